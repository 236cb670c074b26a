"""Importing the package, and asking for one closed form, loads nothing heavy: it is loaded where it is used."""

import subprocess
import sys

import pytest

HEAVY = ("sympy", "matplotlib", "scipy")
SHOCKED = "from lagrotor import Scene, Shock, simulate; scene = Scene((10, -7), shock=Shock((40, -11, 0), 0.3, 0.05))"


def loaded(program: str) -> set[str]:
    code = f"import sys\n{program}\nprint(*sys.modules)"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(ran.stdout.split()) & set(HEAVY)


@pytest.mark.parametrize(
    ("program", "needed"),
    [
        ("import lagrotor", set()),
        ("from lagrotor import Link, Rotor, Scene, Shock; Scene((10, -10), shock=Shock((1, 0, 0), 1, 0.1))", set()),
        ("from lagrotor import Scene, natural_rate; natural_rate(Scene((10, -10)))", set()),
        (f"{SHOCKED}; simulate(scene, [0.0, 1.0])", {"scipy"}),
        (f"{SHOCKED}; simulate(scene, [0.0, 1.0], 'spheres')", {"scipy"}),
        (f"{SHOCKED}; simulate(scene, [0.0, 1.0], 'minimal')", {"scipy"}),
        ("from lagrotor import audit; audit('5.02')", {"sympy"}),
        ("from lagrotor.mechanics import System", {"sympy"}),
    ],
)
def test_only_what_is_used_is_loaded(program: str, needed: set[str]) -> None:
    assert loaded(program) <= needed


def test_what_draws_loads_what_draws() -> None:
    assert "matplotlib" in loaded("import lagrotor.drawing.film")
