"""Premises: what is assumed when an equation is judged, in words, as a substitution, and whether the paper's scene keeps it."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

import sympy as sp

from lagrotor.pair.lagrangians import INERTIAS, J_OF
from lagrotor.pair.symbols import I1, I3, J, K, M, R, a, b, ell, m, omega, omega_1, omega_2, sigma

# The paper's own rotor and bar (section 4.1), SI units, and the lighter bar of section 5.2.1.
PAPERS_OWN: Mapping[sp.Symbol, sp.Expr] = {I1: 1, I3: 1, M: 1, R: 1, ell: 1, m: 1, K: 1}
LIGHT_BAR: Mapping[sp.Symbol, sp.Expr] = {m: sp.Rational(1, 100), K: sp.Rational(1, 10)}


@dataclass(frozen=True)
class Premise:
    """What is assumed. says: in a physicist's words. put: the substitution that states it, made on both sides at once.

    small: for an approximation, the quantity in which only the leading terms are kept; `put` then brings it in.
    broken: how far the paper's own scene is from it, in words; empty where the scene keeps it.
    """

    says: str
    put: Mapping[sp.Basic, Any] = field(default_factory=dict)
    small: sp.Symbol | None = None
    broken: str = ""

    @property
    def sentence(self) -> str:
        """What is assumed, and by how much the paper's own scene breaks it."""
        return f"{self.says} (broken by the paper's own scene: {self.broken})" if self.broken else self.says

    def on(self, side: Any) -> Any:
        """A side with the premise put in."""
        if all(isinstance(old, sp.Symbol) for old in self.put):
            return side.xreplace({old: sp.sympify(new) for old, new in self.put.items()})
        return side.subs(list(self.put.items()), simultaneous=True)


def parameter_premise(
    says: str, put: Mapping[sp.Symbol, sp.Expr], own: Mapping[sp.Symbol, Any] = PAPERS_OWN
) -> Premise:
    """A premise about parameters, such as J = I_3: how far the paper's own values break it is computed from them."""
    off = []
    for left, right in put.items():
        sides = [(side, in_parameters(sp.sympify(side)).subs(own)) for side in (left, right)]
        (_, here), (_, there) = sides
        if here.is_number and there.is_number and here != there:
            off += [f"{sp.pretty(side)} = {float(value):g}" for side, value in sides if side != value]
    return Premise(says, put, broken=", ".join(off))


def massless_bar() -> Premise:
    """The bar has no mass and no inertia: a = J, b = 0, sigma = 1."""
    own = ", ".join(f"{sp.pretty(s)} = {float(PAPERS_OWN[s]):g} or {float(LIGHT_BAR[s]):g}" for s in (m, K))
    return Premise("the bar is massless, m = K = 0", {a: J, b: 0, sigma: 1, m: 0, K: 0}, broken=own)


def in_parameters(expression: Any) -> Any:
    """The expression in the rotor's and the bar's own parameters: a, b, k, J by what they are."""
    return expression.subs(INERTIAS, simultaneous=True).subs(J, J_OF)


def subsets(premises: tuple[Premise, ...]) -> Iterator[tuple[Premise, ...]]:
    """Every choice of premises, fewest first: the first under which an equation holds is what it needs."""
    for size in range(len(premises) + 1):
        yield from combinations(premises, size)


# Premises that several derivations share. Where more than one is offered, they are put in in this order.
ABOUT_JOINT = parameter_premise("I₁ is read as the transverse inertia about the ground joint, I₁ = J", {I1: J})
MASSLESS_BAR = massless_bar()
EQUAL_INERTIAS = parameter_premise("the inertias about the ground joint are equal, J = I₃", {J: I3})
BAR_AS_LONG_AS_ROTORS = parameter_premise("the bar is as long as the rotors, ℓ = R", {ell: R})
UNIT_LENGTH = parameter_premise("lengths are measured in units of the rotor's, R = 1", {R: 1})
PAPERS_ROTOR = parameter_premise(
    "the rotor is the paper's, I₁ = I₃ = M = R = ℓ = 1", {I1: 1, I3: 1, M: 1, R: 1, ell: 1}
)
ONE_KILOGRAM_BAR = parameter_premise("the bar has a mass of 1 kg", {m: 1})
HEAVY_BAR = parameter_premise("the bar is that of section 4.1, m = K = 1", {m: 1, K: 1})
LIGHT_BAR_PREMISE = Premise("the bar is that of section 5.2.1, m = 0.01, K = 0.1", LIGHT_BAR)
EQUAL_SPINS = Premise("the spins are equal, ω₁ = ω₂ = ω", {omega_1: omega, omega_2: omega})
OPPOSITE_SPINS = Premise("the spins are opposite, ω₁ = −ω₂ = ω", {omega_1: omega, omega_2: -omega})
# What sections 5.2 and 6 call a mode (6.01 and claim C24): 1 where a motion of this kind counts as one, 0 where not.
TURNING_COUNTS, RESTING_COUNTS = sp.symbols("turning_counts resting_counts", real=True)
TWO_MODES = Premise(
    "to first order in the motion; toppling counts as a mode though it is a steady turning, not an oscillation, and the "
    "displacement of the precession centre, which rests, does not",
    {TURNING_COUNTS: 1, RESTING_COUNTS: 0},
)
