"""lagrotor on a mechanism: generated Python with the core packages, and compiled by heyoka with the fast extra."""

from functools import partial

from benchmarks.mechanisms.chains import VALUES, chain
from benchmarks.mechanisms.tool import Array, Ready, Tool
from lagrotor.benchmark.records import MechanismKind
from lagrotor.numerics.integrate import Engine

_TOLERANCES = tuple(10.0**-k for k in range(6, 14))


def _prepare(engine: Engine, kind: MechanismKind, n: int) -> Ready:
    system = chain(kind, n)

    def run(start: Array, times: Array, tol: float) -> Array:
        q, v = start.reshape(2, -1)
        return system.simulate(VALUES, q, v, times, tol, engine).q

    return Ready(system.rhs(VALUES, engine), run, _TOLERANCES)


OWN = {
    "lagrotor": Tool(partial(_prepare, "core")),
    "lagrotor, fast": Tool(partial(_prepare, "fast"), "heyoka", "lagrotor[fast]"),
}
