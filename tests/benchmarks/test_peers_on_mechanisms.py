"""Other tools on growing mechanisms: the same right-hand side, reasons in place of what was not measured, tables. No times."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from benchmarks.mechanisms import comparison, deciding
from benchmarks.mechanisms.chains import JOINTS, VALUES, chain, g
from benchmarks.mechanisms.comparison import SAME, TIMES, TOOLS, operation_counts
from benchmarks.mechanisms.deciding import PAIRS
from benchmarks.mechanisms.own_tools import OWN
from benchmarks.mechanisms.tool import Ready, Tool
from lagrotor.benchmark import records
from lagrotor.benchmark.mechanism_tables import (
    COMPARISON_HEAD,
    MECHANISM_HEAD,
    TARGET_HEAD,
    comparison_rows,
    decision_rows,
    mechanism_rows,
    target_rows,
)
from lagrotor.benchmark.records import LINKS, Decided, Measured, MechanismKind, recorded_mechanisms
from lagrotor.errors import LagrotorError

CASES: tuple[tuple[MechanismKind, int], ...] = (("rods", 2), ("gyroscopes", 1))


def prepared(name: str, kind: MechanismKind, n: int) -> Ready:
    for module in (TOOLS[name].module, *TOOLS[name].others):
        pytest.importorskip(module, reason=f"{name} is not installed: pip install {TOOLS[name].install}")
    return TOOLS[name].prepare(kind, n)


@pytest.mark.parametrize("name", [name for name in TOOLS if name != "lagrotor"])
@pytest.mark.parametrize(("kind", "n"), CASES)
def test_every_tool_has_the_same_right_hand_side(name: str, kind: MechanismKind, n: int) -> None:
    ready = prepared(name, kind, n)
    y = np.random.default_rng(2).uniform(-0.5, 0.5, 2 * n * JOINTS[kind])
    ours = np.asarray(chain(kind, n).rhs(VALUES)(0.0, y))
    np.testing.assert_allclose(ready.rhs(0.0, y), ours, rtol=SAME, atol=SAME * np.abs(ours).max())
    # Twin: another gravity is seen.
    heavier = np.asarray(chain(kind, n).rhs(VALUES | {g: 1.001 * VALUES[g]})(0.0, y))
    assert np.abs(heavier - ours).max() > 1e3 * SAME * np.abs(ours).max()


@pytest.mark.parametrize("name", ["lagrotor", "lagrotor, fast", "MuJoCo", "Drake"])
def test_a_tools_own_run_converges_to_the_reference(name: str) -> None:
    ready = prepared(name, "rods", 2)
    begin = comparison.start("rods", 2)
    truth = comparison._scipy(chain("rods", 2).rhs(VALUES), begin, "DOP853", 1e-13)
    assert ready.run is not None
    errors = [np.abs(ready.run(begin, TIMES, setting) - truth).max() for setting in ready.settings[::5]]
    assert errors[-1] < 1e-7 and errors[-1] < errors[0] / 10


def test_a_tool_is_measured_and_one_with_another_motion_is_not_timed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(comparison, "forget_all", lambda: None)  # what sympy remembers is other tests', too
    monkeypatch.setattr(comparison, "_SAMPLE", 1e-5)
    found = comparison.measure(OWN["lagrotor"], Measured("rods", 2, "another"))
    assert found.difference == 0 and found.ready and found.rhs and found.run and found.by and not found.reason
    beside = comparison.measure(OWN["lagrotor"], Measured("rods", 2, "lagrotor"))
    assert beside.run and beside.ready is beside.rhs is None  # these are in the record of bodies and Lagrangians
    falling = Tool(lambda kind, n: Ready(lambda t, y: -np.asarray(chain(kind, n).rhs(VALUES)(t, y))))
    other = comparison.measure(falling, Measured("rods", 2, "falling"))
    assert "differs by 2.0e+00" in other.reason and other.ready is other.rhs is other.run is None


def test_what_is_not_installed_raises_or_takes_too_long_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    missing, broken = Tool(OWN["lagrotor"].prepare, "no_such_module", "--group peers"), Tool(partial(divmod))
    found = comparison.compare({"rods": (2, 3)}, {"missing": missing, "broken": broken})
    assert [x.tool for x in found] == ["missing", "broken"]  # no larger one after a failure
    assert found[0].reason == "no_such_module not installed: pip install --group peers"
    assert found[1].reason.startswith("TypeError: unsupported operand")
    monkeypatch.setattr(comparison, "_LONGEST", 0.01)
    (slow,) = comparison.compare({"rods": (3,)}, {"slow": OWN["lagrotor"]})
    assert slow.reason == "over 0.01 s" and slow.ready is None


@pytest.mark.parametrize("name", PAIRS)
def test_two_formulations_are_decided(name: str) -> None:
    left, right = PAIRS[name]()
    assert left.same_as(right).answer == ("nonzero" if "another" in name else "zero")


def test_simplify_is_given_its_time_and_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(deciding, "LONGEST", 0.01)
    assert deciding._by_simplify("triple pendulum, relative and absolute angles") == (0.01, "did not end")


def test_the_tables_say_what_is_wanted_and_a_dash_for_what_is_missing() -> None:
    own = Measured("rods", 6, "lagrotor", 0.01, 1e-6, 0.0, 1e-3, "its own at 1e-06")
    kane = replace(own, tool="KanesMethod", ready=0.2, rhs=5e-6)
    slow = Measured("rods", 6, "LagrangesMethod", reason="over 90 s")
    decided = [Decided("a pair", 0.01, "zero", 3.0, "zero"), Decided("another", 0.01, "zero", 60.0, "did not end")]
    assert mechanism_rows([slow, own])[1] == ("6 rods", "lagrotor", "10", "1", "1", "its own at 1×10⁻⁶", "0")
    assert mechanism_rows([slow])[0] == ("6 rods", "LagrangesMethod", "—", "—", "—", "over 90 s", "—")
    assert [row[2:] for row in decision_rows(decided)] == [
        ("yes", "3000", "yes", "300"),
        ("yes", "60000", "did not end", "over 6000"),
    ]
    arm = {"mechanism": "arm", "reason": "", "ready": 0.4, "rhs": 2e-5, "difference": 0.0}
    rows = [
        arm | {"tool": "lagrotor, bodies"},
        arm | {"tool": "KanesMethod", "ready": 6.04, "rhs": 1e-4, "difference": 2e-15},
    ]
    rows += [arm | {"tool": "lagrotor, Lagrangian", "difference": 1e-15}]
    rows += [dict.fromkeys(arm) | {"mechanism": "arm", "tool": "LagrangesMethod", "reason": "over 60 s"}]
    assert [row[2:] for row in comparison_rows(rows, 60)] == [
        ("400", "6040", "15.1", "20", "100", "5.0", "0 and 2×10⁻¹⁵"),
        ("400", "over 60 s", "over 150", "20", "—", "—", "1×10⁻¹⁵"),
    ]
    assert all(len(row) == len(COMPARISON_HEAD) for row in comparison_rows(rows, 60))
    counts = {"rods": [10, 20, 41, 90], "gyroscopes": [10, 20, 41, 90]}
    rods = {f"{n} rods": ready for n, ready in zip(LINKS["rods"], (0.005, 0.01, 0.02, 0.06), strict=True)}
    ours = {"tool": "lagrotor, bodies", "rhs": 1e-6}
    beside = [ours | {"mechanism": name, "ready": ready} for name, ready in rods.items()]
    beside += [{"mechanism": "6 rods", "tool": "KanesMethod", "ready": 0.2, "rhs": 5e-6}]
    table = target_rows([own, kane, slow], decided, counts, beside)
    assert [row[1:] for row in table[:3]] == [("15", "20.0"), ("4", "5.0"), ("3", "—")]
    assert [row[-1] for row in table[6:8]] == ["2.00, 2.05, 2.20", "2.00, 2.00, 3.00"] and table[-1][1:] == (
        "20",
        "300",
    )
    assert all(len(row) == len(TARGET_HEAD) for row in table) and all(
        len(row) == len(MECHANISM_HEAD) for row in mechanism_rows([own])
    )


def test_the_record_is_complete_and_its_counts_are_those_of_this_code() -> None:
    found = recorded_mechanisms()
    assert found.operations == operation_counts()
    assert all(x.ready is x.rhs is None for x in found.measured if x.tool in comparison.BESIDE)
    assert {x.tool for x in found.measured} == set(TOOLS)
    assert {(x.kind, x.n) for x in found.measured if x.tool == "lagrotor"} == {(k, n) for k in LINKS for n in LINKS[k]}
    assert all(x.reason or (x.difference is not None and x.difference < SAME) for x in found.measured)
    assert [x.pair for x in found.decided] == list(PAIRS)
    assert found.machine["processor"] and {"sympy", "heyoka", "mujoco", "drake", "pin"} <= found.versions.keys()


def test_a_broken_record_is_said(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    broken = tmp_path / "recorded.json"
    monkeypatch.setitem(records.FILES, "mechanisms", broken)
    for text in (None, "{", '{"measured": [{"speed": 1}], "decided": []}'):
        if text is not None:
            broken.write_text(text)
        with pytest.raises(LagrotorError, match="install lagrotor anew"):
            recorded_mechanisms()
