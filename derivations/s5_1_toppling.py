# %% [markdown]
# # Why the pair topples across the joint line and not along it (5.1)
#
# **Objective.** Section 5.1 argues with force diagrams and prints no equation. The linear pair says the same in three
# equations: what a steady force and a shock on one tip do, and whether the axes are on average displaced in x.
#
# **Assumptions.** Small motion about the upright rest state, any bar, opposite spins $G_1 = -G_2 = G$; a shock short
# against the period is an impulse.
#
# **Notation.** $X = (x_1 + x_2)/2$; $S = y_1 + y_2$ topples, $D = y_1 - y_2$ twists the bar; $p = a + b$,
# $q = a - b$, $\Omega = G/\sqrt{pq}$; $F$ a steady force and $P$ an impulse on tip 1.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link, Scene, Shock, natural_rate, simulate
from lagrotor.algebra import decide_zero
from lagrotor.numerics.convergence import measured_order
from lagrotor.pair.symbols import AXES, G_1, G_2, G, Omega, R, a, b, t
from lagrotor.paper.notebook import findings_table
from lagrotor.theory.natural_frequency import linear_pair

p, q = sp.symbols("p q", positive=True)
S, X, D = sp.symbols("S X D", real=True)
F_x, F_y = sp.symbols("F_x F_y", real=True)
s = sp.Symbol("s")

# %% [markdown]
# ## The equations
#
# The linear pair moves in the null space of its constraints, $x_1 = x_2 = X$. Change to $(S, X, D)$ and put a force on
# tip 1.

# %%
pair = linear_pair()
small = {AXES.q[0]: X, AXES.q[1]: (S + D) / 2, AXES.q[2]: 0, AXES.q[3]: X, AXES.q[4]: (S - D) / 2, AXES.q[5]: 0}
moved = sp.Matrix([small[name] for name in AXES.q])
weights = (pair.basis.T * pair.basis).LUsolve(pair.basis.T * moved)
assert pair.basis * weights == moved
turn = weights.jacobian([S, X, D])
split = {a: (p + q) / 2, b: (p - q) / 2}


def in_sum_and_difference(matrix: sp.Matrix) -> sp.Matrix:
    return (turn.T * matrix * turn).subs(split).applyfunc(sp.factor)


mass, gyroscopic = in_sum_and_difference(pair.mass), in_sum_and_difference(pair.gyroscopic)
assert pair.stiffness.is_zero_matrix
opposite = gyroscopic.subs({G_1: G, G_2: -G})
tip_1 = sp.Matrix([F_x, F_y, 0, 0, 0, 0])
tip_2 = sp.Matrix([0, 0, 0, F_x, F_y, 0])
loads = [R * (pair.basis * turn).T * tip for tip in (tip_1, tip_2)]

# Opposite spins: nothing couples S; X and D hold each other.
assert opposite[0, 1] == opposite[0, 2] == 0
assert mass.is_diagonal()
sp.Tuple(mass, opposite)

# %% [markdown]
# ## Exact responses
#
# Transforms $(s^2 M + sC)\,\hat Q = \hat F$ are rational; their parts at $s = 0$ are powers of $t$, the rest oscillates
# at $\Omega$. Each response is put back into the equations.

# %%
twist = {q: G**2 / (p * Omega**2)}


def in_time(image: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """(secular, oscillating) part of the original of a transform with poles at 0 and ± i Omega."""
    denominator = sp.denom(sp.cancel(image))
    order = min(power for (power,) in sp.Poly(denominator, s).monoms())
    rest, secular = image, sp.Integer(0)
    regular = sp.cancel(image * s**order)
    for i in range(order):
        value = (regular.diff(s, i) / sp.factorial(i)).subs(s, 0)
        secular += value * t ** (order - i - 1) / sp.factorial(order - i - 1)
        rest -= value / s ** (order - i)
    wave = sp.Poly(sp.cancel(rest * (s**2 + Omega**2)), s)
    assert wave.degree() <= 1
    swing = wave.coeff_monomial(s) * sp.cos(Omega * t) + wave.coeff_monomial(1) / Omega * sp.sin(Omega * t)
    return sp.factor(secular), swing


def response(load: sp.Matrix, steady: bool) -> list[tuple[sp.Expr, sp.Expr]]:
    """(S, X, D) from rest, each as (secular, oscillating): a steady force from t = 0 on, or an impulse at t = 0."""
    system = (s**2 * mass + s * opposite).subs(twist)
    images = system.adjugate(method="berkowitz") * load / system.det(method="berkowitz") / (s if steady else 1)
    parts = [in_time(sp.cancel(image)) for image in images]
    motion = sp.Matrix([sum(part) for part in parts])
    force = load if steady else sp.zeros(3, 1)
    balance = mass.subs(twist) * motion.diff(t, 2) + opposite * motion.diff(t) - force
    start = (mass.subs(twist) * motion.diff(t)).subs(t, 0) - (sp.zeros(3, 1) if steady else load)
    assert all(decide_zero(e).answer == "zero" for e in (*balance, *start, *motion.subs(t, 0)))
    return parts


along, across = ({F_y: 0}, {F_x: 0})
first = loads[0]
steady_x, steady_y = (response(first.subs(kind), True) for kind in (along, across))
shock_x, shock_y = (response(first.subs(kind), False) for kind in (along, across))
both_y = response((loads[0] + loads[1]).subs(across), False)
sp.Matrix([sum(part) for part in shock_x])

# %% [markdown]
# What the responses say, decided.

# %%
bounded = steady_x[1][0]
reach = 2 * bounded  # X = bounded (1 − cos Omega t)
topple = steady_y[0][0].diff(t, 2)
mean_x, mean_y = shock_x[1][0], shock_y[1][0]
decisions = {
    "toppling acceleration R F_y / (a + b)": topple - R * F_y / p,
    "toppling has no oscillation": steady_y[0][1],
    "X under a steady F_x is bounded": sp.diff(bounded, t),
    "mean X after an impulse along x is zero": mean_x,
    "mean X after an impulse across on tip 1": mean_y + R * F_y / (2 * G),
    "X after equal impulses across on both tips is zero": sum(both_y[1]),
}
decided = {name: decide_zero(expression).answer for name, expression in decisions.items()}
assert set(decided.values()) == {"zero"}
no_spin_topple = (R * (pair.basis * turn).T * tip_1)[0] / mass[0, 0]
assert decide_zero(no_spin_topple.subs(F_x, 0) - topple).answer == "zero"
no_spin_x = first[1].subs(F_y, 0) / mass[1, 1]  # acceleration of X without spin
equal = gyroscopic.subs({G_1: G, G_2: G})
decided

# %% [markdown]
# ## Against the exact pair
#
# An impulse sets the rates and nothing else, so the exact pair starts upright with the rates of the linear one.

# %%
heavy = Link(mass=1, inertia=1)
still = Scene(spins=(10, -10), link=heavy)
weight_a, weight_b = still.inertias
numbers = {R: 1, p: weight_a + weight_b, G: 10, Omega: natural_rate(still)}
period = 2 * np.pi / natural_rate(still)
one_turn = np.linspace(0, period, 41)


def exact_and_linear(
    parts: list[tuple[sp.Expr, sp.Expr]], impulse: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """X over a period after an impulse (N s) on tip 1: the exact pair and the linear one."""
    values = numbers | {F_x: impulse[0], F_y: impulse[1]}
    S_v, X_v, D_v = (float(sum(part).diff(t).subs(values).subs(t, 0)) for part in parts)
    rates = ((X_v, (S_v + D_v) / 2, 0.0), (X_v, (S_v - D_v) / 2, 0.0))
    run = simulate(Scene(spins=(10, -10), link=heavy, rates=rates), one_turn, "minimal", 1e-12)
    linear = sp.lambdify(t, sum(parts[1]).subs(values))(one_turn)
    return run.axes[:, :, 0].mean(0), linear


sizes = (0.05, 0.1, 0.2)
errors: dict[str, list[float]] = {"x": [], "y": []}
means: list[float] = []
for size in sizes:
    for name, parts, impulse in (("x", shock_x, (size, 0.0)), ("y", shock_y, (0.0, size))):
        exact, linear = exact_and_linear(parts, impulse)
        errors[name].append(float(np.abs(exact - linear).max()))
        if name == "y":
            means.append(float(exact[:-1].mean()) / float(mean_y.subs(numbers).subs(F_y, size)))
orders = {name: measured_order(sizes, values) for name, values in errors.items()}

# The shock of the paper's figure 13: the mean of x over the first period after it, and how far the pair leans by then.
shock = Shock((0, 50, 0), at=2.0, width=1 / 50)
just_after = shock.at + 5 * shock.width
paper = simulate(Scene(spins=(10, -10), link=heavy, shock=shock), just_after + one_turn, "minimal", 1e-9)
paper_mean = float(paper.axes[:, :-1, 0].mean())
paper_linear = float(mean_y.subs(numbers).subs(F_y, shock.impulse[1]))
paper_over = float(np.degrees(paper.inclinations[:, -1]).mean())

# The shock of 5.2.1: the mean twist and the mean X that it leaves.
skew = Shock((40, -11, 0), at=2.0, width=1 / 20)
left = {R: 1, G: 10, F_x: skew.impulse[0], F_y: skew.impulse[1]}
skew_twist, skew_x = (float(mean.subs(left)) for mean in (shock_x[2][0], mean_y))
orders

# %% [markdown]
# ## What stands in place of the diagrams


# %%
def equation(row: int, matrix: sp.Matrix, load: sp.Expr) -> str:
    names = ("S", "X", "D")
    left = [f"{mass[row, j]} {name}''" for j, name in enumerate(names) if mass[row, j] != 0]
    left += [f"{matrix[row, j]} {name}'" for j, name in enumerate(names) if matrix[row, j] != 0]
    return f"{' + '.join(left)} = {load}".replace("+ -", "- ")


ringing = sum(shock_x[1]).subs(F_x, sp.Symbol("P"))
statements: list = []
findings: list[tuple[str, str]] = [
    (
        "The two force diagrams as equations",
        "For opposite spins, with p = a + b and q = a - b: "
        + "; ".join(equation(i, opposite, first[i]) for i in range(3))
        + ". The gyroscopic forces of the common motion S along the bar are equal and opposite, and the bar carries "
        "them: S feels no spin. Those of X twist the bar, and the twist D reacts on X.",
    ),
    (
        "Across the joint line it topples as if nothing were spinning",
        f"A steady force F_y on one tip gives y_1 + y_2 the acceleration {topple} (decided), the same without spin.",
    ),
    (
        "Along the joint line it is held",
        f"A steady force F_x gives X = {bounded} (1 - cos Omega t) from rest, never more than {reach}; without spin X "
        f"would accelerate at {no_spin_x}. What gives way is the twist: D drifts as {steady_x[2][0]}, so the force is "
        "held only while the twist is small.",
    ),
    (
        "Not held against a force across on one tip",
        f"A steady F_y on tip 1 alone also twists the pair, and X drifts as {steady_y[1][0]}; on both tips equally it "
        "leaves X alone.",
    ),
    (
        "The conclusion: on average no displacement in x",
        f"True after an impulse along x: X = {ringing}, mean {mean_x}; true after equal impulses across. Not "
        f"true after an impulse P across on one tip: X swings about {mean_y.subs(F_y, sp.Symbol('P'))} (decided). On "
        f"the exact pair, bar of mass 1 and inertia 1, spins ±10, P = {', '.join(map(str, sizes))} N s, the mean of X "
        f"over a period is {', '.join(f'{mean:.4f}' for mean in means)} of that. With the shock of figure 13 it is "
        f"{paper_mean:.4f} over the first period, {paper_linear:.4f} by the linear pair; the pair then leans "
        f"{paper_over:.0f} degrees.",
    ),
    (
        "An impulse along x parts the two centres in y",
        f"D swings about {shock_x[2][0].subs(F_x, sp.Symbol('P'))}: the precession centres stand apart across the "
        f"joint line. The shock of 5.2.1 leaves y_1 - y_2 = {skew_twist:.4f} and X = {skew_x:.4f} on average: a "
        "skewness such as figure 23 shows.",
    ),
    (
        "Order of the linear responses",
        "The largest error of X over a period after an impulse P on tip 1 goes as "
        f"P**{orders['x']:.2f} along x and P**{orders['y']:.2f} across (exact pair).",
    ),
]
findings_table(findings)
