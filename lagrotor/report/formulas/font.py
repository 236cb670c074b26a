"""The mathematical font that the page carries: a subset of STIX Two Math (OFL), since a browser without one drops roots.

`python -m lagrotor.report.formulas.font STIXTwoMath-Regular.otf` makes the subset again from the whole font, with fonttools and
brotli; version 2.12 was taken. Name and trademark stay with the original: the subset is called "Lagrotor Math".
"""

import re
import unicodedata
from argparse import ArgumentParser
from base64 import b64encode
from pathlib import Path

FONT_FAMILY = "Lagrotor Math"
FILE = Path(__file__).with_name("fonts") / "lagrotor-math.woff2"

# Upright letters and signs as they are typed, blanks and invisible operators first.
_SIGNS = (
    "\u00a0\u2002\u2003\u2004\u2005\u2006\u2009\u200a\u2061\u2062\u2063\u2064"
    "¡¨¯°±²³´·¹×÷ˆ˙˜\u0302\u0303\u0304\u0305\u0307\u0308\u030c\u20d7–—‖†•…′″‴"
    "ℏℑℒℓℜℝℤℕℂℋ←↑→↓↔↦⇐⇒⇔∀∂∃∅∆∇∈∉∏∑−∓∕∗∘∙√∝∞∠∣∥∧∨∩∪∫∮∴∼≃≅≈≔≠≡≢≤≥≪≫≲≳⊂⊆⊕⊗⊙⊤⊥⋅⋆⋮⋯⋱⌈⌉⌊⌋⟨⟩"
)
_GREEK = "".join(map(chr, [*range(0x391, 0x3A2), *range(0x3A3, 0x3AA), *range(0x3B1, 0x3CA)])) + "ϑϕϖϱϵ"
# Italic, bold, bold italic letters and double-struck digits have a block of their own.
_STYLED = re.compile(
    r"MATHEMATICAL ((BOLD |BOLD ITALIC |ITALIC )(SMALL|CAPITAL|DIGIT|PARTIAL|DOTLESS|\w+ SYMBOL)|DOUBLE-STRUCK DIGIT)"
)


def characters() -> frozenset[str]:
    """Every character that the subset has."""
    block = map(chr, range(0x1D400, 0x1D800))
    styled = (letter for letter in block if _STYLED.match(unicodedata.name(letter, "")))
    return frozenset([*map(chr, range(0x20, 0x7F)), *_SIGNS, *_GREEK, *styled, "ℎ"])


def font_face() -> str:
    """Two CSS rules: the font, with its data inside, and that formulas are drawn with it."""
    data = b64encode(FILE.read_bytes()).decode("ascii")
    face = f'@font-face {{ font-family: "{FONT_FAMILY}"; src: url(data:font/woff2;base64,{data}) format("woff2"); }}'
    return f'{face}\nmath {{ font-family: "{FONT_FAMILY}", math; }}'


def subset(source: Path) -> None:
    """Write the subset of a whole STIX Two Math, with its tall brackets, roots and script forms, as WOFF2."""
    from fontTools.subset import Options, Subsetter
    from fontTools.ttLib import TTFont

    font = TTFont(source, recalcTimestamp=False)
    keep = Options(layout_features=["ssty", "dtls"], notdef_outline=True, hinting=False, desubroutinize=True)
    keep.drop_tables += ["GPOS", "DSIG"]
    keep.name_IDs = [0, 1, 2, 3, 4, 5, 6, 13, 14]
    chosen = Subsetter(keep)
    chosen.populate(unicodes=map(ord, characters()))
    chosen.subset(font)
    for record in font["name"].names:
        if record.nameID in (1, 3, 4, 6):
            record.string = FONT_FAMILY if record.nameID in (1, 4) else FONT_FAMILY.replace(" ", "")
    font["CFF "].cff.fontNames = [FONT_FAMILY.replace(" ", "")]
    font.flavor = "woff2"
    font.save(FILE)


if __name__ == "__main__":
    parser = ArgumentParser(description="Make the page's font again.")
    parser.add_argument("source", type=Path, help="STIXTwoMath-Regular.otf, as TeX Live's stix2-otf has it")
    subset(parser.parse_args().source)
