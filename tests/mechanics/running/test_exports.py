"""Exported functions, run by the tools of each language: they give the numbers of `System.rhs` and of the other properties.

Where a tool is missing, its test is skipped. Without Julia a small evaluator reads the text: it knows assignments, loops and
arithmetic, which is all that the files contain, but it is no Julia.
"""

import ctypes
import importlib.util
import json
import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.mechanics import Frame, System, coordinates, reaction, t
from lagrotor.numerics.languages import identifiers
from tests.systems import VALUES, ball_top, cart_and_pole, g, l, m, pendulum, rolling_disc

pytestmark = pytest.mark.filterwarnings("ignore:export. without joint_forces")
Numbers = dict[str, np.ndarray]
_STATES = 2
FUNCTIONS = ("rhs", "mass_matrix", "forcing", "inverse_dynamics", "energy", "joint_forces", "jacobian")


def cart_with_two_rods() -> System:
    c = coordinates("z alpha beta")
    cart = Frame(c).prismatic("z", "x", name="rail")
    first = cart.pin("alpha", "z", name="first")
    second = first.moved(0, -l).pin("beta", "z", name="second")
    bodies = [cart.body(m), first.body(m, (0, 0, m * l**2), (0, -l, 0)), second.body(m, centre=(0, -l / 2, 0))]
    return System(c, sum(b.kinetic - b.potential((0, -g, 0)) for b in bodies))


def four_bar() -> System:
    c = coordinates("a b e")
    ends = Frame(c)
    first = ends.pin("a", "z").moved(0, 1)
    second = first.pin("b", "z").moved(1, 0)
    third = ends.moved(1, 0).pin("e", "z").moved(0, 1)
    bodies = [f.body(m, (0, 0, m), (0, -sp.Rational(1, 2), 0)) for f in (first, second, third)]
    L = sum(b.kinetic - b.potential((0, -g, 0)) for b in bodies)
    return System(c, L, constraints=second.coincides(third, name="loop")[:2])


def driven() -> System:
    F, Omega, d = sp.symbols("F Omega d", positive=True)
    system = cart_and_pole(F * sp.cos(Omega * t))
    return replace(system, dissipation=d * system.c.v[1] ** 2 / 2)


def motor() -> System:
    """Return a pendulum that a motor with the current i turns."""
    k, R, L, V = sp.symbols("k R L V", positive=True)
    current = sp.Symbol("i", real=True)
    system = pendulum(forces=(k * current,))
    return replace(system, states={current: (V - R * current - k * system.c.v[0]) / L})


def quasi_disc() -> System:
    system, wheel = rolling_disc()
    return replace(system, velocities=dict(zip(sp.symbols("p q r", real=True), wheel.angular_velocity, strict=True)))


def odd_functions() -> System:
    """Return a system with every kind of function, powers, and names that no language would take."""
    c = coordinates("x dx")
    names = "lambda end function t_ double π v+1 v_1 M_PI s0 jnp"
    bad = [sp.Symbol(name, positive=True) for name in names.split()]
    x, y = c.q
    V = (
        bad[0] * sp.sech(x)
        + bad[1] * sp.Abs(x) ** sp.Rational(5, 2)
        + bad[2] * sp.atan2(y, 2 + x**2)
        + sp.exp(-x * bad[3])
    )
    V += (
        bad[4] * sp.sqrt(1 + x**2)
        + bad[5] * y**2 / (1 + y**6) / (2 + x**4)
        + sp.log(2 + sp.cos(x)) * sp.pi
        + sp.tanh(y * bad[6])
    )
    V += sp.acot(2 + x) + sp.asec(4 + y) + sp.acsch(3 + x) + sp.acoth(4 + x) + sp.acsc(5 + y) + sp.asech(x / 9)
    V += (
        bad[7] * sp.Max(x, y, 1) ** 2
        + bad[8] * (2 + x) ** bad[9]
        + sp.asinh(x * y)
        + x**11 / 3
        + bad[10] * sp.tan(y / 4)
    )
    return System(
        c, (c.v[0] ** 2 + bad[0] * c.v[1] ** 2 * (2 + sp.sin(x))) / 2 - V, forces=(-c.v[0] * sp.Abs(c.v[0]), 0)
    )


def arm_of_seven_axes(folder: Path) -> System:
    links = "".join(
        f'<link name="l{i}"><inertial><origin xyz="0.0{i} -0.02 0.1" rpy="0.1 0.2 0.{i}"/><mass value="{4 - i * 0.4:.1f}"/>'
        f'<inertia ixx="0.03" iyy="0.03" izz="0.02" ixy="0.001" ixz="0" iyz="-0.002"/></inertial></link>'
        f'<joint name="joint_{i}" type="revolute"><parent link="l{i - 1}"/><child link="l{i}"/><axis xyz="0 0 1"/>'
        f'<origin xyz="0 0.1 0.2" rpy="{(-1) ** i * 1.5707963} 0 0"/><dynamics damping="0.5"/></joint>'
        for i in range(1, 8)
    )
    path = folder / "arm.urdf"
    path.write_text(f'<robot name="arm"><link name="l0"/>{links}</robot>')
    return System.from_urdf(path)


@pytest.fixture(scope="module")
def gallery(tmp_path_factory: pytest.TempPathFactory) -> dict[str, System]:
    return {
        "pendulum": pendulum(),
        "cart": cart_with_two_rods(),
        "top": ball_top(),
        "disc": quasi_disc(),
        "loop": four_bar(),
        "driven": driven(),
        "motor": motor(),
        "odd": odd_functions(),
        "arm": arm_of_seven_axes(tmp_path_factory.mktemp("urdf")),
    }


Calls = dict[str, list[tuple[float, np.ndarray, np.ndarray, np.ndarray]]]


@pytest.fixture(scope="module")
def about(gallery: dict[str, System], tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The description of each system."""
    folder = tmp_path_factory.mktemp("about")
    return {name: json.loads(s.export("c", folder, name)[-1].read_text()) for name, s in gallery.items()}


@pytest.fixture(scope="module")
def calls(gallery: dict[str, System], about: dict[str, Any]) -> Calls:
    """Random arguments (t, x, p, a) of the functions of each system."""
    random, made = np.random.default_rng(1), Calls()
    for name, system in gallery.items():
        p = [
            row.get("value", {str(s): x for s, x in VALUES.items()}.get(row["name"]))
            for row in about[name]["parameters"]
        ]
        numbers = np.array([random.uniform(0.5, 1.5) if x is None else x for x in p], float)
        sizes = len(system.variables), len(system.speeds)
        made[name] = [
            (float(random.uniform(0, 3)), random.uniform(0.2, 1, sizes[0]), numbers, random.uniform(-1, 1, sizes[1]))
            for _ in range(_STATES)
        ]
    for _, x, _, _ in made["top"]:
        x[:4] /= np.linalg.norm(x[:4])  # a quaternion
    return made


@pytest.fixture(scope="module")
def right(gallery: dict[str, System], about: dict[str, Any], calls: Calls) -> dict[str, list[Numbers]]:
    """The numbers of lagrotor itself: of its right-hand side, of inverse dynamics, and of formulas."""
    return {
        name: [_right(system, [row["name"] for row in about[name]["parameters"]], *call) for call in calls[name]]
        for name, system in gallery.items()
    }


def _right(system: System, names: list[str], time: float, x: np.ndarray, p: np.ndarray, a: np.ndarray) -> Numbers:
    values, n = dict(zip(names, p, strict=True)), len(system.c.q)
    rhs, q, u = system.rhs(values), x[:n], x[n : n + len(a)]
    all_values = values | dict(zip((str(s) for s, _ in system.states), x[n + len(a) :], strict=True))

    rates, h = np.array([0 * a, a, *np.eye(len(a))]), 1e-4
    many = (np.tile(each, (len(rates), 1)) for each in (q, u))
    still, forces, *columns = system.inverse_dynamics(*many, rates, all_values, time)
    slopes = [[np.array(rhs(time, x + k * h * e)) for k in (-2, -1, 1, 2)] for e in np.eye(len(x))]
    numbers = {
        "rhs": np.array(rhs(time, x)),
        "inverse_dynamics": forces,
        "forcing": -still,
        "mass_matrix": (np.array(columns) - still).T,
        "jacobian": np.array([(s[0] - 8 * s[1] + 8 * s[2] - s[3]) / 12 / h for s in slopes]).T,
    }
    if system.joints and not system.constraints:
        run = system.simulate(values, q, u, [time, time + 1e-9])
        forces_in = [run.reactions[name] for name in system.joints]
        numbers["joint_forces"] = np.array([[*f.force[0], *f.torque[0]] for f in forces_in])
        numbers["energy"] = np.array(run.energy[0])
    if not system.kinematics and n < 3:
        at = dict(zip((*system.variables, t), (*x, time), strict=True))
        at |= {s: values[str(s)] for s in system.mass_matrix.free_symbols if str(s) in values}
        numbers["mass_matrix"] = np.array(system.mass_matrix.xreplace(at).xreplace(at).tolist(), float)
    if n < 5:
        v = system.kinematics.velocity if system.kinematics else system.c.v
        at = dict(zip((*system.variables, t), (*x, time), strict=True))
        at |= {s: values[str(s)] for s in system.energy.free_symbols if str(s) in values}
        energy = system.energy.xreplace(dict(zip(system.c.v, v, strict=True)))
        numbers["energy"] = np.array(float(energy.xreplace(at).xreplace(at)))
    return numbers


TOLERANCE = {"rhs": 1e-13, "jacobian": 1e-8}


def check(name: str, function: str, numbers: Any, right: np.ndarray) -> None:
    got = np.asarray(numbers, float)
    assert got.shape == right.shape, (name, function)
    assert np.abs(got - right).max() <= TOLERANCE.get(function, 1e-12) * np.abs(right).max() + 1e-300, (name, function)


Call = Callable[..., Any]
Runner = Callable[[dict[str, System], Path, Calls, dict[str, Any]], dict[str, list[Numbers]]]


def each(calls: Calls, about: dict[str, Any], call: Callable[[str, str], Call]) -> dict[str, list[Numbers]]:
    """Return the numbers of every function at every state."""
    return {
        name: [
            {f: call(name, f)(*args[: len(about[name]["functions"][f]["arguments"])]) for f in about[name]["functions"]}
            for args in states
        ]
        for name, states in calls.items()
    }


def in_c(gallery: dict[str, System], folder: Path, calls: Calls, about: dict[str, Any]) -> dict[str, list[Numbers]]:
    if not shutil.which("gcc"):
        pytest.skip("no gcc")
    sources = [file for name, s in gallery.items() for file in s.export("c", folder, name) if file.suffix == ".c"]
    strict = ["-Wall", "-Wextra", "-Werror", "-pedantic"]
    subprocess.run(
        ["gcc", "-std=c99", *strict, "-O0", "-shared", "-fPIC", "-o", "all.so", *sources, "-lm"], cwd=folder, check=True
    )
    if shutil.which("g++"):
        subprocess.run(["g++", "-x", "c++", *strict, "-fsyntax-only", *sources], cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "all.so"))

    def call(name: str, f: str) -> Call:
        shape = about[name]["functions"][f]["shape"]

        def numbers(time: float, *arrays: np.ndarray) -> np.ndarray:
            result = np.full(shape, np.nan)
            arguments = [np.ascontiguousarray(a).ctypes.data_as(ctypes.c_void_p) for a in (*arrays, result)]
            getattr(library, f"{name}_{f}")(ctypes.c_double(time), *arguments)
            return result

        return numbers

    return each(calls, about, call)


def load(path: Path) -> Any:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def in_casadi(
    gallery: dict[str, System], folder: Path, calls: Calls, about: dict[str, Any]
) -> dict[str, list[Numbers]]:
    ca = pytest.importorskip("casadi")

    modules = {name: load(system.export("casadi", folder, name)[0]) for name, system in gallery.items()}

    @cache
    def call(name: str, f: str) -> Call:
        function, shape = getattr(modules[name], f"{name}_{f}"), about[name]["functions"][f]["shape"]
        sizes = [len(e) for e in calls[name][0][1:]]
        symbols = [ca.SX.sym("t"), *(ca.SX.sym(s, k) for s, k in zip("xpa", sizes, strict=True))]
        symbols = symbols[: len(about[name]["functions"][f]["arguments"])]
        expression = function(*symbols)
        if f == "jacobian":  # CasADi differentiates the right-hand side itself
            exact = ca.jacobian(getattr(modules[name], f"{name}_rhs")(*symbols), symbols[1])
            both = ca.Function("both", symbols, [expression, exact])(*calls[name][0][: len(symbols)])
            np.testing.assert_allclose(*map(np.array, both), rtol=1e-11, atol=1e-11)
        compiled = ca.Function(f, symbols, [expression])
        return lambda *args: np.array(compiled(*args)).reshape(shape)

    return each(calls, about, call)


def in_jax(gallery: dict[str, System], folder: Path, calls: Calls, about: dict[str, Any]) -> dict[str, list[Numbers]]:
    jax = pytest.importorskip("jax")

    modules = {name: load(system.export("jax", folder, name)[0]) for name, system in gallery.items()}

    def call(name: str, f: str) -> Call:
        return getattr(modules[name], f"{name}_{f}")

    # The long programs are run as they are, at one state, since compiling them takes XLA minutes.
    numbers = each({name: states[:1] if name == "arm" else states for name, states in calls.items()}, about, call)
    rhs, (time, x, p, _) = call("cart", "rhs"), calls["cart"][0]
    np.testing.assert_allclose(jax.jit(rhs)(time, x, p), numbers["cart"][0]["rhs"], rtol=1e-13)
    np.testing.assert_allclose(jax.jacfwd(rhs, 1)(time, x, p), numbers["cart"][0]["jacobian"], rtol=1e-11, atol=1e-12)
    states = np.array([args[1] for args in calls["cart"]])
    rows = jax.vmap(rhs, (None, 0, None))(time, states, p)
    np.testing.assert_allclose(rows[0], numbers["cart"][0]["rhs"], rtol=1e-13)
    energy = jax.grad(call("cart", "energy"), 1)(time, x, p)
    assert energy.dtype == np.float64 and energy.shape == x.shape
    return numbers


def in_matlab(
    gallery: dict[str, System], folder: Path, calls: Calls, about: dict[str, Any]
) -> dict[str, list[Numbers]]:
    if not shutil.which("octave"):
        pytest.skip("no octave")
    lines = ["function out(z)", "printf('%.17g ', z.'); printf('\\n');", "end"]
    for name, states in calls.items():
        gallery[name].export("matlab", folder, name)
        for args in states:
            vector = [repr(args[0]), *(f"[{'; '.join(map(repr, a.tolist()))}]" for a in args[1:])]
            for f, says in about[name]["functions"].items():
                lines.append(f"out({name}_{f}({', '.join(vector[: len(says['arguments'])])}));")
    (folder / "run_all.m").write_text("1;\n" + "\n".join(lines))
    run = subprocess.run(
        ["octave", "--no-gui", "--norc", "-q", "run_all.m"], cwd=folder, text=True, capture_output=True
    )
    assert run.returncode == 0, run.stderr
    rows = iter(run.stdout.splitlines())
    return each(
        calls,
        about,
        lambda name, f: lambda *args: np.array(next(rows).split(), float).reshape(about[name]["functions"][f]["shape"]),
    )


def in_julia(gallery: dict[str, System], folder: Path, calls: Calls, about: dict[str, Any]) -> dict[str, list[Numbers]]:
    for name, system in gallery.items():
        system.export("julia", folder, name)
    if shutil.which("julia"):
        return _by_julia(folder, calls, about)

    @cache
    def functions(name: str) -> dict[str, Any]:
        made: dict[str, Any] = {}
        exec(_python_of_julia((folder / f"{name}.jl").read_text()), made)
        return made

    def call(name: str, f: str) -> Call:
        shape = about[name]["functions"][f]["shape"]

        def numbers(time: float, x: np.ndarray, p: np.ndarray, *more: np.ndarray) -> Any:
            made, one = functions(name), _FromOne
            if not shape:
                return made[f"{name}_{f}"](one(x), one(p), time)
            result = np.full(shape, np.nan)
            made[f"{name}_{f}_"](one(result), one(x), one(p), time, *map(one, more))
            return result

        return numbers

    return each(calls, about, call)


class _FromOne:
    """An array whose indices begin at 1."""

    def __init__(self, array: Any) -> None:
        self.array = array

    def __getitem__(self, i: int) -> Any:
        return self.array[i - 1]

    def __setitem__(self, i: Any, value: Any) -> None:
        self.array[tuple(k - 1 for k in i) if isinstance(i, tuple) else i - 1] = value


def _python_of_julia(text: str) -> str:
    """Return Julia's assignments, loops and functions as Python."""
    lines, depth = [_JULIA_IN_PYTHON], 0
    for raw in text.splitlines():
        line = raw.strip()
        if not line or line.startswith("#"):
            continue
        if line == "end":
            depth -= 1
            continue
        line = re.sub(r"\batan\(", "julia_atan(", line).replace("^", "**")
        line = re.sub(r"^(function) (\w+)!?\(", r"def \2(", re.sub(r"(\w)!\(", r"\1_(", line))
        line = re.sub(r"^for j in 1:(\d+)$", r"for j in range(1, \1 + 1):", line)
        line = re.sub(
            r"\[i == j \? 1.0 : 0.0 for i in 1:(\d+)\]", r"One([float(i == j) for i in range(1, \1 + 1)])", line
        )
        line = "return None" if line == "return nothing" else f"{line}:" if line.startswith("def") else line
        lines.append(" " * depth + line)
        depth += line.startswith(("def ", "for "))
    return "\n".join(lines)


_JULIA_IN_PYTHON = """from math import *
class One(list):
    def __getitem__(self, i): return list.__getitem__(self, i - 1)
abs = fabs
sign = lambda x: float(x > 0) - float(x < 0)
def julia_atan(y, x=1.0): return atan2(y, x)"""


def _by_julia(folder: Path, calls: Calls, about: dict[str, Any]) -> dict[str, list[Numbers]]:
    lines = []
    for name, states in calls.items():
        lines.append(f'include("{name}.jl")')
        for args in states:
            x, p, a = (f"Float64[{', '.join(map(repr, e.tolist()))}]" for e in args[1:])
            for f, says in about[name]["functions"].items():
                more, shape = (f", {a}" if "a" in says["arguments"] else ""), ", ".join(map(str, says["shape"]))
                head = f"{name}_{f}!(zeros({shape}), " if says["shape"] else f"{name}_{f}("
                value = f"{head}{x}, {p}, {args[0]!r}{more})"
                lines.append(f"println(join({f'permutedims({value})' if len(says['shape']) == 2 else value}, ' '))")
    (folder / "run_all.jl").write_text("\n".join(lines))
    run = subprocess.run(["julia", "run_all.jl"], cwd=folder, text=True, capture_output=True, check=True)
    rows = iter(run.stdout.splitlines())
    return each(
        calls,
        about,
        lambda name, f: lambda *args: np.array(next(rows).split(), float).reshape(about[name]["functions"][f]["shape"]),
    )


LANGUAGES: dict[str, Runner] = {"c": in_c, "casadi": in_casadi, "jax": in_jax, "julia": in_julia, "matlab": in_matlab}


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_gives_the_numbers_of_lagrotor(
    language: str,
    gallery: dict[str, System],
    calls: Calls,
    about: dict[str, Any],
    right: dict[str, list[Numbers]],
    tmp_path: Path,
) -> None:
    for name, states in LANGUAGES[language](gallery, tmp_path, calls, about).items():
        for numbers, expected in zip(states, right[name], strict=False):
            for function, values in expected.items():
                check(name, function, numbers[function], values)


def dry() -> System:
    return pendulum(dissipation=m * sp.Abs(sp.Symbol("theta_dot", real=True)))


def held_by_a_reaction() -> System:
    c = coordinates("x y")
    push = (-reaction("floor") * c.v[0], 0)
    return System(c, m * (c.v[0] ** 2 + c.v[1] ** 2) / 2 - m * g * c.q[1], constraints={"floor": c.q[1]}, forces=push)


PLANE = coordinates("x y")
X, A, B = PLANE.q[0], *PLANE.v


def particle(forces: tuple[sp.Expr, ...] = (), dissipation: sp.Expr = sp.S.Zero) -> System:
    return System(PLANE, (A**2 + B**2) / 2, forces=forces, dissipation=dissipation)


def with_function() -> System:
    c = coordinates("x")
    return System(c, c.v[0] ** 2 / 2 - sp.Function("U")(c.q[0]))


def with_cases() -> System:
    c = coordinates("x")
    return System(c, c.v[0] ** 2 / 2, forces=(sp.Piecewise((1, t < 1), (0, True)),))


@pytest.mark.parametrize(
    ("system", "arguments", "words"),
    [
        (dry, {}, r"dry friction that may hold theta_dot at zero .* tanh\(\(theta_dot\)/v_0\)"),
        (
            lambda: particle(dissipation=m * sp.sqrt(A**2 + B**2)),
            {},
            r"or add v_0\*\*2 to x_dot\*\*2 \+ y_dot\*\*2 under",
        ),
        (lambda: particle((sp.floor(X), 0)), {}, r"derivative of a step, as of floor\(x\), has no code"),
        (lambda: particle((10**400 * X / m, 0)), {}, r"E\+400 is outside the range of doubles: write it with symbols"),
        (pendulum, {"language": ["c"]}, r"language = \['c'\] must be one of"),
        (held_by_a_reaction, {}, "contain a reaction"),
        (with_function, {}, "the function U has no expression"),
        (with_cases, {}, "Piecewise.* has no code in the other language"),
        (pendulum, {"language": "fortran"}, "language = 'fortran' must be one of c, casadi, jax, julia, matlab"),
        (pendulum, {"name": " "}, "name = ' ' must be the name"),
    ],
)
def test_refusals_come_before_anything_is_written(
    system: Callable[[], System], arguments: dict[str, Any], words: str, tmp_path: Path
) -> None:
    call: dict[str, Any] = {"language": "c", "name": "arm", **arguments}
    with pytest.raises(InputError, match=words):
        system().export(folder=tmp_path / "new", **call)
    assert not any(tmp_path.iterdir())


def test_files_of_others_stay(tmp_path: Path) -> None:
    (tmp_path / "arm.c").write_text("int main(void) { return 0; }")
    with pytest.raises(InputError, match=r"arm\.c exists, and lagrotor did not write it"):
        pendulum().export("c", tmp_path, "arm")
    assert [file.name for file in tmp_path.iterdir()] == ["arm.c"]
    pendulum().export("c", tmp_path, "rod")
    pendulum().export("julia", tmp_path, "rod")
    pendulum().export("c", tmp_path, "rod")
    with pytest.raises(InputError, match=r"rod\.h is of another system with the name 'rod'"):
        driven().export("julia", tmp_path, "rod")
    (tmp_path / "rod.h").unlink()
    (tmp_path / "rod.c").unlink()
    driven().export("julia", tmp_path, "rod")
    with pytest.raises(InputError, match=r"arm\.c: File exists: choose a folder"):
        pendulum().export("c", tmp_path / "arm.c", "rod")


def test_no_half_a_folder_when_the_disk_is_full(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write = Path.write_text

    def full(path: Path, text: str, **how: Any) -> int:
        if path.suffix == ".json":
            raise OSError(28, "No space left on device")
        return write(path, text, **how)

    monkeypatch.setattr(Path, "write_text", full)
    with pytest.raises(InputError, match="No space left on device"):
        pendulum().export("c", tmp_path / "new", "arm")
    assert not any(tmp_path.iterdir())


def test_the_description(about: dict[str, Any]) -> None:
    cart, arm = about["cart"], about["arm"]
    assert {*cart} == {"states", "parameters", "outputs", "functions", "digest"}
    assert [(s["name"], s["unit"]) for s in cart["states"]][::3] == [("z", "m"), ("z_dot", "m/s")]
    assert cart["parameters"] == [{"name": s, "unit": unit} for s, unit in (("g", "m/s2"), ("l", "m"), ("m", "kg"))]
    rows = cart["outputs"]["joint_forces"]["rows"]
    assert [row["name"] for row in rows][::6] == [f"{joint} force x" for joint in ("rail", "first", "second")]
    assert rows[3] == {"name": "rail torque x", "unit": "N m"} and cart["functions"]["joint_forces"]["shape"] == [3, 6]
    matrix = cart["outputs"]["mass_matrix"]
    assert matrix["rows"][0] == {"name": "force on z_dot", "unit": "N"}
    assert matrix["columns"][1] == {"name": "alpha_ddot", "unit": "rad/s2"}
    assert cart["functions"]["inverse_dynamics"]["arguments"] == ["t", "x", "p", "a"]
    assert {p["name"]: p["value"] for p in arm["parameters"]}["m_l1"] == 3.6
    assert {*arm["functions"]} == {*FUNCTIONS} and len(arm["digest"]) == 64


def test_the_forces_in_joints_are_left_out_with_the_reason(tmp_path: Path) -> None:
    disc, _ = rolling_disc()
    with pytest.warns(LagrotorWarning, match="export: without joint_forces: the constraint .* does not say"):
        files = disc.export("matlab", tmp_path, "disc")
    assert not [file for file in files if "joint" in file.name]


def test_names_are_identifiers_of_every_language() -> None:
    texts = ("lambda", "end", "t", "dx", "a.b", "a_b", "θ_1", "2x", "x" * 80, "s12", "M_PI", "a\n*/ b", "sin")
    made = identifiers(texts, ("dx",))
    assert made[:8] == ["lambda_2", "end_2", "t_2", "dx_2", "a_b", "a_b_2", "theta_1", "v_2x"]
    assert len({*made}) == len(made) and all(re.fullmatch(r"[A-Za-z]\w{0,59}", name, re.ASCII) for name in made)
