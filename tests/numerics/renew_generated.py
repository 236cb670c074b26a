"""Derive again every function that is kept as source, and write the files `generated.txt`:
`python -m tests.numerics.renew_generated`."""

from importlib import import_module
from pathlib import Path

from lagrotor.files import write_text
from lagrotor.numerics import generated


def derived_files() -> dict[Path, str]:
    """Every `generated.txt` of the package, derived anew."""
    for name in (
        "models.simulate",
        "models.orbits.precession",
        "theory.charged_particle",
        "report.interactive.interactive",
    ):
        import_module(f"lagrotor.{name}")
    return generated.files()


if __name__ == "__main__":
    for file, text in derived_files().items():
        print(write_text(file, text))
