"""Robot files at the shell: equations in three formats, a simulation and its film, refusals in one line."""

import json
from pathlib import Path

import pytest

from lagrotor.commands.command_line import main

ROD = """<robot name="rod"><link name="base"/><link name="rod"><inertial><origin xyz="0 0 -0.5" rpy="0 0 1.5707963"/>
<mass value="2"/><inertia ixx="0.1" iyy="0.2" izz="0.2"/></inertial><visual/></link><joint name="hinge" type="continuous">
<parent link="base"/><child link="rod"/><origin xyz="0 0 1.25"/><axis xyz="0 1 0"/></joint></robot>"""
CHAIN = "<mujoco><worldbody>{}</worldbody></mujoco>"
for _number in range(7):
    _inside = f'<body pos="0 0 1"><joint name="q{_number}" axis="{_number % 2} 1 0"/><geom size="0.1"/>{{}}</body>'
    CHAIN = CHAIN.format(_inside)
CHAIN = CHAIN.format("")


@pytest.fixture
def rod(tmp_path: Path) -> str:
    (tmp_path / "rod_1.urdf").write_text(ROD)
    return str(tmp_path / "rod_1.urdf")


def test_equations_in_three_formats(rod: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The equation of motion is (I + m c²) q'' = m g c sin q, with I about the hinge's axis and c the centre on z."""
    assert main(["equations", rod]) == 0
    said = capsys.readouterr().out
    assert (
        r"\ddot{\mathrm{hinge}} \left(I_{\mathrm{rod} yy} + m_{\mathrm{rod}} c_{\mathrm{rod} z}^{2}\right)" in said
        and "- hinge: hinge" in said
    )
    assert "- shapes (visual, collision): 1" in said and "the angle 1.5707963 is read as pi/2" in said
    assert "- I_rod_yy = 0.1" in said and "E = T + V" in said
    assert main(["equations", rod, "--symbols", "none"]) == 0
    said = capsys.readouterr().out
    assert r"\frac{3 \, \ddot{\mathrm{hinge}}}{5}" in said and r"9.81" in said
    for name, words in (("a.tex", r"\section*{rod\_1.urdf}"), ("a.md", "# rod_1.urdf"), ("a.html", "<math")):
        assert main(["equations", rod, "--out", str(tmp_path / name)]) == 0
        assert words in (tmp_path / name).read_text()


def test_a_large_machine_says_what_is_left_out(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "chain.xml").write_text(CHAIN)
    assert main(["equations", str(tmp_path / "chain.xml")]) == 0
    said = capsys.readouterr().out
    assert "kinetic energy of 7 coordinates is not written out" in said and "lagrotor simulate" in said
    assert "m_body1 = 4.188790205" in said


def test_a_simulation_and_its_film(rod: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["simulate", rod, "--t-end", "0.4", "--samples", "11"]
    assert main([*command, "--start", "hinge=1", "hinge_dot=2", "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    energy = 0.6 * 2**2 / 2 + 2 * 9.81 * (1.25 - 0.5 * 0.5403023058681398)
    assert summary["energy_first"] == pytest.approx(energy) == summary["energy_last"]
    assert main(command) == 0  # at rest as the file says, where it hangs
    assert "hinge at the end" in (said := capsys.readouterr().out) and " 0.000000000" in said
    for name in ("rod.gif", "rod.csv", "rod.png"):
        assert main([*command, "--start", "hinge=1", "--out", str(tmp_path / name)]) == 0
        assert (tmp_path / name).stat().st_size > 100


REFUSED = {
    ("equations", "missing.urdf"): "No such file",
    ("equations", "ROD", "--out", "a.pdf"): "must end in .md, .tex, .html",
    ("equations", "ROD", "--symbols", "some"): "invalid choice",
    ("simulate", "ROD", "--spins", "1", "2"): "--spins belongs to a scene",
    ("simulate", "ROD", "--model", "spheres"): "--model belongs to a scene",
    ("simulate", "ROD", "--start", "hing=1"): ": hinge",
    ("simulate", "ROD", "--start", "hinge"): "write NAME=NUMBER",
    ("simulate", "ROD", "--start", "hinge=nan"): "write NAME=NUMBER",
    ("simulate", "ROD", "--out", "a.doc"): "the name must end in",
    ("simulate", "--start", "hinge=1"): "belong to a robot file",
    ("simulate", "CHAIN", "--base", "floating"): "an MJCF file says itself",
}


@pytest.mark.parametrize("words", REFUSED)
def test_refusals(words: tuple[str, ...], rod: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "chain.xml").write_text(CHAIN)
    files = {"ROD": rod, "CHAIN": str(tmp_path / "chain.xml")}
    assert main([files.get(word, word) for word in words]) == 2
    said = capsys.readouterr().err
    assert REFUSED[words] in said and said.count("\n") == 1


def test_export_writes_the_functions_of_a_robot(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "my-rod.urdf").write_text(ROD.replace("</joint>", '<dynamics friction="0.1"/></joint>'))
    assert main(["export", str(tmp_path / "my-rod.urdf"), "--to", "matlab", "--out", str(tmp_path / "out")]) == 0
    said = capsys.readouterr()
    files = [Path(line) for line in said.out.split()]
    assert said.err.splitlines() == ["not read: shapes (visual, collision): 1", "not read: dry friction of joints: 1"]
    assert files[0].name == "my_rod_rhs.m" and files[-1].name == "my_rod.json"
    assert {*files} == {*(tmp_path / "out").iterdir()}
