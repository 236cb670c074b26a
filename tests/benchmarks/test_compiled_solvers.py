"""Candidates for the fast extra: right where they are installed, and what they refuse. No times."""

from typing import Any

import numpy as np
import pytest

from benchmarks.compiled_solvers import CANDIDATES
from lagrotor import simulate
from lagrotor.benchmark.scenes_and_methods import CASES
from lagrotor.errors import InputError

TIMES = np.linspace(0, 2, 21)
NEEDS = {"minimal, CyRK": ("numba", "CyRK"), "minimal, numba": ("numba",)}


def prepare(name: str, course: str) -> Any:
    for module in NEEDS[name]:
        pytest.importorskip(module, reason=f"{name} is not installed: pip install {CANDIDATES[name].install}")
    return CANDIDATES[name].prepare(CASES[course](True).scene, TIMES)


def test_every_candidate_is_tested() -> None:
    assert set(NEEDS) == set(CANDIDATES)


@pytest.mark.parametrize("name", CANDIDATES)
@pytest.mark.parametrize("course", ["displaced", "heavy"])
def test_a_candidate_meets_its_tolerance(name: str, course: str) -> None:
    run = prepare(name, course)
    truth = simulate(CASES[course](True).scene, TIMES, "minimal", 1e-13).tips
    errors = [float(np.linalg.norm(run(tol)[0] - truth, axis=-1).max()) for tol in (1e-4, 1e-7, 1e-10)]
    assert errors[0] > 100 * errors[1] > 1e4 * errors[2]
    assert errors[2] < 1e-10
    assert run(1e-4)[1] < run(1e-10)[1] < 2000


@pytest.mark.parametrize("name", CANDIDATES)
def test_a_candidate_takes_no_shock(name: str) -> None:
    with pytest.raises(InputError, match="no shock"):
        prepare(name, "shock")
