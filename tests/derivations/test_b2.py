"""The recorded speeds: complete, shown unchanged, and the same bytes each time they are read."""

import json

import pytest

from lagrotor.benchmark import records
from lagrotor.benchmark.scenes_and_methods import OURS
from lagrotor.errors import LagrotorError
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER


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
    assert told["minimal"]["divided by core, 1e-06"] == "1" != told["minimal"]["divided by any model, 1e-06"]
    assert len(rates.rows) == len(found["throughput"])


def test_a_broken_record_is_said(tmp_path, monkeypatch):
    broken = tmp_path / "recorded.json"
    monkeypatch.setattr(records, "SPEED", broken)
    with pytest.raises(LagrotorError, match="install lagrotor anew"):
        records.recorded_speed()
    broken.write_text("{")
    with pytest.raises(LagrotorError, match="install lagrotor anew"):
        records.recorded_speed()
    broken.write_text(json.dumps({"machine": {}}))
    assert records.recorded_speed() == {"machine": {}}
