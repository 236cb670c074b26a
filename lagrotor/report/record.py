"""Renew what is on record: `python -m lagrotor.report.record` the verdicts that `reproduce`, `audit` and `claims` compare
with, `python -m lagrotor.report.record speed` the seconds that the report tells.
"""

import json
import sys

from lagrotor.benchmark.recorded_speed import renew_speed
from lagrotor.files import write_text
from lagrotor.paper import audit, trials
from lagrotor.report.reproduce import RECORDED, outcomes


def renew() -> None:
    """Judge every equation, try every claim, and write id → verdict."""
    found = outcomes(audit.audit(), trials.hear_all())
    write_text(RECORDED, json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["speed"]):
        sys.exit("usage: python -m lagrotor.report.record [speed]")
    renew_speed() if sys.argv[1:] else renew()
