"""Bands of patterns against finite structures, folded bands, differences; Chern numbers against a published case."""

import numpy as np
import pytest

from lagrotor import Link, Rotor, Structure
from lagrotor.errors import InputError
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.chern import chern_numbers
from lagrotor.structures.dispersion import dispersion
from lagrotor.structures.periodic import Pattern, bloch, path

BARS = (Link(), Link(1, 0.3, 0.1))


def staircase(first=10.0, second=-10.0, link=BARS[0], **more) -> Pattern:
    return Pattern(
        Assembly([(0, 0), (1, 0)], spins=[first, second], **more), ((1, 1),), ((0, 1, (0,)), (1, 0, (1,))), link=link
    )


def honeycomb(first=20.0, second=20.0) -> Pattern:
    springs = ((0, 1, (0, 0), 1.0), (1, 0, (0, 1), 1.0), (1, 0, (-1, 1), 1.0))
    rotors = Assembly([(0, 0), (0, 1)], spins=[first, second], hinge=4.0)
    return Pattern(rotors, ((3**0.5, 0.0), (3**0.5 / 2, 1.5)), springs=springs)


@pytest.mark.parametrize("link", BARS)
@pytest.mark.parametrize("n", [4, 6, 7])
def test_a_ring_has_the_modes_of_the_structure(link, n) -> None:
    turn = 2 * np.pi / n
    rotors = {"spins": 12.0, "hinge": 3.0, "gravity": 9.81, "load": 0.1}
    ring = Pattern(Assembly([(1, 0)], **rotors), ((0, 0),), ((0, 0, (1,)),), link=link, turn=turn)
    joints = [(np.cos(k * turn), np.sin(k * turn)) for k in range(n)]
    s = Structure(joints, [(k, (k + 1) % n) for k in range(n)], link=link, **rotors)
    found = dispersion(ring, turn * np.arange(n))
    every = (found.growth - 1j * found.rates).ravel()  # the roots s
    from lagrotor.structures.small_motion import small_motion

    for root in small_motion(s).roots[0]:
        assert np.abs(every - root).min() < 1e-9 * (1 + abs(root))
    assert every.size == 2 * n


@pytest.mark.parametrize("n", [16, 32, 64])
def test_an_open_staircase_lies_on_the_band(n) -> None:
    rates = np.sort(staircase().finite(n // 2).modes().rates)[-(n // 2) :]
    closed = np.sort(10 / 1.25 * np.cos(np.pi * np.arange(n // 2) / n))
    assert np.abs(rates / closed - 1).max() < 1e-9
    band = dispersion(staircase(), np.pi - 2 * np.pi * np.arange(n // 2) / n).rates[:, -1]
    assert np.abs(np.sort(band) / closed - 1).max() < 1e-9


def test_heavy_bars_converge_to_the_band() -> None:
    pattern = staircase(link=BARS[1])
    q = np.linspace(0.01, np.pi, 400)
    band = dispersion(pattern, q).rates[:, -1]
    off = []
    for n in (16, 32, 64):
        rates = np.sort(pattern.finite(n // 2).modes().rates)[-(n // 2) :]
        k = np.pi - 2 * np.pi * np.arange(n // 2) / n
        off.append(np.abs(rates[:3] / np.sort(np.interp(k, q, band))[:3] - 1).max())
    assert off[0] > 1.7 * off[1] > 1.7**2 * off[2] > 0


def test_a_doubled_cell_folds_the_bands() -> None:
    one = staircase(12.0, -7.0, BARS[1], hinge=3.0)
    both = Assembly([(0, 0), (1, 0), (1, 1), (2, 1)], spins=[12, -7, 12, -7], hinge=3.0)
    bars = ((0, 1, (0,)), (1, 2, (0,)), (2, 3, (0,)), (3, 0, (1,)))
    two = Pattern(both, ((2, 2),), bars, link=BARS[1])
    q = 0.7
    folded = np.sort(np.concatenate([dispersion(one, [q / 2 + shift]).rates[0] for shift in (0, np.pi)]))
    assert np.abs(dispersion(two, [q]).rates[0] - folded).max() < 1e-12


@pytest.mark.parametrize("pattern", [staircase(12.0, -7.0, BARS[1], hinge=3.0), staircase()])
def test_the_group_velocity_is_the_slope(pattern) -> None:
    q, h = np.array([0.4, 1.3, 2.6]), 1e-4
    after, before = (dispersion(pattern, q + by).rates for by in (h, -h))
    found = dispersion(pattern, q).velocity[:, 0]
    kept = np.isfinite(found)
    assert kept.sum() >= 6
    assert np.abs(found - (after - before) / (2 * h))[kept].max() < 1e-6


def test_zero_bands_gaps_and_sound() -> None:
    q = np.linspace(0.01, np.pi - 0.01, 60)
    assert dispersion(staircase(), q).zero == 2
    row = Pattern(Assembly([(0, 0)], spins=10.0), ((1, 0),), ((0, 0, (1,)),))
    assert dispersion(row, q).zero == 2 and dispersion(row, q).rates.shape[1] == 2
    assert dispersion(staircase(), [1e-3]).velocity[0, 0, -1] == pytest.approx(10 / 2.5, rel=1e-6)
    (gap,) = dispersion(staircase(12.0, -7.0), np.linspace(0, np.pi, 60)).gaps()
    assert gap == pytest.approx((0, 5 / 2 / 1.25))
    falls = dispersion(staircase(12.0, -7.0, gravity=9.81, load=2.0), q)
    assert falls.growth.max() > 0
    assert dispersion(staircase(200.0, -7.0, gravity=9.81, load=2.0), q).growth.max() == 0


def test_rigid_bars_in_two_directions() -> None:
    square = Pattern(Assembly([(0, 0)], spins=10.0), ((1, 0), (0, 1)), ((0, 0, (1, 0)), (0, 0, (0, 1))))
    assert bloch(square, (0.3, 0.4)).freedoms().shape[1] == 0
    with pytest.raises(InputError, match="0 freedoms"):
        dispersion(square, [(0.3, 0.4)])
    springs = honeycomb()
    rigid = Pattern(springs.rotors, springs.vectors, tuple(spring[:3] for spring in springs.springs))
    found = dispersion(rigid, path([(0.1, 0.2), (2, 1), (3, 2.5)], 5))
    assert np.abs(np.abs(found.rates) - np.sqrt(4 / 1.25)).max() < 1e-9
    with pytest.raises(InputError, match="no bundle"):
        chern_numbers(rigid)


@pytest.mark.parametrize(("spins", "numbers"), [((20, 20), (-1, 1)), ((-20, -20), (1, -1)), ((20, 30), (0, 0))])
def test_chern_numbers_of_gyroscopes_on_a_honeycomb(spins, numbers) -> None:
    for mesh in (12, 24):
        assert chern_numbers(honeycomb(*spins), mesh)[:2] == numbers


def test_a_finite_pattern_of_springs_is_a_structure() -> None:
    s = honeycomb().finite(2, 2)
    assert len(s.joints) == 8 and len(s.braces) == 7
    assert s.modes().rates.shape == (16,)


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({"vectors": ()}, "one or two"),
        ({"bars": ((0, 0, (0,)),)}, "joins no two"),
        ({"bars": ((0, 2, (0,)),)}, "joins no two"),
        ({"rotors": Assembly([(0, 0), (1, 0)], [(0, 1)])}, "without bars"),
        ({"rotors": Assembly([(0, 0), (1, 0)], rotor=[Rotor(), Rotor(length=2)])}, "one length"),
    ],
)
def test_a_pattern_that_makes_no_sense_is_refused(given, reason) -> None:
    with pytest.raises(InputError, match=reason):
        Pattern(**{"rotors": Assembly([(0, 0), (1, 0)]), "vectors": ((1, 1),)} | given)


def test_chern_numbers_need_a_gap() -> None:
    with pytest.raises(InputError, match="touch"):
        chern_numbers(honeycomb(0.0, 0.0))
