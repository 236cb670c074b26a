"""Regressor, base parameters and Coriolis matrix against textbooks and against the equations of motion."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics import Frame, System, coordinates, t, total_derivative

g = sp.Symbol("g", positive=True)
PUMA = ([0, -sp.pi / 2, 0, -sp.pi / 2, sp.pi / 2, -sp.pi / 2], (0, 0, "a2", "a3", 0, 0), (0, 0, "d3", "d4", 0, 0))
RX90 = ([0, sp.pi / 2, 0, -sp.pi / 2, sp.pi / 2, -sp.pi / 2], (0, 0, "D3", 0, 0, 0), (0, 0, 0, "R4", 0, 0))


def length(value: Any) -> Any:
    return sp.Symbol(value) if isinstance(value, str) else value


def arm(alpha: Sequence[Any], a: Sequence[Any], d: Sequence[Any]) -> System:
    """An arm of pins by Craig's rule: a turn and a shift along x, then a turn and a shift along z; inertias as symbols."""
    c = coordinates([f"q{i + 1}" for i in range(len(alpha))])
    frame, L = Frame(c), sp.S.Zero
    for i, q in enumerate(c.q):
        frame = frame.turned("x", alpha[i]).moved(length(a[i])).pin(q).moved(0, 0, length(d[i]))
        k = i + 1
        inertia = sp.Matrix(3, 3, lambda r, s, k=k: sp.Symbol(f"J{k}{min(r, s)}{max(r, s)}"))
        body = frame.body(sp.Symbol(f"M{k}"), inertia, sp.symbols(f"X{k} Y{k} Z{k}"))
        L = L + body.kinetic - body.potential((0, 0, -g))
    return System(c, L)


def planar() -> System:
    c = coordinates("p q")
    first = Frame(c).pin("p")
    second = first.moved(sp.Symbol("l1")).pin("q")
    bodies = (
        first.body(sp.Symbol("m1"), (0, 0, sp.Symbol("J1")), (sp.Symbol("a1"), 0, 0)),
        second.body(sp.Symbol("m2"), (0, 0, sp.Symbol("J2")), (sp.Symbol("a2"), 0, 0)),
    )
    return System(c, sum(body.kinetic - body.potential((0, -g, 0)) for body in bodies))


def test_base_parameters_of_a_planar_arm_are_those_of_the_text() -> None:
    a1, a2, l1, m1, m2, J1, J2 = sp.symbols("a1 a2 l1 m1 m2 J1 J2")
    system = planar()
    base = system.base_parameters()
    wanted = [a1 * m1 + l1 * m2, 0, J1 + a1**2 * m1 + l1**2 * m2, a2 * m2, 0, J2 + a2**2 * m2]
    assert [sp.expand(x - y) for x, y in zip(base.values, wanted, strict=True)] == [0] * 6
    Y, pi = system.regressor()
    assert not any((Y * pi - Y[:, list(base.columns)] * base.values).applyfunc(sp.simplify))
    assert not any((Y * pi - system.inverse_dynamics()).applyfunc(sp.simplify))


@pytest.mark.parametrize("shape", [PUMA, RX90], ids=["puma", "rx90"])
def test_arms_of_six_pins_have_36_base_parameters(shape: Any) -> None:
    """Mayeda, Yoshida & Osuka (1990) for the PUMA 560; Khalil & Dombre, table 9.4, for the RX-90, without rotors."""
    base = arm(*shape).base_parameters()
    assert len(base.columns) == 36 and len(base.hidden) == 24
    if shape is RX90:
        M, D, R = sum(sp.symbols("m_3:7", real=True)), sp.Symbol("D3"), sp.Symbol("R4")
        name = {str(s): s for s in base.names}
        wanted = [
            name["Izz_1"] + name["Iyy_2"] + D**2 * M + name["Iyy_3"],
            name["Ixx_2"] - name["Iyy_2"] - D**2 * M,
            name["Ixz_2"] - D * name["mz_3"],
            name["mx_2"] + D * M,
            name["Ixx_3"] - name["Iyy_3"] + name["Iyy_4"] + 2 * R * name["mz_4"] + R**2 * (M - name["m_3"]),
            name["my_3"] + name["mz_4"] + R * (M - name["m_3"]),
        ]
        found = {sp.expand(e) for e in base.combinations}
        assert {sp.expand(e) for e in wanted} <= found


def test_no_motion_tells_a_hidden_change_and_every_base_parameter_is_told() -> None:
    """Turned and sliding joints, an irrational turn, a ball joint: columns of the regressor at random states, by numbers."""
    c = coordinates("s p a b d e")
    slide = Frame(c).turned("x", sp.Rational(3, 10)).prismatic("s")
    arm_frame = slide.moved(0, sp.sqrt(2), 0).pin("p", "x")
    hand = arm_frame.moved(sp.Symbol("l"), 1, 0).ball("a b d e", "u v w")
    bodies = [frame.body(1, (1, 1, 1)) for frame in (slide, arm_frame, hand)]
    system = System(c, sum(body.kinetic - body.potential((0, 0, -g)) for body in bodies))
    base, (Y, _) = system.base_parameters(), system.regressor()
    symbols = (*c.q, *system.speeds, *system.speed_rates, sp.Symbol("l"), g)
    function, random = sp.lambdify(symbols, Y, cse=True), np.random.default_rng(1)
    rows = []
    for _ in range(20):
        numbers = random.uniform(-1, 1, len(symbols))
        numbers[2:6] /= np.linalg.norm(numbers[2:6])
        numbers[-2:] = 0.7, 9.81
        rows.append(function(*numbers))
    stacked = np.vstack(rows)
    size = np.linalg.svd(stacked, compute_uv=False)
    assert np.sum(size > 1e-10 * size[0]) == len(base.columns)
    assert np.linalg.matrix_rank(stacked[:, list(base.columns)]) == len(base.columns)
    for change in base.hidden:
        direction = [float(change.coeff(name).subs("l", 0.7)) for name in base.names]
        np.testing.assert_allclose(stacked @ direction, 0, atol=1e-12)


def test_a_coriolis_matrix_leaves_the_rate_of_the_mass_matrix_skew() -> None:
    system = planar()
    c, C, M = system.c, system.coriolis_matrix(), system.mass_matrix
    skew = M.applyfunc(lambda e: total_derivative(e, c)) - 2 * C
    assert not any((skew + skew.T).applyfunc(sp.simplify))
    weight = sp.Matrix([sp.diff(system.L, q) for q in c.q]).xreplace(dict.fromkeys(c.v, sp.S.Zero))
    assert not any((C * sp.Matrix(c.v) - weight - system.bias).applyfunc(sp.simplify))
    driven = System(coordinates("x"), (1 + t**2) * sp.Symbol("x_dot", real=True) ** 2)
    with pytest.raises(InputError, match="the mass matrix contains t"):
        driven.coriolis_matrix()


def test_what_has_no_base_parameters_is_refused() -> None:
    c = coordinates("p r")
    frame = Frame(c).pin("p").moved(1).pin("r")
    body = frame.body(1, (1, 1, 1))
    refused = {
        "made of bodies": System(c, c.p_dot**2 + c.r_dot**2),
        "of all or of none": System(c, body.kinetic + Frame(c).pin("p").body(1).kinetic - body.potential((0, 0, 1))),
        "leave them out": System(c, body.kinetic, (c.p - c.r,)),
        "the joints move with time": System(c, body.kinetic + frame.moved(t).body(1).kinetic),
        "joints with .*tanh": System(c, body.kinetic + frame.moved(sp.tanh(c.p)).body(1).kinetic),
        "common divisor": System(c, body.kinetic + frame.pin(c.p / 2, "x").body(1, (1, 1, 1)).kinetic),
    }
    for words, system in refused.items():
        with pytest.raises(InputError, match=words):
            system.base_parameters()
