"""What an evaluation of a chain costs when its rotors double: processor time, all in one run, in turns.

`python -m benchmarks.doublings` prints it for massless and for heavy bars, by the core and by the fast extra:
some minutes.
"""

import time
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from itertools import pairwise

import numpy as np

from benchmarks.structure_comparison import MASSLESS, staircase
from lagrotor.benchmark.runner import Array, check_work
from lagrotor.numerics.integrate import Engine
from lagrotor.pair.scene import Link
from lagrotor.process_settings import begin_process
from lagrotor.structures import exact_motion
from lagrotor.structures.exact.compiled_motion import compiled_right_hand_side
from lagrotor.structures.structure import Structure

SIZES = tuple(2**k for k in range(7, 14))
COMPILED = 512  # rotors beyond which the fast extra compiles none
BARS = {"massless": MASSLESS, "heavy": Link(1, 0.3, 0.1)}
_ROUNDS, _SAME = 50, 1e-9
_ROTORS = 60_000  # evaluated in a round of each


def times(structures: Sequence[Structure], engine: Engine, rounds: int = _ROUNDS) -> Array:
    """Processor time of an evaluation of each, in s: the least of the rounds, in which they take turns."""
    evaluated, spent = [_evaluation(s, engine) for s in structures], np.empty((rounds, len(structures)))
    for s, (rhs, y, often) in zip(structures, evaluated, strict=True):
        moving, known = y + np.linspace(0, 1e-3, len(y)), exact_motion(s).rhs
        rates = np.array(known(0.0, moving))
        off = np.abs(np.array(rhs(0.0, moving)) - rates).max() / np.abs(rates).max()
        check_work(f"{len(s.joints)} rotors, {engine}", often, rates[None], float(off), _SAME)
    for taken in spent:
        for k, (rhs, y, often) in enumerate(evaluated):
            began = time.process_time()
            for _ in range(often):
                rhs(0.0, y)
            taken[k] = (time.process_time() - began) / often
    return np.asarray(spent.min(axis=0))


def _evaluation(s: Structure, engine: Engine) -> tuple[Callable[[float, Array], object], Array, int]:
    """The right-hand side, the upright state at rest, and how often it is evaluated in a round."""
    motion, n = exact_motion(s), len(s.joints)
    rhs = compiled_right_hand_side(s, motion) if engine == "fast" else motion.rhs
    return rhs, np.concatenate([motion.c.upright.ravel(), np.zeros(3 * n)]), _ROTORS // n


def table(sizes: Sequence[int] = SIZES, rounds: int = _ROUNDS) -> str:
    """A line for each kind of bar and engine: the ratio of each size to the one before, and the time a rotor of the last."""
    engines: tuple[Engine, ...] = ("core", "fast") if find_spec("heyoka") else ("core",)
    lines = [f"{'rotors':20}" + "".join(f"{n:>8}" for n in sizes[1:]) + "   µs a rotor"]
    for bars, link in BARS.items():
        for engine in engines:
            run = [n for n in sizes if engine == "core" or n <= COMPILED]
            taken = times([staircase(n, link) for n in run], engine, rounds)
            ratios = "".join(f"{more / few:8.2f}" for few, more in pairwise(taken)).ljust(8 * len(sizes) - 8)
            lines.append(f"{bars + ', ' + engine:20}{ratios}{1e6 * taken[-1] / run[-1]:12.3f}")
    return "\n".join(lines)


if __name__ == "__main__":
    begin_process()
    print(table())
