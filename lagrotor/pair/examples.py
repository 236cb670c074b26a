"""Scenes by name, for the runs that the paper links to, each with a duration that shows its motion."""

from dataclasses import dataclass

from lagrotor.pair.scene import Link, Scene, Shock


@dataclass(frozen=True)
class Ready:
    """A scene, its duration in s, and a sentence about its motion."""

    scene: Scene
    duration: float
    says: str


# The bar of section 4 has the mass 1 kg and the inertia 1 kg m², the bar of 5.2.1 a hundredth and a tenth of these.
HEAVY_LINK, LIGHT = Link(length=1.0, mass=1.0, inertia=1.0), Link(length=1.0, mass=0.01, inertia=0.1)
# The shock of section 4.2, 50 exp(−(50 (t − 2))²) N on the tip of rotor 1 along the bar, and the same across the bar.
SHOCK_X, SHOCK_Y = Shock((50.0, 0.0, 0.0), 2.0, 1 / 50), Shock((0.0, 50.0, 0.0), 2.0, 1 / 50)
# The shock of section 5.2.1, whose component across the bar is chosen so that the pair does not topple.
SHOCK_PAIRED = Shock((40.0, -11.0, 0.0), 2.0, 1 / 20)

SCENES: dict[str, Ready] = {
    "same-spin": Ready(Scene((10.0, 10.0), link=HEAVY_LINK), 10.0, "equal spins, left alone: upright for ever"),
    "same-spin-shock": Ready(
        Scene((10.0, 10.0), link=HEAVY_LINK, shock=SHOCK_X),
        10.0,
        "equal spins, a shock along the bar: both precess alike",
    ),
    "no-spin": Ready(
        Scene((0.0, 0.0), link=HEAVY_LINK, shock=SHOCK_X),
        4.8,
        "no spin, the same shock: the pair topples until all is in line",
    ),
    "anti-spin-shock-x": Ready(
        Scene((10.0, -10.0), link=HEAVY_LINK, shock=SHOCK_X),
        10.0,
        "opposite spins, a shock along the bar: held in x, drifting slowly in y",
    ),
    "anti-spin-shock-y": Ready(
        Scene((10.0, -10.0), link=HEAVY_LINK, shock=SHOCK_Y),
        10.0,
        "opposite spins, a shock across the bar: held in x, toppling in y",
    ),
    "free-precession": Ready(
        Scene((10.0, -10.0), link=LIGHT, shock=SHOCK_PAIRED),
        10.0,
        "opposite spins, light bar, a slanting shock: the paired precession",
    ),
}

# The paper's simulator (4.01, listings of 4.1 and 4.2): S = 2000 (M/n) omega_s² in N/m, D = 500 (M/n) omega_s in kg/s,
# with omega_s = 10 rad/s and n = 20, which the paper does not say: see figure 10. Its step is 1 ms.
STIFFNESS, DAMPING, STEP = 1e4, 250.0, 1e-3
