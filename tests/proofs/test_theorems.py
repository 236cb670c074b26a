"""Orbits, crossings and equilibria proved: published numbers are held, false theorems are refused, certificates are verified."""

from typing import Any

import mpmath as mp
import pytest
import sympy as sp

pytest.importorskip("flint", reason="the extra `proof` is not installed")

from flint import arb

from lagrotor import Link, Scene, floquet
from lagrotor.errors import DomainError, InputError
from lagrotor.mechanics import System, coordinates, t
from lagrotor.numerics.codegen import Program
from lagrotor.pair.notation import AXES
from lagrotor.proofs import (
    NotProved,
    check,
    crossing,
    enclose,
    equilibrium,
    lohner_frames,
    means,
    no_crossing,
    periodic_orbit,
    precession,
)
from lagrotor.proofs.balls import precision
from lagrotor.proofs.checker import certified_sets
from tests.proofs.gallery import (
    HENON_HEILES,
    PENDULUM,
    PLANE,
    RATE,
    THETA,
    C,
    U,
    V,
    X,
    Y,
    moved,
    plain,
    spoiled,
    verified,
)

MU = sp.Symbol("mu", positive=True)
THREE_BODIES = System(
    PLANE,
    ((U - Y) ** 2 + (V + X) ** 2) / 2
    + (1 - MU) / sp.sqrt((X + MU) ** 2 + Y**2)
    + MU / sp.sqrt((X - 1 + MU) ** 2 + Y**2),
)


def near(ball: Any, number: str, within: str) -> bool:
    """Whether a ball holds a number that is published to some digits, and is not wide."""
    with precision(200):
        return bool(ball.overlaps(arb(number) + arb(0, float(within))) and float(ball.rad()) < float(within))


def test_a_pendulum_has_the_period_of_the_elliptic_integral() -> None:
    orbit = periodic_orbit(PENDULUM, {}, [1], [0], 6.7, reversals=[(1, -1)])
    with mp.workdps(40):
        assert near(orbit.period, mp.nstr(4 * mp.ellipk(mp.sin(mp.mpf(1) / 2) ** 2), 35), "1e-18")
    assert orbit.kind == "parabolic" and "periodic orbit of period [6.69997566437" in verified(orbit)


def test_the_shortest_orbit_of_lorenz() -> None:
    """Viswanath 2003: the orbit AB, its period to many digits."""
    x, y, z = sp.symbols("x y z")
    lorenz = Program((x, y, z), (), (10 * (y - x), x * (28 - z) - y, x * y - sp.Rational(8, 3) * z))
    orbit = periodic_orbit(lorenz, {}, [-13.7636, -19.5788, 27], [], 1.5587, fixed=["z"])
    assert near(orbit.period, "1.55865221071617472756787", "1e-17")
    assert near(orbit.start[0], "-13.763610682134", "1e-12") and near(orbit.start[1], "-19.578751942452", "1e-12")
    assert orbit.kind == "hyperbolic" and "hyperbolic" in verified(orbit)


def test_henon_and_heiles() -> None:
    """The straight orbit along y: y'' = −y + y², whose period is an elliptic integral; stable at small energies."""
    orbit = periodic_orbit(HENON_HEILES, {}, [0, 0.3], [0, 0], 6.5, reversals=[(-1, 1, 1, -1)], fixed=["y"])
    with mp.workdps(40):
        y = mp.mpf("0.3")
        a, b, c = sorted(mp.polyroots([mp.mpf(2) / 3, -1, 0, y**2 - 2 * y**3 / 3]))
        period = 2 * mp.sqrt(6) / mp.sqrt(c - a) * mp.ellipk((b - a) / (c - a))
    assert near(orbit.period, mp.nstr(period, 35), "1e-18")
    assert orbit.kind == "elliptic" and "elliptic" in verified(orbit)
    assert crossing(HENON_HEILES, {}, [0, 0.3], [0, 0], event=Y, t_end=3).first


@pytest.mark.slow
def test_arenstorf_s_orbit() -> None:
    """Hairer, Nørsett & Wanner II.0: of a satellite between earth and moon, its start and period to 30 digits."""
    orbit = periodic_orbit(
        THREE_BODIES, {MU: "0.012277471"}, ["0.994", 0], [0, "-2.0016"], "17.0652", reversals=[(1, -1, -1, 1)]
    )
    assert near(orbit.period, "17.0652165601579625588917206249", "1e-15")
    assert near(orbit.start[3], "-2.00158510637908252240537862224", "1e-16")
    assert orbit.kind == "hyperbolic" and verified(orbit)


def test_lagrange_s_points() -> None:
    triangle = equilibrium(THREE_BODIES, {MU: 0.01}, [0.49, 0.866])
    assert triangle.stability == "stable to first order" and verified(triangle)
    assert equilibrium(THREE_BODIES, {MU: 0.05}, [0.45, 0.866]).stability == "unstable"
    line = equilibrium(THREE_BODIES, {MU: 0.01}, [0.85, 0])
    assert line.stability == "unstable" and line.q[1].contains(0) and verified(line)
    assert equilibrium(PENDULUM, {}, [0.1]).stability == "stable" and verified(equilibrium(PENDULUM, {}, [0.1]))
    with pytest.raises(NotProved):
        equilibrium(System(C, RATE**2 / 2 + THETA), {}, [0])


@pytest.mark.parametrize(
    ("dissipation", "stability"),
    [
        (RATE**2 / 10, "asymptotically stable"),
        (RATE**4 - RATE**2 / 10, "unstable"),
        (RATE**6 - RATE**4, "undecided"),
        (RATE**4 + THETA * RATE**2, "undecided"),
    ],
)
def test_with_friction_the_linear_motion_decides(dissipation: sp.Expr, stability: str) -> None:
    """Of Rayleigh's function: one that feeds slow motion, also to a higher order alone, or whose sign is not shown."""
    found = equilibrium(System(C, RATE**2 / 2 + sp.cos(THETA), dissipation=dissipation), {}, [0.1])
    assert found.stability == stability and f"it is {stability}." in verified(found)
    if stability == "undecided":
        false = found.certificate | {"claim": found.certificate["claim"] | {"stability": "stable to first order"}}
        with pytest.raises(NotProved, match="the system is not conservative"):
            check(false)


@pytest.mark.parametrize(("r0", "link"), [(0.204, Link()), pytest.param(0.6, Link(1, 1, 1), marks=pytest.mark.slow)])
def test_the_paired_precession_exists(r0: float, link: Link) -> None:
    scene = Scene((10, -10), link=link)
    orbit, numeric = precession(scene, r0), floquet(scene, r0)
    assert abs(float(orbit.frequency.mid()) - numeric.frequency) < 1e-11
    assert float(orbit.frequency.rad()) < 1e-15
    assert orbit.kind == numeric.kind == "hyperbolic" and orbit.pair_sum is not None
    assert abs(float(orbit.pair_sum.mid()) - numeric.pair_sum) < 1e-4
    assert "paired precession, hyperbolic" in verified(orbit)


@pytest.mark.parametrize(
    ("spins", "r0", "says"),
    [
        ((10, 5), 0.2, "opposite"),
        ((10, -10), ("0.1", "0.2"), "must be one number"),
        ((10, -10), ["0.1", "0.1"], "must be one number"),
        *(((10, -10), r0, "must lie above 0 and below 1") for r0 in ("-0.1", 0, 1)),
    ],
)
def test_a_precession_is_of_opposite_spins_and_one_amplitude(spins: tuple[int, int], r0: Any, says: str) -> None:
    with pytest.raises((InputError, DomainError), match=says):
        precession(Scene(spins), r0)


def test_another_amplitude_is_refused() -> None:
    orbit = precession(Scene((10, -10)), 0.2004)
    with pytest.raises(NotProved, match="the claimed amplitude"):
        check(orbit.certificate | {"claim": orbit.certificate["claim"] | {"r0": ["1/5", "1/5"]}})


def test_a_crossing_is_proved_with_its_time() -> None:
    event = crossing(PENDULUM, {}, [1], [0], event=THETA, t_end=3)
    with mp.workdps(40):
        assert near(event.time, mp.nstr(mp.ellipk(mp.sin(mp.mpf(1) / 2) ** 2), 35), "1e-3")
    assert event.first and "first passes zero" in verified(event)
    quiet = no_crossing(PENDULUM, {}, [1], [0], event=THETA + sp.Rational("1.001"), t_end=6)
    assert "does not pass zero" in verified(quiet)


def test_false_theorems_are_never_proved() -> None:
    """A crossing that just misses, a non-crossing that just fails, an orbit that is none, a wrong period and kind."""
    with pytest.raises(NotProved, match="keeps its sign, or is not proved to change it"):
        crossing(PENDULUM, {}, [1], [0], event=THETA + 1 + sp.Rational("1e-13"), t_end=6)
    with pytest.raises(NotProved, match=r"not proved to be nonzero beyond t = 3\.34"):
        no_crossing(PENDULUM, {}, [1], [0], event=THETA + 1 - sp.Rational("1e-13"), t_end=6)
    with pytest.raises(NotProved):
        periodic_orbit(System(C, RATE**2 / 2 + THETA), {}, [1], [0], 6, reversals=[(1, -1)])
    with pytest.raises(InputError, match="not proved to be a motion"):
        periodic_orbit(System(C, RATE**2 / 2 + THETA**3, dissipation=RATE**2), {}, [1], [0], 6, reversals=[(1, -1)])
    with pytest.raises(InputError, match="signs"):
        periodic_orbit(PENDULUM, {}, [1], [0], 6, reversals=[(-1, -1)])
    with pytest.raises(InputError, match="the system has fewer integrals"):
        periodic_orbit(HENON_HEILES, {}, [0, 0.3], [0, 0], 6.5, reversals=[(-1, 1, 1, -1)], fixed=["y"], integrals=2)
    with pytest.raises(InputError, match="'theta' must be an expression"):
        crossing(PENDULUM, {}, [1], [0], event="theta", t_end=1)


def test_means_over_time() -> None:
    """x″ = −x from x = 1: ∫ of x, x² and x x′ in closed form, also where spans begin and end within a step."""
    c = coordinates("x")
    (x,), (v,) = c.q, c.v
    spring = System(c, (v**2 - x**2) / 2)
    found = means(spring, {}, [1], [0], [(x, 0, 1), (x**2, "0.5", 2), (x * v, 1, 3)])
    with mp.workdps(30):
        closed = [mp.sin(1), mp.mpf(1) / 2 + (mp.sin(4) - mp.sin(1)) / 6, (mp.cos(3) ** 2 - mp.cos(1) ** 2) / 4]
        assert all(near(ball, mp.nstr(value, 20), "1e-9") for ball, value in zip(found.values, closed, strict=True))
    assert "The mean of x**2 from t = 0.5 to 2 s is in [0.2336210" in verified(found) == found.theorem
    rows = (
        ("mean", "1p0", "a claimed mean does not contain the enclosed one"),
        ("until", "5p0", "before the interval of a mean"),
        ("since", "1p0", "no length"),
    )
    for name, number, says in rows:
        with pytest.raises(NotProved, match=says):
            check(spoiled(found.certificate, f"claim/means/0/{name}", [number, "0p0"]))
    for spans in ((), [(x, 1, 1)], [(x, -1, 1)]):
        with pytest.raises(InputError, match="means: "):
            means(spring, {}, [1], [0], spans)


SWING = means(PENDULUM, {}, [1], [0], [(sp.Eq(sp.Symbol("E"), RATE**2 / 2 - sp.cos(THETA)), 0, 2), (THETA, 1, 2)])
MISS = crossing(Scene((10, -10), rates=((0.1, 0, 0),) * 2), event=AXES.q[0] - sp.Rational(1, 500), t_end="0.03")


def test_a_name_is_defined_once_and_what_is_written_is_what_is_computed() -> None:
    words = verified(SWING)
    assert (
        words.startswith("The mean of E from t = 0 to 2 s is in [-0.54030231 +/- ") and words.count("- cos(theta)") == 1
    )
    assert "x_1 - 1/500 first passes zero" in verified(MISS)


def test_a_theorem_names_its_start_and_its_parameters() -> None:
    assert verified(SWING).endswith(
        " This holds for the system with L = theta_dot**2/2 + cos(theta), from t = 0 with theta = 1, theta_dot = 0."
    )
    wide = enclose(THREE_BODIES, {MU: ("0.01", "0.011")}, ["0.5", (0.8, 0.81)], [0, sp.Rational(1, 3)], 0.1)
    words = verified(wide)
    assert ", from t = 0 with x = 0.5, y in [0.8, 0.81], x_dot = 0, y_dot = 0.333333333333333" in words
    assert words.endswith(", where mu in [0.01, 0.011].")
    for change in (("start", "middle"), ("motion", "parameters")):
        other = plain(wide)
        other[change[0]][change[1]] = [moved(x, "0.01") for x in other[change[0]][change[1]]]
        if other != wide.certificate:
            with pytest.raises(NotProved, match="check: "):
                check(other)


FALSE_WORDS: dict[str, list[tuple[str, Any]]] = {
    "cannot be read": [
        *(
            ("1/of", text)
            for text in ("theta # and it topples", "theta\n", "__import__('os').getcwd()", "omega", "v_1")
        ),
        *(("1/of", text) for text in ("ⴰ1", "0*E + theta", "theta + 1/(1/3 - 1/3)", "1**(10**9*1)*theta**100000")),
        ("1/of", "(" * 5000 + "theta" + ")" * 5000),
    ],
    "more than 20000 characters": [("1/of", "theta" + " + 0" * 10_000)],
    "is taken or invalid": [("0/of", text) for text in ("E, and it topples", "theta", "sin")],
    "E has two meanings": [("1", lambda row: row | {"of": "E", "means": "theta"})],
    "a claimed mean does not contain the enclosed one": [
        *(("1/of", text) for text in ("9**9**9**9**9", "theta + 1/10**7", "theta + 1000 + 10**80*(1/3 - 1/3)")),
        ("1/of", "theta + 1000 + 10**80*(1/theta - 1/theta)"),
        ("0/means", "theta_dot**2/2 + cos(theta)"),
        ("0/mean", lambda x: moved(x, "1e-8")),
        ("0/mean", lambda x: [x[0], "0p0"]),
        ("1/since", ["3p-1", "0p0"]),
    ],
}


@pytest.mark.parametrize(("says", "k"), [(says, k) for says, rows in FALSE_WORDS.items() for k in range(len(rows))])
def test_a_mean_of_something_else_is_refused(says: str, k: int) -> None:
    path, value = FALSE_WORDS[says][k]
    with pytest.raises(NotProved, match=says):
        check(spoiled(plain(SWING), f"claim/means/{path}", value))


@pytest.mark.parametrize("by", ["1e-4", "-1e-4", "0.01"])
def test_a_crossing_that_just_misses_its_time_is_refused(by: str) -> None:
    whole = plain(MISS)
    for other in (spoiled(whole, "claim/time", lambda x: moved(x, by)), whole | {"event": {"of": "x_1 - 1/499"}}):
        with pytest.raises(NotProved, match="does not change its sign over the claimed time"):
            check(other)


def test_a_name_of_an_expression_is_its_own() -> None:
    E = sp.Symbol("E")
    for spans in (
        [(sp.Eq(E, RATE), 0, 1), (THETA * sp.E, 0, 1)],
        [(sp.Eq(E, RATE), 0, 1), (sp.Eq(E, THETA), 0, 1)],
        [(sp.Eq(E, RATE), 0, 1), (E + THETA, 0, 1)],
        [(sp.Eq(THETA, RATE**2), 0, 1), (THETA, 0, 1)],
        [(sp.Eq(sp.Symbol("sin"), RATE), 0, 1)],
    ):
        with pytest.raises(InputError, match="a name of its own"):
            means(PENDULUM, {}, [1], [0], spans)


WRITTEN = (
    sp.tan(THETA / 2) + sp.sec(THETA / 3) - sp.csc(THETA + 2) * sp.cot(2 + THETA / 5),
    sp.sinh(THETA) * sp.cosh(RATE) - sp.tanh(THETA - RATE) ** 3,
    sp.acos(THETA / 3) - sp.asin(RATE / 4) * sp.atan(THETA) + sp.log(3 + THETA),
    (2 + THETA) ** sp.Rational(-3, 2) + (3 + RATE) ** sp.Rational(1, 3) - sp.sqrt(2) * sp.pi ** (THETA - 1) + sp.exp(2),
    -(-THETA - 2 * (RATE - sp.Rational(1, 7))) / (5 - RATE / -3) ** 2 - sp.E**RATE,
)


@pytest.mark.parametrize("expression", WRITTEN, ids=str)
def test_what_is_written_is_what_is_evaluated(expression: sp.Expr) -> None:
    """The search's operations of an expression against those of its words, at a point."""
    from lagrotor.proofs.checker.bounded_series import Dual, Series, evaluate
    from lagrotor.proofs.checker.expression_tapes import tape_of_words
    from lagrotor.proofs.fields import system_field, values_at

    made, at = system_field(PENDULUM, {}, [1], [0]), [arb("0.3"), arb("-0.7")]
    tape = tape_of_words([{"of": str(expression)}], ["theta", "theta_dot"], None)
    (found,) = evaluate(tape, [Dual(Series([x], arb(0), 1)) for x in at])
    off = found.value.terms[0] - values_at(made.function([expression]), at)[0]
    assert off.contains(0) and float(off.rad()) < 1e-12


def test_a_pulse_that_begins_within_a_step_leaves_the_set_narrow(monkeypatch: pytest.MonkeyPatch) -> None:
    """A force exp(−(t − 1)²/w²) is in no Taylor term at t = 0, but in the rest; the twin lets the rest be large."""
    c = coordinates("x")
    (x,), (v,) = c.q, c.v
    pushed = System(c, (v**2 - x**2) / 2, forces=(sp.exp(-(((t - 1) * 10) ** 2)),))
    assert float(enclose(pushed, {}, [0], [0], 2, 1e-14).states[0].rad()) < 1e-11
    monkeypatch.setattr(lohner_frames, "_LARGEST_REMAINDER", 1e300)
    assert float(enclose(pushed, {}, [0], [0], 2, 1e-14).states[0].rad()) > 1e-9


def test_a_precession_that_is_hyperbolic_is_not_parabolic() -> None:
    """At r0 = 0.02 the multipliers are so near to 1 that six ones fit them, too."""
    certificate = precession(Scene((10, -10)), "0.02", 1e-14).certificate
    assert certificate["claim"]["kind"] == "undecided"
    false = certificate | {"ones": 6, "claim": certificate["claim"] | {"kind": "parabolic"}}
    with pytest.raises(NotProved, match="four multipliers equal to 1"):
        check(false)


def test_a_check_that_skips_a_node_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """The twin of the spoiled nodes: without the test of one node each of them would be verified."""
    carried, whole = certified_sets.VerifiedSteps._step, certified_sets.demand
    orbit = plain(periodic_orbit(PENDULUM, {}, [1], [0], 6.7, reversals=[(1, -1)]))
    other = spoiled(orbit, "steps/1/node/m/0", lambda x: moved([x, "0p0"], "1e-17")[0])

    def skipping(self: Any, node: Any, data: Any, k: int) -> Any:
        monkeypatch.setattr(certified_sets, "demand", (lambda *_: None) if k in (1, 2) else whole)
        return carried(self, node, data, k)

    monkeypatch.setattr(certified_sets.VerifiedSteps, "_step", skipping)
    assert "parabolic" in check(other)


def test_mutated_arithmetic_of_the_search_is_found_by_the_check(monkeypatch: pytest.MonkeyPatch) -> None:
    found = enclose(PENDULUM, {}, [1], [0], 2)
    assert verified(found)
    from lagrotor.proofs import taylor_step
    from lagrotor.proofs.balls import ZERO

    def without_rest(*arguments: Any) -> Any:
        rests, evaluation = taylor_step.bound_remainder(*arguments)
        return [ZERO for _ in rests], evaluation

    monkeypatch.setattr(lohner_frames, "bound_remainder", without_rest)
    with pytest.raises(NotProved, match="node 1 does not contain the motion of the middle"):
        verified(enclose(PENDULUM, {}, [1], [0], 2))
