"""Where the literate scripts live: beside the package in a checkout, inside it when installed from a wheel."""

import runpy
from pathlib import Path
from typing import Any

from ..errors import LagrotorError

_PACKAGE = Path(__file__).resolve().parent.parent


def folder(name: str) -> Path:
    """The folder `derivations` or `figures`."""
    for base in (_PACKAGE, _PACKAGE.parent):
        if (base / name).is_dir():
            return base / name
    raise LagrotorError(f"the folder {name} is missing beside {_PACKAGE}: install lagrotor again")


def names(kind: str) -> list[str]:
    """Stems of the scripts in a folder, in order."""
    return sorted(path.stem for path in folder(kind).glob("*.py") if not path.stem.startswith("_"))


def run(kind: str, stem: str) -> dict[str, Any]:
    """Run one script and hand on the names it defines."""
    return runpy.run_path(str(folder(kind) / f"{stem}.py"))
