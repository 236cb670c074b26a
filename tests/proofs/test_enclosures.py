"""Enclosures hold the truth: closed forms, 60-digit runs, every member of an interval; and mutated arithmetic does not."""

import random
import subprocess
import sys
from dataclasses import replace
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

pytest.importorskip("flint", reason="the extra `proof` is not installed")

from flint import arb, arb_poly

from lagrotor import Link, Rotor, Scene, Shock, Structure, simulate
from lagrotor.errors import ConstraintError, InputError
from lagrotor.mechanics import System, coordinates
from lagrotor.numerics.codegen import Program
from lagrotor.pair.notation import AXES
from lagrotor.proofs import NotProved, enclose, lohner_frames, taylor_step
from lagrotor.proofs.balls import ZERO, as_text, of_text, precision
from lagrotor.proofs.fields import ball
from lagrotor.proofs.tape import tape_of
from lagrotor.proofs.truncated_series import TaylorModel

x, y, u, v = sp.symbols("x y u v")
OSCILLATOR = Program((x, v), (), (v, -x))


def holds(found: Any, truth: Any, digits: int = 28) -> bool:
    """Whether a ball holds a number that is known to some digits."""
    with precision(250):
        return bool(found.overlaps(arb(mp.nstr(truth, digits + 5)) + arb(0, 10.0**-digits)))


def truth_of(
    rates: tuple[sp.Expr, ...], states: tuple[sp.Symbol, ...], start: list[Any], t: float, digits: int = 28
) -> list[Any]:
    """A run by Taylor series in mpmath's numbers, to some digits."""
    with mp.workdps(digits + 5):
        f = sp.lambdify(states, rates, modules="mpmath")
        run = mp.odefun(lambda _, y: f(*y), 0, [mp.mpf(str(c)) for c in start])
        return list(run(mp.mpf(str(t))))


@pytest.mark.parametrize("tol", [1e-8, 1e-17, 1e-40])
def test_an_oscillator_is_its_closed_form(tol: float) -> None:
    found = enclose(OSCILLATOR, {}, ["0.3", "-1.2"], t="7.7", tol=tol)
    with mp.workdps(60):
        t, a, b = mp.mpf("7.7"), mp.mpf("0.3"), mp.mpf("-1.2")
        truth = a * mp.cos(t) + b * mp.sin(t), b * mp.cos(t) - a * mp.sin(t)
    assert all(holds(c, w, 50) for c, w in zip(found.states, truth, strict=True))
    assert max(float(c.rad()) for c in found.states) < 100 * tol


def test_a_decimal_is_meant_exactly() -> None:
    with precision(200):
        assert ball(0.1).contains(arb(1) / 10) and not ball(0.1).contains(arb(0.1))
        assert ball(sp.pi / 3).contains(arb.pi() / 3)
        for value in (arb(1) / 3, arb(-7), arb(2) ** -300, arb(0)):
            middle = value.mid()
            assert of_text(as_text(middle)) == middle


def random_program(rng: random.Random) -> tuple[tuple[sp.Expr, ...], tuple[sp.Symbol, ...], list[str]]:
    """Two coupled coordinates with forces of every function that has a series."""
    q = (x, y)
    forces = []
    for c in q:
        other = y if c is x else x
        a, b, k = (sp.Rational(rng.randint(-9, 9), 10) for _ in range(3))
        kind = rng.choice(
            [
                a * sp.sin(other + c),
                a * sp.cos(c) * sp.exp(b * other),
                a / (2 + c**2 + other**2),
                sp.sqrt(1 + b**2 * c**2 + other**2),
                a * sp.log(2 + c**2),
                a * sp.atan(c + other),
                a * sp.asin(sp.sin(c) / 2),
                a * sp.tanh(c) + b * sp.cosh(other / 3),
                (1 + c**2) ** sp.Rational(-3, 2) * a,
            ]
        )
        forces.append(-c + kind + k * (u if c is y else v) / 3)
    start = [f"{rng.uniform(-1, 1):.3f}" for _ in range(4)]
    return (u, v, *forces), (x, y, u, v), start


def check_random(seed: int, longest: float, digits: int) -> None:
    rng = random.Random(seed)
    rates, states, start = random_program(rng)
    t, tol = round(rng.uniform(0.2, longest), 3), 10.0 ** rng.choice([-9, -17, -24])
    found = enclose(Program(states, (), rates), {}, start, t=t, tol=tol)
    for c, w in zip(found.states, truth_of(rates, states, start, t, digits), strict=True):
        assert holds(c, w, digits), (seed, c, w)
        assert float(c.rad()) < 1e6 * tol


@pytest.mark.parametrize("seed", range(3))
def test_random_systems_hold_the_truth(seed: int) -> None:
    check_random(seed, 0.5, 28)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100, 140))
def test_many_random_systems_hold_the_truth(seed: int) -> None:
    check_random(seed, 1.2, 34)


def test_every_member_of_an_interval_is_held() -> None:
    k = sp.Symbol("k")
    program = Program((x, v, k), (), (v, -k * sp.sin(x)))
    wide = enclose(program, {k: (0.99, 1.01)}, [(0.99, 1.01), 0], t=2)
    rng = random.Random(5)
    for _ in range(6):
        member = {k: rng.uniform(0.99, 1.01)}
        one = enclose(program, member, [rng.uniform(0.99, 1.01), 0], t=2)
        assert all(a.contains(b) for a, b in zip(wide.states, one.states, strict=True))
    with pytest.raises(NotProved, match="the enclosure ends at t = "):
        enclose(program, {k: (0.1, 3)}, [(0.5, 2), 0], t=20)


def test_the_derivative_is_that_of_neighbouring_motions() -> None:
    found = enclose(Program((x, v), (), (v, -sp.sin(x))), {}, [1, "0.2"], t=3)
    for j in range(2):
        ends = []
        for off in ("1e-12", "-1e-12"):
            start = [sp.Integer(1), sp.Rational("0.2")]
            start[j] += sp.Rational(off)
            ends.append(enclose(Program((x, v), (), (v, -sp.sin(x))), {}, start, t=3, tol=1e-30).states)
        for i in range(2):
            with precision(150):
                slope = (ends[0][i] - ends[1][i]) / arb("2e-12")
            assert abs(float(found.derivative[i, j].mid() - slope.mid())) < 1e-9
            assert float(found.derivative[i, j].rad()) < 1e-6


def test_constraints_are_enclosed() -> None:
    c = coordinates("x y")
    (a, b), (p, q) = c.q, c.v
    m = sp.Symbol("m", positive=True)
    pendulum = System(c, m / 2 * (p**2 + q**2) - m * sp.Rational("9.81") * b, ((a**2 + b**2 - 1) / 2,))
    found = enclose(pendulum, {m: 1}, [0.6, -0.8], [0.8, 0.6], 2)
    assert all(r.contains(0) and float(r.rad()) < 1e-13 for r in found.residual)
    angle = sp.Symbol("angle")
    free = enclose(Program((angle, u), (), (u, -sp.Rational("9.81") * sp.sin(angle))), {}, [sp.atan2(3, 4), 1], t=2)
    assert free.states[0].sin().overlaps(found.q[0]) and (-free.states[0].cos()).overlaps(found.q[1])
    near = enclose(pendulum, {m: 1}, [0.1, -(0.99**0.5)], [0, 0], 0.5)
    assert all(r.contains(0) for r in near.residual)
    with pytest.raises(ConstraintError, match="off the constraints"):
        enclose(pendulum, {m: 1}, [0.6, -0.7], [0, 0], 1)


def test_a_scene_and_a_structure_are_where_their_runs_are() -> None:
    scene = Scene((10, -10), link=Link(1, 0.01, 0.1), shock=Shock((40, -11, 0), 0.1, 1 / 20))
    found, run = enclose(scene, t=0.4), simulate(scene, np.array([0, 0.4]), "minimal", tol=1e-11)
    for letter, value in zip(AXES.q, run.axes[:, -1].ravel(), strict=True):
        assert abs(float(found.value(letter).mid()) - value) < 1e-10
    assert max(float(c.rad()) for c in found.states) < 1e-12
    pair = Structure([(0, 0), (1, 0)], [(0, 1)], spins=[10, -10], link=Link(1, 0.01, 0.1), gravity=9.81)
    tilt, rates = [(0.1, 0), (0.1, -0.1)], [(0.3, 0.2), (0.3, -0.1)]
    axes = enclose(pair, None, tilt, rates, 0.5)
    run_of_pair = pair.simulate([0.0, 0.5], tilt, rates, tol=1e-11)
    assert np.allclose([float(c.mid()) for c in axes.q], run_of_pair.axes[:, -1].ravel(), atol=1e-10)
    assert all(r.contains(0) for r in axes.residual)


@pytest.mark.parametrize("ratio", [0.7, 1.6])
def test_bars_shorter_and_longer_than_an_axis(ratio: float) -> None:
    scene = Scene((10, 5), Rotor(), Link(ratio, 0.3, 0.1), Shock((30, 10, 0), 0.05, 1 / 40))
    found, run = enclose(scene, t=0.3), simulate(scene, np.array([0, 0.3]), "minimal", tol=1e-11)
    seen = [float(found.value(letter).mid()) for letter in AXES.q]
    assert np.allclose(seen, run.axes[:, -1].ravel(), atol=1e-10)


@pytest.mark.parametrize("name", ["exp", "sin", "cos", "sqrt", "inverse", "log", "atan"])
def test_what_a_series_leaves_out_is_bounded(name: str) -> None:
    """A random member of the ball, its function's series to 80 terms: the terms from n on sum to no more than the tail."""
    rng, n = random.Random(name), 9
    with precision(200, 80):
        for _ in range(8):
            terms = [2 + rng.random(), *(rng.uniform(-1, 1) * 0.5**k for k in range(1, n))]
            beyond = [rng.uniform(-1, 1) * 1e-5 / 40 for _ in range(40)]
            a = TaylorModel(arb_poly([arb(c) for c in terms]), arb(1e-5), n)
            series = taylor_step.arb_series([arb(c) for c in terms + beyond], 80)
            if name in ("sin", "cos"):
                found = a.sin_cos()[name == "cos"]
            elif name == "log":
                found = a.by_slope("log", a.inverse())
            elif name == "atan":
                one = TaylorModel(arb_poly([arb(1)]), ZERO, n)
                found = a.by_slope("atan", (one + a * a).inverse())
            else:
                found = getattr(a, name)()
            whole = list(series.inv() if name == "inverse" else getattr(series, name)())
            left = sum((abs(c) for c in whole[n:]), arb(0))
            assert left < found.remainder < 1e4 * left
            assert all(found.poly[k].overlaps(whole[k]) for k in range(n))


def without_rest(*arguments: Any) -> Any:
    rests, evaluation = taylor_step.bound_remainder(*arguments)
    return [ZERO for _ in rests], evaluation


def without_error(node: Any, *rest: Any) -> Any:
    return CARRIED(replace(node, s=[ZERO for _ in node.s]), *rest)


def rounded_to_nothing(motion: Any, start: Any, n: int) -> Any:
    """Taylor terms of 24 bits, as if they were exact."""
    with precision(24, n):
        rows = TAYLOR(motion, start, n)
        return [[c.mid() for c in row] for row in rows]


CARRIED, TAYLOR = lohner_frames.next_node, taylor_step.taylor
SPOILED = {
    "the rest of the series": ("bound_remainder", without_rest),
    "the error in the frame": ("next_node", without_error),
    "rounding": ("taylor", rounded_to_nothing),
}


@pytest.mark.parametrize("what", SPOILED)
def test_mutated_arithmetic_loses_the_truth(what: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The twin of every test above: without one of its parts the enclosure is false, and they see it."""
    truth = truth_of((v, -sp.sin(x)), (x, v), [1, "0.2"], 3)
    program = Program((x, v), (), (v, -sp.sin(x)))
    assert all(holds(c, w) for c, w in zip(enclose(program, {}, [1, "0.2"], t=3, tol=1e-9).states, truth, strict=True))
    monkeypatch.setattr(lohner_frames, *SPOILED[what])
    found = enclose(program, {}, [1, "0.2"], t=3, tol=1e-9)
    assert not all(holds(c, w) for c, w in zip(found.states, truth, strict=True))


def test_errors_name_the_value_and_the_way_out() -> None:
    program = Program((x, v), (), (v, -x))
    with pytest.raises(InputError, match="t = -1 must be after the start"):
        enclose(program, {}, [1, 0], t=-1)
    with pytest.raises(InputError, match="must be 2 numbers"):
        enclose(program, {}, [1], t=1)
    with pytest.raises(InputError, match="lowest value comes first"):
        enclose(program, {}, [(2, 1), 0], t=1)
    with pytest.raises(InputError, match="tol = 2"):
        enclose(program, {}, [1, 0], t=1, tol=2)
    with pytest.raises(InputError, match="k has no value"):
        enclose(Program((x, v, k := sp.Symbol("k")), (), (v, -k * x)), {}, [1, 0], t=1)
    with pytest.raises(InputError, match="Abs in the equations has no rigorous series"):
        enclose(Program((x, v), (), (v, -sp.Abs(x))), {}, [1, 0], t=1)
    with pytest.raises(NotProved, match="ends at t = 0: a denominator, or a root's or logarithm's argument"):
        enclose(Program((x, v), (), (v, 1 / x)), {}, [0, 1], t=1)
    with pytest.raises(InputError, match="must be a System"):
        enclose(3, t=1)


def test_without_the_extra_the_way_out_is_named() -> None:
    code = (
        "import sys; sys.modules['flint'] = None\n"
        "import lagrotor.proofs\nfrom lagrotor.errors import InputError\n"
        "try:\n    from lagrotor.proofs import enclose\n"
        "except InputError as error:\n    print(error)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "pip install lagrotor[proof]" in run.stdout


def test_a_step_that_fails_leaves_the_length_of_series_as_it_was() -> None:
    """Shorter series would drop terms that no bound holds; a twin of the guard."""
    from flint import ctx

    motion = taylor_step.Motion(tape_of(Program((x, v), (), (v, 1 / x))), ())
    with precision(64, 12):
        with pytest.raises(NotProved, match="a denominator, or a root's"):
            taylor_step.taylor(motion, [arb(0, 1), arb(1)], 9)
        assert ctx.cap == 12
        with pytest.raises(NotProved, match="series of 20 terms"):
            TaylorModel(arb_poly([1, 1]), ZERO, 20).inverse()
