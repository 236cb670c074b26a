# %% [markdown]
# # The normal form about a periodic orbit
#
# **Objective.** The dependence of the angle of a return on the size of a motion about a periodic orbit, for any Hamiltonian
# system, and for Hénon's map in closed form.
#
# **Assumptions.** A section across the orbit; motions with the energy of the orbit; no multiplier is 1 or −1.
#
# **Notation.** $y=(u,v)$ the displacement on the section, $F$ the return map, $\Lambda$ its linear part; $z$, $w$ normal
# coordinates with $\{z,w\}=-i$, $I=zw$; $\Phi_h$ the flow of $h$ in unit time; $\alpha$ the angle of a return,
# $c=\cot(\alpha/2)$.
#
# **What is known.** Birkhoff (1927), Moser (1973); of Hénon's map Dullin, Meiss & Sterling (2000).

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import System, coordinates, t
from lagrotor.numerics import measured_order
from lagrotor.paper import Remark, prove

# %% [markdown]
# ## The return map is canonical
#
# In canonical coordinates $(x_1,u,p_1,v)$ with $x_1$ along the motion the section is $x_1=0$, and the energy determines
# $p_1=P(u,v)$. The derivative $E$ of this embedding preserves the matrix of the Poisson bracket:

# %%
P_u, P_v = sp.symbols("P_u P_v")
Omega = sp.Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-1, 0, 0, 0], [0, -1, 0, 0]])
E = sp.Matrix([[0, 0], [1, 0], [P_u, P_v], [0, 1]])
prove(E.T * Omega * E, sp.Matrix([[0, 1], [-1, 0]]), "y has canonical brackets", names=r"E^T\Omega E")

# %% [markdown]
# A unitary matrix for $q+ip$ turns $x_1$ into the direction of any velocity, shown for two degrees of freedom:

# %%
phi_1, phi_2, theta = sp.symbols("phi_1 phi_2 theta", real=True)
cos, sin = sp.cos, sp.sin
A = sp.Matrix([[cos(theta) * cos(phi_1), -sin(theta) * cos(phi_2)], [sin(theta) * cos(phi_2), cos(theta) * cos(phi_1)]])
B = sp.Matrix([[cos(theta) * sin(phi_1), sin(theta) * sin(phi_2)], [sin(theta) * sin(phi_2), -cos(theta) * sin(phi_1)]])
S = sp.Matrix(sp.BlockMatrix([[A, -B], [B, A]]))
prove(S.T * Omega * S, Omega, "the frame is canonical", names=r"S^T\Omega S")

# %% [markdown]
# ## Terms that a change of coordinates removes
#
# $\chi\circ\Lambda^{-1}$ for a term $z^aw^b$, with $\Lambda:z\to e^{i\alpha}z$, $w\to e^{-i\alpha}w$ and $q=e^{i\alpha}$:

# %%
z, w, turn = sp.symbols("z w q")  # q = exp(i alpha)


def bracket(f, g):
    """Return {f, g} with {z, w} = −i."""
    return sp.expand(-sp.I * (f.diff(z) * g.diff(w) - f.diff(w) * g.diff(z)))


def turned(f):
    """Return f ∘ Λ⁻¹."""
    return sp.expand(f.subs({z: z / turn, w: w * turn}, simultaneous=True))


prove(turned(z**3 * w), z**3 * w / turn**2, "a term is multiplied by exp(iα(b − a))", names=r"z^3w\circ\Lambda^{-1}")

# %% [markdown]
# ## Hénon's map
#
# Hénon's map is a kick $y\to y-x^2$ and the rotation $\Lambda$ by $\alpha$, with $x=(z+w)/\sqrt2$ and $y=i(w-z)/\sqrt2$:

# %%
x, y = (z + w) / sp.sqrt(2), sp.I * (w - z) / sp.sqrt(2)
prove(bracket(x, y), 1, "the coordinates are canonical", names=r"\{x,y\}")

# %%
kick = x**3 / 3
prove(
    (bracket(x, kick), bracket(y, kick)), (0, -(x**2)), "the kick is the flow of x³/3", names=(r"\{x,k\}", r"\{y,k\}")
)

# %% [markdown]
# So $F=\Lambda\circ\Phi_k=\Phi_h\circ\Lambda$ with $h=k\circ\Lambda^{-1}$. The change $\Phi_\chi$ takes $h$ to
# $h-\chi+\chi\circ\Lambda^{-1}$, which is zero for

# %%
h = sp.Poly(turned(kick), z, w)
chi = sum(value * z**m * w**n / (1 - turn ** (n - m)) for (m, n), value in h.terms())
prove(
    chi - chi.subs({z: z / turn, w: w * turn}, simultaneous=True),
    h.as_expr(),
    "the change of third degree",
    names="h_3",
)

# %% [markdown]
# The term of fourth degree of $\Phi_\chi^{-1}\Phi_h\Phi_{\chi\circ\Lambda^{-1}}$ is $\tfrac12\{h,\chi\}$ (Campbell, Baker,
# Hausdorff). Its part invariant under $\Lambda$ is $K=\tfrac12\tau I^2$. With $e^{i\alpha}=(c+i)/(c-i)$ the twist is

# %%
c = sp.Symbol("c", real=True)
left = sp.Poly(bracket(h.as_expr(), chi) / 2, z, w).coeff_monomial(z**2 * w**2)
twist = sp.cancel((2 * left).subs(turn, (c + sp.I) / (c - sp.I)))
triple = (c**3 - 3 * c) / (3 * c**2 - 1)  # cot(3 alpha/2)
prove(twist, (3 * c + triple) / 8, "the twist of Hénon's map", names=r"\tau")

# %% [markdown]
# The twist vanishes at $\cos\alpha=-1/4$, the published twistless bifurcation, and diverges at the resonance of third order:

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
# The series of the return map of any system comes from the motion of power series (jets). Through sixth order the angle of a
# return is $\alpha+\tau I+cI^2$. The error of $\alpha$ alone is of second order in the size, the error with the twist of fourth,
# that of the whole sum of sixth order. Exact runs, by an independent integrator, are read at 120 returns: at the crossings of
# the section, or once per period of the drive.

# %%
line, plane = coordinates("x"), coordinates("x y")
(s,), (s_v,) = line.q, line.v
(x_1, y_1), (x_v, y_v) = plane.q, plane.v
swing = System(line, s_v**2 / 2 + sp.cos(s) * (1 + sp.cos(sp.Rational(5, 2) * t) / 6))
duffing = System(line, s_v**2 / 2 - s**2 / 2 - s**4 / 7 + s * sp.cos(sp.Rational(9, 5) * t) / 6)
henon_heiles = System(plane, (x_v**2 + y_v**2 - x_1**2 - y_1**2) / 2 - x_1**2 * y_1 + y_1**3 / 3)
CASES = {  # system, near the orbit's start, near its period in s, the largest size
    "a pendulum whose support moves": (swing, {s: 0}, 2 * np.pi / 2.5, 0.15),
    "a driven Duffing oscillator": (duffing, {s: -0.07}, 2 * np.pi / 1.8, 0.16),
    "an orbit of Hénon–Heiles": (henon_heiles, {x_1: 0, y_1: 0, y_v: 0.38}, 6.8, 0.018),
}
sides = {name: system.hamiltonian() for name, (system, *_) in CASES.items()}
forms = {name: sides[name].normal_form(order=6, at=at, period=T) for name, (_, at, T, _) in CASES.items()}


def returns(h, n, size, count=120):
    """Return (q, p) minus the orbit's start at the returns of the exact motion from z = size."""
    states, base, driven = (*h.q, *h.p), np.array(list(n.orbit.values())), h.H.has(t)
    rates = sp.lambdify((*states, t), [*(h.H.diff(p) for p in h.p), *(-h.H.diff(q) for q in h.q)], "math")
    along = np.array(rates(*base, 0.0))

    def section(_, state):
        return (state - base) @ along

    section.direction = 1
    times, start = n.period * np.arange(count + 1), list(n.place([size]).values())
    run = solve_ivp(
        lambda now, state: rates(*state, now), (0, times[-1]), start, "DOP853", times,
        events=None if driven else section, rtol=1e-11, atol=1e-13,
    )  # fmt: skip
    return (run.y.T if driven else run.y_events[0]) - base


def angle(n, apart):
    """Return the mean angle in rad of these returns, weighted by a bump function, which converges faster than any power."""
    slope = np.array([[f.terms.get(e, 0.0) for e in ((1, 0), (0, 1))] for f in n.frame]) @ n.vectors
    around = np.linalg.lstsq(slope, apart.T + 0j)[0][0]
    turned = np.angle(around[:-1] / around[1:] * np.exp(-1j * n.frequencies[0])) + n.frequencies[0]
    share = (np.arange(turned.size) + 0.5) / turned.size
    weights = np.exp(-1 / (share * (1 - share)))
    return float(weights @ turned / weights.sum())


measured = {}
for name, n in forms.items():
    sizes = CASES[name][-1] * np.array([1, 0.7, 0.5])
    exact = np.array([angle(n, returns(sides[name], n, size)) for size in sizes])
    (alpha,), tau = n.frequencies, n.twist[0, 0]
    laws = alpha + 0 * sizes, alpha + tau * sizes**2, np.array([n.frequencies_at([size**2])[0] for size in sizes])
    measured[name] = [measured_order(sizes, np.abs(exact - law)) for law in laws]
    assert np.abs(np.array(measured[name]) - (2, 4, 6)).max() < 0.1, measured
Remark(
    "Normal forms about periodic orbits",
    "The angle of a return of exact runs differs from the angle of the orbit, from this angle with the twist, and from the "
    "normal form of sixth order. The differences are proportional to these powers of the size: "
    + "; ".join(", ".join(f"{order:.2f}" for order in orders) + f" ({name})" for name, orders in measured.items())
    + ".",
)
