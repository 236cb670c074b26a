"""A system as formulas: what a notebook shows of it, and LaTeX for a paper."""

import sympy as sp

from lagrotor.algebra import derivative
from lagrotor.algebra.enclosures import jet_of
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import jets_of, shortest
from lagrotor.mechanics.glossary import latex, letter_latex
from lagrotor.mechanics.lagrangian import Coordinates, t
from lagrotor.mechanics.symmetry import cyclic_coordinates

_MOST_COORDINATES, _MOST_OPERATIONS = 6, 400  # up to which energies of bodies are written out, and a formula is shown


def formulas(system: Equations) -> dict[str, list[str]]:
    """Heading → LaTeX of the kinetic and potential energy, what rubs, the equations of motion, the constraints, and what is
    conserved as far as that is seen at once: Jacobi's integral E, and momenta of cyclic coordinates.

    A formula of more than some hundred operations is only counted.
    """
    c = system.c
    if system.bodies and len(c.q) > _MOST_COORDINATES:
        return {"Bodies": [rf"{len(system.bodies)}\ \text{{bodies in {len(c.q)} coordinates}}"]}
    still = system.L.subs(dict.fromkeys(c.v, 0))
    kinetic = sp.expand(system.L - still) if sp.count_ops(system.L) <= _MOST_OPERATIONS else system.L - still
    parts = {"Kinetic energy": [_equation("T", kinetic, c)], "Potential energy": [_equation("V", -still, c)]}
    if system.dissipation != 0:
        parts["Dissipation"] = [_equation("D", system.dissipation, c)]
    parts["Equations of motion"] = [_equation(e, sp.S.Zero, c) for e in system.motion]
    if system.multipliers:
        parts["Constraints"] = [_equation(e, sp.S.Zero, c) for e in (*system.constraints, *system.rolling)]
    closed = not (system.forces or system.dissipation != 0 or t in system.L.free_symbols)
    steady = all(e.subs(dict.fromkeys(c.v, 0)) == 0 for e in system.residual)
    kept = [_equation("E", system.energy, c)] if closed and steady else []
    if sp.count_ops(system.L) <= _MOST_OPERATIONS:
        for q in cyclic_coordinates(system):
            kept.append(_equation(rf"p_{{{letter_latex(q)}}}", derivative(system.L, c.v[c.q.index(q)]), c))
    return parts | ({"Conserved": kept} if kept else {})


def in_markdown(system: Equations) -> str:
    """What a notebook shows."""
    return "\n\n".join(
        f"**{heading}**\n\n" + "\n\n".join(f"$${formula}$$" for formula in lines)
        for heading, lines in formulas(system).items()
    )


def in_latex(system: Equations) -> str:
    """The equations of motion and the constraints as an `align` of LaTeX, with a number each."""
    parts = formulas(system)
    lines = [*parts.get("Equations of motion", parts.get("Bodies", [])), *parts.get("Constraints", [])]
    rows = " \\\\\n".join(line.replace(" = 0", " &= 0") for line in lines)
    return f"\\begin{{align}}\n{rows}\n\\end{{align}}"


def _equation(left: sp.Expr | str, right: sp.Expr, c: Coordinates) -> str:
    sides = [e if isinstance(e, str) else _side(e, c) for e in (left, right)]
    return " = ".join(sides)


def _side(e: sp.Expr, c: Coordinates) -> str:
    """A formula, the accelerations in front of what they are multiplied with."""
    count = sp.count_ops(e)
    if count > _MOST_OPERATIONS:
        return rf"\text{{{count:,} operations}}"
    e = shortest(e)
    names = {jet: sp.Dummy() for jet in jets_of(e)}
    e = e.xreplace(names)
    terms = [e]
    if accelerated := [a for a in c.a if a in e.free_symbols]:
        e = sp.expand(e)
        inertial = [a * e.coeff(a) for a in accelerated]
        terms = [*inertial, sp.expand(e - sp.Add(*inertial))]
    written = {dummy: _function(jet) for jet, dummy in names.items()}
    others = e.free_symbols - {*c.q, *c.v, *c.a}
    written |= {s: _multiplier(s) for s in others if str(s).startswith(("lambda_", "Lambda_"))}
    parts = [latex(term, written) for term in terms if term != 0] or ["0"]
    return parts[0] + "".join(f" {part}" if part.startswith("-") else f" + {part}" for part in parts[1:])


def _function(jet: sp.Expr) -> str:
    """A function or a derivative of one: U'(r); of time alone y with dots."""
    found = jet_of(jet)
    assert found is not None
    (function, orders), arguments = found
    letter = letter_latex(sp.Symbol(str(function)))
    inside = ", ".join(latex(a) for a in arguments)
    if len(orders) > 1:
        power = rf"^{{({', '.join(map(str, orders))})}}" if any(orders) else ""
        return rf"{letter}{power}\left({inside}\right)"
    if arguments == (t,) and 0 < orders[0] < 3:
        stem, _, index = letter.partition("_")
        return rf"\{'d' * orders[0]}ot{{{stem}}}{'_' if index else ''}{index}\left({inside}\right)"
    return letter + "'" * orders[0] + rf"\left({inside}\right)"


def _multiplier(s: sp.Symbol) -> str:
    stem, _, name = str(s).partition("_")
    return rf"\{stem}_{{{name}}}" if name.isdigit() else rf"\{stem}_\text{{{name.replace('_', ' ')}}}"
