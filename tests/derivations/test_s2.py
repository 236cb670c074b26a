"""Section 2: the parallel pair. Verdicts, their twins, and the linear response against exact runs."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Rotor, Scene, Shock, simulate
from lagrotor.pair.symbols import G_1, G_2, Omega, R, a, b, t
from lagrotor.paper.audit import statements
from lagrotor.paper.ledger import Relation, judge
from lagrotor.paper.scripts import run as run_script

NAMES = run_script("derivations", "s2b_linear_pair")
STATED = {s.id: s for stem in ("s2a_parallel_pair", "s2b_linear_pair") for s in statements(stem)}
VERDICTS = {
    "2.01": "holds-if",
    "2.02": "holds-to-order",
    "2.03": "holds-to-order",
    "2.04": "holds-to-order",
    "2.05": "holds-to-order",
    "2.06": "definition",
    "2.07": "holds",
    "2.08": "refuted",
    "2.09": "refuted",
    "2.10": "refuted",
    "2.11": "refuted",
    "2.12": "holds-if",
    "2.13": "holds-if",
}


def changed(relation: Relation) -> Relation:
    """The twin: every entry of the printed side doubled."""
    return replace(relation, printed=2 * relation.printed)


def test_every_equation_of_the_section_has_one_statement():
    assert list(STATED) == list(VERDICTS)


@pytest.mark.parametrize("identifier", VERDICTS)
def test_verdict(identifier):
    verdict = judge(STATED[identifier])
    assert verdict.verdict == VERDICTS[identifier]
    assert (verdict.verdict == "refuted") <= (verdict.correction_verdict == "holds")


@pytest.mark.parametrize("identifier", VERDICTS)
def test_a_changed_coefficient_is_refuted(identifier):
    statement = STATED[identifier]
    corrected = VERDICTS[identifier] == "refuted"
    held = statement.correction if corrected else statement.relations
    for i, relation in enumerate(held):
        twin = replace(statement, relations=(*held[:i], changed(relation), *held[i + 1 :]), correction=())
        assert judge(twin).verdict == "refuted"


def test_the_orders_and_conditions():
    assert judge(STATED["2.02"]).order == 0
    assert judge(STATED["2.04"]).order == 1
    assert "omega_2 = omega_1" in judge(STATED["2.12"]).condition
    assert judge(STATED["2.12"]).correction_verdict == "holds"


def test_the_errors_of_2_08_to_2_11_cancel_in_2_12():
    # Numbers instead of algebra: w = 3, 2, T = 1. The share of rotor 1 in the torque is omega_1/(omega_1 + omega_2).
    w1, w2 = 3.0, 2.0
    share = w1 / (w1 + w2)
    rho = w1 / w2
    assert 0.5 + (rho - 1) / (2 * (1 + rho)) == pytest.approx(share)
    assert 0.5 + (1 - rho) / (2 * (1 + rho)) != pytest.approx(share)
    assert share / w1 == pytest.approx(1 / (w1 + w2))


# A light push on tip 1, short against every period: the exact pair then answers linearly.
PUSH, WIDTH, AT = 1e-4, 1e-3, 0.01


def struck(spins, direction, link):
    height = PUSH / (WIDTH * np.sqrt(np.pi))
    shock = Shock(force=tuple(height * d for d in direction), at=AT, width=WIDTH, body=1)
    scene = Scene(spins=spins, rotor=Rotor(), link=link, shock=shock)
    times = np.linspace(0.0, 1.5, 601)
    return scene, simulate(scene, times, model="minimal", tol=1e-11)


def response(scene, direction, after):
    """The closed form of the script, (3, n): X, y_1, y_2."""
    inertia, coupling = scene.inertias
    g1, g2 = scene.momenta
    values = {a: inertia, b: coupling, G_1: g1, G_2: g2, R: scene.rotor.length}
    values |= {NAMES["P_x"]: PUSH * direction[0], NAMES["P_y"]: PUSH * direction[1]}
    frequency = float(sp.sqrt(NAMES["Omega_squared"].subs(values)))
    given = [e.subs(values | {Omega: frequency}) for e in NAMES["impulse_response"]]
    return np.array([sp.lambdify(t, e, "numpy")(after) * np.ones_like(after) for e in given]), frequency


@pytest.mark.parametrize("direction", [(1, 0, 0), (0, 1, 0)])
@pytest.mark.parametrize("spins", [(10, 10), (10, 4), (10, -7)])
@pytest.mark.parametrize("link", [Link(), Link(mass=1.0, inertia=1.0)])
def test_the_linear_response_is_that_of_the_exact_pair(spins, direction, link):
    scene, run = struck(spins, direction, link)
    settled = run.t > AT + 6 * WIDTH
    found = np.array([run.axes[0, :, 0], run.axes[0, :, 1], run.axes[1, :, 1]])[:, settled]
    predicted, _ = response(scene, direction, run.t[settled] - AT)
    size = np.abs(predicted).max()
    assert np.abs(found - predicted).max() < 2e-3 * size
    swapped = np.array([predicted[0], predicted[2], predicted[1]])  # the twin: the rotors exchanged
    assert np.abs(found - swapped).max() > 0.05 * size or (spins[0] == spins[1] and direction[0])


@pytest.mark.parametrize(("ratio", "share"), [(1.0, 1.0), (0.5, 0.9), (0.2, 36 / 52)])
def test_the_paper_overstates_the_drift_unless_the_spins_are_equal(ratio, share):
    scene, run = struck((10.0, 10.0 * ratio), (1, 0, 0), Link())
    _, frequency = response(scene, (1, 0, 0), run.t)
    whole = (run.t > AT + 6 * WIDTH) & (run.t <= AT + 6 * WIDTH + 2 * np.pi / frequency)
    shift = run.axes[:, whole, 1].mean()
    printed = PUSH * scene.rotor.length / sum(scene.momenta)
    assert shift / printed == pytest.approx(share, rel=0.02)
    assert float(NAMES["off"](sp.Rational(str(ratio)))) == pytest.approx(share, rel=1e-12)


def test_the_axes_stay_parallel_for_equal_spins_and_a_push_along_the_bar_only():
    def twist(spins, direction):
        run = struck(spins, direction, Link())[1]
        return np.abs(run.axes[0, :, 1] - run.axes[1, :, 1]).max() / np.abs(run.axes[..., :2]).max()

    assert twist((10, 10), (1, 0, 0)) < 1e-4
    assert twist((10, 5), (1, 0, 0)) > 0.1
    assert twist((10, 10), (0, 1, 0)) > 0.1
