"""The natural rate: known values, the exact model, one rotor, and its error on random pairs."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor import Link, Rotor, Scene, consistent_scene, natural_rate, simulate
from lagrotor.errors import DomainError, LagrotorError
from lagrotor.numerics import peak, spectrum
from lagrotor.theory import natural_rate_error
from tests.theory.random_pairs import COUNTS, held, random_pair, swinging


def test_known_rates() -> None:
    equal = Scene(spins=(20, 20), link=Link(1, 1, 1))
    assert natural_rate(equal) == pytest.approx(80 / 7)
    assert natural_rate(Scene(spins=(20, -20))) == pytest.approx(16)
    assert natural_rate(Scene(spins=(20, 3), link=None)) == pytest.approx(16)
    assert natural_rate(Scene(spins=(10, -10), link=Link(1, 1, 1))) == pytest.approx(10 / np.sqrt(1.75 * 3.25))
    # A dumbbell of the same mass slows opposite spins just as equal ones.
    dumbbell = Link(1, 1, 0.25)
    rates = [natural_rate(Scene(spins=(10, s * 10), link=dumbbell)) for s in (1, -1)]
    assert rates[0] == pytest.approx(rates[1])


@settings(max_examples=12, deadline=None)
@given(
    st.floats(3, 15),
    st.floats(-15, 15).map(lambda w: round(w, 6)),
    st.floats(0.5, 2),
    st.floats(0.0, 2),
    st.floats(0.6, 1.6),
)
def test_the_natural_rate_is_the_exact_model_s(w1: float, w2: float, I1: float, m: float, ell: float) -> None:
    """A small displacement swings at Omega_0: x returns to itself after a period, to second order in the amplitude."""
    link = Link(ell, m, 0.3 * m) if m > 0.01 else Link(ell)
    scene = Scene(spins=(w1, w2), rotor=Rotor(1.2, 1.0, I1, 0.9), link=link)
    size = 1e-5
    moved = consistent_scene(scene.spins, ((0, 0, 1), (0, 0, 1)), ((size, 0, 0), (size, 0, 0)), scene.rotor, scene.link)
    period = 2 * np.pi / natural_rate(scene)
    run = simulate(moved, np.array([0.0, period, 1.3 * period]), "minimal", 1e-12)
    x_rate = run.rates[0, :, 0]
    assert x_rate[1] == pytest.approx(x_rate[0], rel=1e-3)
    assert x_rate[2] != pytest.approx(x_rate[0], rel=1e-2)


@pytest.mark.parametrize("count", COUNTS)
def test_natural_rate(count):
    rng, pairs, refused = np.random.default_rng(1), [], 0
    while len(pairs) + refused < count:
        scene, amplitude = random_pair(rng), 10 ** rng.uniform(-2, np.log10(0.2))
        natural = natural_rate(scene)
        try:
            times = np.linspace(0, 20 * 2 * np.pi / natural, 1201)
            run = simulate(swinging(rng, scene, amplitude), times, "minimal", 1e-10)
        except LagrotorError:
            refused += 1  # the bar does not reach, or the pair topples over
            continue
        seen = peak(*spectrum(times * natural, run.rates[:, :, 0].mean(0))) * natural
        # The spectrum's own error is about 1e-5 of the rate.
        pairs.append((abs(seen - natural), natural_rate_error(scene, amplitude) + 1e-5 * natural))
    held(pairs, refused, count, 0.1)


@pytest.mark.parametrize("count", COUNTS)
def test_natural_rate_of_one_rotor(count):
    rng = np.random.default_rng(2)
    for _ in range(count):
        one, angle = random_pair(rng), rng.uniform(0.01, 0.4)
        scene = Scene(one.spins, one.rotor, None)
        exact = abs(scene.momenta[0]) / (scene.rotor.J * np.cos(angle))
        error = natural_rate_error(scene, np.sin(angle))
        assert exact - natural_rate(scene) == pytest.approx(error, rel=1e-9)


def test_an_amplitude_out_of_range_is_refused():
    with pytest.raises(DomainError, match=r"must lie between 0 and 0\.4"):
        natural_rate_error(Scene((10, -10)), 0.5)
