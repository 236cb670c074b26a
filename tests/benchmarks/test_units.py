"""Times in units of importing sympy: a command is run, timed and laid beside the unit. No test asserts seconds."""

from pathlib import Path

import pytest

from benchmarks import units
from benchmarks.units import LONG, Command, line, measure, measured
from lagrotor.errors import LagrotorError

ROOT = Path(__file__).parent.parent.parent


def test_a_command_is_measured_in_units(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(units, "UNIT", ("-c", "pass"))
    row = measure(Command("nothing", ("-c", "import lagrotor"), 2, repeats=1), ROOT)
    assert row.wall > 0 and row.processor > 0 and row.memory > 1
    assert line(row).startswith("nothing ") and len(line(row).split()) == 5


def test_a_command_that_fails_is_no_measurement() -> None:
    with pytest.raises(LagrotorError, match="ended with 3: lost"):
        measured(("-c", "import sys; print('lost', file=sys.stderr); sys.exit(3)"), ROOT)


def test_the_copy_is_what_runs(tmp_path: Path) -> None:
    (tmp_path / "lagrotor.py").write_text("raise SystemExit(5)")
    with pytest.raises(LagrotorError, match="ended with 5"):
        measured(("-c", "import lagrotor"), tmp_path)


def test_a_derivation_is_changed_only_in_the_copy(tmp_path: Path) -> None:
    (changing,) = (command for command in LONG if command.prepare)
    script = Path("derivations", "s5_3b_opposite_spins.py")
    (tmp_path / "derivations").mkdir()
    (tmp_path / script).write_text((ROOT / script).read_text())
    assert changing.prepare is not None
    changing.prepare(tmp_path)
    assert (tmp_path / script).read_text() != (ROOT / script).read_text()
