"""What makes no sense is refused before work starts, with the reason and the way out."""

from dataclasses import replace
from math import inf, nan

import numpy as np
import pytest

from lagrotor import Brace, Link, Pattern, Rotor, Structure, structures
from lagrotor.errors import DomainError, InputError, LagrotorError, SingularError
from lagrotor.structures import (
    bounded_motion,
    example,
    honeycomb,
    local_hamiltonian,
    measured_growth,
    polygon_ring,
    resonant_factors,
    sign_patterns,
    square,
    straight_row,
    wave_amplitude,
)
from lagrotor.structures.resonances import normal_form_of
from lagrotor.structures.waves.chern import chern_numbers, edge_waves
from lagrotor.structures.waves.dispersion import dispersion

PAIR = {"joints": [(0, 0), (1, 0)], "bars": [(0, 1)], "spins": [1, 1]}
SQUARE = {"joints": [(0, 0), (1, 0), (1, 1), (0, 1)], "spins": 1.0}
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]
ROW = {"joints": ((0, 0),), "steps": ((1, 0),), "bars": ((0, 0, 1),)}

NO_STRUCTURE = [
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
    (PAIR | {"friction": nan}, "finite"),
    (PAIR | {"spins": [1, 2, 3]}, "3 numbers for 2 rotors"),
    (PAIR | {"rotor": [Rotor()] * 3}, "one Rotor"),
    (PAIR | {"link": "steel"}, "one Link"),
    (PAIR | {"joints": []}, "empty"),
    (PAIR | {"joints": [(0, 0), (1,)]}, "2 numbers"),
    (PAIR | {"braces": [Brace(0, 0, 1.0)]}, "one place"),
    (PAIR | {"braces": [Brace(0, 1, -1.0)]}, "negative"),
    (SQUARE | {"bars": [*RING, (0, 2), (1, 3)]}, r"bars\[5\] = \(1, 3\) is redundant"),
    (SQUARE | {"joints": [(0, 0), (1, 0), (2, 0)], "bars": [(0, 1), (1, 2), (0, 2)]}, "is redundant"),
    # Three bars whose triangle cannot close, though each alone can.
    ({"joints": [(0, 0), (1, 0), (0, 1)], "spins": 1.0, "bars": [(0, 1, 0.1), (1, 2, 0.1), (0, 2, 2.5)]}, "cannot close"),
    (SQUARE | {"joints": [(0, 0), (1, 0), (0, 1), (1, 1), (3, 2)],
               "bars": [(i, j) for i in range(5) for j in range(i)]}, "leave no degree of freedom"),
]  # fmt: skip
NO_PATTERN = [
    ({"joints": ()}, "give a joint"),
    ({"steps": ()}, "one or two steps"),
    ({"steps": ((1, 0), (2, 0))}, "span no plane"),
    ({"steps": ((1, 0), (0, 1)), "turn": 0.3}, "only a row of cells turns"),
    ({"bars": ((0, 1, 1),)}, "numbered 0 to 0"),
    ({"bars": ((0, 0, 0),)}, "to itself"),
    ({"bars": ((0, 0, (1, 0)),)}, "whole number"),
    ({"bars": ((0, 0, 0.5),)}, "whole number"),
    ({"braces": ((0, 0, 1),)}, "stiffness"),
    ({"spins": (1.0, 2.0)}, "2 values for 1"),
    ({"inertia": "no"}, "True or False"),
]


@pytest.mark.parametrize(("given", "reason"), NO_STRUCTURE)
def test_what_is_no_structure(given, reason) -> None:
    with pytest.raises(InputError, match=reason):
        Structure(**given)


@pytest.mark.parametrize(("given", "reason"), NO_PATTERN)
def test_what_is_no_pattern(given, reason) -> None:
    with pytest.raises(InputError, match=reason):
        Pattern(**ROW | given)


WEIGHT = {"gravity": 9.81, "load": 2.0}
TWO = Structure(**PAIR)
TOP = Structure([(0, 0)], spins=12.0, gravity=9.81, load=0.2)
EQUAL = replace(example("corner"), spins=(26.8, 0.0, 26.8))  # its rates are equal in pairs
CORNER = Structure([(0, 0), (1, 0), (1.6, 0.8)], [(0, 1), (1, 2)], [39, 5.2, 36.4], gravity=9.81, load=2.0)
SIX = Structure([(k, j) for k in range(3) for j in range(2)], spins=60, **WEIGHT)
FREE = Structure([(0, 0), (1, 0)], [(0, 1)])
FAST = Structure([(0, 0)], spins=3_000.0, gravity=9.81)  # G/A over g S/G exceeds 10⁶
UNEVEN = replace(EQUAL, spins=(24.0, 0.0, 30.0))
HANGING = {"spring": 8.0, "gravity": -9.81, "spins": 30.0, "inertia": False}
SPRINGS = {"spring": 50.0, "hinge": 200.0}
CHAIN = straight_row(spring=1.0, spins=10.0, hinge=2.0)
WAVE = polygon_ring(5, spring=25.0, spins=12.0, hinge=30.0).nonlinear_wave(1.0, 0)
STANDS = replace(EQUAL, spins=tuple(1.0607 * EQUAL.critical_spin() * w for w in EQUAL.spins)).stands()


def driven(**more):
    return lambda: TWO.simulate(**{"t": [0, 1]} | more)


REFUSED = [
    # runs
    (lambda: TWO.simulate("soon"), "t "),
    (lambda: TWO.simulate(None), "t "),
    (driven(t=[1, 0]), "increasing"),
    (driven(tol=0), "tol"),
    (driven(engine="quick"), "neither core nor fast"),
    (driven(engine="fast", ground=lambda t: np.zeros(3)), "takes no drive"),
    (driven(tilt="a"), "tilt"),
    (driven(tilt=[(1.2, 0)] * 2), "exceeds 1"),
    (driven(tilt=[0.1]), "2, 2"),
    (driven(rates=[(nan, 0)] * 2), "finite"),
    (driven(drive=lambda t: np.zeros(3)), "drive"),
    (driven(drive=lambda t: np.full((2, 3), nan if t else 0.0)), "drive at t = 1"),
    (driven(drive=lambda t: np.zeros((2, 3)) if not t else None), "drive at t = 1"),
    (driven(ground=lambda t: np.zeros(3 if not t else 2)), r"at t = 1 must .* \(3,\), not \(2,\)"),
    (driven(ground=3.0), "ground = 3.0 must be a function"),
    (lambda: TWO.simulate([0, 1]).animate("film.txt"), "gif"),
    (driven(tilt=[(1, 0, 0)] * 2), "dependent"),
    (
        lambda: Structure([(0, 0), (2, 0)], spins=5.0, braces=[(0, 1, 50.0)]).simulate([0, 1], [(1, 0), (-1, 0)]),
        r"^simulate: braces\[0\] starts with both ends at one place",
    ),
    # response
    (lambda: TWO.response("x", (1, 0), 0), "rates"),
    (lambda: TWO.response(nan, (1, 0), 0), "finite"),
    (lambda: TWO.response([[1.0, 2.0]], (1, 0), 0), "row of numbers"),
    (lambda: TWO.response(1.0, "a", 0), "force"),
    (lambda: TWO.response(0.0, (1, 0), 0), "the rate of an undamped mode"),
    (lambda: TWO.response(1.0), "give a force"),
    (lambda: TWO.response(1.0, (1, 0), 3), "no rotor"),
    (lambda: TWO.response(1.0, (1, 0, 0), 0), "shape"),
    (lambda: TWO.response(1.0, (1, 0)), "shape"),
    (lambda: TWO.response(1.0, ground=(nan, 0)), "finite"),
    (lambda: structures.spins_worst_case(1.5), "gamma"),
    (lambda: structures.spins_white_noise(0), "gamma"),
    (lambda: structures.mass_worst_case(-1), "mu"),
    # small motion
    (lambda: replace(TWO, hinge=1.0).modes(inertia="no"), "inertia = 'no' must be True or False"),
    *((getattr(FAST, name), rf"^{name}: the fastest rate.* 10⁶ times the slowest.*: take slower spins")
      for name in ("modes", "stands", "resonances")),
    (lambda: Structure([(0, 0), (1, 0)], spins=[10.0, 0.0], hinge=3.0).modes(inertia=False), "no spin acts"),
    (lambda: polygon_ring(6, spins=300.0, hinge=20.0).piece(6).modes(inertia=False), "no spin acts"),
    # resonances
    (lambda: local_hamiltonian(replace(CORNER, friction=0.1)), "friction"),
    (lambda: replace(CORNER, spins=1.0).resonances(), "a mode grows"),
    (SIX.resonances, "at most"),
    (lambda: STANDS.fall_time([1.0, 2.0]), "push must be"),
    (lambda: STANDS.fall_time(0.1 * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]])), "the bars do not allow"),
    *((ask, "above zero") for x in (0, -0.1, nan, inf, "a")
      for ask in (lambda x=x: EQUAL.spin_intervals(x), lambda x=x: STANDS.fall_time(x))),
    (lambda: Structure([(0, 0)], hinge=60.0, **WEIGHT).spin_intervals(0.1), "stable without spins"),
    (lambda: STANDS.hold_time(-1), "hold_time: push = -1 must be"),
    (lambda: SIX.stands().hold_time(0.1), "hold_time: 12 degrees of freedom are too many to expand: at most 8"),
    # precessions
    (lambda: TOP.steady_precession(2, 0.1), "0 to 1"),
    (lambda: TOP.steady_precession(True, 0.1), "0 to 1"),
    (lambda: TOP.steady_precession(0, 1.0), "between 0 and 1"),
    (lambda: TOP.steady_precession(0, nan), "tilt"),
    (lambda: TOP.steady_precession(0, 1e-4), "below 0.001"),
    (lambda: replace(TOP, friction=(0.1,)).steady_precession(), "friction"),
    (lambda: replace(TOP, spins=(1.0,)).steady_precession(), "grows"),
    (lambda: replace(FREE, spins=[10, -10]).steady_precession(), "no rate"),
    (lambda: EQUAL.steady_precession(2, 0.05), "have the rate of mode 2"),
    (lambda: UNEVEN.steady_precession(3, 0.05), "decays"),
    (lambda: UNEVEN.steady_precession(1, 0.05), "ends or turns near"),
    (lambda: CORNER.precession_law(2).rate_at(0.12), "precession_law: tilt"),  # its double is nearly the fastest rate
    (lambda: CORNER.precession_law(2).rate_at(-0.1), "precession_law: tilt"),
    (lambda: CORNER.precession_law(4), "0 to 3"),
    (lambda: replace(FREE, spins=[10, -10]).precession_law(2), "grows or has no rate"),
    (lambda: Structure([(k, 0) for k in range(5)], spins=[11, 12, 13, 14, 15], hinge=9.0).precession_law(), "at most 8"),
    # waves
    (lambda: dispersion(honeycomb(spins=1.0), [0.1, 0.2]), r"\(n_q, 2\)"),
    (lambda: dispersion(straight_row(spins=1.0), [nan]), "finite"),
    (lambda: honeycomb().piece(3), "number"),
    (lambda: straight_row().strip(3), "needs two"),
    (lambda: polygon_ring(2), "no polygon"),
    (lambda: honeycomb(angle="x"), "angle"),
    (lambda: honeycomb(spring=1.0, spins=(10.0, 0.0), hinge=2.0, inertia=False).dispersion([(0.3, 0.4)]), "no spin acts"),
    (lambda: honeycomb(**HANGING).piece(2, 2), "inertia"),
    (lambda: honeycomb(**HANGING).nonlinear_wave((0.3, 0.4), 0), "inertia"),
    (lambda: chern_numbers(straight_row(spins=1.0), 12), "one step"),
    (lambda: edge_waves(straight_row(spins=1.0), 1.0), "needs two"),
    (lambda: chern_numbers(honeycomb(spins=(30.0, -10.0), hinge=200.0), 12), "self-stress"),
    (lambda: chern_numbers(square(spins=30.0, hinge=200.0), 12), "more degrees of freedom"),
    (lambda: chern_numbers(honeycomb(spring=50.0, spins=30.0), 12), "rate zero"),
    (lambda: chern_numbers(honeycomb(**SPRINGS, spins=1.0, gravity=900.0), 12), "grows"),
    (lambda: chern_numbers(honeycomb(**SPRINGS, spins=1.0, friction=0.1), 12), "friction"),
    (lambda: straight_row(spins=10.0, hinge=10.0).nonlinear_wave(1.0, 0), "first order only"),
    (lambda: straight_row(spring=1.0, spins=10.0, friction=0.1).nonlinear_wave(1.0, 0), "friction"),
    (lambda: CHAIN.nonlinear_wave(1.0, 2), "bands there are 0 to 1"),
    (lambda: straight_row(spring=1.0, spins=10.0).nonlinear_wave(0.0, 0), "rate 0 rad/s"),
    (lambda: straight_row(spring=1.0, hinge=2.0).nonlinear_wave(0.0, 0), "2 waves have this rate"),
    (lambda: honeycomb(spring=1.0, spins=10.0, hinge=2.0).three_waves(1.0), "two steps"),
    (lambda: WAVE.rate_at(0.7), "above"),
    (lambda: WAVE.rate_at(-0.1), "above"),
    (lambda: WAVE.rate_at(nan), "finite"),
    (lambda: WAVE.state(-1, amplitude=0.1), "1 or more"),
    *((ask, "q") for x in ("a", 1j, nan, [1.0, 2.0])
      for ask in (lambda x=x: CHAIN.nonlinear_wave(x, 0), lambda x=x: CHAIN.three_waves(x))),
    (lambda: wave_amplitude(WAVE.pattern, WAVE.pattern.piece(4).simulate([0, 0.1], np.zeros((4, 2))), (5,), 1.0, 0),
     "another number"),
]  # fmt: skip


@pytest.mark.parametrize(("ask", "reason"), REFUSED)
def test_what_makes_no_sense(ask, reason) -> None:
    with pytest.raises((InputError, DomainError, SingularError), match=reason):
        ask()


NAMES = ("modes", "stands", "critical_spin", "characteristic", "resonances", "largest_push", "steady_precession",
         "precession_law", "spin_intervals", "response")  # fmt: skip
FUNCTIONS = (bounded_motion, local_hamiltonian, measured_growth, normal_form_of, resonant_factors, sign_patterns)


@pytest.mark.parametrize("name", [*NAMES, *FUNCTIONS], ids=lambda name: getattr(name, "__name__", name))
def test_a_lean_is_refused_in_the_name_of_what_was_asked(name) -> None:
    leaning = Structure(**PAIR | {"bars": [(0, 1, 1.2)]}, gravity=9.81)
    ask = getattr(leaning, name) if isinstance(name, str) else lambda: name(leaning)
    with pytest.raises(InputError, match=f"^{getattr(name, '__name__', name)}: a bar does not have its upright length"):
        ask(*[1.0] * (name in ("spin_intervals", "response")))


def test_their_neighbours_are_not() -> None:
    Structure(**SQUARE, bars=[*RING, (0, 2)], link=[Link()] * 5)
    Structure(**PAIR, rotor=[Rotor(), Rotor(length=1.5)], load=2, hinge=[0, 1], braces=[(0, (0, 1, 0), 3.0, 1.0)])
    s = Structure(joints=[(0, 0), (1, 0), (0, 1)], bars=[(0, 1, 1.1), (1, 2, 1.3), (0, 2, 1.2)], spins=2)
    assert not s.natural and s.spins == (2, 2, 2)
    assert len(FAST.modes(inertia=False).rates) == 1 and replace(FAST, spins=(1_000.0,)).modes()
    arrays = {"joints": np.array([[0, 0], [1, 0]]), "bars": np.array([[0, 1]]), "spins": np.array([1, 2])}
    assert Structure(**arrays, load=np.float64(2)) == Structure(**PAIR | {"spins": [1, 2]}, load=2)


def test_a_long_chain_is_checked_sparsely() -> None:
    bars = [(i, i + 1) for i in range(499)]
    assert len(Structure([(float(i), 0.3 * (i % 2)) for i in range(500)], bars).bars) == 499
    with pytest.raises(InputError, match="dependent"):
        Structure([(float(i), 0.0) for i in range(500)], [*bars, (0, 499)])


def test_more_rotors_than_compile_in_half_a_minute() -> None:
    L = 16
    bars = [(i, i + 1) for i in range(L * L) if i % L < L - 1] + [(i, i + L) for i in range(L * L - L)]
    net = Structure([(i % L, i // L) for i in range(L * L)], bars, 20.0, braces=[Brace(0, 1, 1.0)])
    row = Structure([((k + 1) // 2, k // 2) for k in range(513)], [(k, k + 1) for k in range(512)], 10.0)
    for s, says in ((net, "nets of up to 100, not 256"), (row, "up to 512 rotors and nets .*, not 513")):
        with pytest.raises(LagrotorError, match=f"{says} rotors: use engine='core'"):
            s.simulate([0.0, 1.0], engine="fast")
