"""The model of nine rotors: its JavaScript against the library, and the section in a browser."""

import json
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from lagrotor import Link, Structure
from lagrotor.report.page import interactive as module
from lagrotor.report.page import pages
from lagrotor.report.page.interactive import grid_section
from tests.report.in_browser import dom_of, needs_browser
from tests.report.interactive.in_node import NODE, value_of

SOURCE = (Path(module.__file__).with_name("grid_standing.js")).read_text(encoding="utf-8")


def random_boards(n: int) -> list[tuple[list[float | None], list[int], list[int], float]]:
    """Places with a spin, none, or no spin; bars between neighbours that are there."""
    draw, found = np.random.default_rng(5), []
    while len(found) < n:
        spins = [draw.choice([None, 0.0, 25.0, -25.0, 40.0], p=[0.25, 0.1, 0.3, 0.2, 0.15]) for _ in range(9)]
        here = [spin is not None for spin in spins]
        right = [i for i in range(9) if i % 3 < 2 and here[i] and here[i + 1] and draw.random() < 0.7]
        up = [i for i in range(6) if here[i] and here[i + 3] and draw.random() < 0.7]
        if any(here):
            found.append((spins, right, up, float(draw.choice([0.0, 1.0, 4.0]))))
    return found


def structure(spins, right, up, load) -> Structure:
    places = [i for i, spin in enumerate(spins) if spin is not None]
    at = {place: k for k, place in enumerate(places)}
    bars = [(at[i], at[i + 1]) for i in right] + [(at[i], at[i + 3]) for i in up]
    given = [spins[i] for i in places]
    return Structure([(i % 3, i // 3) for i in places], bars, given, link=Link(1, 0, 0), gravity=9.81, load=load)


@pytest.mark.skipif(NODE is None, reason="node is not installed")
def test_a_board_stands_where_the_structure_does() -> None:
    boards = random_boards(20)
    verdicts = value_of(f"{json.dumps(boards)}.map(board => standing(...board))", SOURCE)
    seen = set()
    for board, found in zip(boards, verdicts, strict=True):
        expected = structure(*board).stands()
        assert found["stands"] == bool(expected)
        assert found["growth"] == pytest.approx(expected.growth, abs=1e-6)
        assert (np.inf if found["factor"] is None else found["factor"]) == pytest.approx(
            expected.critical_spin, rel=1e-6
        )
        seen.add((found["stands"], found["factor"] is None))
    assert seen == {(True, False), (False, False), (False, True)}
    other = [(*board[:3], board[3] + 0.1) for board in boards]
    moved = value_of(f"{json.dumps(other)}.map(board => standing(...board))", SOURCE)
    assert all(a["growth"] != b["growth"] for a, b in zip(verdicts, moved, strict=True) if a["growth"])


@pytest.mark.skipif(NODE is None, reason="node is not installed")
def test_a_resonance_is_told_where_the_structure_has_it() -> None:
    """The corner with its middle rotor at rest: at 3/√8 times its critical spins, and at no others; its rates are the modes'."""
    spins = np.array([1.0, 0.0, 1.0])
    critical = structure([1, 0, None, None, 1, *[None] * 4], [0], [1], 2.0).critical_spin()
    source = SOURCE + Path(module.__file__).with_name("grid_controls.js").read_text(encoding="utf-8")
    words = {}
    for factor in (1.02, 3 / np.sqrt(8), 1.4):
        each = (factor * critical * spins).tolist()
        board = [each[0], each[1], None, None, each[2], None, None, None, None], [0], [1], 2.0
        found = value_of(
            f"(() => {{ const f = standing(...{json.dumps(board)}); return [f.resonance, verdict(f, 1)]; }})()", source
        )
        rates = structure(*board).modes().rates
        words[factor] = found[1][0]
        assert found[0]["fast"] == pytest.approx(rates.max()) and found[0]["slow"] == pytest.approx([rates.min()] * 2)
    assert ["resonance" in said for said in words.values()] == [False, True, False]


@pytest.mark.skipif(NODE is None, reason="node is not installed")
def test_the_plan_moves_as_the_structure_does() -> None:
    """A corner of three: its small motion, and that of the exact model from a hundred-thousandth of its push."""
    spins, board = [30.0, 30.0, None, None, 30.0, None, None, None, None], ([0], [1], 2.0)
    tilts, pushed = value_of(
        f"""(() => {{
        const found = standing(...{json.dumps([spins, *board])}), motion = stepper(found, {json.dumps(spins)});
        let y = motion.pushed(), n = y.length / 2;
        const pushed = motion.tilts(y.slice(n));
        for (let k = 0; k < 500; k++) y = motion.step(y, 0.002);
        return [motion.tilts(y), pushed];
        }})()""",
        SOURCE,
    )
    moved, rates = (1e-5 * np.array([of[place] for place in "014"]) for of in (tilts, pushed))
    exact = structure(spins, *board).simulate([0.0, 1.0], rates=rates, tol=1e-11).after(1.0)
    assert moved == pytest.approx(exact.axes[:, 0, :2], abs=1e-11)


def test_the_section_needs_nothing_else() -> None:
    text = grid_section()
    assert "/* script */" not in text and "http" not in text and text.count("<script>") == 1


@needs_browser
def test_the_board_in_a_browser(tmp_path) -> None:
    press = """document.querySelector(".grid-rotor").click();
        document.body.dataset.pressed = document.querySelectorAll("[data-kind]").length;"""
    shown = dom_of(f"<!doctype html><meta charset=utf-8><body>{grid_section()}<script>{press}</script>", tmp_path)
    assert 'data-pressed="9"' in shown
    assert "It stands" in shown or "It falls" in shown
    for row, place in product((1, 2, 3), repeat=2):
        assert f'aria-label="row {row} from below, place {place}: ' in shown


RECTANGLES = """document.querySelector("[data-grid=example]").value = "grid";
    document.querySelector("[data-grid=example]").dispatchEvent(new Event("input"));
    const box = (e) => { const r = e.getBoundingClientRect(); return [r.left, r.top, r.right, r.bottom]; };
    const boxes = (name) => [...document.querySelectorAll(`#grid-model ${name}`)].filter((e) => !e.disabled).map(box);
    document.body.innerHTML = `<pre id=boxes>${JSON.stringify([boxes(".grid-rotor"), boxes(".grid-bar")])}</pre>`;"""


def misplaced_bars(style: str, folder: Path) -> list[int]:
    """Which of the twelve bars, drawn with the page's style, overlap a rotor or do not lie midway between two."""
    fragment = f"<style>{style}</style><body>{grid_section()}<script>{RECTANGLES}</script>"
    shown = dom_of(f"<!doctype html><meta charset=utf-8>{fragment}", folder)
    rotors, bars = map(np.array, json.loads(shown.split('<pre id="boxes">')[1].split("</pre>")[0]))
    assert len(rotors) == 9 and len(bars) == 12
    overlaps = (np.minimum(bars[:, None, 2:], rotors[:, 2:]) - np.maximum(bars[:, None, :2], rotors[:, :2])).min(-1) > 1
    centres = (rotors[:, :2] + rotors[:, 2:]) / 2
    middles = (centres[:, None] + centres)[np.triu_indices(9, 1)] / 2
    off = np.linalg.norm((bars[:, None, :2] + bars[:, None, 2:]) / 2 - middles, axis=-1).min(1)
    return [int(i) for i in np.flatnonzero(overlaps.any(1) | (off > 1))]


@needs_browser
def test_the_bars_lie_between_their_rotors_on_the_whole_page(tmp_path: Path) -> None:
    style = Path(pages.__file__).with_name("page.css").read_text(encoding="utf-8")
    assert misplaced_bars(style, tmp_path) == []
    assert misplaced_bars(style + " .grid-across { right: .75rem; bottom: .75rem }", tmp_path) != []
