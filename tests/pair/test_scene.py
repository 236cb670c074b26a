"""The scene at the door: what is refused, with which words, and the quantities read off what is let in."""

from collections.abc import Callable
from math import cos, inf, nan, pi, sin, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from lagrotor import Link, Rotor, Scene, Shock
from lagrotor.errors import InputError

UP = ((0, 0, 1), (0, 0, 1))
TILTED = ((sin(0.3), 0, cos(0.3)), (sin(0.3), 0, cos(0.3)))


def scene(**changed: Any) -> Scene:
    return Scene(**({"spins": (10, -10)} | changed))


def shock(**changed: Any) -> Shock:
    return Shock(**({"force": (40, -11, 0), "at": 2, "width": 0.05} | changed))


# What is built, what of the value the message repeats, what it says to do.
REFUSED: dict[str, tuple[Callable[[], object], str, str]] = {
    "no mass": (lambda: Rotor(mass=0), "mass = 0 kg", "greater than zero"),
    "no I1": (lambda: Rotor(I1=0), "I1 = 0 kg m²", "greater than zero"),
    "negative I3": (lambda: Rotor(I3=-0.5), "I3 = -0.5 kg m²", "greater than zero"),
    "flatter than a disc": (lambda: Rotor(I1=1, I3=2.001), "I3 = 2.001 exceeds 2 I1 = 2", "raise I1 or lower I3"),
    "NaN": (lambda: Rotor(mass=nan), "mass = nan", "give it in kg"),
    "infinite": (lambda: Rotor(I1=inf), "I1 = inf", "give it in kg m²"),
    "beyond doubles": (lambda: Rotor(mass=10**400), "mass = 1000", "give it in kg"),
    "word": (lambda: Rotor(length="long"), "length = 'long'", "give it in m"),
    "bar of negative mass": (lambda: Link(mass=-0.01), "mass = -0.01 kg", "must not be negative"),
    "bar of negative inertia": (lambda: Link(mass=1, inertia=-1), "inertia = -1", "must not be negative"),
    "turning without mass": (lambda: Link(inertia=0.1), "inertia = 0.1 kg m² with mass = 0", "give the bar a mass"),
    "flat force": (lambda: shock(force=(1, 2)), "force = (1, 2)", "3 numbers in N"),
    "infinite force": (lambda: shock(force=(0, inf, 0)), "force[1] = inf", "give it in N"),
    "late beyond time": (lambda: shock(at=inf), "at = inf", "give it in s"),
    "no width": (lambda: shock(width=0), "width = 0 s", "greater than zero"),
    "third rotor": (lambda: shock(body=3), "body = 3", "1 (left rotor) or 2 (right rotor)"),
    "true rotor": (lambda: shock(body=True), "body = True", "1 (left rotor) or 2 (right rotor)"),
    "named rotor": (lambda: shock(body="1"), "body = '1'", "1 (left rotor) or 2 (right rotor)"),
    "one spin": (lambda: scene(spins=(10,)), "spins = (10,)", "2 numbers in rad/s"),
    "NaN spin": (lambda: scene(spins=(1, nan)), "spins[1] = nan", "give it in rad/s"),
    "spin whose square overflows": (lambda: scene(spins=(1e200, 1)), "spins[0] = 1e+200", "change the units"),
    "spin whose square vanishes": (lambda: scene(spins=(1, -1e-200)), "spins[1] = -1e-200", "change the units"),
    "mass whose square vanishes": (lambda: Rotor(mass=1e-99), "mass = 1e-99", "change the units"),
    "not a rotor": (lambda: scene(rotor=1.0), "rotor = 1.0", "must be a Rotor"),
    "not a bar": (lambda: scene(link=1.0), "link = 1.0", "must be a Link"),
    "not a shock": (lambda: scene(shock=(1, 0, 0)), "shock = (1, 0, 0)", "must be a Shock"),
    "one axis": (lambda: scene(axes=((0, 0, 1),)), "axes = ((0, 0, 1),)", "two vectors, one for each rotor"),
    "axis in the plane": (lambda: scene(axes=((0, 1), (0, 0, 1))), "axes[0] = (0, 1)", "3 numbers"),
    "axis of NaN": (lambda: scene(axes=((0, 0, nan), (0, 0, 1))), "axes[0][2] = nan", "give it in 1"),
    "long axis": (lambda: scene(axes=((0, 0, 1), (0, 0, 1.1))), "axes[1] has length 1.1", "divide it by its length"),
    "rate along the axis": (lambda: scene(rates=((0, 0, 0.5), (0, 0, 0))), "r . r' = 0.5", "subtract (r . r') r"),
    "bar out of reach": (lambda: scene(axes=(UP[0], TILTED[1])), "ell = 1", "change an axis or the bar"),
    "bar stretched": (
        lambda: scene(rates=((0, 0, 0), (0.5, 0, 0))), "at 0.5 m/s", "make them tangent to its constraint"
    ),
    "axes on the joint line": (
        lambda: scene(axes=((1, 0, 0), (1, 0, 0))), "axes = ((1.0, 0.0, 0.0), (1.0, 0.0, 0.0))", "tilt an axis"
    ),
}  # fmt: skip


@pytest.mark.parametrize(("build", "value", "way_out"), REFUSED.values(), ids=REFUSED.keys())
def test_what_makes_no_sense_is_refused_by_value_and_way_out(
    build: Callable[[], object], value: str, way_out: str
) -> None:
    with pytest.raises(InputError) as refusal:
        build()
    assert value in str(refusal.value)
    assert way_out in str(refusal.value)


# The twins: as near to the refused as sense allows.
@pytest.mark.parametrize(
    "build",
    [
        lambda: Rotor(I1=1, I3=2),
        lambda: Link(mass=0, inertia=0),
        lambda: Link(mass=0.01, inertia=0.1),
        lambda: shock(body=2, width=1e-9, at=-1),
        lambda: scene(spins=np.array([1, -1]), axes=np.array(TILTED), rates=np.zeros((2, 3))),
        lambda: scene(link=None, axes=(UP[0], TILTED[1]), rates=((0, 0, 0), (0, 0.5, 0))),
        lambda: scene(rates=((0.5, 1, 0), (0.5, -1, 0))),
        lambda: scene(axes=((1, 0, 0), (1, 0, 0)), link=None),
    ],
)
def test_the_edge_of_sense_is_let_in(build: Callable[[], object]) -> None:
    assert isinstance(build(), Rotor | Link | Shock | Scene)


def test_a_state_off_its_constraints_by_rounding_is_let_in_but_not_by_more() -> None:
    def tipped(angle: float) -> tuple[tuple[float, float, float], ...]:
        return (0, 0, 1), (sin(angle), 0, cos(angle))

    scene(axes=tipped(1e-10))
    with pytest.raises(InputError, match="the bar cannot reach"):
        scene(axes=tipped(1e-8))
    scene(rates=((0, 0, 1e-10), (0, 0, 0)))
    with pytest.raises(InputError, match="not tangent"):
        scene(rates=((0, 0, 1e-8), (0, 0, 0)))


def test_numbers_are_kept_as_floats_and_the_scene_is_frozen_and_hashable() -> None:
    made = scene(spins=[10, np.int64(-10)], shock=shock(force=[1, 2, 3]), axes=[list(r) for r in UP])
    assert made.spins == (10.0, -10.0)
    assert all(type(x) is float for x in (*made.spins, *made.axes[0], *made.shock.force, Rotor(mass=2).mass))
    assert hash(made) == hash(scene(shock=shock(force=(1, 2, 3))))
    with pytest.raises(AttributeError):
        made.spins = (1, 1)  # type: ignore[misc]


size = st.floats(0.2, 3)


@given(size, size, size)
def test_transverse_inertia_is_steiners(mass: float, length: float, I1: float) -> None:
    rotor = Rotor(mass, length, I1, I1)
    assert pytest.approx(I1 + mass * (length / 2) ** 2) == rotor.J
    assert pytest.approx(I1 + mass * length**2, rel=1e-3) != rotor.J


@given(size, st.floats(-100, 100), size)
def test_the_impulse_is_the_force_integrated(width: float, force: float, at: float) -> None:
    pulse = Shock((force, -2 * force, 0.5), at, width)
    area = quad(lambda t: np.exp(-(((t - at) / width) ** 2)), at - 8 * width, at + 8 * width, epsabs=1e-12)[0]
    assert pulse.impulse == pytest.approx((force * area, -2 * force * area, 0.5 * area))
    # Twin: the area of a normal density of standard deviation `width` is another one.
    assert pulse.impulse[2] != pytest.approx(0.5 * width * sqrt(2 * pi))


@settings(deadline=None)
@given(size, size, st.floats(0.1, 2), st.floats(0, 2), st.lists(st.floats(-2, 2), min_size=6, max_size=6))
def test_inertias_hold_the_rotors_and_the_rigid_bar(
    R: float, ell: float, m: float, K: float, rates: list[float]
) -> None:
    """Energy of the bar from its tips' velocities at parallel axes, where any two rates alike along x are possible."""
    rotor = Rotor(mass=1.3, length=R, I1=0.7, I3=0.9)
    v1, v2 = np.array([rates[0], rates[1], 0]), np.array([rates[0], rates[2], 0])
    a, b = scene(rotor=rotor, link=Link(ell, m, K)).inertias
    centre, turning = R * (v1 + v2) / 2, np.cross([ell, 0, 0], R * (v2 - v1)) / ell**2
    tilting = rotor.J / 2 * (v1 @ v1 + v2 @ v2)
    expected = tilting + m / 2 * centre @ centre + K / 2 * turning @ turning
    assert a / 2 * (v1 @ v1 + v2 @ v2) + b * v1 @ v2 == pytest.approx(expected)


def test_the_bar_couples_by_mass_and_uncouples_by_turning() -> None:
    assert scene(link=None).inertias == (1.25, 0)
    assert scene(link=Link(1, 0, 0)).inertias == (1.25, 0)
    assert scene(link=Link(1, 4, 0)).inertias == (2.25, 1)
    assert scene(link=Link(2, 4, 4)).inertias == (1.25 + 1 + 1, 0)
    assert scene(link=Link(1, 4, 3)).inertias == (1.25 + 1 + 3, -2)


def test_the_shocked_rotor_is_kept_as_an_integer() -> None:
    """1.0 equals 1, yet indexes nothing."""
    assert type(shock(body=1.0).body) is int
    assert type(shock(body=np.int64(2)).body) is int


def test_a_scene_is_shown_with_its_numbers() -> None:
    html = scene(link=Link(1.5, 0.01, 0.1), shock=shock())._repr_html_()
    assert "10, −10" in html
    assert "1.5 m, 0.01 kg, 0.1 kg m²" in html
    assert "(40, −11, 0) N on rotor 1, 2 ± 0.05 s" in html
    assert "r₁&#x27;" in html, "text is escaped"
    assert "upright" in html and "at rest" in html
    tilted = Scene((10, -10), axes=((0.6, -0.0, 0.8),) * 2)
    assert "(0.6, 0, 0.8), (0.6, 0, 0.8)" in str(tilted)
    bare = scene(link=None)._repr_html_()
    assert all(f"<th>{name}</th><td>none</td>" in bare for name in ("bar", "shock"))
