"""The same structure in other words: Lagrange's equations by `System`, the bars as constraints, angles as coordinates."""

import numpy as np
import sympy as sp

from lagrotor.mechanics import System, coordinates


def by_lagrange(s, run, tol=1e-11):
    """The axes (N, n, 3) of `run`, integrated by `System` in the angles (p, q): r = (sin p, −sin q cos p, cos q cos p).

    The kinetic energy of each bar is that of a rod whose centre and direction move; friction is Rayleigh's function.
    """
    N = len(s.joints)
    c = coordinates(" ".join(f"p{i} q{i}" for i in range(N)))
    r, tips, T, V, D = [], [], 0, 0, 0

    def velocity(e):
        return e.jacobian(sp.Matrix(c.q)) * sp.Matrix(c.v)

    for i in range(N):
        p, q = c.q[2 * i : 2 * i + 2]
        r.append(sp.Matrix([sp.sin(p), -sp.sin(q) * sp.cos(p), sp.cos(q) * sp.cos(p)]))
        rotor, G = s.rotor[i], sp.Float(s.rotor[i].I3 * s.spins[i], 17)
        tips.append(sp.Matrix([*s.joints[i], 0]) + rotor.length * r[i])
        square = c.v[2 * i] ** 2 + sp.cos(p) ** 2 * c.v[2 * i + 1] ** 2
        T += (rotor.J + s.load[i] * rotor.length**2) * square / 2
        T += G * sp.sin(p) * c.v[2 * i + 1]  # a monopole's vector potential, which gives G r × r'
        V += s.gravity * (rotor.mass / 2 + s.load[i]) * rotor.length * r[i][2]
        V += s.hinge[i] * sp.acos(r[i][2]) ** 2 / 2
        D += s.friction[i] * square / 2
    g = []
    for (i, j, length), link in zip(s.bars, s.link, strict=True):
        centre, d = (tips[i] + tips[j]) / 2, tips[j] - tips[i]
        u, w = velocity(centre), velocity(d)
        T += link.mass * u.dot(u) / 2 + link.inertia * w.dot(w) / length**2 / 2
        V += s.gravity * link.mass * centre[2]
        g.append((d.dot(d) - length**2) / 2)
    for brace in s.braces:
        start = sp.Matrix(s.upright_tip(brace.tip))
        end, far = (
            (tips[brace.to], s.upright_tip(brace.to)) if isinstance(brace.to, int) else (sp.Matrix(brace.to), brace.to)
        )
        d = tips[brace.tip] - end
        length = sp.sqrt(d.dot(d))
        V += brace.stiffness * (length - float((start - sp.Matrix(far)).norm())) ** 2 / 2
        D += brace.damping * (d.dot(velocity(d)) / length) ** 2 / 2
    system = System(c, T - V, constraints=g, dissipation=D)
    q0, v0 = np.empty(2 * N), np.empty(2 * N)
    for i in range(N):
        (x, y, z), v = run.axes[i, 0], run.rates[i, 0]
        q0[2 * i : 2 * i + 2] = np.arcsin(x), np.arctan2(-y, z)
        v0[2 * i] = v[0] / np.sqrt(1 - x**2)
        v0[2 * i + 1] = (-v[1] * z + v[2] * y) / (y**2 + z**2)
    found = system.simulate({}, q0, v0, run.t, tol=tol).q
    p, q = found[:, 0::2].T, found[:, 1::2].T
    return np.stack([np.sin(p), -np.sin(q) * np.cos(p), np.cos(q) * np.cos(p)], -1)
