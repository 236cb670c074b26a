"""The number of trajectories that an ensemble computes per second."""

import time
from concurrent.futures import Executor
from dataclasses import dataclass
from importlib.util import find_spec

import numpy as np

from lagrotor.benchmark.runner import check_work
from lagrotor.models.minimal import MODEL, scenes_from_states
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.models.simulate import simulate
from lagrotor.models.sweeps.chunk import CHUNK
from lagrotor.models.sweeps.ensemble import Ensemble
from lagrotor.models.sweeps.sweep import sweep
from lagrotor.pair.scene import Scene
from lagrotor.theory.natural_rate import natural_rate

DURATION = 10.0  # s
ENSEMBLE_ERRORS = 1e-6, 1e-10


@dataclass(frozen=True)
class Throughput:
    """A measured rate: the task in words, the rate in `unit`, and its ratio `share` to the rate of the row `against`."""

    what: str
    unit: str
    rate: float
    share: float
    against: str


def displaced_family(n: int) -> list[Scene]:
    """Return n pairs with opposite spins. Their initial states are 0.25 to 1.5 times the start of the paired precession with
    r₀ = 0.204."""
    scene = Scene((10.0, -10.0))
    return scenes_from_states(scene, np.linspace(0.25, 1.5, n)[:, None] * MODEL.start(exact_orbit(scene, 0.204).scene))


def throughput(n: int = 4096, executor: Executor | None = None) -> list[Throughput]:
    """Measure the rates of an ensemble of n scenes at the tolerances 1e-6 and 1e-10, each as the better of two runs.

    The runs take place in `executor`, or in this process if it is None. If heyoka is installed, the engine "fast" adds two
    rows. Raises LagrotorError if the evaluations, the motion or the error of a run are not as reported.
    """
    scenes = displaced_family(n)
    rows: list[Throughput] = []
    first = ""
    chunk = max(1, min(CHUNK, n // 2))
    for engine in ("core", *(["fast"] if find_spec("heyoka") else [])):
        for tol in ENSEMBLE_ERRORS:
            # Compilation happens once in a process and is not part of the rate.
            sweep(scenes[:16], [0.0, 0.1], tol, chunk=4, executor=executor, engine=engine)
            seconds = []
            for _ in range(2):
                began = time.perf_counter()
                ensemble = sweep(scenes, [0.0, DURATION], tol, chunk=chunk, executor=executor, engine=engine)
                seconds.append(time.perf_counter() - began)
            _check_ensemble(ensemble)
            kind = f"{engine}, error {tol:.0e}"
            what, first = f"trajectories of {DURATION:g} s, displaced family, {kind}", first or kind
            rate = n / min(seconds)
            against = f"that of {first}" if rows else "itself"
            rows.append(Throughput(what, "trajectories/s", rate, rate / rows[0].rate if rows else 1.0, against))
    return rows


def _check_ensemble(ensemble: Ensemble) -> None:
    """Check the evaluations and errors of an ensemble, and compare the last axes of three runs with the model `spheres`."""
    ends, errors = ensemble.axes[:, :, -1], [float(ensemble.error.max())]
    for i in (0, len(ends) // 2, len(ends) - 1):
        run = simulate(ensemble.scenes[i], [0.0, DURATION], "spheres", 1e-11)
        errors.append(float(np.linalg.norm(ends[i] - run.axes[:, -1], axis=-1).max()))
    angle = natural_rate(ensemble.scenes[0]) * DURATION  # rad
    check_work("sweep", ensemble.evaluations.min(), ensemble.axes[:, 0], max(errors), ensemble.tol, angle)
