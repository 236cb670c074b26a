"""An equation given as text: how it is read, what is decided of it, and what is refused in words."""

import pytest
import sympy as sp

from lagrotor.commands.command_line import main
from lagrotor.errors import InputError
from lagrotor.paper import judge, judge_text
from lagrotor.paper.premises import relation_text


@pytest.mark.parametrize(
    ("equation", "given", "verdict"),
    [
        ("sin(x)**2 + cos(x)**2 = 1", (), "holds"),
        ("sqrt(x**2) = x", ["x ≥ 0"], "holds-if"),
        ("sqrt(x**2) = -x", ["x >= 1"], "refuted"),
        ("x**2 = x*y", ["y == x"], "holds-if"),
        (r"\sin 2x = 2 \sin x \cos x", (), "holds"),
        (r"\omega^2 l = g", [r"\omega = \sqrt{\frac{g}{l}}"], "holds-if"),
        (r"\cos\theta = 1 - \frac{\theta^2}{2} + O(\theta^4)", (), "holds-to-order"),
        (r"\cos\theta = 1 - \frac{\theta^2}{3} + O(\theta^4)", (), "refuted"),
        ("a = b = c", ["a = 1", "b = 1", "c = 1"], "holds-if"),
        ("integrate(1/(1 + cos(x)), (x, 0, 2*pi)) = 0", (), "undecided"),
        ("integrate(1/(2 + cos(x)), (x, 0, 2*pi)) = 2*pi/sqrt(3)", (), "undecided"),
        # Half of an arc, by the sign of its cosine; numbers made of arcs, by their sine and an enclosure.
        ("cos(acos(x)/2) = sqrt((1+x)/2)", (), "holds"),
        ("cos(acos(x)/2) = -sqrt((1+x)/2)", (), "refuted"),
        ("tan(atan(x)/2) = x/(1-sqrt(1+x**2))", (), "refuted"),
        ("cos(acos(x)/4)**2 = (1+sqrt((1+x)/2))/2", (), "holds"),
        ("acos(2*sqrt(5)/5) = atan(1/2)", (), "holds"),
        ("acos(2*sqrt(5)/5) = atan(1/2) + 10**(-60)", (), "refuted"),
        ("2*acos(1/3) = -acos(-7/9)", (), "refuted"),
        ("atan(1) + atan(2) + atan(3) = 0", (), "refuted"),
        # Definite integrals are refuted by enclosures, not proved by them.
        ("integrate(Abs(sin(x)), (x, 0, 2*pi)) = 2/3", (), "refuted"),
        ("integrate(Abs(sin(x)), (x, 0, 2*pi)) = 4", (), "undecided"),
        ("integrate(1/x, (x, -1, 1)) = 7", (), "undecided"),
        ("exp(1j*x) = cos(x) + 1j*sin(x)", (), "holds"),
        ("pi = acos(x) + asin(x)", (), "refuted"),
        ("sqrt(l**2) = l", (), "holds-if"),
    ],
)
def test_verdicts_of_text(equation: str, given: list[str], verdict: str) -> None:
    assert judge_text(equation, given, positive=["g", "l"] if "g" in given[:1] else ()).verdict.verdict == verdict


@pytest.mark.parametrize(
    ("equation", "given", "domain"),
    [
        ("x/x = 1", [], ["x ≠ 0"]),
        ("exp(log(x)) = x", [], ["x ≠ 0"]),
        (r"\frac{x y}{x} = y", [], ["x ≠ 0"]),
        ("x/(x*y) = 1/y", [], ["x ≠ 0", "y ≠ 0"]),
        ("x/x = 1", ["x > 0"], ["x ≠ 0"]),
        ("sqrt(1/x) = 1/sqrt(x)", ["x > 0"], []),
        ("besselj(0, x) + besselj(2, x) = 2*besselj(1, x)/x", [], ["x ≠ 0"]),
        ("tan(x/2) = sin(x)/(1 + cos(x))", [], ["cos(x/2) ≠ 0"]),
        ("x - x = 0", [], []),
    ],
)
def test_the_domain_has_what_cancels_while_the_text_is_read(equation: str, given: list[str], domain: list[str]) -> None:
    verdict = judge_text(equation, given).verdict
    assert verdict.verdict in ("holds", "holds-if")
    assert [relation_text(relation) for relation in verdict.domain] == domain


@pytest.mark.parametrize(
    ("equation", "given", "says"),
    [
        ("x", [], "write left = right"),
        ("x > 1", [], "write left = right"),
        ("T = 2*pi*sqrt(l/g)", [], "which occurs nowhere else"),
        ("x + 1 = (", [], "was never closed"),
        ("2*x = 1", ["y"], "one relation in each"),
        ("2*x = f(x)", [], r"write f\*"),
        ("2*x = __import__('os')", [], "__import__"),
        (r"\ln x^2 = 3", [], "write the argument in brackets"),
        ("exp(x) = e^x", [], r"write exp\(…\)"),
        ("cosh(x) = (e^x + e^(-x))/2", [], r"write exp\(…\)"),
        ("exp(i*x) = cos(x) + i*sin(x)", [], "write 1j"),
        ("sqrt(x**2) = x", ["x >= 0", "x**2 >= 0"], "is always true"),
    ],
)
def test_what_cannot_be_read_is_refused_in_words(equation: str, given: list[str], says: str) -> None:
    with pytest.raises(InputError, match=says):
        judge_text(equation, given)


def test_the_shell_judges_one_equation(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["judge", "sqrt(x**2) = x", "--given", "x >= 0"]) == 0
    assert capsys.readouterr().out == "sqrt(x**2) = x: holds-if\n  under the given premise x ≥ 0\n"
    assert main(["judge", "sqrt(x**2) = x"]) == 0
    assert capsys.readouterr().out == "sqrt(x**2) = x: holds-if\n  x ≥ 0\n"
    assert main(["judge", "x = x+1"]) == 1
    assert capsys.readouterr().out == "x = x+1: refuted\n  left − right is −1\n"
    assert main(["judge", r"\cos x = 1"]) == 1
    said = capsys.readouterr().out
    assert said.startswith("cos(x) = 1: refuted\n  left − right is −0.16089 at x = −0.57515: left 0.83911, right 1\n")
    assert main(["judge", "cos(x) = 1", "--json"]) == 1
    assert '"witness"' in capsys.readouterr().out
    assert main(["judge", "cos(x)"]) == 2


def test_a_power_may_be_typed_with_a_caret() -> None:
    """sqrt(a^2) is a root, not s·q·r·t: what is typed as in Python is read so; beside LaTeX it is refused."""
    assert judge_text("(sin(x) + cos(x))^2 = 1 + sin(2*x)").verdict.verdict == "holds"
    assert judge_text("sqrt(a^2 + b^2) = a + b").readings[0] == "sqrt(a**2 + b**2) = a + b"
    assert judge_text("x^2 y = y x^2").verdict.verdict == "holds"
    with pytest.raises(InputError, match="reads it as the letters s q r t"):
        judge_text(r"\alpha^2 sqrt(x) = \alpha")


@pytest.mark.parametrize(
    "premise",
    [
        "b = a*sin(x) + c", "a*sin(x) + c = b", "b - c = a*sin(x)", "0 = b - c - a*sin(x)", "3*b = 3*c + 3*a*sin(x)",
        "c = b - a*sin(x)", "a = (b - c)/sin(x)",
    ],
)  # fmt: skip
def test_a_premise_that_is_the_conclusion_is_named_in_every_form(premise: str) -> None:
    verdict = judge_text("a*sin(x) + c = b", [premise]).verdict
    assert verdict.verdict == "undecided" and verdict.evidence[0].startswith("circular: the premise is the conclusion")
    left, right = (part for pair in verdict.statement.premises[0].equations for part in pair)
    sides = verdict.lines[0].relation
    for given in ({left: right}, {right: left}, sp.Eq(left, right), [sp.Eq(right, left)]):
        assert (
            judge(sides.printed, sides.derived, premises=given).evidence
            == judge(sides.derived, sides.printed, given).evidence
        )
        assert "circular" in judge(sides.printed, sides.derived, premises=given).evidence[0]
    assert judge_text("a*sin(x) + c = b", ["c = b", "a = 0"]).verdict.verdict == "holds-if"


def test_a_premise_that_touches_no_letter_of_the_equation_is_refused() -> None:
    a, b, x = sp.symbols("a b x", real=True)
    with pytest.raises(InputError, match="two different symbols are called 'a'"):
        judge(a * x, b * x, premises=[sp.Eq(sp.Symbol("a"), sp.Symbol("b"))])
    with pytest.raises(InputError, match="no symbol of the premise y > 0 is in the equation"):
        judge_text("a*x = b*x", ["y > 0"])
    assert judge_text("a*x = b*x", ["a = y", "c = y", "b = c"]).verdict.verdict == "holds-if"


# Equations in LaTeX with calculus, vectors and matrices, each with a twin that is false.
CALCULUS = [
    (r"\int_0^1 x\,dx = \frac12", r"\frac12", r"\frac13"),
    (r"\int_0^a x^2\,dx = \frac{a^3}{3}", "{3}", "{2}"),
    (r"\frac{d}{dx} x^2 = 2x", "2x", "x"),
    (r"\frac{\partial}{\partial x}(x^2 y) = 2xy", "2xy", "2y"),
    (r"\dv[2]{x}\sin(kx) = -k^2\sin(kx)", "-k", "k"),
    (r"\left.\frac{d}{dx}x^3\right|_{x=2} = 12", "12", "6"),
    (r"\frac{d}{dt}(\frac12 m\dot x^2) = m\dot x\ddot x", r"\ddot x", ""),
    (r"\frac{d}{dt}V(x) = V'(x)\dot x", "V'", "2V'"),
    (r"\frac{d}{dt}(\frac12 m\dot{\mathbf r}\cdot\dot{\mathbf r}) = m\dot{\mathbf r}\cdot\ddot{\mathbf r}", "= m", "= 2m"),
    (r"\sum_{k=1}^{4} k = 10", "10", "11"),
    (r"\sum_{k=1}^{n} k = \frac{n(n+1)}{2}", "1)}", "2)}"),
    (r"\sum_{i=1}^3 m_i = m_1 + m_2 + m_3", "+ m_3", ""),
    (r"\prod_{k=1}^{3} k = 6", "6", "5"),
    (r"\binom{5}{2} = 10", "10", "9"),
    (r"\binom{n}{k} = \frac{n!}{k!(n-k)!}", "(n-k)", "(n+k)"),
    ("n! = n(n-1)!", "n(", "("),
    (r"\|\mathbf v\|^2 = \mathbf v\cdot\mathbf v", "^2", ""),
    (r"\vec a\cdot(\vec b\times\vec c) = \vec c\cdot(\vec a\times\vec b)", r"\vec a\times\vec b)", r"\vec b\times\vec a)"),
    (r"\mathbf a\times\mathbf a = 0", r"\times\mathbf a", r"\times\mathbf b"),
    (
        r"\begin{pmatrix} 1 & 2\\ 3 & 4\end{pmatrix}\begin{pmatrix} x\\ y\end{pmatrix}"
        r" = \begin{pmatrix} x + 2y\\ 3x + 4y\end{pmatrix}", "4y", "3y",
    ),
    (
        r"\begin{pmatrix} a & b\\ c & d\end{pmatrix}^{-1}"
        r" = \frac{1}{ad - bc}\begin{pmatrix} d & -b\\ -c & a\end{pmatrix}", "-b", "b",
    ),
    (r"\begin{pmatrix} a & b\\ c & d\end{pmatrix}^T = \begin{pmatrix} a & c\\ b & d\end{pmatrix}", "c & d", "d & c"),
    (r"\det\begin{pmatrix} a & b\\ c & d\end{pmatrix} = ad - bc", "ad -", "ad +"),
    (r"\begin{vmatrix} a & b\\ c & d\end{vmatrix} = ad - bc", "ad -", "ad +"),
]  # fmt: skip


@pytest.mark.parametrize(("equation", "part", "other"), CALCULUS)
def test_calculus_in_latex_is_decided_straight_from_its_tree(equation: str, part: str, other: str) -> None:
    assert judge_text(equation).verdict.verdict == "holds"
    false = equation[::-1].replace(part[::-1], other[::-1], 1)[::-1]  # the last place
    assert judge_text(false).verdict.verdict == "refuted"


def test_a_premise_is_put_in_for_what_is_differentiated() -> None:
    equation = r"\frac{d}{dt}\frac{\partial L}{\partial\dot q} - \frac{\partial L}{\partial q} = m\ddot q + kq"
    for sign, verdict in (("-", "holds"), ("+", "refuted")):
        assert judge_text(equation, [rf"L = \frac12 m\dot q^2 {sign} \frac12 k q^2"]).verdict.verdict == verdict
    with pytest.raises(InputError, match="give it by a premise"):
        judge_text(equation)


@pytest.mark.parametrize(
    ("equation", "words"),
    [
        (r"\lim_{x\to 0}\frac{\sin x}{x} = 1", "write the value of the limit"),
        (r"\int x\,dx = x^2/2", "between two limits"),
        (r"d(uv) = u\,dv + v\,du", "d precedes a symbol"),
        (r"\sum_{i=1}^n m_i = M + 1", "the first and the last index as numbers"),
        (r"\frac{dE}{dx} = 0", "write the expression that is differentiated"),
        (r"\nabla\cdot\vec E = 0", "write its components"),
        (r"\mathbf A\mathbf B\mathbf x = 0", "write the entries of the matrices"),
        (r"x = \pm a", "write two statements"),
        (r"|a\rangle = b", "closes no bracket"),
        (r"\begin{pmatrix} 1 & 0\\ 0 & 1\end{pmatrix} = 1", "a vector is equal to a number"),
        (r"\frac{d}{dx}(x V) = V(x)", "has an argument in one place and none in another"),
        (r"y = i\omega", 'numbers = "i"'),
    ],
)
def test_what_is_not_decided_is_refused_in_words(equation: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        judge_text(equation)


def test_an_order_in_any_member_is_the_order_of_the_chain() -> None:
    chain = r"1 - \cos\theta = 2\sin^2\frac\theta2 = \frac{\theta^2}{2} + O(\theta^4) = \frac{\theta^2}{%s}"
    assert [judge_text(chain % n).verdict.verdict for n in (2, 4)] == ["holds-to-order", "refuted"]


@pytest.mark.parametrize("positive", [(), ("x",)])
def test_a_function_of_a_function_is_not_evaluated_while_it_is_read(positive: tuple[str, ...]) -> None:
    equation = r"\cos(x\operatorname{arcosh}(1 + 10^{-8})) = %s"
    assert judge_text(equation % "1", positive=positive).verdict.verdict == "refuted"
    same = r"\cos(\operatorname{arcosh}(1 + 10^{-8})\,x)"
    assert judge_text(equation % same, positive=positive).verdict.verdict == "holds"


def test_positive_letters_are_positive_in_sums_and_rates() -> None:
    for equation in (r"\frac{d}{dt}\sqrt{x^2} = \dot x", r"\sum_{i=1}^2\sqrt{x_i^2} = x_1 + x_2"):
        letters = ["x"] if "dt" in equation else ["x_1", "x_2"]
        assert judge_text(equation, positive=letters).verdict.verdict == "holds"
        assert judge_text(equation).verdict.verdict != "holds"


ON_THE_EDGE = [
    # sign(0) is neither 1 nor −1
    ("sign(x) = 1", ["x > 0"], []),
    ("sign(x) = -1", ["x < 0"], []),
    ("sign(x - 1) = 1", ["x − 1 > 0"], []),
    ("sign(x*y) = sign(x)", ["y > 0"], []),
    ("sign(x) + sign(y) = 2", ["x > 0", "y > 0"], []),
    ("sign(sin(x)) = 1", ["tan(x/2) ≥ 0"], ["sin(x) ≠ 0"]),
    ("sign(x**2) = 1", [], ["x ≠ 0"]),
    ("sign(1 + x**2) = 1", [], []),
    (r"\operatorname{sgn}(x) = 1", ["x > 0"], []),
    # the sign of a product, and not of each factor
    ("Abs(x*y) = x*y", ["x·y ≥ 0"], []),
    ("Abs(x)*Abs(y) = x*y", ["x·y ≥ 0"], []),
    ("sqrt(m**2*g**2*sin(t)**2) = m*g*sin(t)", ["g·m·sin(t) ≥ 0"], []),
    ("m*g*sin(t) = sqrt(m**2*g**2*sin(t)**2)", ["g·m·sin(t) ≥ 0"], []),
    ("sqrt(cos(x)**2) = cos(x)", ["cos(x) ≥ 0"], []),
    # between the roots of a quadratic
    ("asin(x) = atan(x/sqrt(1 - x**2))", ["x² − 1 < 0"], []),
    ("sqrt((1 + b)/(1 - b)) = (1 + b)/sqrt(1 - b**2)", ["b² − 1 < 0"], ["b − 1 ≠ 0", "b + 1 ≠ 0"]),
    # proved for either sign
    ("acosh(cosh(x)) = Abs(x)", [], []),
    ("acosh(cosh(x)) = x", ["x ≥ 0"], []),
    ("log(cosh(x)) = Abs(x) + log((1 + exp(-2*Abs(x)))/2)", [], []),
    # the domain in the letters of the print
    ("log((1 + x)/(1 - x)) = log(1 + x) - log(1 - x)", ["x − 1 < 0"], ["x + 1 > 0"]),
    ("log(x**2) = 2*log(Abs(x))", [], ["x ≠ 0"]),
]


@pytest.mark.parametrize(("equation", "branch", "domain"), ON_THE_EDGE)
def test_the_condition_is_right_at_its_edge(equation: str, branch: list[str], domain: list[str]) -> None:
    verdict = judge_text(equation).verdict
    assert verdict.verdict == ("holds-if" if branch else "holds")
    conditions = [relation for premise in verdict.premises for relation in premise.conditions]
    assert [relation_text(relation) for relation in conditions] == branch
    assert [relation_text(relation) for relation in verdict.domain] == domain
    left, right = equation.split(" = ")
    assert judge_text(f"{left} + 7 = {right}").verdict.verdict == "refuted"


def test_a_function_by_its_name_is_no_unknown_function() -> None:
    assert (
        judge_text(r"\operatorname{atan2}(y, x) = \arctan\frac{y}{x}", premises=["x > 0"]).verdict.verdict == "holds-if"
    )
    assert judge_text(r"\operatorname{besselj}(0, 0) = 1").verdict.verdict == "holds"
    assert judge_text(r"\gamma(x) + \gamma(x) = 2\gamma(x)").verdict.verdict == "holds"
    with pytest.raises(InputError, match="no rules for the function erf"):
        judge_text(r"\operatorname{erf}(x) = 1")
