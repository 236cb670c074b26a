"""Section 2: the parallel pair. Verdicts, their twins, and the linear response against exact runs."""

from functools import cache

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Rotor, Scene, Shock, simulate
from lagrotor.pair.notation import G_1, G_2, Omega, R, a, b, t
from lagrotor.paper.rotor_pair.own_paper import PAPER

ROTORS, LINEAR, SHARED = "s2a_angular_momentum", "s2b_linear_pair", "s2c_shared_force"


@cache
def stated():
    return {s.id: s for stem in (ROTORS, SHARED) for s in PAPER.statements(stem)}


def names():
    """Those of the script of the linear pair."""
    return PAPER.scripts.run("derivations", LINEAR)


def test_a_doubled_spin_inertia_takes_the_torques_with_it_and_a_doubled_transverse_one_does_not(changed_physics):
    spin = changed_physics([(ROTORS, "I3 * omega * r_hat", "2 * I3 * omega * r_hat")], ROTORS)
    assert [spin[f"2.0{i}"].verdict for i in (2, 3, 4, 5)] == ["refuted"] * 4
    across = changed_physics([(ROTORS, "return J * r_hat", "return 2 * J * r_hat")], ROTORS)
    assert [across[f"2.0{i}"].verdict for i in (2, 3, 4, 5)] == ["holds-to-order"] * 4


def test_a_cross_product_turned_round_takes_every_rate_with_it(changed_physics):
    turned = changed_physics([(SHARED, "return cross(lever, force)", "return cross(force, lever)")], SHARED)
    assert [turned[identifier].verdict for identifier in ("2.07", "2.12")] == ["refuted", "refuted"]
    assert [turned[identifier].correction_verdict for identifier in ("2.10", "2.11")] == ["refuted", "refuted"]
    assert turned["2.06"].verdict == "holds-if"


def test_a_force_on_both_tips_doubles_the_drift_of_2_13(changed_physics):
    both = [(LINEAR, "sp.Matrix([F[0], F[1], 0, 0, 0, 0])", "sp.Matrix([F[0], F[1], 0, F[0], F[1], 0])")]
    changed = changed_physics(both, LINEAR, SHARED)
    assert (changed["2.13"].verdict, changed["2.12"].correction_verdict) == ("refuted", "refuted")


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
    values |= {names()["P_x"]: PUSH * direction[0], names()["P_y"]: PUSH * direction[1]}
    frequency = float(sp.sqrt(names()["Omega_squared"].subs(values)))
    given = [e.subs(values | {Omega: frequency}) for e in names()["impulse_response"]]
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
    assert float(names()["off"](sp.Rational(str(ratio)))) == pytest.approx(share, rel=1e-12)
