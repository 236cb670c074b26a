"""Symmetries, their Noether integrals and reductions, and the decision whether two systems have the same motion.

A transformation q → q + ε ξ(q, v, t) carries velocities along by v → v + ε ξ', so a Lagrangian changes by

    δL = ∂L/∂q · ξ + ∂L/∂v · ξ',     and along a motion     d/dt (p · ξ) = δL + Q · ξ + λ · (G ξ).

If δL is the total time derivative of a gauge function F(q, v, t), and neither forces nor constraints act along ξ, then
p · ξ − F is conserved. The translation of a cyclic coordinate is the plainest case; its conserved momentum allows the
Legendre transform in that velocity alone, to the Routhian. The field ξ = v with F = L is the translation of time.

Arnold, Mathematical Methods of Classical Mechanics, §20; Goldstein, Poole & Safko, Classical Mechanics, 3rd ed.,
§§2.6, 8.1, 8.3, 13.7; Noether, Invariante Variationsprobleme (1918).
"""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TypeVar

import sympy as sp
from sympy.matrices.utilities import dotprodsimp

from lagrotor.algebra import Decision, along, decide_equal, decide_zero, derivative, normal_form
from lagrotor.algebra.enclosures import apart, solved_at
from lagrotor.algebra.evidence import points
from lagrotor.errors import DomainError, InputError, NotASymmetryError, NotExactError
from lagrotor.mechanics.equations import Equations, constrained_accelerations, no_states, time_derivative
from lagrotor.mechanics.expressions import expression, longer, put_in, shortest
from lagrotor.mechanics.lagrangian import (
    Coordinates,
    euler_lagrange,
    gradient,
    jacobian,
    linear_solve,
    t,
    total_derivative,
)
from lagrotor.mechanics.quasi_velocities import boltzmann_hamel
from lagrotor.result_display import Shown

Kind = TypeVar("Kind", bound=Equations)
_MULTIPLIED_OUT = 100  # operations of L up to which determinants are expanded in the Legendre transform


@dataclass(frozen=True, repr=False)
class FirstIntegral(Shown):
    """A conserved quantity.

    Attributes
    ----------
    expression : Expr
        The quantity in q, v and t.
    domain : tuple of Expr
        Expressions. Conservation is proved where none of them vanishes.
    """

    _shown = (
        ("conserved", "expression"),
        ("where not zero", "domain"),
    )

    expression: sp.Expr
    domain: tuple[sp.Expr, ...]


def cyclic_coordinates(system: Equations) -> tuple[sp.Symbol, ...]:
    """Return the coordinates for which ∂L/∂q, Q and the column of G vanish identically. Goldstein §2.6."""
    return tuple(
        q
        for j, q in enumerate(system.c.q)
        if _vanish(
            [
                derivative(system.L, q),
                system.generalised_forces[j],
                *(system.rows[i, j] for i in range(system.rows.rows)),
            ]
        )
    )


def variation(system: Equations, xi: Sequence[sp.Expr]) -> sp.Expr:
    """Return δL = ∂L/∂q · ξ + ∂L/∂v · ξ' under q → q + ε ξ(q, v, t)."""
    c, field = system.c, _field(system, xi)
    carried = (total_derivative(component, c) for component in field)
    return along(system.L, (*c.q, *c.v), (*field, *carried))


def invariance(system: Equations, xi: Sequence[sp.Expr], gauge: sp.Expr = sp.S.Zero) -> Decision:
    """Decide if δL + Q · ξ = dF/dt and G ξ = 0 identically: `System.invariance`."""
    gauge = expression("noether: gauge", gauge)
    if higher := gauge.free_symbols & {*system.c.a, *dict(system.states)}:
        raise InputError(
            f"noether: gauge = {gauge} contains {', '.join(map(str, higher))}: F depends on q, v and t alone"
        )
    field = _field(system, xi)
    residual = variation(system, xi) + system.generalised_forces.dot(field) - total_derivative(gauge, system.c)
    entries = sp.Matrix([residual, *(system.rows * field)])
    return decide_equal(entries, sp.zeros(len(entries), 1))


def noether(system: Equations, xi: Sequence[sp.Expr], gauge: sp.Expr = sp.S.Zero) -> FirstIntegral:
    """Return p · ξ − F where `invariance` holds: `System.noether`."""
    decision = invariance(system, xi, gauge)
    if decision.answer != "zero":
        raise NotASymmetryError(
            f"noether: q → q + ε ξ does not leave the motion invariant ({decision.answer}: {decision.reason}) with "
            f"δL = {variation(system, xi)} and the gauge function {gauge}; give gauge=F with δL = dF/dt, or see how "
            "p · ξ changes: noether_rate"
        )
    integral = along(system.L, system.c.v, xi) - sp.sympify(gauge, strict=True)
    return FirstIntegral(shortest(integral), decision.domain)


def noether_rate(system: Equations, xi: Sequence[sp.Expr]) -> sp.Expr:
    """Return d/dt (p · ξ) along a motion: `System.noether_rate`."""
    field = _field(system, xi)
    work = sum((lam * e for lam, e in zip(system.multipliers, system.rows * field, strict=True)), sp.S.Zero)
    return variation(system, xi) + system.generalised_forces.dot(field) + work


def conserved(system: Equations, f: sp.Expr) -> Decision:
    """Decide if df/dt vanishes with the accelerations put in: `System.conserved`."""
    f = expression("conserved: f", f)
    if f.free_symbols & {*system.c.a} or not f.free_symbols & {*system.c.v, *system.variables, t}:
        raise InputError(f"conserved: f = {f} must be an expression in q, v and t")
    if system.kinematics is not None and not system.kinematics.stages and not system.left:
        rate = _rate_along_speeds(system, f)
    else:
        a, _ = constrained_accelerations(system)
        rate = time_derivative(system, f).xreplace(dict(zip(system.c.a, a, strict=True)))
    decision = decide_zero(rate)
    if decision.answer == "nonzero" and system.multipliers:
        return replace(decision, answer="undecided", reason=f"Off the constraints df/dt is not zero. {decision.reason}")
    return decision


def _rate_along_speeds(system: Equations, f: sp.Expr) -> sp.Expr:
    """Return df/dt in q, u and t, with u' from the Boltzmann–Hamel equations, and with q0 > 0 for unit quaternions."""
    relation, c, u = system.kinematics, system.c, system.speeds
    assert relation is not None
    velocities = dict(zip(c.v, relation.velocity, strict=True))
    M, h = boltzmann_hamel(system.L, c, relation, u)
    singular = f"conserved: the mass matrix is singular in {', '.join(map(str, u))}: use fewer coordinates"
    rates = linear_solve(M, relation.B.T * system.generalised_forces.xreplace(velocities) - h, singular)
    x, x_dot = zip(*system.states, strict=True) if system.states else ((), ())
    rates = [*rates, *(e.xreplace(velocities) for e in x_dot)]
    rate = along(f.xreplace(velocities), (*c.q, t, *u, *x), (*relation.velocity, 1, *rates))
    unit = {q[0]: sp.sqrt(1 - sum(x**2 for x in q[1:])) for q in (joint.quaternion for joint in system.ball_joints)}
    return rate.xreplace(unit)


def legendre(L: sp.Expr, c: Coordinates, p: Sequence[sp.Symbol]) -> sp.Expr:
    """Return H(q, p) = p · v − L at p = ∂L/∂v.

    For L = ½ v·M v + b·v − V it is H = ½ (p − b)·M⁻¹(p − b) + V.

    Parameters
    ----------
    L, c : Expr, Coordinates
        The Lagrangian and its coordinates.
    p : sequence
        n new symbols of the momenta.

    Returns
    -------
    Expr
        H in q, p and t.

    Raises
    ------
    DomainError
        If L is not quadratic in v.
    SingularError
        If det M vanishes identically.
    """
    if not all(isinstance(s, sp.Symbol) for s in p) or len({*p}) != len(p):
        raise InputError(f"legendre: momenta {tuple(p)}: each must be a symbol of its own; rename them")
    _check_momenta("legendre", c.v, p, {*c.q, *c.v, *c.a} | L.free_symbols)
    # sympy expands determinants of up to three rows. That shortens H for a short L, and takes too long for a long one.
    with dotprodsimp(False if longer(L, _MULTIPLIED_OUT) else None):
        velocities = _velocities("legendre", L, c.v, p)
    return -_legendre(L, c.v, p, velocities)


def routh(system: Kind, cyclic: str | Sequence[str | sp.Symbol] | Mapping[str | sp.Symbol, sp.Expr]) -> Kind:
    """Reduce a system by cyclic coordinates: `System.routh`."""
    no_states("routh", system, "the reduction does not carry them over: write the reduced system with its states")
    c, L = system.c, system.L
    chosen = _momenta(c, cyclic)
    free = cyclic_coordinates(system)
    if bound := [str(q) for q in chosen if q not in free]:
        raise NotASymmetryError(
            f"routh: L, a force or a constraint depends on {', '.join(bound)}: its momentum is not conserved; leave it "
            "among the coordinates"
        )
    L = _free_of(L, chosen)
    places = [c.q.index(q) for q in chosen]
    u, p = [c.v[i] for i in places], list(chosen.values())
    used = {*c.q, *c.v, *c.a, t} | (set() if isinstance(cyclic, Mapping) else L.free_symbols)
    _check_momenta("routh", u, p, used)
    remaining = [i for i in range(len(c.q)) if i not in places]
    if not remaining:
        raise InputError("routh: every coordinate is cyclic: no coordinate remains; keep one")
    velocities = _velocities("routh", L, u, p)
    reduced = Coordinates(*(tuple(names[i] for i in remaining) for names in (c.q, c.v, c.a)))
    substitution = dict(zip(u, velocities, strict=True))
    forces = (
        tuple(system.generalised_forces[i].subs(substitution) for i in remaining)
        if system.forces or system.dissipation != 0
        else ()
    )
    rolling = tuple(f.subs(substitution) for f in system.rolling)
    if entering := {*chosen} & set().union(*(e.free_symbols for e in (*forces, *rolling, *system.constraints))):
        raise NotASymmetryError(
            f"routh: {', '.join(map(str, entering))} enters the forces or the constraints on the others: keep it as a coordinate"
        )
    return replace(
        system,
        c=reduced,
        lagrangian=_legendre(L, u, p, velocities),
        rolling=rolling,
        dissipation=sp.S.Zero,
        forces=forces,
        velocities=(),
    )


def _free_of(L: sp.Expr, cyclic: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """Return L with the cyclic coordinates set to zero, which removes them; return L itself if it is not finite there."""
    at_zero = L.subs(dict.fromkeys(cyclic, 0))
    return L if at_zero.has(sp.nan, sp.zoo, sp.oo, -sp.oo) else at_zero


def _momenta(
    c: Coordinates, cyclic: str | Sequence[str | sp.Symbol] | Mapping[str | sp.Symbol, sp.Expr]
) -> dict[sp.Symbol, sp.Expr]:
    """Return {cyclic coordinate: momentum}; a momentum that the caller does not give is the symbol p_name."""
    by_name = {str(q): q for q in c.q}
    if not isinstance(cyclic, Iterable):
        raise InputError(f"routh: {cyclic!r} must name cyclic coordinates, as 'phi psi'")
    names = cyclic.replace(",", " ").split() if isinstance(cyclic, str) else list(cyclic)
    if strangers := [str(name) for name in names if str(name) not in by_name]:
        raise InputError(f"routh: {', '.join(strangers)} not among the coordinates {c.q}: name some of these")
    if not names or len({*map(str, names)}) != len(names):
        raise InputError(f"routh: {cyclic!r} must name at least one cyclic coordinate, each once")
    if isinstance(cyclic, Mapping):
        return {by_name[str(name)]: expression(f"routh: {name}", p) for name, p in cyclic.items()}
    return {by_name[str(name)]: sp.Symbol(f"p_{name}", real=True) for name in names}


def _check_momenta(where: str, u: Sequence[sp.Symbol], p: Sequence[sp.Expr], used: set[sp.Basic]) -> None:
    if len(p) != len(u) or set().union(*(e.free_symbols for e in p)) & used:
        raise InputError(
            f"{where}: momenta {tuple(p)} for the velocities {tuple(u)}: each velocity needs a momentum of its own, in "
            "symbols that are not used yet; rename them"
        )


def _velocities(where: str, L: sp.Expr, u: Sequence[sp.Symbol], p: Sequence[sp.Expr]) -> list[sp.Expr]:
    """Solve p = b + A u for u, with b = ∂L/∂u at u = 0 and A = ∂²L/∂u∂u."""
    slope = gradient(L, u)
    A = jacobian(slope, u)
    if not _vanish([derivative(entry, w) for entry in A for w in u]):
        raise DomainError(
            f"{where}: L is not quadratic in {', '.join(map(str, u))}: p = ∂L/∂v is not linear there; "
            "solve it for the velocities by hand"
        )
    at_rest = dict.fromkeys(u, 0)
    excess = sp.Matrix(list(p)) - slope.subs(at_rest)
    singular = f"{where}: ∂²L/∂v∂v is singular in {', '.join(map(str, u))}: p does not determine the velocities"
    return list(linear_solve(A.subs(at_rest), excess, f"{singular}; use fewer coordinates"))


def _legendre(L: sp.Expr, u: Sequence[sp.Symbol], p: Sequence[sp.Expr], velocities: Sequence[sp.Expr]) -> sp.Expr:
    """Return L − p·u at u = A⁻¹ (p − b), which is L|₀ − ½ (p − b)·u."""
    at_rest = dict.fromkeys(u, 0)
    excess = sp.Matrix(list(p)) - gradient(L, u).subs(at_rest)
    return L.subs(at_rest) - excess.dot(sp.Matrix(list(velocities))) / 2


def _vanish(expressions: Sequence[sp.Expr]) -> bool:
    return all(decide_zero(e).answer == "zero" for e in expressions)


def _field(system: Equations, xi: Sequence[sp.Expr]) -> sp.Matrix:
    fits = isinstance(xi, Sequence | sp.MatrixBase) and not isinstance(xi, str) and len(xi) == len(system.c.q)
    field = sp.Matrix([expression(f"noether: ξ[{i}]", e) for i, e in enumerate(xi)]) if fits else sp.Matrix()
    if not system.c.q or field.free_symbols & {*dict(system.states)}:
        no_states("noether", system, "a symmetry acts on coordinates: conserved(f) decides about f(q, v, x, t)")
    if not fits or field.free_symbols & {*system.c.a}:
        raise InputError(
            f"noether: ξ = {xi}: give one component ξ(q, v, t) for each of {system.c.q}, without accelerations"
        )
    return field


_POINTS = 3  # random points at which accelerations are compared first


def same_as(system: Equations, other: Equations) -> Decision:
    """Decide if two systems have the same accelerations: `System.same_as`."""
    if not isinstance(other, Equations):
        raise InputError(f"same_as: {other!r} is no System: give one to compare with")
    for each in (system, other):
        no_states("same_as", each, "their rates are not compared: compare the systems without them")
    if system.c != other.c:
        raise InputError(
            f"same_as: {system.c.q} and {other.c.q} are not the same coordinates: write one system in those of the other "
            "with in_coordinates"
        )
    loads = [(e.constraints, e.rolling, e.dissipation, e.forces) for e in (system, other)]
    if loads[0] == loads[1] and (direct := decide_equal(system.L, other.L)).answer == "zero":
        return direct
    if system.multipliers or other.multipliers:
        decision = decide_equal(*(constrained_accelerations(system_of)[0] for system_of in (system, other)))
        reason = "Off the constraints the accelerations differ."
    elif refuted := _refutation(system, other):
        return refuted
    else:
        factor = _factor(system, other)
        difference = factor * system.L - other.L
        with suppress(NotExactError):
            difference = normal_form(difference)
        decision = decide_equal(
            euler_lagrange(difference, system.c), factor * system.generalised_forces - other.generalised_forces
        )
        reason = "Their Lagrangians differ by more than one factor and a total derivative."
    if decision.answer == "nonzero":
        return replace(decision, answer="undecided", reason=f"{reason} {decision.reason}")
    return decision


def _refutation(system: Equations, other: Equations) -> Decision | None:
    """Return the decision that the accelerations differ, if their enclosures at a random point are disjoint; else None."""
    pairs = [(it.mass_matrix, it.generalised_forces - it.bias) for it in (system, other)]
    symbols = set().union(*(entry.free_symbols for pair in pairs for entry in pair))
    for point in points(symbols, _POINTS):
        try:
            first, right = (solved_at(*pair, point) for pair in pairs)
        except NotExactError:
            continue
        if (i := apart(first, right)) is not None:
            value, two = (float(x[i].mid) for x in (first, right))
            apart_by = sp.Rational(float((first[i] - right[i]).mid))
            reason = f"At the witness {system.c.a[i]} is {value:.6g} in the first system, {two:.6g} in the other."
            return Decision("nonzero", (), reason, residual=apart_by, points=(point,))
    return None


def _factor(system: Equations, other: Equations) -> sp.Expr:
    """Return the ratio of the mass matrices, from their shortest entries, if it does not depend on q and t; else 1."""
    entries = [pair for pair in zip(system.mass_matrix, other.mass_matrix, strict=True) if 0 not in pair]
    mine, theirs = min(entries, key=lambda pair: sp.count_ops(pair), default=(sp.S.One, sp.S.One))
    try:
        ratio = normal_form(theirs / mine)
    except NotExactError:
        return sp.S.One
    return sp.S.One if ratio.free_symbols & {*system.c.q, t} else ratio


def in_coordinates(system: Kind, c: Coordinates, where: Mapping[sp.Symbol, sp.Expr]) -> Kind:
    """Rewrite a system in new coordinates: `System.in_coordinates`."""
    old = system.c
    if not isinstance(c, Coordinates) or not isinstance(where, Mapping):
        raise InputError(
            f"in_coordinates: give new coordinates(…) and {{old: expression in them, …}}, not {c!r}, {where!r}"
        )
    if lost := [str(q) for q in old.q if q not in where and q not in c.q]:
        raise InputError(
            f"in_coordinates: {', '.join(lost)} neither given nor among the new coordinates {c.q}: give its expression"
        )
    places = [expression(f"in_coordinates: {q}", where.get(q, q)) for q in old.q]
    substitution = dict(zip(old.q, places, strict=True))
    substitution |= {v: total_derivative(e, c) for v, e in zip(old.v, places, strict=True)}

    def rewritten(e: sp.Expr) -> sp.Expr:
        return put_in(sp.sympify(e, strict=True), substitution)

    slope = jacobian(places, c.q)
    forces = tuple(slope.T * sp.Matrix([rewritten(f) for f in system.forces])) if system.forces else ()

    def left(expressions: tuple[sp.Expr, ...]) -> list[tuple[int, sp.Expr]]:
        expressed = [rewritten(e) for e in expressions]
        return [(i, e) for i, e in enumerate(expressed) if decide_equal(e, sp.S.Zero).answer != "zero"]

    constraints, rolling = left(system.constraints), left(system.rolling)
    numbers = [*(i for i, _ in constraints), *(len(system.constraints) + i for i, _ in rolling)]
    return replace(
        system,
        c=c,
        lagrangian=rewritten(system.L),
        constraints=tuple(e for _, e in constraints),
        rolling=tuple(e for _, e in rolling),
        names=tuple(system.names[i] for i in numbers) if system.names else (),
        dissipation=rewritten(system.dissipation),
        forces=forces,
        velocities=tuple((u, rewritten(e)) for u, e in system.velocities),
        states=tuple((x, rewritten(f)) for x, f in system.states),
    )
