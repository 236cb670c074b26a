"""Zero crossings and means of expressions of the states along an enclosed motion."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.errors import InputError, NotProved
from lagrotor.proofs.balls import Ball, Balls, arb, arb_poly, ball_data, exact, format_ball, precision, radius
from lagrotor.proofs.fields import Field, Values, ball, field_of, in_rationals
from lagrotor.proofs.lohner_frames import Accuracy, LohnerStep, Start, flow_data, steps_of
from lagrotor.proofs.orbits.enclosure import TOL, accuracy_of, add_margin, time_ball
from lagrotor.proofs.statements import Certificate, Proved
from lagrotor.proofs.tape import Tape
from lagrotor.proofs.taylor_step import Motion, bound_remainder, scale_terms, taylor
from lagrotor.proofs.truncated_series import Evaluation, TaylorModel
from lagrotor.renamed import accept_old_keywords

Problem = tuple[Field, Tape, Start]
Spans = Sequence[tuple[sp.Basic, Any, Any]]
_DEPTH = 12  # halvings of a step


@dataclass(frozen=True)
class ExpressionOnStep:
    """The Taylor model of an expression on one step, in s from 0 to 1, for all initial states."""

    series: TaylorModel

    def over(self, low: Ball, high: Ball) -> Ball:
        """Enclose the values of the expression between two places of the step, by the mean-value form."""
        s = low.union(high)
        at = exact(s)
        poly = self.series.poly
        slope = poly.derivative()
        return poly(at) + slope(s) * (s - at) + arb(0, self.series.remainder.abs_upper())

    def integral(self, low: Ball, high: Ball) -> Ball:
        whole = self.series.poly.integral()
        return whole(high) - whole(low) + (high - low) * arb(0, self.series.remainder.abs_upper())

    def signs(self, low: Ball, high: Ball, depth: int = _DEPTH) -> Iterator[tuple[Ball, Ball, int]]:
        """Yield (low, high, sign) for pieces of the step, bisected until each has one sign or the depth is used up."""
        value = self.over(low, high)
        sign = 1 if value > 0 else -1 if value < 0 else 0
        if sign or not depth:
            yield low, high, sign
        else:
            middle = (low + high) / 2
            yield from self.signs(low, middle, depth - 1)
            yield from self.signs(middle, high, depth - 1)


def expressions_on_step(motion: Motion, tape: Tape, step: LohnerStep, w: Balls) -> list[ExpressionOnStep]:
    """Return Taylor models of the outputs of a tape along one step, for all initial states."""
    box, n = step.node.box(w), step.n
    rows = scale_terms(taylor(motion, box, n), step.h, n)
    bounds, _ = bound_remainder(motion, rows, box, step.h, n)
    moving = [TaylorModel(arb_poly(row), bound, n) for row, bound in zip(rows, bounds, strict=True)]
    still = [TaylorModel(arb_poly([c]), arb(0), n) for c in (*box[motion.moving :], *motion.parameters)]
    return [ExpressionOnStep(series) for series in Evaluation(tape, [*moving, *still]).outputs]


@dataclass(frozen=True, eq=False, repr=False)
class Crossing(Proved):
    """A proved zero crossing of an expression, or a proved absence of zeros.

    Attributes
    ----------
    expression : sympy.Basic
        The expression of the states, or Eq(name, expression).
    crosses : bool
        True for a proved crossing, False for a proved absence of zeros from t = 0 to `time`.
    time : Ball
        The time of the crossing in s; without a crossing, the end of the interval.
    first : bool
        True if the crossing is proved to be the first one.
    certificate : Certificate
        The plain data that `check` verifies.
    """

    expression: sp.Basic
    crosses: bool
    time: Ball
    first: bool
    certificate: Certificate

    def summary(self) -> dict[str, str]:
        """Return the expression, the theorem and the number of steps.

        Returns
        -------
        dict[str, str]
            Name → text.
        """
        steps = str(len(self.certificate["steps"]))
        return {"expression": words(self.expression)["of"], "theorem": self.theorem, "steps": steps}


@dataclass(frozen=True, eq=False, repr=False)
class Means(Proved):
    """The enclosed time means of expressions.

    Attributes
    ----------
    spans : tuple[tuple[sympy.Basic, Ball, Ball], ...]
        The rows (expression, t₁, t₂), times in s.
    values : tuple[Ball, ...]
        The mean of each row.
    certificate : Certificate
        The plain data that `check` verifies.
    """

    spans: tuple[tuple[sp.Basic, Ball, Ball], ...]
    values: tuple[Ball, ...]
    certificate: Certificate

    def summary(self) -> dict[str, str]:
        """Return the mean of each expression.

        Returns
        -------
        dict[str, str]
            "mean of …" → ball as text.
        """
        return {f"mean of {words(e)['of']}": format_ball(x) for (e, *_), x in zip(self.spans, self.values, strict=True)}


def prepare(system: Any, values: Any, q0: Any, v0: Any, expressions: Sequence[Any]) -> Problem:
    """Return the field of the system, a tape that computes the expressions from the field's arguments, and the initial set."""
    plain = [e.rhs if isinstance(e, sp.Eq) and e.lhs.is_Symbol else e for e in expressions]
    for e in plain:
        if not isinstance(e, sp.Expr):
            raise InputError(f"proofs: {e!r} must be an expression of the states, a sympy expression")
    field = field_of(system, values, q0, v0)
    named = [e for e in expressions if isinstance(e, sp.Eq)]
    symbols, constants = ({str(s) for e in plain for s in e.atoms(kind)} for kind in (sp.Symbol, sp.NumberSymbol))
    names = symbols | constants | {str(s) for s in (*field.arguments, *(field.observables or ()))}
    for name, e in ((str(e.lhs), e) for e in named):
        if not name.isidentifier() or name in names or hasattr(sp.functions, name):
            what = "must be a name of its own, of no state, parameter, constant or function"
            raise InputError(f"proofs: {e}: {name} {what}")
        if any(str(equation.lhs) == name and equation.rhs != e.rhs for equation in named):
            raise InputError(f"proofs: {name} has two meanings: give each expression a name of its own")
    if both := symbols & constants:
        name = ", ".join(sorted(both))
        raise InputError(f"proofs: {name} is a state or parameter and a constant: take another symbol")
    return field, field.function(plain), Start(*field.start_set)


def words(expression: sp.Basic) -> dict[str, str]:
    """Return {"of": text} for an expression, and {"of": name, "means": text} for Eq(name, expression).

    Examples
    --------
    >>> words(0.5 * sp.Symbol("x"))
    {'of': 'x/2'}
    """
    exact = in_rationals(expression)
    if isinstance(exact, sp.Eq):
        return {"of": str(exact.lhs), "means": str(exact.rhs)}
    return {"of": str(exact)}


def observed_data(field: Field) -> dict[str, Any] | None:
    """Return the tape and the names of the observables for a certificate; None if the motion has no observables."""
    observables = field.observables or {}
    return field.function([*observables]).data() | {"names": [str(s) for s in observables]} if observables else None


@accept_old_keywords
def crossing(
    system: Any,
    values: Values | None = None,
    q0: Any = None,
    v0: Any = None,
    event: Any = None,
    t_end: Any = None,
    tol: float = TOL,
) -> Crossing:
    """Prove that an expression of the states passes through zero, and enclose the time.

    Parameters
    ----------
    system : System, Scene, Structure or Program
        The motion. A Scene has its own initial state; the states of a Program are its first arguments.
    values : Mapping, optional
        Parameter → number, or pair (lowest, highest) for an interval.
    q0 : sequence, optional
        Initial coordinates, each a number or a pair; for a Structure the tilt.
    v0 : sequence, optional
        Initial velocities, each a number or a pair.
    event : sympy.Expr or sympy.Eq
        The expression of the states, or Eq(name, expression). For a Scene it may contain the components x_1 … z_2 of the axes and
        their rates, for a Structure the components x_0, y_0, z_0, ….
    t_end : number
        The time in s before which the crossing is sought.
    tol : float, default 1e-17
        Local error of a step, relative to the size of the state.

    Returns
    -------
    Crossing
        The enclosed time, and whether the crossing is the first one.

    Raises
    ------
    InputError
        If an argument does not fit the system.
    NotProved
        If the sign is not proved to change. The message says how far the proof came.

    Examples
    --------
    >>> import sympy as sp
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("theta")
    >>> pendulum = System(c, c.v[0] ** 2 / 2 + sp.cos(c.q[0]))
    >>> crossing(pendulum, q0=[1], v0=[0], event=c.q[0], t_end=2, tol=1e-10).time
    [1.6750 +/- 6.80e-5]
    """
    accuracy, where = accuracy_of(tol, "crossing"), "crossing"
    with precision(accuracy.bits, accuracy.terms):
        end, problem = time_ball(t_end, where), prepare(system, values, q0, v0, [event])
        last_sign, since, pending, clear, steps = 0, arb(0), False, True, list[LohnerStep]()
        for step, low, high, sign in _signs(problem, end, accuracy, steps):
            if not sign:
                pending = True
                continue
            if last_sign and sign != last_sign:
                time = since.union(step.node.t + step.h * low)
                claim = {"time": ball_data(add_margin(time)), "first": clear}
                certificate = _certificate(problem, steps, accuracy.bits, "crossing", words(event), claim)
                return Crossing(event, True, time, clear, certificate)
            clear = clear and not pending
            last_sign, since, pending = sign, step.node.t + step.h * high, False
        name, end_text = words(event)["of"], format_ball(end, 10)
        raise NotProved(f"{where}: {name} keeps its sign, or is not proved to change it, up to t = {end_text}")


@accept_old_keywords
def no_crossing(
    system: Any,
    values: Values | None = None,
    q0: Any = None,
    v0: Any = None,
    event: Any = None,
    t_end: Any = None,
    tol: float = TOL,
) -> Crossing:
    """Prove that an expression of the states has no zero from t = 0 to `t_end`.

    Parameters
    ----------
    system : System, Scene, Structure or Program
        The motion. A Scene has its own initial state; the states of a Program are its first arguments.
    values : Mapping, optional
        Parameter → number, or pair (lowest, highest) for an interval.
    q0 : sequence, optional
        Initial coordinates, each a number or a pair; for a Structure the tilt.
    v0 : sequence, optional
        Initial velocities, each a number or a pair.
    event : sympy.Expr or sympy.Eq
        The expression of the states, or Eq(name, expression).
    t_end : number
        End of the interval in s.
    tol : float, default 1e-17
        Local error of a step, relative to the size of the state.

    Returns
    -------
    Crossing
        The result with `crosses` False.

    Raises
    ------
    InputError
        If an argument does not fit the system.
    NotProved
        If a zero is not excluded. The message gives the time up to which it is excluded.

    Examples
    --------
    >>> import sympy as sp
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("theta")
    >>> pendulum = System(c, c.v[0] ** 2 / 2 + sp.cos(c.q[0]))
    >>> no_crossing(pendulum, q0=[1], v0=[0], event=c.q[0] - 2, t_end=2, tol=1e-10).theorem
    'theta - 2 does not pass zero from t = 0 to 2 s. This holds for the system with L = ...'
    """
    accuracy, where = accuracy_of(tol, "no_crossing"), "no_crossing"
    with precision(accuracy.bits, accuracy.terms):
        end, problem = time_ball(t_end, where), prepare(system, values, q0, v0, [event])
        steps = list[LohnerStep]()
        for step, low, _, sign in _signs(problem, end, accuracy, steps):
            if not sign:
                at = float((step.node.t + step.h * low).mid())
                raise NotProved(f"{where}: {words(event)['of']} is not proved to be nonzero beyond t = {at:.10g}")
        claim = {"time": ball_data(end), "first": False}
        certificate = _certificate(problem, steps, accuracy.bits, "no crossing", words(event), claim)
        return Crossing(event, False, end, False, certificate)


def _signs(
    problem: Problem, end: Ball, accuracy: Accuracy, steps: list[LohnerStep]
) -> Iterator[tuple[LohnerStep, Ball, Ball, int]]:
    """Yield (step, low, high, sign) for pieces of each step up to the time `end`; append the steps to `steps`.

    `sign` is the sign of the expression between the places low and high of the step; 0 if it is not proved.
    """
    field, tape, start = problem
    for step in steps_of(field.motion, start, end, accuracy):
        steps.append(step)
        for piece in expressions_on_step(field.motion, tape, step, start.spread)[0].signs(arb(0), arb(1)):
            yield step, *piece


def _certificate(
    problem: Problem, steps: Sequence[LohnerStep], bits: int, kind: str, event: Any, claim: dict[str, Any]
) -> Certificate:
    """Return the certificate of a claim about an event, or about means; the rows of means name their expressions."""
    field, _, start = problem
    flow = flow_data(field.subject, field.motion, start, steps, bits) | ({"event": event} if event else {})
    return flow | {"observed": observed_data(field), "kind": kind, "claim": claim}


def means(
    system: Any, values: Values | None = None, q0: Any = None, v0: Any = None, spans: Spans = (), tol: float = TOL
) -> Means:
    """Enclose time means (1/(t₂ − t₁)) ∫ e dt of expressions e of the states from t₁ to t₂.

    Parameters
    ----------
    system : System, Scene, Structure or Program
        The motion. A Scene has its own initial state; the states of a Program are its first arguments.
    values : Mapping, optional
        Parameter → number, or pair (lowest, highest) for an interval.
    q0 : sequence, optional
        Initial coordinates, each a number or a pair; for a Structure the tilt.
    v0 : sequence, optional
        Initial velocities, each a number or a pair.
    spans : sequence of (expression, t₁, t₂), default ()
        Each row has an expression of the states, or Eq(name, expression), and the two ends of the interval in s.
    tol : float, default 1e-17
        Local error of a step, relative to the size of the state.

    Returns
    -------
    Means
        A ball for each row of `spans`.

    Raises
    ------
    InputError
        If an argument does not fit the system.
    NotProved
        If the enclosure ends before the last t₂.

    Examples
    --------
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("x")
    >>> means(System(c, (c.v[0] ** 2 - c.q[0] ** 2) / 2), q0=[1], v0=[0], spans=[(c.q[0] ** 2, 0, 3)], tol=1e-10).values[0]
    [0.4767154 +/- 3.62e-8]
    """
    accuracy, where = accuracy_of(tol, "means"), "means"
    if not isinstance(spans, Sequence) or any(not isinstance(span, tuple | list) or len(span) != 3 for span in spans):
        raise InputError(f"{where}: spans = {spans!r} must be a list of (expression, t₁, t₂)")
    with precision(accuracy.bits, accuracy.terms):
        ends = [(ball(since, f"{where}: t"), time_ball(until, where)) for _, since, until in spans]
        if not ends or not all(0 <= since < until for since, until in ends):
            raise InputError(f"{where}: spans = {spans!r} must be (expression, t₁, t₂) with 0 ≤ t₁ < t₂, one at least")
        field, tape, start = prepare(system, values, q0, v0, [e for e, *_ in spans])
        last = ends[0][1]
        for _, until in ends:
            last = last.max(until)
        steps = tuple(steps_of(field.motion, start, last, accuracy))
        totals = [arb(0)] * len(ends)
        for step in steps:
            integrands = expressions_on_step(field.motion, tape, step, start.spread)
            for i, span in enumerate(ends):
                low, high = (((x - step.node.t) / step.h).max(0).min(1) for x in span)
                if low < high:
                    totals[i] += step.h * integrands[i].integral(low, high)
        values_of = [total / (until - since) for total, (since, until) in zip(totals, ends, strict=True)]
        claim = [  # 16 times the radius, since the checker's bounds differ
            words(e)
            | {
                "since": ball_data(since),
                "until": ball_data(until),
                "mean": ball_data(x + arb(0, (15 * radius(x)).upper())),
            }
            for (e, *_), (since, until), x in zip(spans, ends, values_of, strict=True)
        ]
        certificate = _certificate((field, tape, start), steps, accuracy.bits, "means", None, {"means": claim})
        whole = [(e, *span) for (e, *_), span in zip(spans, ends, strict=True)]
        return Means(tuple(whole), tuple(values_of), certificate)
