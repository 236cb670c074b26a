"""The shells' completion knows what the parsers take."""

import shutil
import subprocess

import pytest

from lagrotor.commands.command_line import main


def script(shell: str, capsys: pytest.CaptureFixture[str]) -> str:
    """What the command prints."""
    assert main(["completion", shell]) == 0
    return capsys.readouterr().out


def completed(words: str, text: str) -> list[str]:
    """What bash offers after these words."""
    typed = words.split(" ")
    asks = f"COMP_WORDS=({' '.join(map(repr, typed))}); COMP_CWORD={len(typed) - 1}; _lagrotor; echo ${{COMPREPLY[@]}}"
    ran = subprocess.run(["bash", "-c", f"{text}\n{asks}"], capture_output=True, text=True, check=True)
    return ran.stdout.split()


def test_bash_completes_commands_options_and_choices(capsys: pytest.CaptureFixture[str]) -> None:
    if shutil.which("bash") is None:
        pytest.skip("no bash is installed")
    text = script("bash", capsys)
    assert completed("lagrotor aud", text) == ["audit"]
    assert completed("lagrotor judge --g", text) == ["--given"]
    assert completed("lagrotor completion f", text) == ["fish"]
    assert "paired" in completed("lagrotor sweep --vary p", text)
    assert completed("lagrotor audit --given", text) == []


def test_fish_and_zsh_are_told_the_same_commands(capsys: pytest.CaptureFixture[str]) -> None:
    fish, zsh = script("fish", capsys), script("zsh", capsys)
    assert "-a judge -d 'judge one equation'" in fish and "seen_subcommand_from judge' -l given" in fish
    assert zsh.startswith("autoload") and "    judge) words=" in zsh
