"""The Hamiltonian of a system: momenta, Poisson brackets, first integrals, canonical transformations.

    q' = ∂H/∂p,   p' = −∂H/∂q,       {f, g} = ∂f/∂q·∂g/∂p − ∂f/∂p·∂g/∂q.

Arnold, Mathematical Methods of Classical Mechanics, §§ 38–45; Marsden & Ratiu, Introduction to Mechanics and Symmetry, ch. 6.

Canonical transformations (q, p) → (Q, P) come from a generating function of the second kind, F(q, P, t),

    p = ∂F/∂q,     Q = ∂F/∂P,     K = H + ∂F/∂t,

for every F with det ∂²F/∂q∂P ≠ 0. If K does not contain Q, the P are first integrals: the Hamilton–Jacobi equation.
Goldstein, Classical Mechanics, § 9.1, ch. 10; Arnold, § 48.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from lagrotor.algebra import Decision, decide_equal, decide_zero, derivative
from lagrotor.errors import DomainError, InputError, SingularError
from lagrotor.mechanics.equations import Equations, no_states
from lagrotor.mechanics.expressions import by_symbol, expression, no_letter, shortest, vector_of
from lagrotor.mechanics.lagrangian import gradient, jacobian, linear_solve, t
from lagrotor.mechanics.symmetry import legendre
from lagrotor.result_display import Shown

if TYPE_CHECKING:
    from lagrotor.mechanics.canonical.normal_forms import NormalForm
    from lagrotor.mechanics.canonical.return_maps import ReturnMapForm


@dataclass(frozen=True, repr=False)
class Hamiltonian(Shown):
    """A Hamiltonian H(q, p, t) with the Poisson bracket of its variables.

    Every method raises InputError for a function that contains a velocity, or a symbol that has only the name in common with
    one of q, p and t; it would count as a constant.

    Attributes
    ----------
    H : Expr
        The Hamiltonian.
    q : tuple of Symbol
    p : tuple of Symbol
        The coordinates and momenta.
    v : tuple of Symbol
        The velocities of the Lagrangian.

    Examples
    --------
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("x")
    >>> h = System(c, c.x_dot**2 / 2 - c.x**2 / 2).hamiltonian()
    >>> (x,), (p,) = h.q, h.p
    >>> h.bracket(x, p), h.rate(x), h.conserved(p**2 + x**2).answer, h.canonical((p,), (-x,)).answer
    (1, p_x, 'zero', 'zero')
    """

    _shown = (
        ("H", "H"),
        ("coordinates", "q"),
        ("momenta", "p"),
    )

    H: sp.Expr
    q: tuple[sp.Symbol, ...]
    p: tuple[sp.Symbol, ...]
    v: tuple[sp.Symbol, ...] = ()

    def bracket(self, f: sp.Expr, g: sp.Expr) -> sp.Expr:
        """Return the Poisson bracket {f, g}.

        Parameters
        ----------
        f, g : Expr
            Functions of q, p and t.

        Returns
        -------
        Expr
            The bracket, in q, p and t.
        """
        f, g = self._function("bracket", f), self._function("bracket", g)
        fq, fp, gq, gp = (gradient(e, s) for e in (f, g) for s in (self.q, self.p))
        return shortest(fq.dot(gp) - fp.dot(gq))

    def _function(self, where: str, f: sp.Expr) -> sp.Expr:
        e, names = expression(where, f), {str(s): s for s in (*self.q, *self.p, t)}
        for s in sorted(e.free_symbols, key=str):
            if s in self.v:
                raise InputError(f"{where}: {e} contains the velocity {s}: write it by the momenta {self.p}")
            if names.get(str(s), s) != s:
                raise InputError(
                    f"{where}: {s} in {e} is another symbol than the {s} of H: use those of h.q, h.p and t"
                )
        return e

    def rate(self, f: sp.Expr) -> sp.Expr:
        """Return df/dt = {f, H} + ∂f/∂t along a motion.

        Parameters
        ----------
        f : Expr
            A function of q, p and t.

        Returns
        -------
        Expr
            df/dt in q, p and t.
        """
        return shortest(self.bracket(f, self.H) + derivative(f, t))

    def conserved(self, f: sp.Expr) -> Decision:
        """Decide if f is a first integral.

        Parameters
        ----------
        f : Expr
            A function of q, p and t.

        Returns
        -------
        Decision
            "zero" if df/dt vanishes.
        """
        return decide_zero(self.bracket(f, self.H) + derivative(f, t))

    def canonical(self, Q: Sequence[sp.Expr], P: Sequence[sp.Expr]) -> Decision:
        """Decide if (q, p) → (Q, P) preserves the brackets: {Q_i, P_j} = δ_ij, all others zero. Arnold § 45.

        Parameters
        ----------
        Q, P : sequence
            n functions of q, p and t each.

        Returns
        -------
        Decision
            "zero" if the transformation is canonical.
        """
        n = len(self.q)
        new = sp.Matrix([*vector_of("canonical: Q", Q, n), *vector_of("canonical: P", P, n)])
        brackets = sp.Matrix(2 * n, 2 * n, lambda a, b: self.bracket(new[a], new[b]))
        return decide_equal(brackets, sp.Matrix(sp.BlockMatrix([[sp.zeros(n), sp.eye(n)], [-sp.eye(n), sp.zeros(n)]])))

    def generated(self, F: sp.Expr, P: Sequence[sp.Symbol]) -> "GeneratedTransformation":
        """Return the canonical transformation of a generating function F(q, P, t).

        Parameters
        ----------
        F : Expr
            The function, without old momenta.
        P : sequence
            New symbols of the new momenta.

        Returns
        -------
        GeneratedTransformation
            The transformation and the new Hamiltonian.

        Raises
        ------
        SingularError
            If det ∂²F/∂q∂P vanishes identically.
        """
        F, q, p = self._function("generated: F", F), self.q, self.p
        new = vector_of("generated: P", P, len(q))
        used = {*q, *p, t} | self.H.free_symbols
        if len({*new}) < len(new) or not all(isinstance(s, sp.Symbol) and s not in used for s in new):
            raise InputError(f"generated: P = {new} must be {len(q)} symbols that H does not have: name new ones")
        if old := F.free_symbols & {*p}:
            raise InputError(
                f"generated: F = {F} contains {', '.join(sorted(map(str, old)))}: it is a function of q and P"
            )
        p_of = gradient(F, q)
        if decide_zero(jacobian(p_of, new).det(method="berkowitz")).answer == "zero":
            raise SingularError(
                f"generated: det ∂²F/∂q∂P = 0 for F = {F}: it generates no transformation; choose another F"
            )
        K = shortest(self.H.xreplace(dict(zip(p, p_of, strict=True))) + derivative(F, t))
        return GeneratedTransformation(new, tuple(p), tuple(p_of), tuple(gradient(F, new)), K)

    def normal_form(
        self,
        order: int,
        at: Mapping[Any, Any],
        values: Mapping[Any, Any] | None = None,
        detuning: float = 0.0,
        period: float | None = None,
    ) -> "NormalForm":
        """Compute Birkhoff's normal form about an equilibrium, or about a periodic orbit.

        A steady motion is an equilibrium of the system that `System.routh` returns. If its momenta are symbols, the
        derivatives of the normal form with respect to them are the mean rates of the cyclic angles.

        Parameters
        ----------
        order : int
            The highest degree in the coordinates and momenta.
        at : mapping or Equilibrium
            {coordinate or momentum: value}. If no momentum is named, the momenta are those of rest. For an orbit velocities
            may be named instead, and t gives the time of the point under a drive (0 by default).
        values : mapping or None, optional
            {symbol: number}; without them the coefficients are exact if the frequencies are rational, or rational in the
            parameters.
        detuning : float, default 0.0
            Integer combinations of the frequencies up to this size, in rad/s, count as resonances.
        period : float or None, optional
            The period of the orbit in s. It is exact under a drive; otherwise an approximate one finds the orbit with the
            energy of `at`.

        Returns
        -------
        NormalForm or ReturnMapForm
            The normal form about an equilibrium; with a period, the normal form of the return map of the orbit.

        Raises
        ------
        DomainError
            If H is not analytic there, or depends on time without a period.
        SingularError
            If a multiplier of the orbit is 1 or −1.
        """
        from lagrotor.mechanics.canonical.normal_forms import normal_form_at

        x = (*self.q, *self.p)
        if self.H.has(t) and period is None:
            raise DomainError("normal_form: H depends on time: name the period of an orbit")
        if period is not None:
            return self._about_orbit(order, at, values or {}, detuning, period)
        H, point = self._with_values(at, x, values or {})
        if strange := [str(s) for s in point if s not in x]:
            raise InputError(f"normal_form: at: {', '.join(strange)} not among {x}: name coordinates and momenta")
        q, p = self.q, self.p
        if missing := [str(s) for s in q if s not in point and H.has(s)]:
            raise InputError(
                f"normal_form: {', '.join(missing)} without a value: give the point a value for each coordinate"
            )
        at_rest = dict.fromkeys(x, sp.S.Zero) | point
        if not point.keys() & {*p}:
            slopes = gradient(H, p).xreplace({s: at_rest[s] for s in q})
            still = -slopes.xreplace(dict.fromkeys(p, sp.S.Zero))
            refusal = "normal_form: det ∂²H/∂p∂p = 0 there: name the momenta"
            at_rest |= dict(zip(p, linear_solve(jacobian(slopes, p), still, refusal), strict=True))
        return normal_form_at(H, x, at_rest, order, detuning)

    def _with_values(
        self, at: Mapping[Any, Any], named: Sequence[sp.Symbol], values: Mapping[Any, Any]
    ) -> tuple[sp.Expr, dict[sp.Symbol, sp.Expr]]:
        """Return H and the point {symbol: value}, both with the values of the parameters substituted."""
        where = "normal_form"
        point = {s: expression(f"{where}: {s}", e) for s, e in by_symbol(f"{where}: at", at, named).items()}
        letters = self.H.free_symbols.union(*(e.free_symbols for e in point.values()))
        numbers = {s: expression(f"{where}: {s}", e) for s, e in by_symbol(f"{where}: values", values, letters).items()}
        return self.H.xreplace(numbers), {s: e.xreplace(numbers) for s, e in point.items()}

    def _about_orbit(
        self, order: int, at: Mapping[Any, Any], values: Mapping[Any, Any], detuning: float, period: float
    ) -> "ReturnMapForm":
        """Compute the normal form of the return map; the momentum of an angle that H does not contain is a parameter."""
        from lagrotor.mechanics.canonical.normal_forms import check_form_order
        from lagrotor.mechanics.canonical.return_maps import return_map_form

        check_form_order(order, detuning)
        try:
            duration = float("nan" if isinstance(period, str | bool) else period)
        except (TypeError, ValueError):
            duration = float("nan")
        if not 0 < duration < float("inf"):
            raise InputError(f"normal_form: period = {period!r} must be a positive time in s")
        x = (*self.q, *self.p)
        H, point = self._with_values(at, (*x, *self.v, t), values)
        if strange := [str(s) for s in point if s not in {*x, *self.v, t}]:
            raise InputError(f"normal_form: at: {', '.join(strange)} not among {x}, {self.v} and t: name these")
        if missing := [str(s) for s in self.q if s not in point and self.H.has(s)]:
            raise InputError(
                f"normal_form: {', '.join(missing)} without a value: give the start a value for each coordinate"
            )
        no_letter("normal_form", (H.free_symbols - {*x, t}).union(*(e.free_symbols for e in point.values())))
        place = dict.fromkeys(self.q, sp.S.Zero) | {t: sp.S.Zero} | point
        if not point.keys() & {*self.p}:
            slopes = gradient(H, self.p).xreplace({s: place[s] for s in (*self.q, t)})
            rates = sp.Matrix([point.get(v, 0) for v in self.v]) - slopes.xreplace(dict.fromkeys(self.p, sp.S.Zero))
            refusal = "normal_form: det ∂²H/∂p∂p = 0 at the start: name the momenta"
            place |= dict(zip(self.p, linear_solve(jacobian(slopes, self.p), rates, refusal), strict=True))
        elif both := [str(s) for s in point if s in self.v]:
            raise InputError(f"normal_form: at names momenta and velocities ({', '.join(both)}): give one kind")
        start = {s: float(place.get(s, 0)) for s in (*x, t)}
        present = [H.has(q) for q in self.q]
        H = H.xreplace({p: sp.Float(start[p], 17) for p, enters in zip(self.p, present, strict=True) if not enters})
        x = tuple(s for s, enters in zip(x, present * 2, strict=True) if enters)
        return return_map_form(H, x, start, duration, int(order), float(detuning))


def hamiltonian(system: Equations, momenta: Sequence[sp.Symbol] | None = None) -> Hamiltonian:
    """Return H = p·v − L: `System.hamiltonian`."""
    if system.forces or system.dissipation != 0 or system.rolling or system.constraints:
        raise DomainError(
            "hamiltonian: forces, friction and constraints have no Hamiltonian here: write potentials of forces into L, and use "
            "independent coordinates, System.in_coordinates"
        )
    no_states("hamiltonian", system, "they have no momenta: leave them out, or make each a coordinate")
    c, L = system.c, system.L
    if momenta is not None and not isinstance(momenta, Iterable):
        raise InputError(f"hamiltonian: momenta = {momenta!r} must be symbols, one for each of {c.q}")
    p = tuple(momenta) if momenta is not None else tuple(sp.Symbol(f"p_{q}", real=True) for q in c.q)
    return Hamiltonian(shortest(legendre(L, c, p)), c.q, p, c.v)


@dataclass(frozen=True, repr=False)
class GeneratedTransformation(Shown):
    """A canonical transformation by a generating function. Solve p = p_of for P, as with sympy's solve, to get P(q, p, t).

    Attributes
    ----------
    new : tuple of Symbol
    old : tuple of Symbol
        The symbols of the new momenta P and of the old momenta p.
    p_of : tuple of Expr
    Q_of : tuple of Expr
        The old momenta and the new coordinates in (q, P, t).
    K : Expr
        The new Hamiltonian in (q, P, t).
    """

    _shown = (
        ("old momenta", lambda g: dict(zip(g.old, g.p_of, strict=True))),
        ("new coordinates", "Q_of"),
        ("new momenta", "new"),
        ("new Hamiltonian", "K"),
    )

    new: tuple[sp.Symbol, ...]
    old: tuple[sp.Symbol, ...]
    p_of: tuple[sp.Expr, ...]
    Q_of: tuple[sp.Expr, ...]
    K: sp.Expr
