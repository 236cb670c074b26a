"""The table of what doubling a chain costs: its form, on short chains; the times are read, not asserted."""

import numpy as np
import pytest

from benchmarks import doublings
from benchmarks.doublings import BARS, table, times
from benchmarks.structure_comparison import staircase


@pytest.fixture(autouse=True)
def few_evaluations(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doublings, "_ROTORS", 600)


def test_each_kind_of_bar_has_a_line_with_a_ratio_for_each_doubling() -> None:
    head, *lines = table((2, 4, 8), 1).splitlines()
    assert head.split()[1:3] == ["4", "8"]
    assert [line.split(",")[0] for line in lines if "core" in line] == list(BARS)
    assert all(np.isfinite([float(x) for x in line.split()[2:]]).all() for line in lines)


def test_each_structure_has_its_time() -> None:
    found = times([staircase(2), staircase(512)], "core", 1)
    assert found.shape == (2,) and (found > 0).all()
