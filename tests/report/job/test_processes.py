"""Steps in several processes give what they give in one, and an error in one ends all."""

import os

import pytest

from lagrotor.report.job.processes import results


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


def plus(n: int, other: int) -> int:
    return n + other


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_task_waits_for_what_it_is_given(jobs: int) -> None:
    """Each of 3, 2, 1 is given the result of the one below it: they end in the other order."""
    found: dict[int, int] = {0: 0}

    def given(n: int) -> tuple[int] | None:
        return (found[n - 1],) if n - 1 in found else None

    for n, value in results([3, 2, 1], plus, jobs, lambda task: None, given):
        found[n] = value
    assert list(found.items()) == [(0, 0), (1, 1), (2, 3), (3, 6)]
