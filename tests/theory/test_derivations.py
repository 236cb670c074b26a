"""The theory's scripts run, prove their steps, and say something; a wrong step is refused."""

from pathlib import Path

import pytest

from lagrotor.errors import ProofError
from lagrotor.paper import Remark, Step, scripts
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from tests.report.derivation_faults import faults_of

STEMS = [stem for stem in PAPER.scripts.names("derivations") if stem.startswith("t")]
# Stem → the least number of steps; t13 is of numbers.
STEPWISE = dict.fromkeys(STEMS, 8) | {"t4_orbit_family": 3, "t7_duration": 5, "t10_conserved": 5, "t13_integrals": 1}
# Exact orbits by the hundred, long runs or long algebra: tests beside this one hold their
# laws to a few.
LONG = (
    "t5_floquet",
    "t6_shock_drift",
    "t8_toppling",
    "t11_slow_motion",
    "t12_unequal_spins",
    "t13_integrals",
    "t14_guiding_centre",
    "t15_return_maps",
)
SCRIPTS = [pytest.param(stem, marks=pytest.mark.slow) if stem in LONG else stem for stem in STEMS]


@pytest.mark.parametrize("stem", SCRIPTS)
def test_a_script_says_what_it_found(stem):
    script = PAPER.scripts.executed("derivations", stem)
    found = [(r.title, r.text) for r in script.values_of(Remark)]
    assert found
    assert all(title and text.endswith(".") for title, text in found)
    assert faults_of(stem) == []


@pytest.mark.parametrize("stem", SCRIPTS)
def test_a_script_shows_each_step_and_says_what_it_is(stem):
    script = PAPER.scripts.executed("derivations", stem)
    steps = script.values_of(Step)
    assert len(steps) >= STEPWISE[stem]
    assert all(step.says for step in steps)
    assert "decide_zero" not in script.names
    most = max(sum(isinstance(value, Step) for value in cell.values) for cell in script.cells)
    assert most == 1  # one equation a cell


# A sign, a factor or a term of the library's or the script's side; each must stop the script. Slow: late in a long script.
MUTANTS = [
    ("t1_natural_rate", "2 * (a + b) * x_a + G_1 * v1", "2 * (a + b) * x_a - G_1 * v1"),
    ("t1_natural_rate", "2 * b * G_1 * G_2) / (2", "b * G_1 * G_2) / (2"),
    ("t2_shock_response", "prove(N**3, -squared * N", "prove(N**3, squared * N"),
    ("t3_paired_orbit", "- lambda_1 * x1 + tau * (k + x2)", "- lambda_1 * x1 + tau * (k - x2)"),
    ("t3_paired_orbit", "z1 - z2 - cosine + sigma * sine", "z1 - z2 - cosine"),
    ("t4_orbit_family", "al1_v: al2_v, al2_v: al1_v}", "al1_v: -al2_v, al2_v: -al1_v}"),
    ("t5_floquet", "3 * sigma * r0**4 / (8 * k**2)", "3 * sigma * r0**4 / (4 * k**2)"),
    pytest.param("t5_floquet", "sp.Rational(3, 16) * sigma**2", "sp.Rational(3, 8) * sigma**2", marks=pytest.mark.slow),
    ("t6_shock_drift", "(2 + att**2) * P_X**2 + att**2 * shape", "(2 - att**2) * P_X**2 + att**2 * shape"),
    ("t6_shock_drift", "-k * apart + (y1 - y2) ** 2 / 2", "-k * apart + (y1 - y2) ** 2"),
    pytest.param("t6_shock_drift", "- 87 * sigma) / (16", "- 78 * sigma) / (16", marks=pytest.mark.slow),
    ("t7_duration", "bracket = (2 * HALF**2 + SWING**2", "bracket = (2 * HALF**2 - SWING**2"),
    ("t7_duration", "2 * G * (HALF**2 + SWING**2 / 2) / k)", "2 * G * (HALF**2 + SWING**2) / k)"),
    ("t11_slow_motion", "- G * beta_v * h**3 * (sp.Rational(1, 3) +", "- G * beta_v * h**3 * (sp.Rational(1, 6) +"),
    ("t11_slow_motion", "sp.Rational(3, 8) * SWING**4) / c - kappa", "sp.Rational(1, 8) * SWING**4) / c - kappa"),
    pytest.param(
        "t11_slow_motion",
        "orbit_momentum = SWING**2 - (k**2",
        "orbit_momentum = SWING**2 + (k**2",
        marks=pytest.mark.slow,
    ),
    pytest.param("t12_unequal_spins", "law -= share**2", "law += share**2", marks=pytest.mark.slow),
    pytest.param(
        "t12_unequal_spins",
        "apart**3 * sigma**2 * (sigma - 5) / (16 * k)",
        "apart**3 * sigma**2 * (sigma - 5) / (8 * k)",
        marks=pytest.mark.slow,
    ),
    ("t12_unequal_spins", "slower = (sigma - 1) * ((sigma + 1)", "slower = (sigma - 1) * ((sigma - 1)"),
    ("t14_guiding_centre", "(G_1 - G_2) * sp.sin(h) ** 2 / k", "(G_1 + G_2) * sp.sin(h) ** 2 / k"),
    ("t14_guiding_centre", "u_v = -J * B.dot(slope)", "u_v = J * B.dot(slope)"),
    ("t15_return_maps", "(1 - turn ** (n - m))", "(1 - turn ** (m - n))"),
    ("t15_return_maps", "(3 * c + triple) / 8", "(3 * c - triple) / 8"),
    ("t8_toppling", "e = b * nu**2 - G * nu / k", "e = b * nu**2 + G * nu / k"),
    ("t8_toppling", "(-(G_1 + G_2) * nu, 0, 0)", "(0, 0, 0)"),
    ("t9_twist", "2 * mu_1 * mu_3 - mu_1**2 / 2", "2 * mu_1 * mu_3"),
    ("t9_twist", "prove(inertia, (a - b) / 2", "prove(inertia, (a + b) / 2"),
    ("t10_conserved", "tuple(I3 * spin for spin in spins)", "tuple(-I3 * spin for spin in spins)"),
]


@pytest.mark.parametrize(("stem", "right", "wrong"), MUTANTS)
def test_a_changed_step_is_refused(tmp_path: Path, stem: str, right: str, wrong: str) -> None:
    source = (PAPER.scripts.path("derivations", stem)).read_text()
    assert source.count(right) == 1
    changed = tmp_path / f"{stem}.py"
    changed.write_text(source.replace(right, wrong))
    with pytest.raises(ProofError):
        scripts.run_file(changed)
