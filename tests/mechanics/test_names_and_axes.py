"""Names of symbols and axes of frames: each value has one name, each frame its place, and what is returned cannot be edited."""

import copy
import pickle
from collections.abc import Callable
from typing import Any

import pytest
import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.errors import InputError, SingularError
from lagrotor.mechanics import Frame, System, coordinates

k = sp.Symbol("k", positive=True)
c = coordinates("x")
SPRING = System(c, c.x_dot**2 / 2 - k * c.x**2 / 2)
two = coordinates("a b")
FIRST = Frame(two).pin("a")
SECOND = FIRST.pin("b", "x")
FOREIGN = Frame(coordinates("y")).pin("y")

REFUSED: list[tuple[Callable[[], Any], str]] = [
    (lambda: SPRING.linearise({"x": 0}, {"k": 1, k: 4}), "twice"),
    (lambda: SPRING.linearise({"x": 1, c.x: 0}), "twice"),
    (lambda: SPRING.floquet({"x": 1, c.x: 2}, {"k": 1}, 6.0), "twice"),
    (lambda: SPRING.equilibria(values={"k": 1, k: 4}, box={"x": (-1, 1)}), "twice"),
    (lambda: SPRING.equilibria(values={"k": 1}, box={"x": (-1, 1), c.x: (2, 3)}), "twice"),
    (lambda: FIRST.torque((0, 0, 1), against=FOREIGN), "same coordinates"),
    (lambda: FIRST.force((0, 0, 1), axes=FOREIGN), "same coordinates"),
    (lambda: FIRST.place((1, 0, 0), frame=SECOND), "from which this one was turned"),
    (lambda: FIRST.place((1, 0, 0), frame=FOREIGN), "from which this one was turned"),
    (lambda: FIRST.place((1, 0)), "must be 3 expressions"),
    (lambda: FIRST.velocity((1, 0)), "must be 3 expressions"),
    (lambda: c[0], "is none of x"),  # type: ignore[index]
]


@pytest.mark.parametrize(("call", "words"), REFUSED, ids=range(len(REFUSED)))
def test_what_has_two_meanings_is_refused(call: Callable[[], Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        call()


def test_a_frame_of_the_same_coordinates_is_the_ground() -> None:
    assert FIRST.velocity((1, 0, 0), frame=Frame(two)) == FIRST.velocity((1, 0, 0), frame=FIRST.to_the_ground[-1])
    assert SECOND.place((1, 0, 0), frame=Frame(two)) == SECOND.place((1, 0, 0))
    assert SECOND.place((1, 0, 0), frame=FIRST) == sp.Matrix([1, 0, 0])


def test_results_of_a_system_cannot_be_edited() -> None:
    for matrix in (SPRING.mass_matrix, SPRING.accelerations, SPRING.motion):
        with pytest.raises(TypeError):
            matrix[0, 0] = 4
    assert SPRING.accelerations == sp.Matrix([-k * c.x])


def test_a_quaternion_has_no_accelerations_but_rates() -> None:
    four = coordinates("q0 q1 q2 q3")
    body = Frame(four).ball("q0 q1 q2 q3", "w1 w2 w3").body(mass=1, inertia=(1, 1, 2))
    with pytest.raises(SingularError, match=r"take the rates of the quasi-velocities from rhs\(values\)"):
        _ = System(four, body.kinetic).accelerations


def test_coordinates_are_named_and_not_iterated() -> None:
    phi = coordinates("ϕ")  # Python reads phi.ϕ as phi.φ
    assert getattr(phi, "φ") is phi["ϕ"] and "ϕ_dot" in dir(phi)  # noqa: B009
    with pytest.raises(TypeError, match="not iterable"):
        list(phi)  # type: ignore[call-overload]


def test_decisions_and_systems_are_copied_and_pickled() -> None:
    x = sp.Symbol("x", real=True)
    for decision in (decide_zero(x**2 - x), decide_zero(sp.sqrt(x**2) - x)):
        assert pickle.loads(pickle.dumps(decision)).branch == copy.deepcopy(decision).branch == decision.branch
    assert pickle.loads(pickle.dumps(SPRING)) == SPRING and not hasattr(SPRING, "nonsense")
