"""Lazy imports: a package's `__init__.py` lists its public names, and each is imported when it is first used.

The names stand as imports under `if TYPE_CHECKING:`, where type checkers read them. So `import lagrotor` needs neither sympy nor
matplotlib.
"""

import ast
import sys
from collections.abc import Callable
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from lagrotor.renamed import old_name


def names_of_face(file: Path) -> dict[str, str]:
    """Return {name: module that defines it} for the public names of an `__init__.py`."""
    later = (node for node in ast.parse(file.read_text("utf-8")).body if isinstance(node, ast.If))
    imports = (node for block in later for node in block.body if isinstance(node, ast.ImportFrom))
    return {alias.name: str(node.module) for node in imports for alias in node.names}


def face(package: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return `__getattr__`, `__dir__` and `__all__` for the `__init__.py` of a package, which assigns them to these names."""
    names = names_of_face(Path(str(sys.modules[package].__file__)))
    return partial(_import_name, package, names), partial(sorted, names), sorted(names)


def _import_name(package: str, names: dict[str, str], name: str) -> Any:
    if name in names:
        return getattr(import_module(names[name]), name)
    if (renamed_object := old_name(package, name)) is not None:
        return renamed_object
    raise AttributeError(f"module {package!r} has no attribute {name!r}", name=name, obj=sys.modules[package])
