"""`python -m benchmarks.mechanisms`: the comparison with other tools, some minutes; prints its tables.

--record writes it to the record that the report shows.
"""

import argparse
import json
from dataclasses import asdict

from benchmarks.machine import machine, versions
from benchmarks.mechanisms.comparison import compare, operation_counts
from benchmarks.mechanisms.deciding import decide_pairs
from lagrotor.benchmark.mechanism_tables import (
    DECISION_HEAD,
    MECHANISM_HEAD,
    TARGET_HEAD,
    decision_rows,
    mechanism_rows,
    target_rows,
)
from lagrotor.benchmark.records import MECHANISMS, Comparison, recorded_bodies_and_lagrangians, stamp
from lagrotor.files import write_text

if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mechanisms", description=__doc__)
    parser.add_argument("--record", action="store_true", help="write the record")
    arguments = parser.parse_args()
    when, results = stamp("mechanisms"), (compare(step=print), decide_pairs(), operation_counts())
    made = Comparison(when["date"], when["digest"], machine(), versions(), *results)
    if arguments.record:
        rows = [{name: x for name, x in asdict(row).items() if x not in (None, "")} for row in made.measured]
        print(
            write_text(MECHANISMS, json.dumps(asdict(made) | {"measured": rows}, indent=1, ensure_ascii=False) + "\n")
        )
    for head, body in (
        (MECHANISM_HEAD, mechanism_rows(made.measured)),
        (DECISION_HEAD, decision_rows(made.decided)),
        (
            TARGET_HEAD,
            target_rows(made.measured, made.decided, made.operations, recorded_bodies_and_lagrangians()["rows"]),
        ),
    ):
        print("", " | ".join(head), *(" | ".join(row) for row in body), sep="\n")
