"""The generalised forces of a mechanism as a linear function of its inertial parameters, and what of these a motion can tell.

A body has ten parameters π: the mass m, the first moment m c, and the inertia I about the origin of its frame, all in the
frame's axes. Its need of force and torque about the origin is linear in them. With ω, α and the acceleration a of the origin
less the field of weight,

    F = m a + K m c,    N = I α + ω × I ω + m c × a,    K = [α]× + [ω]×²,

so that the generalised forces are Y(q, v, a) π. A change of π alters no motion if it alters neither the kinetic energy, nor
the potential energy by more than a constant. Both are linear in π; they are evaluated exactly at random rational states, where
the cosine and sine of an angle are a rational point of the circle.

Atkeson, An & Hollerbach, Int. J. Robotics Res. 5 (1986) 101; Gautier & Khalil, IEEE Trans. Robotics Autom. 6 (1990) 368.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from random import Random
from typing import Any

import sympy as sp
from sympy.polys.constructor import construct_domain
from sympy.polys.matrices import DomainMatrix
from sympy.polys.polyerrors import CoercionFailed

from lagrotor.errors import InputError
from lagrotor.mechanics.bodies.joint_forces import (
    FrameMotion,
    frame_motions,
    frames_of,
    generalised,
    inward,
    rate_stages,
    unsteady_weights,
    written_out,
)
from lagrotor.mechanics.bodies.moving_frames import MovingFrame
from lagrotor.mechanics.bodies.small_matrices import Small, Stages, blocks, unit, zeros
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import shortest
from lagrotor.mechanics.lagrangian import t, total_derivative

_STEMS = "m mx my mz Ixx Ixy Ixz Iyy Iyz Izz"
_ENTRIES = (
    (0, 0),
    (0, 1),
    (0, 2),
    (1, 1),
    (1, 2),
    (2, 2),
)  # the entries of a symmetric matrix on and above its diagonal
_MORE = 5  # random states beyond the number of unknowns
_LARGEST = 30  # numerator and denominator of a random number


@dataclass(frozen=True, eq=False)
class BaseParameters:
    """The combinations of masses, first moments and inertias that a measurement of forces and motion can determine.

    Body number k of a system, from 1, has the parameters m_k, the first moments mx_k, my_k, mz_k, and the inertias Ixx_k, …,
    Izz_k about the origin of its frame, along the axes of that frame.

    Attributes
    ----------
    names : tuple of Symbol
        The symbols of all 10 N parameters of N bodies, in the order of the columns of `System.regressor`.
    columns : tuple of int
        The independent columns of the regressor Y, r of them.
    combinations : Matrix
        The base parameters β as combinations of `names`, shape (r, 1): Y π = Y[:, columns] β.
    values : Matrix
        The base parameters in the symbols of the system, shape (r, 1).
    hidden : tuple of Expr
        Changes of the parameters that leave the forces of every motion the same. Each is a combination of `names`: add ε times
        the coefficient of a name to that parameter. m_2 − l*mx_1 − l**2*Izz_1 adds ε to m_2 and subtracts
        ε l from mx_1 and ε l² from Izz_1.
    """

    names: tuple[sp.Symbol, ...]
    columns: tuple[int, ...]
    combinations: sp.Matrix
    values: sp.Matrix
    hidden: tuple[sp.Expr, ...]


def regressor(system: Equations) -> tuple[sp.Matrix, sp.Matrix]:
    """Return Y and π: `System.regressor`."""
    bodies, field = _bodies("regressor", system)
    frames, keep, N = frames_of(*(body.frame for body in bodies)), Stages(), len(bodies)
    motions, wrenches = frame_motions(system, frames, keep), dict[MovingFrame, Small]()
    for k, body in enumerate(bodies):
        if body.frame.parent is not None:
            column = _unit_wrenches(motions[body.frame], bool(field), keep)
            whole = blocks([[zeros(6, 10 * k), column, zeros(6, 10 * (N - k - 1))]])
            wrenches[body.frame] = wrenches.get(body.frame, zeros(6, 10 * N)) + whole
    Y = generalised(system, inward(frames, motions, wrenches, (), keep))
    written = written_out([*rate_stages(system), *keep.made], list(Y))
    return sp.Matrix(len(system.speeds), 10 * N, [shortest(e) for e in written]), _parameters(bodies)


def _bodies(where: str, system: Equations) -> tuple[tuple[Any, ...], tuple[sp.Expr, ...]]:
    """Return the bodies and their field of weight, () if they have no weight; raise InputError for any other energies."""
    terms = system.lagrangian.terms if system.bodies else ()
    kinetic = [body for body, field, factor in terms if field is None and factor == 1]
    fallen = [body for body, field, factor in terms if field is not None and factor == -1]
    fields = list(dict.fromkeys(field for _, field, _ in terms if field is not None))
    complete = len(kinetic) + len(fallen) == len(terms) and sorted(map(id, kinetic)) == sorted(
        map(id, fallen or kinetic)
    )
    if not kinetic or not complete or len(fields) > 1 or len({*kinetic}) < len(kinetic) or unsteady_weights(system):
        raise InputError(
            f"{where}: the Lagrangian must be made of bodies: body.kinetic of each, once, less body.potential(field) of all or "
            "of none, with one field"
        )
    return tuple(kinetic), fields[0] if fields else ()


def _parameters(bodies: Sequence[Any]) -> sp.Matrix:
    """Return the ten parameters of each body in the symbols of the system, shape (10 N, 1)."""
    entries = list[sp.Expr]()
    for body in bodies:
        c, m = body.centre, body.mass
        I = body.inertia + m * (sp.eye(3) * c.dot(c) - c * c.T)
        entries += [m, *(m * c), *(I[i, j] for i, j in _ENTRIES)]
    return sp.Matrix(entries)


def _unit_wrenches(at: FrameMotion, heavy: bool, keep: Stages) -> Small:
    """Return the torque and force (6, 10) about a frame's origin per unit of each parameter of a body."""
    a = keep.each(at.lift - at.fields if heavy else at.lift)
    axes, columns = [unit(k, sp.S.One) for k in range(3)], [blocks([[zeros(3, 1)], [a]])]
    columns += [blocks([[e.cross(a)], [at.bend * e]]) for e in axes]
    for i, j in _ENTRIES:
        I = Small([[sp.S(int((r, s) in ((i, j), (j, i)))) for s in range(3)] for r in range(3)])
        columns.append(blocks([[I * at.turn + at.spin.cross(I * at.spin)], [zeros(3, 1)]]))
    return keep.each(blocks([columns]))


def base_parameters(system: Equations) -> BaseParameters:
    """Return the base parameters: `System.base_parameters`."""
    bodies, field = _bodies("base_parameters", system)
    if system.left:
        raise InputError(
            "base_parameters: constraints restrict the motions; leave them out, for those of the open chain"
        )
    names = tuple(sp.Symbol(f"{stem}_{k}", real=True) for k in range(1, len(bodies) + 1) for stem in _STEMS.split())
    energies = _Energies(system, bodies, field)
    random = Random(0)
    letters = {s: _number(random) for s in energies.letters}
    base = energies.domain(())
    states = [energies.state(random) for _ in range(len(names) + _MORE)]
    try:
        rows = energies.rows(states, base, letters)
    except CoercionFailed as problem:
        raise InputError(
            f"base_parameters: joints with {problem}: give angles and polynomials of coordinates"
        ) from None
    reduced, columns = DomainMatrix(rows, (len(rows), len(names)), base).rref()
    reduced = reduced.to_Matrix()
    combinations, hidden = [names[p] for p in columns], list[sp.Expr]()
    for j, name in enumerate(names):
        if j in columns:
            continue
        support = [k for k in range(len(columns)) if reduced[k, j] != 0]
        factors = [reduced[k, j] for k in support]
        if energies.letters and support:
            factors = energies.solve([columns[k] for k in support], j, rows, states)
        hidden.append(name - sp.Add(*(f * names[columns[k]] for f, k in zip(factors, support, strict=True))))
        for f, k in zip(factors, support, strict=True):
            combinations[k] += f * name
    pi = dict(zip(names, _parameters(bodies), strict=True))
    values = sp.Matrix([shortest(e.xreplace(pi)) for e in combinations])
    return BaseParameters(names, tuple(columns), sp.Matrix(combinations), values, tuple(hidden))


def _number(random: Random) -> sp.Rational:
    return sp.Rational(random.randint(1, _LARGEST) * random.choice((-1, 1)), random.randint(1, _LARGEST))


class _Energies:
    """The energies of bodies per unit of each parameter, at states of rational numbers."""

    def __init__(self, system: Equations, bodies: Sequence[Any], field: Sequence[sp.Expr]) -> None:
        c, self.c, self.bodies, self.field = system.c, system.c, bodies, field
        self.balls = system.ball_joints
        self.frames, self.steps = frames_of(*(body.frame for body in bodies)), list[list[sp.Expr]]()
        for frame in self.frames:
            u = frame.omega or frame.turn_rate
            self.steps.append([*frame.rotation, *u, *frame.shift, *(total_derivative(e, c) for e in frame.shift)])
        moving = {*c.q, *c.v, *(w for joint in self.balls for w in joint.omega)}
        expanded = [[sp.expand_trig(e) for e in step] for step in self.steps]
        everything = [*(e for step in expanded for e in step), *field]
        if any(t in e.free_symbols for e in everything):
            raise InputError("base_parameters: the joints move with time: give them coordinates")
        atoms = {a for e in everything for a in e.atoms(sp.sin, sp.cos)}
        self.angles = {x: sp.Dummy("tau") for x in sorted({a.args[0] for a in atoms}, key=sp.default_sort_key)}
        turning = [x for x in self.angles if x.free_symbols & moving]
        if near := [(x, y) for x in turning for y in turning if x != y and (x / y).is_Rational]:
            raise InputError(
                f"base_parameters: the angles {near[0][0]} and {near[0][1]}: use their common divisor as coordinate"
            )
        circle = {f: g for x, s in self.angles.items() for f, g in _circle(x, s).items()}
        numbers = {
            a for e in everything for a in e.atoms(sp.NumberSymbol, sp.Function) if a.is_number and a not in circle
        }
        self.constants = {sp.Dummy("c"): a for a in sorted(numbers, key=sp.default_sort_key)}
        circle |= {a: s for s, a in self.constants.items()}
        self.steps = [[e.xreplace(circle) for e in step] for step in expanded]
        self.field = [e.xreplace(circle) for e in field]
        every = [*(e for step in self.steps for e in step), *self.field]
        self.turning = {self.angles[x] for x in turning}
        self.roots = {p for e in every for p in e.atoms(sp.Pow) if p.is_number}
        self.moving = moving | self.turning
        self.exact = dict[int, Any]()  # energies at states, by number, with the letters of the system
        self.letters = sorted(set().union(*(e.free_symbols for e in every)) - self.moving, key=str)

    def domain(self, letters: Sequence[sp.Symbol]) -> Any:
        """Return the field of rational numbers with the roots in the steps, and with letters."""
        base = construct_domain([*self.roots, sp.S.One], field=True, extension=True)[0]
        return base.frac_field(*letters) if letters else base

    def state(self, random: Random) -> dict[sp.Symbol, sp.Expr]:
        """Return a random rational state; ball joints get a unit quaternion."""
        state = {s: _number(random) for s in sorted(self.moving, key=str)}
        for joint in self.balls:
            p = sp.Matrix([_number(random) for _ in range(3)])
            square = p.dot(p)
            state |= dict(zip(joint.quaternion, ((1 - square) / (1 + square), *(2 * p / (1 + square))), strict=True))
        return state

    def rows(self, states: Sequence[Mapping[Any, Any]], K: Any, letters: Mapping[Any, Any]) -> list[list[Any]]:
        """Return the kinetic energy, and the potential energy less its first value, per unit of each parameter."""
        rows, first = list[list[Any]](), None
        for state in states:
            kinetic, potential = self._row({**letters, **state}, K)
            first = first or potential
            rows += [kinetic, [a - b for a, b in zip(potential, first, strict=True)]]
        return rows

    def _row(self, numbers: Mapping[Any, Any], K: Any) -> tuple[list[Any], list[Any]]:
        zero, half = [K.zero] * 3, K.from_sympy(sp.S.Half)
        field = [K.from_sympy(e.xreplace(numbers)) for e in self.field] or zero
        # Each frame has ω, the velocity v of its origin, the field of weight g, and the depth g·r of its origin.
        places = dict[Any, tuple[list[Any], list[Any], list[Any], Any]]()
        for frame, step in zip(self.frames, self.steps, strict=True):
            x = [K.from_sympy(e.xreplace(numbers)) for e in step]
            w, v, g, depth = places.get(frame.parent, (zero, zero, field, K.zero))
            v = [p + r + d for p, r, d in zip(v, _cross(w, x[12:15]), x[15:], strict=True)]
            depth = depth + _dot(g, x[12:15])
            w, v, g = ([_dot(x[k:9:3], e) for k in range(3)] for e in (w, v, g))
            places[frame] = [p + r for p, r in zip(w, x[9:12], strict=True)], v, g, depth
        kinetic, potential = list[Any](), list[Any]()
        for body in self.bodies:
            w, v, g, depth = places.get(body.frame, (zero, zero, field, K.zero))
            kinetic += [_dot(v, v) * half, *_cross(v, w)]
            kinetic += [w[i] * w[j] * (half if i == j else K.one) for i, j in _ENTRIES]
            potential += [-depth, *(-e for e in g), *[K.zero] * 6]
        return kinetic, potential

    def solve(self, columns: Sequence[int], j: int, rows: Sequence[Sequence[Any]], states: Any) -> list[sp.Expr]:
        """Solve column j as a combination of independent columns, with the symbols of the system as letters."""
        base, K, n = self.domain(()), self.domain(self.letters), len(columns)
        numbers = DomainMatrix([[row[k] for row in rows] for k in columns], (n, len(rows)), base)
        chosen = numbers.rref()[1]  # the first independent rows
        exact = list[list[Any]]()
        for i in chosen:
            for k in {0, i // 2} - self.exact.keys():
                self.exact[k] = self._row(states[k], K)
            (kinetic, potential), (_, first) = self.exact[i // 2], self.exact[0]
            exact.append([potential[k] - first[k] if i % 2 else kinetic[k] for k in (*columns, j)])
        solved = DomainMatrix(exact, (n, n + 1), K).rref()[0].to_Matrix()[:, n]
        back = {s: sp.tan(x / 2) for x, s in self.angles.items()} | self.constants
        return [sp.factor(e).xreplace(back) for e in solved]


def _circle(angle: sp.Expr, tau: sp.Symbol) -> dict[sp.Expr, sp.Expr]:
    """Return cosine and sine of an angle by the tangent of its half."""
    return {sp.cos(angle): (1 - tau**2) / (1 + tau**2), sp.sin(angle): 2 * tau / (1 + tau**2)}


def _cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def _dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
