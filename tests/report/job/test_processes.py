"""Steps in several processes give what they give in one, and an error in one ends all."""

import os

import pytest

from lagrotor.report.job.processes import cores, results


def square(n: int) -> tuple[int, int]:
    if n < 0:
        raise ValueError(f"{n} is negative")
    return n * n, os.getpid()


@pytest.mark.parametrize("jobs", [1, 2])
def test_every_task_begins_and_gives_its_result(jobs: int) -> None:
    begun: list[int] = []
    found = dict(results(range(5), square, jobs, begun.append))
    assert {n: value for n, (value, _) in found.items()} == {n: n * n for n in range(5)}
    assert sorted(begun) == list(range(5))
    assert (os.getpid() in {process for _, process in found.values()}) == (jobs == 1)


@pytest.mark.parametrize("jobs", [1, 2])
def test_an_error_reaches_the_caller(jobs: int) -> None:
    with pytest.raises(ValueError, match="-1 is negative"):
        list(results([1, -1, 2], square, jobs, lambda task: None))


def test_a_debugger_has_one_process(monkeypatch: pytest.MonkeyPatch) -> None:
    assert cores() >= 1
    monkeypatch.setitem(__import__("sys").modules, "pydevd", None)
    assert cores() == 1
