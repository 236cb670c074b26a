"""What the derivations hold as printed is what the catalogue's LaTeX says, read by sympy's own parser."""

import re

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
from lagrotor.paper.letters import read
from lagrotor.paper.rotor_pair.own_paper import PAPER

latex = pytest.importorskip("sympy.parsing.latex", reason="sympy's LaTeX parser is missing")
pytest.importorskip("antlr4", reason="sympy's LaTeX parser needs antlr4-python3-runtime: install the extra `test`")

READ = (
    *("5.01", "5.02", "5.03", "5.04", "5.05", "5.07", "5.08", "5.10", "5.11", "5.12", "5.13", "5.15"),
    *("5.20", "5.22", "5.27", "5.28", "6.02"),
)
# Rates are given one Greek letter with a number, which the parser keeps whole.
LETTERS = {"theta": 1, "phi": 2, "psi": 3}
PLAIN = (ROTOR, PAIR, ANSATZ)


def rate_name(angle: str, index: str) -> str:
    return f"xi_{LETTERS[angle]}{index or 0}"


NAMES: dict[str, sp.Expr] = {
    **{s.name: s for s in (*ROTOR.q, *PAIR.q)},
    **{rate_name(*q.name.partition("_")[::2]): v for c in PLAIN for q, v in zip(c.q, c.v, strict=True)},
    **{s.name: s for s in (I1, I3, I, M, R, A, B, M_z, M_3, omega, r0, theta_0, Phi)},
    "a": a_const,
}


# What the parser cannot know of a line: the angle of the correction is the phase of the precession.
MEANT = {"5.20": {ROTOR.q[1]: Phi}}


def reading(source: str) -> list[sp.Expr]:
    """The members of a printed chain of equations as sympy has them."""
    text = re.sub(r"\\(left|right|mathcal)\b", "", source).replace(r"\varphi", r"\phi").replace("{L}", "L")
    text = re.sub(r"\\frac\{\\partial L\}\{\\partial \\dot\{\\\w+\}\}", "", text)
    text = re.sub(r"\\dot\{\\phi\}\s*t", r"\\Phi", text)
    text = re.sub(
        r"\\dot\{\\(\w+)\}(?:_(\d))?", lambda m: rf"\xi_{{{rate_name(m[1], m[2] or '').removeprefix('xi_')}}} ", text
    )
    # A letter before a bracket is a factor, not a function; a dot written out keeps the parser from guessing.
    text = re.sub(r"(?<![\\\w])([IAB]|I_\d|r_0|\\xi_\{\d+\})\s*(?=\()", r"\1 \\cdot ", text)
    text = re.sub(r"\\cos\s*\\theta\s*(?=\()", r"\\cos(\\theta) \\cdot ", text)
    members = []
    for line in re.split(r"\\quad", text):
        parts = [part.strip(" .,;\n") for part in re.split(r"=|\\sim", line)]
        members += [part for part in (parts[1:] if len(parts) > 1 else parts) if part]
    return [named(latex.parse_latex(part)) for part in members]


def named(expression: sp.Expr) -> sp.Expr:
    """Parsed symbols by the glossary's, decimals as the rationals they are written as."""
    table = {s: NAMES[plain(s.name)] for s in expression.free_symbols if plain(s.name) in NAMES}
    return sp.nsimplify(expression.xreplace(table), rational=True)


def plain(name: str) -> str:
    return re.sub(r"[\\{}]", "", name)


def meanings(entry: Equation) -> dict[sp.Expr, sp.Expr]:
    """What the text around an equation says of its letters, as the catalogue has it."""
    found: dict[str, sp.Expr] = {}
    for letter, meaning in entry.letters.items():
        found[letter] = read(meaning, {**PAPER.letters(entry.section).names, **found}, entry.id)
    return {NAMES[letter]: meaning for letter, meaning in found.items() if letter in NAMES}


@pytest.mark.parametrize("identifier", READ)
def test_every_printed_member_is_in_the_catalogue(identifier: str) -> None:
    entry = PAPER.equation(identifier)
    listed = [member for line in PAPER.lines(identifier) for member in line.members]
    for member in reading(entry.latex):
        member = member.subs(MEANT.get(identifier, {})).subs(meanings(entry))
        assert "zero" in [decide_equal(member, other).answer for other in listed], (identifier, member, listed)
        assert all(decide_equal(2 * member, other).answer != "zero" for other in listed)
