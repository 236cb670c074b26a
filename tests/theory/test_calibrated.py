"""Every number of the room that was found by trial names the test that holds it."""

from pathlib import Path

from lagrotor.theory import calibrated_factors

ROOT = Path(__file__).parents[2]


def test_every_calibrated_number_names_a_test_that_holds_it():
    assert len(calibrated_factors.TABLE) >= 5
    for name, row in calibrated_factors.TABLE.items():
        file, test = row.held_by.split("::")
        assert f"def {test}(" in (ROOT / file).read_text(), name
