"""Renew reference.json: `python tests/benchmark/renew_reference.py`, about a minute.

Gragg's midpoint rule, extrapolated (Hairer, Nørsett & Wanner, II.9), with thirty digits in both formulations: another
method, another arithmetic than anything in the package.
"""

import json
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np

from lagrotor import Scene
from lagrotor.benchmark.scenes_and_methods import AMPLITUDE, SERIES_ORDER
from lagrotor.models import minimal, spheres
from lagrotor.numerics.printers import compile_program
from lagrotor.theory import series_orbit

TARGET = Path(__file__).with_name("reference.json")
COLUMNS, STEPS_A_SECOND = 13, 20


def step(f: Any, y: list[Any], H: Any) -> list[Any]:
    table: list[list[Any]] = []
    for j in range(COLUMNS):
        n = 2 * (j + 1)
        h = H / n
        before, now = y, [a + h * b for a, b in zip(y, f(y), strict=True)]
        for _ in range(n - 1):
            before, now = now, [a + 2 * h * b for a, b in zip(before, f(now), strict=True)]
        row = [[(a + b + h * c) / 2 for a, b, c in zip(before, now, f(now), strict=True)]]
        for k in range(1, j + 1):
            factor = mp.mpf(n) ** 2 / (2 * (j - k + 1)) ** 2 - 1
            row.append([a + (a - b) / factor for a, b in zip(row[k - 1], table[k - 1], strict=True)])
        table = row
    return table[-1]


def states(module: Any, scene: Scene, seconds: int) -> list[list[Any]]:
    """States at 1, 2, … seconds."""
    program, parameters = module.MODEL.program(scene, False)
    function = compile_program(program, "mpmath")
    values = [mp.mpf(p) for p in parameters]
    y, kept = [mp.mpf(float(x)) for x in module.MODEL.start(scene)], []
    for _ in range(seconds):
        for _ in range(STEPS_A_SECOND):
            y = step(lambda y: function(*y, *values), y, mp.mpf(1) / STEPS_A_SECOND)
        kept.append(y)
    return kept


def renew() -> None:
    mp.mp.dps = 30
    scene = series_orbit(Scene((10, -10)), AMPLITUDE, SERIES_ORDER).start
    one = states(minimal, scene, 10)
    axes = minimal.MODEL.observe(scene, np.array(one, dtype=float)).axes
    other = np.array(states(spheres, scene, 10), dtype=float)
    apart = float(np.abs(axes - spheres.MODEL.observe(scene, other).axes).max())
    data = {
        "times": list(range(1, 11)),
        "states": [[mp.nstr(x, 25) for x in row] for row in one],
        "axes": axes.tolist(),
        "formulations_apart": apart,
        "scene": {"axes": scene.axes, "rates": scene.rates},
    }
    TARGET.write_text(json.dumps(data, indent=1) + "\n")
    print("formulations apart:", apart)


if __name__ == "__main__":
    renew()
