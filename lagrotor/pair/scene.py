"""The scene: rotors, bar, shock and initial state, in SI units. What makes no sense is refused here."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from html import escape
from math import fsum, hypot, pi, sqrt

from lagrotor.errors import InputError
from lagrotor.numerics.pulse import PULSE_REACH
from lagrotor.pair.quantities import (
    Vector,
    finite_number,
    finite_vector,
    not_negative,
    not_vanishing,
    numbers,
    positive,
    two_vectors,
)

_CLOSE = 1e-9  # how far a given state may lie off its constraints


def _dot(p: Vector, q: Vector) -> float:
    """Scalar product of two vectors."""
    return fsum(x * y for x, y in zip(p, q, strict=True))


@dataclass(frozen=True)
class Rotor:
    """A symmetric rotor standing on a ground joint: mass (kg), axis length (m), inertias about its centre (kg m²)."""

    mass: float = 1.0
    length: float = 1.0
    I1: float = 1.0
    I3: float = 1.0

    def __post_init__(self) -> None:
        for name, unit in (("mass", "kg"), ("length", "m"), ("I1", "kg m²"), ("I3", "kg m²")):
            object.__setattr__(self, name, positive(getattr(self, name), f"Rotor: {name}", unit))
        if self.I3 > 2 * self.I1 * (1 + 1e-12):
            raise InputError(
                f"Rotor: I3 = {self.I3:g} exceeds 2 I1 = {2 * self.I1:g} kg m²: no body has that inertia "
                "(a thin disc reaches I3 = 2 I1); raise I1 or lower I3"
            )

    @property
    def J(self) -> float:
        """Transverse inertia about the ground joint, I1 + M R²/4 (kg m²)."""
        return self.I1 + self.mass * self.length**2 / 4


@dataclass(frozen=True)
class Link:
    """The bar between the tips: length (m), mass (kg), transverse inertia about its centre (kg m²)."""

    length: float = 1.0
    mass: float = 0.0
    inertia: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "length", positive(self.length, "Link: length", "m"))
        object.__setattr__(self, "mass", not_negative(self.mass, "Link: mass", "kg"))
        object.__setattr__(self, "inertia", not_negative(self.inertia, "Link: inertia", "kg m²"))
        if self.inertia > 0 and self.mass == 0:
            raise InputError(
                f"Link: inertia = {self.inertia:g} kg m² with mass = 0: no body has that inertia; "
                "give the bar a mass, or inertia = 0"
            )


@dataclass(frozen=True)
class Shock:
    """A Gaussian pulse on the tip of one rotor: force exp(−((t − at)/width)²), force in N, times in s."""

    force: Vector
    at: float
    width: float
    body: int = 1

    def __post_init__(self) -> None:
        object.__setattr__(self, "force", finite_vector(self.force, "Shock: force", "N"))
        object.__setattr__(self, "at", finite_number(self.at, "Shock: at", "s"))
        object.__setattr__(self, "width", positive(self.width, "Shock: width", "s"))
        if isinstance(self.body, bool) or self.body not in (1, 2):
            raise InputError(f"Shock: body = {self.body!r} must be 1 (left rotor) or 2 (right rotor)")
        object.__setattr__(self, "body", int(self.body))

    @property
    def impulse(self) -> Vector:
        """Force integrated over time, force width sqrt(pi) (N s)."""
        scale = self.width * sqrt(pi)
        return (self.force[0] * scale, self.force[1] * scale, self.force[2] * scale)

    @property
    def begin(self) -> float:
        """Time (s) before which the pulse is below the last bit of its peak."""
        return self.at - PULSE_REACH * self.width

    @property
    def end(self) -> float:
        """Time (s) after which the pulse is below the last bit of its peak."""
        return self.at + PULSE_REACH * self.width

    def since(self, begin: float) -> Shock:
        """The shock with time counted from `begin` (s)."""
        return replace(self, at=self.at - begin)


_UP: tuple[Vector, Vector] = ((0.0, 0.0, 1.0), (0.0, 0.0, 1.0))
_REST: tuple[Vector, Vector] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@dataclass(frozen=True)
class Scene:
    """Two equal rotors of given axial angular velocities (rad/s), the bar between their tips, a shock, a start.

    `axes` are the unit vectors r_i and `rates` their r_i' (1/s) at the start of a run; they must satisfy
    |r_i| = 1, |ell e_x + R (r_2 − r_1)| = ell, and the rates be tangent to both.
    `link=None` leaves the two rotors uncoupled.

    Raises
    ------
    InputError
        Axes, rates or sizes that do not fit together; the message names the way out.

    Examples
    --------
    >>> Scene(spins=(10, -10)).momenta
    (10.0, -10.0)
    """

    spins: tuple[float, float]
    rotor: Rotor = field(default_factory=Rotor)
    link: Link | None = field(default_factory=Link)
    shock: Shock | None = None
    axes: tuple[Vector, Vector] = _UP
    rates: tuple[Vector, Vector] = _REST

    def __post_init__(self) -> None:
        for name, kind, optional in (("rotor", Rotor, False), ("link", Link, True), ("shock", Shock, True)):
            value = getattr(self, name)
            if not (isinstance(value, kind) or (optional and value is None)):
                raise InputError(f"Scene: {name} = {value!r} must be a {kind.__name__}")
        object.__setattr__(self, "spins", numbers(self.spins, 2, "Scene: spins", "rad/s"))
        for i, spin in enumerate(self.spins):
            not_vanishing(spin, f"Scene: spins[{i}]", "rad/s")
        object.__setattr__(self, "axes", two_vectors(self.axes, "Scene: axes", "1"))
        object.__setattr__(self, "rates", two_vectors(self.rates, "Scene: rates", "1/s"))
        for i, (r, v) in enumerate(zip(self.axes, self.rates, strict=True)):
            if abs(hypot(*r) - 1) > _CLOSE:
                raise InputError(f"Scene: axes[{i}] has length {hypot(*r):.9g}, not 1: divide it by its length")
            if abs(_dot(r, v)) > _CLOSE * (1 + hypot(*v)):
                raise InputError(
                    f"Scene: rates[{i}] is not tangent: r . r' = {_dot(r, v):.3g}; subtract (r . r') r, "
                    "or use lagrotor.consistent_scene"
                )
        if self.link is not None:
            self._refuse_bar(self.link)

    def _refuse_bar(self, link: Link) -> None:
        """The bar's length and its rate of change at the start."""
        (r1, r2), (v1, v2), R, ell = self.axes, self.rates, self.rotor.length, link.length
        d = (ell + R * (r2[0] - r1[0]), R * (r2[1] - r1[1]), R * (r2[2] - r1[2]))
        w = (v2[0] - v1[0], v2[1] - v1[1], v2[2] - v1[2])
        if abs(hypot(*d) - ell) > _CLOSE * ell:
            raise InputError(
                f"Scene: the bar cannot reach: |ell e_x + R (r2 - r1)| = {hypot(*d):.9g}, ell = {ell:g}; "
                "change an axis or the bar, or use lagrotor.consistent_scene"
            )
        stretch = R * _dot(d, w) / ell
        if abs(stretch) > _CLOSE * R * (1 + hypot(*w)):
            raise InputError(
                f"Scene: the rates stretch the bar at {stretch:.3g} m/s; make them tangent to its constraint, "
                "or use lagrotor.consistent_scene"
            )
        # n_i: tangent part of the bar's pull on axis i. With both zero nothing the bar does can be felt.
        pulls = []
        for r, partner, sign in ((r1, r2, 1.0), (r2, r1, -1.0)):
            n = (ell / R * sign + partner[0], partner[1], partner[2])
            component = _dot(n, r)
            pulls.append(hypot(n[0] - component * r[0], n[1] - component * r[1], n[2] - component * r[2]))
        if max(pulls) < 1e-6 * min(1.0, ell / R):
            raise InputError(
                f"Scene: axes = {self.axes} both lie along the joint line, where the bar's constraint is singular; "
                "tilt an axis"
            )

    def shock_until(self, t_end: float) -> Shock | None:
        """The shock, if its pulse acts at any time between 0 and t_end (s)."""
        return self.shock if self.shock and self.shock.begin < t_end and self.shock.end > 0 else None

    def since(self, begin: float) -> Scene:
        """The scene with time counted from `begin` (s)."""
        return replace(self, shock=self.shock.since(begin)) if self.shock and begin else self

    @property
    def momenta(self) -> tuple[float, float]:
        """Axial angular momenta G_i = I3 omega_i (kg m²/s)."""
        return self.rotor.I3 * self.spins[0], self.rotor.I3 * self.spins[1]

    @property
    def inertias(self) -> tuple[float, float]:
        """(a, b) of T = a/2 (|r_1'|² + |r_2'|²) + b r_1' . r_2', the bar included (kg m²)."""
        J, R = self.rotor.J, self.rotor.length
        if self.link is None:
            return J, 0.0
        whole, twist = self.link.mass * R**2 / 4, self.link.inertia * (R / self.link.length) ** 2
        return J + whole + twist, whole - twist

    @property
    def sigma(self) -> float:
        """(a + b)/(a − b): 1 without a bar, for a massless bar and for a dumbbell."""
        self_inertia, shared = self.inertias
        return (self_inertia + shared) / (self_inertia - shared)

    @property
    def k(self) -> float:
        """ell/R, the bar's length in lengths of an axis.

        Raises
        ------
        InputError
            Without a bar.
        """
        if self.link is None:
            raise InputError("Scene: k = ell/R needs a bar; give the scene a link")
        return self.link.length / self.rotor.length

    def summary(self) -> dict[str, str]:
        """Spins, rotors, bar and shock, name → words."""
        rotor, bar, shock = self.rotor, self.link, self.shock
        return {
            "spins [rad/s]": f"{self.spins[0]:g}, {self.spins[1]:g}",
            "rotors": f"{rotor.length:g} m, {rotor.mass:g} kg, I1 = {rotor.I1:g}, I3 = {rotor.I3:g} kg m²",
            "bar": f"{bar.length:g} m, {bar.mass:g} kg, {bar.inertia:g} kg m²" if bar else "none",
            "shock": f"{shock.force} N on rotor {shock.body}, {shock.at:g} ± {shock.width:g} s" if shock else "none",
        }

    def _repr_html_(self) -> str:
        vectors = (f"({x:.4g}, {y:.4g}, {z:.4g})" for x, y, z in (*self.axes, *self.rates))
        lines = self.summary() | {"r_1, r_2, r_1', r_2'": ", ".join(vectors)}
        rows = "".join(f"<tr><th>{escape(k)}</th><td>{escape(v)}</td></tr>" for k, v in lines.items())
        return f"<table><caption>Scene</caption>{rows}</table>"
