"""The same structure in other words: energies and constraints of points and rods, differentiated by complex steps."""

import numpy as np


def accelerations_by_energies(s, r, v, G, push=0.0, ground=(0.0, 0.0, 0.0)):
    """r'' (N, 3) at r, v: energies, Rayleigh's function and constraints of points and rods, differentiated by complex steps.

    push: forces (N, 3) on the tips; ground: its acceleration. Shares no formula of a force with the package.
    """
    N, R = len(s.joints), np.array([rotor.length for rotor in s.rotor])
    feet = np.array([(*joint, 0.0) for joint in s.joints])

    def dot(a, b=None):
        return (a * (a if b is None else b)).sum()

    def tips(x):
        return feet + R[:, None] * x

    def kinetic(w):
        u = R[:, None] * w
        T = sum((s.rotor[i].J * dot(w[i]) + s.load[i] * dot(u[i])) / 2 for i in range(N))
        for (i, j, length), link in zip(s.bars, s.link, strict=True):
            T += link.mass * dot((u[i] + u[j]) / 2) / 2 + link.inertia * dot(u[j] - u[i]) / length**2 / 2
        return T

    def weights(x):
        """Σ m X over all bodies."""
        X = tips(x)
        moment = sum(s.rotor[i].mass * (feet[i] + X[i]) / 2 + s.load[i] * X[i] for i in range(N))
        return moment + sum(link.mass * (X[i] + X[j]) / 2 for (i, j, _), link in zip(s.bars, s.link, strict=True))

    def lengths(x):
        """Of the braces: how far they reach."""
        for brace in s.braces:
            far = brace.to
            d = tips(x)[brace.tip] - (tips(x)[far] if isinstance(far, int) else np.array(far))
            yield np.sqrt(dot(d))

    def potential(x):
        V = s.gravity * weights(x)[2] + dot(weights(x), np.array(ground)) - dot(tips(x), np.zeros((N, 3)) + push)
        upright = lengths(np.tile([0.0, 0.0, 1.0], (N, 1)))
        V += sum(b.stiffness * (x - y) ** 2 / 2 for b, x, y in zip(s.braces, lengths(x), upright, strict=True))
        return V + sum(h * np.arctan(np.sqrt(dot(a[:2])) / a[2]) ** 2 / 2 for h, a in zip(s.hinge, x, strict=True))

    def gradient(f, x):
        steps = 1e-30j * np.eye(3 * N).reshape(-1, N, 3)
        return np.array([np.imag(f(x + step)) for step in steps]) / 1e-30

    def constraints(x):
        X = tips(x)
        return np.array([*((dot(a) - 1) / 2 for a in x), *((dot(X[j] - X[i]) - ell**2) / 2 for i, j, ell in s.bars)])

    slopes = gradient(lambda x: [*lengths(x)], r).reshape(N, 3, -1)

    def friction(w):
        along = np.tensordot(w, slopes)
        damped = sum(b.damping * x**2 / 2 for b, x in zip(s.braces, along, strict=True))
        return damped + sum(c * dot(a) / 2 for c, a in zip(s.friction, w, strict=True))

    e = np.eye(3 * N).reshape(-1, N, 3)
    M = np.array([[kinetic(a + b) - kinetic(a) - kinetic(b) for b in e] for a in e])
    rows, n = np.array([constraints(r + a) - constraints(r - a) for a in e]).T / 2, len(s.bars) + N
    bent = constraints(r + v) + constraints(r - v) - 2 * constraints(r)
    F = (G[:, None] * np.cross(r, v)).ravel() - gradient(potential, r) - gradient(friction, v)
    whole = np.block([[M, rows.T], [rows, np.zeros((n, n))]])
    return np.linalg.solve(whole, np.append(F, -bent))[: 3 * N].reshape(N, 3)
