"""Values of unknown functions in a Lagrangian, a force or a constraint: U(r), a support y_s(t), a control u(t).

A value may be an expression, which is substituted before the equations are derived. It may be a callable, or a tuple of
callables for the function and its derivatives. It may also be a table (x, y) or a spline of scipy. A table is interpolated by a
cubic spline (de Boor, A Practical Guide to Splines, ch. IV).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np
import sympy as sp
from sympy.core.function import AppliedUndef, UndefinedFunction

from lagrotor.errors import InputError, IntegrationError, near
from lagrotor.mechanics.equations import Equations, PlacedForces
from lagrotor.mechanics.expressions import expression, repeated_name, unknown_functions, with_jets
from lagrotor.mechanics.lagrangian import t
from lagrotor.mechanics.running.switches import Event, Impact
from lagrotor.numerics.arrays import Array as Array

Orders = tuple[int, ...]
Kind = TypeVar("Kind", bound=Equations)


@dataclass(frozen=True, eq=False)
class FunctionValue:
    """The numerical value of an unknown function.

    Attributes
    ----------
    name : str
        Name of the function.
    derivatives : Mapping
        The known derivatives as callables, by their orders, one order for each argument.
    spline : object or None
        A spline of scipy that takes the place of the derivatives; its value is NaN beyond its knots.
    """

    name: str
    derivatives: Mapping[Orders, Callable[..., Any]]
    spline: Any = None

    def jet(self, where: str, orders: Orders) -> Callable[..., Any]:
        """Return the derivative of these orders as a function of numbers or arrays. It also takes small imaginary parts, so that
        a complex step can differentiate it."""
        f = self._known(where, orders)

        def one(*at: float) -> float:
            try:
                return float(f(*at))
            except TypeError:
                text = f"{jet_name(self.name, orders)}({', '.join(map(str, at))})"
                raise IntegrationError(
                    f"{where}: {text} gives {f(*at)!r}, which is not a number: correct the function"
                ) from None

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
        if self.spline is not None:
            return self.spline.derivative(orders[0]) if orders[0] else self.spline
        if orders not in self.derivatives:
            called = ", ".join(jet_name(self.name, (k,)) for k in range(sum(orders) + 1))
            way = f"give values={{{self.name}: ({called})}}, callables, a table (x, y), or an expression"
            raise InputError(
                f"{where}: the equations contain {jet_name(self.name, orders)}, which a callable for {self.name} alone does not "
                f"give: {way if len(orders) == 1 else 'give an expression'}"
            )
        return self.derivatives[orders]


def jet_name(name: str, orders: Orders) -> str:
    """Return the name of a derivative: U, U' or U'' for one argument, U^(1,0) for several."""
    if len(orders) == 1:
        return name + "'" * orders[0]
    return f"{name}^({','.join(map(str, orders))})" if any(orders) else name


def put_functions(where: str, system: Kind, values: Any, others: Sequence[sp.Expr] = ()) -> tuple[Kind, Any]:
    """Substitute the functions whose values are expressions into the system. Return the system and all values: a number for each
    symbol, a `Lambda` or `FunctionValue` for each function. `others` are further expressions that may contain functions."""
    expressions = [*system.lagrangian_parts, *system.acting, *(e for _, e in system.velocities), *others]
    applied = unknown_functions(expressions)
    functions = {str(f.func): f.func for f in applied}
    if not isinstance(values, Mapping):
        raise InputError(f"{where}: values = {values!r} must be {{symbol: number, …}}, a dictionary")
    by_function = dict(_by_function(where, key, value) for key, value in values.items())
    if len(by_function) < len(values):
        raise InputError(f"{where}: a function has two values, as U and as U(x): give one")
    values = by_function
    # A long Lagrangian shares its subexpressions: its symbols are not counted where no function needs them.
    if letters := functions and sorted(functions.keys() & {str(s) for e in expressions for s in e.free_symbols}):
        raise InputError(f"{where}: {letters[0]} is a symbol of the system and a function in it: rename one")
    if twice := repeated_name(values):
        raise InputError(f"{where}: values give {twice} twice, under its symbol and under its name: give one")
    if not (functions or any(isinstance(key, UndefinedFunction) for key in values)):
        return system, values
    named = {
        str(key): value for key, value in values.items() if isinstance(key, UndefinedFunction) or str(key) in functions
    }
    if strangers := sorted(named.keys() - functions.keys()):
        raise InputError(
            f"{where}: values name the function {strangers[0]}, which the system does not have{near(strangers[0], functions)}"
        )
    if missing := sorted(functions.keys() - named.keys()):
        raise InputError(
            f"{where}: {', '.join(missing)} without a value: values = {{{missing[0]}: an expression, a callable, "
            "or a table (x, y)}"
        )
    numbers: dict[Any, Any] = {key: value for key, value in values.items() if str(key) not in functions}
    lambdas: dict[str, sp.Lambda] = {}
    for name, value in named.items():
        places = {f.args for f in applied if str(f.func) == name}
        resolved = _value(where, name, places, value)
        if isinstance(resolved, sp.Lambda):
            if moving := resolved.free_symbols & {*system.c.v, *system.c.a, *system.variables, t}:
                raise InputError(
                    f"{where}: {name} = {resolved.expr} contains {', '.join(sorted(map(str, moving)))}, but "
                    f"{applied[0]} does not depend on it: write it into the system, {name} with more arguments"
                )
            lambdas[name] = resolved
        numbers[name] = resolved
    return (_with_expressions(system, lambdas) if lambdas else system), numbers


def _by_function(where: str, key: Any, value: Any) -> tuple[Any, Any]:
    """Split an entry U(x): value into U and Lambda(x, value), or into U and the value if it is no expression. Return an entry
    with any other key unchanged."""
    if not isinstance(key, AppliedUndef):
        return key, value
    if not all(a.is_Symbol for a in key.args) or len({*key.args}) < len(key.args):
        raise InputError(f"{where}: values name {key}, no function of different symbols: name {key.func} alone")
    expressed = isinstance(value, sp.Expr | int | float) and not isinstance(value, bool | sp.Lambda)
    return key.func, sp.Lambda(key.args, value) if expressed else value


def _with_expressions(system: Kind, lambdas: Mapping[str, sp.Lambda]) -> Kind:
    """Return the system with expressions in place of the functions, which are given by name."""

    def put(e: sp.Expr) -> sp.Expr:
        return with_values(e, lambdas)

    lagrangian: Any = system.lagrangian
    if not system.bodies:
        lagrangian = put(lagrangian)
    elif unknown_functions(lagrangian.parts):  # in the position of a frame
        lagrangian = put(system.L)
    else:
        lagrangian = replace(lagrangian, remainder=put(lagrangian.remainder))
    return replace(
        system,
        lagrangian=lagrangian,
        constraints=tuple(map(put, system.constraints)),
        rolling=tuple(map(put, system.rolling)),
        dissipation=put(system.dissipation),
        forces=PlacedForces.of(system.forces, map(put, system.forces), put),
        velocities=tuple((u, put(e)) for u, e in system.velocities),
        states=tuple((x, put(f)) for x, f in system.states),
    )


def with_values(e: sp.Expr, values: Mapping[Any, Any]) -> sp.Expr:
    """Substitute, in one expression, the functions whose values are expressions, and their derivatives."""

    def made(name: str, orders: Orders, arguments: tuple[sp.Expr, ...]) -> sp.Expr | None:
        form = values.get(name)
        if not isinstance(form, sp.Lambda):
            return None
        body, letters = form.expr, form.variables
        for letter, order in zip(letters, orders, strict=True):
            body = sp.diff(body, letter, order) if order else body
        return body.subs(dict(zip(letters, arguments, strict=True)), simultaneous=True)

    return with_jets(e, made)


def _value(where: str, name: str, places: set[tuple[sp.Expr, ...]], value: Any) -> sp.Lambda | FunctionValue:
    """Convert the value of a function to a `Lambda` if it is an expression, or to a `FunctionValue` if it is numerical. `places`
    are the arguments with which the function occurs in the system."""
    count = len(next(iter(places)))
    if isinstance(value, FunctionValue):
        return value
    if isinstance(value, sp.Lambda):
        if len(value.variables) != count:
            raise InputError(
                f"{where}: {name} = {value} has {len(value.variables)} arguments, but {count} in the system: give as many"
            )
        form = sp.Lambda(value.variables, expression(f"{where}: {name}", value.expr))
        return _alone(where, name, form)
    if isinstance(value, sp.Expr | int | float) and not isinstance(value, bool):
        body = expression(f"{where}: {name}", value)
        (letters,) = places if len(places) == 1 else (None,)
        if letters is None or not all(a.is_Symbol for a in letters) or len({*letters}) < count:
            if body.free_symbols & set().union(*(a.free_symbols for place in places for a in place)):
                raise InputError(
                    f"{where}: {name} = {body} has no argument that is a symbol alone, as in "
                    f"{name}({min(', '.join(map(str, place)) for place in places)}): "
                    "give sympy's Lambda(x, expression in x)"
                )
            letters = sp.symbols(f"_x:{count}", real=True, cls=sp.Dummy)
        return _alone(where, name, sp.Lambda(tuple(letters), body))
    if count == 1 and (spline := _spline_of(where, name, value)) is not None:
        return spline
    if callable(value):
        return FunctionValue(name, {(0,) * count: value})
    if (
        isinstance(value, Sequence)
        and not isinstance(value, str)
        and value
        and all(map(callable, value))
        and count == 1
    ):
        return FunctionValue(name, {(k,): f for k, f in enumerate(value)})
    raise InputError(
        f"{where}: {name} = {value!r} is no function of {count} argument{'s' * (count > 1)}: give an expression, a callable, "
        "callables "
        f"({name}, {name}', …), a table (x, y) of increasing x, or a spline of scipy"
    )


def _alone(where: str, name: str, form: sp.Lambda) -> sp.Lambda:
    if form.expr.atoms(AppliedUndef):
        raise InputError(f"{where}: {name} = {form.expr} contains a function without a value: write it out")
    return form


def _spline_of(where: str, name: str, value: Any) -> FunctionValue | None:
    """Return the `FunctionValue` of a table (x, y) or of a spline of scipy; None for any other value."""
    from scipy.interpolate import BSpline, CubicSpline, PPoly

    if isinstance(value, BSpline | PPoly):
        pieces = PPoly.from_spline(value, False) if isinstance(value, BSpline) else PPoly(value.c, value.x, False)
        if pieces.c.ndim != 2 or np.iscomplexobj(pieces.c) or not np.isfinite(pieces.c).all():
            raise InputError(f"{where}: {name}: a spline of scipy must have real, finite values, one at each place")
        return FunctionValue(name, {}, pieces)
    pair = isinstance(value, Sequence | np.ndarray) and not isinstance(value, str) and len(value) == 2
    if not pair or any(callable(column) or np.ndim(column) != 1 for column in value):
        return None
    try:
        x, y = (np.array(column, float) for column in value)
    except (TypeError, ValueError):
        raise InputError(f"{where}: {name} = {value!r}: a table is two arrays of numbers, (x, y)") from None
    if len(x) != len(y) or len(x) < 2 or not (np.isfinite(x).all() and np.isfinite(y).all()):
        raise InputError(
            f"{where}: {name}: a table (x, y) needs equally many finite x and y, at least two, not {len(x)} and {len(y)}"
        )
    if (np.diff(x) <= 0).any():
        raise InputError(f"{where}: {name}: the x of a table must increase strictly: sort the table")
    return FunctionValue(name, {}, CubicSpline(x, y, extrapolate=False))


def event_with(event: Event | Impact, substitute: Callable[[sp.Expr], sp.Expr]) -> Event | Impact:
    """Apply a substitution to the expressions of an event."""
    if isinstance(event, Impact):
        gap, restitution, friction, *slip = map(substitute, event.expressions)
        return replace(event, gap=gap, restitution=restitution, friction=friction, slip=tuple(slip))
    velocities = None if event.velocities is None else tuple(map(substitute, event.velocities))
    return replace(event, section=substitute(event.section), velocities=velocities)
