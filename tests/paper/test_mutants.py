"""Twins that must fail: a printed line changed, a premise dropped, the physics changed."""

import json
import random
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import islice

import pytest
import sympy as sp

from lagrotor.paper import Audit, Verdict
from lagrotor.paper.ledger import decide
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.paper.verdicts import Relation, Statement

MOST = 6  # twins of one relation that are judged; the fast suite judges one, in turn the first and the second


def twins(e: sp.Expr) -> Iterator[sp.Expr]:
    """Expressions that differ from `e` in one sign or one coefficient."""
    if e.is_Number:
        yield e + 1
        return
    if e.is_Symbol:
        yield 2 * e
        yield -e
        return
    if e.is_Add:
        for term in e.args:
            yield e - 2 * term
            yield e + term
    if e.is_Mul:
        yield -e
        yield 2 * e
    for i, part in enumerate(e.args):
        if isinstance(part, sp.Expr) and not (e.is_Pow and i == 1):
            for other in twins(part):
                yield e.func(*e.args[:i], other, *e.args[i + 1 :])


def side_twins(side: sp.Expr | sp.MatrixBase) -> Iterator[sp.Expr | sp.MatrixBase]:
    """Twins of an expression, or of one entry of a matrix."""
    if not isinstance(side, sp.MatrixBase):
        yield from twins(side)
        return
    for i, entry in enumerate(side):
        for other in twins(entry):
            changed = side.as_mutable()
            changed[i] = other
            yield changed


def difference(one: sp.Expr | sp.MatrixBase, other: sp.Expr | sp.MatrixBase, point: dict) -> float:
    """Largest difference of two sides at a point."""
    gap = one - other
    entries = list(gap) if isinstance(gap, sp.MatrixBase) else [gap]
    return max(abs(complex(entry.xreplace(point).evalf(30))) for entry in entries)


def is_another(relation: Relation, twin: Relation, seed: int) -> bool:
    """Whether the twin differs at all where the relation is claimed: cos(−x) for cos(x) is no change, and a change
    beyond the claimed order of a series is none either."""
    symbols = set().union(*(side.free_symbols for side in (relation.printed, twin.printed)))
    generator = random.Random(seed)
    point = {s: sp.Rational(generator.randint(20, 90), 97) for s in sorted(symbols, key=str)}
    if relation.small is None or relation.small not in symbols:
        return difference(relation.printed, twin.printed, point) > 1e-12
    sizes = (sp.Rational(1, 1000), sp.Rational(1, 2000))
    gaps = [difference(relation.printed, twin.printed, {**point, relation.small: size}) for size in sizes]
    if gaps[0] < 1e-25:
        return False
    order = float(sp.log(gaps[0] / gaps[1], 2)) if gaps[1] else 99
    return order < relation.claimed + 0.5


# What is held against something: all but the lines that only introduce letters.
JUDGED = [i for i in PAPER.equations if not all(line.names for line in PAPER.lines(i))]


@cache
def statements() -> dict[str, Statement]:
    """id → statement; at collection no script is run."""
    return {s.id: s for stem in PAPER.stating_scripts for s in PAPER.statements(stem) if not s.names}


@pytest.fixture
def verdict(audit: Audit, identifier: str) -> Verdict:
    """On the equation that the test is for."""
    return audit[identifier]


def twin_statements(verdict: Verdict, numbers: range) -> Iterator[Statement]:
    """The statement with one printed member changed; of a refuted one it is the correction that is changed and judged.
    `numbers` count the twins of each relation; where there are fewer, the last is taken."""
    statement, refuted = verdict.statement, verdict.verdict == "refuted"
    relations = statement.correction if refuted else statement.relations
    for i, relation in enumerate(relations):
        candidates = (replace(relation, printed=side) for side in side_twins(relation.printed))
        under = relation.under(verdict.premises)
        real = (c for seed, c in enumerate(candidates) if is_another(under, c.under(verdict.premises), seed))
        first = list(islice(real, numbers.stop))
        for twin in first[min(numbers.start, len(first) - 1) :] if first else ():
            changed = (*relations[:i], twin, *relations[i + 1 :])
            yield replace(statement, relations=changed, correction=())


def test_everything_that_can_be_changed_is() -> None:
    assert set(statements()) == set(JUDGED)


def test_verdicts_premises_orders_and_domains_are_as_recorded(audit: Audit) -> None:
    assert PAPER.changes(audit, PAPER.equations) == []


@pytest.mark.parametrize(
    ("identifier", "numbers"),
    [
        *(pytest.param(i, range(k % 2, k % 2 + 1), id=i) for k, i in enumerate(JUDGED)),
        *(pytest.param(i, range(MOST), id=f"{i}-{MOST}", marks=pytest.mark.slow) for i in JUDGED),
    ],
)
def test_a_changed_print_is_refuted(verdict: Verdict, identifier: str, numbers: range) -> None:
    made = list(twin_statements(verdict, numbers))
    assert made, f"{identifier}: nothing in it can be changed: it says nothing"
    for twin in made:
        found = decide(twin).verdict
        assert found == "refuted", (identifier, [r.printed for r in twin.relations], found)


@pytest.mark.parametrize("identifier", JUDGED)
def test_a_verdict_falls_with_each_of_its_premises(verdict: Verdict, identifier: str) -> None:
    statement = statements()[identifier]
    for premise in verdict.premises:
        if premise not in statement.premises:  # the order that the print itself claims, or the text's values
            assert premise.small is not None or any(premise in line.scene_premises for line in statement.relations)
            bare = [replace(r, scene={}) for r in statement.relations if premise in r.scene_premises]
            for line in bare:
                alone = decide(replace(statement, relations=(line,), correction=()))
                assert alone.verdict in ("refuted", "undecided"), (identifier, line.quantity, alone.verdict)
            continue
        left = tuple(other for other in verdict.premises if other != premise)
        without = decide(replace(statement, premises=left))
        assert without.verdict in ("refuted", "undecided"), (identifier, premise.says, without.verdict)


@pytest.mark.parametrize("identifier", JUDGED)
def test_a_refuted_equation_has_a_correction_that_holds(verdict: Verdict, identifier: str) -> None:
    statement = statements()[identifier]
    assert verdict.verdict != "undecided", verdict.evidence
    if verdict.verdict == "refuted":
        assert verdict.correction_verdict in ("holds", "holds-if", "holds-to-order"), identifier
        assert statement.wrong, f"{identifier}: say in a line what was wrong"
        assert all(relation.quantity for relation in statement.correction), f"{identifier}: name what is corrected"
    elif statement.correction:  # what holds where the printed condition does not
        assert verdict.correction_verdict in ("holds", "holds-if", "holds-to-order"), identifier


@pytest.mark.parametrize("identifier", JUDGED)
def test_what_holds_assumes_nothing(verdict: Verdict) -> None:
    assert (verdict.verdict == "holds") <= (verdict.premises == ())
    assert (verdict.verdict == "holds-if") <= (verdict.premises != ())


# The physics, changed where it enters the library, before anything is derived from it. Proofs in the scripts would refuse
# first; they are let pass here, so that the verdicts themselves are seen to fall.
CHANGED = """
import json, os, sys
import sympy as sp
import lagrotor.pair.lagrangians as physics
from lagrotor.pair.notation import I1, I3, J, K, M, R, a, b, ell, m, ROTOR
import lagrotor.paper.proof as proof
proof.prove = lambda *sides, **more: None
import lagrotor.paper.equation_statements as equation_statements
equation_statements.needs_premises = lambda *compared: False
from lagrotor.paper.ledger import decide
changes, stems = json.load(sys.stdin)
for change in changes:
    copy = os.fork()
    if copy:
        os.waitpid(copy, 0)
        continue
    exec(change)
    from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
    found = {}
    for stem in stems:
        try:
            judged = [decide(s) for s in PAPER.statements(stem)]
            found |= {v.id: f"{v.verdict}, correction {v.correction_verdict}" for v in judged}
        except Exception as error:
            found[stem] = type(error).__name__
    print(json.dumps(found), flush=True)
    os._exit(0)
"""
PHYSICS = {
    "as it is": "",
    "tilting without the factor one half": """
energy = physics._rotor_energy
physics._rotor_energy = lambda inertia, *rest: energy(2 * inertia, *rest)
""",
    "the spin opposite to the precession": """
energy = physics._rotor_energy
physics._rotor_energy = lambda inertia, q, q_v, phi_v, psi_v: energy(inertia, q, q_v, phi_v, -psi_v)
""",
    "the bar's mass at one tip": "physics.INERTIAS[a] = J + m * R**2 / 2 + K * R**2 / ell**2",
}


@cache
def verdicts_under(changes: tuple[str, ...], stems: tuple[str, ...]) -> dict[str, dict[str, str]]:
    """By each of the changes: the verdicts on what the scripts state, in copies of one process."""
    given = json.dumps([[PHYSICS[change] for change in changes], stems])
    ran = subprocess.run([sys.executable, "-c", CHANGED], input=given, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    return dict(zip(changes, map(json.loads, ran.stdout.splitlines()), strict=True))


ROTOR = {"5.01", "5.02", "5.03", "5.04", "5.05", "5.06"}
PAIR_SCRIPTS = ("s5_2b_pair", "s5_2c_first_integrals", "s5_2d_precession_rate", "s5_3a_equal_spins", "s6_conclusion")


OF_ONE_ROTOR = ("tilting without the factor one half", "the spin opposite to the precession")


@pytest.mark.parametrize("change", OF_ONE_ROTOR)
def test_changed_physics_takes_the_verdicts_of_one_rotor_with_it(audit: Audit, change: str) -> None:
    own = {s.id for s in PAPER.statements("s5_2a_single_rotor")}
    sound = {v.id: f"{v.verdict}, correction {v.correction_verdict}" for v in audit if v.id in own}
    changed = verdicts_under(OF_ONE_ROTOR, ("s5_2a_single_rotor",))[change]
    assert {i for i in sound if sound[i] != changed.get(i)} == ROTOR


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "fall"),
    [
        # What rests on a rotor's Lagrangian: not the bar's length (5.09), not the spins alone (5.13), not the linear pair.
        (
            "tilting without the factor one half",
            {"5.07", "5.08", "5.10", "5.11", "5.12", "5.14", "5.15", "5.23"},
        ),
        # What rests on the bar's share of the inertia: the rates of the coupled pair. The correction of 6.02 is in a and b.
        ("the bar's mass at one tip", {"5.24", "5.25"}),
    ],
)
def test_changed_physics_takes_the_verdicts_that_rest_on_it(change: str, fall: set[str]) -> None:
    found = verdicts_under(
        ("as it is", "tilting without the factor one half", "the bar's mass at one tip"), PAIR_SCRIPTS
    )
    sound, changed = found["as it is"], found[change]
    assert {i for i in sound if sound[i] != changed.get(i)} == fall
