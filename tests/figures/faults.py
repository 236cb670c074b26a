"""What a reader of a printed figure would miss: letters, units, entries of the legend, text of a readable size."""

import re
from pathlib import Path

from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

import lagrotor
from lagrotor.drawing.style import laid_out, panel_letters

# Quantities whose axes have no unit.
DIMENSIONLESS = {
    "evaluations of the right-hand side", "number of rods", "number of gyroscopes", "turn after the shock",
    "amplitude $r_0$", "amplitude", r"departure from opposite spins, $1 + \omega_2/\omega_1$", "γ = G/(aΩ)",
    "largest |X K/F|", "|X K/F|", "rate of the force / Ω", "|x| of the first axis", "share of the path 0 – K – M",
    "share of the path 0 – K – M – 0", "tilt along the bar / initial tilt", "spins / critical spins", "sine of the tilt",
    "shift / rate upright", "growth per turn", "number of turns", "distance from the precession", "half-angle η/s",
    "push d/s²", "frequency²/(g² s⁶)", "relative shift of the rate / r₀²", "ratio of the spins ω₂/ω₁", "momentum P/G",
    "mean x", "x", "momentum of x", "action I", "order of the series", "slope", r"$\Omega / \Omega_0$", "σ = (a + b)/(a − b)",
}  # fmt: skip
UNITS = {
    "m", "R", "rad", "deg", "s", "µs", "1/s", "rad/s", "N", "J", "pJ", "kg", "kg m²", "SI", "turns", "1/turn", "turns per return",
    "G/J", "a/c", "√(a/κ)", "√(κ/a)", "√(aκ)/I₃",
}  # fmt: skip
LEAST, WIDTH = 7.0, 182 / 25.4  # points; inches of the text on A4 with the margins of the printed report
PRINTED = (Path(lagrotor.__file__).parent / "report/page/page.css").read_text().partition("@media print")[2]
SCALE = float(re.search(r"img \{[^}]*zoom: ([\d.]+);", PRINTED)[1])


def faults(picture, caption):
    """Return in words what is wrong with a figure and its caption; it is laid out but not written."""
    letters = panel_letters(picture)
    panels = list(letters) or [panel for panel in picture.axes if panel.get_label() != "<colorbar>"]
    found = []
    for panel, letter in letters.items():
        if not panel.get_title(loc="left").startswith(letter):
            found.append(f"panel {letter} does not show its letter")
        if letter not in named_letters(caption):
            found.append(f"the caption does not name {letter}")
        if panel.axison and not panel.get_title(loc="left").removeprefix(letter).strip():
            found.append(f"panel {letter} has no title")
    for panel in filter(lambda panel: panel.axison, panels):
        shown = panel.xaxis.get_tick_params().get("labelbottom", True)
        for label in [panel.get_ylabel() or panels[0].get_ylabel(), *[panel.get_xlabel()] * shown]:
            if label not in DIMENSIONLESS and last_bracket(label) not in UNITS:
                found.append(f"the axis {label!r} has no unit")
        found += unexplained(panel, letters.get(panel, ""), picture)
    with laid_out(picture):
        return found + text_faults(picture)


def named_letters(caption):
    """The letters (a), (b), … that a caption names; "(b) to (d)" names three."""
    named = set(re.findall(r"\([a-j]\)", caption))
    for first, last in re.findall(r"\(([a-j])\) to \(([a-j])\)", caption):
        named |= {f"({chr(code)})" for code in range(ord(first), ord(last) + 1)}
    return named


def last_bracket(label):
    """The text between the bracket that ends a label and its opening one; it may hold further brackets."""
    depth = 0
    for i in range(len(label) - 1, -1, -1):
        depth += (label[i] == ")") - (label[i] == "(")
        if depth == 0:
            return label[i + 1 : -1]
    return ""


def unexplained(panel, letter, picture):
    """The lines of a panel with several colours or dashes of which no entry of the legend, label or title speaks."""
    lines = [line for line in panel.lines if len(line.get_xdata()) and not guide(line)]
    looks = {(to_rgb(line.get_color()), str(line.get_linestyle())) for line in lines}
    if len(looks) < 2:
        return []
    entries = [
        handle
        for legend in picture.legends
        for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True)
        if not re.match(r"\([a-j](, [a-j])*\) ", text.get_text())
        or letter.strip("()") in text.get_text().partition(")")[0].strip("(").split(", ")
    ]
    drawn = [handle for handle in entries if isinstance(handle, Line2D)]
    colours = {to_rgb(handle.get_color()) for handle in drawn} | {to_rgb(text.get_color()) for text in panel.texts}
    colours |= {to_rgb(handle.get_facecolor()) for handle in entries if isinstance(handle, Patch)}
    dashes = {str(handle.get_linestyle()) for handle in drawn} | {"None"}
    in_words = panel.texts or re.search("solid|dotted|dash", panel.get_title(loc="left"))
    return [
        f"panel {letter}: a line with the colour {colour} and the dashes {dash!r} is in no legend"
        for colour, dash in looks
        if colour not in colours or (dash not in dashes and dash != "-" and not in_words)
    ]


def guide(line):
    """A grey straight line, such as zero, explains itself."""
    red, green, blue = to_rgb(line.get_color())
    return red == green == blue and 0.4 < red < 0.8 and len(line.get_xdata()) == 2


def titles_of(panel):
    return [text for text in panel.findobj(Text) if text.get_text() and text.get_text() == panel.get_title(loc="left")]


def text_faults(picture):
    """Text that is too small in print, in old brackets, outside the figure, or titles and legends that overlap."""
    scale = min(SCALE, WIDTH / picture.get_figwidth())
    texts = [text for text in picture.findobj(Text) if text.get_visible() and text.get_text().strip()]
    found = [
        f"{text.get_text()!r} has {scale * text.get_fontsize():.1f} pt in print"
        for text in texts
        if scale * text.get_fontsize() < LEAST
    ]
    found += [f"{text.get_text()!r} has square brackets" for text in texts if re.search(r"\[.*\]", text.get_text())]
    for panel in picture.axes:
        panel.apply_aspect()
    named = [(text.get_text(), text) for panel in picture.axes for text in titles_of(panel)]
    boxes = {
        name: artist.get_window_extent()
        for name, artist in [*named, *(("the legend", legend) for legend in picture.legends)]
    }
    whole = picture.bbox
    found += [
        f"{name!r} leaves the figure"
        for name, box in boxes.items()
        if box.x0 < whole.x0 - 1 or box.x1 > whole.x1 + 1 or box.y0 < whole.y0 - 1 or box.y1 > whole.y1 + 1
    ]
    names = list(boxes)
    return found + [
        f"{one!r} overlaps {other!r}"
        for i, one in enumerate(names)
        for other in names[:i]
        if boxes[one].overlaps(boxes[other])
    ]
