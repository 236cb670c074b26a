"""Small families for the tests of sweeps, whose runs need a moment."""

from dataclasses import fields, replace
from typing import Any

import numpy as np

from lagrotor import Link, Scene, Shock
from lagrotor.models import Ensemble
from lagrotor.models.minimal import scenes_from_states

T = [0.0, 0.3, 0.6]
STATE = np.array([0.1, 0.05, 0.02, 0.3, 1.2, -0.4])


def family(n: int) -> list[Scene]:
    """n scenes of several kinds: with bars of two lengths, without one, and with shocks."""
    scenes = []
    for length in (1.0, 1.4):
        scenes += scenes_from_states(Scene((10.0, -8.0), link=Link(length)), STATE * np.linspace(0.3, 1, n)[:, None])
    chosen = [scenes[i + n * (i % 2)] for i in range(n)]
    chosen[1::7] = [replace(scene, link=None) for scene in chosen[1::7]]
    chosen[2::7] = [replace(scene, shock=Shock((5, -2, 1), 0.2, 0.03, 2)) for scene in chosen[2::7]]
    return chosen


def columns_of(runs: Ensemble) -> dict[str, Any]:
    scenes = runs.scenes.columns  # type: ignore[attr-defined]
    inputs = {f"scene {field.name}": getattr(scenes, field.name) for field in fields(scenes)}
    names = ("t", "axes", "rates", "errors", "evaluations", "models")
    return inputs | {name: getattr(runs, name) for name in names} | {"endings": np.array([*map(str, runs.endings)])}


def assert_same_bits(runs: Ensemble, expected: Ensemble) -> None:
    ours, theirs = columns_of(runs), columns_of(expected)
    for name, values in theirs.items():
        np.testing.assert_array_equal(ours[name], values, err_msg=name)
