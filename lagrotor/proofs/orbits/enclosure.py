"""The motion from a start, or from all starts within an interval, enclosed at a time."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.proofs.balls import Ball, Matrix, arb, ball_data, balls_data, precision, printed, radius
from lagrotor.proofs.fields import Field, Values, ball, field_of, values_at
from lagrotor.proofs.lohner_frames import Accuracy, CarriedStep, Start, flow_data, steps_of
from lagrotor.proofs.statements import Certificate
from lagrotor.result_display import Shown, scientific

TOL = 1e-17


@dataclass(frozen=True, eq=False, repr=False)
class Enclosure(Shown):
    """Balls that hold the motion at the time t.

    q, v: coordinates and velocities (of a Scene U, chi, alpha and their rates; of a Structure the axes' components and
    theirs); states: these and, where it enters, the time. derivative: of the states by the start and by the parameters that
    vary, over the whole start. residual: what the constraints leave, which holds zero.
    """

    field: Field
    t: Ball
    states: tuple[Ball, ...]
    derivative: Matrix
    residual: tuple[Ball, ...]
    steps: tuple[CarriedStep, ...]
    start: Start
    bits: int

    @property
    def q(self) -> tuple[Ball, ...]:
        """Coordinates."""
        return self.states[: self._half]

    @property
    def v(self) -> tuple[Ball, ...]:
        """Velocities."""
        return self.states[self._half : 2 * self._half]

    @property
    def _half(self) -> int:
        return len(self.states) // 2

    def value(self, expression: sp.Expr) -> Ball:
        """Any expression of the states, at t; of a Scene also of x_1 … z_2 and their rates."""
        with precision(self.bits):
            parameters = [self.field.values[s] for s in self.field.arguments[len(self.field.states) :]]
            tape = self.field.function([sp.sympify(expression, strict=True)])
            return values_at(tape, [*self.states, *parameters])[0]

    @cached_property
    def certificate(self) -> Certificate:
        """Plain data that `check` verifies."""
        with precision(self.bits):
            flow = flow_data(self.field.about, self.field.motion, self.start, self.steps, self.bits)
            return flow | {
                "kind": "enclosure",
                "claim": {"t": ball_data(self.t), "states": balls_data([loosened(x) for x in self.states])},
            }

    def summary(self) -> dict[str, str]:
        """The time and the states, name → words."""
        states = {str(s): printed(x, 20) for s, x in zip(self.field.states, self.states, strict=True)}
        off = max((float(abs(x).upper()) for x in self.residual), default=0.0)
        held = {"constraints": f"0 within {scientific(off)}"} if self.residual else {}
        return {"t": printed(self.t, 15)} | states | held


def loosened(x: Ball) -> Ball:
    """A ball a little wider, for another program's rounding."""
    return x + arb(0, (radius(x) * arb(2) ** -6 + abs(x) * arb(2) ** -60).upper())


def accuracy_of(tol: Any, where: str) -> Accuracy:
    """Raises InputError for a tolerance that makes no sense."""
    if isinstance(tol, bool) or not isinstance(tol, int | float) or not 1e-200 < tol < 0.01:
        raise InputError(f"{where}: tol = {tol!r} must be a number between 1e-200 and 0.01")
    return Accuracy(float(tol))


def time_ball(t: Any, where: str) -> Ball:
    """A positive time."""
    found = ball(t, f"{where}: t")
    if not found > 0:
        raise InputError(f"{where}: t = {t!r} must be after the start, at t = 0")
    return found


def enclose(
    system: Any, values: Values | None = None, q0: Any = None, v0: Any = None, t: Any = None, tol: float = TOL
) -> Enclosure:
    """Balls of the state of a motion, by a validated integration from t = 0.

    Parameters
    ----------
    system
        A `System`; a `Scene`, with its own start; a `Structure`, q0 its tilt and v0 the axes' rates; or a `Program` with
        its states first.
    values : Values or None, optional
        Numbers, exact decimals as they are written, or pairs (lowest, highest).
    q0 : optional
        Likewise.
    v0 : optional
        Likewise.
    t : optional
        S.
    tol : float, default TOL
        What a step may leave out, relative to the state's size: order, steps and precision follow from it.

    Raises
    ------
    InputError
        For what makes no sense.
    ConstraintError
        For a start off the constraints.
    NotProved
        Where the enclosure ends before t.
    """
    accuracy = accuracy_of(tol, "enclose")
    with precision(accuracy.bits, accuracy.terms):
        end = time_ball(t, "enclose")
        made = field_of(system, values, q0, v0)
        start = Start(*made.parts)
        steps = tuple(steps_of(made.motion, start, end, accuracy))
        n, last = len(made.states), steps[-1].end
        box = last.box(start.spread)
        fixed = [made.values[s] for s in made.arguments[len(box) :]]
        residual = tuple(values_at(made.function(made.held), [*box, *fixed])) if made.held else ()
        return Enclosure(made, end, tuple(box[:n]), last.derivative, residual, steps, start, accuracy.bits)
