"""The solvers behind `integrate`: each takes a stretch without an edge and a local error, and gives the states asked for.

All raise StopError when they cannot go on or crawl.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..errors import IntegrationError

Array = NDArray[np.float64]
Rate = Callable[[float, Array], list[float]]
Projection = Callable[[Array], Array]

LOST = ValueError, ZeroDivisionError, OverflowError  # what a rate in Python meets outside its coordinates' reach
_BLOCK = 100
_A_CUT = 5_000  # evaluations between two projections, beyond which something else than the motion is followed
_DRIFT = 200.0  # local errors that the constraints may gather between projections: what the run as a whole is asked for
_SWEEPS = 25


@dataclass(frozen=True)
class Stretch:
    """y' = rate(s, y) from `start` at `left` to `right`, to be read at `asked`; no step over `longest`.

    `project` brings a state (d,), or states (d, n), back onto constraints; `allowance`: evaluations before it crawls.
    """

    rate: Rate
    start: Array
    left: float
    right: float
    asked: Array
    longest: float = np.inf
    allowance: float = np.inf
    project: Projection | None = None

    @property
    def pace(self) -> float:
        """A rate of change (1/s) of the state at the start."""
        return float(np.abs(self.rate(self.left, self.start)).max() / (1 + np.abs(self.start).max()))


@dataclass(frozen=True)
class Run:
    """States (n, d) at the asked times, the state at the end, and evaluations spent."""

    states: Array
    end: Array
    evaluations: int


Engine = Callable[[Stretch, float], Run]


class StopError(IntegrationError):
    """A solver that stopped at `at`, in the stretch's own time."""

    def __init__(self, at: float, reason: str) -> None:
        super().__init__(reason)
        self.at, self.reason = at, reason


def lsoda(stretch: Stretch, error: float) -> Run:
    """Adams and BDF methods of variable order (Petzold 1983) in scipy's compiled loop: only the rate is Python.

    The first step is given, not found from the first output, so outputs do not change the run. Where there are
    constraints the run is cut about once a turn and projected: the drift feeds on itself where the axes are pressed.
    """
    if stretch.project is None:
        return _lsoda(stretch, error)
    found, spent, left, y, longest_cut = [], 0, stretch.left, stretch.start, np.inf
    while left < stretch.right:
        cut = min(5 / (replace(stretch, left=left, start=y).pace + 1e-300), longest_cut)
        right = left + cut if left + 1.5 * cut < stretch.right else stretch.right
        inside = (stretch.asked > left) & (stretch.asked <= right)
        # A state with constraints moves no more than a tenth in a step, so that none leaps over where they fail.
        part = replace(
            stretch,
            start=y,
            left=left,
            right=right,
            asked=stretch.asked[inside],
            longest=min(stretch.longest, cut / 50),
        )
        try:
            run = _lsoda(replace(part, allowance=min(stretch.allowance - spent, _A_CUT)), error)
            end, spent = stretch.project(run.end), spent + run.evaluations + 1
            drifted = np.abs(end - run.end).max() / (1 + np.abs(end).max())
        except StopError:
            if cut < longest_cut / 2 or spent + _A_CUT > stretch.allowance:
                raise
            drifted, spent = np.inf, spent + _A_CUT
        if not drifted <= _DRIFT * error:  # what has grown so far would not be brought back to where it left
            longest_cut = cut / 8
            if longest_cut < 1e-6 * (stretch.right - stretch.left):
                raise StopError(left, "the constraints drift faster than they can be kept")
            continue
        found.append(run.states)
        y, left = end, right
    states = stretch.project(np.concatenate(found).T).T
    if not np.isfinite(states).all():
        raise StopError(stretch.left, "a state could not be brought back onto its constraints")
    return Run(states, y, spent)


def _lsoda(stretch: Stretch, error: float) -> Run:
    from scipy.integrate import odeint

    left, right, lost = stretch.left, stretch.right, False

    def watched(s: float, y: Array) -> list[float]:
        # LSODA takes a rate of NaN for a number and may step over where it came from; DOP853 then has to try.
        nonlocal lost
        rates = stretch.rate(s, y)
        lost = lost or rates[0] != rates[0]
        return rates

    first = min(np.sqrt(error) / (1 + np.abs(stretch.rate(left, stretch.start)).max()), stretch.longest, right - left)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            states, log = odeint(
                getattr(stretch.rate, "bare", watched),
                stretch.start,
                np.concatenate([[left], stretch.asked, [right]]),
                tfirst=True,
                rtol=error,
                atol=error,
                full_output=True,
                h0=first,
                hmax=0.0 if np.isinf(stretch.longest) else stretch.longest,
                mxstep=int(min(stretch.allowance, 2**30)) + 1,
            )
    except LOST:
        raise StopError(left, "a rate was not finite") from None
    spent = int(log["nfe"][-1]) + 1
    if lost or log["message"] != "Integration successful." or not np.isfinite(states).all():
        raise StopError(left, "a rate was not finite" if lost else log["message"])
    if spent > stretch.allowance:
        raise StopError(right, f"{spent} evaluations spent")
    return Run(states[1:-1], states[-1], spent)


def dop853(stretch: Stretch, error: float) -> Run:
    """DOP853 (Hairer, Nørsett & Wanner, II.5), step by step: slow in Python, but it says where it stops."""
    from scipy.integrate import DOP853

    asked, project = stretch.asked, stretch.project
    solver = DOP853(
        stretch.rate,
        stretch.left,
        stretch.start,
        stretch.right,
        rtol=max(error, 2.3e-14),
        atol=error,
        max_step=stretch.longest,
    )
    found, done = np.empty((len(asked), len(stretch.start))), 0
    while solver.status == "running":
        if project is not None:  # no step over where the constraints fail
            solver.max_step = min(
                stretch.longest, 0.1 * (1 + np.abs(solver.y).max()) / (np.abs(solver.f).max() + 1e-300)
            )
        message = solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            raise StopError(solver.t, message or "a value is not finite")
        if solver.nfev > stretch.allowance:
            raise StopError(solver.t, f"{solver.nfev} evaluations spent")
        reached = int(np.searchsorted(asked, solver.t, side="right"))
        if reached > done:
            found[done:reached] = solver.dense_output()(asked[done:reached]).T
            done = reached
        if project is not None:
            solver.y = project(solver.y)
            solver.f = np.asarray(stretch.rate(solver.t, solver.y))
            solver.nfev += 1
    return Run(project(found.T).T if project else found, solver.y, solver.nfev)


def adams_order(error: float) -> int:
    """Of the pair, for a local error: the higher, the fewer steps accuracy needs, and the shorter those that are stable."""
    return 10 if error >= 1e-10 else 12


@lru_cache(maxsize=8)
def adams_weights(q: int) -> tuple[Array, Array, Array]:
    """What an Adams pair of q rates needs, from the Lagrange polynomials l_j of q equal steps, exact before rounding.

    A (q,): integrals from the last node to the one after it (Adams–Bashforth); B (q,): from the last but one to the last
    (Adams–Moulton); P (q, q + 1): the integral of l_j from the middle node q // 2 as a polynomial in steps from there.
    """
    from sympy import QQ, Poly, Rational, Symbol

    x, middle, last = Symbol("x"), q // 2, q - 1 - q // 2
    nodes = [i - middle for i in range(q)]
    rows = []
    for j in nodes:
        lagrange = Poly(1, x, domain=QQ)
        for i in nodes:
            if i != j:
                lagrange *= Poly(Rational(1, j - i) * (x - i), x, domain=QQ)
        rows.append(lagrange.integrate(x))
    A = [float(row.eval(last + 1) - row.eval(last)) for row in rows]
    B = [float(row.eval(last) - row.eval(last - 1)) for row in rows]
    P = [[float(row.nth(power)) for power in range(q + 1)] for row in rows]
    return np.array(A), np.array(B), np.array(P)


@dataclass(frozen=True)
class _Piece:
    """Equal steps h from t by the pair of order q: states and rates (n + 1, d) at the nodes, what was spent, and by how
    much h is to change."""

    q: int
    t: float
    h: float
    states: Array
    rates: Array
    spent: int
    change: float

    def read(self, times: Array) -> Array:
        """States (m, d) at times within the piece, by the polynomial of the pair itself."""
        q = self.q
        _, _, P = adams_weights(q)
        steps = (times - self.t) / self.h
        middle = np.clip(np.floor(steps).astype(int), q // 2, len(self.states) - q + q // 2)
        weights = np.vander(steps - middle, q + 1, increasing=True) @ P.T
        window = self.rates[middle[:, None] + np.arange(q) - q // 2]
        return self.states[middle] + self.h * np.einsum("mj,mjd->md", weights, window)


def _piece(stretch: Stretch, q: int, y: Array, t: float, h: float, steps: int, limit: float) -> _Piece:
    """Steps of h until `steps` are made, or h is found too long (change < 1) or needlessly short (change > 1).

    Predict, evaluate, correct, evaluate; predictor less corrector, over h, is held under `limit` (Hairer, Nørsett &
    Wanner, III.1). The first q nodes come together: their integral equation is swept until nothing moves.
    """
    rate = stretch.rate
    A, B, P = adams_weights(q)
    from_middle = np.vander(np.arange(q) - q // 2, q + 1, increasing=True) @ P.T
    S = h * (from_middle - from_middle[0])
    states, rates, off = np.empty((steps + 1, len(y))), np.empty((steps + 1, len(y))), np.zeros((steps + 1, len(y)))
    states[:q], rates[:q] = y, rate(t, y)
    spent = 1
    for sweep in range(_SWEEPS):
        before = states[:q].copy()
        states[:q] = y + S @ rates[:q]
        for i in range(1, q):
            rates[i] = rate(t + i * h, states[i])
        spent += q - 1
        moved = np.abs(states[:q] - before).max()
        if sweep and not moved > 2e-15 * (1 + np.abs(y).max()):
            break
    if not moved < 1e-13 * (1 + np.abs(y).max()):
        return _Piece(q, t, h, states[:1], rates[:1], spent, 0.5)

    hA, hB, last, n = h * A, h * B, states[q - 1], q
    while n <= steps:
        block = range(n, min(n + (_BLOCK if n > q else 2 * q), steps + 1))
        for n in block:
            predicted = last + hA.dot(rates[n - q : n])
            rates[n] = rate(t + n * h, predicted)
            states[n] = last = last + hB.dot(rates[n - q + 1 : n + 1])
            off[n] = last - predicted
            rates[n] = rate(t + n * h, last)
        spent += 2 * len(block)
        worst = np.abs(off[block.start : n + 1]).max() / (h * (1 + np.abs(last).max())) + 1e-300
        change = min(max(0.3, (limit / worst / 4) ** (1 / q)), 3.0) if np.isfinite(worst) else 0.3
        if not worst <= limit:
            kept = block.start if block.start > q else 1
            return _Piece(q, t, h, states[:kept], rates[:kept], spent, change)
        if stretch.project is not None:
            states[n] = last = stretch.project(last)
        n += 1
        if worst < limit / 300 and n <= steps and 1.3 * h < stretch.longest:
            return _Piece(q, t, h, states[:n], rates[:n], spent, change)
    return _Piece(q, t, h, states, rates, spent, 1.0)


def adams(stretch: Stretch, error: float) -> Run:
    """Adams predictor and corrector in equal steps, changed where the pair's own difference asks for it."""
    asked, right, y, t = stretch.asked, stretch.right, stretch.start, stretch.left
    q, limit = adams_order(error), min(100 * error, 1e-3)  # of order 10, steps that leave more are not stable
    h = min((right - t) / q, stretch.longest, min(limit ** (1 / q) / 5, 0.05) / (stretch.pace + 1e-300))
    found, done, spent, end = np.empty((len(asked), len(y))), 0, 1, y
    while t < right:
        steps = min(max(int(np.ceil((right - t) / h)), q), 10_000)
        with np.errstate(all="ignore"):  # a step that is too long overflows, and is shortened
            piece = _piece(stretch, q, y, t, h, steps, limit)
        spent += piece.spent
        if piece.change < 1:  # too long once, for its error or because it is not stable: not tried again
            stretch = replace(stretch, longest=1.2 * piece.change * h)
        if spent > stretch.allowance:
            raise StopError(t, f"{spent} evaluations spent")
        if len(piece.states) > 1:
            reached = t + (len(piece.states) - 1) * h
            until = int(np.searchsorted(asked, reached, side="right")) if reached < right else len(asked)
            found[done:until] = piece.read(asked[done:until])
            end = piece.read(np.array([right]))[0] if reached >= right else end
            done, t, y = until, reached, piece.states[-1]
        h = min(h * min(piece.change, 2.0), stretch.longest)
        if t + h == t:
            raise StopError(t, "the step vanishes")
    if not (np.isfinite(end).all() and np.isfinite(found).all()):
        raise StopError(t, "a value is not finite")
    if stretch.project is not None:
        return Run(stretch.project(found.T).T, stretch.project(end), spent)
    return Run(found, end, spent)
