"""What the derivations hold as printed is what the catalogue's LaTeX says, read by the reader of sources."""

import pytest
import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.pair.notation import (
    ANSATZ,
    I1,
    I3,
    M_3,
    PAIR,
    ROTOR,
    A,
    B,
    I,
    M,
    M_z,
    Phi,
    R,
    a_const,
    omega,
    r0,
    theta_0,
)
from lagrotor.paper.catalogue import Equation
from lagrotor.paper.grammar import read
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.notation import Notation, propose, with_proposals
from lagrotor.paper.latex.tree import text_of
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

READ = (
    *("5.01", "5.02", "5.03", "5.04", "5.05", "5.07", "5.08", "5.10", "5.11", "5.12", "5.13", "5.15"),
    *("5.20", "5.22", "5.27", "5.28", "6.02"),
)
# What the parser cannot know of a line: the angle of the correction is the phase of the precession.
MEANT = {"5.20": {ROTOR.q[1]: Phi}}


PLAIN: dict[str, sp.Expr] = {
    **{s.name: s for c in (ROTOR, PAIR, ANSATZ) for s in (*c.q, *c.v)},
    **{s.name: s for s in (I1, I3, I, M, R, A, B, M_z, M_3, omega, r0, theta_0, Phi)},
    **{"a": a_const, "r_0": r0, "I_1": I1, "I_3": I3, "theta_0": theta_0},
    "t": sp.Symbol("t"),
}


NOTATION = with_proposals(Notation(), propose(e.latex for e in PAPER.equations.values() if e.section == "5"))


def reading(entry: Equation) -> list[sp.Expr]:
    """The members of a printed chain of equations in the paper's letters."""
    found = read_formula(entry.latex.replace(r"\varphi", r"\phi"), NOTATION)
    assert found.whole, found.stop
    names = {**PLAIN, **PAPER.letters(entry.section).names}
    sides = [side for statement in found.statements for side in (statement.sides[1:] or statement.sides)]
    members = []
    for text in (text_of(side.node) for side in sides):
        if not text.startswith("Derivative("):  # the quantity again, as it is defined
            members.append(read(text, names, entry.id).subs(names["phi_dot"] * names["t"], Phi))
    return members


def meanings(entry: Equation) -> dict[sp.Expr, sp.Expr]:
    """What the text around an equation says of its letters, as the catalogue has it."""
    found: dict[str, sp.Expr] = {}
    for letter, meaning in entry.letters.items():
        found[letter] = read(meaning, {**PAPER.letters(entry.section).names, **found}, entry.id)
    names = {**PLAIN, **PAPER.letters(entry.section).names}
    return {names[letter]: meaning for letter, meaning in found.items() if isinstance(names.get(letter), sp.Symbol)}


@pytest.mark.parametrize("identifier", READ)
def test_every_printed_member_is_in_the_catalogue(identifier: str) -> None:
    entry = PAPER.equation(identifier)
    listed = [member for line in PAPER.lines(identifier) for member in line.members]
    for member in reading(entry):
        member = member.subs(MEANT.get(identifier, {})).subs(meanings(entry))
        assert "zero" in [decide_equal(member, other).answer for other in listed], (identifier, member, listed)
        assert all(decide_equal(2 * member, other).answer != "zero" for other in listed)
