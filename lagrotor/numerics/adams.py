"""Adams predictor and corrector in equal steps: the engine for tight tolerances, its order exact before rounding."""

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache

import numpy as np

from lagrotor.numerics.segment import Array, Segment, StopError, Stretch, states_on_constraints

_BLOCK = 100
_SWEEPS = 25
_PATIENCE = 5_000  # evaluations before they are weighed against the share of the run that is done
_PIECE = 2_000  # steps, after which a longer one than had failed before is tried again
_IN_VAIN = 3  # times that a step is shortened at one place by what its order says, and leaves too much as before


def adams_order(error: float) -> int:
    """Order of the pair for a local error: the higher, the fewer steps accuracy needs, and the shorter those that are stable."""
    return 10 if error >= 1e-10 else 12


@lru_cache(maxsize=8)
def adams_weights(q: int) -> tuple[Array, Array, Array, Array]:
    """Weights of an Adams pair of q nodes, from the Lagrange polynomials l_j of q equal steps, exact before rounding.

    A: integrals from the last node to the one after it (Adams–Bashforth); B: from the last but one to the last
    (Adams–Moulton), both (2, q): rounded, and what rounding left. Without that every step of every run has the same
    error, which no comparison of two runs shows. S (q, q): from the first node to each; P (q, q + 1): the integral of l_j
    from the middle node q // 2 as a polynomial in steps from there.
    """
    middle, last = q // 2, q - 1 - q // 2
    nodes = [i - middle for i in range(q)]
    rows = []
    for j in nodes:
        lagrange = [Fraction(1)]  # coefficients of ascending powers
        for i in nodes:
            if i != j:
                pairs = zip([Fraction(0), *lagrange], [*lagrange, Fraction(0)], strict=True)
                lagrange = [(shifted - i * own) / (j - i) for shifted, own in pairs]
        rows.append([Fraction(0), *(c / (n + 1) for n, c in enumerate(lagrange))])

    def at(row: list[Fraction], x: int) -> Fraction:
        return sum((c * x**n for n, c in enumerate(row)), Fraction(0))

    def in_two(weights: list[Fraction]) -> Array:
        return np.array([[float(w) for w in weights], [float(w - Fraction(float(w))) for w in weights]])

    A = in_two([at(row, last + 1) - at(row, last) for row in rows])
    B = in_two([at(row, last) - at(row, last - 1) for row in rows])
    S = [[at(row, node) - at(row, nodes[0]) for row in rows] for node in nodes]
    return A, B, np.array(S, float), np.array(rows, float)


@dataclass(frozen=True)
class _Piece:
    """Equal steps h from t by the pair of order q: states and velocities y' (n + 1, d) at the nodes, evaluations, and the
    factor by which h is to change."""

    q: int
    t: float
    h: float
    states: Array
    velocities: Array
    evaluations: int
    change: float

    def read(self, times: Array) -> Array:
        """States (m, d) at times within the piece, by the polynomial of the pair itself."""
        q = self.q
        P = adams_weights(q)[3]
        steps = (times - self.t) / self.h
        middle = np.clip(np.floor(steps).astype(int), q // 2, len(self.states) - q + q // 2)
        weights = np.vander(steps - middle, q + 1, increasing=True) @ P.T
        window = self.velocities[middle[:, None] + np.arange(q) - q // 2]
        return self.states[middle] + self.h * np.einsum("mj,mjd->md", weights, window)


def _piece(segment: Segment, q: int, y: Array, t: float, h: float, steps: int, limit: float) -> _Piece:
    """Steps of h until `steps` are made, or h is found too long (change < 1) or needlessly short (change > 1).

    Predict, evaluate, correct, evaluate; predictor less corrector, over h, is held under `limit` (Hairer, Nørsett &
    Wanner, III.1).
    """
    rhs = segment.rhs
    A, B, _, _ = adams_weights(q)
    states, velocities, off = np.empty((3, steps + 1, len(y)))
    evaluations, settled = _first_nodes(segment, q, y, t, h, states[:q], velocities[:q])
    if not settled:
        return _Piece(q, t, h, states[:1], velocities[:1], evaluations, 0.5)

    # What rounding alone leaves of predictor less corrector, over h, in the component that moves fastest for its size.
    fastest = (np.abs(velocities[:q]).max(axis=0) / (1 + np.abs(states[q - 1]))).max()
    noise = 4 * np.finfo(float).eps * (np.abs(A[0]).sum() * fastest + 1 / h)
    limit = max(limit, noise)
    last, n = states[q - 1], q
    while n <= steps:
        block = range(n, min(n + (_BLOCK if n > q else 2 * q), steps + 1))
        for n in block:
            mean, rest = A.dot(velocities[n - q : n])
            predicted = last + h * (mean + rest)
            velocities[n] = rhs(t + n * h, predicted)
            mean, rest = B.dot(velocities[n - q + 1 : n + 1])
            states[n] = last = last + h * (mean + rest)
            off[n] = last - predicted
            velocities[n] = rhs(t + n * h, last)
        evaluations += 2 * len(block)
        # Each component against its own size: one that grows without end, an azimuth, would loosen all others.
        worst = (np.abs(off[block.start : n + 1]).max(axis=0) / (1 + np.abs(last))).max() / h + 1e-300
        change = min(max(0.3, (limit / worst / 4) ** (1 / q)), 3.0) if np.isfinite(worst) else 0.3
        near = segment.time_to_singular and any(segment.clear(y) < h for y in states[block.start - q : n + 1])
        if near or not worst <= limit:
            change = min(change, 0.5) if near else change
            kept = block.start if block.start > q else 1
            return _Piece(q, t, h, states[:kept], velocities[:kept], evaluations, change)
        if segment.project is not None:
            states[n] = last = segment.project(last)
        n += 1
        if worst < max(limit / 300, noise) and n <= steps and 1.3 * h < segment.longest:
            return _Piece(q, t, h, states[:n], velocities[:n], evaluations, change)
    return _Piece(q, t, h, states, velocities, evaluations, 1.0)


def _first_nodes(
    segment: Segment, q: int, y: Array, t: float, h: float, states: Array, velocities: Array
) -> tuple[int, bool]:
    """The first q nodes together: their integral equation is swept until nothing moves. Evaluations, and whether it does."""
    S, size = h * adams_weights(q)[2], 1 + np.abs(y).max()
    states[:], velocities[:] = y, segment.rhs(t, y)
    evaluations = 1
    for sweep in range(_SWEEPS):
        before = states.copy()
        states[:] = y + S @ velocities
        for i in range(1, q):
            velocities[i] = segment.rhs(t + i * h, states[i])
        evaluations += q - 1
        moved = np.abs(states - before).max()
        if sweep and not moved > 2e-15 * size:
            break
    return evaluations, bool(moved < 1e-13 * size)


def adams(segment: Segment, error: float) -> Stretch:
    """Adams predictor and corrector in equal steps, changed where the pair's own difference requires it.

    Raises StopError with what was reached, also where far more than its share of `budget` is spent, and where shorter
    steps leave as much: the right-hand side is not known well enough for the tolerance.
    """
    t_eval, right, y, t, longest = segment.t_eval, segment.right, segment.start, segment.left, segment.longest
    q, limit = adams_order(error), min(100 * error, 1e-3)  # of order 10, steps that leave more are not stable
    h = min(
        (right - t) / q,
        segment.longest,
        min(limit ** (1 / q) / 5, 0.05) / (max(segment.relative_speed, segment.typical_rate) + 1e-300),
    )
    states, done, evaluations, end, in_vain = np.empty((len(t_eval), len(y))), 0, 1, y, 0
    while t < right:
        steps = min(max(int(np.ceil((right - t) / h)), q), _PIECE)
        with np.errstate(all="ignore"):  # a step that is too long overflows, and is shortened
            piece = _piece(replace(segment, longest=longest), q, y, t, h, steps, limit)
        evaluations += piece.evaluations
        in_vain = in_vain + 1 if len(piece.states) == 1 and piece.change > 0.5 else 0
        # A step too long once, for its error or because it is not stable, is not tried again for a while.
        if piece.change < 1:
            longest = 1.2 * piece.change * h
        elif len(piece.states) > _PIECE:
            longest = min(1.5 * longest, segment.longest)
        if len(piece.states) > 1:
            reached = t + (len(piece.states) - 1) * h
            until = int(np.searchsorted(t_eval, reached, side="right")) if reached < right else len(t_eval)
            states[done:until] = piece.read(t_eval[done:until])
            end = piece.read(np.array([right]))[0] if reached >= right else end
            done, t, y = until, reached, piece.states[-1]
        h = min(h * min(piece.change, 2.0), longest)
        share = (t - segment.left) / (right - segment.left)
        spent = evaluations > min(segment.budget, _PATIENCE + share * segment.budget)
        if t < right and (spent or in_vain == _IN_VAIN or t + h == t):
            reason = f"{evaluations} evaluations spent" if spent else f"steps of {h:.1e} leave as much as longer ones"
            reached = Stretch(states_on_constraints(segment.project, states[:done]), y, evaluations)
            raise StopError(t, reason, reached, cause="budget" if spent else "stopped")
    if not (np.isfinite(end).all() and np.isfinite(states).all()):
        raise StopError(t, "a value is not finite", evaluations=evaluations)
    end = segment.project(end) if segment.project else end
    return Stretch(states_on_constraints(segment.project, states), end, evaluations)
