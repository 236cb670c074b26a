"""Equilibria, exact: the conditions as polynomials in cosines, sines and lengths, solved factor by factor.

One unknown after another is eliminated by a factor of degree one or two in it; what is found satisfies the conditions, or
is not returned. Where no factor can be solved so, the equilibrium is refused with what to give.
"""

import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero, derivative, normal_form
from lagrotor.algebra.enclosed_roots import Box, kinks_in, roots_in_box
from lagrotor.algebra.enclosures import enclosures
from lagrotor.errors import InputError, LagrotorWarning, NotExactError, SingularError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import by_symbol, put_in
from lagrotor.mechanics.lagrangian import euler_lagrange, t

_HOPELESS = 1000  # the effort of a factor that is not solved for any unknown
_SHOWN = 300  # letters of the conditions in a refusal
Solution = dict[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class Equilibrium:
    """Values of the unknowns, `at`, and the conditions (relations) under which they are real and nothing is singular.

    Attributes
    ----------
    regular : bool, default True
        Whether the mass matrix is regular there. Where it is not, as at the pole of spherical coordinates, no force
        along a coordinate is necessary for rest and may not be enough: other coordinates decide.
    enclosure : mapping, default field(default_factory=dict)
        Where it was found in a box, rationals between which each coordinate is proved to lie; `at` is rounded.
    """

    at: Mapping[sp.Symbol, sp.Expr]
    domain: tuple[sp.Basic, ...] = ()
    regular: bool = True
    enclosure: Mapping[sp.Symbol, tuple[sp.Rational, sp.Rational]] = field(default_factory=dict)


def equilibria(
    system: Equations,
    unknowns: str | Sequence[str | sp.Symbol] = (),
    values: Mapping[Any, Any] | None = None,
    box: Mapping[Any, tuple[Any, Any]] | None = None,
) -> tuple[Equilibrium, ...]:
    """Return the configurations at rest: `System.equilibria`."""
    if isinstance(unknowns, Mapping):
        raise InputError(
            "equilibria: unknowns must be names of letters: values are given as values={symbol: number, …}"
        )
    if values is not None or box is not None:
        if unknowns:
            raise InputError(f"equilibria: in a box all coordinates are unknown: leave out unknowns = {unknowns!r}")
        return _in_box(system, values or {}, box or {})
    return _equilibria(system, unknowns)


def _in_box(
    system: Equations, values: Mapping[Any, Any], box: Mapping[Any, tuple[Any, Any]]
) -> tuple[Equilibrium, ...]:
    """All equilibria in a box, in numbers."""
    from lagrotor.mechanics.running.function_values import FunctionValue, put_functions

    system, values = put_functions("equilibria", system, values)
    if called := [str(name) for name, value in values.items() if isinstance(value, FunctionValue)]:
        raise InputError(
            f"equilibria: {called[0]} is a callable or a table, of which nothing is proved in a box: give an expression"
        )
    c = system.c
    values = {name: value for name, value in values.items() if not isinstance(value, sp.Lambda)}
    if len(system.constraints) > 1:
        raise InputError(
            "equilibria: a box is searched with one constraint at most: solve the others for coordinates by in_coordinates"
        )
    if system.rolling:
        raise InputError(
            "equilibria: where a body rolls, places of rest are not isolated: give linearise a point of your own, or leave out "
            "rolling"
        )
    letters = system.letters | system.generalised_forces.free_symbols
    if strangers := {name for name in values if isinstance(name, str)} - {*map(str, letters)}:
        raise InputError(f"equilibria: values name {min(strangers)}, which the system does not have: leave it out")
    numbers = {s: _rational(f"equilibria: {s}", x) for s, x in by_symbol("equilibria: values", values, letters).items()}
    still = dict.fromkeys((*c.v, *c.a), sp.S.Zero)
    forces = [put_in(e, still).subs(numbers) for e in euler_lagrange(system.L, c) - system.generalised_forces]
    forces, constraints = (
        [e.xreplace({x: sp.Rational(x) for x in e.atoms(sp.Float)}) for e in part]
        for part in (forces, [g.subs(numbers) for g in system.constraints])
    )
    sides = by_symbol("equilibria: box", box, c.q)
    if {*sides} != {*c.q} or not all(isinstance(side, Sequence) and len(side) == 2 for side in sides.values()):
        raise InputError(f"equilibria: box = {box!r} must be {{coordinate: (least, largest)}} for each of {c.q}")
    edges: Box = {
        q: (_rational(f"equilibria: box of {q}", sides[q][0]), _rational(f"equilibria: box of {q}", sides[q][1]))
        for q in c.q
    }
    if empty := [str(q) for q, (low, high) in edges.items() if low >= high]:
        raise InputError(f"equilibria: the box of {', '.join(empty)} is empty: give (least, largest)")
    for q, (low, high) in edges.items():
        less, more = (0 if isinstance(x, int | sp.Rational) else 2**-53 for x in sides[q])
        edges[q] = low - abs(low) * sp.Rational(less), high + abs(high) * sp.Rational(more)
    if any(e.free_symbols & {*system.multipliers} for e in forces):
        raise InputError("equilibria: a force at rest has the reaction of a constraint: a box is searched without it")
    if left := sorted({str(s) for e in (*forces, *constraints) for s in e.free_symbols - {*c.q}}):
        raise InputError(f"equilibria: {', '.join(left)} without a value: in a box every letter has one, and time none")
    roots, undecided = _at_rest(forces, constraints, edges)
    middles = [{q: sp.Float(round((low + high) / 2, 20), 17) for q, (low, high) in root.items()} for root in roots]
    kinks = [kinks_in((*forces, *constraints), part, edges) for part in undecided]
    if undecided and all(kinks):
        warnings.warn(
            f"equilibria: nothing is decided where {' or '.join(dict.fromkeys(str(kink[0]) for kink in kinks))} = 0, first "
            f"about {_about(undecided[0], c.q)}: a force has no derivative or no value there",
            LagrotorWarning,
            stacklevel=3,
        )
    elif undecided:
        shown = _about(undecided[kinks.index([])], c.q)
        proved = "; ".join(", ".join(f"{q} = {float(x):.6g}" for q, x in at.items()) for at in middles)
        raise SingularError(
            f"equilibria: {len(undecided)} parts of the box are undecided, the first about {shown}: an equilibrium that is "
            "not isolated or degenerate, a coordinate on which no force depends, a constraint whose derivative is zero, forces "
            f"that jump, or too large a box; choose another one. Proved elsewhere in it: {proved or 'none'}"
        )
    return tuple(
        Equilibrium(at, regular=_regular(system, numbers | at), enclosure=root)
        for at, root in sorted(zip(middles, roots, strict=True), key=lambda pair: [float(x) for x in pair[0].values()])
    )


def _about(part: Box, coordinates: Sequence[sp.Symbol]) -> str:
    return ", ".join(f"{q} = {float(sum(part[q]) / 2):.6g}" for q in coordinates)


def _at_rest(forces: Sequence[sp.Expr], constraints: Sequence[sp.Expr], box: Box) -> tuple[list[Box], list[Box]]:
    """Roots of F = 0, or of F cos χ + r ∂g/∂q sin χ = 0 and g = 0 with the multiplier r tan χ, and what is undecided.

    r, of the sizes of F and ∂g/∂q, makes them alike whatever the units are.
    """
    if not constraints:
        return roots_in_box(forces, box)
    (g,) = constraints
    slopes = [derivative(g, q) for q in box]
    r = _size(forces, box) / _size(slopes, box)
    c, s = sp.symbols("c s", real=True, cls=sp.Dummy)
    balance = [c * force + s * r * slope for force, slope in zip(forces, slopes, strict=True)]
    # c = 0 only where ∂g/∂q = 0, no root that stands alone
    angle = {c: (sp.S.Zero, sp.S.One), s: (sp.S.NegativeOne, sp.S.One)}
    roots, undecided = roots_in_box([*balance, g, c**2 + s**2 - 1], {**box, **angle})
    return [{q: root[q] for q in box} for root in roots], undecided


def _size(row: Sequence[sp.Expr], box: Box) -> sp.Rational:
    """The largest of a row's products with the sides of the box at two places in it; 1 where none has a value but zero."""
    sizes = [sp.S.Zero]
    for share in (sp.Rational(2, 7), sp.Rational(5, 7)):
        values = enclosures(row, {q: low + share * (high - low) for q, (low, high) in box.items()})
        sizes += [abs(v[0]) * (high - low) for v, (low, high) in zip(values, box.values(), strict=True) if v]
    return sp.Rational(float(max(sizes))) or sp.S.One


def _rational(where: str, given: Any) -> sp.Rational:
    try:
        if isinstance(given, str | bool):
            raise TypeError
        if not isfinite(given):
            raise ValueError
        return sp.Rational(given) if isinstance(given, int | float | sp.Rational) else sp.Rational(float(given))
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{where} = {given!r} must be a finite number") from None


def _equilibria(system: Equations, unknowns: str | Sequence[str | sp.Symbol]) -> tuple[Equilibrium, ...]:
    c = system.c
    still = dict.fromkeys((*c.v, *c.a), 0)
    lam = sp.Matrix(system.multipliers)
    force = euler_lagrange(system.L, c).subs(still) - system.generalised_forces.subs(still)
    pulled = (system.rows.T * lam).subs(still) if len(lam) else sp.zeros(len(c.q), 1)
    conditions = [e for e in (*(force - pulled), *system.constraints, *system.residual.subs(still)) if e != 0]
    if any(t in e.free_symbols for e in conditions):
        raise InputError("equilibria: a force or a constraint depends on time: there is no equilibrium; simulate it")
    wanted = _unknowns(system, unknowns)
    polynomials, pairs = _polynomials(conditions, wanted)
    symbols = [*(x for pair in pairs.values() for x in pair), *wanted, *system.multipliers]
    fixed = {q: q for q in c.q if q not in wanted and any(q in e.free_symbols for e in conditions)}
    places: list[Equilibrium] = []
    circles = {c**2 + s**2 - 1 for c, s in pairs.values()}
    for solution in _solve(polynomials, symbols, {}, circles):
        equilibrium = _equilibrium(solution, wanted, pairs, fixed)
        if equilibrium is not None:
            equilibrium = replace(equilibrium, regular=_regular(system, equilibrium.at))
        if equilibrium is not None and equilibrium not in places:
            places.append(equilibrium)
    return tuple(places)


def _regular(system: Equations, at: Mapping[sp.Symbol, sp.Expr]) -> bool:
    return decide_zero(system.mass_matrix.subs(dict(at)).det(method="berkowitz")).answer != "zero"


def _unknowns(system: Equations, unknowns: str | Sequence[str | sp.Symbol]) -> tuple[sp.Symbol, ...]:
    if not isinstance(unknowns, Sequence):
        raise InputError(f"equilibria: unknowns = {unknowns!r} must be names of letters, 'theta phi'")
    names = unknowns.replace(",", " ").split() if isinstance(unknowns, str) else unknowns
    letters = (system.letters | {*system.c.q} | system.generalised_forces.free_symbols) - {
        *system.c.v,
        *system.speeds,
        t,
    }
    known = {str(s): s for s in sorted(letters, key=str)}
    if strangers := [str(name) for name in names if str(name) not in known]:
        raise InputError(f"equilibria: {', '.join(strangers)} not in the system: solve for some of {', '.join(known)}")
    return tuple(known[str(name)] for name in names) or system.c.q


def _polynomials(
    conditions: Sequence[sp.Expr], wanted: Sequence[sp.Symbol]
) -> tuple[list[sp.Expr], dict[sp.Expr, tuple[sp.Symbol, sp.Symbol]]]:
    """Numerators of the conditions, the cosine and sine of each wanted angle as symbols, tied by c² + s² = 1."""
    roots = {p for e in conditions for p in e.atoms(sp.Pow) if not p.exp.is_integer}
    if any(p.free_symbols & {*wanted} for p in roots):
        raise _refusal(conditions, wanted)
    forms = []
    for e in conditions:
        try:
            forms.append(normal_form(e))
        except NotExactError:
            forms.append(sp.together(sp.expand_trig(e)))
    pairs: dict[sp.Expr, tuple[sp.Symbol, sp.Symbol]] = {}
    for node in sorted(set().union(*(e.atoms(sp.cos, sp.sin) for e in forms)), key=sp.default_sort_key):
        if node.free_symbols & {*wanted}:
            name = str(node.args[0])
            pairs.setdefault(node.args[0], (sp.Symbol(f"cos({name})", real=True), sp.Symbol(f"sin({name})", real=True)))
    put = {f(u): symbol for u, pair in pairs.items() for f, symbol in zip((sp.cos, sp.sin), pair, strict=True)}
    numerators = [sp.numer(sp.together(e.xreplace(put))) for e in forms]
    angles = [q for u in pairs for q in u.free_symbols & {*wanted}]
    mixed = {q for q in angles if angles.count(q) > 1 or any(q in e.free_symbols for e in numerators)}
    if mixed or any(node.free_symbols & {*wanted} for e in numerators for node in e.atoms(sp.Function)):
        raise _refusal(conditions, wanted)
    return [*numerators, *(c**2 + s**2 - 1 for c, s in pairs.values())], pairs


def _solve(
    polynomials: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol], known: Solution, circles: set[sp.Expr]
) -> Iterator[Solution]:
    """Each way to make all polynomials zero, by factors of degree one or two in one unknown.

    Of circles, those c² + s² = 1 that bind what nothing else does stay free.
    """
    left: list[list[sp.Expr]] = []
    whole: list[sp.Expr] = []
    for e in polynomials:
        numerator = sp.numer(sp.together(sp.sympify(e, strict=True).subs(known)))
        if numerator == 0 or decide_zero(numerator).answer == "zero":
            continue
        whole.append(e)
        factors = [f for f, _ in sp.factor_list(numerator)[1] if f.free_symbols & {*unknowns}]
        if not factors:
            return  # a condition on the parameters, which are independent
        left.append(factors)
    bound = set().union(
        *(f.free_symbols for e, factors in zip(whole, left, strict=True) if e not in circles for f in factors)
    )
    places = [i for i, e in enumerate(whole) if e not in circles or e.subs(known) != e or e.free_symbols & bound]
    left, whole = [left[i] for i in places], [whole[i] for i in places]
    if not left:
        yield known
        return
    branches = [[(f, *_easiest(f, unknowns)) for f in factors] for factors in left]
    place = min(range(len(left)), key=lambda i: (max(effort for _, _, effort in branches[i]), len(branches[i])))
    best, others = branches[place], whole[:place] + whole[place + 1 :]
    if max(effort for _, _, effort in best) == _HOPELESS:
        raise _refusal([sp.Mul(*factors) for factors in left], unknowns)
    for factor, x, _ in best:
        for root in sp.roots(sp.Poly(factor, x)):
            if root.is_real is not False:
                put = {x: root}
                yield from _solve(others, unknowns, {s: e.subs(put) for s, e in known.items()} | put, circles)


def _easiest(factor: sp.Expr, unknowns: Sequence[sp.Symbol]) -> tuple[sp.Symbol, int]:
    """The unknown that this factor gives with the least effort: linear, then a plain quadratic."""
    inside = [x for x in unknowns if x in factor.free_symbols]
    efforts = []
    for x in inside:
        polynomial = sp.Poly(factor, x)
        alone = not polynomial.LC().free_symbols & {*unknowns}
        solved = alone and (polynomial.degree() == 1 or (polynomial.degree() == 2 and len(inside) == 1))
        efforts.append((10 * polynomial.degree() + len(inside) if solved else _HOPELESS, str(x), x))
    effort, _, x = min(efforts)
    return x, effort


def _equilibrium(
    solution: Solution,
    wanted: Sequence[sp.Symbol],
    pairs: Mapping[sp.Expr, tuple[sp.Symbol, sp.Symbol]],
    fixed: Mapping[sp.Symbol, sp.Expr],
) -> Equilibrium | None:
    """The solution in the coordinates themselves, where it is real; None where it is not."""
    at: Solution = dict(fixed) | {x: solution[x] for x in wanted if x in solution}
    domain: list[sp.Basic] = []
    for u, (c, s) in pairs.items():
        cosine, sine = solution.get(c), solution.get(s)
        (angle,) = u.free_symbols & {*wanted}
        if cosine is None or sine is None:
            at[angle] = angle  # any
            continue
        if cosine.is_number and sine.is_number:
            value = sp.atan2(sine, cosine)
        else:
            value = -sp.acos(cosine) if sine.could_extract_minus_sign() else sp.acos(cosine)
            domain.append(sp.Le(sp.Abs(cosine), 1))
        at[angle] = value * angle / u
    for e in solution.values():
        domain += [sp.Ge(p.base, 0) for p in e.atoms(sp.Pow) if p.exp == sp.S.Half and p.base.free_symbols]
    domain = [d for d in dict.fromkeys(domain) if d != sp.true]
    return None if sp.false in domain else Equilibrium(at, tuple(domain))


def _refusal(conditions: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol]) -> InputError:
    shown = ", ".join(f"{e} = 0" for e in sorted(conditions, key=sp.count_ops))
    return InputError(
        f"equilibria: {shown if len(shown) < _SHOWN else shown[:_SHOWN] + ' …'} is not solved for "
        f"{', '.join(map(str, unknowns))} by factors of degree one or two: name another unknown that enters more simply "
        "(a momentum, a parameter), or give linearise a point of your own, {coordinate: value, …}, which it decides"
    )
