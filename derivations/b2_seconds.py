# %% [markdown]
# # Speed against accuracy, in seconds
#
# **Objective.** The processor time for a given error with the four core packages, with the fast extra, and with other tools
# on the same pair; the throughput per second.
#
# **Assumptions.** Times differ between machines and between runs. These results are from one machine and one run of
# `python -m benchmarks.speed`: medians of processor time over samples of at least 10 ms. Errors and numbers of evaluations,
# which are the same on every machine, are in `b1_chart`.

# %%
from lagrotor.benchmark.records import record_age, recorded_multiple, recorded_speed
from lagrotor.benchmark.scenes_and_methods import CASES, OURS
from lagrotor.models.simulate import choose
from lagrotor.paper import Table

found = recorded_speed()
machine, at_error = found["machine"], found["at_error"]
ERRORS = tuple(at_error)
age = record_age("speed", found["date"], found["digest"])


def milliseconds(value):
    """Milliseconds to three digits, or a dash if the error is not reached."""
    return "—" if value is None else f"{1e3 * value:.3g}"


def multiple(name, error, of):
    """The ratio of the processor times of two methods at the same error, or a dash."""
    ratio = recorded_multiple(found, name, error, of)
    return "—" if ratio is None else f"{ratio:.3g}"


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
decades

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
        ("method", *ERRORS, "smallest error (m)", "set-up (s)"),
        tuple(
            (
                name,
                *(milliseconds(at_error[error][name]) for error in ERRORS),
                f"{found['least_error'][name]:.1e}",
                f"{found['set_up'][name]:.2g}" if name in found["set_up"] else "",
            )
            for name in names
        ),
        f"The times are processor times of one run on {where} ({versions}) with 1001 output times. The closed form is "
        "valid on the paired "
        f"precession, where auto chooses it down to tol = 1e-{reach}; the other methods integrate. {age}",
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
        f"same run. {age}",
    ),
    Table(
        "Throughput",
        ("quantity", "rate per second", "ratio", "reference"),
        tuple(
            (x["what"], f"{x['rate']:.3g} {x['unit']}", f"{x['share']:.2g}", x["against"]) for x in found["throughput"]
        ),
        f"The rates are from the same run on {where}. Ensembles use one process per core; the other rows use one process. {age}",
    ),
]
tables[0]

# %%
tables[1]

# %%
tables[2]
