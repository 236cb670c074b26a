"""Modules beside a paper's scripts, such as `symbols.py`: imported by their names while a script of that paper runs."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType


@contextmanager
def importable(folder: Path, modules: dict[str, ModuleType]) -> Iterator[None]:
    """Within the block `import name` finds `folder/name.py`; two papers may each have a module of the same name.

    modules: those of the folder that were imported before; new ones are added to it.
    """
    before = dict(sys.modules)
    sys.modules.update(modules)
    sys.path.insert(0, str(folder))
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        for name, module in list(sys.modules.items()):
            if module is not before.get(name) and _lies_in(folder, module):
                modules[name] = module
                if name in before:
                    sys.modules[name] = before[name]
                else:
                    del sys.modules[name]


def _lies_in(folder: Path, module: ModuleType) -> bool:
    file = getattr(module, "__file__", None)
    return file is not None and Path(file).parent == folder and "." not in module.__name__
