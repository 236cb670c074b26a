"""The README is true: its Python runs, its table is that of the record, its commands exist."""

import re
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
    assert main(["init", "my-paper"]) == 0
    names: dict[str, object] = {}
    for block in blocks("python"):
        exec(block, names)
    assert (tmp_path / "run.npz").is_file()
    assert names["run"].tips.shape == (2, 1001, 3)  # type: ignore[attr-defined]


def test_the_shell_commands_are_understood(capsys: pytest.CaptureFixture[str], tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    lines = "\n".join(blocks("sh")).replace("\\\n", " ").splitlines()
    commands = [line.split("#")[0].split()[1:] for line in lines if line.startswith("lagrotor")]
    assert {c[0] for c in commands} >= {"init", "audit", "claims", "figure", "rate", "simulate"}
    (tmp_path / "paper.tex").write_text(r"\[ x = y \]", encoding="utf-8")
    for command in commands:
        if command[0] in ("init", "rate", "simulate") or "my-paper" in command:
            assert main(command) == 0
        else:
            assert main([command[0], "--help"]) == 0
    assert "11.428" in capsys.readouterr().out


def test_the_table_of_verdicts_is_the_record() -> None:
    from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

    for kind, pattern in (("equations", r"\d"), ("claims", "C")):
        counts = Counter(row.verdict for name, row in PAPER.recorded.items() if re.match(pattern, name))
        said = re.search(rf"\| {kind} \| (.*) \|", text())
        assert said, kind
        assert said[1] == ", ".join(f"{n} {verdict}" for verdict, n in counts.most_common())


def test_pictures_are_there() -> None:
    for picture in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text()):
        assert (ROOT / picture).is_file(), picture


def test_the_heavy_top_is_as_it_is_said() -> None:
    from lagrotor.paper import Paper

    top = Paper(ROOT / "papers" / "heavy_top")
    said = re.search(
        r"(\d+) equations, (\w+) of them misprinted on purpose and found, and (\w+) claims", " ".join(text().split())
    )
    assert said
    refuted = [name for name, row in top.recorded.items() if row.verdict == "refuted"]
    words = {"two": 2, "four": 4}
    assert (len(top.equations), len(refuted), len(top.claims)) == (int(said[1]), words[said[2]], words[said[3]])


def test_what_a_comment_says_of_a_verdict_is_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["init", "my-paper"]) == 0
    said = []
    for block in (block for block in blocks("python") if ".verdict  # " in block):
        names: dict[str, object] = {}
        exec(block, names)
        rows = re.findall(r"^(.*\.verdict)  # '([a-z-]+)'", block, flags=re.M)
        said += [(eval(line, names), verdict) for line, verdict in rows]
    assert len(said) == 2 and all(found == verdict for found, verdict in said)
