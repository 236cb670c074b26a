"""The shell's scenes: the help alone, the paired start, a scene's file, a sweep, JSON everywhere."""

import json
from argparse import Namespace
from warnings import warn

import numpy as np
import pytest

from lagrotor import Scene, paired_scene, read_scene, simulate
from lagrotor.commands import command_line
from lagrotor.commands.command_line import main
from lagrotor.commands.terminal import Parser, wrap
from lagrotor.errors import LagrotorWarning

PAIR = ["--spins", "10", "-10"]


def test_a_bare_command_shows_its_help(capsys) -> None:
    assert main([]) == 0
    assert "usage: lagrotor" in capsys.readouterr().out


def test_the_paired_start_is_the_periodic_orbit(capsys, tmp_path) -> None:
    file = tmp_path / "scene.toml"
    asked = ["simulate", *PAIR, "--paired", "0.204", "--t-end", "1", "--samples", "3", "--json"]
    assert main([*asked, "--write-scene", str(file)]) == 0
    found = json.loads(capsys.readouterr().out)
    run = simulate(paired_scene(Scene(spins=(10, -10)), 0.204), np.linspace(0, 1, 3))
    assert found["tip_1"] == pytest.approx(run.tips[0, -1].tolist(), abs=1e-9)
    assert main(["simulate", "--scene", str(file), "--t-end", "1", "--samples", "3", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["tip_1"] == pytest.approx(found["tip_1"], abs=1e-12)
    assert read_scene(file).spins == (10, -10)


def test_a_sweep_is_the_runs_one_by_one(capsys) -> None:
    varied = ["sweep", *PAIR, "--vary", "paired", "--between", "0.1", "0.3", "3", "--t-end", "1"]
    assert main([*varied, "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["paired"] for row in rows] == pytest.approx([0.1, 0.2, 0.3])
    for row in rows:
        run = simulate(paired_scene(Scene(spins=(10, -10)), row["paired"]), [0, 1], tol=1e-10)
        assert row["tip_1"] == pytest.approx(run.tips[0, -1].tolist(), abs=1e-5)


def test_a_scene_in_a_file_is_whole_and_a_file_is_no_folder(capsys, tmp_path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text("spins = [10, -10]\n")
    for words, reason in (
        (
            ["simulate", "--scene", str(file), "--link-mass", "2"],
            "--scene and --link-mass: the file has the whole scene",
        ),
        (["figure", "1", "--out", str(file)], "is a file: give a folder"),
        (["pair", "--amplitude", "0.3"], "unrecognized arguments: --amplitude 0.3; see lagrotor pair --help"),
    ):
        assert main(words) == 2
        said = capsys.readouterr().err
        assert reason in said and said.count("\n") == 1


def test_a_warning_is_a_line(capsys, monkeypatch) -> None:
    class Command(Parser):
        def parse_args(self, *_: object) -> Namespace:
            return Namespace(run=lambda _: warn("tol is not kept", LagrotorWarning, stacklevel=2) or 0)

    monkeypatch.setattr(command_line, "_parser", Command)
    assert main(["simulate"]) == 0
    assert capsys.readouterr().err == "lagrotor: warning: tol is not kept\n"


def test_a_long_line_of_a_verdict_goes_on_under_its_text() -> None:
    first, *more = wrap(f"  wrong      {'word ' * 40}", 13).split("\n")
    assert first.startswith("  wrong      word") and len(more) == 2
    assert all(line.startswith(" " * 13 + "word") and len(line) <= 100 for line in more)
