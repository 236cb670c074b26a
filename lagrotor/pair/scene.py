"""The scene: rotors, bar, shock and initial state, checked, in SI units."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
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
from lagrotor.result_display import Printed, text_of

CLOSE = 1e-9  # the largest residual of the constraints at the start


def _dot(p: Vector, q: Vector) -> float:
    return fsum(x * y for x, y in zip(p, q, strict=True))


@dataclass(frozen=True)
class Rotor(Printed):
    """A symmetric rotor on a ground joint.

    Attributes
    ----------
    mass : float, default 1.0
        The mass M in kg.
    length : float, default 1.0
        The length R of the axis in m.
    I1 : float, default 1.0
    I3 : float, default 1.0
        The transverse and the axial inertia about the centre, in kg m².

    Examples
    --------
    >>> Rotor(mass=4, length=1, I1=2).J
    3.0
    """

    _shown = (
        ("mass M [kg]", "mass"),
        ("length R [m]", "length"),
        ("inertias I₁, I₃ [kg m²]", lambda r: (r.I1, r.I3)),
    )

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
        """The transverse inertia about the ground joint, I1 + M R²/4, in kg m²."""
        return self.I1 + self.mass * self.length**2 / 4


@dataclass(frozen=True)
class Link(Printed):
    """The bar between the tips.

    Attributes
    ----------
    length : float, default 1.0
        The length in m.
    mass : float, default 0.0
        The mass in kg.
    inertia : float, default 0.0
        The transverse inertia about the centre, in kg m².
    """

    _shown = (
        ("length ℓ [m]", "length"),
        ("mass m [kg]", "mass"),
        ("inertia K [kg m²]", "inertia"),
    )

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
class Shock(Printed):
    """A Gaussian pulse force exp(−((t − at)/width)²) on the tip of one rotor.

    Attributes
    ----------
    force : tuple of float
        The peak (x, y, z) in N.
    at : float
    width : float
        The time of the peak and the width, in s.
    body : int, default 1
        The rotor, 1 (left) or 2 (right).

    Examples
    --------
    >>> Shock((50, 0, 0), at=2, width=0.02).impulse[0]
    1.772453850905516
    """

    _shown = (
        ("force [N]", lambda s: f"({text_of(s.force)}) on rotor {s.body}"),
        ("time [s]", lambda s: f"{s.at:g} ± {s.width:g}"),
    )

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
        """The integral of the force over time, force width √π, in N s."""
        scale = self.width * sqrt(pi)
        return (self.force[0] * scale, self.force[1] * scale, self.force[2] * scale)

    @property
    def begin(self) -> float:
        """The time in s before which the pulse is below the last bit of its peak."""
        return self.at - PULSE_REACH * self.width

    @property
    def end(self) -> float:
        """The time in s after which the pulse is below the last bit of its peak."""
        return self.at + PULSE_REACH * self.width

    def since(self, begin: float) -> Shock:
        """Return the shock with time counted from a moment.

        Parameters
        ----------
        begin : float
            The moment in s.

        Returns
        -------
        Shock
            The shifted shock.
        """
        return replace(self, at=self.at - begin)


_UP: tuple[Vector, Vector] = ((0.0, 0.0, 1.0), (0.0, 0.0, 1.0))
_REST: tuple[Vector, Vector] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@dataclass(frozen=True)
class Scene(Printed):
    """Two equal rotors, the bar between their tips, a shock and an initial state.

    Attributes
    ----------
    spins : tuple of float
        The axial angular velocities in rad/s.
    rotor : Rotor
        Both rotors.
    link : Link or None
        The bar; None for uncoupled rotors.
    shock : Shock or None
        The shock; None for a scene without one.
    axes : tuple of vectors
    rates : tuple of vectors
        The unit vectors r_i of the axes and their rates r_i' in 1/s, at the start. They satisfy the constraint of the bar,
        |ell e_x + R (r_2 − r_1)| = ell, and its time derivative.

    Examples
    --------
    >>> scene = Scene(spins=(10, -10), link=Link(mass=1.0, inertia=0.5))
    >>> scene.momenta, scene.inertias, scene.sigma, scene.k
    ((10.0, -10.0), (2.0, -0.25), 0.7777777777777778, 1.0)
    >>> scene.summary()["bar"]
    '1 m, 1 kg, 0.5 kg m²'
    """

    spins: tuple[float, float]
    rotor: Rotor = field(default_factory=Rotor)
    link: Link | None = field(default_factory=Link)
    shock: Shock | None = None
    axes: tuple[Vector, Vector] = _UP
    rates: tuple[Vector, Vector] = _REST

    def __post_init__(self) -> None:
        object.__setattr__(self, "spins", numbers(self.spins, 2, "Scene: spins", "rad/s"))
        for name, kind, optional in (("rotor", Rotor, False), ("link", Link, True), ("shock", Shock, True)):
            value = getattr(self, name)
            if not (isinstance(value, kind) or (optional and value is None)):
                raise InputError(f"Scene: {name} = {value!r} must be a {kind.__name__}")
        for i, spin in enumerate(self.spins):
            not_vanishing(spin, f"Scene: spins[{i}]", "rad/s")
        object.__setattr__(self, "axes", two_vectors(self.axes, "Scene: axes", "1"))
        object.__setattr__(self, "rates", two_vectors(self.rates, "Scene: rates", "1/s"))
        for i, (r, v) in enumerate(zip(self.axes, self.rates, strict=True)):
            if abs(hypot(*r) - 1) > CLOSE:
                raise InputError(f"Scene: axes[{i}] has length {hypot(*r):.9g}, not 1: divide it by its length")
            if abs(_dot(r, v)) > CLOSE * (1 + hypot(*v)):
                raise InputError(
                    f"Scene: rates[{i}] is not tangent: r . r' = {_dot(r, v):.3g}; subtract (r . r') r, "
                    "or use lagrotor.consistent_scene"
                )
        if self.link is not None:
            self._refuse_bar(self.link)

    def _refuse_bar(self, link: Link) -> None:
        """Raise InputError if the start does not satisfy the bar's constraint or its derivative."""
        (r1, r2), (v1, v2), R, ell = self.axes, self.rates, self.rotor.length, link.length
        d = (ell + R * (r2[0] - r1[0]), R * (r2[1] - r1[1]), R * (r2[2] - r1[2]))
        w = (v2[0] - v1[0], v2[1] - v1[1], v2[2] - v1[2])
        if abs(hypot(*d) - ell) > CLOSE * ell:
            raise InputError(
                f"Scene: the bar cannot reach: |ell e_x + R (r2 - r1)| = {hypot(*d):.9g}, ell = {ell:g}; "
                "change an axis or the bar, or use lagrotor.consistent_scene"
            )
        stretch = R * _dot(d, w) / ell
        if abs(stretch) > CLOSE * R * (1 + hypot(*w)):
            raise InputError(
                f"Scene: the rates stretch the bar at {stretch:.3g} m/s; make them tangent to its constraint, "
                "or use lagrotor.consistent_scene"
            )
        # n_i: tangent component of the bar's pull on axis i. If both vanish, the bar has no effect on the axes.
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
        """Return the shock if its pulse acts between 0 and t_end.

        Parameters
        ----------
        t_end : float
            The last time in s.

        Returns
        -------
        Shock or None
            The shock; None if it does not act.

        Examples
        --------
        >>> Scene((10, -10), shock=Shock((50, 0, 0), at=2, width=0.02)).shock_until(1) is None
        True
        """
        return self.shock if self.shock and self.shock.begin < t_end and self.shock.end > 0 else None

    def since(self, begin: float) -> Scene:
        """Return the scene with time counted from a moment.

        Parameters
        ----------
        begin : float
            The moment in s.

        Returns
        -------
        Scene
            The scene with the shifted shock.

        Examples
        --------
        >>> Scene((10, -10), shock=Shock((50, 0, 0), at=2, width=0.02)).since(1.5).shock.at
        0.5
        """
        return replace(self, shock=self.shock.since(begin)) if self.shock and begin else self

    @property
    def momenta(self) -> tuple[float, float]:
        """The axial angular momenta G_i = I3 omega_i, in kg m²/s."""
        return self.rotor.I3 * self.spins[0], self.rotor.I3 * self.spins[1]

    @property
    def inertias(self) -> tuple[float, float]:
        """The inertias (a, b) of T = a/2 (|r_1'|² + |r_2'|²) + b r_1' . r_2' with the bar, in kg m²."""
        J, R = self.rotor.J, self.rotor.length
        if self.link is None:
            return J, 0.0
        whole, twist = self.link.mass * R**2 / 4, self.link.inertia * (R / self.link.length) ** 2
        return J + whole + twist, whole - twist

    @property
    def sigma(self) -> float:
        """The ratio (a + b)/(a − b): 1 without a bar, for a massless bar and for a dumbbell."""
        self_inertia, shared = self.inertias
        return (self_inertia + shared) / (self_inertia - shared)

    @property
    def k(self) -> float:
        """The ratio ell/R of the lengths of bar and axis. Without a bar InputError is raised."""
        if self.link is None:
            raise InputError("Scene: k = ell/R needs a bar; give the scene a link")
        return self.link.length / self.rotor.length

    def summary(self) -> dict[str, str]:
        """Return spins, rotors, bar and shock in words.

        Returns
        -------
        dict of str
            {name: description in words}.
        """
        rotor, bar, shock = self.rotor, self.link, self.shock

        def vectors(pair: tuple[Vector, Vector]) -> str:
            return ", ".join(f"({text_of(float(f'{x:.4g}') + 0.0 for x in vector)})" for vector in pair)

        return {
            "spins [rad/s]": text_of(self.spins),
            "rotors": f"{rotor.length:g} m, {rotor.mass:g} kg, I₁ = {rotor.I1:g}, I₃ = {rotor.I3:g} kg m²",
            "bar": f"{bar.length:g} m, {bar.mass:g} kg, {bar.inertia:g} kg m²" if bar else "none",
            "shock": f"({text_of(shock.force)}) N on rotor {shock.body}, {shock.at:g} ± {shock.width:g} s"
            if shock
            else "none",
            "axes r₁, r₂": "upright" if self.axes == _UP else vectors(self.axes),
            "rates r₁', r₂' [1/s]": "at rest" if self.rates == _REST else vectors(self.rates),
        }
