"""sympy.physics.mechanics and PyDy on the pair: two bodies turned about x, y and their axis, one bar between the tips."""

from math import asin, atan2, cos, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.benchmark.runner import Method, Prepare, Runner, tips
from lagrotor.errors import IntegrationError
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]


def _bodies(scene: Scene, mass: Any) -> dict[str, Any]:
    """The pair in sympy.physics.mechanics: two rigid bodies of `mass`, turned about x, y and their axis, one bar."""
    from sympy.physics import mechanics as me

    assert scene.link is not None
    q, u = me.dynamicsymbols("q:6"), me.dynamicsymbols("u:6")
    ground, origin = me.ReferenceFrame("N"), me.Point("O")
    origin.set_vel(ground, 0)
    R, rotor, bodies, ends = scene.rotor.length, scene.rotor, [], []
    for i, side in enumerate((-1, 1)):
        frame = ground.orientnew(f"B{i}", "Body", q[3 * i : 3 * i + 3], "XYZ")
        joint = origin.locatenew(f"J{i}", side * scene.link.length / 2 * ground.x)
        centre, tip = (joint.locatenew(f"{n}{i}", length * frame.z) for n, length in (("C", R / 2), ("T", R)))
        joint.set_vel(ground, 0)
        centre.v2pt_theory(joint, ground, frame)
        inertia = me.inertia(frame, rotor.I1, rotor.I1, rotor.I3)
        bodies.append(me.RigidBody(f"rotor{i}", centre, frame, mass, (inertia, centre)))
        ends.append(tip)
    apart = ends[1].pos_from(ends[0])
    bar = (apart.dot(apart) - scene.link.length**2) / 2
    return {"q": q, "u": u, "N": ground, "bodies": bodies, "bar": bar, "me": me}


def angles(given: Any) -> list[float]:
    """The bodies' angles and their rates at the start: r = (sin b, −sin a cos b, cos a cos b), spin c' + a' sin b.

    given: axes, rates and spins of any number of rotors.
    """
    places, rates = [], []
    for r, v, spin in zip(given.axes, given.rates, given.spins, strict=True):
        angle_a, angle_b = atan2(-r[1], r[2]), asin(r[0])
        rate_a = (r[1] * v[2] - r[2] * v[1]) / (r[1] ** 2 + r[2] ** 2)
        places += [angle_a, angle_b, 0.0]
        rates += [rate_a, v[0] / cos(angle_b), spin - rate_a * sin(angle_b)]
    return places + rates


def axes_of(states: Array) -> Array:
    """Axes (N, n, 3) of states (n, 6 N) whose first half is these angles."""
    places = states[:, : states.shape[1] // 2].T
    a, b = places[0::3], places[1::3]
    return np.stack([np.sin(b), -np.sin(a) * np.cos(b), np.cos(a) * np.cos(b)], axis=-1)


def check_odeint(log: dict[str, Any]) -> None:
    """Raise IntegrationError where odeint says that it stopped: it hands on what it has all the same."""
    if log["message"] != "Integration successful.":
        raise IntegrationError(log["message"])


def lagranges_method(scene: Scene, t_eval: Array) -> Runner:
    """sympy.physics.mechanics: LagrangesMethod with a multiplier, lambdify with cse, numpy.linalg.solve, odeint."""
    import sympy as sp
    from scipy.integrate import odeint

    made = _bodies(scene, scene.rotor.mass)
    me, q = made["me"], made["q"]
    lagrangian = me.Lagrangian(made["N"], *made["bodies"])
    method = me.LagrangesMethod(lagrangian, q, hol_coneqs=[made["bar"]], frame=made["N"])
    method.form_lagranges_equations()
    t = me.dynamicsymbols._t
    named = sp.symbols("x:12", real=True)
    by_name = dict(zip([s.diff(t) for s in q], named[6:], strict=True)) | dict(zip(q, named[:6], strict=True))
    full = [m.xreplace(by_name) for m in (method.mass_matrix_full, method.forcing_full)]
    function = sp.lambdify([named], full, "numpy", cse=True)
    start, nfev = angles(scene), 0

    def rhs(t: float, y: Array) -> Array:
        nonlocal nfev
        nfev += 1
        matrix, force = function(y)
        return np.linalg.solve(matrix, force)[:12, 0]

    def run(tol: float) -> tuple[Array, int]:
        nonlocal nfev
        nfev = 0
        states, log = odeint(rhs, start, t_eval, tfirst=True, rtol=tol, atol=tol, full_output=True)
        check_odeint(log)
        return tips(scene, axes_of(states)), nfev

    return run


def _pydy(generator: str) -> Prepare:
    def prepare(scene: Scene, t_eval: Array) -> Runner:
        import sympy as sp
        from pydy.system import System

        mass = sp.Symbol("M")  # the generators need a constant
        made = _bodies(scene, mass)
        me, q, u, bar = made["me"], made["q"], made["u"], made["bar"]
        kinematic = [s.diff() - w for s, w in zip(q, u, strict=True)]
        speeds = dict(zip([s.diff() for s in q], u, strict=True))
        closing = me.msubs(bar.diff(me.dynamicsymbols._t), speeds)
        ours = [0, 1, 2, 3, 5]
        kane = me.KanesMethod(
            made["N"],
            [q[i] for i in ours],
            [u[i] for i in ours],
            kinematic,
            q_dependent=[q[4]],
            configuration_constraints=[bar],
            u_dependent=[u[4]],
            velocity_constraints=[closing],
        )
        for body in made["bodies"]:
            body.masscenter.set_vel(made["N"], me.msubs(body.masscenter.vel(made["N"]), speeds))
            body.frame.set_ang_vel(made["N"], me.msubs(body.frame.ang_vel_in(made["N"]), speeds))
        kane.kanes_equations(made["bodies"], [])
        values = {mass: scene.rotor.mass}
        system = System(
            kane, constants=values, times=t_eval, initial_conditions=dict(zip([*q, *u], angles(scene), strict=True))
        )
        system.generate_ode_function(generator=generator, linear_sys_solver="numpy")
        order = [list(map(sp.sympify, system.states)).index(s) for s in [*q, *u]]

        def run(tol: float) -> tuple[Array, int]:
            states, log = system.integrate(rtol=tol, atol=tol, full_output=True)
            check_odeint(log)
            return tips(scene, axes_of(states[:, order])), int(log["nfe"][-1])

        return run

    return prepare


SYMPY: dict[str, Method] = {
    "LagrangesMethod": Method("peer", lagranges_method, install="--group peers"),
    "PyDy, lambdify": Method("peer", _pydy("lambdify"), install="--group peers"),
    "PyDy, Cython": Method("peer", _pydy("cython"), install="--group peers"),
}
