"""The page's colours can be read: on a screen, in the dark, on paper."""

import re
from pathlib import Path

import pytest

from lagrotor.report import page

STYLE = Path(page.__file__).with_name("page.css").read_text(encoding="utf-8")
LETTERS = ("ink", "faint", "link", "good", "part", "bad", "open")
LEAST = 4.5  # WCAG 2.2, level AA, for text of any size


def colours(rule: str) -> dict[str, str]:
    return dict(re.findall(r"--(\w+): (#[0-9a-f]{3,6});", rule))


def luminance(colour: str) -> float:
    digits = colour[1:] if len(colour) == 7 else "".join(2 * digit for digit in colour[1:])
    parts = [int(digits[i : i + 2], 16) / 255 for i in (0, 2, 4)]
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(a: str, b: str) -> float:
    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


def test_contrast_is_what_the_guidelines_call_it() -> None:
    assert contrast("#000", "#ffffff") == pytest.approx(21)
    assert contrast("#767676", "#fff") == pytest.approx(4.54, abs=0.01)
    assert contrast("#777777", "#fff") < LEAST


def test_letters_can_be_told_from_their_ground() -> None:
    rules = [colours(rule) for rule in re.findall(r":root \{(.*?)\}", STYLE, re.DOTALL)]
    assert len(rules) == 3, "light, dark, paper"
    for rule in rules:
        assert {*LETTERS, "ground", "raised"} <= set(rule)
        for letter in LETTERS:
            for ground in ("ground", "raised"):
                assert contrast(rule[letter], rule[ground]) >= LEAST, (letter, ground, rule)
    for rule in rules[
        :2
    ]:  # a hit of the search has the colours of a link and of small text; there is no search on paper
        assert min(contrast(rule[letter], rule["mark"]) for letter in ("link", "faint")) >= LEAST


def test_what_has_the_focus_is_seen() -> None:
    assert re.search(r":focus-visible \{ outline: 3px", STYLE)
    assert "outline: none" not in STYLE and "outline: 0" not in STYLE
