"""Speed against accuracy: the text, the tables and the figure agree with the points. No times."""

import numpy as np
import pytest

from lagrotor.benchmark.runner import benchmark
from lagrotor.benchmark.scenes_and_methods import METHODS
from lagrotor.drawing import paper_style
from lagrotor.paper.rotor_pair.own_paper import PAPER

# Every method at every tolerance; what measures them is tested on few in tests/benchmark.
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def made():
    return PAPER.scripts.run("derivations", "b1_chart")


@pytest.fixture(scope="module")
def drawn():
    return PAPER.scripts.run("figures", "b1_chart")


def best(made, method):
    return min(p.error for p in made["found"].points if p.method == method)


def test_nothing_failed_and_no_table_has_seconds(made):
    assert made["found"].failures == made["missed"].failures == ()
    for table in made["tables"]:
        assert "second" not in " ".join(table.head)


def test_it_is_the_same_twice(made):
    again = benchmark(
        "displaced", made["displaced"], {name: METHODS[name] for name in ("minimal", "euler")}, (1e-7, 1e-13)
    )
    for p in again.points:
        (before,) = (q for q in made["found"].points if (q.method, q.setting) == (p.method, p.setting))
        assert (p.error, p.nfev) == (before.error, before.nfev)


def test_the_conclusion_is_what_the_points_say(made):
    points = [p for p in made["found"].points if p.nfev]
    assert best(made, "closed form") == pytest.approx(3e-11, rel=0.2)
    for error in (1e-7, 1e-8, 1e-9):
        spent = {name: nfev for name in {p.method for p in points} if (nfev := made["least"](name, error)) is not None}
        assert min(spent, key=spent.get) == "minimal, Adams"
    floor = made["found"].floor
    # To the error of the reference, which is itself known to a factor of two.
    assert all(best(made, name) < 2 * floor for name in ("minimal", "spheres", "minimal, Adams"))
    assert all(best(made, name) > 5 * floor for name in made["SCIPY"] if name != "ode, DOP853")
    assert best(made, "minimal, DOP853") > 5 * floor
    again = [p.nfev for p in points if p.method == "ode, DOP853" and p.setting > 1e-12]
    assert max(again) - min(again) <= 0.01 * min(again)
    assert round(made["ratio"]) == 4


def test_a_plain_call_misses_the_whole_shock(made):
    points = {(p.method, p.setting): p.error for p in made["missed"].points}
    assert len(points) == 12
    seen = {key for key, error in points.items() if error < 0.3}
    assert seen == {("solve_ivp, DOP853, one call", 1e-6)}


def test_an_error_never_reached_is_a_dash(made):
    assert made["needed"]("closed form", 1e-12) == "—"


def test_the_figure_draws_these_points(made, drawn):
    data = drawn["data"]()
    count = len([p for p in made["found"].points if p.method != drawn["CLOSED"]])
    assert np.isfinite(data["errors"]).sum() == np.isfinite(data["evaluations"]).sum() == count
    with paper_style():
        picture = drawn["figure"]()
    (panel,), (legend,) = picture.axes, picture.legends
    assert panel.get_xlabel().endswith("[1]") and panel.get_ylabel().endswith("[m]") and panel.get_title()
    lines = {line.get_label(): line for line in panel.get_lines()}
    assert [text.get_text() for text in legend.get_texts()] == list(lines)
    for i, name in enumerate(drawn["LOOKS"]):
        np.testing.assert_array_equal(lines[name].get_ydata(), data["errors"][i])
    np.testing.assert_array_equal(lines["front"].get_ydata(), [p.error for p in made["by_work"] if p.nfev])
    assert len({(line.get_color(), line.get_marker()) for line in lines.values()}) >= len(drawn["LOOKS"])


def test_its_words(drawn):
    assert 100 < len(drawn["CAPTION"]) < 1200 and 150 < len(drawn["ALT"]) < 700
    assert drawn["ALT"].endswith(".")
    assert all(np.isfinite(value) for value in drawn["measure"]().values())
