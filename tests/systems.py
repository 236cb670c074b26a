"""A gallery of textbook systems, each in its letters, with the values VALUES of these; every call makes a new one.

from tests.systems import VALUES, pendulum
pendulum().simulate(VALUES, (2.5,), (0,), times)
"""

from typing import Any

import sympy as sp

from lagrotor.mechanics import Frame, System, coordinates

m, M, l, g, k, R, J, Omega, I1, I2, I3 = sp.symbols("m M l g k R J Omega I_1 I_2 I_3", positive=True)
VALUES: dict[sp.Symbol, float] = {
    m: 1.3,
    M: 2.1,
    l: 0.7,
    g: 9.81,
    k: 2.0,
    R: 0.5,
    J: 0.5,
    Omega: 6.0,
    I1: 0.3,
    I2: 0.4,
    I3: 0.2,
}


def values_of(system: System) -> dict[sp.Symbol, float]:
    """Return the values of the letters that a system has."""
    used = system.L.free_symbols.union(*(e.free_symbols for e in (system.dissipation, *system.constraints)))
    return {s: x for s, x in VALUES.items() if s in used}


def pendulum(**more: Any) -> System:
    """Return a mass m on a rod of length l, theta from below; more: arguments of System."""
    c = coordinates("theta")
    return System(c, m * l**2 * c.v[0] ** 2 / 2 + m * g * l * sp.cos(c.q[0]), **more)


def rod_pendulum() -> System:
    """Return the same pendulum in x and y, with the rod as a constraint."""
    c = coordinates("x y")
    (x, y), (u, w) = c.q, c.v
    return System(c, m * (u**2 + w**2) / 2 - m * g * y, (x**2 + y**2 - l**2,))


def spherical_pendulum() -> System:
    """Return a mass m on a rod of length l in space, theta from below."""
    c = coordinates("theta phi")
    (theta, _), (tilting, turning) = c.q, c.v
    return System(c, m * l**2 * (tilting**2 + sp.sin(theta) ** 2 * turning**2) / 2 + m * g * l * sp.cos(theta))


def double_pendulum() -> System:
    """Return two masses m on rods of length l, absolute angles from below."""
    c = coordinates("alpha beta")
    (alpha, beta), (u, w) = c.q, c.v
    T = m * l**2 * (2 * u**2 + w**2 + 2 * u * w * sp.cos(alpha - beta)) / 2
    return System(c, T + m * g * l * (2 * sp.cos(alpha) + sp.cos(beta)))


def hoop() -> System:
    """Return a bead on a hoop of radius R that turns about the vertical at the rate Omega; theta from the lowest point."""
    c = coordinates("theta")
    spun = c.v[0] ** 2 + Omega**2 * sp.sin(c.q[0]) ** 2
    return System(c, m * R**2 * spun / 2 + m * g * R * sp.cos(c.q[0]))


def heavy_top() -> System:
    """Return a symmetric top, I1 about its tip, in theta, phi and psi."""
    c = coordinates("theta phi psi")
    theta, (tilting, turning, spinning) = c.q[0], c.v
    spin = spinning + turning * sp.cos(theta)
    T = (I1 * (tilting**2 + turning**2 * sp.sin(theta) ** 2) + I3 * spin**2) / 2
    return System(c, T - m * g * l * sp.cos(theta))


def ball_top(inertia: Any = (I1, I1, I3), centre: Any = (0, 0, l)) -> System:
    """Return a top on a ball joint, which has no pole; q0 to q3 turn it, p, q and r are its angular velocities."""
    frame = Frame(coordinates("q0 q1 q2 q3")).ball("q0 q1 q2 q3", omega="p q r")
    body = frame.body(m, inertia, centre)
    return System(frame.c, body.kinetic - body.potential((0, 0, -g)) if any(centre) else body.kinetic)


def turning_top() -> System:
    """Return a top of unlike inertias about its tip in Euler's angles and, p q r, the angular velocities in its axes."""
    c = coordinates("phi theta psi")
    frame = Frame(c).turned("zxz", c.q)
    velocities = dict(zip(sp.symbols("p q r", real=True), frame.angular_velocity, strict=True))
    return System(c, frame.body(0, (I1, I2, I3)).kinetic - m * g * l * sp.cos(c.q[1]), velocities=velocities)


def cart_and_pole(force: Any = 0) -> System:
    """Return a mass m on a rod of length l that stands up at theta = 0, on a cart of mass M at x, which the force moves."""
    c = coordinates("x theta")
    theta, (v, w) = c.q[1], c.v
    kinetic = M * v**2 / 2 + m * (v**2 + 2 * l * v * w * sp.cos(theta) + l**2 * w**2) / 2
    return System(c, kinetic - m * g * l * sp.cos(theta), forces=(force, 0))


def kepler(dimensions: int = 3) -> System:
    """Return a mass m in the potential −k/r."""
    c = coordinates(["x", "y", "z"][:dimensions])
    return System(c, m * sum(v**2 for v in c.v) / 2 + k / sp.sqrt(sum(q**2 for q in c.q)))


def plane_motion(V: Any, magnetic: Any = 0) -> System:
    """Return a unit mass in the plane with the potential V(x, y) and the field 2·magnetic."""
    c = coordinates("x y")
    (x, y), (u, w) = c.q, c.v
    return System(c, (u**2 + w**2) / 2 + magnetic * (x * w - y * u) - V(x, y))


def henon_heiles() -> System:
    """Return Hénon's and Heiles' system."""
    return plane_motion(lambda x, y: (x**2 + y**2) / 2 + x**2 * y - y**3 / 3)


def sleigh() -> System:
    """Return Chaplygin's sleigh: a blade at (x, y) along phi, the centre of mass the distance l ahead of it."""
    c = coordinates("x y phi")
    x, y, phi = c.q
    blade = Frame(c).moved(x, y).turned("z", phi)
    return System(c, blade.body(m, (0, 0, J), (l, 0, 0)).kinetic, rolling=(blade.velocity()[1],))


def rolling_disc() -> tuple[System, Frame]:
    """Return a thin disc on a horizontal plane in its centre, heading, lean and roll; and the frame of the disc."""
    c = coordinates("x y z phi theta psi")
    lean = Frame(c).moved(*c.q[:3]).turned("zx", c.q[3:5])
    wheel = lean.turned("y", c.q[5])
    body = wheel.body(m, (m * R**2 / 4, m * R**2 / 2, m * R**2 / 4))
    slips = wheel.velocity((0, 0, -R), frame=lean)[:2, 0]
    gap = c.q[2] - R * sp.cos(c.q[4])
    return System(c, body.kinetic - body.potential((0, 0, -g)), (gap,), rolling=tuple(slips)), wheel


def chain(n: int) -> System:
    """Return n masses m on links of length l without mass, relative angles about y."""
    c = coordinates([f"q{i}" for i in range(n)])
    frame, L = Frame(c), sp.S.Zero
    for q in c.q:
        frame = frame.turned("y", q)
        point = frame.body(m, centre=(0, 0, -l))
        L, frame = L + point.kinetic - point.potential((0, 0, -g)), frame.moved(0, 0, -l)
    return System(c, L)
