"""Braces whose ends slide in guides: against the yaw of a pair alone, in the linear, the expanded and the exact motion."""

import tomllib
from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Brace, Structure
from lagrotor.errors import InputError
from lagrotor.structures import exact_motion, local_hamiltonian
from lagrotor.structures.coefficients import coefficients
from lagrotor.structures.exact.compiled_motion import right_hand_side
from lagrotor.structures.resonances import normal_form_of
from lagrotor.structures.structure import structure_of, toml_of


def yaw_braced(stiffness: float, spins: tuple[float, float], damping: float = 0.0) -> Structure:
    return Structure(
        [(0, 0), (1, 0)],
        [(0, 1)],
        spins,
        gravity=9.81,
        load=1.0,
        braces=[Brace(0, 1, stiffness, damping, along=(0, 2, 0))],
    )


def test_a_brace_against_yaw_alone_stiffens_yaw_and_leaves_both_sways_to_fall():
    """n1: k (y_1 − y_2)²/2 holds the yaw of the pair, and weight then tips two degrees of freedom, which spins may hold."""
    loose, braced = (yaw_braced(k, (0.0, 0.0)).modes() for k in (0.0, 50.0))
    c = coefficients(yaw_braced(50.0, (0.0, 0.0)))
    fall = np.sqrt(9.81 * c.S[0] / c.A[0])
    assert np.sort(loose.growth) == pytest.approx([fall] * 3)
    assert np.sort(braced.growth) == pytest.approx([0, fall, fall])
    assert braced.rates.max() == pytest.approx(np.sqrt(2 * 50.0 / c.A[0] - fall**2))
    assert yaw_braced(0.0, (1.0, 1.0)).critical_spin() == np.inf > yaw_braced(50.0, (1.0, 1.0)).critical_spin()


def test_a_brace_in_guides_moves_exactly_as_its_energy_and_as_its_small_motion():
    s = replace(yaw_braced(50.0, (14.0, 14.0)), load=(1.0, 0.4))
    tilt = 0.3 * np.array([[0.1, 0.5], [0.1, -0.4]])
    run = s.simulate(np.linspace(0, 2, 41), tilt, tol=1e-8)
    assert np.ptp(run.energy) < 1e-6 * np.abs(run.energy).max()
    assert s.simulate([0.0, 2.0], tilt, tol=1e-8).axes[:, -1] == pytest.approx(run.axes[:, -1], abs=1e-7)
    free = replace(s, braces=()).simulate(run.t, tilt, tol=1e-8)
    assert np.abs(free.axes - run.axes).max() > 0.1
    # The two right-hand sides, in arrays and written out, with a damper in the guides, and the expanded Hamiltonian.
    damped = yaw_braced(50.0, (14.0, 9.0), damping=3.0)
    motion, y = exact_motion(damped), np.concatenate([run.axes[:, 7].ravel(), 0.1 * run.rates[:, 7].ravel()])
    assert right_hand_side(motion)(0.0, y) == pytest.approx(motion.rhs(0.0, y), abs=1e-12)
    n = normal_form_of(s)
    rates = np.sort(np.abs(np.real(n.frequencies)) * local_hamiltonian(s).rate)
    assert rates == pytest.approx(np.sort(s.modes().rates), rel=1e-9)


def test_a_guide_holds_a_tip_at_its_place_where_a_spring_between_two_points_has_no_direction():
    s = Structure([(0, 0)], braces=[Brace(0, (0, 0, 1), 40.0, along=(1, 0, 0))])
    assert s.modes().rates == pytest.approx([0, np.sqrt(40.0 / coefficients(s).A[0])])
    run = s.simulate(np.linspace(0, 3, 31), [(0.2, 0.1)], tol=1e-8)
    assert np.ptp(run.energy) < 1e-6 * run.energy.max()
    with pytest.raises(InputError, match="both ends at one place"):
        Structure([(0, 0)], braces=[Brace(0, (0, 0, 1), 40.0)])


def test_braces_in_guides_are_written_down_and_read_back_and_refused_without_a_direction():
    s = yaw_braced(5.0, (1.0, 2.0))
    assert s.braces[0].along == (0.0, 1.0, 0.0) and structure_of(tomllib.loads(toml_of(s))) == s
    assert "along" not in toml_of(replace(s, braces=[Brace(0, 1, 5.0)]))
    with pytest.raises(InputError, match="along = 'y' must be 3 numbers"):
        replace(s, braces=[Brace(0, 1, 1.0, along="y")])
    with pytest.raises(InputError, match="no direction"):
        replace(s, braces=[Brace(0, 1, 1.0, along=(0, 0, 0))])
    assert "k" in str(s.characteristic().polynomial)
