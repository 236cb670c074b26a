"""What unknown functions in a Lagrangian, a force or a constraint are when it runs: U(r), a support y_s(t), a control u(t).

A value is an expression, put in before anything else; a callable with the derivatives that the equations need; or a table or
a piecewise polynomial of scipy, which is followed piece by piece, each knot an end of a phase: between knots a motion is
smooth, so that a solver's error is what it estimates. A table is interpolated by a cubic spline (de Boor, A Practical Guide
to Splines, ch. IV), whose derivatives are those of its polynomials.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import factorial
from typing import Any, TypeVar

import numpy as np
import sympy as sp
from sympy.core.function import AppliedUndef, UndefinedFunction

from lagrotor.errors import InputError, IntegrationError, near
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import expression, unknown_functions, with_jets
from lagrotor.mechanics.lagrangian import t
from lagrotor.mechanics.running.switches import Event, Impact
from lagrotor.numerics.arrays import Array as Array

Orders = tuple[int, ...]
Kind = TypeVar("Kind", bound=Equations)
_BEYOND = 1e-12  # of a piece, by which it is followed beyond its knots


@dataclass(frozen=True, eq=False)
class FunctionValue:
    """A function in numbers: its derivatives by orders, those that are known; of a spline its knots (m + 1,) and the
    coefficients (k + 1, m) of (w − knot)^k … 1 on each piece."""

    name: str
    derivatives: Mapping[Orders, Callable[..., Any]]
    knots: Array | None = None
    coefficients: Array | None = None

    def jet(self, where: str, orders: Orders) -> Callable[..., Any]:
        """A derivative as a function of numbers, or of arrays, or of numbers with small imaginary parts (a complex step).

        Raises InputError where it is not known.
        """
        f = self._known(where, orders)

        def one(*at: float) -> float:
            try:
                return float(f(*at))
            except TypeError:
                shown = f"{jet_name(self.name, orders)}({', '.join(map(str, at))})"
                raise IntegrationError(f"{where}: {shown} gives {f(*at)!r}, which is no number: correct it") from None

        def call(*at: Any) -> Any:
            if all(np.ndim(x) == 0 and not isinstance(x, complex | np.complexfloating) for x in at):
                return one(*map(float, at))
            places = np.broadcast_arrays(*at)
            real = np.array([one(*map(float, x)) for x in zip(*(p.real.ravel() for p in places), strict=True)])
            values = real.reshape(places[0].shape)
            if not any(np.iscomplexobj(p) for p in places):
                return values
            for i, p in enumerate(places):
                if p.imag.any():
                    slope = self.jet(where, (*orders[:i], orders[i] + 1, *orders[i + 1 :]))
                    values = values + 1j * p.imag * slope(*(p.real for p in places))
            return values + 0j

        return call

    def _known(self, where: str, orders: Orders) -> Callable[..., Any]:
        if self.knots is not None and len(orders) == 1:
            return self._spline(orders[0])
        if orders not in self.derivatives:
            one = len(orders) == 1
            way = (
                f"give values={{{self.name}: ({', '.join(jet_name(self.name, (k,)) for k in range(orders[0] + 1))})}}, "
                "callables, "
                "a table (x, y), or an expression"
                if one
                else f"give values={{{self.name}: {{{orders}: callable, …}}}}, or an expression"
            )
            raise InputError(
                f"{where}: the equations contain {jet_name(self.name, orders)}, which a callable for {self.name} alone does not "
                f"give: {way}"
            )
        return self.derivatives[orders]

    def _spline(self, order: int) -> Callable[[float], float]:
        knots, c = self.knots, self.coefficients
        assert knots is not None and c is not None
        k = len(c) - 1
        if order > k:
            return lambda x: 0.0
        factors = [factorial(k - i) / factorial(k - i - order) for i in range(k + 1 - order)]

        def value(x: float) -> float:
            i = self.piece(x)
            if i is None:
                return np.nan
            total = 0.0
            for factor, coefficient in zip(factors, c[:, i], strict=False):
                total = total * (x - knots[i]) + factor * coefficient
            return float(total)

        return value

    def piece(self, x: float) -> int | None:
        """The number of the piece that x lies in; None outside the table."""
        assert self.knots is not None
        low, high = self.knots[0], self.knots[-1]
        room = 2 * self.room(0 if x < low else len(self.knots) - 2)
        if not low - room <= x <= high + room:
            return None
        return int(np.clip(np.searchsorted(self.knots, x, side="right") - 1, 0, len(self.knots) - 2))

    def room(self, i: int) -> float:
        """By how much a piece is followed beyond its knots, above rounding."""
        assert self.knots is not None
        return float(_BEYOND * (self.knots[i + 1] - self.knots[i]) + 8 * np.finfo(float).eps * np.abs(self.knots).max())


def jet_name(name: str, orders: Orders) -> str:
    """U, U', U''; of several arguments U^(1,0)."""
    if len(orders) == 1:
        return name + "'" * orders[0]
    return f"{name}^({','.join(map(str, orders))})" if any(orders) else name


def put_functions(where: str, system: Kind, values: Any, others: Sequence[sp.Expr] = ()) -> tuple[Kind, Any]:
    """The system with the expressions among the values of its functions put in, and the values: numbers by symbol or name,
    and for each function its form, a Lambda, or a `FunctionValue`. others: expressions that may have functions, too.

    Raises InputError for a function without a value, a value that is none, and one that the system does not have.
    """
    energy = system.L if system.bodies else system.lagrangian
    parts = [energy, *system.acting, *(e for _, e in system.velocities), *others]
    applied = unknown_functions(parts)
    known = {str(f.func): f.func for f in applied}
    if not isinstance(values, Mapping):
        raise InputError(f"{where}: values = {values!r} must be {{symbol: number, …}}, a dictionary")
    if not (known or any(isinstance(key, UndefinedFunction) for key in values)):
        return system, values
    named = {
        str(key): value for key, value in values.items() if isinstance(key, UndefinedFunction) or str(key) in known
    }
    if letters := sorted(known.keys() & {str(s) for e in parts for s in e.free_symbols}):
        raise InputError(f"{where}: {letters[0]} is a letter of the system and a function in it: rename one")
    names = [str(key) for key in values]
    if twice := sorted(name for name in named if names.count(name) > 1):
        raise InputError(f"{where}: {twice[0]} with two values, of the function and of its name: give one")
    if strangers := sorted(named.keys() - known.keys()):
        raise InputError(
            f"{where}: values name the function {strangers[0]}, which the system does not have{near(strangers[0], known)}"
        )
    if missing := sorted(known.keys() - named.keys()):
        raise InputError(
            f"{where}: {', '.join(missing)} without a value: values = {{{missing[0]}: an expression, a callable, "
            "or a table (x, y)}"
        )
    numbers: dict[Any, Any] = {key: value for key, value in values.items() if str(key) not in known}
    written: dict[str, sp.Lambda] = {}
    for name, value in named.items():
        places = {f.args for f in applied if str(f.func) == name}
        made = _value(where, name, places, value)
        if isinstance(made, sp.Lambda):
            if moving := made.free_symbols & {*system.c.q, *system.c.v, *system.c.a, t}:
                raise InputError(
                    f"{where}: {name} = {made.expr} contains {', '.join(sorted(map(str, moving)))}, of which {applied[0]} is no "
                    f"function: write it into the system, {name} with more arguments"
                )
            written[name] = made
        numbers[name] = made
    return (_with_expressions(system, written) if written else system), numbers


def inputs_as_letters(where: str, system: Kind, inputs: Sequence[Any]) -> tuple[Kind, tuple[Any, ...]]:
    """The system with letters of their names for functions of time F(t) that are inputs, and the inputs as letters.

    Raises InputError where a derivative of one enters, or one of another argument than t.
    """
    functions = [u for u in inputs if isinstance(u, AppliedUndef)]
    if other := [u for u in functions if u.args != (t,)]:
        raise InputError(f"{where}: the input {other[0]} must be a function of t alone, F(t), or a letter")
    names = {str(u.func): sp.Symbol(str(u.func), real=True) for u in functions}
    acting = (system.L, *system.acting)
    if twice := names.keys() & {str(s) for e in acting for s in e.free_symbols}:
        raise InputError(f"{where}: {min(twice)} is a letter and a function: rename one")

    def refused(name: str, orders: Orders, arguments: tuple[sp.Expr, ...]) -> None:
        if name in names and arguments != (t,):
            entered = f"{name}({', '.join(map(str, arguments))})"
            raise InputError(f"{where}: {entered} enters beside the input {name}(t): rename it")
        if name in names and any(orders):
            raise InputError(
                f"{where}: {jet_name(name, orders)} of the input {name} enters: write it as a coordinate, or a letter"
            )

    for e in acting:
        with_jets(e, refused)
    forms = {name: sp.Lambda(t, letter) for name, letter in names.items()}
    letters = tuple(names[str(u.func)] if isinstance(u, AppliedUndef) else u for u in inputs)
    return _with_expressions(system, forms), letters


def _with_expressions(system: Kind, written: Mapping[str, sp.Lambda]) -> Kind:
    """The system with expressions in place of functions."""

    def put(e: sp.Expr) -> sp.Expr:
        return with_values(e, written)

    if not system.bodies:
        return _with_each(system, put(system.lagrangian), put)
    energy = system.lagrangian
    of_bodies = unknown_functions(system.L - sp.sympify(energy.rest, strict=True))  # in the place of a frame
    return _with_each(system, put(system.L) if of_bodies else replace(energy, rest=put(energy.rest)), put)


def _with_each(system: Kind, lagrangian: Any, put: Callable[[sp.Expr], sp.Expr]) -> Kind:
    """The system with another Lagrangian, and `put` applied to all else that acts."""
    return replace(
        system,
        lagrangian=lagrangian,
        constraints=tuple(map(put, system.constraints)),
        rolling=tuple(map(put, system.rolling)),
        dissipation=put(system.dissipation),
        forces=tuple(map(put, system.forces)),
        velocities=tuple((u, put(e)) for u, e in system.velocities),
    )


def with_values(e: sp.Expr, values: Mapping[Any, Any]) -> sp.Expr:
    """An expression with those functions written out whose values are expressions."""

    def made(name: str, orders: Orders, arguments: tuple[sp.Expr, ...]) -> sp.Expr | None:
        form = values.get(name)
        if not isinstance(form, sp.Lambda):
            return None
        body, letters = form.expr, form.variables
        for letter, order in zip(letters, orders, strict=True):
            body = sp.diff(body, letter, order) if order else body
        return body.subs(dict(zip(letters, arguments, strict=True)), simultaneous=True)

    return with_jets(e, made)


def _value(where: str, name: str, places: set[tuple[sp.Expr, ...]], given: Any) -> sp.Lambda | FunctionValue:
    """A value as an expression of its arguments or as a function of numbers."""
    count = len(next(iter(places)))
    if isinstance(given, FunctionValue):
        return given
    if isinstance(given, sp.Lambda):
        if len(given.variables) != count:
            raise InputError(
                f"{where}: {name} = {given} has {len(given.variables)} arguments, where the system has {count}"
            )
        form = sp.Lambda(given.variables, expression(f"{where}: {name}", given.expr))
        return _alone(where, name, form)
    if isinstance(given, sp.Expr | int | float) and not isinstance(given, bool):
        body = expression(f"{where}: {name}", given)
        (letters,) = places if len(places) == 1 else (None,)
        if letters is None or not all(a.is_Symbol for a in letters) or len({*letters}) < count:
            if body.free_symbols & set().union(*(a.free_symbols for place in places for a in place)):
                raise InputError(
                    f"{where}: {name} = {body} is of no argument that is a letter alone, as in "
                    f"{name}({min(', '.join(map(str, place)) for place in places)}): "
                    "give sympy's Lambda(x, expression in x)"
                )
            letters = sp.symbols(f"_x:{count}", real=True, cls=sp.Dummy)
        return _alone(where, name, sp.Lambda(tuple(letters), body))
    if count == 1 and (spline := _spline_of(where, name, given)) is not None:
        return spline
    if callable(given):
        return FunctionValue(name, {(0,) * count: given})
    if (
        isinstance(given, Sequence)
        and not isinstance(given, str)
        and given
        and all(map(callable, given))
        and count == 1
    ):
        return FunctionValue(name, {(k,): f for k, f in enumerate(given)})
    if isinstance(given, Mapping) and given and all(map(callable, given.values())):
        orders = {key if isinstance(key, tuple) else (key,): f for key, f in given.items()}
        if all(len(key) == count and all(isinstance(k, int) and k >= 0 for k in key) for key in orders):
            return FunctionValue(name, orders)
    raise InputError(
        f"{where}: {name} = {given!r} is no function of {count} argument{'s' * (count > 1)}: give an expression, a callable, "
        "callables "
        f"({name}, {name}', …), a table (x, y) of increasing x, or a spline of scipy"
    )


def _alone(where: str, name: str, form: sp.Lambda) -> sp.Lambda:
    if form.expr.atoms(AppliedUndef):
        raise InputError(f"{where}: {name} = {form.expr} contains a function without a value: write it out")
    return form


def _spline_of(where: str, name: str, given: Any) -> FunctionValue | None:
    """The piecewise polynomial of a table or a spline; None for what is neither. Raises InputError for a table that is none."""
    from scipy.interpolate import BSpline, CubicSpline, PPoly

    if isinstance(given, BSpline):
        given = PPoly.from_spline(given)
    if not isinstance(given, PPoly):
        pair = isinstance(given, Sequence | np.ndarray) and not isinstance(given, str) and len(given) == 2
        if not pair or any(callable(part) or np.ndim(part) != 1 for part in given):
            return None
        try:
            x, y = (np.array(part, float) for part in given)
        except (TypeError, ValueError):
            raise InputError(f"{where}: {name} = {given!r}: a table is two arrays of numbers, (x, y)") from None
        if len(x) != len(y) or len(x) < 2 or not (np.isfinite(x).all() and np.isfinite(y).all()):
            raise InputError(
                f"{where}: {name}: a table (x, y) has as many finite y as x, at least two: these are {len(x)} and {len(y)}"
            )
        if (np.diff(x) <= 0).any():
            raise InputError(f"{where}: {name}: the x of a table increase, each greater than the one before: sort it")
        given = CubicSpline(x, y)
    c, knots = np.asarray(given.c), np.asarray(given.x, float)
    if c.ndim != 2 or np.iscomplexobj(c) or not (np.isfinite(c).all() and np.isfinite(knots).all()):
        raise InputError(f"{where}: {name}: a spline of scipy must have real, finite values, one at each place")
    own = np.flatnonzero(np.diff(knots) > 0)
    return FunctionValue(name, {}, np.append(knots[own], knots[-1]), np.asarray(c[:, own], float))


@dataclass(frozen=True)
class Piece:
    """U(w) of a spline, on one of its pieces a polynomial in `argument` less `start` with the `coefficients`, whose values are
    those of the piece, as those of `low` and `high`, between which it holds."""

    value: FunctionValue
    argument: sp.Expr
    start: sp.Symbol
    coefficients: tuple[sp.Symbol, ...]
    low: sp.Symbol
    high: sp.Symbol

    def numbers(self, i: int) -> dict[str, float]:
        """The values of its symbols on piece i."""
        assert self.value.knots is not None and self.value.coefficients is not None
        knots, room = self.value.knots, self.value.room(i)
        known = {str(self.start): knots[i], str(self.low): knots[i] - room, str(self.high): knots[i + 1] + room}
        return known | dict(zip(map(str, self.coefficients), self.value.coefficients[:, i], strict=True))

    def polynomial(self, order: int) -> sp.Expr:
        """U(w), or a derivative."""
        k, w, total = len(self.coefficients) - 1, self.argument - self.start, sp.S.Zero
        for i, c in enumerate(self.coefficients[: k + 1 - order]):
            total = total * w + sp.Integer(factorial(k - i) // factorial(k - i - order)) * c
        return total


def in_pieces(
    system: Equations, events: tuple[Event | Impact, ...], values: Mapping[Any, Any]
) -> tuple[Equations, tuple[Event | Impact, ...], tuple[Piece, ...]]:
    """The system and its events with polynomials for the splines among the values, and these, one for each argument."""
    splines = {name: f for name, f in values.items() if isinstance(f, FunctionValue) and f.knots is not None}
    if not splines:
        return system, events, ()
    pieces: dict[tuple[str, sp.Expr], Piece] = {}

    def made(name: str, orders: Orders, arguments: tuple[sp.Expr, ...]) -> sp.Expr | None:
        if name not in splines:
            return None
        key = (name, arguments[0])
        if key not in pieces:
            c, stem = splines[name].coefficients, f"{name}{len(pieces)}"
            assert c is not None
            start, low, high = (sp.Symbol(f"{stem} {part}", real=True) for part in ("start", "low", "high"))
            letters = tuple(sp.Symbol(f"{stem} c{i}", real=True) for i in range(len(c)))
            pieces[key] = Piece(splines[name], arguments[0], start, letters, low, high)
        return pieces[key].polynomial(orders[0])

    def put(e: sp.Expr) -> sp.Expr:
        return with_jets(e, made)

    lagrangian = put(system.L) if unknown_functions(system.L) else system.lagrangian
    new = _with_each(system, lagrangian, put)
    return new, tuple(event_with(event, put) for event in events), tuple(pieces.values())


def event_with(event: Event | Impact, put: Callable[[sp.Expr], sp.Expr]) -> Event | Impact:
    """The event with `put` applied to its expressions."""
    if isinstance(event, Impact):
        return replace(event, gap=put(event.gap), restitution=put(event.restitution))
    after = None if event.velocities is None else tuple(map(put, event.velocities))
    return replace(event, section=put(event.section), velocities=after)
