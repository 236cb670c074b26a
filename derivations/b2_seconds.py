# %% [markdown]
# # Speed against accuracy, in seconds
#
# **Objective.** The processor time for a given error with the four core packages, with the fast extra, and with other tools
# on the same pair; the throughput per second.
#
# **Assumptions.** Times differ between machines and between runs. These results are from one machine and one run of
# `python -m benchmarks.speed`: medians of processor time over samples of at least 10 ms. Errors and numbers of evaluations,
# which are the same on every machine, are in figure b1.

# %%
from lagrotor.benchmark.records import record_age, recorded_multiple, recorded_speed
from lagrotor.benchmark.scenes_and_methods import CASES, METHODS, OURS
from lagrotor.models.simulate import choose
from lagrotor.paper import Table

found = recorded_speed()
machine, at_error = found["machine"], found["at_error"]
over_tolerance = found.get("error_over_tolerance", {})  # older records do not have it
ERRORS = tuple(at_error)
age = record_age("speed", found["date"], found["digest"])


def milliseconds(value):
    """Milliseconds to three digits, or a dash if the error is not reached."""
    return "—" if value is None else f"{1e3 * value:.3g}"


def multiple(name, error, of):
    """The ratio of the processor times of two methods at the same error, or a dash."""
    ratio = recorded_multiple(found, name, error, of)
    return "—" if ratio is None else f"{ratio:.3g}"


def exceeded(name):
    """The largest error of a method divided by the tolerance that it was given, or a dash if it has none."""
    ratio = over_tolerance.get(name)
    return "—" if ratio is None else f"{ratio:.2g}"


def slower_than(error):
    """A sentence with the tools that are faster than the fast extra at the same error; empty if no tool is."""
    others = [name for name in at_error[error] if name not in METHODS and not name.startswith("best of ")]
    ratios = {name: recorded_multiple(found, "best of fast", error, name) for name in others}
    faster = [f"{ratio:.2g} times the time of {name}" for name, ratio in ratios.items() if ratio and ratio > 1]
    return f"For an error of {error} m the time of the fast extra is {', '.join(faster)}." if faster else ""


# %% [markdown]
# ## The choice of `model="auto"`
#
# On the paired precession `auto` chooses the closed form if the last terms of its series give an error below `tol`.

# %%
displaced = CASES["displaced"](True)
decades = [
    n for n in range(3, 14) if choose(displaced.scene, float(displaced.t_eval[-1]), 10.0**-n).model == "closed_form"
]
reach = max(decades)
assert decades == list(range(3, reach + 1))
f"For 10 s of the displaced pair `auto` chooses the closed form if tol is between 1e-3 and 1e-{reach}."

# %% [markdown]
# ## Processor time at equal error
#
# The methods are sorted by processor time at the largest of the errors.

# %%
names = [name for name in at_error[ERRORS[0]] if any(at_error[error][name] for error in ERRORS)]
names.sort(key=lambda name: (at_error[ERRORS[0]][name] or float("inf"), name))
where = f"{machine['processor']}, {machine['cores']} cores, Python {machine['Python']}"
versions = ", ".join(f"{name} {number}" for name, number in found["versions"].items())
tables = [
    Table(
        "Speed against accuracy: milliseconds for an error of the tips (m), 10 s of the displaced pair",
        ("method", *ERRORS, "smallest error (m)", "largest error / tolerance", "set-up (s)"),
        tuple(
            (
                name,
                *(milliseconds(at_error[error][name]) for error in ERRORS),
                f"{found['least_error'][name]:.1e}",
                exceeded(name),
                f"{found['set_up'][name]:.2g}" if name in found["set_up"] else "",
            )
            for name in names
        ),
        f"The times are processor times of one run on {where} ({versions}) with 1001 output times. The closed form is "
        "valid on the paired "
        f"precession, where auto chooses it down to tol = 1e-{reach}; the other methods integrate. "
        "The models of lagrotor estimate their error, "
        "for which they integrate twice, and warn if it exceeds the tolerance. The other methods give no error of a run: the "
        f"last column but one is the largest true error in m of all tolerances, divided by the tolerance. {age}",
    ),
    Table(
        "Speed against accuracy: other tools as multiples",
        ("method", *(f"divided by {best}, {error}" for best in OURS for error in ERRORS[:2])),
        tuple(
            (name, *(multiple(name, error, f"best of {best}") for best in OURS for error in ERRORS[:2]))
            for name in names
            if at_error[ERRORS[0]][name]
        ),
        "Each column gives the time divided by the time of the fastest method of a group, at the stated error in m. "
        "The group 'any "
        "model' is all methods of the core packages; its fastest is the closed form, including its fit to the initial state. The "
        "groups 'core' and 'fast' are the integrations with the core packages and with the fast extra. All times are from the "
        f"same run. {' '.join([*filter(None, map(slower_than, ERRORS)), age])}",
    ),
    Table(
        "Throughput",
        ("quantity", "rate per second", "ratio", "reference"),
        tuple(
            (x["what"], f"{x['rate']:.3g} {x['unit']}", f"{x['share']:.2g}", x["against"]) for x in found["throughput"]
        ),
        f"The rates are from the same run on {where}. Ensembles use one process per core; the other rows use one process. "
        "Sweeps of lagrotor estimate the error of each trajectory. heyoka and diffrax do not: their tolerance is the "
        f"coarsest with which the true errors at the end of the runs are below the stated error. {age}",
    ),
]
tables[0]

# %%
tables[1]

# %%
tables[2]
