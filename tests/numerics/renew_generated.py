"""Derive again every function that is kept as source, and write the files `generated.txt`:
`python -m tests.numerics.renew_generated`."""

import sys
from importlib import import_module
from pathlib import Path

from sympy import __version__

from lagrotor.files import write_text
from lagrotor.numerics.source_cache import GeneratedFunction


def kept_functions() -> list[GeneratedFunction]:
    """Those of the modules that are imported, by name."""
    modules = [vars(module).values() for name, module in [*sys.modules.items()] if name.startswith("lagrotor.")]
    every = {id(one): one for values in modules for one in values if isinstance(one, GeneratedFunction)}
    return sorted(every.values(), key=GeneratedFunction.name)


def derived_files() -> dict[Path, str]:
    """Every `generated.txt` of the package, derived anew, with the version of sympy that printed it."""
    for name in (
        "models.simulate",
        "models.orbits.precession",
        "theory.charged_particle",
    ):
        import_module(f"lagrotor.{name}")
    blocks: dict[Path, str] = {}
    for one in kept_functions():
        for given in one.cases:
            block = f"# %% {one.name(*given)}\n{one.derive(*given)}\n\n"
            blocks[one.file] = blocks.get(one.file, f"# sympy {__version__}\n\n") + block
    return blocks


if __name__ == "__main__":
    for file, text in derived_files().items():
        print(write_text(file, text))
