"""Other tools on the pair: each gets the motion right, to the order and floor it is known for. No times."""

from dataclasses import replace
from importlib.util import find_spec
from typing import Any

import numpy as np
import pytest

from benchmarks.peers import PEERS
from benchmarks.peers.sympy_mechanics import check_odeint
from lagrotor import simulate
from lagrotor.benchmark.runner import Case, benchmark
from lagrotor.benchmark.scenes_and_methods import CASES
from lagrotor.errors import IntegrationError
from lagrotor.numerics import measured_order

SCENE = CASES["displaced"](True).scene
TIMES = np.linspace(0, 1, 11)
NEEDS = {
    "LagrangesMethod": "sympy",
    "PyDy, lambdify": "pydy",
    "PyDy, Cython": "pydy",
    "CasADi CVODES": "casadi",
    "CasADi CVODES, Adams": "casadi",
    "scikit-sundae": "sksundae",
    "MuJoCo": "mujoco",
    "Pinocchio": "pinocchio",
    "Drake, SAP": "pydrake",
    "Drake, multipliers": "pydrake",
}
# Order of the error in the step.
ORDERS = {"MuJoCo": 2, "Drake, SAP": 1}


def run_of(name: str, scene: Any = SCENE) -> Any:
    pytest.importorskip(NEEDS[name], reason=f"{name} is not installed: pip install {PEERS[name].install}")
    if name == "PyDy, Cython":
        pytest.importorskip("Cython", reason="PyDy compiles with it")
    return PEERS[name].prepare(scene, TIMES)


@pytest.fixture(scope="module")
def truth() -> Any:
    return simulate(SCENE, TIMES, "minimal", 1e-13).tips


def off(tips: Any, truth: Any) -> float:
    return float(np.linalg.norm(tips - truth, axis=-1).max())


def test_every_peer_is_tested() -> None:
    assert set(NEEDS) == set(PEERS)
    assert {name for name, given in PEERS.items() if given.steps} == set(ORDERS)


# Slow: derived anew by sympy.physics.mechanics; its equations of smaller mechanisms are compared in test_peers_on_mechanisms.
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow) if name == "LagrangesMethod" else name
        for name in PEERS
        if name not in ORDERS
    ],
)
def test_a_peer_with_a_tolerance_meets_it(name: str, truth: Any) -> None:
    run = run_of(name)
    (crude, few), (fine, many) = run(1e-4), run(1e-10)
    assert off(fine, truth) < 2e-9
    assert off(crude, truth) < 0.05
    assert off(crude, truth) > 1000 * off(fine, truth)
    assert 20 < few < many < 2000
    # Twin: a spin that is one part in a million off is seen.
    other = simulate(replace(SCENE, spins=(10.00001, -10)), TIMES, "minimal", 1e-13).tips
    assert off(fine, other) > 1e-7


@pytest.mark.parametrize("name", ORDERS)
def test_a_peer_with_a_step_has_its_order_and_no_more(name: str, truth: Any) -> None:
    run = run_of(name)
    steps = np.array([2e-3, 1e-3, 5e-4])
    errors = np.array([off(run(step)[0], truth) for step in steps])
    assert measured_order(steps, errors) == pytest.approx(ORDERS[name], abs=0.1)
    assert errors[-1] > 1e-6


def test_a_solver_that_stops_is_not_taken_for_one_that_ends() -> None:
    check_odeint({"message": "Integration successful."})
    with pytest.raises(IntegrationError, match="Excess work"):
        check_odeint({"message": "Excess work done on this call"})


@pytest.mark.skipif(all(map(find_spec, NEEDS.values())), reason="all peers are installed: none is absent")
def test_what_is_not_installed_is_said() -> None:
    absent = [name for name, module in NEEDS.items() if not find_spec(module)]
    found = benchmark("small", Case(SCENE, TIMES, 0, ""), {name: PEERS[name] for name in absent}, (1e-3,))
    assert not found.points
    assert {f.method for f in found.failures} == set(absent)
    assert all("not installed" in f.reason and "pip install --group " in f.reason for f in found.failures)
