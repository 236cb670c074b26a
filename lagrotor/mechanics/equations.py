"""The equations of motion of a Lagrangian system with forces, friction and constraints, which may depend on time.

    M a + h = Q + Gᵀ λ,        G v + b = 0,        G a + γ = 0.

The generalised forces Q are the applied forces less ∂D/∂v of Rayleigh's dissipation function D. The rows of G, b and γ
belong to the holonomic constraints g(q, t) = 0 (row ∂g/∂q, b = ∂g/∂t), and after them to the rolling constraints
f(q, v, t) = 0, which are affine in the velocities (row ∂f/∂v, b = f at v = 0). γ is the part without a of the second time
derivative of g, and of the first of f.

Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., §§1.4, 1.5, 2.4, 2.7; Neimark & Fufaev, Dynamics of
Nonholonomic Systems, ch. III.
"""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import sympy as sp

from lagrotor.algebra import decide_zero, derivative
from lagrotor.algebra.evidence import points
from lagrotor.algebra.name_clashes import check_names
from lagrotor.algebra.subexpressions import free_letters
from lagrotor.errors import InputError, SingularError
from lagrotor.mechanics import lagrangian as free
from lagrotor.mechanics.expressions import expression, no_coordinate, put_in, shortest
from lagrotor.mechanics.lagrangian import (
    NO_COORDINATES,
    Coordinates,
    dependent_rows,
    depends_on,
    gradient,
    is_affine,
    jacobian,
    linear_solve,
    singular_mass,
    t,
    total_derivative,
)
from lagrotor.mechanics.quasi_velocities import Kinematics, Pairs, boltzmann_hamel, check_velocities, kinematics
from lagrotor.renamed import old_attribute

_FAST = 1000  # the factor on random velocities at which friction must have increased


class PlacedForces(tuple[sp.Expr, ...]):
    """The generalised forces of a system, and `loads`, the loads on frames that cause them; None if these are unknown."""

    loads: tuple[Any, ...] | None = ()

    @classmethod
    def of(
        cls, forces: Any, entries: Iterable[sp.Expr], each: Callable[[sp.Expr], sp.Expr] = lambda e: e
    ) -> "PlacedForces":
        """Return the entries with the loads of `forces`, to which the function `each` is applied."""
        placed, loads = cls(entries), getattr(forces, "loads", ())
        placed.loads = loads and tuple(load.each(each) for load in loads)
        return placed


@dataclass(frozen=True)
class Equations:
    """The equations of motion of a Lagrangian with constraints, friction and forces; `System` describes the fields."""

    c: Coordinates = NO_COORDINATES
    lagrangian: sp.Expr = sp.S.Zero
    constraints: tuple[sp.Expr, ...] = ()
    rolling: tuple[sp.Expr, ...] = ()
    dissipation: sp.Expr = sp.S.Zero
    forces: tuple[sp.Expr, ...] = ()
    names: tuple[str, ...] = ()
    velocities: Mapping[sp.Symbol, sp.Expr] | Pairs = ()
    states: Mapping[sp.Symbol, sp.Expr] | Pairs = ()

    if not TYPE_CHECKING:
        __getattr__ = old_attribute

    def __post_init__(self) -> None:
        if not isinstance(self.c, Coordinates):
            raise InputError(
                f"System: {self.c!r}, the first argument, must be Coordinates: make them with coordinates('theta phi')"
            )
        for name in ("constraints", "rolling", "forces"):
            entries = getattr(self, name)
            if isinstance(entries, Mapping) and name != "forces":
                self._name(name, entries)
                entries = tuple(entries.values())
            if isinstance(entries, str) or not isinstance(entries, Sequence | sp.MatrixBase):
                way = f": write ({entries},)" if isinstance(entries, sp.Expr) else ""
                raise InputError(f"System: {name} = {entries} must be a tuple of expressions{way}")
            checked = tuple(expression(f"System: {name}[{i}]", e) for i, e in enumerate(entries))
            object.__setattr__(self, name, PlacedForces.of(entries, checked) if name == "forces" else checked)
        object.__setattr__(self, "dissipation", expression("System: dissipation", self.dissipation))
        self._take_states()
        self._take_velocities()
        if not self.bodies:  # energies of bodies are multiplied out only when needed
            object.__setattr__(self, "lagrangian", expression("System: L", self.lagrangian))
        if self.forces and len(self.forces) != len(self.c.q):
            raise InputError(
                f"System: {len(self.forces)} forces for {len(self.c.q)} coordinates: Q has one component for each "
                "coordinate; give 0 where no force acts"
            )
        moving = (*self.c.q, *self.c.v, *self.c.a)
        no_coordinate("System: L", self.lagrangian_parts, moving)
        no_coordinate("System: a force or a constraint", self.acting, moving)
        check_names("System", *self._letters)
        self._check_symbols()
        self._check_reactions()
        self._check_joints()
        _ = self.kinematics

    def _take_states(self) -> None:
        """Store the first-order states as pairs (x, f), f the rate of x."""
        given: Any = self.states if isinstance(self.states, Mapping | tuple) else {0: 0}
        states, moving = dict(given), {*self.c.q, *self.c.v, *self.c.a, t}
        if not all(isinstance(x, sp.Symbol) and x not in moving for x in states):
            way = "a dictionary {x: rate of x}, each x a symbol that is no coordinate, velocity or time"
            raise InputError(f"System: states = {self.states!r} must be {way}")
        if not states and not self.c.q:
            raise InputError("System: no coordinates and no states: give System(c, L) or System(states={x: rate})")
        pairs = tuple((x, expression(f"System: states[{x}]", f)) for x, f in states.items())
        object.__setattr__(self, "states", pairs)

    def _take_velocities(self) -> None:
        """Store all quasi-velocities as pairs (u, expression in v), also those of ball joints, and express the fields by v."""
        joints = self.ball_joints
        turns = dict.fromkeys((joint.quaternion, joint.omega) for joint in joints)
        letters = [s for group in turns for symbols in group for s in symbols]
        if twice := [s for s, times in Counter(letters).items() if times > 1]:
            raise InputError(
                f"System: {twice[0]} is in two ball joints: give each four coordinates and three velocities of its own"
            )
        for body in self.bodies if letters else ():
            if used := {*letters} & (body.mass.free_symbols | body.inertia.free_symbols | body.centre.free_symbols):
                raise InputError(
                    f"System: {min(map(str, used))} is a velocity of a ball joint and a symbol of a body: rename one"
                )
        named = {u: e for joint in joints for u, e in joint.ball_velocities.items()}
        definitions = dict(check_velocities(self.c, self.velocities, named))
        joint_of = {q: joint for joint in joints for q in joint.quaternion}
        if joints and not definitions:
            for q, v in zip(self.c.q, self.c.v, strict=True):
                definitions |= joint_of[q].ball_velocities if q in joint_of else {v: v}
        for joint in joints:
            definitions |= joint.ball_velocities
            if joint.unit_length not in self.constraints:
                object.__setattr__(self, "constraints", (*self.constraints, joint.unit_length))
                if self.names:
                    first = len(self.constraints) - 1
                    unit = f"unit {joint.quaternion[0]}"
                    object.__setattr__(self, "names", (*self.names[:first], unit, *self.names[first:]))
        pairs = check_velocities(self.c, definitions)
        quasi = {u: e for u, e in pairs if u != e}
        object.__setattr__(self, "velocities", pairs)
        if not quasi:
            return
        for name in ("constraints", "rolling"):
            object.__setattr__(self, name, tuple(e.xreplace(quasi) for e in getattr(self, name)))
        forces = PlacedForces.of(self.forces, (e.xreplace(quasi) for e in self.forces))
        object.__setattr__(self, "forces", forces)
        object.__setattr__(self, "dissipation", self.dissipation.xreplace(quasi))
        object.__setattr__(self, "states", tuple((x, f.xreplace(quasi)) for x, f in self.states))
        if hasattr(self.lagrangian, "xreplace"):
            object.__setattr__(self, "lagrangian", self.lagrangian.xreplace(quasi))

    @property
    def ball_joints(self) -> list[Any]:
        """The frames of the ball joints that carry bodies, from the ground outward."""
        steps = (frame for body in self.bodies for frame in reversed(body.frame.to_the_ground))
        return list(dict.fromkeys(frame for frame in steps if frame.omega))

    def _name(self, field: str, named: Mapping[Any, Any]) -> None:
        """Store the names of the constraints in one field. Constraints in the other field keep their names, or get numbers."""
        if wrong := [name for name in named if not isinstance(name, str) or not name.strip() or name in self.names]:
            raise InputError(
                f"System: {wrong[0]!r} in {field} is no name, or is in use: give {{name: expression}}, each name once"
            )
        labels, first = tuple(named), len(self.constraints)
        numbers = tuple(str(i + 1) for i in range(first + len(self.rolling)))
        names = self.names or numbers
        renamed = (*labels, *names[first:]) if field == "constraints" else (*names[:first], *labels)
        object.__setattr__(self, "names", renamed)

    def _check_symbols(self) -> None:
        velocities, higher = {*self.c.v}, {*self.c.a}
        for name in ("constraints", "rolling", "forces"):
            for i, e in enumerate(getattr(self, name)):
                _free_of(
                    f"{name}[{i}]",
                    e.free_symbols,
                    higher,
                    "accelerations follow from the equations; write it without them",
                )
                if name == "constraints":
                    way = "a holonomic constraint depends on coordinates and time alone; integrate it, or give it to rolling"
                    _free_of(f"constraints[{i}]", e.free_symbols, velocities, way)
                    if not depends_on(e, self.c.q):
                        raise InputError(f"System: constraints[{i}]: {e} = 0 binds no coordinate: leave it out")
                elif name == "rolling":
                    if not e.free_symbols & velocities:
                        raise InputError(f"System: rolling[{i}] = {e} has no velocity: give it to constraints")
                    if not depends_on(e, self.c.v):
                        raise InputError(f"System: rolling[{i}]: {e} = 0 binds no velocity: leave it out")
                    if not is_affine(e, self.c.v):
                        raise InputError(
                            f"System: rolling[{i}] = {e} is not affine in the velocities: its reaction is not defined by "
                            "d'Alembert's principle; write it as sum_j A_j(q, t) v_j + b(q, t)"
                        )
        way = "a Lagrangian depends on q, v and t; add the total derivative that removes them"
        _free_of("L", self.letters, higher, way)
        _free_of("dissipation", self.dissipation.free_symbols, higher, "D depends on q, v and t alone")
        if self.dissipation != 0 and not self.dissipation.free_symbols & velocities:
            raise InputError(
                f"System: dissipation = {self.dissipation} has no velocity: it is Rayleigh's function D(q, v) with the "
                "force −∂D/∂v, k v**2/2 for linear friction"
            )
        for x, f in self.states:
            _free_of(f"the rate of {x}", f.free_symbols, higher, "x' depends on q, v, x and t alone")
        fixed = (*self.constraints, *self.rolling, *(e for _, e in self.velocities))
        if wrong := self.letters.union(*(e.free_symbols for e in fixed)) & {*dict(self.states)}:
            raise InputError(
                f"System: the state {min(map(str, wrong))} is in L, a constraint or a velocity: its rate would enter their time "
                "derivatives; write its force into forces, or make it a coordinate"
            )
        check_friction("System", self.dissipation, self.c)
        symbols = self.letters.union(*(e.free_symbols for e in (*self.forces, *self.residual)))
        if reserved := sorted(str(s) for s in symbols if re.fullmatch(r"_a\d+", str(s))):
            raise InputError(
                f"System: {', '.join(reserved)}: generated programs use names like _a0; choose other names"
            )

    @property
    def acting(self) -> tuple[sp.Expr, ...]:
        """The expressions of constraints, rolling, dissipation, forces and rates of states."""
        return (*self.constraints, *self.rolling, self.dissipation, *self.forces, *(f for _, f in self.states))

    def _check_reactions(self) -> None:
        """Raise InputError for a symbol reaction(name) that names no constraint, or that is outside forces and dissipation."""
        names = self.multiplier_names
        places = (*self.constraints, *self.rolling, *(e for _, e in (*self.velocities, *self.states)))
        elsewhere = self.letters.union(*(e.free_symbols for e in places))
        for s in sorted(set().union(elsewhere, *(e.free_symbols for e in self.acting)), key=str):
            name = str(s)[len("reaction(") : -1] if str(s).startswith("reaction(") else None
            if name is not None and (s in elsewhere or name not in names):
                what = "may stand in forces and dissipation alone" if name in names else "names no constraint"
                raise InputError(
                    f"System: {s} {what}: the constraints have the names {', '.join(names) or '(none)'}; name them by "
                    "{name: expression}"
                )

    def _check_joints(self) -> None:
        """Raise InputError if two joints, or a joint and a constraint, have the same given name."""
        steps = dict.fromkeys(step for body in self.bodies for step in body.frame.to_the_ground)
        times = Counter([*self.names, *(step.name for step in steps if step.name)])
        if twice := [name for name, number in times.items() if number > 1]:
            raise InputError(f"System: two joints or constraints have the name {twice[0]}: rename one")

    @property
    def multiplier_names(self) -> tuple[str, ...]:
        """The names of the constraints and then of the rolling constraints, or their numbers from 1."""
        return self.names or tuple(str(i + 1) for i in range(len(self.constraints) + len(self.rolling)))

    @property
    def _letters(self) -> tuple[Any, ...]:
        """The symbols and expressions of the system, in groups; across all of them a name belongs to one symbol."""
        moving = self.c.q, self.c.v, self.c.a, t
        return *moving, self.acting, self.velocities, self.states, self.letters

    @property
    def lagrangian_parts(self) -> tuple[sp.Expr, ...]:
        """The Lagrangian; if it is made of bodies, the expressions in their energies, which are not multiplied out."""
        lagrangian: Any = self.lagrangian
        return (lagrangian.remainder, *lagrangian.parts) if self.bodies else (lagrangian,)

    @cached_property
    def letters(self) -> set[sp.Symbol]:
        """The symbols in the Lagrangian."""
        return set().union(*map(free_letters, self.lagrangian_parts))

    @cached_property
    def L(self) -> sp.Expr:
        """The Lagrangian as an expression."""
        return expression("System: L", self.lagrangian) if self.bodies else self.lagrangian

    @property
    def speeds(self) -> tuple[sp.Symbol, ...]:
        """The velocities u of a state (q, u): the quasi-velocities, or v if the system has none."""
        return tuple(u for u, _ in self.velocities) or self.c.v

    @property
    def variables(self) -> tuple[sp.Symbol, ...]:
        """The components of a state: the coordinates q, the velocities u and the first-order states x."""
        return (*self.c.q, *self.speeds, *dict(self.states))

    @property
    def speed_rates(self) -> tuple[sp.Symbol, ...]:
        """The time derivatives u' of `speeds`: symbols u_dot; the accelerations a if there are no quasi-velocities."""
        return tuple(sp.Symbol(f"{u}_dot", real=True) for u, _ in self.velocities) or self.c.a

    @cached_property
    def kinematics(self) -> Kinematics | None:
        """The relation v = B u + b between v and the quasi-velocities; None if the system has no quasi-velocities."""
        if not self.velocities:
            return None
        units = [self.constraints.index(joint.unit_length) for joint in self.ball_joints]
        first = [*units, *range(len(self.constraints), len(self.residual))]
        return kinematics(self.c, tuple(self.velocities), self.constraints, self.residual, first)

    @property
    def left(self) -> tuple[int, ...]:
        """The indices of the constraints that have multipliers; quasi-velocities satisfy the other constraints by themselves."""
        return self.kinematics.left if self.kinematics else tuple(range(len(self.residual)))

    @property
    def bodies(self) -> tuple[Any, ...]:
        """The rigid bodies of which the Lagrangian is made; () for a plain expression."""
        return tuple(getattr(self.lagrangian, "bodies", ()))

    @property
    def momenta(self) -> sp.Matrix:
        """The conjugate momenta p = ∂L/∂v in q, v and t, shape (n, 1)."""
        return free.momenta(self.L, self.c)

    @cached_property
    def mass_matrix(self) -> sp.Matrix:
        """The mass matrix M = ∂²L/∂v∂v, shape (n, n): M a = forcing + Gᵀ λ.

        It belongs to the velocities v, also in a system with quasi-velocities. The entries are not simplified:
        mass_matrix.applyfunc(sympy.trigsimp) shortens them.
        """
        return free.mass_matrix(self.L, self.c).as_immutable()

    @cached_property
    def bias(self) -> sp.Matrix:
        """The bias h = (∂²L/∂v∂q) v + ∂²L/∂v∂t − ∂L/∂q, shape (n, 1)."""
        return free.bias(self.L, self.c).as_immutable()

    @property
    def forcing(self) -> sp.Matrix:
        """The column Q − h, shape (n, 1): M a = forcing + Gᵀ λ along a motion.

        It contains the multipliers only as far as `forces` contain reactions. It is in q, v and t, also with quasi-velocities.
        """
        return self.generalised_forces - self.bias

    @cached_property
    def accelerations(self) -> sp.Matrix:
        """The accelerations a in q, v and t, shape (n, 1). Under constraints they hold at states that satisfy these.

        Use them for small systems, since the adjugate of M grows fast with n; `System.rhs` computes them in numbers.
        SingularError is raised if det M vanishes identically, or if the constraints are dependent.
        """
        return constrained_accelerations(self)[0].as_immutable()

    @property
    def generalised_forces(self) -> sp.Matrix:
        """The generalised forces Q, shape (n, 1): `forces` less ∂D/∂v."""
        return free.force_column(self.forces or None, self.c, "System") - gradient(self.dissipation, self.c.v)

    @cached_property
    def residual(self) -> sp.Matrix:
        """The constraints on velocities G v + b, shape (k, 1): holonomic ones differentiated, then rolling ones."""
        rows = [*(total_derivative(g, self.c) for g in self.constraints), *self.rolling]
        return sp.ImmutableMatrix(len(rows), 1, rows)

    @cached_property
    def rows(self) -> sp.Matrix:
        """The Jacobian G of the constraints, shape (k, n)."""
        return jacobian(self.residual, self.c.v).as_immutable()

    @cached_property
    def gamma(self) -> sp.Matrix:
        """The column γ of d/dt `residual` = G a + γ, shape (k, 1)."""
        still = dict.fromkeys(self.c.a, sp.S.Zero)
        return self.residual.applyfunc(lambda e: put_in(total_derivative(e, self.c), still))

    @cached_property
    def multipliers(self) -> tuple[sp.Symbol, ...]:
        """The symbols of the multipliers in `motion` and `power`, one for each constraint.

        A symbol is lambda_ with the name or number of its constraint, or Lambda_ if the system already has such a symbol. It
        is `reaction(name)` if the forces contain that.
        """
        names = [name.replace(" ", "_") for name in self.multiplier_names]
        names = names if len({*names}) == len(names) else list(self.multiplier_names)
        letters = self.letters.union(self.c.q, self.c.v, self.c.a, *(e.free_symbols for e in self.acting))
        stem = "Lambda" if {f"lambda_{name}" for name in names} & {str(s) for s in letters} else "lambda"
        plain = (sp.Symbol(f"{stem}_{name}", real=True) for name in names)
        return tuple(symbol if symbol in letters else s for symbol, s in zip(self.reactions, plain, strict=True))

    @property
    def reactions(self) -> tuple[sp.Symbol, ...]:
        """The symbol `reaction(name)` of each constraint."""
        return tuple(map(reaction, self.multiplier_names))

    @cached_property
    def motion(self) -> sp.Matrix:
        """The equations of motion M a + h − Q − Gᵀ λ, shape (n, 1), zero along a motion."""
        lam = sp.Matrix(len(self.multipliers), 1, self.multipliers)
        return (free.euler_lagrange(self.L, self.c) - self.generalised_forces - self.rows.T * lam).as_immutable()

    @cached_property
    def hamel(self) -> sp.Matrix:
        """The Boltzmann–Hamel equations in quasi-velocities, shape (m, 1), zero along a motion.

        They are M u' + h − Bᵀ Q − (G' B)ᵀ λ with u' = `speed_rates`: see `quasi_velocities`. InputError is raised if the
        system has no quasi-velocities, or if v as a function of them is too long to write out.
        """
        relation = self.kinematics
        if relation is None or relation.stages:
            lack = (
                "has no velocities of its own: give velocities={…}"
                if relation is None
                else "is too long in its own velocities: use motion, whose equations contain v"
            )
            raise InputError(f"hamel: the system {lack}")
        velocities = dict(zip(self.c.v, relation.velocity, strict=True))
        M, h = boltzmann_hamel(self.L, self.c, relation, self.speeds)
        lam = sp.Matrix(len(relation.left), 1, [self.multipliers[i] for i in relation.left])
        reactions = rows_left(self)[0].T * lam
        forces = relation.B.T * self.generalised_forces + reactions
        return M * sp.Matrix(self.speed_rates) + h - forces.xreplace(velocities)

    @property
    def energy(self) -> sp.Expr:
        """The Jacobi integral E = v·∂L/∂v − L; `power` is dE/dt."""
        return shortest(free.energy(self.L, self.c))

    @property
    def power(self) -> sp.Expr:
        """The rate dE/dt = Q·v − λ·b − ∂L/∂t along a motion, in q, v, t and the multipliers."""
        drift = -self.residual.subs(dict.fromkeys(self.c.v, 0))
        work = sum((lam * b for lam, b in zip(self.multipliers, drift, strict=True)), sp.S.Zero)
        by_time = derivative(self.L, t)
        push = self.generalised_forces.dot(self.c.v) if self.c.q else sp.S.Zero
        return push + work - (0 if decide_zero(by_time).answer == "zero" else by_time)


def time_derivative(system: Equations, e: sp.Expr) -> sp.Expr:
    """Return de/dt in q, v, a, t and the first-order states, with the rates of these put in."""
    return sp.Add(total_derivative(e, system.c), *(derivative(e, x) * f for x, f in system.states))


def no_states(where: str, system: Equations, why: str) -> None:
    """Raise InputError if a system has first-order states, for which an analysis is not defined."""
    if system.states:
        names = ", ".join(str(x) for x, _ in system.states)
        raise InputError(f"{where}: the system has first-order states ({names}), and {why}")


def reaction(name: str | int) -> sp.Symbol:
    """Return the symbol of the multiplier of a constraint, for forces and dissipation.

    Coulomb friction on a floor is dissipation = μ reaction("floor") |v|; in a guide that can push to both sides it is μ
    |reaction("wire")| |v|.

    Parameters
    ----------
    name : str or int
        The name of the constraint, or its number from 1.

    Returns
    -------
    Symbol
        The multiplier λ. If the constraint is a gap in m, λ is the normal force in N.
    """
    return sp.Symbol(f"reaction({name})", real=True)


def push_left(system: Equations, push: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
    """Split forces that are affine in the multipliers: return Q at λ = 0 and ∂Q/∂λ, with one column for each multiplier."""
    lam = [system.multipliers[i] for i in system.left]
    by_reaction = jacobian(list(push), lam) if lam else sp.zeros(push.rows, 0)
    active = push.xreplace(dict.fromkeys(lam, sp.S.Zero))
    if wrong := (by_reaction.free_symbols | active.free_symbols) & {*system.multipliers}:
        way = (
            "quasi-velocities satisfy its constraint, which has no multiplier; leave these velocities out"
            if min(wrong, key=str) not in lam
            else ("it must enter linearly, or by its size |λ| in a run")
        )
        raise InputError(f"System: {min(wrong, key=str)} in forces: {way}")
    return active, by_reaction


def rows_left(system: Equations) -> tuple[sp.Matrix, sp.Matrix]:
    """Return G' and γ' of G' u' + γ' = 0, the constraints with multipliers as conditions on the rates u'."""
    relation = system.kinematics
    if relation is None:
        return system.rows, system.gamma
    every = list(range(len(system.c.q)))
    G, gamma = system.rows.extract(list(relation.left), every), system.gamma.extract(list(relation.left), [0])
    return G * relation.B, G * relation.alpha + gamma


def constrained_accelerations(system: Equations) -> tuple[sp.Matrix, sp.Matrix]:
    """Return the accelerations and multipliers at a state that satisfies the constraints.

    With S = G M⁻¹ Gᵀ they are λ = −S⁻¹ (G M⁻¹ (Q − h) + γ) and a = M⁻¹ (Q − h + Gᵀ λ). The adjugates grow fast with n.

    Parameters
    ----------
    system : System
        A small system.

    Returns
    -------
    tuple of Matrix
        a and λ, shapes (n, 1) and (k, 1).

    Raises
    ------
    SingularError
        If det M or det S vanishes identically.

    Examples
    --------
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("x y")
    >>> slide = System(c, (c.x_dot**2 + c.y_dot**2) / 2 - 8 * c.y, constraints=(c.y - c.x,))
    >>> constrained_accelerations(slide)[0].T
    Matrix([[-4, -4]])
    """
    # cos² + sin², left in M, would fill det S of a body that rolls with thousands of terms.
    M, G = (_short(e) if system.residual else e for e in (system.mass_matrix, system.rows))
    if not system.c.q:
        return sp.zeros(0, 1), sp.zeros(0, 1)
    if system.ball_joints:
        raise SingularError(
            "accelerations: the mass matrix is singular along the length of a quaternion (det M = 0): "
            "take the rates of the quasi-velocities from rhs(values)"
        )
    push, by_reaction = push_left(replace(system, velocities=()), system.generalised_forces)
    # M⁻¹ (Q − h) and W = M⁻¹ Gᵀ side by side, so that M is inverted once.
    right = (push - system.bias).row_join(G.T + by_reaction)
    solved = linear_solve(M, right, singular_mass("accelerations", M, system.c))
    if not system.residual:
        return solved, sp.zeros(0, 1)
    unbound, W = _short(solved[:, :1]), _short(solved[:, 1:])
    lam = -linear_solve(_short(G * W), _short(G * unbound + system.gamma), dependent_rows("accelerations", "det S = 0"))
    return unbound + W * lam, lam


def _short(matrix: sp.Matrix) -> sp.Matrix:
    return matrix.applyfunc(shortest)


def degrees_of_freedom(system: Equations, at: Mapping[sp.Symbol, float]) -> int:
    """Count the degrees of freedom n − rank G at one configuration.

    Parameters
    ----------
    system : System
        The system.
    at : mapping
        {symbol: number} for each symbol of G.

    Returns
    -------
    int
        n minus the number of singular values of G above rounding errors.
    """
    G = system.rows.subs(dict(at))
    if G.free_symbols:
        raise InputError(
            f"degrees_of_freedom: {', '.join(sorted(map(str, G.free_symbols)))} without a value: "
            "the rank of G belongs to one configuration; give every symbol a number"
        )
    import numpy as np

    k, n = G.shape
    return n - int(np.linalg.matrix_rank(np.array(G.tolist(), dtype=float))) if k else n


def check_friction(where: str, dissipation: sp.Expr, c: Coordinates) -> None:
    """Raise InputError if D(q, v, t) is below D(q, 0, t) at great velocities: −∂D/∂v would drive the motion.

    D is evaluated at random states for several random sets of parameters. It is refused if it falls for every set.
    """
    moving = dissipation.free_symbols & {*c.q, *c.v, t}
    falls = [
        _falling(put_in(dissipation, {s: abs(x) if s.is_negative is None else x for s, x in letters.items()}), c)
        for letters in points(dissipation.free_symbols - moving)
    ]
    if None not in falls:
        raise InputError(
            f"{where}: dissipation = {dissipation} falls as the velocities grow, as at {falls[0]}: its force −∂D/∂v would "
            "feed the motion; k v**2/2 with a positive k is linear friction, and driving forces belong into forces"
        )


def _falling(dissipation: sp.Expr, c: Coordinates) -> str | None:
    """Return a random state, in words, at which D is below its value at rest; None if there is none."""
    for point in points(dissipation.free_symbols):
        still, fast = ({s: x * scale if s in c.v else x for s, x in point.items()} for scale in (0, _FAST))
        if (put_in(dissipation, fast) - put_in(dissipation, still)).evalf(15).is_negative:
            return ", ".join(f"{s} = {float(x):.3g}" for s, x in fast.items())
    return None


def _free_of(name: str, inside: set[sp.Symbol], unwanted: set[sp.Symbol], way: str) -> None:
    if inside & unwanted:
        raise InputError(f"System: {name} contains {', '.join(sorted(map(str, inside & unwanted)))}: {way}")
