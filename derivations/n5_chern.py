# %% [markdown]
# # Bands with a Chern number
#
# **Objective.** Patterns of rotors on hinges whose bands have a nonzero Chern number, so that waves run one way along their
# border: with springs between the tips, and with rigid bars.
#
# **Assumptions.** Small motion about upright axes on elastic hinges, no friction.
#
# **Notation.** $a$ the inertia of an axis, $G$ its momentum, $\kappa$ its hinge, $k$ the stiffness of a spring between tips,
# lengths of axes 1; $\mu=\kappa+\tfrac32k-a\omega^2$. The Chern numbers are computed by the method of Fukui, Hatsugai and
# Suzuki with the symplectic product of waves.

# %%
import numpy as np
import sympy as sp

from lagrotor import Rotor
from lagrotor.errors import InputError
from lagrotor.paper import Remark, prove
from lagrotor.structures import honeycomb, square_octagon
from lagrotor.structures.waves.chern import chern_numbers, edge_waves

a, k, G, omega = sp.symbols("a k G omega", positive=True)
mu, mu_A, mu_B = sp.symbols("mu mu_A mu_B", real=True)
i, root = sp.I, sp.sqrt(3)

# %% [markdown]
# ## The honeycomb of springs at the smallest gap
#
# Three springs act on each tip, along $n_1,n_2,n_3$ at 120°, $k\sum nn^T=\tfrac32k$. At the corner $K$ of the zone the far
# ends have the phases $1,\varepsilon,\varepsilon^2$ with $\varepsilon=e^{2\pi i/3}$. The springs of one tip add up to

# %%
directions = [sp.Matrix([0, 1]), sp.Matrix([-root / 2, -sp.Rational(1, 2)]), sp.Matrix([root / 2, -sp.Rational(1, 2)])]
cube = -sp.Rational(1, 2) + i * root / 2
phases = [sp.Integer(1), sp.conjugate(cube), cube]
prove(
    sum((n * n.T for n in directions), sp.zeros(2, 2)),
    sp.Rational(3, 2) * sp.eye(2),
    "the springs of one tip",
    names=r"\sum nn^T",
)

# %% [markdown]
# A wave $e^{-i\omega t}$ at $K$ needs $\det D(K)=0$. $D$ is the stiffness minus $\omega^2$ times the mass matrix minus
# $i\omega$ times the gyroscopic matrix. With equal spins

# %%
joined = -k * sum((n * n.T * phase for n, phase in zip(directions, phases, strict=True)), sp.zeros(2, 2))


def corner(first: sp.Expr, second: sp.Expr, G_A: sp.Expr, G_B: sp.Expr) -> sp.Expr:
    """det(K − ω² M − i ω C) at K."""
    own = [sp.Matrix([[m, -i * omega * g], [i * omega * g, m]]) for m, g in ((first, G_A), (second, G_B))]
    below = joined.applyfunc(sp.conjugate).T
    return sp.Matrix(sp.BlockMatrix([[own[0], joined], [below, own[1]]])).det(method="laplace")


quarter = sp.Rational(9, 4) * k**2
prove(
    corner(mu, mu, G, G),
    (mu**2 - omega**2 * G**2) * (mu**2 - omega**2 * G**2 - quarter),
    "equal spins at K",
    names=r"\det D(K)",
)

# %% [markdown]
# At $K$ the springs do not act on one sense of circling of each axis, $\mu=\pm\omega G$, and couple the other senses by
# $\tfrac32k$. The two precessions have different rates there: a gap exists for every spin and spring. With opposite spins

# %%
prove(
    corner(mu, mu, G, -G),
    (mu - omega * G) ** 2 * ((mu + omega * G) ** 2 - quarter),
    "opposite spins at K",
    names=r"\det D(K)",
)

# %% [markdown]
# a double root remains: the bands touch, at any spring. Unequal hinges on the two rotors A and B of a cell separate them:

# %%
unequal = (mu_A - omega * G) * (mu_B + omega * G) * ((mu_A + omega * G) * (mu_B - omega * G) - quarter)
prove(corner(mu_A, mu_B, G, G), unequal, "unequal hinges at K", names=r"\det D(K)")

# %% [markdown]
# The gap closes where $\mu_A=\omega G$ and $(\mu_A+\omega G)(\mu_B-\omega G)=\tfrac94k^2$ together, that is where
# $$\kappa_B-\kappa_A=\frac{9k^2}{8\omega G},\qquad a\omega^2+G\omega=\kappa_A+\tfrac32k .$$ There the Chern numbers of the
# precessions change from the numbers that the spins give to zero. The numbers of the nutations, with $-G$ for $G$ in the
# second equation and a larger $\omega$, change at a smaller difference.

# %%
spring, hinge, spin = 50.0, 200.0, 30.0
J, momentum = Rotor().J, spin * Rotor().I3
slow = (np.sqrt(momentum**2 + 4 * J * (hinge + 1.5 * spring)) - momentum) / (2 * J)
edge = 9 * spring**2 / (8 * slow * momentum)


def sprung(spins: object, second: float = hinge) -> tuple[int, ...]:
    return chern_numbers(honeycomb(spring=spring, spins=spins, hinge=(hinge, second)), 18).numbers


numbers = {
    "for spins of 30 rad/s": sprung(spin),
    "for spins of −30 rad/s": sprung(-spin),
    "if the second hinge is stiffer than the first by 3 % less than the threshold": sprung(spin, hinge + 0.97 * edge),
    "if it is stiffer by 3 % more than the threshold": sprung(spin, hinge + 1.03 * edge),
    "for spins of ±30 rad/s and hinges of 200 and 300 N m/rad": sprung((spin, -spin), 300.0),
}
first, reversed_, below, above, opposite = numbers.values()
assert first == (-1, 1, -1, 1) and reversed_ == (1, -1, 1, -1) and below == (-1, 1, 0, 0)
assert above == opposite == (0, 0, 0, 0)
touching = chern_numbers(honeycomb(spring=spring, spins=(spin, -spin), hinge=hinge), 18).groups
assert touching == ((0, 1), (2, 3))
Remark(
    "Chern numbers of gyroscopes on a honeycomb of springs",
    f"The stiffness of the springs is {spring:g} N/m, and of the hinges {hinge:g} N m/rad. The Chern numbers of the "
    "bands, first of "
    "the two precessions and then of the two nutations, are "
    + "; ".join(f"{', '.join(map(str, found))} {name}" for name, found in numbers.items())
    + f". The threshold is a difference of {edge:.3f} N m/rad between the two hinges. On a lattice of coupled gyroscopes Nash et "
    "al. (2015) observed a gap in the spectrum and, in the gap, waves that run along the border in one direction. Nonzero Chern "
    "numbers explain such waves.",
)

# %% [markdown]
# ## A packet on the border, in the exact motion
#
# The Chern numbers of the bands below the gap add up to −1. One wave therefore runs along the lower border in the direction
# opposite to the first step, and clockwise around the whole piece. The exact motion shows its direction after a push on a
# rotor of the lower border, projected onto the modes in the gap. With reversed spins it must run in the opposite direction.


# %%
def packet(spins: float) -> tuple[tuple[int, ...], float, float]:
    """Chern numbers, and how far a packet of 0.01 has come round in 5 s, rad, with the run's error."""
    pattern = honeycomb(spring=100.0, spins=spins, hinge=100.0)
    gap = pattern.dispersion(2 * np.pi * np.stack(np.meshgrid(*[np.arange(24) / 24] * 2), -1).reshape(-1, 2)).gaps[1]
    piece = pattern.piece(4, 4)
    m, x = piece.modes(), np.array(piece.joints) - np.mean(piece.joints, axis=0)
    inside = (m.rates > gap[0]) & (m.rates < gap[1])
    pushed = int(np.argmin(np.hypot(x[:, 0], x[:, 1] - x[:, 1].min())))
    parts = np.conj(m.shapes[inside, pushed, 0])[:, None, None] * m.shapes[inside]
    tilt, rates = parts.sum(0), (1j * m.rates[inside, None, None] * parts).sum(0)
    size = 0.01 / np.abs(tilt).max()
    run = piece.simulate(np.linspace(0, 5, 101), size * tilt.real, size * rates.real, tol=1e-5)
    centre = (run.axes[..., :2] ** 2).sum(-1).T @ x  # of the squared tilts, about the middle of the piece
    angle = np.unwrap(np.arctan2(centre[:, 1], centre[:, 0]))
    return chern_numbers(pattern, 12).numbers, float(angle[-1] - angle[0]), run.error


(clockwise, gone, off), (against, back, _) = packet(20.0), packet(-20.0)
assert clockwise[0] == -1 and against[0] == 1 and gone < -np.pi < np.pi < back
Remark(
    "A wave packet on the border",
    "A piece of 32 rotors has springs of 100 N/m and hinges of 100 N m/rad. With spins of 20 rad/s the Chern numbers are "
    f"{', '.join(map(str, clockwise))}, and in 5 s the packet travels around the middle of the piece by {gone:.2f} rad. With "
    f"reversed spins it travels by +{back:.2f} rad. The error of the run is {off:.0e}.",
)

# %% [markdown]
# ## Rigid bars
#
# At each $q$ the degrees of freedom are the null space of the bars' constraints. A Chern number needs the same number of
# degrees of freedom at every $q$. At $q=0$ they include two translations. Each self-stress of the bars there, a set of
# tensions that balance at every joint, adds one degree of freedom. In a honeycomb equal tensions balance: it has one degree
# of freedom per cell, two at $q=0$, and no Chern number.

# %%
rows = sp.Matrix([[*n, *(-n)] for n in directions])
prove(sp.ones(1, 3) * rows, sp.zeros(1, 4), "equal tensions of the honeycomb balance at q = 0", names="A^T t")

# %% [markdown]
# Squares joined into octagons have two degrees of freedom per cell. Tensions of 1 in the squares and $\sqrt2$ between them
# balance, unless one joint is displaced along both axes:

# %%
square = [sp.Matrix([1, 0]), sp.Matrix([0, 1]), sp.Matrix([-1, 0]), sp.Matrix([0, -1])]
spokes = [((0, 1), 1), ((1, 2), 1), ((2, 3), 1), ((3, 0), 1), ((0, 2), sp.sqrt(2)), ((1, 3), sp.sqrt(2))]


def pull(joint: int) -> sp.Matrix:
    total = sp.zeros(2, 1)
    for index, ((p, r), tension) in enumerate(spokes):
        along = square[r] - square[p] if index < 4 else -(square[r] - square[p])
        along = along / sp.sqrt(along.dot(along))
        total += tension * ((p == joint) - (r == joint)) * along
    return total


prove(
    [sum((pull(joint)[axis] ** 2 for axis in (0, 1)), sp.Integer(0)) for joint in range(4)],
    [0] * 4,
    "the squares of the unbalanced forces at the four joints",
    names=tuple(f"|f_{joint + 1}|^2" for joint in range(4)),
)


# %%
def refused(pattern: object) -> bool:
    try:
        chern_numbers(pattern, 6)
    except InputError:
        return True
    return False


rigid = (30.0, 10.0, 30.0, 10.0)
moved = square_octagon((0.3, 0.3), spins=rigid, hinge=hinge)
bars, turned = (
    chern_numbers(moved),
    chern_numbers(square_octagon((0.3, 0.3), spins=tuple(-w for w in rigid), hinge=hinge)),
)
assert bars.numbers == (-1, 1) and turned.numbers == (1, -1)
assert refused(square_octagon(spins=rigid, hinge=hinge)) and refused(honeycomb(spins=(30.0, 10.0), hinge=hinge))
grid = 2 * np.pi * np.stack(np.meshgrid(*[np.arange(24) / 24] * 2), -1).reshape(-1, 2)
low, high = moved.dispersion(grid).gaps[1]
along = edge_waves(moved, (low + high) / 2, 8, 61)
assert (along.first, along.last) == (-1, 1)
Remark(
    "Rigid bars with a Chern number",
    "In a pattern of squares and octagons of rigid bars one joint of four is displaced by 0.3 m along both axes; the spins are "
    f"30, 10, 30, 10 rad/s, and the hinges have {hinge:g} N m/rad. There is a gap from {low:.3f} to {high:.3f} rad/s between two "
    f"bands with the Chern numbers {bars.numbers[0]} and {bars.numbers[1]}, which change sign if all spins are reversed. On each "
    "border of a strip of 8 cells one wave has a rate in the gap. It runs opposite to the first step of the lattice on the first "
    "border and along it on the last. Chern numbers are not defined for the pattern without displacement and for the honeycomb, "
    "because their bars have a self-stress at q = 0, and for the square net, which has no bands.",
)
