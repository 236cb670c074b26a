"""Section 6: the conclusion. Verdicts, their twins, and the modes against numbers."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Scene, natural_rate, simulate
from lagrotor.mechanics import degrees_of_freedom
from lagrotor.pair.lagrangians import axes_pair
from lagrotor.pair.symbols import G_1, G_2, G, a, b
from lagrotor.paper.ledger import judge
from lagrotor.paper.scripts import run as run_script

NAMES = run_script("derivations", "s6_conclusion")
STATED = {s.id: s for s in NAMES["statements"]}
BAR = Link(mass=1, inertia=1)


def test_both_equations_are_stated() -> None:
    assert list(STATED) == ["6.01", "6.02"]


@pytest.mark.parametrize("identifier", ["6.01", "6.02"])
def test_verdict(identifier: str) -> None:
    verdict = judge(STATED[identifier])
    assert (verdict.verdict, verdict.correction_verdict) == ("refuted", "holds")


@pytest.mark.parametrize("identifier", ["6.01", "6.02"])
def test_changed_coefficients_are_refuted(identifier: str) -> None:
    statement = STATED[identifier]
    for i, relation in enumerate(statement.correction):
        twins = [-relation.printed, 2 * relation.printed]
        for total in relation.printed.atoms(sp.Add):
            twins.append(relation.printed.xreplace({total: total - 2 * total.args[0]}))
        for twin in twins:
            others = (*statement.correction[:i], replace(relation, printed=twin), *statement.correction[i + 1 :])
            assert judge(replace(statement, relations=others, correction=())).verdict == "refuted"


def test_only_the_count_of_modes_is_wrong() -> None:
    counts = STATED["6.01"].relations
    answers = [judge(replace(STATED["6.01"], relations=(r,), correction=())).verdict for r in counts]
    assert answers == ["holds", "holds", "refuted"]


def test_without_the_bar_there_are_more_degrees_of_freedom() -> None:
    assert degrees_of_freedom(axes_pair(bar=False), NAMES["upright"]) == NAMES["without_spins"] + 1


def test_roots_in_numbers() -> None:
    """Eigenvalues of the linear pair: one pair ± i Omega_0, four zeros; one chain of two, found by ranks."""
    big, coupled = Scene(spins=(10, -10), link=BAR).inertias
    matrix = np.array(NAMES["companion"].subs({a: big, b: coupled, G: 10.0}).tolist(), dtype=float)
    rates = np.sort(np.abs(np.linalg.eigvals(matrix)))
    np.testing.assert_allclose(rates[4:], natural_rate(Scene(spins=(10, -10), link=BAR)), rtol=1e-9)
    assert rates[:4].max() < 1e-4
    assert [np.linalg.matrix_rank(np.linalg.matrix_power(matrix, n)) for n in (1, 2, 3)] == [3, 2, 2]


def test_equal_spins_have_another_zero_mode() -> None:
    """The twin: with equal spins it is the twist y_1 = −y_2 that goes on at a constant rate."""
    (free,) = NAMES["pair"].gyroscopic.subs({G_1: G, G_2: G}).nullspace()
    assert list(NAMES["pair"].basis * free)[1] == -list(NAMES["pair"].basis * free)[4] != 0


def test_third_mode_stays_where_it_is_put_on_the_exact_pair() -> None:
    """Both axes tilted along the joint line, at rest: nothing moves. With the rates of a topple it does."""
    tilted = ((0.3, 0.0, np.sqrt(1 - 0.09)),) * 2
    times = np.linspace(0, 3, 7)
    rest = simulate(Scene(spins=(10, -10), link=BAR, axes=tilted), times, "minimal", 1e-10)
    assert np.ptp(rest.axes, axis=1).max() < 1e-12
    moving = Scene(spins=(10, -10), link=BAR, rates=((0, 0.1, 0),) * 2)
    turned = simulate(moving, times, "minimal", 1e-10)
    np.testing.assert_allclose(turned.axes[:, :, 1], np.sin(0.1 * times) * np.ones((2, 1)), atol=1e-9)
    assert np.abs(turned.axes[:, :, 0]).max() < 1e-9
