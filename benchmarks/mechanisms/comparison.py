"""Tools on growing mechanisms: time to be ready, time of a right-hand side, time to an error; one process for each.

A tool's right-hand side is first compared with lagrotor's at some states; only what is equal is timed. Runs end at the first
setting whose error is at most MECHANISM_ERROR, the largest of a coordinate (rad) at eleven times of one second; the reference is
scipy's DOP853 at 10⁻¹³ on the right-hand side that all agree on.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.mechanisms.chains import JOINTS, VALUES, chain, start
from benchmarks.mechanisms.engine_tools import ENGINES
from benchmarks.mechanisms.own_tools import OWN
from benchmarks.mechanisms.sympy_tools import SYMPY
from benchmarks.mechanisms.tool import Ready, Rhs, Tool, forget_all, in_own_process
from lagrotor.benchmark.records import LINKS, MECHANISM_ERROR, Measured, MechanismKind
from lagrotor.benchmark.runner import TOLERANCES, check_work
from lagrotor.errors import IntegrationError
from lagrotor.mechanics.running.programs import motion_program
from lagrotor.numerics.codegen import operations

Array = NDArray[np.float64]
TOOLS: dict[str, Tool] = OWN | SYMPY | ENGINES
TIMES = np.linspace(0, 1, 11)
BESIDE = (
    "lagrotor",
    "KanesMethod",
    "LagrangesMethod",
)  # `benchmarks.bodies_and_lagrangians` times ready and rhs of these
SAME = 1e-9  # relative difference of right-hand sides up to which they are equal
_LONGEST = 40.0  # s of processor time, for one tool on one mechanism; beyond, larger ones are left out
_SAMPLES, _SAMPLE = 15, 5e-3


def compare(
    sizes: Mapping[MechanismKind, Sequence[int]] = LINKS,
    tools: Mapping[str, Tool] = TOOLS,
    step: Callable[[str], None] = lambda text: None,
) -> list[Measured]:
    """Every tool on every mechanism, from small to large; a tool that took too long is not given a larger one."""
    results: list[Measured] = []
    for kind, numbers in sizes.items():
        for name, tool in tools.items():
            missing = [module for module in (tool.module, *tool.others) if find_spec(module) is None]
            if missing:
                way = f"{', '.join(missing)} not installed: pip install {tool.install}"
                results.append(Measured(kind, min(numbers), name, reason=way))
                continue
            for n in sorted(numbers):
                step(f"{name}, {n} {kind}")
                results.append(_apart(tool, Measured(kind, n, name)))
                if results[-1].reason:
                    break
    return results


def _apart(tool: Tool, case: Measured) -> Measured:
    """Measured in a new process, which is ended when it takes too long."""
    result = in_own_process(_send, _LONGEST, tool, case)
    return replace(case, reason=result) if isinstance(result, str) else result


def _send(send: Callable[[Measured], None], spend: Callable[[], Any], tool: Tool, case: Measured) -> None:
    spend()
    try:
        send(measure(tool, case))
    except Exception as error:  # whatever another tool raises is its result
        send(replace(case, reason=f"{type(error).__name__}: {str(error)[:200]}"))


def measure(tool: Tool, case: Measured) -> Measured:
    """Ready, compared, timed, run. What is imported or compiled once for a process is so by a smaller mechanism."""
    kind, n = case.kind, case.n
    tool.prepare(kind, 2 if kind == "rods" else 1)
    ready, seconds = _prepared(tool, kind, n)
    ours = chain(kind, n).rhs(VALUES)
    difference = max(_difference(ready.rhs, ours, y) for y in _states(kind, n))
    if not difference < SAME:
        return replace(case, difference=difference, reason=f"its right-hand side differs by {difference:.1e}")
    if case.tool in BESIDE:
        return replace(case, difference=difference, **_run(ready, kind, n))
    y = next(_states(kind, n))
    rhs = _time_of(lambda: ready.rhs(0.0, y))
    return replace(case, ready=seconds, difference=difference, rhs=rhs, **_run(ready, kind, n))


def _prepared(tool: Tool, kind: MechanismKind, n: int) -> tuple[Ready, float]:
    """Ready, and the least time of that: of one where it takes seconds, of five with empty caches where it does not."""
    times: list[float] = []
    while len(times) < 5 and sum(times) < 2:
        forget_all()
        before = _clock()
        ready = tool.prepare(kind, n)
        times.append(_clock() - before)
    return ready, min(times)


def _states(kind: MechanismKind, n: int) -> Any:
    random = np.random.default_rng(1)
    return (random.uniform(-0.5, 0.5, 2 * JOINTS[kind] * n) for _ in range(3))


def _difference(rhs: Rhs, ours: Rhs, y: Array) -> float:
    theirs, own = np.asarray(rhs(0.0, y), float), np.asarray(ours(0.0, y), float)
    return float(np.abs(theirs - own).max() / np.abs(own).max())


def _time_of(call: Callable[[], Any]) -> float:
    """Median processor time of one call, s, over samples of at least _SAMPLE."""
    number, seconds = 1, _sample(call, 1)
    while seconds < _SAMPLE:
        number *= 2
        seconds = _sample(call, number)
    return median(_sample(call, number) for _ in range(_SAMPLES if seconds < 20 * _SAMPLE else 3)) / number


def _clock() -> float:
    """Processor time, s; time.process_time goes in steps of 4 ms while a limit of processor time is set."""
    import resource  # not everywhere

    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def _sample(call: Callable[[], Any], number: int) -> float:
    before = _clock()
    for _ in range(number):
        call()
    return _clock() - before


def _run(ready: Ready, kind: MechanismKind, n: int) -> dict[str, Any]:
    """The least time of a run with at most MECHANISM_ERROR: by the tool's own way, or by scipy's DOP853 or LSODA."""
    begin = start(kind, n)
    truth = _scipy(chain(kind, n).rhs(VALUES), begin, "DOP853", 1e-13)
    check_work(f"the reference of {n} {kind}", len(truth), truth[None], least=len(TIMES))
    ways: list[tuple[str, Callable[[float], Array], tuple[float, ...]]] = [
        (name, partial(_scipy, ready.rhs, begin, name), TOLERANCES[3:]) for name in ("DOP853", "LSODA")
    ]
    if ready.run:
        ways.append(("its own", partial(ready.run, begin, TIMES), ready.settings))
    best: dict[str, Any] = {"run": None, "by": f"no setting reaches {MECHANISM_ERROR:g}"}
    for name, run, settings in ways:
        enough = next((setting for setting in settings if np.abs(run(setting) - truth).max() <= MECHANISM_ERROR), None)
        if enough is not None:
            seconds = _time_of(partial(run, enough))
            if best["run"] is None or seconds < best["run"]:
                best = {"run": seconds, "by": f"{name} at {enough:g}"}
    return best


def _scipy(rhs: Rhs, begin: Array, name: str, tol: float) -> Array:
    """Coordinates (n, N) by one of scipy's solvers."""
    from scipy.integrate import solve_ivp

    solution = solve_ivp(rhs, (0, TIMES[-1]), begin, name, TIMES, rtol=tol, atol=tol)
    if not solution.success:
        raise IntegrationError(f"{name} at {tol:g}: {solution.message}")
    return np.asarray(solution.y.T[:, : len(begin) // 2])


def operation_counts() -> dict[MechanismKind, list[int]]:
    """Operations of one evaluation on each of LINKS."""
    return {kind: [operations(motion_program(chain(kind, n)).program) for n in sizes] for kind, sizes in LINKS.items()}
