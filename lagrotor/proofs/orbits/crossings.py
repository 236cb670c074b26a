"""Expressions of the state along a motion: that one passes zero before a time, or does not up to a time; their means."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.errors import InputError, NotProved
from lagrotor.proofs.balls import Ball, Balls, arb, arb_poly, ball_data, exact, precision, printed, radius
from lagrotor.proofs.fields import Field, Values, ball, field_of, in_rationals
from lagrotor.proofs.lohner_frames import Accuracy, CarriedStep, Start, flow_data, steps_of
from lagrotor.proofs.orbits.enclosure import TOL, accuracy_of, loosened, time_ball
from lagrotor.proofs.statements import Certificate, Proved
from lagrotor.proofs.tape import Tape
from lagrotor.proofs.taylor_step import Motion, scaled, taylor, with_rest
from lagrotor.proofs.truncated_series import Evaluation, Tailed

Asked = tuple[Field, Tape, Start]
_DEPTH = 12  # halvings of a step


@dataclass(frozen=True)
class Watch:
    """An expression along one step: its series in s over all starts, 0 ≤ s ≤ 1."""

    series: Tailed

    def over(self, low: Ball, high: Ball) -> Ball:
        """A ball of the values between two places of the step, by its middle and slope."""
        s = low.union(high)
        at = exact(s)
        poly = self.series.poly
        slope = poly.derivative()
        return poly(at) + slope(s) * (s - at) + arb(0, self.series.tail.abs_upper())

    def sign(self, low: Ball, high: Ball) -> int:
        """Its sign between two places, 0 where it is not shown to have one."""
        value = self.over(low, high)
        return 1 if value > 0 else -1 if value < 0 else 0

    def integral(self, low: Ball, high: Ball) -> Ball:
        """Over s between two places."""
        whole = self.series.poly.integral()
        return whole(high) - whole(low) + (high - low) * arb(0, self.series.tail.abs_upper())

    def signs(self, low: Ball, high: Ball, depth: int = _DEPTH) -> Iterator[tuple[Ball, Ball, int]]:
        """The step cut until each piece has a sign, or is too short to go on, in order."""
        sign = self.sign(low, high)
        if sign or not depth:
            yield low, high, sign
        else:
            middle = (low + high) / 2
            yield from self.signs(low, middle, depth - 1)
            yield from self.signs(middle, high, depth - 1)


def watch(motion: Motion, tape: Tape, step: CarriedStep, w: Balls) -> list[Watch]:
    """The tape's outputs along a step, over all starts."""
    box, n = step.node.box(w), step.n
    rows = scaled(taylor(motion, box, n), step.h, n)
    rests, _ = with_rest(motion, rows, box, step.h, n)
    moving = [Tailed(arb_poly(row), rest, n) for row, rest in zip(rows, rests, strict=True)]
    still = [Tailed(arb_poly([c]), arb(0), n) for c in (*box[motion.moving :], *motion.parameters)]
    return [Watch(series) for series in Evaluation(tape, [*moving, *still]).outputs]


@dataclass(frozen=True, eq=False, repr=False)
class Crossing(Proved):
    """A proved crossing, in a time that `time` holds, or a proved non-crossing up to `time`.

    Attributes
    ----------
    first : bool
        Whether it is proved to be the first crossing, too.
    certificate : Certificate
        What `check` verifies.
    """

    expression: sp.Basic
    crosses: bool
    time: Ball
    first: bool
    certificate: Certificate

    def summary(self) -> dict[str, str]:
        """What is proved, name → words."""
        return {
            "expression": words(self.expression)["of"],
            "theorem": self.theorem,
            "steps": str(len(self.certificate["steps"])),
        }


@dataclass(frozen=True, eq=False, repr=False)
class Means(Proved):
    """Means of expressions over spans of time, enclosed. spans: (expression, from, to); values: a ball for each.

    certificate: what `check` verifies.
    """

    spans: tuple[tuple[sp.Basic, Ball, Ball], ...]
    values: tuple[Ball, ...]
    certificate: Certificate

    def summary(self) -> dict[str, str]:
        """What is proved, name → words."""
        return {f"mean of {words(e)['of']}": printed(x) for (e, *_), x in zip(self.spans, self.values, strict=True)}


def prepared(system: Any, values: Any, q0: Any, v0: Any, expressions: Sequence[Any]) -> Asked:
    """The field, the expressions as a tape of its arguments, the start."""
    plain = [e.rhs if isinstance(e, sp.Eq) and e.lhs.is_Symbol else e for e in expressions]
    for e in plain:
        if not isinstance(e, sp.Expr):
            raise InputError(f"proved: {e!r} must be an expression of the states, a sympy expression")
    made = field_of(system, values, q0, v0)
    named = [e for e in expressions if isinstance(e, sp.Eq)]
    letters, constants = ({str(s) for e in plain for s in e.atoms(kind)} for kind in (sp.Symbol, sp.NumberSymbol))
    taken = letters | constants | {str(s) for s in (*made.arguments, *(made.seen or ()))}
    for name, e in ((str(e.lhs), e) for e in named):
        if not name.isidentifier() or name in taken or hasattr(sp.functions, name):
            raise InputError(
                f"proved: {e}: {name} must be a name of its own, of no state, parameter, constant or function"
            )
        if any(str(other.lhs) == name and other.rhs != e.rhs for other in named):
            raise InputError(f"proved: {name} has two meanings: give each expression a name of its own")
    if both := letters & constants:
        raise InputError(
            f"proved: {', '.join(sorted(both))} is a state or parameter and a constant: take another letter"
        )
    return made, made.function(plain), Start(*made.parts)


def words(expression: sp.Basic) -> dict[str, str]:
    """What an expression is called, and what that means where it is named; decimals are the rational numbers that they mean."""
    written = in_rationals(expression)
    if isinstance(written, sp.Eq):
        return {"of": str(written.lhs), "means": str(written.rhs)}
    return {"of": str(written)}


def observed_data(made: Field) -> dict[str, Any] | None:
    """Of a certificate: the operations of what is observed, with its names."""
    seen = made.seen or {}
    return made.function([*seen]).data() | {"names": [str(s) for s in seen]} if seen else None


def crossing(
    system: Any,
    values: Values | None = None,
    q0: Any = None,
    v0: Any = None,
    event: Any = None,
    before: Any = None,
    tol: float = TOL,
) -> Crossing:
    """A proof that an expression of the states passes zero, with when.

    Parameters
    ----------
    system
        As in `enclose`.
    values : Values or None, optional
        As in `enclose`.
    q0 : optional
        As in `enclose`.
    v0 : optional
        As in `enclose`.
    event : optional
        The expression; of a Scene it may have x_1 … z_2 of the axes and their rates, of a Structure x_0, y_0, z_0, ….
        A long one may have a name, Eq(E, expression).
    before : optional
        S.
    tol : float, default TOL
        As in `enclose`.

    Raises
    ------
    InputError
        For what makes no sense.
    NotProved
        Where the sign is not shown to change, with how far the proof came.
    """
    accuracy, where = accuracy_of(tol, "crossing"), "crossing"
    with precision(accuracy.bits, accuracy.terms):
        end, asked = time_ball(before, where), prepared(system, values, q0, v0, [event])
        known, since, pending, clear, steps = 0, arb(0), False, True, list[CarriedStep]()
        for step, low, high, sign in _signs(asked, end, accuracy, steps):
            if not sign:
                pending = True
                continue
            if known and sign != known:
                time = since.union(step.node.t + step.h * low)
                claim = {"time": ball_data(loosened(time)), "first": clear}
                certificate = _certificate(asked, steps, accuracy.bits, "crossing", words(event), claim)
                return Crossing(event, True, time, clear, certificate)
            clear = clear and not pending
            known, since, pending = sign, step.node.t + step.h * high, False
        raise NotProved(
            f"{where}: {words(event)['of']} keeps its sign, or is not shown to change it, up to t = {printed(end, 10)}"
        )


def no_crossing(
    system: Any,
    values: Values | None = None,
    q0: Any = None,
    v0: Any = None,
    event: Any = None,
    until: Any = None,
    tol: float = TOL,
) -> Crossing:
    """A proof that an expression of the states does not pass zero from t = 0 on.

    Parameters
    ----------
    system
        As in `enclose`.
    values : Values or None, optional
        As in `enclose`.
    q0 : optional
        As in `enclose`.
    v0 : optional
        As in `enclose`.
    event : optional
        As in `crossing`.
    until : optional
        S.
    tol : float, default TOL
        As in `enclose`.

    Raises
    ------
    NotProved
        With the time up to which it is proved.
    """
    accuracy, where = accuracy_of(tol, "no_crossing"), "no_crossing"
    with precision(accuracy.bits, accuracy.terms):
        end, asked = time_ball(until, where), prepared(system, values, q0, v0, [event])
        steps = list[CarriedStep]()
        for step, low, _, sign in _signs(asked, end, accuracy, steps):
            if not sign:
                at = float((step.node.t + step.h * low).mid())
                raise NotProved(f"{where}: {words(event)['of']} is not shown to stay off zero beyond t = {at:.10g}")
        claim = {"time": ball_data(end), "first": False}
        certificate = _certificate(asked, steps, accuracy.bits, "no crossing", words(event), claim)
        return Crossing(event, False, end, False, certificate)


def _signs(
    asked: Asked, end: Ball, accuracy: Accuracy, steps: list[CarriedStep]
) -> Iterator[tuple[CarriedStep, Ball, Ball, int]]:
    """Yield each step up to a time in pieces, with the sign of an expression over them; the steps are added to `steps`."""
    made, tape, start = asked
    for step in steps_of(made.motion, start, end, accuracy):
        steps.append(step)
        for piece in watch(made.motion, tape, step, start.spread)[0].signs(arb(0), arb(1)):
            yield step, *piece


def _certificate(
    asked: Asked, steps: Sequence[CarriedStep], bits: int, kind: str, event: Any, claim: dict[str, Any]
) -> Certificate:
    """Of a claim about an event, or about means, which name their own expressions."""
    made, _, start = asked
    flow = flow_data(made.about, made.motion, start, steps, bits) | ({"event": event} if event else {})
    return flow | {"observed": observed_data(made), "kind": kind, "claim": claim}


def means(
    system: Any,
    values: Values | None = None,
    q0: Any = None,
    v0: Any = None,
    spans: Sequence[tuple[sp.Basic, Any, Any]] = (),
    tol: float = TOL,
) -> Means:
    """Means of expressions of the states over spans of time, (1/(t₂ − t₁)) ∫ e dt from t₁ to t₂, enclosed.

    Parameters
    ----------
    system
        As in `enclose`.
    values : Values or None, optional
        As in `enclose`.
    q0 : optional
        As in `enclose`.
    v0 : optional
        As in `enclose`.
    spans : sequence, default ()
        (expression, t₁, t₂) for each mean, t in s, expressions as in `crossing`.
    tol : float, default TOL
        As in `enclose`.

    Raises
    ------
    InputError
        For what makes no sense.
    NotProved
        Where the enclosure ends before the last t₂.
    """
    accuracy, where = accuracy_of(tol, "means"), "means"
    if not isinstance(spans, Sequence) or any(not isinstance(span, tuple | list) or len(span) != 3 for span in spans):
        raise InputError(f"{where}: spans = {spans!r} must be a list of (expression, t₁, t₂)")
    with precision(accuracy.bits, accuracy.terms):
        ends = [(ball(since, f"{where}: t"), time_ball(until, where)) for _, since, until in spans]
        if not ends or not all(0 <= since < until for since, until in ends):
            raise InputError(f"{where}: spans = {spans!r} must be (expression, t₁, t₂) with 0 ≤ t₁ < t₂, one at least")
        made, tape, start = prepared(system, values, q0, v0, [e for e, *_ in spans])
        last = ends[0][1]
        for _, until in ends:
            last = last.max(until)
        steps = tuple(steps_of(made.motion, start, last, accuracy))
        totals = [arb(0)] * len(ends)
        for step in steps:
            along = watch(made.motion, tape, step, start.spread)
            for i, span in enumerate(ends):
                low, high = (((x - step.node.t) / step.h).max(0).min(1) for x in span)
                if low < high:
                    totals[i] += step.h * along[i].integral(low, high)
        values_of = [total / (until - since) for total, (since, until) in zip(totals, ends, strict=True)]
        claim = [  # sixteen times as wide: another program's bounds are others
            words(e)
            | {
                "since": ball_data(since),
                "until": ball_data(until),
                "mean": ball_data(x + arb(0, (15 * radius(x)).upper())),
            }
            for (e, *_), (since, until), x in zip(spans, ends, values_of, strict=True)
        ]
        certificate = _certificate((made, tape, start), steps, accuracy.bits, "means", None, {"means": claim})
        whole = [(e, *span) for (e, *_), span in zip(spans, ends, strict=True)]
        return Means(tuple(whole), tuple(values_of), certificate)
