"""Chern numbers: a honeycomb of springs, its reversed and trivial twins, rigid bars, and waves along a border."""

import numpy as np
import pytest

from lagrotor import Rotor
from lagrotor.structures import honeycomb, square_octagon
from lagrotor.structures.waves.chern import chern_numbers, edge_waves
from lagrotor.structures.waves.dispersion import bloch

SPRINGS = {"spring": 50.0, "hinge": 200.0}
BARS = {"move": (0.3, 0.3), "hinge": 200.0}


@pytest.mark.parametrize("grid", [12, pytest.param(24, marks=pytest.mark.slow)])
def test_gyroscopes_on_a_honeycomb_of_springs_have_bands_of_chern_number_one(grid: int) -> None:
    """The two bands of precession have ±1, as waves that run one way (Nash et al. 2015) need; so have the two of nutation."""
    found = chern_numbers(honeycomb(**SPRINGS, spins=30.0), grid)
    assert (
        found.groups == ((0, 0), (1, 1), (2, 2), (3, 3)) and found.numbers == (-1, 1, -1, 1) and found.flux_error < 1e-9
    )


def test_opposite_spins_leave_the_bands_touching_and_in_the_trivial_phase_have_zero() -> None:
    touching = chern_numbers(honeycomb(**SPRINGS, spins=(30.0, -30.0)), 12)
    assert touching.groups == ((0, 1), (2, 3)) and touching.numbers == (0, 0)
    trivial = chern_numbers(honeycomb(spring=50.0, spins=(30.0, -30.0), hinge=(100.0, 300.0)), 12)
    assert len(trivial.groups) == 4 and trivial.numbers == (0, 0, 0, 0)


def energy_chern(pattern, grid: int) -> tuple[int, ...]:
    """The same from the Hermitian matrix of (K^½ u, M^½ u'), whose square is twice the energy."""
    b, phases = bloch(pattern), 2 * np.pi * (np.arange(grid) + 0.5) / grid
    ((_, m),) = b.motions(np.array([(x, y) for x in phases for y in phases]))

    def dagger(x):
        return x.conj().swapaxes(-1, -2)

    stiff, vectors = np.linalg.eigh(m.stiffness)
    root_K = (vectors * np.sqrt(stiff)[:, None]) @ dagger(vectors)
    heavy, vectors = np.linalg.eigh(m.mass)
    root_M = (vectors / np.sqrt(heavy)[:, None]) @ dagger(vectors)
    across = 1j * root_K @ root_M
    _, v = np.linalg.eigh(np.block([[0 * across, across], [dagger(across), -1j * root_M @ m.gyroscopic @ root_M]]))
    f = m.dof
    v = np.concatenate([m.basis @ v[:, :f, f:], m.basis @ v[:, f:, f:]], axis=-2).swapaxes(-1, -2)
    v = v.reshape(grid, grid, *v.shape[1:])
    link = [(v.conj() * np.roll(v, -1, axis)).sum(-1) for axis in (0, 1)]
    loop = link[0] * np.roll(link[1], -1, 0) * np.roll(link[0], -1, 1).conj() * link[1].conj()
    sense = np.sign(np.linalg.det(pattern.steps))
    return tuple(round(sense * x) for x in np.angle(loop).sum((0, 1)) / (2 * np.pi))


@pytest.mark.parametrize(
    "pattern",
    [
        honeycomb(**SPRINGS, spins=30.0),
        honeycomb(**SPRINGS, spins=(30.0, 20.0)),
        square_octagon(**BARS, spins=(30.0, 10.0, 30.0, 10.0)),
        square_octagon(**BARS, spins=(10.0, 10.0, 30.0, 10.0)),
    ],
)
def test_the_product_of_energy_gives_the_same_numbers(pattern) -> None:
    assert energy_chern(pattern, 12) == chern_numbers(pattern, 12).numbers


@pytest.mark.parametrize("spins", [30.0, (30.0, -30.0)], ids=["equal", "opposite"])
def test_the_least_distance_of_bands_is_found_between_the_wave_numbers_of_the_grid(spins) -> None:
    """At the corner of the zone, which a grid of ten lacks: roots of a ω² + G ω = κ + 3/2 k and of det D(K) for equal spins;
    with opposite spins they are one."""
    a, G, k, kappa = Rotor().J, 30 * Rotor().I3, SPRINGS["spring"], SPRINGS["hinge"]
    single = max(np.roots([a, G, -kappa - 1.5 * k]))
    coupled = np.roots([a * a, 0, -2 * a * (kappa + 1.5 * k) - G * G, 0, (kappa + 1.5 * k) ** 2 - (1.5 * k) ** 2])
    found = chern_numbers(honeycomb(**SPRINGS, spins=spins), 10)
    if spins == 30.0:
        assert np.isclose(found.apart[0], single - min(coupled[coupled > 0]), rtol=1e-9)
        assert np.isclose(found.apart[2], max(coupled) - max(np.roots([a, -G, -kappa - 1.5 * k])), rtol=1e-9)
    else:
        assert found.groups == ((0, 1), (2, 3))


def test_rigid_bars_can_have_a_gap_and_chern_numbers() -> None:
    for sign in (1, -1):
        pattern = square_octagon(**BARS, spins=[sign * w for w in (30.0, 10.0, 30.0, 10.0)])
        found = chern_numbers(pattern, 12)
        assert found.groups == ((0, 0), (1, 1)) and found.numbers == (-sign, sign)
    q = 2 * np.pi * np.stack(np.meshgrid(np.arange(18), np.arange(18)), -1).reshape(-1, 2) / 18
    assert len(pattern.dispersion(q).gaps) == 2


@pytest.mark.parametrize(
    ("pattern", "rate"),
    [
        (honeycomb(**SPRINGS, spins=30.0), 6.94),
        (square_octagon(**BARS, spins=(30.0, 10.0, 30.0, 10.0)), 12.65),
    ],
    ids=["springs", "rigid bars"],
)
def test_a_border_carries_as_many_one_way_waves_as_the_numbers_below_the_gap(pattern, rate: float) -> None:
    found = edge_waves(pattern, rate, width=7, points=61)
    below = chern_numbers(pattern, 12).numbers[0]
    assert (found.first, found.last) == (below, -below) and below == -1
