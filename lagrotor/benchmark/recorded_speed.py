"""Benchmark results of one machine, with its description: the displaced pair by every method, and ensembles.

A report shows these, and so is the same bytes everywhere. Renewed by `python -m lagrotor.report.renew_record speed`.
"""

import json
import os
import platform
from dataclasses import asdict, replace
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from lagrotor.errors import LagrotorError
from lagrotor.files import write_text

RECORDED = Path(__file__).with_name("recorded_speed.json")
_PACKAGES = (
    "numpy",
    "scipy",
    "sympy",
    "heyoka",
    "pydy",
    "casadi",
    "scikit-sundae",
    "mujoco",
    "pin",
    "drake",
    "symbrim",
    "Cython",
    "CyRK",
    "numba",
)
_SAMPLES = 7
_ERRORS = (1e-6, 1e-8, 1e-10, 1e-12, 1e-13)


def recorded_speed() -> dict[str, Any]:
    """machine, versions, at_error (error → method → s), set_up (method → s), throughput. Raises LagrotorError if unreadable."""
    try:
        return dict(json.loads(RECORDED.read_text(encoding="utf-8")))
    except (OSError, ValueError) as error:
        raise LagrotorError(f"{RECORDED} cannot be read ({error}): renew it") from None


def renew_speed() -> None:
    """Run the displaced pair by every method that is installed, and the ensembles; a few minutes. Writes RECORDED."""
    from concurrent.futures import ProcessPoolExecutor

    from lagrotor.benchmark.compiled_solvers import CANDIDATES
    from lagrotor.benchmark.peers import PEERS
    from lagrotor.benchmark.runner import benchmark, work_at
    from lagrotor.benchmark.scenes_and_methods import CASES, METHODS, OURS
    from lagrotor.benchmark.throughput import throughput

    case = replace(CASES["displaced"](False), repeats=_SAMPLES)
    found = benchmark("displaced", case, METHODS | CANDIDATES | PEERS)
    best = {f"best of {name}": [p for p in found.points if p.family in of] for name, of in OURS.items()}
    best |= {name: [p for p in found.points if p.method == name] for name in found.setup}
    with ProcessPoolExecutor() as executor:
        rates = throughput(8192, executor)
    data = {
        "machine": machine(),
        "versions": versions(),
        "at_error": {f"{e:g}": {name: work_at(points, e) for name, points in best.items()} for e in _ERRORS},
        "least_error": {name: min((p.error for p in points), default=None) for name, points in best.items()},
        "set_up": found.setup,
        "failures": list(map(str, found.failures)),
        "throughput": [asdict(rate) for rate in rates],
    }
    write_text(RECORDED, json.dumps(data, indent=1, ensure_ascii=False) + "\n")


def machine() -> dict[str, Any]:
    """Processor, cores and Python of this machine."""
    return {"processor": _processor(), "cores": os.cpu_count(), "Python": platform.python_version()}


def versions() -> dict[str, str]:
    """Of the packages that are compared and installed."""
    return {name: version(name) for name in _PACKAGES if _installed(name)}


def _installed(name: str) -> bool:
    return find_spec({"scikit-sundae": "sksundae", "pin": "pinocchio", "drake": "pydrake"}.get(name, name)) is not None


def _processor() -> str:
    """The processor's name as the system gives it."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())
