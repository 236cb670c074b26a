# %% [markdown]
# # Where methods fail
#
# **Objective.** For each regime in which a method fails: the threshold that a formula predicts, the one measured, and
# what lagrotor does there.
#
# **Assumptions.** Runs short enough for a report; `lagrotor stability` has the long ones (10,000 turns) and the
# rates of ensembles.

# %%
from lagrotor.benchmark.limits.step_size import limits
from lagrotor.paper import Table

found = limits(quick=True)
list(dict.fromkeys(x.regime for x in found))

# %% [markdown]
# ## Predicted and measured

# %%
tables = [
    Table(
        "Where methods fail",
        ("regime", "quantity", "formula", "predicted", "measured", "measured / predicted", "what lagrotor does"),
        tuple(
            (x.regime, x.what, x.formula, f"{x.predicted:.3g}", f"{x.measured:.3g}", f"{x.ratio:.2f}", x.tool)
            for x in found
        ),
        "Thresholds measured by bisection or read off runs; over few turns energy, momentum and phase drift more slowly than "
        "over many, where energy and momentum grow in proportion to time, the phase as v t + c t². "
        "Full runs: `lagrotor stability`.",
    )
]
tables[0]
