# %% [markdown]
# # The paper's own method beside the exact model and the closed forms
#
# **Objective.** Every number that the paper prints of its simulations: as printed, by the paper's method with the
# stiffness found (claim C08), by the exact model, in closed form. And the longest step that its stiff
# springs allow, predicted and measured.
#
# **Assumptions.** $S = 10^4$ N/m, $D = 250$ kg/s ($n = 20$, $\omega_s = 10$ in 4.01), steps of 1 ms; the bar of mass 1
# and inertia 1 unless said otherwise. The numbers are those of the tests of the claims.

# %%
from lagrotor import Link, Scene, natural_rate
from lagrotor.benchmark.limits.step_size import step_limit_by_bisection
from lagrotor.models import paper_system, step_limit
from lagrotor.paper import Table
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

claims = {i: PAPER.claim_tests[i].result.measured for i in ("C06", "C07", "C08", "C20", "C21", "C22")}
BAR, LIGHT = Link(1, 1, 1), Link(1, 0.01, 0.1)

# %% [markdown]
# ## The printed numbers

# %%
c06, c07, c08, c20, c21, c22 = claims.values()
none = "none"
rows = (
    ("energy before the shock, spins 10 (J)", "100", f"{c08['before_J']:.2f}", f"{c08['before_J']:.2f}", "I_3 omega²"),
    (
        "energy after it (J)",
        "about 100.45",
        f"{c08['highest_springs_J']:.4f}",
        f"{c08['after_exact_J']:.4f}",
        f"{c08['after_closed_form_J']:.4f}",
    ),
    (
        "bar misplaced: highest energy (J)",
        "a spike",
        f"{c06['peak_J']:.1f} at {1e3 * c06['peak_at_s']:.0f} ms, {c06['after_0.6_s_J']:.2f} after 0.6 s",
        "refused: the bar cannot reach",
        none,
    ),
    (
        "projection as printed (3.16)",
        "NaN",
        f"NaN from {c07['shock_at_s'] - c07['nan_at_s_printed_rotation']:.2f} s before the shock; cured: none",
        none,
        f"fails below |Omega| = {c07['largest_omega_that_fails_rad_per_s']:.2g} rad/s",
    ),
    (
        "single rotor, spin 20 (rad/s)",
        "16",
        f"{c20['rate_springs_over_3_s_rad_per_s']:.3f}",
        f"{c20['rate_exact_over_8_s_rad_per_s']:.3f}",
        f"{natural_rate(Scene((20, 0), link=None)):.3f}, at its amplitude {c20['rate_by_G_over_J_cos_rad_per_s']:.3f}",
    ),
    (
        "equal spins 20 (rad/s)",
        "11.4",
        f"{c21['rate_springs_n_20_over_3_s_rad_per_s']:.3f}",
        f"{c21['rate_exact_over_8_s_rad_per_s']:.3f}",
        f"{natural_rate(Scene((20, 20), link=BAR)):.3f}",
    ),
    (
        "opposite spins 10 (rad/s)",
        "0.57, meant 5.7",
        f"{c22['rate_springs_over_3_s_m_1_K_1']:.2f}",
        f"{c22['rate_over_3.3_s_after_40_N_m_1_K_1']:.2f}",
        f"{natural_rate(Scene((10, -10), link=BAR)):.3f}; light bar {natural_rate(Scene((10, -10), link=LIGHT)):.3f}",
    ),
)

# %% [markdown]
# ## The longest stable step
#
# Predicted from stiffness, damping and the mobility of all joints together; measured by bisection on the step,
# to 1 % of it.

# %%
systems = (
    ("1e4, 250", "1, 1", paper_system(Scene((10, -10), link=BAR), 1e4, 250)),
    ("1e4, 0", "1, 1", paper_system(Scene((0, 0), link=BAR), 1e4, 0)),
    ("1e4, 250", "0.01, 0.1", paper_system(Scene((10, -10), link=LIGHT), 1e4, 250)),
    ("1e5, 1", "0.3, 0.02", paper_system(Scene((5, -5), link=Link(1, 0.3, 0.02)), 1e5, 1)),
)
limits = []
for springs, bar, system in systems:
    predicted, found = step_limit(system), step_limit_by_bisection(system, 5)
    row = (springs, bar, 1e3 * predicted.whole, 1e3 * found, found / predicted.whole, 1e3 * predicted.joints.min())
    limits.append((*row[:2], *(f"{value:.3g}" for value in row[2:])))

tables = [
    Table(
        "The paper's simulated numbers",
        ("what", "printed", "paper's method", "exact model", "closed form"),
        rows,
        "Rates after a shock of 40 N along x on tip 1: by the paper's method fitted over the first 3 s, exact over 8 s, of "
        "opposite spins over 3.3 s. The excess of the runs over the closed forms is the amplitude's.",
    ),
    Table(
        "The longest stable step of the paper's method",
        (
            "S (N/m), D (kg/s)",
            "bar m, K",
            "predicted (ms)",
            "found (ms)",
            "found / predicted",
            "worst single joint (ms)",
        ),
        tuple(limits),
        "Predicted from all joints together, h < 4/(w D + sqrt((w D)² + 4 w S)); a single joint gives too long a step.",
    ),
]
tables[0]

# %%
tables[1]
