"""Transfer functions against the exact motion; optimal brace and damper against every neighbour and a numerical optimum."""

import numpy as np
import pytest

from lagrotor import Brace, Link, Rotor, Structure, structures

HELD = {"joints": [(0, 0), (1, 0), (1, 1)], "bars": [(0, 1), (1, 2)], "gravity": 9.81, "load": [1, 0, 2], "hinge": 60.0}
SHAKEN = Structure(
    **HELD, spins=[20, -5, 12], link=Link(1, 0.3, 0.1), friction=15.0, rotor=[Rotor(), Rotor(length=1.2), Rotor()],
    braces=[Brace(0, 2, 5.0, 1.0)],
)  # fmt: skip


def steady(s: Structure, rate: float, **driven) -> np.ndarray:
    """Amplitudes (N, 2) of the exact motion, once its start is forgotten."""
    after = 18 / -s.modes().growth.max()
    t = after + np.linspace(0, 2 * np.pi / rate, 17)[:-1]
    run = s.simulate([0.0, *t], **driven, tol=1e-12).after(t[0])
    feet = np.column_stack([s.joints, [rotor.length for rotor in s.rotor]])[:, None]
    return 2j * ((run.tips - feet)[..., :2] * np.exp(-1j * rate * t)[:, None]).mean(1)


@pytest.mark.parametrize("rate", [2.0, 7.0])
def test_a_force_on_a_tip(rate) -> None:
    push = np.zeros((3, 3))
    push[1, :2] = 1e-4, -2e-4
    measured = steady(SHAKEN, rate, drive=lambda t: push * np.sin(rate * t))
    found = SHAKEN.response(rate, (1e-4, -2e-4), 1)[0]
    assert np.abs(measured - found).max() < 1e-5 * np.abs(found).max()
    assert np.abs(measured - found.conj()).max() > 1e-2 * np.abs(found).max()


def test_a_shaken_ground() -> None:
    measured = steady(SHAKEN, 4.0, ground=lambda t: np.array([1e-4, 2e-4, 0]) * np.sin(4.0 * t))
    found = SHAKEN.response([4.0], ground=(1e-4, 2e-4))[0]
    assert np.abs(measured - found).max() < 1e-5 * np.abs(found).max()


def transfer(w, gamma, f2, zeta):
    own = f2 - w**2 + 2j * zeta * w
    return own / ((1 - w**2) * own - gamma**2 * w**2)


def weighted(w, mu, f2, zeta):
    """The sway under a mass mu on a spring and damper of its own."""
    own = f2 + 2j * zeta * np.sqrt(f2) * w
    return 1 / (1 - w**2 - mu * w**2 * own / (own - w**2))


WORST_CASES = [(structures.spins_worst_case, transfer, x) for x in (0.05, 0.3, 1.0, 1.35)]
WORST_CASES += [(structures.mass_worst_case, weighted, x) for x in (0.004, 0.1, 3.0)]


@pytest.mark.parametrize(("law", "response", "ratio"), WORST_CASES)
def test_the_worst_case_is_the_peak_and_no_other_is_lower(law, response, ratio) -> None:
    from scipy.optimize import minimize

    best, width = law(ratio), ratio if law is structures.spins_worst_case else np.sqrt(ratio)
    rates = np.linspace(max(1e-4, 1 - 3 * width), 1 + 3 * width, 6_001)

    def peak(x):
        heights = np.abs(response(rates, ratio, *x))
        top = heights.argmax()
        bend, slope, height = np.polyfit([-1, 0, 1], heights[top - 1 : top + 2], 2)
        return height - slope**2 / (4 * bend)

    start = np.array([best.tuning, best.damping])
    assert peak(start) == pytest.approx(best.value, rel=1e-7)
    found = minimize(peak, start * [1.05, 0.9], method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-10})
    assert found.fun == pytest.approx(best.value, rel=1e-6)


@pytest.mark.parametrize("gamma", [0.05, 0.3, 1.0])
def test_the_mean_square_is_at_its_least(gamma) -> None:
    best = structures.spins_white_noise(gamma)

    def mean(f2, zeta):
        rate = np.tan((np.arange(20_000) + 0.5) * np.pi / 40_000)  # 0 … infinity, equal steps of the angle
        return (np.abs(transfer(rate, gamma, f2, zeta)) ** 2 * (1 + rate**2)).mean()

    assert mean(best.tuning, best.damping) == pytest.approx(best.value, rel=1e-6)
    for off in ((0.02, 0), (-0.02, 0), (0, 0.02), (0, -0.02)):
        assert mean(best.tuning + off[0] * gamma, best.damping * (1 + off[1])) > best.value


@pytest.mark.parametrize("mu", [0.005, 0.02, 0.1])
def test_spins_and_mass_are_even_where_it_is_said(mu) -> None:
    worst, noise = structures.spins_win_worst_case(mu), structures.spins_win_white_noise(mu)
    assert structures.spins_worst_case(worst).value == pytest.approx(structures.mass_worst_case(mu).value)
    assert structures.spins_white_noise(noise).value == pytest.approx(np.sqrt((4 + 3 * mu) / (mu * (1 + mu))))
    assert structures.spins_worst_case(1.01 * worst).value < structures.mass_worst_case(mu).value
