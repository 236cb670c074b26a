# %% [markdown]
# # Stability under load
#
# **Objective.** The structures of rotors and bars that are stable under weight, the spins that they need, and the effect of
# friction.
#
# **Assumptions.** Small motion about upright axes; in the closed forms equal rotors and loads and massless bars. The
# numbers compare the linear results with the exact motion, with heavy bars too. Known results: spins stabilise only an even
# number of unstable degrees of freedom (Thomson & Tait, Natural Philosophy, § 345); stacks of tops (Greenhill, Encyclopædia
# Britannica, 11th ed. (1911), Gyroscope and Gyrostat, §§ 14 and 15); friction (Merkin, Introduction to the Theory of Stability,
# ch. 6). The least spins for rotors side by side under bars are new, as far as we know.
#
# **Notation.** $u_i=(x_i,y_i)$ the tilt of axis $i$; $a$ the inertia of an axis about its joint, load included; $\kappa=gS$
# its weight's moment, $S$ the sum of its masses times their heights; $N$ the number of rotors; $b$ the coupling by a heavy
# bar; $G_i$ the axial momenta; $\lambda=as^2-\kappa$ for motion as $e^{st}$; $D(s)$ the matrix of the equations of such motion,
# $P(s)=\det D(s)$ its characteristic polynomial.

# %%
from math import inf, sqrt

import numpy as np
import sympy as sp

from lagrotor import Brace, Link, Structure
from lagrotor.mechanics import coordinates, euler_lagrange
from lagrotor.paper import Formula, Remark, prove
from lagrotor.structures import bounded_motion, measured_growth, sign_patterns
from lagrotor.structures.coefficients import coefficients

s = sp.Symbol("s")
a, b, kappa, c, k = sp.symbols("a b kappa c k", positive=True)
G_1, G_2, G_3, G_4 = sp.symbols("G_1:5", real=True)
weight = {"gravity": 9.81, "load": 2.0}
lam = a * s**2 - kappa


def polynomial(spins: list[float], **more: object) -> sp.Expr:
    """The library's characteristic polynomial, kappa and b positive."""
    found = Structure(spins=spins, gravity=9.81, load=2.0, **more).characteristic().polynomial
    return found.subs({sp.Symbol("kappa", real=True): kappa, sp.Symbol("b", real=True): b})


pair = {"joints": [(0, 0), (1, 0)], "bars": [(0, 1)]}

# %% [markdown]
# ## The linear equations
#
# To second order in the tilts the Lagrangian after Routh's reduction is
#
# $$L=\sum_i\Big(\frac a2|\dot u_i|^2+\frac{G_i}2\,(y_i\dot x_i-x_i\dot y_i)+\frac\kappa2|u_i|^2\Big)
# +\sum_{\text{bars }ij}b\,\dot u_i\cdot\dot u_j.$$
#
# Each bar keeps the two tilts along it equal. The Euler–Lagrange equations of the remaining degrees of freedom are linear. For
# motion as $e^{st}$ they are $D(s)\,q=0$, and such a motion exists where $P(s)=\det D(s)=0$.


# %%
def small_motion(tilts: list[str], spins: tuple[sp.Expr, ...], bars: tuple = (), spring: sp.Expr = sp.S.Zero) -> tuple:
    """Equations of motion and coordinates of the tilts "x_i y_i"; bars: (i, j) that couple by b; spring: its energy."""
    free = coordinates(sorted(set(" ".join(tilts).split())))
    named = {str(q): (q, v) for q, v in zip(free.q, free.v, strict=True)}
    u = [[named[name] for name in tilt.split()] for tilt in tilts]
    total = -spring
    for ((x, x_v), (y, y_v)), G in zip(u, spins, strict=True):
        total += a / 2 * (x_v**2 + y_v**2) + G / 2 * (y * x_v - x * y_v) + kappa / 2 * (x**2 + y**2)
    for i, j in bars:
        total += sum(b * one[1] * other[1] for one, other in zip(u[i], u[j], strict=True))
    return euler_lagrange(total, free), free


def pencil(*of: object, **more: object) -> sp.Matrix:
    """D(s) of a small motion."""
    motion, free = small_motion(*of, **more)
    by_q, by_v, by_a = (motion.jacobian(list(names)) for names in (free.q, free.v, free.a))
    return by_q + s * by_v + s**2 * by_a


# %% [markdown]
# ## The loaded pair
#
# The bar keeps $x_1=x_2$. Three degrees of freedom remain, $x_1$, $y_1$, $y_2$, with the equations

# %%
tilts_of_two, G_12 = ["x_1 y_1", "x_1 y_2"], (G_1, G_2)
Formula(small_motion(tilts_of_two, G_12, bars=((0, 1),))[0], "E")

# %% [markdown]
# each equal to zero. For motion as $e^{st}$

# %%
coupled = pencil(tilts_of_two, G_12, bars=((0, 1),))
Formula(coupled, "D(s)")

# %% [markdown]
# With a massless bar, $b=0$,

# %%
massless = polynomial([3, 2], **pair)
product = lam * (2 * lam**2 + (G_1**2 + G_2**2) * s**2)
prove(
    (coupled.subs(b, 0).det(), massless),
    (product, product),
    "the determinant for a massless bar, and the library's characteristic polynomial",
    names=(r"\det D(s)", "P(s)"),
)

# %% [markdown]
# The factor $\lambda$ contains no spin: one motion grows at the rate $\sqrt{\kappa/a}$, as without spins. In this motion the two
# gyroscopic moments cancel, $x_1=0$, $G_1y_1+G_2y_2=0$. Equal spins are unstable to yaw, opposite spins to toppling about the
# joint line. A heavy bar couples the motions, but at $s=0$ and for large $s$ its polynomial has the signs

# %%
heavy = sp.Poly(coupled.det(), s)
prove(heavy.eval(0), -2 * kappa**3, "the polynomial of a heavy bar at s = 0", names="P(0)")

# %%
prove(heavy.coeff_monomial(s**6), 2 * (a - b) * (a + b) ** 2, "its leading coefficient", names="P_6")

# %%
prove(
    polynomial([3, 2], link=Link(1, 0.3, 0.1), **pair),
    coupled.det(),
    "the library's polynomial of a heavy bar",
    equations=r"P_{\text{library}}(s) = \det D(s)",
)

# %% [markdown]
# As $a>|b|$, the polynomial changes its sign in between, so a positive root exists for every pair of spins. **No loaded pair is
# stable.** ($\kappa$ includes the weight of the bar.)
#
# ## Any structure
#
# For $n$ degrees of freedom $\det(Ms^2+Cs+K)$ is $\det K$ at $s=0$ and positive for large $s$. If an odd number of degrees of
# freedom is unstable without spins, $\det K<0$, and a positive root exists for all spins (Thomson & Tait). Each independent bar
# removes one of $2N$ degrees of freedom. Under weight alone **a structure with an odd number of bars is therefore never
# stable**: no pair, no triangle, no rigid plate ($n=3$).
#
# If all degrees of freedom have the same $\lambda$, they form pairs, on each of which the spins act with one $\beta$:
# $\lambda^2+\beta^2s^2=0$. This is a quadratic in $p=s^2$ with the discriminant

# %%
p, beta = sp.Symbol("p"), sp.Symbol("beta", positive=True)
quadratic = sp.Poly((a * p - kappa) ** 2 + beta**2 * p, p)
prove(quadratic.discriminant(), beta**2 * (beta**2 - 4 * a * kappa), "the discriminant", names=r"\Delta")

# %% [markdown]
# Its roots are negative, and the pair of degrees of freedom is stable, if $\beta^2>4a\kappa$. With $\beta=0$, as in the pair of
# rotors, it is unstable. A single top has $\beta=G$.
#
# ## The smallest stable structure
#
# Three rotors and two bars at a corner: $x_1=x_2$, $y_2=y_3$, four degrees of freedom, $x_1$, $x_3$, $y_1$, $y_2$. Massless bars:

# %%
at_corner = pencil(["x_1 y_1", "x_1 y_2", "x_3 y_2"], (G_1, G_2, G_3))
Formula(at_corner, "D(s)")

# %%
corner = {"joints": [(0, 0), (1, 0), (1, 1)], "bars": [(0, 1), (1, 2)]}
terms = 4 * lam**4 + (2 * G_1**2 + G_2**2 + 2 * G_3**2) * lam**2 * s**2 + G_1**2 * G_3**2 * s**4
prove(
    (at_corner.det(), polynomial([3, 2, 1], **corner)),
    (terms, terms),
    "the determinant, and the library's characteristic polynomial of the corner",
    names=(r"\det D(s)", "P(s)"),
)

# %% [markdown]
# With $\lambda^2=-\beta^2s^2$ the two $\beta^2$ have the product $G_1^2G_3^2/4$ and the sum $(2G_1^2+G_2^2+2G_3^2)/4$. The
# smaller one is largest if the middle rotor does not spin. Then $\beta=G/\sqrt2$ for $G_1=\pm G_3=G$:

# %%
resting = polynomial([3, 0, 3], **corner).subs(G_3, G_1)
prove(resting, (2 * lam**2 + G_1**2 * s**2) ** 2, "the corner with its middle rotor at rest", names="P(s)")

# %% [markdown]
# so that it is stable for $G>2\sqrt2\sqrt{a\kappa}$. In a straight row all $x_i$ are equal. The spins act only on $x$ and on one
# mean of the $y_i$, and the other degrees of freedom are unstable:

# %%
in_row = pencil(["x_1 y_1", "x_1 y_2", "x_1 y_3"], (G_1, G_2, G_3))
Formula(in_row, "D(s)")

# %%
row = {"joints": [(0, 0), (1, 0), (2, 0)], "bars": [(0, 1), (1, 2)]}
product = lam**2 * (3 * lam**2 + (G_1**2 + G_2**2 + G_3**2) * s**2)
prove(
    (in_row.det(), polynomial([3, 2, 1], **row)),
    (product, product),
    "the determinant, and the library's characteristic polynomial of a straight row of three",
    names=(r"\det D(s)", "P(s)"),
)

# %% [markdown]
# ## The square, and grids
#
# Four rotors and four bars: each row of the grid has one $x$, each column one $y$.

# %%
of_square = pencil(["x_1 y_1", "x_1 y_2", "x_3 y_2", "x_3 y_1"], (G_1, G_2, G_3, G_4))
Formula(of_square, "D(s)")

# %%
square = {"joints": [(0, 0), (1, 0), (1, 1), (0, 1)], "bars": [(0, 1), (1, 2), (2, 3), (3, 0)]}
squares = G_1**2 + G_2**2 + G_3**2 + G_4**2
terms = 16 * lam**4 + 4 * squares * lam**2 * s**2 + (G_1 * G_3 - G_2 * G_4) ** 2 * s**4
prove(
    (of_square.det(), polynomial([1, 2, 3, 4], **square)),
    (terms, terms),
    "the determinant, and the library's characteristic polynomial of the square",
    names=(r"\det D(s)", "P(s)"),
)

# %% [markdown]
# For equal spins and for alternating spins $G_1G_3=G_2G_4$, and the square is unstable. With one spin opposite to the other three
# it can be stable:

# %%
odd = polynomial([-1, 1, 1, 1], **square).subs({G_1: -G_2, G_3: G_2, G_4: G_2})
prove(odd, 4 * (2 * lam**2 + G_2**2 * s**2) ** 2, "the square with one spin opposite", names="P(s)")

# %% [markdown]
# In general the $\beta$ of an $L\times L$ grid are the singular values of the matrix of its $G_{rc}$, row $r$ and column $c$,
# over $L$: a rotor couples the $x$ of its row with the $y$ of its column, $L\lambda x_r+s\sum_cG_{rc}y_c=0$ and
# $L\lambda y_c-s\sum_rG_{rc}x_r=0$. The grid is stable for sufficiently large spins if and only if that matrix is regular. The
# squares of its $L$ singular values add up to $\sum G^2\le L^2G_{max}^2$, so every choice of spins needs at least
# $2\sqrt L\sqrt{a\kappa}$, and only Hadamard matrices reach this bound. For $L=3$ there is none, and the determinant gives a
# sharper bound: it is linear in each $G_{rc}$, so it is largest at $\pm G_{max}$, and the least singular value is at most its
# cube root.


# %%
def grid(L: int) -> dict[str, object]:
    bars = [(i, i + 1) for i in range(L * L) if i % L < L - 1] + [(i, i + L) for i in range(L * L - L)]
    return {"joints": [(i % L, i // L) for i in range(L * L)], "bars": bars, "gravity": 9.81, "load": 2.0}


def natural(one: Structure) -> float:
    """sqrt(a κ) / I3, rad/s."""
    found = coefficients(one)
    return float(np.sqrt(found.A[0] * found.gravity * found.S[0])) / one.rotor[0].I3


tried = {L: sign_patterns(Structure(**grid(L), spins=1.0)) for L in (2, 3)}
least = {L: found.least / natural(Structure(**grid(L), spins=1.0)) for L, found in tried.items()}
slower = Structure(**grid(3), spins=[-0.5, 1, 1, 1, -0.5, 1, 1, 1, -0.5])
needs = slower.critical_spin() / natural(slower)
signs = np.array(np.meshgrid(*[(1.0, -1.0)] * 9)).reshape(3, 3, -1).transpose(2, 0, 1)
largest = float(np.abs(np.linalg.det(signs)).max())
bound = 2 * 3 / largest ** (1 / 3)
assert abs(least[2] - 2 * sqrt(2)) < 1e-9
assert abs(least[3] - 6) < 1e-9
assert abs(needs - 4) < 1e-9 and abs(largest - 4) < 1e-9 and len(signs) == 512
Remark(
    "The signs of the spins that need the least spin",
    " ".join(
        f"Of the {found.count} sign patterns of the {L} × {L} grid {found.standing} are stable if the spins are large "
        "enough; the "
        f"best one requires an axial momentum of {least[L]:.3f} √(aκ) per rotor."
        for L, found in tried.items()
    )
    + " If the three rotors on the diagonal of the 3 × 3 grid spin in the opposite sense at half the speed of the others, the "
    f"others are stable from an axial momentum of {needs:.3f} √(aκ) on. "
    f"For no choice of speeds and senses can the largest momentum be below {bound:.3f} "
    f"√(aκ), because no 3 × 3 determinant with entries between −1 and 1 exceeds {largest:.0f}.",
)

# %% [markdown]
# ## A brace across the bar
#
# With a spring $k>\kappa$ on $y_1$ of the pair ($k$ times $R^2$ compared with $\kappa$) two degrees of freedom are unstable
# without spins, an even number:

# %%
y_1, y_2 = coordinates("y_1 y_2").q
braced = pencil(tilts_of_two, G_12, spring=k * y_1**2 / 2)
Formula(braced, "D(s)")

# %%
across = [Brace(0, (0.0, 1.0, 1.0), 200.0)]
terms = 2 * lam**2 * (lam + k) + G_1**2 * s**2 * lam + G_2**2 * s**2 * (lam + k)
prove(
    (braced.det(), polynomial([3, 2], braces=across, **pair)),
    (terms, terms),
    "the determinant, and the library's characteristic polynomial of the braced pair",
    names=(r"\det D(s)", "P(s)"),
)

# %% [markdown]
# Divided by $k$, for a stiff brace, it is $2\lambda^2+G_2^2s^2$. The pair is stable for $G_2>2\sqrt2\sqrt{a\kappa}$, where
# $G_2$ is the spin of the rotor without the brace; the sign of the other spin does not matter.

# %%
stiff = sp.Limit(terms / k, k, sp.oo).doit()
prove(stiff, 2 * lam**2 + G_2**2 * s**2, "a stiff brace", names=r"\lim_{k\to\infty} P(s)/k")

# %% [markdown]
# With a spring that acts only on yaw, $k(y_1-y_2)^2/2$, the two sways are unstable without spins:

# %%
yaw = k * (y_1 - y_2) ** 2 / 2
Formula(pencil(tilts_of_two, G_12, spring=yaw), "D(s)")

# %%
prove(
    [pencil(tilts_of_two, (G_1, sign * G_1), spring=yaw).det() for sign in (1, -1)],
    (2 * (lam + 2 * k) * (lam**2 + G_1**2 * s**2), 2 * lam * (lam * (lam + 2 * k) + G_1**2 * s**2)),
    "equal and opposite spins with a spring against yaw",
    names=("P_=(s)", r"P_\pm(s)"),
)

# %% [markdown]
# With $2k>\kappa$ the pair is stable for equal spins above $2\sqrt{a\kappa}$, like a single rotor. With opposite spins it is
# unstable for any spring: the factor $\lambda$ is toppling, on which opposite spins do not act.
#
# ## Friction
#
# With friction $c$ the complex tilt $x+iy$ of a pair of motions obeys $as^2+(c-i\beta)s-\kappa=0$. Without friction
# $s=iw$ with $\kappa=\beta w-aw^2$. To first order $s=iw+cg$:

# %%
w, i = sp.Symbol("w", real=True), sp.I
g = w / (beta - 2 * a * w)
root = i * w + c * g
prove(
    sp.expand(a * root**2 + (c - i * beta) * root - (beta * w - a * w**2)),
    c**2 * g * (a * g + 1),
    "the remaining terms of the equation are of second order in the friction",
    names="as^2+(c-i\\beta)s-\\kappa",
)

# %% [markdown]
# The slow precession, $0<w<\beta/2a$, grows at $cw/(\beta-2aw)$, and the fast one decays. Under weight, friction therefore
# destabilises a position that the spins stabilise, at any spin (Kelvin, Tait & Chetaev). If springs make it stable,
# $\kappa<0$ and $w<0$ or $w>\beta/a$: both precessions decay.
#
# ## Compared with the exact motion


# %%
def held(spins: list[float], **more: object) -> tuple[float, float, float]:
    """(factor, measured growth 3 % under over the linear one less 1, distance from the linear motion 3 % over)."""
    factor = Structure(spins=spins, **more).critical_spin()
    under, over = (Structure(spins=[x * factor * f for f in spins], **more) for x in (0.97, 1.03))
    return factor, measured_growth(under) / under.stands().growth - 1, bounded_motion(over, turns=8)[1]


cases = {
    "corner, massless bars": held([1, 0, 1], **corner, **weight),
    "corner under 50 kg on the middle tip, heavy bars": held(
        [30, 0, 30], **corner, gravity=9.81, load=[0, 50, 0], link=Link(mass=0.3, inertia=0.1)
    ),
}
assert all(abs(growth) < 1e-3 and off < 1e-3 for _, growth, off in cases.values())
with_friction = Structure(**corner, spins=[40, 0, 40], friction=0.5, **weight)
falling = with_friction.stands()
assert falling.critical_spin == inf
Remark(
    "Thresholds on the exact motion",
    "The least spin for stability is compared with exact runs 3 % below and 3 % above it. "
    + " ".join(
        f"{name.capitalize()}: the threshold is {factor:.5g} times the given spins. Below it the measured growth rate has a "
        f"relative error of {abs(growth):.0e}; above it the motion is bounded, and its relative distance from the linear motion "
        f"is at most {off:.0e}."
        for name, (factor, growth, off) in cases.items()
    ),
)

# %%
kappa_over_a = (coefficients(with_friction).gravity * coefficients(with_friction).S / coefficients(with_friction).A)[0]
Remark(
    "With friction the structure falls slowly",
    "Without friction a corner with spins of 40 rad/s is stable. With a friction of 0.5 N m s/rad it falls: according to the "
    f"linearised equations its tilt grows by the factor e every {1 / falling.growth:.2f} s, and in the exact motion every "
    f"{1 / measured_growth(with_friction, folds=0.2):.2f} s. Without spin it grows by this factor every "
    f"{kappa_over_a**-0.5:.2f} s.",
)
