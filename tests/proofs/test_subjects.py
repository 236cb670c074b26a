"""What a theorem is about: the program is that of what is named, and of nothing else that is like it."""

import json
from operator import add, mul, sub, truediv
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

pytest.importorskip("flint", reason="the extra `proof` is not installed")

from lagrotor import Link, Scene, Shock, Structure
from lagrotor.errors import InputError
from lagrotor.mechanics import System, coordinates, t
from lagrotor.numerics.codegen import Program
from lagrotor.pair.notation import AXES
from lagrotor.proofs import NotProved, check, crossing, enclose, equilibrium, precession
from lagrotor.proofs.checker.expression_tapes import Words
from lagrotor.proofs.checker.reversals import points_of
from lagrotor.proofs.fields import field_of
from tests.proofs.gallery import PLANE, RATE, THETA, C, U, V, X, Y, plain, spoiled

M, G, ELL, K = sp.symbols("m g ell k", positive=True)
PENDULUM = System(C, M * ELL**2 * RATE**2 / 2 + M * G * ELL * sp.cos(THETA), dissipation=K * RATE**2 / 2)
VALUES = {M: "0.7", G: "9.81", ELL: 1, K: "0.1"}
DRIVEN = System(PLANE, (U**2 + V**2) / 2 - X * t, ((X**2 + Y**2 - 1) / 2,), forces=(Y * V, sp.exp(-t) - U * Y))
SLEIGH = System(PLANE, (U**2 + V**2) / 2 - X**2 / 2, rolling=(V - X * U,), dissipation=U**2 / 10)
x, v = sp.symbols("x v")
SHOCKED = Scene((10, -10), link=Link(1, 1, 0.5), shock=Shock((50, 0, 1), at=0.02, width=0.05, body=2))
CORNER = Structure([(0, 0), (1, 0), (1, 1)], [(0, 1), (1, 2)], spins=(10, -10, 7), gravity=9.81, link=Link(1, 0.5, 0.1))

THEOREMS: dict[str, Any] = {
    "a Lagrangian with friction": lambda: enclose(PENDULUM, VALUES, [1], [0], "0.1"),
    "constraint, time and forces": lambda: enclose(DRIVEN, {}, [0, 1], [1, 0], "0.1"),
    "rolling and friction": lambda: enclose(SLEIGH, {}, [1, 0], [1, 1], "0.1"),
    "rates in words": lambda: enclose(Program((x, v, K), (), (v, -K * sp.sin(x))), {K: 2}, [1], [0], "0.1"),
    "a scene that is pushed": lambda: crossing(SHOCKED, event=AXES.q[0] - sp.Rational(1, 1000), t_end="0.1", tol=1e-12),
    "a structure": lambda: enclose(CORNER, None, [(0.1, 0)] * 3, [(0, 0)] * 3, "0.02", 1e-12),
    "an equilibrium": lambda: equilibrium(System(C, PENDULUM.L), VALUES, [0.1]),
}


@pytest.fixture(scope="module")
def certificates() -> dict[str, Any]:
    return {name: plain(make()) for name, make in THEOREMS.items()}


SAYS = {
    "a Lagrangian with friction": "L = ell**2*m*theta_dot**2/2 + ell*g*m*cos(theta), dissipation k*theta_dot**2/2, from t = 0 "
    "with theta = 1, theta_dot = 0, where ell = 1, g = 9.81, k = 0.1, m = 0.7.",
    "constraint, time and forces": "forces (y*y_dot, -x_dot*y + exp(-t)), x**2/2 + y**2/2 - 1/2 = 0, from t = 0 with x = 0, y",
    "rolling and friction": "dissipation x_dot**2/10, -x*x_dot + y_dot = 0, from t = 0 with",
    "rates in words": "This holds for the motion x′ = v, v′ = -k*sin(x), from t = 0 with x = 1, v = 0, where k = 2.",
    "a scene that is pushed": "the pair of spins 10, -10 rad/s with a bar of 1 m, 1 kg, 0.5 kg m² and rotors of 1 m, 1 kg, I1 "
    "= 1, I3 = 1 kg m², pushed at rotor 2 by (50, 0, 1) N exp(−((t − 0.02)/0.05)²), from t = 0 with all states 0.",
    "a structure": "the structure of rotors at (0, 0), (1, 0), (1, 1) m of 1 m, 1 kg, I1 = 1, I3 = 1 kg m²; bars 0–1 of 1 m, 1–2 "
    "of 1 m, each of 0.5 kg, 0.1 kg m²; spins 10, -10, 7 rad/s; gravity 9.81 m/s², from t = 0 with x_0 = 0.0999",
    "an equilibrium": "is definite there and conserved. This holds for the system with L = ell**2*m*theta_dot**2/2",
}


@pytest.mark.parametrize("name", THEOREMS)
def test_a_theorem_says_of_what_it_is(name: str, certificates: Any) -> None:
    assert SAYS[name] in check(certificates[name])


L = "about/Lagrangian"
# Theorem → path in its certificate → entries that make it a theorem of something else.
OTHERS: dict[str, dict[str, list[Any]]] = {
    "a Lagrangian with friction": {
        f"{L}/L": ["ell**2*m*theta_dot**2/2 + ell*g*m*cos(theta)*(1 + 1/10**40)", "0", "ell**2*m*theta_dot*theta"],
        f"{L}/dissipation": ["0", "-k*theta_dot**2/2"],
        f"{L}/forces": [["theta"]],
        f"{L}/constraints": [["theta - 1"]],
        f"{L}/letters": [["theta"]],
        "motion/operations/0": [["argument", 1]],
        "about": [
            {"rates": ["theta_dot", "-theta"]},
            {"scene": {}},
            {},
            {"Lagrangian": 1, "rates": []},
            "the pendulum",
        ],
    },
    "constraint, time and forces": {
        f"{L}/constraints": [[], ["x - x"], ["x**2/2 + y**2/3 - 1/2"]],
        f"{L}/forces": [["y*y_dot"], ["y*y_dot", "-x_dot*y + exp(t)"]],
        f"{L}/L": ["x_dot**2/2 + y_dot**2/2"],
        "motion/arguments/4": ["tau"],
        "start/middle/4": [["1p0", "0p0"]],  # the time
        "start/middle/1": [["3p-1", "0p0"]],  # off the constraint
        "start/middle/3": [["1p-60", "0p0"]],  # leaving it
    },
    "rolling and friction": {f"{L}/rolling": [[], ["x*x_dot + y_dot"]], f"{L}/dissipation": ["x_dot**2/11"]},
    "rates in words": {
        "about/rates": [["v"], ["v", "-k*x"], ["v + 0*heat", "-k*sin(x)"]],
        "motion/arguments/0": ["x=1,"],
    },
    "a scene that is pushed": {
        "about/scene/spins": [[10, -10.000001], [10, 10]],
        "about/scene/link/mass": [0],
        "about/scene/link/inertia": [0.4],
        "about/scene/rotor/I1": [1.5],
        "about/scene/shock": [None],
        "about/scene/shock/body": [1],
        "about/scene/shock/width": [0.0500001],
        "about/scene/shock/force": [[50, 0, -1]],
        "observed/names": [[f"z_{i}" for i in range(12)]],
        "observed/outputs/0": [0],
        "about": [None],
    },
    "a structure": {
        "about/structure/spins": [[10, -10, 8]],
        "about/structure/joints": [[[0, 0], [1, 0], [1, 1], [2, 2]]],
        "about/structure/gravity": [0],
        "start/middle/2": [["1p0", "0p0"]],
        "about/structure/bars": [[[0, 1, 1]]],
        "about/structure/braces": [[{"tip": 0, "to": [0, 3, 5], "stiffness": 1, "damping": 0}]],
    },
    "an equilibrium": {
        f"{L}/dissipation": ["m*theta_dot**2/2"],
        "energy": ["-ell*g*m*cos(theta) + ell**2*m*theta_dot**2"],
        "claim/stability": ["asymptotically stable"],
        "about": [None],
    },
}


@pytest.mark.parametrize(("name", "path"), [(name, path) for name, rows in OTHERS.items() for path in rows])
def test_a_theorem_of_something_else_is_refused(name: str, path: str, certificates: Any) -> None:
    for value in OTHERS[name][path]:
        other = spoiled(certificates[name], path, value)
        assert other != certificates[name]
        with pytest.raises((NotProved, ValueError)):
            check(other)


ENERGY = "x_dot**2/2 + y_dot**2/2"
CIRCLE = "x**2/2 + y**2/2 - 1/2"


@pytest.mark.parametrize(
    ("key", "value", "refusal"),
    [
        ("L", f"sin(pi)*({ENERGY} - x*t)", "determine the accelerations"),  # zero, though no identity of letters
        ("L", f"(sin(2) - 2*sin(1)*cos(1))*({ENERGY} - x*t)", "determine the accelerations"),
        ("constraints", [f"(4*atan(1) - pi)*({CIRCLE})"], "determine the accelerations"),
        ("constraints", ["x**2/2 + y**2/2 - c/2"], "symbols without a value"),
        ("letters", ["c,x:y"], "the name of a symbol is not one word"),
        ("letters", ["c\u200b"], "the name of a symbol is not one word"),
        ("L", f"{ENERGY} - x*t + 0*log(-1 - x**2)", "positive"),
        ("L", f"{ENERGY} - x*t + sqrt(-1 - x**2) - sqrt(-1 - x**2)", "positive"),
    ],
)
def test_what_is_named_is_what_its_words_say_at_the_start(
    key: str, value: Any, refusal: str, certificates: Any
) -> None:
    """Functions of numbers are letters modulo a prime: independent there, though they may cancel."""
    found = certificates["constraint, time and forces"]
    data = found["about"]["Lagrangian"] | ({"letters": ["c"]} if key != "letters" else {}) | {key: value}
    if key == "L" and "*(" in value:  # all that acts is scaled
        data["forces"] = [f"{value.split('*(')[0]}*({f})" for f in data["forces"]]
    with pytest.raises(NotProved, match=refusal):
        check(found | {"about": {"Lagrangian": data}})


def test_the_time_is_no_parameter() -> None:
    """L = x'²/2 − (1 + t) x²/2 at a fixed t is another motion."""
    c = coordinates("x")
    (q,), (w,) = c.q, c.v
    found = plain(enclose(System(c, w**2 / 2 - (1 + K) * q**2 / 2), {K: 2}, [1], [0], "0.1"))
    text = json.dumps(found).replace('"k"', '"t"').replace("k + 1", "t + 1")
    with pytest.raises(NotProved, match="t is not the time"):
        check(json.loads(text))


def test_a_bar_has_the_length_that_is_named() -> None:
    """Longer than the tips are apart upright; and a root, that no decimal is."""
    pair = Structure([(0, 0), (1, 0)], [(0, 1, 1.2)], spins=(10, -10))
    found = enclose(pair, None, [(-0.1, 0), (0.1, 0)], [(0, 0)] * 2, "0.01", 1e-12)
    x = dict(zip(map(str, found.field.states), found.states, strict=True))
    apart = [int(letter == "x") + x[f"{letter}_1"] - x[f"{letter}_0"] for letter in "xyz"]
    assert abs(sum(d * d for d in apart) - 1.44) < 1e-9
    assert "bars 0–1 of 1.2 m" in check(plain(found))
    other = plain(found)
    other["about"]["structure"]["bars"] = [[0, 1, 1]]
    with pytest.raises(NotProved):
        check(other)
    skew = Structure([(0.1, 0.3), (0.3, 0.7)], [(0, 1)], spins=(10, -10), link=Link(1, 1, 0.1))
    words = check(enclose(skew, None, [(0.1, 0)] * 2, [(0, 0)] * 2, "0.01", 1e-12).certificate)
    assert "bars 0–1 as long as its tips are apart upright" in words


ROOTS = {
    "a root in the mass": -sp.sqrt(1 - U**2 - V**2) + 1 / sp.sqrt(X**2 + Y**2),
    "a third": (U**2 + V**2) / 2 - sp.cbrt(1 + X**2),
    "tenths, π and √2": sp.pi * (U**2 + V**2) / 2 - (1 + X**2) ** sp.Rational(17, 10) + sp.sqrt(2) * sp.cos(Y),
    "four roots": (U**2 + V**2) / 2 + sum(1 / sp.sqrt((X - i) ** 2 + (Y - 1) ** 2) for i in range(2, 6)),
    "seven roots": (U**2 + V**2) / 2 + sum(1 / sp.sqrt((X - i) ** 2 + (Y - 1) ** 2) for i in range(2, 9)),
}


@pytest.mark.parametrize("name", ROOTS)
def test_roots_are_what_their_squares_say(name: str) -> None:
    found = plain(enclose(System(PLANE, ROOTS[name]), {}, ["0.5", 0], [0, "0.25"], "0.02", 1e-9))
    check(found)
    data = found["about"]["Lagrangian"]
    other = found | {"about": {"Lagrangian": data | {"L": data["L"] + " + x**3/10**9"}}}
    with pytest.raises(NotProved, match="do not satisfy Lagrange's equations"):
        check(other)


def test_an_orbit_names_its_parameters_and_a_precession_its_pair() -> None:
    orbit = json.loads(json.dumps(precession(Scene((10, -10)), "0.204", 1e-12).certificate))
    words = check(orbit)
    assert words.startswith(
        "The pair of spins 10, -10 rad/s with a bar of 1 m, 0 kg, 0 kg m² and rotors of 1 m, 1 kg, I1 = 1, I3"
    )
    for change in (("about/scene/spins", [11, -11]), ("about/scene/rotor/mass", 2), ("about", None)):
        with pytest.raises(NotProved):
            check(spoiled(orbit, *change))


def test_what_a_root_says_beside_the_program_is_not_taken_of_the_program() -> None:
    """√(x²) is x only where the program itself has √x: a name that has it does not make −√(x²) the rate −x."""
    found = enclose(Program((x, v), (), (v, -sp.sqrt(x**2 + 2 - 2))), {}, [1], [0], "0.1")
    other = plain(found)
    place = other["motion"]["operations"]
    place[:] = [["argument", 0], ["argument", 1], ["multiply", 0, 0], ["sqrt", 2], ["number", "0"], ["subtract", 4, 3]]
    other["motion"]["outputs"] = [1, 5]
    assert "v′ = -sqrt(x**2)" in check(other | {"about": {"rates": ["v", "-sqrt(x**2)"]}})
    for rate in ("-x", "-x + 0*sqrt(x)", "0*log(x) - x"):
        with pytest.raises(NotProved, match="the rates are not those of the text"):
            check(other | {"about": {"rates": ["v", rate]}})


TWO = {"add": add, "subtract": sub, "multiply": mul, "divide": truediv}


@pytest.mark.parametrize("name", ["sqrt", "exp", "log", "sin", "cos", "asin", "atan", "tan", "1/", "square", "product"])
def test_slopes_of_words_are_those_of_sympy(name: str) -> None:
    """At random numbers of 30 digits, an oracle that shares nothing with residues."""
    of = {"1/": "1/({})", "square": "({})**5", "product": "({0})*sin({0})"}.get(name, f"{name}({{}})")
    text = of.format("x/3 + v**2/5")
    words = Words(["x", "v"], None)
    place = words.place(text)
    slope = words.slope(place, {0: words.keep("number", "2"), 1: 0})
    e = sp.sympify(text)
    expected = 2 * sp.diff(e, x) + x * sp.diff(e, v)
    with mp.workdps(30):
        at = [mp.mpf("0.37"), mp.mpf("0.81")]
        found: list[Any] = []
        for kind, *on in words.operations:
            if kind == "argument":
                found.append(at[on[0]])
            elif kind == "number":
                found.append(mp.mpf(sp.Rational(on[0]).p) / sp.Rational(on[0]).q)
            else:
                rule = TWO[kind] if kind in TWO else getattr(mp, kind)
                found.append(rule(*(found[i] for i in on)))
        true = mp.mpf(str(sp.N(expected.subs({x: sp.Rational(37, 100), v: sp.Rational(81, 100)}), 30)))
        assert abs(found[slope] - true) < mp.mpf("1e-25")
    assert len({r.value for r in next(points_of(words.tape([slope, place]))).outputs([])}) == 2


def test_decimals_of_a_system_are_not_rounded_on_their_way_to_its_equations() -> None:
    """0.3/0.7 is 3/7: against the closed form, inside 10⁻³⁰."""
    c = coordinates("x")
    (q,), (w,) = c.q, c.v
    with mp.workdps(50):
        rate = mp.sqrt(mp.mpf(3) / 7)
        found = enclose(System(c, 0.7 * w**2 / 2 - 0.3 * q**2 / 2), {}, [1], [0], 1, 1e-32)
        assert abs(mp.mpf(found.states[0].mid().str(45, radius=False)) - mp.cos(rate)) < mp.mpf("1e-29")
    assert "L = 7*x_dot**2/20 - 3*x**2/20" in check(found.certificate) or "L = -3*x**2/20 + 7*x_dot**2/20" in check(
        found.certificate
    )


def test_a_system_that_cannot_be_read_again_is_named_by_its_program() -> None:
    stages = ((sp.Symbol("w_0"), x * v),)
    found = enclose(Program((x, v), stages, (v, -stages[0][0])), {}, [1], [0], "0.1", 1e-12)
    assert "the motion whose program has the SHA-256 digest" in check(plain(found))
    assert np.isfinite(float(found.states[0]))


def test_a_start_may_be_given_by_names() -> None:
    by_name = field_of(SLEIGH, {}, {str(Y): 1, X: 2}, {V: 6, str(U): 3})
    assert by_name.start == field_of(SLEIGH, {}, (2, 1), (3, 6)).start
    with pytest.raises(InputError, match="q0 lacks"):
        field_of(SLEIGH, {}, {X: 1}, (0, 0))
