"""Others' compiled solvers: right where they are installed, and what they refuse. No times."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from benchmarks import full_equations
from benchmarks.compiled_solvers import COMPILED
from lagrotor import Link, Rotor, Scene, simulate
from lagrotor.benchmark.scenes_and_methods import CASES
from lagrotor.errors import InputError
from lagrotor.models import spheres

TIMES = np.linspace(0, 2, 21)
NEEDS = {
    "minimal, CyRK": ("numba", "CyRK"),
    "minimal, numba DOP853": ("numba",),
    "heyoka alone": ("heyoka",),
    "diffrax": ("diffrax",),
}
LANES = {"heyoka_lanes": "heyoka", "diffrax_vmap": "diffrax"}


def prepare(name: str, course: str) -> Any:
    for module in NEEDS[name]:
        pytest.importorskip(module, reason=f"{name} is not installed: pip install {COMPILED[name].install}")
    return COMPILED[name].prepare(CASES[course](True).scene, TIMES)


def test_every_compiled_solver_is_tested() -> None:
    assert set(NEEDS) == set(COMPILED)


@pytest.mark.parametrize("name", COMPILED)
@pytest.mark.parametrize("course", ["displaced", "heavy"])
def test_the_error_of_a_solver_falls_with_its_tolerance(name: str, course: str) -> None:
    if course == "heavy" and not name.startswith("minimal"):
        pytest.skip("the full equations have a massless bar")
    run = prepare(name, course)
    truth = simulate(CASES[course](True).scene, TIMES, "minimal", 1e-13).tips
    errors = [float(np.linalg.norm(run(tol)[0] - truth, axis=-1).max()) for tol in (1e-4, 1e-7, 1e-10)]
    assert errors[0] > 100 * errors[1] > 1e4 * errors[2]
    assert errors[2] < (2e-8 if name == "diffrax" else 1e-10)  # diffrax exceeds its tolerance, as the page says
    assert run(1e-4)[1] < run(1e-10)[1] < 2000


@pytest.mark.parametrize("name", COMPILED)
def test_a_solver_takes_no_shock(name: str) -> None:
    with pytest.raises(InputError, match="no shock"):
        prepare(name, "shock")


@pytest.mark.parametrize("of", [Rotor(), Rotor(2.0, 0.7, 0.5, 0.9)], ids=["unit", "other"])
def test_the_full_equations_are_those_of_the_unit_vectors(of: Rotor) -> None:
    """Beside the kept program of the model `spheres`, for a rotor whose J, R and G are no ones."""
    scene = Scene((10, -7), rotor=of, link=Link(1.3))
    moving = spheres.MODEL.start(CASES["displaced"](True).scene)
    units = spheres.MODEL.rate(replace(scene, rotor=of), False)
    assert full_equations.rates(list(moving), full_equations.constants(scene)) == pytest.approx(units(0.0, moving))
    other = full_equations.constants(replace(scene, spins=(10.001, -7)))
    assert np.abs(np.array(full_equations.rates(list(moving), other)) - units(0.0, moving)).max() > 1e-5


@pytest.mark.parametrize("name", LANES)
def test_many_scenes_at_once_end_where_each_ends_alone(name: str) -> None:
    pytest.importorskip(LANES[name])
    scene = CASES["displaced"](True).scene
    scenes = [scene, *(replace(scene, rates=tuple(tuple(x * c for x in v) for v in scene.rates)) for c in (0.9, 1.1))]
    ends = getattr(full_equations, name)(scenes, 1.0, 1e-10)
    assert ends.shape == (3, 12)
    for one, end in zip(scenes, ends, strict=True):
        run = simulate(one, [0.0, 1.0], "spheres", 1e-11)
        assert np.abs(end[:6] - run.axes[:, -1].ravel()).max() < 1e-8
    assert np.abs(ends[0] - ends[1]).max() > 1e-3
