"""Claim of section 5.3: how the rate goes with the inclination (C23)."""

from collections.abc import Mapping

import numpy as np

from lagrotor.models.simulate import simulate
from lagrotor.numerics.curves import best_harmonics, measured_order
from lagrotor.pair.quantities import Spins
from lagrotor.pair.scene import Link, Scene
from lagrotor.paper.claim_tests import ClaimTest, Finding, Part
from lagrotor.paper.rotor_pair.claims.natural_rates import BARS
from lagrotor.paper.rotor_pair.claims.precession_runs import (
    AMPLITUDES,
    EQUAL,
    MASSLESS,
    OPPOSITE,
    PAPER_R0,
    once_round,
    precession_scene,
)
from lagrotor.paper.rotor_pair.claims.proved_parts import over_cosine
from lagrotor.paper.rotor_pair.shocked_runs import shock_of, shocked_scene
from lagrotor.theory.natural_rate import natural_rate

OVER_COSINE, _HALF_UNIT = 0.5, 0.05  # c of 1/cos θ = 1 + θ²/2, to half a unit of its decimal
WEAK = 5.0  # N

_COSINE = "the rate at average inclination θ is the natural rate over cos θ"


def coefficient(spins: Spins, bar: Link) -> tuple[float, float]:
    """c of rate/natural rate = 1 + c θ̄² at the least amplitude, and the power of θ̄ in the change.

    Opposite spins on exact orbits. Any other spins after both axes got the same velocity: they then go round a cone, whose
    half-angle is half the largest angle between two of their positions.
    """
    sizes, changes = [], []
    natural = natural_rate(Scene(spins, link=bar))
    for r0 in AMPLITUDES:
        if spins[0] == -spins[1] != 0:
            rate = precession_scene(spins, r0, bar)[1]
            sizes.append(float(once_round(spins, r0, bar).inclinations.mean()) ** 2)
        else:
            scene = Scene(spins, link=bar, rates=((r0 * natural, 0, 0),) * 2)
            run = simulate(scene, np.linspace(0, 6, 401), "minimal", 1e-11)
            rate = best_harmonics(run.t, run.axes[0, :, 0], natural).rate
            farthest = np.linalg.norm(run.axes[0] - run.axes[0, 0], axis=-1).max()
            sizes.append(float(np.arcsin(farthest / 2)) ** 2)
        changes.append(rate / natural - 1)
    return changes[0] / sizes[0], 2 * measured_order(sizes, np.abs(changes))


def _after_shock(spins: Spins, bar: Link) -> float:
    """c after a weak shock along x from rest, over three cycles; θ̄ of half the swing of x."""
    scene = shocked_scene(spins, (WEAK, 0, 0), bar, 1 / 20)
    natural, after = natural_rate(scene), shock_of(scene).at + 0.33
    times = after + np.linspace(0, 3 * 2 * np.pi / natural, 201)
    run = simulate(scene, [0.0, *times], "spheres", 1e-11).after(after)
    x = run.axes[0, :, 0]
    return float((best_harmonics(run.t, x, natural).rate / natural - 1) / (np.ptp(x) / 2) ** 2)


def measure_c23(spins: Spins) -> dict[str, float]:
    """c for four bars on orbits, for three after a shock, and for equal spins."""
    measured = {f"coefficient_after_shock_{name}": _after_shock(spins, bar) for name, bar in BARS.items()}
    for name, bar in ({"massless": MASSLESS} | BARS).items():
        measured[f"coefficient_{name}"], measured[f"order_{name}"] = coefficient(spins, bar)
    measured["coefficient_equal_spins_m_1_K_1"], measured["order_equal_spins_m_1_K_1"] = coefficient(
        EQUAL, BARS["m_1_K_1"]
    )
    return measured


def decide_c23(m: Mapping[str, float]) -> Finding:
    """c against that of 1/cos θ, for every bar; and for equal spins."""
    own = [m[f"coefficient_{name}"] for name in ("massless", *BARS)]
    shock = [m[f"coefficient_after_shock_{name}"] for name in BARS]
    equal = m["coefficient_equal_spins_m_1_K_1"]
    needs = "equal spins with parallel axes" if abs(equal - OVER_COSINE) < _HALF_UNIT else ""
    return Finding(
        (Part(_COSINE, all(abs(c - OVER_COSINE) < _HALF_UNIT for c in own), needs),),
        f"The rate is the natural one times 1 + c θ², with θ the average inclination; 1/cos θ has c = +0.5. Measured: "
        f"{own[0]:+.3f} massless, {own[1]:+.3f}, {own[2]:+.3f}, {own[3]:+.3f} for m, K = 1, 1; 0.01, 0.1; 1, 0.1 (the change "
        f"goes as θ to the power {m['order_massless']:.2f}); for equal spins with parallel axes {equal:+.3f}. After a shock "
        "along x from rest, which leaves the centres of precession twisted apart, c is "
        f"{shock[0]:+.2f}, {shock[1]:+.2f}, {shock[2]:+.2f}: its sign depends on the twist.",
    )


C23 = ClaimTest(
    "C23",
    OPPOSITE,
    {_COSINE: EQUAL},
    "exact orbits; exact pair (minimal)",
    measure_c23,
    decide_c23,
    lambda spins: over_cosine(_COSINE, Scene(spins, link=MASSLESS), PAPER_R0),
)
