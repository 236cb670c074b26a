"""The theory's scripts run, prove their steps, and say something; a wrong step is refused."""

from pathlib import Path

import pytest

from lagrotor.errors import ProofError
from lagrotor.paper import scripts
from lagrotor.paper.notebook import Remark
from lagrotor.paper.proof import Step

STEMS = [stem for stem in scripts.names("derivations") if stem.startswith("t")]
STEPWISE = ["t1_normal_modes", "t2_shock_response", "t6_shock_drift", "t7_duration", "t8_toppling", "t9_twist"]


@pytest.mark.parametrize("stem", STEMS)
def test_a_script_says_what_it_found(stem):
    script = scripts.executed("derivations", stem)
    found = [(r.title, r.text) for r in script.shown(Remark)] + script.names.get("findings", [])
    assert found
    assert all(title and text.endswith(".") for title, text in found)


@pytest.mark.parametrize("stem", STEPWISE)
def test_a_script_shows_each_step_and_says_what_it_is(stem):
    script = scripts.executed("derivations", stem)
    steps = script.shown(Step)
    assert len(steps) >= 8
    assert all(step.says for step in steps)
    assert "decide_zero" not in script.names
    most = max(sum(isinstance(value, Step) for value in cell.shown) for cell in script.cells)
    assert most == 1  # one equation a cell


# A sign, a factor or a term of the library's or the script's side; each must stop the script.
MUTANTS = [
    ("t1_normal_modes", "2 * (a + b) * x_a + G_1 * v1", "2 * (a + b) * x_a - G_1 * v1"),
    ("t1_normal_modes", "2 * b * G_1 * G_2) / (2", "b * G_1 * G_2) / (2"),
    ("t2_shock_response", "prove(N**3, -squared * N", "prove(N**3, squared * N"),
    ("t2_shock_response", "prove(M * S, C * D", "prove(M * S, -C * D"),
    ("t6_shock_drift", "(2 + att**2) * P_X**2 + att**2 * sigma", "(2 - att**2) * P_X**2 + att**2 * sigma"),
    ("t6_shock_drift", "-k * apart + (y1 - y2) ** 2 / 2", "-k * apart + (y1 - y2) ** 2"),
    ("t7_duration", "(P - G * Delta**2 / (2 * k)) / (2 * A)", "(P + G * Delta**2 / (2 * k)) / (2 * A)"),
    ("t7_duration", "- att**2 * b / D)", "+ att**2 * b / D)"),
    ("t8_toppling", "e = b * nu**2 - G * nu / k", "e = b * nu**2 + G * nu / k"),
    ("t8_toppling", "(-(G_1 + G_2) * nu, 0, 0)", "(0, 0, 0)"),
    ("t9_twist", "2 * mu_1 * mu_3 - mu_1**2 / 2", "2 * mu_1 * mu_3"),
    ("t9_twist", "prove(inertia, (a - b) / 2", "prove(inertia, (a + b) / 2"),
]


@pytest.mark.parametrize(("stem", "right", "wrong"), MUTANTS)
def test_a_changed_step_is_refused(tmp_path: Path, stem: str, right: str, wrong: str) -> None:
    source = (scripts.folder("derivations") / f"{stem}.py").read_text()
    assert source.count(right) == 1
    changed = tmp_path / f"{stem}.py"
    changed.write_text(source.replace(right, wrong))
    with pytest.raises(ProofError):
        scripts.run_file(changed)
