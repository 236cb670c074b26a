r"""Readings: every token of a print is read as its notation declares it, or the reading names the token where it stops."""

import pytest
import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError
from lagrotor.paper.grammar import read
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.notation import Notation, Proposal, declared_notation, propose, with_proposals
from lagrotor.paper.latex.tree import Letter, Opaque, in_catalogue, letters_of, sympy_expression, text_of, walk


def said(latex: str, *others: str, **table: str | bool) -> str:
    """The statements as text, in the notation of a table and of what a sweep proposes; what stopped the reading else."""
    reading = read_formula(latex, with_proposals(declared_notation(table), propose([latex, *others])))
    if reading.stop is not None:
        assert reading.stop[1], "what would help"
        return f"stopped: {reading.stop[0]}"
    return "; ".join(" = ".join(text_of(side.node) for side in s.sides) for s in reading.statements)


READ = {
    r"x^{\mathrm{s}} = y": "x__s = y",
    r"F_i = m_i\ddot x_i + \sum_j a_{ij} x_j": "F_i = m_i*x_i_ddot + Sum(a_ij*x_j, j)",
    r"y = \ln\frac ab\,x + \sin\frac{n\pi}{l}": "y = log(a/b)*x + sin(n*pi/l)",
    r"\ddot\theta = -\frac{g}{l}\,\theta.": "theta_ddot = -g/l*theta",
    r"T = \tfrac12 m \dot{x}_1^2 = T_1": "T = 1/2*m*x_1_dot**2 = T_1",
    r"E = a\left(b + c\right)": "E = a*(b + c)",
    r"V = x_{cm}\,0.7125": "V = x_cm*(57/80)",
    r"\phi = \frac{M}{\cos\theta (I_1 + I_3)}": "phi = M/(cos(theta)*(I_1 + I_3))",
    r"x = \lambda e^{-\gamma t}": "x = lamda*exp(-gamma*t)",
    "{x_A}^2": "x_A**2",
    r"k = 4\pi^2/T^2": "k = 4*pi**2/T**2",
    r"v = \frac{dx}{dt} = \frac{\mathrm{d}x}{\mathrm{d}t}": "v = x_dot = x_dot",
    r"a = \frac{d^2 x}{dt^2} = \frac{d\dot x}{dt}": "a = x_ddot = x_ddot",
    r"\frac{d}{dt}\frac{\partial L}{\partial\dot q} = \frac{\partial L}{\partial q}":
        "rate(Derivative(L, q_dot)) = Derivative(L, q)",
    r"\vec L = m\,\vec r\times\dot{\vec r}": "Lvec = cross(m*rvec, rvec_dot)",
    r"W = \mathbf{F}\cdot\mathbf{s} = |\mathbf{F}|\,s\cos\alpha": "W = dot(Fbold, sbold) = norm(Fbold)*s*cos(alpha)",
    r"M = \sum_{i=1}^{n} m_i": "M = Sum(m_i, i, 1, n)",
    r"A = \int_0^1 x^2\,dx + \int\frac{dy}{y}": "A = Integral(x**2, x, 0, 1) + Integral(1/y, y)",
    r"y = \sin^2\theta + \sin 2\theta\cos\phi": "y = sin(theta)**2 + sin(2*theta)*cos(phi)",
    r"y = \sin\theta\,\dot\theta": "y = sin(theta)*theta_dot",
    "x^{(1)} = l_1^2 + x'": "x__1 = l_1**2 + xprime",
    r"n = \sqrt[3]{5} + \sqrt{a+b} + \frac12": "n = 5**(1/3) + sqrt(a + b) + 1/2",
    r"A = \begin{pmatrix} a & b\\ c & 0\end{pmatrix}": "A = matrix(row(a, b), row(c, 0))",
    r"\left.\frac{\partial V}{\partial x}\right|_{x=0} = 0": "at(Derivative(V, x), x, 0) = 0",
    r"x = a,\qquad y = b \quad\text{where } z = c.": "x = a; y = b; z = c",
    r"\begin{aligned} a &= b\\ &\quad + c\\ &= d\end{aligned}": "a = b + c = d",
    r"\alpha = 30^\circ": "alpha = 30*pi/180",
    r"x = \ln\cosh\left(\frac{g t}{v}\right) + \sin\arccos y": "x = log(cosh(g*t/v)) + sin(acos(y))",
    r"a = \varDelta x + \varGamma": "a = Delta_x + Gamma",
    r"\frac{\text{d}x}{\text{d}t} = \int f\,\text{d}x + x_\text{d}": "x_dot = Integral(f, x) + x_d",
    r"\frac{\partial^{} r}{\partial u^{}} = 1": "Derivative(r, u) = 1",
    r"\left\{\begin{aligned} \dot x &= y\\ \dot y &= -x\end{aligned}\right.": "x_dot = y; y_dot = -x",
    r"H(q,p) = p\dot q - L(q,\dot q)": "H(q, p) = p*q_dot - L(q, q_dot)",
    r"y = \dot x' + \theta'_1": "y = xprime_dot + thetaprime_1",
    r"y = x_1 - 2 + a \cdot 2": "y = x_1 - 2 + a*2",
    r"y = 2\frac{a}{b}": "y = 2*(a/b)",
    "y = k(x - x_0)": "y = k*(x - x_0)",
    r"y = a\underbrace{- b}_{c}": "y = a - b",
    r"\mathbf u = \mathbf b^T e^{\mathbf A t}\mathbf C\mathbf d":
        "ubold = matmul(transpose(bbold), exp(Abold*t), Cbold, dbold)",
    r"y = (\vec a\times\vec b)\cdot\hat{\mathbf n}": "y = dot(cross(avec, bvec), nboldhat)",
    r"\vec F = F\hat{\mathbf r}": "Fvec = F*rboldhat",
    r"\vec F = 0": "Fvec = 0",
    r"a = b \text{ and } c = d": "a = b; c = d",
    r"{a + b \over c} = {n \choose k}": "(a + b)/c = binomial(n, k)",
    r"y = \ln|x| + \sin n\pi": "y = log(Abs(x)) + sin(n*pi)",
    r"a = b\qquad (c > 0)": "a = b; c = 0",
    r"\ddot x + x = A\text{ cos }(t)": "x_ddot + x = A*cos(t)",
    r"\begin{aligned} a &= b = \\ &= c\end{aligned}": "a = b = c",
    r"a = b, \\ = c": "a = b = c",
    r"y = \mathrm{e}^{im\phi} + i": "y = exp(imaginary_unit*m*phi) + imaginary_unit",
    r"y = {\rm cos}[x - a]": "y = cos(x - a)",
    r"p = \left.\frac{dV}{dx}\right|_{x = 0}": "p = at(Derivative(V, x), x, 0)",
    "y = |a||b|": "y = Abs(a)*Abs(b)",
    r"y = 4\pi\left(\frac{m}{k}\right)^{3/2}": "y = 4*pi*(m/k)**(3/2)",
    r"E = a + b.\\": "E = a + b",
    r"G = \int\frac{dE}{2\pi} f(E, x)": "G = Integral(1/(2*pi)*f(E, x), E)",
    r"D = |\mathbf{K} - \mathbf{M}|": "D = norm(Kbold - Mbold)",
    r"V = \theta(\theta^2 - 1)": "V = theta*(theta**2 - 1)",
    "y = A(x - a)(x - b)": "y = A*(x - a)*(x - b)",
    r"\vec E = \frac{q}{r^2}\hat r": "Evec = q/r**2*rhat",
    r"\vec B = \vec C + b\hat e_\phi": "Bvec = Cvec + b*ehat_phi",
    r"\beta = 13.7^o": "beta = 137/10*pi/180",
    r"x = \sum_i\frac{m_i}{\Sigma m} x_i": "x = Sum(m_i/(Sigma*m)*x_i, i)",
    r"x = 1{,}000 + 0{,}25 + 3.2\times10^{-5}": "x = 1000 + 1/4 + 16/5*10**(-5)",
}  # fmt: skip


@pytest.mark.parametrize("latex", READ)
def test_what_is_read_is_what_is_printed(latex: str) -> None:
    assert said(latex) == READ[latex]


def test_the_text_of_a_reading_is_what_its_tree_is() -> None:
    """A catalogue holds the text, a verdict of LaTeX takes the tree."""
    compared = 0
    for latex in READ:
        reading = read_formula(latex, with_proposals(Notation(), propose([latex])))
        for side in (each for statement in reading.statements for each in statement.sides):
            if not in_catalogue(side.node) or any(isinstance(each, Letter) and each.vector for each in walk(side.node)):
                continue
            letters = {name: sp.Symbol(name, real=True) for name in letters_of(side.node)}
            text, tree = read(text_of(side.node), letters, "text"), sympy_expression(side.node, Opaque(refuses=True))
            assert decide_equal(text, tree).answer == "zero" and decide_equal(text, tree + 1).answer != "zero"
            compared += 1
    assert compared > 50


# What the notation does not declare, or the grammar does not have, and where the reading stops.
REFUSED = {
    "SO(3, 1) = G": ", cannot be read",
    r"\frac{\partial L}{\partial(\partial_x\phi)} = \frac{\partial L}{\partial\,\partial_x\phi}": r"{\partial cannot be read",
    "S[f] = a": "it is unclear whether S before [ is a function or a factor",
    r"E = m\omega^2(\Delta x)^2 + \omega(x)": r"it is unclear whether \omega^2 before ( is a function or a factor",
    r"|k_{ij} - \omega^2 m_{ij}| = 0": "it is unclear whether the bars are a determinant or a length",
    r"\delta W = 0": r"it is unclear whether \delta is a factor or an operator",
    r"W = \frac{\partial L}{\partial q}\delta q - 2\Delta t": r"it is unclear whether \delta is a factor or an operator",
    r"H = p_i\dot q_i - L": "it is unclear whether i is summed over",
    r"Q_j = F_i\frac{\partial x_i}{\partial q_j}": "it is unclear whether i is summed over",
    "f^p_q = b": "it is unclear whether p is an upper index or a power",
    r"\mathbf q^{n+1/2}_i = \vec F^{int} + \mathbf s^1": "it is unclear whether n+1/2 is an upper index or a power",
    r"\hat H\psi = E\psi": "it is unclear whether Hhat is an operator or a symbol",
    "F^e = a": "it is unclear whether e is an upper index or a power",
    "x^0 = ct": "it is unclear whether 0 is an upper index or a power",
    r"y = \sin x y": "it is unclear where the argument of sin ends",
    r"y = \ln\frac ab x": "it is unclear where the argument of ln ends",
    r"g = 9.81\,\mathrm{m/s^2}": r"\mathrm{m/s^2} is a unit",
    r"g = 9.81\,\mathrm{m/s^2} = 981\,\mathrm{cm/s^2}": r"\mathrm{m/s^2} is a unit",
    r"c = 3~{\rm m/s}": "upright m after a number is a unit",
    r"F = 2\,\mathrm{N} = 2\,\mathrm{kg}\,\mathrm{m}\,\mathrm{s}^{-2}": "upright N after a number is a unit",
    r"ds = v\,dt": "d precedes a symbol",
    r"\mathrm{d}x\mathrm{d}y\mathrm{d}z = \mathrm{d}V\mathrm{d}s\mathrm{d}t": "d precedes a symbol",
    r"x = i\omega": "it is unclear whether i is the imaginary unit",
    r"P \equiv \frac{\hbar}{i}\frac{\partial}{\partial x}": "it is unclear whether i is the imaginary unit",
    r"H = -\frac{d^2}{dx^2} + V(x)": "the derivative has nothing to act on",
    r"\left(\frac{\partial}{\partial t} + \vec u\cdot\nabla\right) \vec u = \vec g": "the derivative has nothing to act on",
    r"\text{Pr}[A] = 4": "it is unclear what the square brackets mean",
    r"\vec k = [\cos a, \sin a]": "it is unclear what the square brackets mean",
    "c = (v_i)_n": "(v_i)_n has an index",
    r"\left(\frac{d\mathbf B}{dt}\right)_I = \mathbf C + \mathbf D": r"\left(\frac{d\mathbf B}{dt}\right)_I has an index",
    r"S = \sum_{cyc} a": "the limits of the sum are not clear",
    r"S = \sum_{i\in N} a_i + \sum_{\text{spins}} b": "the limits of the sum are not clear",
    "u^m(q, p) = v": "it is unclear whether the superscript of u^m is a power",
    r"\psi = Y_l^m(\theta, \phi)": "it is unclear whether the superscript of Y_l^m is a power",
    r"\vec v\cdot\operatorname{grad}(a + b) = 0": "it is unclear whether grad is a vector",
    r"x = \foo y": r"\foo is unknown",
    r"y = \overset{\circ}{A}": r"\overset is unknown",
    r"y = \dot{\bar x} + \bar{\dot x} + \dot{\ddot x}": "an accent is above the dot of x",
    r"p = \text{R}_{\text{u}} T_\text{rot.} + W_{1\to 2}": "_ has nothing before it",
    r"N = 6.02\times 10^{23}\,\text{mol}^{-1} = 2\,\text{J kg}^{-1}": "^ has nothing before it",
    r"x = \int f": "the differential of the integral is missing",
    r"y = \int d\ln m\,f(m), \quad n = 0, \frac12, 1...": "the differential of the integral is missing",
    r"H|n\rangle = E_n|n\rangle": r"\rangle closes no bracket",
    r"|a\rangle = |b\rangle + c|d\rangle": r"\rangle closes no bracket",
    r"p = \text{const}\qquad (t > 0)": "the words const are a unit or a side of a relation",
    r"T = 25^\circ\mathrm{C} = 77^\circ\text{F}": "the words F are a unit or a side of a relation",
    r"y = \left.\frac{\partial a}{\partial x}\right|_i": "the index of the evaluation bar is not an equation",
    r"c = \left.\frac{\partial S}{\partial E}\right|_{V,N}": "the index of the evaluation bar is not an equation",
    r"x = a_1 \cdots a_n": "dots stand for factors",
    r"c = \langle n|H|m\rangle": r"\langle … \rangle is not read",
    r"\langle p|q\rangle = \delta^3(\mathbf p - \mathbf q)": r"\langle … \rangle is not read",
    "y = (2n)!! + n!": "it is unclear what ! belongs to",
    "y = 0,5": "the part after the comma has no relation",
    r"e_i = a_j,\quad i, j = 1, 2": "the part after the comma has no relation",
    r"n = \frac{1}{e^{-\infty} + 1}": "it is unclear whether e is Euler's number",
    r"x = \frac R2\sin\phi(t)": "it is unclear where the argument of sin ends",
    "c = {f_j}^{k'} g": "the superscript k' is not a power",
    r"E^{\omega,\mathrm i} = r^{\mathrm a}": r"the superscript \omega,\mathrm i is not a power",
    r"\mathbf v^\Sigma = \mathbf u": "a vector has a power",
    r"y = \arg\max f": "it is unclear where the argument of arg ends",
    r"\vec F = m a": "a vector is equal to a number",
    r"a = \mathbf e\cdot\mathbf H\cdot\mathbf p": "a vector is equal to a number",
    "y = (a + b)'": "' follows a sign that is not a symbol",
    r"y = \sin^\prime x": "' follows a sign that is not a symbol",
    "y = x^12": "the number 2 follows a factor",
    r"y = \sqrt 12": "the number 2 follows a factor",
    r"y = 1\frac12": "it is unclear whether a mixed number or a product is meant",
    "a, b = 0": "the part before the comma has no relation",
    "a b, c = 0": "the part before the comma has no relation",
    r"\vec a\times\vec b\times\vec c = 0": "it is unclear which × comes first",
    r"r = \text{not constant}": "the words not constant negate a statement",
    r"a = b \text{ but not } c = d": "the words but not negate a statement",
    r"y = \sin\theta^2": "it is unclear whether the power belongs to the argument or to the function",
    r"y = \sin(\theta)^2": "it is unclear whether the power belongs to the argument or to the function",
    r"y = \exp(\theta)_{2} S": "it is unclear whether the power belongs to the argument or to the function",
    r"L = r\times p": "it is unclear whether × multiplies vectors or numbers",
    r"k = \frac{1}{c} v\times H": "it is unclear whether × multiplies vectors or numbers",
    r"y = \sin\theta/2": "it is unclear whether the slash is inside the function",
    "y = a/bc": "it is unclear what the slash divides by",
    "y = 1/2x": "it is unclear what the slash divides by",
    "|a|b|c| = 1": "it is unclear how the bars belong together",
    "= x": "a side of the relation is missing",
    "= a = b": "a side of the relation is missing",
    r"\vec a\vec b = c": "two vectors are side by side",
    r"y = e^{i\mathbf k\mathbf r}": "two vectors are side by side",
    r"S = \sum_i a_i + b_i": "it is unclear whether the sum ends here",
    "x = a.b": "a full stop is inside the formula",
    r"\nabla.\underline{u} = \underline{a}.\underline{b}": "a full stop is inside the formula",
    r"v = \frac{dr}{dt}(0)": "it is unclear whether the bracket after a derivative is the point of evaluation or a factor",
    "x = (a + b": "( is not closed by )",
    "x = a + + b": "two signs follow each other",
    r"y = \frac{d}{dx} f \frac{d}{dx} g": "it is unclear how far the derivative reaches",
    "C = x + constant": "const is a word",
    "y = x_{n^2} + x_{n2}": "an index has signs other than letters and numbers",
    r"v = v_{\text{\tiny a}}": "an index has signs other than letters and numbers",
    "x = 10⁶ y": "⁶ is unknown",
    r"a = \frac{\delta}{\delta f(x)} G": "it is unclear whether the fraction with delta is a derivative",
    r"\frac{\tilde{\mathrm{d}}v}{\mathrm{d}t} = a": "it is unclear whether the fraction with d is a derivative",
    r"P\,\mathrm{d}' A = b": "it is unclear whether d is an operator",
    r"ACC = \frac{TP}{N}": "ACC is a word",
    r"A = \operatorname{Cl}^{3}(V)": "it is unclear whether the superscript of Cl is a mark or a power",
    r"Z = \int f\,dx\,dy": "it is unclear whether the factors after the differential are integrated",
    r"V = \iiint_D f(x, y, z)\,dx\,dy\,dz": "it is unclear whether the factors after the differential are integrated",
    r"W = \int F(r)\cdot d\vec r": "the integral is over a vector",
    r"\left(\begin{array}{cc|c}1 & 0 & j\\ 0 & 1 & k\end{array}\right) = A": "a vertical line divides the matrix",
    r"A = \Omega^T\Omega": r"it is unclear whether \Omega^T is transposed or has a power",
    r"f = \phi(\mathrm{Re}, \epsilon) + \frac{64}{\text{Re}}": "Re has no argument",
    r"\begin{aligned} a &= b \text{ where } c = d\\ &= e\end{aligned}": "a row continues one of several statements",
    r"p = \frac{dV}{dx}\Big|_{x = 0}": "a bar has no partner",
    r"Z = \int d^3r_1\,d^3r_2\,f": "the differential of the integral is not clear",
    r"U = \int\mathbf E\cdot\mathbf E\,\mathrm{d}^3\mathbf r": "the differential of the integral is not clear",
    r"\int_V\nabla\cdot\mathbf E\,dV = \int_V\nabla^2\phi\,dV": "the integral is not over one variable between two limits",
}  # fmt: skip


@pytest.mark.parametrize("latex", REFUSED)
def test_what_is_not_declared_is_refused_with_its_token(latex: str) -> None:
    assert said(latex) == f"stopped: {REFUSED[latex]}"


# A print, a table, the reading in it, and where the reading stops without it.
DECLARED = [
    (r"E = V(x + h)", {"functions": "V"}, "E = V(x + h)", "stopped: it is unclear whether V before ("),
    (r"E = K(1) + K(2)", {"functions": "K"}, "E = K(1) + K(2)", "stopped: it is unclear whether K before ("),
    (r"F = -V'(r)", {"functions": "V"}, "F = -Derivative(V(r), r)", "stopped: it is unclear whether V' before ("),
    (r"F = -V'", {"functions": "V"}, "F = -prime(V)", "F = -Vprime"),
    (
        r"F = -V''(r)",
        {"functions": "V"},
        "F = -Derivative(V(r), r, 2)",
        "stopped: it is unclear whether V'' before (",
    ),
    (r"x' = \gamma(x - vt)", {"functions": "V"}, "xprime = gamma*(x - v*t)", "xprime = gamma*(x - v*t)"),
    (r"y = V^2(r)", {"functions": "V"}, "y = V(r)**2", "stopped: it is unclear whether V^2 before ("),
    (
        r"r\times p = L",
        {"vectors": "r p L"},
        "cross(r, p) = L",
        "stopped: it is unclear whether × multiplies vectors or numbers",
    ),
    (
        r"\mathbf r\times\mathbf p = 0",
        {"vectors": "r p"},
        "cross(rbold, pbold) = 0",
        "stopped: it is unclear whether rbold is a vector or a matrix",
    ),
    (r"A^T = A", {"matrices": "A"}, "transpose(A) = A", "stopped: it is unclear whether A^T is transposed"),
    (r"A^{-1} B = C", {"matrices": "A B C"}, "matmul(inverse(A), B) = C", "A**(-1)*B = C"),
    (r"T(t_1) = a", {"functions": "T"}, "T(t_1) = a", "stopped: it is unclear whether T before ("),
    (
        r"\mathbf r' = O(t)\mathbf r",
        {"vectors": "r"},
        "stopped: it is unclear whether O(…) next to a factor",
        "stopped: it is unclear whether rbold",
    ),
    (r"L u = v", {"operators": "L"}, "stopped: L is an operator", "L*u = v"),
    (r"y = e^{-t}", {"numbers": "e"}, "y = exp(-t)", "stopped: it is unclear whether e is Euler's number"),
    (
        r"x = i\omega",
        {"numbers": "i"},
        "x = imaginary_unit*omega",
        "stopped: it is unclear whether i is the imaginary unit",
    ),
    (r"x = i\omega", {"indices": "i"}, "x = i*omega", "stopped: it is unclear whether i is the imaginary unit"),
    (r"y = x^\mu", {"positive": "mu"}, "y = x**mu", "stopped: it is unclear whether \\mu is an upper index or a power"),
    (r"y = x^k", {"indices": "k"}, "stopped: it is unclear whether k is an upper index or a power", "y = x**k"),
    (r"x = 1{,}500", {"decimal_comma": True}, "x = 3/2", "x = 1500"),
    (
        r"y = \delta(x)",
        {"functions": "delta"},
        "y = delta(x)",
        "stopped: it is unclear whether \\delta is a factor or an operator",
    ),
]


@pytest.mark.parametrize(("latex", "table", "reading", "without"), DECLARED)
def test_a_declared_letter_is_read_as_its_kind(latex: str, table: dict[str, str], reading: str, without: str) -> None:
    for notation, words in ((declared_notation(table), reading), (Notation(), without)):
        found = read_formula(latex, notation)
        text = f"stopped: {found.stop[0]}" if found.stop else ""
        text = text or " = ".join(text_of(side.node) for side in found.statements[0].sides)
        assert text.startswith(words)


def test_the_way_out_names_the_entry_of_the_table() -> None:
    for latex, entry in (
        ("E = K(1)", 'functions = "K"'),
        (r"\mathbf F = 0", 'vectors = "Fbold" or matrices = "Fbold"'),
        ("y = e^{t}", 'numbers = "e"'),
        ("A^T = B", 'matrices = "A"'),
    ):
        assert entry in read_formula(latex).stop[1]  # type: ignore[index]


# Formulas of a source, and the kinds that one sweep proposes.
SWEPT = [
    (("V(x) = k x^2", "F = -V'"), "functions V"),
    ((r"L(q, \dot q) = T", "x(t) = A"), "functions L"),
    (("E = V(x + h)", "x(0) = 1", "c(n + 1) = 0"), ""),
    ((r"m\ddot{\mathbf r} = \mathbf F + q\hat r",), "vectors rbold, vectors Fbold, vectors rhat"),
    ((r"\mathbf u = \mathbf A\mathbf x", r"\mathbf A = 0"), "vectors ubold, matrices Abold, vectors xbold"),
    ((r"R = \begin{pmatrix} a & b\\ c & d\end{pmatrix}",), "matrices R"),
    ((r"\vec L = \sum_{i=1}^n\vec r_i",), "vectors Lvec, indices i, vectors rvec"),
    ((r"\det(K - \omega^2 M) = 0",), "matrices K, matrices M"),
    ((r"x = a e^{-\gamma t}",), "numbers e"),
    ((r"x = a e^{i\omega t}", r"\sum_i x_i = 0"), "numbers e, numbers i, indices i"),
    ((r"x = a e^{-\gamma t}", "F = e E"), ""),
]


@pytest.mark.parametrize(("formulas", "kinds"), SWEPT)
def test_one_sweep_proposes_kinds_with_their_evidence(formulas: tuple[str, ...], kinds: str) -> None:
    found = propose(formulas)
    assert ", ".join(f"{each.kind} {each.symbol}" for each in found) == kinds
    assert all(each.evidence in formulas for each in found)


def test_declared_letters_win_over_proposals() -> None:
    proposals = [Proposal("functions", "V", "V(x) = 0"), Proposal("vectors", "Fbold", "")]
    notation = with_proposals(declared_notation({"positive": "V"}), proposals)
    assert (notation.functions, notation.vectors, notation.positive) == (frozenset(), {"Fbold"}, {"V"})


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"function": "V"}, "'function' is not a key"),
        ({"functions": ["V"]}, "functions is not text"),
        ({"vectors": "r", "matrices": "R r"}, "r is in vectors and in matrices"),
        ({"decimal_comma": "yes"}, "write true or false"),
    ],
)
def test_a_table_that_says_nothing_is_refused(table: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        declared_notation(table)


def test_an_order_that_is_claimed_is_kept() -> None:
    reading = read_formula(r"f = 1 + \epsilon + O(\epsilon^2)")
    assert reading.statements[0].order == ("epsilon", 2)
    assert text_of(reading.statements[0].sides[1].node) == "1 + epsilon"


def test_relations_part_equations_from_what_is_kept_aside() -> None:
    kinds = [read_formula(each).statements[0].kind for each in ("a = b", r"a \approx b", "a < b", r"x \to 0")]
    assert kinds == ["equation", "approximation", "inequality", "other"]


def test_sums_of_five_hundred_terms_are_read() -> None:
    latex = "S = " + " + ".join(f"a_{{{n}}} x^{{{n}}}" for n in range(1, 501))
    assert len(read_formula(latex).statements[0].sides[1].node.args) == 500  # type: ignore[union-attr]


def test_brackets_too_deep_and_numbers_too_long_are_refused_in_words() -> None:
    assert "too deep" in said("x = " + "(" * 500 + "a" + ")" * 500)
    assert "more than 1000 digits" in said(f"y = {'9' * 1001}")


def test_a_condition_is_a_statement_of_its_own() -> None:
    reading = read_formula(r"a = b\quad\text{for } x > 0")
    assert [each.kind for each in reading.statements] == ["equation", "condition"]


SIDES = {
    r"W + 3\Pi + \mathcal{M} = 0": r"W + 3\Pi + \mathcal{M}",
    r"{\bf k}_1 + {\bf k}_2 = 0": r"{\bf k}_1 + {\bf k}_2",
    r"{\bf \dot{x}} = {\bf c}": r"{\bf \dot{x}}",
    r"\mathscr {T} = \frac{f}{U}": r"\mathscr {T}",
    r"\boldsymbol\zeta = 2\mathbf y": r"\boldsymbol\zeta",
    r"\boldsymbol{\mathrm{\tau}} = I\boldsymbol{\alpha}": r"\boldsymbol{\mathrm{\tau}}",
    r"{x} + \mathbf y^2 = z": r"{x} + \mathbf y^2",
    r"{\partial L \over \partial\theta} = M": r"{\partial L \over \partial\theta}",
    r"m{\text{d}v \over \text{d}t} = F": r"m{\text{d}v \over \text{d}t}",
}


@pytest.mark.parametrize("latex", SIDES)
def test_a_side_keeps_its_braces_and_its_font(latex: str) -> None:
    assert (
        read_formula(latex, with_proposals(Notation(), propose([latex]))).statements[0].sides[0].latex == SIDES[latex]
    )
