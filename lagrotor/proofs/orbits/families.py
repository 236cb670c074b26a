"""A family of orbits proved: the motions of every ε in [−1, 1], followed together as Taylor models of s and ε.

Over a step of length h in s = t/h the motion of the middle w = 0 is P(s, ε) + e. P is found by Picard's map; with its defect
δ = x(0) + h ∫ f(P) − P and L the bounds of |h J| over the tube, entry by entry, Gronwall's inequality gives |e| ≤ exp(L) δ.
The derivative D by the start, D' = h J D, likewise. A node is every

    x(ε) + b + V(ε, w) w,   |b_i| ≤ bounds, |w_i| ≤ W_i,

b what rounding and truncation have left, V a Taylor model over all w. Krawczyk's test is held for the ε of each cut. In
one box there is one orbit for each ε, and its derivative is regular: together they are one smooth curve.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from math import floor
from operator import add
from typing import Any

from lagrotor.errors import NotProved
from lagrotor.proofs.balls import ZERO, Ball, Balls, Matrix, arb, arb_mat, arb_poly, exact, max_of, radius, upper
from lagrotor.proofs.matrices import inside, krawczyk, middle_inverse, times
from lagrotor.proofs.orbits.closed_orbits import OrbitProblem
from lagrotor.proofs.orbits.taylor_models import Order, TaylorModel, sum_of_sizes
from lagrotor.proofs.stepping import Motion
from lagrotor.proofs.tails import Evaluation, TailError

Models = list[TaylorModel]
_TRIES = 6  # of a tube
_LONGEST, _MOST = 0.25, 40  # step, of the whole time; steps
_SHORTEST_CUT = 2.0**-10  # of ε
_SHARPER = 2  # Krawczyk's map once more, of the box that it has led to
_FIRST, _WIDEST, _BOXES = 1e-9, 1e-4, 3  # the box: its first half width, its largest, how many are tried


@dataclass(frozen=True)
class FamilyNode:
    """x: models of ε, one for each state and parameter; b: bounds; V: rows of models."""

    x: Models
    b: Balls
    V: list[Models]

    def derivative(self, eps: Ball) -> Matrix:
        """By the start, over the box, for every ε of a ball."""
        return arb_mat([[v.poly(eps) + arb(0, (v.rest or ZERO).abs_upper()) for v in row] for row in self.V])

    def wide(self, W: Balls) -> Balls:
        """Bounds of b + V w."""
        return [
            upper(b + sum((v.norm * w for v, w in zip(row, W, strict=True)), ZERO))
            for b, row in zip(self.b, self.V, strict=True)
        ]


@dataclass(frozen=True)
class FamilyStep:
    """A step of length h; bounds of how far any motion is from P over it, for states."""

    h: Ball
    tube: Balls


def first_node(x: Sequence[Any], p: int) -> FamilyNode:
    """At s = 0: polynomials of ε, and V = 1."""
    order, size = Order(1, p), len(x)
    V = [[TaylorModel(arb_poly([int(i == j)]), ZERO, order) for j in range(size)] for i in range(size)]
    return FamilyNode([TaylorModel(poly, ZERO, order) for poly in x], [ZERO] * size, V)


def family_step(
    motion: Motion, node: FamilyNode, W: Balls, left: Ball, n: int, tol: float
) -> tuple[FamilyStep, FamilyNode]:
    """A step, no longer than `left`, at which the last powers of s are tol of the state's size, and the node at its end.

    Raises TailError where a bound does not close.
    """
    p, moving = node.x[0].order.p, motion.moving
    order = Order(n, p)
    still = [TaylorModel(x.poly, ZERO, order) for x in node.x[moving:]]
    longest = arb(_LONGEST).min(left)
    P = _picard(motion, node, longest, order)
    shorter = _shortening(P, order, tol)
    h = left if shorter >= 1 and longest >= left else longest * shorter
    P = [_scaled(poly, h / longest, order.width) for poly in P]
    rates = Evaluation(motion.tape, [*(TaylorModel(x, ZERO, order) for x in P), *still]).outputs
    missed = [
        (TaylorModel(x.poly, ZERO, order) + f.integral(h) - TaylorModel(poly, ZERO, order)).norm
        for x, f, poly in zip(node.x, rates, P, strict=False)
    ]
    J, tube, growth = _tube(motion, node, W, P, missed, h, order)
    D = _derivative(J, h, order, growth)
    x = [TaylorModel(poly, ZERO, order).at_end() for poly in P]
    rests = grown(growth, [*missed, *[ZERO] * (len(D) - moving)])
    x = [centred(model) for model in (*x, *node.x[moving:])]
    b = [
        upper(sum((d.norm * before for d, before in zip(row, node.b, strict=True)), rest + model.rest))
        for row, rest, model in zip(D, rests, x, strict=True)
    ]
    V = [[centred(_sum([d * node.V[k][j] for k, d in enumerate(row)])) for j in range(len(D))] for row in D]
    return FamilyStep(h, tube), FamilyNode([TaylorModel(model.poly, ZERO, model.order) for model in x], b, V)


def centred(model: TaylorModel) -> TaylorModel:
    """With exact coefficients, their balls in the rest: else these would grow from step to step as intervals do."""
    coeffs = model.poly.coeffs()
    rest = sum((radius(c) for c in coeffs), model.rest or ZERO)
    return TaylorModel(arb_poly([exact(c) for c in coeffs]), rest, model.order)


def _shortening(P: list[Any], order: Order, tol: float) -> float:
    """The factor on s that makes the last powers small, exact in few bits and at most 1."""
    found = 1.0
    blocks = [_by_powers(poly, order) for poly in P]
    size = max(1.0, max(float(sum_of_sizes(block[0])) for block in blocks))
    for k in (order.n - 2, order.n - 1):
        most = max((float(sum_of_sizes(block[k])) for block in blocks if k < len(block)), default=0.0)
        if most > 0:
            found = min(found, (tol * size / most) ** (1 / k))
    return max(floor(found * 64), 1) / 64


def _scaled(poly: Any, factor: Ball, width: int) -> Any:
    """s replaced by factor s."""
    return arb_poly([x * factor ** (place // width) for place, x in enumerate(poly.coeffs())])


def _sum(models: Models) -> TaylorModel:
    return reduce(add, models)


def _picard(motion: Motion, node: FamilyNode, h: Ball, order: Order) -> list[Any]:
    """n powers of s of the motion of the middle."""
    moving, p = motion.moving, order.p
    P = [x.poly for x in node.x[:moving]]
    for n in range(2, order.n + 1):
        now = Order(n, p)
        models = [TaylorModel(x, None, now) for x in (*P, *(x.poly for x in node.x[moving:]))]
        rates = Evaluation(motion.tape, models).outputs
        P = [x.poly + f.integral(h).poly for x, f in zip(node.x, rates, strict=False)]
    return P


def _tube(
    motion: Motion, node: FamilyNode, W: Balls, P: list[Any], missed: Balls, h: Ball, order: Order
) -> tuple[list[Models], Balls, Matrix]:
    """J over all motions of the node; bounds of their distance from P; exp(L), L the bounds of |h J|."""
    moving, wide = motion.moving, node.wide(W)
    still = [TaylorModel(x.poly, w, order) for x, w in zip(node.x[moving:], wide[moving:], strict=True)]
    off = [*(x + y for x, y in zip(wide, missed, strict=False)), *wide[moving:]]
    tube = [upper(4 * max_of(off))] * moving
    for k in range(_TRIES):
        models = [*(TaylorModel(x, r, order) for x, r in zip(P, tube, strict=True)), *still]
        evaluation = Evaluation(motion.tape, models)
        zero = models[0].constant(ZERO)
        J = [[g if g is not None else zero for g in evaluation.gradient(i)[: len(node.x)]] for i in range(moving)]
        size = len(node.x)
        L = arb_mat([*([upper(h * g.norm) for g in row] for row in J), *[[ZERO] * size] * (size - moving)])
        growth = L.exp()
        needed = grown(growth, off)[:moving]
        if k and all(x <= r for x, r in zip(needed, tube, strict=True)):  # the first is a guess, alike in all
            return J, tube, growth
        tube = [upper(1.25 * x) for x in needed]
    raise TailError("the tube about the family is not bounded over the step")


def grown(growth: Matrix, off: Balls) -> Balls:
    """What deviations become, by Gronwall's inequality."""
    return [upper(x) for x in times(growth, off)]


def _derivative(J: list[Models], h: Ball, order: Order, growth: Matrix) -> list[Models]:
    """The step's derivative by states and parameters at s = 1, models of ε."""
    size, moving, p = len(J[0]), len(J), order.p
    parts = [[[arb_poly(x) for x in _by_powers(g.poly, order)] for g in row] for row in J]
    D: list[list[list[Any]]] = [[[arb_poly([int(i == j)])] for j in range(size)] for i in range(size)]
    for k in range(order.n - 1):
        for i, row in enumerate(parts):
            for j in range(size):
                total = arb_poly([])
                for g, column in zip(row, (D[m][j] for m in range(size)), strict=True):
                    for a in range(max(0, k + 1 - len(column)), min(k + 1, len(g))):
                        total += g[a] * column[k - a]
                D[i][j].append((total * (h / (k + 1))).truncate(p + 1))
    packed = [[TaylorModel(_packed(entry, order.width), ZERO, order) for entry in rows] for rows in D]
    end = [[entry.at_end() for entry in models] for models in packed]
    for j in range(size):
        missed = []
        for i, rates in enumerate(J):
            rate = _sum([g * packed[m][j] for m, g in enumerate(rates)])
            one = rate.constant(arb(int(i == j)))
            missed.append((one + rate.integral(h) - packed[i][j]).norm)
        for i, rest in enumerate(grown(growth, [*missed, *[ZERO] * (size - moving)])[:moving]):
            end[i][j] = TaylorModel(end[i][j].poly, rest, end[i][j].order)
    return end


def _by_powers(poly: Any, order: Order) -> list[Balls]:
    """Return for each power of s the coefficients of the powers of ε."""
    coeffs, width = poly.coeffs(), order.width
    return [coeffs[k : k + order.p + 1] for k in range(0, len(coeffs), width)]


def _packed(parts: Sequence[Any], width: int) -> Any:
    flat: Balls = []
    for part in parts:
        coeffs = part.coeffs()
        flat += [*coeffs, *[ZERO] * (width - len(coeffs))]
    return arb_poly(flat)


@dataclass(frozen=True, eq=False)
class FamilyProof:
    """One orbit for every ε, its start and pace within W of the polynomials x of ε, where it is alone; w holds it.

    n: powers of s; cuts: the ends of the parts of ε; node: after one unit of s.
    """

    problem: OrbitProblem
    x: tuple[Any, ...]
    W: tuple[Ball, ...]
    steps: tuple[FamilyStep, ...]
    n: int
    cuts: tuple[Ball, ...]
    w: tuple[Ball, ...]
    node: FamilyNode

    def pace(self, eps: Ball) -> Ball:
        """The time of one unit of s, s, for every ε of a ball."""
        return self.x[-1](eps) + self.w[-1]


def prove_family(problem: OrbitProblem, x: Sequence[Any], n: int, tol: float) -> FamilyProof:
    """Krawczyk's test about polynomials x of ε, the start's states and the pace; at the precision in force.

    The box is a first guess, then what the conditions are missed by. Raises NotProved where the test does not close.
    """
    w = [arb(_FIRST)] * len(problem.free)
    for _ in range(_BOXES):
        W = [arb(0)] * len(x)
        for i, wide in zip(problem.free, w, strict=True):
            W[i] = upper(wide)
        steps, node = _followed(problem.motion, x, W, n, tol)
        cuts = _tests(problem, node, W)
        if cuts is not None:
            ends, found = cuts
            return FamilyProof(problem, tuple(x), tuple(W), tuple(steps), n, tuple(ends), tuple(found), node)
        w = [8 * upper(y) + arb(_FIRST) / 8 for y in _misses(problem, node)]
        if not max_of(w) < _WIDEST:
            break
    raise NotProved("Krawczyk's test does not close over a part of the family")


def _followed(motion: Motion, x: Sequence[Any], W: Balls, n: int, tol: float) -> tuple[list[FamilyStep], FamilyNode]:
    """The steps, and the node after one unit of s."""
    node, left, steps = first_node(x, max(poly.degree() for poly in x)), arb(1), list[FamilyStep]()
    while left > 0:
        step, node = family_step(motion, node, W, left, n, tol)
        steps.append(step)
        left = left - step.h
        if len(steps) > _MOST:
            raise NotProved(f"more than {_MOST} steps are needed")
    return steps, node


def _tests(problem: OrbitProblem, node: FamilyNode, W: Balls) -> tuple[Balls, Balls] | None:
    """The ends of the cuts over which the test closes, and a box of all w; None where a cut would be too short."""
    ends, hull = [arb(-1)], [arb(0)] * len(problem.free)
    high = arb(1)
    while ends[-1] < 1:
        found = _krawczyk(problem, node, W, ends[-1].union(high))
        if found is not None:
            ends.append(high)
            hull = [a.union(b) for a, b in zip(hull, found, strict=True)]
            high = arb(1).min(high + 2 * (high - ends[-2]))
        else:
            high = (ends[-1] + high) / 2
            if not high - ends[-1] > _SHORTEST_CUT:
                return None
    return ends, hull


def _at(problem: OrbitProblem, node: FamilyNode, eps: Ball) -> tuple[Balls, Matrix]:
    """What must vanish at the middle, and the conditions' derivative over the box, for every ε of a ball."""
    D = node.derivative(eps)
    end = [x.poly(eps) + arb(0, b.abs_upper()) for x, b in zip(node.x, node.b, strict=True)]
    return problem.value([], end), problem.slope(D, problem.free)


def _krawczyk(problem: OrbitProblem, node: FamilyNode, W: Balls, eps: Ball) -> Balls | None:
    """K for every ε of a ball; None where it does not lie within the inner half of W."""
    w = [arb(0, W[i].upper()) for i in problem.free]
    value, slope = _at(problem, node, eps)
    try:
        A = middle_inverse(slope)
    except NotProved:
        return None
    K = krawczyk(value, slope, A, w)
    if not inside(K, [x / 2 for x in w]):
        return None
    for _ in range(_SHARPER):
        K = krawczyk(value, slope, A, K)
    return K


def _misses(problem: OrbitProblem, node: FamilyNode) -> Balls:
    """How far Newton's method would move the middle, at most, at some ε."""
    moves = []
    for k in range(-4, 5):
        value, slope = _at(problem, node, arb(k) / 4)
        moves.append(times(middle_inverse(slope), value))
    return [max_of([move[i] for move in moves]) for i in range(len(problem.free))]
