"""Section 6: the conclusion. What it assumes, its twins, and the modes against numbers."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Scene, simulate
from lagrotor.mechanics import degrees_of_freedom
from lagrotor.pair import axes_pair
from lagrotor.pair.notation import G_1, G_2, G, a, b
from lagrotor.paper.ledger import decide
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.paper.verdicts import Relation, Statement

STEM = "s6_conclusion"
BAR = Link(mass=1, inertia=1)


def names() -> dict[str, Any]:
    return PAPER.scripts.run("derivations", STEM)


@cache
def stated() -> dict[str, Statement]:
    return {s.id: s for s in PAPER.statements(STEM)}


def test_equal_spins_have_other_modes() -> None:
    """The physics changed: the steady motion is then the twist y_1 = −y_2, and the oscillation the circle y_1 = y_2."""
    for relation in stated()["6.01"].relations[-2:]:
        assert relation.scene == {G_2: -G_1}
        equal = replace(relation, scene={G_2: G_1})
        assert decide(replace(stated()["6.01"], relations=(equal,))).verdict == "refuted"
        turned = replace(equal, printed=sp.Matrix([relation.printed[0], -relation.printed[1]]))
        assert decide(replace(stated()["6.01"], relations=(turned,))).verdict == "holds-if"


def test_without_the_bar_there_are_more_degrees_of_freedom() -> None:
    free = degrees_of_freedom(axes_pair(bar=False), names()["upright"])
    assert free == names()["without_spins"] + 1
    line = next(r for r in stated()["6.01"].relations if "without" in r.quantity)
    changed = Relation(line.printed, sp.Integer(free), quantity=line.quantity)
    assert decide(replace(stated()["6.01"], relations=(changed,))).verdict == "refuted"


def test_what_the_linear_pair_keeps_is_kept_on_a_small_run() -> None:
    """Position and twist of the precession centre, along a run of the exact pair after a small kick; y_1 − y_2 alone is not."""
    size = 1e-4
    kicked = Scene(spins=(10, -10), link=BAR, rates=((size, size, 0), (size, -size, 0)))
    run = simulate(kicked, np.linspace(0, 2, 101), "spheres", 1e-12)
    big, coupled = kicked.inertias
    (x, y, _), (x_v, y_v, _) = (np.moveaxis(part, -1, 0) for part in (run.axes, run.rates))
    centre = x[0] - (big - coupled) * (y_v[0] - y_v[1]) / 20, y[0] - y[1] + 2 * (big + coupled) * x_v[0] / 10
    assert max(np.ptp(part) for part in centre) < 30 * size**2
    assert np.ptp(y[0] - y[1]) > 0.1 * size
    kept = names()["kept"].subs({a: big, b: coupled, G: 10})
    named = {str(s): s for s in kept.free_symbols}
    start = {"y_1_dot": size, "y_2_dot": -size, "x_dot": size, "y_1": 0, "y_2": 0, "x": 0}
    expected = kept.subs({symbol: start[name] for name, symbol in named.items()})
    assert [part[0] for part in centre] == pytest.approx([float(e) for e in expected], rel=1e-9)
