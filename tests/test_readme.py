"""The README is true: what it shows is what is printed, its table is that of the record; the pages that go on run."""

import doctest
import re
import shlex
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


def blocks(language: str, page: Path = README) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.S)


def outputs(block: str) -> list[tuple[str, str]]:
    """The commands of a block of a shell, each with the output that is shown."""
    return [
        (command, shown.strip("\n")) for command, _, shown in (each.partition("\n") for each in block.split("$ ")[1:])
    ]


@pytest.mark.parametrize(("command", "shown"), [row for block in blocks("console") for row in outputs(block)])
def test_a_command_prints_what_is_shown(command: str, shown: str, capsys: pytest.CaptureFixture[str]) -> None:
    """A line of three dots stands for any lines."""
    assert main(shlex.split(command)[1:]) == 0
    printed = capsys.readouterr().out
    parts = [part.strip("\n") for part in re.split(r"^\.\.\.$", shown, flags=re.MULTILINE)]
    assert any(parts) and all(part in printed for part in parts)


def test_the_python_prints_what_is_shown() -> None:
    ran = doctest.testfile(str(README), module_relative=False, encoding="utf-8")
    assert ran.attempted > 5 and not ran.failed


def test_it_is_short() -> None:
    assert len(text().splitlines()) <= 120


PAGES = {name: ROOT / "docs" / f"{name}.md" for name in ("pairs", "systems", "papers")}


@pytest.mark.parametrize("page", PAGES)
def test_the_python_of_a_page_runs(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["init", "my-paper"]) == 0
    names: dict[str, object] = {}
    for block in blocks("python", PAGES[page]):
        exec(block, names)
        rows = re.findall(r"^(.*\.verdict)  # '([a-z-]+)'", block, flags=re.M)
        assert all(eval(line, names) == verdict for line, verdict in rows)
    assert page != "pairs" or (tmp_path / "run.npz").is_file()


def test_the_shell_commands_are_understood(capsys: pytest.CaptureFixture[str], tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    shell = [block for page in PAGES.values() for block in blocks("sh", page)]
    lines = "\n".join(shell).replace("\\\n", " ").splitlines()
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
        r"(\d+) equations, (\w+) of them misprinted on purpose and found, and (\w+) claims",
        " ".join(PAGES["papers"].read_text(encoding="utf-8").split()),
    )
    assert said
    refuted = [name for name, row in top.recorded.items() if row.verdict == "refuted"]
    words = {"two": 2, "four": 4}
    assert (len(top.equations), len(refuted), len(top.claims)) == (int(said[1]), words[said[2]], words[said[3]])
