"""Closed forms, each with its assumptions, domain and order, generated as numpy functions that broadcast.

Every expression is derived here from the Lagrangian; none is typed in.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from math import prod
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import DomainError, InputError
from lagrotor.mechanics import momenta
from lagrotor.mechanics.perturbation import LinearSystem, linearise
from lagrotor.numerics.codegen import Program, compile_program, in_blocks
from lagrotor.pair.symbols import ANSATZ, AXES, G_1, G_2, GLOSSARY, I3, M_3, ROTOR, A, B, G, J, M_z, Phi, a, b, k, omega, r0, sigma
from lagrotor.pair.lagrangians import ansatz_integrals, axes_pair, rotor_lagrangian
from lagrotor.theory.paired_precession.series import paired_series
from lagrotor.pair.scene import Scene


@dataclass(frozen=True)
class ClosedForm:
    """Expressions of `arguments`, valid under `assumptions` where every condition of `domain` holds.

    `order`: through which power of `small` a series is right; None for an exact form. `source`: the paper's equation.
    Called with numbers or arrays in the order of `arguments` it returns the expressions' values, broadcast.
    """

    name: str
    outputs: tuple[str, ...]
    expressions: tuple[sp.Expr, ...]
    arguments: tuple[sp.Symbol, ...]
    domain: tuple[sp.Basic, ...]
    assumptions: str
    source: str
    order: int | None = None
    small: sp.Symbol | None = None

    @cached_property
    def _functions(self) -> tuple[Callable[..., Any], tuple[Callable[..., Any], ...]]:
        units = ", ".join(f"{s} [{GLOSSARY[s].unit}]" if s in GLOSSARY else str(s) for s in self.arguments)
        doc = f"{self.name}({units}) -> {', '.join(self.outputs)}"
        expressions = tuple(e.replace(_is_multiple, _by_one_angle) for e in self.expressions)
        values = compile_program(Program(self.arguments, (), expressions), "numpy", doc)
        return values, tuple(sp.lambdify(self.arguments, condition, "numpy") for condition in self.domain)

    def _repr_latex_(self) -> str:
        pairs = zip(self.outputs, self.expressions, strict=True)
        named = ((re.sub("(?=Omega|phi|theta|sin)", r"\\", name), sp.latex(e)) for name, e in pairs)
        lines = r" \\ ".join(f"{name} &= {expression}" for name, expression in named)
        return rf"$\displaystyle \begin{{aligned}} {lines} \end{{aligned}}$"

    def __call__(self, *values: ArrayLike) -> NDArray[np.float64] | tuple[NDArray[np.float64], ...]:
        """The outputs at these argument values: one array, or a tuple where there are several outputs.

        Raises InputError for a wrong number of arguments, DomainError where a value is outside the domain.
        """
        if len(values) != len(self.arguments):
            raise InputError(
                f"{self.name}: takes {len(self.arguments)} arguments ({', '.join(map(str, self.arguments))})"
            )
        given = [np.asarray(v, dtype=float) for v in values]
        shape = np.broadcast_shapes(*(array.shape for array in given))
        for argument, array in zip(self.arguments, given, strict=True):
            if not np.isfinite(array).all():
                raise DomainError(f"{self.name}: {argument} holds a value that is not finite")
            if argument.is_positive and not (array > 0).all():
                raise DomainError(f"{self.name}: {argument} = {array.min():g} must be greater than zero")
        # One value for all stays one number.
        flat = [float(v.flat[0]) if v.size == 1 else np.broadcast_to(v, shape).ravel() for v in given]
        function, conditions = self._functions
        for relation, condition in zip(self.domain, conditions, strict=True):
            inside = np.broadcast_to(condition(*flat), prod(shape))
            if not inside.all():
                where = int(np.argmin(inside))
                at = ", ".join(
                    f"{s} = {v if isinstance(v, float) else v[where]:g}"
                    for s, v in zip(self.arguments, flat, strict=True)
                )
                raise DomainError(f"{self.name}: outside its domain {relation}: {at}")
        results = tuple(row.reshape(shape) for row in in_blocks(function, flat, len(self.outputs), prod(shape)))
        return results if len(results) > 1 else results[0]


def _is_multiple(e: sp.Expr) -> bool:
    """cos(n x) or sin(n x) with n = 2, 3, …"""
    return isinstance(e, sp.cos | sp.sin) and e.args[0].as_coeff_Mul()[0] in range(2, 100)


def _by_one_angle(e: sp.Expr) -> sp.Expr:
    """T_n(cos x) or sin x U_(n−1)(cos x): products of two functions cost less than another function."""
    n, x = e.args[0].as_coeff_Mul()
    if isinstance(e, sp.cos):
        return sp.chebyshevt(n, sp.cos(x))
    return sp.sin(x) * sp.chebyshevu(n - 1, sp.cos(x))


@cache
def rotor_precession_rate() -> ClosedForm:
    """phi' = (M_z − M_3 cos theta) / (J sin² theta) of one grounded rotor, from its two cyclic momenta (5.02)."""
    theta, (_, phi_v, psi_v) = ROTOR.q[0], ROTOR.v
    p = momenta(rotor_lagrangian(), ROTOR)
    rate = sp.solve([p[1] - M_z, p[2] - M_3], [phi_v, psi_v], dict=True)[0][phi_v]
    return ClosedForm(
        "rotor_precession_rate",
        ("phi'",),
        (sp.factor(rate),),
        (theta, M_z, M_3, J),
        (sp.Ne(sp.sin(theta), 0),),
        "one grounded rotor, no gravity",
        "5.02",
    )


@cache
def pair_precession_rate() -> ClosedForm:
    """phi' of the ansatz pair from its integrals A and B, for any J and I_3; the paper's (5.15) for J = I_3 = I."""
    theta_1, theta_2 = ANSATZ.q[:2]
    phi_v, psi_v = ANSATZ.v[2:]
    integral_A, integral_B = ansatz_integrals()
    rate = sp.solve([integral_A - A, integral_B - B], [phi_v, psi_v], dict=True)[0][phi_v]
    numerator, denominator = sp.fraction(sp.together(rate))
    return ClosedForm(
        "pair_precession_rate",
        ("phi'",),
        (numerator / denominator,),
        (theta_1, theta_2, A, B, J, I3),
        (sp.Ne(sp.factor(denominator), 0),),
        "the ansatz phi_1' = −phi_2', psi_1' = −psi_2'; a link that exerts nothing",
        "5.15",
    )


@cache
def linear_pair() -> LinearSystem:
    """The coupled pair linearised at rest, in (x, y_1, y_2), for any spins and any bar."""
    system, gyroscopic = axes_pair()
    upright = dict(zip(AXES.q, (0, 0, 1, 0, 0, 1), strict=True))
    return linearise(system, upright, list(gyroscopic))


@cache
def natural_frequency() -> ClosedForm:
    """Omega_0² = (a (G_1² + G_2²) − 2 b G_1 G_2) / (2 (a + b)(a² − b²)): the one oscillation of the linear pair.

    The other roots of det(s² M + s C) are zero: turning about the joint line and displacements at rest.
    """
    s = sp.Symbol("s")
    polynomial = sp.Poly(linear_pair().characteristic(s), s)
    leading, constant = polynomial.coeff_monomial(s**6), polynomial.coeff_monomial(s**4)
    return ClosedForm(
        "natural_frequency",
        ("Omega_0",),
        (sp.sqrt(sp.factor(constant / leading)),),
        (a, b, G_1, G_2),
        (sp.Gt(a, sp.Abs(b)),),
        "small motion about the upright rest state, any spins, any bar",
        "5.28",
    )


@cache
def paired_frequency(order: int = 3) -> ClosedForm:
    """Omega / Omega_0 of the paired precession at amplitude r_0 (opposite spins), through r_0**order (5.21)."""
    series = paired_series(order + 1)  # order n of the orbit fixes the frequency's order n − 1
    return ClosedForm(
        "paired_frequency",
        ("Omega/Omega_0",),
        (series.expression(series.frequency),),
        (r0, sigma, k),
        _ORBIT_DOMAIN,
        "opposite spins, the symmetric periodic orbit",
        "5.21",
        order,
        r0,
    )


_ORBIT_DOMAIN = (sp.Gt(r0, -1), sp.Lt(r0, 1))


@cache
def corrected_trajectories(order: int = 3) -> ClosedForm:
    """Axes (x_1, y_1, z_1, x_2, y_2, z_2) of the paired precession at phase Phi = Omega t, through r_0**order (5.22).

    r_0 is the sine of the inclination when the axes are parallel (Phi = 0). Tips: ∓ell/2 e_x + R r_i.
    """
    series = paired_series(order)
    x, y, z = (series.expression(part) for part in (series.x, series.Y, series.z))
    y *= sp.sqrt(sigma)
    later = {Phi: Phi + sp.pi}
    second = (-x.subs(later), y.subs(later), z.subs(later))
    return ClosedForm(
        "corrected_trajectories",
        ("x_1", "y_1", "z_1", "x_2", "y_2", "z_2"),
        (x, y, z, *second),
        (r0, Phi, sigma, k),
        _ORBIT_DOMAIN,
        "opposite spins with G_1 > 0, the symmetric periodic orbit",
        "5.22",
        order,
        r0,
    )


@cache
def corrected_inclinations(order: int = 2) -> ClosedForm:
    """(sin theta_1, sin theta_2) of the paired precession with a massless bar or a dumbbell (sigma = 1), in r_0 (5.20)."""
    from lagrotor.algebra import normal_form, truncated_series

    series = paired_series(order + 1, sp.Integer(1))
    x, y = series.expression(series.x), series.expression(series.Y)
    first = truncated_series(r0 * sp.sqrt(normal_form((x**2 + y**2) / r0**2)), r0, order)
    return ClosedForm(
        "corrected_inclinations",
        ("sin theta_1", "sin theta_2"),
        (first, first.subs(Phi, Phi + sp.pi)),
        (r0, Phi, k),
        (sp.Ge(r0, 0), sp.Lt(r0, 1)),
        "opposite spins, sigma = 1",
        "5.20",
        order,
        r0,
    )


@cache
def free_precession_rate() -> ClosedForm:
    """G / (J cos theta): the steady precession of one free grounded rotor about the angular momentum it has (5.23).

    From theta'' = 0 in the Euler–Lagrange equation of theta, sin theta phi' (J cos theta phi' − G) = 0.
    """
    from lagrotor.mechanics import euler_lagrange

    theta, (theta_v, phi_v, psi_v), theta_a = ROTOR.q[0], ROTOR.v, ROTOR.a[0]
    steady = euler_lagrange(rotor_lagrangian(), ROTOR)[0].subs(
        {theta_a: 0, theta_v: 0, psi_v: omega - phi_v * sp.cos(theta)}
    )
    rate = next(root for root in sp.solve(steady, phi_v) if root != 0)
    return ClosedForm(
        "free_precession_rate",
        ("phi'",),
        (rate.subs(omega, G / I3),),
        (theta, G, J),
        (sp.Ne(sp.cos(theta), 0),),
        "one grounded rotor, no gravity, theta constant",
        "5.23",
    )


def natural_rate(scene: Scene) -> float:
    """Natural angular frequency (rad/s) of a scene: of the coupled pair, or of rotor 1 alone when there is no bar.

    Omega_0² = (a (G_1² + G_2²) − 2 b G_1 G_2) / (2 (a + b)(a² − b²)); see `natural_frequency`. Source: 5.28, corrected.
    """
    if not isinstance(scene, Scene):
        raise InputError(f"natural_rate: {scene!r} must be a Scene")
    first, second = scene.momenta
    if scene.link is None:
        return abs(float(free_precession_rate()(0.0, first, scene.rotor.J)))  # type: ignore[arg-type]
    return float(natural_frequency()(*scene.inertias, first, second))  # type: ignore[arg-type]
