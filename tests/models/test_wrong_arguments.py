"""A value of a wrong type is refused in words, with the argument's name, before anything runs."""

from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp

from lagrotor import Paper, Scene, Shock, Structure, floquet, read_scene, simulate, sweep, write_scene
from lagrotor.commands.command_line import main
from lagrotor.errors import InputError
from lagrotor.mechanics import System, coordinates

SCENE, TIMES = Scene((10.0, -10.0)), np.linspace(0.0, 0.1, 3)
SHAKEN = Scene((10.0, -10.0), shock=Shock((1, 0, 0), 0.1, 0.1))
STRUCTURE = Structure([(0, 0), (1, 0)], [(0, 1)], 10.0)
C = coordinates("q")
SYSTEM = System(C, C.v[0] ** 2 / 2 - C.q[0] ** 2 / 2)


class Client:
    """A client as dask has it: it can submit, and has an executor."""

    def submit(self, work: Callable[..., object], *given: object) -> object:
        return work(*given)

    def get_executor(self) -> None: ...


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
        (lambda: sweep([SCENE], TIMES, executor=4), r"sweep: executor = 4 must be .*client\.get_executor\(\)"),
        (lambda: sweep([SCENE], TIMES, executor=Client()), r"sweep: executor = .*client\.get_executor\(\)"),
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
