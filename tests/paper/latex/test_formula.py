r"""Readings: what is printed is what is read, what may mean two things is not read, and every guess is named."""

import pytest

from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.tree import text_of
from lagrotor.paper.latex.usage import declared_notation, notation_of


def said(latex: str, *others: str, **notation: str) -> str:
    """The statements as text; what stopped the reading where there are none."""
    reading = read_formula(latex, notation_of([latex, *others], declared_notation(notation)))
    if reading.stop is not None:
        return f"stopped: {reading.stop[0]}"
    return "; ".join(" = ".join(text_of(side.node) for side in s.sides) for s in reading.statements)


READ = {
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
    r"x = 1{,}000 + 0{,}25 + 3.2\times10^{-5}": "x = 1000 + 1/4 + 16/5*10**(-5)",
    r"g = 9.81\,\mathrm{m/s^2}": "g = 981/100*unit_m*unit_s**(-2)",
    r"y = \sin^2\theta + \sin 2\theta\cos\phi": "y = sin(theta)**2 + sin(2*theta)*cos(phi)",
    r"y = \sin\theta\,\dot\theta": "y = sin(theta)*theta_dot",
    r"x^{(1)} = l_1^2 + x'": "x__1 = l_1**2 + xprime",
    r"n = \sqrt[3]{5} + \sqrt{a+b} + \frac12": "n = 5**(1/3) + sqrt(a + b) + 1/2",
    r"f = \begin{cases} 1 & x<0\\ 2 & \text{else}\end{cases}": "f = cases(case(1, Lt(x, 0)), case(2, otherwise))",
    r"A = \begin{pmatrix} a & b\\ c & 0\end{pmatrix}": "A = matrix(row(a, b), row(c, 0))",
    r"\left.\frac{\partial V}{\partial x}\right|_{x=0} = 0": "at(Derivative(V, x), x, 0) = 0",
    r"x = a,\qquad y = b \quad\text{where } z = c.": "x = a; y = b; z = c",
    r"\begin{aligned} a &= b\\ &\quad + c\\ &= d\end{aligned}": "a = b + c = d",
    r"\alpha = 30^\circ": "alpha = 30*pi/180",
    r"x = \ln\cosh\left(\frac{g t}{v}\right) + \sin\arccos y": "x = log(cosh(g*t/v)) + sin(acos(y))",
    r"a = \varDelta x + \varGamma": "a = Delta_x + Gamma",
    r"P \equiv \frac{\hbar}{i}\frac{\partial}{\partial x}": "P = hbar/imaginary_unit*operator_derivative(x)",
    r"H = -\frac{d^2}{dx^2} + V(x)": "H = -operator_derivative(x, 2) + V(x)",
    r"\mathbf p = -i\hbar\nabla,\quad T = -\nabla^2":
        "pbold = -imaginary_unit*hbar*operator_gradient(); T = -operator_laplacian()",
    r"a = b\left(\frac{\partial}{\partial x} + c\right)": "a = b*(operator_derivative(x) + c)",
    r"[x, \partial_x] = -1": "commutator(x, operator_derivative(x)) = -1",
    r"\partial_x = \frac{\partial r}{\partial x}\partial_r": "operator_derivative(x) = Derivative(r, x)*operator_derivative(r)",
    r"\frac{d}{dt} = \frac{\partial}{\partial t} + (\mathbf u\cdot\nabla)":
        "operator_derivative(t) = operator_derivative(t) + operator_advection(ubold)",
    r"\mathbf u\cdot\nabla\mathbf u = \mathbf a": "advection(ubold, ubold) = abold",
    r"\left(\frac{d\mathbf B}{dt}\right)_I = \mathbf C + \mathbf D": "at_constant(Bbold_dot, I) = Cbold + Dbold",
    r"\frac{\text{d}x}{\text{d}t} = \int f\,\text{d}x + x_\text{d}": "x_dot = Integral(f, x) + x_d",
    r"\frac{\partial^{} r}{\partial u^{}} = 1": "Derivative(r, u) = 1",
    r"Z = \sum_{s\in\{-1,1\}} f(s)": "Z = Sum(f(s), In(s, set(-1, 1)))",
    r"\left\{\begin{aligned} \dot x &= y\\ \dot y &= -x\end{aligned}\right.": "x_dot = y; y_dot = -x",
    r"H(q,p) = p\dot q - L(q,\dot q)": "H(q, p) = p*q_dot - L(q, q_dot)",
    r"\frac{dx/dt}{2} = \partial_x u": "x_dot/2 = Derivative(u, x)",
    r"f^{(4)}(x) = f(x)": "f__4(x) = f(x)",
    r"y = \dot x' + \theta'_1": "y = xprime_dot + thetaprime_1",
    r"y = x_1 - 2 + a \cdot 2": "y = x_1 - 2 + a*2",
    r"y = 2\frac{a}{b}": "y = 2*(a/b)",
    r"y = k(x - x_0)": "y = k*(x - x_0)",
    r"\mathbf{J = \frac{\nabla\times B}{2}}": "Jbold = curl(Bbold)/2",
    r"y = a\underbrace{- b}_{c}": "y = a - b",
    r"I = 5\,\mathrm{~mm}^4 + 6\,\mathrm{m/s}^2": "I = 5*unit_mm**4 + 6*unit_m*unit_s**(-2)",
    r"\vec v\cdot\operatorname{grad}(a + b) = 0": "dot(vvec, grad(a + b)) = 0",
    r"\mathbf u = \mathbf b^T e^{\mathbf A t}\mathbf C\mathbf d": "ubold = matmul(transpose(bbold), exp(Abold*t), Cbold, dbold)",
    r"\begin{cases} \dot x = y & x_0 = a\\ \dot y = -x & y_0 = b\end{cases}": "x_dot = y; x_0 = a; y_dot = -x; y_0 = b",
    r"\begin{cases} x = a & + b\\ y = c\end{cases}": "x = a + b; y = c",
    "n = 0, 1, ..": "n = values(0, 1, dots())",
    r"a \overset{!}{=} b": "a = b",
    r"y = (\vec a\times\vec b)\cdot\hat{\mathbf n}": "y = dot(cross(avec, bvec), nboldhat)",
    r"\vec F = F\hat{\mathbf r}": "Fvec = F*rboldhat",
    r"\vec F = 0": "Fvec = 0",
    r"x = 1{,}5,\quad n = 1, 2": "x = 3/2; n = values(1, 2)",
    r"a = b \text{ and } c = d": "a = b; c = d",
    r"{a + b \over c} = {n \choose k}": "(a + b)/c = binomial(n, k)",
    r"\nabla\cdot\vec E = \frac{\rho}{\epsilon_0}": "divergence(Evec) = rho/epsilon_0",
    r"\nabla\times(\nabla\times\mathbf E) = \mathbf F": "curl(curl(Ebold)) = Fbold",
    r"y = \ln|x| + \sin n\pi": "y = log(Abs(x)) + sin(n*pi)",
    r"m\,d^2x/dt^2 = -\partial V/\partial x": "m*x_ddot = -Derivative(V, x)",
    r"a = b\qquad (c > 0)": "a = b; c = 0",
    r"y = \dot{\bar x} + \bar{\dot x} + \dot{\ddot x}": "y = xbar_dot + xdotbar + x_dddot",
    r"N = 6.02\times 10^{23}\,\text{mol}^{-1} = 2\,\text{J kg}^{-1}": "N = 301/50*10**23*unit_mol**(-1) = 2*unit_J*unit_kg**(-1)",
    r"p = \text{R}_{\text{u}} T_\text{rot.} + W_{1\to 2}": "p = R_u*T_rot + W_1to2",
    r"\frac{\partial L}{\partial(\partial_x\phi)} = \frac{\partial L}{\partial\,\partial_x\phi}":
        "Derivative(L, Derivative(phi, x)) = Derivative(L, Derivative(phi, x))",
    r"y = \int d\ln m\,f(m), \quad n = 0, \frac12, 1...": "y = Integral(f(m), log(m)); n = values(0, 1/2, 1, dots())",
    r"|a\rangle = |b\rangle + c|d\rangle": "ket(a) = ket(b) + matmul(c, ket(d))",
    r"(ds)^2 = g_{\mu\nu}\mathrm{d}x^\mu\mathrm{d}x^\nu":
        "differential(s)**2 = contraction(g_mu_nu, differential(x__mu), differential(x__nu))",
    r"\rho = 46\,\mathrm{\Omega\,cm}": "rho = 46*unit_Ohm*unit_cm",
    r"T = 25^\circ\mathrm{C} = 77^\circ\text{F}": "T = 25*unit_degC = 77*unit_degF",
    r"c = (v_i)_n": "c = component(v_i, n)",
    r"\ddot x + x = A\text{ cos }(t)": "x_ddot + x = A*cos(t)",
    r"\begin{aligned} a &= b = \\ &= c\end{aligned}": "a = b = c",
    r"a = b, \\ = c": "a = b = c",
    r"\begin{aligned}\begin{cases} a = b\\ c = d\end{cases}\end{aligned}": "a = b; c = d",
    r"y = \begin{cases} a & 0 \le t \le T\\ b & t > T\end{cases}":
        "y = cases(case(a, And(Le(0, t), Le(t, T))), case(b, Gt(t, T)))",
    r"y = \left.\frac{\partial a}{\partial x}\right|_i": "y = at(Derivative(a, x), i)",
    r"x = a_1 \cdots a_n": "x = a_1*dots()*a_n",
    r"y = \mathrm{e}^{im\phi} + i": "y = exp(imaginary_unit*m*phi) + imaginary_unit",
    r"c = (AB)_{ik}": "c = component(A*B, ik)",
    r"\overline{\vec u\times\vec v} = \vec a": "bar(cross(uvec, vvec)) = avec",
    r"y = {\rm cos}[x - a]": "y = cos(x - a)",
    r"n = 1,2,3,\ldots": "n = values(1, 2, 3, dots())",
    r"H|n\rangle = E_n|n\rangle": "matmul(H, ket(n)) = matmul(E_n, ket(n))",
    r"c = \langle n|H|m\rangle": "c = braket(n, H, m)",
    r"p = \left.\frac{dV}{dx}\right|_{x = 0}": "p = at(Derivative(V, x), x, 0)",
    r"p = \frac{dV}{dx}\Big|_{x = 0}": "p = at(Derivative(V, x), x, 0)",
    r"ds^2 = dx^2 + dy^2": "differential(s)**2 = differential(x)**2 + differential(y)**2",
    r"y = (2n)!! + n!": "y = double_factorial(2*n) + factorial(n)",
    r"y = |a||b|": "y = Abs(a)*Abs(b)",
    r"p = \text{const}\qquad (t > 0)": "p = const; t = 0",
    r"y = 4\pi\left(\frac{m}{k}\right)^{3/2}": "y = 4*pi*(m/k)**(3/2)",
    r"V = \iiint_D f(x, y, z)\,dx\,dy\,dz": "V = Integral(f(x, y, z), volume(x, y, z), over_D)",
    r"\int |z\rangle\langle z|\,dz = 1": "Integral(matmul(ket(z), bra(z)), z) = 1",
    r"f = \int g(\vec s)\,\mathrm{d}^{\,3}\vec s": "f = Integral(g(svec), differential(svec, 3))",
    r"Z = \int d^3r_1\,d^3r_2\,f": "Z = Integral(f, volume(differential(r_1, 3), differential(r_2, 3)))",
    r"\int_V\nabla\cdot\mathbf E\,dV = \int_V\nabla^2\phi\,dV":
        "Integral(divergence(Ebold), V, over_V) = Integral(laplacian(phi), V, over_V)",
    r"U = \int\mathbf E\cdot\mathbf E\,\mathrm{d}^3\mathbf r": "U = Integral(dot(Ebold, Ebold), differential(rbold, 3))",
    r"\langle x, y\rangle = n\langle v\rangle_{p}": "inner(x, y) = n*mean_p(v)",
    r"|\psi\rangle_A = \left|0\right>": "ket_A(psi) = ket(0)",
    r"L_3 = (\mathbf r\times\mathbf p)_3": "L_3 = component(cross(rbold, pbold), 3)",
    r"\langle p|q\rangle = \delta^3(\mathbf p - \mathbf q)": "braket(p, q) = delta__3(pbold - qbold)",
    r"\partial_\mu\chi = A_\mu": "Derivative(chi, x__mu) = A_mu",
    r"\mathbf B = \nabla\wedge\mathbf A": "Bbold = curl(Abold)",
    r"E = a + b.\\": "E = a + b",
    r"S = \sum_{i\in N} a_i + \sum_{\text{spins}} b": "S = Sum(a_i, In(i, N)) + Sum(b, all_spins)",
    r"\overline{u + v} = \vec{\vec\sigma} - \vec\sigma": "bar(u + v) = sigmavecvec - sigmavec",
    r"I = \int dx\,(x + 1)": "I = Integral(x + 1, x)",
    r"G = \int\frac{dE}{2\pi} f(E, x)": "G = Integral(1/(2*pi)*f(E, x), E)",
    r"m = 0, \pm 1, \pm 2, ...": "m = values(0, plus_minus(1), plus_minus(2), dots())",
    r"n = \frac{1}{e^{-\infty} + 1}": "n = 1/(exp(-oo) + 1)",
    r"t = \text{tr}(A) + \sum_{ij} a_{ij}": "t = tr(A) + Sum(a_ij, i, all, all, j)",
    r"\mathrm{d}x\mathrm{d}y\mathrm{d}z = \mathrm{d}V\mathrm{d}s\mathrm{d}t":
        "differential(x)*differential(y)*differential(z) = differential(V)*differential(s)*differential(t)",
    r"(\nabla^2 + k^2) p = 0": "laplacian(p) + k**2*p = 0",
    r"\left(i\hbar\frac{\partial}{\partial t} - V\right)\psi = 0": "imaginary_unit*hbar*Derivative(psi, t) - V*psi = 0",
    r"\left(\frac{\partial}{\partial t} + \vec u\cdot\nabla\right) \vec u = \vec g":
        "Derivative(uvec, t) + advection(uvec, uvec) = gvec",
    r"(\partial_t - c\partial_x)(\partial_t + c\partial_x) u = 0":
        "Derivative(Derivative(u, t) + c*Derivative(u, x), t) - c*Derivative(Derivative(u, t) + c*Derivative(u, x), x) = 0",
    r"(1 - \nabla^2) u v = f": "1*u*v - laplacian(u*v) = f",
    r"(\Box + m^2)\phi = 0": "dalembertian(phi) + m**2*phi = 0",
    r"\nabla_{\mathbf k}\cdot\mathbf A = 0": "divergence(Abold, kbold) = 0",
    r"\partial_\mu J^\mu = 0": "contraction(Derivative(J__mu, x__mu)) = 0",
    r"\partial_\mu F^{\mu\nu} = J^\nu": "contraction(Derivative(F__mu__nu, x__mu)) = J__nu",
    r"\dot f + v^i\frac{\partial f}{\partial x^i} = 0": "f_dot + v__i*Derivative(f, x__i) = 0",
    r"T^{ij} = S^{ij}": "T__i__j = S__i__j",
    r"S[f] = a": "S(f) = a",
    r"y[n] = x[n] - a x[n-1]": "y(n) = x(n) - a*x(n - 1)",
    r"p(a|b) = \frac{p(b|a)p(a)}{p(b)}": "p(a, given(b)) = p(b, given(a))*p(a)/p(b)",
    r"E^{\omega,\mathrm i} = r^{\mathrm a}": "E__omega__i = r__a",
    r"\mathbf v^\Sigma = \mathbf u": "vbold__Sigma = ubold",
    r"Z = \int f\,dx\,dy": "Z = Integral(f, volume(x, y))",
    r"k = 0.4\,\mathrm{cm}^2\,\,\mathrm{g}^{-1}": "k = 2/5*unit_cm**2*unit_g**(-1)",
}  # fmt: skip


@pytest.mark.parametrize("latex", READ)
def test_what_is_read_is_what_is_printed(latex: str) -> None:
    assert said(latex) == READ[latex]


# What may mean two things, and where the reading stops.
OPEN = {
    r"\frac{d}{dx} x - x\frac{d}{dx} = 1": "whether a derivative acts on what follows it or is an operator",
    r"\nabla = \frac{\partial}{\partial x}\mathbf{i}": "whether a derivative acts on what follows it or is an operator",
    r"a = \frac{\partial}{\partial t}\times\mathbf B": "the derivative has nothing to act on",
    r"\mathbf a = \mathbf u\cdot\nabla f\mathbf v": "∇ of a vector is not read",
    r"a = \mathbf u\cdot\nabla\mathbf v\cdot\mathbf w": "how far ∇ reaches",
    r"(\nabla\cdot\mathbf v + \partial_t) f = 0": "how far ∇ reaches is open",
    r"y = \arg\max f": "the argument of arg is not clear",
    r"E = \sum_{pq} h^p_q a_p": "whether p is an upper index or a power",
    r"a = \mathbf e\cdot\mathbf H\cdot\mathbf p": "which · comes first",
    r"a = s^2[R]": "whether s[…] is a functional",
    r"\partial_i f = x^i y^{i + 1}": "whether i is an upper index or a power",
    r"\partial_k f = \sum_k a_k x^k": "whether k is an upper index or a power",
    r"y = (a + b)'": "a prime stands behind what is no letter",
    r"y = \frac{a}{b}'": "a prime stands behind what is no letter",
    r"y = \sin^\prime x": "a prime stands behind what is no letter",
    r"y = \sqrt{x}_1": "has an index",
    r"y = \binom{n}{k}_q": "has an index",
    r"y = \overset{\circ}{A}": "sets a mark on what is no relation",
    r"y = x_{1}2": "a number stands behind a letter",
    r"y = x^12": "a number stands behind a letter",
    r"y = \sqrt 12": "a number stands behind a letter",
    r"y = 1\frac12": "whether a mixed number or a product is meant",
    r"y = 0,5": "whether the comma is in a number",
    r"y = 1,000": "whether the comma is in a number",
    r"a b, c = 0": "what stands before the comma has no relation",
    r"\vec a\times\vec b\times\vec c = 0": "which × comes first",
    r"\vec F = m a": "a vector is equal to a number",
    r"a = b \text{ but not } c = d": "the words deny what they join",
    r"f(x) = \begin{cases} 1 & x \to 0\\ 2 & x > 1\end{cases}": "the condition of a case is not read",
    rf"y = {'9' * 1001}": "a number has more than 1000 digits",
    r"y = \sin x y": "where the argument of sin ends",
    r"y = \sin\theta^2": "whether the power is of the argument",
    r"y = \sin(\theta)^2": "",
    r"k = \frac{1}{c} v\times H": "whether × is of vectors or of numbers",
    r"k = 2 v\times H": "whether × is of vectors or of numbers",
    r"y = \begin{cases} 0 & x < 0 \text{ or } x > L\\ 1 & x = 0\end{cases}": "the condition of a case is not read",
    r"n = (a)_{r}": "a bracket has an index",
    r"y = \exp(\theta)_{2} S": "a bracket has an index",
    r"y = \sum_i a_i x^i": "whether i is an upper index or a power",
    r"y = \sin\theta/2": "whether the slash is within the function",
    r"y = a/bc": "what the slash divides by",
    r"y = 1/2x": "what the slash divides by",
    r"|a|b|c| = 1": "how the bars belong together",
    r"x = \foo y": "\\foo is not known",
    r"x = ": "a side of the relation is missing",
    r"= x": "the left side is missing",
    r"x = i\omega": "whether i is the imaginary unit",
    r"\vec a\vec b = c": "two vectors stand side by side",
    r"L = r\times p": "whether × is of vectors or of numbers",
    r"y = \Delta + \Delta x": "whether \\Delta is a factor or a difference",
    r"S = \sum_i a_i + b_i": "whether the sum ends here",
    r"x = a.b": "a full stop stands within",
    r"v = \frac{dr}{dt}(0)": "whether a derivative is taken there",
    r"D = |\mathbf{K} - \mathbf{M}|": "whether the bars are a determinant",
    r"x = (a + b": "( is not closed",
    r"x = a + + b": "two signs follow each other",
    r"x = \int f": "the differential of the integral is missing",
    r"y = \frac{d}{dx} f \frac{d}{dx} g": "how far the derivative reaches",
    r"x^0 = ct": "whether 0 is an upper index",
    r"y = S^{P}_{,t} + P": "whether P is a mark or a power",
    r"C = x + constant": "constant is a word",
    r"\psi = Y_l^m(\theta, \phi)": "whether m is an upper index or a power",
    r"u^m(q, p) = v": "whether m is an upper index or a power",
    r"c = {f_j}^{k'} g": "whether k is an upper index or a power",
    r"y = x_{n^2} + x_{n2}": "are one letter is open",
    r"\nabla\cdot\mathbf E\times\mathbf B = 0": "how far",
    r"P(x) = \int d^n\theta\,f(x)": "the differential of the integral",
    "x = 10⁶ y": "⁶ is not known",
    r"\frac{\tilde{\mathrm{d}}v}{\mathrm{d}t} = a": "a derivative is open",
    r"\ddot r = \mathrm{d}r\,f": "a differential stands on one side only",
    r"P\,\mathrm{d}' A = b": "a differential has a prime",
    r"\chi^{xxz} = 0": "whether x x z are upper indices or a power",
    r"ACC = \frac{TP}{N}": "ACC is a word",
    r"SO(3, 1) = G": "whether SO(…) is one name",
    r"\epsilon_{12...k} = 1": "an index is not letters and numbers",
    r"c = 3~{\rm m/s}": "whether upright letters are a unit",
    r"r = \left(\frac{E_r}{E_i}\right)_\parallel": "a bracket has an index",
    r"R_\mu^{t^*} = 1": "whether the marked t is an upper index or a power",
    r"Y = P_l^m(\cos\theta)": "whether m is an upper index or a power",
    r"y = \delta_x U": "whether delta is a factor or acts on what follows",
    r"y = \partial_\eta p\,\partial_y\phi": "how far the derivative reaches",
    r"A = \operatorname{Cl}^{3}(V)": "whether Cl has an upper index or a power",
    r"y = U\bullet\phi": "is not read here",
    r"y = \int f(x)\,d\nu(x)": "belongs to the differential",
    r"v = v_{\text{\tiny a}}": "an index is not letters and numbers",
    r"r = \text{not constant}": "words stand for a side",
    r"[R_l(t)] = e^{-t}": "what the square brackets mean",
    r"W = \int F(r)\cdot d\vec r": "whether F is a vector",
    r"\text{Pr}[A] = 4": "whether Pr acts on what follows",
    r"\vec k = [\cos a, \sin a]": "components or an interval",
    r"S = \sum_{cyc} a": "words or indices stand below",
    r"\left(\begin{array}{cc|c}1 & 0 & j\\ 0 & 1 & k\end{array}\right) = A": "a line stands in the matrix",
    r"m = \int \vec F\,dt": "a vector is equal to a number",
}


# What the print leaves open and custom settles, with other formulas of the paper: its reading, and the words of its mark.
CUSTOM: dict[tuple[str, ...], tuple[str, str]] = {
    (r"\dot x = -kx(t - \tau)",): ("x_dot = -k*x(t - tau)", "x before ( is a function"),
    (r"E = K(1) + K(2)",): ("E = K(1) + K(2)", "K before ( is a function"),
    (r"y = f\left(\frac{x}{a}\right)",): ("y = f(x/a)", "f before ( is a function"),
    (r"E = p(r + s) - p(r)", "p = a"): ("E = p(r + s) - p(r)", "p before ( is a function"),
    (r"V = \theta(\theta^2 - 1)", r"\theta(t) = a", r"b = \theta c"): (
        "V = theta*(theta**2 - 1)",
        "theta before ( is a factor",
    ),
    (r"H = \rho(\partial_x u)^2", r"\rho(x) = a"): ("H = rho*Derivative(u, x)**2", "rho before ( is a factor"),
    (r"y = A(x - a)(x - b)", "A = 2", "A(x) = b"): ("y = A*(x - a)*(x - b)", "A before ( is a factor"),
    (r"F = f^2(kx)", "f(k) = 1"): ("F = f(k*x)**2", "f before ( is a function"),
    (r"a = \delta n(t) b", "n(x) = c"): ("a = delta_n(t)*b", "delta n is one quantity"),
    (r"\Gamma^\lambda_{\mu\nu} = 0",): ("Gamma__lambda_mu_nu = 0", "the superscript of Gamma is part of the name"),
    (r"y = x^\mu + A_\mu",): ("y = x__mu + A_mu", "the superscript of x is part of the name"),
    (r"f^p_q = b", "c_p = 1"): ("f__p_q = b", "the superscript of f is part of the name"),
    (r"p^0 = E", r"x^\mu = a"): ("p__0 = E", "the superscript of p is part of the name"),
    (r"\partial^\mu F_{\mu\nu} = j_\nu",): (
        "contraction(Derivative(F_mu_nu, x_mu)) = j_nu",
        "what it differentiates by",
    ),
    (r"a = \frac{\delta}{\delta f(x)} G",): ("a = Derivative(G, f(x))", "the fraction with delta"),
    (r"S[q(t), t] = a",): ("S(q, t) = a", "a functional of what the brackets hold"),
    (r"T = V\zeta(3/2)",): ("T = V*zeta(3/2)", "zeta before ( is a function"),
    (r"A = \Omega^T\Omega",): ("A = transpose(Omega)*Omega", "T above transposes"),
    (r"\tau^{ab}_{ij} = \epsilon_a t^{ab}_{ij}", "a = 1"): (
        "tau__a__b_ij = contraction(epsilon_a, t__a__b_ij)",
        "is part of the name",
    ),
    (r"dx^\mu = F^\mu d\tau", r"\mu = 1"): ("differential(x__mu) = F__mu*differential(tau)", "is part of the name"),
    (r"b^{s\dagger} = c",): ("b__s__dagger = c", "is part of the name"),
    (r"(AB)^\dagger = (c + d)^*",): ("adjoint(A*B) = conjugate(c + d)", "the superscript of a bracket is a mark"),
    (r"\vec E = \frac{q}{r^2}\hat r",): ("Evec = q/r**2*rhat", "what has a hat"),
    (r"\vec B = \vec C + b\hat e_\phi",): ("Bvec = Cvec + b*ehat_phi", "what has a hat"),
    (r"\rho\mathbf a = -\nabla p + \nabla\cdot\boldsymbol\sigma",): (
        "rho*abold = -gradient(p) + divergence(sigmabold)",
        "the divergence of a tensor",
    ),
    (r"\delta Q = dU + p\,dV",): ("delta_Q = differential(U) + p*differential(V)", "delta Q is one quantity"),
    (r"Z = \int\mathcal{D}q\,e^{iS[q]}",): ("Z = Integral(exp(imaginary_unit*S(q)), measure(q))", "over functions"),
    (r"\nabla.\underline{u} = \underline{a}.\underline{b}",): (
        "divergence(uunder) = dot(aunder, bunder)",
        "the full stop",
    ),
    (r"\int_V \rho + \oint_S\vec j\cdot\hat{\vec n} = 0",): (
        "Integral(rho, over_V) + Integral(dot(jvec, nvechat), over_S) = 0",
        "its differential is left out",
    ),
    (r"= a = b",): ("a = b", "begins with its sign"),
    (r"f = \phi(\mathrm{Re}, \epsilon) + \frac{64}{\text{Re}}", r"\phi(x) = 1"): (
        "f = phi(Re, epsilon) + 64/Re",
        "Re is a number of its own",
    ),
    (r"\mathbf q^{n+1/2}_i = \vec F^{int} + \mathbf s^1",): (
        "qbold__nplus1over2_i = Fvec__int + sbold__1",
        "is part of the name",
    ),
    (r"c = \left.\frac{\partial S}{\partial E}\right|_{V,N}",): (
        "c = at_constant(Derivative(S, E), V, N)",
        "is held constant",
    ),
    (r"\beta = 13.7^o",): ("beta = 137/10*pi/180", "means degrees"),
    (r"\begin{aligned} a &= b \text{ where } c = d\\ &= e\end{aligned}",): (
        "a = b; c = d = e",
        "continues what stands just before",
    ),
    (r"x = \sum_i\frac{m_i}{\Sigma m} x_i",): ("x = Sum(m_i/(Sigma*m)*x_i, i)", "no sum or product over it"),
    (r"a, b = 0",): ("values(a, b) = 0", "holds for each of them"),
    (r"e_i = a_j,\quad i, j = 1, 2",): ("e_i = a_j; values(i, j) = values(1, 2)", "holds for each of them"),
    (r"\delta W = 0", r"\cos(t + \delta)"): ("delta_W = 0", "delta W is one quantity"),
    (r"\dot z_i = i\omega z_i", r"y = e^{ikx}"): ("z_i_dot = imaginary_unit*omega*z_i", "i is the imaginary unit"),
    (r"ds = v\,dt", "d = 1"): ("differential(s) = v*differential(t)", "d before a letter"),
    (r"y = e^{i\mathbf k\mathbf r}",): ("y = exp(imaginary_unit*dot(kbold, rbold))", "with a dot"),
}


@pytest.mark.parametrize("formulas", CUSTOM)
def test_what_custom_settles_is_read_with_a_mark(formulas: tuple[str, ...]) -> None:
    reading, mark = CUSTOM[formulas]
    assert said(*formulas) == reading
    assert any(mark in each for each in read_formula(formulas[0], notation_of(formulas)).guesses)


@pytest.mark.parametrize("latex", [latex for latex, why in OPEN.items() if why])
def test_what_may_mean_two_things_is_not_read_and_it_says_where(latex: str) -> None:
    assert said(latex).startswith("stopped: ") and OPEN[latex] in said(latex)
    assert read_formula(latex, notation_of([latex])).stop[1], "what would help"  # type: ignore[index]


def test_a_power_behind_a_bracket_of_a_function_is_not_read() -> None:
    assert "stopped" in said(r"y = \sin(\theta)^2")


def test_words_for_a_condition_are_no_otherwise() -> None:
    cases = r"f = \begin{cases} 1 & \text{%s}\\ 0 & x > 0\end{cases}"
    assert said(cases % "otherwise,") == "f = cases(case(1, otherwise), case(0, Gt(x, 0)))"
    for words in ("if the sum is even", "inside"):
        assert said(cases % words).startswith("stopped: the condition of a case")
    assert (
        said(r"f = \begin{cases} 1 & \,\\ 0 & x > 0\end{cases}") == "f = cases(case(1, otherwise), case(0, Gt(x, 0)))"
    )


def test_what_the_paper_shows_elsewhere_settles_a_reading() -> None:
    assert said("E = V(x + h)") == "E = V*(x + h)"
    assert said("E = V(x + h)", "V(x) = x").startswith("E = V(x + h)")
    assert said("E = K(1) + K(2)", functions="K") == "E = K(1) + K(2)"
    assert said("E = K(1)", letters="K") == "E = K*1"
    assert said(r"y = e^2 x") == "y = e**2*x" and "stopped" in said("y = e^2 x", "z = e^{-t}")
    assert said(r"y = e^{-t}", "a = 1 - e") == "y = exp(-t)"
    assert said(r"y = e^{-t}", "a = 1 - e", numbers="e") == "y = exp(-t)"
    assert said(r"x = i\omega", numbers="i") == "x = imaginary_unit*omega"
    assert said("E = mc^2") == "E = m*c**2" and said("I = mr^2") == "I = m*r**2", "energy and inertia, no numbers"
    assert (
        said(r"s = \ln N!") == "s = log(factorial(N))"
        and said(r"s = \ln(N + 1)! - c") == "s = log(factorial(N + 1)) - c"
    )
    assert "stopped" in said(r"s = \sin(x)!")
    assert said(r"c = 1.0\,\mathrm{kJ/(kg\,K)}") == "c = 1*unit_kJ*unit_kg**(-1)*unit_K**(-1)"
    assert said(r"x = \sfrac{1}{2} y + \nicefrac12") == "x = 1/2*y + 1/2"
    assert said("x = 1{,}500", decimal_comma=True) == "x = 3/2"
    assert "pi is the number or a quantity" in said(r"H = \pi^2 + \phi^2", r"\pi(x) = \dot\phi")
    for momentum in (r"\pi = \dot\phi", r"\dot\phi = \pi", r"\pi = \frac{\partial L}{\partial\dot\phi}"):
        assert "pi is the number or a quantity" in said(r"H = \pi^2 + \phi^2", momentum)
    assert said(r"H = 2\pi k", r"\pi(x) = \dot\phi") == "H = 2*pi*k", "a multiple of the number"
    assert said(r"a\delta^3(x - y) = b") == "a*delta__3(x - y) = b"
    assert "Dirac's function or a power" in said(r"a\delta^3(x - y) = b", r"\delta = 1")
    assert said(r"A_\mu = \partial_\mu U", r"\mu = 1") == "A_mu = Derivative(U, x__mu)"
    assert said(r"\partial_\mu U = 1", r"\mu = 1") == "Derivative(U, mu) = 1", "a scale"
    assert said(r"y = r(t)^2", "r(t) = 1") == "y = r**2", "a power of what is called"
    assert said(r"\dot x = f(x + 1)", "f(x) = x") == "x_dot = f(x + 1)", "f is printed with its argument only"
    assert said(r"\delta W = 0", r"\delta") == "delta_W = 0", "the sign by itself in a sentence"
    assert "factor or a difference" in said(r"\delta W = \delta", r"\cos(t + \delta)")
    wave = (r"y = e^{ikx}", "v_i = a")
    assert said(r"a = -iqB", *wave) == "a = -imaginary_unit*q*B", "no index of this formula"
    assert said(r"|i\rangle = 0", *wave) == "ket(i) = 0", "a label"


@pytest.mark.parametrize(
    ("latex", "guess"),
    [
        (r"x = e^t", "e is Euler's number"),
        (r"x = \cos\nu t", "the argument of cos is the product"),
        (r"x = \sin^{-1} y", "the inverse function"),
        (r"x = \log y", "the natural logarithm"),
        (r"x = \Delta y", "one quantity, a difference"),
        (r"c = \{a, b\}", "poisson brackets are meant, no set"),
        (r"c = [a, b]", "commutator brackets are meant, no interval"),
        (r"y = V^\gamma", "the superscript of V is a power"),
        (r"h = p/2\pi", "all that follows the slash divides"),
        (r"x = 1{,}000", "parts thousands"),
        (r"\frac{d}{dt} m v = F", "acts on the whole product"),
    ],
)
def test_what_custom_settles_is_named_as_a_guess(latex: str, guess: str) -> None:
    (found,) = read_formula(latex, notation_of([latex])).guesses
    assert guess in found


@pytest.mark.parametrize(
    ("latex", "read", "guess"),
    [
        (r"l = 5\mathrm{m}", "l = 5*unit_m", "upright m behind a number is a unit"),
        (r"l = 5\,\mathrm{m}", "l = 5*unit_m", ""),
        (r"l = 5\,m", "l = 5*m", "a letter, and no unit"),
        (r"x = \cos\omega t", "x = cos(omega*t)", ""),
        ("V = 2 m g l", "V = 2*m*g*l", ""),
        ("I = 2 m l^2", "I = 2*m*l**2", ""),
        ("V = 2 m l", "V = 2*m*l", "a letter, and no unit"),
        ("a = 9.81 m/s^2", "a = 981/100*m/s**2", "a letter, and no unit"),
        (r"l = 5\,\eta", "l = 5*eta", ""),
        (r"l = 83\,\mathrm{\%}", "l = 83/100", ""),
        (r"l = 1.602\,176", "l = 25034/15625", ""),
        (r"l = 29.6\,\mathrm{fm}", "l = 148/5*unit_fm", ""),
        (r"y = e^2/r", "y = e**2/r", "e is a letter, and not Euler's number"),
        (r"x' = \gamma(x - vt)", "xprime = gamma*(x - v*t)", "gamma before ( is a factor"),
        (r"a = b \text{ or } c = d", "a = b; c = d", "what or joins are two statements, and both are meant"),
    ],
)
def test_units_products_and_alternatives_are_marked(latex: str, read: str, guess: str) -> None:
    assert said(latex) == read
    guesses = read_formula(latex, notation_of([latex])).guesses
    assert guess in "".join(guesses) and bool(guess) == bool(guesses)


def test_an_order_that_is_claimed_is_kept() -> None:
    reading = read_formula(r"f = 1 + \epsilon + O(\epsilon^2)")
    assert reading.statements[0].order == ("epsilon", 2)
    assert text_of(reading.statements[0].sides[1].node) == "1 + epsilon"


def test_relations_part_equations_from_what_is_kept_aside() -> None:
    kinds = {
        latex: read_formula(latex).statements[0].kind
        for latex in ("a = b", r"a \approx b", "a < b", "n = 1, 2", r"x \to 0")
    }
    assert list(kinds.values()) == ["equation", "approximation", "inequality", "range", "other"]


def test_sums_of_five_hundred_terms_are_read() -> None:
    latex = "S = " + " + ".join(f"a_{{{n}}} x^{{{n}}}" for n in range(1, 501))
    assert len(read_formula(latex).statements[0].sides[1].node.args) == 500  # type: ignore[union-attr]


def test_deep_brackets_are_refused_in_words() -> None:
    assert "too deep" in said("x = " + "(" * 500 + "a" + ")" * 500)


def test_a_bra_ends_at_its_bar_where_a_sign_follows() -> None:
    read = said(r"X = |0\rangle\langle1| + |1\rangle\langle0|")
    assert read == "X = matmul(ket(0), bra(1)) + matmul(ket(1), bra(0))"
    assert said(r"a = \langle 1|-x|2\rangle") == "a = braket(1, -x, 2)"


def test_a_primed_index_of_a_sum_keeps_its_prime() -> None:
    assert said(r"a = \sum_{j'=1}^m b_{j'}") == "a = Sum(b_jprime, jprime, 1, m)"
    assert said(r"a = \sum_{i j'} b_{i j'}").endswith("i, all, all, jprime)")


def test_a_letter_with_another_argument_elsewhere_keeps_its_t_with_every_index() -> None:
    latex = r"P_{n+1}(t) = P_{n-1}(t) + \dot P_n(t)"
    assert said(latex) == "P_nplus1 = P_nminus1 + P_n_dot"
    assert said(latex, "P_n(x) = 1") == "P_nplus1(t) = P_nminus1(t) + P_n_dot(t)"


SIDES = {
    r"W + 3\Pi + \mathcal{M} = 0": r"W + 3\Pi + \mathcal{M}",
    r"{\bf k}_1 + {\bf k}_2 = 0": r"{\bf k}_1 + {\bf k}_2",
    r"{\bf \dot{x}} = {\bf c}": r"{\bf \dot{x}}",
    r"\left(a\right) + {b} = c": r"\left(a\right) + {b}",
    r"{\rm St} = \frac{f}{U}": r"{\rm St}",
    r"\mathbf{x} + \mathbf{y} = \mathbf{z}": r"\mathbf{x} + \mathbf{y}",
    r"\mathscr {T} = \frac{f}{U}": r"\mathscr {T}",
    r"\boldsymbol{x}_1 = 2\boldsymbol{y}": r"\boldsymbol{x}_1",
    r"\boldsymbol\zeta = 2\mathbf y": r"\boldsymbol\zeta",
    r"\boldsymbol{\mathrm{\tau}} = I\boldsymbol{\alpha}": r"\boldsymbol{\mathrm{\tau}}",
    r"\vec\nabla\cdot\vec B = 0": r"\vec\nabla\cdot\vec B",
    r"\vec{\nabla}\cdot\vec{B} = 0": r"\vec{\nabla}\cdot\vec{B}",
    r"\frac{x}{y} + {x} = \sqrt{y}": r"\frac{x}{y} + {x}",
    r"{x} + \mathbf y^2 = z": r"{x} + \mathbf y^2",
    r"{\partial L \over \partial\theta} = M": r"{\partial L \over \partial\theta}",
    r"m{\text{d}v \over \text{d}t} = F": r"m{\text{d}v \over \text{d}t}",
    r"\{a, b\} = {c}": r"\{a, b\}",
}


@pytest.mark.parametrize("latex", SIDES)
def test_a_side_keeps_its_braces_and_its_font(latex: str) -> None:
    assert read_formula(latex, notation_of([latex])).statements[0].sides[0].latex == SIDES[latex]
