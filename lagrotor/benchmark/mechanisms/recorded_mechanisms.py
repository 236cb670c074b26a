"""The comparison on one machine, with its description. Renewed by `python -m lagrotor.benchmark.mechanisms --record`."""

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from lagrotor.benchmark.mechanisms.chains import Kind, chain
from lagrotor.benchmark.mechanisms.comparison import SIZES, Measured, compare, ready_in_turns
from lagrotor.benchmark.mechanisms.deciding import Decided, decide_pairs
from lagrotor.benchmark.recorded_speed import machine, versions
from lagrotor.errors import LagrotorError
from lagrotor.files import write_text
from lagrotor.mechanics.running.programs import motion_program
from lagrotor.numerics.codegen import operations

RECORDED = Path(__file__).with_name("recorded_mechanisms.json")


@dataclass(frozen=True)
class Comparison:
    """machine and versions; tools on mechanisms; pairs of formulations; on each of SIZES operations of one
    evaluation, and the time in which lagrotor is ready, s."""

    machine: dict[str, Any]
    versions: dict[str, str]
    measured: list[Measured]
    decided: list[Decided]
    operations: dict[Kind, list[int]]
    ready: dict[Kind, list[float]]


def measure_all(step: Callable[[str], None] = lambda text: None) -> Comparison:
    """All of it, some minutes."""
    ready = {kind: ready_in_turns(kind) for kind in SIZES}
    return Comparison(machine(), versions(), compare(step=step), decide_pairs(), counted(), ready)


def counted() -> dict[Kind, list[int]]:
    """Operations of one evaluation on each of SIZES."""
    return {kind: [operations(motion_program(chain(kind, n)).program) for n in sizes] for kind, sizes in SIZES.items()}


def write_record(found: Comparison) -> Path:
    """Write RECORDED."""
    return write_text(RECORDED, json.dumps(asdict(found), indent=1, ensure_ascii=False) + "\n")


def recorded_mechanisms() -> Comparison:
    """What is on record. Raises LagrotorError if it is unreadable."""
    try:
        data = json.loads(RECORDED.read_text(encoding="utf-8"))
        measured = [Measured(**x) for x in data.pop("measured")]
        decided = [Decided(**x) for x in data.pop("decided")]
        return Comparison(**data, measured=measured, decided=decided)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise LagrotorError(f"{RECORDED} cannot be read ({error}): renew it") from None
