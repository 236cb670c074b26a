"""The notebooks of the documentation run from top to bottom, and find what their words say."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from matplotlib.figure import Figure

import lagrotor

FOLDER = Path(lagrotor.__file__).parent.parent / "docs" / "tutorials"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="installed without the documentation")


def ran(name: str) -> tuple[dict[str, Any], list[Any]]:
    """The names that a notebook defines, and what each code cell ends in."""
    cells = json.loads((FOLDER / f"{name}.ipynb").read_text(encoding="utf-8"))["cells"]
    names: dict[str, Any] = {}
    ends = []
    for source in ("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"):
        body, _, last = source.rpartition("\n") if "\n" in source else ("", "", source)
        exec(body, names)
        ends.append(eval(last.split("  #")[0], names))
    assert any(isinstance(end, Figure) or hasattr(end, "html") for end in ends), f"{name} shows no picture"
    return names, ends


def test_my_own_pair() -> None:
    names, ends = ran("my_own_pair")
    assert ends[1] == pytest.approx(lagrotor.natural_rate(names["upright"]))
    assert max(ends[3].values()) < 1e-7
    assert ends[4].axes


def test_structures() -> None:
    _, ends = ran("structures")
    assert len(ends[0]) == 10 and ends[1].stands and not ends[2].stands


def test_speed_against_accuracy() -> None:
    _, ends = ran("speed_against_accuracy")
    rows = [ends[1][tol] for tol in sorted(ends[1], reverse=True)]
    assert all(
        true <= estimate <= tol for tol, (_, estimate, true) in zip((1e-4, 1e-6, 1e-8, 1e-10), rows, strict=True)
    )
    assert [evaluations for evaluations, _, _ in rows] == sorted(evaluations for evaluations, _, _ in rows)


def test_the_paired_precession() -> None:
    _, ends = ran("paired_precession")
    assert ends[1] < 1e-7, "the run comes back"
    assert 1e-5 < ends[2] < 0.204**3, "the series through the third order"
    assert (np.diff(ends[3]) < 0).all(), "wider orbits turn more slowly"
    assert ends[4].kind == "hyperbolic"


def test_a_shock_and_what_cancels_it() -> None:
    _, ends = ran("a_shock_and_what_cancels_it")
    rate, force = ends[1]
    assert rate == pytest.approx(-0.37, abs=0.02) and force == pytest.approx(-10.6, abs=0.05)
    without, cancelled = ends[2].values()
    assert abs(without) > 2.5 and abs(cancelled) < 0.1


def test_one_equation_checked() -> None:
    _, ends = ran("one_equation_checked")
    assert ends[0] == "holds" and ends[1] == ("holds-to-order", 2)
    assert ends[-1][0] == "refuted" and ends[-1][2].startswith("holds")


def test_velocities_and_joints() -> None:
    names, ends = ran("velocities_and_joints")
    assert ends[0] is names["top"] and len(ends[0].hamel) == 3 and len(ends[1].hamel) == 2
    assert (
        abs(ends[2][1]) < 1e-6
        and ends[2][0] == pytest.approx(np.sqrt(0.45 * 9), abs=1e-6)
        and names["run"].v.shape[1] == 3
    )
    error, lowest = ends[3]
    assert error < 1e-9 and lowest > 0.99, "a fast top sleeps"
    assert ends[4] == ("zero", True)


def test_an_orbit_proved() -> None:
    pytest.importorskip("flint", reason="the extra `proof` is not installed")
    names, ends = ran("an_orbit_proved")
    assert ends[0] is names["orbit"] and "period [6.69997566437" in ends[1]
    assert ends[2].startswith("theta first passes zero") and ends[3] == "stable"
    assert all(float(x.rad()) < 0.2 for x in ends[4].states) and "is not proved to change it" in ends[5]


def test_from_a_lagrangian() -> None:
    names, ends = ran("from_a_lagrangian")
    assert ends[1] == ((names["phi"],), "zero")
    assert max(ends[3]) < 1e-8 and len(ends[4].axes) == 3


def test_constraints_and_tensions() -> None:
    _, ends = ran("constraints_and_tensions")
    assert ends[2] < 1e-6 and ends[3] < 1e-10


def test_rolling() -> None:
    names, ends = ran("rolling")
    w, g, r = (names[letter] for letter in "wgr")
    (s,) = ends[1].free_symbols - {w, g, r}
    assert (ends[1] - s**6 * (s**2 + 12 * w**2 / 5 - 4 * g / (5 * r))).expand() == 0
    assert "canvas" in ends[2].html and 0.9 < ends[3] < 1


def test_small_motions() -> None:
    names, ends = ran("small_motions")
    g, l, k, m = (names[letter] for letter in "glkm")
    squares = {(rate**2).expand() for rate in ends[0]}
    assert squares == {-g / l, (-g / l - 2 * k / (l**2 * m)).expand()}
    assert ends[1][0] is sp.true and not any(ends[1][1].subs({m: 1, g: 1, l: 1, k: x}) for x in (0.1, 0.6, 2))
    assert 1e-9 < ends[3] < 1e-6


def test_control() -> None:
    _, ends = ran("control")
    assert ends[0].shape == (4, 4) and len(ends[1]) == 4 and ends[3] < 0.05


def test_from_a_robot_file() -> None:
    """An upright double pendulum has two unstable directions; a torque's symbol has no value in the description."""
    names, ends = ran("from_a_robot_file")
    A, B, rates = ends[1]
    assert abs(names["run"].q[-1] - [np.pi, 0]).max() < 0.05
    assert len(ends[0]) == 11 and A.shape == (4, 4) and B.shape == (4, 2) and sum(rate.real > 0 for rate in rates) == 2
    assert [name for name, (_, value) in ends[4].items() if value is None] == ["tau_elbow", "tau_shoulder"]


def test_from_sympy() -> None:
    _, ends = ran("from_sympy")
    assert ends[2] < 1e-12


def test_every_notebook_has_its_test_an_opening_and_no_output() -> None:
    stems = sorted(path.stem for path in FOLDER.glob("*.ipynb"))
    assert stems == [
        "a_shock_and_what_cancels_it",
        "an_orbit_proved",
        "constraints_and_tensions",
        "control",
        "from_a_lagrangian",
        "from_a_robot_file",
        "from_sympy",
        "my_own_pair",
        "one_equation_checked",
        "paired_precession",
        "rolling",
        "small_motions",
        "speed_against_accuracy",
        "structures",
        "the_pair_in_thirty_lines",
        "velocities_and_joints",
    ]
    for stem in stems:
        cells = json.loads((FOLDER / f"{stem}.ipynb").read_text(encoding="utf-8"))["cells"]
        title, _, opening = "".join(cells[0]["source"]).partition("\n\n")
        headings = [
            line for cell in cells[1:] if cell["cell_type"] == "markdown" for line in cell["source"] if line[0] == "#"
        ]
        assert title.startswith("# ") and not any(line.startswith("# ") for line in headings), f"{stem}: one title"
        assert "This page" in opening, f"{stem}: say first what the page shows"
        assert not any(cell.get("outputs") for cell in cells), f"{stem}: clear the outputs before it is committed"


def test_the_pair_in_thirty_lines() -> None:
    names, ends = ran("the_pair_in_thirty_lines")
    assert ends[1].tex.startswith(r"\mathcal L = ") and r"\dot{\theta}_1" in ends[1].tex
    assert ends[2].tex.startswith("0 = k") and (ends[3].name, ends[4].name) == ("A", "B")
    assert names["rate"].expressions == ends[5].expressions and ends[6].error < 1e-11
    assert 1e-3 < ends[7] < 2e-3 and ends[8] == "0.43%, 7.910 and 7.918 rad/s"
