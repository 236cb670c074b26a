"""The font inside the page: every character of every formula is in it, and what makes roots and brackets grow."""

import re
import unicodedata
from base64 import b64decode
from collections.abc import Iterator
from html.parser import HTMLParser

import pytest

from lagrotor.mechanics.glossary import latex
from lagrotor.pair.notation import GLOSSARY
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.formulas.font import FILE, FONT_FAMILY, font_face
from lagrotor.report.formulas.mathml_latex import mathml

ttlib = pytest.importorskip("fontTools.ttLib", reason="fonttools reads the font")
pytest.importorskip("brotli", reason="brotli unpacks WOFF2")


class Letters(HTMLParser):
    """The characters that a browser draws: a letter alone in its `mi` is drawn italic, from the block for it."""

    def __init__(self) -> None:
        super().__init__()
        self.upright = True
        self.drawn: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.upright = tag != "mi" or ("mathvariant", "normal") in attrs

    def handle_data(self, data: str) -> None:
        self.drawn |= {data if self.upright or len(data) > 1 else italic(data)} if len(data) == 1 else set(data)


def italic(letter: str) -> str:
    """The mathematical italic of a letter, as MathML Core maps it."""
    name = unicodedata.name(letter).replace("LATIN ", "").replace("GREEK ", "").replace(" LETTER", "")
    name = {"PHI SYMBOL": "SMALL PHI SYMBOL"}.get(name, name)
    candidates = (f"MATHEMATICAL ITALIC {name}", f"MATHEMATICAL ITALIC {name.replace('SMALL ', '', 1)}")
    for candidate in candidates:
        try:
            return unicodedata.lookup(candidate)
        except KeyError:
            continue
    return "ℎ" if letter == "h" else letter


def drawn(formula: str) -> set[str]:
    reader = Letters()
    reader.feed(formula)
    return reader.drawn


def formulas() -> Iterator[str]:
    """Everything that the page sets as mathematics."""
    for entry in PAPER.equations.values():
        yield from filter(None, [mathml(entry.latex)])
    for stem in PAPER.scripts.names("derivations", "s"):
        for statement in PAPER.statements(stem):
            for relation in (*statement.relations, *statement.correction):
                line = f"{relation.quantity} = {relation.written or latex(relation.derived)}"
                yield from filter(None, [mathml(line)])
    yield from filter(None, (mathml(latex(letter)) for letter in GLOSSARY))


@pytest.fixture(scope="module")
def covered() -> set[str]:
    return set(map(chr, ttlib.TTFont(FILE).getBestCmap()))


def test_every_character_of_every_formula_is_in_the_font(covered: set[str]) -> None:
    used = set().union(*map(drawn, formulas()))
    assert set("𝜃𝜙𝜑ℒ∑→˙𝟙Ω−") <= used
    assert used <= covered, sorted(map(unicodedata.name, used - covered))


def test_a_character_that_is_missing_is_seen(covered: set[str]) -> None:
    assert drawn("<math><mi>θ</mi><mo>⨀</mo></math>") - covered == {"⨀"}


def test_the_page_carries_the_whole_file() -> None:
    match = re.search(r"url\(data:font/woff2;base64,([A-Za-z0-9+/=]+)\)", font_face())
    assert match
    assert b64decode(match[1]) == FILE.read_bytes()
    assert len(match[1]) < 200_000
    assert f'math {{ font-family: "{FONT_FAMILY}"' in font_face()
