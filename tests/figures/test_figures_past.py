"""Figures t1 to t10: what they show, on their own numbers."""

import pytest

from lagrotor.paper import scripts
from lagrotor.pictures import figures


def test_every_derivation_past_the_paper_has_its_figure():
    assert scripts.names("derivations", "t") == [stem for key, stem in figures.stems().items() if key.startswith("t")]


def test_what_they_show(script):
    """The point of the figures, on their own numbers."""
    measured = {key: script(key)["measure"]() for key in figures.stems() if key.startswith("t")}
    assert measured["t1"]["largest distance of the exact model (G/J)"] < 1e-4
    assert measured["t2"]["power of the force"] == pytest.approx(2, abs=0.02)
    for order in range(1, 10):
        assert measured["t3"][f"slope of order {order}"] == pytest.approx(order + 1, abs=0.1)
    assert measured["t6"]["cancelling force, exact runs (N)"] == pytest.approx(-11, abs=0.1)
    assert measured["t7"]["power of the force, x"] == pytest.approx(-3, abs=0.05)
    assert measured["t8"]["largest relative distance, measured growth"] < 0.01
    assert measured["t9"]["largest relative distance from Hill's equation"] < 1e-4
    assert measured["t10"]["largest swing of E, G_1, P, B"] < 1e-9
