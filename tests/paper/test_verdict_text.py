"""A verdict in a terminal: short lines in letters and signs, as printed and as it should read."""

import pytest

from lagrotor import audit
from lagrotor.paper.audit import in_words
from lagrotor.paper.plain_text import from_latex
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER


@pytest.mark.parametrize(
    ("source", "text"),
    [
        (r"\frac{a + b}{c}", "(a + b)/c"),
        (r"\frac{\rho\,\vec{r}\times\vec{F}}{(1 + \rho) I_3\omega_1}", "(ρ r × F)/((1 + ρ) I₃ω₁)"),
        (r"\frac{\frac{a}{b}}{2}", "(a/b)/2"),
        (r"\frac{d}{dt}\vec X_r", "d/dt X_r"),
        (r"y_1/\sqrt\sigma", "y₁/√σ"),
        (r"\sqrt{a^{2} - b^{2}}", "√(a² − b²)"),
        (r"R I_{0} R^{T}", "R I₀ Rᵀ"),
        (r"\sin^{2}{\theta} \left(a - b\right)", "sin² θ (a − b)"),
        (r"\frac{\partial L}{\partial\dot\theta}", "∂L/∂θ̇"),
        (r"\left\langle\dot x^2\right\rangle \pm\mathrm{d} t", "⟨x\u0307²⟩ ± dt"),
        (r"\frac{\mathrm{d}}{\mathrm{d} t} p_x", "d/dt p_x"),
        (r"m\frac{\mathrm{d} v}{\mathrm{d} t^{}}", "m dv/dt"),
        (r"\begin{pmatrix} a & b \\ c & \cos\theta \end{pmatrix} x", "[a, b; c, cos θ] x"),
        (r"\tfrac12 m \ddot{x}_{12}", "1/2 m x\u0308₁₂"),
        (r"\left.\int_0^T \mathbf{F}\,\mathrm{d}t\right|_{\text{(path)}}", "∫₀ᵀ F dt|_(path)"),
    ],
)
def test_a_formula_is_one_line_of_text(source: str, text: str) -> None:
    assert from_latex(source) == text


@pytest.mark.parametrize(("equation", "right"), [("3.12", "I(t) = R I₀ Rᵀ"), ("3.14", "d/dt X_r = Ω × X_r")])
def test_vectors_and_tensors_are_not_written_out(equation: str, right: str) -> None:
    lines = in_words(audit(equation), PAPER).splitlines()
    assert f"  right      {right}" in lines
    assert all(len(line) < 300 and "Matrix" not in line and "\\" not in line for line in lines)
