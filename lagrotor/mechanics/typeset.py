"""A system as formulas: what a notebook shows of it, and LaTeX for a paper."""

import sympy as sp

from lagrotor.algebra import derivative
from lagrotor.algebra.enclosures import jet_of
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import jets_of, longer, shortest
from lagrotor.mechanics.glossary import latex, letter_latex, multiplier_latex
from lagrotor.mechanics.lagrangian import t
from lagrotor.mechanics.symmetry import cyclic_coordinates

_MOST_COORDINATES, _MOST_OPERATIONS = 6, 400  # up to which energies of bodies are written out, and a formula is shown


def formulas(system: Equations) -> dict[str, list[str]]:
    """Heading → LaTeX of the kinetic and potential energy, what rubs, the equations of motion, the constraints, and what is
    conserved as far as that is seen at once: Jacobi's integral E, and momenta of cyclic coordinates.

    In velocities of one's own, where they are short, q' = B u + b stands before the equations of Boltzmann and Hamel. A formula
    of more than some hundred operations is only counted.
    """
    c = system.c
    if system.bodies and len(c.q) > _MOST_COORDINATES:
        return {"Bodies": [rf"{len(system.bodies)}\ \text{{bodies in {len(c.q)} coordinates}}"]}
    short = not longer(system.L, _MOST_OPERATIONS)
    own = system.kinematics if short else None
    put = dict(zip(c.v, own.velocity, strict=True)) if own and not own.stages else {}
    rates = tuple(dict.fromkeys((*c.a, *system.speed_rates)))
    multipliers = {
        s: multiplier_latex("Lambda" if str(s).startswith("Lambda") else "lambda", name)
        for s, name in zip(system.multipliers, system.multiplier_names, strict=True)
    }

    def line(left: sp.Expr | str, right: sp.Expr = sp.S.Zero) -> str:
        return " = ".join(e if isinstance(e, str) else _side(e, rates, multipliers) for e in (left, right))

    still = system.L.subs(dict.fromkeys(c.v, 0))
    kinetic = sp.expand(system.L - still) if short else system.L - still
    parts = {"Kinetic energy": [line("T", kinetic.xreplace(put))], "Potential energy": [line("V", -still)]}
    if system.dissipation != 0:
        parts["Dissipation"] = [line("D", system.dissipation.xreplace(put))]
    parts["Equations of motion"] = [line(e) for e in (_in_own_velocities(system) if put else system.motion)]
    if put:
        parts["Equations of motion"][:0] = [line(latex(v), e) for v, e in put.items() if v != e]
    if system.multipliers:
        rolling = enumerate(system.rolling, len(system.constraints))
        # Where q' = B u + b is written, without the rows that it keeps.
        rows = [e for i, e in rolling if not (own and put) or i in own.left]
        parts["Constraints"] = [line(e) for e in (*system.constraints, *rows)]
    closed = not (system.forces or system.dissipation != 0 or t in system.L.free_symbols)
    steady = all(e.subs(dict.fromkeys(c.v, 0)) == 0 for e in system.residual)
    square = short and sp.expand(kinetic.xreplace({v: 2 * v for v in c.v}) - 4 * kinetic) == 0
    kept = [line("E", "T + V" if square else system.energy.xreplace(put))] if closed and steady else []
    if short:
        for q in cyclic_coordinates(system):
            momentum = derivative(system.L, c.v[c.q.index(q)])
            kept.append(line(rf"p_{{{letter_latex(q)}}}", momentum.xreplace(put)))
    return {heading: lines for heading, lines in (parts | {"Conserved": kept}).items() if lines}


def _in_own_velocities(system: Equations) -> list[sp.Expr]:
    """The equations of Boltzmann and Hamel, the derivative of a coordinate's velocity its acceleration."""
    c = system.c
    named = {rate: c.a[c.v.index(u)] for u, rate in zip(system.speeds, system.speed_rates, strict=True) if u in c.v}
    return [e.xreplace(named) for e in system.hamel]


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
    rows = " \\\\\n".join(line.replace(" = ", " &= ", 1) for line in lines)
    return f"\\begin{{align}}\n{rows}\n\\end{{align}}"


def _side(e: sp.Expr, rates: tuple[sp.Symbol, ...], multipliers: dict[sp.Symbol, str]) -> str:
    """A formula, the accelerations in front of what they are multiplied with."""
    count = sp.count_ops(e)
    if count > _MOST_OPERATIONS:
        return rf"\text{{{count:,} operations}}"
    e = shortest(e)
    names = {jet: sp.Dummy() for jet in jets_of(e)}
    e = e.xreplace(names)
    terms = [e]
    if accelerated := [a for a in rates if a in e.free_symbols]:
        e = sp.expand(e)
        inertial = [a * e.coeff(a) for a in accelerated]
        rest = sp.expand(e - sp.Add(*inertial))
        terms = [*(a * shortest(e.coeff(a)) for a in accelerated), rest]
    written = {dummy: _function(jet) for jet, dummy in names.items()} | multipliers
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
