"""Import paths of earlier releases: each still imports the module of its new name, with a DeprecationWarning that names it."""

import sys
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any
from warnings import warn

# Old module → new module. A row of a package also covers the modules in it.
RENAMED = {
    "lagrotor.proved": "lagrotor.proofs",
}


def new_name(name: str) -> str | None:
    """Return the new name of a module by the longest row that covers it; None where no row does."""
    rows = [old for old in RENAMED if name == old or name.startswith(f"{old}.")]
    return RENAMED[old] + name.removeprefix(old) if (old := max(rows, key=len, default="")) else None


class RenamedModules(MetaPathFinder, Loader):
    """A finder of modules by their old names. It returns the module itself, never a second copy of it."""

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        """Warn, and return the specification of a renamed module; None for any other name."""
        if (new := new_name(name)) is None:
            return None
        warn(f"{name} is now {new}: import that instead", DeprecationWarning, stacklevel=2)
        return ModuleSpec(name, self)

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Import the module of the new name."""
        module = import_module(str(new_name(spec.name)))
        spec.loader_state = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        """Give the module its specification back, in whose place importing has put that of the old name."""
        module.__spec__ = module.__spec__ and module.__spec__.loader_state


def install() -> None:
    """Put the finder before Python's, once."""
    if not any(isinstance(finder, RenamedModules) for finder in sys.meta_path):
        sys.meta_path.insert(0, RenamedModules())
