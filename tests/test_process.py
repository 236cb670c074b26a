"""How a process of a long computation begins."""

import gc
import os

import pytest

from lagrotor.process_settings import begin_process


def test_a_process_has_one_thread_of_linear_algebra_unless_its_user_chose_otherwise(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "3")
    begin_process()
    assert (os.environ["OMP_NUM_THREADS"], os.environ["OPENBLAS_NUM_THREADS"]) == ("1", "3")


def test_garbage_is_still_found() -> None:
    begin_process(2_000_000)
    assert gc.isenabled() and gc.get_threshold()[0] == 2_000_000
    begin_process()
    assert 700 < gc.get_threshold()[0] < 2_000_000
    circle: list[object] = []
    circle.append(circle)
    del circle
    assert gc.collect() > 0
