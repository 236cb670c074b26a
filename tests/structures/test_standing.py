"""Which structures stand: theorems, closed forms, and the exact motion 3 % under and over each threshold."""

from dataclasses import replace
from math import inf, sqrt

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy.core.random import seed

from lagrotor import Brace, Link, Rotor, Structure
from lagrotor.errors import InputError
from lagrotor.structures import bounded_motion, measured_growth
from lagrotor.structures.coefficients import coefficients
from lagrotor.structures.small_motion import SmallMotion, small_motion

WEIGHT = {"gravity": 9.81, "load": 2.0}
PAIR = {"joints": [(0, 0), (1, 0)], "bars": [(0, 1)]}
CORNER = {"joints": [(0, 0), (1, 0), (1, 1)], "bars": [(0, 1), (1, 2)], **WEIGHT}
SQUARE = {"joints": [(0, 0), (1, 0), (1, 1), (0, 1)], "bars": [(0, 1), (1, 2), (2, 3), (3, 0)], **WEIGHT}
HEXAGON = {
    "joints": [(np.cos(k * np.pi / 3), np.sin(k * np.pi / 3)) for k in range(6)],
    "bars": [(k, (k + 1) % 6) for k in range(6)],
    **WEIGHT,
}


def grid(L: int) -> dict:
    bars = [(i, i + 1) for i in range(L * L) if i % L < L - 1] + [(i, i + L) for i in range(L * L - L)]
    return {"joints": [(i % L, i // L) for i in range(L * L)], "bars": bars, **WEIGHT}


def exact_roots(linear: SmallMotion) -> list[complex]:
    """The roots of det(M s² + (D + G) s + K) with 40 digits, of the matrices as exact rationals."""
    z = sp.Symbol("z")
    M, C, K = (
        sp.Matrix(each.shape[0], each.shape[1], [sp.Rational(float(x)) for x in each.ravel()])
        for each in (linear.mass, linear.damping + linear.gyroscopic, linear.stiffness)
    )
    return [
        complex(root) for root in sp.Poly((M * z**2 + C * z + K).det(method="berkowitz"), z).nroots(n=40, maxsteps=500)
    ]


def natural(s: Structure) -> float:
    """sqrt(a κ) over I3 of equal rotors and loads under massless bars."""
    c = coefficients(s)
    return float(np.sqrt(c.A[0] * c.gravity * c.S[0]) / s.rotor[0].I3)


bounded = st.floats(-40, 40).filter(lambda x: abs(x) > 0.1)


@settings(max_examples=20, deadline=None)
@given(st.tuples(bounded, bounded), st.sampled_from([Link(1, 0, 0), Link(1, 1, 1), Link(1, 0.3, 0.1)]), st.floats(0, 5))
def test_no_loaded_pair_stands(spins, link, load) -> None:
    found = Structure(**PAIR, spins=spins, link=link, gravity=9.81, load=load).stands()
    assert not found and found.critical_spin == inf and "odd number" in found.why


@pytest.mark.parametrize(
    ("shape", "spins", "factor"),
    [
        ({"joints": [(0, 0)], **WEIGHT}, [1], 2),
        (CORNER, [1, 0, 1], 2 * sqrt(2)),
        (SQUARE, [-1, 1, 1, 1], 2 * sqrt(2)),
        (SQUARE, [1, 1, 1, 1], inf),
        (SQUARE, [1, -1, 1, -1], inf),
        (grid(3), [-1, 1, 1, 1, -1, 1, 1, 1, -1], 6),
        (grid(3), [-0.5, 1, 1, 1, -0.5, 1, 1, 1, -0.5], 4),
        (grid(3), [1] * 9, inf),
        (HEXAGON, [1, -1] * 3, 2 * sqrt(5)),
        (SQUARE | {"bars": [*SQUARE["bars"], (0, 2)]}, [1e3] * 4, inf),  # a rigid plate
        ({"joints": [(k, 0) for k in range(4)], "bars": [(0, 1), (1, 2), (2, 3)], **WEIGHT}, [1, 2, 3, 4], inf),
    ],
)
def test_the_least_spin_in_closed_form(shape, spins, factor) -> None:
    s = Structure(**shape, spins=spins)
    assert s.critical_spin() == pytest.approx(factor * natural(s), rel=1e-9)


@pytest.mark.parametrize(
    ("shape", "spins", "more"),
    [
        (CORNER, [1, 0, 1], {}),
        (CORNER | {"load": [0, 50, 0]}, [30, 0, 30], {"link": Link(mass=0.3, inertia=0.1)}),
        pytest.param(PAIR | WEIGHT, [30, 30], {"braces": [Brace(0, (0.0, 1.0, 1.0), 200.0)]}, marks=pytest.mark.slow),
        pytest.param(SQUARE, [-1, 1, 1, 1], {"link": Link(1, 1, 0.1)}, marks=pytest.mark.slow),
        pytest.param(grid(3), [-1, 1, 1, 1, -1, 1, 1, 1, -1], {}, marks=pytest.mark.slow),
    ],
)
def test_the_exact_motion_falls_under_the_threshold_and_stays_over_it(shape, spins, more) -> None:
    factor = Structure(**shape, spins=spins, **more).critical_spin()
    under, over = (Structure(**shape, spins=[x * factor * f for f in spins], **more) for x in (0.97, 1.03))
    assert measured_growth(under) == pytest.approx(under.stands().growth, rel=1e-3)
    assert not under.stands() and over.stands()
    largest, off = bounded_motion(over)
    assert largest < 10 and off < 1e-3


def test_friction_undoes_what_the_spins_hold() -> None:
    spins = [40, 0, 40]
    assert Structure(**CORNER, spins=spins).stands()
    s = Structure(**CORNER, spins=spins, friction=0.5)
    found, c = s.stands(), coefficients(s)
    assert not found and found.critical_spin == inf and "friction undoes" in found.why
    # Each pair of degrees of freedom alone: a s² + (c − i β) s − κ = 0 with β = G/√2.
    a, kappa, beta = c.A[0], c.gravity * c.S[0], 40 / sqrt(2)
    roots = np.roots([a, 0.5 - 1j * beta, -kappa])
    assert found.growth == pytest.approx(roots.real.max(), rel=1e-9)
    assert measured_growth(s, folds=0.2) == pytest.approx(found.growth, rel=1e-3)


@pytest.mark.parametrize("balanced", [False, True])
def test_at_any_fast_spins_what_falls_is_said(balanced: bool) -> None:
    """With friction c each pair falls as c (g S/G)²; also beside a neutral rotor."""
    count = 3 + balanced
    joints, spins = [(0, 0), (1, 0), (2.1, 0.3), (5, 5)][:count], np.array([1, -0.5, 1, 1][:count])
    s = Structure(
        joints, [(0, 1), (1, 2)], spins, tuple(Rotor(length=x) for x in (1, 1.3, 0.8, 1)[:count]), gravity=9.81
    )
    if balanced:
        s = replace(s, hinge=(0, 0, 0, 9.81 * coefficients(s).S[3]))
    least = s.critical_spin()
    for times in (10, 30, 1e2):
        fast = replace(s, spins=tuple(times * least * spins))
        assert fast.stands() and fast.critical_spin() == pytest.approx(1 / times, rel=1e-6)
        rubbed = replace(fast, friction=0.1)
        found = rubbed.stands()
        assert not found and found.kind == "never" and found.critical_spin == inf
        assert found.growth == pytest.approx(max(z.real for z in exact_roots(small_motion(rubbed))), rel=1e-6)
    # What springs hold does not fall, however fast it spins.
    assert replace(fast, friction=0.1, hinge=100.0).stands().kind == "holds"


def test_small_growth_keeps_its_digits_or_is_refused() -> None:
    """A s² + (c − i G) s − w: growth w c/G², decay c/A. Twin: friction whose growth is rounding beside the fast rate."""
    top = Structure([(0, 0)], spins=300.0, gravity=9.81, friction=1e-3)
    c, normal = coefficients(top), top.modes()
    w, G = c.gravity * c.S[0], c.G[0]
    roots = sp.Poly(
        [sp.Rational(float(c.A[0])), sp.Rational(1e-3) - sp.I * sp.Rational(float(G)), -sp.Rational(float(w))],
        sp.Symbol("z"),
    ).nroots(n=40)
    slow, fast = sorted(map(complex, roots), key=abs)
    assert normal.rates == pytest.approx([slow.imag, fast.imag], rel=1e-9)
    assert normal.growth == pytest.approx([slow.real, fast.real], rel=1e-6)
    assert slow.real == pytest.approx(1e-3 * w / G**2, rel=1e-3)
    lost = replace(top, friction=1e-10)
    assert lost.modes().growth.max() == 0 and lost.critical_spin() == inf
    with pytest.raises(InputError, match="so slowly that double precision does not resolve"):
        lost.stands()


def test_rotors_that_nothing_joins_keep_their_rates() -> None:
    """By the hinge h of one √(h/A) and −c/(2 A), by spin G/A; one that nothing holds has the root zero twice. Twin: a hinge so
    soft that it counts for none."""
    rotors = Structure([(0, 0), (3, 0), (6, 0)], spins=[0, 3e3, 0], hinge=[8.0, 0, 0], friction=[1e-3, 0, 0])
    A = coefficients(rotors).A[0]
    normal = rotors.modes()
    assert np.unique(normal.rates) == pytest.approx([0, np.sqrt(8.0 / A), 3e3 / A], rel=1e-6)
    assert np.unique(normal.growth) == pytest.approx([-1e-3 / (2 * A), 0], rel=1e-6)
    assert (normal.rates == 0).sum() == 3 and not rotors.stands()
    assert (replace(rotors, hinge=(8.0, 0, 1e-11)).modes().rates == 0).sum() == 3
    assert (replace(rotors, hinge=(8.0, 0, 1e-3)).modes().rates == 0).sum() == 1


@pytest.mark.parametrize("size", [1e1, 1e2])
def test_at_any_spins_what_no_spins_hold_is_not_said_to_stand(size: float) -> None:
    """An odd number that falls, and a motion along which neither a brace nor another motion acts."""
    brace = Brace(0, (1.4, -0.3, 1.9), 90.0)
    drifting, standing = Structure([(0, 0)], spins=size, braces=[brace]), Structure([(0, 0)], spins=size)
    assert drifting.stands().kind == "never" and small_motion(drifting).drifts and not small_motion(standing).drifts
    odd = replace(drifting, gravity=9.81, braces=[replace(brace, stiffness=60.0)])
    linear = small_motion(odd)
    assert np.linalg.det(linear.stiffness) < 0
    assert odd.stands().growth == pytest.approx(max(z.real for z in exact_roots(linear)), rel=1e-9)


@pytest.mark.parametrize("spin", [2.2e2, 2.2e3])
def test_what_no_friction_reaches_neither_grows_nor_decays(spin: float) -> None:
    """Rotors that nothing joins, one braced to the ground and rubbed; twin: friction on the other, too."""
    rotor, brace = [Rotor(2.4, 1, 2.1, 2.5), Rotor(1.1, 0.74, 0.46, 0.2)], [Brace(1, (0, 3, 1), 335)]
    two = Structure([(0, 0), (1, 0)], spins=[spin, -0.43 * spin], rotor=rotor, friction=[0, 2e3], braces=brace)
    decaying = [(s.modes().growth < 0).sum() for s in (two, replace(two, friction=(1.0, 2e3)))]
    assert decaying[1] == decaying[0] + 1


@pytest.mark.parametrize(
    "given",
    [
        {**PAIR, "spins": [30, 20], **WEIGHT},
        {**PAIR, "spins": [30, 20], "link": Link(1, 0.3, 0.1), **WEIGHT},
        {**PAIR, "spins": [30, 20], **WEIGHT, "friction": 0.1, "braces": [Brace(0, (0.0, 1.0, 1.0), 100.0, 0.3)]},
        {**CORNER, "spins": [10, 5, 10], "load": [0, 50, 0], "link": Link(1, 0.3, 0.1)},
        {**SQUARE, "spins": [1, 2, 3, 4]},
        {"joints": [(0, 0), (1, 1)], "bars": [(0, 1)], "spins": 7, "rotor": [Rotor(), Rotor(length=2)], **WEIGHT},
    ],
)
def test_the_exact_polynomial_has_the_numeric_roots(given) -> None:
    seed(0)  # sympy factors by values drawn at random, and of eight letters some take it minutes
    s = Structure(**given)
    found = s.characteristic()
    polynomial = sp.Poly(found.polynomial.subs(found.values), sp.Symbol("s"))
    roots = np.sort_complex(np.roots([float(c) for c in polynomial.all_coeffs()]))
    numeric = small_motion(s).roots
    for root in roots:
        assert np.abs(numeric - root).min() < 1e-6 * (1 + abs(root))
    assert len(roots) == len(numeric)


@pytest.mark.parametrize("more", [{"spins": 0.0}, {"spins": [30.0, 0.0], "gravity": 9.81, "hinge": [0.0, 9.81 / 2]}])
def test_what_nothing_holds_does_not_stand_at_any_multiple_of_its_spins(more) -> None:
    """A rotor without spin whose hinge only carries its weight; a little spin, and it stands."""
    s = Structure([(0, 0), (1, 0)], **more)
    assert not s.stands() and "nothing holds" in s.stands().why and s.critical_spin() == inf
    assert s.plot().get_suptitle() == "Unstable; no multiple of these spins stabilises it"
    held = replace(s, spins=[30.0, 1.0])
    assert held.stands() and held.critical_spin() < 1 and held.plot().get_suptitle().startswith("Stable")


@pytest.mark.parametrize("times", [3, 30.0])
def test_friction_on_some_axes_lets_what_it_reaches_fall(times: float) -> None:
    """At any spins; where only a spring holds what is rubbed, it stands."""
    s = Structure([(0, 0), (3, 0)], spins=[10.0 * times, 7.0 * times], gravity=9.81, friction=[0.0, 0.01])
    held = replace(s, hinge=[0.0, 50.0])
    assert held.stands() and held.critical_spin() < inf
    assert s.critical_spin() == inf
    assert not s.stands()
