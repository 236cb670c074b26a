"""Renew what is kept: `python -m lagrotor.report.renew_record speed` the timings that the report shows, `… code` the functions
kept as source in `generated.txt` files. Verdicts are put on record by `lagrotor audit --record`, `lagrotor claims --record`.
"""

import sys
from importlib import import_module
from pathlib import Path

from lagrotor.benchmark.recorded_speed import renew_speed
from lagrotor.files import write_text
from lagrotor.numerics import generated


def generated_code() -> dict[Path, str]:
    """Every `generated.txt` of the package, derived anew."""
    for name in ("models.simulate", "models.orbits.precession", "report.interactive.interactive"):
        import_module(f"lagrotor.{name}")
    return generated.files()


def renew_code() -> None:
    """Derive every function that is kept as source, and write its source."""
    for file, text in generated_code().items():
        write_text(file, text)


if __name__ == "__main__":
    renewals = {"speed": renew_speed, "code": renew_code}
    if len(sys.argv) != 2 or sys.argv[1] not in renewals:
        sys.exit("usage: python -m lagrotor.report.renew_record speed | code")
    renewals[sys.argv[1]]()
