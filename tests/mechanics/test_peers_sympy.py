"""Every system of which sympy's own mechanics tests form equations, taken by `from_sympy` and held to sympy's own equations.

The tests that sympy ships are run, the methods that they make are kept, and at random states on the constraints the derivatives
of coordinates and speeds are compared with those of sympy's mass_matrix_full and forcing_full.
"""

import importlib
import warnings
from typing import Any

import numpy as np
import pytest
import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.physics.mechanics import KanesMethod, LagrangesMethod, dynamicsymbols

from lagrotor.errors import InputError, LagrotorError
from lagrotor.mechanics import System, t

CLOCK, AT = dynamicsymbols._t, 0.4


def methods_of(module: str, name: str, monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The methods whose equations a test of sympy forms, each once."""
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
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        getattr(tests, name)()
    monkeypatch.undo()
    return list(made.values())


def difference(method: Any, seed: int) -> float:
    """The largest difference of q' and u', of q' and q'' and multipliers, relative to the largest."""
    system, n, random = System.from_sympy(method), len(method.q), np.random.default_rng(seed)
    full = [sp.Matrix(e) for e in (method.mass_matrix_full, method.forcing_full)]
    rates = [f.diff(CLOCK) for f in method.q]
    kane = isinstance(method, KanesMethod)
    speeds = list(method.u) if kane else rates
    parts = (system.L, *system.forces, *system.constraints, *system.rolling)
    own = set().union(*(e.free_symbols for e in parts))
    letters = set().union(own, *(e.free_symbols for e in full)) - {*system.c.q, *system.c.v, CLOCK, t}
    values = {s: random.uniform(0.5, 1.5) for s in sorted(letters, key=str)}
    prescribed = {f for e in full for f in e.atoms(AppliedUndef) if f.args == (CLOCK,)} - {*method.q, *speeds}
    constants = {f: random.uniform(-1, 1) for f in sorted(prescribed, key=str)}
    constants |= dict.fromkeys(getattr(method, "_uaux", ()), 0.0)  # of forces that do no work
    functions = {str(f.func) for e in parts for f in e.atoms(AppliedUndef)}
    taken = {str(s): x for s, x in values.items() if s in own}
    taken |= {str(f.func): x for f, x in constants.items() if str(f.func) in functions}
    for _ in range(8):
        try:
            q, v = system.consistent(taken, random.uniform(-0.9, 0.9, n), random.uniform(-1, 1, n), AT)
            break
        except LagrotorError as refusal:
            last = refusal
    else:
        raise last
    moved = np.array(system.rhs(taken)(AT, np.concatenate([q, v])))[n:]
    at = dict(zip(method.q, q, strict=True)) | values
    still = {f.diff(CLOCK): 0 for f in constants}
    moving = dict(zip(rates, v, strict=True))

    def number(e: sp.Matrix, *puts: Any) -> np.ndarray:
        for put in (*puts, moving, still, constants, at, {CLOCK: AT}):
            e = e.xreplace(put)
        return np.array(e.evalf().tolist(), float)

    u, names = v, dict(zip(speeds, sp.symbols(f"u:{len(speeds)}", cls=sp.Dummy), strict=True))
    if kane:
        held = method._k_nh * method.u + method._f_nh if len(method._k_nh) else sp.zeros(0, 1)
        kinematic = method._k_kqdot_implicit * method._qdot + method._k_ku_implicit * method.u + method._f_k_implicit
        both = sp.Matrix([*kinematic, *held]).xreplace(names)
        rest = both.xreplace(dict.fromkeys(names.values(), 0))
        u = np.linalg.lstsq(number(both.jacobian(list(names.values()))), -number(rest), rcond=None)[0].ravel()
    put = dict(zip(speeds, u, strict=True))
    theirs = np.linalg.lstsq(*(number(e, put) for e in full), rcond=None)[0].ravel()
    if kane:  # q'' from theirs: the kinematic equations, differentiated along the motion
        accelerations = sp.symbols(f"a:{n}", cls=sp.Dummy)
        turning = kinematic.diff(CLOCK).xreplace({r.diff(CLOCK): a for r, a in zip(rates, accelerations, strict=True)})
        turning = turning.xreplace({s.diff(CLOCK): x for s, x in zip(speeds, theirs[n:], strict=True)})
        rest = turning.xreplace(dict.fromkeys(accelerations, 0))
        theirs = np.linalg.solve(number(turning.jacobian(accelerations), put), -number(rest, put)).ravel()
    else:
        theirs = theirs[n : 2 * n]
    mine = moved
    return float(np.abs(mine - theirs).max() / max(1.0, np.abs(theirs).max()))


QUICK = {
    "test_kane": "one_dof two_dof pend rolling_disc",
    "test_kane2": "sub_qdot",
    "test_kane4": "replace_qdots_in_force",
    "test_lagrange": "disc_on_an_incline_plane simp_pen nonminimal_pendulum dub_pen",
    "test_lagrange2": "lagrange_2forces",
    "test_models": "multi_mass_spring_damper_higher_order n_link_pendulum_on_cart_inputs",
    "test_jointsmethod": "chaos_pendulum simple_pedulum",
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
}


def cases(table: dict[str, str]) -> list[tuple[str, str]]:
    return [(module, f"test_{name}") for module, names in table.items() for name in names.split()]


@pytest.mark.parametrize(
    ("module", "name"),
    [*cases(QUICK), *(pytest.param(*each, marks=pytest.mark.slow) for each in cases(LONG))],
)
def test_it_moves_as_sympy_says(module: str, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    methods = methods_of(module, name, monkeypatch)
    if (module, name) == ("test_kane", "test_aux"):
        with pytest.raises(
            InputError, match="do not give every speed"
        ):  # speeds without coordinates, which bring out forces
            System.from_sympy(methods.pop(0))
    assert methods
    assert max(difference(method, 1) for method in methods) < 1e-9


def test_another_motion_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """The twin: a pendulum with another force than sympy's."""
    (method,) = methods_of("test_lagrange", "test_simp_pen", monkeypatch)
    assert difference(method, 1) < 1e-12
    own = System.from_sympy(method)
    monkeypatch.setattr(System, "from_sympy", staticmethod(lambda _: System(own.c, own.L, forces=(own.c.q[0],))))
    assert difference(method, 1) > 1e-3
