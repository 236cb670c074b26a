# %% [markdown]
# # Other tools on growing mechanisms
#
# **Objective.** What a mechanism costs with this tool and with others: until it is ready, for one right-hand side, for a run.
#
# **Assumptions.** Rods of $l = 0.7$ m with $m = 1.3$ kg at their ends in a plane, relative angles; gyroscopes of
# $I_1 = 0.3$, $I_3 = 0.2$ kg m² on each other's tips. Each tool is used as its documentation recommends, in a process of its
# own; its right-hand side is equal to the others' to $10^{-9}$ before it is timed. One machine, recorded by
# `python -m benchmarks.mechanisms --record`; the counts of operations are the same everywhere.
#
# **Notation.** $n$ the number of rods or gyroscopes; ready: from the description of the mechanism to its right-hand side,
# compiling included; rhs: one evaluation from Python.

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
        "Multiples of processor time, each within one record: rods and gyroscopes over sympy and the time to be ready are from "
        f"the table beside sympy, the others from the tables of tools and of decisions. {age_beside} Each rod more takes "
        f"{each['rods']} operations, each gyroscope more {each['gyroscopes']}; the first, on the ground, takes much less "
        f"({found.operations['gyroscopes'][0]} for a gyroscope). Twice as many therefore take more than twice the "
        "operations, most so where there are few.",
    ),
    Table(
        "Mechanisms: tools, and what each needs",
        MECHANISM_HEAD,
        tuple(mechanism_rows(found.measured)),
        f"Processor time on {where}, medians; {versions}. Of lagrotor and of sympy's methods, ready and rhs are in the table "
        "beside sympy. The run is one second, its error the largest at eleven times, by scipy's DOP853 or LSODA or the tool's "
        "own integrator, whichever is quickest. symbrim is not among them: it has bicycles, riders and a rolling disc, and "
        f"neither mechanism. {age}",
    ),
    Table(
        "Mechanisms: do two formulations agree?",
        DECISION_HEAD,
        tuple(decision_rows(found.decided)),
        f"The same steps with the exact decision and with sympy's simplify in its place, from a run of its own. {age}",
    ),
    Table(
        "Mechanisms from bodies and from a Lagrangian, beside sympy",
        COMPARISON_HEAD,
        tuple(comparison_rows(beside["rows"], beside["longest"])),
        "From bodies beside KanesMethod; from the Lagrangian written out, the writing included, beside LagrangesMethod, of "
        "sympy's own energies of the same bodies, for the bicycle of this one. sympy's right-hand sides are lambdify's "
        "with common subexpressions, then numpy's solve. rhs differs by: from lagrotor's of bodies, relative. A method that used "
        f"{beside['longest']:g} s was ended, larger mechanisms were not given to it. The bicycle is that of sympy's own test, "
        f"in its letters, the arm one of six joints. Processor time on {where_beside}, one method "
        f"after the other, ready measured once, by `python -m benchmarks.bodies_and_lagrangians --record`. {age_beside}",
    ),
]
tables[0]

# %%
tables[1]

# %%
tables[2]

# %%
tables[3]
