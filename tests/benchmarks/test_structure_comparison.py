"""Chains of rotors beside engines: what is on record is shown, and a tool is timed at its coarsest setting that suffices."""

from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest

from benchmarks import structure_comparison
from benchmarks.structure_comparison import begun, staircase, tools
from lagrotor.benchmark.records import CHAIN_ERROR, CHAIN_SIZES, recorded_structures
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER


def test_the_table_is_the_record() -> None:
    record, found = recorded_structures()
    table = PAPER.scripts.run("derivations", "b4_chains_of_rotors")["table"]
    assert len(table.rows) == len(found) and record["machine"]["processor"] in table.note
    assert {x.n for x in found if x.tool == "lagrotor, fast"} == set(CHAIN_SIZES)
    assert all(x.error <= CHAIN_ERROR for x in found if x.seconds) and all(x.reason for x in found if not x.seconds)
    own = next(x for x in found if (x.n, x.tool) == (16, "lagrotor, fast"))
    row = next(row for row in table.rows if row[:2] == ("16", "lagrotor, fast"))
    assert row[4:6] == (f"{1e3 * own.seconds:.3g}", "1.0")


def test_the_coarsest_setting_that_suffices_is_taken() -> None:
    truth = np.zeros((2, 1, 3))
    runs = {1e-1: 1e-3, 1e-2: 5e-7, 1e-3: 1e-9}
    found = structure_comparison._reached(2, "tool", lambda setting: truth + runs[setting], tuple(runs), truth)
    assert (found.setting, found.error) == (1e-2, pytest.approx(5e-7))
    worse = structure_comparison._reached(2, "tool", lambda setting: truth + 1e-3, tuple(runs), truth)
    assert worse.error == pytest.approx(1e-3) and replace(worse, seconds=1.0).error > CHAIN_ERROR


def test_every_tool_that_is_there_runs_the_same_chain() -> None:
    truth = begun(staircase(3), 1e-11).tips
    for name, (run, settings) in tools(3).items():
        if name not in ("MuJoCo", "Drake, SAP") and (name != "lagrotor, fast" or find_spec("heyoka")):
            assert np.abs(run(settings[-1]) - truth).max() < 1e-7, name
