"""Section 4, energies and the damper, with the physics changed."""

from functools import cache

from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

LINKS, ENERGY, SHOCK = "s4a_link_constants", "s4b_energy", "s4c_shock"


def names_of(stem):
    return PAPER.scripts.run("derivations", stem)


@cache
def stated():
    return {s.id: s for stem in (LINKS, ENERGY, SHOCK) for s in PAPER.statements(stem)}


def test_changed_physics_of_the_energy_and_of_the_damper(changed_physics):
    doubled = changed_physics([(ENERGY, "sp.expand(dot(field, field) / 2)", "sp.expand(dot(field, field))")], ENERGY)
    assert [doubled[i].verdict for i in ("4.02", "4.03", "4.05")] == ["refuted"] * 3
    turning = changed_physics([(ENERGY, "field = U + cross(Omega, d)", "field = U + 2 * cross(Omega, d)")], ENERGY)
    assert turning["4.03"].verdict == "refuted"
    quadratic = changed_physics([(LINKS, "newton / (metre / second)\n", "newton / (metre / second) ** 2\n")], LINKS)
    assert quadratic["4.01"].verdict == "refuted"
