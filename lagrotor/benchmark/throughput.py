"""Trajectories per second in ensembles, and points per second of the closed forms against what memory delivers."""

import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec

import numpy as np

from lagrotor.models.minimal import MODEL, scenes_from_states
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.models.sweeps.ensemble import CHUNK, sweep
from lagrotor.pair.scene import Scene
from lagrotor.theory.paired_precession.closed_forms import corrected_trajectories, paired_frequency
from lagrotor.theory.paired_precession.series_orbit import series_orbit

_RUN = 10.0  # s
_BIG = 1_000_000  # doubles: 8 MB an array, past the caches that a core has to itself


@dataclass(frozen=True)
class Throughput:
    """What was done, how many a second (`unit`), and as what share of what (`against`)."""

    what: str
    unit: str
    rate: float
    share: float
    against: str


def displaced_family(n: int) -> list[Scene]:
    """n opposite pairs displaced from the paired precession: its start at r₀ = 0.204 scaled from a quarter to one and a half."""
    scene = Scene((10.0, -10.0))
    return scenes_from_states(scene, np.linspace(0.25, 1.5, n)[:, None] * MODEL.start(exact_orbit(scene, 0.204).scene))


def throughput(n: int = 4096, executor: Executor | None = None) -> list[Throughput]:
    """Rates of an ensemble of n at 1e-6 and 1e-10, in `executor` or here, and of the closed forms; each the best of a few.

    With the fast extra, where heyoka is installed, the ensembles once more by it.
    """
    scenes = displaced_family(n)
    rows: list[Throughput] = []
    first = ""
    chunk = max(1, min(CHUNK, n // 2))
    for engine in ("core", *(["fast"] if find_spec("heyoka") else [])):
        for tol in (1e-6, 1e-10):
            # Compile now what is compiled once in a process.
            sweep(scenes[:16], [0.0, 0.1], tol, chunk=4, executor=executor, engine=engine)
            seconds = _best(partial(sweep, scenes, [_RUN], tol, chunk=chunk, executor=executor, engine=engine), 2)
            kind = f"{engine}, error {tol:.0e}"
            what, first = f"trajectories of {_RUN:g} s, displaced family, {kind}", first or kind
            rate = n / seconds
            against = f"that of {first}" if rows else "itself"
            rows.append(Throughput(what, "trajectories/s", rate, rate / rows[0].rate if rows else 1.0, against))
    phases, source, target = np.linspace(0, 2 * np.pi, _BIG), np.ones(_BIG), np.empty(_BIG)
    copied = _BIG / _best(partial(np.copyto, target, source), 5)
    rows.append(Throughput("an array copied", "numbers/s", copied, 1.0, "itself"))
    amplitudes, orbit = np.linspace(0.01, 0.3, _BIG), series_orbit(Scene((10.0, -10.0)), 0.204, 9)
    for name, outputs, work in (
        ("paired_frequency, order 3", 1, partial(paired_frequency(3), amplitudes, 1.0, 1.0)),
        ("corrected_trajectories, order 3", 6, partial(corrected_trajectories(3), 0.204, phases, 1.0, 1.0)),
        ("precession_orbit, order 9", 6, partial(orbit.at_phase, phases)),
    ):
        rate = _BIG / _best(work, 2)
        rows.append(Throughput(name, "points/s", rate, outputs * rate / copied, "the numbers that a copy moves"))
    return rows


def _best(work: Callable[[], object], times: int) -> float:
    """Least seconds of a few runs."""
    seconds = []
    for _ in range(times):
        began = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - began)
    return min(seconds)
