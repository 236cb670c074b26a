# %% [markdown]
# # Waves through spin coupling
#
# **Objective.** The dispersion relations of rows of rotors: how waves run where there are no springs, which patterns
# have gaps,
# what the gaps mean for standing, and where bands are topological.
#
# **Assumptions.** Small motion; in the closed forms equal rotors and massless bars.
#
# **Notation.** $a$ the inertia of an axis; $\lambda=as^2+h$ for motion as $e^{st}$, $h$ the hinge's stiffness less the
# weight's
# moment; $q$ the phase from cell to cell; $\beta(q)$ as in "Standing under load": $\lambda^2+\beta^2s^2=0$, so that
# without $h$ the rate is $\omega=\beta/a$.

# %%
import numpy as np
import sympy as sp

from lagrotor import Structure
from lagrotor.paper.notebook import Remark
from lagrotor.paper.proof import prove
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.chern import chern_numbers
from lagrotor.structures.coefficients import coefficients
from lagrotor.structures.dispersion import dispersion
from lagrotor.structures.periodic import Pattern

s, lam, q, theta, phi = sp.symbols("s lambda q theta phi", real=True)
G, G_1, G_2 = sp.symbols("G G_1 G_2", real=True)
E = sp.exp(-sp.I * q)

# %% [markdown]
# ## The straight row
#
# Its bars hold every tilt along it: for $q\neq0$ all $x=0$, one freedom a rotor is left, and a spin needs two to act
# on. Its bands are flat, and zero without hinges.
#
# ## The staircase
#
# Bars along $x$ and $y$ in turn: a cell has a tilt $X$ shared by its two rotors, and a $Y$ shared by the second and the
# first of the next cell. Rotor 2 couples $X$ with the $Y$ of its cell, rotor 1 with that of the cell before:

# %%
coupling = G_2 + G_1 * E
staircase = sp.Matrix([[2 * lam, s * coupling], [-s * coupling.subs(q, -q), 2 * lam]])
prove(
    sp.expand(staircase.det()).rewrite(sp.cos).expand(),
    4 * lam**2 + s**2 * (G_1**2 + G_2**2 + 2 * G_1 * G_2 * sp.cos(q)),
    "the characteristic polynomial of the staircase",
    names="P(s,q)",
)

# %% [markdown]
# so that $4\beta^2=G_1^2+G_2^2+2G_1G_2\cos q$: the bands of Su, Schrieffer & Heeger's chain, the spins in the place of
# its hoppings.

# %%
beta = (G_1**2 + G_2**2 + 2 * G_1 * G_2 * sp.cos(2 * theta)) / 4
prove(
    [beta.subs({G_1: G, G_2: G}), beta.subs({G_1: G, G_2: -G})],
    (G**2 * sp.cos(theta) ** 2, G**2 * sp.sin(theta) ** 2),
    "equal and opposite spins, with θ = q/2",
    names=(r"\beta_=^2", r"\beta_\pm^2"),
)

# %% [markdown]
# Opposite spins make a row with neither weight nor spring that carries sound: $\omega=(G/a)\sin(q/2)$, at $G/(2a)$
# cells a second for long waves. Of the four bands two are zero: displacements that stay. Unequal spins have the gap

# %%
prove(
    [beta.subs(theta, 0), beta.subs(theta, sp.pi / 2)],
    ((G_1 + G_2) ** 2 / 4, (G_1 - G_2) ** 2 / 4),
    "the edges of the band",
    names=(r"\beta^2(0)", r"\beta^2(\pi)"),
)

# %% [markdown]
# An endless staircase stands under load exactly where the lower edge $||G_1|-|G_2||/2$ exceeds $2\sqrt{a\kappa}$.
#
# ## Ends
#
# An open staircase of $N$ rotors has $N+1$ such tilts in a row; those at the ends belong to one rotor, and have half
# the inertia. With equal $|G|$ the tilts $\cos j\theta$ (with signs that undo those of the spins) satisfy the equations
# of the inner ones,

# %%
j = sp.Symbol("j", real=True)
prove(
    sp.expand(sp.expand_trig(sp.cos(j * theta - theta) + sp.cos(j * theta + theta))),
    2 * sp.cos(theta) * sp.cos(j * theta),
    "the inner tilts: neighbours add up to 2 cos θ times the one between",
    names=r"\cos(j-1)\theta+\cos(j+1)\theta",
)

# %% [markdown]
# and of the ends, $\cos\theta=\cos\theta\cdot1$ with half the inertia, if $\sin N\theta=0$: **the modes of the open
# staircase lie on the band, at $\beta=G|\cos(k\pi/N)|$, whatever the signs of its spins.**


# %%
def step(spins: tuple[float, float], **more: object) -> Pattern:
    return Pattern(Assembly([(0, 0), (1, 0)], spins=spins, **more), ((1.0, 1.0),), ((0, 1, (0,)), (1, 0, (1,))))


a = 1.25
found = {}
for N in (16, 32, 64):
    one = step((10.0, -10.0)).finite(N // 2)
    rates = np.sort(one.modes().rates)[-(N // 2) :]
    band = np.sort(dispersion(step((10.0, -10.0)), np.pi - 2 * np.pi * np.arange(N // 2) / N).rates[:, -1])
    slow = one.modes()
    k = int(np.flatnonzero(slow.rates > 1e-6)[np.argmin(slow.rates[slow.rates > 1e-6])])
    period, shape = 2 * np.pi / slow.rates[k], 1e-7 * slow.shapes[k]
    run = one.simulate([0.0, period], shape.real, (1j * slow.rates[k] * shape).real, tol=1e-9)
    back = float(np.abs(run.axes[:, 1] - run.axes[:, 0]).max() / 1e-7)
    found[N] = (float(np.abs(rates / band - 1).max()), float(slow.rates[k]), back)
    assert found[N][0] < 1e-9 and back < 0.02
Remark(
    "Modes of open staircases on the band",
    "; ".join(
        f"N = {N}: all modes within {off:.0e} of the dispersion relation; the slowest, {rate:.5f} rad/s, is "
        "back after its period on the "
        f"exact motion within {back:.0e} of its amplitude"
        for N, (off, rate, back) in found.items()
    )
    + ".",
)

# %% [markdown]
# Under load the least $\beta$ decides. With equal $|G|$ and odd $N$ it is $G\sin(\pi/2N)$, and the spin that is needed
# grows with the length. With every second rotor at rest the tilts fall into pairs, $\beta=G/2$ or, at the ends,
# $G/\sqrt2$: $4\sqrt{a\kappa}$ suffices for any odd length.

# %%
least = {}
for N in (5, 9, 17, 33):
    row = []
    for rest in (1.0, 0.0):
        shape = [((k + 1) // 2, k // 2) for k in range(N)]
        spins = [1.0 if k % 2 == 0 else rest for k in range(N)]
        one = Structure(shape, [(k, k + 1) for k in range(N - 1)], spins, gravity=9.81, load=2.0)
        c = coefficients(one)
        row.append(one.critical_spin() / float(np.sqrt(c.A[0] * c.gravity * c.S[0])))
    least[N] = row
    assert abs(row[0] * np.sin(np.pi / (2 * N)) / 2 - 1) < 1e-9 and abs(row[1] / 4 - 1) < 1e-9
Remark(
    "A gap that makes long rows stand",
    "Least spin in √(aκ)/I3 of staircases under load, all spinning alike against every second at rest: "
    + "; ".join(f"N = {N}: {row[0]:.2f} against {row[1]:.2f}" for N, row in least.items())
    + ".",
)

# %% [markdown]
# ## A zigzag of any angle
#
# Let $\varphi$ be the angle between neighbouring bars. With $p=n_1\cdot u$ and $r=n_2\cdot u$, which the bars hand on,
# as coordinates the inertia is $(p^2+r^2-2pr\cos\varphi)/\sin^2\varphi$ a rotor and the spin acts by
# $(pr'-rp')/\sin\varphi$:

# %%
f = (1 + E) / sp.sin(phi) ** 2
own, mixed, spun = 2 / sp.sin(phi) ** 2, -sp.cos(phi) * f, G * (1 + E) / sp.sin(phi)
zigzag = sp.Matrix([[lam * own, lam * mixed + s * spun], [(lam * mixed - s * spun).subs(q, -q), lam * own]])
cosine = sp.cos(q / 2) ** 2
determinant = sp.expand(zigzag.det()).rewrite(sp.cos).expand().subs(sp.cos(q), 2 * cosine - 1)
prove(
    sp.expand(determinant * sp.sin(phi) ** 4),
    4 * lam**2 * (1 - sp.cos(phi) ** 2 * cosine) + 4 * s**2 * G**2 * cosine * sp.sin(phi) ** 2,
    "the characteristic polynomial of the zigzag of equal spins",
    names=r"P(s,q)\sin^4\varphi",
)

# %% [markdown]
# so that $\beta=G\sin\varphi\cos(q/2)/\sqrt{1-\cos^2\varphi\cos^2(q/2)}$: $G\cos(q/2)$ of the staircase, and nothing
# but the motion as a whole, $\beta(0)=G$, as the zigzag straightens.

# %%
offs = []
for angle in (0.3, 1.0, 2.0):
    bent = (np.cos(angle), np.sin(angle))
    pattern = Pattern(Assembly([(0, 0), (1, 0)], spins=10.0), ((1 + bent[0], bent[1]),), ((0, 1, (0,)), (1, 0, (1,))))
    phases = np.linspace(0.2, 3.0, 15)
    closed = 10 / a * np.sin(angle) * np.cos(phases / 2) / np.sqrt(1 - (np.cos(angle) * np.cos(phases / 2)) ** 2)
    offs.append(float(np.abs(dispersion(pattern, phases).rates[:, -1] / closed - 1).max()))
assert max(offs) < 1e-9
Remark("The zigzag", f"The library's bands are the closed form's at angles of 0.3, 1 and 2 rad within {max(offs):.0e}.")

# %% [markdown]
# ## Two directions
#
# Rigid bars on a square leave no waves at a general $q$: its rows and columns move as a whole. On a honeycomb they
# leave one freedom a cell, on which spins do not act: the band is flat, and at $q=0$, where the honeycomb moves as a
# whole, there are two: no Chern number is defined. Springs in place of bars leave all freedoms.


# %%
def honeycomb(first: float, second: float) -> Pattern:
    """Rotors on hinges, joined by springs: two a cell."""
    springs = ((0, 1, (0, 0), 1.0), (1, 0, (0, 1), 1.0), (1, 0, (-1, 1), 1.0))
    return Pattern(
        Assembly([(0, 0), (0, 1)], spins=[first, second], hinge=4.0),
        ((3**0.5, 0.0), (3**0.5 / 2, 1.5)),
        springs=springs,
    )


numbers = {spins: chern_numbers(honeycomb(*spins)) for spins in ((20.0, 20.0), (-20.0, -20.0), (20.0, 30.0))}
assert numbers[20.0, 20.0][:2] == (-1, 1)
assert numbers[-20.0, -20.0] == tuple(-n for n in numbers[20.0, 20.0])
assert numbers[20.0, 30.0] == (0, 0, 0, 0)
Remark(
    "Chern numbers of gyroscopes on a honeycomb of springs",
    "; ".join(f"spins {one:g} and {two:g} rad/s: {', '.join(map(str, n))}" for (one, two), n in numbers.items())
    + ", the two slow bands first. The slow bands' ∓1 and their change of sign with the spins are those of Nash "
    "et al. (2015); "
    "spins that differ enough between the two places of a cell undo them.",
)
