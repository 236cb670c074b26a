"""The second interactive model of the report: up to nine rotors on a grid, and whether they stand.

Its numbers come from grid_standing.js, written by hand for massless bars and equal loads, and held to `Structure` by a test.
"""

from functools import cache
from pathlib import Path

_HERE = Path(__file__).parent


@cache
def grid_section() -> str:
    """The section as an HTML fragment that needs nothing else: `<section id="grid-model">`, its style and its script."""
    parts = [(_HERE / f"grid_{name}.js").read_text(encoding="utf-8") for name in ("standing", "controls")]
    script = "\n".join(
        ["(() => {", '"use strict";', *parts, 'showGrid(document.getElementById("grid-model"));', "})();"]
    )
    return (_HERE / "grid.html").read_text(encoding="utf-8").replace("/* script */", script)
