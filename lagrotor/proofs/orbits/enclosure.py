"""The enclosure of a motion at one time, for one initial state or for all initial states in a box."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.proofs.balls import Ball, Matrix, arb, ball_data, balls_data, format_ball, precision, radius
from lagrotor.proofs.fields import Field, Values, ball, field_of, values_at
from lagrotor.proofs.lohner_frames import Accuracy, LohnerStep, Start, flow_data, steps_of
from lagrotor.proofs.statements import Certificate
from lagrotor.result_display import Shown, scientific

TOL = 1e-17


@dataclass(frozen=True, eq=False, repr=False)
class Enclosure(Shown):
    """Balls that contain the motion at the time t.

    Attributes
    ----------
    field : Field
        The equations of motion with the values of their parameters.
    t : Ball
        The time in s.
    states : tuple[Ball, ...]
        Coordinates and velocities, then the time where it enters the equations. For a Scene these are U, chi, alpha and their
        rates; for a Structure the components of the axes and their rates.
    derivative : Matrix
        The derivative of the states by the initial state and the interval parameters, over the whole initial set.
    residual : tuple[Ball, ...]
        The values of the constraints; each ball contains zero.
    steps : tuple[LohnerStep, ...]
        The steps of the integration.
    start : Start
        The initial set.
    bits : int
        The precision of the balls.
    """

    field: Field
    t: Ball
    states: tuple[Ball, ...]
    derivative: Matrix
    residual: tuple[Ball, ...]
    steps: tuple[LohnerStep, ...]
    start: Start
    bits: int

    @property
    def q(self) -> tuple[Ball, ...]:
        """The coordinates, a ball each."""
        return self.states[: len(self.states) // 2]

    @property
    def v(self) -> tuple[Ball, ...]:
        """The velocities, a ball each."""
        n = len(self.states) // 2
        return self.states[n : 2 * n]

    def value(self, expression: sp.Expr) -> Ball:
        """Enclose an expression of the states at the time t.

        Parameters
        ----------
        expression : sympy.Expr
            The expression. For a Scene it may also contain the components x_1 … z_2 of the axes, and their rates.

        Returns
        -------
        Ball
            The enclosure, in the units of the expression.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> enclose(System(c, (c.v[0] ** 2 - c.q[0] ** 2) / 2), q0=[1], v0=[0], t=2).value(c.q[0] ** 2 + c.v[0] ** 2)
        [1.00000000000000 +/- 3.75e-18]
        """
        with precision(self.bits):
            parameters = [self.field.values[s] for s in self.field.arguments[len(self.field.states) :]]
            tape = self.field.function([sp.sympify(expression, strict=True)])
            return values_at(tape, [*self.states, *parameters])[0]

    @cached_property
    def certificate(self) -> Certificate:
        """The plain data that `check` verifies."""
        with precision(self.bits):
            flow = flow_data(self.field.subject, self.field.motion, self.start, self.steps, self.bits)
            claim = {"t": ball_data(self.t), "states": balls_data([add_margin(x) for x in self.states])}
            return flow | {"kind": "enclosure", "claim": claim}

    def summary(self) -> dict[str, str]:
        """Return the time, the states and the residual of the constraints.

        Returns
        -------
        dict[str, str]
            Name → ball as text.
        """
        states = {str(s): format_ball(x, 20) for s, x in zip(self.field.states, self.states, strict=True)}
        residual = max((float(abs(x).upper()) for x in self.residual), default=0.0)
        constraints = {"constraints": f"0 within {scientific(residual)}"} if self.residual else {}
        return {"t": format_ball(self.t, 15)} | states | constraints


def add_margin(x: Ball) -> Ball:
    """Return a slightly wider ball, to allow for the checker's rounding."""
    return x + arb(0, (radius(x) * arb(2) ** -6 + abs(x) * arb(2) ** -60).upper())


def accuracy_of(tol: Any, where: str) -> Accuracy:
    """Return the accuracy of a tolerance. Raises InputError if it is not between 1e-200 and 0.01."""
    if isinstance(tol, bool) or not isinstance(tol, int | float) or not 1e-200 < tol < 0.01:
        raise InputError(f"{where}: tol = {tol!r} must be a number between 1e-200 and 0.01")
    return Accuracy(float(tol))


def time_ball(t: Any, where: str) -> Ball:
    """Return a time as a ball. Raises InputError if it is not positive."""
    time = ball(t, f"{where}: t")
    if not time > 0:
        raise InputError(f"{where}: t = {t!r} must be after the start, which is at t = 0")
    return time


def enclose(
    system: Any, values: Values | None = None, q0: Any = None, v0: Any = None, t: Any = None, tol: float = TOL
) -> Enclosure:
    """Enclose the state of a motion at time t by validated integration from t = 0.

    Parameters
    ----------
    system : System, Scene, Structure or Program
        The motion. A Scene has its own initial state; the states of a Program are its first arguments.
    values : Mapping, optional
        Parameter → number, or pair (lowest, highest) for an interval. A decimal denotes the exact rational number.
    q0 : sequence, optional
        Initial coordinates, each a number or a pair; for a Structure the tilt.
    v0 : sequence, optional
        Initial velocities, each a number or a pair; for a Structure the rates of the axes.
    t : number
        The time in s.
    tol : float, default 1e-17
        Local error of a step, relative to the size of the state. It sets order, step length and precision.

    Returns
    -------
    Enclosure
        A ball for each state.

    Raises
    ------
    InputError
        If an argument does not fit the system.
    ConstraintError
        If the initial state violates the constraints.
    NotProved
        If the enclosure ends before t.

    Examples
    --------
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("x")
    >>> enclose(System(c, (c.v[0] ** 2 - c.q[0] ** 2) / 2), q0=[(0.99, 1.01)], v0=[0], t=1, tol=1e-10).q[0]
    [0.54 +/- 5.71e-3]
    """
    accuracy = accuracy_of(tol, "enclose")
    with precision(accuracy.bits, accuracy.terms):
        end = time_ball(t, "enclose")
        field = field_of(system, values, q0, v0)
        start = Start(*field.start_set)
        steps = tuple(steps_of(field.motion, start, end, accuracy))
        n, last = len(field.states), steps[-1].end
        box = last.box(start.spread)
        fixed = [field.values[s] for s in field.arguments[len(box) :]]
        residual = tuple(values_at(field.function(field.constraints), [*box, *fixed])) if field.constraints else ()
        return Enclosure(field, end, tuple(box[:n]), last.derivative, residual, steps, start, accuracy.bits)
