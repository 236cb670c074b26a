"""Trajectories per second in ensembles, and points per second of the closed forms against what memory delivers."""

import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from typing import TypeVar

import numpy as np

from lagrotor.benchmark.runner import check_work
from lagrotor.models.minimal import MODEL, scenes_from_states
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.models.simulate import simulate
from lagrotor.models.sweeps.ensemble import CHUNK, Ensemble, sweep
from lagrotor.pair.scene import Scene
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.paired_precession.closed_forms import corrected_trajectories, paired_frequency
from lagrotor.theory.paired_precession.series_orbit import series_orbit

_RUN = 10.0  # s
_BIG = 1_000_000  # doubles: 8 MB an array, past the caches that a core has to itself
_Result = TypeVar("_Result")


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

    With the fast extra, where heyoka is installed, the ensembles once more by it. Raises LagrotorError for a run whose
    evaluations, motion or error are not those of the work that it reports.
    """
    scenes = displaced_family(n)
    rows: list[Throughput] = []
    first = ""
    chunk = max(1, min(CHUNK, n // 2))
    for engine in ("core", *(["fast"] if find_spec("heyoka") else [])):
        for tol in (1e-6, 1e-10):
            # Compile now what is compiled once in a process.
            sweep(scenes[:16], [0.0, 0.1], tol, chunk=4, executor=executor, engine=engine)
            run = partial(sweep, scenes, [0.0, _RUN], tol, chunk=chunk, executor=executor, engine=engine)
            seconds, ensemble = _best(run, 2)
            _check_ensemble(ensemble)
            kind = f"{engine}, error {tol:.0e}"
            what, first = f"trajectories of {_RUN:g} s, displaced family, {kind}", first or kind
            rate = n / seconds
            against = f"that of {first}" if rows else "itself"
            rows.append(Throughput(what, "trajectories/s", rate, rate / rows[0].rate if rows else 1.0, against))
    phases, source, target = np.linspace(0, 2 * np.pi, _BIG), np.ones(_BIG), np.zeros(_BIG)
    copied = _BIG / _best(partial(np.copyto, target, source), 5)[0]
    check_work("an array copied", _BIG, np.array([phases]), float(np.abs(target - source).max()), 0.0)
    rows.append(Throughput("an array copied", "numbers/s", copied, 1.0, "itself"))
    pair, some = Scene((10.0, -10.0)), slice(None, None, _BIG // 16)
    amplitudes, orbit, exact = np.linspace(0.01, 0.3, _BIG), series_orbit(pair, 0.204, 9), series_orbit(pair, 0.204, 15)
    axes = np.moveaxis(exact.at_phase(phases[some]), 2, 1)
    frequency = series_orbit(pair, amplitudes[-1], 15).frequency / natural_rate(pair)
    frequencies = partial(paired_frequency(3), amplitudes, 1.0, 1.0)
    corrected = partial(corrected_trajectories(3), 0.204, phases, 1.0, 1.0)
    # Of each form its work, a part of its values, that part by the series of order 15, and the bound of the difference.
    for name, outputs, work, part, known, bound in (
        ("paired_frequency, order 3", 1, frequencies, -1, frequency, 0.3**4),
        ("corrected_trajectories, order 3", 6, corrected, some, axes, 0.204**4),
        ("precession_orbit, order 9", 6, lambda: np.moveaxis(orbit.at_phase(phases), 2, 1), some, axes, orbit.error),
    ):
        seconds, result = _best(work, 2)
        values, rate = np.reshape(result, (outputs, _BIG)), _BIG / seconds
        check_work(name, _BIG, values, float(np.abs(values[:, part].ravel() - np.ravel(known)).max()), bound, _BIG)
        rows.append(Throughput(name, "points/s", rate, outputs * rate / copied, "the numbers that a copy moves"))
    return rows


def _check_ensemble(ensemble: Ensemble) -> None:
    """Refuse an ensemble that did not run: compare evaluations, errors and the last axes of three runs with `spheres`."""
    ends, errors = ensemble.axes[:, :, -1], [float(ensemble.error.max())]
    for i in (0, len(ends) // 2, len(ends) - 1):
        run = simulate(ensemble.scenes[i], [0.0, _RUN], "spheres", 1e-11)
        errors.append(float(np.linalg.norm(ends[i] - run.axes[:, -1], axis=-1).max()))
    turned = natural_rate(ensemble.scenes[0]) * _RUN  # rad
    check_work("sweep", ensemble.evaluations.min(), ensemble.axes[:, 0], max(errors), ensemble.tol, turned)


def _best(work: Callable[[], _Result], times: int) -> tuple[float, _Result]:
    """Return the least seconds of a few runs, and the result of the last one."""
    seconds = []
    for _ in range(times):
        began = time.perf_counter()
        result = work()
        seconds.append(time.perf_counter() - began)
    return min(seconds), result
