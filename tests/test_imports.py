"""Importing the package, and asking for one closed form, loads nothing heavy: it is loaded where it is used."""

import subprocess
import sys

HEAVY = ("sympy", "matplotlib", "scipy")
SHOCKED = "from lagrotor import Scene, Shock, simulate; scene = Scene((10, -7), shock=Shock((40, -11, 0), 0.3, 0.05))"


def loaded(*programs: str) -> list[set[str]]:
    """What is loaded after each of the programs, one after the other in one process."""
    code = "\n".join(["import sys", *(f"{program}\nprint(*sys.modules)" for program in programs)])
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return [set(line.split()) & set(HEAVY) for line in ran.stdout.splitlines()]


def test_describing_a_scene_and_asking_for_a_closed_form_loads_nothing_heavy() -> None:
    programs = (
        "import lagrotor",
        "from lagrotor import Link, Rotor, Scene, Shock; Scene((10, -10), shock=Shock((1, 0, 0), 1, 0.1))",
        "from lagrotor import Scene, natural_rate; natural_rate(Scene((10, -10)))",
    )
    assert loaded(*programs) == [set()] * 3


def test_running_a_pair_loads_what_integrates() -> None:
    programs = (f"simulate(scene, [0.0, 1.0], {model!r})" for model in ("auto", "spheres", "minimal"))
    assert set().union(*loaded(SHOCKED, *programs)) <= {"scipy"}


def test_judging_loads_what_derives_and_drawing_what_draws() -> None:
    deriving, judging, drawing = loaded(
        "from lagrotor.mechanics import System",
        "from lagrotor import audit; audit('5.02')",
        "import lagrotor.drawing.film",
    )
    assert deriving | judging <= {"sympy"}
    assert "matplotlib" in drawing
