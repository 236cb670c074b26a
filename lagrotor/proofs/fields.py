"""A `System`, `Scene`, `Structure` or generated `Program` as a motion with its initial set, and as the subject of a theorem.

The subject is plain data of a certificate: the numbers of a scene or structure, or the text of a Lagrangian or of rates. It
is None where the text cannot be read back; a digest of the program then identifies the motion.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from itertools import chain
from operator import add, mul, neg, sub, truediv
from typing import Any

import numpy as np
import sympy as sp

from lagrotor.errors import ConstraintError, InputError, SingularError
from lagrotor.mechanics.equations import Equations, no_states
from lagrotor.mechanics.expressions import in_order, repeated_name
from lagrotor.mechanics.lagrangian import Coordinates, coordinates, t
from lagrotor.mechanics.running.programs import constrained_motion, depends_on_time
from lagrotor.models.programs.minimal_program import FORCE, observation, program
from lagrotor.numerics import operation_recorder
from lagrotor.numerics.codegen import Program, Stage
from lagrotor.numerics.operation_recorder import Recorded, Term
from lagrotor.pair.lagrangians import INERTIAS, J_OF
from lagrotor.pair.notation import AXES, G_1, G_2, I1, I3, J, K, M, R, a, b, ell, k, m
from lagrotor.pair.scene import Scene
from lagrotor.proofs.balls import ZERO, Ball, Balls, arb, arb_mat, arb_poly, exact, fmpq, rational
from lagrotor.proofs.matrices import identity, inside, times
from lagrotor.proofs.statements import has_upright_size
from lagrotor.proofs.tape import Tape, tape_of
from lagrotor.proofs.taylor_step import Motion
from lagrotor.proofs.truncated_series import Evaluation, TaylorModel, series_values
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Coefficients, coefficients_in
from lagrotor.structures.exact.compiled_motion import structure_accelerations
from lagrotor.structures.exact.exact_motion import off_constraints, rates_of_constraints

Values = Mapping[Any, Any]
Subject = dict[str, Any] | None
_EXPRESSION, _LONGEST = re.compile(r"^\d|[\s+*/().-]"), 20_000  # a symbol's name that is an expression; characters


def ball(value: Any, where: str = "value") -> Ball:
    """Return the ball of a number, a pair (lowest, highest) or an expression of numbers, at the current precision.

    Raises InputError if the value is none of these, or not finite.
    """
    if isinstance(value, tuple | list) and len(value) == 2:
        low, high = (ball(end, where) for end in value)
        if low > high:
            raise InputError(f"{where} = {value!r}: the lowest value comes first")
        return low.union(high)
    if isinstance(value, arb):
        number = value
    elif isinstance(value, sp.Expr) and not value.is_Number and value.is_number:
        number = series_values(tape_of(Program((), (), (value,))), [])[0]
    else:
        meant = rational(value, where)
        number = arb(fmpq(meant.numerator, meant.denominator))
    if not number.is_finite():
        raise InputError(f"{where} = {value} must be a finite real number")
    return number


def in_rationals(e: sp.Basic) -> sp.Basic:
    """Replace decimals by the rational numbers that they denote."""
    return e.xreplace({x: sp.Rational(str(rational(x, "a number"))) for x in e.atoms(sp.Float)})


def with_rationals(system: Equations) -> Equations:
    """Replace the decimals of a system by rational numbers, so that the derivation of its equations rounds nothing."""
    acting = {name: getattr(system, name) for name in ("constraints", "rolling", "forces")}
    terms: dict[str, Any] = {name: tuple(map(in_rationals, expressions)) for name, expressions in acting.items()}
    whole = (system.L, system.dissipation, *chain(*acting.values()))
    if not any(e.has(sp.Float) for e in whole):
        return system
    return replace(system, lagrangian=in_rationals(whole[0]), dissipation=in_rationals(whole[1]), **terms)


def scene_subject(scene: Scene) -> Subject:
    data = asdict(scene)
    return {"scene": {name: data[name] for name in ("spins", "rotor", "link", "shock")}}


def structure_subject(s: Assembly) -> Subject:
    return {"structure": asdict(s)}


def system_subject(system: Equations, arguments: Sequence[str]) -> Subject:
    """Return the Lagrangian, all forces and all constraints as text; None if the checker cannot read it.

    `letters` lists the symbols that occur in this text alone.
    """
    terms = system.L, *system.acting
    letters = set().union(*(map(str, e.free_symbols) for e in terms))
    acting = ("constraints", "rolling", "forces")
    data: dict[str, Any] = {name: [str(e) for e in getattr(system, name)] for name in acting}
    data |= {"L": str(system.L), "dissipation": str(system.dissipation), "letters": sorted(letters - {*arguments})}
    readable = _readable(terms, [*arguments, *data["letters"]])
    return {"Lagrangian": data} if readable else None


def program_subject(program: Program) -> Subject:
    rates = [in_rationals(e) for e in program.outputs]
    readable = not program.stages and _readable(rates, [str(s) for s in program.arguments])
    return {"rates": [str(e) for e in rates]} if readable else None


def _readable(expressions: Sequence[sp.Expr], names: Sequence[str]) -> bool:
    """Return True if the checker can read the text of the expressions."""
    if any(_EXPRESSION.search(name) for name in names) or any(len(str(e)) > _LONGEST for e in expressions):
        return False
    used: set[Any] = set().union(*(e.free_symbols for e in expressions))
    try:
        tape_of(Program(tuple(used), (), tuple(expressions)))
    except InputError:
        return False
    return True


@dataclass(frozen=True)
class Field:
    """The equations of motion of a system, with its initial set.

    `program` computes the rates of the states from the states and parameters. `values` are balls of the parameters, `start`
    balls of the states. `stages` are common subexpressions of the observables. `observables` gives symbols that stand for
    expressions of the states. The expressions in `constraints` stay zero.
    """

    program: Program
    values: Mapping[sp.Symbol, Ball]
    start: tuple[Ball, ...]
    stages: tuple[Stage, ...] = ()
    observables: Mapping[sp.Symbol, sp.Expr] | None = None
    constraints: tuple[sp.Expr, ...] = ()
    subject: Subject = None

    @property
    def states(self) -> tuple[sp.Symbol, ...]:
        return self.program.arguments[: len(self.program.outputs)]

    @cached_property
    def varying(self) -> tuple[sp.Symbol, ...]:
        """The parameters that are intervals."""
        return tuple(s for s in self.program.arguments[len(self.states) :] if is_interval(self.values[s]))

    @cached_property
    def arguments(self) -> tuple[sp.Symbol, ...]:
        """The states, then the interval parameters, then the other parameters."""
        parameters = self.program.arguments[len(self.states) :]
        return (*self.states, *self.varying, *(s for s in parameters if s not in self.varying))

    @cached_property
    def motion(self) -> Motion:
        """The rates of the states as a tape, with the values of the fixed parameters."""
        fixed = self.arguments[len(self.states) + len(self.varying) :]
        return Motion(tape_of(replace(self.program, arguments=self.arguments)), tuple(self.values[s] for s in fixed))

    @cached_property
    def start_set(self) -> tuple[Balls, Balls]:
        """The initial states and interval parameters, as an exact middle and the spread about it."""
        middle: Balls = []
        spread: Balls = []
        for x in (*self.start, *(self.values[s] for s in self.varying)):
            at = exact(x) if is_interval(x) else x
            middle.append(at)
            spread.append(x - at if is_interval(x) else ZERO)
        return middle, spread

    def function(self, expressions: Sequence[sp.Expr]) -> Tape:
        """Return a tape that computes expressions of states and observables from the motion's arguments."""
        observables = self.observables or {}
        symbols = {*self.arguments, *observables, *(name for name, _ in self.stages)}
        for e in expressions:
            if unknown := sorted(map(str, sp.sympify(e, strict=True).free_symbols - symbols)):
                names = ", ".join(map(str, (*self.states, *observables)))
                raise InputError(f"proofs: {e} contains the unknown {', '.join(unknown)}; the motion has {names}")
        functions = [sp.sympify(e, strict=True).xreplace(dict(observables)) for e in expressions]
        return tape_of(Program(self.arguments, self.stages, tuple(functions), shared=True))


def is_interval(x: Ball) -> bool:
    """Return True if a ball is meant as an interval, because it is much wider than a rounding error."""
    return not x.is_exact() and x.rel_accuracy_bits() < 40 and float(x.rad()) > 1e-25


def values_at(tape: Tape, arguments: Sequence[Ball], derivatives: bool = False) -> Any:
    """Enclose the outputs of a tape at balls of its arguments; with `derivatives`, return also the Jacobian matrix."""
    evaluation = Evaluation(tape, [TaylorModel(arb_poly([x]), ZERO, 1) for x in arguments])
    values = [f.poly[0] for f in evaluation.outputs]
    if not derivatives:
        return values
    rows = [[g.poly[0] if g is not None else ZERO for g in evaluation.gradient(i)] for i in range(len(values))]
    return values, rows


def field_of(system: Any, values: Values | None = None, q0: Any = None, v0: Any = None) -> Field:
    """Return the field of a system with its initial set. Raises InputError if an argument does not fit the system."""
    if isinstance(system, Scene):
        if values or q0 is not None or v0 is not None:
            raise InputError("proofs: a Scene has its own values and start: give the time alone")
        return scene_field(system)
    if isinstance(system, Assembly):
        return structure_field(system, q0, v0)
    if isinstance(system, Equations):
        return system_field(system, values or {}, q0, v0)
    if isinstance(system, Program):
        n = len(system.outputs)
        start = _numbers("start", [*(q0 if q0 is not None else ()), *(v0 if v0 is not None else ())], n)
        return Field(system, _values(system.arguments[n:], values or {}), start, subject=program_subject(system))
    raise InputError(f"proofs: {system!r} must be a System, a Scene, a Structure or a Program")


def _numbers(name: str, values: Any, n: int) -> tuple[Ball, ...]:
    entries = list(values) if values is not None else []
    if len(entries) != n:
        raise InputError(f"proofs: {name} must be {n} numbers or pairs (lowest, highest), not {len(entries)}")
    return tuple(ball(x, f"{name}[{i}]") for i, x in enumerate(entries))


def _values(parameters: Sequence[sp.Symbol], values: Values) -> dict[sp.Symbol, Ball]:
    by_name = {str(key): value for key, value in values.items()}
    if twice := repeated_name(values):
        raise InputError(f"proofs: values give {twice} twice, as a symbol and as a name: give one")
    if missing := [str(p) for p in parameters if str(p) not in by_name]:
        raise InputError(f"proofs: {', '.join(missing)} has no value: give values = {{symbol: number, …}}")
    return {p: ball(by_name[str(p)], str(p)) for p in parameters}


def system_field(system: Equations, values: Values, q0: Any, v0: Any) -> Field:
    """Return the field of a Lagrangian system with the states (q, v), and t if the equations contain it; t starts at 0."""
    if system.velocities:
        speeds = ", ".join(map(str, system.speeds))
        raise InputError(f"proofs: the system is written in {speeds}, quasi-velocities: leave them out")
    no_states("proofs", system, "a field of a System has none: give a Program of all first-order equations")
    system = with_rationals(system)
    n, timed = len(system.c.q), depends_on_time(system)
    stages, accelerations, _ = constrained_motion(system)
    outputs = (*system.c.v, *accelerations, *((sp.S.One,) if timed else ()))
    states = (*system.c.q, *system.c.v, *((t,) if timed else ()))
    constraints = (*system.constraints, *system.residual)
    internal = {name for name, _ in stages} | {*states}
    used = set().union(*(e.free_symbols for e in (*outputs, *constraints)), *(e.free_symbols for _, e in stages))
    named = {s for s in {*system.L.free_symbols, *system.dissipation.free_symbols} if str(s) in {*map(str, values)}}
    parameters = tuple(sorted((used | named) - internal, key=str))
    q0, v0 = in_order("proofs: q0", q0, system.c.q), in_order("proofs: v0", v0, system.c.v)
    start = (*_numbers("q0", q0, n), *_numbers("v0", v0, n), *((ZERO,) if timed else ()))
    program = Program((*states, *parameters), tuple(stages), outputs, shared=len(stages) > 100)
    about = system_subject(system, [*map(str, program.arguments)])
    field = Field(program, _values(parameters, values), start, constraints=constraints, subject=about)
    return start_on_constraints(field) if constraints else field


def scene_field(scene: Scene) -> Field:
    """Return the field of the pair with the states (U, chi, alpha, rates), and t if needed.

    The bar is eliminated, and a shock acts at all times.
    """
    if scene.link is None:
        raise SingularError("proofs: the scene has no bar to eliminate; take the two rotors as a Structure")
    exactly = scene_numbers(scene)
    massive, body = exactly[b] != 0, scene.shock.body if scene.shock else 0
    ratio = scene_ratio(scene)
    generated, numbers = program(massive, ratio, body), dict(exactly)
    if scene.shock:
        at, width = exact_number(scene.shock.at), exact_number(scene.shock.width)
        pulse = sp.exp(-(((t - at) / width) ** 2))
        numbers |= {F: exact_number(f) * pulse for F, f in zip(FORCE, scene.shock.force, strict=True)}
        generated = replace(generated, outputs=(*generated.outputs, sp.S.One))
    timed = (t,) if scene.shock else ()
    states = (*generated.arguments[:6], *timed)
    stages = tuple((name, e.xreplace(numbers)) for name, e in generated.stages)
    whole = Program(states, stages, tuple(e.xreplace(numbers) for e in generated.outputs))
    look = observation(ratio)
    renamed = {name: sp.Symbol(f"seen_{name}", real=True) for name, _ in look.stages}
    observables = dict(zip((*AXES.q, *AXES.v), (e.xreplace(renamed) for e in look.outputs), strict=True))
    looked = tuple((renamed[name], e.xreplace(numbers | renamed)) for name, e in look.stages)
    start = (*scene_start(scene), *((ZERO,) if timed else ()))
    return Field(whole, {}, start, looked, observables, (), scene_subject(scene))


def scene_numbers(scene: Scene) -> dict[sp.Symbol, sp.Rational]:
    """Return a, b, k, G_1, G_2 of a scene with a bar, exactly."""
    rotor, link = scene.rotor, scene.link
    if link is None:
        raise SingularError("proofs: the scene has no bar")
    of = {M: rotor.mass, R: rotor.length, I1: rotor.I1, I3: rotor.I3, ell: link.length, m: link.mass, K: link.inertia}
    numbers = {s: exact_number(x) for s, x in of.items()}
    numbers[J] = J_OF.xreplace(numbers)
    spins = [exact_number(x) * numbers[I3] for x in scene.spins]
    inertias = {s: e.xreplace(numbers) for s, e in INERTIAS.items()}
    return {a: inertias[a], b: inertias[b], k: numbers[ell] / numbers[R], G_1: spins[0], G_2: spins[1]}


def scene_ratio(scene: Scene) -> Any:
    """Return 'equal', 'short' or 'long', the result of a comparison of the bar's length with the length of an axis."""
    value = scene_numbers(scene)[k]
    return "equal" if value == 1 else "short" if value < 1 else "long"


def scene_start(scene: Scene) -> tuple[Ball, ...]:
    """Return (U, chi, alpha, rates) of the scene's axes.

    chi follows from the twist between the axes; the bar determines their other difference.
    """
    value, ratio = ball(scene_numbers(scene)[k]), scene_ratio(scene)
    u, alpha, u_v, alpha_v = [], [], [], []
    for i, (axis, rate) in enumerate(zip(scene.axes, scene.rates, strict=True)):
        (x, y, z), (p, q, w) = ([ball(c) for c in vector] for vector in (axis, rate))
        square = y * y + z * z
        if not z > 0:
            raise SingularError(f"proofs: axis {i + 1} is not above the ground: start where z > 0")
        u.append((x / (square + x * x).sqrt()).atanh())
        alpha.append((-y / z).atan())
        u_v.append(p / square)
        alpha_v.append((y * w - z * q) / square)
    twist, twist_v, w = alpha[1] - alpha[0], alpha_v[1] - alpha_v[0], u[0] - u[1]
    chi, chi_v, Delta = twist, twist_v, twist
    if ratio == "short":
        rho, c, s = value * w.cosh() - w.sinh(), twist.cos(), twist.sin()
        chi = (s / rho).atan()
        chi_v = (rho / c * twist_v + s / c * (u_v[0] - u_v[1])) / ((rho * rho + s * s) / (c * c))
        Delta = (value * chi.sin()).asin()
    middle = (u[0] + u[1]) / 2, chi, alpha[0] + Delta / 2
    return (*middle, (u_v[0] + u_v[1]) / 2, chi_v, (alpha_v[0] + alpha_v[1]) / 2)


_ARITHMETIC = {"+": add, "-": sub, "*": mul, "/": truediv}
_OPERATIONS: dict[str, Callable[..., sp.Expr]] = {**_ARITHMETIC, "neg": neg, "sqrt": sp.sqrt}


def exact_number(x: Any) -> sp.Rational:
    """Return the rational number that the decimal of a float denotes."""
    value = rational(x, "Structure")
    return sp.Rational(value.numerator, value.denominator)


def exact_coefficients(s: Assembly) -> Coefficients:
    """Return the coefficients of a structure as rational numbers; only the length of a brace may be a root."""
    if any(s.hinge):
        raise InputError("proofs: a hinge's moment θ/sin θ has no rigorous series here; leave the hinges out")
    ell = np.array([_bar(s, *bar) for bar in s.bars], dtype=object)
    return coefficients_in(s, np.vectorize(exact_number, otypes=[object]), ell, np.frompyfunc(sp.sqrt, 1, 1))


def _bar(s: Assembly, i: int, j: int, ell: float) -> sp.Expr:
    """Return the length of a bar; if it is a rounded distance of the upright tips, return that distance exactly, as a root."""
    if not has_upright_size(asdict(s), i, j, ell):
        return exact_number(ell)
    ends = [[*map(exact_number, (*s.joints[k], s.rotor[k].length))] for k in (i, j)]
    return sp.sqrt(sum((x - y) ** 2 for x, y in zip(*ends, strict=True)))


def structure_coordinates(s: Assembly) -> Coordinates:
    """Return coordinates x_0 y_0 z_0 x_1 …, the components of the axes; rotors are counted from 0."""
    return coordinates(" ".join(f"{axis}_{i}" for i in range(len(s.joints)) for axis in "xyz"))


def structure_program(s: Assembly) -> tuple[Program, tuple[sp.Expr, ...]]:
    """Return the program (r, r'[, t]) → (r', r''[, 1]) of a structure, and the expressions that stay zero.

    These are |r_i|² − 1, |d|² − ell², and half of the rates of both.
    """
    c, axes = exact_coefficients(s), structure_coordinates(s)
    N, timed, tape = len(c.R), any(x != 0 for x in c.decay), list[Recorded]()
    of_time = {f"G_{i}": G * sp.exp(-k * t) for i, (G, k) in enumerate(zip(c.G, c.decay, strict=True)) if k}
    recorded = ([Recorded(tape, str(x)) for x in components] for components in (axes.q, axes.v))
    r, v = ([row[3 * i : 3 * i + 3] for i in range(N)] for row in recorded)
    G = [Recorded(tape, f"G_{i}") if f"G_{i}" in of_time else G for i, G in enumerate(c.G)]
    accelerations = structure_accelerations(c, r, v, G, operation_recorder)
    leaves = {str(x): x for x in (*axes.q, *axes.v)} | of_time
    stages, rates = _stages(tape, leaves, accelerations)
    arguments = (*axes.q, *axes.v, *((t,) if timed else ()))
    outputs = (*axes.v, *rates, *((sp.S.One,) if timed else ()))
    return Program(arguments, tuple(stages), outputs, shared=True), _constraints(c, axes)


def _stages(
    tape: Sequence[Recorded], leaves: Mapping[str, sp.Expr], outputs: Sequence[Term]
) -> tuple[list[Stage], list[sp.Expr]]:
    """Convert recorded operations to stages (symbol, expression), and return them with the outputs; constants are exact."""
    stages, values = list[Stage](), dict[Recorded, sp.Expr]()

    def expression(x: Any) -> sp.Expr:
        return values[x] if isinstance(x, Recorded) else x if isinstance(x, sp.Expr) else exact_number(x)

    for x in tape:
        values[x] = _OPERATIONS[x.kind](*map(expression, x.operands)) if x.operands else leaves[x.kind]
        if x.operands and x.kind != "neg" and not values[x].is_Atom:
            stages.append((sp.Symbol(f"w_{len(stages)}", real=True), values[x]))
            values[x] = stages[-1][0]
    return stages, [expression(x) for x in outputs]


def _constraints(c: Coefficients, axes: Coordinates) -> tuple[sp.Expr, ...]:
    r, v = (np.array(components, dtype=object).reshape(-1, 3) for components in (axes.q, axes.v))
    return (*off_constraints(c, r), *rates_of_constraints(c, r, v))


def structure_field(s: Assembly, tilt: Any, rates: Any) -> Field:
    """Return the field of a structure with the states axes (3 N), rates (3 N), and t if needed.

    `tilt` has x and y of each axis, or unit vectors.
    """
    program, constraints = structure_program(s)
    n = 3 * len(s.joints)
    if len(constraints) > 2 * len(s.joints) and tilt is not None:
        from lagrotor.structures.exact.structure_run import simulate_structure

        run = simulate_structure(s, [0.0], tilt, rates)
        tilt, rates = run.axes[:, 0], run.rates[:, 0]
    r, v = _axes("tilt", tilt, len(s.joints)), _axes("rates", rates, len(s.joints))
    q: Balls = []
    w: Balls = []
    for i, (place, rate) in enumerate(zip(r, v, strict=True)):
        if len(place) == 2:
            square = 1 - place[0] * place[0] - place[1] * place[1]
            if not square > 0:
                raise InputError(f"proofs: tilt of rotor {i} must be inside the unit circle")
            place = [*place, square.sqrt()]
        if len(rate) == 2:
            rate = [*rate, -(place[0] * rate[0] + place[1] * rate[1]) / place[2]]
        q += place
        w += rate
    start = (*q, *w, *(ZERO,) * (len(program.outputs) - 2 * n))
    return start_on_constraints(Field(program, {}, start, constraints=constraints, subject=structure_subject(s)))


def _axes(name: str, values: Any, N: int) -> list[Balls]:
    if values is None:
        return [[ZERO, ZERO] for _ in range(N)]
    rows = [list(row) for row in values]
    if len(rows) != N or {len(row) for row in rows} - {2, 3}:
        raise InputError(f"proofs: {name} must be {N} rows of two or three numbers")
    return [[ball(x, name) for x in row] for row in rows]


def start_on_constraints(field: Field) -> Field:
    """Enclose a start on the constraints: the given one if it satisfies them, else one near it by the Krawczyk test.

    Raises ConstraintError if no state within 1e-6 is proved to satisfy them.
    """
    constraints = field.function(field.constraints)
    values = [*(field.values[s] for s in field.arguments[len(field.states) :])]
    residual = values_at(constraints, [*field.start, *values])
    if all(x.contains(0) and (float(x.rad()) < 1e-25 or any(map(is_interval, field.start))) for x in residual):
        return field
    middle = [exact(x) for x in field.start]
    for _ in range(3):
        misses, rows = values_at(constraints, [*middle, *values], True)
        slope = np.array([[float(x.mid()) for x in row[: len(middle)]] for row in rows])
        inverse = np.linalg.pinv(slope, rcond=1e-9)
        step = inverse @ np.array([float(x.mid()) for x in misses])
        middle = [exact(x - arb(float(d))) for x, d in zip(middle, step, strict=True)]
    B = arb_mat(len(middle), len(misses), inverse.ravel().tolist())
    w = [arb(0, 1e-13)] * len(misses)
    box = [x + d for x, d in zip(middle, times(B, w), strict=True)]
    at = values_at(constraints, [*middle, *values])
    _, rows = values_at(constraints, [*box, *values], True)
    slope = identity(len(misses)) - arb_mat([row[: len(middle)] for row in rows]) * B
    narrow = [x - y for x, y in zip(times(slope, w), at, strict=True)]
    far = max(float(abs(x - y).upper()) for x, y in zip(middle, field.start, strict=True))
    if far > 1e-6 or not inside(narrow, w):
        raise ConstraintError(
            f"proofs: the start is off the constraints by {max(float(abs(x).upper()) for x in residual):.2g}, and no state on "
            "them is proved within 1e-6; system.consistent gives a start on them"
        )
    start = [x + d for x, d in zip(middle, times(B, narrow), strict=True)]
    return replace(field, start=tuple(start))
