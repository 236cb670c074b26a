"""The comparison on mechanisms as it is shown: tables and figure are the record."""

import numpy as np
import pytest

from benchmarks.bodies_and_lagrangians import CHAINS
from benchmarks.mechanisms.comparison import TOOLS
from lagrotor.drawing import paper_style
from lagrotor.paper.rotor_pair.own_paper import PAPER


@pytest.fixture(scope="module")
def made():
    return PAPER.scripts.run("derivations", "b3_mechanisms")


@pytest.fixture(scope="module")
def drawn():
    return PAPER.scripts.run("figures", "b2_mechanisms")


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


def test_the_figure_draws_these_points(made, drawn):
    assert set(drawn["LOOKS"]) - {"lagrotor, bodies"} == set(TOOLS) - {"lagrotor"}
    data = drawn["data"]()
    with paper_style():
        picture = drawn["figure"]()
    assert len(picture.axes) == 4
    lines = {line.get_label(): line for line in picture.axes[2].get_lines()}
    for i, name in enumerate(drawn["LOOKS"]):
        np.testing.assert_allclose(lines[name].get_ydata(), 1e6 * data["rhs of rods"][i])  # in µs
    measured = [x for x in made["found"].measured if x.kind == "rods"]
    beside = [x for x in made["beside"]["rows"] if x["mechanism"].endswith("rods") and x["tool"] in drawn["BESIDE"]]
    count = len([x for x in measured if x.rhs]) + len([x for x in beside if x["rhs"]])
    assert np.isfinite(data["rhs of rods"]).sum() == count


def test_its_words(drawn):
    assert drawn["CAPTION"].count("The measurement is of") == 2
    assert 100 < len(drawn["CAPTION"]) < 1200 and 150 < len(drawn["ALT"]) < 700
    assert all(np.isfinite(value) for value in drawn["measure"]().values())
