"""Claims of section 4.2: the energy after the shock, and what is conserved (C08, C09)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lagrotor.models.simulate import simulate
from lagrotor.models.spring_link.run import run_steps
from lagrotor.models.spring_link.system import RigidBodySystem, join_bar, paper_bodies, paper_system, step_limit
from lagrotor.numerics.arrays import Array
from lagrotor.pair.examples import DAMPING, HEAVY_LINK, LIGHT, STEP, STIFFNESS
from lagrotor.pair.quantities import Spins
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Trajectory
from lagrotor.paper.claim_tests import ClaimTest, Finding, Part, PrintedNumber
from lagrotor.paper.rotor_pair.claims.proved_parts import energies
from lagrotor.paper.rotor_pair.shocked_runs import EQUAL, after_shock, shock_of, shocked_scene
from lagrotor.shown import scientific

# J; "constant" is to the digits of the second.
PRINTED = {"before": PrintedNumber("100"), "after": PrintedNumber("100.45")}
OMEGA_S, N = 10.0, 20  # rad/s, the spin; what the paper leaves open in S = 2000 (M/n) ω_s², D = 500 (M/n) ω_s
TRIED = (5, 8, 10, 20, 40, 80, 160)  # values of n
SECONDS = 8.0  # of the paper's run after the shock
_FORCE = 50.0
CONSERVED = 1e-6  # of the impulse, a thousand times the error of the exact runs
FREED = 1e-3  # of the impulse: the dampers are not central and change the angular momentum, by less than this

FROM_100, TO_100_45, _CONSTANT = "the energy starts at 100 J", "it rises to about 100.45 J", "it then stays constant"
MOMENTUM, ANGULAR = "the total momentum is not conserved", "the total angular momentum is not conserved"
BY_GROUNDS = "the cause is what the grounds exert: without them both are conserved"


def _spring_energy(scene: Scene, n: int, times: Array) -> Array | None:
    """Kinetic energy (J) at `times` by the paper's program with ω_s = 10 rad/s; None where 1 ms is above the step limit."""
    system = paper_system(scene, 2000 / n * OMEGA_S**2, 500 / n * OMEGA_S)
    if step_limit(system).whole <= STEP:
        return None
    return run_steps(system, scene.shock, np.append(0, times), STEP).paper_energy[1:]


def _jump(scene: Scene) -> float:
    """Energy (J) that a shock along x gives an equal pair: P²R²/(4(a + b)) exp(−(Ωw)²/2), Ω = G/(a + b), width w."""
    shock, inertia = shock_of(scene), sum(scene.inertias)
    narrow = (shock.impulse[0] * scene.rotor.length) ** 2 / (4 * inertia)
    return float(narrow * np.exp(-((scene.momenta[0] / inertia * shock.width) ** 2) / 2))


@dataclass(frozen=True)
class ShockAlongX:
    """Spins (rad/s), force (N) along x on tip 1, and the width (s) of its pulse."""

    spins: Spins = EQUAL
    force: float = _FORCE
    width: float = 1 / 50


def measure_c08(case: ShockAlongX) -> dict[str, float]:
    """Energies before and after a shock by three ways; which n give the same."""
    scene, light = (shocked_scene(case.spins, (case.force, 0, 0), bar, case.width) for bar in (HEAVY_LINK, LIGHT))
    at = shock_of(scene).at
    first = np.round(at + np.arange(0.14, 0.25, 0.02), 3)  # seven widths after the peak the shock is over
    rising = np.round(
        at + np.arange(-0.1, 0.25, 0.002), 3
    )  # to where it rises is its highest value: the dampers take it back
    springs = _spring_energy(scene, N, np.append(first, at + SECONDS))
    assert springs is not None  # n = 20 is stable at 1 ms, see `step_limit_ms`
    exact = simulate(scene, np.linspace(0, at + SECONDS, 83), "spheres", 1e-10)
    exact_after = exact.energy[exact.t > first[0]]
    tried = {n: seen.max() for n in TRIED if (seen := _spring_energy(scene, n, rising)) is not None}
    fitting = [n for n, highest in tried.items() if PRINTED["after"].is_matched(highest)]
    return {
        "before_J": exact.energy[0],
        "highest_springs_J": tried[N],
        "after_exact_J": exact_after[0],
        "after_closed_form_J": exact.energy[0] + _jump(scene),
        "after_closed_form_light_bar_J": exact.energy[0] + _jump(light),
        "lost_in_8_s_springs_J": springs[0] - springs[-1],
        "swing_in_8_s_exact_J": np.ptp(exact_after),
        "stiffness_N_per_m": 2000 / N * OMEGA_S**2,
        "damping_kg_per_s": 500 / N * OMEGA_S,
        "step_limit_ms": 1e3 * step_limit(paper_system(scene, STIFFNESS, DAMPING)).whole,
        "step_limit_light_bar_ms": 1e3 * step_limit(paper_system(light, STIFFNESS, DAMPING)).whole,
        "smallest_n_that_fits": min(fitting, default=0),
        "largest_n_that_fits": max(fitting, default=0),
    }


def decide_c08(m: Mapping[str, float]) -> Finding:
    """The energies before and after, both with springs and exactly; what is left of them 8 s later, likewise."""
    reached = [PRINTED["after"].is_matched(m[key]) for key in ("highest_springs_J", "after_exact_J")]
    least, most, unit = m["smallest_n_that_fits"], m["largest_n_that_fits"], PRINTED["after"].half_unit
    kept = m["swing_in_8_s_exact_J"] < unit
    drained = "the joints are rigid: the dampers of the paper's springs slowly drain the energy" if kept else ""
    return Finding(
        (
            Part(FROM_100, PRINTED["before"].is_matched(m["before_J"])),
            Part(TO_100_45, all(reached)),
            Part(_CONSTANT, kept and m["lost_in_8_s_springs_J"] < unit, drained),
        ),
        f"{PRINTED['before'].rule} J, {PRINTED['after'].rule} J. The energy rises from {m['before_J']:.2f} to "
        f"{m['highest_springs_J']:.4f} J with springs, {m['after_exact_J']:.4f} J exactly, {m['after_closed_form_J']:.4f} J by "
        f"P²R²/(4(a + b)) and the width of the pulse. The exact pair then keeps it to {scientific(m['swing_in_8_s_exact_J'])} "
        f"J; from 0.14 s after the peak the dampers of the springs take {m['lost_in_8_s_springs_J']:.4f} J in 8 s. S = "
        f"{m['stiffness_N_per_m']:.0f} N/m "
        f"and D = {m['damping_kg_per_s']:.0f} kg/s (n = {N}, ω_s = {OMEGA_S:.0f} rad/s) are stable up to a step of "
        f"{m['step_limit_ms']:.2f} ms; with that ω_s, n from {least:.0f} to {most:.0f} of those tried gives the printed number. "
        f"The light bar of 5.2.1 would give {m['after_closed_form_light_bar_J']:.2f} J and needs a step below "
        f"{m['step_limit_light_bar_ms']:.2f} ms.",
    )


def _momenta(run: Trajectory) -> tuple[Array, Array]:
    """Total momentum (n, 3), total angular momentum (n, 3) about the middle between the ground joints, bar included."""
    scene, (r1, r2), (v1, v2) = run.scene, run.axes, run.rates
    rotor, R = scene.rotor, scene.rotor.length
    p = [rotor.mass * R / 2 * v for v in (v1, v2)]
    e, e_rate = np.array([1.0, 0, 0]) + R / HEAVY_LINK.length * (r2 - r1), R / HEAVY_LINK.length * (v2 - v1)
    bar_p = HEAVY_LINK.mass * R / 2 * (v1 + v2)
    L = np.cross(R / 2 * (r1 + r2), bar_p) + HEAVY_LINK.inertia * np.cross(e, e_rate)
    for joint, r, v, G, own in zip(run.joints, run.axes, run.rates, scene.momenta, p, strict=True):
        L = L + rotor.J * np.cross(r, v) + G * r + np.cross(joint, own)
    return p[0] + p[1] + bar_p, L


@dataclass(frozen=True)
class Grounds:
    """Whether the pair stands on its grounds; and how many of them are kept where it is said to be without them."""

    grounded: bool = True
    kept: int = 0


def measure_c09(case: Grounds) -> dict[str, float]:
    """Over the impulse, for 2.4 s after the shock: how far the total momenta swing, with the grounds and without them."""
    scene = shocked_scene(EQUAL, (_FORCE, 0, 0))
    exact, impulse = after_shock(scene, 2.4, 1e-11), float(np.linalg.norm(shock_of(scene).impulse))
    freed = RigidBodySystem(paper_bodies(scene), STIFFNESS, DAMPING)
    for rotor in range(1, case.kept + 1):
        freed.ground(rotor, 1)
    join_bar(freed)
    run = run_steps(freed, scene.shock, np.append(0, np.round(np.arange(0.34, 2.6, 0.02), 3)), STEP)
    without = run.momentum[1:], run.angular_momentum[1:]
    p, L = _momenta(exact) if case.grounded else without

    def swing(values: Array) -> float:
        return float(np.linalg.norm(np.ptp(values, axis=0))) / impulse

    return {
        "momentum_swing": swing(p),
        "angular_momentum_swing_about_the_middle": swing(L),
        "angular_momentum_swing_about_ground_1": swing(L - np.cross(exact.joints[0], p)),
        "angular_momentum_swing_about_the_joint_line": swing(L[:, :1]),
        "momentum_swing_without_grounds": swing(without[0]),
        "angular_momentum_swing_without_grounds": swing(without[1]),
    }


def decide_c09(m: Mapping[str, float]) -> Finding:
    """The swings of both momenta, the angular one about three places; and those of the same bodies without grounds."""
    about_ground, about_middle, about_line = (
        m[f"angular_momentum_swing_about_{place}"] for place in ("ground_1", "the_middle", "the_joint_line")
    )
    needs = "angular momentum about a point off the middle between the grounds" if about_ground > FREED else ""
    caused = max(m["momentum_swing_without_grounds"], m["angular_momentum_swing_without_grounds"]) < FREED
    return Finding(
        (
            Part(MOMENTUM, m["momentum_swing"] > FREED),
            Part(ANGULAR, min(about_ground, about_middle, about_line) > CONSERVED, needs),
            Part(BY_GROUNDS, caused),
        ),
        f"In the 2.4 s after the shock, per unit of its impulse, the momentum swings by {m['momentum_swing']:.2f}, and the "
        f"angular momentum by {about_ground:.2f} m about ground 1, by {scientific(about_middle)} m about the middle between the "
        f"grounds, by {scientific(about_line)} m about the line through them, about which the grounds have no moment. The same "
        f"bodies without grounds keep both, to {scientific(m['momentum_swing_without_grounds'])} and "
        f"{scientific(m['angular_momentum_swing_without_grounds'])} m. The paper's own run, with parallel axes, thus has a "
        "conserved angular momentum, about the middle, which could have served as a check.",
    )


# C08: a pulse seven times as wide still pushes when the energy is first read. C09: with one ground kept, it exerts a force.
C08 = ClaimTest(
    "C08",
    ShockAlongX(),
    {FROM_100: ShockAlongX((5.0, 5.0)), TO_100_45: ShockAlongX(force=45.0), _CONSTANT: ShockAlongX(width=7 / 50)},
    "spring-linked bodies, the exact pair, the closed form",
    measure_c08,
    decide_c08,
    lambda case: energies(FROM_100, TO_100_45, case.spins, PRINTED) if case == ShockAlongX() else (),
    "whether the energy stays constant depends on the dampers of the paper's program",
)
C09 = ClaimTest(
    "C09",
    Grounds(),
    {MOMENTUM: Grounds(grounded=False), ANGULAR: Grounds(grounded=False), BY_GROUNDS: Grounds(kept=1)},
    "exact pair (spheres), bar m = 1 kg, K = 1 kg m²; spring-linked bodies without grounds",
    measure_c09,
    decide_c09,
    unproved="its cause is shown on the bodies of the paper's program",
)
