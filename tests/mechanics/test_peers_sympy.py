"""Every system of which sympy's own mechanics tests form equations, taken by `from_sympy` and held to sympy's own equations.

The tests that sympy ships are run, the methods that they make are kept, and at random states on the constraints the derivatives
of coordinates and speeds are compared with those of sympy's mass_matrix_full and forcing_full.
"""

import importlib
import sys
import warnings
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.physics.mechanics import KanesMethod, LagrangesMethod, dynamicsymbols

from lagrotor.errors import LagrotorError
from lagrotor.mechanics import System, t

CLOCK, AT = dynamicsymbols._t, 0.4


def methods_of(
    module: str, name: str, monkeypatch: pytest.MonkeyPatch, stop: type[Exception] | None = None
) -> list[Any]:
    """The methods whose equations a test of sympy forms, each once; by `stop` it may be ended."""
    made: dict[int, Any] = {}

    def keep(method: type, call: str) -> None:
        own = getattr(method, call)

        def kept(self: Any, *given: Any, **more: Any) -> Any:
            result = own(self, *given, **more)
            made[id(self)] = self
            return result

        monkeypatch.setattr(method, call, kept)

    keep(KanesMethod, "kanes_equations")
    keep(LagrangesMethod, "form_lagranges_equations")
    try:
        tests = importlib.import_module(f"sympy.physics.mechanics.tests.{module}")
    except ModuleNotFoundError:
        pytest.skip("this sympy is installed without its tests")
    with warnings.catch_warnings(), suppress(*([stop] if stop else [])):
        warnings.simplefilter("ignore")
        group, _, one = name.rpartition(".")
        getattr(getattr(tests, group)() if group else tests, one)()
    monkeypatch.undo()
    return list(made.values())


def difference(method: Any, seed: int) -> float:
    """The largest difference of q' and u', of q' and q'' and multipliers, relative to the largest."""
    system, random = System.from_sympy(method), np.random.default_rng(seed)
    n, size = len(method.q), len(system.c.q)
    full = [sp.Matrix(e) for e in (method.mass_matrix_full, method.forcing_full)]
    rates = [f.diff(CLOCK) for f in method.q]
    kane = isinstance(method, KanesMethod)
    speeds = list(method.u) if kane else rates
    parts = (system.L, *system.forces, *system.constraints, *system.rolling)
    known = set().union(*(e.free_symbols for e in parts))
    letters = set().union(known, *(e.free_symbols for e in full)) - {*system.c.q, *system.c.v, CLOCK, t}
    values = {s: random.uniform(0.5, 1.5) for s in sorted(letters, key=str)}
    prescribed = {f for e in full for f in e.atoms(AppliedUndef) if f.args == (CLOCK,)} - {*method.q, *speeds}
    constants = {f: random.uniform(-1, 1) for f in sorted(prescribed, key=str)}
    constants |= dict.fromkeys(getattr(method, "_uaux", ()), 0.0)  # of forces that do no work
    functions = {str(f.func) for e in parts for f in e.atoms(AppliedUndef)}
    taken = {str(s): x for s, x in values.items() if s in known}
    taken |= {str(f.func): x for f, x in constants.items() if str(f.func) in functions}
    for _ in range(8):
        try:
            q, v = system.consistent(taken, random.uniform(-0.9, 0.9, size), random.uniform(-1, 1, size), AT)
            break
        except LagrotorError as refusal:
            last = refusal
    else:
        raise last
    moved = np.array(system.rhs(taken)(AT, np.concatenate([q, v])))[size:]
    at = dict(zip(method.q, q[:n], strict=True)) | values
    still = {f.diff(CLOCK): 0 for f in constants}
    moving = dict(zip(rates, v[:n], strict=True))
    own = [s for s in speeds if f"q_{s.func.__name__}" in map(str, system.c.q[n:])] if kane else []

    def number(e: sp.Matrix, *puts: Any) -> np.ndarray:
        for put in (*puts, moving, still, constants, at, {CLOCK: AT}):
            e = e.xreplace(put)
        return np.array(e.evalf().tolist(), float)

    u, names = v, dict(zip(speeds, sp.symbols(f"u:{len(speeds)}", cls=sp.Dummy), strict=True))
    if kane:
        held = method._k_nh * method.u + method._f_nh if len(method._k_nh) else sp.zeros(0, 1)
        kinematic = method._k_kqdot_implicit * method._qdot + method._k_ku_implicit * method.u + method._f_k_implicit
        turning = [u - x for u, x in zip(own, v[n:], strict=True)]
        both = sp.Matrix([*kinematic, *held, *turning]).xreplace(names)
        rest = both.xreplace(dict.fromkeys(names.values(), 0))
        u = np.linalg.lstsq(number(both.jacobian(list(names.values()))), -number(rest), rcond=None)[0].ravel()
    put = dict(zip(speeds, u, strict=True))
    theirs = np.linalg.lstsq(*(number(e, put) for e in full), rcond=None)[0].ravel()
    if kane:  # q'' from theirs: the kinematic equations, differentiated along the motion
        accelerations = sp.symbols(f"a:{n}", cls=sp.Dummy)
        turning = kinematic.diff(CLOCK).xreplace({r.diff(CLOCK): a for r, a in zip(rates, accelerations, strict=True)})
        turning = turning.xreplace({s.diff(CLOCK): x for s, x in zip(speeds, theirs[n:], strict=True)})
        rest = turning.xreplace(dict.fromkeys(accelerations, 0))
        rates_of_own = [theirs[n + speeds.index(s)] for s in own]
        theirs = np.linalg.solve(number(turning.jacobian(accelerations), put), -number(rest, put)).ravel()
        theirs = np.append(theirs, rates_of_own)
    else:
        theirs = theirs[n : 2 * n]
    return float(np.abs(moved - theirs).max() / max(1.0, np.abs(theirs).max()))


QUICK = {
    "test_kane": "one_dof two_dof pend rolling_disc",
    "test_kane2": "sub_qdot",
    "test_kane4": "replace_qdots_in_force",
    "test_lagrange": "disc_on_an_incline_plane simp_pen nonminimal_pendulum dub_pen",
    "test_lagrange2": "lagrange_2forces",
    "test_models": "multi_mass_spring_damper_higher_order n_link_pendulum_on_cart_inputs",
    "test_jointsmethod": "chaos_pendulum simple_pedulum",
    "test_system_class": "TestSystemExamples.box_on_ground",
}
LONG = {
    "test_kane": "aux parallel_axis input_format implicit_kinematics",
    "test_kane2": "aux_dep non_central_inertia",
    "test_kane5": "kane_rolling_disc_lu",
    "test_lagrange": "rolling_disc",
    "test_jointsmethod": (
        "jointsmethod rigid_body_particle_compatibility complete_simple_double_pendulum two_dof_joints "
        "four_bar_linkage_with_manual_constraints"
    ),
    "test_linearize": (
        "linearize_rolling_disc_kane linearize_pendulum_kane_minimal linearize_pendulum_kane_nonminimal "
        "linearize_pendulum_lagrange_minimal linearize_pendulum_lagrange_nonminimal linearize_rolling_disc_lagrange"
    ),
    "test_models": "multi_mass_spring_damper_inputs n_link_pendulum_on_cart_higher_order",
    "test_system_class": "TestSystemExamples.cart_pendulum_kanes TestSystemExamples.cart_pendulum_lagrange",
}


def cases(table: dict[str, str]) -> list[tuple[str, str]]:
    return [
        (module, ".".join([*groups, f"test_{name}"]))
        for module, names in table.items()
        for *groups, name in (each.split(".") for each in names.split())
    ]


@pytest.mark.parametrize(
    ("module", "name"),
    [*cases(QUICK), *(pytest.param(*each, marks=pytest.mark.slow) for each in cases(LONG))],
)
def test_it_moves_as_sympy_says(module: str, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    methods = methods_of(module, name, monkeypatch)
    assert methods
    assert max(difference(method, 1) for method in methods) < 1e-9


@pytest.mark.slow
def test_the_bicycle_moves_as_sympy_says_and_has_the_matrix_of_its_test(monkeypatch: pytest.MonkeyPatch) -> None:
    """test_kane3.py, stopped before sympy linearises, its numbers read there (Meijaard et al., 2007)."""
    numbers: dict[Any, Any] = {}

    class FormedError(Exception):
        pass

    def stopped(self: Any, **_: Any) -> None:
        numbers.update(sys._getframe(1).f_locals["val_dict"])
        raise FormedError

    monkeypatch.setattr(KanesMethod, "linearize", stopped)
    (method,) = methods_of("test_kane3", "test_bicycle", monkeypatch, FormedError)
    assert difference(method, 1) < 1e-9
    system = System.from_sympy(method)
    v, values = sp.Symbol("v"), {s: float(x) for s, x in numbers.items() if isinstance(s, sp.Symbol)}
    for speed in (1, 5):
        spins = {f"q_{s.func.__name__}_dot": x.subs(v, speed) for s, x in numbers.items() if sp.sympify(x).has(v)}
        still = dict.fromkeys(map(str, (*system.c.q, *system.c.v)), 0)
        rates = system.linearise(still | spins, values).rates
        lean = [9.48977444677355, -0.891197738059089 * speed**2 - 0.571523173729245]
        steer = [11.7194768719633, -1.97171508499972 * speed**2 + 30.9087533932407]
        lean += [-0.105522449805691 * speed, -0.330515398992311 * speed]
        steer += [3.67680523332152 * speed, -3.08486552743311 * speed]
        theirs = np.linalg.eigvals(np.array([[0, 0, 1, 0], [0, 0, 0, 1], lean, steer]))
        assert max(np.abs(rates - root).min() for root in theirs) < 1e-9
        assert sum(abs(rate) > 1e-6 for rate in rates) == 4


def test_another_motion_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """The twin: a pendulum with another force than sympy's."""
    (method,) = methods_of("test_lagrange", "test_simp_pen", monkeypatch)
    assert difference(method, 1) < 1e-12
    own = System.from_sympy(method)
    monkeypatch.setattr(System, "from_sympy", staticmethod(lambda _: System(own.c, own.L, forces=(own.c.q[0],))))
    assert difference(method, 1) > 1e-3
