"""Premises that several derivations share. Each says by how much the paper's own rotor and bar violate it."""

from collections.abc import Mapping
from typing import Any

import sympy as sp

from lagrotor.pair.notation import I1, I3, J, K, M, R, a, b, ell, m, omega, omega_1, omega_2, sigma
from lagrotor.paper.premises import Premise, parameter_premise, with_meanings
from lagrotor.paper.rotor_pair.symbols import WRITTEN_OUT

# The paper's own rotor and bar (section 4.1), SI units, and the lighter bar of section 5.2.1.
PAPERS_OWN: Mapping[sp.Symbol, sp.Expr] = {I1: 1, I3: 1, M: 1, R: 1, ell: 1, m: 1, K: 1}
LIGHT_BAR: Mapping[sp.Symbol, sp.Expr] = {m: sp.Rational(1, 100), K: sp.Rational(1, 10)}


def in_parameters(expression: Any) -> Any:
    """Replace a, b, k and J by their expressions in the parameters of the rotor and the bar."""
    return with_meanings(expression, WRITTEN_OUT)


def about_parameters(says: str, substitution: Mapping[sp.Symbol, Any]) -> Premise:
    """Return a premise about parameters, such as J = I_3, with the paper's own values if these violate it."""
    return parameter_premise(says, substitution, PAPERS_OWN, WRITTEN_OUT)


def massless_bar() -> Premise:
    """Return the premise that the bar has neither mass nor inertia, so that a = J, b = 0 and sigma = 1."""
    values = ", ".join(f"{sp.pretty(s)} = {float(PAPERS_OWN[s]):g} or {float(LIGHT_BAR[s]):g}" for s in (m, K))
    return Premise("the bar is massless, m = K = 0", {a: J, b: 0, sigma: 1, m: 0, K: 0}, broken=values)


# Several premises of one equation are substituted in this order.
ABOUT_JOINT = about_parameters("I₁ is read as the transverse inertia about the ground joint, I₁ = J", {I1: J})
MASSLESS_BAR = massless_bar()
EQUAL_INERTIAS = about_parameters("the inertias about the ground joint are equal, J = I₃", {J: I3})
BAR_AS_LONG_AS_ROTORS = about_parameters("the bar is as long as the rotors, ℓ = R", {ell: R})
UNIT_LENGTH = about_parameters("lengths are measured in units of the rotor's, R = 1", {R: 1})
PAPERS_ROTOR = about_parameters("the rotor is the paper's, I₁ = I₃ = M = R = ℓ = 1", {I1: 1, I3: 1, M: 1, R: 1, ell: 1})
ONE_KILOGRAM_BAR = about_parameters("the bar has a mass of 1 kg", {m: 1})
HEAVY_BAR = about_parameters("the bar is that of section 4.1, m = K = 1", {m: 1, K: 1})
LIGHT_BAR_PREMISE = Premise("the bar is that of section 5.2.1, m = 0.01, K = 0.1", LIGHT_BAR)
EQUAL_SPINS = Premise("the spins are equal, ω₁ = ω₂ = ω", {omega_1: omega, omega_2: omega})
OPPOSITE_SPINS = Premise("the spins are opposite, ω₁ = −ω₂ = ω", {omega_1: omega, omega_2: -omega})
# Section 5.2 counts two modes (claim C24), while the conclusion speaks of oscillations, of which there is one (6.01).
TWO_MODES = (
    "to first order in the motion; toppling counts as a mode though it is a steady turning, not an oscillation, and the "
    "displacement of the precession centre, which rests, does not"
)
