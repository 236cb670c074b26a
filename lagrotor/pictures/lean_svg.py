"""A figure's SVG, written in half as many characters: what is saved, and what the page shows.

As a PNG in a palette of 256 most figures are larger, and blurred on a good screen.
"""

import re

# Coordinates in points to a hundredth: a fortieth of a pixel on a screen of twice the usual density.
_DECIMALS = 2


def lean_svg(source: str) -> str:
    """The same drawing in fewer characters: no metadata, short ids, rounded and relative coordinates."""
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
    return re.sub(r' (x|y|transform)="([^"]*)"', _round_numbers, text)


def _position(match: re.Match[str]) -> str:
    return f'{match[1]}x="{match[2]}"' + (f' y="{match[3]}"' if float(match[3] or 0) else "")


def _round_numbers(match: re.Match[str]) -> str:
    if "scale" in match[2]:  # of letters: few, and each digit counts
        return match[0]
    numbers = re.sub(r"-?\d+\.\d+", lambda number: _short(float(number[0])), match[2])
    return f' {match[1]}="{numbers}"'


def _short(value: float) -> str:
    text = f"{value:.{_DECIMALS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text.replace("0.", ".", 1) if abs(value) < 1 else text


def _relative(path: str) -> str:
    """A path of M, L, Q, C and z with each point relative to the one before, rounding errors not carried along."""
    written, at, start, last = [], (0.0, 0.0), (0.0, 0.0), ""
    for letter, rest in re.findall(r"([MLQCz])([^MLQCz]*)", path):
        numbers = [float(number) for number in rest.split()]
        if letter == "z":
            written.append("z")
            at, last = start, letter
            continue
        points = list(zip(numbers[::2], numbers[1::2], strict=True))
        steps = [(round(x - at[0], _DECIMALS), round(y - at[1], _DECIMALS)) for x, y in points]
        again = letter == last and letter != "M"
        written.append((" " if again else letter.lower()) + " ".join(f"{_short(x)} {_short(y)}" for x, y in steps))
        at = (at[0] + steps[-1][0], at[1] + steps[-1][1])
        start, last = at if letter == "M" else start, letter
    return "".join(written).replace(" -", "-")
