"""A view holds the motion that it is given, as a page that needs nothing else."""

import base64
import json
import re
from pathlib import Path

import numpy as np
import pytest

from lagrotor import Scene, paired_scene, simulate
from lagrotor.drawing import view_lines, view_times
from lagrotor.errors import InputError


def motion_of(html: str) -> dict:
    """What the page's script plays."""
    found = re.search(r"const MOTION = (\{.*\});", html)
    assert found
    return json.loads(found[1])


def points_of(held: dict, row: int) -> np.ndarray:
    """The points of a line, (m, p, 3), as the script reads them."""
    line = held["lines"][row]
    whole = np.frombuffer(base64.b64decode(line["data"]), "<i2").reshape(-1, line["points"], 3)
    return whole * held["unit"] + held["middle"]


def test_lines_come_back_within_what_is_seen() -> None:
    t, rng = view_times(0, 2), np.random.default_rng(5)
    lines = [rng.normal(size=(len(t), 4, 3)), rng.normal(size=(1, 2, 3)) * 3]
    held = motion_of(view_lines(t, lines, ["#123456"], "a <b>", traced=[0], still=[np.eye(3)]).html)
    assert [line["traced"] for line in held["lines"]] == [True, False, False]
    for row, line in enumerate([*lines, np.eye(3)[None]]):
        assert np.abs(points_of(held, row) - line).max() < 1e-3
    assert np.allclose(held["t"], t, atol=1e-5)


def test_a_pair_turns_and_plays_without_a_network(tmp_path: Path) -> None:
    run = simulate(paired_scene(Scene(spins=(10, -10)), 0.204), np.linspace(0, 3, 61), tol=1e-6)
    view = run.view()
    page = view.save(tmp_path / "run.html").read_text(encoding="utf-8")
    assert "http" not in page and len(page) < 1_000_000 and "a &lt;b&gt;" not in page
    held = motion_of(page)
    bar = points_of(held, [line["ink"] for line in held["lines"]].index("#777777"))
    assert np.allclose(np.linalg.norm(bar[:, 1] - bar[:, 0], axis=1), 1, atol=1e-3)
    assert "<iframe" in view._repr_html_() and "&quot;" in view._repr_html_()
    with pytest.raises(InputError, match="must end in"):
        view.save(tmp_path / "run.gif")


def test_what_does_not_move_is_refused() -> None:
    with pytest.raises(InputError, match="nothing that moves"):
        view_lines(view_times(0, 1), [], ["#000000"])
    with pytest.raises(InputError, match="not finite"):
        view_lines(view_times(0, 1), [np.full((31, 2, 3), np.nan)], ["#000000"])
