"""The interactive model of the report: a rotor pair with sliders, whose formulas are generated as JavaScript.

The browser evaluates the same expressions that Python compiles: rates and axes of the minimal model, the periodic series for
any bar, and the paper's formula. Integration, drawing and controls (interactive_*.js), the style (interactive.css) and the
markup (interactive.html) are written by hand.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

import sympy as sp

from lagrotor.drawing.view import canvas_script
from lagrotor.mechanics.fourier import FourierSeries
from lagrotor.models.programs import minimal_program as elimination
from lagrotor.models.programs.minimal_program import Ratio
from lagrotor.numerics.codegen import Program, Stage
from lagrotor.numerics.printers import javascript
from lagrotor.pair.lagrangians import INERTIAS, J_OF, JOINT_LINE, bar_curve, mercator_axis, minimal_embedding
from lagrotor.pair.notation import (
    AXES,
    G_1,
    G_2,
    I1,
    I3,
    MERCATOR,
    MINIMAL,
    J,
    K,
    M,
    Phi,
    R,
    a,
    b,
    ell,
    k,
    m,
    omega_1,
    omega_2,
)
from lagrotor.pair.notation import r0 as amplitude
from lagrotor.pair.notation import sigma as shape
from lagrotor.pair.scene import Rotor
from lagrotor.theory.natural_frequency import linear_pair, natural_frequency
from lagrotor.theory.paired_precession import horner
from lagrotor.theory.paired_precession.series import paired_series

PAGE_ORDER = 9  # highest order of the series whose coefficients are short enough for the page
_BARS: tuple[Ratio, ...] = "short", "equal", "long"
_Y_1, _Y_2 = AXES.v[1], AXES.v[4]


@cache
def interactive() -> str:
    """Return the pair as a self-contained HTML fragment: `<section id="model">`, its style and its script."""
    scripts = [_part(f"interactive_{name}.js") for name in ("motion", "drawing", "controls")]
    lines = [javascript_formulas(), canvas_script(), *scripts, 'show(document.getElementById("model"));']
    script = "\n".join(["(() => {", '"use strict";', *lines, "})();"])
    return _part("interactive.html").replace("/* script */", script).replace("/* style */", _part("interactive.css"))


def _part(file: str) -> str:
    return (Path(__file__).parent / file).read_text(encoding="utf-8")


@cache
def javascript_formulas() -> str:
    """Return the generated part of the script: the order of the series, and one JavaScript function per program."""
    lines = [f"const ORDER = {PAGE_ORDER};", *(javascript(program, name) for name, program in page_programs().items())]
    return "\n".join(lines)


@cache
def page_programs() -> dict[str, Program]:
    """Return the programs that the script calls, by name. Units are SI; the rotors are the paper's, M = R = I_1 = I_3 = 1.

    Each row gives the arguments and, after the arrow, the outputs. A name that ends with _ is completed by short, equal or
    long: a program for a bar that is shorter than an axis, as long, or longer. U, chi, alpha are the minimal model's coordinates.

    constants     (m, K, ell, omega_1, omega_2) → a, b, k, sigma, G_1, G_2, Omega_0, and the paper's rate (5.28)
    rate_         (coordinates, velocities, a, b, k, G_1, G_2) → the rates of change of the minimal model
    axes_         (U, chi, alpha, k) → the axes r_1, r_2
    start_        (r_0, y_1', y_2', k) → the state with both axes at (r_0, 0, sqrt(1 − r_0²)) and these rates
    slopes_       (U, chi, alpha, k) → the derivatives of r_1, r_2 by the coordinates, 6 rows of 3
    small_motion  (r_0, a, b, G_1, G_2) → y_1', y_2' of the pair's one small oscillation, for any spins
    series        (powers of r_0, sigma, k) → the coefficients of c⁰, c¹ … in x, y / s and z, and Omega / Omega_0
    orbit         (c, s, coefficients) → the axes r_1, r_2, with c = cos Phi and s = sin Phi
    paper         (r_0, Phi) → the axes r_1, r_2 as equations 5.20 and 5.22 print them
    bar_length    (r_1, r_2, ell) → the distance of the tips in m
    """
    result = {"constants": _constants(), "small_motion": _small_motion(), "paper": _paper(), "bar_length": _length()}
    result |= {"series": _series(), "orbit": horner.horner_program(PAGE_ORDER)}
    for ratio in _BARS:
        arguments, pair = (*MINIMAL.q, k), _pair_at(ratio)
        result |= {f"rate_{ratio}": _rate(ratio), f"axes_{ratio}": Program(arguments, (), tuple(pair))}
        result |= {f"start_{ratio}": _start(ratio)}
        result |= {f"slopes_{ratio}": Program(arguments, (), tuple(pair.jacobian(MINIMAL.q)))}
    return result


def _constants() -> Program:
    rotor = Rotor()
    sizes = {M: rotor.mass, R: rotor.length, I1: rotor.I1, I3: rotor.I3}
    values = {symbol: sp.Rational(repr(size)) for symbol, size in sizes.items()}
    stages = [(symbol, expression.subs(J, J_OF).subs(values)) for symbol, expression in INERTIAS.items()]
    stages += [(shape, (a + b) / (a - b)), (G_1, values[I3] * omega_1), (G_2, values[I3] * omega_2)]
    printed = (sp.Rational("0.7125") * I3 * omega_1 / J_OF).subs(values)
    outputs = (a, b, k, shape, G_1, G_2, natural_frequency().expressions[0], printed)
    return Program((m, K, ell, omega_1, omega_2), tuple(stages), outputs)


def _rate(ratio: Ratio) -> Program:
    massive = elimination.program(True, ratio, 0)  # holds for b = 0 too
    return replace(massive, arguments=(*MINIMAL.q, *MINIMAL.v, a, b, k, G_1, G_2))


def _pair_at(ratio: Ratio) -> sp.Matrix:
    """Return the axes r_1 and r_2, one below the other, shape (6, 1), as functions of the minimal model's coordinates."""
    curve = bar_curve(ratio)
    embedding = minimal_embedding(curve.twist, curve.latitude)
    first, second = (mercator_axis(*MERCATOR.q[i : i + 2]).subs(embedding) for i in (0, 2))
    return first.col_join(second)


def _start(ratio: Ratio) -> Program:
    U, chi, alpha = MINIMAL.q
    parallel = {U: sp.atanh(amplitude), chi: 0, alpha: 0}
    ordinates = sp.Matrix([_pair_at(ratio)[i] for i in (1, 4)])
    slopes = ordinates.jacobian([chi, alpha]).subs(parallel)
    rates = slopes.LUsolve(sp.Matrix([_Y_1, _Y_2]))
    return Program((amplitude, _Y_1, _Y_2, k), (), (parallel[U], sp.Integer(0), sp.Integer(0), sp.Integer(0), *rates))


def _small_motion() -> Program:
    """Return the program for the initial rates y_1', y_2' of the pair's one small oscillation, from parallel axes.

    They follow from the linear equations M q'' + C q' = 0, integrated about the mean of q to M q' = −C q.
    """
    linear = linear_pair()
    parallel = linear.basis[0, :].T * amplitude
    rates = -linear.basis * linear.mass.LUsolve(linear.gyroscopic * parallel)
    return Program((amplitude, a, b, G_1, G_2), (), (sp.factor(rates[1]), sp.factor(rates[4])))


def _series() -> Program:
    """Return the program for the coefficients of the series in r_0.

    Its arguments r_n stand for r_0**n and are 0 beyond the wanted order, so that one function serves every order.
    """
    orbit, cosine = paired_series(PAGE_ORDER), sp.Symbol("c", real=True)
    powers = [sp.Integer(1), *(sp.Symbol(f"r_{n}", real=True) for n in range(1, PAGE_ORDER + 1))]
    stages: list[Stage] = []

    def sizes(of: FourierSeries, name: str) -> Iterator[tuple[int, sp.Symbol]]:
        for (n, h), value in sorted(of.terms.items()):
            size = sp.Symbol(f"{name}_{n}_{h}".replace("-", "s"), real=True)
            stages.append((size, sp.factor(orbit.field.to_sympy(value)) * powers[n]))
            yield h, size

    outputs: list[sp.Expr] = []
    for name, of, scale in (("x", orbit.x, 1), ("y", orbit.Y, sp.sqrt(shape)), ("z", orbit.z, 1)):
        sums = [sp.Integer(0)] * (PAGE_ORDER + 1)
        for h, size in sizes(of, name):
            # cos h Phi = T_h(c), sin h Phi = s U_(h−1)(c).
            wave = sp.chebyshevt(h, cosine) if h >= 0 else sp.chebyshevu(-h - 1, cosine)
            for (degree,), share in sp.Poly(wave, cosine).terms():
                sums[degree] += share * size
        outputs += [scale * total for total in sums]
    frequency = sum((size for _, size in sizes(orbit.frequency, "f")), sp.Integer(0))
    return Program((*powers[1:], shape, k), tuple(stages), (*outputs, frequency))


def _paper() -> Program:
    sines = amplitude - amplitude**2 * sp.cos(Phi), amplitude + amplitude**2 * sp.cos(Phi)
    first, second = (
        (sine * sp.cos(phi), sine * sp.sin(phi), sp.sqrt(1 - sine**2))
        for sine, phi in zip(sines, (Phi, -Phi), strict=True)
    )
    return Program((amplitude, Phi), (), (*first, *second))


def _length() -> Program:
    first, second = sp.Matrix(AXES.q[:3]), sp.Matrix(AXES.q[3:])
    bar = ell * JOINT_LINE + sp.Rational(repr(Rotor().length)) * (second - first)
    return Program((*AXES.q, ell), (), (sp.sqrt(bar.dot(bar)),))
