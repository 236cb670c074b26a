"""Figures 1 to 16: their structure, what they plot against committed samples, and the paper's numbers read off them.

`plotted_setup.json` holds samples of every array of each script's `data()`. Renew it, after looking at the new pictures,
with `python tests/figures/test_figures_setup.py`.
"""

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from lagrotor.paper import scripts
from lagrotor.report import figures
from lagrotor.report.style import paper_style

COMMITTED = Path(__file__).with_name("plotted_setup.json")
DIAGRAMS = {1: 1, 2: 1, 3: 1, 4: 1, 5: 1, 6: 1, 7: 4, 14: 1, 15: 1}  # number → panels, all without axes
PLOTS = {8: 3, 9: 1, 10: 2, 11: 3, 12: 3, 13: 3, 16: 1}
UNITS = {"m", "s", "N", "J"}
LEGENDS = {8: 2, 9: 2, 10: 2, 11: 4, 12: 4, 13: 4}
SAMPLES, TOLERANCE = 9, 1e-6
NUMBERS = sorted(DIAGRAMS | PLOTS)


@cache
def script(number):
    return scripts.run("figures", figures.stems()[str(number)])


@cache
def picture(number):
    with paper_style():
        return script(number)["figure"]()


def sampled(data):
    """Name → text as it is, or shape, range and samples spread evenly over the flattened array."""
    found = {}
    for name, values in data.items():
        flat = np.ravel(values)
        if flat.dtype.kind == "U":
            found[name] = flat.tolist()
            continue
        places = np.linspace(0, flat.size - 1, min(SAMPLES, flat.size)).astype(int)
        found[name] = {
            "shape": list(np.shape(values)),
            "range": float(np.ptp(flat)),
            "samples": flat[places].astype(float).tolist(),
        }
    return found


def differences(found, kept):
    """Names of the arrays that are not as committed: by text, shape, or a sample off by TOLERANCE of range or size."""
    wrong = sorted(found.keys() ^ kept.keys())
    for name in found.keys() & kept.keys():
        now, then = found[name], kept[name]
        if isinstance(now, list) or isinstance(then, list) or now["shape"] != then["shape"]:
            wrong += [name] * (now != then)
            continue
        scale = max(then["range"], *map(abs, then["samples"]), 1e-6)
        if not np.abs(np.subtract(now["samples"], then["samples"])).max() <= TOLERANCE * scale:
            wrong.append(name)
    return wrong


@pytest.fixture(scope="module")
def committed():
    return json.loads(COMMITTED.read_text(encoding="utf-8"))


@pytest.mark.parametrize("number", NUMBERS)
def test_data_is_as_committed(number, committed):
    assert differences(sampled(script(number)["data"]()), committed[str(number)]) == []


@pytest.mark.parametrize("number", NUMBERS)
def test_perturbed_data_is_noticed(number, committed):
    """The twin that must fail: one sample of one array is off, one line of text is changed."""
    kept = committed[str(number)]
    for name in kept:
        moved = json.loads(json.dumps(kept))
        if isinstance(moved[name], list):
            moved[name][-1] += "_"
        else:
            moved[name]["samples"][-1] += 1e-5 * max(1, moved[name]["range"], *map(abs, moved[name]["samples"]))
        assert differences(moved, kept) == [name]
        assert differences({k: v for k, v in kept.items() if k != name}, kept) == [name]


@pytest.mark.parametrize("number", NUMBERS)
def test_text(number):
    found = script(number)
    assert found["TITLE"]
    assert 100 < len(found["CAPTION"]) < 900
    assert "nan" not in found["CAPTION"]
    assert 100 < len(found["ALT"]) < 600
    assert found["ALT"].endswith(".")
    assert found["CAPTION"].endswith(".")
    if 7 <= number <= 13:  # simulated: model, step, stiffness and bar
        assert all(word in found["CAPTION"] for word in ("Spring-link model", "step of 0.001 s", "N/m", "bar of 1 kg"))
    measured = found["measure"]() if "measure" in found else {}
    assert all(np.isfinite(value) for value in measured.values())


@pytest.mark.parametrize("number", NUMBERS)
def test_structure(number):
    drawn = picture(number)
    assert drawn.get_suptitle().startswith(script(number)["TITLE"])
    assert len(drawn.axes) == (DIAGRAMS | PLOTS)[number]
    for panel in drawn.axes:
        assert panel.get_legend() is None  # legends stand outside the panels
        assert bool(panel.axison) == (number in PLOTS)
        if number in PLOTS:
            assert unit(panel.get_ylabel()) in UNITS
            if panel.xaxis.get_tick_params().get("labelbottom", True):
                assert unit(panel.get_xlabel()) in UNITS
        if number in DIAGRAMS or number == 16:
            assert panel.get_aspect() == 1
    labels = [text.get_text() for legend in drawn.legends for text in legend.get_texts()]
    assert len(set(labels)) == len(labels) == LEGENDS.get(number, 0)


def unit(label):
    return label.rpartition("[")[2].removesuffix("]") if label.endswith("]") else None


def test_the_papers_energies():
    """4.02 and 4.03: the spike and decay of the misplaced bar, 100 J, 100 to about 100.45 J; the exact model beside."""
    spike, level, shock = (script(n)["measure"]() for n in (8, 9, 10))
    assert 150 < spike["kinetic energy, peak (J)"] < 250
    assert spike["kinetic energy at the end (J)"] == pytest.approx(100, abs=1e-6)
    assert spike["total energy at the start (J)"] == pytest.approx(100 + 2 * 1e4 * 0.5**2 / 2)
    assert level["largest distance from 100 J (J)"] < 1e-9
    assert shock["energy, largest (J)"] == pytest.approx(100.45, abs=0.005)
    assert shock["exact energy after the shock (J)"] == pytest.approx(100.45, abs=0.005)
    assert shock["longest stable step (s)"] > 1e-3


def test_spike_decays_as_the_joints_say():
    found = script(8)["measure"]()
    assert found["decay of the kinetic energy (1/s)"] == pytest.approx(
        found["decay by the joints' mobility (1/s)"], rel=1e-2
    )
    assert found["decay by the joints' mobility (1/s)"] != pytest.approx(2 * 1e4 / 250, rel=1e-2)  # 2 S/D: too simple


def test_shocks_hold_x_and_topple_y():
    """Section 5: without spin the pair falls in x; with opposite spins x is held, whichever way the shock points."""
    ranges = {n: script(n)["measure"]() for n in (11, 12, 13)}
    assert ranges[11]["x of the centre, range (m)"] > 0.8
    assert ranges[11]["y of the centre, range (m)"] == 0
    for n in (12, 13):
        assert ranges[n]["x of the centre, range (m)"] < 0.2
        assert ranges[n]["y of the centre, range (m)"] > 1.5 * ranges[n]["x of the centre, range (m)"]
        assert ranges[n]["centre at 10 s, off the exact model (m)"] < 0.05


def test_diagrams_are_the_models_geometry():
    bar, forces, wheels = (script(n)["measure"]() for n in (15, 2, 7))
    assert bar["length of the bar (m)"] == pytest.approx(1, abs=1e-9)
    assert bar["axes against r(theta, phi)"] < 1e-12
    assert max(forces.values()) < 1e-12
    assert script(14)["measure"]()["e_3 against r(theta, varphi - pi/2)"] < 1e-12
    assert wheels["rate of the wheel (rad/s)"] == pytest.approx(10, abs=1e-9)
    assert script(6)["measure"]()["longest link at the start (m)"] == 0


def test_design_names_every_public_method():
    """Figure 3 is read off the classes: nothing that is public is left out."""
    from lagrotor.models.spring_link import RigidBodySystem

    shown = {line.split("(")[0] for line in script(3)["data"]()["RigidBodySystem"]}
    public = {name for name, value in vars(RigidBodySystem).items() if callable(value) and not name.startswith("_")}
    assert shown == public | {"RigidBodySystem"}


if __name__ == "__main__":
    now = {str(n): sampled(script(n)["data"]()) for n in NUMBERS}
    COMMITTED.write_text(json.dumps(now, ensure_ascii=False) + "\n", encoding="utf-8")
