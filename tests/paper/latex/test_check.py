"""The check of a source by itself: slips are found with their line, and a law or a condition is left alone."""

import json
from pathlib import Path

import pytest

from lagrotor.commands.command_line import main
from lagrotor.paper.latex import comparison
from lagrotor.paper.latex.check import (
    HOLDS,
    INDEX,
    MEANINGS,
    NOT_JUDGED,
    REFUTED,
    UNITS,
    Check,
    StepFinding,
    check_source,
)
from lagrotor.paper.latex.displays import read_latex
from lagrotor.paper.latex.markup import read_source
from lagrotor.paper.latex.notation import declared_notation


def written(folder: Path, body: str) -> Path:
    file = folder / "paper.tex"
    head = "\\documentclass{article}\\usepackage{amsmath}\n\\begin{document}\n"
    file.write_text(f"{head}{body}\n\\end{{document}}\n", encoding="utf-8")
    return file


def findings(body: str) -> tuple[StepFinding, ...]:
    return check_source(read_latex(f"\\begin{{document}}\n{body}\n\\end{{document}}\n")).findings


def verdicts(body: str) -> list[str]:
    return [each.verdict for each in findings(body)]


SQUARE = (
    r"\begin{equation} T = m(\dot x + l\dot\phi)^2 = m(\dot x^2 SIGN 2 l\dot x\dot\phi + l^2\dot\phi^2)\end{equation}"
)
SLIP = r"\[ E = (x + y)^2 = x^2 - 2xy + y^2 \] "


def test_a_wrong_sign_within_a_chain_is_found_with_its_line_its_members_and_its_term() -> None:
    assert verdicts(SQUARE.replace("SIGN", "+")) == [HOLDS]
    (slip,) = findings("\n" + SQUARE.replace("SIGN", "-"))
    assert (slip.verdict, slip.step, slip.line) == (REFUTED, 2, 3) and "with the sign of" in slip.why
    assert slip.members[0].startswith("m*(x_dot + l*phi_dot)**2") and "- 2*l*x_dot*phi_dot" in slip.members[1]


def test_a_slip_between_two_rows_has_the_line_of_its_row() -> None:
    body = "\\begin{align}\n E &= m v^2 + 2 m g h \\\\\n &= m(v^2 + 2 g h) \\\\\n &= m(v^2 - 2 g h)\n\\end{align}"
    assert [(each.equation, each.verdict, each.line) for each in findings(body)] == [("2", HOLDS, 4), ("3", REFUTED, 5)]


# A chain of three rows whose second claims an order: what follows it must agree through that order.
ORDERS = [
    (r"1-\cos\theta &= 2\sin^2\frac\theta2 \\ &= \frac{\theta^2}{2} + O(\theta^4) \\ &= \frac{\theta^2}{4}", REFUTED),
    (r"1-\cos\theta &= 2\sin^2\frac\theta2 \\ &= \frac{\theta^2}{2} + O(\theta^4) \\ &= \frac{\theta^2}{2}", HOLDS),
    (r"y &= \sin\epsilon \\ &= \epsilon - \frac{\epsilon^3}{6} + O(\epsilon^5)", HOLDS),
    (r"y &= \sin\epsilon \\ &= \epsilon - \frac{\epsilon^3}{3} + O(\epsilon^5)", REFUTED),
    (r"y &= (a + \eta)\ddot\eta + \dot\eta^2 \\ &= a\ddot\eta + O(\eta^2)", HOLDS),
    (r"y &= (a + \eta)\ddot\eta + \dot\eta^2 \\ &= 2a\ddot\eta + O(\eta^2)", REFUTED),
]


@pytest.mark.parametrize(("rows", "verdict"), ORDERS)
def test_a_claimed_order_is_checked(rows: str, verdict: str) -> None:
    assert verdicts(rf"\begin{{align}} {rows} \end{{align}}")[-1] == verdict


# Members of chains without a word beside them: slips and conditions are refuted, laws with new letters are not judged.
CHAINS = [
    (r"F = -k x = m\ddot x", NOT_JUDGED),
    (r"0 = m_1 a + m_2 b = m_1(a + g) + m_2(a - b)", NOT_JUDGED),
    (r"f = x^2 - l^2 = 0", NOT_JUDGED),
    (r"A = \int_0^1 x\,dx = B", NOT_JUDGED),
    (r"E = T + V = 2T", REFUTED),
    (r"E = a b + c = a b - c", REFUTED),
    (r"E = \frac{d}{dt} p = p", NOT_JUDGED),
    (r"E = (\vec a + \vec b)\cdot\vec c = \vec a\cdot\vec c", NOT_JUDGED),
    (r"y = 9^{9^{9^9}} = 9^{9^{9^9}} + 1", NOT_JUDGED),
    (r"w = 99999999! = 99999999! + 1", NOT_JUDGED),
    (r"w = \binom{1000000000}{500000000} = 1", NOT_JUDGED),
    (r"w = 4\pi\cdot 1.2 = 15.08", NOT_JUDGED),
    (r"w = 4\cdot 2 = 9", REFUTED),
    (r"w = a^2 + 2bc = 2bc", NOT_JUDGED),
    (r"w = -a - \sqrt{a^2 - b^2} + b = -a + b", NOT_JUDGED),
    (r"w = a^2 + 2bc = a^2 + bc", REFUTED),
    (r"y = (a + 9^{2})^2 = a^2 - 2\cdot 9^{2} a + 9^{4}", REFUTED),
    (r"y = e^{10^{24} + x} z = 2 e^{10^{24} - x} z", NOT_JUDGED),
    (r"y = e^{10^{24} x} z = z e^{10^{24} x}", HOLDS),
    (r"y = x^{10^{12}} = x^{10^{12}+1}", NOT_JUDGED),
    (r"y = (10^{10^5} + x)^{50} = x^{50}", NOT_JUDGED),
    (r"y = \sqrt{x^2} = x", HOLDS),  # for positive letters, and it says so
    (r"y = \cos^2 x - \sin^2 x = 1", REFUTED),
    (r"y = x\sqrt{-1 - x^2} = \sqrt{-1 - x^2}\,x", HOLDS),
    (r"A = \frac{\partial f}{\partial x} + b = \frac{\partial f}{\partial y} - b", NOT_JUDGED),
    (r"f = \sin^2 x/2 = \frac{1 - \cos x}{2}", NOT_JUDGED),  # an argument of two readings
    (r"\cos^2 x = 1 - \sin^2 x", HOLDS),
    (r"\sin(2x) = 2\sin x\cos x", HOLDS),
    (r"e^{x} e^{y} = e^{x + y}", HOLDS),
]


@pytest.mark.parametrize(("chain", "verdict"), CHAINS)
def test_a_chain_without_words(chain: str, verdict: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(comparison, "MOST_CALLS", 300_000)
    assert verdicts(rf"\[ {chain} \]") == [verdict]


@pytest.mark.parametrize(
    "words",
    [
        "By symmetry, □", "Modulo total derivatives □", "Integrating by parts □", "We drop boundaries: □", "□ if both are equal",
        "By the virial theorem □", "□ where they are equal", "For a free particle □", "Setting them equal □",
        "We neglect friction. Then □",
    ],
)  # fmt: skip
def test_a_condition_or_a_reason_in_words_leaves_a_chain_alone(words: str) -> None:
    assert verdicts(words.replace("□", r"\[ E = T + V = 2T \]")) == [NOT_JUDGED]
    assert verdicts(words.replace("□", "it rests.") + "\n\n" + r"Then \[ E = T + V = 2T \]") == [REFUTED]


@pytest.mark.parametrize(
    "words",
    [r"\[ xy = 0 \]", r"\[ |y| = 0 \]", "Let $xy = 0$.", r"For $y = 0$,", r"For $y\ll x$,", r"As $y\to 0$,"],
)
def test_an_equation_of_the_letters_of_a_step_leaves_it_alone(words: str) -> None:
    assert REFUTED not in verdicts(words + SLIP)


@pytest.mark.parametrize(
    "words", [r"\[ (x + y)^2 = x^2 + 2xy + y^2 \]", r"\[ y = z w \]", "Here $y > 0$.", "Here $z = 1$."]
)
def test_identities_bounds_and_other_letters_say_nothing_of_a_step(words: str) -> None:
    assert verdicts(words + SLIP)[-1] == REFUTED


# A sum over an index, a step with it, and a slip: the index outside its sum.
INDICES = [
    (r"S = \sum_j \cos\theta_j \sum_{k=j}^N 1 = (N-j+1)\sum_j \cos\theta_j", ["j"]),
    (r"S = \sum_{k=1}^2 a_k = 2 a_k", ["k"]),
    (r"S = \sum_j (N-j+1)\cos\theta_j = \sum_k (N-k+1)\cos\theta_k", []),
    (r"p_k = \sum_{j} A_{jk} q_j + b_k", []),
]


@pytest.mark.parametrize(("equation", "letters"), INDICES)
def test_an_index_outside_its_sum_is_found(equation: str, letters: list[str]) -> None:
    reported = [each.why.split()[0] for each in findings(rf"\[ {equation} \]") if each.verdict == INDEX]
    assert reported == letters


# A chain, the step that follows it, and the same step with one slip of an author.
STEPS = [
    (r"(2ab)^3", "8a^3b^3", "6a^3b^3"),
    (r"\sqrt{a^2 b^4}", "|a| b^2", "|a| b"),
    (r"2\sin\alpha\cos\alpha", r"\sin(2\alpha)", r"\cos(2\alpha)"),
    (r"\frac{1}{1/a + 1/b}", r"\frac{ab}{a + b}", r"\frac{a + b}{ab}"),
    (r"m_1 v_1 + m_2 v_2 - m_1 v_1", "m_2 v_2", "m_2 v_1"),
    (r"e^{-2k t} e^{k t}", "e^{-k t}", "e^{k t}"),
    (r"\cosh^2 x - \sinh^2 x", "1", "-1"),
    (r"\frac34\cdot\frac25 a", r"\frac{3}{10} a", r"\frac{3}{20} a"),
    (r"\begin{vmatrix} a & b\\ c & d\end{vmatrix}", "ad - bc", "ad + bc"),
    (r"\frac{d}{dx} x^3", "3x^2", "3x"),
    (r"\int_0^a x\,dx", r"\frac{a^2}{2}", "a^2"),
    (r"\sum_{k=1}^3 k a", "6a", "5a"),
]


# What the text gives before a step, the step, and a part of it with a slip in its place.
WITH_PREMISES = [
    (r"Here $v = l\dot\theta$.", r"T = \frac12 m v^2 = \frac12 m l^2\dot\theta^2", r"= \frac12 m l^2", r"= \frac14 m l^2"),
    (r"\[ v = l\dot\theta \]", r"T = m v^2 = m l^2\dot\theta^2", r"\dot\theta", r"\theta"),
    (r"\[ H = \frac{p^2}{2M} + \frac{k q^2}{2} \]", r"\dot p = -\frac{\partial H}{\partial q} = -k q", "-k", "k"),
    (
        r"\[ L = T - V \] where $T = \frac12 m\dot q^2$ and $V = \frac12 k q^2$.",
        r"p = \frac{\partial L}{\partial\dot q} = m\dot q", r"m\dot q", "m q",
    ),
    (
        r"\[ \mathbf v = \dot{\mathbf r} \]",
        r"T = \frac12 m\mathbf v\cdot\mathbf v = \frac12 m\dot{\mathbf r}\cdot\dot{\mathbf r}",
        r"\frac12 m\dot{\mathbf r}", r"m\dot{\mathbf r}",
    ),
    (
        r"\[ L = \frac12 m l^2\dot\theta^2 + m g l\cos\theta \]"
        r"\[ p = \frac{\partial L}{\partial\dot\theta} = m l^2\dot\theta \]",
        r"H = p\dot\theta - L = \frac{p^2}{2 m l^2} - m g l\cos\theta", r"- m g l", r"+ m g l",
    ),
    (
        r"\[ x = r\cos\theta \] \[ y = r\sin\theta \]",
        r"T = \frac12 m(\dot x^2 + \dot y^2) = \frac12 m(\dot r^2 + r^2\dot\theta^2)", r"+ r^2", r"+ r",
    ),
    (
        r"The motion is $x(t) = A\cos\omega t$.", r"E = \frac12 m\dot x^2 + \frac12 m\omega^2 x^2 = \frac12 m\omega^2 A^2",
        r"= \frac12 m\omega^2 A", r"= m\omega^2 A",
    ),
    ("", r"N = \frac{d}{dt}\left(\frac13 m b^2\dot\theta\right) = \frac13 m b^2\ddot\theta", r"= \frac13", r"= -\frac13"),
    (r"Here $\omega^2 = g/l$.", r"E = \omega^2 + k = g/l + k", "l + k", "l - k"),
    ("", r"S = \int_0^a b x\,dx = \frac{a^2 b}{2}", "{a^2", "{a^3"),
    (
        "", r"E = \left(1 + \frac{\partial f}{\partial x}\right)^2 = 1 + 2\frac{\partial f}{\partial x}"
        r" + \left(\frac{\partial f}{\partial x}\right)^2", r"2\frac", r"\frac",
    ),
]  # fmt: skip


# The same in passages of textbooks, where single equations are worked out from what is given.
PASSAGES = {
    "the velocity of a pendulum": (
        r"\begin{align} x &= l\sin\theta, \\ y &= -l\cos\theta .\end{align} The velocities follow by differentiation,",
        r"\dot y = l\dot\theta\sin\theta", "= l", "= -l",
    ),
    "the force of a pendulum": (
        r"\[ L = \frac12 m l^2\dot\theta^2 + m g l\cos\theta \] The momentum is $p$, and the force",
        r"\frac{\partial L}{\partial\theta} = -m g l\sin\theta", "-m", "m",
    ),
    "a cyclic angle": (
        r"\[ p_\varphi = m l^2\sin^2\theta\,\dot\varphi \] is conserved, and the energy becomes",
        r"E = \frac12 m l^2(\dot\theta^2 + \sin^2\theta\,\dot\varphi^2) = \frac12 m l^2\dot\theta^2"
        r" + \frac{p_\varphi^2}{2 m l^2\sin^2\theta}", r"m l^2\sin^2\theta}", r"m l^2\sin\theta}",
    ),
    "an effective potential": (
        r"\[ U(r) = \frac{\ell^2}{2\mu r^2} - \frac{k}{r} \] Its derivative is",
        r"\frac{dU}{dr} = -\frac{\ell^2}{\mu r^3} + \frac{k}{r^2} \] which vanishes at $r_0$. \[ r_0 = \frac{\ell^2}{\mu k}",
        r"{\mu r^3}", r"{\mu r^2}",
    ),
    "a rate put into a rate": (
        r"\begin{align}\dot\omega_1 &= -\Omega\omega_2, \\ \dot\omega_2 &= \Omega\omega_1 .\end{align} Once more,",
        r"\ddot\omega_1 = -\Omega\dot\omega_2 = -\Omega^2\omega_1", r"\Omega^2", r"\Omega^3",
    ),
    "the equation of motion put in": (
        r"With the equation of motion $m\ddot x = -k x - b\dot x$ the power becomes",
        r"\frac{dE}{dt} = \dot x(m\ddot x + k x) = -b\dot x^2", "-b", "b",
    ),
    "beats": (
        "By the addition theorem this is",
        r"y = A(\cos\omega_1 t + \cos\omega_2 t)"
        r" = 2A\cos\left(\frac{\omega_1 + \omega_2}{2}t\right)\cos\left(\frac{\omega_1 - \omega_2}{2}t\right)",
        r"- \omega_2}{2}", r"- \omega_2}{1}",
    ),
    "a standing wave": (
        "On a string", r"y = A\sin(kx - \omega t) + A\sin(kx + \omega t) = 2A\sin kx\cos\omega t", r"kx\cos", r"kx\sin",
    ),
    "a group velocity": (
        r"\[ \omega^2 = g k + \frac{\sigma}{\rho}k^3 \] and the group velocity",
        r"v_g = \frac{d\omega}{dk} = \frac{g + 3\sigma k^2/\rho}{2\omega}", r"{2\omega}", r"{\omega}",
    ),
    "heats of a cycle": (
        r"\begin{align} Q_1 &= N k T_1\ln\frac{V_2}{V_1}, \\ Q_2 &= N k T_2\ln\frac{V_2}{V_1} .\end{align} The work is",
        r"W = Q_1 - Q_2 = N k(T_1 - T_2)\ln\frac{V_2}{V_1}", "T_1 - T_2", "T_1 + T_2",
    ),
    "an enthalpy": (
        r"An ideal gas has $U = \frac{f}{2} N k T$ and $p V = N k T$. The enthalpy is",
        r"H = U + p V = \frac{f + 2}{2} N k T", "f + 2", "f - 2",
    ),
    "probabilities": (
        r"\begin{align} r &= \frac{k - q}{k + q}, \\ t &= \frac{2k}{k + q} .\end{align} They add up to one:",
        r"T = \frac{q}{k}t^2 = \frac{4kq}{(k + q)^2}", "{4kq", "{2kq",
    ),
    "an integral to infinity": (
        r"With $a > 0$,", r"\int_0^\infty v^2 e^{-a v^2}\,dv = \frac{\sqrt\pi}{4a^{3/2}}", "{4a", "{2a",
    ),
    "the energy of a charged sphere": (
        r"\[ E(r) = \frac{Q}{4\pi\varepsilon_0 r^2} \] The energy stored is",
        r"W = \int_R^\infty\frac{\varepsilon_0}{2}E^2\,4\pi r^2\,dr = \frac{Q^2}{8\pi\varepsilon_0 R}", r"_0 R}", r"_0 R^2}",
    ),
    "a circuit": (
        r"The charge is $q(t) = q_0\cos\omega t$ with $\omega^2 = 1/(LC)$. \[ I = \dot q = -q_0\omega\sin\omega t \] Then",
        r"W = \frac12 L I^2 = \frac{q_0^2}{2C}\sin^2\omega t", "{2C}", "{C}",
    ),
    "the derivative of a function by a prime": (
        r"The potential is $V(r) = a r^4 - b r^2$. Its slope is", r"V'(r) = 4 a r^3 - 2 b r", "- 2 b", "+ 2 b",
    ),
    "a magnitude": (
        r"The modulus is \[ |Z| = \sqrt{R^2 + \omega^2 L^2} \] and the mean power",
        r"P = \frac{U^2 R}{2|Z|^2} = \frac{U^2 R}{2(R^2 + \omega^2 L^2)}", r"L^2", "L",
    ),
    "a tangent": (
        r"The phase is given by \[ \tan\delta = \frac{2\gamma\omega}{\Omega^2} \] Then",
        r"c = \frac{1}{1 + \tan^2\delta} = \frac{\Omega^4}{\Omega^4 + 4\gamma^2\omega^2}", r"4\gamma", r"2\gamma",
    ),
    "a factor before a bracket that is differentiated": (
        r"\[ V(r) = D(1 - e^{-\alpha r})^2 \] The force follows from",
        r"\frac{dV}{dr} = 2\alpha D(1 - e^{-\alpha r})e^{-\alpha r}", r"= 2\alpha D", r"= \alpha D",
    ),
    "an amplitude that is no operator": (
        r"With $x = Ae^{-\gamma t}\cos\omega t$ the velocity is",
        r"\dot x = -Ae^{-\gamma t}(\gamma\cos\omega t + \omega\sin\omega t)", r"+ \omega\sin", r"- \omega\sin",
    ),
    "differences that are quantities": (
        r"\[ v(r) = \frac{\Delta p}{4\eta l}(R^2 - r^2) \] The flux is",
        r"Q = 2\pi\int_0^R v(r)\,r\,dr = \frac{\pi\Delta p}{8\eta l}R^4", r"}R^4", r"}R^3",
    ),
    "a factor below a root": (
        r"Here $v = \sqrt{2gh}$. The level sinks as", r"\dot h = -\frac{a}{A}v = -\frac{a}{A}\sqrt{2gh}", "{2gh", "{gh",
    ),
    "a half-integer power": (
        r"\[ B(z) = \frac{b}{(R^2 + z^2)^{3/2}} \] The derivative",
        r"B'(z) = -\frac{3bz}{(R^2 + z^2)^{5/2}}", "5/2", "3/2",
    ),
    "a square of numbers where nothing is said of operators": (
        r"\[ L = \frac m2(\dot x - \Omega y)^2 + \frac m2(\dot y + \Omega x)^2 \]",
        r"p = \frac{\partial L}{\partial\dot y} = m(\dot y + \Omega x)", r"+ \Omega x", r"- \Omega x",
    ),
    "a power for a root": (
        r"Here $\Phi(z) = \frac{Q}{\sqrt{R^2 + z^2}}$. The field is",
        r"E = -\frac{d\Phi}{dz} = \frac{Q z}{(R^2 + z^2)^{3/2}}", "{3/2}", "{1/2}",
    ),
    "a factor before two brackets": (
        r"The stream function is $\psi = W\left(r - \frac{a^2}{r}\right)\sin\theta$. The velocity is",
        r"v = \frac1r\frac{\partial\psi}{\partial\theta} = W\left(1 - \frac{a^2}{r^2}\right)\cos\theta", "{r^2}", "{r^3}",
    ),
    "a power of a bracket": (
        r"Along the adiabat $T = b\left(\frac{c}{V}\right)^{\gamma - 1}$, so that",
        r"\frac{dT}{dV} = -(\gamma - 1)\frac{T}{V}", "{V}", "{V^2}",
    ),
    "rates in what is marked": (
        r"On the curve $x = a\cos\phi$, $y = b\sin\phi$",
        r"J = m(x\dot y - y\dot x) = mab\dot\phi \] \[ J = m(x\dot y - y\dot x) = m a b\dot\phi", r"m a b", r"2 m a b",
    ),
    "a power of which the derivative is taken": (
        r"With $p = C\rho^\gamma$ we have", r"\frac{dp}{d\rho} = \gamma C\rho^{\gamma - 1}", "- 1", "+ 1",
    ),
    "a function elsewhere": (
        r"The potential is $V(r) = a r^4 - b r^2$. There", r"V(r_0) = a r_0^4 - b r_0^2", "- b", "+ b",
    ),
}  # fmt: skip


CASES_OF_A_PREMISE = {
    "given twice": (
        r"\begin{equation} y = a x\end{equation} for $x>0$; \begin{equation} y = - a x\end{equation} for $x<0$. "
        r"\begin{equation} z = y + x = x(1 + a)\end{equation}"
    ),
    "given with either sign": (
        r"\begin{equation}\omega = \pm\sqrt{k/m}\end{equation}\begin{equation}\omega = -\sqrt{k/m}\end{equation}"
        r"\begin{equation} s = \omega t = \sqrt{k/m}\, t\end{equation}"
    ),
    "the half of it": (
        r"\begin{equation} A = 4\pi r^2\end{equation} is the area of the sphere. The hemisphere has half of it: "
        r"\begin{equation} F = p A = 2\pi r^2 p\end{equation}"
    ),
    "another case": (
        r"\begin{equation} V = -\frac{k}{r}\end{equation} For repulsion, "
        r"\begin{equation} E = T + V = T + \frac{k}{r}\end{equation}"
    ),
    "a count of states": (
        r"\begin{equation} N = \frac{V k^3}{6\pi^2}\end{equation} With two spins a state: "
        r"\begin{equation} n = \frac{N}{V} = \frac{k^3}{3\pi^2}\end{equation}"
    ),
}


# Conditions as physicists write them, one sign, factor or power from an identity.
CONDITIONS = [
    "The system is at resonance when □", "We require □", "At resonance □", "The phase must satisfy □", "Setting □ we find",
    "We set □", "The boundary condition at the free end gives □", "The frequencies are given by □",
    "The allowed energies follow from □", "Stationary points obey □", "This vanishes for □", "which happens at □",
    "The quantization condition reads □", "Equating the two forces, □", "The two curves cross at □",
    "Matching at the boundary yields □", "Continuity demands □", "The orbit is closed provided that □",
    "Let $x$ be such that □", "Choose $x$ so that □", "Suppose that □", "Assume □", "Imposing □",
    "To have □ the angle is small", "Demanding □ fixes the phase", "We want □", "We look for solutions of □",
    "Hence □ and thus $x = 0$", "The equilibrium angle is determined by □", "The critical angle is defined by □",
    "For the special case □ nothing moves", "In the case □", "Consider □", "Consider the equation □", "We have to solve □",
    "Therefore □ whose solutions are known", "It follows that □ and thus $x = 0$", "Newton's law gives □",
    "The torque balance is □", "Fix the gauge by □", "Take □", "with □", "given that □", "The turning points are where □",
    "The roots of □", "Energy conservation implies □", "The constraint is □", "The characteristic equation becomes □",
    "The dispersion relation is □", "The minimum lies at □", "Maximizing, we get □", "The derivative is zero at □",
    "Snell's law reads □", "The two agree only for □", "Solve for $x$: □", "Exercise. Find $x$ with □",
    "The ansatz works as long as □", "The bifurcation takes place once □", "Putting □ in the first integral",
    "A closed orbit needs □", "Eigenvalues: □", "This is possible only if □", "Using the boundary conditions we get □",
    "From the formula for the torque, □ if it rests", "□", "Hence □",
]  # fmt: skip


@pytest.mark.parametrize(("left", "right", "slip"), STEPS)
def test_slips_of_factors_powers_indices_and_functions_are_found(left: str, right: str, slip: str) -> None:
    assert verdicts(rf"\[ y = {left} = {right} \]") == [HOLDS]
    assert verdicts(rf"\[ y = {left} = {slip} \]") == [REFUTED]


@pytest.mark.parametrize(("before", "step", "part", "slip"), [*WITH_PREMISES, *PASSAGES.values()])
def test_a_slip_is_found_where_the_step_holds_with_the_premises_of_the_text(
    before: str, step: str, part: str, slip: str
) -> None:
    assert verdicts(rf"{before} \[ {step} \]")[-1] == HOLDS
    assert step.count(part) == 1 and verdicts(rf"{before} \[ {step.replace(part, slip)} \]")[-1] == REFUTED


@pytest.mark.parametrize("body", CASES_OF_A_PREMISE.values(), ids=CASES_OF_A_PREMISE)
def test_a_premise_of_another_case_refutes_nothing(body: str) -> None:
    assert REFUTED not in verdicts(body)


# Texts in which a law, another case, another section or another sign of a root explains the difference.
LAWS = [
    r"Here $v = l\omega$, and for the other $v = b\omega$. \[ T = m v^2 = \frac12 m l^2\omega^2 \]",
    r"\section{One} $v = l\omega$ \section{Two} \[ T = m v^2 = \frac12 m l^2\omega^2 \]",
    r"\[ v = l\omega \] By symmetry \[ T = m v^2 = \frac12 m l^2\omega^2 \]",
    r"\[ x = r\cos\theta \] \[ x = b\cos\theta \] \[ T = m\dot x^2 = 2 m r^2\dot\theta^2\sin^2\theta \]",
    r"\[ l\omega = 2 l\omega^2 \] \[ v = l\omega \] \[ T = v = 2 l\omega^2 \]",
    r"\[ A = \int_0^1 f(x)\,dx = -\int_0^1 f(x)\,dx = 0 \]",
    r"The solution is $x = A\cos\omega t$. \[ \ddot x = -\omega_0^2 x \]",
    r"\[ x = A\cos\omega t \] \[ E = \dot x^2 + \omega_0^2 x^2 = \omega_0^2 A^2 \]",
    r"Here $\omega^2 = k/m$. \[ v = a\omega = - a\sqrt{k/m} \]",
    r"\[ V(r) = a r^2 \] \[ V(r) = - a r^2 \]",
    r"\[ V(r, s) = a r^2 + s^2 \] \[ V(u, v) = a u^2 - v^2 \]",
    r"\[ W = \int_0^\infty e^{bt}\,dt = -\frac1b \]",
    r"Here $F = k x$ and $G = k y$, and in equilibrium \[ F + G = k(x - y) \]",
    r"\[ x = r\cos\phi \] \[ r = 2 x \] \[ E = x^2 = \frac14 r^2 \]",
    r"\[ y = a x^2 \] For the other branch \[ \frac{dy}{dx} = -2 a x \]",
    r"\[ y = a x^2 \] To be solved is the equation \[ \frac{dy}{dx} = -2 a x \]",
    r"Here $T = \frac12 m v^2$. Including the rotation it becomes \[ T = \frac{7}{10} m v^2 \]",
    r"Here $\varphi = kx - \omega t$, $k = 2\pi/l$. The reflected wave has \[ \varphi = -\frac{2\pi x}{l} - \omega t \]",
]


@pytest.mark.parametrize("text", LAWS)
def test_a_law_or_another_case_refutes_nothing(text: str) -> None:
    assert REFUTED not in verdicts(text)


CITED = r"""\begin{equation} v = \omega r \label{v}\end{equation} \begin{equation} F = \frac{m v^2}{r} + b\label{F}\end{equation}
With \eqref{v} in \eqref{F}, \begin{equation} F = m\omega^2 r SIGN b \end{equation}"""


def test_an_equation_is_compared_with_those_that_it_cites() -> None:
    assert verdicts(CITED.replace("SIGN", "+")) == [HOLDS]
    (slip,) = findings(CITED.replace("SIGN", "-"))
    assert slip.verdict == REFUTED and "with (2), (1)" in slip.why


@pytest.mark.parametrize("words", ["Using", "The identity", "Recall that", "We know that", "Note that"])
def test_a_single_equation_is_refuted_only_where_the_text_calls_it_an_identity(words: str) -> None:
    assert verdicts(rf"{words} \[ \cos^2 x = 1 + \sin^2 x \]") == [REFUTED]
    assert verdicts(r"Hence \[ \cos^2 x = 1 + \sin^2 x \]") == []


@pytest.mark.parametrize("words", CONDITIONS)
def test_a_condition_is_no_error(words: str) -> None:
    equations = (r"\cos^2 x = 1 + \sin^2 x", r"\sin 2x = \sin x\cos x", r"\cos 2x = \cos^2 x + \sin^2 x")
    assert verdicts(words.replace("□", rf"\[ {equations[len(words) % 3]} \]")) == []


def test_a_root_is_taken_of_a_square_only_where_the_text_does_not_say_that_its_letter_is_negative() -> None:
    step = r"\[ y = x + 1 = \sqrt{a} + 1 \]"
    assert verdicts(rf"With $x^2 = a$, where $x < 0$, we have {step}") == [NOT_JUDGED]
    assert verdicts(rf"With $x^2 = a$, where $x > 0$, we have {step}") == [HOLDS]


DIMENSIONS = [
    "F = m a",
    r"a = \ddot x",
    r"v = \dot x",
    "F = k x",
    r"E = \frac12 m v^2",
    "E = F x",
    "p = m v",
    "P = F v",
]
WRONG_DIMENSIONS = [
    ("F = m a", "F = m v"),
    (r"v = \dot x", r"v = \ddot x"),
    (r"E = \frac12 m v^2", r"E = \frac12 m v"),
    ("E = F x", r"E = F x + F\dot x"),
    ("P = F v", "P = F a"),
    ("p = m v", r"p = m v e^{-x}"),
    ("F = k x", r"F = k x + \hbar v"),
]


@pytest.mark.parametrize(("good", "wrong"), WRONG_DIMENSIONS)
def test_a_wrong_dimension_is_found_where_the_paper_prints_units_and_none_among_pure_numbers(
    good: str, wrong: str
) -> None:
    body = "".join(rf"\[ {each} \]" for each in [*DIMENSIONS, r"P = \hbar\omega^2", wrong])
    units = r"With $m = 2\,\mathrm{kg}$, $x = 3\,\mathrm{m}$ and $v = 0.5\,\mathrm{m/s}$, "
    assert [each.equation for each in findings(units + body) if each.verdict == UNITS] == ["0j"]
    assert UNITS not in verdicts(units + body.replace(rf"\[ {wrong} \]", rf"\[ {good} \]"))
    (why,) = [each.why for each in findings(units + body) if each.verdict == UNITS]
    assert wrong.startswith("E = F x +") or f"unless {wrong[0]} has another meaning here" in why
    assert UNITS not in verdicts(r"With $m = 2$, $x = 3$ and $\hbar = 1$, " + body)


@pytest.mark.parametrize("values", [r"x = 3", r"x = 2.5 t", r"n = 10^{16} + 10^{14} = 10^{16}\,\mathrm{cm^{-3}}"])
def test_numbers_that_may_have_a_unit_say_nothing(values: str) -> None:
    assert UNITS not in verdicts(rf"At $x = 3\,\mathrm{{m}}$, $t = 2\,\mathrm{{s}}$ \[ {values} \]")
    assert UNITS in verdicts(r"At $x = 3\,\mathrm{m}$, $t = 2\,\mathrm{s}$ \[ x = t \]")


def test_a_letter_with_another_meaning_in_another_section_is_no_contradiction() -> None:
    waves = r"\section{Waves} \[ t = 2\,\mathrm{s} \] \[ v = a\omega \] \[ v = l/t \] \[ \omega t = 1 \] \[ a = l \] "
    fall = r"\section{Fall} \[ t = 3\,\mathrm{s} \] \[ v = a t \] \[ l = \frac12 a t^2 \] "
    assert UNITS not in verdicts(waves + fall)
    assert verdicts(waves + fall + r"\[ l = a t^3 \]").count(UNITS) == 1, "against its own section"
    assert UNITS not in verdicts(waves + fall + r"where \[ l = a t^3 \] is the length"), "the text gives a meaning"
    assert UNITS not in verdicts(waves + fall + r"\[ l = a t^3 \] \[ v = a t^2 \]"), (
        "two equations need another meaning"
    )


def test_two_definitions_of_a_letter_are_found() -> None:
    body = "".join(
        rf"\begin{{equation}} {each} \end{{equation}}" for each in ("y = H x", r"H \equiv a + b", "H := a - b")
    )
    assert verdicts(body) == [MEANINGS]
    assert verdicts(body.replace("a - b", "b + a")) == []


def test_definitions_by_each_other_are_not_worked_out_without_end() -> None:
    given = r"\[ x = a + \frac{1}{\tan(y)} \]\[ y = a + \tan(x) \]"
    assert REFUTED not in verdicts(given + r"\[ b = x + y = \tan(x) + y^3 \]")


def test_a_step_that_takes_too_much_work_is_not_judged_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twin: with the whole budget the same step is decided."""
    inner = r"\tan(C - 2 + \frac{1}{C - 1/y} - 1/y)"
    body = rf"\[ b = p {inner} + v = v + p {inner} + \ln(p^2 + 1) - \ln(1 + p^2) \]"
    monkeypatch.setattr(comparison, "MOST_CALLS", 2_000)
    (step,) = findings(body)
    assert (step.verdict, step.why) == (NOT_JUDGED, "the difference is too large")
    monkeypatch.undo()
    for right, verdict in ((rf"v + p {inner}", HOLDS), (rf"v - p {inner}", REFUTED)):
        assert verdicts(rf"\[ b = p {inner} + v = {right} \]") == [verdict]


def test_a_declared_kind_changes_the_reading() -> None:
    source = read_latex(r"\begin{document}\[ E = c(x + 1) - c x = c \]\end{document}")
    assert [each.verdict for each in check_source(source).findings] == [HOLDS], "letters are real numbers"
    assert HOLDS not in [each.verdict for each in check_source(source, declared_notation({"functions": "c"})).findings]


def test_the_command_counts_steps_names_reasons_and_shows_both_members(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = written(tmp_path, SQUARE.replace("SIGN", "-") + r" \[ y = a + a = 2a \] \[ F = -k x = m\ddot x \]")
    assert main(["check", str(file)]) == 1
    said = " ".join("".join(capsys.readouterr()).split())
    assert "(1), step 2: refuted" in said and "·φ̇)² = m·(" in said
    assert "3 displayed equations: 1 step holds, 1 is refuted, 1 is not judged" in said
    assert "the right member has letters that the left one has not (1)" in said
    assert main(["check", str(file), "--json"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert data["steps"] == {"holds": 1, "refuted": 1, "not judged": 1} and len(data["reasons"]) == 1
    (row,) = data["findings"]
    assert sorted(row) == ["equation", "line", "members", "step", "verdict", "why"]
    assert main(["check", str(written(tmp_path, SQUARE.replace("SIGN", "+")))]) == 0
    capsys.readouterr()
    for body, words in (("no formula", "it has no displayed equation"), (r"\input{part}", "part is missing")):
        assert main(["check", str(written(tmp_path, body))]) == 0
        assert words in "".join(capsys.readouterr())


def test_a_finding_in_a_part_has_its_file_and_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "my parts").mkdir()
    (tmp_path / "my parts" / "one.tex").write_text("\n" + SLIP, encoding="utf-8")
    file = written(tmp_path, rf"\input{{my parts/one}} {SLIP}")
    assert main(["check", str(file), "--json"]) == 1
    rows = json.loads(capsys.readouterr().out)["findings"]
    places = [(row.get("file"), row["line"], row["verdict"]) for row in rows]
    assert places == [(str(tmp_path / "my parts" / "one.tex"), 2, REFUTED), (None, 3, REFUTED)]


def test_notation_beside_the_source_is_declared(tmp_path: Path) -> None:
    file = written(tmp_path, r"\[ E = c(x + 1) - c x = 2c \]")
    assert main(["check", str(file)]) == 1
    (tmp_path / "paper.toml").write_text('[notation]\nfunctions = "c"\n', encoding="utf-8")
    assert main(["check", str(file)]) == 0


def test_a_long_source_is_read_and_checked_with_progress(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "long.tex"
    file.write_text("".join(rf"\[ a_{{{n}}} = b^{n} \] " for n in range(501)), encoding="utf-8")
    assert main(["check", str(file)]) == 0
    lines = [line.partition(" s  ")[2] for line in capsys.readouterr().err.splitlines()]
    ranges = "equations 1 to 500", "equations 501 to 501"
    assert [line for line in lines if line] == [f"{what} {each}" for what in ("read", "check") for each in ranges]


def test_a_command_of_a_package_beside_the_source_is_known(tmp_path: Path) -> None:
    (file := tmp_path / "paper.tex").write_text(
        "\\documentclass{article}\n\\usepackage{notation}\n\\begin{document}\n\\[ E = \\twice{x} + x = 3 x \\]\n\\end{document}\n"
    )
    (stop,) = check_source(read_source(file)).findings
    assert stop.verdict == NOT_JUDGED and r"\twice is not known" in stop.why
    (tmp_path / "notation.sty").write_text(r"\newcommand{\twice}[1]{2 #1}")
    assert [each.verdict for each in check_source(read_source(file)).findings] == [HOLDS]


def test_the_three_commonest_reasons_are_counted() -> None:
    steps = (
        [r"\[ y = a = b \]"] * 3
        + [r"\[ y = \frac{\partial f}{\partial x} = \frac{\partial f}{\partial z} \]"] * 2
        + [r"\[ y = a^2 - b^2 = 0 \]", r"\[ y = \]"]
    )
    check: Check = check_source(read_latex(rf"\begin{{document}}{''.join(steps)}\end{{document}}"))
    assert check.counts == {"holds": 0, "refuted": 0, "not judged": 7}
    assert [*check.reasons.values()] == [3, 2, 1]
