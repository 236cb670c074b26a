# %% [markdown]
# # Why the pair topples across the joint line and not along it (5.1)
#
# **Objective.** Section 5.1 argues with force diagrams and prints no equation. Three linearised equations answer the same
# questions: the effect of a steady force and of a shock on one tip, and the mean displacement of the axes in $x$.
#
# **Assumptions.** Small motion about the upright rest state, any bar, opposite spins $G_1 = -G_2 = G$; a shock short against
# the period is an impulse.
#
# **Notation.** $X = (x_1 + x_2)/2$; $S = y_1 + y_2$ topples, $D = y_1 - y_2$ twists the bar; $p = a + b$, $q = a - b$,
# $\Omega = G/\sqrt{pq}$; $F$ a steady force on tip 1 and $P$ an impulse on it.

# %%
import numpy as np
import sympy as sp

from lagrotor import Scene, natural_rate, simulate
from lagrotor.numerics import measured_order
from lagrotor.pair import HEAVY_LINK, SHOCK_PAIRED, SHOCK_Y
from lagrotor.pair.notation import AXES, G_1, G_2, G, Omega, R, a, b, t
from lagrotor.paper import Formula, Remark, Table, prove
from lagrotor.theory import linear_pair

p, q = sp.symbols("p q", positive=True)
S, X, D = sp.symbols("S X D", real=True)
S_v, X_v, D_v, S_a, X_a, D_a = sp.symbols("S_dot X_dot D_dot S_ddot X_ddot D_ddot", real=True)
F_x, F_y, P_x, P_y = sp.symbols("F_x F_y P_x P_y", real=True)

# %% [markdown]
# ## The equations
#
# The linearised motion lies in the null space of the constraints, $x_1 = x_2 = X$, $z_i$ unchanged. In $(S, X, D)$:

# %%
pair = linear_pair()
place = dict(zip(AXES.q, (X, (S + D) / 2, 0, X, (S - D) / 2, 0), strict=True))
moved = sp.Matrix([place[name] for name in AXES.q])
turn = (pair.basis.T * pair.basis).LUsolve(pair.basis.T * moved).jacobian([S, X, D])
prove(pair.basis * turn * sp.Matrix([S, X, D]), moved, "the axes in S, X and D")

# %%
sums = {a: (p + q) / 2, b: (p - q) / 2}
mass, gyroscopic = ((turn.T * part * turn).subs(sums) for part in (pair.mass, pair.gyroscopic))
prove(mass, sp.diag(p / 2, 2 * p, q / 2), "the mass matrix")

# %%
opposite = gyroscopic.subs({G_1: G, G_2: -G})
prove(opposite, sp.Matrix([[0, 0, 0], [0, 0, G], [0, -G, 0]]), "the gyroscopic matrix of opposite spins")

# %% [markdown]
# The generalized forces of a force $(F_x, F_y)$ on a tip follow from the possible displacements of the tip:

# %%
pushes = sp.Matrix([F_x, F_y, 0, 0, 0, 0]), sp.Matrix([0, 0, 0, F_x, F_y, 0])
on_tip_1, on_tip_2 = (R * (pair.basis * turn).T * push for push in pushes)
prove(
    on_tip_1.row_join(on_tip_2), R * sp.Matrix([[F_y / 2, F_y / 2], [F_x, F_x], [F_y / 2, -F_y / 2]]), "the two loads"
)

# %% [markdown]
# $S$ is decoupled: the gyroscopic forces of the common motion along the bar are equal and opposite, and the bar carries them. $X$
# and $D$ are coupled: motion in $X$ twists the bar, and the twist reacts on $X$:

# %%
equations = mass * sp.Matrix([S_a, X_a, D_a]) + opposite * sp.Matrix([S_v, X_v, D_v]) - on_tip_1
Formula(equations, "0")

# %% [markdown]
# ## Responses
#
# Each response is substituted into the equations, with $\Omega^2 = G^2/(pq)$, and must start from rest in the upright position.

# %%
rest = sp.zeros(3, 1)
twist = {q: G**2 / (p * Omega**2)}
sine, cosine = sp.sin(Omega * t), sp.cos(Omega * t)


def balance(motion: sp.Matrix) -> sp.Matrix:
    """Force on the coordinates (S, X, D), and impulse at t = 0 on them, that a motion from rest upright has."""
    force = (mass * motion.diff(t, 2) + opposite * motion.diff(t)).subs(twist)
    impulse = (mass * motion.diff(t)).subs(twist).subs(t, 0)
    return sp.Matrix([force, impulse, motion.subs(t, 0)])


# %% [markdown]
# Under a steady force along the joint line $X$ stays bounded, while the twist drifts.

# %%
bound = R * F_x / (2 * p * Omega**2)
steady_x = sp.Matrix([0, bound * (1 - cosine), R * F_x / G * (t - sine / Omega)])
prove(balance(steady_x), sp.Matrix([on_tip_1.subs(F_y, 0), rest, rest]), "the response to a steady force along x")

# %% [markdown]
# Under a force across the joint line the pair topples with the acceleration $RF_y/p$, as without spins. $X$ drifts, because a
# force on one tip also twists the pair.

# %%
steady_y = sp.Matrix(
    [R * F_y / p * t**2 / 2, -R * F_y / (2 * G) * (t - sine / Omega), p * R * F_y / G**2 * (1 - cosine)]
)
prove(balance(steady_y), sp.Matrix([on_tip_1.subs(F_x, 0), rest, rest]), "the response to a steady force across")

# %% [markdown]
# An impulse along $x$ lets $X$ swing about zero and $D$ about $RP_x/G$:

# %%
on_tip_1_P = on_tip_1.subs({F_x: P_x, F_y: P_y})
shock_x = sp.Matrix([0, R * P_x / (2 * p * Omega) * sine, R * P_x / G * (1 - cosine)])
prove(balance(shock_x), sp.Matrix([rest, on_tip_1_P.subs(P_y, 0), rest]), "the response to an impulse along x")

# %% [markdown]
# An impulse across on tip 1 lets $X$ swing about $-RP_y/(2G)$:

# %%
mean_y = -R * P_y / (2 * G)
shock_y = sp.Matrix([R * P_y / p * t, mean_y * (1 - cosine), p * R * P_y * Omega / G**2 * sine])
prove(balance(shock_y), sp.Matrix([rest, on_tip_1_P.subs(P_x, 0), rest]), "the response to an impulse across")

# %% [markdown]
# Equal impulses across on both tips do not change $X$ and $D$:

# %%
both = sp.Matrix([2 * R * P_y / p * t, 0, 0])
loads = (on_tip_1 + on_tip_2).subs({F_x: 0, F_y: P_y})
prove(balance(both), sp.Matrix([rest, loads, rest]), "the response to equal impulses across on both tips")

# %% [markdown]
# ## Against the exact pair
#
# An impulse changes only the velocities, so the exact pair starts upright with the velocities of the linear one. For a bar of
# mass 1 and inertia 1 and spins ±10, the table gives the largest error of $X$ over a period, and the ratio of the two means
# of $X$.

# %%
still = Scene(spins=(10, -10), link=HEAVY_LINK)
period = 2 * np.pi / natural_rate(still)
turn_times = np.linspace(0, period, 41)
numbers = {R: 1, p: sum(still.inertias), q: still.inertias[0] - still.inertias[1], G: 10, Omega: natural_rate(still)}


def exact_and_linear(motion: sp.Matrix, impulse: dict[sp.Symbol, float]) -> tuple[np.ndarray, np.ndarray]:
    """X over a period after an impulse (N s) on tip 1: the exact pair and the linear one."""
    mine = motion.subs(numbers | impulse)
    speeds = [float(speed) for speed in mine.diff(t).subs(t, 0)]
    rates = ((speeds[1], (speeds[0] + speeds[2]) / 2, 0.0), (speeds[1], (speeds[0] - speeds[2]) / 2, 0.0))
    run = simulate(Scene(spins=(10, -10), link=HEAVY_LINK, rates=rates), turn_times, "minimal", 1e-12)
    return run.axes[:, :, 0].mean(0), sp.lambdify(t, mine[1], "numpy")(turn_times)


sizes = (0.05, 0.1, 0.2)
along = [exact_and_linear(shock_x, {P_x: size}) for size in sizes]
across = [exact_and_linear(shock_y, {P_y: size}) for size in sizes]
orders = {
    name: measured_order(sizes, [np.abs(exact - linear).max() for exact, linear in runs])
    for name, runs in (("x", along), ("y", across))
}
means = [
    exact[:-1].mean() / float(mean_y.subs(numbers | {P_y: size}))
    for size, (exact, _) in zip(sizes, across, strict=True)
]
Table(
    "The linearised X against the exact pair",
    (
        "impulse (N s)",
        "largest error of X, impulse along x",
        "largest error of X, impulse across",
        "exact mean of X / linear, impulse across",
    ),
    tuple(
        (f"{size:g}", *(f"{np.abs(exact - linear).max():.2e}" for exact, linear in (one, other)), f"{mean:.4f}")
        for size, one, other, mean in zip(sizes, along, across, means, strict=True)
    ),
    f"The error is proportional to the impulse to the power {orders['x']:.2f} along x, and {orders['y']:.2f} across the bar.",
)

# %% [markdown]
# The shock of figure 13 has 50 N across the bar. The mean of $X$ is taken over the first period after it, the tilt of the pair
# at the end of this period.

# %%
just_after = SHOCK_Y.at + 5 * SHOCK_Y.width
pushed = Scene(spins=(10, -10), link=HEAVY_LINK, shock=SHOCK_Y)
paper = simulate(pushed, [0.0, *(just_after + turn_times)], "minimal", 1e-9).after(just_after)
paper_mean = float(paper.axes[:, :-1, 0].mean())
paper_linear = float(mean_y.subs(numbers | {P_y: SHOCK_Y.impulse[1]}))
paper_over = float(np.degrees(paper.inclinations[:, -1]).mean())
f"The exact mean is {paper_mean:.4f}, the linearised equations give {paper_linear:.4f}. The pair leans by {paper_over:.0f}°."

# %% [markdown]
# ## Corrected statements of the diagrams

# %%
Remark(
    "Across the joint line the pair topples as without spins",
    "The spins drop out of the equation of S = y₁ + y₂: in the common motion the gyroscopic forces along the bar are equal and "
    "opposite, and the bar carries them. A steady force F across the bar gives S the acceleration RF/(a + b), with or without "
    "spins.",
)

# %%
Remark(
    "Along the joint line it stays bounded, while the twist is small",
    "A steady force F along x displaces X by at most RF/((a + b)Ω²), while the twist grows at the rate RF/G. Under a "
    "force across "
    "the bar on one tip X is not bounded: it drifts at the rate −RF/(2G).",
)

# %%
skew = SHOCK_PAIRED.impulse
skew_twist, skew_x = (float(e.subs({R: 1, G: 10, P_x: skew[0], P_y: skew[1]})) for e in (R * P_x / G, mean_y))
Remark(
    "The conclusion: on average no displacement in x",
    "The conclusion is true after an impulse along x, and after equal impulses across the bar on both tips. It is not true after "
    "an impulse P across the bar on one tip, because X then oscillates about −RP/(2G). On the exact pair with P = "
    f"{', '.join(map(str, sizes))} N s the mean of X over a period is {', '.join(f'{mean:.4f}' for mean in means)} times this "
    f"value. With the shock of figure 13 the exact mean is {paper_mean:.4f}, and the linearised equations give "
    f"{paper_linear:.4f}; the pair then leans by {paper_over:.0f} degrees.",
)

# %%
Remark(
    "An impulse along x separates the two centres in y",
    "After an impulse P along x the difference D = y₁ − y₂ oscillates about RP/G, so the two centres of precession are separated "
    f"across the joint line. After the shock of 5.2.1 the mean values are y₁ − y₂ = {skew_twist:.4f} and X = {skew_x:.4f}. This "
    "is a skewness such as figure 23 shows.",
)

# %%
Remark(
    "Order of the linear responses",
    "The linear response of X is compared with the exact pair over a period after an impulse P on tip 1. Its largest error is "
    f"proportional to P^{orders['x']:.2f} if the impulse is along x, and to P^{orders['y']:.2f} if it is across the bar.",
)
