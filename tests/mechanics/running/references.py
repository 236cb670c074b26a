"""Random systems with motions that are known to 60 bits: by mpmath, and an extrapolated integration in 64 bits.

Nothing here is made by the package's solvers: the integrator is Gragg's method with Richardson's extrapolation (Hairer, Nørsett &
Wanner, II.9), the equations are written by hand.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from lagrotor.mechanics import Frame, System, coordinates, t

Long = np.longdouble
EXTENDED = np.finfo(Long).nmant >= 63
_COLUMNS = 9  # of the extrapolation: order 18


@dataclass(frozen=True)
class Drawn:
    """A system with a start, times, a tolerance, and its exact states (n, 2 N) there. period: of coordinates that are angles."""

    name: str
    system: System
    values: dict[Any, float]
    q: tuple[float, ...]
    v: tuple[float, ...]
    t: np.ndarray
    tol: float
    exact: Callable[[], np.ndarray]
    compared: tuple[int, ...] = field(default=())


def extrapolated(
    rhs: Callable[[Any, np.ndarray], np.ndarray], y0: Any, times: np.ndarray, local: float = 1e-17
) -> np.ndarray:
    """States at the times in 64 bits, by steps of order 18 whose last two columns agree to `local`."""
    y, now = np.array(y0, Long), Long(times[0])
    rows, h = [y], Long((times[-1] - times[0]) / 50)
    for until in times[1:]:
        while now < until:
            h = min(h, Long(until) - now)
            following, error = _step(rhs, now, y, h)
            assert h > 1e-14 * (times[-1] - times[0]), "the reference does not come to its last time"
            if error <= 1:
                now, y = now + h, following
                if Long(until) - now < Long(1e-15) * abs(Long(until)):
                    now = Long(until)
            h = h * Long(min(2.0, max(0.2, 0.8 * float(max(error, 1e-30)) ** (-1 / (2 * _COLUMNS - 1)))))
        rows.append(y)
    return np.array(rows, float)


def _step(rhs: Any, now: Any, y: np.ndarray, h: Any) -> tuple[np.ndarray, float]:
    table: list[list[np.ndarray]] = []
    first = rhs(now, y)
    for k in range(_COLUMNS):
        m = 2 * (k + 1)
        s = h / m
        before, here = y, y + s * first
        for j in range(1, m):
            before, here = here, before + 2 * s * rhs(now + j * s, here)
        row = [(here + before + s * rhs(now + h, here)) / 2]
        for j in range(k):
            ratio = (Long(k + 1) / Long(k - j)) ** 2
            row.append(row[j] + (row[j] - table[-1][j]) / (ratio - 1))
        table.append(row)
    size = 1e-17 * (np.abs(y).max() + np.abs(h * first).max())
    scale = 2e-18 * np.abs(y) + size
    return table[-1][-1], float((np.abs(table[-1][-1] - table[-1][-2]) / scale).max()) / 4


def solved(A: list[list[Any]], b: list[Any]) -> list[Any]:
    """A x = b in whatever precision the numbers have."""
    n = len(b)
    M = [[*row, x] for row, x in zip(A, b, strict=True)]
    for i in range(n):
        p = max(range(i, n), key=lambda k: abs(M[k][i]))
        M[i], M[p] = M[p], M[i]
        for k in range(i + 1, n):
            f = M[k][i] / M[i][i]
            for j in range(i, n + 1):
                M[k][j] = M[k][j] - f * M[i][j]
    x = [Long(0)] * n
    for i in reversed(range(n)):
        x[i] = (M[i][n] - sum((M[i][j] * x[j] for j in range(i + 1, n)), Long(0))) / M[i][i]
    return x


def _times(rng: np.random.Generator, duration: float, begin: float = 0.0) -> np.ndarray:
    """Samples at random, few or many."""
    n = int(rng.integers(2, 40))
    inner = np.sort(rng.uniform(begin, begin + duration, n - 2)) if n > 2 else []
    return np.unique(np.concatenate([[begin], inner, [begin + duration]]))


def _tol(rng: np.random.Generator) -> float:
    return float(10 ** rng.uniform(-11, -3))


def pendulum(rng: np.random.Generator) -> Drawn:
    """From rest at any height, for up to a thousand seconds."""
    c = coordinates("theta")
    rate, top = float(10 ** rng.uniform(-1, 1)), float(rng.uniform(0.01, 3.1))
    L = c.v[0] ** 2 / 2 + rate**2 * sp.cos(c.q[0])
    times = _times(rng, float(10 ** rng.uniform(0, 3)))

    def exact() -> np.ndarray:
        with mpmath.workprec(90):
            k = mpmath.sin(mpmath.mpf(top) / 2)
            K, rows = mpmath.ellipk(k**2), []
            for s in times:
                u = K - mpmath.mpf(rate) * mpmath.mpf(float(s))
                sn, cn = mpmath.ellipfun("sn", u, m=k**2), mpmath.ellipfun("cn", u, m=k**2)
                rows.append((float(2 * mpmath.asin(k * sn)), float(-2 * mpmath.mpf(rate) * k * cn)))
        return np.array(rows)

    return Drawn("pendulum", System(c, L), {}, (top,), (0.0,), times, _tol(rng), exact)


def kepler(rng: np.random.Generator) -> Drawn:
    """An ellipse of eccentricity up to 1 − 2e-5 in x and y, in any unit of length."""
    c = coordinates("x y")
    e, a = 1 - float(10 ** rng.uniform(np.log10(2e-5), 0)), float(10 ** rng.uniform(-4, 4))
    mu = a**3  # of mean motion one
    x, y = c.q
    L = (c.v[0] ** 2 + c.v[1] ** 2) / 2 + sp.Symbol("mu") / sp.sqrt(x**2 + y**2)
    u0 = float(rng.uniform(0.3, 6.0)) if rng.random() < 0.7 else float(np.pi)
    times = _times(rng, float(rng.uniform(1, 15)))

    def place(u: Any) -> list[Any]:
        E, b, r = mpmath.mpf(e), mpmath.sqrt(1 - mpmath.mpf(e) ** 2), 1 - mpmath.mpf(e) * mpmath.cos(u)
        A = mpmath.mpf(a)
        return [A * (mpmath.cos(u) - E), A * b * mpmath.sin(u), -A * mpmath.sin(u) / r, A * b * mpmath.cos(u) / r]

    with mpmath.workprec(120):
        start = [float(z) for z in place(mpmath.mpf(u0))]

    def exact() -> np.ndarray:
        """From the start as it is rounded: its own elements, by universal formulas of the two-body problem."""
        with mpmath.workprec(150):
            x0, y0, vx, vy = map(mpmath.mpf, start)
            m, r0 = mpmath.mpf(mu), mpmath.sqrt(x0**2 + y0**2)
            A = 1 / (2 / r0 - (vx**2 + vy**2) / m)
            n, s0 = mpmath.sqrt(m / A**3), (x0 * vx + y0 * vy) / mpmath.sqrt(m * A)
            c0, rows = 1 - r0 / A, []
            for time in times:
                M = n * mpmath.mpf(float(time))
                d = _kepler_difference(M, c0, s0)
                f = 1 - A / r0 * (1 - mpmath.cos(d))
                g = mpmath.mpf(float(time)) - (d - mpmath.sin(d)) / n
                r = A * (1 - c0 * mpmath.cos(d) + s0 * mpmath.sin(d))
                fd, gd = -mpmath.sqrt(m * A) / (r * r0) * mpmath.sin(d), 1 - A / r * (1 - mpmath.cos(d))
                rows.append([f * x0 + g * vx, f * y0 + g * vy, fd * x0 + gd * vx, fd * y0 + gd * vy])
        return np.array(rows, float)

    return Drawn(
        "kepler", System(c, L), {"mu": mu}, (start[0], start[1]), (start[2], start[3]), times, _tol(rng), exact
    )


def _kepler_difference(M: Any, c0: Any, s0: Any) -> Any:
    """d − c0 sin d + s0 (1 − cos d) = M, a growing function of d: by bisection, then Newton's method."""

    def f(d: Any) -> Any:
        return d - c0 * mpmath.sin(d) + s0 * (1 - mpmath.cos(d)) - M

    low, high = M - 3, M + 3
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if f(middle) < 0 else (low, middle)
    d = (low + high) / 2
    for _ in range(8):
        d = d - f(d) / (1 - c0 * mpmath.cos(d) + s0 * mpmath.sin(d))
    return d


def springs(rng: np.random.Generator) -> Drawn:
    """Masses on springs in a row between walls, stiffnesses apart by up to 1e6: an eigenvalue problem."""
    n = int(rng.integers(1, 5))
    c = coordinates([f"x_{i}" for i in range(n)])
    masses = 10 ** rng.uniform(-1, 1, n)
    k = 10 ** rng.uniform(-1, float(rng.choice([1, 3, 5])), n + 1)
    places = (sp.S.Zero, *c.q, sp.S.Zero)
    V = sum(sp.Float(float(k[i]), 30) * (places[i + 1] - places[i]) ** 2 / 2 for i in range(n + 1))
    L = sum(sp.Float(float(m), 30) * v**2 / 2 for m, v in zip(masses, c.v, strict=True)) - V
    size = float(10 ** rng.uniform(-3, 3))
    q, v = size * rng.normal(size=n), size * rng.normal(size=n)
    times = _times(rng, float(10 ** rng.uniform(0, 1.7)))

    def exact() -> np.ndarray:
        with mpmath.workprec(110):
            root = [mpmath.sqrt(mpmath.mpf(float(m))) for m in masses]
            K = mpmath.zeros(n, n)
            for i in range(n):
                K[i, i] = mpmath.mpf(float(k[i])) + mpmath.mpf(float(k[i + 1]))
                if i:
                    K[i, i - 1] = K[i - 1, i] = -mpmath.mpf(float(k[i]))
            scaled = mpmath.matrix(n, n)
            for i in range(n):
                for j in range(n):
                    scaled[i, j] = K[i, j] / root[i] / root[j]
            squares, Q = mpmath.eigsy(scaled)
            a = Q.T * mpmath.matrix([root[i] * mpmath.mpf(float(q[i])) for i in range(n)])
            b = Q.T * mpmath.matrix([root[i] * mpmath.mpf(float(v[i])) for i in range(n)])
            rows = []
            for s in times:
                w = [mpmath.sqrt(x) for x in squares]
                angle = [x * mpmath.mpf(float(s)) for x in w]
                z = Q * mpmath.matrix(
                    [a[i] * mpmath.cos(angle[i]) + b[i] / w[i] * mpmath.sin(angle[i]) for i in range(n)]
                )
                u = Q * mpmath.matrix(
                    [b[i] * mpmath.cos(angle[i]) - a[i] * w[i] * mpmath.sin(angle[i]) for i in range(n)]
                )
                rows.append([float(z[i] / root[i]) for i in range(n)] + [float(u[i] / root[i]) for i in range(n)])
        return np.array(rows)

    return Drawn("springs", System(c, L), {}, tuple(q), tuple(v), times, _tol(rng), exact)


def driven(rng: np.random.Generator) -> Drawn:
    """A damped oscillator under a harmonic force, from a time that may be far from zero."""
    c = coordinates("x")
    w, gamma, A, W = (float(x) for x in 10 ** rng.uniform([-0.5, -2.5, -1, -1], [1, 0, 1, 1]))
    x, v, begin = float(rng.normal()), float(rng.normal()), float(rng.choice([0, 10 ** rng.uniform(0, 4)]))
    L = c.v[0] ** 2 / 2 - w**2 * c.q[0] ** 2 / 2
    system = System(c, L, dissipation=gamma * c.v[0] ** 2, forces=(A * sp.cos(W * t),))
    times = _times(rng, float(10 ** rng.uniform(0, 1.7)), begin)

    def rhs(s: Any, y: np.ndarray) -> np.ndarray:
        return np.array([y[1], Long(A) * np.cos(Long(W) * s) - 2 * Long(gamma) * y[1] - Long(w) ** 2 * y[0]], Long)

    return Drawn("driven", system, {}, (x,), (v,), times, _tol(rng),
                 lambda: extrapolated(rhs, [x, v], times))  # fmt: skip


def pendulums(m: Any, l: Any) -> Callable[[Any, np.ndarray], np.ndarray]:
    """Pendulums on each other in absolute angles: their rates, in 64 bits."""
    n, lengths = len(m), np.array(l, Long)
    above = np.array([np.array(m[i:], Long).sum() for i in range(n)], Long)

    def rhs(_: Any, y: np.ndarray) -> np.ndarray:
        a, w = y[:n], y[n:]
        M = [[above[max(i, j)] * lengths[i] * lengths[j] * np.cos(a[i] - a[j]) for j in range(n)] for i in range(n)]
        b = [
            -sum(above[max(i, j)] * lengths[i] * lengths[j] * np.sin(a[i] - a[j]) * w[j] ** 2 for j in range(n))
            - above[i] * Long(9.81) * lengths[i] * np.sin(a[i])
            for i in range(n)
        ]
        return np.concatenate([w, np.array(solved(M, b), Long)])

    return rhs


def chain(rng: np.random.Generator) -> Drawn:
    """Two or three pendulums on each other, in absolute angles, from frames."""
    n = int(rng.integers(2, 4))
    c = coordinates([f"a_{i}" for i in range(n)])
    m, l = rng.uniform(0.3, 2, n), rng.uniform(0.3, 1.5, n)
    frame, L, turned = Frame(c), sp.S.Zero, sp.S.Zero
    for i, q in enumerate(c.q):
        frame = frame.turned("y", q - turned)
        bob, frame = (
            frame.body(sp.Float(float(m[i]), 30), centre=(0, 0, -sp.Float(float(l[i]), 30))),
            frame.moved(0, 0, -sp.Float(float(l[i]), 30)),
        )
        L, turned = L + bob.kinetic - bob.potential((0, 0, -sp.Float(9.81, 30))), q
    wide = rng.choice([0.05, 0.5, 2.0])
    q, v = wide * rng.normal(size=n), wide * rng.normal(size=n)
    times = _times(rng, float(10 ** rng.uniform(-0.3, 1.2)))
    return Drawn(f"chain of {n}", System(c, L), {}, tuple(q), tuple(v), times, _tol(rng),
                 lambda: extrapolated(pendulums(m, l), [*q, *v], times))  # fmt: skip


def top(rng: np.random.Generator) -> Drawn:
    """A heavy symmetric top in Euler's angles, fast or slow."""
    c = coordinates("phi theta psi")
    A, C, P = float(rng.uniform(0.2, 1)), float(rng.uniform(0.05, 1)), float(rng.uniform(0.1, 3))
    _, theta, _ = c.q
    p_v, t_v, s_v = c.v
    A_, C_, P_ = (sp.Float(x, 30) for x in (A, C, P))
    L = (A_ * (t_v**2 + p_v**2 * sp.sin(theta) ** 2) + C_ * (s_v + p_v * sp.cos(theta)) ** 2) / 2 - P_ * sp.cos(theta)
    q = (float(rng.uniform(-3, 3)), float(rng.uniform(0.3, 2.8)), float(rng.uniform(-3, 3)))
    v = (float(rng.normal()), float(rng.normal()), float(rng.normal() * rng.choice([1, 30])))

    def rhs(_: Any, y: np.ndarray) -> np.ndarray:
        S, K, (p, w, s) = np.sin(y[1]), np.cos(y[1]), y[3:]
        spin = s + p * K
        first = (Long(C) * spin - 2 * Long(A) * p * K) * w / (Long(A) * S)
        second = (Long(A) * p**2 * K - Long(C) * spin * p + Long(P)) * S / Long(A)
        return np.concatenate([y[3:], [first, second, -first * K + p * w * S]])

    times = _times(rng, float(10 ** rng.uniform(-0.5, 1.2)))
    return Drawn("top", System(c, L), {}, q, v, times, _tol(rng),
                 lambda: extrapolated(rhs, [*q, *v], times))  # fmt: skip


def rods(rng: np.random.Generator) -> Drawn:
    """A double pendulum of points x, y under two constraints; the reference in angles."""
    c = coordinates("x_1 y_1 x_2 y_2")
    x1, y1, x2, y2 = c.q
    m = [float(x) for x in rng.uniform(0.3, 2, 2)]
    l = [float(x) for x in rng.uniform(0.3, 1.5, 2)]
    m_, l_ = ([sp.Float(x, 30) for x in given] for given in (m, l))
    T = m_[0] * (c.v[0] ** 2 + c.v[1] ** 2) / 2 + m_[1] * (c.v[2] ** 2 + c.v[3] ** 2) / 2
    L = T - sp.Float(9.81, 30) * (m_[0] * y1 + m_[1] * y2)
    held = (x1**2 + y1**2 - l_[0] ** 2, (x2 - x1) ** 2 + (y2 - y1) ** 2 - l_[1] ** 2)
    wide = rng.choice([0.3, 1.5])
    a, w = wide * rng.normal(size=2), wide * rng.normal(size=2)
    times = _times(rng, float(rng.uniform(0.3, 4)))

    def placed(y: np.ndarray) -> np.ndarray:
        b, u = y[:2], y[2:]
        steps = [np.array([l[i] * np.sin(b[i]), -l[i] * np.cos(b[i])]) for i in (0, 1)]
        speeds = [u[i] * np.array([l[i] * np.cos(b[i]), l[i] * np.sin(b[i])]) for i in (0, 1)]
        return np.concatenate([steps[0], steps[0] + steps[1], speeds[0], speeds[0] + speeds[1]])

    start = placed(np.concatenate([a, w]))
    return Drawn("rods", System(c, L, held), {}, tuple(start[:4]), tuple(start[4:]), times, _tol(rng),
                 lambda: np.array([placed(y) for y in extrapolated(pendulums(m, l), [*a, *w], times)]))  # fmt: skip


def skate(rng: np.random.Generator) -> Drawn:
    """A skate on a slope (rolling constraint): it turns at a constant rate w."""
    c = coordinates("x y phi")
    A, w, u, f = float(rng.uniform(0.2, 3)), float(rng.uniform(0.3, 4)), float(rng.normal()), float(rng.uniform(-3, 3))
    L = (c.v[0] ** 2 + c.v[1] ** 2) / 2 + c.v[2] ** 2 / 20 + sp.Float(A, 30) * c.q[0]
    system = System(c, L, rolling=(c.v[0] * sp.sin(c.q[2]) - c.v[1] * sp.cos(c.q[2]),))
    times = _times(rng, float(10 ** rng.uniform(0, 1.3)))

    def rhs(_: Any, y: np.ndarray) -> np.ndarray:
        """Of the place, the heading, and the speed along it."""
        S, K = np.sin(y[2]), np.cos(y[2])
        return np.array([y[3] * K, y[3] * S, Long(w), Long(A) * K], Long)

    def exact() -> np.ndarray:
        x, y, p, along = extrapolated(rhs, [0, 0, f, u], times).T
        return np.stack([x, y, p, along * np.cos(p), along * np.sin(p), w + 0 * p], 1)

    start = (float(u * np.cos(f)), float(u * np.sin(f)), w)
    return Drawn("skate", system, {}, (0.0, 0.0, f), start, times, _tol(rng), exact)


def relaxing(rng: np.random.Generator) -> Drawn:
    """Van der Pol's oscillator, up to stiffish."""
    c, mu = coordinates("x"), float(10 ** rng.uniform(-1, 1.5))
    force = sp.Float(mu, 30) * (1 - c.q[0] ** 2) * c.v[0]
    y0 = rng.normal(size=2)
    times = _times(rng, float(rng.uniform(1, 12)))

    def rhs(_: Any, y: np.ndarray) -> np.ndarray:
        return np.array([y[1], Long(mu) * (1 - y[0] ** 2) * y[1] - y[0]], Long)

    return Drawn("relaxing", System(c, c.v[0] ** 2 / 2 - c.q[0] ** 2 / 2, forces=(force,)), {}, (y0[0],), (y0[1],), times,
                 _tol(rng), lambda: extrapolated(rhs, y0, times))  # fmt: skip


def henon_heiles(rng: np.random.Generator) -> Drawn:
    """Regular and chaotic, of any energy below the saddles, for up to 150 s."""
    c = coordinates("x y")
    x, y = c.q
    L = (c.v[0] ** 2 + c.v[1] ** 2) / 2 - (x**2 + y**2) / 2 - x**2 * y + y**3 / 3
    y0 = rng.normal(size=4)
    y0 *= np.sqrt(2 * rng.uniform(0.01, 0.08)) / np.linalg.norm(y0)
    times = _times(rng, float(10 ** rng.uniform(0.5, 2.2)))

    def rhs(_: Any, s: np.ndarray) -> np.ndarray:
        return np.array([s[2], s[3], -s[0] - 2 * s[0] * s[1], -s[1] - s[0] ** 2 + s[1] ** 2], Long)

    return Drawn("henon_heiles", System(c, L), {}, tuple(y0[:2]), tuple(y0[2:]), times, _tol(rng),
                 lambda: extrapolated(rhs, y0, times))  # fmt: skip


KINDS = (pendulum, kepler, springs, driven, chain, kepler, top, rods, skate, driven, relaxing, henon_heiles)


def drawn(seed: int) -> Drawn:
    """One of the kinds in turn, its numbers from the seed."""
    return KINDS[seed % len(KINDS)](np.random.default_rng([26, seed]))
