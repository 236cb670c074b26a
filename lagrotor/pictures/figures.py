"""Run a figure's script and keep its picture.

A script `figures/figNN_*.py` (one of the paper's figures) or `figures/tN_*.py` (another, by a letter and a number) defines
`figure() -> matplotlib.figure.Figure`, the strings TITLE, CAPTION and ALT, and may define `measure() -> dict[str, float]`,
the numbers read off it.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from io import StringIO
from pathlib import Path
from typing import Any

from lagrotor.errors import InputError, near
from lagrotor.files import write_beside, write_text
from lagrotor.paper.scripts import Scripts
from lagrotor.pictures.lean_svg import lean_svg

# The same bytes every time; pixels compressed a little less, and faster, than by default.
_PNG: dict[str, Any] = {"metadata": {"Software": None}, "pil_kwargs": {"compress_level": 2}}


@dataclass(frozen=True)
class Picture:
    """A figure as saved: `svg` and `png` are the two files, `measured` the numbers its script reads off it.

    key: the paper's number, such as "17", or the name of another figure, such as "t6".
    """

    stem: str
    key: str
    title: str
    caption: str
    alt: str
    svg: Path
    png: Path
    measured: dict[str, float]


def stems(scripts: Scripts) -> dict[str, str]:
    """The scripts that draw figures: key → stem; the paper's by number, then those with a letter, "b1" …, "t1" …."""
    matches = [(re.match(r"(?:fig0*)?([a-z]?\d+)_", stem), stem) for stem in scripts.names("figures")]
    return dict(sorted(((match[1], stem) for match, stem in matches if match), key=lambda row: not row[0].isdigit()))


def check_keys(keys: Iterable[str], scripts: Scripts) -> list[str]:
    """The keys, each once, 07 read as 7; raises InputError for one that no script draws."""
    drawn = stems(scripts)
    wanted = list(dict.fromkeys(key.lstrip("0") or key for key in keys))
    for key in wanted:
        if key not in drawn:
            listed = ", ".join(drawn) or "none"
            raise InputError(f"figure {key!r} has no script: those drawn are {listed}{near(key, drawn)}")
    return wanted


def draw_figure(key: str, folder: Path, scripts: Scripts) -> Picture:
    """Draw one figure of `stems()` and write `<stem>.svg` and `<stem>.png` into `folder`: the same bytes every time.

    Raises InputError when the folder cannot be written to or a script lacks what every figure has, ScriptError where it fails.
    """
    from lagrotor.drawing.style import laid_out, paper_style

    stem = stems(scripts)[key]
    with paper_style():
        script = scripts.run("figures", stem)
        if lacking := [name for name in ("TITLE", "CAPTION", "ALT", "figure") if name not in script]:
            raise InputError(f"{scripts.path('figures', stem)}: it defines no {lacking[0]}")
        with laid_out(scripts.called("figures", stem, "figure")) as figure:
            drawn = StringIO()
            figure.savefig(drawn, format="svg", metadata={"Date": None})
            svg = write_text(folder / f"{stem}.svg", lean_svg(drawn.getvalue()))
            png = write_beside(folder / f"{stem}.png", partial(figure.savefig, format="png", **_PNG))
    measured = scripts.called("figures", stem, "measure") if "measure" in script else {}
    return Picture(
        stem=stem,
        key=key,
        title=script["TITLE"],
        caption=script["CAPTION"],
        alt=script["ALT"],
        svg=svg,
        png=png,
        measured={name: float(value) for name, value in measured.items()},
    )
