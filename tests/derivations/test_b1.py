"""Speed against accuracy: the text, the tables and the figure agree with the points. No times."""

import pytest

from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

# Every method at every tolerance; what measures them is tested on few in tests/benchmark.
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def made():
    return PAPER.scripts.run("derivations", "b1_chart")


def best(made, method):
    return min(p.error for p in made["found"].points if p.method == method)


def test_nothing_failed_and_no_table_has_seconds(made):
    assert made["found"].failures == made["missed"].failures == ()
    for table in made["tables"]:
        assert "second" not in " ".join(table.head)


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
