"""The equations of motion as generated programs: state → its derivative, in stages, so that no product is expanded.

The state is (q, u), u the quasi-velocities or v, with t as a last component if time enters explicitly. A stage is a named
intermediate result. The mass matrix, and the Schur complement S = G M⁻¹ Gᵀ of the constraints, are factored as L D Lᵀ; each
element of the factors is a stage.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from keyword import iskeyword
from operator import add
from typing import Any

import numpy as np
import sympy as sp

from lagrotor.algebra.differentiation import along
from lagrotor.algebra.evidence import points
from lagrotor.errors import InputError, SingularError, near
from lagrotor.mechanics.bodies.articulated import joints, tree_accelerations, tree_energy
from lagrotor.mechanics.bodies.small_matrices import Stages
from lagrotor.mechanics.bodies.trees import rest_forces, tree_of
from lagrotor.mechanics.equations import Equations, push_left, rows_left
from lagrotor.mechanics.expressions import longer, unknown_functions, with_jets
from lagrotor.mechanics.lagrangian import clock_parts, dependent_rows, jacobian, singular_mass, t
from lagrotor.mechanics.quasi_velocities import boltzmann_hamel
from lagrotor.mechanics.running.function_values import Array, FunctionValue, jet_name
from lagrotor.mechanics.running.sweeps import swept_energy, swept_equations
from lagrotor.numerics.codegen import Program, Stage, solve_symmetric, tangent_program
from lagrotor.numerics.printers import compile_program, rhs_source
from lagrotor.numerics.source_cache import function_of

LEAST_TREE = 2  # coordinates from which the recursion of a tree takes fewer operations than the mass matrix
_OWN = "s y t I Q rate bare make pulse width begin LOST OutsideError"  # names of generated code
_LONG = 300  # operations of a Lagrangian from which its equations are made by sweeps
_STATES = 3  # random states at which the rank of a matrix is measured
_NEWTON = 20  # steps that bring them onto the constraints
_ROUNDING = 1e-12  # of a matrix with a unit diagonal, in its singular values
FOLLOWED = 1000  # factor of ψ: heyoka scales ψ, on which no rate depends, down to a millionth
MANY = 100  # stages from which common parts of their sums and products are not worth the search


@dataclass(frozen=True)
class Jet:
    """An unknown function in a program, or a derivative of one. `orders` says how often it is differentiated with respect to each
    argument."""

    name: str
    orders: tuple[int, ...]

    def __str__(self) -> str:
        return jet_name(self.name, self.orders)


@dataclass(frozen=True, eq=False)
class Generated:
    """A program (state, parameters) → outputs, for example d(state)/dt, with names that every language accepts. The components of
    the state are `states`: q, u and, if time enters, t. The parameters are the other symbols by name, then the functions that are
    called."""

    program: Program
    states: tuple[sp.Symbol, ...]
    parameters: tuple["sp.Symbol | Jet", ...]

    @cached_property
    def letters(self) -> tuple[str, ...]:
        """The names of the parameters that are numbers."""
        return tuple(str(p) for p in self.parameters if not isinstance(p, Jet))

    @cached_property
    def rhs(self) -> Callable[..., Any]:
        """The function that takes the parameters and returns the right-hand side rhs(t, y)."""
        clock = self.states.index(t) if t in self.states else None
        return function_of(rhs_source(self.program, len(self.states), clock=clock))

    def rate(self, parameters: Sequence[Any], begin: float) -> Callable[..., Any]:
        """Return the right-hand side rhs(s, y) at the time t = begin + s. If t were integrated as a state, it would accumulate
        the rounding errors of all steps."""
        return self.rhs(*parameters, begin) if t in self.states else self.rhs(*parameters)

    @cached_property
    def function(self) -> Callable[..., Any]:
        """The function that takes the arguments, as numbers or arrays, and returns the list of outputs."""
        return compile_program(self.program, "numpy")

    def along(self, values: Mapping[Any, Any], where: str = "simulate") -> Callable[[Array, Array], Array]:
        """Return a function that evaluates the k outputs along a run. It takes states (n, ≥ N + m), which begin with q and u, and
        times (n,), and returns an array (k, n)."""
        function, parameters, d = self.function, parameter_values(self, values, where), len(self.states) - 1

        def outputs(states: Array, times: Array) -> Array:
            with np.errstate(all="ignore"):
                rows = function(*states[:, :d].T, times, *parameters)
            values = np.empty((len(rows), np.size(times)))
            for i, e in enumerate(rows):
                values[i] = e
            return values

        return outputs


@lru_cache(maxsize=64)
def motion_program(system: Equations, followed: tuple[Any, ...] = ()) -> Generated:
    """Generate the right-hand side (q, u[, t], ψ) → (v, u'[, 1], ψ') of a system.

    Parameters
    ----------
    system : Equations
        The system.
    followed : tuple of NarrowPart, default ()
        Narrow terms. For each of them FOLLOWED · ψ is integrated along with the motion, with ψ' = factor · g'.

    Returns
    -------
    Generated
        The program.
    """
    stages, rates, _ = motion_of_speeds(system)
    clock = [sp.S.One] * depends_on_time(system)
    rates = [*rates, *(f for _, f in system.states)]
    moving = {t: sp.S.One} | dict(zip(system.variables, (*system.c.v, *rates), strict=True))
    if (kinematics := system.kinematics) is not None:
        u_dot = sp.Matrix(rates[: len(system.speeds)])
        moving |= dict(zip(system.c.v, kinematics.B * u_dot + kinematics.alpha, strict=True))
    followed_rates = [FOLLOWED * factor * along(g, moving.keys(), moving.values()) for g, factor, _ in followed]
    states = (*state_symbols(system), *(sp.Symbol(f"_followed{i}", real=True) for i in range(len(followed))))
    return _program(states, stages, [*system.c.v, *rates, *clock, *followed_rates], moving=True)


def state_symbols(system: Equations) -> tuple[sp.Symbol, ...]:
    """Return the symbols of a motion's state: q, u, first-order states and, if time enters explicitly, t."""
    return (*system.variables, *((t,) if depends_on_time(system) else ()))


def _program(
    states: tuple[sp.Symbol, ...], stages: Sequence[Stage], outputs: Sequence[sp.Expr], moving: bool = False
) -> Generated:
    """Return the program of a state and parameters whose symbols have new names that every language accepts. The program of a
    motion (`moving`) is evaluated often, so common parts of its sums and products are sought, unless it has more than MANY
    stages."""
    stages, outputs, functions = _with_calls(stages, outputs)
    names = dict.fromkeys(name for name, _ in stages)
    used = set().union(*(e.free_symbols for _, e in stages), *(e.free_symbols for e in outputs)) - names.keys()
    parameters = tuple(sorted(used - {*states}, key=str))
    rename: dict[Any, Any] = {
        s: sp.Symbol(f"y{i}_", real=True)
        for i, s in enumerate((*states, *parameters, *(s for s in names if not s.name.startswith("_"))))
        if not _is_plain(str(s))
    }
    rename |= {c: c.evalf(17) for e in (*(e for _, e in stages), *outputs) for c in e.atoms(sp.NumberSymbol)}

    def put_in(e: sp.Expr) -> sp.Expr:
        e = e.xreplace(rename) if rename else e
        pulses = [p for p in e.atoms(sp.Pow) if isinstance(p.base, sp.cosh) and p.exp.is_negative]
        return e.xreplace({p: sp.sech(*p.base.args) ** -p.exp for p in pulses}) if pulses else e

    numbers = set().union(*(e.atoms(sp.Float, sp.Rational) for e in (*(e for _, e in stages), *outputs)))
    if lost := [c for c in numbers if c != 0 and float(c) in (0.0, math.inf, -math.inf)]:
        raise InputError(
            f"{sp.Float(lost[0], 3)} is outside the range of doubles: write it with symbols, and give them values; from an "
            "exponent with decimals, as in exp(x + 1838.0), sympy separates such a number"
        )
    program = Program(
        (*(rename.get(s, s) for s in (*states, *parameters)), *functions),
        tuple((rename.get(name, name), put_in(e)) for name, e in stages),
        tuple(put_in(e) for e in outputs),
        shared=not moving or len(stages) > MANY,
    )
    return Generated(program, states, (*parameters, *functions.values()))


def _with_calls(
    stages: Sequence[Stage], outputs: Sequence[sp.Expr], calls: Mapping[sp.Symbol, Jet] | None = None
) -> tuple[list[Stage], list[sp.Expr], dict[sp.Symbol, Jet]]:
    """Replace unknown functions and their derivatives by calls. Return the stages, the outputs, and the `Jet` of each symbol that
    is called. `calls` are the functions that are called already."""
    jets = {str(name): jet for name, jet in (calls or {}).items()}
    symbols = {jet: name for name, jet in (calls or {}).items()}

    def called(name: str, orders: tuple[int, ...], arguments: tuple[sp.Expr, ...]) -> sp.Expr:
        called_jet = jets.get(name)
        jet = Jet(called_jet.name, tuple(map(add, called_jet.orders, orders))) if called_jet else Jet(name, orders)
        symbol = symbols.setdefault(jet, sp.Symbol(f"call{len(symbols)}_", real=True))
        return sp.Function(str(symbol))(*arguments)

    stages = [(name, with_jets(e, called)) for name, e in stages]
    outputs = [with_jets(e, called) for e in outputs]
    return stages, outputs, {symbol: jet for jet, symbol in symbols.items()}


def velocities_along(system: Equations, values: Mapping[Any, Any], states: Array, times: Array) -> Array:
    """Return the velocities v, shape (n, N), at states (n, ≥ N + m) that begin with q and u."""
    if system.kinematics is None:
        return states[:, len(system.c.q) : 2 * len(system.c.q)]
    return function_program(system, *system.c.v).along(values)(states, times).T


@lru_cache(maxsize=64)
def rows_program(system: Equations) -> Generated:
    """Generate (q, u, t) → the elements of G, row by row. These are the coefficients of u' in the constraints that multipliers
    enforce."""
    return function_program(system, *rows_left(system)[0])


@lru_cache(maxsize=64)
def mass_program(system: Equations) -> Generated:
    """Generate (q, u, t) → the elements of the mass matrix of u', row by row."""
    stages, M, _ = equations_of_speeds(system)
    return _program((*system.c.q, *system.speeds, t), stages, [*M])


@lru_cache(maxsize=64)
def start_program(system: Equations) -> Generated:
    """Generate (q, u, t) → M, g and ∂g/∂q, then the coefficients of u' and the residuals of the constraints that multipliers
    enforce. M is the mass matrix of the velocities v; for quasi-velocities it is the unit matrix."""
    h, M = len(system.constraints), system.mass_matrix if system.kinematics is None else sp.eye(len(system.speeds))
    residual = [system.residual[i] for i in system.left]
    outputs = [*M, *system.constraints, *system.rows[:h, :], *rows_left(system)[0], *residual]
    return _program((*system.c.q, *system.speeds, t), velocity_stages(system), outputs)


@lru_cache(maxsize=256)
def function_program(system: Equations, *expressions: sp.Expr) -> Generated:
    """Generate (q, u, x, t) → values of expressions in q, v, u, x, t, the accelerations and the multipliers of a motion."""
    states = (*system.variables, t)
    named = dict(zip(system.reactions, system.multipliers, strict=True))
    expressions = tuple(e.xreplace(named) for e in expressions) if named else expressions
    symbols = set().union(*(e.free_symbols for e in expressions))
    if not symbols & {*system.c.a, *system.multipliers}:
        return _program(states, velocity_stages(system), expressions)
    independent = tuple(system.multipliers[i] for i in system.left)
    every = bool(symbols & {*system.multipliers} - {*independent})
    stages, a, lam = constrained_motion(system, every)
    solved = dict(zip((*system.c.a, *(system.multipliers if every else independent)), (*a, *lam), strict=True))
    return _program(states, stages, [e.xreplace(solved) for e in expressions])


def velocity_stages(system: Equations) -> list[Stage]:
    """Return the stages that compute v from the quasi-velocities; an empty list if the system has none."""
    kinematics = system.kinematics
    if kinematics is None:
        return []
    velocities = [(v, e) for v, e in zip(system.c.v, kinematics.velocity, strict=True) if v != e]
    return [*kinematics.stages, *velocities]


@lru_cache(maxsize=64)
def clock_program(system: Equations) -> Generated | None:
    """Generate (t) → the largest parts of the equations of motion that contain only t and parameters. Return None if there are
    none."""
    if not depends_on_time(system):
        return None
    stages, rates, _ = motion_of_speeds(system)
    every = (*system.c.v, *rates, *(f for _, f in system.states))
    clocks, outputs = clock_parts(stages, every, {*system.c.v, *system.variables})
    return _program((t,), clocks, outputs) if outputs else None


@lru_cache(maxsize=64)
def energy_program(system: Equations) -> Generated:
    """Generate (q, u, t) → the Jacobi integral v·∂L/∂v − L."""
    tree = tree_of(system) if len(system.c.q) >= LEAST_TREE else None
    if tree is None and _is_long(system):
        swept, energy = swept_energy(system)
        return _program((*system.c.q, *system.speeds, t), [*velocity_stages(system), *swept], [energy])
    if tree is None:
        return _program((*system.c.q, *system.speeds, t), velocity_stages(system), [system.energy])
    keep = Stages()
    energy = tree_energy(tree, joints(tree, keep), (*system.c.v, *system.speeds), keep)
    return _program((*system.c.q, *system.speeds, t), [*velocity_stages(system), *keep.made], [energy])


def _is_plain(name: str) -> bool:
    """Return True if generated code may use a name: no function of mathematics, no keyword, and no name of a stage."""
    return name.isidentifier() and not (
        iskeyword(name)
        or name in vars(math)
        or name in _OWN.split()
        or name.startswith(("_", "c_"))
        or name.endswith("_")
    )


def depends_on_time(system: Equations) -> bool:
    """Return True if t is in the Lagrangian, a force, the friction, a constraint or a quasi-velocity."""
    expressions = (*system.acting, *(e for _, e in system.velocities))
    return t in system.letters or any(t in e.free_symbols for e in expressions)


def constrained_motion(system: Equations, every: bool = True) -> tuple[list[Stage], list[sp.Expr], list[sp.Expr]]:
    """Return the stages, the accelerations and the multipliers of a motion under constraints. If `every` is true, the multipliers
    include those of constraints that the quasi-velocities satisfy by themselves. They follow from M α + h = Q + Gᵀ λ, by the
    inverse of the joint matrix [A; G] of quasi-velocities and constraints."""
    stages, rates, lam = motion_of_speeds(system)
    kinematics = system.kinematics
    if kinematics is None:
        return stages, rates, lam
    a = kinematics.B * sp.Matrix(rates) + kinematics.alpha
    multipliers = dict(zip(kinematics.left, lam, strict=True))
    if kinematics.used and every:
        reactions = system.rows.extract(list(kinematics.left), list(range(len(a)))).T * sp.Matrix(len(lam), 1, lam)
        push = system.generalised_forces.xreplace({system.multipliers[i]: e for i, e in multipliers.items()})
        missing = kinematics.inverse.T * (system.mass_matrix * a + system.bias - push - reactions)
        multipliers |= dict(zip(kinematics.used, missing[len(rates) :, :], strict=True))
    return stages, list(a), [multipliers[i] for i in sorted(multipliers)]


def motion_of_speeds(system: Equations) -> tuple[list[Stage], list[sp.Expr], list[sp.Expr]]:
    """Return the stages, the accelerations u' and the independent multipliers. They are computed by the recursion of a tree of
    bodies, or else from the mass matrix."""
    if not system.c.q:
        return [], [], []
    G, gamma = rows_left(system)
    friction = bool(system.generalised_forces.free_symbols & {*system.multipliers})
    if (by_tree := tree_motion(system)) is not None:
        return under_constraints(*by_tree, G, gamma, friction)
    (first, _, push), (added, weight, M) = equations_of_speeds(system), inertia(system)
    push, by_reaction = push_left(system, push)
    stages, solved = solve_symmetric(M, (push - G.T * weight * gamma).row_join(G.T + by_reaction), "_m")
    return under_constraints([*first, *added, *stages], solved, G, gamma, friction)


@lru_cache(maxsize=64)
def _is_long(system: Equations) -> bool:
    return longer(system.L, _LONG) and not unknown_functions(system.L)


@lru_cache(maxsize=64)
def equations_of_speeds(system: Equations) -> tuple[list[Stage], sp.Matrix, sp.Matrix]:
    """Return the stages, M and Q − h of the equations M u' = Q − h + Gᵀ λ, in which v may occur. A long Lagrangian is
    differentiated by sweeps. A short one with quasi-velocities gives the Boltzmann–Hamel equations, or their projection if the
    quasi-velocities have stages."""
    if _is_long(system):
        return swept_equations(system)
    kinematics, first = system.kinematics, velocity_stages(system)
    M, push = system.mass_matrix, system.generalised_forces - system.bias
    if kinematics is None:
        return first, M, push
    if kinematics.stages:
        return first, kinematics.B.T * M * kinematics.B, kinematics.B.T * (push - M * kinematics.alpha)
    M, h = boltzmann_hamel(system.L, system.c, kinematics, system.speeds)
    velocities = dict(zip(system.c.v, kinematics.velocity, strict=True))
    return first, M, kinematics.B.T * system.generalised_forces.xreplace(velocities) - h


def tree_motion(system: Equations) -> tuple[list[Stage], sp.Matrix] | None:
    """Return the stages, and a matrix with the columns M⁻¹ (Q − h) and M⁻¹ Gᵀ, by the recursion of a tree of bodies. Return None
    for any other system, or if constraints bind a direction without mass."""
    tree = tree_of(system) if len(system.c.q) >= LEAST_TREE else None
    if tree is None:
        return None
    keep, (G, _), kinematics = Stages(), rows_left(system), system.kinematics
    push = system.generalised_forces + rest_forces(tree, system.c)
    push, by_reaction = push_left(system, push if kinematics is None else kinematics.B.T * push)
    columns = [list(push), *((G.T + by_reaction).col(i).flat() for i in range(G.rows))]
    try:
        solved = sp.Matrix(tree_accelerations(tree, joints(tree, keep), system.speeds, columns, keep)).T
        return [*velocity_stages(system), *keep.made], solved
    except SingularError:
        if not G.rows:
            raise
        return None


@lru_cache(maxsize=64)
def inertia(system: Equations) -> tuple[list[Stage], sp.Matrix, sp.Matrix]:
    """Return the stages of W, the diagonal matrix W, and M + Gᵀ W G. If M is regular, W = 0. Otherwise constraints may bind the
    direction without mass, for example the length of a quaternion. Then (M + Gᵀ W G) a = Q − h − Gᵀ W γ + Gᵀ λ has the same
    solutions and a positive definite matrix. The weight of each row of G is the mean mass divided by the row's squared length.
    Ranks are measured at random states. Raise SingularError if no constraint binds the direction."""
    (stages, M, _), (G, _) = equations_of_speeds(system), rows_left(system)
    if _regular(system, stages, M):
        return [], sp.zeros(G.rows, G.rows), M
    if (mean := M.trace() / M.rows) != 0:
        weights = {sp.Symbol(f"_w{i}", real=True): mean / G[i, :].dot(G[i, :]) for i in range(G.rows)}
        bound = M + G.T * sp.diag(*weights) * G
        if _regular(system, stages, bound.xreplace(weights)):
            return [*weights.items()], sp.diag(*weights), bound
    raise SingularError(singular_mass("System", M, system.c))


def _regular(system: Equations, stages: Sequence[Stage], matrix: sp.Matrix) -> bool:
    """Return True if a symmetric matrix that the stages compute has full rank at one of several random states on the constraints.
    Return True also if it has a finite value at none of them."""
    bound = (*system.constraints, *jacobian(system.constraints, system.c.q))
    program = _program((*system.c.q, *system.speeds, t), stages, [*matrix, *bound])
    letters = (*system.c.q, *system.speeds, t, *(p for p in program.parameters if not isinstance(p, Jet)))
    calls = [
        lambda *at, k=k: np.cos(sum(at) + k)
        for k in range(len(program.parameters) + 1 + len(system.c.q) + len(system.speeds) - len(letters))
    ]
    n, h, m = len(system.c.q), len(system.constraints), matrix.rows
    ranks = []
    for point in points(letters, _STATES):
        at = np.array([float(point[s]) for s in letters])
        for _ in range(_NEWTON if h else 1):
            with np.errstate(all="ignore"):
                numbers = np.array(program.function(*at, *calls), float)
            M, g, slope = np.split(numbers, [m * m, m * m + h])
            if np.isfinite(numbers).all():
                at[:n] -= np.linalg.pinv(slope.reshape(h, n)) @ g
        M = M.reshape(m, m)
        size = np.sqrt(np.abs(np.diag(M)))
        if np.isfinite(M).all():
            M = M / np.outer(size, size) if size.all() else M
            ranks.append(np.linalg.svd(M, compute_uv=False)[-1] > _ROUNDING * np.abs(M).max())
    return any(ranks) or not ranks


def under_constraints(
    stages: list[Stage], solved: sp.Matrix, G: sp.Matrix, gamma: sp.Matrix, friction: bool = False
) -> tuple[list[Stage], list[sp.Expr], list[sp.Expr]]:
    """Return the stages, accelerations and multipliers under the constraints G a + γ = 0. The columns of `solved` are M⁻¹ (Q − h)
    and M⁻¹ (Gᵀ + ∂Q/∂λ)."""
    free, W = solved[:, :1], solved[:, 1:]
    if not G.rows:
        return stages, list(free), []
    S, right_side = G * W, -(G * free + gamma)
    if friction and G.rows > 1:  # S is not symmetric
        S, right_side = S.T * S, S.T * right_side
    solve_stages, lam = constraint_solve(S, right_side, "_s")
    return [*stages, *solve_stages], list(free + W * lam), list(lam)


def constraint_solve(S: sp.Matrix, right: sp.Matrix, prefix: str) -> tuple[list[Stage], sp.Matrix]:
    """Return the stages that solve S x = right for the Schur complement S, and the solution x."""
    try:
        return solve_symmetric(S, right, prefix)
    except SingularError:
        raise SingularError(dependent_rows("System", "det S = 0")) from None


@lru_cache(maxsize=64)
def projection_program(system: Equations) -> Generated:
    """Generate one Newton step onto the constraints, along M⁻¹ Gᵀ: q − M⁻¹ Gᵀ S⁻¹ g, v − M⁻¹ Gᵀ S⁻¹ (G v + b). Rolling
    constraints change only velocities. For quasi-velocities the step is along Gᵀ, as if M were 1."""
    G, n, h = system.rows, len(system.c.q), len(system.constraints)
    if system.kinematics is None:
        added, _, M = inertia(system)
        stages, W = solve_symmetric(M, G.T, "_m")
        stages, rows, V = [*equations_of_speeds(system)[0], *added, *stages], G, W
    else:
        rows, _ = rows_left(system)
        stages, W, V = velocity_stages(system), G.T, rows.T
    moves, speeds = sp.zeros(n, 1), sp.zeros(len(system.speeds), 1)
    if h:
        solve_stages, x = constraint_solve(G[:h, :] * W[:, :h], sp.Matrix(system.constraints), "_h")
        stages, moves = [*stages, *solve_stages], W[:, :h] * x
    if rows.rows:
        solve_stages, x = constraint_solve(rows * V, system.residual.extract(list(system.left), [0]), "_s")
        stages, speeds = [*stages, *solve_stages], V * x
    state = sp.Matrix([*system.c.q, *system.speeds]) - moves.col_join(speeds)
    states = state_symbols(system)
    return _program(states, stages, [*state, *states[len(state) :]])


def tangent_motion(motion: Generated) -> Generated:
    """Return the program of the motion together with its linearisation, (y, δ; parameters) → (f, (∂f/∂y) δ)."""
    d, arguments = len(motion.states), motion.program.arguments
    names = [sp.Symbol(f"d{i}_", real=True) for i in range(d)]
    slopes = {y: [name] for y, name in zip(arguments, names, strict=False)}
    both = tangent_program(motion.program, slopes, (*arguments[:d], *names, *arguments[d:]))
    calls = {s: p for s, p in zip(arguments[d:], motion.parameters, strict=True) if isinstance(p, Jet)}
    stages, outputs, functions = _with_calls(both.stages, both.outputs, calls)
    new_functions = list(functions)[len(calls) :]
    both = replace(both, arguments=(*both.arguments, *new_functions), stages=tuple(stages), outputs=tuple(outputs))
    return Generated(both, (*motion.states, *names), (*motion.parameters, *(functions[s] for s in new_functions)))


def parameter_values(program: Generated, values: Mapping[Any, Any], where: str = "simulate") -> tuple[Any, ...]:
    """Return the values of the program's parameters in its order: numbers, then callables. The keys of `values` are symbols or
    their names."""
    if not isinstance(values, Mapping):
        raise InputError(f"{where}: values = {values!r} must be {{symbol: number, …}}, a dictionary")
    by_name = {str(key): value for key, value in values.items()}
    if len(by_name) < len(values):
        names = [str(key) for key in values]
        twice = sorted({name for name in names if names.count(name) > 1})
        raise InputError(
            f"{where}: values give {', '.join(twice)} twice, under the symbol and under its name: give one"
        )
    if moving := [str(s) for s in program.states if str(s) in by_name]:
        raise InputError(
            f"{where}: values give {', '.join(moving)} a value, which varies in time: give its start by q0, v0 or x0, a time by t"
        )
    if missing := [name for name in program.letters if name not in by_name]:
        misspelt = near(missing[0], by_name.keys() - {str(p) for p in program.parameters})
        raise InputError(
            f"{where}: {', '.join(missing)} without a value: values = {{symbol: number, …}} names each{misspelt}"
        )
    numbers: list[Any] = []
    for name in program.letters:
        try:
            if isinstance(by_name[name], str | bool):
                raise TypeError
            numbers.append(float(by_name[name]))
        except (TypeError, ValueError, OverflowError):
            raise InputError(
                f"{where}: {name} = {by_name[name]!r} must be a number; for a value that varies in time write "
                f'Function("{name}")(t) in the system, with t of lagrotor.mechanics'
            ) from None
        if not abs(numbers[-1]) < float("inf"):
            raise InputError(f"{where}: {name} = {numbers[-1]} must be finite")
    for jet in program.parameters[len(numbers) :]:
        assert isinstance(jet, Jet)
        value = by_name.get(jet.name)
        if not isinstance(value, FunctionValue):
            raise InputError(
                f"{where}: {jet.name} without a value: values = {{{jet.name}: an expression, a callable, a table (x, y)}}"
            )
        numbers.append(value.jet(where, jet.orders))
    return tuple(numbers)
