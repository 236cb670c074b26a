"""Rung 6: the paper's own simulator, rigid bodies whose vertices are joined by stiff springs of zero length.

All bodies are stepped at once in stacked arrays. The ground is one more body, with zero inverse mass and inverse inertia. One
matrix B maps the positions of centres and body axes to the gaps of the links, and their velocities to the rates of the gaps.
Its transpose Bᵀ maps the forces of the links to the bodies. A step costs some forty calls on a few rows each, so that the
overhead of a call dominates. The module `run` repeats the step in scalar code.
"""

from collections.abc import Callable
from math import isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError
from lagrotor.models.spring_link.rigid_body import (
    Array,
    RigidBody,
    finite_rotation,
    inertia_transform,
    rotation_between,
)
from lagrotor.numerics.arrays import finite_array
from lagrotor.numerics.rotations import skew_matrix, turning_sum
from lagrotor.pair.scene import Link, Scene

_LinkForce = Callable[[Array, Array, float, float], Array]


def link_force(gap: Array, rate: Array, S: float, D: float) -> Array:
    """Return the force −S (X_1 − X_2) − D (U_1 − U_2) on vertex 1 of each link. Vertex 2 bears the opposite force (3.20).

    This is the consistent reading of 3.19. It is linear, smooth at zero gap, where a joint is kept, and damps every relative
    motion. The damper is not central: it exerts the couple D gap × rate, which vanishes with the gap.

    Parameters
    ----------
    gap, rate : Array
        X_1 − X_2 in m and U_1 − U_2 in m/s, (n, 3).
    S, D : float
        The stiffness, N/m, and the damping, kg/s.

    Returns
    -------
    Array
        The forces, (n, 3), N.
    """
    return -S * gap - D * rate


class RigidBodySystem:
    """Bodies, links between their vertices, and the paper's step. Bodies and vertices count from 1, as in the paper.

    The state has one row per body, and the ground is the last row. X and U, (n + 1, 3), are the positions and velocities of the
    centres, and R, (n + 1, 3, 3), the rotations. L, (n + 1, 3), are the angular momenta about the centres and Omega, (n + 1,
    3), the angular velocities. The L of the ground collects the momentum that it receives from the links.

    Parameters
    ----------
    bodies : list of RigidBody
        The bodies.
    stiffness, damping : float
        The stiffness S > 0, N/m, and the damping D, kg/s, of every link.
    force, rotation, transform : callable
        The force of a link, the finite rotation, and the rotation of the inertia. The `printed_*` functions are the
        alternatives.
    """

    def __init__(
        self, bodies: list[RigidBody], stiffness: float, damping: float, *, force: _LinkForce = link_force,
        rotation: Callable[[Array, float], Array] = finite_rotation,
        transform: Callable[[Array, Array], Array] = inertia_transform,
    ) -> None:  # fmt: skip
        self.stiffness = float(finite_array("RigidBodySystem: stiffness", stiffness, ()))
        self.damping = float(finite_array("RigidBodySystem: damping", damping, ()))
        if self.stiffness <= 0 or self.damping < 0 or not bodies:
            raise InputError(
                f"RigidBodySystem: S = {self.stiffness:g} N/m must be above zero, D = {self.damping:g} kg/s must not "
                f"be negative, and there must be a body ({len(bodies)} given)"
            )
        self.force, self.rotation, self.transform = force, rotation, transform
        self.vertices = [body.vertices for body in bodies]
        nothing, identity = np.zeros((1, 3)), np.eye(3)[None]
        self.X = np.vstack([*(body.centre for body in bodies), nothing])
        self.U = np.vstack([*(body.velocity for body in bodies), nothing])
        self.L = np.vstack([*(body.momentum for body in bodies), nothing])
        self.R = np.concatenate([*(body.rotation[None] for body in bodies), identity])
        self.inverse_mass = np.array([*(1 / body.mass for body in bodies), 0.0])[:, None]
        self.inverse_inertia = np.concatenate([*(np.linalg.inv(body.inertia)[None] for body in bodies), 0 * identity])
        self.external = np.zeros_like(self.X)
        self.F, self.tau = np.zeros_like(self.X), np.zeros_like(self.X)
        self.Omega = self.angular_velocity()
        self._incidence = np.empty((0, 4 * len(self.X)))

    def add_external(self, body: int, force: ArrayLike) -> None:
        """Add a constant force at the centre of mass of a body. The energies of a run do not include its potential.

        Parameters
        ----------
        body : int
            The body, from 1.
        force : array_like
            The force, (3,), N.
        """
        self.external[self._body(body)] += finite_array("add_external: force", force, (3,))

    def link(self, body1: int, body2: int, vertex1: int, vertex2: int) -> None:
        """Join a vertex of one body to a vertex of another.

        Parameters
        ----------
        body1, body2 : int
            The bodies, from 1.
        vertex1, vertex2 : int
            Their vertices, from 1.
        """
        self._join(self._end(body1, vertex1), self._end(body2, vertex2))

    def ground(self, body: int, vertex: int) -> None:
        """Join a vertex to the point of the ground at its present position.

        Parameters
        ----------
        body, vertex : int
            The body and its vertex, from 1.
        """
        i, arm = self._end(body, vertex)
        self._join((i, arm), (len(self.vertices), self.X[i] + self.R[i] @ arm))

    def push(self, body: int, vertex: int, force: ArrayLike, strength: float = 1.0) -> None:
        """Add a force on a vertex for the next step. This call belongs between `compute_forces` and `step`.

        Parameters
        ----------
        body, vertex : int
            The body and its vertex, from 1.
        force : array_like
            The force, (3,), N.
        strength : float, default 1.0
            A factor on the force.
        """
        i, arm = self._end(body, vertex)
        applied = finite_array("push: force", force, (3,)) * strength
        self.F[i] += applied
        self.tau[i] += skew_matrix(self.R[i] @ arm) @ applied

    def angular_velocity(self) -> Array:
        """Return Omega = R I₀⁻¹ Rᵀ L (3.17) from the stored I₀⁻¹.

        Returns
        -------
        Array
            The angular velocities in world components, (n + 1, 3), rad/s.
        """
        return (self.transform(self.R, self.inverse_inertia) @ self.L[:, :, None])[:, :, 0]

    def compute_forces(self) -> None:
        """Compute the total force F and torque tau about the centre of each body, (n + 1, 3) each (3.02, 3.06)."""
        gap, rate = self.gaps(self.X, self.R), self.gaps(self.U, skew_matrix(self.Omega) @ self.R)
        pull = self.force(gap, rate, self.stiffness, self.damping)
        # Σ ±F of each body, and Σ ±a_k F of each of its axes e_k, where X_r = Σ a_k e_k.
        on_bodies = self._incidence.T.dot(pull).reshape(-1, 4, 3)
        self.F = self.external + on_bodies[:, 0]
        self.tau = turning_sum(self.R @ on_bodies[:, 1:])

    def step(self, dt: float) -> None:
        """Take the paper's step (3.13, 3.15): update L and U first, then Omega, X_cm and R from the new values.

        It is semi-implicit: positions change with the new velocities. No matrix is inverted.

        Parameters
        ----------
        dt : float
            The step, s.
        """
        if not (isfinite(dt) and dt > 0):
            raise InputError(f"step: dt = {dt!r} s must be a finite number above zero")
        self.L += self.tau * dt
        self.U += self.F * self.inverse_mass * dt
        self.Omega = self.angular_velocity()
        self.X += self.U * dt
        self.R = np.concatenate((self.rotation(self.Omega[:-1], dt) @ self.R[:-1], self.R[-1:]))

    @property
    def state(self) -> Array:
        """The arrays X, U, L (n, 3), R (n, 3, 3) and Omega (n, 3) of the bodies in one row, (21 n,)."""
        return np.concatenate([array[:-1].ravel() for array in (self.X, self.U, self.L, self.R, self.Omega)])

    def load(self, state: Array) -> None:
        """Set the state of the bodies.

        Parameters
        ----------
        state : Array
            The row of `state`, (21n,), or its first 18n numbers. Omega then follows from L and R.
        """
        n = len(self.vertices)
        X, U, L = state[: 9 * n].reshape(3, n, 3)
        self.X, self.U, self.L = (
            np.concatenate((array, ground[-1:])) for array, ground in ((X, self.X), (U, self.U), (L, self.L))
        )
        self.R = np.concatenate((state[9 * n : 18 * n].reshape(n, 3, 3), self.R[-1:]))
        rates = state[18 * n :].reshape(-1, 3)
        self.Omega = np.concatenate((rates, self.Omega[-1:])) if len(rates) else self.angular_velocity()

    @property
    def joints(self) -> int:
        """The number of links."""
        return len(self._incidence)

    def joint_mobility(self) -> Array:
        """Return the matrix of the accelerations of the gaps that unit forces in the links cause.

        W = B M⁻¹ Bᵀ, where the row of B for a vertex at r from its centre is (1, −[r]×): gap rate = B (U, Omega). Its
        diagonal 3 × 3 blocks are the sums over both ends of 1/M − [r]× I⁻¹ [r]×.

        Returns
        -------
        Array
            The matrix W at the present positions, (3 n_links, 3 n_links), 1/kg.
        """
        n, ends = len(self._incidence), self._incidence.reshape(-1, len(self.X), 4)
        share, crossed = ends[..., 0], skew_matrix((self.R @ ends[..., 1:, None])[..., 0])
        turning = self.transform(self.R, self.inverse_inertia)
        pushed = np.einsum("lb,b,mb,ij->limj", share, self.inverse_mass[:, 0], share, np.eye(3))
        rotational = np.einsum("lbij,bjk,mbkn->limn", crossed, turning, crossed)
        return (pushed - rotational).reshape(3 * n, 3 * n)

    def gaps(self, X: Array, R: Array) -> Array:
        """Return the gap X_1 − X_2 of every link. With the velocities U and [Omega]× R as X and R, its rate is returned.

        Parameters
        ----------
        X, R : Array
            The centres, (…, n + 1, 3), m, and the rotations, (…, n + 1, 3, 3).

        Returns
        -------
        Array
            The gaps, (…, n_links, 3), m.
        """
        centres_and_axes = np.concatenate((X[..., None, :], R.swapaxes(-1, -2)), axis=-2)
        return np.asarray(self._incidence @ centres_and_axes.reshape(*X.shape[:-2], -1, 3))

    def _join(self, first: tuple[int, Array], second: tuple[int, Array]) -> None:
        """Add a link as one row of the matrix B, with the entries ± (1, arm) for the centre and the axes of each end's body."""
        row = np.zeros((len(self.X), 4))
        for (i, arm), sign in ((first, 1.0), (second, -1.0)):
            row[i] += sign * np.array([1.0, *arm])
        self._incidence = np.vstack((self._incidence, row.ravel()))

    def _body(self, body: int) -> int:
        if isinstance(body, bool) or not isinstance(body, int) or not 1 <= body <= len(self.vertices):
            raise InputError(
                f"RigidBodySystem: body = {body!r} is not there: bodies count from 1 to {len(self.vertices)}"
            )
        return body - 1

    def _end(self, body: int, vertex: int) -> tuple[int, Array]:
        i = self._body(body)
        n = len(self.vertices[i])
        if isinstance(vertex, bool) or not isinstance(vertex, int) or not 1 <= vertex <= n:
            raise InputError(f"RigidBodySystem: vertex = {vertex!r} of body {body} is not there: give 1 to {n}")
        return i, self.vertices[i][vertex - 1]


class StepLimit(NamedTuple):
    """The longest stable step of all joints together, `whole`, and of each joint alone, `joints` (n_links,), in s."""

    whole: float
    joints: Array


def step_limit(system: RigidBodySystem) -> StepLimit:
    """Return the longest dt with which `step` is stable with `link_force` at the present position.

    Linearised, a gap x obeys x'' = −W (S x + D x'). Along an eigenvector of W with eigenvalue w the step is v ← (1 − h w D) v
    − h w S x, x ← x + h v, a map of determinant 1 − h w D and trace 2 − h w D − h² w S. It is stable if and only if h² w S +
    2 h w D < 4, that is

        h < 4 / (w D + sqrt((w D)² + 4 w S)),

    which is 2/sqrt(w S) without damping and 2/(w D) for damping alone. The largest w decides.

    Parameters
    ----------
    system : RigidBodySystem
        The bodies and links.

    Returns
    -------
    StepLimit
        The limit of the system, and of each joint, s.
    """
    W = system.joint_mobility()
    if not len(W):
        raise InputError("step_limit: the system has no link, so every step is stable; link or ground a vertex first")
    blocks = [W[3 * j : 3 * j + 3, 3 * j : 3 * j + 3] for j in range(len(W) // 3)]
    w = np.array([np.linalg.eigvalsh(block)[-1] for block in (W, *blocks)])
    S, D = system.stiffness, system.damping
    h = 4 / (w * D + np.sqrt((w * D) ** 2 + 4 * w * S))
    return StepLimit(float(h[0]), h[1:])


TIP = 2  # the vertex of a rotor with the bar and the shock; vertex 1 is grounded


def paper_bodies(scene: Scene, bar_height: float | None = None) -> list[RigidBody]:
    """Return the bodies of a scene (listings of 4.1 and 5.2.1): the rotors and, if the scene has one, the bar as the third.

    A rotor has its centre at the middle of the axis, vertices at ∓R/2 along the axis, and the inertia diag(I1, I1, I3). The bar
    has its centre midway between the tips, vertices at ∓ell/2, and the inertia K·1 as in the paper; its axial inertia has no
    effect. `bar_height` (m) replaces the z of its centre. The paper's z starts at the centres of the rotors, ours at the
    joints: its correct 0.5 is our 1.0, and its mistaken 1 (section 4.1) is our 1.5. Raises InputError for a bar without mass or
    inertia.
    """
    rotor, link = scene.rotor, scene.link
    half = (link.length if link else rotor.length) / 2
    inertia, ends = np.diag([rotor.I1, rotor.I1, rotor.I3]), rotor.length / 2 * np.array([[0, 0, -1.0], [0, 0, 1.0]])
    bodies = []
    for r, v, spin, x in zip(np.array(scene.axes), np.array(scene.rates), scene.spins, (-half, half), strict=True):
        centre, R = np.array([x, 0, 0]) + rotor.length / 2 * r, rotation_between(np.array([0, 0, 1.0]), r)
        bodies.append(RigidBody(centre, ends, inertia, R, rotor.mass, np.cross(r, v) + spin * r, rotor.length / 2 * v))
    return bodies if link is None else [*bodies, _bar(scene, link, bar_height)]


def _bar(scene: Scene, link: Link, height: float | None) -> RigidBody:
    if not (link.mass > 0 and link.inertia > 0):
        raise InputError(
            f"paper_bodies: a bar of mass {link.mass:g} kg and inertia {link.inertia:g} kg m² cannot be a third body, "
            "moved by force over mass; give it both, as Link(mass=0.01, inertia=0.1), or use lagrotor.simulate"
        )
    R, axes, rates = scene.rotor.length, np.array(scene.axes), np.array(scene.rates)
    centre = R * axes.mean(0)
    centre[2] = centre[2] if height is None else height
    e = np.array([1.0, 0, 0]) + R / link.length * (axes[1] - axes[0])
    e /= np.linalg.norm(e)
    Omega = np.cross(e, R / link.length * (rates[1] - rates[0]))
    ends = link.length / 2 * np.array([[-1.0, 0, 0], [1.0, 0, 0]])
    rotation = rotation_between(np.array([1.0, 0, 0]), e)
    return RigidBody(centre, ends, link.inertia * np.eye(3), rotation, link.mass, Omega, R * rates.mean(0))


def paper_system(
    scene: Scene, stiffness: float, damping: float, bar_height: float | None = None, **laws: Callable[..., Array]
) -> RigidBodySystem:
    """Return the paper's program for a scene: vertex 1 of each rotor is grounded, and the bar joins both tips.

    Parameters
    ----------
    scene : Scene
        The pair. Without a bar it gives two rotors and two links.
    stiffness, damping : float
        The stiffness S, N/m, and the damping D, kg/s, of every link.
    bar_height : float or None, optional
        Another height of the centre of the bar, m, as in section 4.1 of the paper.
    **laws : callable
        The `force`, `rotation` and `transform` of `RigidBodySystem`.

    Returns
    -------
    RigidBodySystem
        The bodies and links.

    Examples
    --------
    >>> from lagrotor import Link, Scene
    >>> paper_system(Scene(spins=(10, -10), link=Link(mass=0.01, inertia=0.1)), 1e4, 10.0).joints
    4
    """
    system = RigidBodySystem(paper_bodies(scene, bar_height), stiffness, damping, **laws)
    system.ground(2, 1)
    system.ground(1, 1)
    join_bar(system)
    return system


def join_bar(system: RigidBodySystem) -> None:
    """Link the tips of the rotors to the ends of the bar, if there is one."""
    if len(system.vertices) == 3:
        system.link(1, 3, TIP, 1)
        system.link(2, 3, TIP, 2)
