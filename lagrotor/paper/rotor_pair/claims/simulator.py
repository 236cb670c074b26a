"""Claims of section 3: the finite rotation, the step without inversions, springs in place of joints (C03 to C05)."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from math import inf
from unittest.mock import patch

import numpy as np

from lagrotor.models.simulate import simulate
from lagrotor.models.spring_link.rigid_body import (
    RigidBody,
    finite_rotation,
    inertia_transform,
    printed_inertia_transform,
)
from lagrotor.models.spring_link.run import run_steps
from lagrotor.models.spring_link.system import RigidBodySystem, paper_system
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.curves import measured_order
from lagrotor.numerics.rotations import skew_matrix
from lagrotor.pair.examples import DAMPING, HEAVY_LINK, STEP, STIFFNESS
from lagrotor.pair.scene import Scene
from lagrotor.paper.claim_tests import ClaimTest, Finding, Part
from lagrotor.paper.rotor_pair.shocked_runs import EQUAL, shocked_scene
from lagrotor.shown import scientific

_ROUNDING = 100 * float(np.finfo(float).eps)  # what a few products of 3 × 3 matrices may lose
ENFORCED = 0.1  # a joint is kept where its gap, and the error of the axes, are below a tenth of the motion
INVERTERS = ("inv", "solve", "pinv", "lstsq", "tensorinv", "tensorsolve")  # numpy's ways to invert a matrix

NOT_ORTHOGONAL, ORTHOGONAL = "1 + Δt Ω× is not orthogonal for a finite step", "the Rodrigues rotation is orthogonal"
NO_INVERSION, SOLVED = "a step inverts no matrix", "its Ω is that of the momentum"
LINKED, GROUNDED = "a spring-damper enforces a link", "a ground is a link to a body that never moves"


def _off_orthogonal(matrix: Array) -> float:
    return float(abs(matrix @ matrix.T - np.eye(3)).max())


def _stretch(step: Array) -> float:
    """Relative change of a length after 10,000 steps."""
    return float(np.linalg.norm(np.linalg.matrix_power(step, 10_000)[:, 0])) - 1


def undivided_rotation(Omega: Array, dt: float) -> Array:
    """Rodrigues' rotation with P = Ω Ωᵀ to the letter of (3.16), not divided by |Ω|²: (n, 3) → (n, 3, 3)."""
    size = np.linalg.norm(Omega, axis=1)[:, None, None]
    P = Omega[:, :, None] * Omega[:, None, :]
    turned: Array = P + np.cos(size * dt) * (np.eye(3) - P) + np.sin(size * dt) * skew_matrix(Omega) / size
    return turned


@dataclass(frozen=True)
class OneStep:
    """A step (s), and what is taken for the Rodrigues rotation: (n, 3), s → (n, 3, 3)."""

    dt: float = STEP
    rodrigues: Callable[[Array, float], Array] = finite_rotation


def measure_c03(case: OneStep) -> dict[str, float]:
    """Both rotations over one step of a rotor that spins, and what 10,000 of them do to a length."""
    Omega = np.array([[0.0, 0.0, EQUAL[0]]])
    first_order, rodrigues = np.eye(3) + case.dt * skew_matrix(Omega)[0], case.rodrigues(Omega, case.dt)[0]
    return {
        "first_order_off_orthogonal": _off_orthogonal(first_order),
        "rodrigues_off_orthogonal": _off_orthogonal(rodrigues),
        "first_order_stretch_in_10_s": _stretch(first_order),
        "rodrigues_stretch_in_10_s": abs(_stretch(rodrigues)),
        "rodrigues_with_P_as_printed_off_orthogonal": _off_orthogonal(undivided_rotation(Omega, case.dt)[0]),
    }


def decide_c03(m: Mapping[str, float]) -> Finding:
    """How far each rotation of one step is from orthogonal, against rounding."""
    return Finding(
        (
            Part(NOT_ORTHOGONAL, m["first_order_off_orthogonal"] > _ROUNDING),
            Part(ORTHOGONAL, m["rodrigues_off_orthogonal"] < _ROUNDING),
        ),
        f"One step is off orthogonal by {scientific(m['first_order_off_orthogonal'])} to first order and by "
        f"{scientific(m['rodrigues_off_orthogonal'])} by Rodrigues; in 10,000 steps the first stretches a body by "
        f"{m['first_order_stretch_in_10_s']:.0%}, the second by {scientific(m['rodrigues_stretch_in_10_s'])}. With P = Ω Ωᵀ "
        "to the letter of (3.16), not divided by |Ω|², it would be off by "
        f"{scientific(m['rodrigues_with_P_as_printed_off_orthogonal'])}.",
    )


def inverted_each_time(R: Array, inverse_inertia: Array) -> Array:
    """(R I₀ Rᵀ)⁻¹ with I₀⁻¹ not stored: the inertia is turned and inverted at each step."""
    inertia: Array = np.linalg.pinv(inverse_inertia).astype(float)
    inverse: Array = np.linalg.pinv(inertia_transform(R, inertia)).astype(float)
    return inverse


def measure_c04(transform: Callable[[Array, Array], Array]) -> dict[str, float]:
    """Inversions in a hundred steps of the paper's bodies and of a free one of unequal inertia; Ω of the free one."""
    inertia = np.diag([1.0, 2.0, 2.5])
    start = np.array([0.3, 0.5, 1.0]) * EQUAL[0]
    body = RigidBody(np.zeros(3), [[0, 0, 1]], inertia, np.eye(3), 1.0, start, np.zeros(3))  # type: ignore[arg-type]
    free = RigidBodySystem([body], 1.0, 0.0, transform=transform)
    paper = paper_system(Scene(EQUAL, link=HEAVY_LINK), STIFFNESS, DAMPING, transform=transform)
    with ExitStack() as stack:
        counters = [stack.enter_context(patch.object(np.linalg, k, wraps=getattr(np.linalg, k))) for k in INVERTERS]
        for system in (free, paper):
            for _ in range(100):
                system.compute_forces()
                system.step(STEP)
        inversions = sum(counter.call_count for counter in counters)
    R, L = free.R[0], free.L[0]
    solved = np.linalg.solve(R @ inertia @ R.T, L)
    printed = printed_inertia_transform(free.R, free.inverse_inertia)[0] @ L
    return {
        "inversions_in_200_steps": inversions,
        "inertia_changed_by_kg_m2": abs(R @ inertia @ R.T - inertia).max(),
        "off_the_solved_omega_relative": np.linalg.norm(free.angular_velocity()[0] - solved) / np.linalg.norm(solved),
        "off_with_the_printed_transform_relative": np.linalg.norm(printed - solved) / np.linalg.norm(solved),
    }


def decide_c04(m: Mapping[str, float]) -> Finding:
    """The count of inversions, and the step's Ω against the solution of R I₀ Rᵀ Ω = L."""
    return Finding(
        (
            Part(NO_INVERSION, m["inversions_in_200_steps"] == 0),
            Part(SOLVED, m["off_the_solved_omega_relative"] < _ROUNDING),
        ),
        f"In 200 steps {m['inversions_in_200_steps']:.0f} matrices are inverted, while the inertia changes by "
        f"{m['inertia_changed_by_kg_m2']:.2f} kg m²; Ω agrees with the solved one to "
        f"{scientific(m['off_the_solved_omega_relative'])}. The transform must be R I₀⁻¹ Rᵀ: the printed Rᵀ I₀⁻¹ R gives a "
        f"body of unequal inertia an Ω off by {m['off_with_the_printed_transform_relative']:.0%} after 0.1 s.",
    )


@dataclass(frozen=True)
class Sprung:
    """Stiffness of the links (N/m), and the mass of the ground (kg): without bound, or that of a body that can move."""

    stiffness: float = STIFFNESS
    ground_mass: float = inf


def measure_c05(case: Sprung) -> dict[str, float]:
    """The shocked equal pair joined by springs of a quarter, half and the whole stiffness, against the exact pair."""
    scene = shocked_scene(EQUAL, (50, 0, 0))
    t = np.round(np.arange(0, 1.2005, 2e-3), 3)
    exact = simulate(scene, t, "spheres", 1e-9)
    stiffnesses = case.stiffness * np.array([0.25, 0.5, 1.0])
    errors, gaps, ground = [], [], 0.0
    for S in stiffnesses:
        system = paper_system(scene, float(S), float(S) * DAMPING / STIFFNESS)
        system.inverse_mass[-1] = 1 / case.ground_mass
        run = run_steps(system, scene.shock, t, STEP)
        errors.append(abs(run.axes - exact.axes).max())
        gaps.append(run.stretches.max())
        for _ in range(50):
            system.compute_forces()
            system.push(1, 2, (50, 0, 0))
            system.step(STEP)
        ground = max(ground, abs(system.X[-1]).max(), abs(system.R[-1] - np.eye(3)).max())
    moved = abs(exact.axes[..., :2]).max()
    return {
        "stiffness_N_per_m": case.stiffness,
        "largest_gap_m": gaps[-1],
        "gap_over_motion_of_tips": gaps[-1] / (scene.rotor.length * moved),
        "error_over_motion": errors[-1] / moved,
        "power_of_stiffness_in_error": measured_order(stiffnesses, errors),
        "power_of_stiffness_in_gap": measured_order(stiffnesses, gaps),
        "ground_moved_m": ground,
    }


def decide_c05(m: Mapping[str, float]) -> Finding:
    """The gaps of the links and the error of the axes, both over the motion; what the ground moved."""
    kept = max(m["gap_over_motion_of_tips"], m["error_over_motion"]) < ENFORCED
    needs = "the springs are stiff, faster than the motion: the link is exact only as S grows without bound"
    return Finding(
        (
            Part(LINKED, kept and m["largest_gap_m"] == 0, needs if kept else ""),
            Part(GROUNDED, m["ground_moved_m"] == 0),
        ),
        f"Enforced is to a tenth of the motion. At S = {m['stiffness_N_per_m']:.0f} N/m, in the second after the shock, the "
        f"gaps reach {1e3 * m['largest_gap_m']:.1f} mm, "
        f"{m['gap_over_motion_of_tips']:.1%} of the motion of the tips, and the axes are off by {m['error_over_motion']:.1%} "
        f"of theirs. The gap goes as S to the power {m['power_of_stiffness_in_gap']:.2f}, the error to the power "
        f"{m['power_of_stiffness_in_error']:.2f}. The ground moved by {m['ground_moved_m']:g} m.",
    )


# C03: at 10⁻⁹ s the step is finite no more, for double precision; (3.16) to the letter is no rotation. C05: springs of 100 N/m
# are slower than the motion; a ground of 1000 kg is a body that moves.
C03 = ClaimTest(
    "C03",
    OneStep(),
    {NOT_ORTHOGONAL: OneStep(1e-9), ORTHOGONAL: OneStep(rodrigues=undivided_rotation)},
    "one step of a rigid body",
    measure_c03,
    decide_c03,
    unproved="it is about rounding in the steps of a program",
)
C04 = ClaimTest(
    "C04",
    inertia_transform,
    {NO_INVERSION: inverted_each_time, SOLVED: printed_inertia_transform},
    "spring-linked bodies, and one free body of unequal inertia",
    measure_c04,
    decide_c04,
    unproved="it is about the steps of a program",
)
C05 = ClaimTest(
    "C05",
    Sprung(),
    {LINKED: Sprung(100.0), GROUNDED: Sprung(ground_mass=1000.0)},
    "spring-linked bodies against the exact pair",
    measure_c05,
    decide_c05,
    unproved="it is about the springs of the paper's program",
)
