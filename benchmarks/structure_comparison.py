"""Chains of rotors by this tool and by multibody engines: processor time to one error, all in one run, in turns.

`python -m benchmarks.structure_comparison` writes the record that the report shows; some minutes, in one thread. A
tool's time is that of its coarsest setting whose tips are within CHAIN_ERROR of the reference at all times: the exact model at
10⁻¹², with which every engine agrees. `simulate` gives its error estimate, for which it integrates twice; the engines give none.
"""

import os
import time
from collections.abc import Callable
from dataclasses import asdict, replace
from importlib.util import find_spec
from multiprocessing import get_context
from statistics import median
from typing import Any

import numpy as np

from benchmarks.machine import machine, versions
from benchmarks.peers.multibody_engines import ENGINES
from benchmarks.peers.rig import Rig
from lagrotor.benchmark.records import CHAIN_ERROR, CHAIN_SIZES, Timed, write_record
from lagrotor.benchmark.runner import Array, Runner, check_work
from lagrotor.errors import IntegrationError
from lagrotor.numerics.integrate import Engine
from lagrotor.pair.scene import Link
from lagrotor.structures.exact.structure_run import StructureRun
from lagrotor.structures.structure import Structure

MASSLESS = Link(1, 0, 0)
TIMES = np.linspace(0, 3, 31)
_LONGEST = 60.0  # s of a run, after which no finer setting is tried
_ONCE = 10.0  # s of a run that is not repeated
_SLOW = 300  # times the fastest tool
_ROUNDS = 5
_TOLERANCES = tuple(10.0 ** (-n / 2) for n in range(3, 24))
_MODULES = {"MuJoCo": "mujoco", "Pinocchio": "pinocchio", "Drake": "pydrake"}
Run = Callable[[float], Array]


def staircase(n: int, link: Link = MASSLESS) -> Structure:
    """n equal rotors, spins 10 rad/s, joined in a staircase by bars of 1 m, massless unless said."""
    return Structure([((k + 1) // 2, k // 2) for k in range(n)], [(k, k + 1) for k in range(n - 1)], 10.0, link=link)


def begun(s: Structure, tol: float, engine: Engine = "core", seed: int = 0) -> StructureRun:
    """Its run through TIMES from random tilts of 0.05 and rates of 0.5/s."""
    draw = np.random.default_rng(seed)
    tilt, rates = (size * draw.standard_normal((len(s.joints), 2)) for size in (0.05, 0.5))
    return s.simulate(TIMES, tilt, rates, tol=tol, engine=engine)


def tools(n: int) -> dict[str, tuple[Run, tuple[float, ...]]]:
    """What is installed: runs, setting → tips (n, 31, 3), and settings from coarse to fine."""
    s = staircase(n)
    at_start = begun(s, 1e-3)
    rig = Rig(
        s.rotor[0], np.array(s.joints), tuple((i, j) for i, j, _ in s.bars), np.array(s.spins), at_start.axes[:, 0],
        at_start.rates[:, 0],
    )  # fmt: skip
    runs: dict[str, tuple[Run, tuple[float, ...]]] = {"lagrotor": (lambda tol: begun(s, tol).tips, _TOLERANCES)}
    if find_spec("heyoka"):
        runs["lagrotor, fast"] = (lambda tol: begun(s, tol, "fast").tips, _TOLERANCES)
    for name, (prepare, steps) in ENGINES.items():
        if find_spec(_MODULES[name.split(",")[0]]):
            runs[name] = (_prepared(prepare, rig), steps[-2:] or _TOLERANCES[7:])
    return runs


def _prepared(prepare: Callable[[Rig, Array], Runner], rig: Rig) -> Run:
    """Prepared at its first run, in which it may be refused."""
    made: list[Runner] = []

    def run(setting: float) -> Array:
        made[:] = made or [prepare(rig, TIMES)]
        return made[0](setting)[0]

    return run


def compared(n: int, say: Callable[[str], None], out: set[str]) -> list[Timed]:
    """Every tool on a chain of n rotors but those left out."""
    reference = begun(staircase(n), 1e-12)
    truth, least = reference.tips, len(TIMES)
    check_work(f"the reference of {n} rotors", reference.evaluations, truth, reference.error, CHAIN_ERROR / 10, least)
    timed, chosen = dict[str, Timed](), dict[str, tuple[Run, float, list[float]]]()
    for name, (run, settings) in tools(n).items():
        if name in out:
            continue
        timed[name], seconds = _reached(n, name, run, settings, truth), list[float]()
        if timed[name].error <= CHAIN_ERROR and timed[name].first < _ONCE:
            chosen[name] = (run, timed[name].setting, seconds)
        say(f"{n} {name}: error {timed[name].error:.1e} at {timed[name].setting:g}")
    for _ in range(_ROUNDS):
        for run, setting, seconds in chosen.values():
            seconds.append(_timed(run, setting)[1])
    taken = {name: each.first if each.error <= CHAIN_ERROR else None for name, each in timed.items()}
    taken |= {name: median(seconds) for name, (_, _, seconds) in chosen.items()}
    return [replace(each, seconds=taken[name]) for name, each in timed.items()]


def _reached(n: int, name: str, run: Run, settings: tuple[float, ...], truth: Array) -> Timed:
    """The first setting within CHAIN_ERROR, or the best of those that were tried."""
    best = Timed(n, name, settings[0], np.inf, None, 0.0)
    for setting in settings:
        try:
            tips, seconds = _timed(run, setting)
        except IntegrationError as refusal:
            return replace(best, reason=str(refusal))
        error = float(np.abs(tips - truth).max())
        if error < best.error:
            best = Timed(n, name, setting, error, None, seconds)
        if error <= CHAIN_ERROR or seconds > _LONGEST:
            break
    return best


def _timed(run: Run, setting: float) -> tuple[Array, float]:
    import warnings

    begin = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a tolerance that is not kept: the error is measured here
        tips = run(setting)
    return tips, time.process_time() - begin


def measure_all(say: Callable[[str], None] = lambda text: None) -> dict[str, Any]:
    """All of it: machine, versions, and the rows."""
    rows: list[Timed] = []
    for n in CHAIN_SIZES:
        timed = compared(n, say, {row.tool for row in rows if row.reason})
        rows += timed
        least = min(row.seconds for row in timed if row.seconds)
        rows = [
            replace(row, reason=f"over {_SLOW} times the fastest: not tried with more rotors")
            if row.n == n and not row.reason and (row.seconds is None or row.seconds > _SLOW * least)
            else row
            for row in rows
        ]
    return {
        "machine": machine(),
        "versions": versions(),
        "rows": [asdict(row) | {"error": None if np.isinf(row.error) else row.error} for row in rows],
    }


def _in_one_thread() -> None:
    print(write_record("structures", measure_all(print)))


if __name__ == "__main__":
    os.environ |= dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    process = get_context("spawn").Process(target=_in_one_thread)
    process.start()
    process.join()
    raise SystemExit(process.exitcode)
