"""Figures 17 to 28: what they show, on their own numbers."""

import pytest

from lagrotor.drawing.style import paper_style
from lagrotor.pictures import figures


@pytest.mark.parametrize("number", [n for n in range(17, 29) if n not in (22, 23)])
def test_analytical_curves_have_a_residual(script, number):
    with paper_style():
        picture = script(number)["figure"]()
    titles = [panel.get_title() for panel in picture.axes]
    assert any("Residual" in title or "Phase of the sine" in title for title in titles)


def test_corrected_curves_beat_the_papers(script):
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
def test_rate_is_read_off_the_spectrum(script, number):
    found = script(number)["measure"]()
    assert found["rate, exact model (rad/s)"] == pytest.approx(found["rate, closed form (rad/s)"], rel=1e-4)
    assert found["rate, spring model (rad/s)"] == pytest.approx(found["rate, closed form (rad/s)"], rel=1e-2)


def test_drawn_twice_is_the_same_bytes(tmp_path):
    first, second = (figures.draw("17", tmp_path / name) for name in _folders(tmp_path))
    assert first.svg.read_bytes() == second.svg.read_bytes()
    assert first.png.read_bytes() == second.png.read_bytes()
    assert first.measured == second.measured


def _folders(base):
    for name in ("one", "two"):
        (base / name).mkdir()
        yield name
