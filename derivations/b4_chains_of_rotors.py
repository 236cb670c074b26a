# %% [markdown]
# # Chains of rotors beside multibody engines
#
# **Objective.** What a run of many rotors costs with this tool and with engines, at the same error.
#
# **Assumptions.** Equal rotors of 10 rad/s in a staircase, massless bars of 1 m, no weight, three seconds from random tilts
# of 0.05 and rates of 0.5 rad/s. The engines have three hinges a rotor. Accelerations under the bars, integrated by odeint,
# come from Pinocchio's solver for constraints, or from Pinocchio's or Drake's matrices by sparse LU. MuJoCo has the bars as
# tendons of fixed length, with the Runge–Kutta method of fourth order; Drake's own steps have them as constraints. One
# machine and one thread, the tools in turns, recorded by `python -m benchmarks.structure_comparison`.
#
# **Notation.** Error: the largest error of a tip's coordinate, m. `simulate` integrates twice, for its error estimate; the
# engines give none. With the fast extra both integrations run side by side in the processor's vectors, at the price of one.

# %%
import numpy as np

from lagrotor.benchmark.records import CHAIN_ERROR, CHAIN_SIZES, Timed, record_age, recorded_structures
from lagrotor.paper import Table

record, found = recorded_structures()
machine = record["machine"]
age = record_age("structures", record["date"], record["digest"])
ours = {x.n: x for x in found if x.tool == "lagrotor, fast"}


def milliseconds(seconds: float | None) -> str:
    return "—" if seconds is None else f"{1e3 * seconds:.3g}"


def times(theirs: float | None, own: float | None) -> str:
    return f"{theirs / own:.1f}" if theirs and own else "—"


def nearest(n: int) -> Timed:
    """The fastest engine on n rotors."""
    return min(
        (x for x in found if x.n == n and x.seconds and "lagrotor" not in x.tool), key=lambda x: x.seconds or 0.0
    )


wanted = Table(
    "Chains of rotors: wanted and measured",
    ("rotors", "the fastest engine", "wanted", "over `simulate` with the fast extra"),
    tuple(
        (
            str(n),
            nearest(n).tool,
            "10",
            times(nearest(n).seconds, ours[n].seconds),
        )
        for n in CHAIN_SIZES
    ),
    "Multiples of processor time to the same error. Pinocchio does not run 256 rotors here: its data hold four tensors of the "
    f"cube of 768 speeds, 14 GB. {age}",
)
wanted

# %%
table = Table(
    "Chains of rotors: time to one error",
    (
        "rotors",
        "tool",
        "setting",
        "error (m)",
        "a run (ms)",
        "over the fast extra",
        "why not further",
    ),
    tuple(
        (
            str(x.n),
            x.tool,
            f"{x.setting:.0e}",
            f"{x.error:.0e}" if np.isfinite(x.error) else "—",
            milliseconds(x.seconds),
            times(x.seconds, ours[x.n].seconds),
            x.reason or "—",
        )
        for x in found
    ),
    f"Processor time to an error of {CHAIN_ERROR:.0e} m, medians, {machine['processor']}, {machine['cores']} cores, Python "
    f"{machine['Python']}; compiling left out. A tool without a time did not come to that error with its finest step, or "
    f"did not run. {age}",
)
table
