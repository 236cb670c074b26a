"""A rigid body, its rotation in a finite time, and the rotation of its inertia, each also as the paper prints it.

The rotation R (3, 3) takes body components to world components, v = R v_body. A step changes it by R ← dR R. All functions take
stacks of n bodies.
"""

from dataclasses import dataclass

import numpy as np

from lagrotor.errors import InputError
from lagrotor.numerics.arrays import Array as Array
from lagrotor.numerics.arrays import finite_array
from lagrotor.numerics.rotations import skew_matrix, turn_about

_LEAST = np.finfo(float).smallest_normal
_CLOSE = 1e-9  # tolerance for an orthogonal rotation and a symmetric inertia


def finite_rotation(Omega: Array, dt: float) -> Array:
    """Return the rotation matrices of a constant angular velocity.

    dR = 1 + sin(θ) [n]× + (1 − cos θ)(n nᵀ − 1), θ = |Omega| dt, n = Omega/|Omega|. `hypot` avoids under- and overflow of
    |Omega|. The smallest normal number is added to |Omega|, so that dR = 1 at Omega = 0. It changes other results only if
    |Omega| is as small.

    Parameters
    ----------
    Omega : Array
        The angular velocities, (n, 3), rad/s.
    dt : float
        The time, s.

    Returns
    -------
    Array
        The rotations dR, (n, 3, 3).
    """
    size = np.hypot(np.hypot(Omega[:, 0], Omega[:, 1]), Omega[:, 2])
    return turn_about(Omega / (size + _LEAST)[:, None], size * dt)


def printed_rotation(Omega: Array, dt: float) -> Array:
    """Return dR = P + cos(θ)(1 − P) + sin(θ) [n]× with P = Omegaᵀ Omega / |Omega|², from equations 3.15 and 3.16.

    Omega is (n, 3) and dR (n, 3, 3). The paper's program had this form before its repair (section 4.2): P is NaN if |Omega|²
    underflows to zero. Equation 3.16 as printed lacks the division, and is a projection only if |Omega| = 1.
    """
    size = np.hypot(np.hypot(Omega[:, 0], Omega[:, 1]), Omega[:, 2])
    with np.errstate(divide="ignore", invalid="ignore"):
        P = Omega[:, :, None] * Omega[:, None, :] / (Omega**2).sum(1)[:, None, None]
        n = Omega / size[:, None]
        angle = (size * dt)[:, None, None]
        rotation = P + np.cos(angle) * (np.eye(3) - P) + np.sin(angle) * skew_matrix(n)
    return np.where(size[:, None, None] == 0, np.eye(3), rotation)


def inertia_transform(R: Array, tensor: Array) -> Array:
    """Return the world components R I₀ Rᵀ of a tensor I₀ given in the body frame, (n, 3, 3). I₀ may also be an inverse."""
    return R @ tensor @ R.swapaxes(-1, -2)


def printed_inertia_transform(R: Array, tensor: Array) -> Array:
    """Return Rᵀ I₀ R, (n, 3, 3), as printed in 3.12, 3.17 and 3.18.

    It is wrong for the R of R ← dR R (3.15), which takes body to world components, and right for the inverse of R. For the
    isotropic bodies that the paper runs, both forms agree.
    """
    return R.swapaxes(-1, -2) @ tensor @ R


def rotation_between(u: Array, v: Array) -> Array:
    """Return the shortest rotation (3, 3) that takes the basis vector `u` (3,) to the unit vector `v` (3,)."""
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
    """The initial state of a body, in the order of the paper's constructor (section 3.2).

    Attributes
    ----------
    centre : Array
        The centre of mass X_cm, (3,), m.
    vertices : Array
        The points that bear links, from the centre in the body frame, (n, 3), m.
    inertia : Array
        The inertia I₀ about the centre in the body frame, (3, 3), kg m².
    rotation : Array
        The rotation R from body to world, (3, 3).
    mass : float
        The mass, kg.
    angular_velocity : Array
        The angular velocity Omega in world components, (3,), rad/s.
    velocity : Array
        The velocity U of the centre in world components, (3,), m/s.
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
            raise InputError(f"RigidBody: inertia = {I0.tolist()} must be symmetric with principal moments above zero")
        if abs(R @ R.T - np.eye(3)).max() > _CLOSE or np.linalg.det(R) < 0:
            raise InputError(f"RigidBody: rotation = {R.tolist()} is no rotation: give R with R Rᵀ = 1 and det R = 1")

    @property
    def momentum(self) -> Array:
        """The angular momentum about the centre, L = R I₀ Rᵀ Omega (3,), kg m²/s (3.10)."""
        return self.rotation @ self.inertia @ self.rotation.T @ self.angular_velocity
