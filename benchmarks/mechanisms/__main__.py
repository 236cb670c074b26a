"""`python -m benchmarks.mechanisms`: the comparison with other tools, some minutes; prints its tables.

--record writes it to the record that the report shows.
"""

import argparse
import json
from dataclasses import asdict

from benchmarks.machine import machine, versions
from benchmarks.mechanisms.comparison import compare, operation_counts, ready_in_turns
from benchmarks.mechanisms.deciding import decide_pairs
from lagrotor.benchmark.mechanism_tables import DECIDED_HEAD, HEAD, WANTED_HEAD, decided_rows, rows, wanted
from lagrotor.benchmark.records import LINKS, MECHANISMS, Comparison
from lagrotor.files import write_text

if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mechanisms", description=__doc__)
    parser.add_argument("--record", action="store_true", help="write the record")
    arguments = parser.parse_args()
    ready = {kind: ready_in_turns(kind) for kind in LINKS}
    made = Comparison(machine(), versions(), compare(step=print), decide_pairs(), operation_counts(), ready)
    if arguments.record:
        print(write_text(MECHANISMS, json.dumps(asdict(made), indent=1, ensure_ascii=False) + "\n"))
    for head, body in (
        (HEAD, rows(made.measured)),
        (DECIDED_HEAD, decided_rows(made.decided)),
        (WANTED_HEAD, wanted(made.measured, made.decided, made.operations, made.ready)),
    ):
        print("", " | ".join(head), *(" | ".join(row) for row in body), sep="\n")
