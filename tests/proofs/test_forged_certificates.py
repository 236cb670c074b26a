"""Certificates made by hand of theorems that are false, by what each got past: the second program refuses all of them."""

import copy
import json
import random
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import sympy as sp

pytest.importorskip("flint", reason="the extra `proof` is not installed")

from flint import arb

from lagrotor import Link, Scene
from lagrotor.errors import InputError
from lagrotor.mechanics import System, coordinates
from lagrotor.models.orbits.shooting import QuarterPeriod
from lagrotor.numerics.codegen import Program
from lagrotor.proofs import NotProved, check, enclose, equilibrium, means, no_crossing, periodic_orbit, precession
from lagrotor.proofs.balls import as_text, ball_data, exact, precision
from lagrotor.proofs.checker.checking import second_derivatives
from lagrotor.proofs.checker.expression_tapes import tape_of_words
from lagrotor.proofs.checker.reversals import check_reversal
from lagrotor.proofs.checker.tapes import demand_pace, read_tape
from lagrotor.proofs.fields import ball, scene_field, values_at
from lagrotor.proofs.lohner_frames import Accuracy, Start, steps_of
from lagrotor.proofs.orbits.closed_orbits import krawczyk_proof, orbit_of, refine_start
from lagrotor.proofs.orbits.paired_orbits import A, B, guess, problem_of_pair
from lagrotor.proofs.tape import tape_of, with_pace
from tests.proofs.gallery import HENON_HEILES, PENDULUM, THETA, moved, plain, spoiled

ENCLOSURE = plain(enclose(PENDULUM, {}, [1], [0], 2))
ORBIT = plain(periodic_orbit(PENDULUM, {}, [1], [0], 6.7, reversals=[(1, -1)]))
MEANS = means(PENDULUM, {}, [1], [0], [(sp.cos(THETA), 0, 1)])
x, v, z = sp.symbols("x v z")


def test_an_equilibrium_is_sought_about_the_middle_of_its_box() -> None:
    """sin(1) + cos(1 + c) c = 0 for c = −0.89…: the test closes about 1 + c, where nothing rests."""
    false = plain(equilibrium(PENDULUM, {}, [0.1]))
    off = -0.85
    for _ in range(60):
        off = -np.sin(1) / np.cos(1 + off)
    false |= {"middle": ["1p0"], "box": [ball_data(arb(off, 2**-20))], "A": [[as_text(arb(-1 / np.cos(1 + off)))]]}
    false["claim"] = {"q": [ball_data(arb(1 + off, 2**-19))], "stability": "undecided"}
    with pytest.raises(NotProved, match="does not contain its middle"):
        check(false)


def test_at_an_equilibrium_the_coordinates_rest_and_the_theorem_names_the_energy_that_is_definite() -> None:
    whole = plain(equilibrium(PENDULUM, {}, [0.1]))
    assert "it is stable. Its energy theta_dot**2/2 - cos(theta) is definite there and conserved." in check(whole)
    for words, says in {
        "cos(theta)": "the energy is not that of the Lagrangian",
        "theta_dot**2 - theta**2": "the energy is not that of the Lagrangian",
        "theta_dot**2 - 2*cos(theta)": "the energy is not that of the Lagrangian",
        "heat": "cannot be read",
    }.items():
        with pytest.raises(NotProved, match=says):
            check(whole | {"energy": words})
    operations = whole["motion"]["operations"]
    operations.append(["number", "1"])
    whole["motion"]["outputs"][0] = len(operations) - 1
    with pytest.raises(NotProved, match="the rates are not those of velocities"):
        check(whole)
    with pytest.raises(NotProved, match="the coordinates' rates are not the velocities"):
        check(whole | {"about": None})


X = coordinates("x y")
BENT = System(
    X, sum(s**2 for s in X.v) / (2 + sp.sin(X.q[0] * X.q[1])) - sp.exp(X.q[0] ** 2 - X.q[0] * X.q[1] + X.q[1] ** 2)
)


def test_second_derivatives_are_those_of_sympy() -> None:
    at = [0.3, -0.2, 0.5, 0.7]
    tape = tape_of_words([{"of": str(BENT.energy)}], [str(s) for s in (*X.q, *X.v)], None)
    found = second_derivatives(tape, [arb(y) for y in at], 4)
    exactly = sp.hessian(BENT.energy, (*X.q, *X.v)).subs(dict(zip((*X.q, *X.v), at, strict=True)))
    for i, row in enumerate(found):
        assert all(abs(float(y.mid()) - float(exactly[i, j])) < 1e-12 for j, y in enumerate(row))


def motion(*rates: Any, states: Any = (x, v)) -> dict[str, Any]:
    """x' = rates(x) multiples of the pace."""
    return json.loads(
        json.dumps(with_pace(tape_of(Program(states, (), tuple(map(sp.sympify, rates)))), len(states)).data())
    )


SMALL = x**2048


@pytest.mark.parametrize(
    ("tape", "signs", "says"),
    [
        (motion(v, 1), [-1, float("nan")], "a sign 1 or −1"),
        (motion(v, -x, z, states=(x, v, z)), [1, -1, 5e-324], "a sign 1 or −1"),
        (motion(v, -x), [1, -1.0], "a sign 1 or −1"),
        (motion(v, -x), [True, -1], "a sign 1 or −1"),
        (motion(v, -x), [1], "a sign 1 or −1"),
        (motion(v, -x), [1, -1, 1], "a sign 1 or −1"),
        (
            motion(v, -x, z, states=(x, v, z)),
            [1, -1, 1],
            "the reversed motion does not satisfy the equations of motion",
        ),
        (motion(v, -x + SMALL / 2), [-1, 1], "the reversed motion does not satisfy the equations of motion"),
        (
            motion(v, -x + sp.Rational(1, 10**300)),
            [-1, 1],
            "the reversed motion does not satisfy the equations of motion",
        ),
        (
            motion(v, -x + v * sp.exp(-1000 * (1 + x**2))),
            [1, -1],
            "the reversed motion does not satisfy the equations of motion",
        ),
        (motion(v, -sp.sqrt(x**2)), [1, 1], "the reversed motion does not satisfy the equations of motion"),
    ],
)
def test_what_reverses_a_motion_is_decided_on_its_tape(tape: Any, signs: Any, says: str) -> None:
    """At points near zero the small terms are below any tolerance."""
    with pytest.raises(NotProved, match=says):
        check_reversal(tape, signs)


def test_a_degree_that_could_hide_a_difference_is_refused() -> None:
    tape = motion(v, -x)
    place = tape["operations"].index(["argument", 0])
    for _ in range(300):
        tape["operations"].append(["multiply", place, place])
        place = len(tape["operations"]) - 1
    with pytest.raises(NotProved, match="degree of the motion is too large"):
        check_reversal(tape, [1, -1])


def beside(tape: Any, name: str, inner: int) -> Any:
    """The tape with an operation, on x + 2 or x, that no rate needs."""
    operations = [*tape["operations"], ["number", "2"]]
    operations += [["add", inner, len(operations) - 1], [name, len(operations)]]
    return tape | {"operations": operations}


@pytest.mark.parametrize("name", ["sqrt", "log", "asin"])
def test_nothing_is_taken_at_the_reversed_motion_that_was_not_followed(name: str) -> None:
    """√((x + 2)²) is x + 2 where √(x + 2) was taken: that is so on the half that is followed, not on its image."""
    tape = beside(motion(v, -x), name, 0)
    check_reversal(tape, [1, -1])  # twin: x itself stays
    with pytest.raises(NotProved, match="may leave the domain of its roots"):
        check_reversal(tape, [-1, 1])


def test_a_theorem_names_each_state_that_is_no_time_and_no_name_is_an_expression() -> None:
    called_time = copy.deepcopy(ENCLOSURE) | {"about": None}
    called_time["motion"]["arguments"][0] = "t"
    with pytest.raises(NotProved, match="the argument t is not the time, which starts at 0"):
        check(called_time)
    with pytest.raises(NotProved, match="there are observables, but the subject defines none"):
        check(ENCLOSURE | {"observed": 0})
    certificate = plain(MEANS)
    check(certificate)
    for name in ("theta + 1000", "1000", "pi", "sin"):
        forged = copy.deepcopy(certificate)
        forged["motion"]["arguments"][0] = name
        with pytest.raises(NotProved, match=r"is an expression|cannot be read"):
            check(forged)


@pytest.mark.parametrize("link", [Link(), Link(1, 1, 1), Link(0.5, 1, 1), Link(2)])
def test_the_pair_s_reversals_are_decided_on_its_tape_and_no_other_signs_are(link: Link) -> None:
    """All 64 rows of signs, against the rates at a random state in balls."""
    made = scene_field(Scene((10, -10), link=link))
    tape = json.loads(json.dumps(with_pace(made.motion.tape, 6).data()))
    at = [arb(y) / 64 for y in (3, 11, -7, 5, 13, -9)]
    rates = values_at(made.motion.tape, at)
    alike = []
    for row in ([1 - 2 * (k >> i & 1) for i in range(6)] for k in range(64)):
        image = values_at(made.motion.tape, [s * y for s, y in zip(row, at, strict=True)])
        if all((s * f + g).contains(0) for s, f, g in zip(row, rates, image, strict=True)):
            alike.append(tuple(row))
            check_reversal(tape, row)
        elif row in ([1] * 6, [-y for y in A], [y * -1 for y in B], [1, -1, -1, -1, 1, -1]):
            with pytest.raises(NotProved, match="the reversed motion does not satisfy the equations of motion"):
                check_reversal(tape, row)
    assert {*alike} == {A, B}


def test_an_amplitude_that_is_sought_is_not_the_one_that_is_claimed() -> None:
    scene, accuracy = Scene((10, -10)), Accuracy(1e-12)
    with precision(accuracy.bits, accuracy.terms):
        curve = QuarterPeriod(scene)
        made = scene_field(curve.scene)
        problem = replace(problem_of_pair(made), free=(0, 5, 6))
        middle, slope, _ = refine_start(
            problem, [exact(y) for y in guess(curve, 0.4, ball("0.4").atanh())], accuracy, "x"
        )
        start = Start(middle, [arb(0, 1e-9) if i in (0, 5, 6) else arb(0) for i in range(7)])
        proof = krawczyk_proof(
            problem, start, slope, tuple(steps_of(problem.motion, start, arb(1), accuracy)), 4, accuracy.bits
        )
        assert proof is not None
        certificate = orbit_of(proof, made).certificate
    false = certificate | {"claim": certificate["claim"] | {"r0": ["4000000006/10000000000"] * 2}}
    with pytest.raises(NotProved, match="the amplitude is not fixed"):
        check(false)


def by_pace_again(tape: Any) -> None:
    pace = tape["operations"].index(["argument", 2])
    for i, place in enumerate(tape["outputs"]):
        tape["operations"].append(["multiply", place, pace])
        tape["outputs"][i] = len(tape["operations"]) - 1


def with_pace_inside(tape: Any) -> None:
    tape["operations"] += [["argument", 2], ["multiply", 0, len(tape["operations"])]]


def changed(place: int, *operation: Any) -> Any:
    """A tape with another operation."""
    return lambda tape: tape["operations"].__setitem__(place, list(operation))


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (changed(0, "argument", -1), "operation 0 of a tape is malformed"),
        (changed(0, "argument", 3), "operation 0 of a tape is malformed"),
        (changed(0, "argument", True), "operation 0 of a tape is malformed"),
        (changed(0, "number", "1/2/3"), "operation 0 of a tape is malformed"),
        (changed(2, "sin", 2), "operation 2 of a tape is malformed"),
        (changed(2, "sin", -1), "operation 2 of a tape is malformed"),
        (changed(2, "sin", 0, 1), "operation 2 of a tape is malformed"),
        (changed(2, "tan", 0), "operation 2 of a tape is malformed"),
        (lambda tape: tape["outputs"].__setitem__(0, -1), "not the result of an operation"),
        (lambda tape: tape["arguments"].__setitem__(1, "theta"), "two arguments have one name"),
        (by_pace_again, "multiples of the pace"),
        (with_pace_inside, "multiples of the pace"),
    ],
)
def test_a_tape_is_read_as_it_is_meant(change: Any, says: str) -> None:
    tape = copy.deepcopy(ORBIT["motion"])
    demand_pace(read_tape(tape))
    change(tape)
    with pytest.raises(NotProved, match=says):
        demand_pace(read_tape(tape))


ODD = (None, True, -1, 10**9, 1.5, float("nan"), "", "1p", "1p99999999", [], {}, [["1p0", "0p0"]], sp.S.One)


def places(data: Any, path: tuple[Any, ...] = ()) -> Any:
    """Of every entry of plain data."""
    yield path
    if isinstance(data, dict | list):
        for key in data if isinstance(data, dict) else range(len(data)):
            yield from places(data[key], (*path, key))


@pytest.mark.parametrize(
    "certificate", [ENCLOSURE, ORBIT, equilibrium(PENDULUM, {}, [0.1]).certificate], ids=lambda c: c["kind"]
)
def test_a_certificate_in_which_an_entry_is_another_is_refused_in_words(certificate: Any) -> None:
    chosen, every = random.Random(0), [path for path in places(certificate) if path]
    few = [path for path in every if "steps" not in path or path[:2] == ("steps", 0)]
    for path in chosen.sample(few, min(60, len(few))):
        with suppress(NotProved, InputError):
            assert check(spoiled(certificate, "/".join(map(str, path)), chosen.choice(ODD)))
    for what in (None, 1, "text", [], [certificate], {"version": 1}):
        with pytest.raises(InputError, match="check: a certificate is the dictionary"):
            check(what)


SADDLE = equilibrium(PENDULUM, {}, [3.1])
PLANAR = periodic_orbit(HENON_HEILES, {}, [0, 0.3], [0, 0], 6.5, reversals=[(-1, 1, 1, -1)], fixed=["y"])
PAIRED = precession(Scene((10, -10)), "0.2", 1e-12)
QUIET = no_crossing(PENDULUM, {}, [1], [0], event=THETA + sp.Rational("1.001"), t_end=2)
MADE: dict[str, Any] = {
    **{"quiet": plain(QUIET), "mean": plain(MEANS), "rest": plain(SADDLE), "planar": plain(PLANAR)},
    **{"paired": plain(PAIRED), "enclosure": ENCLOSURE, "orbit": ORBIT},
}
ENTRIES: list[tuple[str, str, Any, str]] = [
    ("quiet", "claim/time", ["-7p0", "0p0"], "no time is claimed"),
    ("quiet", "claim/time", ["1p4", "0p0"], "the steps end before"),
    ("quiet", "event/of", "theta", "may pass zero"),
    ("quiet", "event/of", "theta/(theta - theta)", "a denominator"),
    ("quiet", "event/of", "sqrt(theta - 10)**2 + 11", "a root's argument"),
    ("quiet", "kind", "crossing", "does not change its sign"),
    ("mean", "claim/means", [], "no mean is claimed"),
    ("mean", "claim/means/0/until", ["1p0", "2p0"], "the interval of a mean has no length"),
    ("rest", "claim/stability", "stable", "the energy is not proved to be definite"),
    ("rest", "claim/stability", "asymptotically stable", "not proved to have a negative real part"),
    ("rest", "claim/stability", "stable to first order", "not proved to be imaginary"),
    ("rest", "version", True, "version True"),
    ("rest", "box/0/1", "0p0", "does not contain its middle"),
    ("orbit", "reversals", [[1, 1], [1, 1]], "not those of the second reversal"),
    ("orbit", "reversals", [[], []], "do not close the orbit"),
    ("orbit", "A", [["0p0"]], "does not close"),
    ("orbit", "free", [True], "do not fit"),
    ("orbit", "claim/kind", "elliptic", "pair of multipliers"),
    (
        "orbit",
        "claim/period",
        [ORBIT["claim"]["period"][0], "0p0"],
        "the claimed period does not contain the period of the orbit",
    ),
    ("enclosure", "steps/0/h/0", "-1p0", "has no length"),
    ("enclosure", "steps/0/terms", 24.0, "no terms"),
    ("enclosure", "bits", 10**12, "no valid number of bits"),
    ("paired", "kind", "family", "with a known version and kind"),
    ("enclosure", "steps/1/node/S", [[["0p0", "0p0"]] * 2] * 2, "does not contain the derivative"),
    ("enclosure", "steps/1/node/s", [["0p0", "0p0"]] * 2, "does not contain the motion"),
    ("enclosure", "claim/states/0/1", "-1p0", "a radius is negative"),
    ("enclosure", "claim/states/0/0", "nan", "not an exact number"),
    ("enclosure", "start/spread/0", ["0p0", "1p-3"], "does not contain the derivative"),
    ("enclosure", "start/spread/1", ["1p-1", "1p-20"], "the start's box does not contain its middle"),
    ("orbit", "start/spread/2", ["1p-1", "1p-20"], "the start's box does not contain its middle"),
    ("enclosure", "steps/1/node/s", [["1p0", "1p0"], ["1p1", "1p0"]], "node 2 does not contain its middle"),
    ("paired", "free", [0, 5, 6], "a fixed state is an interval"),
    ("paired", "claim/r0", ["1/5", "2/5"], "the claimed amplitude"),
    ("planar", "steps", lambda steps: [*steps[:2], *steps[3:]], "check: "),
    ("planar", "steps", lambda steps: steps[:-1], "do not take one unit of s"),
    (
        "planar",
        "claim/period",
        lambda x: moved(x, "1e-13"),
        "the claimed period does not contain the period of the orbit",
    ),
    (
        "planar",
        "claim/start/1",
        lambda x: moved(x, "1e-15"),
        "the claimed start does not contain the start of the orbit",
    ),
    ("planar", "ones", 4, "check: "),
    ("planar", "steps/1/node/m/0", lambda x: moved([x, "0p0"], "1e-17")[0], "does not contain the motion"),
    ("planar", "steps/1/node/s", lambda s: [[m, "0p0"] for m, _ in s], "does not contain"),
    (
        "planar",
        "steps/1/node/S",
        lambda S: [[[m, "0p0"] for m, _ in row] for row in S],
        "does not contain the derivative",
    ),
    ("planar", "start/middle/3", lambda x: moved(x, "1e-3"), "check: "),
    ("planar", "reversals/0", [1, 1, -1, -1], "check: "),
    ("planar", "motion/operations/0", ["__import__", 0], "operation 0 of a tape is malformed"),
    (
        "planar",
        "claim/pair_sum",
        lambda x: moved(x, "1e-3"),
        "the claimed sum of two multipliers does not contain the verified one",
    ),
    ("planar", "A", [["zz"]], "is not an exact number"),
    *(("planar", "claim/kind", kind, "check: ") for kind in ("hyperbolic", "parabolic", "attracting", "another")),
]


@pytest.mark.parametrize(("name", "path", "entry", "says"), ENTRIES)
def test_an_entry_that_makes_the_theorem_false_or_empty_is_refused(name: str, path: str, entry: Any, says: str) -> None:
    other = spoiled(MADE[name], path, entry)
    assert repr(other) != repr(MADE[name])
    with pytest.raises((NotProved, InputError), match=says):
        check(other)


@pytest.mark.parametrize("name", MADE)
def test_a_certificate_that_is_not_spoiled_is_verified(name: str) -> None:
    """The words are those of the claim, whatever else the certificate says."""
    assert check(MADE[name] | {"theorem": "It falls."}) == check(MADE[name])
