"""sympy.physics.mechanics and PyDy on a mechanism, each as its documentation recommends.

Kane's method with the links' own angular velocities as generalised speeds, in which its equations are shortest; Lagrange's
with the kinetic energies of the same bodies. lambdify with common subexpressions, then numpy.linalg.solve.
"""

from typing import Any

import numpy as np

from benchmarks.mechanisms.chains import JOINTS, VALUES
from benchmarks.mechanisms.tool import Array, Ready, Tool
from lagrotor.benchmark.records import MechanismKind

_NUMBERS = {str(s): value for s, value in VALUES.items()}


class _Mechanism:
    """Coordinates q, speeds u, the ground, bodies with their frames, and the weights, in sympy.physics.mechanics."""

    def __init__(self, kind: MechanismKind, n: int) -> None:
        import sympy as sp
        from sympy.physics import mechanics as me

        self.me, self.parameters = me, sp.symbols("m l g I_1 I_3")
        count = JOINTS[kind] * n
        self.q, self.u = list(me.dynamicsymbols(f"q:{count}")), list(me.dynamicsymbols(f"u:{count}"))
        self.rates = [q.diff() for q in self.q]
        self.ground, self.origin = me.ReferenceFrame("N"), me.Point("O")
        self.origin.set_vel(self.ground, 0)
        self.bodies: list[Any] = []
        self.loads: list[Any] = []
        self.frames: list[Any] = []
        frame, joint, spin = self.ground, self.origin, 0 * self.ground.x
        for i in range(n):
            frame, joint, spin = (self._rod if kind == "rods" else self._gyroscope)(i, frame, joint, spin)

    def _turned(self, name: str, frame: Any, number: int, axis: Any, spin: Any) -> tuple[Any, Any]:
        """A frame turned by coordinate `number`, and its angular velocity in the speeds."""
        turned = frame.orientnew(name, "Axis", (self.q[number], axis))
        spin = spin + self.u[number] * axis
        turned.set_ang_vel(self.ground, spin)
        self.frames.append(turned)
        return turned, spin

    def _point(self, name: str, joint: Any, way: Any, frame: Any) -> Any:
        point = joint.locatenew(name, way)
        point.v2pt_theory(joint, self.ground, frame)
        return point

    def _rod(self, i: int, frame: Any, joint: Any, spin: Any) -> tuple[Any, Any, Any]:
        m, l, g, _, _ = self.parameters
        turned, spin = self._turned(f"A{i}", frame, i, frame.y, spin)
        end = self._point(f"P{i}", joint, -l * turned.z, turned)
        self.bodies.append(self.me.Particle(f"B{i}", end, m))
        self.loads.append((end, -m * g * self.ground.z))
        return turned, end, spin

    def _gyroscope(self, i: int, frame: Any, joint: Any, spin: Any) -> tuple[Any, Any, Any]:
        m, l, g, I1, I3 = self.parameters
        half, spin = self._turned(f"A{i}", frame, 3 * i, frame.x, spin)
        axis, spin = self._turned(f"B{i}", half, 3 * i + 1, half.y, spin)
        rotor, _ = self._turned(f"C{i}", axis, 3 * i + 2, axis.z, spin)
        centre = self._point(f"M{i}", joint, l / 2 * axis.z, axis)
        inertia = self.me.inertia(axis, I1, I1, I3)
        self.bodies.append(self.me.RigidBody(f"R{i}", centre, rotor, m, (inertia, centre)))
        self.loads.append((centre, -m * g * self.ground.z))
        return axis, self._point(f"T{i}", joint, l * axis.z, axis), spin

    def kane(self) -> Any:
        method = self.me.KanesMethod(
            self.ground, self.q, self.u, [a - b for a, b in zip(self.rates, self.u, strict=True)]
        )
        method.kanes_equations(self.bodies, self.loads)
        return method

    def lagrange(self) -> Any:
        me, speeds = self.me, dict(zip(self.u, self.rates, strict=True))
        for frame in self.frames:
            frame.set_ang_vel(self.ground, me.msubs(frame.ang_vel_in(self.ground), speeds))
        places = [load[0] for load in self.loads]
        for place in places:
            place.set_vel(self.ground, me.msubs(place.vel(self.ground), speeds))
        m, g = self.parameters[0], self.parameters[2]
        potential = sum(m * g * place.pos_from(self.origin).dot(self.ground.z) for place in places)
        method = me.LagrangesMethod(sum(b.kinetic_energy(self.ground) for b in self.bodies) - potential, self.q)
        method.form_lagranges_equations()
        return method


def _solved(method: Any, q: list[Any], u: list[Any], parameters: Any) -> Ready:
    """The full equations by lambdify with cse, solved by numpy."""
    import sympy as sp

    names = sp.symbols(f"y:{2 * len(q)}")
    speeds, places = (
        dict(zip(symbols, part, strict=True)) for symbols, part in ((u, names[len(q) :]), (q, names[: len(q)]))
    )
    full = [e.xreplace(speeds).xreplace(places) for e in (method.mass_matrix_full, method.forcing_full)]
    function = sp.lambdify([names, parameters], full, "numpy", cse=True)
    values = [_NUMBERS[str(p)] for p in parameters]

    def rhs(t: float, y: Array) -> Array:
        matrix, force = function(y, values)
        return np.asarray(np.linalg.solve(matrix, force)[:, 0])

    return Ready(rhs)


def kane(kind: MechanismKind, n: int) -> Ready:
    """KanesMethod."""
    made = _Mechanism(kind, n)
    return _solved(made.kane(), made.q, made.u, made.parameters)


def lagrange(kind: MechanismKind, n: int) -> Ready:
    """LagrangesMethod."""
    made = _Mechanism(kind, n)
    return _solved(made.lagrange(), made.q, made.rates, made.parameters)


def pydy(kind: MechanismKind, n: int) -> Ready:
    """KanesMethod's equations compiled by PyDy with Cython."""
    from pydy.codegen.ode_function_generators import generate_ode_function

    made = _Mechanism(kind, n)
    method = made.kane()
    parameters = [p for p in made.parameters if method.forcing_full.has(p) or method.mass_matrix_full.has(p)]
    function = generate_ode_function(
        method.forcing_full,
        made.q,
        made.u,
        parameters,
        mass_matrix=method.mass_matrix_full,
        generator="cython",
        linear_sys_solver="numpy",
    )
    values = np.array([_NUMBERS[str(p)] for p in parameters])
    return Ready(lambda t, y: function(y, t, values))


SYMPY = {
    "KanesMethod": Tool(kane),
    "LagrangesMethod": Tool(lagrange),
    "PyDy, Cython": Tool(pydy, "pydy", "--group peers", ("Cython",)),
}
