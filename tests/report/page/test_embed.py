"""Figures in the page: data addresses, sizes."""

from pathlib import Path
from urllib.parse import unquote
from xml.etree import ElementTree

import pytest

from lagrotor.paper.rotor_pair.own_paper import PAPER
from lagrotor.pictures import Picture
from lagrotor.pictures.figures import draw_figure
from lagrotor.report.page.pieces import data_address, size

# With 55 figures of this size the page would still be under its ceiling; most are half of it.
LARGEST = 100_000
DRAWN = ("3", "14", "16", "18")


@pytest.fixture(scope="module")
def pictures(tmp_path_factory: pytest.TempPathFactory) -> list[Picture]:
    return [draw_figure(key, tmp_path_factory.mktemp("drawn"), PAPER.scripts) for key in DRAWN]


def test_pictures_are_small_and_whole(pictures: list[Picture]) -> None:
    for picture in pictures:
        address = data_address(picture)
        assert len(address) <= LARGEST
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
