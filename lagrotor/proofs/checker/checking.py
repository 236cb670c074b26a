"""The checker: a second program that verifies a certificate with its own series arithmetic.

It searches for nothing: steps, frames, orders and orbits are in the certificate. It propagates each set through its step by
its own Taylor recurrences; the image must lie in the next set. Derivatives come from dual numbers, in forward mode.
"""

from collections.abc import Callable, Sequence
from math import isfinite
from typing import Any

from flint import arb, arb_mat, arb_poly, ctx

from lagrotor.errors import InputError, NotProved
from lagrotor.proofs.checker.bounded_series import Dual, Series, evaluate, sign_over
from lagrotor.proofs.checker.certified_sets import (
    MOST_BITS,
    Flow,
    VerifiedSteps,
    balls,
    column,
    krawczyk,
    matrix,
    number,
    read_ball,
)
from lagrotor.proofs.checker.expression_tapes import tape_of_words
from lagrotor.proofs.checker.orbit_checking import check_orbit
from lagrotor.proofs.checker.subject_checking import LagrangianOfWords, check_subject, demand_equal, second_derivatives
from lagrotor.proofs.checker.tapes import ZERO, demand, is_place
from lagrotor.proofs.statements import theorem_of

Ball = Any
_MORE_BITS = 64


def check(certificate: Any) -> str:
    """Verify a certificate and return its theorem in words.

    The words are composed from the verified claim. The checker evaluates the text of each expression, and proves that the
    program belongs to the scene, structure, Lagrangian or rates that the theorem names.

    Parameters
    ----------
    certificate : Certificate
        The `certificate` of a result, or the same data from a JSON file.

    Returns
    -------
    str
        The theorem.

    Raises
    ------
    InputError
        If the data are no certificate.
    NotProved
        If a condition fails. The message names the first one.

    Examples
    --------
    >>> from lagrotor.mechanics import System, coordinates
    >>> from lagrotor.proofs import enclose
    >>> c = coordinates("x")
    >>> check(enclose(System(c, (c.v[0] ** 2 - c.q[0] ** 2) / 2), q0=[1], v0=[0], t=1, tol=1e-10).certificate)
    'At t = 1.00000000000000: x in [0.5403023...], x_dot in [-0.8414709...]. This holds for the system with L = ...'
    """
    try:
        certificate = plain(certificate)
        version, rule = certificate["version"], _RULES[certificate["kind"]]
    except (LookupError, TypeError, ValueError, RecursionError):
        what = "check: a certificate is the dictionary of `.certificate`, with a known version and kind"
        raise InputError(what) from None
    if type(version) is not int or version != 1:
        raise InputError(f"check: version {version} of certificates is unknown; this program reads 1")
    outer = ctx.prec
    try:
        demand(is_place(certificate["bits"], MOST_BITS), "the precision is no valid number of bits")
        ctx.prec = certificate["bits"] + _MORE_BITS
        check_subject(certificate)
        rule(certificate)
        words = theorem_of(certificate)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError, RecursionError):
        what = "check: the certificate cannot be followed: an entry is missing, is no number, or has another shape"
        raise NotProved(what) from None
    finally:
        ctx.prec = outer
    return words


def plain(data: Any) -> Any:
    """Return data as read from a JSON file: lists, dictionaries, text, finite numbers. Raises TypeError for anything else.

    Examples
    --------
    >>> plain({"terms": (1, 2.5, "1p0")})
    {'terms': [1, 2.5, '1p0']}
    """
    if isinstance(data, dict) and all(isinstance(key, str) for key in data):
        return {key: plain(x) for key, x in data.items()}
    if isinstance(data, list | tuple):
        return [plain(x) for x in data]
    if not (data is None or isinstance(data, str | int) or (isinstance(data, float) and isfinite(data))):
        raise TypeError(f"{data!r} is no plain data")
    return data


def check_enclosure(certificate: Any) -> None:
    """Verify that the last box lies within the claimed states, at the claimed time."""
    carried, claim = VerifiedSteps(certificate), certificate["claim"]
    demand(carried.time.contains(read_ball(claim["t"])), "the steps do not end at the claimed time")
    claimed = balls(claim["states"])
    demand(0 < len(claimed) <= len(carried.box), "no states are claimed")
    fits = all(y.contains(x) for x, y in zip(carried.box, claimed, strict=False))
    demand(fits, "the claimed states do not contain the enclosed ones")


def pieces_of(certificate: Any, carried: VerifiedSteps, named: Sequence[Any]) -> Any:
    """Yield for each step the start time, the length, and the series of the named expressions."""
    at = ZERO
    tape = tape_of_words(named, carried.flow.tape["arguments"], certificate["observed"])
    for box, h, n in carried.boxes:
        rows = carried.flow.step(box, h, n)
        arguments = carried.flow.arguments(rows, box[carried.flow.moving :], None, n)
        yield at, h, [result.value for result in evaluate(tape, arguments)]
        at += h


def check_crossing(certificate: Any) -> None:
    """Verify opposite signs at the ends of the claimed time and, for a first crossing, one sign before it."""
    carried, claim = VerifiedSteps(certificate), certificate["claim"]
    pieces = [*pieces_of(certificate, carried, [certificate["event"]])]
    time = read_ball(claim["time"])
    ends = []
    for moment in (arb(time.lower()), arb(time.upper())):
        signs = set()
        for at, h, (series,) in pieces:
            s = (moment - at) / h
            if not (s < 0 or s > 1):  # a time at a node can be in either step
                value = arb_poly(series.terms)(within_step(s)) + arb(0, series.remainder.upper())
                signs.add(1 if value > 0 else -1 if value < 0 else 0)
        ends.append(signs)
    changes = ends in ([{1}, {-1}], [{-1}, {1}])
    demand(changes, "the expression does not change its sign over the claimed time")
    if claim["first"]:
        signs = set()
        for at, h, (series,) in pieces:
            s = (arb(time.lower()) - at) / h
            if not s <= 0:
                signs.add(sign_over(arb_poly(series.terms), series.remainder, ZERO, within_step(s)))
        demand(signs == ends[0], "the expression may pass zero before the claimed time")


def within_step(s: Ball) -> Ball:
    return s.max(ZERO).min(arb(1))


def check_no_crossing(certificate: Any) -> None:
    """Verify one sign over every step."""
    carried = VerifiedSteps(certificate)
    claimed = read_ball(certificate["claim"]["time"])
    demand(claimed > 0, "no time is claimed")
    demand(carried.time.contains(claimed) or carried.time >= claimed, "the steps end before the claimed time")
    pieces = pieces_of(certificate, carried, [certificate["event"]])
    signs = {sign_over(arb_poly(f.terms), f.remainder, ZERO, arb(1)) for _, _, (f,) in pieces}
    demand(len(signs) == 1 and 0 not in signs, "the expression may pass zero")


def check_means(certificate: Any) -> None:
    carried, claims = VerifiedSteps(certificate), certificate["claim"]["means"]
    demand(len(claims) > 0, "no mean is claimed")
    spans = [(read_ball(x["since"]), read_ball(x["until"])) for x in claims]
    for since, until in spans:
        demand(bool(since >= 0 and since < until), "the interval of a mean has no length")
        demand(carried.time.contains(until) or carried.time >= until, "the steps end before the interval of a mean")
    totals = [ZERO] * len(claims)
    for at, h, series in pieces_of(certificate, carried, claims):
        for i, (f, span) in enumerate(zip(series, spans, strict=True)):
            low, high = (within_step((x - at) / h) for x in span)
            whole = arb_poly(f.terms).integral()
            totals[i] += h * (whole(high) - whole(low) + arb(0, ((high - low) * f.remainder).abs_upper()))
    for x, total, (since, until) in zip(claims, totals, spans, strict=True):
        fits = read_ball(x["mean"]).contains(total / (until - since))
        demand(fits, "a claimed mean does not contain the enclosed one")


def check_equilibrium(certificate: Any) -> None:
    """Verify the Krawczyk test for the accelerations at rest, and the stability."""
    flow = Flow(certificate["motion"])
    n = flow.moving // 2
    rates = [flow.tape["operations"][place] for place in flow.tape["outputs"][:n]]
    demand(rates == [["argument", n + i] for i in range(n)], "the coordinates' rates are not the velocities")
    middle, box = [number(x) for x in certificate["middle"]], balls(certificate["box"])
    fits = len(middle) == len(box) == n and flow.size == flow.moving == 2 * n
    demand(fits, "the equilibrium does not fit the motion")
    demand(all(x.contains(0) for x in box), "the box does not contain its middle")
    A = matrix(certificate["A"])
    wide = [x + y for x, y in zip(middle, box, strict=True)]
    at = gradients(flow.tape, flow, [*middle, *[ZERO] * n])
    J = gradients(flow.tape, flow, [*wide, *[ZERO] * n])
    value = column([f.value.at_start() for f in at[n:]])
    slope = arb_mat([[x.at_start() for x in (f.by or [])[:n]] for f in J[n:]])
    states = [x + y for x, y in zip(middle, krawczyk(value, slope, A, box), strict=True)]
    fits = all(y.contains(x) for x, y in zip(states, balls(certificate["claim"]["q"]), strict=True))
    demand(fits, "the claimed coordinates do not contain the equilibrium")
    claim = certificate["claim"]["stability"]
    kinds = ("stable", "asymptotically stable", "stable to first order", "unstable", "undecided")
    demand(claim in kinds, "the claimed stability is unknown")
    if claim == "unstable":
        demand(any(z.real > 0 for z in linear(J, n).eig()), "no eigenvalue is proved to have a positive real part")
    elif claim == "asymptotically stable":
        demand(all(z.real < 0 for z in linear(J, n).eig()), "an eigenvalue is not proved to have a negative real part")
    elif claim != "undecided":
        check_stable(certificate, J, n, [*wide, *[ZERO] * n, *flow.parameters])


def check_stable(certificate: Any, J: Sequence[Dual], n: int, state: list[Ball]) -> None:
    """Verify that the energy of a conservative system is definite, or that its eigenvalues are distinct and imaginary."""
    claim, about = certificate["claim"]["stability"], certificate["about"]
    demand(about is not None and "Lagrangian" in about, "the theorem names no Lagrangian with a conserved energy")
    system = LagrangianOfWords(certificate, about["Lagrangian"])
    demand(system.autonomous and about["Lagrangian"]["dissipation"] == "0", "the system is not conservative")
    if claim == "stable":
        energy = system.words.place(certificate["energy"])
        demand_equal(system.words, [energy], [system.energy()], "the energy is not that of the Lagrangian")
        H = second_derivatives(system.words.tape([energy]), [*state, *system.others], 2 * n)
        for k in range(1, 2 * n + 1):
            demand(arb_mat([row[:k] for row in H[:k]]).det() > 0, "the energy is not proved to be definite")
    else:
        values = linear(J, n).eig()
        apart = all(not a.imag.overlaps(b.imag) for i, a in enumerate(values) for b in values[:i])
        demand(apart and all(z.real.contains(0) for z in values), "the eigenvalues are not proved to be imaginary")


def linear(J: Sequence[Dual], n: int) -> Any:
    """Return the matrix of the linearised motion in (q, v); J has the derivatives of the rates."""
    zero = Series([ZERO], ZERO, 1)
    return arb_mat([[x.at_start() for x in (f.by or [zero] * 2 * n)] for f in J])


def gradients(tape: Any, flow: Flow, state: list[Ball]) -> list[Dual]:
    """Return the outputs of the tape, each with its derivatives with respect to the states."""
    rows = [Series([x], ZERO, 1) for x in state]
    by = [[Series([arb(int(i == j))], ZERO, 1) for j in range(len(state))] for i in range(len(state))]
    return evaluate(tape, flow.arguments(rows, [], by, 1))


_RULES: dict[str, Callable[[Any], None]] = {
    "enclosure": check_enclosure,
    "crossing": check_crossing,
    "no crossing": check_no_crossing,
    "means": check_means,
    "periodic orbit": check_orbit,
    "equilibrium": check_equilibrium,
}
