"""Renew what is on record: `python -m lagrotor.report.renew_record` the verdicts that `reproduce`, `audit` and `claims` compare
with; with `speed`, the timings that the report shows; with `code`, the functions kept as source in `generated.txt` files.
"""

import sys
from importlib import import_module
from pathlib import Path

from lagrotor.benchmark.recorded_speed import renew_speed
from lagrotor.files import write_text
from lagrotor.numerics import generated
from lagrotor.paper import audit, claim_tests
from lagrotor.paper.record import RECORDED, OnRecord, as_text


def renew() -> None:
    """Judge every equation, try every claim, and write the verdicts with what they use."""
    found = {v.id: OnRecord(v.verdict, v.statement.depends_on) for v in audit.audit()}
    found |= {result.test.id: OnRecord(result.finding.outcome) for result in claim_tests.evaluate()}
    write_text(RECORDED, as_text(found))


def generated_code() -> dict[Path, str]:
    """Every `generated.txt` of the package, derived anew."""
    for name in ("lagrotor.models.simulate", "lagrotor.models.orbits.precession"):
        import_module(name)
    return generated.files()


def renew_code() -> None:
    """Derive every function that is kept as source, and write its source."""
    for file, text in generated_code().items():
        write_text(file, text)


if __name__ == "__main__":
    renewals = {(): renew, ("speed",): renew_speed, ("code",): renew_code}
    if tuple(sys.argv[1:]) not in renewals:
        sys.exit("usage: python -m lagrotor.report.renew_record [speed | code]")
    renewals[tuple(sys.argv[1:])]()
