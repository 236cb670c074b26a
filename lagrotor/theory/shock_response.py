"""The linear answer of the coupled pair at rest to a Gaussian pulse, in closed form, for any two spins and any bar.

With q = (x, y_1, y_2) the linear pair is M q'' + C q' = Q(t). One integral is at once M q' + C q = p(t), the impulse
received so far. C has one null vector n, along which the pair topples, and N = M⁻¹ C satisfies N³ = −Omega² N. So the
answer to a unit impulse is a polynomial in N:

    H(s) = n nᵀ s / (n.M n) + D (1 − cos Omega s) + S sin(Omega s) / Omega,
    D = −N M⁻¹ / Omega²  (displacement that stays),    S = −N² M⁻¹ / Omega²  (velocity of the swing),

and a Gaussian pulse of the same impulse and width w multiplies the swing by exp(−(Omega w)²/4) and nothing else.
"""

from dataclasses import dataclass, replace
from functools import cache
from math import exp, pi, sqrt

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError
from lagrotor.mechanics import LinearSystem
from lagrotor.pair.scene import Scene
from lagrotor.pair.symbols import G_1, G_2, P_1, P_2, P_X, a, b
from lagrotor.theory.closed_form import ClosedForm
from lagrotor.theory.natural_frequency import linear_pair, natural_frequency

Array = NDArray[np.float64]

_SPUN = (sp.Gt(a, sp.Abs(b)), sp.Gt(G_1**2 + G_2**2, 0))
# A pulse that starts later than this many widths before its peak has lost 2e-8 of its impulse.
_WHOLE = 4.0


@dataclass(frozen=True)
class ImpulseMatrices:
    """H(s) = drift s + displacement (1 − cos Omega s) + swing sin(Omega s)/Omega, all (3, 3), in (x, y_1, y_2).

    `mass`, `gyroscopic`: M and C in the same order; `null`: n, (3, 1); `frequency_squared`: Omega².
    """

    mass: sp.Matrix
    gyroscopic: sp.Matrix
    null: sp.Matrix
    drift: sp.Matrix
    displacement: sp.Matrix
    swing: sp.Matrix
    frequency_squared: sp.Expr


@cache
def impulse_matrices() -> ImpulseMatrices:
    """The matrices of the answer to a unit impulse, from the linear pair (symbols a, b, G_1, G_2)."""
    linear = _ordered(linear_pair())
    M, C = linear.mass, linear.gyroscopic
    inverse = M.inv().applyfunc(sp.factor)
    squared = natural_frequency().expressions[0] ** 2
    N = (inverse * C).applyfunc(sp.factor)
    # C n = 0 from the cofactors of the antisymmetric C: n = (C_23, −C_13, C_12).
    null = sp.Matrix([C[1, 2], -C[0, 2], C[0, 1]])
    weight = sp.factor((null.T * M * null)[0])
    drift = (null * null.T / weight).applyfunc(sp.factor)
    displacement = (-N * inverse / squared).applyfunc(sp.factor)
    swing = (-N * N * inverse / squared).applyfunc(sp.factor)
    return ImpulseMatrices(M, C, null, drift, displacement, swing, sp.factor(squared))


def _ordered(linear: LinearSystem) -> LinearSystem:
    """The linear pair with its coordinates in the order (x, y_1, y_2), read off the basis (rows x_1, y_1, …, z_2)."""
    rows = [linear.basis.row(i) for i in (0, 1, 4)]
    change = sp.Matrix.vstack(*rows).inv()
    parts = (change.T * m * change for m in (linear.mass, linear.gyroscopic, linear.stiffness))
    mass, gyroscopic, stiffness = parts
    return LinearSystem(mass, gyroscopic, stiffness, linear.basis * change)


@cache
def shock_displacement() -> ClosedForm:
    """(x, y_1, y_2) about which the pair precesses just after an impulse: the permanent displacement (1).

    D p with D = −M⁻¹ C M⁻¹ / Omega_0². Arguments: a, b, G_1, G_2 and the impulse's moment R × N s along x, y_1, y_2.
    """
    return _form("shock_displacement", ("x", "y_1", "y_2"), impulse_matrices().displacement * _impulse())


@cache
def shock_drift() -> ClosedForm:
    """(x', y_1', y_2') of the mean motion after an impulse, (1/s): n (n.p)/(n.M n), n = (0, G_2, −G_1) up to sign.

    Toppling, y_1' = y_2', for opposite spins; twisting, y_1' = −y_2', for equal ones; never along x.
    """
    return _form("shock_drift", ("x'", "y_1'", "y_2'"), impulse_matrices().drift * _impulse())


@cache
def shock_swing() -> ClosedForm:
    """Velocity amplitudes (x, y_1, y_2) of the swing's sine, (1/s), in the limit of a short pulse: S p.

    The motion is displacement (1 − cos Omega s) + (swing/Omega) sin Omega s + drift s.
    """
    return _form("shock_swing", ("x", "y_1", "y_2"), impulse_matrices().swing * _impulse())


@cache
def shock_energy() -> ClosedForm:
    """(E_drift, E_swing) in J gained from an impulse: (n.p)²/(2 n.M n) and p.S p/2; their sum is p.M⁻¹ p/2.

    A Gaussian pulse of width w gives E_drift + exp(−(Omega_0 w)²/2) E_swing.
    """
    matrices, p = impulse_matrices(), _impulse()
    along, swing = ((p.T * m * p)[0] / 2 for m in (matrices.drift, matrices.swing))
    across = swing.subs(P_X, 0)
    form = _form("shock_energy", ("E_drift", "E_swing"), sp.Matrix([along, sp.factor(swing - across)]))
    return replace(form, expressions=(form.expressions[0], form.expressions[1] + sp.factor(across)))


def _impulse() -> sp.Matrix:
    return sp.Matrix([P_X, P_1, P_2])


def _form(name: str, outputs: tuple[str, ...], column: sp.Matrix) -> ClosedForm:
    return ClosedForm(
        name,
        outputs,
        tuple(sp.factor(e) for e in column),
        (a, b, G_1, G_2, P_X, P_1, P_2),
        _SPUN,
        "first order in the impulse, from rest upright, any spins not both zero, any bar",
        "4.2, 5, 5.2.1",
        1,
    )


@dataclass(frozen=True, eq=False)
class ShockResponse:
    """What a pulse leaves, to first order in it. Vectors are (x, y_1, y_2), (3,).

    frequency: Omega_0 (rad/s). impulse: R times the impulse on the tip (N m s). displacement: centre of the precession
    when the pulse peaks (1); with `drift` (1/s) it moves. swing: velocity of the swing that a short pulse of the same
    impulse would start (1/s). attenuation: A = exp(−(Omega_0 w)²/4). After the pulse, with s = t − at,

        q = displacement (1 − A cos Omega_0 s) + drift s + A swing sin(Omega_0 s) / Omega_0.

    energy: gained (J); impulse_energy: the limit of a short pulse (J).
    """

    scene: Scene
    frequency: float
    impulse: Array
    displacement: Array
    drift: Array
    swing: Array
    attenuation: float
    energy: float
    impulse_energy: float

    @property
    def cosine(self) -> Array:
        """The swing's coefficients of cos Omega_0 s, (3,)."""
        return -self.attenuation * self.displacement

    @property
    def sine(self) -> Array:
        """The swing's coefficients of sin Omega_0 s, (3,)."""
        return self.attenuation * self.swing / self.frequency if self.frequency else 0 * self.swing

    @property
    def amplitude(self) -> Array:
        """Amplitudes of the swing in x, y_1, y_2, (3,): sqrt(cosine² + sine²)."""
        return np.hypot(self.cosine, self.sine)

    @property
    def toppling_rate(self) -> float:
        """Rate of the mean turning about the joint line, −(y_1' + y_2')/2, as alpha' (rad/s), to first order in the shock.

        Of opposite spins a shock along the bar alone has none; the second order, `toppling_after_shock`, then decides.
        """
        return float(-(self.drift[1] + self.drift[2]) / 2)

    def after(self, t: ArrayLike) -> Array:
        """(x, y_1, y_2) at times t (n,), as if the whole pulse were over, (n, 3)."""
        s = np.atleast_1d(np.asarray(t, float))[:, None] - self._at
        phase = self.frequency * s
        return self.displacement + self.drift * s + self.cosine * np.cos(phase) + self.sine * np.sin(phase)

    def through(self, t: ArrayLike) -> Array:
        """(x, y_1, y_2) at times t (n,) before, in and after the pulse, (n, 3).

        With E = (1 + erf(s/w))/2 the impulse received so far, the drift's s becomes s E + w exp(−(s/w)²)/(2 sqrt(pi))
        and the swing's exp(i Omega s) becomes exp(i Omega s − (Omega w)²/4) (1 + erf(s/w + i Omega w/2))/2.
        """
        from scipy.special import erfc, wofz

        s = np.atleast_1d(np.asarray(t, float))[:, None] - self._at
        w, Omega = self._width, self.frequency
        received = erfc(-s / w) / 2
        ramp = s * received + w * np.exp(-((s / w) ** 2)) / (2 * sqrt(pi))
        z = s / w + 0.5j * Omega * w
        # wofz(i z) = exp(z²) erfc(z), bounded for Re z > 0: each half line has its own form.
        tail = np.exp(-((s / w) ** 2)) * wofz(1j * np.where(s > 0, z, -z)) / 2
        wave = np.where(s > 0, self.attenuation * np.exp(1j * Omega * s) - tail, tail)
        sine = self.swing / Omega if Omega else 0 * self.swing
        return self.displacement * (received - wave.real) + self.drift * ramp + sine * wave.imag

    @property
    def _at(self) -> float:
        return self.scene.shock.at if self.scene.shock else 0.0

    @property
    def _width(self) -> float:
        return self.scene.shock.width if self.scene.shock else 1.0


def shock_response(scene: Scene) -> ShockResponse:
    """The linear response of the pair, at rest and upright, to the scene's Gaussian pulse; any spins, any bar.

    The error against the exact motion falls as the square of the shock. Without any spin nothing swings: the drift is
    M⁻¹ p. A force along z does nothing to this order.
    Raises InputError without a shock or a bar, when the pair is not at rest upright, or when the pulse began before
    t = 0. Source: 4.2, 5 and 5.2.1 of the paper, where these are read off simulations.
    """
    if not isinstance(scene, Scene) or scene.shock is None or scene.link is None:
        raise InputError(f"shock_response: {scene!r} must be a Scene with a bar and a shock")
    if scene.axes != ((0, 0, 1), (0, 0, 1)) or scene.rates != ((0, 0, 0), (0, 0, 0)):
        raise InputError("shock_response: the pair must start at rest and upright; use simulate for other starts")
    shock = scene.shock
    if shock.at < _WHOLE * shock.width:
        raise InputError(
            f"shock_response: the pulse at {shock.at:g} s of width {shock.width:g} s began before t = 0; "
            f"place it at {_WHOLE * shock.width:g} s or later"
        )
    px, py, _ = (scene.rotor.length * i for i in shock.impulse)
    impulse = np.array([px, py, 0.0] if shock.body == 1 else [px, 0.0, py])
    inertia_a, inertia_b = scene.inertias
    first, second = scene.momenta
    if first == second == 0:
        mass = np.array(impulse_matrices().mass.subs({a: inertia_a, b: inertia_b}), dtype=float)
        drift = np.linalg.solve(mass, impulse)
        gained = float(impulse @ drift) / 2
        zero = np.zeros(3)
        return ShockResponse(scene, 0.0, impulse, zero, drift, zero, 1.0, gained, gained)
    arguments = (inertia_a, inertia_b, first, second, *impulse)
    displacement, drift, swing = (
        np.array(form(*arguments)) for form in (shock_displacement(), shock_drift(), shock_swing())
    )
    along, across = (float(e) for e in shock_energy()(*arguments))
    Omega = float(natural_frequency()(inertia_a, inertia_b, first, second))  # type: ignore[arg-type]
    attenuation = exp(-((Omega * shock.width) ** 2) / 4)
    return ShockResponse(
        scene,
        Omega,
        impulse,
        displacement,
        drift,
        swing,
        attenuation,
        along + attenuation**2 * across,
        along + across,
    )
