"""The pair on one page: its formulas are the derived ones, and its numbers those of an orbit found by shooting."""

import json

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Scene, Shock, corrected_trajectories, pair_precession_rate, pair_with_bar
from lagrotor.algebra import decide_equal
from lagrotor.commands.command_line import main
from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex
from lagrotor.pair import ansatz_integrals
from lagrotor.pair.notation import r0
from lagrotor.paper.rotor_pair.pair_page import compare_pair, pair_formulas

FORMULAS = pair_formulas()
PAIR = pair_with_bar()
A, B = ansatz_integrals()


@pytest.mark.parametrize(
    ("name", "derived"),
    [
        (r"\mathcal L", PAIR.L),
        ("g", PAIR.constraints[0]),
        ("A", A),
        ("B", B),
        (r"\dot\phi", pair_precession_rate().expressions[0]),
    ],
)
def test_a_formula_of_the_page_is_the_derived_one(name: str, derived: sp.Expr) -> None:
    assert decide_equal(FORMULAS[name], derived).answer == "zero"
    assert decide_equal(FORMULAS[name] + FORMULAS["x_1"], derived).answer == "nonzero"


def test_the_axes_are_the_corrected_trajectories_through_the_second_power() -> None:
    x_1, y_1, _, x_2, y_2, _ = corrected_trajectories(3).expressions
    for name, series in zip(("x_1", "y_1", "x_2", "y_2"), (x_1, y_1, x_2, y_2), strict=True):
        difference = sp.expand(series - FORMULAS[name])
        assert [decide_equal(difference.coeff(r0, n), sp.S.Zero).answer for n in (1, 2, 3)] == [
            "zero",
            "zero",
            "nonzero",
        ]


def test_the_differences_are_those_of_the_orbit_found_by_shooting() -> None:
    """0.0418 m, 0.43 %, 7.910 and 7.918 rad/s; the frequency of the hyperbolic orbit is proved in docs/proofs.md."""
    c = compare_pair()
    assert c.run.error < 1e-11 and abs(c.run.axes[:, -1] - c.run.axes[:, 0]).max() < 1e-9
    assert c.run_mean == pytest.approx(7.9181412672010303, abs=1e-9)
    assert (round(c.printed_x, 4), round(c.rate_mean, 3), round(100 * c.rate_error, 2)) == (0.0418, 7.910, 0.43)
    # The series is of third order: a sixteenth at half the amplitude.
    assert c.series / compare_pair(0.102).series == pytest.approx(16, rel=0.2)


def test_a_pair_of_ones_own_is_compared_by_the_series_of_its_bar(capsys: pytest.CaptureFixture[str]) -> None:
    bar = ["--link-length", "1.5", "--link-mass", "2", "--link-inertia", "0.3"]
    own = Scene((10, -10), link=Link(1.5, 2, 0.3))
    errors = [compare_pair(amplitude, own).series for amplitude in (0.1, 0.05)]
    assert errors[0] < 2e-4 and errors[0] / errors[1] == pytest.approx(16, rel=0.2)
    assert main(["pair", "--paired", "0.3", *bar]) == 0
    text = " ".join(capsys.readouterr().out.split())
    assert "a bar of 2 kg and 0.3 kg m², ell = 1.5 m" in text and "r₀ = 0.3" in text
    assert "(5.15), which takes no inertia of a bar" in text
    with pytest.raises(InputError, match="remove the shock"):
        compare_pair(0.1, Scene((10, -10), shock=Shock((1, 0, 0), 1, 0.1)))


def test_the_command_prints_the_page_and_its_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pair"]) == 0
    text = capsys.readouterr().out
    assert [f"({part})" in text for part in "abcdefg"] == [True] * 6 + [False]
    assert (
        "B = I₃ (φ̇ (cos θ₁ + cos θ₂) + 2 ψ̇)" in text
        and "within 0.43 %" in text
        and "7.910 rad/s" in " ".join(text.split())
    )
    assert main(["pair", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert (
        data["formulas"]["B"]
        == r"I_3 \left(\dot{\phi} \left(\cos \theta_1 + \cos \theta_2\right) + 2 \dot{\psi}\right)"
    )
    assert np.isclose(data["comparison"]["run_mean"], 2 * np.pi / compare_pair().run.t[-1])


m, g, l, I3 = sp.symbols("m g l I_3", positive=True)
theta, theta_v, phi_v = sp.symbols("theta theta_dot phi_dot", real=True)


@pytest.mark.parametrize(
    ("expression", "written"),
    [
        (m * g * l * sp.cos(theta), r"m g l \cos \theta"),
        (m * l**2 * theta_v**2 / 2, r"\frac{m l^{2}}{2} \dot{\theta}^{2}"),
        (-m * g * l * (1 - sp.cos(theta)), r"- m g l \left(1 - \cos \theta\right)"),
        (I3 * (phi_v + 1) ** 2 / 2, r"\frac{I_3}{2} \left(\dot{\phi} + 1\right)^{2}"),
        (-sp.Rational(3, 4) * m * l * (theta_v + phi_v), r"- \frac{3 m l}{4} \left(\dot{\phi} + \dot{\theta}\right)"),
        (m / (g * l), r"\frac{m}{g l}"),
        (-theta + 1, r"1 - \theta"),
        (-theta - l, r"- l - \theta"),
        (theta_v / 2, r"\frac{\dot{\theta}}{2}"),
    ],
)
def test_factors_stand_in_the_order_of_a_physicist(expression: sp.Expr, written: str) -> None:
    assert latex(expression) == written
