"""Section 3, particles, rigid bodies and the time step, with premises and physics changed."""

from dataclasses import replace
from functools import cache

import sympy as sp

from lagrotor.paper import Premise
from lagrotor.paper.grammar import symmetric
from lagrotor.paper.ledger import decide
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

PARTICLES, BODY_SCRIPT, STEP, ROTATION, LINK = (
    "s3a_particles",
    "s3b_rigid_body",
    "s3c_time_step",
    "s3d_rotation",
    "s3e_link",
)


@cache
def stated():
    return {s.id: s for stem in (PARTICLES, BODY_SCRIPT, STEP, ROTATION, LINK) for s in PAPER.statements(stem)}


def test_unequal_inertias_let_omega_lag_by_one_order():
    verdict = decide(stated()["3.13"])
    assert (verdict.verdict, verdict.order) == ("holds-to-order", 1)
    step = tuple(premise for premise in verdict.premises if premise.small is not None)
    lagging = decide(replace(stated()["3.13"], premises=step))
    assert (lagging.verdict, lagging.order) == ("refuted", 0)


def test_equal_inertias_hide_what_is_wrong_in_3_12_and_3_17():
    principal = sp.symbols("I_x I_y I_z", positive=True)
    for identifier in ("3.17", "3.18"):
        equal = Premise("equal principal inertias", dict.fromkeys(principal[1:], principal[0]))
        assert decide(replace(stated()[identifier], premises=(equal,))).verdict == "holds-if"
    I_0 = symmetric("I_0")
    equal = Premise("equal principal inertias", dict(zip(I_0, principal[0] * sp.eye(3), strict=True)))
    assert decide(replace(stated()["3.12"], premises=(equal,))).verdict == "holds-if"


def test_a_cross_product_turned_round_in_the_angular_momentum(changed_physics):
    edit = (PARTICLES, "summed(m * cross(d, U - U_cm)", "summed(m * cross(U - U_cm, d)")
    changed = changed_physics([edit], PARTICLES, BODY_SCRIPT)
    assert [changed[i].verdict for i in ("3.05", "3.10", "3.06", "3.11")] == ["refuted", "refuted", "holds", "holds"]


def test_twice_the_inertial_mass_in_newtons_law(changed_physics):
    changed = changed_physics([(PARTICLES, "[m * A - inside(i)", "[2 * m * A - inside(i)")], PARTICLES)
    assert [changed[i].verdict for i in ("3.07", "3.08", "3.02")] == ["refuted", "refuted", "holds-if"]


def test_a_body_that_turns_the_other_way(changed_physics):
    field = (BODY_SCRIPT, "field = U_cm + rate(Q) * d", "field = U_cm - rate(Q) * d")
    moments = (BODY_SCRIPT, "C_turned = Q * C_0 * Q.T", "C_turned = Q.T * C_0 * Q")
    changed = changed_physics([field, moments], BODY_SCRIPT)
    assert (changed["3.09"].verdict, changed["3.12"].verdict) == (
        "refuted",
        "holds",
    )  # 3.12 is that of the inverse turn
    assert changed["3.12"].correction_verdict == "refuted"


def test_changed_physics_of_a_step(changed_physics):
    light = changed_physics([(STEP, "exact_U = U + F / M * dt", "exact_U = U + 2 * F / M * dt")], STEP)
    assert light["3.13"].verdict == "refuted"
    other_way = changed_physics(
        [(ROTATION, "sp.eye(3) + sp.sin(angle) * N", "sp.eye(3) - sp.sin(angle) * N")], ROTATION
    )
    assert (other_way["3.15"].verdict, other_way["3.16"].correction_verdict) == ("refuted", "holds")
    one_sided = changed_physics([(LINK, "length_squared = (X_1 - X_2)", "length_squared = (X_1 - 2 * X_2)")], LINK)
    assert (one_sided["3.20"].verdict, one_sided["3.19"].correction_verdict) == ("refuted", "refuted")
