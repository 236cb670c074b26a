"""How long a structure that stands to first order holds for certain: its normal form, and what that leaves out.

In the coordinates of the normal form through order N the terms that conserve Q = sum_j |z_j|² move nothing apart. What is left of
degree d = 3 … N, the resonances, and of degree N + 1, the first that the form does not reach, changes it by

    |dQ/dt| ≤ sum_d g_d Q^(d/2),    g_d a bound of |{Q, K_d}| at Q = 1,

so that Q takes ∫ dQ / sum_d g_d Q^(d/2) at least: without resonances a time as push^−(N − 1). Where degree N + 1 is zero by
symmetry, the next counts. Of the orders and of what is kept as a resonance the longest time is taken. Where the energy is
least upright, or symmetry keeps all actions, it is forever. Giorgilli, Delshams, Fontich,
Galgani & Simó, J. Differ. Equ. 77 (1989) 167. Sizes of polynomials: Beauzamy, Bombieri, Enflo & Montgomery, J. Number Theory 36
(1990) 219.
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
from lagrotor.structures.resonances import (
    MOST_DOF,
    checked_push,
    normal_form_of,
    start_of_push,
    trusted_push,
)
from lagrotor.structures.small_motion import small_motion
from lagrotor.structures.upright_hamiltonian import local_hamiltonian

# Of the normal form, N + 1, by the degrees of freedom up to which it is expanded so far.
_ORDERS = {4: 6, 6: 5, MOST_DOF: 4}
_ZERO = 1e-9  # of the largest coefficient: what moves it apart by less is rounding
_DETUNINGS = (0.0, 1e-3, 1e-2, 0.1)  # of the largest rate: what is nearer is kept as a resonance


def hold_time(s: Assembly, push: float) -> float:
    """Compute `Standing.hold_time` from the first terms that the normal form leaves and that are not zero, and the first of
    what its coordinates and the normal modes differ by."""
    push, linear = checked_push("hold_time", push), small_motion(s)
    if linear.growth > 0 or linear.drifts:
        return 0.0
    if not linear.dof:
        return inf
    least = bool(np.linalg.eigvalsh(stiffness_in_masses(linear))[0] > 1e-12)
    if linear.dof > MOST_DOF:
        if least:
            return inf
        raise InputError(f"hold_time: {linear.dof} degrees of freedom: at most {MOST_DOF} are expanded")
    h = local_hamiltonian(s)
    if push > trusted_push(s):
        return 0.0
    if least:
        return inf
    if not s.bars and not s.braces:
        return inf  # each rotor keeps its energy and its momentum about the vertical, and with them both its actions
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
    """In units of the form's rate, by what each degree leaves that is not zero, until sqrt(2) times the size is reached in the
    normal modes; none where these differ by too much from the form's coordinates."""
    n, times, resonant, shift = len(form.frequencies), list[float](), dict[int, float](), 0.0
    rates, zero = np.real(form.frequencies), _ZERO * float(np.abs(form.series.coefficients).max())
    for degree, generator in enumerate(form.generators, 3):
        gap = (generator.exponents[:, :n] - generator.exponents[:, n:]) @ rates
        kept_here, remainder = _feeding(form.series.part(degree)), _feeding(generator.times(gap))
        if remainder > zero:
            growth = {**resonant, degree: kept_here + remainder}
            times.append(_duration(growth, size * (1 + shift), sqrt(2) * size / (1 + shift)))
        resonant[degree] = kept_here
        shift += _moved(generator, degree, sqrt(2) * size)
        if (1 + shift) ** 2 >= sqrt(2):
            break
    return times


def _moved(generator: Polynomial, degree: int, size: float) -> float:
    """How far a generator moves what is of that size, in parts of it, to first order: a bound."""
    return degree * _size(generator) * size ** (degree - 2)


def _feeding(f: Polynomial) -> float:
    """The largest |{Q, f}| at Q = 1."""
    n = f.variables // 2
    by = f.exponents[:, :n].sum(1) - f.exponents[:, n:].sum(1)
    return _size(Polynomial(f.exponents, f.coefficients * by))


def _size(f: Polynomial) -> float:
    """A bound of |f| at sum |z_j|² = 1, w = z̄, f homogeneous of degree d: 2^(d/2) times Bombieri's norm."""
    if not len(f.coefficients):
        return 0.0
    d = int(f.exponents[0].sum())
    return float(np.sqrt(2.0**d * (np.abs(f.coefficients) ** 2 * factorial(f.exponents).prod(1)).sum() / factorial(d)))


def _duration(growth: dict[int, float], begin: float, end: float) -> float:
    """∫ dQ / sum_d g_d Q^(d/2) from Q = begin² to end²."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    r: Array = begin + (end - begin) * (1 + nodes) / 2
    return float((weights * 2 * r / sum(g * r**d for d, g in growth.items())).sum() * (end - begin) / 2)
