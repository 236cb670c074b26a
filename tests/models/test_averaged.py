"""Opposite spins averaged over their swing: the error and its order against exact runs, long runs at once, what is refused."""

import itertools

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, Shock, consistent_scene, simulate
from lagrotor.errors import DomainError, LagrotorError, SingularError
from lagrotor.models import averaged
from lagrotor.models.minimal import MODEL
from lagrotor.models.model import PACE, natural_units
from lagrotor.models.simulate import choose
from lagrotor.numerics import measured_order
from lagrotor.theory import series_orbit
from tests.theory.random_pairs import held, random_pair

UP = ((0.05, 0, 1),) * 2
SHOCKED = Scene((10, -10), link=Link(1, 0.01, 0.1), shock=Shock((4, -1, 0), 0.5, 1 / 20))
BAR = Link(1.2, 0.3, 0.05)


def swinging(size: float, link: Link = BAR, spins: tuple[float, float] = (10, -10)) -> Scene:
    """Leaning parallel axes that swing, twist and turn with a size."""
    return consistent_scene(spins, UP, size * np.array([[6.0, 2, 0], [6, -3, 0]]), Rotor(), link)


def turns(scene: Scene, count: float, n: int = 41) -> np.ndarray:
    """Times over turns of the scene's typical rate, in s."""
    return np.linspace(0, 2 * np.pi * count / PACE / natural_units(scene).rate, n)


def apart(run: object, exact: object) -> np.ndarray:
    return np.asarray(np.linalg.norm(run.axes - exact.axes, axis=-1).max(0))


@pytest.mark.filterwarnings("ignore::lagrotor.errors.LagrotorWarning")
@pytest.mark.parametrize("count", [3, pytest.param(400, marks=pytest.mark.slow)])
def test_the_error_is_bounded(count: int) -> None:
    """Any lean, any bar, swings that are small or not, up to 300 turns."""
    rng, pairs, refused = np.random.default_rng(7), [], 0
    while len(pairs) + refused < count:
        one, size = random_pair(rng, "opposite"), 10 ** rng.uniform(-3, -0.9)
        lean = rng.uniform(-0.6, 0.6) * rng.choice([0, 1])
        axes = np.array([np.sin(lean), 0.2 * rng.uniform(-1, 1), np.cos(lean)]) + size * rng.normal(size=(2, 3))
        rates = size * rng.normal(size=(2, 3)) * abs(one.momenta[0]) / one.rotor.J
        try:
            axes /= np.linalg.norm(axes, axis=1)[:, None]
            scene = consistent_scene(one.spins, axes, rates, one.rotor, one.link)
            t = turns(scene, 10 ** rng.uniform(1, 2.5 if count > 5 else 1.7))
            run = simulate(scene, t, "averaged")
        except LagrotorError:
            refused += 1
            continue
        exact = simulate(scene, t, "minimal", 1e-11)
        off, told = apart(run, exact), run.errors + exact.errors
        worst = int(np.argmax(off / told))
        pairs.append((off[worst], told[worst]))
    held(pairs, refused, count, 0.4)


@pytest.mark.parametrize("through", [4, 6])
def test_the_order(through: int) -> None:
    sizes, off = (0.015, 0.02, 0.03), []
    for size in sizes:
        scene = natural_units(swinging(size, Link(0.8, 0.5, 0.2))).scene
        t = np.linspace(0, 40, 81)
        start = MODEL.start(scene)
        forms = averaged._forms_about(scene, averaged._centre(scene, start), 6)
        states, _ = averaged._states(scene, forms, through, start, t)
        off.append(
            np.linalg.norm(MODEL.observe(scene, states).axes - simulate(scene, t, "minimal", 1e-12).axes, axis=-1).max()
        )
    assert measured_order(sizes, off) == pytest.approx(through, abs=0.1)


def test_long_runs_take_few_evaluations() -> None:
    scene = swinging(0.005)
    t = turns(scene, 10_000, 2_001)
    run = simulate(scene, t, "averaged", 1e-6)
    assert run.error < 1e-6 and run.horizon == np.inf and run.evaluations < 10_000
    assert "averaged over the swing" in run.why
    first = simulate(scene, t[:41], "minimal", 1e-10)
    assert np.linalg.norm(run.axes[:, :41] - first.axes, axis=-1).max() <= run.errors[40] + first.error


@pytest.mark.parametrize(
    ("pair", "r0"),
    [
        (Scene((10, -10), link=Link()), 0.02),
        (Scene((10, -10), link=Link()), 0.05),
        (Scene((10, -10), Rotor(I3=0.8), Link(0.5, 5, 0.2)), 0.01),
    ],
)
def test_a_difference_of_another_kind_hides_no_error(pair: Scene, r0: float) -> None:
    """On the paired precession the orders 2 and 4 differ by the turning about the joint line, 4 and 6 by little."""
    orbit = series_orbit(pair, r0, 21)
    t = turns(orbit.start, 1000, 61)
    run = simulate(orbit.start, t, "averaged", 1e-4)
    assert (
        np.linalg.norm(run.axes - orbit(t), axis=-1).max()
        <= run.error + orbit.error + abs(t[-1]) * orbit.frequency_error
    )
    assert run.error < 1e-4
    # Twin: by the last two differences alone it would be told to be less.
    units = natural_units(orbit.start)
    begin, grid = MODEL.start(units.scene), t * units.rate
    forms = averaged._forms_about(units.scene, averaged._centre(units.scene, begin), 6)
    seen = [MODEL.observe(units.scene, averaged._states(units.scene, forms, n, begin, grid)[0]).axes for n in (2, 4, 6)]
    before, last = (np.linalg.norm(two - one, axis=-1).max() for one, two in itertools.pairwise(seen))
    off = np.linalg.norm(seen[-1] - orbit(t), axis=-1).max()
    assert averaged.FALLING.value * last**2 / before < off / 3
    if pair.link and pair.link.mass:  # nor does the motion's square beside the last difference hold it
        square = np.abs(averaged._normal_start(units.scene, forms, 6, begin)).max() ** 2
        assert averaged.FALLING.value * square * last < off < averaged.FALLING.value * square**2 * before


def test_auto_takes_it_for_long_runs() -> None:
    scene = swinging(0.01)
    short, long = (choose(scene, turns(scene, count)[-1], 1e-6) for count in (30, 1_000))
    assert short.model != "averaged" and long.model == "averaged"
    assert choose(swinging(0.15), turns(scene, 1_000)[-1], 1e-9).model == "minimal"
    run = simulate(scene, turns(scene, 1_000), tol=1e-6)
    assert run.model == "averaged" and run.error < 1e-6
    # The fast extra integrates the same run in less time than the normal form takes.
    scene = swinging(0.003)
    fast = [choose(scene, turns(scene, count)[-1], 1e-6, "fast").model for count in (1_000, 20_000)]
    assert fast == ["minimal", "averaged"]


@pytest.mark.parametrize(
    ("size", "count", "tol", "orders", "left_out"),
    [
        (0.06, 1_000, 1e-6, {2}, (6, 8)),
        (0.02, 1_000, 1e-6, {2, 8}, (6,)),
        (0.002, 1_000, 1e-9, {2, 6}, ()),
        (1e-4, 20_000, 1e-9, set(), (6,)),  # the rounding of so many turns exceeds the tolerance
    ],
)
def test_no_form_is_derived_that_cannot_keep_the_tolerance(
    monkeypatch: pytest.MonkeyPatch, size: float, count: int, tol: float, orders: set[int], left_out: tuple[int, ...]
) -> None:
    """An order is derived only if it may suffice, and one that was left out would not have kept the tolerance."""
    derive, derived = averaged._forms, set[int]()
    monkeypatch.setattr(averaged, "_forms", lambda *a: (derived.add(a[-1]), derive(*a))[1])
    scene = swinging(size)
    end = float(turns(scene, count)[-1])
    model = choose(scene, end, tol).model
    assert derived == orders and (model == "averaged") == (max(orders, default=0) > 2)
    for order in left_out:
        monkeypatch.setattr(averaged, "_ORDERS", (order,))
        assert averaged.averaged_motion(scene, end, tol, best=True).error > tol


# The modes about its start put the centre of the fast one on the joint line.
ALONG = np.array([-0.6, 0.0, 0.8])
FAST = consistent_scene(
    (1e-3, -1e-3), [ALONG, ALONG], [[0, 0.3, 0], [0, -0.2, 0.1]], Rotor(1e-3, 1, 1e-3, 1e-3), Link(0.56, 6.3, 0.0)
)


@pytest.mark.parametrize(
    ("scene", "end", "message"),
    [
        (swinging(0.01, spins=(10, -9)), 1.0, "are not opposite"),
        (Scene((10, -10), link=None), 1.0, "no bar"),
        (swinging(0.5), 300.0, "no small motion|moves far"),
        (FAST, 300.0, "no small motion"),
        (SHOCKED, 0.5, "ends within the pulse"),
    ],
)
def test_what_it_does_not_hold_is_refused(scene: Scene, end: float, message: str) -> None:
    with pytest.raises((DomainError, SingularError), match=message):
        simulate(scene, [0.0, end], "averaged")
