"""Starts that satisfy the bar: what is given is kept, what is left out has its default, and the nearest start is found."""

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, Shock, consistent_scene
from lagrotor.errors import ConstraintError, InputError, SingularError
from lagrotor.mechanics import constraints

AXES, RATES = [[0.3, 0.2, 0.9], [0.1, -0.3, 0.9]], [[0.1, 0.5, 0.0], [0.0, 0.1, 0.2]]
ROTOR, BAR = Rotor(mass=2.0, length=0.6, I1=0.3, I3=0.1), Link(length=0.9, mass=0.5, inertia=0.04)


def test_what_is_given_is_kept_and_the_rest_has_its_default() -> None:
    shock = Shock((1.0, 0.0, 0.0), 1.0, 0.1)
    whole, bare = consistent_scene((3, 4), AXES, RATES, ROTOR, BAR, shock), consistent_scene((3, 4), AXES)
    assert (whole.spins, whole.rotor, whole.link, whole.shock) == ((3, 4), ROTOR, BAR, shock)
    assert (bare.rotor, bare.link, bare.shock) == (Rotor(), Link(), None)
    assert bare.rates == ((0, 0, 0), (0, 0, 0))


@pytest.mark.parametrize(("rotor", "link"), [(None, None), (ROTOR, BAR), (ROTOR, None), (None, BAR)])
def test_the_start_is_on_the_bar_and_near_what_was_given(rotor: Rotor | None, link: Link | None) -> None:
    scene = consistent_scene((3, 4), AXES, RATES, rotor, link)
    k = (link or Link()).length / (rotor or Rotor()).length
    (r1, r2), (v1, v2) = np.array(scene.axes), np.array(scene.rates)
    span = np.array([k, 0, 0]) + r2 - r1
    assert [r1 @ r1, r2 @ r2, span @ span] == pytest.approx([1, 1, k * k], abs=1e-12)
    assert [r1 @ v1, r2 @ v2, span @ (v2 - v1)] == pytest.approx([0, 0, 0], abs=1e-12)
    assert np.abs(np.array(scene.axes) - AXES).max() < 0.3


def test_the_rates_are_the_nearest_in_the_mass_metric() -> None:
    """M (v - v_given) has no component along an allowed velocity; with another bar's masses it has one."""
    scene = consistent_scene((3, 4), AXES, RATES, ROTOR, BAR)
    (r1, r2), zero = np.array(scene.axes), np.zeros(3)
    span = np.array([BAR.length / ROTOR.length, 0, 0]) + r2 - r1
    rows = np.array([[*r1, *zero], [*zero, *r2], [*-span, *span]])
    allowed = np.linalg.svd(rows)[2][3:]

    def along(a: float, b: float) -> float:
        change = np.ravel(scene.rates) - np.ravel(RATES)
        return float(np.abs(allowed @ np.kron([[a, b], [b, a]], np.eye(3)) @ change).max())

    assert along(*scene.inertias) < 1e-12 < 1e-3 < along(*Scene((1, 1)).inertias)


@pytest.mark.parametrize("rates", [[[1, 2], [3, 4]], "fast", [[np.nan, 0, 0], [0, 0, 0]]])
def test_other_shapes_and_numbers_are_refused(rates: object) -> None:
    with pytest.raises(InputError, match="consistent_scene: axes"):
        consistent_scene((3, 4), AXES, rates)  # type: ignore[arg-type]
    with pytest.raises(SingularError, match="dependent"):
        consistent_scene((3, 4), ((0, 0, 0), (0, 0, 0)))


def beside_the_dead_point(rng: np.random.Generator) -> list[list[float]]:
    """Two axes within 10⁻³ of e_x, where the rows of the constraints are nearly dependent."""
    return [[1.0, *(10 ** rng.uniform(-4.5, -3) * rng.normal(size=2))] for _ in range(2)]


def test_a_residual_of_rounding_refuses_no_start(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(3)
    starts = [beside_the_dead_point(rng) for _ in range(60)]
    for axes in starts:
        r1, r2 = np.array(consistent_scene((3, 4), axes).axes)
        assert np.abs([r1 @ r1 - 1, r2 @ r2 - 1, 1 + (r2 - r1)[0] - r1 @ r2]).max() < 1e-15
    # Twin: held to 10⁻¹⁴ in the axes whatever rounding leaves, some of them are refused.
    monkeypatch.setattr(constraints, "_ROUNDING", 0.0)
    refused = 0
    for axes in starts:
        try:
            consistent_scene((3, 4), axes)
        except ConstraintError:
            refused += 1
    assert refused > 0
