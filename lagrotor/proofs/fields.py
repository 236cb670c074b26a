"""A `System`, a `Scene`, a `Structure` or a generated `Program` as a motion with its start, and as the subject of a theorem.

The subject is plain data of a certificate: the numbers of a scene or structure, a Lagrangian or rates in words. It is None where
the words cannot be read again: then a digest of the program stands for it.
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
from lagrotor.mechanics.equations import Equations
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
from lagrotor.proofs.statements import as_upright
from lagrotor.proofs.tape import Tape, tape_of
from lagrotor.proofs.taylor_step import Motion
from lagrotor.proofs.truncated_series import Evaluation, Tailed, series_values
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Coefficients, coefficients_in
from lagrotor.structures.exact.compiled_motion import structure_accelerations
from lagrotor.structures.exact.exact_motion import off_constraints, rates_of_constraints

Values = Mapping[Any, Any]
Subject = dict[str, Any] | None
_EXPRESSION, _LONGEST = re.compile(r"^\d|[\s+*/().-]"), 20_000  # a name that is one; characters


def ball(value: Any, where: str = "value") -> Ball:
    """Return the ball of a number, a pair (lowest, highest) or an expression of numbers, at the precision in force.

    Raises
    ------
    InputError
        If the value is none of these, or not finite.
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
    """Decimals as the rational numbers that they mean."""
    return e.xreplace({x: sp.Rational(str(rational(x, "a number"))) for x in e.atoms(sp.Float)})


def exactly_meant(system: Equations) -> Equations:
    """The system with its decimals as rational numbers, so that none is rounded when its equations are derived."""
    acting = {name: getattr(system, name) for name in ("constraints", "rolling", "forces")}
    parts: dict[str, Any] = {name: tuple(map(in_rationals, each)) for name, each in acting.items()}
    whole = (system.L, system.dissipation, *chain(*acting.values()))
    if not any(e.has(sp.Float) for e in whole):
        return system
    return replace(system, lagrangian=in_rationals(whole[0]), dissipation=in_rationals(whole[1]), **parts)


def of_scene(scene: Scene) -> Subject:
    """Spins, rotor, bar and shock."""
    data = asdict(scene)
    return {"scene": {name: data[name] for name in ("spins", "rotor", "link", "shock")}}


def of_structure(s: Assembly) -> Subject:
    """All that it is made of."""
    return {"structure": asdict(s)}


def of_system(system: Equations, arguments: Sequence[str]) -> Subject:
    """The Lagrangian and what else acts, in words; letters: those that are in the words alone."""
    terms = system.L, *system.acting
    letters = set().union(*(map(str, e.free_symbols) for e in terms))
    data: dict[str, Any] = {
        name: [str(e) for e in getattr(system, name)] for name in ("constraints", "rolling", "forces")
    }
    data |= {"L": str(system.L), "dissipation": str(system.dissipation), "letters": sorted(letters - {*arguments})}
    known = _readable(terms, [*arguments, *data["letters"]])
    return {"Lagrangian": data} if known else None


def of_program(program: Program) -> Subject:
    """The rates in words."""
    rates = [in_rationals(e) for e in program.outputs]
    known = not program.stages and _readable(rates, [str(s) for s in program.arguments])
    return {"rates": [str(e) for e in rates]} if known else None


def _readable(expressions: Sequence[sp.Expr], letters: Sequence[str]) -> bool:
    """Whether the second program reads their words."""
    if any(_EXPRESSION.search(name) for name in letters) or any(len(str(e)) > _LONGEST for e in expressions):
        return False
    used: set[Any] = set().union(*(e.free_symbols for e in expressions))
    try:
        tape_of(Program(tuple(used), (), tuple(expressions)))
    except InputError:
        return False
    return True


@dataclass(frozen=True)
class Field:
    """The motion of a system.

    program: (states, parameters) → rates of the states; put: exact values of parameters that are in the equations as numbers;
    values: balls of the others; start: balls of the states; seen: stages of what is observed, and held: what stays zero;
    about: of what theorems are.
    """

    program: Program
    values: Mapping[sp.Symbol, Ball]
    start: tuple[Ball, ...]
    stages: tuple[Stage, ...] = ()
    seen: Mapping[sp.Symbol, sp.Expr] | None = None
    held: tuple[sp.Expr, ...] = ()
    about: Subject = None

    @property
    def states(self) -> tuple[sp.Symbol, ...]:
        """The states, in order."""
        return self.program.arguments[: len(self.program.outputs)]

    @cached_property
    def varying(self) -> tuple[sp.Symbol, ...]:
        """Parameters that are intervals."""
        return tuple(s for s in self.program.arguments[len(self.states) :] if wide(self.values[s]))

    @cached_property
    def arguments(self) -> tuple[sp.Symbol, ...]:
        """States, then parameters that vary, then the others."""
        rest = self.program.arguments[len(self.states) :]
        return (*self.states, *self.varying, *(s for s in rest if s not in self.varying))

    @cached_property
    def motion(self) -> Motion:
        """Rates of the states, with the fixed parameters' values."""
        fixed = self.arguments[len(self.states) + len(self.varying) :]
        return Motion(tape_of(replace(self.program, arguments=self.arguments)), tuple(self.values[s] for s in fixed))

    @cached_property
    def parts(self) -> tuple[Balls, Balls]:
        """The start with the parameters that vary, as an exact middle and what they are off it."""
        middle: Balls = []
        off: Balls = []
        for x in (*self.start, *(self.values[s] for s in self.varying)):
            at = exact(x) if wide(x) else x
            middle.append(at)
            off.append(x - at if wide(x) else ZERO)
        return middle, off

    def function(self, expressions: Sequence[sp.Expr]) -> Tape:
        """Expressions of states and of what is observed, as a tape of the motion's arguments."""
        seen = self.seen or {}
        known = {*self.arguments, *seen, *(name for name, _ in self.stages)}
        for e in expressions:
            if unknown := sorted(map(str, sp.sympify(e, strict=True).free_symbols - known)):
                names = ", ".join(map(str, (*self.states, *seen)))
                raise InputError(f"proved: {e} has the unknown {', '.join(unknown)}; the motion has {names}")
        put = [sp.sympify(e, strict=True).xreplace(dict(seen)) for e in expressions]
        return tape_of(Program(self.arguments, self.stages, tuple(put), shared=True))


def wide(x: Ball) -> bool:
    """Whether a ball is an interval that was meant, more than what rounding leaves of a number."""
    return not x.is_exact() and x.rel_accuracy_bits() < 40 and float(x.rad()) > 1e-25


def values_at(tape: Tape, arguments: Sequence[Ball], derivatives: bool = False) -> Any:
    """Balls of a tape's outputs at balls of its arguments; with derivatives, and the rows of their derivatives."""
    evaluation = Evaluation(tape, [Tailed(arb_poly([x]), ZERO, 1) for x in arguments])
    found = [f.poly[0] for f in evaluation.outputs]
    if not derivatives:
        return found
    rows = [[g.poly[0] if g is not None else ZERO for g in evaluation.gradient(i)] for i in range(len(found))]
    return found, rows


def field_of(system: Any, values: Values | None = None, q0: Any = None, v0: Any = None) -> Field:
    """The field of a system with its start. Raises InputError for what makes no sense."""
    if isinstance(system, Scene):
        if values or q0 is not None or v0 is not None:
            raise InputError("proved: a Scene has its own values and start: give the time alone")
        return scene_field(system)
    if isinstance(system, Assembly):
        return structure_field(system, q0, v0)
    if isinstance(system, Equations):
        return system_field(system, values or {}, q0, v0)
    if isinstance(system, Program):
        n = len(system.outputs)
        start = _numbers("start", [*(q0 if q0 is not None else ()), *(v0 if v0 is not None else ())], n)
        return Field(system, _values(system.arguments[n:], values or {}), start, about=of_program(system))
    raise InputError(f"proved: {system!r} must be a System, a Scene, a Structure or a Program")


def _numbers(name: str, given: Any, n: int) -> tuple[Ball, ...]:
    entries = list(given) if given is not None else []
    if len(entries) != n:
        raise InputError(f"proved: {name} must be {n} numbers or pairs (lowest, highest), not {len(entries)}")
    return tuple(ball(x, f"{name}[{i}]") for i, x in enumerate(entries))


def _values(parameters: Sequence[sp.Symbol], values: Values) -> dict[sp.Symbol, Ball]:
    by_name = {str(key): value for key, value in values.items()}
    if missing := [str(p) for p in parameters if str(p) not in by_name]:
        raise InputError(f"proved: {', '.join(missing)} without a value: values = {{symbol: number, …}} names each")
    return {p: ball(by_name[str(p)], str(p)) for p in parameters}


def system_field(system: Equations, values: Values, q0: Any, v0: Any) -> Field:
    """(q, v[, t]) of a Lagrangian system; time starts at 0."""
    if system.velocities:
        raise InputError(
            f"proved: the system is written in {', '.join(map(str, system.speeds))}, velocities of its own: leave them out"
        )
    system = exactly_meant(system)
    n, timed = len(system.c.q), depends_on_time(system)
    stages, accelerations, _ = constrained_motion(system)
    outputs = (*system.c.v, *accelerations, *((sp.S.One,) if timed else ()))
    states = (*system.c.q, *system.c.v, *((t,) if timed else ()))
    held = (*system.constraints, *system.residual)
    own = {name for name, _ in stages} | {*states}
    used = set().union(*(e.free_symbols for e in (*outputs, *held)), *(e.free_symbols for _, e in stages))
    named = {s for s in {*system.L.free_symbols, *system.dissipation.free_symbols} if str(s) in {*map(str, values)}}
    parameters = tuple(sorted((used | named) - own, key=str))
    start = (*_numbers("q0", q0, n), *_numbers("v0", v0, n), *((ZERO,) if timed else ()))
    made = Program((*states, *parameters), tuple(stages), outputs, shared=len(stages) > 100)
    about = of_system(system, [*map(str, made.arguments)])
    field = Field(made, _values(parameters, values), start, held=held, about=about)
    return on_constraints(field) if held else field


def scene_field(scene: Scene) -> Field:
    """(U, chi, alpha, rates[, t]) of the pair, the bar eliminated; a shock is in the equations at all times."""
    if scene.link is None:
        raise SingularError("proved: the scene has no bar to eliminate; take the two rotors as a Structure")
    exactly = scene_numbers(scene)
    massive, body = exactly[b] != 0, scene.shock.body if scene.shock else 0
    ratio = scene_ratio(scene)
    made, put = program(massive, ratio, body), dict(exactly)
    if scene.shock:
        at, width = exact_number(scene.shock.at), exact_number(scene.shock.width)
        pulse = sp.exp(-(((t - at) / width) ** 2))
        put |= {F: exact_number(f) * pulse for F, f in zip(FORCE, scene.shock.force, strict=True)}
        made = replace(made, outputs=(*made.outputs, sp.S.One))
    timed = (t,) if scene.shock else ()
    states = (*made.arguments[:6], *timed)
    stages = tuple((name, e.xreplace(put)) for name, e in made.stages)
    whole = Program(states, stages, tuple(e.xreplace(put) for e in made.outputs))
    look = observation(ratio)
    renamed = {name: sp.Symbol(f"seen_{name}", real=True) for name, _ in look.stages}
    seen = dict(zip((*AXES.q, *AXES.v), (e.xreplace(renamed) for e in look.outputs), strict=True))
    looked = tuple((renamed[name], e.xreplace(put | renamed)) for name, e in look.stages)
    return Field(whole, {}, (*scene_start(scene), *((ZERO,) if timed else ())), looked, seen, (), of_scene(scene))


def scene_numbers(scene: Scene) -> dict[sp.Symbol, sp.Rational]:
    """a, b, k, G_1, G_2 of a scene with a bar, exactly."""
    rotor, link = scene.rotor, scene.link
    if link is None:
        raise SingularError("proved: the scene has no bar")
    of = {M: rotor.mass, R: rotor.length, I1: rotor.I1, I3: rotor.I3, ell: link.length, m: link.mass, K: link.inertia}
    put = {s: exact_number(x) for s, x in of.items()}
    put[J] = J_OF.xreplace(put)
    spins = [exact_number(x) * put[I3] for x in scene.spins]
    found = {s: e.xreplace(put) for s, e in INERTIAS.items()}
    return {a: found[a], b: found[b], k: put[ell] / put[R], G_1: spins[0], G_2: spins[1]}


def scene_ratio(scene: Scene) -> Any:
    """How the bar's length compares with an axis."""
    value = scene_numbers(scene)[k]
    return "equal" if value == 1 else "short" if value < 1 else "long"


def scene_start(scene: Scene) -> tuple[Ball, ...]:
    """(U, chi, alpha, rates) of the scene's axes, as `minimal` reads them: the twist is theirs, the rest follows from the bar."""
    value, ratio = ball(scene_numbers(scene)[k]), scene_ratio(scene)
    u, alpha, u_v, alpha_v = [], [], [], []
    for i, (axis, rate) in enumerate(zip(scene.axes, scene.rates, strict=True)):
        (x, y, z), (p, q, w) = ([ball(c) for c in part] for part in (axis, rate))
        square = y * y + z * z
        if not z > 0:
            raise SingularError(f"proved: axis {i + 1} is not above the ground: start where z > 0")
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


_OPERATIONS: dict[str, Callable[..., sp.Expr]] = {
    "+": add,
    "-": sub,
    "*": mul,
    "/": truediv,
    "neg": neg,
    "sqrt": sp.sqrt,
}


def exact_number(x: Any) -> sp.Rational:
    """The rational that a float's decimal means."""
    value = rational(x, "Structure")
    return sp.Rational(value.numerator, value.denominator)


def exact_coefficients(s: Assembly) -> Coefficients:
    """`coefficients` in rationals. A brace's length is that of its ends, as a root."""
    if any(s.hinge):
        raise InputError("proved: a hinge's moment θ/sin θ has no rigorous series here; leave the hinges out")
    ell = np.array([_bar(s, *bar) for bar in s.bars], dtype=object)
    return coefficients_in(s, np.vectorize(exact_number, otypes=[object]), ell, np.frompyfunc(sp.sqrt, 1, 1))


def _bar(s: Assembly, i: int, j: int, ell: float) -> sp.Expr:
    """A bar's length: as it is written or, where that is the rounded distance of the upright tips, this distance."""
    if not as_upright(asdict(s), i, j, ell):
        return exact_number(ell)
    ends = [[*map(exact_number, (*s.joints[k], s.rotor[k].length))] for k in (i, j)]
    return sp.sqrt(sum((x - y) ** 2 for x, y in zip(*ends, strict=True)))


def structure_coordinates(s: Assembly) -> Coordinates:
    """x_0 y_0 z_0 x_1 …: components of the axes' unit vectors, rotors counted from 0."""
    return coordinates(" ".join(f"{letter}_{i}" for i in range(len(s.joints)) for letter in "xyz"))


def structure_program(s: Assembly) -> tuple[Program, tuple[sp.Expr, ...]]:
    """(r, r'[, t]) → (r', r''[, 1]), and the expressions that stay zero: |r_i|² − 1, |d|² − ell² and their rates, halved."""
    c, letters = exact_coefficients(s), structure_coordinates(s)
    N, timed, tape = len(c.R), any(x != 0 for x in c.decay), list[Recorded]()
    of_time = {f"G_{i}": G * sp.exp(-k * t) for i, (G, k) in enumerate(zip(c.G, c.decay, strict=True)) if k}
    r, v = (
        [[Recorded(tape, str(x)) for x in part[3 * i : 3 * i + 3]] for i in range(N)] for part in (letters.q, letters.v)
    )
    G = [Recorded(tape, f"G_{i}") if f"G_{i}" in of_time else G for i, G in enumerate(c.G)]
    accelerations = structure_accelerations(c, r, v, G, operation_recorder)
    leaves = {str(x): x for x in (*letters.q, *letters.v)} | of_time
    stages, rates = _stages(tape, leaves, accelerations)
    arguments = (*letters.q, *letters.v, *((t,) if timed else ()))
    outputs = (*letters.v, *rates, *((sp.S.One,) if timed else ()))
    return Program(arguments, tuple(stages), outputs, shared=True), _held(c, letters)


def _stages(
    tape: Sequence[Recorded], leaves: Mapping[str, sp.Expr], outputs: Sequence[Term]
) -> tuple[list[Stage], list[sp.Expr]]:
    """Each recorded operation as a stage, its constants as they are meant, and the outputs; leaves: what names stand for."""
    stages, known = list[Stage](), dict[Recorded, sp.Expr]()

    def expression(x: Any) -> sp.Expr:
        return known[x] if isinstance(x, Recorded) else x if isinstance(x, sp.Expr) else exact_number(x)

    for x in tape:
        known[x] = _OPERATIONS[x.kind](*map(expression, x.operands)) if x.operands else leaves[x.kind]
        if x.operands and x.kind != "neg" and not known[x].is_Atom:
            stages.append((sp.Symbol(f"w_{len(stages)}", real=True), known[x]))
            known[x] = stages[-1][0]
    return stages, [expression(x) for x in outputs]


def _held(c: Coefficients, letters: Coordinates) -> tuple[sp.Expr, ...]:
    r, v = (np.array(part, dtype=object).reshape(-1, 3) for part in (letters.q, letters.v))
    return (*off_constraints(c, r), *rates_of_constraints(c, r, v))


def structure_field(s: Assembly, tilt: Any, rates: Any) -> Field:
    """The axes (3 N) and their rates (3 N)[, t] of a structure, from x, y of the axes (N, 2) or unit vectors (N, 3)."""
    made, held = structure_program(s)
    n = 3 * len(s.joints)
    if len(held) > 2 * len(s.joints) and tilt is not None:
        from lagrotor.structures.exact.structure_run import simulate_structure

        run = simulate_structure(s, [0.0], tilt, rates)
        tilt, rates = run.axes[:, 0], run.rates[:, 0]
    r, v = _axes("tilt", tilt, len(s.joints)), _axes("rates", rates, len(s.joints))
    q: Balls = []
    w: Balls = []
    for i, (place, rate) in enumerate(zip(r, v, strict=True)):
        if len(place) == 2:
            left = 1 - place[0] * place[0] - place[1] * place[1]
            if not left > 0:
                raise InputError(f"proved: tilt of rotor {i} must be inside the unit circle")
            place = [*place, left.sqrt()]
        if len(rate) == 2:
            rate = [*rate, -(place[0] * rate[0] + place[1] * rate[1]) / place[2]]
        q += place
        w += rate
    timed = (ZERO,) * (len(made.outputs) - 2 * n)
    return on_constraints(Field(made, {}, (*q, *w, *timed), held=held, about=of_structure(s)))


def _axes(name: str, given: Any, N: int) -> list[Balls]:
    if given is None:
        return [[ZERO, ZERO] for _ in range(N)]
    rows = [list(row) for row in given]
    if len(rows) != N or {len(row) for row in rows} - {2, 3}:
        raise InputError(f"proved: {name} must be {N} rows of two or three numbers")
    return [[ball(x, name) for x in row] for row in rows]


def on_constraints(field: Field) -> Field:
    """The start enclosed on the constraints: as it is where it satisfies them, else near it, where Krawczyk's test proves one.

    Raises ConstraintError where none is within 1e-6.
    """
    held = field.function(field.held)
    values = [*(field.values[s] for s in field.arguments[len(field.states) :])]
    residual = values_at(held, [*field.start, *values])
    if all(x.contains(0) and (float(x.rad()) < 1e-25 or any(map(wide, field.start))) for x in residual):
        return field
    middle = [exact(x) for x in field.start]
    for _ in range(3):
        found, rows = values_at(held, [*middle, *values], True)
        slope = np.array([[float(x.mid()) for x in row[: len(middle)]] for row in rows])
        moved = np.linalg.pinv(slope, rcond=1e-9)
        step = moved @ np.array([float(x.mid()) for x in found])
        middle = [exact(x - arb(float(d))) for x, d in zip(middle, step, strict=True)]
    B = arb_mat(len(middle), len(found), moved.ravel().tolist())
    w = [arb(0, 1e-13)] * len(found)
    box = [x + d for x, d in zip(middle, times(B, w), strict=True)]
    at = values_at(held, [*middle, *values])
    _, rows = values_at(held, [*box, *values], True)
    slope = identity(len(found)) - arb_mat([row[: len(middle)] for row in rows]) * B
    narrow = [x - y for x, y in zip(times(slope, w), at, strict=True)]
    far = max(float(abs(x - y).upper()) for x, y in zip(middle, field.start, strict=True))
    if far > 1e-6 or not inside(narrow, w):
        raise ConstraintError(
            f"proved: the start is off the constraints by {max(float(abs(x).upper()) for x in residual):.2g}, and no state on "
            "them is proved within 1e-6; system.consistent gives a start on them"
        )
    start = [x + d for x, d in zip(middle, times(B, narrow), strict=True)]
    return replace(field, start=tuple(start))
