"""Periodic orbits proved: Newton's method finds them, Krawczyk's test proves that they exist and are alone nearby.

Where time reversed under a reflection of the states, x ↦ A x with signs ±1, is a motion again, an orbit that starts in the
fixed set of A and reaches that of B is its own image there: it closes after 2 m times that time, m the order of A B.
Without a reversal the whole orbit is followed.

Floquet multipliers come from the enclosed monodromy matrix. Of a conservative system they come in pairs μ, 1/μ: one pair of ones
for the energy with the shift of time, one more for every further integral. Where one pair is left, its sum is the trace less the
ones: inside (−2, 2) the pair lies on the unit circle, outside it is real. Of any other orbit all multipliers but the one along
the motion are enclosed one by one.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

from lagrotor.algebra import decide_zero
from lagrotor.errors import InputError, NotProved
from lagrotor.mechanics.equations import Equations
from lagrotor.proofs.balls import (
    Ball,
    Balls,
    Matrix,
    arb,
    arb_mat,
    arb_poly,
    ball_data,
    balls_data,
    exact,
    matrix_data,
    precision,
    printed,
    upper,
)
from lagrotor.proofs.fields import Field, Values, field_of
from lagrotor.proofs.lohner_frames import Accuracy, CarriedStep, Start, flow_data, steps_of
from lagrotor.proofs.matrices import diagonal, inside, inverse, krawczyk, middle_inverse, times
from lagrotor.proofs.orbits.enclosure import accuracy_of, loosened, time_ball
from lagrotor.proofs.statements import Certificate, Proved
from lagrotor.proofs.tape import paced
from lagrotor.proofs.taylor_step import Motion

Signs = tuple[int, ...]
Kind = Literal["elliptic", "hyperbolic", "attracting", "parabolic", "undecided"]
TOL = 1e-20
_COARSE = 1e-12  # of the first Newton steps
_NEWTON = 12


@dataclass(frozen=True)
class OrbitProblem:
    """Which starts are sought: the states and the pace free, the states at the end of one unit of s that must vanish.

    first, last: the reversals at the start and at the end, none where the orbit is followed through; then the conditions are
    that the states return.
    """

    motion: Motion
    free: tuple[int, ...]
    conditions: tuple[int, ...]
    first: Signs = ()
    last: Signs = ()

    @property
    def turns(self) -> int:
        """Times of one unit of s in a period."""
        return 1 if not self.first else 2 if self.first == self.last else 4

    def value(self, middle: Balls, end: Balls) -> Balls:
        """What must vanish."""
        return [end[i] - (0 if self.first else middle[i]) for i in self.conditions]

    def slope(self, derivative: Matrix, by: Sequence[int]) -> Matrix:
        """Its derivative by some of the states and the pace."""
        rows = [[derivative[i, j] - int(i == j and not self.first) for j in by] for i in self.conditions]
        return arb_mat(rows)


def trace(matrix: Matrix) -> Ball:
    """The sum of the diagonal."""
    return sum((matrix[i, i] for i in range(matrix.nrows())), arb(0))


def monodromy(quarter: Matrix, first: tuple[int, ...], last: tuple[int, ...]) -> Matrix:
    """(A D⁻¹ B D)^m from the derivative D between the reversals A at the start and B at the end, m the order of A B."""
    A, B = diagonal(first), diagonal(last)
    part = A * inverse(quarter) * B * quarter
    return part if first == last else part * part


def of_pairs(matrix: Matrix, ones: int) -> tuple[Kind, Ball | None]:
    """Return the kind of a conservative orbit with a number of multipliers that are 1, and μ + 1/μ of the one other pair.

    It is parabolic without another pair, undecided with more pairs.
    """
    left = matrix.nrows() - ones
    total = trace(matrix) - ones
    if left not in (0, 2):
        return "undecided", None
    if not fits(matrix, total, ones):
        raise InputError(
            f"periodic_orbit: the multipliers are not {ones} ones and a pair: the system has fewer integrals"
        )
    if not left:
        return "parabolic", None
    return "elliptic" if abs(total) < 2 else "hyperbolic" if abs(total) > 2 else "undecided", total


def fits(matrix: Matrix, total: Ball, ones: int) -> bool:
    """Whether the characteristic polynomial may be (z − 1)^ones (z² − total z + 1), without the pair where none is left."""
    pair = arb_poly([1, -total, 1]) if matrix.nrows() > ones else arb_poly([1])
    return all(x.contains(0) for x in (matrix.charpoly() - arb_poly([-1, 1]) ** ones * pair).coeffs())


def of_any(matrix: Matrix) -> Kind:
    """Return attracting where all multipliers but the one along the motion are inside the unit circle, hyperbolic off it."""
    try:
        found: list[Any] = matrix.eig()
    except ValueError:  # not apart
        return "undecided"
    others: Balls = [abs(z) for z in found if not z.contains(1)]
    if len(others) != len(found) - 1 or not all(s < 1 or s > 1 for s in others):
        return "undecided"
    return "attracting" if all(s < 1 for s in others) else "hyperbolic"


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicOrbit(Proved):
    """A periodic orbit that exists, the only one of its kind near its start.

    period (s) and frequency 2π/period (rad/s), balls; start: the states at t = 0; kind: by its multipliers. pair_sum: μ + 1/μ
    of the pair of multipliers that is not 1, where there is one. certificate: what `check` verifies.
    """

    field: Field
    period: Ball
    frequency: Ball
    start: tuple[Ball, ...]
    kind: Kind
    pair_sum: Ball | None
    proof: "OrbitProof"

    @property
    def names(self) -> tuple[str, ...]:
        """Of the states."""
        return tuple(map(str, self.field.states))

    @cached_property
    def certificate(self) -> Certificate:
        """Plain data that `check` verifies."""
        return self.proof.certificate(self)

    def summary(self) -> dict[str, str]:
        """Period, frequency, start and kind, name → words."""
        sums = {"μ + 1/μ": printed(self.pair_sum, 20)} if self.pair_sum is not None else {}
        return (
            {"period [s]": printed(self.period), "frequency [rad/s]": printed(self.frequency), "kind": self.kind}
            | sums
            | {f"{name} at t = 0": printed(x, 25) for name, x in zip(self.names, self.start, strict=True)}
        )


@dataclass(frozen=True, eq=False)
class OrbitProof:
    """The last run of a proof: the problem, the start with its box, A, the steps, and K about the middle."""

    problem: OrbitProblem
    start: Start
    A: Matrix
    steps: tuple[CarriedStep, ...]
    found: Balls
    ones: int
    bits: int

    @property
    def derivative(self) -> Matrix:
        """Of the end by the start's coordinates w."""
        return self.steps[-1].end.derivative

    def states(self) -> Balls:
        """The orbit's start and pace, enclosed."""
        w = [x if x.is_zero() else arb(0) for x in self.start.spread]
        for i, x in zip(self.problem.free, self.found, strict=True):
            w[i] = x
        return [a + b for a, b in zip(self.start.middle, w, strict=True)]

    def stability(self) -> tuple[Kind, Ball | None]:
        """Return the kind of the orbit, and μ + 1/μ of the one pair of multipliers that is not 1."""
        d = self.problem.motion.moving
        D = self.derivative
        part = arb_mat([[D[i, j] for j in range(d)] for i in range(d)])
        if not self.problem.first:
            return of_any(part), None
        try:
            return of_pairs(monodromy(part, self.problem.first, self.problem.last), self.ones)
        except NotProved:
            return "undecided", None

    def certificate(self, orbit: PeriodicOrbit) -> Certificate:
        """Plain data."""
        problem = self.problem
        with precision(self.bits):
            flow = flow_data(orbit.field.about, problem.motion, self.start, self.steps, self.bits)
            sums = {} if orbit.pair_sum is None else {"pair_sum": ball_data(loosened(orbit.pair_sum))}
            return flow | {
                "kind": "periodic orbit",
                "free": list(problem.free),
                "conditions": list(problem.conditions),
                "reversals": [list(problem.first), list(problem.last)],
                "A": matrix_data(self.A),
                "ones": self.ones,
                "claim": {
                    "period": ball_data(loosened(orbit.period)),
                    "start": balls_data([loosened(x) for x in orbit.start]),
                    "kind": orbit.kind,
                }
                | sums,
            }


def prove_orbit(problem: OrbitProblem, middle: Balls, accuracy: Accuracy, ones: int, where: str) -> OrbitProof:
    """From a start and pace near those of an orbit; at the precision in force. Raises NotProved with how far it came."""
    middle, A, miss = refined(problem, list(middle), accuracy, where)
    sizes = [upper(x) for x in times(A, miss)]
    for grow in (2**10, 2**16, 2**24):
        spread = [arb(0)] * len(middle)
        for i, x in zip(problem.free, sizes, strict=True):
            spread[i] = arb(
                0, (grow * (x + abs(middle[i]) * arb(2) ** (20 - accuracy.bits) + arb(2) ** -accuracy.bits)).upper()
            )
        start = Start(middle, spread)
        steps = tuple(steps_of(problem.motion, start, arb(1), accuracy))
        proof = closing(problem, start, A, steps, ones, accuracy.bits)
        if proof is not None:
            if not proof.states()[-1] > 0:
                raise NotProved(f"{where}: Newton's method leads to a period of zero: start nearer to the orbit")
            return proof
    raise NotProved(
        f"{where}: Newton's method comes within {float(max(sizes)):.1g} of an orbit, but Krawczyk's test does not close there"
    )


def closing(
    problem: OrbitProblem,
    start: Start,
    A: Matrix,
    steps: tuple[CarriedStep, ...],
    ones: int,
    bits: int,
) -> OrbitProof | None:
    """The proof, where K lies within the box."""
    last = steps[-1].end
    w = [start.spread[i] for i in problem.free]
    found = krawczyk(problem.value(start.middle, last.middle), problem.slope(last.derivative, problem.free), A, w)
    return OrbitProof(problem, start, A, steps, found, ones, bits) if inside(found, w) else None


def refined(problem: OrbitProblem, middle: Balls, accuracy: Accuracy, where: str) -> tuple[Balls, Matrix, Balls]:
    """Newton's method on midpoints: the start and pace, A near the inverse of the conditions' derivative, and what they miss."""
    coarse = Accuracy(max(_COARSE, accuracy.tol))
    last = coarse if coarse.tol > accuracy.tol else accuracy
    before = float("inf")
    for _ in range(_NEWTON):
        still = Start(middle, [arb(0)] * len(middle))
        *_, step = steps_of(problem.motion, still, arb(1), last)
        miss = problem.value(middle, step.end.middle)
        A = middle_inverse(problem.slope(step.end.derivative, problem.free))
        move = times(A, miss)
        size = max(float(upper(x)) for x in move)
        if last is accuracy and (size < 1e3 * accuracy.tol or size > 0.1 * before):
            return middle, A, miss
        if not size < 1e3:
            break
        for i, x in zip(problem.free, move, strict=True):
            middle[i] = exact(middle[i] - x)
        if last is not accuracy and (size < 1e-4 or size > 0.1 * before):
            last, size = accuracy, float("inf")
        before = size
    raise NotProved(f"{where}: Newton's method finds no orbit near the start that is given")


def periodic_orbit(
    system: Any,
    values: Values | None = None,
    q0: Any = None,
    v0: Any = None,
    period: Any = None,
    reversals: Sequence[Sequence[int]] = (),
    integrals: int = 1,
    held: Sequence[Any] = (),
    tol: float = TOL,
) -> PeriodicOrbit:
    """The periodic orbit near the start q0, v0 and the period (s), proved to exist.

    Parameters
    ----------
    values : Values or None, optional
        As in `enclose`.
    tol : float, default TOL
        As in `enclose`.
    reversals : sequence, default ()
        One or two rows of signs ±1, one for each state (q, v): time reversed under the first is a motion, and the
        start lies in its fixed set; likewise the second, if any, at a quarter period instead of the first at half of it.
    held : sequence, default ()
        States that keep their value, by symbol or name; where orbits come in families, as many as the family has parameters
        are held, the first that can be, unless given.
    integrals : int, default 1
        How many the system has, its energy among them, each with a pair of multipliers that are 1.

    Raises
    ------
    InputError
        For what makes no sense.
    NotProved
        Where no orbit can be proved, with how far it came.
    """
    accuracy, where = accuracy_of(tol, "periodic_orbit"), "periodic_orbit"
    with precision(accuracy.bits, accuracy.terms):
        length = time_ball(period, where)
        made = field_of(system, values, q0, v0)
        n = len(made.states)
        if made.varying or made.stages or "t" in map(str, made.states):
            raise InputError("periodic_orbit: values are numbers, and the time is not in the equations")
        if made.held:
            raise InputError("periodic_orbit: an orbit is not shown to keep constraints: take free coordinates")
        first, last = reversals_of(system, made, reversals)
        problem = _problem_of(made, first, last, indices(made, held))
        start = [*made.start, length / problem.turns]
        for i, x in enumerate(start):
            if first and i < n and first[i] < 0:
                start[i] = arb(0)
            elif i in problem.free:
                start[i] = exact(x)
        return orbit_of(prove_orbit(problem, start, accuracy, 2 * integrals, where), made)


def orbit_of(proof: OrbitProof, made: Field) -> PeriodicOrbit:
    """What a proof says."""
    states = proof.states()
    period = states[-1] * proof.problem.turns
    start = tuple(states[: len(made.states)])
    return PeriodicOrbit(made, period, 2 * arb.pi() / period, start, *proof.stability(), proof)


def indices(made: Field, held: Sequence[Any]) -> tuple[int, ...]:
    """Places of states by symbol or name."""
    names = [str(s) for s in made.states]
    if missing := [str(s) for s in held if str(s) not in names]:
        raise InputError(f"periodic_orbit: held = {', '.join(missing)}: the states are {', '.join(names)}")
    return tuple(names.index(str(s)) for s in held)


def _problem_of(made: Field, first: Signs, last: Signs, held: tuple[int, ...]) -> OrbitProblem:
    """The free states and the conditions; as many states are held as there are more unknowns than conditions."""
    n = len(made.states)
    free = [i for i in range(n) if not first or first[i] > 0]
    conditions = [i for i in range(n) if last[i] < 0] if first else list(range(n))
    spare = len(free) + 1 - len(conditions)
    if spare < 0 or len(held) > spare or any(i not in free for i in held):
        raise InputError(
            f"periodic_orbit: {len(free)} free states and the period for {len(conditions)} conditions: hold "
            f"{max(spare, 0)} states that the reversal leaves free"
        )
    chosen = [*held, *(i for i in free if i not in held)][:spare]
    motion = Motion(paced(made.motion.tape, n), made.motion.parameters)
    return OrbitProblem(motion, (*(i for i in free if i not in chosen), n), tuple(conditions), first, last)


def reversals_of(system: Any, made: Field, given: Sequence[Sequence[int]]) -> tuple[Signs, Signs]:
    """One or two rows of signs, each proved to reverse the motion."""
    if not given:
        return (), ()
    rows = [tuple(row) for row in given]
    n = len(made.states)
    if len(rows) > 2 or any(len(row) != n or {*row} - {1, -1} for row in rows):
        raise InputError(f"periodic_orbit: reversals must be one or two rows of {n} signs 1 or −1")
    for row in rows:
        if not (isinstance(system, Equations) and reverses(system, row)):
            raise InputError(
                f"periodic_orbit: time reversed under the signs {row} is not shown to be a motion of the system: the Lagrangian "
                "must be the same at q → S q, v → −S v"
            )
    return rows[0], rows[-1]


def reverses(system: Equations, signs: Signs) -> bool:
    """Whether (q, v) ↦ signs (q, v) with time reversed takes motions to motions: S of the q, −S of the v, L unchanged."""
    n = len(system.c.q)
    S = signs[:n]
    if tuple(-s for s in S) != signs[n:] or system.dissipation != 0 or system.rolling or system.forces:
        return False
    put = {x: s * x for x, s in zip((*system.c.q, *system.c.v), signs, strict=True)}
    same = decide_zero(system.L.xreplace(put) - system.L).answer == "zero"
    return same and all(decide_zero(g.xreplace(put) - g).answer == "zero" for g in system.constraints)
