"""The slow motion after a shock of opposite spins: closed forms against exact runs."""

import numpy as np
import pytest

from lagrotor import Link, Scene, Shock
from lagrotor.errors import DomainError, InputError
from lagrotor.models.mean_motion import (
    exact_cancelling_force,
    mean_over,
    run_after,
    time_to_lean,
    time_to_wander,
    turning_rate,
    wandering_rate,
)
from lagrotor.numerics.convergence import measured_order
from lagrotor.theory.drift_after_shock import cancelling_force, toppling_after_shock, wander_after_shock


def scene(x, y=0.0, body=1, link=None, spins=(10, -10)):
    return Scene(spins=spins, link=link or Link(1, 0.01, 0.1), shock=Shock((x, y, 0), 0.5, 1 / 20, body))


@pytest.mark.parametrize("link", [Link(1.5, 0.4, 0.05), Link(0.7, 1, 1)])
@pytest.mark.parametrize("body", [1, 2])
@pytest.mark.parametrize("spins", [(10, -10), (-10, 10)])
def test_rates_after_a_shock(link, body, spins):
    tried = scene(3, 0.3, body, link, spins)
    run = run_after(tried, 30)
    assert turning_rate(run) == pytest.approx(toppling_after_shock(tried), rel=0.01)
    assert wandering_rate(run) == pytest.approx(wander_after_shock(tried), rel=0.02)


def test_second_order():
    forces = (3, 6, 12)
    off = [abs(turning_rate(run_after(scene(f), 16)) - toppling_after_shock(scene(f))) for f in forces]
    assert measured_order(forces, off) == pytest.approx(4, abs=0.3)


def test_cancelling_force_of_the_paper():
    assert cancelling_force(scene(40)) == pytest.approx(-10.6, abs=0.01)
    assert toppling_after_shock(scene(40, cancelling_force(scene(40)))) == pytest.approx(0, abs=1e-14)


def test_refused():
    with pytest.raises(InputError, match="opposite"):
        cancelling_force(scene(40, spins=(10, 10)))
    with pytest.raises(DomainError, match="outside its domain"):
        cancelling_force(scene(400))
    with pytest.raises(DomainError, match="too few"):
        mean_over(np.arange(3.0), np.arange(3.0))


@pytest.mark.slow
def test_exact_cancelling_force():
    exact = {f: exact_cancelling_force(scene(f)) for f in (10, 20, 40)}
    assert exact[40] == pytest.approx(-11.11, abs=0.02)
    off = [abs(exact[f] - cancelling_force(scene(f))) for f in (10, 20)]
    assert measured_order((10, 20), off) == pytest.approx(4, abs=0.3)


@pytest.mark.slow
def test_times_fall_as_square_and_cube():
    lean = [time_to_lean(scene(f), 0.5, 0.8 / abs(toppling_after_shock(scene(f)))) for f in (3, 6, 12)]
    leave = [time_to_wander(scene(f), 0.03, 0.06 / abs(wander_after_shock(scene(f)))) for f in (4, 8)]
    assert measured_order((3, 6, 12), lean) == pytest.approx(-2, abs=0.1)
    assert measured_order((4, 8), leave) == pytest.approx(-3, abs=0.1)
