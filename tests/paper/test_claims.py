"""The tests of the claims: each comes out as recorded, each differently for a scene that it is not about."""

import json
from math import exp, pi, sqrt

import numpy as np
import pytest

from lagrotor import Link, Scene, Shock, simulate
from lagrotor.paper.catalogue import claims
from lagrotor.paper.claim_tests import claim_tests, record

TESTS = claim_tests()

RECORDED = {
    "C01": "confirmed",
    "C02": "refuted",
    "C03": "confirmed",
    "C04": "confirmed",
    "C05": "confirmed-if",
    "C06": "confirmed",
    "C07": "confirmed",
    "C08": "confirmed-if",
    "C09": "confirmed-if",
    "C10": "confirmed-if",
    "C11": "confirmed-if",
    "C12": "confirmed",
    "C13": "confirmed-if",
    "C14": "confirmed",
    "C15": "confirmed-if",
    "C16": "confirmed-if",
    "C17": "refuted",
    "C18": "confirmed",
    "C19": "confirmed-if",
    "C20": "confirmed",
    "C21": "confirmed-if",
    "C22": "refuted",
    "C23": "confirmed-if",
    "C24": "confirmed-if",
}

J, P_50, P_40 = 1.25, 50 * sqrt(pi) / 50, 40 * sqrt(pi) / 20


def anti(m, K, G=10.0):
    """Natural rate of opposite spins, G / sqrt(a² − b²) with a ± b = J + m/2, J + 2K."""
    return G / sqrt((J + m / 2) * (J + 2 * K))


def struck(rate):
    """What a pulse of width 1/20 gives an oscillator of that rate, over what its impulse would."""
    return exp(-((rate / 40) ** 2))


# id, name of the number, what it should be by hand, relative tolerance.
ORACLES = [
    ("C01", "displacement_by_equation_7", P_50 / 20, 1e-12),
    # A pulse of finite width and an amplitude of 0.09: one part in fifty.
    ("C01", "displacement_1_last_cycles", P_50 / 20, 0.02),
    # Fixed in space is G r + (a + b) r × r': the axis goes round it at its size over a + b.
    ("C01", "precession_1_rad_per_s", sqrt(10**2 + (P_50 / 2) ** 2) / 1.75, 0.003),
    ("C02", "largest_x_without_spins", np.sin(2.4 * P_50 / 3.5), 1e-4),
    # Linear drift over (7), massless or not: (a − b)(G_1 + G_2)² / (2 D), D = a (G_1² + G_2²) − 2 b G_1 G_2.
    ("C02", "drift_over_equation_7_spins_10_10", 1.0, 0.003),
    ("C02", "drift_over_equation_7_spins_10_5", 3.25 * 225 / (2 * (2.5 * 125 + 0.75 * 100)), 0.02),
    ("C03", "first_order_off_orthogonal", 1e-4, 1e-9),
    ("C03", "first_order_stretch_in_10_s", (1 + 1e-4) ** 5000 - 1, 1e-9),
    ("C07", "largest_omega_that_fails_rad_per_s", sqrt(5e-324) / sqrt(2), 0.03),
    ("C08", "after_exact_J", 100 + P_50**2 / 7 * exp(-((10 / 1.75 / 50) ** 2) / 2), 1e-6),
    ("C08", "after_closed_form_light_bar_J", 100 + P_50**2 / 5.02 * exp(-((10 / 1.255 / 50) ** 2) / 2), 1e-9),
    ("C10", "dead_point_after_s", pi / 2 / (P_50 / 3.5), 1e-3),
    ("C10", "shock_along_x_tilt_after_2.7_s_deg", np.degrees(2.7 * P_50 / 3.5), 1e-3),
    ("C10", "shock_along_x_rate_in_XZ_rad_per_s", P_50 / 3.5, 1e-4),
    ("C13", "shock_along_y_5_N_predicted", -P_50 / 10 / 20, 1e-12),
    ("C13", "shock_along_y_5_N_mean_x", -P_50 / 10 / 20, 0.05),
    ("C13", "power_of_shock_along_x_in_half_difference", 2, 0.02),
    ("C13", "power_of_shock_along_x_in_common_mean", 3, 0.02),
    ("C16", "constant_theta_longest", sqrt(1 + 4 * 0.204**2), 1e-4),
    ("C16", "corrected_longest", sqrt(1 + 4 * 0.204**2 + 4 * 0.204**4), 1e-4),
    ("C16", "corrected_shortest", sqrt(1 + 4 * 0.204**2), 1e-4),
    ("C16", "exact_orbit_longest", 1, 1e-9),
    # Omega/Omega_0 = 1 − r_0²/4 and cos = 1 − r_0²/2.
    ("C17", "change_over_r0_squared", -0.75, 0.01),
    ("C20", "rate_exact_rad_per_s", sqrt(20**2 + (P_40 * struck(16)) ** 2) / J, 2e-3),
    ("C20", "rate_after_small_shock_rad_per_s", 16, 1e-4),
    ("C21", "rate_after_small_shock_rad_per_s", 80 / 7, 1e-4),
    ("C21", "constant", J / 1.75, 1e-4),
    ("C21", "constant_light_bar", J / 1.255, 1e-4),
    ("C22", "rate_after_small_shock_m_1_K_1", anti(1, 1), 1e-3),
    ("C22", "rate_after_small_shock_m_0.01_K_0.1", anti(0.01, 0.1), 1e-3),
    ("C22", "rate_after_small_shock_m_1_K_0.1", anti(1, 0.1), 1e-3),
    ("C23", "coefficient_massless", -0.25, 0.01),
    ("C23", "coefficient_equal_spins_m_1_K_1", 0.5, 0.01),
    ("C24", "rate_rad_per_s", anti(1, 1), 1e-9),
    # After P_y the joint-line momentum is shared: 2 (a + b) alpha' = P_y − G (x_1 − x_2), to first order P_y alone.
    ("C24", "slope_y_1_per_s", 0.3 / 50 * P_50 / 3.5, 0.01),
    ("C24", "centre_x_1", -0.3 / 50 * P_50 / 20, 0.01),
]


@pytest.fixture(scope="module")
def results():
    return {identifier: test.result for identifier, test in TESTS.items()}


def test_every_claim_has_a_test():
    assert list(claims()) == sorted(TESTS) == list(RECORDED)


@pytest.mark.parametrize("identifier", RECORDED)
def test_outcome_is_as_recorded(results, identifier):
    finding = results[identifier].finding
    assert finding.outcome == RECORDED[identifier], finding.explanation
    assert (finding.condition is not None) == (finding.outcome == "confirmed-if")


@pytest.mark.parametrize("identifier", RECORDED)
def test_a_scene_that_the_claim_is_not_about_comes_out_otherwise(results, identifier):
    test, finding = results[identifier].test, results[identifier].finding
    if identifier == "C14":
        # A rotor at rest about its axis keeps that freedom, so no spins make the count another: what the claim is not
        # about is the same pair without its bar.
        assert test.decide(test.measure(test.foreign)).outcome == finding.outcome
        foreign = test.decide(test.measure(test.case, link=None))
    else:
        foreign = test.decide(test.measure(test.foreign))
    assert (foreign.outcome, foreign.condition) != (finding.outcome, finding.condition), foreign.explanation


@pytest.mark.parametrize(("identifier", "name", "value", "tolerance"), ORACLES)
def test_numbers_by_hand(results, identifier, name, value, tolerance):
    assert results[identifier].measured[name] == pytest.approx(value, rel=tolerance)


def test_the_printed_opposite_rate_needs_a_bar_the_paper_does_not_list(results):
    K = results["C22"].measured["inertia_that_mass_1_needs_kg_m2"]
    assert anti(1, K) == pytest.approx(5.7)
    # The nearest, mass 1 with inertia 0.1, a mixture of two listings, is a tenth off.
    assert min(abs(anti(m, inertia) - 5.7) for m in (0, 0.01, 1) for inertia in (0, 0.1, 1)) > 0.3


def test_one_choice_of_stiffness_and_damping_gives_the_papers_other_numbers(results):
    n = 20
    energy, rates, single = (results[i].measured for i in ("C08", "C21", "C20"))
    assert energy["smallest_n_that_fits"] <= n <= energy["largest_n_that_fits"]
    assert energy["stiffness_N_per_m"] == 2000 / n * 10**2
    assert energy["damping_kg_per_s"] == 500 / n * 10
    assert energy["step_limit_ms"] > 1 > energy["step_limit_light_bar_ms"]
    assert n <= rates["largest_n_that_gives_11.4"] < energy["largest_n_that_fits"]
    assert round(rates[f"rate_springs_n_{n}_rad_per_s"], 1) == 11.4
    assert round(single["rate_springs_rad_per_s"]) == 16


def test_stability_in_x_is_for_a_while(results):
    m = results["C11"].measured
    # A mirror in the plane between the grounds takes one sign along x into the other, but not along y.
    assert m["fallen_in_x_after_s_+x"] == pytest.approx(m["fallen_in_x_after_s_-x"], abs=0.1)
    assert m["turned_about_joint_line_rad_+x"] == pytest.approx(m["turned_about_joint_line_rad_-x"], rel=1e-2)
    assert m["fallen_in_x_after_s_-y"] < m["fallen_in_x_after_s_+x"] < m["not_fallen_within_s_+y"]
    assert "fallen_in_x_after_s_+y" not in m
    # Another model, in other coordinates: read at the same times, 1/40 s apart.
    scene = Scene((10, -10), link=Link(mass=1, inertia=1), shock=Shock((0, -50, 0), 0.2, 1 / 50))
    t = np.linspace(0.3, 10, 971)
    x = abs(simulate(scene, t, "minimal", 1e-10).axes[..., 0]).max(0)
    assert m["fallen_in_x_after_s_-y"] == pytest.approx(t[np.argmax(x > 0.5)] - 0.2, abs=0.04)
    assert m["fallen_in_x_after_s_-y_springs"] == pytest.approx(m["fallen_in_x_after_s_-y"], rel=0.03)
    assert m["power_of_shock_in_toppling_rate_x"] == pytest.approx(2, abs=0.1)
    assert m["power_of_shock_in_time_x"] == pytest.approx(-3, abs=0.3)
    assert m["power_of_shock_in_time_minus_y"] == pytest.approx(-2, abs=0.3)


def test_after_the_dead_point_side_force_and_softness_decide(results):
    m = results["C10"].measured
    assert m["shock_along_x_tilt_after_2.7_s_deg"] < 80
    parted = [m[f"side_1_N_axes_part_by_deg_springs_S_{S}"] for S in ("1e4", "1e5", "1e6")]
    assert parted == sorted(parted)
    assert parted[0] < 5 < 0.1 * parted[2] + 5 < m["side_1_N_axes_part_by_deg_after_8_s"]
    # Clear of the dead point another model, in other coordinates, does the same.
    shock = Shock((50, 1, 0), 0.2, 1 / 50)
    run = simulate(Scene((0, 0), link=Link(mass=1, inertia=1), shock=shock), [2.9, 5.2], "spheres", 1e-11)
    assert m["side_1_N_tilt_deg"] == pytest.approx(90.1, abs=0.1)
    assert np.linalg.norm(run.axes[1, 1] - run.axes[0, 1]) > 10 * np.linalg.norm(run.axes[1, 0] - run.axes[0, 0])


def test_the_freedoms_are_those_of_a_pair_with_its_bar():
    test = TESTS["C14"]
    counted = {link: test.measure((0, 0), link=bar) for link, bar in (("bar", Link(1, 1, 1)), ("none", None))}
    assert [counted[k]["degrees_of_freedom"] for k in counted] == [5, 6]
    assert [counted[k]["degrees_of_freedom_without_spins"] for k in counted] == [3, 4]
    assert counted["bar"]["rank_where_axes_and_bar_are_in_line"] == 2


def test_the_ansatz_is_within_its_bound(results):
    m = results["C15"].measured
    for name in ("massless", "light_bar"):
        assert m[f"azimuth_rates_sum_relative_there_{name}"] == pytest.approx(0.05, rel=1e-3)
        assert m[f"r0_at_which_the_azimuth_sum_is_5_percent_{name}"] < 0.204 / 6


def test_the_confirmation_is_held_against_a_plain_sine(results):
    m = results["C19"].measured
    assert m["left_projected_corrected"] < m["left_projected_plain_sine"] < m["left_projected_printed"] / 2
    assert m["left_projected_plain_sine"] == pytest.approx(0.071, abs=0.001)
    assert m["skew_deg"] == pytest.approx(-20.8, abs=0.1)


def test_no_bar_keeps_the_printed_opposite_rate_for_three_cycles(results):
    m = results["C22"].measured
    cycles = [value for key, value in m.items() if key.startswith("cycles_within_a_quarter")]
    assert len(cycles) == 6 and max(cycles) < 3
    # A quarter cycle apart after n cycles of the motion: n |1/rate − 1/printed| · printed = 1/4.
    assert m["cycles_within_a_quarter_after_small_shock_m_1_K_0.1"] == pytest.approx(
        anti(1, 0.1) / (4 * (anti(1, 0.1) - 5.7)), rel=0.02
    )


@pytest.mark.parametrize("identifier", RECORDED)
def test_record(results, identifier):
    result = results[identifier]
    row = record(result)
    keys = "id section text verdict condition model measured explanation seconds"
    assert list(row) == keys.split()
    assert row["verdict"] == RECORDED[identifier]
    assert row["explanation"].endswith(".")
    assert row["measured"]
    assert all(np.isfinite(float(v)) for v in row["measured"].values())
    assert json.loads(json.dumps(row)) == row
