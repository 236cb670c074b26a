"""Families of orbits: the truth is inside for every parameter, functions keep their bounds, what is spoiled is found."""

import copy
import random
from typing import Any

import mpmath as mp
import pytest

pytest.importorskip("flint", reason="the extra `proof` is not installed")

from flint import arb, arb_poly, ctx

from lagrotor import Link, Scene
from lagrotor.errors import DomainError
from lagrotor.proofs import NotProved, check, precession
from lagrotor.proofs.balls import exact, precision, upper
from lagrotor.proofs.checker import family_checking
from lagrotor.proofs.fields import field_of
from lagrotor.proofs.orbits import families
from lagrotor.proofs.orbits.closed_orbits import OrbitProblem
from lagrotor.proofs.orbits.families import FamilyProof, prove_family
from lagrotor.proofs.orbits.taylor_models import Order, TaylorModel
from lagrotor.proofs.stepping import Motion
from lagrotor.proofs.tape import paced
from tests.proofs.gallery import PENDULUM, plain

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


def pendulum_family(low: str, high: str) -> tuple[FamilyProof, dict[str, Any]]:
    """The pendulum's orbits of all amplitudes between two, by a quarter of a period, and what the second program reads."""
    made = field_of(PENDULUM, {}, [1], [0])
    problem = OrbitProblem(Motion(paced(made.motion.tape, 2)), (2,), (0,), (1, -1), (-1, 1))
    middle, half = exact((arb(low) + arb(high)) / 2), exact((arb(high) - arb(low)) / 2)
    with mp.workdps(40):
        slopes = mp.taylor(quarter_period, mp.mpf(str(float(middle))), 8)
        pace = arb_poly([arb(mp.nstr(c, 25)) * half**k for k, c in enumerate(slopes)])
    pace = arb_poly([exact(c) for c in pace.coeffs()])
    proof = prove_family(problem, [arb_poly([middle, half]), arb_poly([]), pace], 14, 1e-11)
    return proof, {"middle": middle, "half": half}


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


def follow(proof: FamilyProof, change: str = "") -> family_checking.FamilyFlow:
    """The second program along the family's steps."""
    tape = {"operations": proof.problem.motion.tape.operations, "outputs": proof.problem.motion.tape.outputs}
    tape |= {"arguments": proof.problem.motion.tape.arguments}
    flow = family_checking.FamilyFlow(tape, list(proof.x), list(proof.W), proof.n, 8)
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
    assert family.frequency.contains(inner.frequency) and float(family.frequency.rad()) < 0.02
    assert inner.kind == "hyperbolic" and family.kind == "undecided"
    words = check(plain(family))
    assert "for every r0 in [0.45, 0.46], a paired precession" in words and "they are one smooth curve" in words


SPOILS = {
    "the period is another": lambda c: c["claim"]["period"].__setitem__(1, "0p0"),
    "of a family no kind is shown": lambda c: c["claim"].__setitem__("kind", "elliptic"),
    "Krawczyk's test does not close over a family": lambda c: c["pieces"][0].__setitem__(
        "W", [w if w.startswith("0") else "1p-90" for w in c["pieces"][0]["W"]]
    ),
    "the amplitudes are others": lambda c: c["claim"].__setitem__("r0", ["1/5", "1/4"]),
    "not one unit of s": lambda c: c["pieces"][0]["steps"].pop(),
    "leave a part out": lambda c: c["pieces"][0]["cuts"].pop(),
    "fixed set of the reversal": lambda c: c["pieces"][0]["x"].__setitem__(1, ["1p-20"]),
    "the tube about a family is too narrow": lambda c: c["pieces"][0]["x"][6].__setitem__(0, "1p-2"),
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


def test_a_pair_of_amplitudes_that_is_none_is_refused() -> None:
    for r0 in (("-0.1", "0.1"), ("0.1", "0.1"), (0, "0.1"), ("0.1", 1)):
        with pytest.raises(DomainError, match="must lie above 0 and below 1, the lowest of a pair first"):
            precession(Scene((10, -10)), r0)


@pytest.mark.slow
def test_the_precession_exists_for_all_amplitudes_from_a_twentieth_to_three_fifths() -> None:
    """The numbers of docs/proofs.md, a hole, a missing beginning; a heavy bar over a shorter interval."""
    family = precession(Scene((10, -10)), ("0.05", "0.6"), 1e-11)
    certificate = plain(family)
    assert "for every r0 in [0.05, 0.6]" in check(certificate) and len(certificate["pieces"]) == 5
    assert all(family.frequency.contains(precession(Scene((10, -10)), r0).frequency) for r0 in ("0.05", "0.33", "0.59"))
    for what, place in {"there is a gap between two pieces": 2, "the amplitudes are others": 0}.items():
        spoiled = certificate | {"pieces": [x for i, x in enumerate(certificate["pieces"]) if i != place]}
        with pytest.raises(NotProved, match=what):
            check(spoiled)
    heavy = Scene((10, -10), link=Link(1, 1, 1))
    assert "for every r0 in [0.1, 0.15]" in check(precession(heavy, ("0.1", "0.15"), 1e-9).certificate)
