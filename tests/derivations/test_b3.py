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
    found, (wanted, tools, decided, beside) = made["found"], made["tables"]
    assert all(found.machine["processor"] in table.note for table in (wanted,)) and len(tools.rows) == len(
        found.measured
    )
    row = next(row for row in tools.rows if row[:2] == ("6 rods", "lagrotor"))
    (own,) = (x for x in found.measured if (x.kind, x.n, x.tool) == ("rods", 6, "lagrotor"))
    assert row[2:4] == (f"{1e3 * own.ready:.3g}", f"{1e6 * own.rhs:.3g}")
    assert len(decided.rows) == len(found.decided)
    names = [*CHAINS["rods"], *CHAINS["gyroscopes"], "arm", "bicycle"]
    assert [row[:2] for row in beside.rows] == [(name, source) for name in names for source in ("bodies", "Lagrangian")]
    assert all(row["reason"] or row["difference"] < 1e-9 for row in made["beside"]["rows"])
    assert not [row for row in made["beside"]["rows"] if row["reason"] and row["tool"].startswith("lagrotor")]
    assert all(len(row) == len(table.head) for table in made["tables"] for row in table.rows)


def test_the_figure_draws_these_points(made, drawn):
    assert set(drawn["LOOKS"]) == set(TOOLS)
    data = drawn["data"]()
    with paper_style():
        picture = drawn["figure"]()
    assert len(picture.axes) == 4
    lines = {line.get_label(): line for line in picture.axes[2].get_lines()}
    for i, name in enumerate(drawn["LOOKS"]):
        np.testing.assert_allclose(lines[name].get_ydata(), 1e6 * data["rhs of rods"][i])  # in µs
    measured = [x for x in made["found"].measured if x.kind == "rods"]
    assert np.isfinite(data["rhs of rods"]).sum() == len([x for x in measured if x.rhs])


def test_its_words(drawn):
    assert 100 < len(drawn["CAPTION"]) < 1200 and 150 < len(drawn["ALT"]) < 700
    assert all(np.isfinite(value) for value in drawn["measure"]().values())
