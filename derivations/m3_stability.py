# %% [markdown]
# # Limits of the methods
#
# **Objective.** For each regime in which a method fails: the predicted threshold, the measured threshold, and the response of
# lagrotor.
#
# **Assumptions.** The runs are short enough for a report. `lagrotor stability` makes the long runs (10,000 periods) and
# computes the rates of ensembles.

# %%
from lagrotor.benchmark.limits.step_size import limits
from lagrotor.paper import Table

thresholds = limits(quick=True)
f"The regimes are: {'; '.join(dict.fromkeys(x.regime for x in thresholds))}."

# %% [markdown]
# ## Predicted and measured thresholds
#
# Figure m1 shows the range of use of the closed forms.

# %%
tables = [
    Table(
        "Limits of the methods",
        ("regime", "quantity", "formula", "predicted", "measured", "measured / predicted", "response of lagrotor"),
        tuple(
            (x.regime, x.what, x.formula, f"{x.predicted:.3g}", f"{x.measured:.3g}", f"{x.ratio:.2f}", x.tool)
            for x in thresholds
        ),
        "The thresholds are measured by bisection, or read off simulations. Over few periods the drift of energy, momentum and "
        "phase is slower than over many. Over many periods the errors of energy and momentum are proportional to time, and "
        "the error of the phase is v t + c t². The command `lagrotor stability` makes the full runs.",
    )
]
tables[0]
