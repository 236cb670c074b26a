"""Rung 6: the paper's own simulator, rigid bodies whose vertices are joined by stiff springs of no rest length.

All bodies are stepped at once in stacked arrays, the ground being one more body, whose inverse mass and inverse inertia
are zero. The gaps of the links are one matrix B times the places of centres and body axes, their rates B times the
velocities of these, and Bᵀ takes the links' forces to the bodies. A step costs some forty array calls on a few rows each:
what limits it is the overhead of a call, not the number of bodies or links. `run` repeats it in single numbers.
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
    """Force on vertex 1 of each link, −S (X_1 − X_2) − D (U_1 − U_2), (n, 3) in N; on vertex 2 its opposite (3.20).

    The sound reading of 3.19: linear, smooth where the vertices coincide, which is where a joint is kept, and damping every
    relative motion. Its damper is not central: it exerts the couple D gap × rate, which vanishes with the gap.

    Parameters
    ----------
    gap : Array
        X_1 − X_2, (n, 3), m.
    rate : Array
        U_1 − U_2, (n, 3), m/s.
    S : float
        Stiffness, N/m.
    D : float
        Damping, kg/s.
    """
    return -S * gap - D * rate


def printed_link_force(gap: Array, rate: Array, S: float, D: float) -> Array:
    """Force on vertex 1 of each link, −(S |gap| + D rate · e) e with e = gap/|gap|, (n, 3) in N: 3.19 as printed.

    Read as the only signs that hold together: F_12 is what vertex 1 does to 2, ê_21 points from 2 to 1, and the spring
    term lacks its ê_21. The spring is that of `link_force`; the damper acts along the line of separation only. It
    leaves a gap that circles undamped, and at gap = 0, where every joint starts, e is 0/0 (here 0: no damping there).

    Parameters
    ----------
    gap : Array
        X_1 − X_2, (n, 3), m.
    rate : Array
        U_1 − U_2, (n, 3), m/s.
    S : float
        Stiffness, N/m.
    D : float
        Damping, kg/s.
    """
    size = np.linalg.norm(gap, axis=1, keepdims=True)
    e = gap / (size + (size == 0))
    return -S * gap - D * (rate * e).sum(1, keepdims=True) * e


class RigidBodySystem:
    """Bodies, links between their vertices, and the paper's step. Bodies and vertices count from 1, as in the paper.

    stiffness S in N/m and damping D in kg/s are those of every link. State, one row a body and the ground as the last:
    X, U (n + 1, 3) of the centres, R (n + 1, 3, 3), L (n + 1, 3) about the centres, Omega (n + 1, 3). The ground's L
    gathers what the links have handed to it. `force`, `rotation`, `transform` may be replaced by their printed twins.

    Raises
    ------
    InputError
        For S not above zero, D below zero, no body, a body or vertex that is not there.
    """

    def __init__(
        self,
        bodies: list[RigidBody],
        stiffness: float,
        damping: float,
        *,
        force: _LinkForce = link_force,
        rotation: Callable[[Array, float], Array] = finite_rotation,
        transform: Callable[[Array, Array], Array] = inertia_transform,
    ) -> None:
        self.stiffness = float(finite_array("RigidBodySystem: stiffness", stiffness, ()))
        self.damping = float(finite_array("RigidBodySystem: damping", damping, ()))
        if self.stiffness <= 0 or self.damping < 0 or not bodies:
            raise InputError(
                f"RigidBodySystem: S = {self.stiffness:g} N/m must be above zero, D = {self.damping:g} kg/s not below "
                f"it, and there must be a body ({len(bodies)} given)"
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
        """A lasting force (3,) in N on the centre of mass of `body`, without torque; not counted in any energy."""
        self.external[self._body(body)] += finite_array("add_external: force", force, (3,))

    def link(self, body1: int, body2: int, vertex1: int, vertex2: int) -> None:
        """Join two bodies.

        Parameters
        ----------
        body1 : int
            One.
        body2 : int
            The other.
        vertex1 : int
            Of the one.
        vertex2 : int
            Of the other.
        """
        self._join(self._end(body1, vertex1), self._end(body2, vertex2))

    def ground(self, body: int, vertex: int) -> None:
        """Join `vertex` of `body` to the point of the ground where it now is."""
        i, arm = self._end(body, vertex)
        self._join((i, arm), (len(self.vertices), self.X[i] + self.R[i] @ arm))

    def push(self, body: int, vertex: int, force: ArrayLike, strength: float = 1.0) -> None:
        """Push a body for the step to come: after `compute_forces`, before `step`.

        Parameters
        ----------
        body : int
            Which.
        vertex : int
            Of it.
        force : array_like
            (3,) in N.
        strength : float, default 1.0
            By which it is multiplied.
        """
        i, arm = self._end(body, vertex)
        applied = finite_array("push: force", force, (3,)) * strength
        self.F[i] += applied
        self.tau[i] += skew_matrix(self.R[i] @ arm) @ applied

    def angular_velocity(self) -> Array:
        """Omega = R I₀⁻¹ Rᵀ L, (n + 1, 3) in rad/s: 3.17 in the right frames, from the stored I₀⁻¹."""
        return (self.transform(self.R, self.inverse_inertia) @ self.L[:, :, None])[:, :, 0]

    def compute_forces(self) -> None:
        """F and tau (n + 1, 3): sums of the external and the link forces, and of X_r × F (3.02, 3.06)."""
        gap, rate = self.gaps(self.X, self.R), self.gaps(self.U, skew_matrix(self.Omega) @ self.R)
        pull = self.force(gap, rate, self.stiffness, self.damping)
        # Σ ±F for each body, then Σ ±a_k F for each of its axes e_k: X_r = Σ a_k e_k.
        on_bodies = self._incidence.T.dot(pull).reshape(-1, 4, 3)
        self.F = self.external + on_bodies[:, 0]
        self.tau = turning_sum(self.R @ on_bodies[:, 1:])

    def step(self, dt: float) -> None:
        """The paper's step (3.13, 3.15), in its order: L, U, then with them Omega, X_cm and R. No matrix is inverted.

        Semi-implicit: positions move with the new velocities, which the forces at the old state made.

        Raises
        ------
        InputError
            For a dt not above zero.
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
        """X, U, L (n, 3), R (n, 3, 3) and Omega (n, 3) of the bodies, without the ground, one after the other: (21 n,)."""
        return np.concatenate([array[:-1].ravel() for array in (self.X, self.U, self.L, self.R, self.Omega)])

    def load(self, state: Array) -> None:
        """Put in what `state` gives, for the bodies; Omega is that of L and R where it is left out."""
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
        """How many links there are."""
        return len(self._incidence)

    def joint_mobility(self) -> Array:
        """W (3 n_links, 3 n_links) in 1/kg: acceleration of the gaps by unit forces in the links, at this position.

        W = B M⁻¹ Bᵀ, where the row of B for a vertex at r from its centre is (1, −[r]×): gap rate = B (U, Omega). Its
        3 × 3 blocks on the diagonal are the sums over both ends of 1/M − [r]× I⁻¹ [r]×.
        """
        n, ends = len(self._incidence), self._incidence.reshape(-1, len(self.X), 4)
        share, crossed = ends[..., 0], skew_matrix((self.R @ ends[..., 1:, None])[..., 0])
        turning = self.transform(self.R, self.inverse_inertia)
        pushed = np.einsum("lb,b,mb,ij->limj", share, self.inverse_mass[:, 0], share, np.eye(3))
        rotational = np.einsum("lbij,bjk,mbkn->limn", crossed, turning, crossed)
        return (pushed - rotational).reshape(3 * n, 3 * n)

    def gaps(self, X: Array, R: Array) -> Array:
        """X_1 − X_2 of every link (…, n_links, 3) in m, for stacks of centres (…, n + 1, 3) and rotations.

        Its rate (m/s) for their velocities U and [Omega]× R.
        """
        centres_and_axes = np.concatenate((X[..., None, :], R.swapaxes(-1, -2)), axis=-2)
        return np.asarray(self._incidence @ centres_and_axes.reshape(*X.shape[:-2], -1, 3))

    def _join(self, first: tuple[int, Array], second: tuple[int, Array]) -> None:
        """One more row: for the body of each end ± (1, arm), on the places of its centre and its axes."""
        row = np.zeros((len(self.X), 4))
        for (i, arm), sign in ((first, 1.0), (second, -1.0)):
            row[i] += sign * np.array([1.0, *arm])
        self._incidence = np.vstack((self._incidence, row.ravel()))

    def _body(self, body: int) -> int:
        if isinstance(body, bool) or not isinstance(body, int) or not 1 <= body <= len(self.vertices):
            raise InputError(
                f"RigidBodySystem: body = {body!r} is not there: they count from 1 to {len(self.vertices)}"
            )
        return body - 1

    def _end(self, body: int, vertex: int) -> tuple[int, Array]:
        i = self._body(body)
        n = len(self.vertices[i])
        if isinstance(vertex, bool) or not isinstance(vertex, int) or not 1 <= vertex <= n:
            raise InputError(f"RigidBodySystem: vertex = {vertex!r} of body {body} is not there: they count 1 to {n}")
        return i, self.vertices[i][vertex - 1]


class StepLimit(NamedTuple):
    """Longest stable steps, in s: of all joints together, and of each joint (n_links,) as if the others were cut."""

    whole: float
    joints: Array


def step_limit(system: RigidBodySystem) -> StepLimit:
    """The longest dt with which `step` is stable, from `joint_mobility` at the present position, with `link_force`.

    Linearised, a gap x obeys x'' = −W (S x + D x'). Along an eigenvector of W with eigenvalue w the step reads
    v ← (1 − h w D) v − h w S x, x ← x + h v: a map of determinant 1 − h w D and trace 2 − h w D − h² w S. Its
    eigenvalues lie within the unit circle if and only if h² w S + 2 h w D < 4, that is

        h < 4 / (w D + sqrt((w D)² + 4 w S)),

    which is 2/sqrt(w S) without damping and 2/(w D) for damping alone. The largest w decides.

    Raises
    ------
    InputError
        When the system has no link.
    """
    W = system.joint_mobility()
    if not len(W):
        raise InputError("step_limit: the system has no link, so every step is stable; link or ground a vertex first")
    blocks = [W[3 * j : 3 * j + 3, 3 * j : 3 * j + 3] for j in range(len(W) // 3)]
    w = np.array([np.linalg.eigvalsh(block)[-1] for block in (W, *blocks)])
    S, D = system.stiffness, system.damping
    h = 4 / (w * D + np.sqrt((w * D) ** 2 + 4 * w * S))
    return StepLimit(float(h[0]), h[1:])


TIP = 2  # the vertex of a rotor that bears the bar and the shock; vertex 1 is at the ground


def paper_bodies(scene: Scene, bar_height: float | None = None) -> list[RigidBody]:
    """The bodies of `scene` (listings of 4.1 and 5.2.1): the rotors and, where the scene has one, the bar as the third.

    Rotors: centre half way up the axis, vertices at ∓R/2 along it, inertia diag(I1, I1, I3). Bar: centre midway between the
    tips, vertices at ∓ell/2 along it, inertia K·1 as in the paper: its axial inertia is K too, which has no effect, as no
    force acts off its line.

    bar_height (m) puts the bar's centre at that z instead. The paper's z starts at the rotors' centres (grounds at
    −0.5, tips at 0.5), ours at the ground joints: its right 0.5 is our 1.0, its mistaken 1 (section 4.1) our 1.5.

    Raises
    ------
    InputError
        For a bar without mass or without inertia, which no third body can be.
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
    """The paper's program for a scene: its `paper_bodies`, vertex 1 of each rotor grounded, the bar linked to both tips.

    Parameters
    ----------
    scene : Scene
        Without a bar it gives two rotors and two links.
    stiffness : float
        S, N/m.
    damping : float
        D, kg/s.
    bar_height : float or None, optional
        As in `paper_bodies`, m.
    laws : callable
        The `force`, `rotation` and `transform` of RigidBodySystem.
    """
    system = RigidBodySystem(paper_bodies(scene, bar_height), stiffness, damping, **laws)
    system.ground(2, 1)
    system.ground(1, 1)
    join_bar(system)
    return system


def join_bar(system: RigidBodySystem) -> None:
    """Link the tips of the rotors to the ends of the bar, where there is one."""
    if len(system.vertices) == 3:
        system.link(1, 3, TIP, 1)
        system.link(2, 3, TIP, 2)
