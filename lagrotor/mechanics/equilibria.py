"""Equilibria of a system, exact by elimination or enclosed in a box by interval Newton.

The conditions ∂L/∂q + Q + Gᵀ λ = 0, g = 0 at v = 0 become polynomials in cosines, sines and lengths. A factor of degree one or
two eliminates one unknown at a time; a system without such factors is refused, and the message names a way out.
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
from lagrotor.mechanics.equations import Equations, no_states
from lagrotor.mechanics.expressions import by_symbol, put_in
from lagrotor.mechanics.lagrangian import euler_lagrange, t
from lagrotor.result_display import ShownInOneLine, scientific, text_of

_UNSOLVABLE = 1000  # the effort of a factor that is not solved for any unknown
_LONGEST = 300  # characters of the conditions in a message
Solution = dict[sp.Symbol, sp.Expr]


@dataclass(frozen=True, repr=False)
class Equilibrium(ShownInOneLine):
    """A configuration at rest, and the conditions on the parameters under which it exists.

    Attributes
    ----------
    at : mapping
        {symbol: value} of the coordinates, or of the other unknowns that were solved for; angles in rad.
    domain : tuple[Basic, ...], default ()
        Relations under which the values are real and no equation is singular.
    regular : bool, default True
        True if the mass matrix is regular. Where it is singular, as at the pole of spherical coordinates, zero force along each
        coordinate is necessary for rest but may not suffice: other coordinates decide.
    enclosure : mapping, default {}
        {coordinate: (lower, upper)}, rational bounds of the exact value, of an equilibrium in a box; `at` is then rounded.
    residual : float or None, optional
        The largest rate of a velocity or state that is left at an equilibrium from `System.rest`.
    stability : str, default ""
        The stability of that equilibrium to first order, in words.

    Examples
    --------
    >>> import sympy as sp
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("theta")
    >>> pendulum = System(c, c.v[0] ** 2 / 2 + sp.cos(c.q[0]))
    >>> [place.at[c.q[0]] for place in pendulum.equilibria()]
    [0, pi]
    """

    at: Mapping[sp.Symbol, sp.Expr]
    domain: tuple[sp.Basic, ...] = ()
    regular: bool = True
    enclosure: Mapping[sp.Symbol, tuple[sp.Rational, sp.Rational]] = field(default_factory=dict)
    residual: float | None = None
    stability: str = ""

    def summary(self) -> dict[str, str]:
        """Return the configuration and its conditions in words.

        Returns
        -------
        dict of str
            {symbol: value}; "free" for a symbol that may have any value.
        """
        rows = {text_of(s): "free" if value == s else text_of(value) for s, value in self.at.items()}
        if self.enclosure:
            width = max(high - low for low, high in self.enclosure.values())
            rows["enclosed to"] = scientific(float(width), 1)
        rows |= {"where": text_of(self.domain)} if self.domain else {}
        rows |= {} if self.residual is None else {"largest rate left": scientific(self.residual, 1)}
        rows |= {"small motion": self.stability} if self.stability else {}
        return rows | ({} if self.regular else {"mass matrix": "singular there"})


def equilibria(
    system: Equations,
    unknowns: str | Sequence[str | sp.Symbol] = (),
    values: Mapping[Any, Any] | None = None,
    box: Mapping[Any, tuple[Any, Any]] | None = None,
) -> tuple[Equilibrium, ...]:
    """Return the configurations at rest: `System.equilibria`."""
    if isinstance(unknowns, Mapping):
        raise InputError("equilibria: unknowns must be names of symbols: give numbers by values={symbol: number}")
    if values is not None or box is not None:
        if unknowns:
            raise InputError(f"equilibria: in a box all coordinates are unknown: leave out unknowns = {unknowns!r}")
        return _in_box(system, values or {}, box or {})
    return _equilibria(system, unknowns)


def _in_box(
    system: Equations, values: Mapping[Any, Any], box: Mapping[Any, tuple[Any, Any]]
) -> tuple[Equilibrium, ...]:
    from lagrotor.mechanics.running.function_values import FunctionValue, put_functions

    system, values = put_functions("equilibria", system, values)
    if called := [str(name) for name, value in values.items() if isinstance(value, FunctionValue)]:
        raise InputError(f"equilibria: {called[0]} is a callable or a table: an enclosure needs an expression")
    no_states("equilibria", system, "a box holds coordinates alone: leave out box and values, or use rest")
    c = system.c
    values = {name: value for name, value in values.items() if not isinstance(value, sp.Lambda)}
    if len(system.constraints) > 1:
        raise InputError("equilibria: a box takes one constraint at most: rest(near=…, values=…) takes several")
    if system.rolling:
        raise InputError("equilibria: with rolling, equilibria are not isolated: give linearise a point")
    symbols = system.letters | system.generalised_forces.free_symbols
    if strangers := {name for name in values if isinstance(name, str)} - {*map(str, symbols)}:
        raise InputError(f"equilibria: values name {min(strangers)}, which is no symbol of the system: leave it out")
    numbers = {s: _rational(f"equilibria: {s}", x) for s, x in by_symbol("equilibria: values", values, symbols).items()}
    at_rest = dict.fromkeys((*c.v, *c.a), sp.S.Zero)
    forces = [put_in(e, at_rest).subs(numbers) for e in euler_lagrange(system.L, c) - system.generalised_forces]
    forces, constraints = (
        [e.xreplace({x: sp.Rational(x) for x in e.atoms(sp.Float)}) for e in expressions]
        for expressions in (forces, [g.subs(numbers) for g in system.constraints])
    )
    sides = by_symbol("equilibria: box", box, c.q)
    if {*sides} != {*c.q} or not all(isinstance(side, Sequence) and len(side) == 2 for side in sides.values()):
        raise InputError(f"equilibria: box = {box!r} must be {{coordinate: (least, largest)}} for each of {c.q}")
    ends = {q: [_rational(f"equilibria: box of {q}", x) for x in sides[q]] for q in c.q}
    edges: Box = {q: (low, high) for q, (low, high) in ends.items()}
    if empty := [str(q) for q, (low, high) in edges.items() if low >= high]:
        raise InputError(f"equilibria: the box of {', '.join(empty)} is empty: give (least, largest)")
    for q, (low, high) in edges.items():
        lower_margin, upper_margin = (0 if isinstance(x, int | sp.Rational) else 2**-53 for x in sides[q])
        edges[q] = low - abs(low) * sp.Rational(lower_margin), high + abs(high) * sp.Rational(upper_margin)
    if any(e.free_symbols & {*system.multipliers} for e in forces):
        raise InputError("equilibria: a force depends on the reaction of a constraint: leave out the box")
    if free := sorted({str(s) for e in (*forces, *constraints) for s in e.free_symbols - {*c.q}}):
        raise InputError(f"equilibria: {', '.join(free)} without a value: in a box every symbol needs one")
    roots, undecided = _at_rest(forces, constraints, edges)
    middles = [{q: sp.Float(round((low + high) / 2, 20), 17) for q, (low, high) in root.items()} for root in roots]
    kinks = [kinks_in((*forces, *constraints), region, edges) for region in undecided]
    if undecided and all(kinks):
        warnings.warn(
            f"equilibria: nothing is decided where {' or '.join(dict.fromkeys(str(kink[0]) for kink in kinks))} = 0, first "
            f"about {_about(undecided[0], c.q)}: a force has no derivative or no value there",
            LagrotorWarning,
            stacklevel=3,
        )
    elif undecided:
        place = _about(undecided[kinks.index([])], c.q)
        proved = "; ".join(", ".join(f"{q} = {float(x):.6g}" for q, x in at.items()) for at in middles)
        raise SingularError(
            f"equilibria: {len(undecided)} regions of the box are undecided, the first about {place}: an equilibrium that is "
            "not isolated or degenerate, a coordinate on which no force depends, a constraint whose derivative is zero, forces "
            f"that jump, or too large a box; choose another one. Proved elsewhere in it: {proved or 'none'}"
        )
    return tuple(
        Equilibrium(at, regular=_regular(system, numbers | at), enclosure=root)
        for at, root in sorted(zip(middles, roots, strict=True), key=lambda pair: [float(x) for x in pair[0].values()])
    )


def _about(region: Box, coordinates: Sequence[sp.Symbol]) -> str:
    return ", ".join(f"{q} = {float(sum(region[q]) / 2):.6g}" for q in coordinates)


def _at_rest(forces: Sequence[sp.Expr], constraints: Sequence[sp.Expr], box: Box) -> tuple[list[Box], list[Box]]:
    """Return two lists of boxes: each of the first contains one equilibrium, those of the second are undecided.

    Under a constraint g = 0 with the multiplier r tan χ the equations are F cos χ + r ∂g/∂q sin χ = 0 and g = 0. The number r
    gives both terms a similar size.
    """
    if not constraints:
        return roots_in_box(forces, box)
    (g,) = constraints
    slopes = [derivative(g, q) for q in box]
    r = _size(forces, box) / _size(slopes, box)
    c, s = sp.symbols("c s", real=True, cls=sp.Dummy)
    balance = [c * force + s * r * slope for force, slope in zip(forces, slopes, strict=True)]
    # c = 0 needs ∂g/∂q = 0, where no root is isolated
    angle = {c: (sp.S.Zero, sp.S.One), s: (sp.S.NegativeOne, sp.S.One)}
    roots, undecided = roots_in_box([*balance, g, c**2 + s**2 - 1], {**box, **angle})
    return [{q: root[q] for q in box} for root in roots], undecided


def _size(row: Sequence[sp.Expr], box: Box) -> sp.Rational:
    """Return the largest |entry| × (side of the box) at two points of the box; 1 if all entries are zero or undefined there."""
    sizes = [sp.S.Zero]
    for share in (sp.Rational(2, 7), sp.Rational(5, 7)):
        values = enclosures(row, {q: low + share * (high - low) for q, (low, high) in box.items()})
        sizes += [abs(v[0]) * (high - low) for v, (low, high) in zip(values, box.values(), strict=True) if v]
    return sp.Rational(float(max(sizes))) or sp.S.One


def _rational(where: str, value: Any) -> sp.Rational:
    try:
        if isinstance(value, str | bool):
            raise TypeError
        if not isfinite(value):
            raise ValueError
        return sp.Rational(value) if isinstance(value, int | float | sp.Rational) else sp.Rational(float(value))
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{where} = {value!r} must be a finite number") from None


def _equilibria(system: Equations, unknowns: str | Sequence[str | sp.Symbol]) -> tuple[Equilibrium, ...]:
    c = system.c
    at_rest = dict.fromkeys((*c.v, *c.a), 0)
    lam = sp.Matrix(system.multipliers)
    force = euler_lagrange(system.L, c).subs(at_rest) - system.generalised_forces.subs(at_rest)
    pulled = (system.rows.T * lam).subs(at_rest) if len(lam) else sp.zeros(len(c.q), 1)
    rates = [f.subs(at_rest) for _, f in system.states]
    conditions = [e for e in (*(force - pulled), *rates, *system.constraints, *system.residual.subs(at_rest)) if e != 0]
    if any(t in e.free_symbols for e in conditions):
        raise InputError("equilibria: a force or a constraint depends on time: there is no equilibrium; simulate it")
    targets = _unknowns(system, unknowns)
    polynomials, pairs = _polynomials(conditions, targets)
    symbols = [*(x for pair in pairs.values() for x in pair), *targets, *system.multipliers]
    fixed = {q: q for q in c.q if q not in targets and any(q in e.free_symbols for e in conditions)}
    places: list[Equilibrium] = []
    circles = {c**2 + s**2 - 1 for c, s in pairs.values()}
    for solution in _solve(polynomials, symbols, {}, circles):
        equilibrium = _equilibrium(solution, targets, pairs, fixed)
        if equilibrium is not None:
            equilibrium = replace(equilibrium, regular=_regular(system, equilibrium.at))
        if equilibrium is not None and equilibrium not in places:
            places.append(equilibrium)
    return tuple(sorted(places, key=lambda place: not place.regular))


def _regular(system: Equations, at: Mapping[sp.Symbol, sp.Expr]) -> bool:
    return decide_zero(system.mass_matrix.subs(dict(at)).det(method="berkowitz")).answer != "zero"


def _unknowns(system: Equations, unknowns: str | Sequence[str | sp.Symbol]) -> tuple[sp.Symbol, ...]:
    if not isinstance(unknowns, Sequence):
        raise InputError(f"equilibria: unknowns = {unknowns!r} must be names of symbols, 'theta phi'")
    names = unknowns.replace(",", " ").split() if isinstance(unknowns, str) else unknowns
    acting = system.generalised_forces.free_symbols.union(*(f.free_symbols for _, f in system.states))
    symbols = (system.letters | {*system.variables} | acting) - {*system.c.v, *system.speeds, t}
    by_name = {str(s): s for s in sorted(symbols, key=str)}
    if strangers := [str(name) for name in names if str(name) not in by_name]:
        raise InputError(f"equilibria: no {', '.join(strangers)} in the system: solve for some of {', '.join(by_name)}")
    return tuple(by_name[str(name)] for name in names) or (*system.c.q, *dict(system.states))


def _polynomials(
    conditions: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol]
) -> tuple[list[sp.Expr], dict[sp.Expr, tuple[sp.Symbol, sp.Symbol]]]:
    """Write the conditions as polynomials, which include c² + s² − 1 for each angle; return them and {angle: (c, s)}."""
    roots = {p for e in conditions for p in e.atoms(sp.Pow) if not p.exp.is_integer}
    if any(p.free_symbols & {*unknowns} for p in roots):
        raise _refusal(conditions, unknowns)
    forms = []
    for e in conditions:
        try:
            forms.append(normal_form(e))
        except NotExactError:
            forms.append(sp.together(sp.expand_trig(e)))
    pairs: dict[sp.Expr, tuple[sp.Symbol, sp.Symbol]] = {}
    for node in sorted(set().union(*(e.atoms(sp.cos, sp.sin) for e in forms)), key=sp.default_sort_key):
        if node.free_symbols & {*unknowns}:
            name = str(node.args[0])
            pairs.setdefault(node.args[0], (sp.Symbol(f"cos({name})", real=True), sp.Symbol(f"sin({name})", real=True)))
    symbol_of = {f(u): symbol for u, pair in pairs.items() for f, symbol in zip((sp.cos, sp.sin), pair, strict=True)}
    numerators = [sp.numer(sp.together(e.xreplace(symbol_of))) for e in forms]
    angles = [q for u in pairs for q in u.free_symbols & {*unknowns}]
    mixed = {q for q in angles if angles.count(q) > 1 or any(q in e.free_symbols for e in numerators)}
    if mixed or any(node.free_symbols & {*unknowns} for e in numerators for node in e.atoms(sp.Function)):
        raise _refusal(conditions, unknowns)
    return [*numerators, *(c**2 + s**2 - 1 for c, s in pairs.values())], pairs


def _solve(
    polynomials: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol], solution: Solution, circles: set[sp.Expr]
) -> Iterator[Solution]:
    """Yield each common root {unknown: value} of the polynomials, found from factors of degree one or two.

    An angle on which only c² + s² = 1 depends stays free.
    """
    factor_lists: list[list[sp.Expr]] = []
    whole: list[sp.Expr] = []
    for e in polynomials:
        numerator = sp.numer(sp.together(sp.sympify(e, strict=True).subs(solution)))
        if numerator == 0 or decide_zero(numerator).answer == "zero":
            continue
        whole.append(e)
        factors = [f for f, _ in sp.factor_list(numerator)[1] if f.free_symbols & {*unknowns}]
        if not factors:
            return  # a condition on the parameters alone, which are independent
        factor_lists.append(factors)
    coupled = (factors for e, factors in zip(whole, factor_lists, strict=True) if e not in circles)
    bound = set().union(*(f.free_symbols for factors in coupled for f in factors))
    places = [i for i, e in enumerate(whole) if e not in circles or e.subs(solution) != e or e.free_symbols & bound]
    factor_lists, whole = [factor_lists[i] for i in places], [whole[i] for i in places]
    if not factor_lists:
        yield solution
        return
    branches = [[(f, *_easiest(f, unknowns)) for f in factors] for factors in factor_lists]
    place = min(range(len(factor_lists)), key=lambda i: (max(effort for _, _, effort in branches[i]), len(branches[i])))
    best, others = branches[place], whole[:place] + whole[place + 1 :]
    if max(effort for _, _, effort in best) == _UNSOLVABLE:
        raise _refusal([sp.Mul(*factors) for factors in factor_lists], unknowns)
    for factor, x, _ in best:
        for root in sp.roots(sp.Poly(factor, x)):
            if root.is_real is not False:
                at = {x: root}
                yield from _solve(others, unknowns, {s: e.subs(at) for s, e in solution.items()} | at, circles)


def _easiest(factor: sp.Expr, unknowns: Sequence[sp.Symbol]) -> tuple[sp.Symbol, int]:
    """Return the unknown for which this factor is solved most easily, and a number for the effort: linear before quadratic."""
    inside = [x for x in unknowns if x in factor.free_symbols]
    efforts = []
    for x in inside:
        polynomial = sp.Poly(factor, x)
        alone = not polynomial.LC().free_symbols & {*unknowns}
        solved = alone and (polynomial.degree() == 1 or (polynomial.degree() == 2 and len(inside) == 1))
        efforts.append((10 * polynomial.degree() + len(inside) if solved else _UNSOLVABLE, str(x), x))
    effort, _, x = min(efforts)
    return x, effort


def _equilibrium(
    solution: Solution,
    unknowns: Sequence[sp.Symbol],
    pairs: Mapping[sp.Expr, tuple[sp.Symbol, sp.Symbol]],
    fixed: Mapping[sp.Symbol, sp.Expr],
) -> Equilibrium | None:
    """Return the equilibrium that belongs to a root {unknown: value}; None if the root is not real."""
    at: Solution = dict(fixed) | {x: solution[x] for x in unknowns if x in solution}
    domain: list[sp.Basic] = []
    for u, (c, s) in pairs.items():
        cosine, sine = solution.get(c), solution.get(s)
        (angle,) = u.free_symbols & {*unknowns}
        if cosine is None or sine is None:
            at[angle] = angle  # arbitrary
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
    equations = ", ".join(f"{e} = 0" for e in sorted(conditions, key=sp.count_ops))
    return InputError(
        f"equilibria: {equations if len(equations) < _LONGEST else equations[:_LONGEST] + ' …'} is not solved for "
        f"{', '.join(map(str, unknowns))} by factors of degree one or two: name another unknown that enters more simply "
        "(a momentum, a parameter), or give linearise a point, {coordinate: value, …}, which it decides"
    )
