"""`choose`: on random scenes the chosen rung meets the tolerance, and hardly ever would a cheaper one have."""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, Shock, consistent_scene, paired_scene, simulate
from lagrotor.errors import LagrotorError
from lagrotor.models import minimal, spheres
from lagrotor.models.simulate import choose
from tests.models.one_integration import observed

LADDER = ("closed_form", "linear", "minimal", "spheres")
BARS = ((0.0, 0.0), (0.01, 0.1), (1.0, 1.0), (1.0, 0.05))
UP = np.array([[0, 0, 1.0], [0, 0, 1.0]])


def random_scene(rng: np.random.Generator, kind: str) -> Scene:
    """A scene at rest, displaced, shocked, turning about the joint line, or on its paired precession."""
    link = Link(rng.choice([0.7, 1.0, 1.3]), *BARS[rng.integers(4)])
    spin = rng.uniform(3, 20) * rng.choice([-1, 1])
    if kind == "paired":
        return paired_scene(Scene((spin, -spin), link=link), 10 ** rng.uniform(-3, -0.5))
    spins = (spin, (-spin, spin, rng.uniform(-20, 20))[rng.integers(3)])
    axes, rates, shock = UP, np.zeros((2, 3)), None
    if kind == "shocked":
        push = 10 ** rng.uniform(-4, 2) * rng.normal(size=3)
        shock = Shock(tuple(push), rng.uniform(0.1, 5), 10 ** rng.uniform(-2, -1), int(rng.integers(1, 3)))
    elif kind in ("displaced", "turning"):
        size = 10 ** rng.uniform(-5, -0.5)
        axes = UP + size * rng.normal(size=(2, 3)) * [1, 1, 0]
        axes = axes / np.linalg.norm(axes, axis=1)[:, None]
        rates = 5 * size * rng.normal(size=(2, 3))
    if kind == "turning":
        rates = rates + [0, rng.uniform(-1, 1), 0]
    return consistent_scene(spins, axes, rates, Rotor(), link, shock)


@dataclass(frozen=True)
class Trial:
    """A scene, its times and tolerance, and two exact runs that agree on it."""

    kind: str
    scene: Scene
    t: np.ndarray
    tol: float
    exact: np.ndarray

    def error(self, model: str) -> float:
        """Largest error of an axis by a model; infinite where it refuses."""
        try:
            axes = simulate(self.scene, self.t, model, self.tol).axes
        except LagrotorError:
            return np.inf
        return float(np.linalg.norm(axes - self.exact, axis=-1).max())


def trials(seed: int, count: int) -> Iterator[Trial]:
    """Random trials; a motion that two exact models at 1e-13 see differently is beyond prediction, and drawn again."""
    rng, drawn = np.random.default_rng(seed), 0
    while drawn < count:
        kind = ("rest", "displaced", "shocked", "turning", "paired")[rng.integers(5)]
        t, tol = np.linspace(0, rng.uniform(0.5, 20), 200), 10 ** rng.uniform(-11, -1)
        try:
            scene = random_scene(rng, kind)
        except LagrotorError:
            continue
        exact = observed(spheres.MODEL, scene, t, 1e-13).axes
        try:
            other = observed(minimal.MODEL, scene, t, 1e-13).axes
        except LagrotorError:
            other = observed(spheres.MODEL, scene, t, 3e-13).axes
        if np.abs(exact - other).max() < tol / 10:
            drawn += 1
            yield Trial(kind, scene, t, tol, exact)


@cache
def drawn(seed: int, count: int) -> tuple[Trial, ...]:
    """The trials of a seed, once for every test that judges them."""
    return tuple(trials(seed, count))


def judge(seed: int, count: int, engine: str = "core") -> tuple[list[str], list[str], Counter[tuple[str, str]]]:
    """Trials whose chosen rung missed the tolerance, those that a cheaper rung would have met, and what was chosen."""
    missed, dear, chosen = [], [], Counter[tuple[str, str]]()
    for trial in drawn(seed, count):
        choice = choose(trial.scene, trial.t[-1], trial.tol, engine)
        run = simulate(trial.scene, trial.t, tol=trial.tol, engine=engine)
        error = float(np.linalg.norm(run.axes - trial.exact, axis=-1).max())
        says = f"{trial} {choice} {run.why} {error:.3e}"
        chosen[trial.kind, run.model] += 1
        assert choice.estimate <= trial.tol
        if not error <= trial.tol:
            missed.append(says)
        # Of those that are integrated one is no dearer than the other.
        if any(trial.error(cheaper) <= trial.tol for cheaper in LADDER[: min(2, LADDER.index(run.model))]):
            dear.append(says)
    return missed, dear, chosen


def check(seed: int, count: int) -> Counter[tuple[str, str]]:
    missed, dear, chosen = judge(seed, count)
    assert not missed, missed
    assert len(dear) <= count / 10, dear
    return chosen


def test_the_chosen_rung_meets_the_tolerance_and_hardly_any_cheaper_one_would() -> None:
    chosen = check(1, 20)
    assert {model for _, model in chosen} >= {"closed_form", "linear", "minimal"}


@pytest.mark.parametrize("count", [12, pytest.param(300, marks=pytest.mark.slow)])
def test_the_fast_extra_misses_none_either_and_foresees_only_long_runs(count: int) -> None:
    pytest.importorskip("heyoka", reason="the fast extra is not installed")
    missed, _, chosen = judge(4, count, "fast")
    assert not missed, missed
    assert chosen["rest", "minimal"] and chosen["paired", "minimal"]
    shaken = Scene((10, -10), shock=Shock((0.04, 0, 0), 2.0, 0.05))
    assert choose(shaken, 5.0, 1e-4, "fast").reason.endswith("too short to estimate the cheaper ones' errors")
    assert choose(shaken, 50.0, 1e-4, "fast").model == choose(shaken, 5.0, 1e-4).model == "linear"
    assert choose(Scene((10, 3), link=None, rates=((1, 0, 0),) * 2), 1.0, 1e-6, "fast").model == "closed_form"


def test_the_judge_would_see_a_wrong_choice(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twins: an estimate ten times too small misses tolerances; one ten thousand times too large is dear."""
    import lagrotor.models.linear as normal_modes

    right = normal_modes.linear_error
    monkeypatch.setattr(normal_modes, "linear_error", lambda scene, t_end: right(scene, t_end) / 100)
    assert judge(3, 16)[0]
    monkeypatch.setattr(normal_modes, "linear_error", lambda scene, t_end: right(scene, t_end) * 1e6)
    assert len(judge(3, 16)[1]) > 16 / 10


@pytest.mark.parametrize(
    ("size", "tol", "estimated"), [(0.03, 1e-4, 0), (1e-4, 1e-4, 1), (1e-4, 1e-11, 0), (1e-6, 1e-11, 1)]
)
@pytest.mark.parametrize("shaken", [False, True])
def test_nothing_is_estimated_that_cannot_keep_the_tolerance(
    monkeypatch: pytest.MonkeyPatch, size: float, tol: float, estimated: int, shaken: bool
) -> None:
    """A motion too wide for normal modes costs no estimate of their error, whether it moves at the start or is shaken."""
    import lagrotor.models.linear as normal_modes

    right, calls = normal_modes.linear_error, []
    monkeypatch.setattr(normal_modes, "linear_error", lambda *a: (calls.append(a), right(*a))[1])
    shock = Shock((200 * size, 100 * size, 0), 1.0, 0.05)
    moving = consistent_scene((10, 4), UP, 10 * size * np.array([[1, 0.5, 0], [-0.3, 1, 0]]))
    scene = Scene((10, 4), shock=shock) if shaken else moving
    choice = choose(scene, 2.0, tol)
    assert len(calls) == estimated and (estimated or choice.model == "minimal")
    assert choice.model == "linear" or right(scene, 2.0) > tol


SHOCK = Shock((40, -11, 0), 2.0, 1 / 20)


@pytest.mark.parametrize(
    ("scene", "tol", "model", "reason"),
    [
        (Scene((10, -10)), 1e-9, "closed_form", "at rest without shock: nothing moves"),
        (paired_scene(Scene((10, -10)), 0.05), 1e-6, "closed_form", r"paired precession of amplitude 0\.05: .* r₀⁷"),
        (Scene((10, -10), shock=Shock((0.04, 0, 0), 2.0, 0.05)), 1e-4, "linear", "normal modes; error"),
        (
            Scene((10, -10), shock=SHOCK),
            1e-6,
            "minimal",
            "bar eliminated, six states; the motion is too wide for normal modes",
        ),
        (Scene((10, 0), link=None, shock=SHOCK), 1e-6, "spheres", "regular everywhere; minimal: the scene has no bar"),
    ],
)
def test_reasons(scene: Scene, tol: float, model: str, reason: str) -> None:
    choice = choose(scene, 5.0, tol)
    assert choice.model == model and choice.estimate <= tol
    assert re.search(reason, choice.reason)
    assert simulate(scene, [0, 5.0], tol=tol).why == choice.reason
