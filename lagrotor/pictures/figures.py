"""The figures of a paper: run a figure's script and save its picture.

A script `figures/figNN_*.py` (a figure of the paper) or `figures/tN_*.py` (any other) defines TITLE, CAPTION and ALT, and
`figure() -> matplotlib.figure.Figure`. It may define `measure() -> dict[str, float]`, numbers read off the figure.

The SVG has half as many characters as matplotlib's; a PNG with 256 colours is larger for most figures, and blurred.
"""

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from io import StringIO
from pathlib import Path
from typing import Any

from lagrotor.errors import InputError, near
from lagrotor.files import write_beside, write_text
from lagrotor.paper.scripts import Scripts

# No metadata, for reproducible bytes; faster compression than by default.
_PNG: dict[str, Any] = {"metadata": {"Software": None}, "pil_kwargs": {"compress_level": 2}}


@dataclass(frozen=True)
class Picture:
    """A saved figure with the texts of its script.

    stem: the name of the script and of the files. key: the paper's number, such as "17", or the name of another figure,
    such as "t6". alt: a description for those who do not see it. svg, png: its files. measured: the numbers that its
    script reads off.
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
    """Return a map from the key of each figure to the stem of its script: first the paper's by number, then others."""
    matches = [(re.match(r"(?:fig0*)?([a-z]?\d+)_", stem), stem) for stem in scripts.names("figures")]
    return dict(sorted(((match[1], stem) for match, stem in matches if match), key=lambda row: not row[0].isdigit()))


def check_keys(keys: Iterable[str], scripts: Scripts) -> list[str]:
    """Return the keys without repetition and leading zeros. Raises InputError for a key to which no script belongs."""
    drawn = stems(scripts)
    unique = list(dict.fromkeys(key.lstrip("0") or key for key in keys))
    for key in unique:
        if key not in drawn:
            listed = ", ".join(drawn) or "none"
            raise InputError(f"figure {key!r} has no script: give one of {listed}{near(key, drawn)}")
    return unique


def draw_figure(key: str, folder: Path, scripts: Scripts) -> Picture:
    """Draw one figure and write `<stem>.svg` and `<stem>.png` into `folder`; the same script gives the same bytes.

    Raises InputError if the folder is not writable or the script lacks a definition, ScriptError if the script fails.
    """
    from lagrotor.drawing.style import laid_out, letter_panels, paper_style

    stem = stems(scripts)[key]
    with paper_style():
        script = scripts.run("figures", stem)
        if lacking := [name for name in ("TITLE", "CAPTION", "ALT", "figure") if name not in script]:
            raise InputError(f"{scripts.path('figures', stem)} does not define {lacking[0]}: define it there")
        with laid_out(letter_panels(scripts.called("figures", stem, "figure"))) as figure:
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


# Digits of coordinates in points; 0.01 is 1/40 pixel on a screen of double density.
_DECIMALS = 2


def lean_svg(source: str) -> str:
    """Return an SVG with fewer characters that draws the same: no metadata, short ids, rounded relative coordinates."""
    text = re.sub(r"<\?xml.*?\?>|<!DOCTYPE.*?>|<!--.*?-->|<metadata>.*?</metadata>", "", source, flags=re.DOTALL)
    text = re.sub(r">\s+<", "><", text.strip())
    used = set(re.findall(r'(?:href="#|url\(#)([^")]+)', text))
    text = re.sub(r' id="([^"]+)"', lambda match: match[0] if match[1] in used else "", text)
    short = {name: f"{i:x}" for i, name in enumerate(sorted(used))}
    text = re.sub(r'(id="|href="#|url\(#)([^")]+)', lambda match: f"{match[1]}_{short.get(match[2], match[2])}", text)
    text = text.replace("xlink:href", "href").replace(' xmlns:xlink="http://www.w3.org/1999/xlink"', "")
    text = re.sub(r'style="[^"]+"', lambda match: match[0].replace(": ", ":").replace("; ", ";"), text)
    text = re.sub(r'(<use [^>]*)transform="translate\(([-\d.]+)(?: ([-\d.]+))?\)"', _position, text)
    text = re.sub(r' d="([^"]*)"', lambda match: f' d="{_relative(match[1])}"', text)
    return _with_classes(re.sub(r' (x|y|transform)="([^"]*)"', _round_numbers, text))


def _with_classes(text: str) -> str:
    """Replace each repeated style in an SVG by a class, because hundreds of markers and grid lines share one style."""
    counts = Counter(re.findall(r' style="([^"]*)"', text))
    names = {style: f"_{i:x}" for i, (style, n) in enumerate(counts.most_common()) if n > 1}
    rules = "".join(f".{name}{{{style}}}" for style, name in names.items())
    text = re.sub(
        r' style="([^"]*)"', lambda match: f' class="{names[match[1]]}"' if match[1] in names else match[0], text
    )
    return text.replace("</style>", f"{rules}</style>", 1)


def _position(match: re.Match[str]) -> str:
    return f'{match[1]}x="{match[2]}"' + (f' y="{match[3]}"' if float(match[3] or 0) else "")


def _round_numbers(match: re.Match[str]) -> str:
    if "scale" in match[2]:  # glyphs need all digits
        return match[0]
    numbers = re.sub(r"-?\d+\.\d+", lambda number: _short(float(number[0])), match[2])
    return f' {match[1]}="{numbers}"'


def _short(value: float) -> str:
    text = f"{value:.{_DECIMALS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text.replace("0.", ".", 1) if abs(value) < 1 else text


def _relative(path: str) -> str:
    """Return an SVG path of M, L, Q, C and z in relative coordinates; its rounding errors do not accumulate."""
    pieces, at, start, last = [], (0.0, 0.0), (0.0, 0.0), ""
    for letter, coordinates in re.findall(r"([MLQCz])([^MLQCz]*)", path):
        numbers = [float(number) for number in coordinates.split()]
        if letter == "z":
            pieces.append("z")
            at, last = start, letter
            continue
        points = list(zip(numbers[::2], numbers[1::2], strict=True))
        steps = [(round(x - at[0], _DECIMALS), round(y - at[1], _DECIMALS)) for x, y in points]
        again = letter == last and letter != "M"
        pieces.append((" " if again else letter.lower()) + " ".join(f"{_short(x)} {_short(y)}" for x, y in steps))
        at = (at[0] + steps[-1][0], at[1] + steps[-1][1])
        start, last = at if letter == "M" else start, letter
    return "".join(pieces).replace(" -", "-")
