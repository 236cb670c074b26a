"""The order of the steps, by the times of an earlier run, which the paper brings along; and which of them run."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.job import reproduce
from lagrotor.report.job.cache import derived_as_json
from lagrotor.report.job.dependencies import TIMES
from lagrotor.report.job.reproduce import longest_first
from lagrotor.report.job.steps import Derived, JobStep, derive, steps


def test_the_paper_brings_the_time_of_each_step() -> None:
    """They are renewed by a run from nothing on a quiet machine: `cp report/times.json lagrotor/paper/rotor_pair/`."""
    recorded = json.loads((PAPER.folder / TIMES).read_text(encoding="utf-8"))
    assert recorded["seconds"].keys() - {"report"} == {step.name for step in steps(PAPER)}
    assert not recorded["taken from earlier runs"]


def step(name: str, *derivations: str) -> SimpleNamespace:
    return SimpleNamespace(name=name, derivations=derivations)


@pytest.mark.parametrize(
    ("seconds", "order"),
    [
        ({"a": 1, "b": 2, "c": 3}, "cba"),
        ({"a": 1, "b": 3}, "bca"),  # c takes the mean
        ({}, "abc"),
    ],
)
def test_the_longest_step_comes_first(seconds: dict[str, float], order: str) -> None:
    assert [step.name for step in longest_first([step(name) for name in "abc"], seconds)] == list(order)


def test_a_step_counts_with_what_waits_for_it() -> None:
    """b alone is short, but c waits for a, which waits for b: 1 + 1 + 3 is more than d."""
    four = [step("c", "a"), step("d"), step("a", "b"), step("b")]
    assert [step.name for step in longest_first(four, {"a": 1, "b": 1, "c": 3, "d": 3.5})] == ["b", "a", "d", "c"]


class Run:
    """Steps that run without any work, with a cache of some derivations."""

    def __init__(self, folder: Path, stored: dict[str, Any]) -> None:
        self.folder, self.stored, self.kept, self.begun = folder, stored, dict[str, Any](), list[str]()
        self.paper = SimpleNamespace(folder=folder)

    def take(self, name: str, made_from: str) -> Any:
        return self.stored.get(name)

    def keep(self, name: str, made_from: str, product: Any) -> None:
        self.kept[name] = product

    @contextmanager
    def progress(self, total: int, first: str) -> Iterator[Any]:
        self.first = first
        yield self.begun.append

    def of(self, *all_steps: JobStep) -> dict[str, Any]:
        made = reproduce._make(self, list(all_steps), self.folder, self.progress, 1, self.folder, set())  # type: ignore[arg-type]
        return made[0]


def derived(stem: str) -> Derived:
    return Derived(stem, "", (), (), (), "", {"measured": 7})


def job_step(folder: Path, name: str, imports: str = "") -> JobStep:
    """A step that returns the value that it imports."""
    kind, stem = name.split()
    source = folder / f"{stem}.py"
    source.write_text(f'take("{imports}")')

    def value(paper: Any, key: str, folder: Path) -> Any:
        return (
            derived(key) if kind == "derivation" else imports and paper.scripts.run("derivations", imports)["measured"]
        )

    return JobStep(name, value, PAPER, stem, source)


def test_steps_run_in_the_order_of_the_times(tmp_path: Path) -> None:
    (tmp_path / TIMES).write_text('{"seconds": {"figure t1": 1, "figure t2": 3, "figure t3": 2}}')
    run = Run(tmp_path, {})
    run.of(*(job_step(tmp_path, name) for name in ("figure t1", "figure t2", "figure t3")))
    assert run.begun == ["figure t2", "figure t3", "figure t1", "report"]


@pytest.mark.parametrize(
    ("stored", "begun"),
    [
        (["derivation t13_integrals"], ["figure t13", "report"]),  # its value is stored
        (["derivation t13_integrals", "figure t13"], ["report"]),
        (["figure t13"], ["derivation t13_integrals", "report"]),
    ],
)
def test_a_stored_result_is_not_computed_again(stored: list[str], begun: list[str], tmp_path: Path) -> None:
    derivation, figure = (
        job_step(tmp_path, "derivation t13_integrals"),
        job_step(tmp_path, "figure t13", "t13_integrals"),
    )
    if derivation.name in stored:
        derivation = replace(derivation, run=derive)  # such results are restored as derivations
    data = {derivation.name: derived_as_json(derived("t13_integrals")), figure.name: 7}
    run = Run(tmp_path, {name: data[name] for name in stored})
    assert run.of(derivation, figure)[figure.name] == 7
    assert run.begun == begun


TIMED = (step("a"), step("b", "a"), step("c"))


@pytest.mark.parametrize(
    ("expected", "jobs", "seconds", "left"),
    [
        ({"a": 3, "b": 4, "c": 7, "report": 1}, 1, {}, "15 s"),
        ({"a": 3, "b": 4, "c": 7, "report": 1}, 2, {}, "8 s"),
        ({"a": 3, "b": 4, "c": 5, "report": 1}, 8, {}, "8 s"),  # b waits for a
        ({"a": 3, "b": 4, "c": 7, "report": 1}, 1, {"c": 15.0}, "16 s"),  # half as fast as in the earlier run
        ({"a": 300, "b": 4, "c": 7, "report": 1}, 1, {}, "5 minutes"),
        ({"a": 3, "b": 4, "report": 1}, 1, {}, ""),  # c has no recorded time
        ({"a": 3, "b": 4, "c": 7}, 1, {}, ""),
        ({}, 1, {}, ""),
    ],
)
def test_the_remaining_time(expected: dict[str, float], jobs: int, seconds: dict[str, float], left: str) -> None:
    assert reproduce._time_left(list(TIMED), expected, jobs, seconds) == left  # type: ignore[arg-type]


def test_a_run_begins_with_what_it_takes(tmp_path: Path) -> None:
    steps_ = [job_step(tmp_path, name) for name in ("figure t1", "figure t2")]
    run = Run(tmp_path, {"figure t2": 7})
    run.of(*steps_)
    assert run.first == "1 of 2 results to compute, with --jobs 1"
    (tmp_path / TIMES).write_text('{"seconds": {"figure t1": 30, "figure t2": 3, "report": 2}}')
    run.of(*steps_)
    assert run.first == "1 of 2 results to compute, with --jobs 1: about 32 s, by the times of an earlier run"
    assert run.begun[-2:] == ["figure t1; about 32 s left", "report; about 0 s left"]


def test_a_damaged_file_of_times_is_ignored(tmp_path: Path) -> None:
    assert reproduce._seconds(tmp_path) == {}
    for text in ("{", "[1]", '{"seconds": [1]}', '{"seconds": {"a": "x"}}'):
        (tmp_path / TIMES).write_text(text)
        assert reproduce._seconds(tmp_path) == {}
    (tmp_path / TIMES).write_text('{"seconds": {"a": 2}}')
    assert reproduce._seconds(tmp_path) == {"a": 2.0}
