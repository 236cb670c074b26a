"""Figures 17 to 28: their structure, and what they plot against committed samples.

`plotted_theory.json` holds seven samples of every array of each script's `data()`. Renew it, after looking at the new
pictures, with `python tests/figures/test_figures_theory.py`.
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

COMMITTED = Path(__file__).with_name("plotted_theory.json")
PANELS = {17: 3, 18: 2, 19: 2, 20: 2, 21: 3, 22: 3, 23: 2, 24: 3, 25: 4, 26: 3, 27: 4, 28: 4}
UNITS = {"m", "rad", "s", "N", "rad/s", "deg", "1"}
SAMPLES, TOLERANCE = 7, 1e-6


@cache
def script(number):
    return scripts.run("figures", figures.stems()[str(number)])


def sampled(data):
    """Name → (shape, range, samples spread evenly over the flattened array)."""
    found = {}
    for name, values in data.items():
        flat = np.ravel(values)
        places = np.linspace(0, flat.size - 1, SAMPLES).astype(int)
        found[name] = {
            "shape": list(np.shape(values)),
            "range": float(np.ptp(flat)),
            "samples": [float(value) for value in flat[places]],
        }
    return found


def differences(found, kept):
    """What is not as committed: names, shapes, samples off by more than TOLERANCE of the range, or of the size."""
    if found.keys() != kept.keys():
        return sorted(found.keys() ^ kept.keys())
    wrong = []
    for name, now in found.items():
        then = kept[name]
        scale = max(then["range"], max(map(abs, then["samples"])) if then["range"] < 1e-9 else 0.0)
        far = np.abs(np.subtract(now["samples"], then["samples"])).max() > TOLERANCE * scale
        if now["shape"] != then["shape"] or far:
            wrong.append(name)
    return wrong


@pytest.fixture(scope="module")
def committed():
    return json.loads(COMMITTED.read_text())


@pytest.mark.parametrize("number", PANELS)
def test_data_is_as_committed(number, committed):
    assert differences(sampled(script(number)["data"]()), committed[str(number)]) == []


@pytest.mark.parametrize("number", PANELS)
def test_perturbed_data_is_noticed(number, committed):
    """The twin that must fail: one sample of one array is off by 1e-5 of its range."""
    for name in committed[str(number)]:
        moved = json.loads(json.dumps(committed[str(number)]))
        scale = moved[name]["range"] or abs(moved[name]["samples"][0])
        moved[name]["samples"][3] += 1e-5 * max(scale, abs(moved[name]["samples"][3]))
        assert differences(moved, committed[str(number)]) == [name]


def test_missing_array_is_noticed(committed):
    kept = committed["17"]
    assert differences({k: v for k, v in kept.items() if k != "exact"}, kept) == ["exact"]


@pytest.mark.parametrize("number", PANELS)
def test_text(number):
    found = script(number)
    assert found["TITLE"]
    assert 100 < len(found["CAPTION"]) < 1200
    assert "nan" not in found["CAPTION"]
    assert 150 < len(found["ALT"]) < 700
    assert found["ALT"].endswith(".")
    assert all(np.isfinite(value) for value in found["measure"]().values())


@pytest.mark.parametrize("number", PANELS)
def test_structure(number):
    """Panels with titles, units in square brackets on both axes, one legend outside the panels."""
    with paper_style():
        picture = script(number)["figure"]()
    assert len(picture.axes) == PANELS[number]
    assert picture.get_suptitle() == script(number)["TITLE"]
    for panel in picture.axes:
        assert panel.get_title()
        assert _unit(panel.get_ylabel()) in UNITS
        if panel.xaxis.get_tick_params().get("labelbottom", True):
            assert _unit(panel.get_xlabel()) in UNITS
        assert panel.get_legend() is None
        assert not panel.get_title().startswith("Top view") or panel.get_aspect() == 1
    (legend,) = picture.legends
    labels = [text.get_text() for text in legend.get_texts()]
    assert len(labels) == len(set(labels)) >= 2
    assert all(labels)


def _unit(label):
    return label.rpartition("[")[2].removesuffix("]") if label.endswith("]") else None


@pytest.mark.parametrize("number", [n for n in PANELS if n not in (22, 23)])
def test_analytical_curves_have_a_residual(number):
    with paper_style():
        picture = script(number)["figure"]()
    titles = [panel.get_title() for panel in picture.axes]
    assert any("Residual" in title or "Phase of the sine" in title for title in titles)


def test_corrected_curves_beat_the_papers():
    """The point of the figures, on their own numbers."""
    for number, paper, corrected in (
        (19, "paper, largest distance (m)", "order_3, largest distance (m)"),
        (20, "paper, largest distance (m)", "order_9, largest distance (m)"),
        (21, "paper, largest residual (m)", "corrected, largest residual (m)"),
        (
            24,
            "paper, half distance of the tips, largest residual (m)",
            "corrected, half distance of the tips, largest residual (m)",
        ),
        (25, "printed rate, largest residual (m)", "closed form, largest residual (m)"),
        (27, "printed rate, largest residual (m)", "closed form, largest residual (m)"),
    ):
        found = script(number)["measure"]()
        assert found[corrected] < found[paper] / 5


@pytest.mark.parametrize("number", [25, 27])
def test_rate_is_read_off_the_spectrum(number):
    found = script(number)["measure"]()
    assert found["rate, exact model (rad/s)"] == pytest.approx(found["rate, closed form (rad/s)"], rel=1e-4)
    assert found["rate, spring model (rad/s)"] == pytest.approx(found["rate, closed form (rad/s)"], rel=1e-2)


def test_peak_of_a_known_sine():
    """The spectrum's reading, tried on a sine of known rate and size."""
    t = np.linspace(2.3, 10, 1541)
    tools = script(25)
    rate, amplitude = tools["spectrum"](t, 3 + 0.2 * np.sin(11.4 * t + 0.3))
    assert tools["peak"](rate, amplitude) == pytest.approx(11.4, abs=1e-3)
    assert amplitude.max() == pytest.approx(0.2, rel=5e-3)


def test_drawn_twice_is_the_same_bytes(tmp_path):
    first, second = (figures.draw("17", tmp_path / name) for name in _folders(tmp_path))
    assert first.svg.read_bytes() == second.svg.read_bytes()
    assert first.png.read_bytes() == second.png.read_bytes()
    assert first.measured == second.measured


def _folders(base):
    for name in ("one", "two"):
        (base / name).mkdir()
        yield name


if __name__ == "__main__":
    stems = figures.stems()
    now = {
        str(n): sampled(runpy.run_path(str(scripts.folder("figures") / f"{stems[str(n)]}.py"))["data"]())
        for n in PANELS
    }
    COMMITTED.write_text(json.dumps(now, indent=1) + "\n")
