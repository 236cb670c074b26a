"""Figures in the page: the same drawing in fewer characters."""

import re
from pathlib import Path
from urllib.parse import unquote
from xml.etree import ElementTree

import numpy as np
import pytest

from lagrotor.paper.rotor_pair.own_paper import PAPER
from lagrotor.pictures import Picture
from lagrotor.pictures.figures import draw
from lagrotor.report.page import embed
from lagrotor.report.page.embed import embedded, lean_svg, size

# With 39 figures of this size the page would still be under 5 MB; most are half of it.
LARGEST = 100_000
DRAWN = ("3", "14", "16", "18")
STEP = re.compile(r"([MLQCzmlqc])([^MLQCzmlqc]*)")


@pytest.fixture(scope="module")
def pictures(tmp_path_factory: pytest.TempPathFactory) -> list[Picture]:
    return [draw(key, tmp_path_factory.mktemp("drawn"), PAPER.scripts) for key in DRAWN]


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


def test_every_path_is_where_it_was(pictures: list[Picture]) -> None:
    for picture in pictures:
        source = picture.svg.read_text()
        was, now = paths(source), paths(lean_svg(source))
        assert len(was) == len(now) > 10
        for a, b in zip(was, now, strict=True):
            assert a.shape == b.shape
            assert np.abs(a - b).max() <= 0.0051


def test_a_coarser_rounding_is_seen(pictures: list[Picture], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(embed, "_DECIMALS", 1)
    source = pictures[-1].svg.read_text()
    off = [np.abs(a - b).max() for a, b in zip(paths(source), paths(lean_svg(source)), strict=True)]
    assert max(off) > 0.0051


def test_ids_are_kept_where_they_are_used(pictures: list[Picture]) -> None:
    for picture in pictures:
        tree = ElementTree.fromstring(lean_svg(picture.svg.read_text()))
        text = ElementTree.tostring(tree, encoding="unicode")
        ids = {node.get("id") for node in tree.iter()} - {None}
        assert set(re.findall(r'href="#([^"]+)|url\(#([^)]+)', text)) and ids
        assert {a or b for a, b in re.findall(r'href="#([^"]+)|url\(#([^)]+)', text)} == ids


def test_pictures_are_small_and_whole(pictures: list[Picture]) -> None:
    for picture in pictures:
        address = embedded(picture)
        assert len(address) <= LARGEST
        assert len(address) < 0.75 * picture.svg.stat().st_size
        assert not set('"<>#& ') & set(address.removeprefix("data:image/svg+xml,").replace(" ", ""))
        kind, _, data = address.partition(",")
        assert kind == "data:image/svg+xml"
        ElementTree.fromstring(unquote(data))
        width, height = size(picture)
        assert 300 < width < 1200 and 100 < height < 1200


def test_what_has_no_size_is_still_shown(tmp_path: Path) -> None:
    svg = tmp_path / "a.svg"
    svg.write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
    assert size(Picture("a", "1", "", "", "", svg, svg, {})) == (1, 1)
