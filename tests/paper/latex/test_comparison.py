"""Two sides at points: they differ only where both are real numbers there; what is spared is counted."""

import pytest
import sympy as sp

from lagrotor.paper.latex import comparison
from lagrotor.paper.latex.check import check_source
from lagrotor.paper.latex.displays import read_latex

x, y = sp.symbols("x y", real=True)


@pytest.mark.parametrize(
    ("a", "b", "may"),
    [
        ((x + y) ** 2, x**2 + 2 * x * y + y**2, True),
        ((x + y) ** 2, x**2 + 3 * x * y + y**2, False),
        (sp.sqrt(-x - y), -sp.sqrt(-x - y), False),  # real where x + y is negative alone
        (sp.log(-x), sp.log(-2 * x), False),
        (sp.sqrt(-(x**2) - 1), x, True),  # nowhere: no point is known
        (sp.sqrt(-(x**2) - 1) * (x + 1), x * sp.sqrt(-(x**2) - 1) + sp.sqrt(-(x**2) - 1), True),
        (sp.cosh(40 * x) - sp.sinh(40 * x), sp.exp(-40 * x), True),  # digits cancel in floats
        (sp.Integer(10) ** 400 * x, x, True),  # no float has it
        (sp.gamma(x), sp.gamma(x) + 1, False),  # no function of floats
    ],
)
def test_sides_differ_only_where_both_are_real(a: sp.Expr, b: sp.Expr, may: bool) -> None:
    assert comparison.may_agree(a, b) is may


def test_what_is_not_real_at_positive_letters_takes_no_exact_decision(monkeypatch: pytest.MonkeyPatch) -> None:
    """It took up to a second each."""
    asked = []
    monkeypatch.setattr(comparison, "decide_equal", lambda a, b: asked.append((a, b)))
    check_source(read_latex(r"\begin{align*} A &= \sqrt{-p - q} + p \\ &= \sqrt{-p - q} + q \end{align*}"))
    assert not asked


def test_what_a_step_may_cost_does_not_hang_on_the_length_of_the_source(monkeypatch: pytest.MonkeyPatch) -> None:
    """The rates of all letters were sought within the first step that needs them: in 5 MB each step was too large."""
    monkeypatch.setattr(comparison, "MOST_CALLS", 40_000)
    chain = r"\begin{align*} F &= 2 a (b + a) \\ &= 2 a b + 2 a^2 + \frac{c d}{e} \end{align*}"
    others = "".join(rf"\[ q_{{{n}}} = p_{{{n}}} + r_{{{n}}} s_{{{n}}} \]" "\n" for n in range(600))
    alone, among = (
        next(f for f in check_source(read_latex(text)).findings if f.step == 2) for text in (chain, chain + others)
    )
    assert (among.verdict, among.why) == (alone.verdict, alone.why)
    assert "symbols that the left member lacks" in among.why
