# %% [markdown]
# # Chains of rotors with lagrotor and with multibody engines
#
# **Objective.** The processor time for runs of many rotors with this tool and with multibody engines, at the same error.
#
# **Assumptions.** Equal rotors of 10 rad/s in a staircase, massless bars of 1 m, no weight, three seconds from random tilts
# of 0.05 and rates of 0.5 rad/s. The engines use three hinges per rotor. The accelerations under the bars are integrated by
# odeint. They come from Pinocchio's solver for constraints, or from Pinocchio's or Drake's matrices by sparse LU. In MuJoCo
# the bars are tendons of fixed length, and the integrator is Runge–Kutta of fourth order. In Drake's time steps the bars are
# constraints. One machine and one thread, the tools in turns, recorded by `python -m benchmarks.structure_comparison`.
#
# **Notation.** Error: the largest error of a tip's coordinate, m. `simulate` integrates twice for its error estimate; the
# engines give no estimate. With the fast extra both integrations use the vector instructions of the processor and take the
# time of a single integration.

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


def times(seconds: float | None, reference: float | None) -> str:
    return f"{seconds / reference:.1f}" if seconds and reference else "—"


def nearest(n: int) -> Timed:
    """The fastest engine on n rotors."""
    return min(
        (x for x in found if x.n == n and x.seconds and "lagrotor" not in x.tool), key=lambda x: x.seconds or 0.0
    )


wanted = Table(
    "Chains of rotors: target and measurement",
    ("rotors", "fastest engine", "target", "ratio to `simulate` with the fast extra"),
    tuple(
        (
            str(n),
            nearest(n).tool,
            "10",
            times(nearest(n).seconds, ours[n].seconds),
        )
        for n in CHAIN_SIZES
    ),
    "The values are ratios of processor times at the same error. Pinocchio cannot run 256 rotors on this machine, "
    "because its data contain four "
    f"tensors of size 768³, 14 GB. {age}",
)
wanted

# %%
table = Table(
    "Chains of rotors: processor time at equal error",
    (
        "rotors",
        "tool",
        "setting",
        "error (m)",
        "run (ms)",
        "ratio to the fast extra",
        "reason for the limit",
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
    f"The processor times for an error of {CHAIN_ERROR:.0e} m are medians on {machine['processor']}, "
    f"{machine['cores']} cores, Python "
    f"{machine['Python']}, without compilation. A tool without a time did not reach this error with its smallest step, or "
    f"did not run. {age}",
)
table
