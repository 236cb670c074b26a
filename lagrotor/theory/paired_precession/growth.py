"""How fast motions beside the paired precession part from it, at small amplitude: its Floquet exponents, as laws."""

from math import sqrt


def leading_square(r0: float, sigma: float, k: float) -> float:
    """lambda² of the pair per radian of phase, at small amplitude: positive means growth by 2 pi lambda a turn.

        lambda² = (3/16) sigma² (1 − sigma) r0⁶ / k²      for a bar with b != 0 (sigma != 1),
        lambda² = (9/32) r0⁸ / k⁴                         for a massless bar or a dumbbell (sigma = 1).

    The powers follow from the averaged motion (`rotors.averaged`: the twist's stiffness is b Omega_0² d²/8, that of the
    mean x vanishes to the same order). The three rational factors were read off exact multipliers, not derived.
    """
    return 9 * r0**8 / (32 * k**4) if sigma == 1 else 3 * sigma**2 * (1 - sigma) * r0**6 / (16 * k**2)


def most_growth(r0: float, sigma: float, k: float) -> float:
    """A bound on lambda per radian of phase: both laws together, the first where it is positive. Not proved.

    The tests hold it to the exact multipliers of ten bars at r0 = 0.2 and 0.5.
    """
    return sqrt(max(leading_square(r0, sigma, k), 0.0) + leading_square(r0, 1.0, k))
