"""Where the literate scripts live: beside the package in a checkout, inside it when installed from a wheel."""

import re
import runpy
from functools import cache
from pathlib import Path
from typing import Any

from lagrotor.errors import LagrotorError

_PACKAGE = Path(__file__).resolve().parent.parent


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

    Derivations: s… sections, c… claims, m… tables, t… theory past the paper, p… the table of it.
    """
    found = (path.stem for path in folder(kind).glob(f"{prefix}*.py") if not path.stem.startswith("_"))
    return sorted(found, key=lambda stem: [(int(n or 0), text) for n, text in re.findall(r"(\d*)(\D*)", stem)])


@cache
def run(kind: str, stem: str) -> dict[str, Any]:
    """Run one script, once in a process, and hand on the names it defines."""
    return runpy.run_path(str(folder(kind) / f"{stem}.py"))
