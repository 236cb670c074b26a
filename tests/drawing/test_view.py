"""A view holds the motion that it is given, as a page that needs nothing else."""

import base64
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lagrotor import Scene, Structure, paired_scene, simulate
from lagrotor.drawing.view import view_lines, view_times
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
    held = motion_of(view_lines(t, lines, ["#123456"], "a <b>", traced=[0]).html)
    assert [line["traced"] for line in held["lines"]] == [True, False]
    for row, line in enumerate(lines):
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
    with pytest.raises(InputError, match="nothing moves"):
        view_lines(view_times(0, 1), [], ["#000000"])
    with pytest.raises(InputError, match="not finite"):
        view_lines(view_times(0, 1), [np.full((31, 2, 3), np.nan)], ["#000000"])


def test_a_structure_turns_and_plays() -> None:
    """Its bars keep their lengths; two rotors and a bar, the paths of the two rotors' tips, colours by sense."""
    run = Structure([(0, 0), (1, 0)], [(0, 1)], [10, -10]).simulate(
        np.linspace(0, 2, 41), rates=[(0.5, 0), (0.5, 0)], tol=1e-6
    )
    held = motion_of(run.view().html)
    assert [line["traced"] for line in held["lines"]] == [False, True, True]
    assert len({line["ink"] for line in held["lines"]}) == 3
    bar, first, _ = (points_of(held, row) for row in range(3))
    assert np.allclose(np.linalg.norm(bar[:, 1] - bar[:, 0], axis=1), 1, atol=1e-3)
    assert np.allclose(first[:, 1], bar[:, 0], atol=1e-3) and np.ptp(first[:, 1, 1]) > 0.05


def widget_of_a_line() -> Any:
    """A line that turns for two seconds."""
    pytest.importorskip("anywidget", reason="anywidget is not installed")
    t = view_times(0, 2)
    turning = np.stack([np.zeros((len(t), 3)), np.stack([np.cos(t), np.sin(t), 0 * t], -1)], 1)
    return view_lines(t, [turning], ["#123456"], "a line").widget()


BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
# A model as a notebook has it, and what a reader does: Python sets the time, a hand moves the slider, Python lets it play.
PAGE = """<!doctype html><body><div id="cell"></div><script type="module">
const members = MEMBERS, heard = {}, cell = document.getElementById("cell");
const model = {
  get: (name) => members[name],
  set(name, value) { if (members[name] !== value) { members[name] = value; heard["change:" + name]?.(); } },
  save_changes() {},
  on: (name, call) => { heard[name] = call; },
  off: (name) => { delete heard[name]; },
};
const widget = await import(URL.createObjectURL(new Blob([ESM], { type: "text/javascript" })));
const close = widget.default.render({ model, el: cell }), said = {};
said.opened = cell.querySelector("output").textContent;
model.set("time", 1.25);
said.moved = cell.querySelector("output").textContent;
cell.querySelector("input").value = 0.5;
cell.querySelector("input").oninput();
said.slid = members.time;
cell.querySelector("button").onclick();
said.playing = members.playing;
model.set("playing", false);
said.button = cell.querySelector("button").textContent;
close();
said.left = Object.keys(heard).length;
document.body.innerHTML = "<pre>" + JSON.stringify(said) + "</pre>";
</script></body>"""


@pytest.mark.skipif(BROWSER is None, reason="no chromium, chromium-browser or google-chrome is installed")
def test_the_widget_shares_its_time_with_python(tmp_path: Path) -> None:
    widget = widget_of_a_line()
    widget.time = 1.0  # set before the cell is shown
    members = {name: getattr(widget, name) for name in ("motion", "parts", "time", "playing")}
    page = PAGE.replace("MEMBERS", json.dumps(members)).replace("ESM", json.dumps(str(widget._esm)))
    file = tmp_path / "cell.html"
    file.write_text(page, encoding="utf-8")
    assert BROWSER is not None
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=4000", "--dump-dom"]
    shown = subprocess.run([*command, file.as_uri()], capture_output=True, text=True, timeout=120, check=True).stdout
    found = re.search(r"<pre>(.*)</pre>", shown)
    assert found, shown[-500:]
    assert json.loads(found[1]) == {
        "opened": "t = 1.00 s", "moved": "t = 1.25 s", "slid": 0.5, "playing": True, "button": "Play", "left": 0,
    }  # fmt: skip
