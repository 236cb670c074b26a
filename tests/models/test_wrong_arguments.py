"""What the runs of the pair do not take is refused in words, with the argument's name, before anything runs."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from lagrotor import (
    Link,
    Paper,
    Scene,
    Shock,
    Structure,
    floquet,
    orbit_family,
    paired_scene,
    precession_orbit,
    read_scene,
    simulate,
    sweep,
    write_scene,
)
from lagrotor.commands.command_line import main
from lagrotor.errors import DomainError, InputError, SingularError
from lagrotor.mechanics import System, coordinates
from lagrotor.models import (
    RigidBody,
    RigidBodySystem,
    exact_orbit,
    paper_system,
    run_solver,
    run_steps,
    step_limit,
)
from lagrotor.models.linear import linear_error
from lagrotor.theory import parallel_scene

SCENE, TIMES = Scene((10.0, -10.0)), np.linspace(0.0, 0.1, 3)
SHAKEN = Scene((10.0, -10.0), shock=Shock((1, 0, 0), 0.1, 0.1))
STRUCTURE = Structure([(0, 0), (1, 0)], [(0, 1)], 10.0)
C = coordinates("q")
SYSTEM = System(C, C.v[0] ** 2 / 2 - C.q[0] ** 2 / 2)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (
            lambda: simulate(SCENE, TIMES, "spheres", progress=5),
            r"simulate: progress = 5 must be a function of the time",
        ),
        (lambda: simulate(SCENE, TIMES, progress="x"), r"simulate: progress = 'x'"),
        (lambda: simulate(SCENE, TIMES, ["minimal"]), r"simulate: model = \['minimal'\] is not one of auto"),
        (lambda: simulate(SCENE, TIMES, "sphere"), r"simulate: model = 'sphere' is not one of .*: spheres\?"),
        (lambda: sweep([SCENE], TIMES, progress=5), r"sweep: progress = 5 must be a function of two numbers"),
        (lambda: sweep([SCENE], TIMES, executor=4), r"sweep: executor = 4 must be .* a dask Client"),
        (lambda: sweep([SCENE], TIMES, executor="process"), r"sweep: executor = 'process' must be .*'processes'"),
        (lambda: sweep(SCENE, TIMES), r"sweep: scenes must be a sequence of at least one Scene"),
        (lambda: sweep([], TIMES), r"a sequence of at least one Scene"),
        (lambda: sweep([1.0], TIMES), r"a sequence of at least one Scene"),
        (lambda: sweep([SCENE], TIMES, chunk=0), r"chunk = 0 must be a whole number"),
        (lambda: sweep([SCENE], TIMES, chunk=True), r"chunk = True must be a whole number"),
        (lambda: sweep([SCENE], TIMES, engine="quick"), r"sweep: engine = 'quick' is neither core nor fast"),
        (lambda: sweep([SHAKEN], TIMES, engine="fast"), r"takes no shock"),
        (lambda: sweep([SCENE], TIMES, 5), r"sweep: tol = 5 must lie between"),
        (lambda: floquet(5, 0.2), r"the paired precession needs a Scene, not 5"),
        (lambda: simulate(SCENE, TIMES).save(5), r"save: path = 5 must be a path"),
        (lambda: simulate(SCENE, TIMES).animate(5), r"animate: path = 5 must be a path"),
        (lambda: write_scene(SCENE, 5), r"write_scene: path = 5 must be a path"),
        (lambda: Paper(5), r"Paper: folder = 5 must be a path"),
        (lambda: read_scene([]), r"path = \[\] must be a path"),
        (lambda: STRUCTURE.resonances(factor="x"), r"resonances: factor = 'x' must be numbers"),
        (lambda: STRUCTURE.resonances(factor=float("nan")), r"resonances: factor = nan must be finite"),
        (lambda: STRUCTURE.upright_tip(2), r"upright_tip: i = 2 must be a rotor's number, from 0 to 1"),
        (lambda: SYSTEM.hamiltonian(5), r"hamiltonian: momenta = 5 must be symbols"),
        (lambda: SYSTEM.consistent({}, [1.0], [0.0], [1, "a"]), r"consistent: t = \[1, 'a'\] must be numbers"),
    ],
)
def test_a_wrong_type_is_refused_in_words(call: Callable[[], object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        call()


MODELS = ("auto", "closed_form", "linear", "averaged", "minimal", "spheres", "euler")


@pytest.mark.parametrize("model", MODELS)
def test_no_model_takes_times_or_tolerances_that_are_none(model: str) -> None:
    ordered = ([1, 0.5], [0, 1, 1], [0, np.nan], [0, np.inf], [], [[0, 1], [2, 3]], 1.0)
    numbers = ("soon", [0, "x"], [[0], [1, 2]], ["0", "1"], [True, False], None)
    for times, said in ((ordered, "an increasing array of finite times"), (numbers, "an (increasing )?array")):
        for t in times:
            with pytest.raises(InputError, match=f"t = .*must be {said}"):
                simulate(SCENE, t, model)  # type: ignore[arg-type]
    for tol in (0, 1e-14, 0.11, -1e-9, np.nan, "tight"):
        with pytest.raises(InputError, match="tol = "):
            simulate(SCENE, [0, 1], model, tol)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="scene = 'two rotors' must be a Scene"):
        simulate("two rotors", [0, 1], model)  # type: ignore[arg-type]


FREE = Scene((10, -10), link=None, axes=((0.6, 0, 0.8),) * 2)
ON_THE_LINE = Scene((10, -10), axes=((1, 0, 0), (0, 0, 1)), rates=((0, 1, 0), (0, 1, 0)))
PAIRED = paired_scene(SCENE, 0.1)
FALLING = Scene((0, 0), rates=((1, 0, 0), (1, 0, 0)))
FAR = Scene((10, -10), axes=((0.9, 0, 0.19**0.5),) * 2)
TWISTED = parallel_scene(Scene((10, 10), link=Link(1, 0.01, 0.1)), 0.3, 1e-8)


@pytest.mark.parametrize(
    ("scene", "model", "said"),
    [
        (SCENE, "euler", r"euler: theta_1 = 0 rad.* use model='minimal' or 'spheres'"),
        (FREE, "minimal", "minimal: the scene has no bar.*use model='spheres'"),
        (FREE, "euler", "euler: the scene has no bar.*use model='spheres'"),
        (FREE, "linear", "linear: the scene has no bar"),
        (ON_THE_LINE, "minimal", "axis 1 lies along the joint line.*use model='spheres'"),
        (FAR, "linear", r"at t = 0 s the motion is 84.*° from rest.*use model='minimal'"),
        (TWISTED, "closed_form", "turn alike, not"),
        (FALLING, "closed_form", "near the joint line"),
        (replace(SCENE, shock=Shock((1, 0, 0), 0.5, 0.05)), "closed_form", "no closed form goes through a shock"),
        (replace(PAIRED, rates=2 * np.array(PAIRED.rates)), "closed_form", "not on a paired precession"),
        (replace(PAIRED, spins=(10, 10)), "closed_form", "only with parallel axes that turn alike"),
    ],
)
def test_a_model_that_cannot_hold_the_scene_says_which_can_or_why(scene: Scene, model: str, said: str) -> None:
    with pytest.raises((DomainError, SingularError), match=said):
        simulate(scene, [0, 1], model)


BAR = Scene((10, -6), link=Link(1, 1, 1))
SPRINGS = paper_system(BAR, 1e3, 1)
BODY = {"centre": (0, 0, 0), "vertices": [[0, 0, 1]], "inertia": np.eye(3), "rotation": np.eye(3), "mass": 1}
ALONE = RigidBodySystem([RigidBody(**BODY, angular_velocity=(0, 0, 0), velocity=(0, 0, 0))], 1.0, 0.0)


@pytest.mark.parametrize(
    ("call", "values", "said"),
    [
        (lambda i: SPRINGS.ground(i, 1), (0, 4, -1, 1.0, True, "1"), "not there"),
        (lambda i: SPRINGS.link(1, 2, 1, i), (0, 3, -1, 1.0, True, "1"), "not there"),
        (lambda force: SPRINGS.push(1, 2, force), ((0, 0), (0, 0, np.nan), "up"), ""),
        (SPRINGS.step, (0.0, -1.0, np.nan, np.inf), "above zero"),
        (lambda dt: run_steps(SPRINGS, None, [0.0], dt), (0.0, -1.0, np.nan, np.inf), "above zero"),
        (lambda t: run_steps(SPRINGS, None, [t], 1e-3), (0.0015,), "multiples"),
        (lambda width: run_steps(SPRINGS, Shock((1, 0, 0), 1, width), [1.0], 1e-3), (1e-4,), "steps over"),
        (step_limit, (ALONE,), "no link"),
        (lambda system: run_steps(system, None, [0.0], 1e-3), (ALONE,), "two vertices"),
        (lambda S: paper_system(BAR, S, 0), (0, -1, np.nan), ""),
        (lambda D: paper_system(BAR, 1, D), (-1, np.inf), ""),
        (lambda link: paper_system(replace(BAR, link=link), 1e3, 1), (Link(1, 0, 0), Link(1, 1, 0)), r"lagrotor\.simulate"),
        (lambda tol: run_solver(SPRINGS, None, [0, 1], tol), (0, "tight"), "tol = "),
        (lambda t: run_solver(SPRINGS, None, t, 1e-6), ([1, 0.5], [0, np.nan], "soon"), "t = "),
        (
            lambda change: RigidBody(**(BODY | {"angular_velocity": (0, 0, 0), "velocity": (0, 0, 0)} | change)),
            (
                {"mass": 0}, {"mass": np.nan}, {"inertia": np.diag([1, 1, 0])}, {"rotation": 2 * np.eye(3)},
                {"rotation": -np.eye(3)}, {"vertices": []}, {"centre": (0, 0)}, {"velocity": (0, 0, np.inf)},
                {"inertia": [[1, 1, 0], [0, 1, 0], [0, 0, 1]]},
            ),
            "",
        ),
        (lambda r0: precession_orbit(SCENE, r0), (1.0, -2, np.nan, "much"), "r0"),
        (lambda tol: precession_orbit(SCENE, 0.1, tol), (0, -1e-9, 2, "fine", True), "tol"),
        (lambda tol: precession_orbit(SCENE, 0.3, tol), (1e-14,), "reaches tol = 1e-14; take a larger tol"),
        (lambda r0: exact_orbit(SCENE, r0), (0.0,), "at rest"),
        (lambda scene: precession_orbit(scene, 0.1), (BAR,), "opposite"),
        (lambda scene: orbit_family(scene, [0.1]), (BAR,), "opposite"),
        (lambda amplitudes: orbit_family(SCENE, amplitudes), ([0.3, 0.2],), "increase"),
        (lambda end: linear_error(SCENE, end), (1e5,), "turns are too many to estimate"),
    ],
)  # fmt: skip
def test_springs_and_orbits_refuse(call: Callable[..., object], values: tuple[object, ...], said: str) -> None:
    for value in values:
        with pytest.raises((InputError, DomainError), match=said):
            call(value)


def test_right_values_are_taken() -> None:
    seen = list[float]()
    assert simulate(SCENE, TIMES, "minimal", progress=seen.append).model == "minimal" and seen
    assert SYSTEM.hamiltonian((sp.Symbol("p"),)).p == (sp.Symbol("p"),)
    assert STRUCTURE.upright_tip(1) == (1, 0, 1)


@pytest.mark.parametrize("command", ["sweep", "simulate"])
def test_help_says_that_tol_is_the_error_of_the_whole_run(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, "--help"]) == 0
    words = " ".join(capsys.readouterr().out.split())
    assert "--tol TOL target for the estimated largest error of an axis over the run" in words and "solver" not in words
