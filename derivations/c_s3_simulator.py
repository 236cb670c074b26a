# %% [markdown]
# # Claims of section 3: the simulator (C03 to C05)
#
# **Objective.** The finite rotation, the step without inversions, and springs in place of joints.
#
# **Assumptions.** The paper's step of 1 ms. Its stiffness and damping are $S = 2000(M/n)\omega_s^2$,
# $D = 500(M/n)\omega_s$ with $n$ and $\omega_s$ not given: n = 20, $\omega_s$ = 10 make them 10⁴ N/m and 250 kg/s (C08).

# %%
from contextlib import ExitStack
from unittest.mock import patch

import numpy as np

from lagrotor import Link, Scene, Shock, simulate
from lagrotor.models.spring_link.rigid_body import RigidBody, finite_rotation, printed_inertia_transform
from lagrotor.models.spring_link.run import paper_system, run_steps
from lagrotor.models.spring_link.system import RigidBodySystem
from lagrotor.numerics.convergence import measured_order
from lagrotor.numerics.rotations import cross_matrix
from lagrotor.paper.claim_tests import ClaimTest, Finding

BAR, DT, S, D = Link(mass=1, inertia=1), 1e-3, 1e4, 250.0
ROUNDING = 100 * np.finfo(float).eps  # what a few products of 3 × 3 matrices may lose
Scene((10, 10), link=BAR)

# %% [markdown]
# ## C03: orthogonality
#
# At the paper's spin and step; then ten seconds of steps, as in its runs.


# %%
def off_orthogonal(matrix):
    return float(abs(matrix @ matrix.T - np.eye(3)).max())


def measure_c03(spins):
    Omega = np.array([[0.0, 0.0, spins[0]]])
    first_order, rodrigues = np.eye(3) + DT * cross_matrix(Omega)[0], finite_rotation(Omega, DT)[0]
    n, angle = Omega[0] / (np.linalg.norm(Omega) or 1.0), np.linalg.norm(Omega) * DT
    P = np.outer(Omega, Omega)  # (3.16) to the letter: not divided by |Omega|²
    printed = P + np.cos(angle) * (np.eye(3) - P) + np.sin(angle) * cross_matrix(n[None])[0]
    return {
        "first_order_off_orthogonal": off_orthogonal(first_order),
        "rodrigues_off_orthogonal": off_orthogonal(rodrigues),
        "first_order_stretch_in_10_s": np.linalg.norm(np.linalg.matrix_power(first_order, 10_000)[:, 0]) - 1,
        "rodrigues_stretch_in_10_s": abs(np.linalg.norm(np.linalg.matrix_power(rodrigues, 10_000)[:, 0]) - 1),
        "rodrigues_with_P_as_printed_off_orthogonal": off_orthogonal(printed),
    }


def decide_c03(m):
    how = (
        f"One step is off orthogonal by {m['first_order_off_orthogonal']:.1e} to first order and by "
        f"{m['rodrigues_off_orthogonal']:.0e} by Rodrigues; in 10 s the first stretches a body by "
        f"{m['first_order_stretch_in_10_s']:.0%}, the second by {m['rodrigues_stretch_in_10_s']:.0e}. With P = Omega "
        "Omega^T to the letter of (3.16), undivided, it would be off by "
        f"{m['rodrigues_with_P_as_printed_off_orthogonal']:.1e}."
    )
    kept = m["rodrigues_off_orthogonal"] < ROUNDING
    return Finding("confirmed" if m["first_order_off_orthogonal"] > ROUNDING and kept else "refuted", how)


measure_c03((10, 10))

# %% [markdown]
# ## C04: no inversion in a step
#
# All of numpy's ways to invert or solve are counted during a hundred steps of the paper's three bodies and of one free
# body of unequal inertia, whose Omega is then compared with the solution of $R I_0 R^T\Omega = L$. A body that does not
# turn keeps its inertia, and there is nothing to invert: the claim is empty.

# %%
INVERTERS = ("inv", "solve", "pinv", "lstsq", "tensorinv", "tensorsolve")


def measure_c04(spins):
    inertia = np.diag([1.0, 2.0, 2.5])
    start = np.array([0.3, 0.5, 1.0]) * spins[0]
    body = RigidBody(np.zeros(3), [[0, 0, 1]], inertia, np.eye(3), 1.0, start, np.zeros(3))
    systems = [RigidBodySystem([body], 1.0, 0.0), paper_system(Scene(spins, link=BAR), S, D)]
    with ExitStack() as stack:
        counters = [stack.enter_context(patch.object(np.linalg, k, wraps=getattr(np.linalg, k))) for k in INVERTERS]
        for system in systems:
            for _ in range(100):
                system.compute_forces()
                system.step(DT)
        inversions = sum(counter.call_count for counter in counters)
    free = systems[0]
    free.Omega, R, L = free.angular_velocity(), free.R[0], free.L[0]
    solved, size = np.linalg.solve(R @ inertia @ R.T, L), max(float(np.linalg.norm(L)), 1e-300)
    printed = printed_inertia_transform(free.R, free.inverse_inertia)[0] @ L
    return {
        "inversions_in_200_steps": inversions,
        "inertia_changed_by_kg_m2": abs(R @ inertia @ R.T - inertia).max(),
        "off_the_solved_omega_relative": np.linalg.norm(free.Omega[0] - solved) / size,
        "off_with_the_printed_transform_relative": np.linalg.norm(printed - solved) / size,
    }


def decide_c04(m):
    if m["inversions_in_200_steps"] or m["off_the_solved_omega_relative"] > ROUNDING:
        return Finding("refuted", f"{m['inversions_in_200_steps']:.0f} inversions were counted.")
    if m["inertia_changed_by_kg_m2"] < ROUNDING:
        return Finding("confirmed-if", "Nothing turned, so nothing had to be inverted.", "empty: no body turns")
    return Finding(
        "confirmed",
        f"{m['inversions_in_200_steps']:.0f} inversions in 200 steps, while the inertia changed by "
        f"{m['inertia_changed_by_kg_m2']:.2f} kg m²; Omega agrees with the solved one to "
        f"{m['off_the_solved_omega_relative']:.0e}. The transform must be R I^-1 R^T: the printed R^T I^-1 R gives a "
        f"body of unequal inertia an Omega off by {m['off_with_the_printed_transform_relative']:.0%} after 0.1 s.",
    )


# %% [markdown]
# ## C05: springs as joints
#
# The equal pair with the shock of section 4.2, against the exact pair with a rigid bar: largest gap, and largest error of
# the axes over the largest motion of the axes. A joint is enforced when that is below a tenth. A spring answers within
# 1/sqrt(S w): a motion faster than that (spins of 100 precess at 57 rad/s) is no longer led by it.

# %%
STIFFNESSES = (2.5e3, 5e3, 1e4)


def measure_c05(spins):
    scene = Scene(spins, link=BAR, shock=Shock((50, 0, 0), 0.2, 1 / 50))
    t = np.round(np.arange(0, 1.2005, 2e-3), 3)
    exact = simulate(scene, t, "spheres", 1e-9)
    errors, gaps, ground = [], [], 0.0
    for stiffness in STIFFNESSES:
        system = paper_system(scene, stiffness, stiffness / 40)
        run = run_steps(system, scene.shock, t, DT)
        errors.append(abs(run.axes - exact.axes).max())
        gaps.append(run.stretches.max())
        for _ in range(50):
            system.push(1, 2, (50, 0, 0))
            system.step(DT)
            system.compute_forces()
        ground = max(ground, abs(system.X[-1]).max(), abs(system.R[-1] - np.eye(3)).max())
    moved = abs(exact.axes[..., :2]).max()
    return {
        "largest_gap_m": gaps[-1],
        "error_over_motion": errors[-1] / moved,
        "power_of_stiffness_in_error": measured_order(STIFFNESSES, errors),
        "power_of_stiffness_in_gap": measured_order(STIFFNESSES, gaps),
        "ground_moved_m": ground,
        "precession_rad_per_s": max(abs(s) for s in spins) / (scene.inertias[0] + scene.inertias[1]),
    }


def decide_c05(m):
    how = (
        f"At S = 10^4 N/m the gaps reach {1e3 * m['largest_gap_m']:.1f} mm and the axes are off by "
        f"{m['error_over_motion']:.1%} of their motion; gap and error go as S^{m['power_of_stiffness_in_gap']:.2f} and "
        f"S^{m['power_of_stiffness_in_error']:.2f}. The ground moved by {m['ground_moved_m']:g} m."
    )
    if m["ground_moved_m"] or m["error_over_motion"] > 0.1:
        return Finding("refuted", how)
    return Finding(
        "confirmed-if", how, "S large: the springs faster than the motion; exact only as S grows without bound"
    )


# %%
tests = [
    ClaimTest("C03", (10, 10), (0, 0), "one step of a rigid body", measure_c03, decide_c03),
    ClaimTest(
        "C04", (10, 10), (0, 0), "spring-linked bodies, and one free body of unequal inertia", measure_c04, decide_c04
    ),
    ClaimTest("C05", (10, 10), (100, 100), "spring-linked bodies against the exact pair", measure_c05, decide_c05),
]
tests
