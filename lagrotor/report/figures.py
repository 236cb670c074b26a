"""Run a figure's script and keep its picture.

A script `figures/figNN_*.py` defines `figure() -> matplotlib.figure.Figure`, the strings TITLE, CAPTION and ALT, and
may define `measure() -> dict[str, float]`, the numbers read off it.
"""

import re
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from ..errors import InputError
from ..numerics.files import write_beside
from ..paper import scripts


@dataclass(frozen=True)
class Picture:
    """A figure as saved: `svg` and `png` are the two files, `measured` the numbers its script reads off it."""

    stem: str
    number: int
    title: str
    caption: str
    alt: str
    svg: Path
    png: Path
    measured: dict[str, float]
    seconds: float


def stems() -> dict[int, str]:
    """The scripts that draw the paper's figures: number → stem."""
    found = ((re.match(r"fig(\d+)_", stem), stem) for stem in scripts.names("figures"))
    return {int(match[1]): stem for match, stem in found if match}


def check_numbers(numbers: Iterable[int]) -> list[int]:
    """The numbers, each once; raises InputError for one that no script draws."""
    drawn = stems()
    wanted = list(dict.fromkeys(numbers))
    for number in wanted:
        if number not in drawn:
            raise InputError(f"figure {number} has no script: those drawn are {', '.join(map(str, sorted(drawn)))}")
    return wanted


def draw(number: int, folder: Path) -> Picture:
    """Draw one figure of `stems()` and write `<stem>.svg` and `<stem>.png` into `folder`: the same bytes every time.

    Raises InputError when the folder cannot be written to.
    """
    from .style import paper_style

    began = time.perf_counter()
    stem = stems()[number]
    with paper_style():
        script = scripts.run("figures", stem)
        figure = script["figure"]()
        svg = write_beside(
            folder / f"{stem}.svg", lambda file: figure.savefig(file, format="svg", metadata={"Date": None})
        )
        png = write_beside(
            folder / f"{stem}.png", lambda file: figure.savefig(file, format="png", metadata={"Software": None})
        )
    measured = script["measure"]() if "measure" in script else {}
    return Picture(
        stem=stem,
        number=number,
        title=script["TITLE"],
        caption=script["CAPTION"],
        alt=script["ALT"],
        svg=svg,
        png=png,
        measured={name: float(value) for name, value in measured.items()},
        seconds=time.perf_counter() - began,
    )
