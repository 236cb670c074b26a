"""The literate scripts: where they live, how one is run cell by cell, and what its cells show."""

import ast
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal

from lagrotor.errors import LagrotorError

_PACKAGE = Path(__file__).resolve().parent.parent
_CELL = re.compile(r"^# %%.*$", re.MULTILINE)


def beside(name: str) -> Path:
    """A file or folder that lies beside the package in a checkout, inside it when installed."""
    for base in (_PACKAGE, _PACKAGE.parent):
        if (base / name).exists():
            return base / name
    raise LagrotorError(f"{name} is missing beside {_PACKAGE}: install lagrotor again")


def folder(name: str) -> Path:
    """The folder `derivations` or `figures`."""
    return beside(name)


def names(kind: str, prefix: str = "") -> list[str]:
    """Stems of the scripts in a folder, in order, t2 before t10.

    Derivations: s… sections, c… claims, m… tables, t… theory past the paper, p… the table of it, g… the gallery of
    textbook systems.
    """
    found = (path.stem for path in folder(kind).glob(f"{prefix}*.py") if not path.stem.startswith("_"))
    return sorted(found, key=lambda stem: [(int(n or 0), text) for n, text in re.findall(r"(\d*)(\D*)", stem)])


@dataclass(frozen=True)
class Cell:
    """One cell of a script: prose in Markdown, or code with the values of its bare expressions, which a notebook shows."""

    kind: Literal["prose", "code"]
    text: str
    shown: tuple[Any, ...] = ()


@dataclass(frozen=True)
class Script:
    """A script that was run: its cells in order and the names it defines."""

    cells: tuple[Cell, ...]
    names: dict[str, Any]

    def shown(self, kind: type) -> list[Any]:
        """Every value of one type that its cells show, in order; of rows of values, each."""
        found = []
        for cell in self.cells:
            for value in cell.shown:
                found += [v for v in (value if isinstance(value, tuple | list) else [value]) if isinstance(v, kind)]
        return found


@cache
def executed(kind: str, stem: str) -> Script:
    """Run one script, once in a process."""
    return run_file(folder(kind) / f"{stem}.py")


def run(kind: str, stem: str) -> dict[str, Any]:
    """The names that a script defines."""
    return executed(kind, stem).names


def run_file(path: Path) -> Script:
    """Run a script in the percent format (`# %%` begins a cell, `# %% [markdown]` one of prose)."""
    source = path.read_text(encoding="utf-8")
    defined: dict[str, Any] = {"__name__": path.stem, "__file__": str(path)}
    starts = [match.start() for match in _CELL.finditer(source)] or [0]
    cells = []
    for start, end in zip(starts, [*starts[1:], len(source)], strict=True):
        text = source[start:end]
        head, _, body = text.partition("\n") if text.startswith("# %%") else ("", "", text)
        if "[markdown]" in head:
            cells.append(Cell("prose", re.sub(r"^# ?", "", body, flags=re.MULTILINE).strip()))
        else:
            shown = _execute(body, source.count("\n", 0, start) + bool(head), path, defined)
            cells.append(Cell("code", body.strip(), tuple(shown)))
    return Script(tuple(cells), defined)


def _execute(body: str, before: int, path: Path, defined: dict[str, Any]) -> list[Any]:
    """Execute a cell's statements in order; the values of its bare expressions."""
    shown = []
    for node in ast.increment_lineno(ast.parse(body), before).body:
        if isinstance(node, ast.Expr):
            value = eval(compile(ast.Expression(node.value), str(path), "eval"), defined)
            if value is not None and not isinstance(node.value, ast.Constant):
                shown.append(value)
        else:
            exec(compile(ast.Module([node], []), str(path), "exec"), defined)
    return shown


@cache
def stating() -> dict[str, str]:
    """Equation's id → stem of the derivation that judges it, read off the scripts without running them."""
    found = {}
    for stem in names("derivations", "s"):
        for node in ast.walk(ast.parse((folder("derivations") / f"{stem}.py").read_text(encoding="utf-8"))):
            if (
                isinstance(node, ast.Call)
                and isinstance(node.func, ast.Name)
                and node.func.id == "verdict"
                and node.args
            ):
                first = node.args[0]
                if isinstance(first, ast.Constant) and isinstance(first.value, str):
                    found[first.value] = stem
    return found
