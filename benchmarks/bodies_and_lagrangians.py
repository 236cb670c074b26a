"""`python -m benchmarks.bodies_and_lagrangians`: rods, gyroscopes, an arm of six joints and the bicycle of sympy's
test_kane3, from bodies beside Kane's method, and from their Lagrangian written out beside Lagrange's: time to be ready, time of
a right-hand side. --record writes the record that is shown.

Each in a process of its own, ended after LONGEST; right-hand sides are compared before they are timed.
"""

import argparse
import importlib
import sys
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import sympy as sp

from benchmarks.machine import machine
from benchmarks.mechanisms.chains import JOINTS, VALUES, chain
from benchmarks.mechanisms.comparison import SAME, _clock, _time_of
from benchmarks.mechanisms.sympy_tools import kane, lagrange
from benchmarks.mechanisms.tool import forget_all, in_own_process
from lagrotor.benchmark.records import LINKS, MechanismKind, write_record
from lagrotor.benchmark.runner import check_work
from lagrotor.mechanics import Frame, System, coordinates

LONGEST = 90.0  # s of processor time
AXES = "zyyxyx"  # of the arm's joints
LENGTHS = (0.3, 0.6, 0.5, 0.2, 0.1, 0.1)  # m, along z of each link
MASSES, INERTIAS = (8, 6, 4, 2, 1, 0.5), ((0.3, 0.25, 0.1), (0.2, 0.22, 0.05), (0.1, 0.12, 0.03))  # kg, kg m²
ARM = {f"m_{i}": x for i, x in enumerate(MASSES)} | {f"l_{i}": x for i, x in enumerate(LENGTHS)} | {"g": 9.81}
ARM |= {f"I_{i}{k}": INERTIAS[i % 3][k] / (1 + i // 3) for i in range(6) for k in range(3)}
Rhs = Callable[[Any, Any], Any]


def arm(bodies: bool) -> Rhs:
    """The right-hand side."""
    c = coordinates([f"q_{i}" for i in range(6)])
    frame, L = Frame(c), sp.S.Zero
    for i, axis in enumerate(AXES):
        frame = frame.turned(axis, c.q[i])
        m, l, *I = sp.symbols(f"m_{i} l_{i} I_{i}0 I_{i}1 I_{i}2", positive=True)
        body = frame.body(m, tuple(I), (0, 0, l / 2))
        L = body.kinetic - body.potential((0, 0, -sp.Symbol("g"))) + L
        frame = frame.moved(0, 0, l)
    system = System(c, L)
    values = {sp.Symbol(s): x for s, x in ARM.items()}  # symbols that L has not are passed over
    return (system if bodies else System(c, system.L)).rhs(values)


def arm_of_sympy(by_kane: bool) -> Rhs:
    """By Kane's or by Lagrange's method, lambdified with common subexpressions, solved by numpy."""
    from sympy.physics import mechanics as me

    q, values = me.dynamicsymbols("q:6"), {sp.Symbol(s): x for s, x in ARM.items()}
    u = me.dynamicsymbols("u:6") if by_kane else [a.diff() for a in q]
    N, start = me.ReferenceFrame("N"), me.Point("O")
    start.set_vel(N, 0)
    joint, frame, spin, bodies, loads, g = start, N, 0 * N.x, [], [], sp.Symbol("g")
    for i, axis in enumerate(AXES):
        m, l, *I = sp.symbols(f"m_{i} l_{i} I_{i}0 I_{i}1 I_{i}2")
        turned = frame.orientnew(f"A{i}", "Axis", (q[i], getattr(frame, axis)))
        spin = spin + u[i] * getattr(frame, axis)
        turned.set_ang_vel(N, spin)
        centre = joint.locatenew(f"C{i}", l / 2 * turned.z)
        centre.v2pt_theory(joint, N, turned)
        bodies.append(me.RigidBody(f"B{i}", centre, turned, m, (me.inertia(turned, *I), centre)))
        loads.append((centre, -m * g * N.z))
        end = joint.locatenew(f"P{i}", l * turned.z)
        end.v2pt_theory(joint, N, turned)
        frame, joint = turned, end
    if by_kane:
        method = me.KanesMethod(N, q, u, [a.diff() - b for a, b in zip(q, u, strict=True)])
        method.kanes_equations(bodies, loads)
    else:
        kinetic = sum(body.kinetic_energy(N) for body in bodies)
        height = (b.mass * g * b.masscenter.pos_from(start).dot(N.z) for b in bodies)
        method = me.LagrangesMethod(kinetic - sum(height), q)
        method.form_lagranges_equations()
    return _solved(method, list(q), list(u), values)


def _solved(method: Any, q: list[Any], speeds: list[Any], values: Mapping[Any, float]) -> Rhs:
    names = sp.symbols(f"y:{len(q) + len(speeds)}")
    put = [dict(zip(speeds, names[len(q) :], strict=True)), dict(zip(q, names[: len(q)], strict=True))]
    full = [e.xreplace(put[0]).xreplace(put[1]) for e in (method.mass_matrix_full, method.forcing_full)]
    function = sp.lambdify([names, list(values)], full, "numpy", cse=True)
    numbers = list(values.values())

    def rhs(t: float, y: Any) -> Any:
        M, f = function(y, numbers)
        return np.linalg.solve(M, f)[:, 0]

    return rhs


def sympys_bicycle() -> tuple[Any, dict[Any, float]]:
    """The KanesMethod of test_kane3 before its equations are formed, with bodies and loads, and the numbers of its letters."""
    from sympy.physics.mechanics import KanesMethod

    tests, found = importlib.import_module("sympy.physics.mechanics.tests.test_kane3"), dict[str, Any]()

    class FormedError(Exception):
        pass

    def stopped(self: Any, **_: Any) -> None:
        found.update(sys._getframe(1).f_locals)
        raise FormedError

    own, KanesMethod.linearize = KanesMethod.linearize, stopped
    try:
        tests.test_bicycle()
    except FormedError:
        pass
    finally:
        KanesMethod.linearize = own
    values = {s: float(x) for s, x in found["val_dict"].items() if isinstance(s, sp.Symbol)}
    return found, values


def bicycle(bodies: bool, values: Mapping[Any, float]) -> System:
    """The bicycle of test_kane3 with the place of its rear contact and the turns of its wheels, in the rates of lean, rear wheel
    and steering."""
    s = {str(x): x for x in values}
    c = coordinates("x y q1 q2 q3 q4 q5 q6")
    x, y, yaw, lean, rear_turn, pitch, steer, front_turn = c.q

    def inertia(part: str) -> Any:
        a, b, d, across = (s[f"I{part}{ij}"] for ij in ("11", "22", "33", "31"))
        return [[a, 0, across], [0, b, 0], [across, 0, d]]

    hub = Frame(c).moved(x, y, 0).turned("z", yaw).turned("x", lean).moved(0, 0, s["WRrad"])
    chassis = hub.turned("y", pitch + s["htangle"])
    rear = chassis.turned("y", rear_turn).body(s["mwr"], (s["Iwr11"], s["Iwr22"], s["Iwr11"]))
    rider = (
        chassis.moved(-s["framecg1"], 0, s["framecg3"]).turned("y", -s["htangle"]).body(s["mframe"], inertia("frame"))
    )
    fork = chassis.moved(0, 0, s["framelength"]).turned("x", steer)
    bar = fork.moved(-s["forkcg1"], 0, s["forkcg3"]).turned("y", -s["htangle"]).body(s["mfork"], inertia("fork"))
    front_hub = fork.moved(s["forklength"], 0, s["forkoffset"])
    front = front_hub.turned("y", front_turn).body(s["mwf"], (s["Iwf11"], s["Iwf22"], s["Iwf11"]))
    height = front_hub.place()[2]
    rise = sp.Matrix([front_hub.place((1, 0, 0))[2] - height, 0, front_hub.place((0, 0, 1))[2] - height])
    length, f = sp.sqrt(rise.dot(rise)), s["WFrad"]
    slips = (
        rear.frame.velocity((0, 0, -s["WRrad"]), hub)[:2]
        + front.frame.velocity(list(-f * rise / length), front_hub)[:2]
    )
    down = (0, 0, -s["g"])
    L = sum((b.kinetic - b.potential(down) for b in (rider, bar, front)), rear.kinetic - rear.potential(down))
    own = {sp.Symbol(f"u{i}", real=True): c.v[1 + i] for i in (2, 3, 5)}
    held = (height - f * length,)
    return System(c, L if bodies else System(c, L).L, held, tuple(slips), velocities=own)


def bicycle_by_lagrange(values: Mapping[Any, float]) -> Rhs:
    """sympy's, of the same Lagrangian, constraint and slips."""
    from sympy.physics import mechanics as me

    system = bicycle(True, values)
    q = me.dynamicsymbols(" ".join(map(str, system.c.q)))
    moving = dict(zip((*system.c.q, *system.c.v), (*q, *(x.diff() for x in q)), strict=True))
    L, *held = (e.xreplace(moving) for e in (system.L, *system.constraints, *system.rolling))
    method = me.LagrangesMethod(L, q, hol_coneqs=held[:1], nonhol_coneqs=held[1:])
    method.form_lagranges_equations()
    return _solved(method, list(q), [x.diff() for x in q], values)


def _links(name: str) -> tuple[MechanismKind, int] | None:
    """The kind and number in "3 rods"."""
    number, _, kind = name.partition(" ")
    return (("rods" if kind.startswith("rod") else "gyroscopes"), int(number)) if kind else None


def _state(name: str, tool: str) -> np.ndarray:
    """One state, as a tool has it."""
    if name != "bicycle":
        n = JOINTS[links[0]] * links[1] if (links := _links(name)) else 6
        return np.random.default_rng(1).uniform(-0.5, 0.5, 2 * n)
    found, values = sympys_bicycle()
    system = bicycle(True, values)
    q, u = system.consistent(values, (0, 0, 0.1, 0.2, 0.3, 0.05, 0.2, 0.4), (0.3, -2, 0.2))
    y = np.concatenate([q, u])
    v = system.rhs(values)(0.0, y)[:8]
    if tool == "LagrangesMethod":
        return np.concatenate([q, v])
    if tool != "KanesMethod":
        return y
    at = dict(zip(map(str, (*system.c.q, *system.c.v)), (*q, *v), strict=True))
    method = found["KM"]
    turned = [at[f"q{s.func.__name__[1:]}_dot"] for s in method.u]
    return np.array([*(at[s.func.__name__] for s in method.q), *turned])


def _rates(name: str, tool: str, rates: Any) -> np.ndarray:
    """The accelerations that all have."""
    rates = np.asarray(rates, float)
    if name == "bicycle":
        return rates[{"KanesMethod": [4, 5, 6], "LagrangesMethod": [11, 12, 14]}.get(tool, [8, 9, 10])]
    return rates[len(rates) // 2 :]


def _made(name: str, tool: str, values: Mapping[Any, float]) -> Rhs:
    bodies = "Lagrang" not in tool
    if links := _links(name):
        if not tool.startswith("lagrotor"):
            return (kane if bodies else lagrange)(*links).rhs
        system = chain(*links)
        return (system if bodies else System(system.c, system.L)).rhs(VALUES)
    if name == "arm":
        return arm(bodies) if tool.startswith("lagrotor") else arm_of_sympy(bodies)
    if tool.startswith("lagrotor"):
        return bicycle(bodies, values).rhs(values)
    if not bodies:
        return bicycle_by_lagrange(values)
    method = sympys_bicycle()[0]["KM"]
    return _solved(method, list(method.q), list(method.u), values)


def _measured(send: Callable[[Any], None], spend: Callable[[], Any], name: str, tool: str) -> None:
    """Ready once, as after a start: what the known rates were made with is forgotten."""
    values = sympys_bicycle()[1] if name == "bicycle" else {}
    known = _rates(name, TOOLS[0], _made(name, TOOLS[0], values)(0.0, _state(name, TOOLS[0])))
    state = _state(name, tool)
    forget_all()
    spend()
    before = _clock()
    rhs = _made(name, tool, values)
    ready = _clock() - before
    off = np.abs(_rates(name, tool, rhs(0.0, state)) - known).max() / np.abs(known).max()
    check_work(f"{tool} on {name}", 1, np.array([known]), float(off))  # an error that is not finite is refused
    send((ready, _time_of(lambda: rhs(0.0, state)) if off < SAME else None, float(off)))


TOOLS = ("lagrotor, bodies", "KanesMethod", "lagrotor, Lagrangian", "LagrangesMethod")
CHAINS = {kind: [f"{n} {kind if n > 1 else kind[:-1]}" for n in numbers] for kind, numbers in LINKS.items()}


def measure() -> list[dict[str, Any]]:
    """A row for each tool on each mechanism; a reason in place of what was not measured: over LONGEST, or a smaller one was."""
    rows = list[dict[str, Any]]()
    for names in (*CHAINS.values(), ["arm"], ["bicycle"]):
        lost = dict[str, str]()
        for name in names:
            for tool in TOOLS:
                row: dict[str, Any] = dict.fromkeys(("ready", "rhs", "difference")) | {"mechanism": name, "tool": tool}
                result = lost.get(tool) or in_own_process(_measured, LONGEST, name, tool)
                if isinstance(result, str):
                    row["reason"] = result
                    lost[tool] = f"{result.removesuffix(', with fewer')}, with fewer"
                else:
                    row |= dict(zip(("ready", "rhs", "difference"), result, strict=True)) | {"reason": ""}
                print(row, flush=True)
                rows.append(row)
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m benchmarks.bodies_and_lagrangians", description=__doc__)
    parser.add_argument("--record", action="store_true", help="write the record")
    arguments = parser.parse_args()
    made = {"machine": machine(), "longest": LONGEST, "rows": measure()}
    if arguments.record:
        print(write_record("bodies_and_lagrangians", made))
