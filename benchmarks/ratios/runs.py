"""Rows of runs in this process: single runs and sweeps beside heyoka alone, sweeps beside an older checkout, `auto` beside the
model that it chooses, and chains of rotors beside shorter ones."""

import json
import subprocess
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from importlib.util import find_spec
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.full_equations import heyoka_alone, heyoka_lanes
from benchmarks.ratios.pairs import Pairs, Row, at_equal_error, seconds
from benchmarks.scenes import SCENES
from benchmarks.structure_comparison import staircase
from lagrotor.benchmark.runner import check_work, reference
from lagrotor.benchmark.scenes_and_methods import CASES
from lagrotor.benchmark.throughput import DURATION, ENSEMBLE_ERRORS, displaced_family
from lagrotor.errors import LagrotorError, LagrotorWarning
from lagrotor.models.model import integrate_model
from lagrotor.models.simulate import MODELS, simulate
from lagrotor.models.sweeps.sweep import sweep
from lagrotor.numerics.integrate import TIGHTEST, Engine
from lagrotor.pair.scene import Link
from lagrotor.structures import exact_motion
from lagrotor.structures.exact.compiled_motion import compiled_right_hand_side
from lagrotor.theory.natural_rate import natural_rate

ROOT = Path(__file__).resolve().parent.parent.parent
_RIVAL = tuple(10.0**-n for n in range(3, 17))  # tolerances of heyoka alone
# Engine → duration of the runs of `auto`, s: so short that the choice of a model counts, and kinds of scenes that are left out.
_AUTO: dict[str, tuple[float, tuple[str, ...]]] = {"core": (1.0, ()), "fast": (10.0, ("equal spins, shock",))}
_TOL = 1e-9


def short_run(periods: int, tol: float) -> Pairs:
    """The displaced pair through some periods with ten times in each, by the fast extra and by heyoka alone."""
    scene = CASES["displaced"](True).scene
    t = np.linspace(0, periods * 2 * np.pi / natural_rate(scene), 10 * periods + 1)
    truth, rival = reference(scene, t), heyoka_alone(scene, t)
    ours = partial(simulate, scene, t, "minimal", tol, "fast")

    def error(tips: NDArray[np.float64]) -> float:
        return max(float(np.linalg.norm(tips - truth.tips, axis=-1).max()), truth.floor)

    run = ours()
    check_work(f"{periods} periods", run.evaluations, run.tips, error(run.tips), max(tol, truth.floor), 10 * periods)
    return at_equal_error(ours, error(run.tips), rival, {x: error(rival(x)[0]) for x in _RIVAL}, tol)


def sweep_and_lanes(n: int, tol: float) -> Pairs:
    """A sweep of n scenes with the fast extra, and heyoka's lanes; the end of every scene is compared with two references."""
    scenes = displaced_family(n)
    truth = heyoka_lanes(scenes, DURATION, _RIVAL[-1])[:, :6]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LagrotorWarning)  # the last digit is not asked for
        exact = _ends(sweep(scenes, [0.0, DURATION], 1e-13))
    floor = float(np.abs(exact - truth).max())
    check_work("the references", n, np.stack([_starts(scenes), truth], 1), floor, tol / 10)
    ours, rival = partial(sweep, scenes, [0.0, DURATION], tol, engine="fast"), partial(heyoka_lanes, scenes, DURATION)
    error = max(_checked_sweep("sweep, fast", ours(), truth), floor)
    errors = {x: max(float(np.abs(rival(x)[:, :6] - truth).max()), floor) for x in _RIVAL[:-1]}
    return at_equal_error(ours, error, rival, errors, tol)


def _ends(ensemble: Any) -> NDArray[np.float64]:
    return np.asarray(ensemble.axes[:, :, -1].reshape(-1, 6))


def _starts(scenes: Any) -> NDArray[np.float64]:
    return np.array([np.ravel(scene.axes) for scene in scenes])


def _checked_sweep(name: str, ensemble: Any, truth: NDArray[np.float64]) -> float:
    """The largest true error of an axis at the end. Raises LagrotorError if a run misses the end or its tolerance."""
    error = float(np.abs(_ends(ensemble) - truth).max())
    moved = np.stack([_starts(ensemble.scenes), _ends(ensemble)], 1)
    check_work(name, int(ensemble.evaluations.min()), moved, max(error, float(ensemble.error.max())), ensemble.tol, 20)
    return error


# Reads the last time and scenes, then a tolerance a line, and answers with the processor time of a sweep and where it ends.
_SWEEPING = """
import json, sys, time, warnings
from lagrotor import Scene, sweep
warnings.simplefilter("ignore")
t_end, given = json.loads(sys.stdin.readline())
scenes = [Scene(spins=s, axes=a, rates=v) for s, a, v in given]
for line in sys.stdin:
    began = time.process_time()
    ensemble = sweep(scenes, [0.0, t_end], float(line))
    taken = time.process_time() - began
    print(json.dumps([taken, int(ensemble.evaluations.min()), ensemble.axes[:, :, -1].tolist()]), flush=True)
"""


def sweep_and_older(n: int, tol: float, old: Path) -> Pairs:
    """A sweep of n scenes with the core packages, by this code and by the checkout in the folder `old`."""
    scenes = displaced_family(n)
    truth = _ends(sweep(scenes, [0.0, DURATION], 1e-11))
    sides = [_sweeping(folder, scenes) for folder in (ROOT, old)]
    try:
        for side, bound in zip(sides, (tol, 100 * tol), strict=True):  # an older one may bound the local error alone
            _, evaluations, axes = side(tol)
            ends = np.reshape(axes, (n, 6))
            moved = np.stack([_starts(scenes), ends], 1)
            check_work("sweep, core", evaluations, moved, float(np.abs(ends - truth).max()), bound, 20)
        while True:
            yield sides[0](tol)[0], sides[1](tol)[0]
    finally:
        for side in sides:
            with suppress(LagrotorError):
                side(None)


def _sweeping(folder: Path, scenes: Any) -> Callable[[float | None], Any]:
    """A process that sweeps with the code in a folder: a function of the tolerance; None ends the process."""
    process = subprocess.Popen(
        [sys.executable, "-c", _SWEEPING], cwd=folder, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert process.stdin and process.stdout
    into, out = process.stdin, process.stdout
    said = json.dumps([DURATION, [(s.spins, s.axes, s.rates) for s in scenes]])

    def run(tol: float | None) -> Any:
        nonlocal said
        with suppress(BrokenPipeError):  # a process that ended answers nothing
            if tol is None:
                into.close()
                return process.wait()
            into.write(f"{said}\n{tol!r}\n" if said else f"{tol!r}\n")
            into.flush()
            said = ""
        if answer := out.readline():
            return json.loads(answer)
        raise LagrotorError(f"the sweep in {folder} ended with {process.wait()}")

    return run


def auto_and_chosen(kind: str, engine: str) -> Pairs:
    """`simulate` with the model "auto" and with the name of the model that it chooses, each on scenes that it has not seen."""
    fresh, t = (SCENES[kind](1 + i * 1e-3) for i in count()), np.linspace(0, _AUTO[engine][0], 101)
    first, model = next(fresh), MODELS["spheres"]
    run, exact = simulate(first, t, tol=_TOL, engine=engine), integrate_model(model, first, t, TIGHTEST)
    error = float(np.abs(run.axes - model.observe(first, exact.states).axes).max())
    check_work(f"auto, {kind}", exact.evaluations, run.axes, error, _TOL)

    def taken(name: str) -> float:
        return seconds(lambda: simulate(next(fresh), t, name, _TOL, engine))

    while True:
        yield taken("auto"), taken(run.model)


def doubled_chain(n: int, link: Link, engine: Engine) -> Pairs:
    """An evaluation of the accelerations of a chain of 2 n rotors, and of n."""
    calls = []
    for s in (staircase(2 * n, link), staircase(n, link)):
        motion = exact_motion(s)
        rhs = compiled_right_hand_side(s, motion) if engine == "fast" else motion.rhs
        y = np.concatenate([motion.c.upright.ravel(), np.zeros(3 * len(s.joints))])
        moving = y + np.linspace(0, 1e-3, len(y))
        right = np.array(motion.rhs(0.0, moving))
        check_work(
            f"{len(s.joints)} rotors, {engine}",
            1,
            right[None],
            float(np.abs(np.array(rhs(0.0, moving)) - right).max()),
            1e-9,
        )
        calls.append(partial(rhs, 0.0, moving))
    while True:
        yield seconds(calls[0]), seconds(calls[1])


def rows(old: Path | None) -> list[Row]:
    """The rows of runs; those of an older checkout only if its folder is given."""
    lanes = [
        Row(f"sweep, fast, 512 scenes of 10 s, tol {tol:g}", "heyoka's lanes", 2, partial(sweep_and_lanes, 512, tol))
        for tol in ENSEMBLE_ERRORS
    ]
    older = [
        Row(
            f"sweep, core, 512 scenes of 10 s, tol {tol:g}",
            "the older one",
            1 / 6,
            partial(sweep_and_older, 512, tol, old),
            3,
        )
        for tol in ENSEMBLE_ERRORS
        if old
    ]
    single = [
        Row(f"run of {n} periods, fast, tol {tol:g}", "heyoka alone", wanted, partial(short_run, n, tol))
        for n, wanted, tol in ((10, 4, 1e-6), (10, 4, 1e-10), (200, 3, 1e-6), (200, 3, 1e-8))
    ]
    auto = [
        Row(f"simulate(auto), {engine}, {kind}", "the chosen model", 1.3, partial(auto_and_chosen, kind, engine))
        for engine, (_, left_out) in _AUTO.items()
        for kind in SCENES
        if kind not in left_out
    ]
    # heyoka compiles long chains with heavy bars for minutes.
    sizes: dict[Engine, int] = {"core": 512, "fast": 64} if find_spec("heyoka") else {"core": 512}
    chains = [
        Row(
            f"evaluation of {2 * n} rotors, {bars}, {engine}",
            f"{n} rotors",
            2.3,
            partial(doubled_chain, n, link, engine),
        )
        for bars, link in {"massless bars": Link(), "heavy bars": Link(1, 0.3, 0.1)}.items()
        for engine, n in sizes.items()
    ]
    return [*lanes, *older, *single, *auto, *chains]
