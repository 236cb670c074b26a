"""The table of ratios: its pairs, its interpolation at equal error, and the checks of the work. No test asserts seconds."""

from itertools import islice
from math import inf
from pathlib import Path

import numpy as np
import pytest

from benchmarks.mechanisms.chains import VALUES, chain
from benchmarks.ratios import pairs, processes, rods, runs
from benchmarks.ratios.pairs import HEAD, Row, at_equal_error, measured
from benchmarks.ratios.processes import change_derivation, copied, run_python
from benchmarks.scenes import SCENES
from lagrotor.errors import LagrotorError

ROOT = Path(__file__).parent.parent.parent


def test_a_row_is_the_median_of_the_ratios_of_its_pairs() -> None:
    times = [(2.0, 1.0), (30.0, 10.0), (1.0, 4.0), (9.0, 1.0)]
    row = Row("work", "a rival", 2.0, lambda: iter(times), 3)
    assert measured(row).split() == ["work", "a", "rival", "2", "2", "0.25", "to", "3", "3"]
    assert measured(row, 4).endswith("4  missed") and "2.5" in measured(row, 4)
    assert measured(Row("work", "s", inf, lambda: iter(times), 1)).split()[2:4] == ["—", "2"]
    assert len(HEAD.split()) == 8


@pytest.mark.parametrize(
    ("error", "expected"),
    [
        (1e-4, 10.0),  # the error of a tolerance
        (1e-5, 10**1.5),  # between two, as on a chart with logarithmic axes
        (1e-6, 100.0),
        (1.0, 1.0),  # larger than every error: the coarsest
        (1e-12, 100.0),  # smaller than every error: the most exact, which favours the rival
    ],
)
def test_the_rivals_time_is_interpolated_at_our_error(
    error: float, expected: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    spent = {1e-1: 1.0, 1e-2: 10.0, 1e-3: 100.0, 1e-4: 1000.0}
    order = list[float]()

    def rival(tol: float) -> float:
        order.append(tol)
        return spent[tol]

    def ours() -> float:
        order.append(0.0)
        return 7.0

    monkeypatch.setattr(pairs, "seconds", lambda call: call())
    errors = {1e-1: 1e-2, 1e-2: 1e-4, 1e-3: 1e-6, 1e-4: 1e-5}  # rounding spoils the last
    taken = at_equal_error(ours, error, rival, errors, 1e-6)
    assert [next(taken), next(taken)] == [(7.0, pytest.approx(expected))] * 2
    assert order[: len(order) // 2] == order[len(order) // 2 :] and order[0] == 0.0  # they take turns


def test_a_rival_that_misses_what_is_asked_for_is_no_rival() -> None:
    with pytest.raises(LagrotorError, match=r"the rival reaches 0\.01 at best"):
        next(at_equal_error(lambda: None, 1e-4, lambda tol: None, {1e-1: 1e-2}, 1e-3))


@pytest.mark.parametrize("periods", [2])
def test_a_short_run_is_compared_at_equal_error(periods: int, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("heyoka")
    monkeypatch.setattr(pairs, "_SAMPLE", 1e-9)
    assert all(x > 0 for pair in islice(runs.short_run(periods, 1e-6), 2) for x in pair)
    assert all(x > 0 for pair in islice(runs.sweep_and_lanes(3, 1e-6), 1) for x in pair)
    monkeypatch.setattr(runs, "heyoka_lanes", lambda scenes, *given: runs._starts(scenes))
    with pytest.raises(LagrotorError, match="the references: the benchmark did not do its work"):
        next(runs.sweep_and_lanes(3, 1e-6))


def test_a_sweep_of_an_older_checkout_runs_its_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "DURATION", 1.0)
    own, other = next(runs.sweep_and_older(2, 1e-6, ROOT))
    assert own > 0 and other > 0
    (tmp_path / "lagrotor.py").write_text("raise SystemExit(5)")
    with pytest.raises(LagrotorError, match="ended with 5"):
        next(runs.sweep_and_older(2, 1e-6, tmp_path))


@pytest.mark.parametrize("kind", SCENES)
def test_auto_is_compared_on_scenes_that_move(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pairs, "_SAMPLE", 1e-9)
    assert all(x > 0 for x in next(runs.auto_and_chosen(kind, "core")))
    assert SCENES[kind](1.0) != SCENES[kind](1.001)


def test_the_accelerations_of_rods_are_derived_in_two_ways() -> None:
    y = np.random.default_rng(0).uniform(-1, 1, 8)
    derived = np.asarray(chain("rods", 4).rhs(VALUES)(0.0, y))[4:]
    assert rods.accelerations(y[:4], y[4:]) == pytest.approx(derived, rel=1e-11)
    assert rods.accelerations(y[:4], 1.001 * y[4:]) != pytest.approx(derived, rel=1e-5)
    assert rods.ready(3) > 0


def test_a_process_that_fails_or_does_not_do_its_work_is_no_measurement(tmp_path: Path) -> None:
    assert run_python(("-c", "print('holds')"), ROOT, "holds").processor > 0
    with pytest.raises(LagrotorError, match=r"ended with 3.*lost"):
        run_python(("-c", "import sys; print('lost', file=sys.stderr); sys.exit(3)"), ROOT)
    with pytest.raises(LagrotorError, match="should print 'holds': refuted"):
        run_python(("-c", "print('refuted')"), ROOT, "holds")
    (tmp_path / "lagrotor.py").write_text("raise SystemExit(5)")
    with pytest.raises(LagrotorError, match="ended with 5"):  # the folder's code is what runs
        run_python(("-c", "import lagrotor"), tmp_path)


@pytest.mark.parametrize("lost", ["derivation", "figure"])
def test_a_report_that_lost_a_page_or_a_figure_is_no_measurement(
    lost: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder in ("derivations", "figures"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / f"{folder[:1]}1.py").touch()
    shown = {"derivation": "derivation-d1", "figure": "f1.png"}

    def made(arguments: object, folder: Path, *, cache: Path) -> processes.Used:
        (folder / "report" / "figures").mkdir(parents=True)
        (folder / "report" / "index.html").write_text(f'<p id="{shown["derivation"]}">')
        (folder / "report" / "figures" / shown["figure"]).touch()
        return processes.Used(3.0, 0.0, "")

    monkeypatch.setattr(processes, "ROOT", tmp_path)
    monkeypatch.setattr(processes, "run_python", made)
    assert next(processes.reproduce(tmp_path)) == (3.0, 3.0)
    shown[lost] = "other"
    with pytest.raises(LagrotorError, match=f"does not show {lost[:1]}1"):
        next(processes.reproduce(tmp_path))


def test_a_derivation_is_changed_only_in_the_copy() -> None:
    name = Path("derivations", "s5_3b_opposite_spins.py")
    before = (ROOT / name).read_text()
    with copied(ROOT) as folder:
        assert not (folder / ".git").exists() and not list(folder.glob(".venv*"))
        change_derivation(folder / name, 3)
        assert (folder / name).read_text().removeprefix(before).split() == [
            "#",
            "%%",
            "changed",
            "=",
            "3",
            "#",
            "%%",
            "[markdown]",
            "#",
            "Change",
            "number",
            "3.",
        ]
    assert (ROOT / name).read_text() == before and not folder.exists()


def test_the_table_has_the_rows_that_are_wanted() -> None:
    rows = [*runs.rows(ROOT), *processes.rows(), *processes.whole_rows(ROOT)]
    names = [row.name for row in rows]
    assert len(set(names)) == len(names) and max(map(len, names)) < 58
    for words in (
        "sweep, fast",
        "sweep, core",
        "run of 10 periods",
        "run of 200",
        "auto",
        "64 rods",
        "100 rods",
        "32 rods",
    ):
        assert any(words in name for name in names)
    for words in ("audit 5.22", "judge", "rate", "from nothing", "one derivation changed", "the tests"):
        assert any(words in name for name in names)
    alone = {row.name for row in (*runs.rows(None), *processes.rows(), *processes.whole_rows(None))}
    assert set(names) - alone == {name for name in names if "sweep, core" in name or "from nothing" in name}
