"""Claims of section 4.2: the misplaced bar, and the run that is not a number (C06, C07)."""

import warnings
from bisect import bisect_left
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from lagrotor.errors import LagrotorWarning
from lagrotor.models.spring_link.rigid_body import finite_rotation, printed_rotation
from lagrotor.models.spring_link.run import run_steps
from lagrotor.models.spring_link.system import paper_system
from lagrotor.numerics.arrays import Array
from lagrotor.pair.examples import DAMPING, HEAVY_LINK, STEP, STIFFNESS
from lagrotor.pair.scene import Scene, Shock
from lagrotor.paper.claim_tests import ClaimTest, Finding, Part, PrintedNumber
from lagrotor.paper.rotor_pair.shocked_runs import EQUAL
from lagrotor.shown import scientific

PRINTED_ENERGY = PrintedNumber("100")  # J
_START = 0.1  # s, a hundredth of the paper's 10 s: what figure 8 shows at its left edge

SPIKES, DECAYS, STAYS = (
    "the energy spikes at the start",
    "it decays back",
    "with the bar placed right it stays at 100 J",
)
NAN, EDGE = "Ω is not zero, |Ω|² rounds to zero, and the rotation is NaN", "the NaN begins where |Ω|² rounds to zero"
_LOST = "the state of the run turns to NaN"


@dataclass(frozen=True)
class MisplacedBar:
    """A bar whose centre starts at `height` (m above the ground joints; right is 1), with dampers (kg/s) and spins (rad/s)."""

    height: float = 1.5
    damping: float = DAMPING
    spins: tuple[float, float] = EQUAL


def measure_c06(case: MisplacedBar) -> dict[str, float]:
    """Kinetic energy of the paper's program for 0.6 s, with the bar at that height and placed right.

    The paper's z starts at the rotors' centres, ours at the ground joints: its mistaken 1 is our 1.5.
    """
    scene, t = Scene(case.spins, link=HEAVY_LINK), np.round(np.arange(601) * STEP, 6)
    wrong = run_steps(paper_system(scene, STIFFNESS, case.damping, case.height), None, t, STEP).paper_energy
    right = run_steps(paper_system(scene, STIFFNESS, case.damping), None, t, STEP).paper_energy
    excess = abs(wrong - wrong[-1])

    def last(part: float) -> float:
        above = t[excess > part * excess.max()]
        return float(above[-1]) if len(above) else 0.0

    return {
        "start_J": wrong[0],
        "peak_J": wrong.max(),
        "peak_at_s": t[wrong.argmax()],
        "after_0.6_s_J": wrong[-1],
        "below_a_tenth_of_the_peak_from_s": last(0.1),
        "below_a_thousandth_of_the_peak_from_s": last(0.001),
        "placed_right_J": right.mean(),
        "placed_right_swing_J": np.ptp(right),
    }


def decide_c06(m: Mapping[str, float]) -> Finding:
    """The height of the peak and when it comes, the energy at the end, and the energy with the bar placed right."""
    unit = PRINTED_ENERGY.half_unit
    return Finding(
        (
            Part(SPIKES, m["peak_J"] > m["start_J"] + unit and m["peak_at_s"] < _START),
            Part(DECAYS, abs(m["after_0.6_s_J"] - m["start_J"]) < unit),
            Part(STAYS, PRINTED_ENERGY.is_matched(m["placed_right_J"]) and m["placed_right_swing_J"] < unit),
        ),
        f"{PRINTED_ENERGY.rule} J. With the bar half a metre too high the energy rises from {m['start_J']:.0f} to "
        f"{m['peak_J']:.1f} J at the program's step of {1e3 * m['peak_at_s']:.0f} ms, is within a tenth of that rise from "
        f"{1e3 * m['below_a_tenth_of_the_peak_from_s']:.0f} ms on, within a thousandth from "
        f"{1e3 * m['below_a_thousandth_of_the_peak_from_s']:.0f} ms on, and ends at {m['after_0.6_s_J']:.2f} J; "
        f"with the bar in its place it is {m['placed_right_J']:.2f} J with a swing of {scientific(m['placed_right_swing_J'])} J.",
    )


def _is_nan(rotation: Callable[[Array, float], Array], size: float) -> bool:
    return bool(np.isnan(rotation(np.array([[0.0, 0.0, size]]), STEP)).any())


def _is_lost(scene: Scene, rotation: Callable[[Array, float], Array], end: float) -> bool:
    """Return whether the paper's program, with this rotation, loses the run before `end` (s)."""
    system = paper_system(scene, STIFFNESS, DAMPING, rotation=rotation)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LagrotorWarning)
        return run_steps(system, scene.shock, [0.0, end], STEP).ending.early


@dataclass(frozen=True)
class Underflow:
    """|Ω| (rad/s) at which the rotation is evaluated, and the rotation: (n, 3), s → (n, 3, 3)."""

    size: float = 1e-169
    rotation: Callable[[Array, float], Array] = printed_rotation


def measure_c07(case: Underflow) -> dict[str, float]:
    """The rotation at |Ω| = size and where its NaN begins, by halving; the paper's run with it and with its cure.

    The shock is moved from 2 s to 0.56 s to save time: its tail, which sets the bar turning, begins 27 widths (0.54 s)
    before the peak, wherever that is.
    """
    low, high = -200.0, -100.0  # powers of ten: NaN at the first, none at the second
    while high - low > 0.01:
        middle = (low + high) / 2
        low, high = (middle, high) if _is_nan(case.rotation, 10**middle) else (low, middle)
    scene = Scene(EQUAL, link=HEAVY_LINK, shock=Shock((50, 0, 0), 0.56, 1 / 50))
    ends = np.round(np.arange(1, 201) * STEP, 6)
    lost = bisect_left(ends, True, key=lambda end: _is_lost(scene, case.rotation, end))
    return {
        "omega_rad_per_s": case.size,
        "omega_squared": case.size**2,
        "nan_at_that_omega": _is_nan(case.rotation, case.size),
        "nan_at_that_omega_cured": _is_nan(finite_rotation, case.size),
        "nan_at_omega_zero": _is_nan(case.rotation, 0.0),
        "largest_omega_that_fails_rad_per_s": 10**low,
        "its_square": 10**low * 10**low,
        "least_omega_that_does_not_fail_rad_per_s": 10**high,
        "square_of_that": 10**high * 10**high,
        "nan_at_s_printed_rotation": ends[lost] if lost < len(ends) else 0.0,
        "shock_at_s": 0.56,
        "nan_with_cured_rotation": _is_lost(scene, finite_rotation, 1.0),
    }


def decide_c07(m: Mapping[str, float]) -> Finding:
    """NaN at an Ω not zero whose square is; squares on both sides of where the NaN begins; the paper's run."""
    rounded = m["omega_rad_per_s"] != 0 and m["omega_squared"] == 0
    edge = m["its_square"] == 0 < m["square_of_that"] and not m["nan_at_omega_zero"]
    return Finding(
        (
            Part(NAN, rounded and bool(m["nan_at_that_omega"])),
            Part(EDGE, edge),
            Part(_LOST, m["nan_at_s_printed_rotation"] > 0 and not m["nan_with_cured_rotation"]),
        ),
        f"At |Ω| = {scientific(m['omega_rad_per_s'])} rad/s the printed rotation "
        f"{'is' if m['nan_at_that_omega'] else 'is not'} NaN; it is NaN up to "
        f"{scientific(m['largest_omega_that_fails_rad_per_s'], 1)} rad/s, whose square rounds to zero, but not at zero. The "
        f"paper's run is lost {m['shock_at_s'] - m['nan_at_s_printed_rotation']:.2f} s before the peak of the shock, in its "
        "tail, which sets the resting bar turning by less than that (the shock was moved from 2 s to "
        f"{m['shock_at_s']:.2f} s to save time). With n = Ω/|Ω| and |Ω| by hypot the run "
        f"{'is lost too' if m['nan_with_cured_rotation'] else 'is not lost'}.",
    )


C06 = ClaimTest(
    "C06",
    MisplacedBar(),
    {SPIKES: MisplacedBar(height=1.0), DECAYS: MisplacedBar(damping=0.0), STAYS: MisplacedBar(spins=(9.0, 9.0))},
    "spring-linked bodies, S = 10⁴ N/m, D = 250 kg/s",
    measure_c06,
    decide_c06,
    unproved="it is about the springs of the paper's program",
)
# At 10⁻¹⁵⁰ rad/s the square is 10⁻³⁰⁰: not rounded to zero.
# The cured rotation is NaN nowhere.
C07 = ClaimTest(
    "C07",
    Underflow(),
    {NAN: Underflow(1e-150), EDGE: Underflow(rotation=finite_rotation), _LOST: Underflow(rotation=finite_rotation)},
    "spring-linked bodies with the printed rotation",
    measure_c07,
    decide_c07,
    unproved="it is about rounding in the paper's program",
)
