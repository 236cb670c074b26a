"""Switches of a motion: events, impacts, and the surfaces on which a force jumps.

An impact on a gap g(q, t) ≥ 0 changes the velocities along M⁻¹ Gᵀ alone, G = ∂g/∂q, so that (G v + b)⁺ = −e (G v + b)⁻. All
constraints hold before and after it. Pfeiffer & Glocker, Multibody Dynamics with Unilateral Contacts, ch. 7.

With friction, an impulse Λ acts on the sliding velocities s, too. After the impact either s⁺ = 0 and |Λ| ≤ μ Λ_n, or Λ = −μ Λ_n
s⁺/|s⁺|. Moreau, in: Nonsmooth Mechanics and Applications (1988).

A force with sign(w) or |w| jumps on w = 0. The force −F sign(w) ∂w/∂v is dry friction: it may hold w at zero, with a reaction
of at most F. Any other force that jumps may keep w at zero, if a value of sign(w) between −1 and 1 gives dw/dt = 0. Filippov,
Differential Equations with Discontinuous Righthand Sides, §4.

Dry friction in several directions is −F ∂√Q/∂v, where Q = (v − v₀)ᵀ A (v − v₀) is a quadratic form of rank r. With r independent
rows p of A, Q = wᵀ A_pp⁻¹ w for the sliding velocities w = A_p (v − v₀). At w = 0 the reaction A_pᵀ λ holds while λᵀ A_pp λ ≤ F².
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from random import Random
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero, derivative
from lagrotor.algebra.evidence import points
from lagrotor.algebra.subexpressions import subexpressions
from lagrotor.errors import InputError
from lagrotor.mechanics.equations import Equations, reaction
from lagrotor.mechanics.expressions import expression, put_in, vector_of
from lagrotor.mechanics.lagrangian import Coordinates, depends_on, force_column, gradient, is_affine, jacobian, t


@dataclass(frozen=True)
class Event:
    """An event at the crossings of a section; it ends the run or changes the velocities.

    Attributes
    ----------
    section : Expr
        An expression in q, v and t. The event happens where it crosses zero.
    velocities : tuple of Expr or None, optional
        The velocities after the event, as functions of the state before it; without them the run ends.
    direction : {0, 1, -1}, default 0
        Upward crossings (1), downward ones (−1), or both (0).

    Examples
    --------
    >>> from lagrotor.mechanics import Event, System, coordinates
    >>> c = coordinates("x")
    >>> System(c, c.v[0]**2 / 2).simulate({}, (0,), (1,), [0, 5], events=Event(c.q[0] - 2)).t
    array([0., 2.])
    """

    section: sp.Expr
    velocities: tuple[sp.Expr, ...] | None = None
    direction: int = 0

    def __post_init__(self) -> None:
        object.__setattr__(self, "section", expression("Event: section", self.section))
        if self.direction not in (-1, 0, 1):
            raise InputError(f"Event: direction = {self.direction!r} must be 1 (upward), −1 (downward) or 0 (both)")
        if not self.section.free_symbols:
            raise InputError(
                f"Event: section = {self.section} is a number, which nothing crosses: give q, v or t in it"
            )
        if self.velocities is not None:
            if not isinstance(self.velocities, Sequence | sp.MatrixBase):
                raise InputError(
                    f"Event: velocities = {self.velocities!r} must be a tuple, an expression for each coordinate"
                )
            velocities = vector_of("Event: velocities", self.velocities, len(self.velocities))
            object.__setattr__(self, "velocities", velocities)

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        """All expressions of the event: its section, and the velocities after it."""
        return self.section, *(self.velocities or ())


@dataclass(frozen=True)
class Impact:
    """An impact where a gap closes: the velocity of approach is reversed and multiplied by the coefficient of restitution.

    If nothing rebounds, the gap stays closed, as a constraint, until its reaction would pull.

    Attributes
    ----------
    gap : Expr or Contact
        An expression in q and t that stays at least zero, or the contact of a body, `body.rolls_on(surface, radius)`.
    restitution : Expr, default 1
        The coefficient of restitution, a number from 0 to 1 or a parameter.
    friction : Expr, default 0
        The coefficient of Coulomb friction, in the impact and while the gap is closed. The gap must be a distance in m.
    slip : Expr or sequence of Expr, default ()
        The sliding velocity at the contact in m/s, affine in v: in space two components along perpendicular axes of the
        tangential plane. It is needed if there is friction and `gap` is an expression; a contact knows its sliding velocity.

    Notes
    -----
    The normal velocity obeys Newton's law of restitution. The tangential impulse obeys Coulomb's law with the sliding velocity
    after the impact (Moreau). If both laws together would increase the energy, the run ends at the impact (Kane's paradox).
    Other contacts that are closed take up a normal impulse but no tangential one.

    Examples
    --------
    >>> from lagrotor.mechanics import Impact, System, coordinates
    >>> c = coordinates("x")
    >>> System(c, c.v[0]**2 / 2).simulate({}, (2,), (-1,), [0, 4], events=Impact(c.q[0], 0.5)).q.round(6).T
    array([[2., 1.]])

    A ball that falls without spin strikes the floor with friction, slides and rolls:

    >>> c = coordinates("x y theta")
    >>> ball = System(c, c.x_dot**2 / 2 + c.y_dot**2 / 2 + c.theta_dot**2 / 5 - 10 * c.y)
    >>> floor = Impact(c.y - 1, 0.5, friction=0.1, slip=c.x_dot + c.theta_dot)
    >>> ball.simulate({}, (0, 2, 0), (7, 0, 0), [0, 9], events=floor).v[-1].round(6) + 0
    array([ 5.,  0., -5.])
    """

    gap: sp.Expr
    restitution: sp.Expr = sp.S.One
    friction: sp.Expr = sp.S.Zero
    slip: tuple[sp.Expr, ...] = ()

    def __post_init__(self) -> None:
        if hasattr(self.gap, "slips"):
            object.__setattr__(self, "slip", self.slip or (self.gap.slips if self.friction != 0 else ()))
            object.__setattr__(self, "gap", self.gap.gap)
        object.__setattr__(self, "gap", expression("Impact: gap", self.gap))
        e = expression("Impact: restitution", self.restitution)
        object.__setattr__(self, "restitution", e)
        if e.is_number and not 0 <= e <= 1:
            raise InputError(f"Impact: restitution = {e} must lie between 0, nothing rebounds, and 1, nothing is lost")
        mu = expression("Impact: friction", self.friction)
        object.__setattr__(self, "friction", mu)
        slips = self.slip if isinstance(self.slip, Sequence | sp.MatrixBase) else (self.slip,)
        object.__setattr__(self, "slip", vector_of("Impact: slip", slips, len(slips)))
        if mu.is_number and not 0 <= mu < sp.oo:
            raise InputError(f"Impact: friction = {mu} must be a coefficient of at least 0")
        if (mu == 0) != (len(self.slip) == 0) or len(self.slip) > 2:
            raise InputError(
                f"Impact: friction = {mu} with {len(self.slip)} sliding velocities: with friction give slip, one or two "
                "velocities at the contact, which the gap does not determine; without friction give none"
            )

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        """All expressions of the impact: its gap, restitution and friction, and its sliding velocities."""
        return self.gap, self.restitution, self.friction, *self.slip


@dataclass(frozen=True)
class Surface:
    """A surface w(q, v, t) = 0 on which a force jumps.

    Attributes
    ----------
    argument : Expr
        w; for friction in several directions the square Q of the sliding speed.
    sign : Symbol
        The symbol in place of sign(w), or 1 in place of √Q/√Q while it slides.
    bound : Expr or None
        The bound F of dry friction; None for any other force.
    slips : tuple of Expr
        The sliding velocities of friction in several directions; otherwise () or, of a force that can keep w at zero, (w,).
    metric : Matrix or None
        A_pp of friction in several directions, with Q = wᵀ A_pp⁻¹ w.
    impact : int or None
        The index of the impact of which this is the friction, which acts while its gap is closed.
    """

    argument: sp.Expr
    sign: sp.Symbol
    bound: sp.Expr | None
    slips: tuple[sp.Expr, ...] = ()
    metric: sp.Matrix | None = None
    impact: int | None = None

    @property
    def least(self) -> sp.Symbol:
        """The symbol of the sliding speed that counts as zero."""
        return sp.Symbol(f"least {self.sign}", real=True)

    @property
    def square(self) -> sp.Expr:
        """Q as a sum of squares, which rounding does not make negative."""
        assert self.metric is not None
        w = sp.Matrix(self.slips)
        return self.argument if self.argument.is_nonnegative else (w.T * self.metric.inv() * w)[0]

    def force(self, c: Coordinates) -> sp.Matrix:
        """Return the friction force −F ∂√Q/∂v while it slides, shape (n, 1)."""
        assert self.bound is not None
        return -self.bound / (2 * sp.sqrt(self.square)) * gradient(self.square, c.v)


def check_events(system: Equations, events: Any) -> tuple[Event | Impact, ...]:
    """Return the events of a run as a tuple, or raise InputError if they do not fit the system."""
    event_tuple = (events,) if isinstance(events, Event | Impact) else events
    if not isinstance(event_tuple, Sequence) or not all(isinstance(event, Event | Impact) for event in event_tuple):
        raise InputError(f"simulate: events = {events!r} must be Event(section) or Impact(gap), or several in a tuple")
    c, n = system.c, len(system.speeds)
    for event in event_tuple:
        if isinstance(event, Impact):
            if wrong := event.gap.free_symbols & {*c.v, *c.a}:
                raise InputError(f"Impact: the gap {event.gap} contains {_names(wrong)}: it may depend only on q and t")
            if not event.gap.free_symbols & {*c.q}:
                raise InputError(f"Impact: the gap {event.gap} contains no coordinate: no impact changes it")
            for w in event.slip:
                if not is_affine(w, c.v) or not depends_on(w, c.v) or w.free_symbols & {*c.a, *dict(system.states)}:
                    raise InputError(f"Impact: slip {short(w)} must be affine in the velocities, in q, v and t alone")
        elif event.velocities is not None and len(event.velocities) != n:
            raise InputError(
                f"Event: velocities has {len(event.velocities)} entries, but the system has {n} velocities: give one for each"
            )
        if isinstance(event, Event) and (wrong := event.section.free_symbols & {*c.a}):
            raise InputError(
                f"Event: the section {event.section} contains {_names(wrong)}: it may depend only on q, v, t and reactions"
            )
    return tuple(event_tuple)


def without_jumps(system: Equations) -> tuple[Equations, tuple[Surface, ...]]:
    """Replace each sign that jumps where the state passes a surface by a symbol σ. Return the smooth system and a `Surface` for
    each symbol. The replacements are sign(w) → σ, |w| → σ w, Heaviside(w) → (1 + σ)/2, Max(a, b) → (a + b + σ (a − b))/2, and
    Min(a, b) with −σ in place of σ."""
    moving = {*system.c.v, *system.variables, *system.reactions, t}
    L = getattr(system.lagrangian, "remainder", system.lagrangian)  # for bodies, the terms added to their energy
    places = [*system.forces, system.dissipation, L, *(f for _, f in system.states)]
    substitutions: dict[sp.Expr, sp.Expr] = {}
    signs: dict[sp.Expr, sp.Expr] = {}
    for atom in sorted({e for e in subexpressions(*places) if isinstance(e, _JUMPING)}, key=sp.default_sort_key):
        w = atom.args[0] - atom.args[1] if isinstance(atom, sp.Max | sp.Min) else atom.args[0]
        if w.free_symbols & moving and (not isinstance(atom, sp.Max | sp.Min) or len(atom.args) == 2):
            w = sp.expand(w)
            opposite = sp.expand(-w)
            s = -signs[opposite] if opposite in signs else signs.setdefault(w, sp.Symbol(f"sign({w})", real=True))
            substitutions[atom] = _smooth(atom, w, s)
    squares = {
        root.base: sp.Symbol(f"slip {i + 1}", real=True)
        for i, root in enumerate(sorted(system.generalised_forces.atoms(sp.Pow), key=sp.default_sort_key))
        if root.exp == sp.Rational(-1, 2) and _jumps_at_zero(system.generalised_forces, root.base, system.c.v)
    }
    if not substitutions and not squares:
        return system, ()
    if nested := [atom for atom in substitutions if any(atom != outer and atom.has(outer) for outer in substitutions)]:
        way = "write each case as a system of its own, a saturation Max(-a, Min(a, u)) as (Abs(u + a) - Abs(u - a))/2"
        raise InputError(f"simulate: {nested[0]} has a jump within a jump: {way}")
    slopes = [derivative(L, s) for s in (*system.c.q, *system.c.v)]
    steps = {(step, e) for e in slopes for step in e.atoms(sp.DiracDelta)}
    if jumps := [step.args[0] for step, e in steps if _is_a_jump(step, e, (*system.c.q, *system.c.v))]:
        w = min(jumps, key=str)
        raise InputError(
            f"simulate: the Lagrangian jumps where {w} = 0, and its force is infinite there: give an Impact or an Event; of a "
            f"potential without a jump write {w} as a factor"
        )
    # A solver evaluates beyond the surface before its phase ends there, so Hertz's (−z)^(5/2) gets |z| for −z.
    roots = {
        e: sp.Abs(e.base.xreplace(substitutions)) ** e.exp
        for e in subexpressions(*places)
        if isinstance(e, sp.Pow) and e.exp.is_number and not e.exp.is_integer
        if e.base.has(*substitutions) or any((e.base / w).is_number for w in signs)
    }
    substitutions |= roots
    friction = gradient(system.dissipation.xreplace(substitutions), system.c.v)
    forces = (force_column(system.forces or None, system.c, "System") - friction).xreplace(substitutions)
    planar = tuple(_planar_friction(forces, square, s, system.c) for square, s in squares.items())
    slides = {s.argument: s for s in planar}
    powers = {e: slides[e.base] for e in forces.atoms(sp.Pow) if e.base in slides and not e.exp.is_integer}
    forces = tuple(forces.xreplace({e: s.sign * s.square**e.exp for e, s in powers.items()}))
    smooth = replace(
        system,
        lagrangian=system.lagrangian.xreplace(substitutions),
        forces=forces if system.c.q else (),
        dissipation=sp.S.Zero,
        states=tuple((x, f.xreplace(substitutions)) for x, f in system.states),
    )
    surfaces = tuple(_surface(smooth, w, s) for w, s in signs.items())
    if bound := [
        s.argument for s in surfaces if s.bound not in (None, 0) and s.argument.free_symbols & {*dict(system.states)}
    ]:
        way = "make the state the velocity of a coordinate, or the friction smooth, tanh(w/w_0) for sign(w)"
        raise InputError(
            f"simulate: dry friction on {bound[0]} = 0 would bind a velocity to a first-order state: {way}"
        )
    return smooth, surfaces + planar


def with_impacts(system: Equations, impacts: Sequence[Impact]) -> tuple[Surface, ...]:
    """Return a surface for the friction of each impact that has any."""
    return tuple(
        Surface(
            sum((w**2 for w in impact.slip), sp.S.Zero),
            sp.Symbol(f"impact {i + 1} slip", real=True),
            impact.friction * reaction(f"gap {i + 1}"),
            impact.slip,
            sp.eye(len(impact.slip)),
            i,
        )
        for i, impact in enumerate(impacts)
        if impact.slip
    )


def _planar_friction(forces: sp.Matrix, square: sp.Expr, s: sp.Symbol, c: Coordinates) -> Surface:
    """Return the surface of the force −F ∂√Q/∂v in `forces`, Q = `square`. Raise InputError if the force is another one."""
    slope = gradient(square, c.v) / 2
    A = jacobian(list(slope), c.v)
    r = sp.Dummy("r", positive=True)
    jump = [(sp.expand(e.xreplace({sp.sqrt(square): r, 1 / sp.sqrt(square): 1 / r}) * r)).subs(r, 0) for e in forces]
    i = next(i for i, e in enumerate(jump) if e != 0 and slope[i] != 0)
    F = sp.cancel(-jump[i] / slope[i])
    if any(decide_zero(e + F * w).answer != "zero" for e, w in zip(jump, slope, strict=True)):
        raise InputError(
            f"simulate: the force jumps where Q = {short(square)} = 0 and is no friction −F ∂√Q/∂v there: give such a "
            "dissipation, or add the square of a small speed under the root"
        )
    point = next(iter(points(A.free_symbols)))
    numbers, rows = sp.Matrix(put_in(A, point)), list[int]()
    for k in range(len(c.v)):
        if numbers.extract([*rows, k], [*rows, k]).evalf(30).rank(iszerofunc=lambda e: abs(e) < _NO_JUMP) > len(rows):
            rows.append(k)
    if len(rows) == 1:
        raise InputError(f"simulate: {short(square)} is the square of one velocity w: write Abs(w) for its root")
    return Surface(square, s, F, tuple(slope[k] for k in rows), A.extract(rows, rows))


def _surface(system: Equations, w: sp.Expr, s: sp.Symbol) -> Surface:
    """Return the surface of a force that jumps with the sign s of w. Unless it is friction, w may stay at zero if it is affine in
    the velocities and the sign is in forces alone."""
    bound, c = _friction(system, w, s), system.c
    elsewhere = [system.lagrangian, *(f for _, f in system.states)]
    slides = depends_on(w, c.v) and is_affine(w, c.v) and not w.free_symbols & {*dict(system.states), *system.reactions}
    if bound is None and slides and not any(s in e.free_symbols for e in elsewhere):
        return Surface(w, s, None, (w,))
    return Surface(w, s, bound)


def short(e: sp.Expr) -> str:
    """Return an expression as text for a message of one line; only the beginning if the expression is long."""
    text = str(e)
    return text if len(text) <= _LONGEST else text[:_LONGEST] + " …"


def _is_a_jump(step: sp.DiracDelta, slope: sp.Expr, moving: Sequence[sp.Symbol]) -> bool:
    """Return True if the Lagrangian jumps where w = 0: in its derivative `slope` the factor of δ(w) is not zero at a root of w.
    The root is found by Newton's method, because sympy does not see every identity. For example, a rope has the same length with
    and without a drum when it touches the drum."""
    mark, w = sp.Dummy(), step.args[0]
    factor = derivative(slope.xreplace({step: mark}), mark)
    letters = sorted((factor.free_symbols | w.free_symbols), key=str)
    random = Random(1)
    for _ in range(_TRIALS):
        point = {s: sp.Float(random.uniform(0.2, 2.0)) for s in letters}
        for q in sorted(w.free_symbols & {*moving}, key=str):
            others = {s: value for s, value in point.items() if s != q}
            try:
                root = sp.nsolve(w.xreplace(others), q, float(point[q]))
                size = abs(complex(factor.xreplace({**point, q: root})))
            except (ValueError, TypeError, ArithmeticError, AttributeError, KeyError):
                continue
            if root.is_real:
                return size > _NO_JUMP
    return False


_LONGEST = 80  # characters of a formula in a message
_TRIALS, _NO_JUMP = 12, 1e-8  # points from which a root is sought; a factor below which there is no jump
_JUMPING = (sp.sign, sp.Abs, sp.Heaviside, sp.Max, sp.Min)


def _jumps_at_zero(push: sp.Matrix, e: sp.Expr, v: Sequence[sp.Symbol]) -> bool:
    """Return True if a force with √e jumps at rest or at the least value of e. The expression e is quadratic in several
    velocities."""
    speeds = [s for s in v if s in e.free_symbols]
    still = dict.fromkeys(speeds, sp.S.Zero)
    value_at_rest, slope = e.xreplace(still), gradient(e, speeds).xreplace(still)
    curvature = jacobian(list(gradient(e, speeds)), speeds)
    if len(speeds) < 2 or value_at_rest == 0:
        return len(speeds) > 1
    if curvature.free_symbols & {*speeds}:
        return False
    try:
        least, free = curvature.gauss_jordan_solve(-slope)
    except ValueError:
        return False
    if decide_zero(value_at_rest + slope.dot(least.xreplace(dict.fromkeys(free, sp.S.Zero))) / 2).answer != "zero":
        return False
    r = sp.Dummy("r", positive=True)
    sizes = [sp.expand(r * f.xreplace({sp.sqrt(e): r, 1 / sp.sqrt(e): 1 / r})).xreplace({r: sp.S.Zero}) for f in push]
    return any(size.has(sp.nan, sp.zoo, sp.oo) or decide_zero(size).answer != "zero" for size in sizes)


def _smooth(atom: sp.Expr, w: sp.Expr, s: sp.Symbol) -> sp.Expr:
    if isinstance(atom, sp.sign):
        return s
    if isinstance(atom, sp.Abs):
        return s * w
    if isinstance(atom, sp.Heaviside):
        return (1 + s) / 2
    a, b = atom.args
    return (a + b + (s if isinstance(atom, sp.Max) else -s) * w) / 2


def _friction(system: Equations, w: sp.Expr, s: sp.Symbol) -> sp.Expr | None:
    """Return the bound F if the force that jumps with the sign s of w is dry friction −F s ∂w/∂v; None for any other force."""
    c = system.c
    slope = gradient(w, c.v)
    lagrangian = s in system.lagrangian.free_symbols
    if not any(slope) or lagrangian or any(derivative(e, v) != 0 for e in slope for v in c.v):
        return None
    i = next(i for i, e in enumerate(slope) if e != 0)
    on_surface = {c.v[i]: c.v[i] - w / slope[i]}
    above, below = (system.generalised_forces.subs(s, side).subs(on_surface) for side in (1, -1))
    jump = (above - below) / 2
    F = sp.cancel(-jump[i] / slope[i]) if jump[i] != 0 else sp.S.Zero
    return F if all(decide_zero(e).answer == "zero" for e in jump + F * slope) else None


def _names(symbols: set[sp.Symbol]) -> str:
    return ", ".join(sorted(map(str, symbols)))
