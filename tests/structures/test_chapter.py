"""The chapter's scripts run, prove their steps, and say what they found; a wrong step is refused."""

import pytest

from lagrotor.errors import ProofError
from lagrotor.paper import Remark, Step, scripts
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from tests.report.derivation_faults import faults_of

AFTER_RUNS = pytest.mark.slow  # the step stands after exact runs of the script
# Their numbers are held in test_standing, test_chern, test_resonances, test_nonlinear_waves and test_precession_law.
LONG = ("n1_standing", "n5_chern", "n6_resonances", "n7_nonlinear_waves", "n9_precessions")
STEMS = [
    pytest.param(stem, marks=AFTER_RUNS) if stem in LONG else stem for stem in PAPER.scripts.names("derivations", "n")
]
# A sign, a factor or a term; each must stop the script.
MUTANTS = [
    ("n1_standing", "(G_1**2 + G_2**2) * s**2)", "(G_1**2 - G_2**2) * s**2)"),
    ("n1_standing", "(G_1 * G_3 - G_2 * G_4) ** 2", "(G_1 * G_3 + G_2 * G_4) ** 2"),
    ("n2_shaken", "(4 - 3 * d)", "(4 - 2 * d)"),
    ("n2_shaken", "(r + 2) * (3 * r + 2) / form", "(r + 2) * (3 * r + 1) / form"),
    pytest.param(
        "n4_damped",
        "-G_0 * r_0**2 / (k * (a - b)) * (G_0 / G - 1)",
        "G_0 * r_0**2 / (k * (a - b)) * (G_0 / G - 1)",
        marks=AFTER_RUNS,
    ),
    ("n5_chern", "(mu**2 - omega**2 * G**2 - quarter)", "(mu**2 - omega**2 * G**2 + quarter)"),
    pytest.param("n5_chern", "((0, 2), sp.sqrt(2))", "((0, 2), 1)", marks=AFTER_RUNS),
    ("n3_waves", "4 * (sp.sin(q) ** 2 - c**2 + c", "4 * (sp.sin(q) ** 2 + c**2 + c"),
    ("n3_waves", "closed = np.sqrt(3) * free", "closed = np.sqrt(2) * free"),
    ("n4_damped", "(2 * (a * s + c) ** 2 + G_1", "(2 * (a * s - c) ** 2 + G_1"),
    (
        "n6_resonances",
        "P, P_bar = c * sp.Mul(*z), c * sp.Mul(*w)",
        "P, P_bar = c * z[0] * z[1] * w[2], c * w[0] * w[1] * z[2]",
    ),
    ("n6_resonances", "p_2: -sp.cos(2", "p_2: sp.cos(2"),
    ("n7_nonlinear_waves", "(c + f * b + B * b**2 / 2)", "(c + f * b + B * b**2)"),
    pytest.param("n7_nonlinear_waves", "z[2] * w[1] / g[0], i", "z[2] * z[1] / g[0], i", marks=AFTER_RUNS),
    ("n8_fast_spins", "sp.sqrt(kappa * (kappa + 3 * k)) / G", "sp.sqrt(kappa * (kappa + 2 * k)) / G"),
    ("n9_precessions", "[-i * added.diff(u_bar), i *", "[-i * added.diff(u_bar), -i *"),
    ("n1_standing", "G / 2 * (y * x_v - x * y_v)", "G * (y * x_v - x * y_v)"),
]


@pytest.mark.parametrize("stem", STEMS)
def test_a_script_proves_and_says_what_it_found(stem: str) -> None:
    script = PAPER.scripts.executed("derivations", stem)
    found, steps = script.values_of(Remark), script.values_of(Step)
    assert found and all(remark.title and remark.text.endswith(".") for remark in found)
    assert faults_of(stem) == []
    assert len(steps) >= 5 and all(step.says for step in steps)


@pytest.mark.parametrize(("stem", "old", "new"), MUTANTS)
def test_a_wrong_step_is_refused(stem: str, old: str, new: str, tmp_path) -> None:
    text = PAPER.scripts.path("derivations", stem).read_text(encoding="utf-8")
    assert text.count(old) == 1
    path = tmp_path / f"{stem}.py"
    path.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises((ProofError, AssertionError)):
        scripts.run_file(path)
