"""`python -m benchmarks.mechanisms`: the comparison with other tools, some minutes; prints its tables.

--record writes it to the record that the report shows.
"""

import argparse
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
from lagrotor.benchmark.records import recorded_bodies_and_lagrangians, write_record

if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mechanisms", description=__doc__)
    parser.add_argument("--record", action="store_true", help="write the record")
    arguments = parser.parse_args()
    measured, decided, operations = compare(step=print), decide_pairs(), operation_counts()
    if arguments.record:
        rows = [{name: x for name, x in asdict(row).items() if x not in (None, "")} for row in measured]
        made = {"machine": machine(), "versions": versions(), "measured": rows, "operations": operations}
        print(write_record("mechanisms", made | {"decided": list(map(asdict, decided))}))
    for head, body in (
        (MECHANISM_HEAD, mechanism_rows(measured)),
        (DECISION_HEAD, decision_rows(decided)),
        (
            TARGET_HEAD,
            target_rows(measured, decided, operations, recorded_bodies_and_lagrangians()["rows"]),
        ),
    ):
        print("", " | ".join(head), *(" | ".join(row) for row in body), sep="\n")
