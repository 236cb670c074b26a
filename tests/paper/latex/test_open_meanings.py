r"""A sign with a rival meaning is marked, and passes where the paper settles it: each pair has the paper's other formulas."""

from pathlib import Path

import pytest

from lagrotor.paper.latex.check import REFUTED, check_source
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.markup import read_source
from lagrotor.paper.latex.usage import declared_notation, notation_of


def guesses(latex: str, *paper: str, **said: str) -> tuple[str, ...]:
    return read_formula(latex, notation_of([latex, *paper], declared_notation(said))).guesses


def test_a_space_before_the_differential_of_an_integral_parts_no_list() -> None:
    assert not guesses(r"a = \int_0^b x^2 \;\mathrm{d} x")
    assert "what a space parts" in guesses(r"a = b \; c")[-1]


# A formula that is marked by itself, other formulas of a paper that settle it, and the words of the mark.
SETTLED = [
    (r"a = \Phi(b + c)", [r"\Phi(b) = c"], "Phi before ( is a factor"),
    (r"a = m(b + c)", ["m v = p"], "m before ( is a factor"),
    (r"a = \Gamma^2(b)", [], "Gamma(…) is a function or a product"),
    (r"a = c[n - 1]", [], "c before [ is a factor"),
    (r"a = F\{b + (c - d)\}", [], "F before { is a factor"),
    (r"a = X^{HF}", [], "the superscript of X is"),
    (r"a = u^{n+1}", [], "the superscript of u is a power"),
    (r"a = u^n", [], "the superscript of u is a power"),
    (r"a = \Phi^{-1} b", [], "is one over Phi"),
    (r"a = \mathbb{E} b", [], "no set or mean"),
    (r"a = b^*", [], "the superscript of b is part of the name"),
    (r"a = x'", ["K(x, x') = b"], "x with a prime"),
    (r"a = \hat H\psi", [], "H with a hat is a factor"),
    (r"a = \mathcal{L} y", [], "L is a factor"),
    (r"a = \{b\}", [], "encloses a factor"),
    (r"V = \{0\}", [], "encloses a factor"),
    (r"a = (5)", [], "enclose one sign"),
    (r"a = [1, 2]", [], "the brackets hold components"),
    (r"a = |S|", [], "no determinant"),
    (r"a = b\cdot c", [], "the dot multiplies"),
    (r"a = b_i c_i", [], "the index i is not summed over"),
    (r"a \sim b", [], r"\sim is read as ~"),
    (r"a \to b", [], r"\to is read as ->"),
    (r"a \overset{d}{=} b", [], "stands over ="),
    (r"a = \text{MSD}(b)", [], "MSD acts on what follows"),
    (r"a = \oint b\,dx", [], r"\oint is an integral"),
    (r"a = \int dx\, b", [], "what follows the differential"),
    (r"a = \nabla_k f", [], "the index of"),
    (r"p(a|b) = c", [], "parts what is given"),
    (r"y[n] = x", [], "no product"),
    (r"a = \int_0^1 x\,dx\,b", [], "what follows the differential"),
    (r"a = \int_0^1\frac{dx}{x} b", [], "what follows the differential"),
    (r"a = \Delta b", [], "Delta b is one quantity"),
    (r"|01\rangle = a|0\rangle", [], "list of labels"),
    (r"a = \frac{\delta S}{\delta q}", [], "the fraction with delta"),
    (r"a = QED\, b", [], "QED is a"),
    (r"\frac{dx}{dt} = \dot x", [], "are the same"),
    (r"a = \bar D_i\bar D_j b", [], "D is a factor"),
    (r"a = b_{,j}", [], "the comma in the index of b"),
    (r"a = b_{i,j}", [], "the comma in the index of b"),
    (r"R_{\alpha\beta;\gamma} = a", [], "the semicolon in the index of R"),
    (r"\theta\eta = -\eta\theta", [], "the factors commute"),
    (r"\phi\psi = c - \psi\phi", [], "the factors commute"),
    (r"a = \frac{\partial 2}{\partial x}", [], "the number above is differentiated"),
    (r"a = \int_0^1 b_\lambda(x) \rho(\lambda)\,d\lambda", [], "not integrated over"),
    (r"a = \Sigma x f(x)", [], "Sigma is a factor"),
    (r"a = E_t b", [], "E is a factor"),
    (r"a = m^M", [], "the superscript of m"),
    (r"a = \text{R[i] S[j]}", [], "the words R[i] S[j]"),
    (r"\hat n\cdot\hat m = \cos\theta", [], "the dot multiplies"),
    (r"x_i x_i = r^2", [], "the index i is not summed over"),
    (r"v_i = \epsilon_{ijk}\omega_j r_k", [], "the index j is not summed over"),
    (r"[\mathcal L] = 4", [], "encloses a factor"),
    (r"(\psi, Q\psi) = \sum_n a_n b_n", [], "the brackets hold components"),
    (r"f = \sqrt{\lambda}(T)", [], "enclose one sign"),
    (r"a = |AB|", [], "AB is a product"),
    (r"a = 1/nx", [], "what the slash divides by"),
    (r"\left| 01 \right> = a", [], "list of labels"),
    ("b = 000", [], "000 is a number"),
    (r"S = \left.\frac{\partial F}{\partial T}\right|_H", [], "held constant"),
    (r"a = (b - \Delta)c", [], "no Laplacian"),
    (r"a = (g g')^2", [], "g with a prime"),
    (r"a = GM/r", [], "GM is a product"),
    (r"a = cn(x, k)", [], "cn is a product"),
    (r"a = 2e-3", [], "no power of ten"),
    (r"a = \frac{D}{Dt}(b + c)", [], "a derivative is open"),
    (r"f = \frac{d\ln D}{d\ln a}", [], "a derivative is open"),
    (r"a = \mathbf{n}^T s\mathbf{n}", [], "a vector is equal to a number"),
    (r"v = \begin{pmatrix} a\ b\\ c\ d\end{pmatrix}", [], "what a space parts"),
    (r"a = (A - b)^{-1}", [], "no inverse matrix"),
    (r"G = O(3)", [], "no group"),
    (r"a = \begin{pmatrix} a & b & c\\ d & f & g\end{pmatrix}", [], "no 3j symbol"),
    (r"a = 1 \pm 2\,\mathrm{fm}", [], "the unit belongs"),
    ("y' = f(y)", [], "y with a prime"),
    (r"(\tilde\Delta - h)f = g", [], "no Laplacian"),
    ("J = A_{x,yx} - A_{y,xx}", [], "the comma in the index of A"),
    (r"\kappa = \frac{dz^2}{dt}", [], "the power above is differentiated"),
    (r"\kappa = dz^2/dt", [], "the power above is differentiated"),
    (r"\left\{\begin{array}{l} a = b\\ c = d\end{array}\right.", [], "the lines of the array are statements"),
    (r"\mathrm{d}f(a, b)/\mathrm{d}t = c", [], "the derivative is not taken there"),
    (r"r = \max|\lambda|", [], "max acts on all"),
    ("a = 001", [], "no row of digits"),
    (r"(\mathbf v\cdot\nabla_k)\mathbf u = \mathbf a", [], "has an index or a power"),
    (r"M\begin{pmatrix} a\\ b\end{pmatrix} = v", [], "M is a factor"),
    (r"u_{tt} = c u_{xx} + u", [], "the index of u is"),
    ("u_t + u u_x = 0", [], "the index of u is"),
    (r"\phi_x|_l = a", [], "held constant"),
    (r"a = 3\times 10^{-14}s", [], "s behind the number"),
    (r"a = 9.81\frac{m}{s^2}", [], "m behind the number"),
    (r"\lambda = 500 nm", [], "n behind the number"),
    (r"x = 5 \mu m", [], "mu behind the number"),
    (r"\Delta^2\Phi = 4\pi\rho", [], "no Laplacian"),
    (r"H\psi = E\psi", [], "H is a factor"),
    ("D f = g", [], "D is a factor"),
    (r"\left\langle a \left| H \right| b\right\rangle = c", [], "whether bars part a bra"),
    ("(D^2 - k^2) f = 0", [], "D is a factor"),
    (r"u(a, b) = 0\, t > 0", [], "what a space parts"),
    (r"W = e^{2\pi j/N}", [], "j is a letter"),
    (r"K_\mu L_\mu = 0", [], "the index mu is not summed"),
    (r"a = F^{n + 1/2} b", [], "half step"),
    ("P(D) y = b", [], "D is a number, and no derivative"),
    (r"a = \sum_{k\in EV(b)} c_k", [], "EV is a product"),
    (r"a = \ln 2 x", [], "the argument of ln"),
    (r"\rho = 1000\frac{kg}{m^3}", [], "k behind the number"),
    ("u_i n_i = 0", [], "the index i is not summed over"),
    (r"H(j\omega) = 1", [], "j is a letter"),
    (r"a = \triangle u", [], "no Laplacian"),
    (r"a = b\uparrow", [], "uparrow is a letter"),
    (r"\mathbf{T} = \mathbf{A}\mathbf{B}", [], "side by side are matrices"),
    (r"a = \mathbf{E}\cdot\mathbf{B}", [r"\mathbf{E}\times\mathbf{B} = \mathbf{S}"], "the dot multiplies"),
    ("i^2 = -1", [], "whether i is the imaginary unit"),
    (r"a = m^2(b + c)", ["m v = p"], "m before ( is a factor"),
    (r"u_t + f_x = 0", [], "the index of u is"),
    (r"\mathbf{u}_t + \mathbf{f}_x = 0", [], "the index of u is"),
    ("I_{xx} = a", [], "the index of I is"),
    (r"\frac{d\rho u}{a} = \frac{dE}{b}", [], "of the letter that follows it alone"),
    (r"d\frac{a}{b} = c", [], "no differential of what follows"),
    (r"\mathbf{d}\Omega = 0", [], "no differential"),
    ("0 < x, y < 1", [], "each bound holds"),
    (r"\dot q = q, H", [], "no components or arguments"),
    ("+ a = b", [], "begins with its sign"),
    ("x = 3 - 5", [], "no ends of a range"),
    (r"\boldsymbol{\eta}\cdot\mathbf{J} = \mathbf{E}", [], "neither is a matrix"),
    ("a = b, c > 0", [], "no condition of it"),
    (r"a = b \Rightarrow c = d", [], "both are meant"),
    (r"S = \frac{T N}{T N + F P}", [], "TN is a product"),
    (r"\lim_{n\to\infty} a_n + b_n = c", [], "the lim is of the term"),
    (r"a = \sum_{i=1}^n b_i + c", [], "the sum is of the term"),
    (r"\begin{aligned} 0 = u + v \\ -u = v\end{aligned}", [], "continues what stands just before"),
    (r"a = \mathrm{F} b", [], "no unit or operator"),
    (r"a = \sum_{i\ne j} b_{ij}", [], "what sum runs over"),
    (r"a = \begin{pmatrix} n\\ k\end{pmatrix}", [], "binomial"),
    (r"a = \partial_i b", [], "what it differentiates by"),
    (r"y = \exp(-3x) \text{ } z = \exp(x)", [], "what a space parts"),
    (r"R = 4.84 \, \Omega", [], "Omega behind the number"),
    (r"E_k = m v \, E_p = m g h", [], "no left side"),
    ("a = 1^2S_{1/2}", [], "no sign of a term"),
    (r"E = \frac{a}{2}\,\mathrm{eV}", [], "no unit or operator"),
    (r"\partial_t u(x, 0) = 0", [], "is not taken there"),
    (r"\frac{\partial u(0, t)}{\partial x} = 0", [], "is not taken there"),
    (r"a = \frac{1}{|c|}", [], "number of elements"),
    (r"\frac{d}{dx}\left.\frac{f}{x}\right|_{x = a} = 0", [], "taken at a place"),
    (r"\frac{\partial F(m_0)}{\partial m} = 0", [], "is not taken there"),
    (r"a = \frac{d}{dx} 1 - b", [], "of the number that follows it alone"),
    (r"R(\theta)\vec F = m\vec a", [], "R of its argument is a number"),
    (r"P = p_1 p_2\cdots p_n", [], "the dots stand for factors"),
    (r"M = (a_{11} \dots)", [], "dots stand for factors"),
    (r"c = e^{-i\Delta t/2}", [], "Delta t is one quantity"),
    (r"T_{ijkl} = -T_{jikl} \text{ and } T_{ijij} = 0", [], "an index of T is not summed over"),
    (r"a = b - \underbrace{c + d}_{f}", [], "as if brackets stood around it"),
    (r"a = \underbrace{b + c}_{f} d", [], "as if brackets stood around it"),
    (r"R = 377\,\mathrm{\Omega}", [], "Omega is no unit"),
    (r"t = 3\,\mathrm{us}", [], "us behind the number"),
    (r"\Phi = e^{At}", [r"A = \frac{3}{2}"], "A is a number, and no operator"),
    ("L u = v", [], "L is a factor of what follows"),
    (r"m = gx_1 c", ["x_1 = b", "g = 2"], "gx is a product"),
    (r"B = (z - b) y(z)\big|_{z = b}", [], "the bar is of what stands just before it"),
    ("I = 540.000", [], "parts no thousands"),
    ("F/m", [], "the letters are a quantity"),
    (r"h = 1.05\times 10^{-34} J-s", [], "J behind the number"),
    (r"E = 0.5(\frac{3}{30})^2 J", [], "J behind the number"),
    ("sk = s", [], "sk is a product"),
    (r"\sigma = \binom{1234}{1423}", [], "and no permutation"),
    (r"\cos x\approx 1,\quad x\ll 1", [], "and no condition"),
    (r"\frac{x}{a}\le 1,\quad x\ge 2", [], "and no condition"),
    (r"\varphi = 0, y = \pm 1", [], "the value of an argument"),
    (r"|\psi\rangle = d_{ab} |a\rangle |b\rangle", [], "the index a is not summed over"),
    (r"\int_A x^2 d\lambda_1 < \infty", [], "and no measure"),
    ("A(n) = 1, n = 0", [], "the value of an argument"),
    (r"\forall c", [], "what holds for all"),
    (r"a > b > \cdots", [], "the dots at the end"),
    ("A(q) y(t) = u(t)", [], "what is of q or z"),
    (r"a = v\div r", [], "/ has its usual meaning"),
    (r"a = A_{2,x} - A_{1,y}", [], "the comma in the index of A"),
    (
        r"\frac{\partial x_i}{\partial y_{0k}}\frac{\partial y_{0k}}{\partial x_j} = \delta_{ij}",
        [],
        "the index k is not summed",
    ),
]


@pytest.mark.parametrize(("latex", "paper", "words"), SETTLED)
def test_what_has_a_rival_is_marked_until_the_paper_settles_it(latex: str, paper: list[str], words: str) -> None:
    alone = read_formula(latex, notation_of([latex]))
    said = alone.guesses if alone.stop is None else alone.stop
    assert any(words in each for each in said), said
    if paper:
        assert not guesses(latex, *paper)


def test_digits_in_groups_are_one_number() -> None:
    assert not guesses(r"12! = 479\,001\,600")


@pytest.mark.parametrize(
    ("latex", "paper", "words"),
    [
        ("a = b x", r"b^\top = C", "b is a factor"),
        (r"a = \bar z", r"b = e^{i c}", "no conjugate"),
        (r"\dot x = a", r"\frac{dx}{d\tau} = b", "its rate in t"),
        (r"a = \left(\frac{b}{p}\right)", r"b \equiv 1 \pmod{p}", "symbol of Legendre"),
        ("a = x^2", r"x^\mu = b", "is a power, and no index"),
        ("w_r = a", "w(r, s) = b", "the index of w is"),
        ("w_r = a", r"\frac{\partial w}{\partial r} = b", "the index of w is"),
        (r"y = e^{-a}", "a = 1 - e", "e is Euler"),
        ("a = b c", r"[b, c] = 1", "b is a factor"),
        ("a = m v", r"|\psi\rangle = 0", "m is a factor"),
        ("a = m v", r"\hat H = 0", "m is a factor"),
        (r"x = \gamma(1, \beta)s", r"E = \gamma m", "gamma before ( is a function"),
        (r"f = \Omega(g)", "f = O(g)", "no order of magnitude"),
        (r"a = \nabla^2 f", r"(\nabla g)^T b = c", "no matrix of second derivatives"),
        (
            r"a = \frac{dt}{dx}",
            r"\frac{\partial f}{\partial t} + c\frac{\partial f}{\partial x} = 0",
            "quotient of two steps",
        ),
    ],
)
def test_another_use_in_the_paper_is_a_rival(latex: str, paper: str, words: str) -> None:
    assert not guesses(latex)
    assert any(words in each for each in guesses(latex, paper))


@pytest.mark.parametrize(
    ("latex", "paper"),
    [
        ("v = c x", r"\vec x = \begin{pmatrix} a\\ b\end{pmatrix}"),
        ("v = c x", r"\vec x^T\vec y = 0"),
        ("v = c t", r"t \in [0, t]"),
        ("v = c x", r"\det(A - c I) = \det\begin{pmatrix} x & 0\\ 0 & x\end{pmatrix}"),
        ("v_x = a", r"|\vec v| = 1"),
        ("a = b - x'", "K(x, x') = c"),
    ],
)
def test_what_only_looks_like_another_use_is_no_rival(latex: str, paper: str) -> None:
    assert not guesses(latex, paper)


def test_e_with_one_letter_above_may_be_a_vector_of_a_basis() -> None:
    assert any("no vector of a basis" in each for each in guesses("a = e^b", "e^{c t} = k", "e_b = c"))
    assert not guesses("a = e^b", "e^{c t} = k")


def test_a_dot_beside_a_letter_with_upper_indices_may_join_four_vectors() -> None:
    assert any("the dot" in each for each in guesses(r"a = p\cdot q", r"\vec x = 0", r"p^\mu q_\mu = b"))
    assert not guesses(r"a = 2\cdot q", r"\vec x = 0", r"p^\mu q_\mu = b")


def test_lists_of_a_differential_equation_make_no_names_of_primes() -> None:
    assert any("y with a prime" in each for each in guesses("a = b + y'", "F(x, y, y') = 0", "y'' = y", "y(x) = c"))


def test_a_factor_of_another_function_s_value_settles_nothing() -> None:
    assert any("k before ( is a factor" in each for each in guesses("a = k(x + b)", "V(x) = k c"))


@pytest.mark.parametrize(
    "shown",
    [
        r"b = \frac{c}{2H}",
        "b = c/H",
        r"b = \sqrt{H c}",
        r"b = \sin H",
        r"b = \ln(H c)",
        "H = 2.5",
        "H = m v + c",
        r"\frac{dS}{dH} = c",
    ],
)  # fmt: skip
def test_a_capital_before_a_factor_is_a_number_where_the_paper_shows_it(shown: str) -> None:
    assert any("H is a factor of what follows" in each for each in guesses("a = H x"))
    assert not guesses("a = H x", shown)


@pytest.mark.parametrize(
    "other",
    ["b = c H", r"b = \frac{1}{z - H}", r"b = e^{-H c}", "H = 1", "H = D y", r"H = \frac{d}{dx}", r"\frac{dH}{dt} = b"],
)
def test_where_an_operator_can_stand_nothing_is_shown(other: str) -> None:
    assert guesses("a = H x", other)


@pytest.mark.parametrize(
    "latex",
    [
        r"m\ddot x = -k x", r"T = \frac12 m v^2", r"x(t) = A\cos(\omega t + \phi)", r"\vec F = m\vec a",
        r"\frac{d}{dt}\frac{\partial L}{\partial\dot q} = \frac{\partial L}{\partial q}", r"E = e^{-\beta a}",
        r"\sum_{i=1}^n m_i v_i = p", r"\int_0^1 x^2\,dx = \frac13", r"\langle\phi|\psi\rangle = 0", r"|a - b| \le c",
        r"R = \begin{pmatrix} \cos\theta & -\sin\theta\\ \sin\theta & \cos\theta\end{pmatrix}", r"a = 5\ \text{km}",
        r"(a + b)(a - b) = a^2 - b^2", r"f(x, y) = x + y", r"p_i = m_i v_i", r"(\nabla^2 + k^2) p = 0",
        r"\int_0^1 f(x)\,dx + \int_0^1 g(x)\,dx = \int_0^1\frac{dx}{x}", r"a = \int_V \rho\,dV", r"\vec r = x\vec e_x",
        r"k = 0.4\,\mathrm{cm}^2\,\mathrm{g}^{-1}", r"{\rm cos} x = a", r"\mathrm{d}(x^2) = 2x\,\mathrm{d}x",
        r"\tau = \mu\frac{du}{dy}\bigg|_{y=0}", "a = 540.001", r"a = \underbrace{b + c}_{f} + d",
        r"p = \frac{F}{m}", "V_1 = V_{1,2} + V_{1,3}",
        "E = 0.5 - s", r"F = \frac{2s-3}{s^2}", r"0 < x < a,\quad 0 < y < b", r"a = \binom{10}{3}", "x = 3, y = 4",
        r"E = \int_A I(\lambda) d\lambda", r"1 = \sum_n |n\rangle\langle n|",
        r"M(q)\ddot q(t) = u(t)", "u(x, t) = X(x) T(t)",
        r"\theta\eta = -\theta\phi", r"R_{\alpha\beta\gamma} = a", r"a = \int_0^1 b_\lambda(x) \rho(x)\,dx",
    ],
)  # fmt: skip
def test_what_has_no_rival_is_read_without_a_mark(latex: str) -> None:
    assert not guesses(latex)


def test_evidence_elsewhere_in_a_paper_is_none_for_an_operator_a_coefficient_or_a_name() -> None:
    assert guesses("L u = v", r"a = \frac{b}{L}") and not guesses("L u + b = v", r"a = \frac{b}{L}")
    assert guesses(r"\xi_4(P)", r"\xi_4 P = b", r"a = \frac{b}{P}") and not guesses(r"\xi_4(P)")
    assert guesses("m = gx_1 c", "x = b", "g = 2"), "gx is a name wherever x has an index"
    assert guesses(r"y = \lambda_max", "a x = b") and not guesses(r"y = \lambda_m ax", "a x = b")


def test_a_dot_is_of_numbers_where_the_paper_prints_its_vectors() -> None:
    chain = r"a = \frac{dy}{du}\cdot\frac{du}{dx}"
    assert guesses(chain) and not guesses(chain, r"\vec F = \vec G")
    assert guesses(chain, r"\vec y = \vec G") and guesses(chain, r"\vec F = \vec G", r"p^\mu = 0"), (
        "vectors, four-vectors"
    )


def test_a_bound_is_a_number_and_a_composition_is_no_factor() -> None:
    assert guesses("a = N b") and not guesses("a = N b", r"c = \sum_{i=1}^N x_i")
    assert guesses(r"E(\phi(E)) = E", r"\phi(E) = a", r"b = \frac{a}{E}", "b = E a")


def test_a_function_of_another_argument_than_the_paper_shows_may_be_a_factor() -> None:
    (mark,) = guesses(r"E = \omega(n + 1)", r"\omega(k) = c k")
    assert "omega before ( is a function" in mark
    assert not guesses(r"E = \omega(k + 1)", r"\omega(k) = c k")


def test_a_mark_says_what_is_read() -> None:
    assert [mark.partition(" ([")[0] for mark in guesses(r"T = 20^\circ C")] == [
        "C behind a degree sign is a scale of temperature"
    ]


def test_the_line_that_a_mark_names_settles_it() -> None:
    latex = r"a = \Phi(b + c)"
    (mark,) = guesses(latex)
    assert mark.endswith('([notation] functions = "Phi" or letters = "Phi")')
    assert not guesses(latex, letters="Phi") and not guesses(latex, functions="Phi")
    assert guesses("a = x'")[0].endswith('([notation] usual = "prime")') and not guesses("a = x'", usual="prime")


@pytest.mark.parametrize("latex", [row[0] for row in SETTLED])
def test_each_mark_is_settled_by_its_line(latex: str) -> None:
    for mark in guesses(latex):
        key, _, names = mark.rpartition("([notation] ")[2].rstrip(")").split(" or ")[0].partition(" = ")
        after = read_formula(latex, notation_of([latex], declared_notation({key: names.strip('"')})))
        assert after.stop is not None or mark not in after.guesses, mark


def test_no_verdict_rests_on_a_marked_reading(tmp_path: Path) -> None:
    file = tmp_path / "paper.tex"
    verdicts = []
    for latex in (r"y = a(b + c) = ab - ac", r"y = (a)(b + c) = ab - ac"):
        file.write_text(rf"\documentclass{{article}}\begin{{document}}\[ {latex} \]\[ a b = d \]\end{{document}}")
        verdicts.append([each.verdict for each in check_source(read_source(file)) if each.step])
    assert verdicts == [[REFUTED], ["undecided"]]


def test_a_letter_before_brackets_alone_is_shown_to_be_no_factor() -> None:
    latex = "a = b_k y(n - k)"
    assert guesses(latex)
    assert not guesses(latex, "y b = 2")


@pytest.mark.parametrize(
    "latex", [r"H = \sum_{\langle ij\rangle} s_i s_j", r"Z = \sum_{s\in\{0,1\}} e^{-\beta s}", r"s \in \{0,1\}"]
)
def test_pairs_and_sets_are_no_means_brackets_or_names(latex: str) -> None:
    assert [mark.partition(" ([")[0] for mark in guesses(latex)] in (
        ["what sum runs over is as it is written"],
        [r"\in is read as in"],
    )


def test_what_is_no_letter_of_the_formula_has_no_mark_of_its_scripts() -> None:
    """The order of a derivative is no power of its variable; elsewhere the letter may have an index above."""
    assert guesses(r"\frac{\partial^2 f}{\partial x^2} = a", "x^1 = b") == ()
    assert any("no index" in each for each in guesses("a = x^2", "x^1 = b"))
