"""Formulas in LaTeX: a glossary of symbols with meanings and units, expressions with dots over velocities, whole systems."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import sympy as sp
from sympy.printing.latex import LatexPrinter, tex_greek_dictionary
from sympy.printing.pretty.pretty_symbology import greek_unicode

from lagrotor.algebra import derivative
from lagrotor.algebra.enclosures import jet_of
from lagrotor.formula_text import VELOCITY, place_of_factor, with_plus_first
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import jets_of, longer, shortest
from lagrotor.mechanics.lagrangian import Coordinates, t
from lagrotor.mechanics.symmetry import cyclic_coordinates


@dataclass(frozen=True)
class Entry:
    """A row of a glossary: a symbol, its meaning in words, and its unit."""

    symbol: sp.Symbol
    meaning: str
    unit: str


class Glossary(dict[sp.Symbol, Entry]):
    """A glossary {symbol: entry}, in the order in which the symbols are declared."""

    def letter(self, name: str, meaning: str, unit: str, **assumptions: bool) -> sp.Symbol:
        """Declare a symbol.

        Parameters
        ----------
        name, meaning, unit : str
            The name, the meaning in words, and the unit: "kg m^2", "1" for a number.
        **assumptions : bool
            The assumptions of sympy, such as positive=True.

        Returns
        -------
        Symbol
            The symbol.
        """
        symbol = sp.Symbol(name, **assumptions)
        self[symbol] = Entry(symbol, meaning, unit)
        return symbol

    def moving(self, c: Coordinates, *rows: tuple[str, str]) -> Coordinates:
        """Enter coordinates with their velocities and accelerations.

        Parameters
        ----------
        c : Coordinates
            The coordinates.
        *rows : tuple of str
            (meaning, unit) of each coordinate, in their order.

        Returns
        -------
        Coordinates
            The same coordinates.
        """
        for q, v, acc, (meaning, unit) in zip(c.q, c.v, c.a, rows, strict=True):
            self[q] = Entry(q, meaning, unit)
            self[v] = Entry(v, f"rate of {q.name}", f"{unit}/s")
            self[acc] = Entry(acc, f"acceleration of {q.name}", f"{unit}/s²")
        return c

    def meaning(self, symbol: sp.Symbol) -> str:
        """Return the meaning of a symbol in a few words.

        Parameters
        ----------
        symbol : Symbol
            A symbol.

        Returns
        -------
        str
            Its meaning; "parameter" if the glossary lacks it.
        """
        return self[symbol].meaning.split(":")[0] if symbol in self else "parameter"


def latex(expression: Any, names: Mapping[sp.Symbol, str] | None = None) -> str:
    r"""Return an expression as LaTeX, in the order in which it is written by hand: m g l \cos\theta.

    Symbols that end in _dot or _ddot get dots; `names` gives LaTeX for chosen symbols.
    """
    free = (s for s in getattr(expression, "free_symbols", ()) if isinstance(s, sp.Symbol))
    symbol_names = {s: letter_latex(s) for s in free} | dict(names or {})
    return light(_Printer({"symbol_names": symbol_names, "order": "none"}).doprint(expression))


class _Printer(LatexPrinter):  # type: ignore[misc]
    """LaTeX with masses and inertias first in a product, then other parameters, velocities, functions and sums; in a sum with a
    term without a minus sign first."""

    def _print_Mul(self, expr: sp.Expr) -> str:
        commutative, others = expr.args_cnc(split_1=False)
        factors = sorted(commutative, key=place_of_factor)
        split = next((i for i, e in enumerate(factors) if place_of_factor(e)[0] >= VELOCITY), len(factors))
        (number, *constants), rest = factors[: max(split, 1)], factors[max(split, 1) :]
        divided = number.is_Rational and number.q > 1 and 0 < len(constants) <= 2 and rest
        if not divided or others or any(e.is_Pow and e.exp.could_extract_minus_sign() for e in factors):
            return super()._print_Mul(sp.Mul(*factors, *others, evaluate=False))
        # A number and constants in a fraction before the rest: I_3/2 (…)².
        top = sp.Mul(*([abs(number.p)] if abs(number.p) > 1 else []), *constants, evaluate=False)
        after = self._print(rest[0]) if len(rest) == 1 else super()._print_Mul(sp.Mul(*rest, evaluate=False))
        after = rf"\left({after}\right)" if len(rest) == 1 and rest[0].is_Add else after
        return rf"{'- ' if number.is_negative else ''}\frac{{{self._print(top)}}}{{{number.q}}} {after}"

    def _as_ordered_terms(self, expr: sp.Expr, order: str | None = None) -> list[sp.Expr]:
        return with_plus_first(expr)


# sin, cos or tan, perhaps to a power, of a single symbol in brackets.
_OF_A_LETTER = re.compile(r"(\\(?:sin|cos|tan)(?:\^\{\d+\})?)\{\\left\((\\?[A-Za-z]+(?:_(?:\{\w+\}|\w))?) ?\\right\)\}")


def light(source: str) -> str:
    r"""Return LaTeX without brackets around a single symbol in sine, cosine and tangent: \cos\theta."""
    return _OF_A_LETTER.sub(r"\1 \2", source)


# Greek letters, and ℓ, as commands of LaTeX.
GREEK = {letter: tex_greek_dictionary.get(name, rf"\{name}") for name, letter in greek_unicode.items()} | {
    "ϑ": r"\vartheta",
    "ℓ": r"\ell",
}
_GREEK = re.compile(f"[{''.join(GREEK)}](?=([A-Za-z{''.join(GREEK)}])?)")
_MARKS = {"\\": r"\backslash ", "^": r"\wedge ", "~": r"\sim ", " ": r"\ "} | {c: rf"\{c}" for c in "&%#$_{}"}
_MARKS |= {letter: f"{command} " for letter, command in GREEK.items()}
_FOREIGN = re.compile(r"[^\x00-\x7f]+")  # characters without a command of LaTeX: é


@cache
def letter_latex(symbol: sp.Symbol) -> str:
    r"""Return LaTeX of one symbol: theta_1_dot is \dot{\theta}_1, d_dotx is \dot{d}_x, α is \alpha."""
    if reaction := re.fullmatch(r"reaction\((.+)\)", symbol.name):
        return multiplier_latex("lambda", reaction[1])
    # A component of a vector of rates, d_dotx or r_1_dotx.
    name = re.sub(r"(_\d+)?_(d?dot)([xyz])$", lambda m: f"{m[1] or '_'}{m[3]}_{m[2]}", symbol.name)
    dotted = re.fullmatch(r"(.+?)_(d?dot)", name)
    source = sp.latex(sp.Symbol(dotted[1]) if dotted else symbol)
    if dotted:
        source = re.sub(r"^(.+?)(_\{.*)?$", rf"\\{dotted[2]}{{\1}}\2", source)
    source = re.sub(r"(?<!\\)[&%#$]", r"\\\g<0>", source)
    source = _GREEK.sub(lambda m: GREEK[m[0]] + " " * (m[1] is not None), source)
    return re.sub(r"_\{(\w)\}$", r"_\1", _FOREIGN.sub(r"\\text{\g<0>}", source))


def multiplier_latex(letter: str, name: str) -> str:
    """Return LaTeX of a multiplier: a letter whose index is the number of its constraint, or its name in upright letters."""
    upright = _FOREIGN.sub(r"\\text{\g<0>}", "".join(_MARKS.get(c, c) for c in name))
    return rf"\{letter}_{{{name}}}" if name.isdigit() else rf"\{letter}_{{\mathrm{{{upright}}}}}"


_DIGITS = 6  # digits of a printed decimal fraction
_MOST_COORDINATES, _MOST_OPERATIONS = 6, 400  # the largest system and formula that are printed


def formulas(system: Equations, most: int = _MOST_OPERATIONS) -> dict[str, list[str]]:
    """Return {heading: lines of LaTeX}: energies, dissipation, equations of motion, constraints, conserved quantities.

    The relation q' = B u + b to quasi-velocities, if short, precedes the Boltzmann–Hamel equations. A formula of more than
    `most` operations is replaced by the number of its operations.
    """
    c = system.c
    if system.bodies and len(c.q) > _MOST_COORDINATES:
        return {"Bodies": [rf"{len(system.bodies)}\ \text{{bodies in {len(c.q)} coordinates}}"]}
    short = not longer(system.L, most)
    relation = system.kinematics if short else None
    velocities = dict(zip(c.v, relation.velocity, strict=True)) if relation and not relation.stages else {}
    rates = tuple(dict.fromkeys((*c.a, *system.speed_rates)))
    multipliers = {
        s: multiplier_latex("Lambda" if str(s).startswith("Lambda") else "lambda", name)
        for s, name in zip(system.multipliers, system.multiplier_names, strict=True)
    }

    def line(side: sp.Expr | str, right: sp.Expr = sp.S.Zero) -> str:
        return " = ".join(e if isinstance(e, str) else _side(e, rates, multipliers, most) for e in (side, right))

    states = [line(rf"\dot{{{letter_latex(x)}}}", f.xreplace(velocities)) for x, f in system.states]
    if not c.q:
        return {"First-order states": states}
    still = system.L.subs(dict.fromkeys(c.v, 0))
    kinetic = sp.expand(system.L - still) if short else system.L - still
    sections = {"Kinetic energy": [line("T", kinetic.xreplace(velocities))], "Potential energy": [line("V", -still)]}
    if system.dissipation != 0:
        sections["Dissipation"] = [line("D", system.dissipation.xreplace(velocities))]
    sections["Equations of motion"] = [line(e) for e in (_in_own_velocities(system) if velocities else system.motion)]
    if velocities:
        sections["Equations of motion"][:0] = [line(latex(v), e) for v, e in velocities.items() if v != e]
    if states:
        sections["First-order states"] = states
    if system.multipliers:
        rolling = enumerate(system.rolling, len(system.constraints))
        # Rows that q' = B u + b satisfies are not repeated.
        rows = [e for i, e in rolling if not (relation and velocities) or i in relation.left]
        sections["Constraints"] = [line(e) for e in (*system.constraints, *rows)]
    closed = not (system.forces or system.dissipation != 0 or t in system.L.free_symbols)
    steady = all(e.subs(dict.fromkeys(c.v, 0)) == 0 for e in system.residual)
    square = short and sp.expand(kinetic.xreplace({v: 2 * v for v in c.v}) - 4 * kinetic) == 0
    integrals = [line("E", "T + V" if square else system.energy.xreplace(velocities))] if closed and steady else []
    if short:
        for q in cyclic_coordinates(system):
            momentum = derivative(system.L, c.v[c.q.index(q)])
            integrals.append(line(rf"p_{{{letter_latex(q)}}}", momentum.xreplace(velocities)))
    return {heading: lines for heading, lines in (sections | {"Conserved": integrals}).items() if lines}


def _in_own_velocities(system: Equations) -> list[sp.Expr]:
    """Return the Boltzmann–Hamel equations. If a speed u is the velocity of a coordinate, its rate has the symbol q''."""
    c = system.c
    named = {rate: c.a[c.v.index(u)] for u, rate in zip(system.speeds, system.speed_rates, strict=True) if u in c.v}
    return [e.xreplace(named) for e in system.hamel]


def in_markdown(system: Equations) -> str:
    """Return the formulas as Markdown for a notebook."""
    return "\n\n".join(
        f"**{heading}**\n\n" + "\n\n".join(f"$${formula}$$" for formula in lines)
        for heading, lines in formulas(system).items()
    )


def in_latex(system: Equations) -> str:
    """Return the equations of motion and the constraints as an `align` of LaTeX: `System.latex`."""
    sections = formulas(system)
    headings = "Equations of motion", "Bodies", "First-order states", "Constraints"
    lines = [line for heading in headings for line in sections.get(heading, [])]
    rows = " \\\\\n".join(line.replace(" = ", " &= ", 1) for line in lines)
    return f"\\begin{{align}}\n{rows}\n\\end{{align}}"


def _side(e: sp.Expr, rates: tuple[sp.Symbol, ...], multipliers: dict[sp.Symbol, str], most: int) -> str:
    """Return LaTeX of one side of a formula, each acceleration before its coefficient."""
    count = sp.count_ops(e)
    if count > most:
        return rf"\text{{{count:,} operations}}"
    e = shortest(e)
    names = {jet: sp.Dummy() for jet in jets_of(e)}
    e = e.xreplace(names)
    terms = [e]
    if accelerated := [a for a in rates if a in e.free_symbols]:
        e = sp.expand(e)
        inertial = [a * e.coeff(a) for a in accelerated]
        remainder = sp.expand(e - sp.Add(*inertial))
        terms = [*(a * shortest(e.coeff(a)) for a in accelerated), remainder]
    names_of = {dummy: _function(jet) for jet, dummy in names.items()} | multipliers
    formulas = [latex(in_decimals(term), names_of) for term in terms if term != 0] or ["0"]
    return formulas[0] + "".join(
        f" {formula}" if formula.startswith("-") else f" + {formula}" for formula in formulas[1:]
    )


def in_decimals(e: sp.Expr) -> sp.Expr:
    """Return an expression with finite decimal fractions, and fractions of long numbers, as decimals of six digits."""
    long = (r for r in e.atoms(sp.Rational) if r.q >= 100 and (10**_DIGITS % r.q == 0 or r.q > 10**_DIGITS))
    return e.xreplace({r: sp.Float(r, _DIGITS) for r in long})


def _function(jet: sp.Expr) -> str:
    """Return LaTeX of a function or a derivative: U'(r), or y with dots for a function of time."""
    jets = jet_of(jet)
    assert jets is not None
    (function, orders), arguments = jets
    letter = letter_latex(sp.Symbol(str(function)))
    inside = ", ".join(latex(a) for a in arguments)
    if len(orders) > 1:
        power = rf"^{{({', '.join(map(str, orders))})}}" if any(orders) else ""
        return rf"{letter}{power}\left({inside}\right)"
    if arguments == (t,) and 0 < orders[0] < 3:
        stem, _, index = letter.partition("_")
        return rf"\{'d' * orders[0]}ot{{{stem}}}{'_' if index else ''}{index}\left({inside}\right)"
    return letter + "'" * orders[0] + rf"\left({inside}\right)"
