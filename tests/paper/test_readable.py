"""Formulas in sentences as people read them."""

import pytest

from lagrotor.paper import scientific
from lagrotor.paper.plain_text import readable


@pytest.mark.parametrize(
    ("typed", "read"),
    [
        ("J = I_1 (I_1 read)", "J = I₁ (I₁ read)"),
        ("cos(Phi)**3/2 - 3*cos(Phi)/2", "cos(Φ)³/2 − 3·cos(Φ)/2"),
        ("by -cos(Phi) in Delta_t", "by −cos(Φ) in Δt"),
        ("M*R**2*(phi_dot**2 + theta_1_dot**2)", "M·R²·(φ̇² + θ̇₁²)"),
        ("4 r_0⁴ cos⁴ Phi", "4 r₀⁴ cos⁴ Φ"),
        ("phi_1 = -phi_2 at -0.363", "φ₁ = −φ₂ at −0.363"),
        ("(a+b)**nu", "(a+b)^ν"),
        ("Omega**12", "Ω¹²"),
        ("varepsilon, sin(vartheta_1)", "ε, sin(ϑ₁)"),
        ("Omega_y*I_x = -f_ij", "Ω_y·I_x = −f_ij"),
        ("Omega^2 (X)^2 R^T", "Ω² (X)² Rᵀ"),
        ("psi_1' = D s' + r'', the rotors' own, Hill's", "ψ₁′ = D s′ + r′′, the rotors' own, Hill's"),
        ("r x F, R -> R, k >= 1, ||Omega||", "r × F, R → R, k ≥ 1, ‖Ω‖"),
        ("1e-11, 5.9e+03, -1.2e-7, 0e+00", "10⁻¹¹, 5.9×10³, −1.2×10⁻⁷, 0"),
        ("sqrt(1 + exp(-(2 t)))", "√(1 + exp(−(2 t)))"),
    ],
)
def test_formulas_are_set(typed: str, read: str) -> None:
    assert readable(typed) == read


@pytest.mark.parametrize(
    "text",
    [
        "U_3_x",
        "figures 13-14",
        "x-y",
        "lagrotor chart --quick",
        "*b* _c_ `a`",
        "trial_1",
        r"\theta_1",
        "-x",
        "M_z",
    ],
)
def test_words_are_left_alone(text: str) -> None:
    assert readable(text) == text


@pytest.mark.parametrize(
    ("value", "digits", "read"),
    [
        (3e-14, 0, "3×10⁻¹⁴"),
        (-1.57e-162, 1, "−1.6×10⁻¹⁶²"),
        (2.5e10, 1, "2.5×10¹⁰"),
        (0, 0, "0"),
        (1.0, 0, "1"),
        (-2.0, 1, "−2.0"),
    ],
)
def test_a_number_in_powers_of_ten(value: float, digits: int, read: str) -> None:
    assert scientific(value, digits) == read
