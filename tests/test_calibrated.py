"""Every number that was found by trial names the test that holds it."""

from pathlib import Path

import pytest

from lagrotor.benchmark import chart_constants
from lagrotor.numerics import calibrated
from lagrotor.numerics.calibrated import Calibrated
from lagrotor.theory import calibrated_factors


@pytest.mark.parametrize("room", [calibrated, calibrated_factors, chart_constants])
def test_a_calibrated_number_names_the_test_that_holds_it(room) -> None:
    numbers = {name: entry for name, entry in vars(room).items() if isinstance(entry, Calibrated)}
    assert numbers
    for name, entry in numbers.items():
        file, test = entry.held_by.split("::")
        assert any(f"def {test}(" in path.read_text() for path in Path(__file__).parent.rglob(file)), name
