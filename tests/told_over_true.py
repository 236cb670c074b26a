"""How tight and how safe the estimate of a run is, and what a run costs, on random scenes, systems and structures.

`python -m tests.told_over_true scenes|systems|structures SEED COUNT [dense]` prints a line for what is remarkable and a summary.
An error is told as the largest up to a time. dense: the true one is sought at 64 times more than the trial's own; else it is
too small by what happens between the samples.
"""

import sys
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from lagrotor import simulate
from lagrotor.errors import LagrotorError, LagrotorWarning
from lagrotor.numerics.calibrated import LOST
from lagrotor.structures import exact_motion
from lagrotor.structures.exact.closing import start_state
from lagrotor.structures.exact.compiled_motion import right_hand_side

FINE = np.arange(1, 65) / 64
ROUNDED = 1e-13  # a true error below which told over true says nothing of the estimate: it is rounding
TOLERANCES = 10.0 ** -np.arange(1, 14, 0.5)  # of plain DOP853


@dataclass(frozen=True)
class Told:
    """A run and what is true of it. under: the most by which a true error up to a time exceeds what is told of it."""

    name: str
    tol: float
    told: float
    true: float
    under: float
    warned: bool
    evaluations: int
    plain: float = np.nan

    @property
    def silent(self) -> bool:
        return self.true > self.tol and not self.warned

    def __str__(self) -> str:
        return (
            f"{self.name}: tol {self.tol:.1e}, told {self.told:.2e}, true {self.true:.2e}, true/told {self.under:.3g}, "
            f"{self.evaluations} evaluations, {self.evaluations / self.plain:.3g} times DOP853's"
            f"{', warned' if self.warned else ''}"
        )


def told(name: str, tol: float, run: Any, off: np.ndarray, unsure: np.ndarray | float, warned: bool) -> Told:
    """off (n,): how far the run is from the exact motion at each of its times, its reference's own error included."""
    surely = np.maximum.accumulate(np.maximum(off - unsure, 0.0))
    under = float((surely / run.errors).max())
    return Told(name, tol, run.error, float(surely[-1]), under, warned, run.evaluations)


def quietly(door: Any, *given: Any, **more: Any) -> tuple[Any, bool]:
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        run = door(*given, **more)
    return run, any(issubclass(w.category, LagrotorWarning) for w in said)


def least_evaluations(rhs: Any, start: Any, t: np.ndarray, sizes: Any, off: Any, error: float) -> float:
    """Evaluations of one call of scipy's DOP853 whose largest error, off(its states (n, d)), is at most `error`; NaN where that
    is one of which nothing is known: any run has it."""
    if error > LOST.value:
        return np.nan
    for local in TOLERANCES:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            alone = solve_ivp(rhs, (t[0], t[-1]), start, "DOP853", t, rtol=max(local, 2.3e-14), atol=local * sizes)
        if alone.success and off(alone.y.T) <= max(error, 1e-15):
            return float(alone.nfev)
    return np.nan


def with_fine(t: np.ndarray, dense: bool) -> np.ndarray:
    return np.union1d(t, t[0] + (t[-1] - t[0]) * FINE[:-1]) if dense else t


def scenes(seed: int, count: int, dense: bool, most_turns: float = 100.0) -> Iterator[Told]:
    """Wide scenes (80-bit references by heyoka) in which neighbours part less than ten-thousandfold."""
    from tests.models.oracle import exact_axes
    from tests.models.wide_scenes import turns, wide_scenes

    rng = np.random.default_rng(0)
    for i, trial in enumerate(wide_scenes(seed, count, most_turns)):
        if turns(trial) > most_turns:
            continue
        t = with_fine(np.append(0.0, trial.t), dense)
        exact = exact_axes(trial.scene, t[1:])
        beside = exact_axes(trial.scene, t[1:], 1e-17, rng.normal(size=(2, 2, 3)) * 1e-10)
        own = np.abs(exact - exact_axes(trial.scene, t[1:], 1e-17)).max((0, 2))
        growth = np.abs(beside - exact).max((0, 2)) / 1e-10
        if not (np.isfinite(exact).all() and growth.max() < 1e4):
            continue
        try:
            run, warned = quietly(simulate, trial.scene, t, tol=trial.tol)
        except LagrotorError:
            continue
        if run.ending.early or not run.evaluations or run.model not in ("minimal", "spheres"):
            continue
        off = np.append(0.0, np.linalg.norm(run.axes[:, 1:] - exact, axis=-1).max(0)).astype(float)
        axes = np.array(trial.scene.axes)
        near = np.linalg.norm(axes[:, 1:]) if trial.scene.link and axes[0, 0] * axes[1, 0] > 0.9 else 1.0
        rounding = 10 * 2.0**-64 / max(near, 1e-9) * growth * (near < 1e-3)
        yield told(f"scene {seed}/{i}", trial.tol, run, off, np.append(0.0, 2 * own + rounding).astype(float), warned)


def systems(seed: int, count: int, dense: bool) -> Iterator[Told]:
    """Systems of all kinds, their numbers from `seed` on."""
    from tests.mechanics.running import references

    sparse = references._times
    references._times = lambda *given: with_fine(sparse(*given), dense)
    try:
        for number in range(seed, seed + count):
            given = references.drawn(number)
            run, warned = quietly(given.system.simulate, given.values, given.q, given.v, given.t, given.tol)
            if run.ending.early:
                continue
            exact, distance = given.exact(), run.scales.distance
            off = distance(np.hstack([run.q, run.v]), exact)
            one = told(f"{given.name} {number}", given.tol, run, off, 1e-15, warned)
            least = least_evaluations(
                given.system.rhs(given.values), exact[0], given.t, run.scales.sizes,
                lambda y, exact=exact, distance=distance: distance(y, exact).max(), one.true,
            )  # fmt: skip
            yield Told(**{**vars(one), "plain": least})
    finally:
        references._times = sparse


def structures(seed: int, count: int, dense: bool) -> Iterator[Told]:
    from tests.structures.extended import exact as exact_structure
    from tests.structures.test_told_error import drawn

    rng = np.random.default_rng(seed)
    while count:
        try:
            s, given, tol = drawn(rng)
            given["t"] = with_fine(np.asarray(given["t"]), dense)
            run, warned = quietly(s.simulate, **given, tol=tol)
        except LagrotorError:  # a tilt that the bars do not allow
            continue
        if run.ending.early:
            continue
        axes, drift = exact_structure(s, run.axes[:, 0], run.rates[:, 0], run.t)
        if drift > 1e-15:
            continue
        count -= 1
        exact, n = axes.astype(float), len(axes)
        off = np.linalg.norm(run.axes - exact, axis=-1).max(0)
        one = told(f"structure {seed}/{count}", tol, run, off, 1e-15, warned)
        motion = exact_motion(s)
        start = start_state(motion, given["tilt"], given["rates"])
        least = least_evaluations(
            right_hand_side(motion), start, motion.c.rate * (run.t - run.t[0]), 1.0,
            lambda y, n=n, exact=exact: np.linalg.norm(
                y[:, : 3 * n].reshape(-1, n, 3).swapaxes(0, 1) - exact, axis=-1
            ).max(), one.true,
        )  # fmt: skip
        yield Told(**{**vars(one), "plain": least})


def summary(rows: list[Told]) -> str:
    ratios = np.array([row.told / row.true for row in rows if row.true > ROUNDED])
    under, cost = np.array([row.under for row in rows]), np.array([row.evaluations / row.plain for row in rows])
    cost = cost[np.isfinite(cost)]
    nearest = ", ".join(f"{row.name} {row.under:.3g}" for row in sorted(rows, key=lambda row: -row.under)[:5])
    dear = ", ".join(f"{x:.3g}" for x in np.sort(cost)[:-4:-1])
    return (
        f"{len(rows)} runs, {len(ratios)} above rounding: told/true median {np.median(ratios):.3g}, quartiles "
        f"{np.quantile(ratios, 0.25):.3g} and {np.quantile(ratios, 0.75):.3g}; under-told {int((under > 1).sum())}, silent "
        f"{sum(row.silent for row in rows)}; largest true/told: {nearest}"
        + (f"; over DOP853's evaluations median {np.median(cost):.3g}, most {dear} of {len(cost)}" if len(cost) else "")
    )


if __name__ == "__main__":
    kind, seed, count = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    rows = list[Told]()
    for row in {"scenes": scenes, "systems": systems, "structures": structures}[kind](seed, count, "dense" in sys.argv):
        rows.append(row)
        if row.under > 0.3 or row.silent or row.evaluations > 8 * row.plain or "all" in sys.argv:
            print(row, flush=True)
    print(summary(rows))
