"""The comparison on mechanisms as it is shown: tables and figure are the record."""

import pytest

from benchmarks.bodies_and_lagrangians import CHAINS
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER


@pytest.fixture(scope="module")
def made():
    return PAPER.scripts.run("derivations", "b3_mechanisms")


def test_the_tables_are_the_record(made):
    found, (_, tools, decided, beside) = made["found"], made["tables"]
    assert found.machine["processor"] in tools.note and len(tools.rows) == len(found.measured)
    row = next(row for row in tools.rows if row[:2] == ("6 rods", "MuJoCo"))
    (own,) = (x for x in found.measured if (x.kind, x.n, x.tool) == ("rods", 6, "MuJoCo"))
    assert row[2:4] == (f"{1e3 * own.ready:.3g}", f"{1e6 * own.rhs:.3g}")
    # lagrotor's time to be ready with 24 rods is shown once.
    shown = [row for table in (tools, beside) for row in table.rows if row[0] == "24 rods"]
    assert [row[2] for row in shown if row[1] in ("lagrotor", "bodies") and row[2] != "—"] == ["3070"]
    for table in made["tables"]:
        assert found.date in table.note or made["beside"]["date"] in table.note
    assert len(decided.rows) == len(found.decided)
    names = [*CHAINS["rods"], *CHAINS["gyroscopes"], "arm", "bicycle"]
    assert [row[:2] for row in beside.rows] == [(name, source) for name in names for source in ("bodies", "Lagrangian")]
    assert all(row["reason"] or row["difference"] < 1e-9 for row in made["beside"]["rows"])
    assert not [row for row in made["beside"]["rows"] if row["reason"] and row["tool"].startswith("lagrotor")]
    assert all(len(row) == len(table.head) for table in made["tables"] for row in table.rows)
