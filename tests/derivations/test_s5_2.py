"""Section 5.2: under which premises its equations hold, twins that must fail, and independent oracles."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.spatial.transform import Rotation

from lagrotor import Link, Scene, paired_scene, simulate
from lagrotor.models import exact_orbit
from lagrotor.pair import lagrangians
from lagrotor.pair.notation import I3, ROTOR, J, ell, k, sigma, theta_0
from lagrotor.paper import Audit, Statement, Verdict, decide
from lagrotor.paper.premises import relation_text
from lagrotor.paper.rotor_pair import premises
from lagrotor.paper.rotor_pair.ansatz import (
    breach,
    one_inclination,
    opposite_azimuths,
    opposite_spin_angles,
)
from lagrotor.paper.rotor_pair.own_paper import PAPER

UNITS = {premises.BAR_AS_LONG_AS_ROTORS.says, premises.UNIT_LENGTH.says}


@pytest.fixture(scope="module")
def stated() -> dict[str, Statement]:
    return {s.id: s for stem in PAPER.scripts.names("derivations", "s5_2") for s in PAPER.statements(stem)}


@pytest.fixture(scope="module")
def verdicts(audit: Audit) -> dict[str, Verdict]:
    return {verdict.id: verdict for verdict in audit}


def test_orders_and_domains(verdicts: dict[str, Verdict]) -> None:
    assert (verdicts["5.17"].order, verdicts["5.19"].order) == (3, 3)
    assert {p.says for p in verdicts["5.19"].premises} > {*UNITS, opposite_azimuths().says, one_inclination().says}
    assert [verdicts[i].order for i in ("5.20", "5.22")] == [1, 1]
    assert [relation_text(r) for r in verdicts["5.02"].domain] == ["sin(θ) ≠ 0"]
    assert [relation_text(r) for r in verdicts["5.14"].domain] == ["cos(θ₁) + cos(θ₂) ≠ 0"]


def test_what_is_refuted_is_refuted_with_every_premise_granted(stated: dict[str, Statement]) -> None:
    """The first difference is that of a massless bar as long as the rotors, the paper's own case."""
    product, last = decide(stated["5.21"]).lines
    assert (product.verdict, last.verdict) == ("refuted", "holds-if"), "two errors that cancel"
    _, value_of_A = stated["5.16"].relations
    alone = decide(replace(stated["5.16"], relations=(value_of_A,), correction=()))
    assert value_of_A.quantity == "A"
    assert (alone.verdict, alone.order) == ("holds-to-order", 1), "only B is wrong"
    assert premises.OPPOSITE_SPINS in alone.premises


@pytest.fixture
def changed(
    monkeypatch: pytest.MonkeyPatch, changed_physics: Callable[..., dict[str, Verdict]]
) -> Callable[..., dict[str, str]]:
    """Verdicts of a script after a function of the pair's Lagrangian is changed."""

    def verdicts(stem: str, name: str, change: Callable[[Any], Any]) -> dict[str, str]:
        monkeypatch.setattr(lagrangians, name, change(getattr(lagrangians, name)))
        return {identifier: found.verdict for identifier, found in changed_physics([], stem).items()}

    return verdicts


def test_spin_against_the_precession_flips_the_lagrangians(changed: Callable[..., dict[str, str]]) -> None:
    found = changed(
        "s5_2b_pair",
        "_rotor_energy",
        lambda energy: lambda inertia, q, q_v, phi_v, psi_v: energy(inertia, q, q_v, phi_v, -psi_v),
    )
    assert found == {"5.07": "refuted", "5.08": "refuted", "5.09": "holds", "5.10": "refuted", "5.11": "refuted"}


def test_with_a_second_constraint_an_angle_less_is_free(changed: Callable[..., dict[str, str]]) -> None:
    found = changed(
        "s5_2b_pair",
        "pair_with_bar",
        lambda pair: lambda: replace(pair(), constraints=(*pair().constraints, pair().c.q[0] - sp.pi / 5)),
    )
    assert found["5.09"] == "refuted"
    assert found["5.07"] == "holds-if", "the constraint is no part of the Lagrangian"


def test_axes_of_another_length_change_the_projection(changed: Callable[..., dict[str, str]]) -> None:
    stretched = sp.diag(2, 3, 1)
    found = changed("s5_2e_bar_length", "axis", lambda axis: lambda *angles: stretched * axis(*angles))
    assert found == dict.fromkeys(("5.17", "5.18", "5.19"), "refuted")


@pytest.mark.parametrize(("link", "spins"), [(Link(), 0.28), (Link(1, 0.01, 0.1), 0.24)], ids=["massless", "light"])
def test_how_far_the_ansatz_is_from_the_exact_orbit(link: Link, spins: float) -> None:
    """Against the paper's own angles, integrated: psi_1' + psi_2' from the Euler model's momenta and azimuths."""
    orbit = exact_orbit(Scene(spins=(10, -10), link=link), 0.204)
    run = simulate(orbit.scene, np.linspace(0, 2 * np.pi / orbit.frequency, 401), "euler", 1e-10)
    turning = np.gradient(run.azimuths, run.t, axis=1)[:, 2:-2]
    spin = np.array([[10.0], [-10.0]]) - turning * np.cos(run.inclinations)[:, 2:-2]
    found = breach()["spin angles"][link.mass > 0]
    assert np.abs(spin.sum(0)).max() / 10 == pytest.approx(found, rel=2e-3)
    assert found == pytest.approx(spins, abs=0.006)
    assert f"{100 * found:.0f} %" in opposite_spin_angles().broken


def test_the_energy_of_a_rotor_from_its_rotation() -> None:
    """Against scipy's rotations: kinetic energy of a spinning, tilting body that stands on its joint."""
    rng = np.random.default_rng(5)
    I1, axial, mass, length, step = 1.1, 0.7, 1.3, 0.9, 1e-6
    for _ in range(5):
        q, v = rng.uniform(0.3, 1.2, 3), rng.uniform(-2, 2, 3)

        def attitude(time: float, q=q, v=v) -> Rotation:
            theta, phi, psi = q + v * time
            return Rotation.from_euler("ZXZ", [phi, theta, psi])

        turned = (attitude(-step).inv() * attitude(step)).as_rotvec() / (2 * step)
        centre = (attitude(step).apply([0, 0, length / 2]) - attitude(-step).apply([0, 0, length / 2])) / (2 * step)
        kinetic = (I1 * (turned[0] ** 2 + turned[1] ** 2) + axial * turned[2] ** 2 + mass * centre @ centre) / 2
        values = dict(zip((*ROTOR.q, *ROTOR.v), (*q, *v), strict=True)) | {J: I1 + mass * length**2 / 4, I3: axial}
        assert float(lagrangians.rotor_lagrangian().subs(values)) == pytest.approx(kinetic, rel=1e-8)
        without = values | {J: I1}
        assert float(lagrangians.rotor_lagrangian().subs(without)) != pytest.approx(kinetic, rel=1e-4)


def test_the_corrected_inclinations_are_those_of_the_exact_orbit(stated: dict[str, Statement]) -> None:
    """Those corrected in 5.20, with a bar that is neither massless nor as long as the rotors; the printed ones are not."""
    link = Link(1.3, 0.5, 0.2)
    scene = Scene(spins=(10, -10), link=link)
    big, coupled = scene.inertias
    orbit = exact_orbit(scene, 0.02)
    phases = np.linspace(0, 2 * np.pi, 25)
    run = simulate(orbit.scene, phases / orbit.frequency, "minimal", 1e-12)
    values = {
        sigma: (big + coupled) / (big - coupled),
        ell: 1.3,
        premises.R: 1,
        k: 1.3,
        theta_0: np.arcsin(0.02),
    }
    errors = []
    for side in (stated["5.20"].correction, stated["5.20"].relations):
        for axis, relation in zip(run.axes, side, strict=True):
            (phase,) = relation.printed.free_symbols - values.keys()
            sines = sp.lambdify(phase, relation.printed.subs(values))(phases)
            errors.append(np.abs(np.hypot(axis[:, 0], axis[:, 1]) - sines).max())
    assert max(errors[:2]) < 6 * 0.02**3
    assert min(errors[2:]) > 0.9 * 0.02**2


def test_centres_of_the_two_curves() -> None:
    """The mean of x_1 over a turn is −ell/2 + r_0²/2 to second order; the paper's is on the other side."""
    scene = paired_scene(Scene(spins=(10, -10)), 0.05)
    orbit = exact_orbit(Scene(spins=(10, -10)), 0.05)
    turn = np.linspace(0, 2 * np.pi / orbit.frequency, 257)[:-1]
    run = simulate(scene, turn, "minimal", 1e-12)
    mean = run.tips[0, :, 0].mean() + 0.5
    assert mean == pytest.approx(0.05**2 / 2, rel=0.02)
    assert abs(mean + 0.05**2 / 2) > 0.9 * 0.05**2
