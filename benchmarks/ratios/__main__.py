"""`python -m benchmarks.ratios [WORDS …]`: speeds beside a rival in the same run, each with its wanted ratio.

Rows whose names contain one of the words are measured, without words all. Every row checks its work first. --old FOLDER adds
the sweeps of an older checkout, and with --whole its main job. --whole adds what takes minutes: the main job and the tests.
"""

import argparse
from importlib.util import find_spec
from pathlib import Path

from lagrotor.process_settings import begin_process

if __name__ == "__main__":
    begin_process()
    from benchmarks.ratios import processes, runs
    from benchmarks.ratios.pairs import HEAD, measured
    from lagrotor.errors import LagrotorError

    parser = argparse.ArgumentParser(prog="python -m benchmarks.ratios", description=__doc__)
    parser.add_argument("words", nargs="*", help="parts of the names of rows")
    parser.add_argument("--old", type=Path, metavar="FOLDER", help="an older checkout")
    parser.add_argument("--whole", action="store_true", help="also the main job and the tests")
    parser.add_argument("--pairs", type=int, metavar="N", help="the number of pairs of each row")
    arguments = parser.parse_args()
    old = arguments.old.resolve() if arguments.old else None
    rows = [*runs.rows(old), *processes.rows(), *(processes.whole_rows(old) if arguments.whole else [])]
    print(HEAD, flush=True)
    for row in rows:
        if arguments.words and not any(word in row.name for word in arguments.words):
            continue
        try:
            print(measured(row, arguments.pairs), flush=True)
        except (LagrotorError, ImportError) as reason:
            print(f"{row.name:<58}not measured: {reason}", flush=True)
    if not find_spec("heyoka"):
        print("The rows of the fast extra need heyoka: pip install 'lagrotor[fast]'")
