"""Every number that was found by trial names the test that holds it."""

from importlib import import_module
from pathlib import Path

import pytest

import lagrotor
from lagrotor.numerics.solver_constants import Calibrated

PACKAGE = Path(lagrotor.__file__).parent
ROOMS = sorted(
    ".".join(("lagrotor", *path.relative_to(PACKAGE).with_suffix("").parts))
    for path in PACKAGE.rglob("*.py")
    if " = Calibrated(" in path.read_text()
)


@pytest.mark.parametrize("room", ROOMS)
def test_a_calibrated_number_names_the_test_that_holds_it(room: str) -> None:
    numbers = {name: entry for name, entry in vars(import_module(room)).items() if isinstance(entry, Calibrated)}
    assert numbers
    for name, entry in numbers.items():
        file, test = entry.test.split("::")
        assert any(f"def {test}(" in path.read_text() for path in Path(__file__).parent.rglob(file)), name


def test_every_room_that_has_such_numbers_is_seen() -> None:
    assert {"lagrotor.models.simulate", "lagrotor.theory.fitted_factors"} <= {*ROOMS}
