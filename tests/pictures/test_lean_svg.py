"""Figures as saved: the same drawing in fewer characters."""

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.pictures import figures
from lagrotor.pictures.figures import draw_figure, lean_svg

DRAWN = ("3", "18")  # a diagram with arrows, curves on axes
STEP = re.compile(r"([MLQCzmlqc])([^MLQCzmlqc]*)")


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Figures as matplotlib writes them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(figures, "lean_svg", str)
        return [draw_figure(key, tmp_path_factory.mktemp("drawn"), PAPER.scripts).svg.read_text() for key in DRAWN]


def points(path: str) -> np.ndarray:
    """Every point of a path, in absolute coordinates."""
    found, at, start = [], np.zeros(2), np.zeros(2)
    for letter, rest in STEP.findall(path):
        steps = np.array([float(n) for n in re.findall(r"-?(?:\d+\.?\d*|\.\d+)", rest)]).reshape(-1, 2)
        if letter in "zZ":
            at = start
            continue
        size_of = {"m": 1, "l": 1, "q": 2, "c": 3}[letter.lower()]
        for group in steps.reshape(-1, size_of, 2):
            group = group + at if letter.islower() else group
            found += list(group)
            at = group[-1]
        start = at if letter in "Mm" else start
    return np.array(found)


def paths(svg: str) -> list[np.ndarray]:
    return [points(match) for match in re.findall(r' d="([^"]+)"', svg)]


def test_every_path_is_where_it_was(sources: list[str]) -> None:
    for source in sources:
        was, now = paths(source), paths(lean_svg(source))
        assert len(was) == len(now) > 10
        for a, b in zip(was, now, strict=True):
            assert a.shape == b.shape
            assert np.abs(a - b).max() <= 0.0051


def test_ids_are_kept_where_they_are_used(sources: list[str]) -> None:
    for source in sources:
        tree = ElementTree.fromstring(lean_svg(source))
        text = ElementTree.tostring(tree, encoding="unicode")
        ids = {node.get("id") for node in tree.iter()} - {None}
        assert set(re.findall(r'href="#([^"]+)|url\(#([^)]+)', text)) and ids
        assert {a or b for a, b in re.findall(r'href="#([^"]+)|url\(#([^)]+)', text)} == ids


def test_a_saved_figure_is_lean(sources: list[str], tmp_path: Path) -> None:
    saved = draw_figure(DRAWN[0], tmp_path, PAPER.scripts).svg.read_text()
    assert saved == lean_svg(sources[0])
    assert len(saved) < 0.75 * len(sources[0])
