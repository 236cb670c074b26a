"""The coefficients of the equations of motion of a structure: masses, moments, bars and braces as arrays.

With r_i the unit vector of axis i and X_i = p_i + R_i r_i its tip, the kinetic energy is

    T = 1/2 sum_ij A_ij r_i' . r_j',   A_ii = J_i + load_i R_i² + sum_bars R_i² (m/4 + K/ell²),
                                       A_ij = R_i R_j (m/4 − K/ell²) for a bar between i and j,

and the potential energy of the weight is sum_i g S_i z_i with S_i = M_i R_i/2 + load_i R_i + sum_bars m R_i/2. J_i is the
inertia of rotor i about its joint and M_i its mass. The bars have the mass m, the moment of inertia K and the length ell.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.arrays import Array as Array
from lagrotor.structures.assembly import Assembly

Index = NDArray[np.intp]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Coefficients:
    """The coefficients of a structure in arrays.

    - For each rotor, shape (N,): R is the length of the axis, A the inertia A_ii, S the first moment (kg m), G = I3 ω the axial
      momentum and `decay` its rate of decay by spin friction (1/s). `friction` and `hinge` are those of the structure.
    - `feet` are the ground joints, (N, 3), m.
    - For each bar, shape (B,): i and j are the rotors at its ends, `ell` its length, and `coupling` is A_ij.
    - For each brace: `brace_tip` is the rotor at its first end. `brace_to` is the rotor at its second end, or −1 for ground.
      `brace_point` (3,) is the second end upright, and `brace_length` the unstrained length, m.
    """

    R: Array
    A: Array
    S: Array
    G: Array
    decay: Array
    friction: Array
    hinge: Array
    gravity: float
    feet: Array
    i: Index
    j: Index
    ell: Array
    coupling: Array
    brace_tip: Index
    brace_to: Index
    brace_point: Array
    brace_length: Array
    stiffness: Array
    damping: Array

    @property
    def inertia(self) -> Array:
        """The matrix A_ij of the kinetic energy, (N, N), kg m²."""
        A = np.diag(self.A)
        np.add.at(A, (self.i, self.j), self.coupling)
        np.add.at(A, (self.j, self.i), self.coupling)
        return A

    @property
    def upright(self) -> Array:
        """The upright axes, (N, 3)."""
        return np.tile([0.0, 0.0, 1.0], (len(self.R), 1))

    @cached_property
    def pull(self) -> float:
        """The largest rate in rad/s at which an axis alone would topple or swing without spin, by weight, hinge and braces."""
        pull = np.abs(self.gravity) * np.abs(self.S) + self.hinge
        stiff = np.zeros(len(self.R))
        np.add.at(stiff, self.brace_tip, self.stiffness * self.R[self.brace_tip] ** 2)
        joined = self.brace_to >= 0
        np.add.at(stiff, self.brace_to[joined], self.stiffness[joined] * self.R[self.brace_to[joined]] ** 2)
        return float(np.sqrt((pull + stiff) / self.A).max())

    @cached_property
    def rate(self) -> float:
        """The larger of `pull` and the rates |G|/A of the axes, rad/s; at least 1e-6. It is the unit of rates in a run."""
        return float(max((np.abs(self.G) / self.A).max(), self.pull, 1e-6))


@lru_cache(maxsize=64)
def coefficients(s: Assembly) -> Coefficients:
    return coefficients_in(s, np.array, np.array([bar[2] for bar in s.bars], dtype=float), np.sqrt)


def coefficients_in(
    s: Assembly, numbers: Callable[[Any], Any], ell: Array, root: Callable[[Array], Array]
) -> Coefficients:
    """Return the coefficients in numbers of another kind than floats, such as intervals. `numbers` converts floats, `root`
    takes square roots, and `ell` are the lengths of the bars. Hinges stay floats."""
    M, R, I1, I3 = (numbers([getattr(rotor, name) for rotor in s.rotor]) for name in ("mass", "length", "I1", "I3"))
    load = numbers(s.load)
    A, S = I1 + M * R**2 / 4 + load * R**2, M * R / 2 + load * R
    i, j = (np.array([bar[end] for bar in s.bars], dtype=np.intp) for end in (0, 1))
    m, K = (numbers([float(getattr(link, name)) for link in s.link]) for name in ("mass", "inertia"))
    for end in (i, j):
        np.add.at(A, end, R[end] ** 2 * (m / 4 + K / ell**2))
        np.add.at(S, end, R[end] * m / 2)
    to = np.array([b.to if isinstance(b.to, int) else -1 for b in s.braces], dtype=np.intp)
    point, tip = (
        numbers(np.array([s.upright_tip(x) if isinstance(x, int) else x for x in ends], dtype=float).reshape(-1, 3))
        for ends in ([b.to for b in s.braces], [b.tip for b in s.braces])
    )
    brace_tip = np.array([b.tip for b in s.braces], dtype=np.intp)
    springs, dampers = (numbers([float(getattr(b, name)) for b in s.braces]) for name in ("stiffness", "damping"))
    return Coefficients(
        R, A, S, G=I3 * numbers(s.spins), decay=numbers(s.spin_friction) / I3, friction=numbers(s.friction),
        hinge=np.array(s.hinge), gravity=numbers([s.gravity]).tolist()[0], feet=numbers([(*p, 0.0) for p in s.joints]),
        i=i, j=j, ell=ell, coupling=R[i] * R[j] * (m / 4 - K / ell**2), brace_tip=brace_tip, brace_to=to,
        brace_point=point, brace_length=root(((tip - point) ** 2).sum(1)), stiffness=springs, damping=dampers,
    )  # fmt: skip
