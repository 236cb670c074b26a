"""The theory's scripts run, decide their steps, and say something."""

import pytest

from lagrotor.paper import scripts

STEMS = [stem for stem in scripts.names("derivations") if stem.startswith("t")]


@pytest.mark.parametrize("stem", STEMS)
def test_script(stem):
    names = scripts.run("derivations", stem)
    assert names["statements"] == []
    assert names["findings"]
    assert all(len(pair) == 2 and pair[1].endswith(".") for pair in names["findings"])
