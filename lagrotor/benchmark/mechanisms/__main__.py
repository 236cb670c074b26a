"""`python -m lagrotor.benchmark.mechanisms`: the comparison with other tools, some minutes; prints its tables.

--record writes it to the record that the report shows.
"""

import argparse

from lagrotor.benchmark.mechanisms.comparison_tables import DECIDED_HEAD, HEAD, WANTED_HEAD, decided_rows, rows, wanted
from lagrotor.benchmark.mechanisms.recorded_mechanisms import measure_all, write_record

if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m lagrotor.benchmark.mechanisms", description=__doc__)
    parser.add_argument("--record", action="store_true", help="write the record")
    given = parser.parse_args()
    found = measure_all(print)
    if given.record:
        print(write_record(found))
    for head, body in (
        (HEAD, rows(found.measured)),
        (DECIDED_HEAD, decided_rows(found.decided)),
        (WANTED_HEAD, wanted(found.measured, found.decided, found.operations, found.ready)),
    ):
        print("", " | ".join(head), *(" | ".join(row) for row in body), sep="\n")
