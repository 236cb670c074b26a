"""Results in a notebook and as tables of other libraries."""

import sys

import numpy as np
import pytest
import sympy as sp

from lagrotor import (
    Pattern,
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
from lagrotor.mechanics import System, coordinates

PAIR = Scene(spins=(10, -10))
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
    lines = repr(result).split("\n")
    assert lines[0] == name and len(lines) == 1 + len(result.summary())


def test_systems_and_closed_forms_are_printed_in_lines() -> None:
    assert repr(PENDULUM) == "System\n  coordinates  theta\n  L            theta_dot**2/2 + cos(theta)"
    assert repr(PENDULUM.equilibria()[1]) == "Equilibrium\n  theta  pi"
    assert repr(pair_precession_rate()).startswith(
        "pair_precession_rate(theta_1, theta_2, A, B, J, I_3)\n  phi'   (2*A"
    )


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
