"""The paper's figures and those past it: how each is built, its text, and what it plots against committed samples.

`plotted_setup.json` (figures 1 to 16), `plotted_theory.json` (17 to 28) and `plotted_past.json` (t1 to t10) hold samples
of every array of a script's `data()`. Renew them, after looking at the new pictures, with
`python tests/figures/test_plotted.py`.
"""

import json
from pathlib import Path

import numpy as np
import pytest

from lagrotor.drawing.style import paper_style
from lagrotor.paper import scripts
from lagrotor.pictures import figures

FILES = {name: Path(__file__).with_name(f"plotted_{name}.json") for name in ("setup", "theory", "past")}
KEPT = {name: json.loads(file.read_text(encoding="utf-8")) for name, file in FILES.items()}
COMMITTED = {key: arrays for kept in KEPT.values() for key, arrays in kept.items()}
TOLERANCES = {key: 1e-5 if name == "past" else 1e-6 for name, kept in KEPT.items() for key in kept}  # of the range
SAMPLES = 7
# What is rounding and step error of a run is another number on another machine.
NOISE = {("t10", name) for name in ("E", "G_1", "P", "B")} | {("t3", "errors")}

DIAGRAMS = {"1": 1, "2": 1, "3": 1, "4": 1, "5": 1, "6": 1, "7": 4, "14": 1, "15": 1}  # key → panels, without axes
PLOTS = {  # key → panels, entries of the legend
    **{"8": (3, 2), "9": (1, 2), "10": (2, 2), "11": (3, 4), "12": (3, 4), "13": (3, 4), "16": (1, 0)},
    **{"17": (3, 6), "18": (2, 5), "19": (2, 5), "20": (2, 5), "21": (3, 3), "22": (3, 3)},
    **{"23": (2, 5), "24": (3, 3), "25": (4, 4), "26": (3, 2), "27": (4, 4), "28": (4, 4)},
    **{"t1": (2, 6), "t2": (3, 6), "t3": (2, 12), "t4": (3, 4), "t5": (2, 9)},
    **{"t6": (2, 5), "t7": (2, 6), "t8": (2, 6), "t9": (2, 6), "t10": (2, 5)},
}
UNITS = {"m", "rad", "s", "N", "J", "rad/s", "1/s", "1", "deg", "kg", "kg m²"}


def sampled(data):
    """Name → text as it is, or shape, range and samples spread evenly over the flattened array."""
    found = {}
    for name, values in data.items():
        flat = np.ravel(values)
        if flat.dtype.kind == "U":
            found[name] = flat.tolist()
            continue
        samples = flat[spread(flat.size, SAMPLES)].astype(float).tolist()
        found[name] = {"shape": list(np.shape(values)), "range": float(np.ptp(flat)), "samples": samples}
    return found


def spread(size, count):
    return np.linspace(0, size - 1, count).astype(int)


def scale(then):
    """The range of an array, or its size where it is constant."""
    return then["range"] if then["range"] > 1e-9 else max(1e-6, *map(abs, then["samples"]))


def differences(key, data, kept):
    """Names of the arrays that are not as committed: by name, text, shape, or a sample too far off."""
    wrong = sorted(data.keys() ^ kept.keys())
    for name in data.keys() & kept.keys():
        flat, then = np.ravel(data[name]), kept[name]
        if isinstance(then, list):
            same = flat.tolist() == then
        elif list(np.shape(data[name])) != then["shape"]:
            same = False
        else:
            off = np.abs(flat[spread(flat.size, len(then["samples"]))] - then["samples"]).max()
            same = off <= TOLERANCES[key] * scale(then) or (key, name) in NOISE
        wrong += [] if same else [name]
    return wrong


def unit(label):
    return label.rpartition("[")[2].removesuffix("]") if label.endswith("]") else None


def test_every_figure_is_here():
    drawn = {key for key in figures.stems() if key[0] not in "bm"}  # b1 … and m1 … have tests of their own
    assert drawn == set(COMMITTED) == set(DIAGRAMS) | set(PLOTS)


@pytest.mark.parametrize("key", COMMITTED)
def test_data_is_as_committed(script, key):
    assert differences(key, script(key)["data"](), COMMITTED[key]) == []


@pytest.mark.parametrize("key", COMMITTED)
def test_changed_data_is_noticed(script, key):
    """The twins that must fail: a sample off by ten tolerances, a changed line of text, another shape, a missing array."""
    data, kept = script(key)["data"](), COMMITTED[key]
    for name, then in kept.items():
        if isinstance(then, list):
            moved = [*then[:-1], then[-1] + "_"]
        else:
            moved = {**then, "samples": list(then["samples"])}
            moved["samples"][3 % len(moved["samples"])] += 10 * TOLERANCES[key] * scale(then)
            assert differences(key, data, kept | {name: then | {"shape": [1, *then["shape"]]}}) == [name]
        assert differences(key, data, kept | {name: moved}) == ([] if (key, name) in NOISE else [name])
        assert differences(key, data, {k: v for k, v in kept.items() if k != name}) == [name]


@pytest.mark.parametrize("key", COMMITTED)
def test_text(script, key):
    found = script(key)
    assert found["TITLE"]
    assert 100 < len(found["CAPTION"]) < 900
    assert "nan" not in found["CAPTION"]
    assert 100 < len(found["ALT"]) < 600
    assert found["CAPTION"].endswith(".") and found["ALT"].endswith(".")
    measured = found["measure"]() if "measure" in found else {}
    assert all(np.isfinite(value) for value in measured.values())


@pytest.mark.parametrize("key", PLOTS)
def test_structure_of_a_plot(script, key):
    """A title where panels are several, units in square brackets, equal scales from above, no legend in a panel."""
    panels, entries = PLOTS[key]
    with paper_style():
        picture = script(key)["figure"]()
    assert len(picture.axes) == panels
    assert picture.get_suptitle() == script(key)["TITLE"]
    for panel in picture.axes:
        assert panel.axison and panel.get_legend() is None
        assert panel.get_title() or panels == 1
        assert unit(panel.get_ylabel()) in UNITS
        if panel.xaxis.get_tick_params().get("labelbottom", True):
            assert unit(panel.get_xlabel()) in UNITS
        if key == "16" or panel.get_title().startswith("Top view"):
            assert panel.get_aspect() == 1
    labels = [text.get_text() for legend in picture.legends for text in legend.get_texts()]
    assert len(picture.legends) == min(entries, 1)
    assert len(set(labels)) == len(labels) == entries
    assert all(labels)


@pytest.mark.parametrize("key", DIAGRAMS)
def test_structure_of_a_diagram(script, key):
    with paper_style():
        picture = script(key)["figure"]()
    assert len(picture.axes) == DIAGRAMS[key]
    assert picture.get_suptitle().startswith(script(key)["TITLE"])
    assert picture.legends == []
    for panel in picture.axes:
        assert not panel.axison and panel.get_legend() is None
        assert panel.get_aspect() == 1


if __name__ == "__main__":
    for name, file in FILES.items():
        now = {key: sampled(scripts.run("figures", figures.stems()[key])["data"]()) for key in KEPT[name]}
        file.write_text(json.dumps(now, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
