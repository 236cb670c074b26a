"""The limit of fast spins: the published lattices of hanging gyroscopes, and how far the limit is from what has inertia."""

from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Structure
from lagrotor.errors import SingularError
from lagrotor.numerics import measured_order
from lagrotor.structures import example, honeycomb, polygon_ring

WEIGHT, SPRING, SPIN = 9.81 / 2, 8.0, 30.0
HANGING = {"spring": SPRING, "gravity": -9.81, "spins": SPIN, "inertia": False}


def published(joints: np.ndarray, pairs: list[tuple[int, int]]) -> np.ndarray:
    """Rates of i ψ' = Ω_g ψ + ½ sum Ω_k ((ψ_p − ψ_q) + e^{2iθ} (ψ_p − ψ_q)*), ψ = x + i y (Nash et al. 2015, eq. 1)."""
    n, gravity, spring = len(joints), WEIGHT / SPIN, SPRING / SPIN
    own, other = gravity * np.eye(n) + 0j, np.zeros((n, n), dtype=complex)
    for p, q in pairs:
        along = complex(*(joints[q] - joints[p]))
        turn = (along / abs(along)) ** 2
        for i, j in ((p, q), (q, p)):
            own[i, [i, j]] += np.array([1, -1]) * spring / 2
            other[i, [i, j]] += np.array([1, -1]) * spring / 2 * turn
    return np.linalg.eigvals(np.block([[own, other], [-other.conj(), -own.conj()]]))


def test_a_piece_of_the_lattice_has_the_rates_of_the_published_equation() -> None:
    piece = honeycomb(**{**HANGING, "inertia": True}).piece(3, 2)
    pairs = [(b.tip, b.to) for b in piece.braces]
    rates = np.sort(published(np.array(piece.joints), pairs).real)
    modes = piece.modes(inertia=False)
    assert len(modes.rates) == 12 and np.sort(modes.rates) == pytest.approx(rates[12:], rel=1e-10)
    assert not modes.topple and (modes.energy_signs == 1).all()
    assert np.abs(np.sort(piece.modes().rates)[:12] / rates[12:] - 1).max() > 1e-3


def test_the_limit_is_off_as_one_over_the_square_of_the_spins_and_says_by_how_much() -> None:
    """A lopsided network, two rotors that differ; with `left_out` taken off the fourth power is left."""
    network = Structure(
        joints=[(0, 0), (1, 0.2), (0.4, 1.1)],
        braces=[(0, 1, 7.0), (1, 2, 4.0), (0, 2, 9.0), (0, (0, 0.7, 1.4), 3.0)],
        spins=[1.0, -1.3, 0.8],
        hinge=[5.0, 3.0, 4.0],
    )
    factors, off, rest = np.array([40.0, 80.0, 160.0]), [], []
    for f in factors:
        s = replace(network, spins=tuple(f * w for w in network.spins))
        limit, slow = s.modes(inertia=False), np.sort(s.modes().rates)[:3]
        rising = np.argsort(limit.rates)
        off.append(np.abs(limit.rates[rising] / slow - 1).max())
        rest.append(np.abs((limit.rates - limit.left_out)[rising] / slow - 1).max())
    assert abs(measured_order(factors, off) + 2) < 0.1 and abs(measured_order(factors, rest) + 4) < 0.1


def test_what_weight_tips_over_precesses_with_less_energy_than_rest() -> None:
    heavy = Structure(joints=[(0, 0), (1, 0)], braces=[(0, 1, 2.0)], spins=[200.0, 150.0], gravity=9.81)
    limit, whole = heavy.modes(inertia=False), heavy.modes()
    assert (limit.energy_signs == -1).all() and not limit.topple
    slow = np.sort(whole.rates)[:2]
    assert np.sort(limit.rates) == pytest.approx(slow, rel=1e-3)
    # The inertia raises them.
    rising = np.argsort(limit.rates)
    assert (limit.left_out < 0).all()
    assert (limit.rates - limit.left_out)[rising] == pytest.approx(slow, rel=3e-6) != limit.rates[rising]
    assert (Structure(joints=[(0, 0)], spins=9.0).modes(inertia=False).left_out == 0).all()  # nothing pulls it back


def test_bars_leave_slow_precessions_of_their_own() -> None:
    """A corner of bars has them; of a ring the spins leave the breathing of all rotors alone, and it has no limit."""
    corner = replace(example("corner"), spins=(300.0, 250.0, 200.0), hinge=20.0, gravity=0.0)
    limit, whole = corner.modes(inertia=False), np.sort(corner.modes().rates)
    assert len(limit.rates) == 2 and np.sort(limit.rates) == pytest.approx(whole[:2], rel=1e-2)
    with pytest.raises(SingularError, match="no spin acts"):
        polygon_ring(6, spins=300.0, hinge=20.0).piece(6).modes(inertia=False)
