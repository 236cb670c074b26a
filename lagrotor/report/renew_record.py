"""Renew what is on record: `python -m lagrotor.report.renew_record` the verdicts that `reproduce`, `audit` and `claims` compare
with, `python -m lagrotor.report.renew_record speed` the timings that the report shows.
"""

import sys

from lagrotor.benchmark.recorded_speed import renew_speed
from lagrotor.files import write_text
from lagrotor.paper import audit, claim_tests
from lagrotor.paper.record import RECORDED, OnRecord, as_text


def renew() -> None:
    """Judge every equation, try every claim, and write the verdicts with what they use."""
    found = {v.id: OnRecord(v.verdict, v.statement.depends_on) for v in audit.audit()}
    found |= {result.test.id: OnRecord(result.finding.outcome) for result in claim_tests.evaluate()}
    write_text(RECORDED, as_text(found))


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["speed"]):
        sys.exit("usage: python -m lagrotor.report.renew_record [speed]")
    renew_speed() if sys.argv[1:] else renew()
