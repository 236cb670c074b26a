"""Families of orbits: the truth is inside for every parameter, functions keep their bounds, what is spoiled is found."""

import copy
import random
from dataclasses import replace
from typing import Any

import mpmath as mp
import pytest
import sympy as sp

pytest.importorskip("flint", reason="the extra `proof` is not installed")

from flint import arb, arb_mat, arb_poly, ctx

from lagrotor import Link, Scene
from lagrotor.errors import DomainError
from lagrotor.mechanics import System
from lagrotor.proofs import NotProved, check, precession
from lagrotor.proofs.balls import exact, precision, upper
from lagrotor.proofs.checker import family_checking, orbit_checking
from lagrotor.proofs.fields import field_of
from lagrotor.proofs.orbits import families
from lagrotor.proofs.orbits.closed_orbits import OrbitProblem
from lagrotor.proofs.orbits.families import FamilyProof, prove_family
from lagrotor.proofs.orbits.taylor_models import MotionNearRest, NearRest, Order, TaylorModel
from lagrotor.proofs.stepping import Motion
from lagrotor.proofs.tape import paced
from tests.proofs.gallery import PENDULUM, RATE, THETA, C, plain

ORDER = Order(9, 7)
FUNCTIONS = {
    "product": (lambda a, b: a * b, lambda a, b: a * b, lambda x, y: x * y),
    "inverse": (lambda a, b: a.inverse(), lambda a, b: a.inverse(), lambda x, y: 1 / x),
    "root": (lambda a, b: a.sqrt(), lambda a, b: a.sqrt(), lambda x, y: x.sqrt()),
    "exp": (lambda a, b: b.exp(), lambda a, b: b.exp(), lambda x, y: y.exp()),
    "sine": (lambda a, b: b.sin_cos()[0], lambda a, b: b.sin_cos()[0], lambda x, y: y.sin()),
    "cosine": (lambda a, b: b.sin_cos()[1], lambda a, b: b.sin_cos()[1], lambda x, y: y.cos()),
    "log": (lambda a, b: a.by_slope("log", a.inverse()), lambda a, b: a.log()[0], lambda x, y: x.log()),
}


def table(rng: random.Random, centre: float) -> list[list[float]]:
    """Coefficients of s^k ε^j, which fall off."""
    return [
        [centre if k == j == 0 else rng.uniform(-1, 1) * 0.25 ** (k + j) for j in range(ORDER.p + 1)]
        for k in range(ORDER.n)
    ]


def value(rows: list[list[Any]], s: Any, eps: Any) -> Any:
    """At a point."""
    return sum((arb(c) * s**k * eps**j for k, row in enumerate(rows) for j, c in enumerate(row)), arb(0))


def model(rows: list[list[float]], rest: float) -> TaylorModel:
    """The search's."""
    flat = [arb(c) for row in rows for c in [*row, *[0.0] * ORDER.p]]
    return TaylorModel(arb_poly(flat), arb(rest), ORDER)


def sheet(rows: list[list[float]], rest: float) -> family_checking.Sheet:
    """The second program's."""
    return family_checking.Sheet([arb_poly([arb(c) for c in row]) for row in rows], arb(rest), ORDER.n, ORDER.p)


POINTS = [(arb(1), arb(1)), (arb(1), arb("-0.99")), (arb("0.6"), arb("0.9")), (arb("0.9"), arb("-0.8"))]


def check_bounds(mine: TaylorModel, other: family_checking.Sheet, truth: Any, idle: float) -> None:
    """Both bounds hold the distance from the truth at points (s, ε); the search's is needed, and at most `idle` times that."""
    needed, width = arb(0), ORDER.width
    for s, eps in POINTS:
        coeffs, true = mine.poly.coeffs(), truth(s, eps)
        first = abs(true - value([coeffs[k : k + width] for k in range(0, len(coeffs), width)], s, eps))
        assert first <= mine.rest
        assert abs(true - value([poly.coeffs() for poly in other.terms], s, eps)) <= other.rest
        needed = needed.max(upper(first))
    assert needed > 0 and mine.rest < idle * needed


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("rest", [0.0, 1e-6])
def test_both_programs_keep_the_bounds_of_their_functions(name: str, rest: float) -> None:
    """At random points, also where the arguments differ from their polynomials by all that their rests allow."""
    search, second, of = FUNCTIONS[name]
    rng = random.Random(name)
    with precision(80, ORDER.p + 1):
        for _ in range(3):
            a, b = table(rng, 2.0), table(rng, 0.3)

            def truth(s: Any, eps: Any, a: Any = a, b: Any = b) -> Any:
                off = rng.choice([-1, 1]) * rest
                return of(value(a, s, eps) + off, value(b, s, eps) + off)

            first, other = search(model(a, rest), model(b, rest)), second(sheet(a, rest), sheet(b, rest))
            check_bounds(first, other, truth, 100)


def test_both_programs_enclose_the_inverse_of_a_matrix_of_models() -> None:
    rng, size, rest = random.Random(5), range(3), arb(1e-9)
    with precision(80, ORDER.p + 1):
        rows = [
            [arb_poly([rng.uniform(-1, 1) * 0.2**j + 3 * (i == k and not j) for j in range(ORDER.p + 1)]) for k in size]
            for i in size
        ]
        mine = families.inverse_models([[TaylorModel(f, rest, Order(1, ORDER.p)) for f in row] for row in rows])
        sheets = [[family_checking.Sheet([f], rest, 1, ORDER.p) for f in row] for row in rows]
        other = family_checking.inverse_of_sheets(sheets)
        assert mine is not None
        for eps in (arb(-1), arb("0.3"), arb(1)):
            true = arb_mat([[f(eps) + rng.choice([-1, 1]) * rest for f in row] for row in rows]).inv()
            for i, j in ((i, j) for i in size for j in size):
                a, b = mine[i][j], other[i][j]
                assert abs(a.poly(eps) - true[i, j]) <= a.rest < 1e-4
                assert abs(b.terms[0](eps) - true[i, j]) <= b.rest < 1e-4


def pendulum_family(low: str, high: str) -> tuple[FamilyProof, dict[str, Any]]:
    """The pendulum's orbits of all amplitudes between two, by a quarter of a period, and what the second program reads."""
    made = field_of(PENDULUM, {}, [1], [0])
    problem = OrbitProblem(Motion(paced(made.motion.tape, 2)), (2,), (0,), (1, -1), (-1, 1))
    middle, half = exact((arb(low) + arb(high)) / 2), exact((arb(high) - arb(low)) / 2)
    with mp.workdps(40):
        slopes = mp.taylor(quarter_period, mp.mpf(str(float(middle))), 8)
        pace = arb_poly([arb(mp.nstr(c, 25)) * half**k for k, c in enumerate(slopes)])
    pace = arb_poly([exact(c) for c in pace.coeffs()])
    U, first = arb_poly([middle, half]), arb_poly([middle, half])
    if low == "0":
        problem = replace(problem, motion=MotionNearRest(problem.motion.tape, (), U))
        first = arb_poly([1])
    proof = prove_family(problem, [first, arb_poly([]), pace], 14, 1e-11)
    return proof, {"middle": middle, "half": half, "U": U}


def quarter_period(amplitude: Any) -> Any:
    """K(sin²(θ/2))."""
    return mp.ellipk(mp.sin(amplitude / 2) ** 2)


def test_the_pendulum_s_family_holds_every_period() -> None:
    with precision(70, 14), mp.workdps(30):
        proof, data = pendulum_family("1", "1.2")
        for eps in ("-1", "-0.3", "0.55", "1"):
            amplitude = mp.mpf(str(float(data["middle"]))) + mp.mpf(eps) * mp.mpf(str(float(data["half"])))
            pace = proof.pace(arb(eps))
            assert pace.overlaps(arb(mp.nstr(quarter_period(amplitude), 20)))
            assert float(pace.rad()) < 1e-7
        whole = proof.pace(arb(0, 1))
        assert whole.overlaps(arb("1.7")) and whole.overlaps(arb(mp.nstr(quarter_period(mp.mpf("1.0001")), 12)))
        assert not whole.overlaps(arb("1.9"))


def follow(proof: FamilyProof, change: str = "", U: Any = None) -> family_checking.FamilyFlow:
    """The second program along the family's steps; near the rest where U is given."""
    tape = {"operations": proof.problem.motion.tape.operations, "outputs": proof.problem.motion.tape.outputs}
    tape |= {"arguments": proof.problem.motion.tape.arguments}
    made = (tape, list(proof.x), list(proof.W), proof.n, 8)
    flow = family_checking.FamilyFlow(*made) if U is None else family_checking.FlowNearRest(*made, U)
    for k, step in enumerate(proof.steps):
        narrow = 1e-4 if change == "a narrow tube" and k == 1 else 1
        flow.step(step.h, [exact(r * narrow) for r in step.tube])
    return flow


def test_the_second_program_follows_the_family_and_refuses_a_narrow_tube() -> None:
    with precision(70, 14):
        proof, _ = pendulum_family("1", "1.1")
        before = ctx.cap
        flow = follow(proof)
        assert ctx.cap == before
        assert flow.end(0, arb(0)).contains(0) and abs(flow.end(0, arb(0, 1))) < 1e-6
        # Both carry exact coefficients: as balls they would grow from step to step, as intervals do.
        carried = [x.poly for x in proof.node.x] + [v.poly for row in proof.node.V for v in row] + list(flow.x)
        carried += [poly for row in flow.V for v in row for poly in v.terms]
        assert all(c.is_exact() for poly in carried for c in poly.coeffs())
        with pytest.raises(NotProved, match="the tube about a family is too narrow"):
            follow(proof, "a narrow tube")


def test_a_family_from_the_rest_on_holds_every_period_and_that_of_the_linear_motion() -> None:
    with precision(70, 14), mp.workdps(30):
        proof, data = pendulum_family("0", "0.3")
        assert proof.pace(arb(-1)).contains(arb.pi() / 2) and float(proof.pace(arb(-1)).rad()) < 1e-8
        for eps in ("-0.999", "-0.5", "1"):
            amplitude = mp.mpf(str(float(data["middle"]))) + mp.mpf(eps) * mp.mpf(str(float(data["half"])))
            assert proof.pace(arb(eps)).overlaps(arb(mp.nstr(quarter_period(amplitude), 20)))
        flow = follow(proof, U=data["U"])
        assert flow.end(0, arb(0)).contains(0) and abs(flow.end(0, arb(0, 1))) < 1e-6
        with pytest.raises(NotProved, match="the tube about a family is too narrow"):
            follow(proof, "a narrow tube", data["U"])


def test_a_rest_that_is_none_is_refused_by_both_programs() -> None:
    """The pendulum with a weight to one side: its rates at 0 are not zero; and one that is zero to rounding only."""
    for weight in (sp.Rational(1, 10), sp.Rational(1, 10**40)):
        made = field_of(System(C, RATE**2 / 2 + sp.cos(THETA) + weight * THETA), {}, [1], [0])
        U, tape = arb_poly([arb(0.125), arb(0.125)]), paced(made.motion.tape, 2)
        x = [arb_poly([1]), arb_poly([]), arb_poly([arb.pi() / 2])]
        with precision(70, 14):
            problem = OrbitProblem(MotionNearRest(tape, (), U), (2,), (0,), (1, -1), (-1, 1))
            with pytest.raises(NotProved, match="do not vanish at rest"):
                prove_family(problem, x, 14, 1e-11)
            data = {"operations": tape.operations, "outputs": tape.outputs, "arguments": tape.arguments}
            flow = family_checking.FlowNearRest(data, x, [arb(0)] * 3, 14, 8, U)
            with pytest.raises(NotProved, match="do not vanish at rest"):
                flow.step(arb(0.25), [arb(1), arb(1)])


NEAR_REST = {"sqrt": (2.0, lambda v: v.sqrt()), "log": (1.5, lambda v: v.log()), "exp": (0.4, lambda v: v.exp())}
NEAR_REST |= {"sin": (0.7, lambda v: v.sin()), "cos": (0.7, lambda v: v.cos()), "divide": (2.0, lambda v: 1 / v)}


@pytest.mark.parametrize("name", NEAR_REST)
@pytest.mark.parametrize("rest", [0.0, 1e-6])
def test_both_programs_keep_the_bounds_of_functions_near_a_rest(name: str, rest: float) -> None:
    """(f(v₀ + u w) − f(v₀))/u at random points, u = 0.1 (1 + ε), also where w differs from its polynomial by its rest."""
    at, truth = NEAR_REST[name]
    rng = random.Random(name)
    with precision(80, ORDER.p + 1):
        for _ in range(2):
            w, none = table(rng, 0.3), [[0.0]]
            u, sheet_u = model([[0.1, 0.1]], 0.0), sheet([[0.1, 0.1]], 0.0)
            v = NearRest(model([[at]], 0.0), model(w, rest), u)
            if name in ("sin", "cos"):
                mine = v.sin_cos()[name == "cos"].off
            elif name == "divide":
                mine = v.inverse().off
            else:
                mine = (v.by_slope(name, v.inverse()) if name == "log" else getattr(v, name)()).off
            split = (sheet([[at]], 0.0), sheet(w, rest))
            one = (sheet([[1.0]], 0.0), sheet(none, 0.0))
            if name == "divide":
                other = family_checking._joined(name, one, split, sheet_u)[1]
            else:
                other = family_checking._moved(name, split, sheet_u)[1]

            def true(s: Any, eps: Any, w: Any = w) -> Any:
                wide = (1 + eps) * arb(0.1)
                moved = value(w, s, eps) + rng.choice([-1, 1]) * rest
                return (truth(arb(at) + wide * moved) - truth(arb(at))) / wide

            check_bounds(mine, other, true, 1000)


def test_a_family_that_is_none_is_not_proved(monkeypatch: pytest.MonkeyPatch) -> None:
    """The pace of another amplitude; and the twin: without the rests of its functions the search proves what is not shown."""
    with precision(70, 14):
        proof, _ = pendulum_family("1", "1.1")
        wrong = [*proof.x[:2], proof.x[2] + arb("1e-3")]
        with pytest.raises(NotProved, match="does not close"):
            prove_family(proof.problem, wrong, 14, 1e-11)
        monkeypatch.setattr(families, "_krawczyk", lambda problem, node, W, eps: [arb(0)])
        assert prove_family(proof.problem, wrong, 14, 1e-11).cuts


@pytest.fixture(scope="module")
def family() -> Any:
    return precession(Scene((10, -10)), ("0.45", "0.46"), 1e-12)


@pytest.mark.slow
def test_a_family_of_the_pair_holds_its_orbits(family: Any) -> None:
    inner = precession(Scene((10, -10)), "0.454")
    assert family.frequency_at("0.454").overlaps(inner.frequency) and family.frequency.contains(inner.frequency)
    assert float(family.frequency_at("0.454").rad()) < 1e-6
    assert inner.kind == family.kind == "hyperbolic"
    with pytest.raises(DomainError, match="is not shown to lie in"):
        family.frequency_at("0.25")
    for r0 in ("0.4499999", "0.4600001", ("0.455", "0.4600001")):  # beside the interval, though not beside its pieces
        with pytest.raises(DomainError, match="is not shown to lie in"):
            family.frequency_at(r0)
    words = check(plain(family))
    assert "for every r0 in [0.45, 0.46], a paired precession" in words and "they are one smooth curve" in words


SPOILS = {
    "the period is another": lambda c: c["claim"]["period"].__setitem__(1, "0p0"),
    "the orbits are not shown to be elliptic": lambda c: c["claim"].__setitem__("kind", "elliptic"),
    "Krawczyk's test does not close over a family": lambda c: c["pieces"][0].__setitem__(
        "W", [w if w.startswith("0") else "1p-90" for w in c["pieces"][0]["W"]]
    ),
    "the amplitudes are others": lambda c: c["claim"].__setitem__("r0", ["1/5", "1/4"]),
    "not one unit of s": lambda c: c["pieces"][0]["steps"].pop(),
    "leave a part out": lambda c: c["pieces"][0]["cuts"].pop(),
    "fixed set of the reversal": lambda c: c["pieces"][0]["x"].__setitem__(1, ["1p-20"]),
    "the tube about a family is too narrow": lambda c: c["pieces"][0]["x"][6].__setitem__(0, "1p-2"),
    "the piece near the rest does not begin there": lambda c: c["pieces"][0].update(
        {"near rest": True, "x": [["1p0"], *c["pieces"][0]["x"][1:]]}
    ),
    "no precession of the pair": lambda c: c["reversals"].pop(),
    "the program is not that of what the theorem names": lambda c: next(
        o for o in c["motion"]["operations"] if o[0] == "subtract"
    ).__setitem__(0, "add"),
}


@pytest.mark.slow
@pytest.mark.parametrize("what", SPOILS)
def test_a_spoiled_family_is_refused(family: Any, what: str) -> None:
    certificate = copy.deepcopy(plain(family))
    SPOILS[what](certificate)
    with pytest.raises(NotProved, match=what):
        check(certificate)


@pytest.mark.slow
def test_that_half_a_turn_has_four_ones_is_held_against_its_square(
    family: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = orbit_checking.trace_of_sheets
    monkeypatch.setattr(orbit_checking, "trace_of_sheets", lambda a: whole(a) + a[0][0].number(arb(1)))
    with pytest.raises(NotProved, match="other multipliers than four ones and a pair"):
        check(family.certificate)


@pytest.mark.slow
@pytest.mark.parametrize(("r0", "tol"), [(("0.3", "0.31"), 1e-13), (("0.2", "0.205"), 1e-14)])
def test_narrow_pieces_show_that_their_orbits_are_hyperbolic(r0: tuple[str, str], tol: float) -> None:
    found = precession(Scene((10, -10)), r0, tol)
    assert found.kind == "hyperbolic" and "hyperbolic" in check(plain(found))


def test_a_pair_of_amplitudes_that_is_none_is_refused() -> None:
    for r0 in (("-0.1", "0.1"), ("0.1", "0.1"), (0, 1), (0, 0)):
        with pytest.raises(DomainError, match="must lie between 0 and 1, the lowest of a pair first"):
            precession(Scene((10, -10)), r0)


@pytest.mark.slow
def test_the_precession_exists_for_all_amplitudes_up_to_three_fifths() -> None:
    """The numbers of docs/proofs.md, a hole, a missing beginning; a heavy bar over a shorter interval."""
    family = precession(Scene((10, -10)), (0, "0.6"), 1e-11)
    certificate = plain(family)
    assert "for every r0 in (0, 0.6]" in check(certificate) and len(certificate["pieces"]) == 5
    for r0 in ("1e-9", "0.05", "0.33", "0.59"):
        assert family.frequency_at(r0).overlaps(precession(Scene((10, -10)), r0).frequency)
    for what, place in {"there is a gap between two pieces": 2, "the amplitudes are others": 0}.items():
        spoiled = certificate | {"pieces": [x for i, x in enumerate(certificate["pieces"]) if i != place]}
        with pytest.raises(NotProved, match=what):
            check(spoiled)
    heavy = Scene((10, -10), link=Link(1, 1, 1))
    assert "for every r0 in [0.1, 0.15]" in check(precession(heavy, ("0.1", "0.15"), 1e-9).certificate)
