"""Results as they are printed, in a notebook, and as tables of other libraries."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from lagrotor import (
    Paper,
    Pattern,
    Rotor,
    Scene,
    Shock,
    Structure,
    floquet,
    orbit_family,
    pair_precession_rate,
    precession_orbit,
    shock_response,
    simulate,
    sweep,
)
from lagrotor.errors import InputError
from lagrotor.mechanics import Pathway, System, coordinates
from lagrotor.paper import Finding, Part, judge_text
from lagrotor.result_display import text_of
from tests.systems import double_pendulum, heavy_top, henon_heiles

PAIR = Scene(spins=(10, -10))
PAPERS = Path(__file__).parents[2] / "papers"
CORNER = Structure([(0, 0), (1, 0), (1, 1)], [(0, 1), (1, 2)], spins=[30, 0, 30])


PENDULUM = System(C := coordinates("theta"), C.v[0] ** 2 / 2 + sp.cos(C.q[0]))
RESULTS = {
    "Trajectory": lambda: simulate(PAIR, [0, 1]),
    "PrecessionOrbit": lambda: precession_orbit(PAIR, 0.1),
    "OrbitFamily": lambda: orbit_family(PAIR, [0.1, 0.2]),
    "Floquet": lambda: floquet(PAIR, 0.1),
    "ShockResponse": lambda: shock_response(Scene(spins=(10, -10), shock=Shock((4, 0, 0), at=1, width=0.05))),
    "Ensemble": lambda: sweep([PAIR], [0, 1]),
    "Equilibrium": lambda: PENDULUM.equilibria()[1],
    "Modes": CORNER.modes,
    "Standing": CORNER.stands,
    "Characteristic": CORNER.characteristic,
    "StructureRun": lambda: CORNER.simulate([0, 0.1, 0.2]),
    "Dispersion": lambda: Pattern([(0, 0)], [(1, 0)], bars=[(0, 0, 1)], spins=10).dispersion([0.1, 1.0]),
    "Lyapunov": lambda: PENDULUM.simulate({}, (0.5,), (0.0,), [0, 1, 2]).lyapunov(),
}  # fmt: skip


@pytest.mark.parametrize("name", RESULTS)
def test_every_result_is_a_table_in_a_notebook(name: str) -> None:
    result = RESULTS[name]()
    html = result._repr_html_()
    assert html.startswith(f"<table><caption>{name}</caption>")
    assert all(result.summary().values()) and html.count("<tr>") == len(result.summary())
    lines = str(result).split("\n")
    assert lines[0] == name and len(lines) == 1 + len(result.summary())


def test_systems_and_closed_forms_are_printed_in_lines() -> None:
    assert repr(PENDULUM) == "System\n  coordinates  θ\n  L            θ̇²/2 + cos θ"
    assert repr(PENDULUM.equilibria()[1]) == "Equilibrium(θ = π)"
    assert repr(pair_precession_rate()).startswith("pair_precession_rate(θ₁, θ₂, A, B, J, I₃)\n  φ'     (2 A")


m, l, g, k, eps, a = sp.symbols("m l g k epsilon a", positive=True)
SPRING = System(X := coordinates("x"), X.v[0] ** 2 / 2 - k * X.q[0] ** 2 / 2)
VAN_DER_POL = System(X, X.v[0] ** 2 / 2 - X.q[0] ** 2 / 2, forces=(eps * (1 - X.q[0] ** 2) * X.v[0],))
HEAVY = System(C, m * l**2 * C.v[0] ** 2 / 2 + m * g * l * sp.cos(C.q[0]))
# A public result, and lines of its print.
PRINTED = {
    "System": (lambda: HEAVY, "  L            m l² θ̇²/2 + m g l cos θ"),
    "steady motion": (lambda: heavy_top().routh("phi psi").equilibria("p_phi")[0], "  θ      free"),
    "enclosed": (
        lambda: HEAVY.equilibria(values={m: 1, l: 1, g: 9.81}, box={"theta": (2, 4)})[0], "  θ            3.14159",
    ),
    "linear": (lambda: HEAVY.linearise({"theta": 0}), "  equations  M a + C v + K q = 0\n  M          (m l²)"),
    "matrix": (lambda: HEAVY.linearise({"theta": 0}, {m: 1, l: 1, g: 4}), "  A            [ 0  1]\n               [−4  0]"),
    "mode": (lambda: HEAVY.linearise({"theta": 0}).modes()[0], "  rate [1/s]  i √(g/l)"),
    "numeric mode": (
        lambda: double_pendulum().linearise({"alpha": 0, "beta": 0}).modes(dict(zip("mlg", (1, 1, 9.81), strict=True)))[1],
        "  rate [1/s]  2.3972 i\n  shape       (0.707107, 1)",
    ),
    "series": (lambda: HEAVY.lindstedt_poincare(2, a), "  frequency ω [rad/s]  √(g/l) − a² √(g/l)/16 + O(a³)"),
    "averaged": (lambda: VAN_DER_POL.averaged(1, eps), "  polar       r' = ε r/2 − ε r³/8; β' = 0"),
    "integral": (lambda: PENDULUM.noether((0,)), "  conserved  0"),
    "decision": (lambda: PENDULUM.conserved(PENDULUM.energy), "  answer  zero"),
    "Hamiltonian": (lambda: HEAVY.hamiltonian(), "  H            p_θ²/(2 m l²) − m g l cos θ"),
    "normal form": (lambda: henon_heiles().hamiltonian().normal_form(4, {"x": 0, "y": 0}), "  I₁ I₂ in H           1/3"),
    "multipliers": (lambda: SPRING.floquet({"x": 0}, {k: 1}, 1.0), "multiplier 1         0.54030231 ± 0.84147098 i"),
    "locus": (lambda: SPRING.root_locus({"x": 0}, {}, k, [1, 2]), "  stability changes at  no value"),
    "run": (lambda: HEAVY.simulate({m: 1, l: 1, g: 9.81}, {"theta": 1}, t=[0, 1]), "  coordinates      θ"),
    "rotor": (lambda: Rotor(I1=0.5), "  inertias I₁, I₃ [kg m²]  0.5, 1"),
    "shock": (lambda: Shock((4, 0, 0), at=1, width=0.05), "  force [N]  (4, 0, 0) on rotor 1"),
    "scene": (lambda: PAIR, "  spins [rad/s]         10, −10"),
    "structure": (lambda: CORNER, "  bars           0–1, 1–2\n  spins [rad/s]  30, 0, 30"),
    "pattern": (lambda: Pattern([(0, 0)], [(1, 0)], bars=[(0, 0, 1)], spins=10), "  steps [m]      (1, 0)"),
    "paper": (lambda: Paper(PAPERS / "heavy_top"), "  title               The heavy symmetric top"),
    "finding": (lambda: Finding((Part("x grows", True),), "It does."), "  outcome  confirmed\n  parts    x grows: holds"),
    "return map": (
        lambda: henon_heiles().hamiltonian().normal_form(4, {"x": 0, "y": 0, "p_x": 0.1}, {}, period=6.28),
        "  rotation per return 1 [rad]  0.0090750096",
    ),
    "path": (lambda: Pathway.line(X, (0, 0, 0), (X.q[0], 1, 0)), "  length [m]  √(x² + 1)"),
    "claim": (lambda: Paper(PAPERS / "heavy_top").claims["C01"], "  claim      C01"),
    "equation": (lambda: next(iter(Paper(PAPERS / "hoop").equations.values())), "  print     "),
    "line": (lambda: judge_text("sqrt(x**2) = x", ["x >= 0"]).verdict.lines[0], "  line     |x| = x\n  verdict  holds-if"),
    "premise": (lambda: judge_text("sqrt(x**2) = x", ["x >= 0"]).verdict.premises[0], "  premise  x ≥ 0"),
    "judgement": (lambda: judge_text("sqrt(x**2) = x", ["x >= 0"]), "  under the given premise x ≥ 0"),
}  # fmt: skip
_NOISE = re.compile(r"\w+\(\w+=|\d\.\d{13}|\b(\w+): \1\b|\be[-+]\d|\d\*|\*\*|_d?dot|np\.|j\b")


@pytest.mark.parametrize("name", PRINTED)
def test_what_is_printed_are_lines_of_formulas_with_units(name: str) -> None:
    make, lines = PRINTED[name]
    result = make()
    printed = str(result)
    assert lines in printed and (name == "judgement" or not _NOISE.search(printed))
    assert len(printed.splitlines()) < 16
    assert any(hasattr(result, f"_repr_{form}_") for form in ("html", "markdown"))


FORMULAS = {
    "−m g l cos θ": -m * g * l * sp.cos(C.q[0]),
    "m l² θ̇²/2 − m g l": m * l**2 * C.v[0] ** 2 / 2 - m * g * l,
    "sin² θ (g + l)/(2 m)": sp.sin(C.q[0]) ** 2 * (g + l) / (2 * m),
    "1/(3 √a)": 1 / (3 * sp.sqrt(a)),
    "(g + l)^(3/2)": (g + l) ** sp.Rational(3, 2),
    "−1/2": sp.Rational(-1, 2),
    "2.5×10⁻⁹ a": 2.5e-9 * a,
    "g/(m l²) ≤ 1": sp.Le(g / (m * l**2), 1),
    "a long expression": sp.expand((g + l + m + a) ** 6),
    "−3.1 i": 1e-17 - 3.1j,
    "(1, 2 i)": np.array([1 + 1e-17j, 2j]),
    "[1  g l]\n[0    1]": sp.Matrix([[1, g * l], [0, 1]]),
    "∞": float("inf"),
}


@pytest.mark.parametrize("text", FORMULAS)
def test_formulas_are_written_as_by_hand(text: str) -> None:
    assert text_of(FORMULAS[text]) == text


def test_a_film_is_shown_in_a_notebook(tmp_path) -> None:
    film = simulate(PAIR, np.linspace(0, 0.2, 5)).animate(tmp_path / "pair.gif", fps=5)
    assert film.exists() and film._repr_html_().startswith('<img src="data:image/gif;base64,')


def test_a_run_is_a_frame_and_a_dataset_where_they_are_installed() -> None:
    run = simulate(PAIR, [0, 0.5, 1])
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    frame, data = run.to_dataframe(), run.to_xarray()
    assert isinstance(frame, pandas.DataFrame) and isinstance(data, xarray.Dataset)
    assert frame["tips_1_x"].to_numpy() == pytest.approx(run.tips[0, :, 0])
    assert data["tips"].sel(rotor=2, component="z").to_numpy() == pytest.approx(run.tips[1, :, 2])
    assert data["energy"].attrs["units"] == "J"


@pytest.mark.parametrize(("name", "call"), [("pandas", "to_dataframe"), ("xarray", "to_xarray")])
def test_without_the_library_the_way_to_it_is_said(monkeypatch: pytest.MonkeyPatch, name: str, call: str) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(InputError, match=f"pip install {name}"):
        getattr(simulate(PAIR, [0, 1]), call)()
