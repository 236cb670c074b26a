"""Which signs of equal spins hold a structure with the least spin: every pattern tried."""

from dataclasses import dataclass
from itertools import product
from math import inf

import numpy as np

from lagrotor.errors import InputError
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.critical_spins import spin_threshold
from lagrotor.structures.small_motion import small_motion

_MOST = 12  # rotors
_SAME = 1e-9  # relative: spins as near as that are one


@dataclass(frozen=True)
class Patterns:
    """tried: patterns; standing: how many stand at some spin; least: the least spin (rad/s, inf where none); best: the
    first pattern that needs it.
    """

    tried: int
    standing: int
    least: float
    best: tuple[int, ...]


def sign_patterns(s: Assembly) -> Patterns:
    """The structure of equal |spin| with each pattern of signs, the first sign +; at most 12 rotors.

    A turn of all signs changes nothing (a mirror image).

    Raises:
        InputError: for more rotors.
    """
    N = len(s.joints)
    if N > _MOST:
        raise InputError(f"sign_patterns: {N} rotors have 2^{N - 1} patterns: at most {_MOST} rotors")
    linear = small_motion(s)
    I3 = np.array([rotor.I3 for rotor in s.rotor])
    needed = {}
    for rest in product((1, -1), repeat=N - 1):
        signs = (1, *rest)
        needed[signs] = spin_threshold(linear.with_momenta(I3 * np.array(signs)))
    least = min(needed.values())
    best = next(signs for signs, spin in needed.items() if spin <= least * (1 + _SAME))
    return Patterns(len(needed), sum(v < inf for v in needed.values()), least, best)
