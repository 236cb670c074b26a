"""No wrong answer without a word: random scenes as wide as the package accepts, held to 80-bit integrations.

The references are recorded in `wide_scenes.npz`; `python -m tests.models.wide_scenes` renews them, with heyoka.
"""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

import lagrotor.numerics.integrate as integrators
from lagrotor import Link, Rotor, Scene, Trajectory, sweep
from lagrotor.errors import DomainError, IntegrationError, LagrotorWarning, SingularError
from lagrotor.models import simulate as simulating
from lagrotor.models import spheres
from lagrotor.numerics import error_estimate, taylor
from lagrotor.numerics.solvers import lsoda
from lagrotor.numerics.taylor import taylor_order
from tests.models.wide_scenes import COUNT, IN_128_BITS, SEED, Array, Wide, reference, turns, wide_scenes
from tests.models.wide_scenes import run as run_of

RECORDED = np.load(Path(__file__).with_name("wide_scenes.npz"))
TENFOLD = 10.0  # of rounding, that a reference beside a dead point may gather
PREDICTABLE = 1e4  # parting of neighbouring motions below which no miss may be silent
NO_HEYOKA = pytest.mark.skipif(find_spec("heyoka") is None, reason="the fast extra is not installed")
ENGINES = ["core", pytest.param("fast", marks=NO_HEYOKA)]
TRIALS = wide_scenes(SEED, COUNT)
LONG_TWIST = 639  # 1,200 turns of a bar longer than the rotors, that goes round and round
ALIKE = [874]  # of a fifth of the local error both runs have the same error of 2×10⁻⁵
SHORT = [i for i, trial in enumerate(TRIALS) if turns(trial) < 10][:100]


@dataclass(frozen=True)
class Outcome:
    """A trial's run, None where it was refused; its true error beyond the reference's own; whether there was a warning."""

    trial: Wide
    run: Trajectory | None
    error: float
    growth: float
    warned: bool

    @property
    def missed(self) -> bool:
        return self.run is not None and not self.error <= self.trial.tol

    def __str__(self) -> str:
        says = f"{self.run.model}, estimate {self.run.error:.1e}" if self.run else "refused"
        return f"{self.trial}: {says}, error {self.error:.1e}, neighbours part {self.growth:.0e}-fold"


def unsure(i: int) -> Array:
    """How far off the recorded axes may be (3,): beside a dead point, where the constraints are nearly dependent, rounding of 80
    bits is divided by the distance from it, and grows as motions part."""
    axes = np.array(TRIALS[i].scene.axes)
    near = np.linalg.norm(axes[:, 1:]) if TRIALS[i].scene.link and axes[0, 0] * axes[1, 0] > 0.9 else 1.0
    rounding = TENFOLD * 2.0**-64 / max(near, 1e-9) * RECORDED["growth"][i]
    return np.asarray(2 * RECORDED["own"][i] + np.where((near < 1e-3) & (i not in IN_128_BITS), rounding, 0.0))


def outcomes(which: list[int], engine: str) -> Iterator[Outcome]:
    for i in which:
        trial, growth = TRIALS[i], float(RECORDED["growth"][i].max())
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            try:
                run = run_of(trial, engine=engine)
            except (IntegrationError, SingularError):
                yield Outcome(trial, None, np.nan, growth, True)
                continue
        error = np.linalg.norm(run.axes - RECORDED["axes"][i], axis=-1).max() - unsure(i).max()
        yield Outcome(trial, run, float(error), growth, any(w.category is LagrotorWarning for w in said))


def judge(which: list[int], engine: str) -> tuple[list[str], list[str], list[str]]:
    """Silent misses, refusals, and warnings of runs that did keep the tolerance, where neighbours part little."""
    silent, refused, needless = [], [], []
    for outcome in outcomes(which, engine):
        if outcome.missed and not outcome.warned:
            silent.append(str(outcome))
        if outcome.growth < PREDICTABLE:
            refused += [str(outcome)] if outcome.run is None else []
            needless += [str(outcome)] if outcome.run and outcome.warned and not outcome.missed else []
    return silent, refused, needless


@pytest.mark.parametrize(("engine", "count"), [("core", 100), pytest.param("fast", 40, marks=NO_HEYOKA)])
def test_no_miss_is_silent(engine: str, count: int) -> None:
    """Fewer by the fast engine, which compiles a program for nearly each scene anew: of all in the slow suite."""
    silent, refused, needless = judge(SHORT[:count], engine)
    assert not silent, silent
    assert len(refused) + len(needless) <= count / 10, refused + needless


@pytest.mark.slow
@pytest.mark.parametrize("engine", ENGINES)
def test_no_miss_is_silent_on_a_thousand_scenes(engine: str) -> None:
    silent, refused, needless = judge(list(range(COUNT)), engine)
    assert not silent, silent
    assert len(refused) + len(needless) <= COUNT / 10, refused + needless


def test_an_estimate_that_says_too_little_would_be_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twin: one integration at the wanted tolerance, its error taken for granted, misses in silence."""

    def trusting(evolution, times, tol):  # type: ignore[no-untyped-def]
        once = evolution.integrate(evolution.start, times, tol, False, 1e7)
        return error_estimate.EstimatedRun(
            times,
            once.states,
            np.full(len(times), tol),
            np.inf,
            0,
            error_estimate.Ending("end", times[-1]),
            tol,
        )

    monkeypatch.setattr(simulating, "estimate_run", trusting)
    assert judge(SHORT[1::2], "core")[0]


def told_too_little(which: list[int], tolerances: tuple[float, ...], model: str = "minimal") -> list[str]:
    """Runs of a model, by name, whose error is larger than they say."""
    found = []
    for i in which:
        for tol in tolerances:
            trial = replace(TRIALS[i], tol=tol)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", LagrotorWarning)
                try:
                    run = run_of(trial, model=model)
                except (IntegrationError, SingularError, DomainError):
                    continue
            errors = np.linalg.norm(run.axes - RECORDED["axes"][i], axis=-1).max(0) - unsure(i)
            found += [f"{i}, {tol:g}: {errors}, {run.errors}"] if (errors > run.errors).any() else []
    return found


IN_A_PULSE, BESIDE_THE_JOINT_LINE = [51, 81, 172], [36, 80, 164, 221, 326]
BESIDE_A_DEAD_POINT = [72, 107, 867]  # where rounding of the constraints moves a state on them a thousand times as far


def test_in_a_pulse_two_runs_take_no_steps_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not told_too_little(IN_A_PULSE, (1e-3,))
    # Twin: at two loose tolerances the same local error, as it is the largest for a pulse.
    fixed = lambda segment, error: lsoda(segment, 1e-6 if segment.longest < np.inf else error)  # noqa: E731
    monkeypatch.setattr(integrators, "lsoda", fixed)
    assert told_too_little(IN_A_PULSE, (1e-3,))


def test_a_start_that_coordinates_cannot_hold_is_in_the_error(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not told_too_little(BESIDE_THE_JOINT_LINE, (1e-8, 1e-10))
    monkeypatch.setattr(simulating, "start_error", lambda *given: 1.0)  # twin
    assert len(told_too_little(BESIDE_THE_JOINT_LINE, (1e-10,))) > 1


def test_where_the_constraints_are_nearly_dependent_rounding_is_in_the_error(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not told_too_little(BESIDE_A_DEAD_POINT, (2.3e-11, 1e-11), "spheres")
    without = replace(spheres.MODEL, slack=None)  # twin
    monkeypatch.setitem(simulating.MODELS, "spheres", without)
    assert told_too_little(BESIDE_A_DEAD_POINT, (2.3e-11, 1e-11), "spheres")


def test_beside_a_dead_point_the_model_that_keeps_the_tolerance_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    """Unit vectors would be off by ten to a hundred times the tolerance there, as their constraints are nearly dependent."""
    which = (224, 387)
    runs = [run_of(TRIALS[i]) for i in which]
    for i, run in zip(which, runs, strict=True):
        error = np.linalg.norm(run.axes - RECORDED["axes"][i], axis=-1).max() - 2 * RECORDED["own"][i].max()
        assert run.model == "minimal" and error <= run.error <= TRIALS[i].tol and "dead point" in run.why
    monkeypatch.setattr(simulating, "MOST_SLACK", simulating.MOST_SLACK._replace(value=0.0))  # twin
    with pytest.warns(LagrotorWarning, match="does not keep"):
        others = [run_of(TRIALS[i]) for i in which]
    assert all(other.model == "spheres" and other.error > TRIALS[i].tol for i, other in zip(which, others, strict=True))


FOLDING = Scene(  # a bar that folds over 10⁻² rad from the dead point
    (0.012, -0.012), Rotor(0.1, 1.0, 0.17, 0.17), Link(0.99944, 0.0094, 7.8e-4), None, ((0.7, 0, 0.51**0.5),) * 2,
    ((1.0, 0.0148, -0.7 / 0.51**0.5), (1.0, -0.0115, -0.7 / 0.51**0.5)),
)  # fmt: skip


def test_two_runs_that_are_off_alike_are_seen_by_what_they_conserve(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both step over the same fold at some tolerance, which depends on rounding: they are a fiftieth of their errors apart."""
    fold = Wide(FOLDING, np.array([0.5, 1.3, 1.7]), 1e-10)
    exact = run_of(fold, model="spheres")

    def bounded(tol: float) -> bool:
        run = run_of(replace(fold, tol=tol), model="minimal")
        return bool((np.linalg.norm(run.axes - exact.axes, axis=-1).max(0) < run.errors + exact.errors).all())

    tolerances = 10.0 ** -np.arange(5, 8, 0.125)
    assert all(map(bounded, tolerances))
    monkeypatch.setattr(error_estimate, "_shared_error_factor", lambda *_: 1.0)  # twin
    assert not all(map(bounded, tolerances))


def under_estimated(which: list[int]) -> list[str]:
    """Runs of sweeps whose error is larger than it is said to be, or than a tolerance that they are said to keep."""
    found = []
    for i in which:
        trial = TRIALS[i]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LagrotorWarning)
            ensemble = sweep([trial.scene], [0.0, *trial.t], trial.tol)
        if not len(ensemble.failed):
            axes = ensemble.axes[0][:, 1:]
            error = np.linalg.norm(axes - RECORDED["axes"][i], axis=-1).max() - unsure(i).max()
            found += [f"{trial}: {error:.1e}, {ensemble.error[0]:.1e}"] if error > ensemble.error[0] else []
    return found


@pytest.mark.parametrize("every", [16, pytest.param(1, marks=pytest.mark.slow)])
def test_each_run_of_a_sweep_says_its_error(every: int) -> None:
    assert not under_estimated([i for i in SHORT if RECORDED["growth"][i].max() < PREDICTABLE][::every])


def test_a_sweep_that_says_too_little_would_be_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    for constant in ("SAFETY", "LEAST", "ROUNDING"):
        monkeypatch.setattr(error_estimate, constant, getattr(error_estimate, constant)._replace(value=1e-18))
    assert under_estimated(SHORT[::16])


@NO_HEYOKA
def test_taylor_steps_that_the_states_set_and_not_the_tolerance_hide_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its twist turns without end, and of two runs of one order both take the steps that the largest state allows."""
    tight = [replace(trial, tol=1e-10) for trial in TRIALS]
    monkeypatch.setitem(globals(), "TRIALS", tight)
    (one,) = outcomes([LONG_TWIST], "fast")
    assert one.run is not None and one.error < one.run.error <= one.trial.tol
    # Twin: with the twist in full and orders alike, the two runs agree better than either is right.
    in_full = tuple(replace(model, angles=()) for model in simulating.LADDER)
    monkeypatch.setattr(simulating, "LADDER", in_full)
    monkeypatch.setattr(taylor, "taylor_order", lambda local, companion=False: taylor_order(local))
    (other,) = outcomes([LONG_TWIST], "fast")
    assert other.run is not None and other.error / other.run.error > 2 * one.error / one.run.error


def test_two_runs_at_local_errors_too_near_each_other_are_off_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    assert all(one.run and one.error <= one.run.error <= one.trial.tol for one in outcomes(ALIKE, "core"))
    monkeypatch.setattr(error_estimate, "APART", error_estimate.APART._replace(value=5.0))  # twin
    assert any(one.missed and not one.warned for one in outcomes(ALIKE, "core"))


@NO_HEYOKA
def test_the_record_is_what_the_oracle_gives() -> None:
    rng = np.random.default_rng(5)
    for i in SHORT[::12]:
        exact, own, _ = reference(TRIALS[i], rng)
        # The starts are drawn by linear algebra, whose last digit depends on its kernels.
        rounding = 1e-15 + 4 * np.finfo(float).eps * RECORDED["growth"][i].max()
        assert np.abs(exact - RECORDED["axes"][i]).max() <= rounding + own.max() + RECORDED["own"][i].max()
