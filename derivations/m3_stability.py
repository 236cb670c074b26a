# %% [markdown]
# # Where methods fail
#
# **Objective.** For each regime in which a method fails: the threshold that a formula predicts, the one found by trying,
# and what the tool does about it.
#
# **Assumptions.** Runs short enough for a report; `lagrotor stability` has the long ones (10,000 turns), the
# rates of ensembles and the figure.

# %%
from lagrotor.benchmark.limits.step_size import limits
from lagrotor.paper.tables import Table

found = limits(quick=True)
list(dict.fromkeys(x.regime for x in found))

# %% [markdown]
# ## Predicted and found

# %%
tables = [
    Table(
        "Where methods fail",
        ("regime", "what", "by what formula", "predicted", "found", "found / predicted", "what the tool does"),
        tuple(
            (x.regime, x.what, x.formula, f"{x.predicted:.3g}", f"{x.measured:.3g}", f"{x.ratio:.2f}", x.tool)
            for x in found
        ),
        "Thresholds found by bisection or by the runs themselves; energy and momentum drift more slowly over few turns "
        "than over many, where they grow as time. Full runs: `lagrotor stability`.",
    )
]
tables[0]
