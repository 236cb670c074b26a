"""The face of a room: the names that its `__init__.py` hands on, each imported when it is first used.

A face lists them as imports under `if TYPE_CHECKING:`, where type checkers read them; `import lagrotor` needs neither sympy nor
matplotlib.
"""

import ast
import sys
from collections.abc import Callable
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any


def names_of_face(file: Path) -> dict[str, str]:
    """Name → the module that defines it, of the names that an `__init__.py` hands on."""
    later = (node for node in ast.parse(file.read_text("utf-8")).body if isinstance(node, ast.If))
    imports = (node for block in later for node in block.body if isinstance(node, ast.ImportFrom))
    return {alias.name: str(node.module) for node in imports for alias in node.names}


def face(package: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """`__getattr__`, `__dir__` and `__all__` of a package that hands names on."""
    names = names_of_face(Path(str(sys.modules[package].__file__)))
    return partial(_import_name, package, names), partial(sorted, names), sorted(names)


def _import_name(package: str, names: dict[str, str], name: str) -> Any:
    if name in names:
        return getattr(import_module(names[name]), name)
    raise AttributeError(f"module {package!r} has no attribute {name!r}", name=name, obj=sys.modules[package])
