"""Paired precessions of many pairs side by side, in numbers of 64 bits: the reference for the errors that orbits give.

Newton's method from the orbits that are tested; the flow and its slope by extrapolated steps of the midpoint rule (Gragg), whose
weights are rational, so that the steps are as exact as the numbers.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from lagrotor import Scene
from lagrotor.models.minimal import MODEL, program
from lagrotor.numerics.codegen import tangent_program
from lagrotor.numerics.printers import compile_program

Long = np.longdouble
ENOUGH = bool(np.finfo(Long).eps < 2e-19)  # a mantissa of 64 bits
SUBSTEPS = (2, 4, 6, 8, 10)  # order 10
SMALL = 1e-15  # step of Newton's method, relative, that changes no more
MOST = 6  # of them
TOGETHER = 1_000  # orbits side by side
A, B = np.array([[1, -1, -1, -1, 1, 1], [-1, 1, -1, 1, -1, 1]])[..., None]  # reversals, as in `orbits.floquet`


Found = tuple[Scene, float]  # a scene that starts on an orbit, nearly, and the orbit's frequency


class Orbits(NamedTuple):
    """Of n orbits: u = artanh r_0 and the two rates at Phi = 0 (n, 3), the time of a quarter (n,), axes and rates over it
    (n, 2, steps + 1, 3), mu + 1/mu − 2 (n,)."""

    start: Any
    time: Any
    axes: Any
    rates: Any
    excess: Any


@cache
def rate_of(kind: tuple[Any, ...]) -> Callable[..., Any]:
    """(state with its slope (42, n), parameters) → its rate."""
    whole = program(*kind)
    directions = dict(zip(whole.arguments, np.eye(6, dtype=int).tolist(), strict=False))
    numbers = compile_program(
        tangent_program(replace(whole, outputs=whole.outputs[3:]), directions, whole.arguments), "numpy"
    )

    def rate(y: Any, parameters: Any) -> Any:
        out = np.empty_like(y)
        values = numbers(*y[:6], *parameters)
        out[:3], out[6:24] = y[3:6], y[24:]
        slope = y[6:].reshape(6, 6, -1)
        for i in range(3):
            out[3 + i] = values[i]
            row = values[3 + 6 * i : 9 + 6 * i]
            out[24 + 6 * i : 30 + 6 * i] = sum(part * slope[j] for j, part in enumerate(row) if np.ndim(part) or part)
        return out

    return rate


def extrapolated_step(rate: Callable[[Any], Any], y: Any, first: Any, step: Any) -> Any:
    """One step of the midpoint rule with several numbers of parts, extrapolated to none (Aitken–Neville in their squares)."""
    table: list[Any] = []
    for n in SUBSTEPS:
        h = step / n
        before, now = y, y + h * first
        for _ in range(n - 1):
            before, now = now, before + 2 * h * rate(now)
        row = [(before + now + h * rate(now)) / 2]
        for k, other in enumerate(table, 1):
            row.append(row[-1] + (row[-1] - other) / ((Long(n) / SUBSTEPS[len(table) - k]) ** 2 - 1))
        table = row
    return table[-1]


def exact_orbits(found: Sequence[Found], amplitudes: Sequence[float], steps: int = 40, turning: bool = False) -> Orbits:
    """The orbits of those amplitudes, from the found ones; half the steps leave 10⁻¹¹ of mu + 1/mu near a family's end.

    turning: of the found ones' rates of turning about the joint line at Phi = 0, up to which they close.
    """
    kinds: dict[Any, list[int]] = {}
    for i, (scene, _) in enumerate(found):
        kinds.setdefault(MODEL.kind(scene, False)[0], []).append(i)
    parts, places, radii = list[Orbits](), list[int](), np.array(amplitudes, Long)
    for kind, alike in kinds.items():
        for begin in range(0, len(alike), TOGETHER):
            those = alike[begin : begin + TOGETHER]
            parts.append(_of_one_kind(kind, [found[i] for i in those], radii[those], steps, turning))
            places += those
    order = np.argsort(places)
    return Orbits(*(np.concatenate(part)[order] for part in zip(*parts, strict=True)))


def _of_one_kind(kind: tuple[Any, ...], found: Sequence[Found], amplitudes: Any, steps: int, turning: bool) -> Orbits:
    rows, free = ([0, 4], [4]) if turning else ([0, 2, 4], [4, 5])
    n, rate = len(found), rate_of(kind)
    parameters = np.array([MODEL.kind(scene, False)[1] for scene, _ in found], Long).T
    z = np.array([MODEL.start(scene)[[0, 4, 5]] for scene, _ in found], Long)
    z[:, 0] = np.arctanh(amplitudes)
    time = np.array([np.pi / 2 / abs(frequency) for _, frequency in found], Long)
    for _ in range(MOST):
        states = [np.zeros((42, n), Long)]
        states[0][[0, 4, 5]], states[0][6:] = z.T, np.eye(6).reshape(36, 1)
        for _ in range(steps):
            y = states[-1]
            states.append(extrapolated_step(lambda y: rate(y, parameters), y, rate(y, parameters), time / steps))
        end, slope = states[-1][:6].T, states[-1][6:].reshape(6, 6, n).transpose(2, 0, 1)
        moved = np.stack([*slope[:, rows][:, :, free].transpose(2, 0, 1), rate(states[-1], parameters)[rows].T], axis=2)
        step = -np.linalg.solve(moved.astype(float), end[:, rows, None].astype(float))[..., 0]
        if np.abs(step / np.stack([z[:, 1], *[time] * len(free)], axis=1)).max() < SMALL:
            break
        z[:, 1 : len(rows)] += step[:, :-1]
        time = time + step[:, -1]
    else:
        raise AssertionError("Newton's method does not end")
    half, known = np.zeros_like(slope), slope.astype(float)
    for _ in range(3):  # B slope over slope, by remainders
        half += np.linalg.solve(known, (B * slope - slope @ half).astype(float))
    half = A * half
    excess = np.einsum("nij,nji->n", half, half) - 6
    seen = [MODEL.observe(scene, np.array([y[:6, i] for y in states], float)) for i, (scene, _) in enumerate(found)]
    return Orbits(z, time, np.array([one.axes for one in seen]), np.array([one.rates for one in seen]), excess)
