"""The mathematical font that the page carries: a subset of STIX Two Math (OFL), since a browser without one drops roots.

The file is made by `pyftsubset STIXTwoMath-Regular.otf --flavor=woff2 --layout-features=ssty,dtls --notdef-outline --no-hinting
--desubroutinize --drop-tables+=GPOS,DSIG --unicodes=…` of version 2.12; a test names a character that it lacks. Name and
trademark stay with the original: the subset is called "Lagrotor Math".
"""

from base64 import b64encode
from pathlib import Path

FONT_FAMILY = "Lagrotor Math"
FILE = Path(__file__).with_name("fonts") / "lagrotor-math.woff2"


def font_face() -> str:
    """Return two CSS rules: the font, with its data inside, and that formulas are drawn with it."""
    data = b64encode(FILE.read_bytes()).decode("ascii")
    face = f'@font-face {{ font-family: "{FONT_FAMILY}"; src: url(data:font/woff2;base64,{data}) format("woff2"); }}'
    return f'{face}\nmath {{ font-family: "{FONT_FAMILY}", math; }}'
