# %% [markdown]
# # Mechanisms of increasing size with lagrotor and with other tools
#
# **Objective.** The processor time for a mechanism with this tool and with others: for preparation, for one right-hand side,
# and for a run.
#
# **Assumptions.** Rods of $l = 0.7$ m with $m = 1.3$ kg at their ends in a plane, relative angles; gyroscopes of $I_1 = 0.3$,
# $I_3 = 0.2$ kg m² on each other's tips. Each tool is used as its documentation recommends, in a separate process. Before the
# timing, the right-hand sides of all tools agree to $10^{-9}$. The results are from one machine, recorded by
# `python -m benchmarks.mechanisms --record`. The numbers of operations are the same on every machine.
#
# **Notation.** $n$ the number of rods or gyroscopes; ready: the time from the description of the mechanism to its right-hand
# side, including compilation; rhs: the time of one evaluation from Python.

# %%
from lagrotor.benchmark.mechanism_tables import (
    COMPARISON_HEAD,
    DECISION_HEAD,
    MECHANISM_HEAD,
    TARGET_HEAD,
    comparison_rows,
    decision_rows,
    mechanism_rows,
    target_rows,
)
from lagrotor.benchmark.records import LINKS, record_age, recorded_bodies_and_lagrangians, recorded_mechanisms
from lagrotor.paper import Table

found = recorded_mechanisms()
beside = recorded_bodies_and_lagrangians()
where, where_beside = (
    f"{machine['processor']}, {machine['cores']} cores, Python {machine['Python']}"
    for machine in (found.machine, beside["machine"])
)
age = record_age("mechanisms", found.date, found.digest)
age_beside = record_age("bodies_and_lagrangians", beside["date"], beside["digest"])
versions = ", ".join(f"{name} {number}" for name, number in found.versions.items())
each = {kind: (found.operations[kind][-1] - found.operations[kind][-2]) // (n[-1] - n[-2]) for kind, n in LINKS.items()}

# %% [markdown]
# ## Targets and measurements

# %%
tables = [
    Table(
        "Mechanisms: targets and measurements",
        TARGET_HEAD,
        tuple(target_rows(found.measured, found.decided, found.operations, beside["rows"])),
        "The values are ratios of processor times, each within one record. The ratios of rods and gyroscopes to sympy "
        "and the time to be "
        "ready are from the table of the comparison with sympy, the others from the tables of tools and of decisions. "
        f"{age_beside} Each additional rod requires {each['rods']} operations, each additional gyroscope "
        f"{each['gyroscopes']}. The first body, on the ground, requires much fewer ({found.operations['gyroscopes'][0]} for a "
        "gyroscope). A chain of double length therefore requires more than twice the operations, especially a short chain.",
    ),
    Table(
        "Mechanisms: processor times of the tools",
        MECHANISM_HEAD,
        tuple(mechanism_rows(found.measured)),
        f"The processor times are medians on {where} ({versions}). For lagrotor and sympy's methods, the columns ready and "
        "rhs are in the table that compares them with sympy. The run has a length of one second, and its error "
        "is the largest at eleven times. The integrator is the fastest of scipy's DOP853, LSODA and the tool's integrator. "
        "symbrim is not included: it has "
        f"bicycles, riders and a rolling disc, but neither of these mechanisms. {age}",
    ),
    Table(
        "Mechanisms: decisions whether two formulations agree",
        DECISION_HEAD,
        tuple(decision_rows(found.decided)),
        f"Both columns make the same steps, with the exact decision or with sympy's simplify in its place, in a "
        f"separate run. {age}",
    ),
    Table(
        "Mechanisms from bodies and from a Lagrangian, compared with sympy",
        COMPARISON_HEAD,
        tuple(comparison_rows(beside["rows"], beside["longest"])),
        "Mechanisms from bodies are compared with KanesMethod, mechanisms from an explicit Lagrangian with LagrangesMethod; "
        "the time of writing the Lagrangian is included. LagrangesMethod uses sympy's energies of the same bodies, for the "
        "bicycle lagrotor's energies. sympy's right-hand sides use lambdify with common subexpressions, then numpy's solve. "
        "The column 'rhs differs by' gives the relative difference from lagrotor's right-hand side of bodies. A method was "
        f"stopped after {beside['longest']:g} s, and was not applied to larger mechanisms. The bicycle is the bicycle of "
        f"sympy's test suite, with its symbols; the arm has six joints. The processor times are on {where_beside}, one method "
        f"after another, with a single measurement of ready, by `python -m benchmarks.bodies_and_lagrangians "
        f"--record`. {age_beside}",
    ),
]
tables[0]

# %%
tables[1]

# %%
tables[2]

# %%
tables[3]
