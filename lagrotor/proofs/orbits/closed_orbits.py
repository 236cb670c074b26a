"""Proved periodic orbits: Newton's method approximates an orbit, and the Krawczyk test proves existence and local uniqueness.

A reversal is a reflection of the states x ↦ A x, with signs ±1, that maps time-reversed motions to motions. An orbit from
the fixed set of A to that of a second reversal B takes a part 1/(2 m) of the period, m the order of A B. Without a reversal
the integration covers the whole orbit.

Floquet multipliers come from the enclosed monodromy matrix. Those of a conservative system come in pairs μ, 1/μ: a pair of
ones for the energy, and one more for every further integral. If one other pair remains, its sum is the trace minus the
ones: inside (−2, 2) the pair lies on the unit circle, outside it is real. For any other orbit, all multipliers are enclosed
individually; the multiplier along the motion is 1.
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
    format_ball,
    matrix_data,
    precision,
    upper,
)
from lagrotor.proofs.fields import Field, Values, field_of
from lagrotor.proofs.lohner_frames import Accuracy, LohnerStep, Start, flow_data, steps_of
from lagrotor.proofs.matrices import diagonal, inside, inverse, krawczyk, middle_inverse, times
from lagrotor.proofs.orbits.enclosure import accuracy_of, add_margin, time_ball
from lagrotor.proofs.statements import Certificate, Proved
from lagrotor.proofs.tape import with_pace
from lagrotor.proofs.taylor_step import Motion
from lagrotor.renamed import accept_old_keywords

Signs = tuple[int, ...]
Kind = Literal["elliptic", "hyperbolic", "attracting", "parabolic", "undecided"]
TOL = 1e-20
_COARSE = 1e-12  # tolerance of the first Newton steps
_NEWTON = 12


@dataclass(frozen=True)
class OrbitProblem:
    """The boundary-value problem of a periodic orbit.

    `motion` is scaled so that the arc to the end condition takes one unit of s. `free` has the places of the unknown states and
    of the pace. `conditions` has the places of the states that vanish at the end, or return to their initial values if there is
    no reversal. `first` and `last` are the reversals at start and end, () without.
    """

    motion: Motion
    free: tuple[int, ...]
    conditions: tuple[int, ...]
    first: Signs = ()
    last: Signs = ()

    @property
    def turns(self) -> int:
        """The number of arcs in a period."""
        return 1 if not self.first else 2 if self.first == self.last else 4

    def value(self, middle: Balls, end: Balls) -> Balls:
        """Return the residuals of the conditions: end values that must vanish, or changes over a period."""
        return [end[i] - (0 if self.first else middle[i]) for i in self.conditions]

    def slope(self, derivative: Matrix, by: Sequence[int]) -> Matrix:
        """Return the Jacobian matrix of the conditions with respect to the states and pace at the places `by`."""
        rows = [[derivative[i, j] - int(i == j and not self.first) for j in by] for i in self.conditions]
        return arb_mat(rows)


def monodromy(quarter: Matrix, first: tuple[int, ...], last: tuple[int, ...]) -> Matrix:
    """Return the monodromy matrix (A D⁻¹ B D)^m, where m is the order of A B.

    D is the derivative of the motion between the reversals A at the start and B at the end.
    """
    A, B = diagonal(first), diagonal(last)
    half = A * inverse(quarter) * B * quarter
    return half if first == last else half * half


def conservative_kind(matrix: Matrix, ones: int) -> tuple[Kind, Ball | None]:
    """Return the kind of a conservative orbit, and μ + 1/μ of the one pair besides `ones` multipliers equal to 1.

    Examples
    --------
    >>> conservative_kind(arb_mat([[2, 0], [0, arb("0.5")]]), 0)
    ('hyperbolic', 2.50000000000000)
    """
    pairs = matrix.nrows() - ones
    total = sum((matrix[i, i] for i in range(matrix.nrows())), arb(0)) - ones
    if pairs not in (0, 2):
        return "undecided", None
    if not fits_pairs(matrix, total, ones):
        what = f"the multipliers are not {ones} ones and a pair: the system has fewer integrals"
        raise InputError(f"periodic_orbit: {what}")
    if not pairs:
        return "parabolic", None
    return "elliptic" if abs(total) < 2 else "hyperbolic" if abs(total) > 2 else "undecided", total


def fits_pairs(matrix: Matrix, total: Ball, ones: int) -> bool:
    """Return True if the characteristic polynomial can be (z − 1)^ones (z² − total z + 1), or (z − 1)^ones without another
    pair.

    Examples
    --------
    >>> fits_pairs(arb_mat([[1, 3], [0, 1]]), arb(0), 2)
    True
    """
    pair = arb_poly([1, -total, 1]) if matrix.nrows() > ones else arb_poly([1])
    return all(x.contains(0) for x in (matrix.charpoly() - arb_poly([-1, 1]) ** ones * pair).coeffs())


def general_kind(matrix: Matrix) -> Kind:
    """Return 'attracting' if all multipliers but the one along the motion lie inside the unit circle.

    Return 'hyperbolic' if none of the others lies on the circle, and 'undecided' if neither is proved.
    """
    try:
        multipliers: list[Any] = matrix.eig()
    except ValueError:  # not proved to be distinct
        return "undecided"
    others: Balls = [abs(z) for z in multipliers if not z.contains(1)]
    if len(others) != len(multipliers) - 1 or not all(s < 1 or s > 1 for s in others):
        return "undecided"
    return "attracting" if all(s < 1 for s in others) else "hyperbolic"


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicOrbit(Proved):
    """A periodic orbit that exists and is unique near its initial state.

    Attributes
    ----------
    field : Field
        The equations of motion with the values of their parameters.
    period : Ball
        The period in s.
    frequency : Ball
        The angular frequency 2π/period in rad/s.
    start : tuple[Ball, ...]
        The states at t = 0.
    kind : str
        Stability by the Floquet multipliers: 'elliptic', 'hyperbolic', 'attracting', 'parabolic', or 'undecided' without a proof.
    pair_sum : Ball or None
        The sum μ + 1/μ of the pair of multipliers that is not 1; None without such a pair.
    proof : OrbitProof
        The data of the Krawczyk test.
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
        """The names of the states."""
        return tuple(map(str, self.field.states))

    @cached_property
    def certificate(self) -> Certificate:
        """The plain data that `check` verifies."""
        return self.proof.certificate(self)

    def summary(self) -> dict[str, str]:
        """Return period, frequency, stability and initial state.

        Returns
        -------
        dict[str, str]
            Name → text.
        """
        sums = {"μ + 1/μ": format_ball(self.pair_sum, 20)} if self.pair_sum is not None else {}
        return (
            {
                "period [s]": format_ball(self.period),
                "frequency [rad/s]": format_ball(self.frequency),
                "kind": self.kind,
            }
            | sums
            | {f"{name} at t = 0": format_ball(x, 25) for name, x in zip(self.names, self.start, strict=True)}
        )


@dataclass(frozen=True, eq=False)
class OrbitProof:
    """A Krawczyk test that succeeded: the initial box, the preconditioner A, the steps, and the image K of the box."""

    problem: OrbitProblem
    start: Start
    A: Matrix
    steps: tuple[LohnerStep, ...]
    image: Balls
    ones: int
    bits: int

    @property
    def derivative(self) -> Matrix:
        return self.steps[-1].end.derivative

    def states(self) -> Balls:
        """Return the enclosed initial state and pace of the orbit."""
        w = [x if x.is_zero() else arb(0) for x in self.start.spread]
        for i, x in zip(self.problem.free, self.image, strict=True):
            w[i] = x
        return [a + b for a, b in zip(self.start.middle, w, strict=True)]

    def stability(self) -> tuple[Kind, Ball | None]:
        """Return the kind of the orbit, and μ + 1/μ of the pair of multipliers that is not 1."""
        d = self.problem.motion.moving
        D = self.derivative
        block = arb_mat([[D[i, j] for j in range(d)] for i in range(d)])
        if not self.problem.first:
            return general_kind(block), None
        try:
            return conservative_kind(monodromy(block, self.problem.first, self.problem.last), self.ones)
        except NotProved:
            return "undecided", None

    def certificate(self, orbit: PeriodicOrbit) -> Certificate:
        problem = self.problem
        with precision(self.bits):
            flow = flow_data(orbit.field.subject, problem.motion, self.start, self.steps, self.bits)
            sums = {} if orbit.pair_sum is None else {"pair_sum": ball_data(add_margin(orbit.pair_sum))}
            return flow | {
                "kind": "periodic orbit",
                "free": list(problem.free),
                "conditions": list(problem.conditions),
                "reversals": [list(problem.first), list(problem.last)],
                "A": matrix_data(self.A),
                "ones": self.ones,
                "claim": {
                    "period": ball_data(add_margin(orbit.period)),
                    "start": balls_data([add_margin(x) for x in orbit.start]),
                    "kind": orbit.kind,
                }
                | sums,
            }


def prove_orbit(problem: OrbitProblem, middle: Balls, accuracy: Accuracy, ones: int, where: str) -> OrbitProof:
    """Prove an orbit near an initial state and pace, at the current precision.

    Raises NotProved; its message says how far the proof came.
    """
    middle, A, miss = refine_start(problem, list(middle), accuracy, where)
    sizes = [upper(x) for x in times(A, miss)]
    for grow in (2**10, 2**16, 2**24):
        spread = [arb(0)] * len(middle)
        for i, x in zip(problem.free, sizes, strict=True):
            unit = arb(2) ** -accuracy.bits
            spread[i] = arb(0, (grow * (x + abs(middle[i]) * 2**20 * unit + unit)).upper())
        start = Start(middle, spread)
        steps = tuple(steps_of(problem.motion, start, arb(1), accuracy))
        proof = krawczyk_proof(problem, start, A, steps, ones, accuracy.bits)
        if proof is not None:
            if not proof.states()[-1] > 0:
                raise NotProved(f"{where}: Newton's method leads to a period of zero: start nearer to the orbit")
            return proof
    place = f"{where}: Newton's method comes within {float(max(sizes)):.1g} of an orbit"
    raise NotProved(f"{place}, but Krawczyk's test does not close there")


def krawczyk_proof(
    problem: OrbitProblem, start: Start, A: Matrix, steps: tuple[LohnerStep, ...], ones: int, bits: int
) -> OrbitProof | None:
    """Return the proof if the Krawczyk image of the box lies inside the box, else None."""
    last = steps[-1].end
    w = [start.spread[i] for i in problem.free]
    image = krawczyk(problem.value(start.middle, last.middle), problem.slope(last.derivative, problem.free), A, w)
    return OrbitProof(problem, start, A, steps, image, ones, bits) if inside(image, w) else None


def refine_start(problem: OrbitProblem, middle: Balls, accuracy: Accuracy, where: str) -> tuple[Balls, Matrix, Balls]:
    """Improve the start and the pace by Newton's method on midpoints.

    Return them, a matrix A near the inverse of the derivative, and the residual of the conditions.
    """
    coarse = Accuracy(max(_COARSE, accuracy.tol))
    last = coarse if coarse.tol > accuracy.tol else accuracy
    last_size = float("inf")
    for _ in range(_NEWTON):
        still = Start(middle, [arb(0)] * len(middle))
        *_, step = steps_of(problem.motion, still, arb(1), last)
        miss = problem.value(middle, step.end.middle)
        A = middle_inverse(problem.slope(step.end.derivative, problem.free))
        move = times(A, miss)
        size = max(float(upper(x)) for x in move)
        if last is accuracy and (size < 1e3 * accuracy.tol or size > 0.1 * last_size):
            return middle, A, miss
        if not size < 1e3:
            break
        for i, x in zip(problem.free, move, strict=True):
            middle[i] = exact(middle[i] - x)
        if last is not accuracy and (size < 1e-4 or size > 0.1 * last_size):
            last, size = accuracy, float("inf")
        last_size = size
    raise NotProved(f"{where}: Newton's method finds no orbit near the given start")


@accept_old_keywords
def periodic_orbit(
    system: Any,
    values: Values | None = None,
    q0: Any = None,
    v0: Any = None,
    period: Any = None,
    reversals: Sequence[Sequence[int]] = (),
    integrals: int = 1,
    fixed: Sequence[Any] = (),
    tol: float = TOL,
) -> PeriodicOrbit:
    """Prove that a periodic orbit exists near an initial state and period.

    Parameters
    ----------
    system : System or Program
        The motion, without constraints and without explicit time.
    values : Mapping, optional
        Parameter → number.
    q0 : sequence, optional
        Coordinates near the orbit.
    v0 : sequence, optional
        Velocities near the orbit.
    period : number
        The approximate period in s.
    reversals : sequence, default ()
        One or two rows of signs ±1, one for each state (q, v), under which the reversed motion is a motion. The start lies in
        the fixed set of the first row. The orbit reaches the fixed set of the second after a quarter of a period; with one row,
        it reaches the same fixed set after half a period.
    integrals : int, default 1
        The number of integrals of motion, including the energy. Each makes two multipliers equal to 1.
    fixed : sequence, default ()
        Symbols or names of states that keep their value. Each parameter of a family of orbits requires one such state. By default
        they are the first states that the reversal leaves free.
    tol : float, default 1e-20
        Local error of a step, relative to the size of the state.

    Returns
    -------
    PeriodicOrbit
        The enclosed period and initial state, and the stability.

    Raises
    ------
    InputError
        If an argument does not fit the system.
    NotProved
        If no orbit can be proved. The message says how far the proof came.

    Examples
    --------
    >>> import sympy as sp
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("theta")
    >>> pendulum = System(c, c.v[0] ** 2 / 2 + sp.cos(c.q[0]))
    >>> periodic_orbit(pendulum, q0=[1], v0=[0], period=6.7, reversals=[(1, -1)], tol=1e-10).period
    [6.699975664 +/- 8.59e-10]
    """
    accuracy, where = accuracy_of(tol, "periodic_orbit"), "periodic_orbit"
    with precision(accuracy.bits, accuracy.terms):
        length = time_ball(period, where)
        field = field_of(system, values, q0, v0)
        n = len(field.states)
        if field.varying or field.stages or "t" in map(str, field.states):
            raise InputError("periodic_orbit: the values must be numbers; the equations have no explicit time")
        if field.constraints:
            raise InputError("periodic_orbit: an orbit is not proved to satisfy constraints: take free coordinates")
        first, last = reversals_of(system, field, reversals)
        problem = _problem_of(field, first, last, indices(field, fixed))
        start = [*field.start, length / problem.turns]
        for i, x in enumerate(start):
            if first and i < n and first[i] < 0:
                start[i] = arb(0)
            elif i in problem.free:
                start[i] = exact(x)
        return orbit_of(prove_orbit(problem, start, accuracy, 2 * integrals, where), field)


def orbit_of(proof: OrbitProof, field: Field) -> PeriodicOrbit:
    states = proof.states()
    period = states[-1] * proof.problem.turns
    start = tuple(states[: len(field.states)])
    return PeriodicOrbit(field, period, 2 * arb.pi() / period, start, *proof.stability(), proof)


def indices(field: Field, fixed: Sequence[Any]) -> tuple[int, ...]:
    """Return the places of states given by symbol or name."""
    names = [str(s) for s in field.states]
    if missing := [str(s) for s in fixed if str(s) not in names]:
        raise InputError(f"periodic_orbit: fixed = {', '.join(missing)}: the states are {', '.join(names)}")
    return tuple(names.index(str(s)) for s in fixed)


def _problem_of(field: Field, first: Signs, last: Signs, fixed: tuple[int, ...]) -> OrbitProblem:
    """Return the boundary-value problem. If there are k more unknowns than conditions, k states keep their values."""
    n = len(field.states)
    free = [i for i in range(n) if not first or first[i] > 0]
    conditions = [i for i in range(n) if last[i] < 0] if first else list(range(n))
    spare = len(free) + 1 - len(conditions)
    if spare < 0 or len(fixed) > spare or any(i not in free for i in fixed):
        raise InputError(
            f"periodic_orbit: {len(free)} free states and the period must satisfy {len(conditions)} conditions: fix "
            f"{max(spare, 0)} states that the reversal leaves free"
        )
    chosen = [*fixed, *(i for i in free if i not in fixed)][:spare]
    motion = Motion(with_pace(field.motion.tape, n), field.motion.parameters)
    return OrbitProblem(motion, (*(i for i in free if i not in chosen), n), tuple(conditions), first, last)


def reversals_of(system: Any, field: Field, reversals: Sequence[Sequence[int]]) -> tuple[Signs, Signs]:
    """Verify one or two time reversals, and return those at the start and at the end, each as one sign per state."""
    if not reversals:
        return (), ()
    rows = [tuple(row) for row in reversals]
    n = len(field.states)
    if len(rows) > 2 or any(len(row) != n or {*row} - {1, -1} for row in rows):
        raise InputError(f"periodic_orbit: reversals must be one or two rows of {n} signs 1 or −1")
    for row in rows:
        if not (isinstance(system, Equations) and reverses(system, row)):
            raise InputError(
                f"periodic_orbit: time reversed under the signs {row} is not proved to be a motion of the system: the Lagrangian "
                "must be the same at q → S q, v → −S v"
            )
    return rows[0], rows[-1]


def reverses(system: Equations, signs: Signs) -> bool:
    """Return True if (q, v) ↦ (S q, −S v) leaves L unchanged, so that the reversed motion is a motion; `signs` is (S, −S)."""
    n = len(system.c.q)
    S = signs[:n]
    if tuple(-s for s in S) != signs[n:] or system.dissipation != 0 or system.rolling or system.forces:
        return False
    reflection = {x: s * x for x, s in zip((*system.c.q, *system.c.v), signs, strict=True)}
    same = decide_zero(system.L.xreplace(reflection) - system.L).answer == "zero"
    return same and all(decide_zero(g.xreplace(reflection) - g).answer == "zero" for g in system.constraints)
