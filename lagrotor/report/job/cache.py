"""The cache: results of earlier runs in the user's cache folder, which are reused if their inputs have not changed.

The product of a step is its result: the numbers of a claim, a figure with its files, the interactive model, the title,
findings, tables and HTML of a derivation. A product that JSON can represent is stored with the digest of its inputs. A missing,
damaged or outdated product is computed again. A derivation also runs again, unless the whole report is unchanged, if it has
verdicts. Of the formulas in a table only the LaTeX is stored, and of the values those that `stored_values` can represent.
"""

import json
import os
from base64 import b64decode, b64encode
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import sympy as sp
from sympy.core.symbol import Str

from lagrotor.errors import InputError
from lagrotor.files import write_text
from lagrotor.mechanics.glossary import latex
from lagrotor.paper.papers import Paper
from lagrotor.paper.tables import FigureLink, Table
from lagrotor.pictures.figures import Picture
from lagrotor.report.job.dependencies import digest
from lagrotor.report.job.steps import Derived
from lagrotor.report.job.stored_values import value_from_json, values_as_json


def cache_folder() -> Path:
    """Return the cache folder: lagrotor in XDG_CACHE_HOME, or ~/.cache/lagrotor."""
    base = Path(os.environ.get("XDG_CACHE_HOME", ""))
    return (base if base.is_absolute() else Path.home() / ".cache") / "lagrotor"


@dataclass(frozen=True)
class Cache:
    """The cached products of one paper, identified by the paths of its folder and of its scripts."""

    paper: Paper

    def take(self, name: str, made_from: str) -> Any:
        """Return the stored product `name` as JSON data; None if it is missing or damaged, or if its inputs differ.

        `made_from` is the digest of the present inputs.
        """
        with suppress(OSError, RuntimeError, ValueError, TypeError, KeyError):  # RuntimeError: the user has no home
            entry = json.loads(self._file(name).read_text(encoding="utf-8"))
            if entry["digest"] == digest(made_from, json.dumps(entry["product"])):
                return entry["product"]
        return None

    def keep(self, name: str, made_from: str, product: Any) -> bool:
        """Store a product for later runs. Return False if JSON cannot represent it or the folder cannot be written to."""
        with suppress(OSError, RuntimeError, InputError, TypeError):
            text = json.dumps(product)
            self._file(name).parent.mkdir(parents=True, exist_ok=True)
            write_text(self._file(name), json.dumps({"digest": digest(made_from, text), "product": product}))
            return True
        return False

    def _file(self, name: str) -> Path:
        place = digest(str(self.paper.folder), str(self.paper.scripts_in))[:16]
        return cache_folder() / place / f"{name.replace(' ', '-')}.json"


def picture_as_json(picture: Picture) -> dict[str, Any]:
    """Return a picture as a dictionary for JSON that contains the contents of its two files."""
    contents = {"svg": picture.svg.read_text(encoding="utf-8"), "png": b64encode(picture.png.read_bytes()).decode()}
    return asdict(picture) | contents


def picture_from_json(data: Mapping[str, Any], folder: Path) -> Picture:
    """Write the two files of a stored picture into `folder` and return the picture."""
    stem = folder / Path(data["stem"]).name
    svg, png = stem.with_suffix(".svg"), stem.with_suffix(".png")
    svg.write_text(data["svg"], encoding="utf-8")
    png.write_bytes(b64decode(data["png"]))
    return Picture(**{**data, "svg": svg, "png": png})


class StoredFormula(sp.Expr):  # type: ignore[misc]
    """An expression in a table. Only its LaTeX is stored, as the argument."""

    def _latex(self, printer: Any, exp: Any = None) -> str:
        return str(self.args[0].name)


def derived_as_json(derived: Derived) -> dict[str, Any]:
    """Return a derivation as a dictionary, which JSON can represent if it has no verdicts."""
    tables = [
        asdict(table) | {"rows": [list(map(_cell_as_json, row)) for row in table.rows]} for table in derived.tables
    ]
    fields = {name: getattr(derived, name) for name in ("stem", "title", "verdicts", "remarks", "html")}
    return fields | {"tables": tables, "values": values_as_json(derived.values)}


def derived_from_json(data: Mapping[str, Any]) -> Derived:
    """Return a stored derivation, which has no verdicts; those of its `values` are missing that could not be stored."""
    tables = (
        Table(
            table["title"],
            tuple(table["head"]),
            tuple(tuple(map(_cell_from_json, row)) for row in table["rows"]),
            table["note"],
        )
        for table in data["tables"]
    )
    remarks = tuple((title, text) for title, text in data["remarks"])
    values = {name: value_from_json(value) for name, value in data["values"].items()}
    return Derived(data["stem"], data["title"], (), remarks, tuple(tables), data["html"], values)


def _cell_as_json(cell: Any) -> Any:
    if isinstance(cell, tuple):
        return list(map(_cell_as_json, cell))
    if isinstance(cell, sp.Basic) and not isinstance(cell, sp.Symbol | sp.MatrixBase):
        return {"latex": latex(cell)}
    return asdict(cell) if isinstance(cell, FigureLink) else cell


def _cell_from_json(cell: Any) -> Any:
    if isinstance(cell, list):
        return tuple(map(_cell_from_json, cell))
    if isinstance(cell, dict):
        return StoredFormula(Str(cell["latex"])) if "latex" in cell else FigureLink(**cell)
    return cell
