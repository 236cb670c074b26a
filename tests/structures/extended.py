"""An oracle for any structure that shares nothing with the package: Lagrange's equations with multipliers in 80-bit numbers,
extrapolated midpoint steps (Gragg, Bulirsch and Stoer), the constraints held by Baumgarte's terms.

No axis may leave its unit length, no bar its own; the drift of both is part of the reference's own uncertainty.
"""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor import Structure

X = np.longdouble
Extended = NDArray[np.longdouble]
_SEQUENCE = (2, 4, 6, 8, 10, 12, 14, 16, 18)
_HOLD = X(1)  # 1/s over the structure's rate, of Baumgarte's terms
_LOCAL = 1e-18


def right_hand_side(s: Structure) -> Callable[[Extended], Extended]:
    """y' of y = (r, r') (6 N,), in s."""
    N, B = len(s.joints), len(s.bars)
    R, m = np.array([r.length for r in s.rotor], X), np.array([r.mass for r in s.rotor], X)
    I1, I3 = (np.array([getattr(r, name) for r in s.rotor], X) for name in ("I1", "I3"))
    load, G = np.array(s.load, X), I3 * np.array(s.spins, X)
    own = I1 + m * R**2 / 4 + load * R**2
    moment = m * R / 2 + load * R
    mass = np.zeros((N, N), X)
    for k, (i, j, ell) in enumerate(s.bars):
        bar, twist = X(s.link[k].mass), X(s.link[k].inertia) / X(ell) ** 2
        for a, b, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
            mass[a, b] += R[a] * R[b] * (bar / 4 + sign * twist)
        moment[[i, j]] += bar * R[[i, j]] / 2
    mass[np.arange(N), np.arange(N)] += own
    feet = np.array([(*joint, 0.0) for joint in s.joints], X)
    friction, g, hold = np.array(s.friction, X), X(s.gravity), _HOLD * max(np.abs(G / own).max(), X(1))

    def rhs(y: Extended) -> Extended:
        r, v = y[: 3 * N].reshape(N, 3), y[3 * N :].reshape(N, 3)
        force = G[:, None] * np.cross(r, v) - friction[:, None] * v
        force[:, 2] -= g * moment
        A = np.zeros((4 * N + B, 4 * N + B), X)
        b = np.zeros(4 * N + B, X)
        for k in range(3):
            A[k : 3 * N : 3, k : 3 * N : 3] = mass
        b[: 3 * N] = force.ravel()
        rows = [(i, r[i], None, None, (r[i] @ r[i] - 1) / 2, r[i] @ v[i], v[i] @ v[i]) for i in range(N)]
        for i, j, ell in s.bars:
            d, w = feet[j] - feet[i] + R[j] * r[j] - R[i] * r[i], R[j] * v[j] - R[i] * v[i]
            rows.append((i, -R[i] * d, j, R[j] * d, (d @ d - X(ell) ** 2) / 2, d @ w, w @ w))
        for n, (i, first, j, second, off, rate, bent) in enumerate(rows):
            A[3 * N + n, 3 * i : 3 * i + 3] = A[3 * i : 3 * i + 3, 3 * N + n] = first
            if j is not None:
                A[3 * N + n, 3 * j : 3 * j + 3] = A[3 * j : 3 * j + 3, 3 * N + n] = second
            b[3 * N + n] = -bent - 2 * hold * rate - hold**2 * off
        return np.concatenate([y[3 * N :], _solved(A, b)[: 3 * N]])

    return rhs


def _solved(A: Extended, b: Extended) -> Extended:
    """Gauss elimination with pivoting."""
    A, b, n = A.copy(), b.copy(), len(b)
    for j in range(n):
        p = j + int(np.argmax(np.abs(A[j:, j])))
        A[[j, p]], b[[j, p]] = A[[p, j]], b[[p, j]]
        below = np.flatnonzero(A[j + 1 :, j]) + j + 1
        share = A[below, j] / A[j, j]
        A[below, j:] -= share[:, None] * A[j, j:]
        b[below] -= share * b[j]
    for j in reversed(range(n)):
        b[j] = (b[j] - A[j, j + 1 :] @ b[j + 1 :]) / A[j, j]
    return b


def exact(s: Structure, axes: Any, rates: Any, times: Any) -> tuple[Extended, float]:
    """Axes (N, n, 3) at the times (n,), the first the start's, and how far the constraints have drifted."""
    N, rhs = len(s.joints), right_hand_side(s)
    y = np.concatenate([np.asarray(axes, X).ravel(), np.asarray(rates, X).ravel()])
    states, H = [y], (X(times[-1]) - X(times[0])) / 8
    for left, right in pairwise(times):
        t = X(left)
        while t < right:
            step = min(H, X(right) - t)
            with np.errstate(all="ignore"):
                new, off = _extrapolated(rhs, y, step)
            if off < _LOCAL:
                y, t, H = new, (X(right) if step < H else t + step), H * X(1.25)
            else:
                H = step / 2
        states.append(y)
    seen = np.array(states)[:, : 3 * N].reshape(-1, N, 3).swapaxes(0, 1)
    return seen, float(np.abs((seen**2).sum(-1) - 1).max())


def _extrapolated(rhs: Callable[[Extended], Extended], y: Extended, H: Any) -> tuple[Extended, float]:
    """The state after a step H, and how far the last two of the highest order are apart, relative to it."""
    first, table = rhs(y), list[Extended]()
    for k, n in enumerate(_SEQUENCE):
        h = H / n
        before, now = y, y + h * first
        for _ in range(n - 1):
            before, now = now, before + 2 * h * rhs(now)
        new = (before + now + h * rhs(now)) / 2  # Gragg's smoothing: even powers of h alone
        row = [new]
        for j in range(1, k + 1):
            ratio = (X(n) / X(_SEQUENCE[k - j])) ** 2
            row.append(row[j - 1] + (row[j - 1] - table[j - 1]) / (ratio - 1))
        table = row
    return table[-1], float((np.abs(table[-1] - table[-2]) / (1 + np.abs(y))).max())
