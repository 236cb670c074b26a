"""The recorded speeds: complete, shown unchanged, and the same bytes each time they are read."""

import json
from pathlib import Path
from runpy import run_path

import pytest

from lagrotor.benchmark import records
from lagrotor.benchmark.scenes_and_methods import METHODS, OURS
from lagrotor.errors import LagrotorError
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

ROOT = Path(__file__).parent.parent.parent


@pytest.fixture(scope="module")
def made():
    return PAPER.scripts.run("derivations", "b2_seconds")


def test_the_tables_are_the_record(made):
    found, (times, multiples, rates) = records.recorded_speed(), made["tables"]
    row = next(row for row in times.rows if row[0] == "minimal")
    assert row[1] == f"{1e3 * found['at_error']['1e-06']['minimal']:.3g}"
    assert all(len(row) == len(times.head) for row in times.rows)
    told = {row[0]: dict(zip(multiples.head, row, strict=True)) for row in multiples.rows}
    for best in OURS:  # each is one of itself
        assert told[f"best of {best}"][f"divided by {best}, 1e-06"] == "1"
    minimal = told["minimal"]
    assert 1 <= float(minimal["divided by core, 1e-06"]) < float(minimal["divided by any model, 1e-06"])
    assert len(rates.rows) == len(found["throughput"])


@pytest.mark.parametrize("older", [True, False])
def test_the_page_says_what_others_do_faster_and_by_how_much_they_miss_their_tolerance(older, tmp_path, monkeypatch):
    found = records.recorded_speed()
    errors = found["at_error"]
    for at in errors.values():
        at |= {name: None for name in at.keys() - METHODS.keys() if not name.startswith("best of ")}  # the record's own
    errors["1e-06"]["heyoka alone"] = errors["1e-06"]["best of fast"] / 2
    errors["1e-08"]["heyoka alone"] = 2 * errors["1e-08"]["best of fast"]
    for error in ("1e-10", "1e-12", "1e-13"):
        errors[error]["heyoka alone"] = None
    found["least_error"]["heyoka alone"] = 1e-9
    found["error_over_tolerance"] = {"heyoka alone": 1234.5, "Drake, SAP": None}
    found["digest"] = records.code_digests("speed")
    if older:
        del found["error_over_tolerance"], found["digest"]
    monkeypatch.setitem(records.FILES, "speed", tmp_path / "recorded.json")
    records.FILES["speed"].write_text(json.dumps({"digest": None} | found))
    times, multiples, _ = run_path(str(ROOT / "derivations" / "b2_seconds.py"))["tables"]
    row = dict(zip(times.head, next(row for row in times.rows if row[0] == "heyoka alone"), strict=True))
    assert row["largest error / tolerance"] == ("—" if older else "1.2e+03")
    slower = "For an error of 1e-06 m the time of the fast extra is 2 times the time of heyoka alone."
    assert slower in multiples.note and "error of 1e-08 m the" not in multiples.note
    assert times.note.endswith("is not on record." if older else "with the present code.")


def test_a_broken_record_is_said(tmp_path, monkeypatch):
    broken = tmp_path / "recorded.json"
    monkeypatch.setitem(records.FILES, "speed", broken)
    with pytest.raises(LagrotorError, match="install lagrotor anew"):
        records.recorded_speed()
    broken.write_text("{")
    with pytest.raises(LagrotorError, match="install lagrotor anew"):
        records.recorded_speed()
    broken.write_text(json.dumps({"machine": {}}))
    assert records.recorded_speed() == {"machine": {}}
