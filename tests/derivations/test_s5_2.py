"""Section 5.2: under which premises its equations hold, twins that must fail, and independent oracles."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Scene, simulate
from lagrotor.models import exact_orbit
from lagrotor.pair import lagrangians
from lagrotor.pair.notation import ell, k, sigma, theta_0
from lagrotor.paper import Verdict
from lagrotor.paper.ledger import decide
from lagrotor.paper.rotor_pair import premises
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.paper.verdicts import Statement


@pytest.fixture(scope="module")
def stated() -> dict[str, Statement]:
    return {s.id: s for stem in PAPER.scripts.names("derivations", "s5_2") for s in PAPER.statements(stem)}


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
