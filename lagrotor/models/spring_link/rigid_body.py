"""A rigid body, how it turns in a finite time, and how its inertia turns with it; each beside what the paper prints.

R (3, 3) takes body components to world components, v = R v_body, and grows by R ← dR R. All functions take stacks.
"""

from dataclasses import dataclass

import numpy as np

from lagrotor.errors import InputError
from lagrotor.numerics.arrays import Array as Array
from lagrotor.numerics.arrays import finite_array
from lagrotor.numerics.rotations import skew_matrix, turn_about

_LEAST = np.finfo(float).smallest_normal
_CLOSE = 1e-9  # how far a given rotation may be from orthogonal, an inertia from symmetric


def finite_rotation(Omega: Array, dt: float) -> Array:
    """dR = 1 + sin(θ) [n]× + (1 − cos θ)(n nᵀ − 1), θ = |Omega| dt, n = Omega/|Omega|: (n, 3) → (n, 3, 3). From 3.15.

    Defined for every Omega: |Omega| is taken by `hypot`, which neither under- nor overflows, and nothing is divided by
    its square. The least normal number added to it changes only an |Omega| near that number: n is then shorter than a unit,
    but sin θ is as small, and so is the error. At Omega = 0 the axis is left at zero, and dR = 1.
    """
    size = np.hypot(np.hypot(Omega[:, 0], Omega[:, 1]), Omega[:, 2])
    return turn_about(Omega / (size + _LEAST)[:, None], size * dt)


def printed_rotation(Omega: Array, dt: float) -> Array:
    """dR = P + cos(θ)(1 − P) + sin(θ) [n]× with P = Omegaᵀ Omega / |Omega|², (n, 3) → (n, 3, 3). From 3.15 and 3.16.

    As the paper's program had it before its repair (section 4.2): where |Omega| is not zero, but |Omega|² underflows to
    zero, P = 0/0 is NaN. (3.16 as printed leaves out the division: it projects only if |Omega| = 1.)
    """
    size = np.hypot(np.hypot(Omega[:, 0], Omega[:, 1]), Omega[:, 2])
    with np.errstate(divide="ignore", invalid="ignore"):
        P = Omega[:, :, None] * Omega[:, None, :] / (Omega**2).sum(1)[:, None, None]
        n = Omega / size[:, None]
        angle = (size * dt)[:, None, None]
        rotation = P + np.cos(angle) * (np.eye(3) - P) + np.sin(angle) * skew_matrix(n)
    return np.where(size[:, None, None] == 0, np.eye(3), rotation)


def inertia_transform(R: Array, tensor: Array) -> Array:
    """World components R I₀ Rᵀ of a tensor given in the body frame, (n, 3, 3) each; for I₀⁻¹ too."""
    return R @ tensor @ R.swapaxes(-1, -2)


def printed_inertia_transform(R: Array, tensor: Array) -> Array:
    """Rᵀ I₀ R, (n, 3, 3) each, as printed in 3.12, 3.17 and 3.18.

    Wrong for R ← dR R (3.15), whose R takes body to world: it would be right for the inverse rotation. An isotropic
    body, all that the paper runs, does not distinguish the two.
    """
    return R.swapaxes(-1, -2) @ tensor @ R


def rotation_between(u: Array, v: Array) -> Array:
    """The shortest rotation (3, 3) that takes the basis vector `u` (3,) to the unit vector `v` (3,)."""
    axis, cosine = np.cross(u, v), float(u @ v)
    sine = float(np.linalg.norm(axis))
    if sine == 0.0:
        axis, sine, angle = np.roll(u, 1), 1.0, 0.0 if cosine > 0 else np.pi
    else:
        angle = float(np.arctan2(sine, cosine))
    rotation: Array = finite_rotation(axis[None] / sine, angle)[0]
    return rotation


@dataclass(frozen=True, eq=False)
class RigidBody:
    """How a body starts: (X_cm, vertices, I₀, R, M, Omega, U) of section 3.2, in the order of the paper's constructor.

    centre X_cm (3,) in m; vertices (n, 3), the points that bear links, from the centre in the body frame, in m; inertia
    I₀ (3, 3) about the centre in the body frame, in kg m²; rotation R (3, 3); mass in kg; angular velocity Omega (3,)
    in rad/s and velocity U (3,) of the centre in m/s, both in world components.

    Raises
    ------
    InputError
        For a mass not above zero, an inertia not symmetric and positive, an R that is no rotation.
    """

    centre: Array
    vertices: Array
    inertia: Array
    rotation: Array
    mass: float
    angular_velocity: Array
    velocity: Array

    def __post_init__(self) -> None:
        shapes = {"centre": (3,), "vertices": (-1, 3), "inertia": (3, 3), "rotation": (3, 3)}
        for name, shape in (shapes | {"angular_velocity": (3,), "velocity": (3,), "mass": ()}).items():
            object.__setattr__(self, name, finite_array(f"RigidBody: {name}", getattr(self, name), shape))
        object.__setattr__(self, "mass", float(self.mass))
        if self.mass <= 0:
            raise InputError(f"RigidBody: mass = {self.mass:g} kg must be greater than zero")
        I0, R = self.inertia, self.rotation
        if abs(I0 - I0.T).max() > _CLOSE * abs(I0).max() or np.linalg.eigvalsh(I0)[0] <= 0:
            raise InputError(f"RigidBody: inertia = {I0.tolist()} must be symmetric, its principal moments above zero")
        if abs(R @ R.T - np.eye(3)).max() > _CLOSE or np.linalg.det(R) < 0:
            raise InputError(f"RigidBody: rotation = {R.tolist()} is no rotation: give R with R Rᵀ = 1 and det R = 1")

    @property
    def momentum(self) -> Array:
        """Angular momentum about the centre, L = R I₀ Rᵀ Omega (3,), in kg m²/s (3.10)."""
        return self.rotation @ self.inertia @ self.rotation.T @ self.angular_velocity
