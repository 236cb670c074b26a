"""Section 2, the parallel pair, with its physics changed."""

ROTORS, LINEAR, SHARED = "s2a_angular_momentum", "s2b_linear_pair", "s2c_shared_force"


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
