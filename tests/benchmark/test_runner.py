"""One scene, many methods: what is kept, listed and left out, and the front. No times of the machine."""

import json
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from lagrotor import Scene
from lagrotor.benchmark import runner as measure
from lagrotor.benchmark.runner import (
    SAMPLE,
    Case,
    ChartPoint,
    Failure,
    Method,
    benchmark,
    failure_sentences,
    front,
    work_at,
)
from lagrotor.benchmark.scenes_and_methods import CASES, METHODS
from lagrotor.commands.benchmark_commands import chart_data, chart_tables
from lagrotor.errors import LagrotorError


def small() -> Case:
    return Case(CASES["displaced"](True).scene, np.linspace(0, 1, 11), 1, "one second")


def broken(scene: Scene, times: Any) -> Any:
    raise LagrotorError("does not do this")


def absent(scene: Scene, times: Any) -> Any:
    raise ImportError("no module", name="pydy")


def moving(times: Any) -> Any:
    return np.zeros((2, len(times), 3)) + np.asarray(times)[:, None]


def halfway(scene: Scene, times: Any) -> Any:
    def run(tol: float) -> Any:
        if tol < 1e-4:
            raise RuntimeError("too tight\nand more")
        return moving(times), 1

    return run


def lost(scene: Scene, times: Any) -> Any:
    return lambda tol: (np.full((2, len(times), 3), np.nan), 1)


class Clock:
    """A clock that only runs advance, by seconds(setting, how often it was run) each."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, seconds: Callable[[float, int], float]) -> None:
        self.now, self.seconds, self.runs = 0.0, seconds, Counter[float]()
        monkeypatch.setattr(measure, "_CLOCK", lambda: self.now)

    def prepare(self, scene: Scene, times: Any) -> Any:
        self.runs.clear()

        def run(setting: float) -> Any:
            self.runs[setting] += 1
            self.now += self.seconds(setting, self.runs[setting])
            return moving(times), 1

        return run


def test_what_fails_or_is_absent_is_listed() -> None:
    methods = {"minimal": METHODS["minimal"], "broken": Method("core", broken), "lost": Method("core", lost)}
    methods |= {"early": Method("springs", lambda *_: lambda tol: (np.zeros((2, 4, 3)), 9))}
    methods |= {"absent": Method("peer", absent, install="--group peers"), "halfway": Method("core", halfway)}
    found = benchmark("small", small(), methods, (1e-3, 1e-6))
    assert {(p.method, p.setting) for p in found.points} == {("minimal", 1e-3), ("minimal", 1e-6), ("halfway", 1e-3)}
    assert [str(failure) for failure in found.failures] == [
        "absent: not installed (pydy): pip install --group peers",
        "broken: does not do this",
        "early: the run ended early, at 4 of 11 times",
        "halfway at 1e-06: too tight",
        "lost: a value is not finite",
    ]
    assert set(found.setup) == {"minimal", "early", "halfway", "lost"}
    assert min(p.error for p in found.points) >= found.floor
    words = chart_tables([found])
    assert "left out: broken: does not do this" in words
    assert json.loads(json.dumps(chart_data([found])))["charts"][0]["scene"] == "small"


def test_a_method_that_takes_long_is_not_run_at_finer_settings(monkeypatch: pytest.MonkeyPatch) -> None:
    slow = {"slow": Method("peer", Clock(monkeypatch, lambda setting, _: 0.3 / setting).prepare, (0.1, 0.01))}
    found = benchmark("small", small(), slow, (1e-3,), longest=2.0)
    assert [(p.setting, p.seconds) for p in found.points] == [(0.1, pytest.approx(3.0))]
    assert [str(failure) for failure in found.failures] == ["slow at 0.01: left out: at 0.1 a run took 3.0 s"]
    # Twin: with more time both are run.
    patient = benchmark("small", small(), slow, (1e-3,), longest=4.0)
    assert [p.setting for p in patient.points] == [0.1, 0.01]
    assert not patient.failures


def test_the_same_failure_is_listed_once() -> None:
    failures = [Failure("a", (), "why"), Failure("b", (1e-3,), "why"), Failure("c", (), "why")]
    assert failure_sentences(failures) == ["a; c: why", "b at 0.001: why"]


def test_a_first_run_that_compiles_neither_ends_a_method_nor_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    # A setting's first run takes 5 s, the others 1 ms; the crudest is run once more, before its turn.
    prepare = Clock(monkeypatch, lambda setting, count: 5.0 if count == 1 else 0.001).prepare
    fast, peer = (benchmark("small", small(), {"a": Method(f, prepare)}, (1e-3, 1e-4, 1e-5)) for f in ("fast", "peer"))
    assert [p.seconds for p in fast.points] == pytest.approx([0.001] * 3)
    assert [p.first for p in fast.points] == pytest.approx([0.001, 5, 5])
    assert fast.setup["a"] > 4.9
    # Twin: for another family the same run is a long one, and the last.
    assert [p.seconds for p in peer.points] == pytest.approx([0.001, 5])


def test_a_short_run_is_repeated_until_a_sample_is_full_and_a_long_one_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock(monkeypatch, lambda setting, _: SAMPLE.value * (3 if setting < 0.01 else 0.3))
    found = benchmark("small", small(), {"a": Method("core", clock.prepare, (0.1, 0.001))}, (1e-3,))
    # Once to get ready (the crudest), once for the error, and one sample.
    assert clock.runs == {0.1: 1 + 1 + 4, 0.001: 1 + 1}
    assert [p.seconds / SAMPLE.value for p in found.points] == pytest.approx([0.3, 3])


def point(name: str, error: float, evaluations: int, seconds: float, family: Any = "core") -> ChartPoint:
    return ChartPoint(name, family, 1, error, evaluations, seconds, seconds)


def test_the_front_keeps_what_nothing_beats() -> None:
    rows = ((1, 10, 1), (0.1, 5, 2), (0.2, 7, 3), (0.01, 20, 4), (2, 9, 9))
    points = [point("a", *row) for row in rows]
    assert [p.error for p in front(points)] == [1, 0.1, 0.01]
    assert [p.error for p in front(points, "nfev")] == [0.1, 0.01]
    assert front([*points, point("trap", 1e-3, 1, 0.1, "trap")]) == front(points)
    assert work_at(points, 0.1) == pytest.approx(2)
    assert work_at(points, 0.1 / 10**0.5) == pytest.approx(8**0.5)
    assert work_at(points, 1e-3) is None
    assert work_at([], 1) is None
    assert work_at([replace(p, nfev=0) for p in points], 0.1, "nfev") == 0
