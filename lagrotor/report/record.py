"""Renew the record that `reproduce`, `audit` and `claims` compare with: `python -m lagrotor.report.record`."""

import json

from ..numerics.files import write_text
from ..paper import audit, trials
from .reproduce import RECORDED, outcomes


def renew() -> None:
    """Judge every equation, try every claim, and write id → verdict."""
    found = outcomes(audit.audit(), trials.hear_all())
    write_text(RECORDED, json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    renew()
