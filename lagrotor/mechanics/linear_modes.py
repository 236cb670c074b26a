"""Small motion about an equilibrium or a steady motion: its linear system, modes, and the condition of its stability.

Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., ch. 6; Merkin, Introduction to the Theory of Stability, chs. 4, 6;
Gantmacher, The Theory of Matrices, vol. 2, ch. XV (Routh–Hurwitz, Hankel forms).
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero, derivative, normal_form
from lagrotor.errors import InputError, NotExactError, SingularError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.equilibria import Equilibrium
from lagrotor.mechanics.expressions import by_symbol, no_letter, put_in
from lagrotor.mechanics.lagrangian import euler_lagrange, jacobian, t

_S = sp.Symbol("s")


@dataclass(frozen=True)
class Mode:
    """A solution Re(shape exp(rate t)): rate = i ω for an oscillation, 1/s; shape (n, 1) in the full coordinates."""

    rate: sp.Expr
    shape: sp.Matrix


@dataclass(frozen=True)
class LinearSystem:
    """M a + C v + K q = 0 in independent small coordinates; `basis` (n, d) carries them to the full ones.

    `gyroscopic` is C, with friction and nonconservative forces in it where there are any.
    """

    mass: sp.Matrix
    gyroscopic: sp.Matrix
    stiffness: sp.Matrix
    basis: sp.Matrix

    def characteristic(self, s: sp.Symbol) -> sp.Expr:
        """det(s² M + s C + K), factored."""
        return sp.factor(self._pencil(s).det(method="berkowitz"))

    def _pencil(self, s: sp.Expr) -> sp.Matrix:
        return s**2 * self.mass + s * self.gyroscopic + self.stiffness

    def modes(self, values: Mapping[sp.Symbol, Any] | None = None) -> tuple[Mode, ...]:
        """The modes, exact where the factors of the characteristic polynomial are of degree two in s or s²; with `values`
        for every symbol, numbers, sorted by |rate|.

        Raises:
            InputError: when neither is possible, or a symbol has no value.
        """
        if values is not None:
            return self._numeric_modes(values)
        modes: list[Mode] = []
        for factor, _ in sp.factor_list(sp.numer(sp.together(self.characteristic(_S))))[1]:
            if factor.has(_S):
                for rate in _roots(sp.Poly(factor, _S)):
                    modes += [Mode(rate, (self.basis * vector).applyfunc(_reduce)) for vector in self._shapes(rate)]
        return tuple(modes)

    def _shapes(self, rate: sp.Expr) -> list[sp.Matrix]:
        """Null vectors at a root of the characteristic polynomial: a column of the adjugate, where one is not zero."""
        pencil = self._pencil(rate).applyfunc(_reduce)
        columns = [pencil.adjugate()[:, j] for j in range(pencil.cols)]
        column = next((column for column in columns if not all(map(_is_zero, column))), None)
        return [column] if column is not None else list(pencil.nullspace(iszerofunc=_is_zero))

    def _numeric_modes(self, values: Mapping[sp.Symbol, Any]) -> tuple[Mode, ...]:
        import numpy as np

        matrices = (self.mass, self.gyroscopic, self.stiffness, self.basis)
        parts = [m.subs(by_symbol(values, m.free_symbols)) for m in matrices]
        no_letter("modes", set().union(*(m.free_symbols for m in parts)))
        M, C, K, basis = (np.array(m.tolist(), dtype=float) for m in parts)
        d = len(M)
        below = np.linalg.solve(M, np.hstack([-K, -C]))
        rates, vectors = np.linalg.eig(np.vstack([np.hstack([np.zeros((d, d)), np.eye(d)]), below]))
        order = sorted(range(2 * d), key=lambda i: (round(float(abs(rates[i])), 9), rates[i].imag))
        return tuple(Mode(sp.sympify(complex(rates[i]), strict=True), sp.Matrix(basis @ vectors[:d, i])) for i in order)

    @property
    def stable_if(self) -> sp.Basic:
        """When every mode stays bounded or decays: a condition on the parameters.

        It is sufficient and, but for equality, necessary.
        Without friction (det(s² M + s C + K) even in s): all roots s² real, negative and distinct: the coefficients and
        the Hankel minors of the roots' power sums are positive; without gyroscopic forces these are real, and may be equal.
        Otherwise so for the product of its even factors, and for that of the others the Routh–Hurwitz determinants are positive.
        Factors that are positive by the symbols' assumptions are divided out. Zero roots are left aside where they are those
        of rest elsewhere and of drifts at constant velocity; where a motion grows as t², it is false.
        Rates that several independent modes have at any parameters, as those of a spherical pendulum, count once.
        """
        natural = all(map(_is_zero, (*self.gyroscopic, *(self.stiffness - self.stiffness.T))))
        return sp.false if self._zeros > max(2, self._drifts) else stability_condition(self._pencil(_S), _S, natural)

    @property
    def _zeros(self) -> int:
        """How often s = 0 is a root of det(s² M + s C + K)."""
        coefficients = sp.Poly(sp.numer(sp.together(self._pencil(_S).det(method="berkowitz"))), _S).all_coeffs()
        return next(i for i, e in enumerate(reversed(coefficients)) if not _is_zero(e))

    @property
    def _drifts(self) -> int:
        """The dimension of K q = 0, of rest elsewhere, and that of K q + C v = 0 with K v = 0, of constant velocities v."""
        K = self.stiffness
        right, left = (m.nullspace(iszerofunc=_is_zero) for m in (K, K.T))
        coupled = sp.Matrix(len(left), len(right), lambda i, j: left[i].dot(self.gyroscopic * right[j]))
        return 2 * len(right) - int(coupled.rank(iszerofunc=_is_zero))


def stability_condition(pencil: sp.Matrix, s: sp.Symbol, natural: bool = False) -> sp.Basic:
    """When the roots s of det(pencil) = 0 are as `LinearSystem.stable_if` says; natural: of s² M + K, both symmetric."""
    pencil = pencil.applyfunc(lambda e: e.xreplace({x: sp.Rational(x) for x in e.atoms(sp.Float)}))
    factors = _last_invariant(pencil, s)
    parts = [sp.Mul(*factors)]
    if not _is_even(parts[0], s):
        parts = [sp.Mul(*(f for f in factors if _is_even(f, s) is even)) for even in (True, False)]
    conditions: list[sp.Expr] = []
    for part in parts:
        coefficients = _coefficients(part, s)
        if natural:
            conditions += [_reduce(x / coefficients[0]) for x in coefficients[2::2]]
        else:
            conditions += _all_negative(coefficients[::2]) if _is_even(part, s) else _hurwitz(coefficients)
    return _conjunction(conditions)


def _coefficients(e: sp.Expr, s: sp.Symbol) -> list[sp.Expr]:
    """Those of a polynomial in s, the highest first, without its zero roots."""
    coefficients = [_reduce(c) for c in sp.Poly(e, s).all_coeffs()]
    while _is_zero(coefficients[-1]):
        coefficients.pop()
    return coefficients


def _is_even(e: sp.Expr, s: sp.Symbol) -> bool:
    return all(_is_zero(c) for c in _coefficients(e, s)[1::2])


def _last_invariant(pencil: sp.Matrix, s: sp.Symbol) -> list[sp.Expr]:
    """The determinant's factors without what the minors of order n − 1 have in common of repeated ones: these stay repeated where
    motions grow as t exp(s t). Gantmacher, vol. 1, ch. VI (invariant polynomials)."""
    _, factors = sp.factor_list(sp.numer(sp.together(pencil.det(method="berkowitz"))))
    lasting = {f: k for f, k in factors if f.has(s)}
    repeated = [(f, k) for f, k in factors if k > 1 and f.has(s) and f != s]
    minors = [sp.Poly(e, s) for e in pencil.adjugate(method="berkowitz") if e != 0] if repeated else []
    for f, k in repeated:
        shared = 0
        while shared < k - 1 and all(
            all(map(_is_zero, m.rem(sp.Poly(f ** (shared + 1), s)).all_coeffs())) for m in minors
        ):
            shared += 1
        lasting[f] -= shared
    return [f**k for f, k in lasting.items()]


def point_of(where: str, system: Equations, at: Mapping[Any, Any], letters: Iterable[sp.Symbol]) -> dict[Any, Any]:
    """The point by symbol. Raises InputError for a name that is neither a coordinate, a velocity nor one of the letters."""
    known = {*letters} - {*system.c.v} | {*system.speeds}
    point = by_symbol(at, known)
    if strangers := [str(s) for s in point if s not in known]:
        raise InputError(
            f"{where}: {', '.join(strangers)} in the point: it gives coordinates, velocities "
            f"({', '.join(map(str, system.speeds))}) and letters of the system"
        )
    for joint in system.ball_joints:
        if all(q in point and sp.sympify(point[q], strict=True).is_zero for q in joint.quaternion):
            raise InputError(f"{where}: {no_turn(joint.quaternion, 0)}")
    return point


def no_turn(quaternion: Sequence[sp.Symbol], norm: float) -> str:
    """Why a quaternion cannot be a start."""
    return f"the quaternion ({', '.join(map(str, quaternion))}) has norm {norm:.3g} and gives no direction: give one of norm 1"


def linearise(system: Equations, at: Mapping[sp.Symbol, Any] | Equilibrium) -> LinearSystem:
    """The linear system about an equilibrium, in a basis of the null space of the constraints.

    at: values of the coordinates on which the motion depends; velocities are zero unless given (a steady motion in a
    coordinate on which nothing depends), and a parameter may be given too. Where the equations are 0/0 there, they are
    first reduced.

    Raises SingularError when the point is no equilibrium, or a singular one of these coordinates, or the constraints are
    dependent there; InputError when something depends on time.
    """
    c = system.c
    letters = {*c.q, *system.speeds} | system.L.free_symbols | system.motion.free_symbols | system.residual.free_symbols
    place = point_of("linearise", system, at.at if isinstance(at, Equilibrium) else at, letters)
    point = {s: x for s, x in place.items() if s in c.v or s not in system.speeds}  # those of one's own are zero
    used = system.motion.free_symbols | system.residual.free_symbols
    if missing := [str(q) for q in c.q if q not in point and q in used]:
        raise InputError(f"linearise: {', '.join(missing)} without a value: the point needs each coordinate's")
    still = dict.fromkeys((*c.v, *c.a), 0) | point
    if system.push.free_symbols & {*system.multipliers}:
        raise InputError(
            "linearise: a force has the reaction of a constraint: give outputs or a velocity, for A, B, C, D"
        )
    motion = euler_lagrange(system.L, c) - system.push
    if moving := [str(q) for q, v in zip(c.q, c.v, strict=True) if q in used and still[v] != 0]:
        raise InputError(f"linearise: {', '.join(moving)} moves there and enters the equations: give it no velocity")
    if system.rolling and any(still[v] != 0 for v in c.v):
        raise InputError("linearise: a steady motion under rolling constraints is not linearised: simulate near it")
    if any(decide_zero(derivative(e, t)).answer != "zero" for e in (*motion, *system.residual)):
        raise InputError(
            "linearise: the motion depends on time explicitly: give functions F(t) as inputs, or simulate it"
        )
    force = _value(motion, still, c.q)
    G = _value(system.rows, still, c.q)
    lam = _held_by(force, G, at)
    held = motion - system.rows.T * lam
    basis = sp.Matrix.hstack(*G.nullspace(iszerofunc=_is_zero)) if G.rows else sp.eye(len(c.q))
    mass, gyroscopic, stiffness = (
        (basis.T * _value(jacobian(held, names), still, c.q) * basis).applyfunc(_reduce) for names in (c.a, c.v, c.q)
    )
    if _is_zero(mass.det(method="berkowitz")):
        raise SingularError(f"linearise: the mass matrix is singular at {point}: use coordinates regular there")
    return LinearSystem(mass, gyroscopic, stiffness, basis)


def _held_by(force: sp.Matrix, G: sp.Matrix, at: Any) -> sp.Matrix:
    """The multipliers that hold the point: force = Gᵀ λ."""
    normal = G * G.T
    det = normal.det(method="berkowitz")
    if _is_zero(det):
        raise SingularError(f"linearise: the constraints are dependent at {at}: leave out what follows from the others")
    lam = normal.adjugate() * G * force / det if G.rows else sp.zeros(0, 1)
    left = [decide_zero(e).answer for e in force - G.T * lam]
    # What `equilibria` solved is an equilibrium, also where its roots are outside the class that is decided.
    if "nonzero" in left or ("undecided" in left and not isinstance(at, Equilibrium)):
        raise SingularError(f"linearise: {at} is no equilibrium: a force is left over; start from one")
    return lam


def _value(matrix: sp.Matrix, still: Mapping[sp.Symbol, Any], q: tuple[sp.Symbol, ...]) -> sp.Matrix:
    """A matrix at the point, parameters first; an entry that is 0/0 there is reduced before."""
    at = {s: sp.sympify(value, strict=True) for s, value in still.items()}
    parameters = {s: value for s, value in at.items() if s not in q}
    rest = {s: value for s, value in parameters.items() if value == 0}
    general = any(value.free_symbols for value in at.values())

    def value(entry: sp.Expr) -> sp.Expr:
        if general:  # reduced while its symbols are independent, before roots are put in
            entry = _reduce(put_in(entry, rest))
        entry = put_in(entry, parameters)
        number = put_in(entry, at)
        if number.has(sp.nan, sp.zoo, sp.oo):
            try:
                number = put_in(normal_form(entry), at)
            except NotExactError:
                number = sp.nan
        if number.has(sp.nan, sp.zoo, sp.oo):
            raise SingularError(
                f"linearise: {entry} is singular at {dict(still)}: use coordinates that are regular there"
            )
        if number.has(sp.DiracDelta):
            raise InputError(f"linearise: {entry} jumps at {dict(still)}: write the case that holds there")
        return number

    return matrix.applyfunc(value) if len(matrix) else matrix


def _reduce(e: sp.Expr) -> sp.Expr:
    """A shorter form of the same: unique where the class of decisions has one."""
    try:
        return sp.factor(normal_form(e))
    except NotExactError:
        return sp.factor(e)


def _is_zero(e: sp.Expr) -> bool:
    return e == 0 or decide_zero(e).answer == "zero"


def _roots(factor: sp.Poly) -> list[sp.Expr]:
    """Roots of a factor of degree one or two in s, or of degree one or two in s²."""
    s = factor.gen
    if factor.degree() <= 2:
        return list(sp.roots(factor, multiple=True))
    even = all(power % 2 == 0 for (power,) in factor.monoms())
    if even and factor.degree() == 4:
        squares = sp.roots(sp.Poly(factor.as_expr().subs(s, sp.sqrt(s)), s), multiple=True)
        return [sign * sp.sqrt(square) for square in squares for sign in (1, -1)]
    raise InputError(f"modes: {factor.as_expr()} = 0 is not solved in closed form: give values={{symbol: number, …}}")


def _all_negative(a: list[sp.Expr]) -> list[sp.Expr]:
    """What must be positive for a_0 x^n + … + a_n to have real, negative and distinct roots only."""
    a = [_reduce(x / a[0]) for x in a]
    n = len(a) - 1
    sums: list[sp.Expr] = [sp.Integer(n)]
    for k in range(1, 2 * n - 1):  # Newton's identities
        total = sum((a[i] * sums[k - i] for i in range(1, min(k, n + 1)) if i <= n), sp.S.Zero)
        sums.append(-total - (k * a[k] if k <= n else 0))
    hankel = [sp.Matrix(m, m, lambda i, j: sums[i + j]).det(method="berkowitz") for m in range(2, n + 1)]
    return [*a[1:], *hankel]


def _hurwitz(a: list[sp.Expr]) -> list[sp.Expr]:
    """The leading coefficient divided out, the coefficients and the Routh–Hurwitz determinants."""
    a = [_reduce(x / a[0]) for x in a]
    n = len(a) - 1

    def entry(i: int, j: int) -> sp.Expr:
        place = 2 * j - i + 1
        return a[place] if 0 <= place <= n else sp.S.Zero

    return [*a[1:], *(sp.Matrix(m, m, entry).det(method="berkowitz") for m in range(2, n))]


def _conjunction(expressions: list[sp.Expr]) -> sp.Basic:
    """All of them positive: positive factors divided out, and what another one implies left out."""
    kept = list(dict.fromkeys(part for e in expressions for part in _essential(e) if not part.is_positive))
    if any(e.is_nonpositive for e in kept):
        return sp.false
    more = {(e, other): sp.Add.make_args(sp.expand(e - other)) for e in kept for other in kept if e != other}
    implied = {e for (e, _), terms in more.items() if all(term.is_nonnegative for term in terms)}
    return sp.And(*(sp.Gt(e, 0) for e in kept if e not in implied))


def _essential(e: sp.Expr) -> list[sp.Expr]:
    """What must be positive for e to be: its factors of odd power together, the squares of the others each."""
    above, below = sp.fraction(sp.together(_reduce(e)))
    coefficient, factors = sp.factor_list(above * below)
    odd = [factor for factor, power in factors if power % 2 and not factor.is_positive]
    product = sp.sign(coefficient) * sp.Mul(*odd)
    return [sp.expand(product) if len(odd) == 1 else product, *(f**2 for f, power in factors if power % 2 == 0)]
