"""A lower bound of the time for which a linearly stable structure stays near upright, from its normal form.

In the coordinates of the normal form through order N, Q = sum_j |z_j|² is the squared distance from upright. Some terms of the
form conserve Q. The other terms, which are the resonances of degree d = 3 … N and the first terms of degree N + 1 beyond the
form, change Q at a rate

    |dQ/dt| ≤ sum_d g_d Q^(d/2),    g_d a bound of |{Q, K_d}| at Q = 1,

so that Q takes at least ∫ dQ / sum_d g_d Q^(d/2). Without resonances this time is ∝ push^−(N − 1). If degree N + 1 vanishes by
symmetry, the next one counts. The longest time over the orders and over the choices of resonances is returned. It is infinite
if the energy has a minimum upright, or if symmetry conserves all actions. Giorgilli, Delshams, Fontich, Galgani & Simó, J.
Differ. Equ. 77 (1989) 167. Norms of polynomials: Beauzamy, Bombieri, Enflo & Montgomery, J. Number Theory 36 (1990) 219.
"""

from math import inf, sqrt

import numpy as np
from scipy.special import factorial

from lagrotor.errors import InputError, SingularError
from lagrotor.mechanics.canonical.normal_forms import NormalForm
from lagrotor.mechanics.canonical.polynomials import Polynomial
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array
from lagrotor.structures.critical_spins import stiffness_in_masses
from lagrotor.structures.resonances import MOST_DOF, checked_push, normal_form_of, start_of_push, trusted_push
from lagrotor.structures.small_motion import small_motion
from lagrotor.structures.upright_hamiltonian import local_hamiltonian

# {degrees of freedom: N + 1 of the normal form}
_ORDERS = {4: 6, 6: 5, MOST_DOF: 4}
_ZERO = 1e-9  # relative to the largest coefficient: smaller terms are rounding
_DETUNINGS = (0.0, 1e-3, 1e-2, 0.1)  # relative to the largest rate: the largest detuning of a resonance


def hold_time(s: Assembly, push: float) -> float:
    """Compute a time (s) within which no push of a size (rad/s) grows by the factor sqrt(2): see `Standing.hold_time`. It
    follows from the first nonzero terms beyond the normal form, and from the displacement by the change of coordinates."""
    push, linear = checked_push("hold_time", push), small_motion(s)
    if linear.growth > 0 or linear.drifts:
        return 0.0
    if not linear.dof:
        return inf
    least = bool(np.linalg.eigvalsh(stiffness_in_masses(linear))[0] > 1e-12)
    if linear.dof > MOST_DOF:
        if least:
            return inf
        raise InputError(f"hold_time: {linear.dof} degrees of freedom are too many to expand: at most {MOST_DOF}")
    h = local_hamiltonian(s)
    if push > trusted_push(s):
        return 0.0
    if least:
        return inf
    if not s.bars and not s.braces:
        return inf  # each rotor conserves energy and vertical momentum, hence both its actions
    order = next(n for dof, n in _ORDERS.items() if linear.dof <= dof)
    times = [0.0]
    for detuning in _DETUNINGS:
        try:
            form = normal_form_of(s, 1.0, detuning, order)
        except SingularError:
            continue
        size = float(np.linalg.norm(np.linalg.inv(form.vectors)[: linear.dof] @ start_of_push(s), 2)) * push
        times += _times(form, size)
    return max(times) / h.rate


def _times(form: NormalForm, size: float) -> list[float]:
    """Return lower bounds of the time in which a state grows from `size` to sqrt(2) times `size` in the normal modes. There is
    one bound for each degree with a nonzero remainder, in the unit of time of the normal form."""
    n, times, resonant, shift = len(form.frequencies), list[float](), dict[int, float](), 0.0
    rates, zero = np.real(form.frequencies), _ZERO * float(np.abs(form.series.coefficients).max())
    for degree, generator in enumerate(form.generators, 3):
        gap = (generator.exponents[:, :n] - generator.exponents[:, n:]) @ rates
        feeding, remainder = _feeding(form.series.part(degree)), _feeding(generator.times(gap))
        if remainder > zero:
            growth = {**resonant, degree: feeding + remainder}
            times.append(_duration(growth, size * (1 + shift), sqrt(2) * size / (1 + shift)))
        resonant[degree] = feeding
        shift += _displacement(generator, degree, sqrt(2) * size)
        if (1 + shift) ** 2 >= sqrt(2):
            break
    return times


def _displacement(generator: Polynomial, degree: int, size: float) -> float:
    """Return a bound, to first order, of the relative change of states of a given size by a generator's transformation."""
    return degree * _size(generator) * size ** (degree - 2)


def _feeding(f: Polynomial) -> float:
    """Return a bound of the rate |{Q, f}| at which the terms f change Q, at Q = 1."""
    n = f.variables // 2
    by = f.exponents[:, :n].sum(1) - f.exponents[:, n:].sum(1)
    return _size(Polynomial(f.exponents, f.coefficients * by))


def _size(f: Polynomial) -> float:
    """Return a bound of |f(z, z̄)| at sum |z_j|² = 1 for f homogeneous of degree d: 2^(d/2) times Bombieri's norm."""
    if not len(f.coefficients):
        return 0.0
    d = int(f.exponents[0].sum())
    return float(np.sqrt(2.0**d * (np.abs(f.coefficients) ** 2 * factorial(f.exponents).prod(1)).sum() / factorial(d)))


def _duration(growth: dict[int, float], begin: float, end: float) -> float:
    """Return ∫ dQ / sum_d g_d Q^(d/2) from Q = begin² to end², with g_d = growth[d]: the least time of this growth."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    r: Array = begin + (end - begin) * (1 + nodes) / 2
    return float((weights * 2 * r / sum(g * r**d for d, g in growth.items())).sum() * (end - begin) / 2)
