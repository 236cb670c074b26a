"""Structures that make no sense are refused at the door, with the reason and the way out."""

import numpy as np
import pytest

from lagrotor import Brace, Link, Rotor, Structure
from lagrotor.errors import InputError
from lagrotor.structures import bounded_motion, local_hamiltonian, measured_growth, resonant_factors, sign_patterns
from lagrotor.structures.resonances import normal_form_of

PAIR = {"joints": [(0, 0), (1, 0)], "bars": [(0, 1)], "spins": [1, 1]}
SQUARE = {"joints": [(0, 0), (1, 0), (1, 1), (0, 1)], "spins": 1.0}
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]

BAD = [
    (PAIR | {"bars": [(0, 0)]}, "bar to itself"),
    (PAIR | {"bars": [(0, 1), (1, 0)]}, "dependent constraints"),
    (PAIR | {"bars": [(0, 1, 3.5)]}, "cannot close"),
    (PAIR | {"bars": [(0, 2)]}, "no rotor"),
    (PAIR | {"bars": [(0, 1, 0)]}, "must be apart"),
    (PAIR | {"bars": [(0.0, 1)]}, "no rotor"),
    (PAIR | {"bars": 3}, "must be a list"),
    (PAIR | {"braces": [(0,)]}, "must be .tip, to"),
    (PAIR | {"braces": [(0, "b", 1.0)]}, "must be 3 numbers"),
    (PAIR | {"spins": "fast"}, "not a finite number"),
    (PAIR | {"load": [0, -1]}, r"load\[1\] = -1 kg must not be negative"),
    (PAIR | {"hinge": -1}, "negative"),
    (PAIR | {"friction": float("nan")}, "finite"),
    (PAIR | {"spins": [1, 2, 3]}, "3 numbers for 2 rotors"),
    (PAIR | {"rotor": [Rotor()] * 3}, "one Rotor"),
    (PAIR | {"link": "steel"}, "one Link"),
    (PAIR | {"joints": []}, "empty"),
    (PAIR | {"joints": [(0, 0), (1,)]}, "2 numbers"),
    (PAIR | {"braces": [Brace(0, 0, 1.0)]}, "one place"),
    (PAIR | {"braces": [Brace(0, 1, -1.0)]}, "negative"),
    (SQUARE | {"bars": [*RING, (0, 2), (1, 3)]}, r"bars\[5\] = \(1, 3\) holds nothing"),
    (SQUARE | {"joints": [(0, 0), (1, 0), (2, 0)], "bars": [(0, 1), (1, 2), (0, 2)]}, "holds nothing"),
    # Three bars whose triangle cannot close, though each alone can.
    ({"joints": [(0, 0), (1, 0), (0, 1)], "spins": 1.0, "bars": [(0, 1, 0.1), (1, 2, 0.1), (0, 2, 2.5)]}, "cannot close"),
    (SQUARE | {"joints": [(0, 0), (1, 0), (0, 1), (1, 1), (3, 2)],
               "bars": [(i, j) for i in range(5) for j in range(i)]}, "leave no degree of freedom"),
]  # fmt: skip


@pytest.mark.parametrize(("given", "reason"), BAD)
def test_it_is_refused_with_the_reason(given, reason) -> None:
    with pytest.raises(InputError, match=reason):
        Structure(**given)


@pytest.mark.parametrize(
    "door", [bounded_motion, local_hamiltonian, measured_growth, normal_form_of, resonant_factors, sign_patterns]
)
def test_a_lean_is_refused_in_the_name_of_its_door(door) -> None:
    with pytest.raises(InputError, match=f"^{door.__name__}: a bar is not as long"):
        door(Structure(**PAIR | {"bars": [(0, 1, 1.2)]}, gravity=9.81))


def test_inertia_is_true_or_false() -> None:
    assert Structure(**PAIR, hinge=1.0).modes(inertia=True)
    with pytest.raises(InputError, match="inertia = 'no' must be True or False"):
        Structure(**PAIR, hinge=1.0).modes(inertia="no")


def test_its_neighbours_are_not() -> None:
    Structure(**PAIR)
    Structure(**SQUARE, bars=[*RING, (0, 2)], link=[Link()] * 5)
    Structure(**PAIR, rotor=[Rotor(), Rotor(length=1.5)], load=2, hinge=[0, 1], braces=[(0, (0, 1, 0), 3.0, 1.0)])
    s = Structure(joints=[(0, 0), (1, 0), (0, 1)], bars=[(0, 1, 1.1), (1, 2, 1.3), (0, 2, 1.2)], spins=2)
    assert not s.natural and s.spins == (2, 2, 2)


def test_numbers_may_be_numpys() -> None:
    s = Structure(
        joints=np.array([[0, 0], [1, 0]]), bars=np.array([[0, 1]]), spins=np.array([1, 2]), load=np.float64(2)
    )
    assert s == Structure(joints=[(0, 0), (1, 0)], bars=[(0, 1)], spins=[1, 2], load=2)


@pytest.mark.parametrize(
    "ask",
    [
        lambda s: s.simulate("soon"),
        lambda s: s.simulate(None),
        lambda s: s.simulate([0, 1], tilt="a"),
        lambda s: s.simulate([0, 1], drive=lambda t: "x"),
        lambda s: s.simulate([0, 1], tol=0),
        lambda s: s.response("x", (1, 0), 0),
        lambda s: s.response(float("nan"), (1, 0), 0),
        lambda s: s.response([[1.0, 2.0]], (1, 0), 0),
        lambda s: s.response(1.0, "a", 0),
        lambda s: s.response(0.0, (1, 0), 0),
        lambda s: s.simulate([0, 1]).animate("film.txt"),
    ],
)
def test_what_makes_no_sense_is_refused_of_a_structure_too(ask) -> None:
    with pytest.raises(InputError):
        ask(Structure(**PAIR))


def test_a_long_chain_is_checked_sparsely() -> None:
    line = [(float(i), 0.3 * (i % 2)) for i in range(500)]
    s = Structure(joints=line, bars=[(i, i + 1) for i in range(499)])
    assert len(s.bars) == 499
    straight = [(float(i), 0.0) for i in range(500)]
    with pytest.raises(InputError, match="dependent"):
        Structure(joints=straight, bars=[*((i, i + 1) for i in range(499)), (0, 499)])
