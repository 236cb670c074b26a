"""Bands of periodic patterns: closed forms, finite structures, group velocity, zero bands, what is refused."""

import numpy as np
import pytest

from lagrotor import Link, Pattern, Rotor
from lagrotor.structures import honeycomb, polygon_ring, square, straight_row, zigzag
from lagrotor.structures.waves import dispersion as dispersion_module
from lagrotor.structures.waves.dispersion import dispersion, long_wave_speeds

J = Rotor().J
Q = np.linspace(-3.1, 3.1, 24)
HEAVY = Link(mass=0.3, inertia=0.1)


def test_the_honeycomb_of_opposite_spins_has_its_closed_form_and_that_of_equal_spins_a_zero_band() -> None:
    q = np.random.default_rng(1).uniform(-np.pi, np.pi, (50, 2))
    d = np.array([q[:, 0], -q[:, 1], q[:, 1] - q[:, 0]])
    for spins in ((10.0, -10.0), (10.0, -4.0)):
        closed = (spins[0] - spins[1]) / 2 / J * np.sqrt(3) * np.sin(d).sum(0) / (3 - np.cos(d).sum(0))
        assert np.abs(honeycomb(spins=spins).dispersion(q).rates[:, 0] - np.maximum(closed, 0)).max() < 1e-5
    equal = honeycomb(spins=(10.0, 10.0)).dispersion(q)
    assert equal.zero_bands == 1 and not equal.rates.any()
    assert honeycomb(spins=(10.0, 10.0), hinge=1.0).dispersion(q).zero_bands == 0


def test_the_straight_row_has_a_wave_across_its_bars_alone() -> None:
    found = straight_row(spins=10.0, hinge=50.0, link=Link(mass=1.0, inertia=0.1)).dispersion(Q)
    A, B = J + 2 * (1 / 4 + 0.1), 1 / 4 - 0.1
    assert found.rates[:, 0] == pytest.approx(np.sqrt(50 / (A + 2 * B * np.cos(Q))), rel=1e-9)
    assert straight_row(spins=10.0).dispersion(Q).zero_bands == 1
    assert straight_row(spins=10.0).dispersion([0.0, 1.0]).dof.tolist() == [2, 1]
    assert np.isnan(straight_row(spins=10.0).dispersion([0.0, 1.0]).rates).sum() == 1


def test_the_square_net_moves_along_whole_rows_and_columns_alone() -> None:
    assert square(spins=10.0).dispersion([[0.3, 1.0], [0, 1.0], [1.0, 0], [0, 0]]).dof.tolist() == [0, 1, 1, 2]
    assert not square(spins=10.0).dispersion([[0.3, 1.0]]).gaps


def test_waves_under_weight_fall_where_the_spins_act_too_little_and_stand_elsewhere() -> None:
    found = zigzag(np.pi / 2, spins=(40.0, -40.0), gravity=9.81).dispersion(Q)
    falls = (40 * np.sin(Q / 2)) ** 2 < 4 * J * 9.81 / 2
    assert ((found.growth.max(axis=1) > 0) == falls).all() and falls.any() and not falls.all() and found.falls


@pytest.mark.parametrize(
    "more", [{"hinge": 200.0}, {"gravity": 9.81, "friction": 0.3, "load": 1.0}], ids=["stands", "falls"]
)
def test_many_wave_numbers_at_once_give_what_each_gives_alone(more, monkeypatch: pytest.MonkeyPatch) -> None:
    """At q = 0 the rigid honeycomb has a freedom more: wave numbers of both kinds and their opposites, in no order, in blocks."""
    turn = 2 * np.pi
    pattern, q = (
        honeycomb(spins=(30.0, 10.0), **more),
        np.array(
            [[0.3, 0.2], [0, 0], [1, 2], [0, 0], [-0.3, -0.2], [2.5, 0.4], [turn - 1, turn - 2], [turn, 0], [1, -2]]
        ),
    )
    monkeypatch.setattr(dispersion_module, "_TOGETHER", 2)
    together = dispersion(pattern, q)
    assert together.dof.tolist() == [1, 2, 1, 2, 1, 1, 1, 2, 1] and together.zero_bands == 0
    assert together.falls == ("gravity" in more)
    for k, point in enumerate(q):
        alone = dispersion(pattern, point[None])
        f = alone.rates.shape[1]
        assert np.isnan(together.rates[k, f:]).all() and np.allclose(together.rates[k, :f], alone.rates[0], rtol=1e-13)
        assert np.allclose(together.growth[k, :f], alone.growth[0], rtol=1e-12, atol=1e-12)
        # A shape is known but for its phase.
        product = np.abs((together.shapes[k, :f].conj() * alone.shapes[0]).sum((-2, -1)))
        assert np.allclose(product, 1, atol=1e-13)


def test_gaps_are_where_no_band_is() -> None:
    found = square(spring=40.0, spins=20.0, hinge=30.0).dispersion(np.random.default_rng(0).uniform(-3, 3, (200, 2)))
    assert len(found.gaps) == 2
    for low, high in found.gaps:
        assert low < high and not ((found.rates > low + 1e-9) & (found.rates < high - 1e-9)).any()


def test_a_doubled_cell_folds_the_bands() -> None:
    more = {"link": HEAVY, "hinge": 3.0}
    one = zigzag(np.pi / 2, spins=(12.0, -7.0), **more)
    x = np.cos(np.pi / 4)
    joints = ((0, 0), (x, x), (2 * x, 0), (3 * x, x))
    two = Pattern(joints, ((4 * x, 0),), ((0, 1), (1, 2), (2, 3), (3, 0, 1)), spins=(12.0, -7.0) * 2, **more)
    folded = np.sort(one.dispersion([0.35, 0.35 + np.pi]).rates.ravel())
    assert np.abs(two.dispersion([0.7]).rates[0] - folded).max() < 1e-12


@pytest.mark.parametrize("n", [4, 6, 7])
def test_a_ring_under_weight_has_every_root_of_the_structure(n) -> None:
    ring = polygon_ring(n, spins=12.0, hinge=3.0, gravity=9.81, load=0.1, link=HEAVY)
    found = ring.dispersion(2 * np.pi * np.arange(n) / n)
    every = (found.growth - 1j * found.rates).ravel()
    for rate, growth in zip(*(getattr(ring.piece(n).modes(), name) for name in ("rates", "growth")), strict=True):
        root = abs(growth) + 1j * rate
        assert min(np.abs(every - root).min(), np.abs(every - root.conjugate()).min()) < 1e-9 * (1 + abs(root))


def test_long_waves_of_the_honeycomb_run_at_a_speed_that_depends_on_their_direction_alone() -> None:
    pattern = honeycomb(spins=(10.0, -10.0))
    for direction in ([1.0, 0.3], [1.0, -0.5], [1.0, 0.9]):
        d = np.array([direction[0], -direction[1], direction[1] - direction[0]])
        slope = -np.sqrt(3) * 10 / J * d.prod() / (d**2).sum()
        k = np.linalg.solve(np.array(pattern.steps), direction)
        speed = slope / np.linalg.norm(k)
        chi = np.arctan2(k[1], k[0])
        assert speed == pytest.approx(10 / J / 2 * np.cos(3 * chi), rel=1e-12)
        assert np.max(long_wave_speeds(pattern, np.sign(speed) * np.array(direction))) == pytest.approx(
            abs(speed), rel=1e-6
        )


def test_the_modes_of_a_piece_of_the_honeycomb_come_to_its_bands() -> None:
    """The slowest, all tips alike, is the bottom of the lowest band; the fastest comes to the top of the last as 1/N²."""
    p = honeycomb(spring=50.0, hinge=200.0, spins=30.0)
    bands = dispersion(p, 2 * np.pi * np.mgrid[:24, :24].reshape(2, -1).T / 24).rates
    few, many = (p.piece(N, N).modes().rates for N in (3, 6))
    assert few.min() == pytest.approx(bands.min(), rel=1e-12) and many.min() == pytest.approx(bands.min(), rel=1e-12)
    assert 3.5 < (bands.max() - few.max()) / (bands.max() - many.max()) < 4.5
    other = dispersion(honeycomb(spring=52.0, hinge=200.0, spins=30.0), [(0.0, 0.0), (0.1, 0.2)]).rates
    assert abs(other.max() - many.max()) > 2e-3


@pytest.mark.parametrize("spins", [(10.0, -10.0), (10.0, 10.0)])
@pytest.mark.parametrize("theta", [0.7, np.pi / 2, 2.2])
def test_heavy_bars_slow_the_zigzag_as_in_closed_form(theta: float, spins: tuple[float, float]) -> None:
    a, b, q = J + 2 * (HEAVY.mass / 4 + HEAVY.inertia), HEAVY.mass / 4 - HEAVY.inertia, np.linspace(0.1, 3.0, 12)
    below = [a * (1 - c * np.cos(q)) + 2 * b * np.cos(q) * (np.cos(q) - c) for c in (np.cos(theta), -np.cos(theta))]
    up = np.sin(q) / below[0] if spins[1] < 0 else np.abs(np.cos(q)) / np.sqrt(below[0] * below[1])
    found = zigzag(theta, spins=spins, link=HEAVY).dispersion(2 * q).rates[:, -1]
    assert np.abs(found - 10 * np.sin(theta) * up).max() < 1e-12
    if spins[1] < 0:  # the twin: the band of the ring, which a zigzag of massless bars has
        ring = a * (1 - np.cos(theta) * np.cos(q)) + 2 * b * (
            np.sin(q) ** 2 - np.cos(theta) ** 2 + np.cos(theta) * np.cos(q)
        )
        assert np.abs(found - 10 * np.sin(theta) * np.sin(q) / ring).max() > 1e-2
