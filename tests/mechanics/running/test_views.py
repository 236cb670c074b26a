"""What she sees of a system and its run: formulas, curves, bodies that turn, root loci."""

import base64
import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from scipy.special import mathieu_a, mathieu_b

from lagrotor.errors import InputError
from lagrotor.mechanics import Frame, System, coordinates, reaction, t

I1, I3, m, g, l, mu = sp.symbols("I_1 I_3 m g l mu", positive=True)
C = coordinates("phi theta psi")
BODY = Frame(C).turned("zxz", C.q).body(mass=m, inertia=(I1, I1, I3), centre=(0, 0, l))
TOP = System(C, BODY.kinetic - m * g * l * sp.cos(C.q[1]))
VALUES = {I1: 0.1, I3: 0.15, m: 1, g: 9.81, l: 1}
ONE = coordinates("x y")
(x, y), U, s = ONE.q, sp.Function("U"), sp.Function("y_s")
ROD = System(ONE, m * (ONE.v[0] ** 2 + ONE.v[1] ** 2) / 2 - m * g * y, {"rod": sp.sqrt(x**2 + y**2) - l})


@pytest.fixture(scope="module")
def spinning():
    return TOP.simulate(VALUES, (0, 0.5, 0), (0, 0, 40), np.linspace(0, 1, 101), 1e-9)


def test_a_notebook_shows_the_equations_of_a_system() -> None:
    shown = TOP._repr_markdown_()
    headings = re.findall(r"\*\*(.+)\*\*", shown)
    assert headings == ["Kinetic energy", "Potential energy", "Equations of motion", "Conserved"]
    assert r"$$V = m g l \cos \theta$$" in shown
    assert r"$$I_3 \ddot{\phi} \cos \theta + I_3 \ddot{\psi} - I_3 \dot{\phi} \dot{\theta} \sin \theta = 0$$" in shown
    assert r"$$p_{\psi} = I_3 \dot{\phi} \cos \theta + I_3 \dot{\psi}$$" in shown
    rough = System(ONE, ROD.L, dissipation=mu * ONE.v[0] ** 2)
    assert "Conserved" in ROD._repr_markdown_() and "Dissipation" in rough._repr_markdown_()
    assert "E =" not in rough._repr_markdown_()  # friction takes it


def test_latex_has_functions_dots_and_names() -> None:
    held = System(ONE, ROD.L - U(x - y), {"rod": y - s(t)}, {"slip": ONE.v[0] - s(t).diff(t)})
    lines = held.latex().splitlines()
    assert lines[0] == r"\begin{align}" and lines[-1] == r"\end{align}"
    assert (
        lines[1].startswith(r"m \ddot{x}")
        and r"U'\left(x - y\right)" in lines[1]
        and r"\lambda_{\mathrm{slip}}" in lines[1]
    )
    assert lines[4] == r"\dot{x} - \dot{y}_s\left(t\right) &= 0"


def odd_names() -> System:
    """A bob on a rod with every sign that LaTeX keeps for itself in a name, and coordinates that are no plain letters."""
    c = coordinates(["lambda", "α_in", "γ%", "delta1"])
    kinetic = sum((v**2 for v in c.v), sp.S.Zero) / 2
    held = {"rod & bar_1 50% #2 $ { α": c.q[0] ** 2 + c.q[1] ** 2 - 1, "é": c.q[2] - c.q[3]}
    return System(c, m * kinetic - m * g * c.q[1], held)


def test_any_name_is_latex() -> None:
    lines = odd_names().latex().splitlines()
    rod = r"\lambda_{\mathrm{rod\ \&\ bar\_1\ 50\%\ \#2\ \$\ \{\ \alpha }}"
    # The coordinate's acceleration is no multiplier.
    assert lines[1] == rf"m \ddot{{\lambda}} - 2 \lambda {rod} &= 0 \\"
    assert lines[2] == rf"m \ddot{{\alpha}}_{{in}} + m g - 2 {rod} \alpha_{{in}} &= 0 \\"
    assert lines[3] == r"m \ddot{\gamma\%} - \lambda_{\mathrm{\text{é}}} &= 0 \\"
    assert r"\ddot{\delta}_1" in lines[4]
    c = coordinates("lambda y")  # whose velocity is lambda_dot
    alike = System(c, sum(v**2 for v in c.v) / 2, {"dot": c.q[0], "dot ": c.q[1], "dot_": c.q[0] - 2 * c.q[1]})
    assert len({*alike.multipliers} - {*c.v}) == 3
    for name in ("my x", "1x", "", "{", "_x"):
        with pytest.raises(InputError, match="a name begins with a letter"):
            coordinates([name])


@pytest.mark.skipif(not shutil.which("pdflatex"), reason="pdflatex sets it")
def test_pdflatex_sets_any_name(tmp_path) -> None:
    source = rf"\documentclass{{article}}\usepackage{{amsmath}}\begin{{document}}{odd_names().latex()}\end{{document}}"
    (tmp_path / "names.tex").write_text(source, encoding="utf-8")
    subprocess.run(["pdflatex", "-halt-on-error", "names.tex"], cwd=tmp_path, check=True, capture_output=True)


def test_any_name_stands_beside_its_curve() -> None:
    run = odd_names().simulate({m: 1, g: 9.81}, (0, -1, 0, 0), (1, 0, 0, 0), np.linspace(0, 0.1, 5))
    force = reaction("rod & bar_1 50% #2 $ { α")
    figure = run.plot("γ%", "rod & bar_1 50% #2 $ { α", 2 * run.system.c.v[1], sp.Eq(force, run.system.c.q[1]))
    figure.canvas.draw()  # matplotlib reads the labels
    assert figure.axes[0].get_ylabel() == r"$\gamma\%$" and figure.axes[1].get_ylabel() == "rod & bar_1 50% #2\n\\$ { α"


def test_equations_are_shown_in_velocities_of_ones_own() -> None:
    """Chaplygin's sleigh in u along the blade and omega."""
    c, (I, a, u, omega) = coordinates("x y phi"), sp.symbols("I a u omega", positive=True)
    (X, Y, P), phi = c.v, c.q[2]
    L = m * ((X - a * P * sp.sin(phi)) ** 2 + (Y + a * P * sp.cos(phi)) ** 2) / 2 + I * P**2 / 2
    blade = (Y * sp.cos(phi) - X * sp.sin(phi),)
    own = {u: X * sp.cos(phi) + Y * sp.sin(phi), omega: P}
    system = System(c, L, rolling=blade, velocities=own)
    assert system.latex().splitlines()[1:] == [
        r"\dot{x} &= u \cos \phi \\",
        r"\dot{y} &= u \sin \phi \\",
        r"\dot{\phi} &= \omega \\",
        r"m \dot{u} - m a \omega^{2} &= 0 \\",
        r"\dot{\omega} \left(I + m a^{2}\right) + m a \omega u &= 0",
        r"\end{align}",
    ]  # and not the rolling again, which the first two keep
    assert "Constraints" not in system._repr_markdown_()
    plain = System(c, L, rolling=blade)
    assert r"\ddot" in plain.latex() and "Constraints" in plain._repr_markdown_()


def test_curves_are_those_that_are_named(spinning) -> None:
    figure = spinning.plot("theta", "E", "phi_dot", sp.cos(C.q[1]))
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == [r"$\theta$ (rad)", "$E$ (J)", r"$\dot{\phi}$ (rad/s)", r"$\cos \theta$"]
    assert figure.axes[0].lines[0].get_ydata() == pytest.approx(spinning.q[:, 1])
    assert np.ptp(figure.axes[1].get_ylim()) > 1  # no picture of rounding
    hung = ROD.simulate({m: 1, g: 9.81, l: 1}, (0, -1), (1, 0), np.linspace(0, 1, 11))
    assert hung.plot("rod").axes[0].lines[0].get_ydata() == pytest.approx(hung.reactions["rod"])
    named, rounded = spinning.plot(sp.Eq(sp.Symbol("F"), 2 * C.q[1]), 2.123456 * C.q[1]).axes
    assert (named.get_ylabel(), rounded.get_ylabel()) == ("$F$", r"$2.12 \theta$")
    assert named.lines[0].get_ydata() == pytest.approx(2 * spinning.q[:, 1])
    for what, words in (("thet", "theta?"), ("mass", "is none of"), (U(C.q[0]), "U without a value")):
        with pytest.raises(InputError, match=words):
            spinning.plot(what)


def lines_of(view) -> list[np.ndarray]:
    """The lines that a view's script draws, each (m, p, 3)."""
    held = json.loads(re.search(r"const MOTION = (\{.*\});\n", view.html)[1])
    whole = [(np.frombuffer(base64.b64decode(line["data"]), "<i2"), line["points"]) for line in held["lines"]]
    return [steps.reshape(-1, points, 3) * held["unit"] + held["middle"] for steps, points in whole]


def test_a_view_carries_the_bodies(spinning, tmp_path: Path) -> None:
    view = spinning.view()
    assert "http" not in view.save(tmp_path / "top.html").read_text(encoding="utf-8")  # it needs no network
    rim = max(lines_of(view), key=lambda line: line.shape[1])
    across = np.linalg.svd(rim - rim.mean(1, keepdims=True))[2][:, 2]  # of the rim's plane: the axis of the top
    times = np.linspace(spinning.t[0], spinning.t[-1], len(rim))
    assert np.abs(across[:, 2]) == pytest.approx(np.abs(np.cos(spinning.at(times).q[:, 1])), abs=1e-3)
    [rod] = lines_of(
        ROD.simulate({m: 1, g: 9.81, l: 1}, (0, -1), (1, 0), np.linspace(0, 1, 11)).view([[(0, 0, 0), (x, 0, y)]])
    )
    assert np.linalg.norm(rod[:, 1] - rod[:, 0], axis=1) == pytest.approx(np.ones(len(rod)), abs=1e-3)
    for lines, words in (((), "nothing to draw"), ([(0, 0, 0)], "no line|a point"), ([[(x, y)]], "3 expressions")):
        with pytest.raises(InputError, match=words):
            ROD.simulate({m: 1, g: 9.81, l: 1}, (0, -1), (1, 0), (0, 1)).view(lines)


def test_charts_of_stability_have_the_boundaries_of_textbooks() -> None:
    """Mathieu's tongue between b₁(q) and a₁(q); a rotor with internal damping, stable below k (1 + c_e/c_i) (Merkin, ch. 6)."""
    a, b, k, c_i, c_e, w = sp.symbols("a b k c_i c_e w", positive=True)
    c = coordinates("x")
    swing = System(c, c.v[0] ** 2 / 2 - (a - 2 * b * sp.cos(2 * t)) * c.q[0] ** 2 / 2)
    chart = swing.stability_chart({"x": 0}, {}, {a: np.linspace(0.2, 2, 4), b: [0.3, 0.5]}, period=sp.pi)
    edges = [(f(1, q), q) for q in (0.3, 0.5) for f in (mathieu_b, mathieu_a)]
    np.testing.assert_allclose(chart.boundaries, edges, atol=2e-6)
    assert chart.growth.shape == (2, 4) and (chart.growth[:, 1] > 0.05).all() and chart.growth[:, 3].max() < 1e-6
    c = coordinates("x y")
    (x, y), (vx, vy) = c.q, c.v
    damped = c_e * (vx**2 + vy**2) / 2 + c_i * ((vx + w * y) ** 2 + (vy - w * x) ** 2) / 2
    rotor = System(c, (vx**2 + vy**2) / 2 - k * (x**2 + y**2) / 2, dissipation=damped)
    chart = rotor.stability_chart({x: 0, y: 0}, {k: 4, c_e: 0.1}, {w: np.linspace(1, 8, 4), c_i: [0.05, 0.1, 0.2]})
    late = 1e-6 * 2 / (0.25 * chart.boundaries[:, 1])  # where the growth is a millionth of the largest rate
    np.testing.assert_allclose(chart.boundaries[:, 0], 2 * (1 + 0.1 / chart.boundaries[:, 1]) + late, atol=1e-6)
    (edge,) = rotor.root_locus({x: 0, y: 0}, {k: 4, c_e: 0.1, c_i: 0.05}, w, np.linspace(1, 8, 4)).boundaries
    assert edge == pytest.approx(6 + 1.6e-4, abs=1e-6)
    panel = chart.plot().axes[0]
    assert panel.get_xlabel() == "$w$" and len(panel.lines[0].get_xdata()) == 3
    for numbers, words in (
        ({w: [1, 2]}, "numbers"),
        ({w: [1, 2], k: [1, 2]}, "without w, k"),
        ({w: [1, 2], sp.Symbol("z"): [1, 2]}, "z is no symbol"),
        ({w: [2, 1], c_i: [1, 2]}, "increasing"),
    ):
        with pytest.raises(InputError, match=words):
            rotor.stability_chart({x: 0, y: 0}, {k: 4, c_e: 0.1}, numbers)


def test_a_root_locus_has_its_boundary() -> None:
    """A spinning top stands upright from p² = 4 I₁' m g l on; about three axes, so that its pole is elsewhere."""
    c, w = coordinates("a b s"), sp.Symbol("w", positive=True)
    body = Frame(c).turned("xyz", c.q).body(mass=m, inertia=(I1, I1, I3), centre=(0, 0, l))
    top = System(c, body.kinetic - body.potential((0, 0, -g)))
    locus = top.root_locus({c.q[0]: 0, c.q[1]: 0, c.v[2]: w}, VALUES, w, np.linspace(20, 60, 9))
    assert locus.boundaries == pytest.approx([np.sqrt(4 * 1.1 * 9.81) / 0.15], rel=1e-6)
    assert locus.growth[0] > 1 and abs(locus.growth[-1]) < 1e-6 and locus.boundaries[0] in locus.numbers
    figure = locus.plot()
    assert figure.axes[1].get_xlabel() == "$w$" and len(figure.axes[0].lines) == 6 + 1 + 1
    for values, numbers, words in ((VALUES | {w: 1}, [1, 2], "without w"), (VALUES, [2, 1], "increasing")):
        with pytest.raises(InputError, match=words):
            top.root_locus({c.q[0]: 0, c.q[1]: 0, c.v[2]: w}, values, w, numbers)
