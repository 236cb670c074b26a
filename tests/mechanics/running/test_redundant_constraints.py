"""Redundant constraints run, with the reactions that are determined: a parallelogram with a third crank, coupling rods."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor.errors import ConstraintError, InputError, LagrotorError, SingularError
from lagrotor.mechanics import System, SystemRun, coordinates, reaction, t

C = coordinates("x y")
CIRCLE = C.x**2 + C.y**2 - 1
BALL = (C.x_dot**2 + C.y_dot**2) / 2 - 9 * C.y
TIMES = np.linspace(0, 3, 7)

P = coordinates("A B D phi")
S = coordinates("A")


def _crank(angle: sp.Symbol, x: float) -> sp.Matrix:
    return sp.Matrix([x + sp.cos(angle), sp.sin(angle)])


def _parallelogram() -> System:
    """Three cranks of length 1 at x = 0, 2 and 1 carry a rod of length 2 and mass 1/3, whose middle pin is redundant."""
    rod = sp.Matrix([sp.cos(P.phi), sp.sin(P.phi)])
    ends = (_crank(P.A, 0) + 2 * rod - _crank(P.B, 2), _crank(P.A, 0) + rod - _crank(P.D, 1))
    names = ["end x", "end y", "middle x", "middle y"]
    kinetic = (P.A_dot**2 + P.B_dot**2 + P.D_dot**2) / 6 + P.phi_dot**2 / 6
    weight = 4.9 * (sp.sin(P.A) + sp.sin(P.B) + sp.sin(P.D))
    return System(P, kinetic - weight, constraints=dict(zip(names, [*ends[0], *ends[1]], strict=True)))


PARALLELOGRAM = _parallelogram()
ONE_ANGLE = System(S, S.A_dot**2 / 2 - 14.7 * sp.sin(S.A))


def test_a_parallelogram_with_a_third_crank_moves_as_one_angle() -> None:
    run = PARALLELOGRAM.simulate({}, [-1, -1, -1, 0], [0, 0, 0, 0], TIMES)
    alone = ONE_ANGLE.simulate({}, [-1], [0], TIMES)
    np.testing.assert_allclose(run.q[:, :3], np.repeat(alone.q, 3, axis=1), atol=1e-9)
    assert run.drift.max() < 1e-12
    assert run.redundancy is not None
    assert len(run.redundancy.dropped) == 1
    assert not run.reactions
    q, v = PARALLELOGRAM.consistent({}, [-1.1, -1, -0.95, 0.02], [1, 0, 0, 0])
    np.testing.assert_allclose([np.ptp(q[:3]), q[3], np.ptp(v[:3]), v[3]], 0, atol=1e-12)
    at = PARALLELOGRAM.rest({"A": -1, "B": -1.1, "D": -1.2, "phi": 0}, {})
    linear = PARALLELOGRAM.linearise(at, {})
    np.testing.assert_allclose(linear.rates.imag, [-np.sqrt(14.7), np.sqrt(14.7)])
    period = float(np.pi)
    multipliers = PARALLELOGRAM.floquet(at.at, {}, period).multipliers
    np.testing.assert_allclose(np.sort(multipliers.real), 2 * [np.cos(period * np.sqrt(14.7))], rtol=1e-7)


def test_a_parallelogram_that_lies_flat_is_singular() -> None:
    with pytest.raises(SingularError, match="dependent"):
        PARALLELOGRAM.simulate({}, [0, 0, 0, 0], [0, 0, 0, 0], TIMES)


TWINS: dict[str, dict[str, Any]] = {
    "own derivative": {"constraints": (CIRCLE,), "rolling": (C.x * C.x_dot + C.y * C.y_dot,)},
    "multiple": {"constraints": (CIRCLE, 3 * CIRCLE)},
    "with a factor": {"constraints": (CIRCLE, CIRCLE * (2 + C.x))},
}


@pytest.mark.parametrize("twin", TWINS)
def test_a_constraint_beside_its_twin(twin: str, tmp_path: Path) -> None:
    system = System(C, BALL, **TWINS[twin])
    run = system.simulate({}, [0, -1], [1, 0], TIMES)
    alone = System(C, BALL, constraints=(CIRCLE,)).simulate({}, [0, -1], [1, 0], TIMES)
    np.testing.assert_allclose(run.q, alone.q, atol=1e-8)
    for refused in (lambda: run.reactions["2"], lambda: run.evaluate(system.multipliers[1])):
        with pytest.raises(InputError, match=r"is not determined: the constraints 1, 2 are dependent .*leave . out"):
            refused()
    np.testing.assert_allclose(system.consistent({}, [0, -1.2], [1, 0.3]), [[0, -1], [1, 0]], atol=1e-12)
    np.testing.assert_allclose(system.consistent({}, [0, -1], [1, 0.3]), [[0, -1], [1, 0]], atol=1e-12)
    again = SystemRun.load(run.save(tmp_path / "twin.npz"), system)
    np.testing.assert_array_equal(again.drift, run.drift)
    with pytest.raises(InputError, match="not determined"):
        again.reactions["1"]


def test_other_reactions_are_determined() -> None:
    """A ball on a slope of 45° beside the pendulum: half its weight, as in the system without redundancy."""
    c = coordinates("x y s h")
    pendulum = c.x**2 + c.y**2 - 1
    rods = {"rod": pendulum, "slope": c.s - c.h, "second rod": 2 * pendulum}
    lagrangian = sum(v**2 for v in c.v) / 2 - 9 * c.y - 9 * c.h
    run = System(c, lagrangian, constraints=rods).simulate({}, [0, -1, 0, 0], [1, 0, 0, 0], [0, 1])
    assert [*run.reactions] == ["slope"]
    np.testing.assert_allclose(run.reactions["slope"], -4.5)
    with pytest.raises(KeyError):
        run.reactions["spring"]


def test_coupling_rods_at_a_right_angle_pass_the_dead_points_of_each() -> None:
    """Two wheels, geared as one; the kept rod alone is singular where the cranks lie on the line of the centres."""
    c = coordinates("A B")
    rods = []
    for phase in (0, sp.pi / 2):
        d = _crank(c.B + phase, 3) - _crank(c.A + phase, 0)
        rods.append(d.dot(d) - 9)
    system = System(c, (c.A_dot**2 + 2 * c.B_dot**2) / 2 - c.A / 3 - sp.cos(c.B), constraints=rods)
    with pytest.warns(match="does not keep tol") as caught:
        run = system.simulate({}, [0.5, 0.5], [3, 3], np.linspace(0, 6, 61))
    assert not any("become dependent" in str(warning.message) for warning in caught)
    one = System(S, 3 * S.A_dot**2 / 2 - S.A / 3 - sp.cos(S.A)).simulate({}, [0.5], [3], run.t)
    assert np.abs(run.q - one.q).max() < min(run.error, 1e-7)


def test_constraints_that_contradict_each_other_later_end_the_run() -> None:
    system = System(C, BALL, constraints={"first": C.x - t**3, "second": C.x - t**4})
    with pytest.warns(match="no longer hold at t = 0.25 s: they contradict"):
        run = system.simulate({}, [0, 0], [0, 0], [0, 0.25, 1])
    assert run.ending.kind == "stopped"


REFUSED: dict[str, tuple[type[LagrotorError], Callable[[], Any]]] = {
    "no state near the start satisfies the constraints 1, 2": (
        ConstraintError,
        lambda: System(C, BALL, constraints=(C.x, C.x - 1)).simulate({}, [0, 0], [0, 0], TIMES),
    ),
    "no state near the start satisfies the constraints 1, 2 ": (
        ConstraintError,
        lambda: System(C, BALL, constraints=(C.x - t, C.x - 2 * t)).simulate({}, [0, 0], [1, 0], TIMES),
    ),
    "the constraints are dependent": (  # a double zero binds x, but its row is zero
        SingularError,
        lambda: System(C, BALL, constraints=(C.x**2,)).simulate({}, [0, 0], [0, 0], TIMES),
    ),
    "which is not determined": (
        InputError,
        lambda: System(
            C, BALL, constraints=(C.y, 2 * C.y), dissipation=sp.Abs(reaction(1)) * sp.Abs(C.x_dot) / 9
        ).simulate({}, [0, 0], [1, 0], TIMES),
    ),
    "which is not determined, as the constraints 1, 2 are dependent: leave out 2": (
        InputError,
        lambda: System(C, BALL, constraints=(C.y, 2 * C.y, C.x), forces=(0, reaction(1) + reaction(2))).simulate(
            {}, [0, 0], [0, 0], TIMES
        ),
    ),
}


@pytest.mark.parametrize("message", REFUSED)
def test_it_is_refused_in_words(message: str) -> None:
    kind, action = REFUSED[message]
    with pytest.raises(kind, match=message):
        action()
