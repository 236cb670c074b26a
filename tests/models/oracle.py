"""An oracle for any scene that shares nothing with the models: sum and difference of the axes, in extended precision.

With s = r_1 + r_2 and d = r_2 − r_1 the kinetic energy is (a + b)/4 |s'|² + (a − b)/4 |d'|², the inertias of swinging
together and apart; the constraints are |s|² + |d|² = 4, s . d = 0, |d|² + 2 k d_x = 0. Their multipliers are eliminated, the
constraints held by Baumgarte's terms, and the whole integrated by heyoka in 80-bit numbers.
"""

from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor import Scene

Extended = NDArray[np.longdouble]
_EDGE = 7  # widths from its peak at which a pulse is below 80-bit rounding of it


def _dot(p: list[Any], q: list[Any]) -> Any:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def _cross(p: list[Any], q: list[Any]) -> list[Any]:
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


@cache
def _solver(bar: bool, tol: float, X: Any) -> Any:
    """par: 1/(a + b), 1/(a − b), k, G_1, G_2, torques on axis 1 and 2, 1/width. Time from the pulse's peak."""
    import heyoka as hy

    names = [f"{part}_{i}" for part in ("s", "d", "sv", "dv") for i in "xyz"]
    y = hy.make_vars(*names)
    s, d, sv, dv = y[:3], y[3:6], y[6:9], y[9:12]
    p, q, k, G = hy.par[0], hy.par[1], hy.par[2], (hy.par[3], hy.par[4])
    pulse = hy.exp(-((hy.time * hy.par[11]) ** 2))
    r = [[(x - z) * 0.5 for x, z in zip(s, d, strict=True)], [(x + z) * 0.5 for x, z in zip(s, d, strict=True)]]
    v = [[(x - z) * 0.5 for x, z in zip(sv, dv, strict=True)], [(x + z) * 0.5 for x, z in zip(sv, dv, strict=True)]]
    f = [[G[i] * c + hy.par[5 + 3 * i + j] * pulse for j, c in enumerate(_cross(r[i], v[i]))] for i in (0, 1)]
    free_s = [p * (x + z) for x, z in zip(*f, strict=True)]
    free_d = [q * (z - x) for x, z in zip(*f, strict=True)]
    zero = [0.0 * s[0]] * 3
    rows = [(s, d), (d, s)]
    g = [(_dot(s, s) + _dot(d, d) - 4.0) * 0.5, _dot(s, d)]
    gv = [_dot(s, sv) + _dot(d, dv), _dot(s, dv) + _dot(d, sv)]
    gamma = [_dot(sv, sv) + _dot(dv, dv), 2.0 * _dot(sv, dv)]
    if bar:
        e = [d[0] + k, d[1], d[2]]
        rows.append((zero, e))
        g.append((_dot(d, d) + 2.0 * k * d[0]) * 0.5)
        gv.append(_dot(e, dv))
        gamma.append(_dot(dv, dv))
    S = [[p * _dot(m[0], n[0]) + q * _dot(m[1], n[1]) for n in rows] for m in rows]
    right = [
        -(_dot(n[0], free_s) + _dot(n[1], free_d) + c + 2.0 * w + z)
        for n, c, w, z in zip(rows, gamma, gv, g, strict=True)
    ]
    lam = _solve(S, right)
    sa = [free_s[j] + p * sum(x * n[0][j] for x, n in zip(lam, rows, strict=True)) for j in range(3)]
    da = [free_d[j] + q * sum(x * n[1][j] for x, n in zip(lam, rows, strict=True)) for j in range(3)]
    system = list(zip(y, [*sv, *dv, *sa, *da], strict=True))
    return hy.taylor_adaptive(system, [X(0)] * 12, pars=[X(0)] * 12, fp_type=X, tol=X(tol), compact_mode=True)


def _solve(S: list[list[Any]], b: list[Any]) -> list[Any]:
    """Gauss elimination of a symmetric system, written out."""
    S, b, n = [row[:] for row in S], b[:], len(b)
    for j in range(n):
        for i in range(j + 1, n):
            factor = S[i][j] / S[j][j]
            S[i] = [x - factor * z for x, z in zip(S[i], S[j], strict=True)]
            b[i] = b[i] - factor * b[j]
    for j in reversed(range(n)):
        b[j] = (b[j] - sum(S[j][i] * b[i] for i in range(j + 1, n))) / S[j][j]
    return b


def pace(scene: Scene, X: Any = np.longdouble) -> Any:
    """A rate (rad/s) of the scene: spins, start, and what the shock adds."""
    together, apart = _inertias(scene, X)
    G, least = sum(abs(X(G)) for G in scene.momenta), min(together, apart)
    push = X(0)
    if scene.shock:
        torque = np.sqrt(sum(X(f) ** 2 for f in scene.shock.force)) * X(scene.rotor.length)
        push = min(torque * X(scene.shock.width) * 2 / least, np.sqrt(torque / least))
    return G / least + np.linalg.norm(np.array(scene.rates, dtype=float)) + push or X(1)


def _inertias(scene: Scene, X: Any) -> tuple[Any, Any]:
    """a + b and a − b, neither as a difference."""
    rotor, R = scene.rotor, X(scene.rotor.length)
    J = X(rotor.I1) + X(rotor.mass) * R**2 / 4
    if scene.link is None:
        return J, J
    return J + X(scene.link.mass) * R**2 / 2, J + 2 * X(scene.link.inertia) * (R / X(scene.link.length)) ** 2


def exact_axes(
    scene: Scene,
    times: Any,
    tol: float = 1e-19,
    off: Any = None,
    most_steps: int = 3_000_000,
    X: Any = np.longdouble,
) -> Extended:
    """Axes (2, n, 3) at times (n,) in s, started off by `off` (2, 2, 3), axes and rates in units of the scene's rate;
    X: the numbers, of 80 bits or heyoka's of 128.

    NaN from where the solver stops.
    """
    together, apart = _inertias(scene, X)
    least, rate = min(together, apart), pace(scene, X)
    shock, R = scene.shock, X(scene.rotor.length)
    at = X(shock.at) * rate if shock else X(0)
    width = X(shock.width) * rate if shock else X(1)
    solver = _solver(scene.link is not None, tol, X)
    k = X(scene.link.length) / R if scene.link else X(1)
    r, v = np.array(scene.axes, dtype=X), np.array(scene.rates, dtype=X) / rate
    if off is not None:
        r, v = r + off[0], v + off[1]
    pars = [least / together, least / apart, k, *(X(G) / (least * rate) for G in scene.momenta), *[X(0)] * 6, 1 / width]
    torque = [X(f) * R / (least * rate**2) for f in shock.force] if shock else []
    begin, asked = -at, np.array(times, dtype=X) * rate - at
    reach = _EDGE * width
    edges = sorted([begin, asked[-1], *((e for e in (-reach, reach) if begin < e < asked[-1]) if shock else ())])
    solver.state[:] = np.concatenate([*_onto(r, v, k, scene.link is not None, X)])
    found = np.full((len(asked), 12), X("nan"))
    solver.time = begin
    for left, right in pairwise(edges):
        driven = shock is not None and abs(left + right) / 2 < reach
        solver.pars[:] = pars
        if driven:
            solver.pars[5 + 3 * (shock.body - 1) : 8 + 3 * (shock.body - 1)] = torque
        for n in np.flatnonzero((asked > left) & (asked <= right)):
            if not _to(solver, asked[n], width if driven else None, most_steps):
                return _read(found)
            found[n] = solver.state
        if not _to(solver, right, width if driven else None, most_steps):
            break
    return _read(found)


def _to(solver: Any, t: Any, longest: Any, most_steps: int) -> bool:
    given = {} if longest is None else {"max_delta_t": longest}
    outcome = solver.propagate_until(t, max_steps=most_steps, **given)[0]
    return "time_limit" in str(outcome) and bool(np.isfinite(solver.state).all())


def _onto(r: Extended, v: Extended, k: Any, bar: bool, X: Any) -> tuple[Extended, ...]:
    """(s, d, s', d') of the nearest start on the constraints: what doubles left off is below the oracle's digits."""
    for _ in range(4):
        (r1, r2), e, zero = r, np.array([k, X(0), X(0)]), np.zeros(3, X)
        g = [(r1 @ r1 - 1) / 2, (r2 @ r2 - 1) / 2, k * (r2[0] - r1[0]) + 1 - r1 @ r2]
        G = [[*r1, *zero], [*zero, *r2], [*(-e - r2), *(e - r1)]]
        n = 3 if bar else 2
        G, g = np.array(G[:n], X), np.array(g[:n], X)
        inverse = np.linalg.pinv(G.astype(float) @ G.T.astype(float), rcond=1e-15)
        inverse = np.array([[X(float(part)) for part in row] for row in inverse], X)
        q, w = r.ravel() - G.T @ (inverse @ g), v.ravel() - G.T @ (inverse @ (G @ v.ravel()))
        r, v = q.reshape(2, 3), w.reshape(2, 3)
    return r[0] + r[1], r[1] - r[0], v[0] + v[1], v[1] - v[0]


def _read(states: Extended) -> Extended:
    s, d = states[:, :3], states[:, 3:6]
    return np.stack([(s - d) / 2, (s + d) / 2])
