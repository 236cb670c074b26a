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


WITHOUT = "import sys; sys.modules |= dict.fromkeys(('numpy', 'scipy', 'matplotlib'))"
SYMBOLIC = """
from sympy import cos, log, symbols
from lagrotor.algebra import decide_equal
from lagrotor.mechanics import Frame, System, constrained_accelerations, coordinates
from lagrotor.paper import judge
x, m, l, g, A, C = symbols('x m l g A C', positive=True)
c = coordinates('phi theta psi')
body = Frame(c).turned('zxz', c.q).body(mass=m, inertia=(A, A, C), centre=(0, 0, l))
Frame(c).turned('zxz', c.q).body(mass=1, inertia=(1, 2, 2.5))
top = System(c, body.kinetic - m * g * l * cos(c.q[1]))
constrained_accelerations(top), top.energy, top.routh('phi psi').equilibria('p_phi')
plane = coordinates('x y')
L = m * (plane.v[0]**2 + plane.v[1]**2) / 2 - m * g * plane.q[1]
held = System(plane, L, constraints=(plane.q[0]**2 + plane.q[1]**2 - l**2,))
held.linearise({plane.q[0]: 0, plane.q[1]: -l}).modes()
print(*top.cyclic, decide_equal(log(x**2), 2 * log(x)).answer, judge('cos(x)', 1 - x**2 / 2).verdict)
"""


def test_the_symbolic_half_needs_neither_numpy_nor_scipy() -> None:
    ran = subprocess.run([sys.executable, "-c", WITHOUT + SYMBOLIC], capture_output=True, text=True, check=True)
    assert ran.stdout.split() == ["phi", "psi", "zero", "refuted"]
    numeric = f"{WITHOUT}\nfrom lagrotor.mechanics.running import flow"
    assert subprocess.run([sys.executable, "-c", numeric], capture_output=True, check=False).returncode
