"""The mathematical font of the page: a subset of STIX Two Math (OFL); without such a font browsers draw roots wrongly.

The file is made by `pyftsubset STIXTwoMath-Regular.otf --flavor=woff2 --layout-features=ssty,dtls --notdef-outline --no-hinting
--desubroutinize --drop-tables+=GPOS,DSIG --unicodes=…` of version 2.12; a test names missing characters. The subset is called
"Lagrotor Math", because the original's name is a trademark.
"""

from base64 import b64encode
from pathlib import Path

FONT_FAMILY = "Lagrotor Math"
FILE = Path(__file__).with_name("fonts") / "lagrotor-math.woff2"


def font_face() -> str:
    """Return the CSS rules that embed the font and apply it to formulas."""
    data = b64encode(FILE.read_bytes()).decode("ascii")
    face = f'@font-face {{ font-family: "{FONT_FAMILY}"; src: url(data:font/woff2;base64,{data}) format("woff2"); }}'
    return f'{face}\nmath {{ font-family: "{FONT_FAMILY}", math; }}'
