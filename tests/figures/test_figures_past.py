"""Figures t1 to t10: their structure, and what they plot against committed samples.

`plotted_past.json` holds seven samples of every array of each script's `data()`. Renew it, after looking at the new
pictures, with `python tests/figures/test_figures_past.py`.
"""

import json
import runpy
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from lagrotor.paper import scripts
from lagrotor.report import figures
from lagrotor.report.style import paper_style

COMMITTED = Path(__file__).with_name("plotted_past.json")
PANELS = {"t1": 2, "t2": 3, "t3": 2, "t4": 3, "t5": 2, "t6": 2, "t7": 2, "t8": 2, "t9": 2, "t10": 2}
UNITS = {"m", "rad", "s", "N", "rad/s", "1/s", "1", "kg", "kg m²"}
# What is rounding and step error of a run is another number on another machine.
NOISE = {("t10", name) for name in ("E", "G_1", "P", "B")} | {("t3", "errors")}
SAMPLES, TOLERANCE = 7, 1e-5


@cache
def script(key):
    return scripts.run("figures", figures.stems()[key])


def sampled(data):
    """Name → (shape, range, samples spread evenly over the flattened array)."""
    found = {}
    for name, values in data.items():
        flat = np.ravel(values)
        places = np.linspace(0, flat.size - 1, SAMPLES).astype(int)
        samples = [float(value) for value in flat[places]]
        found[name] = {"shape": list(np.shape(values)), "range": float(np.ptp(flat)), "samples": samples}
    return found


def scale(kept):
    """The range of an array, or its size where it is constant."""
    return max(kept["range"], max(map(abs, kept["samples"])) if kept["range"] < 1e-9 else 0.0)


def differences(key, found, kept):
    """What is not as committed: names, shapes, samples off by more than TOLERANCE of the range."""
    if found.keys() != kept.keys():
        return sorted(found.keys() ^ kept.keys())
    wrong = []
    for name, now in found.items():
        then = kept[name]
        far = np.abs(np.subtract(now["samples"], then["samples"])).max() > TOLERANCE * scale(then)
        if now["shape"] != then["shape"] or (far and (key, name) not in NOISE):
            wrong.append(name)
    return wrong


@pytest.fixture(scope="module")
def committed():
    return json.loads(COMMITTED.read_text())


def test_every_script_is_here():
    assert [key for key in figures.stems() if figures.past(key)] == list(PANELS)
    assert scripts.names("derivations", "t") == [figures.stems()[key] for key in PANELS]


@pytest.mark.parametrize("key", PANELS)
def test_data_is_as_committed(key, committed):
    assert differences(key, sampled(script(key)["data"]()), committed[key]) == []


@pytest.mark.parametrize("key", PANELS)
def test_perturbed_data_is_noticed(key, committed):
    """The twin that must fail: one sample of one array is off by 1e-4 of its range."""
    for name in committed[key]:
        moved = json.loads(json.dumps(committed[key]))
        moved[name]["samples"][3] += 1e-4 * scale(moved[name])
        expected = [] if (key, name) in NOISE else [name]
        assert differences(key, moved, committed[key]) == expected


@pytest.mark.parametrize("key", PANELS)
def test_text(key):
    found = script(key)
    assert found["TITLE"]
    assert 100 < len(found["CAPTION"]) < 1200
    assert "nan" not in found["CAPTION"]
    assert 150 < len(found["ALT"]) < 700
    assert found["ALT"].endswith(".")
    assert all(np.isfinite(value) for value in found["measure"]().values())


@pytest.mark.parametrize("key", PANELS)
def test_structure(key):
    """Panels with titles, units in square brackets on both axes, one legend outside the panels."""
    with paper_style():
        picture = script(key)["figure"]()
    assert len(picture.axes) == PANELS[key]
    assert picture.get_suptitle() == script(key)["TITLE"]
    for panel in picture.axes:
        assert panel.get_title()
        for label in (panel.get_xlabel(), panel.get_ylabel()):
            assert label.endswith("]") and label.rpartition("[")[2][:-1] in UNITS
        assert panel.get_legend() is None
    (legend,) = picture.legends
    labels = [text.get_text() for text in legend.get_texts()]
    assert len(labels) == len(set(labels)) >= 2
    assert all(labels)


def test_what_they_show():
    """The point of the figures, on their own numbers."""
    measured = {key: script(key)["measure"]() for key in PANELS}
    assert measured["t1"]["largest distance of the exact model (G/J)"] < 1e-4
    assert measured["t2"]["power of the force"] == pytest.approx(2, abs=0.02)
    for order in range(1, 10):
        assert measured["t3"][f"slope of order {order}"] == pytest.approx(order + 1, abs=0.1)
    assert measured["t6"]["cancelling force, exact runs (N)"] == pytest.approx(-11, abs=0.1)
    assert measured["t7"]["power of the force, x"] == pytest.approx(-3, abs=0.05)
    assert measured["t8"]["largest relative distance, measured growth"] < 0.01
    assert measured["t9"]["largest relative distance from Hill's equation"] < 1e-4
    assert measured["t10"]["largest swing of E, G_1, P, B"] < 1e-9


if __name__ == "__main__":
    stems = figures.stems()
    now = {n: sampled(runpy.run_path(str(scripts.folder("figures") / f"{stems[n]}.py"))["data"]()) for n in PANELS}
    COMMITTED.write_text(json.dumps(now, indent=1) + "\n")
