"""The natural rate of a scene, its error and its limits; `lagrotor.theory.natural_frequency` gives the functions."""

from dataclasses import dataclass, replace
from math import hypot, pi, sqrt

from lagrotor.errors import DomainError, InputError
from lagrotor.numerics.source_cache import generated
from lagrotor.pair.scene import Link, Scene
from lagrotor.theory.fitted_factors import LARGEST_SHIFT, LARGEST_SWING, LIGHTEST_TWIST, MOST_GROWTH, NEXT_SHIFT
from lagrotor.theory.rate_shift import frequency_shift, opposite_share, twist_coefficient

# Limit → its formula and, where the bar changes, its a and b.
LIMIT_FORMULAS = {
    "equal": ("G/(a + b)", ""),
    "opposite": ("G/√(a² − b²)", ""),
    "massless": ("G/a", "a = J, b = 0"),
    "dumbbell": ("G/a", "a = (2 J + R² m)/2, b = 0"),
}
TURNS = 20  # of an oscillation for which the error is calibrated


@generated(((),))
def natural_frequency_value() -> str:
    """Return the source code of a function of the numbers a, b, G_1, G_2; it returns [Omega_0]."""
    from lagrotor.theory.natural_frequency import natural_frequency

    return natural_frequency().code()


@generated(((),))
def _free_rate() -> str:
    """Return the source code of a function of the numbers theta, G, J; it returns [phi']."""
    from lagrotor.theory.natural_frequency import free_precession_rate

    return free_precession_rate().code()


def natural_rate(scene: Scene) -> float:
    """Return the natural angular frequency of the coupled pair, or of rotor 1 alone in a scene without a bar.

    Omega_0² = (a (G_1² + G_2²) − 2 b G_1 G_2) / (2 (a + b)(a² − b²)), exact in the limit of small motion; `natural_rate_error`
    gives the error at an amplitude.

    Parameters
    ----------
    scene : Scene
        Any two spins, with or without a bar.

    Returns
    -------
    float
        The frequency in rad/s.

    Raises
    ------
    InputError
        If `scene` is not a Scene.

    References
    ----------
    Equation (5.28) of the paper, corrected; derivations/t1_natural_rate.py.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> round(natural_rate(Scene(spins=(10, -10))), 12)
    8.0
    """
    if not isinstance(scene, Scene):
        raise InputError(f"natural_rate: {scene!r} must be a Scene")
    first, second = scene.momenta
    if scene.link is None:
        return abs(float(_free_rate()(0.0, first, scene.rotor.J)[0]))
    return float(natural_frequency_value()(*scene.inertias, first, second)[0])


def natural_rate_error(scene: Scene, amplitude: float) -> float:
    """Estimate the error of `natural_rate` for an orbit about the upright position or an oscillation over 20 periods.

    The oscillation starts in the linear mode.

    With c and share of `theory.rate_shift`, d = share² sigma/(2 k²) for oscillations of another phase, which turn about the
    joint line, and C equal to c with all terms positive, the error is

        Omega_0 ( (|c| + d) r²/(1 − r²) + 3 N r⁴ ),  N = C² + share sigma |sigma − 1| + share³ sigma²/k⁴.

    It is an estimate, no bound. The first term is derived, the powers in N are derived, and its factor 3 is empirical: of
    10,000 random oscillations none had more than 0.71 of this error. One rotor alone precesses at Omega_0 / cos theta exactly.
    For opposite spins, a rotation at rate nu about the joint line also shifts the rate by −(a + b) nu/(k G) Omega_0.

    Parameters
    ----------
    scene : Scene
        Any two spins, with or without a bar.
    amplitude : float
        Sine r of the larger inclination, at most 0.4.

    Returns
    -------
    float
        The error in rad/s.

    Raises
    ------
    DomainError
        Unless 0 <= r <= 0.4, √N r² <= 0.12, sigma r² <= 0.5, and a twist of the orbit grows by at most exp(6) in 20 turns.

    References
    ----------
    derivations/t1_natural_rate.py, derivations/t12_unequal_spins.py.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> round(natural_rate_error(Scene(spins=(10, -10)), amplitude=0.1), 4)
    0.0668
    """
    rate = natural_rate(scene)
    if not 0 <= amplitude <= LARGEST_SWING.value:
        raise DomainError(
            f"natural_rate_error: amplitude = {amplitude:g} must lie between 0 and {LARGEST_SWING.value:g}, the range that "
            "was calibrated; use lagrotor.simulate, or precession_orbit for opposite spins"
        )
    if scene.link is None:
        return rate * (1 / sqrt(1 - amplitude**2) - 1)
    if not rate:
        return 0.0
    k, sigma, share, square = scene.k, scene.sigma, opposite_share(scene), amplitude**2
    c_positive = 0.5 + 0.75 * share * (abs(sigma - 1) + share * sigma / k**2) + share**2 * abs(sigma**2 - 1) / 4
    next_order = c_positive**2 + share * sigma * abs(sigma - 1) + share**3 * sigma**2 / k**4
    growth = sqrt(max(twist_coefficient(sigma, share), 0.0)) * 2 * pi * TURNS
    limits = {
        "the next order is not small": sqrt(LARGEST_SHIFT.value / sqrt(next_order)),
        "its twist has little inertia": sqrt(LIGHTEST_TWIST.value / sigma),
        f"a twist grows within {TURNS} turns": MOST_GROWTH.value / growth if growth else 1.0,
    }
    why, largest = min(limits.items(), key=lambda limit: limit[1])
    if not amplitude <= largest:
        raise DomainError(
            f"natural_rate_error: amplitude = {amplitude:g} is too large for this bar: at most {largest:.2g}, beyond "
            f"which {why}; use lagrotor.simulate, or precession_orbit for opposite spins"
        )
    turning = share**2 * sigma / (2 * k * k)
    first = (abs(frequency_shift(scene)) + turning) * square / (1 - square)
    return rate * (first + NEXT_SHIFT.value * next_order * square**2)


@dataclass(frozen=True)
class RateLimit:
    """A limit of the natural rate: `rate` in rad/s, its formula, and in `says` how the scene differs in the limit."""

    rate: float
    formula: str
    says: str


def natural_rate_limits(scene: Scene) -> dict[str, RateLimit]:
    """Return the natural rate in four limits near a scene with a bar: equal, opposite, massless, dumbbell.

    In "equal" and "opposite" both momenta have the root mean square G of the scene's momenta; the rates are G/(a + b) and
    G/√(a² − b²). In "massless" the bar has no mass: a = J, b = 0. In "dumbbell" the bar's mass is at its ends: K = m ell²/4,
    b = 0, a = J + m R²/2. Raises InputError without a bar.
    """
    if scene.link is None:
        raise InputError("natural_rate_limits: the scene has no bar, which all four limits need: add a Link")
    mean = hypot(*scene.spins) / sqrt(2)
    length, mass = scene.link.length, scene.link.mass
    changed = {
        "equal": (replace(scene, spins=(mean, mean)), "equal spins of the root mean square G"),
        "opposite": (replace(scene, spins=(mean, -mean)), "opposite spins of the same G"),
        "massless": (replace(scene, link=Link(length)), "a bar without mass: {}"),
        "dumbbell": (replace(scene, link=Link(length, mass, mass * length**2 / 4)), "K = m ℓ²/4: {}"),
    }
    rows = [(name, *LIMIT_FORMULAS[name], *change) for name, change in changed.items()]
    return {name: RateLimit(natural_rate(s), formula, says.format(ab)) for name, formula, ab, s, says in rows}
