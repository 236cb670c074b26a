"""A figure's script, run once, with its picture and the numbers that its claims are read off."""

from functools import cache, cached_property
from typing import Any

import pytest

from lagrotor.drawing import paper_style
from lagrotor.drawing.style import letter_panels
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.pictures import figures


class Drawn:
    """The names of one script; data, measured numbers and picture are computed once, when first used."""

    def __init__(self, key: str) -> None:
        self.names = PAPER.scripts.run("figures", figures.stems(PAPER.scripts)[key])

    @cached_property
    def data(self) -> dict[str, Any]:
        found = self.names["data"]()
        return found if isinstance(found, dict) else vars(found)

    @cached_property
    def measured(self) -> dict[str, float]:
        return self.names["measure"]() if "measure" in self.names else {}

    @cached_property
    def picture(self) -> Any:
        with paper_style():
            return letter_panels(self.names["figure"]())

    def constants(self) -> dict[str, Any]:
        return {name: value for name, value in self.names.items() if name.isupper()}

    def facts(self) -> dict[str, Any]:
        """The script's constants, what it draws and what it measures, name → value."""
        return self.constants() | self.data | self.measured

    def changed_facts(self, name: str, change: Any) -> dict[str, Any]:
        """The same with one array changed before it is drawn and measured."""
        data = self.data | {name: change(self.data[name].copy())}
        kept = self.names["data"]
        if not isinstance(kept(), dict):
            return self.constants() | data
        self.names["data"] = lambda: data
        try:
            return self.constants() | data | (self.names["measure"]() if "measure" in self.names else {})
        finally:
            self.names["data"] = kept


@pytest.fixture(scope="session")
def drawn():
    """key → its figure."""
    return cache(lambda key: Drawn(str(key)))
