# %% [markdown]
# # The normal form about a periodic orbit
#
# **Objective.** How the angle of a return depends on the size of a motion about a periodic orbit, for any Hamiltonian system,
# and the same for Hénon's map in closed form.
#
# **Assumptions.** A section across the orbit, motions of the orbit's energy; no multiplier is 1 or −1.
#
# **Notation.** $y=(u,v)$ the displacement on the section, $F$ the return map, $\Lambda$ its linear part; $z$, $w$ normal
# coordinates with $\{z,w\}=-i$, $I=zw$; $\Phi_h$ the flow of $h$ in unit time; $\alpha$ the angle of a return, $c=\cot(\alpha/2)$.
#
# **What is known.** Birkhoff (1927), Moser (1973); of Hénon's map Dullin, Meiss & Sterling (2000).

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import System, coordinates, t
from lagrotor.numerics import measured_order
from lagrotor.paper import Remark, prove

# %% [markdown]
# ## The return map is canonical
#
# In canonical coordinates $(x_1,u,p_1,v)$ with $x_1$ along the motion the section is $x_1=0$, and $p_1=P(u,v)$ is what the energy
# leaves. The embedding's derivative $E$ keeps the bracket's matrix:

# %%
P_u, P_v = sp.symbols("P_u P_v")
Omega = sp.Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-1, 0, 0, 0], [0, -1, 0, 0]])
E = sp.Matrix([[0, 0], [1, 0], [P_u, P_v], [0, 1]])
prove(E.T * Omega * E, sp.Matrix([[0, 1], [-1, 0]]), "y has canonical brackets", names=r"E^T\Omega E")

# %% [markdown]
# Coordinates with $x_1$ along any velocity: a unitary matrix for $q+ip$, here of two degrees of freedom:

# %%
phi_1, phi_2, theta = sp.symbols("phi_1 phi_2 theta", real=True)
A = sp.Matrix([[sp.cos(theta) * sp.cos(phi_1), -sp.sin(theta) * sp.cos(phi_2)], [sp.sin(theta) * sp.cos(phi_2), sp.cos(theta) * sp.cos(phi_1)]])
B = sp.Matrix([[sp.cos(theta) * sp.sin(phi_1), sp.sin(theta) * sp.sin(phi_2)], [sp.sin(theta) * sp.sin(phi_2), -sp.cos(theta) * sp.sin(phi_1)]])
S = sp.Matrix(sp.BlockMatrix([[A, -B], [B, A]]))
prove(S.T * Omega * S, Omega, "the frame is canonical", names=r"S^T\Omega S")

# %% [markdown]
# ## What a change of coordinates removes
#
# $\chi\circ\Lambda^{-1}$ of a term $z^aw^b$, with $\Lambda:z\to e^{i\alpha}z$, $w\to e^{-i\alpha}w$ and $q=e^{i\alpha}$:

# %%
z, w, turn = sp.symbols("z w q")  # q = exp(i alpha)


def bracket(f, g):
    """{f, g} with {z, w} = −i."""
    return sp.expand(-sp.I * (f.diff(z) * g.diff(w) - f.diff(w) * g.diff(z)))


def turned(f):
    """f ∘ Λ⁻¹."""
    return sp.expand(f.subs({z: z / turn, w: w * turn}, simultaneous=True))


prove(turned(z**3 * w), z**3 * w / turn**2, "a term is multiplied by exp(iα(b − a))", names=r"z^3w\circ\Lambda^{-1}")

# %% [markdown]
# ## Hénon's map
#
# A kick $y\to y-x^2$ and the turn $\Lambda$ by $\alpha$, with $x=(z+w)/\sqrt2$ and $y=i(w-z)/\sqrt2$:

# %%
x, y = (z + w) / sp.sqrt(2), sp.I * (w - z) / sp.sqrt(2)
prove(bracket(x, y), 1, "the coordinates are canonical", names=r"\{x,y\}")

# %%
kick = x**3 / 3
prove((bracket(x, kick), bracket(y, kick)), (0, -(x**2)), "the kick is the flow of x³/3", names=(r"\{x,k\}", r"\{y,k\}"))

# %% [markdown]
# So $F=\Lambda\circ\Phi_k=\Phi_h\circ\Lambda$ with $h=k\circ\Lambda^{-1}$. The change $\Phi_\chi$ takes $h$ to
# $h-\chi+\chi\circ\Lambda^{-1}$, which is zero for

# %%
h = sp.Poly(turned(kick), z, w)
chi = sum(value * z**m * w**n / (1 - turn ** (n - m)) for (m, n), value in h.terms())
prove(chi - chi.subs({z: z / turn, w: w * turn}, simultaneous=True), h.as_expr(), "the change of third degree", names="h_3")

# %% [markdown]
# At fourth degree $\Phi_\chi^{-1}\Phi_h\Phi_{\chi\circ\Lambda^{-1}}$ leaves $\tfrac12\{h,\chi\}$ (Campbell, Baker, Hausdorff),
# and of it what $\Lambda$ keeps, $K=\tfrac12\tau I^2$. With $e^{i\alpha}=(c+i)/(c-i)$ the twist is

# %%
c = sp.Symbol("c", real=True)
left = sp.Poly(bracket(h.as_expr(), chi) / 2, z, w).coeff_monomial(z**2 * w**2)
twist = sp.cancel((2 * left).subs(turn, (c + sp.I) / (c - sp.I)))
triple = (c**3 - 3 * c) / (3 * c**2 - 1)  # cot(3 alpha/2)
prove(twist, (3 * c + triple) / 8, "the twist of Hénon's map", names=r"\tau")

# %% [markdown]
# It vanishes at $\cos\alpha=-1/4$, where the published twistless bifurcation is, and has no bound at the resonance of third order:

# %%
root = sp.sqrt(sp.Rational(3, 5))
prove(
    (twist.subs(c, root), ((c**2 - 1) / (c**2 + 1)).subs(c, root)),
    (0, -sp.Rational(1, 4)),
    "where it vanishes",
    names=(r"\tau", r"\cos\alpha"),
)

# %% [markdown]
# ## Measured on exact runs
#
# The series of any system's return map comes from the motion of power series (jets); the form is of fourth order, so that the
# angle $\alpha_0+\tau I$ is off by $O(I^2)$, fourth order in the size. Exact runs are read once a period of the drive:

# %%
one = coordinates("x")
(q,), (v,) = one.q, one.v
CASES = {
    "a pendulum whose support moves": (sp.cos(q) * (1 + sp.cos(sp.Rational(5, 2) * t) / 6), 0.0, 2.5),
    "a driven Duffing oscillator": (-(q**2) / 2 - q**4 / 7 + q * sp.cos(sp.Rational(9, 5) * t) / 6, -0.07, 1.8),
}
SIZES, RETURNS = np.array([0.1, 0.07, 0.05]), 120


def form_of(name):
    """The system, and its form of fourth order about the orbit near rest."""
    potential, place, drive = CASES[name]
    system = System(one, v**2 / 2 + potential)
    return system, system.hamiltonian().normal_form(order=4, at={q: place}, period=2 * np.pi / drive)


def angle(system, n, size):
    """The mean angle of a return of the exact motion that begins at z = size, weighted by a bump."""
    start = list(n.place([size]).values())
    run = system.simulate({}, [start[0]], [start[1]], n.period * np.arange(RETURNS + 1), tol=1e-10)
    slope = np.array([[f.terms.get(e, 0.0) for e in ((1, 0), (0, 1))] for f in n.frame]) @ n.vectors
    apart = np.column_stack([run.q[:, 0], run.v[:, 0]]) - np.array(list(n.orbit.values()))
    around = np.linalg.solve(slope, apart.T + 0j)[0]
    turned = np.angle(around[:-1] / around[1:] * np.exp(-1j * n.frequencies[0])) + n.frequencies[0]
    share = (np.arange(RETURNS) + 0.5) / RETURNS
    weights = np.exp(-1 / (share * (1 - share)))
    return float(weights @ turned / weights.sum())


measured, flat = {}, {}
for name in CASES:
    system, n = form_of(name)
    exact = np.array([angle(system, n, size) for size in SIZES])
    law = np.array([n.frequencies_at([size**2])[0] for size in SIZES])
    measured[name] = measured_order(SIZES, np.abs(exact - law))
    flat[name] = measured_order(SIZES, np.abs(exact - n.frequencies[0]))
assert all(abs(order - 4) < 0.1 for order in measured.values()), measured
assert all(abs(order - 2) < 0.1 for order in flat.values()), flat
Remark(
    "Normal forms about periodic orbits",
    "The angle of a return of exact runs differs from that of the normal form by amounts that fall as the size to the "
    + "; ".join(f"{order:.2f} ({name})" for name, order in measured.items())
    + "; without the twist to the "
    + "; ".join(f"{order:.2f}" for order in flat.values())
    + ".",
)
