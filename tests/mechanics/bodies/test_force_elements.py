"""Springs, dampers, actuators and friction along pathways; forces and torques; against sympy's and against closed solutions."""

import numpy as np
import pytest
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics import Frame, Pathway, System, coordinates, t

C = coordinates("x y z")
x, y, z = C.q
k, d, F, m, l, R, T = sp.symbols("k d F m l R T", positive=True)


def test_what_acts_along_a_line_is_what_sympy_has() -> None:
    """A spring, a damper and an actuator between a fixed point and a moving one; sympy's generalised forces at random states."""
    from sympy.physics.mechanics import (
        ForceActuator,
        LinearDamper,
        LinearPathway,
        LinearSpring,
        Point,
        ReferenceFrame,
        dynamicsymbols,
    )

    N, O = ReferenceFrame("N"), Point("O")
    q = dynamicsymbols("x y z")
    P = O.locatenew("P", q[0] * N.x + q[1] * N.y + q[2] * N.z)
    O.set_vel(N, 0)
    P.set_vel(N, P.pos_from(O).dt(N))
    path = LinearPathway(O, P)
    peers = (LinearSpring(k, path, l), LinearDamper(d, path), ForceActuator(F, path))
    line = Pathway.line(C, (0, 0, 0), C.q)
    mine = (
        -System(C, -line.spring(k, l)).bias,
        System(C, m * C.v[0] ** 2, dissipation=line.damper(d)).generalised_forces,
        line.actuator(F),
    )
    random = np.random.default_rng(1)
    for peer, own in zip(peers, mine, strict=True):
        for _ in range(3):
            state = random.uniform(-1, 1, 6)
            values = {k: 2.0, d: 0.7, F: 1.3, l: 0.4}
            theirs = {f.diff(): v for f, v in zip(q, state[3:], strict=True)} | dict(zip(q, state, strict=False))
            Q = [
                sum(load.vector.dot(load.point.vel(N).diff(f.diff(), N)) for load in peer.to_loads() if load.point is P)
                for f in q
            ]
            expected = [float(sp.sympify(e).xreplace(theirs).subs(values)) for e in Q]
            here = own.subs(dict(zip((*C.q, *C.v), state, strict=True)) | values)
            assert np.array(here.tolist(), float).ravel() == pytest.approx(expected, abs=1e-12)


def shortest_round(p: np.ndarray, q: np.ndarray, radius: float) -> float:
    """The length of a path from p to q that has a cylinder about z on its left: along the convex hull of both and the circle."""
    from scipy.spatial import ConvexHull

    turn = np.linspace(0, 2 * np.pi, 20_000, endpoint=False)
    points = np.vstack([p[:2], q[:2], radius * np.column_stack([np.cos(turn), np.sin(turn)])])
    hull = [int(i) for i in ConvexHull(points).vertices]  # in the positive sense
    hull = hull[hull.index(0) :] + hull[: hull.index(0)]
    way = points[hull[: hull.index(1) + 1]]
    return float(np.hypot(np.linalg.norm(np.diff(way, axis=0), axis=1).sum(), q[2] - p[2]))


@pytest.mark.parametrize("angle", [1.9, 2.6, 3.4])
def test_a_path_round_a_cylinder_is_the_shortest(angle: float) -> None:
    P, Q = np.array([1.5, 0, 0.2]), np.array([1.2 * np.cos(angle), 1.2 * np.sin(angle), 0.9])
    path = Pathway.around(C, tuple(map(sp.Rational, map(str, P))), C.q, sp.Rational(1, 2))
    here = float(path.length.subs(dict(zip(C.q, Q, strict=True))).evalf())
    assert here == pytest.approx(shortest_round(P, Q, 0.5), abs=1e-7)
    other = Pathway.around(C, tuple(map(sp.Rational, map(str, P))), C.q, sp.Rational(1, 2), side=-1)
    mirrored = other.length.subs(dict(zip(C.q, Q * [1, -1, 1], strict=True)))
    assert here == pytest.approx(float(mirrored.evalf()))


def test_a_path_on_the_surface_is_the_helix_of_sympy_and_a_free_one_straight() -> None:
    from sympy.physics.mechanics import Point, ReferenceFrame, WrappingCylinder, WrappingPathway

    N, O = ReferenceFrame("N"), Point("O")
    on = [(R * sp.cos(s), R * sp.sin(s), h) for s, h in ((sp.Rational(1, 5), 0), (sp.Rational(7, 5), l))]
    points = [O.locatenew(f"P{i}", a * N.x + b * N.y + h * N.z) for i, (a, b, h) in enumerate(on)]
    peer = WrappingPathway(*points, WrappingCylinder(R, O, N.z)).length
    values = {R: 0.7, l: 0.3}
    mine = Pathway.around(C, *on, R).length
    assert float(mine.subs(values).evalf()) == pytest.approx(float(peer.subs(values).evalf()), abs=1e-12)
    free = Pathway.around(C, (2, 1, 0), (-2, 1, 0), sp.Rational(1, 2))  # passes above the cylinder, on that side
    assert free.length.evalf() == pytest.approx(4)


def test_a_rope_round_a_drum_keeps_its_energy_where_it_touches_and_leaves_it() -> None:
    """A mass on a spring that wraps round a fixed cylinder: the energy is kept through touching and leaving."""
    c = coordinates("x y")
    path = Pathway.around(c, (2, 0, 0), (*c.q, 0), R)
    system = System(c, m * (c.v[0] ** 2 + c.v[1] ** 2) / 2 - path.spring(k, l))
    run = system.simulate({m: 1, k: 2, l: 3, R: 0.5}, (-1, 1), (-0.2, -0.8), np.linspace(0, 1.2, 13), 1e-9)
    touching = run.evaluate(path.lengths[1][0])
    assert touching[0] == 0 and touching[-1] == 1 and run.ending.kind == "end"
    assert np.ptp(run.energy) < 1e-8
    turned = System(c, m * (c.v[0] ** 2 + c.v[1] ** 2) / 2, forces=path.actuator(-k * (path.length - l)))
    again = turned.simulate({m: 1, k: 2, l: 3, R: 0.5}, (-1, 1), (-0.2, -0.8), np.linspace(0, 1.2, 13), 1e-9)
    assert again.q == pytest.approx(run.q, abs=1e-8)


def test_dry_friction_along_a_line_holds_what_pulls_less() -> None:
    c = coordinates("x")
    line = Pathway.line(c, (0, 0, 0), (2 + c.q[0], 0, 0))
    system = System(c, c.v[0] ** 2 / 2 - c.q[0] ** 2 / 2, dissipation=line.dry_friction(F))
    run = system.simulate({F: 0.3}, (1,), (0,), np.linspace(0, 3 * np.pi, 4), 1e-9)
    assert run.q[:, 0] == pytest.approx([1, -0.4, -0.2, -0.2], abs=1e-8)


def test_forces_and_torques_are_those_of_virtual_work() -> None:
    """A motor between two links, and a force at the end of the second."""
    c = coordinates("a b")
    first = Frame(c).turned("z", c.q[0])
    second = first.moved(l, 0, 0).turned("z", c.q[1])
    assert list(second.torque((0, 0, T), against=first)) == [0, T]
    assert list(second.torque((0, 0, T))) == [T, T]
    pushed = second.force((0, F, 0), at=(l, 0, 0), axes=Frame(c))
    a, b = c.q
    assert sp.simplify(pushed[0] - F * l * (sp.cos(a) + sp.cos(a + b))) == 0
    assert sp.simplify(pushed[1] - F * l * sp.cos(a + b)) == 0
    moving = Frame(c).moved(sp.sin(t), 0, 0).turned("z", c.q[0])
    assert list(moving.force((F, 0, 0), axes=Frame(c))) == [0, 0]


def test_forces_and_torques_are_in_the_axes_of_the_frame_or_of_another() -> None:
    c = coordinates("a b")
    a, b = c.q
    ground = Frame(c)
    first = ground.pin(a)
    second = first.moved(l, 0, 0).turned("zx", (b, a))
    for axes in (None, "frame", "ground", second, first, second.turned("x", b)):
        frame, vector = {None: second, "frame": second, "ground": ground}.get(axes, axes), (1, 2, 3)
        in_ground = list(frame.place(vector) - frame.place())
        for found, expected in (
            (second.force(vector, (l, 0, 0), axes=axes), second.force(in_ground, (l, 0, 0), axes=ground)),
            (second.torque(vector, first, axes=axes), second.torque(in_ground, first, axes=ground)),
        ):
            assert not any((found - expected).applyfunc(sp.simplify))
    # By hand: a force along the ground's x at the joint turns the first link by −F l sin a, one along its own x by none.
    joint = first.moved(l, 0, 0)
    assert list(joint.force((F, 0, 0))) == [0, 0]
    assert list(joint.force((F, 0, 0), axes=ground)) == [-F * l * sp.sin(a), 0]
    assert sp.simplify(second.torque((T, 0, 0), first, axes=ground.pin(a + b))[0] - T) == 0
    with pytest.raises(InputError, match="force: axes = 'x' must be 'frame', 'ground' or a Frame"):
        first.force((1, 0, 0), axes="x")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"torque: axes = Frame.ground. must be a Frame with the same"):
        first.torque((1, 0, 0), axes=Frame(coordinates("z")))


def test_the_old_push_keeps_the_axes_of_the_ground() -> None:
    rod = Frame(coordinates("a")).pin("a")
    with pytest.warns(DeprecationWarning, match="Frame.force.F, at, axes='ground'"):
        assert rod.push((0, F, 0), (l, 0, 0)) == rod.force((0, F, 0), (l, 0, 0), axes=Frame(rod.c))
    line = Pathway.line(C, (0, 0, 0), C.q)
    with pytest.warns(DeprecationWarning, match="Pathway.spring: rest is now rest_length"):
        assert line.spring(k, rest=l) == line.spring(k, l)  # type: ignore[call-arg]
    with pytest.warns(DeprecationWarning, match="seen is now frame"):
        assert rod.place((1, 0, 0), seen=rod) == sp.Matrix([1, 0, 0])  # type: ignore[call-arg]
