"""Panels that several figures share: their frames, and what is drawn in which."""

import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from lagrotor.pictures import distance_over_one_turn, orbits_from_above, rate_figure, shock_figure


def test_the_frames_of_an_orbit():
    top, below = Figure().subplots(2)
    orbits_from_above(top, 0.85, 0.27)
    distance_over_one_turn(below, 1e-5, 1)
    assert (top.get_xlim(), top.get_ylim(), top.get_aspect()) == ((-0.85, 0.85), (-0.27, 0.27), 1)
    assert top.lines[0].get_xdata() == pytest.approx([-0.5, 0.5])
    assert below.get_ylim() == (1e-5, 1)
    assert below.get_xticks() == pytest.approx(np.arange(5) * np.pi / 2)


def test_the_force_is_drawn_along_the_letter_given():
    t = np.linspace(0, 1, 5)
    data = {"t": t, "energy": t, "exact_energy": t[:3], "exact_t": t[:3], "force": t}
    data |= {"centre": np.outer(t, [1, 2, 3]), "exact_centre": np.zeros((3, 3))}
    _, force, centre = shock_figure(data, "y").axes
    assert force.get_ylabel() == "force in y (N)"
    *curves, end = centre.lines
    assert [line.get_ydata()[-1] for line in curves] == [1, 0, 2, 0, 3, 0]
    assert [len(line.get_xdata()) for line in curves] == [5, 3] * 3
    assert end.get_xdata() == [0.5, 0.5]  # where the exact model ends


def test_residuals_are_against_the_exact_model():
    t, names = np.linspace(1, 5, 5), ("t", "force", "rate", "exact_amplitude", "springs_amplitude")
    x = t / 5
    data = dict.fromkeys(names, t) | {"exact": x, "springs": 2 * x, "printed": 3 * x, "corrected": x}
    *_, residual, heights = rate_figure(data | {"closed_form_rate": np.array([11.5])}, 11.4).axes
    assert [line.get_ydata()[-1] for line in residual.lines] == [2, 1, 0]  # printed, springs, corrected
    assert [line.get_xdata()[0] for line in heights.lines[2:]] == [11.4, 11.5]
    assert heights.get_xlim() == pytest.approx((6.4, 16.4))


def test_figures_name_a_colour_by_its_meaning():
    """Cases take colours without a meaning of their own; charts of tools are exempt."""
    scripts = [
        path for path in Path(__file__).parents[2].joinpath("figures").glob("*.py") if not path.name.startswith("b")
    ]
    assert len(scripts) > 40
    named = re.compile(r'OKABE_ITO\["(?:vermillion|blue|bluish green|black)"\]')
    assert [path.name for path in scripts if named.search(path.read_text(encoding="utf-8"))] == []
