"""The README is true: its Python runs, its table is that of the record, its commands exist."""

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

import lagrotor
from lagrotor.commands.command_line import main

ROOT = Path(lagrotor.__file__).parent.parent
README = ROOT / "README.md"
pytestmark = pytest.mark.skipif(not README.is_file(), reason="installed without the README")


def text() -> str:
    return README.read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", text(), flags=re.S)


def test_the_python_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for block in blocks("python"):
        exec(block, names)
    assert (tmp_path / "run.npz").is_file()
    assert names["run"].tips.shape == (2, 1001, 3)  # type: ignore[attr-defined]


def test_the_shell_commands_are_understood(capsys: pytest.CaptureFixture[str], tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    lines = "\n".join(blocks("sh")).replace("\\\n", " ").splitlines()
    commands = [line.split("#")[0].split()[1:] for line in lines if line.startswith("lagrotor")]
    assert {c[0] for c in commands} >= {"audit", "claims", "figure", "rate", "simulate"}
    for command in commands:
        if command[0] in ("rate", "simulate"):
            assert main(command) == 0
        else:
            assert main([command[0], "--help"]) == 0
    assert "11.428" in capsys.readouterr().out


def test_the_table_of_verdicts_is_the_record() -> None:
    from lagrotor.paper.rotor_pair.own_paper import PAPER

    for kind, pattern in (("equations", r"\d"), ("claims", "C")):
        counts = Counter(row.verdict for name, row in PAPER.recorded.items() if re.match(pattern, name))
        said = re.search(rf"\| {kind} \| (.*) \|", text())
        assert said, kind
        assert said[1] == ", ".join(f"{n} {verdict}" for verdict, n in counts.most_common())


def test_importing_is_light() -> None:
    code = "import lagrotor, sys; print([m for m in ('sympy', 'matplotlib', 'scipy') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    heavy = subprocess.run(
        [sys.executable, "-c", code.replace("lagrotor, sys", "sympy, lagrotor, sys")],
        capture_output=True,
        text=True,
        check=True,
    )
    assert "sympy" in heavy.stdout


def test_pictures_are_there() -> None:
    for picture in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text()):
        assert (ROOT / picture).is_file(), picture
