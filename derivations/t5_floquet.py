# %% [markdown]
# # Stability of the paired precession
#
# **Objective.** The growth of perturbations of the periodic orbit, derived from the variational equations: the exponents as a
# power series in the amplitude, the ranges in which the orbit is elliptic or hyperbolic, and the boundary between them.
#
# **Assumptions.** Opposite spins, any bar; the orbit's series of t3. The laws are leading terms, each with its error.
#
# **Notation.** $\mu$, $1/\mu$ the two Floquet multipliers that are not 1, $\log\mu=2\pi\lambda$; $\sigma=(a+b)/(a-b)$,
# $k=\ell/R$; $x,Y,z$ and the multipliers $\lambda_1$, $\tau$ as in t3; $\xi,\eta$ amplitudes of a perturbation.

# %%
import numpy as np
import sympy as sp
from scipy.optimize import brentq

from lagrotor import Link, Scene, floquet
from lagrotor.mechanics import euler_lagrange
from lagrotor.mechanics.fourier import FourierSeries
from lagrotor.numerics import measured_order
from lagrotor.pair import axes_pair
from lagrotor.pair.notation import AXES, G_1, G_2, HALF, LEAN, SWING, G, P, Phi, a, b, k, r0, sigma
from lagrotor.paper import Formula, Remark, prove
from lagrotor.theory import averaged_hamiltonian, elliptic_edge, exponent_series, growth_squared, paired_series

# %% [markdown]
# ## Perturbations that can grow
#
# At rest four of the six multipliers belong to constant displacements: rotation about the joint line, its rate, a shift of
# both axes along $x$, and a twist. Along the orbit four multipliers equal 1. Two of them are due to the energy and the shift
# of time, two to the momentum and the rotation. Exchange of the rotors with a shift by half a period ($S$, t3) maps the orbit
# to itself. The shift of time and the rotation are even under $S$; the shift along $x$ and the twist are odd. So the last
# pair of multipliers belongs to perturbations that are odd under $S$,
#
# $$\delta=\xi\,p(\Phi)+\eta\,q(\Phi),\qquad \frac{d\xi}{d\Phi}=A\,\eta,\qquad \frac{d\eta}{d\Phi}=B\,\xi,$$
#
# with periodic $p$ and $q$. At $r_0=0$ they are $p=(1,0,0)$ and $q=(0,1,0)$ in $(x,Y,z)$. Then $\lambda^2=AB$. Under time
# reversal with $y\to-y$ the vector $p$ is even and $q$ is odd. This gives the two equations their form.
#
# ## The variational equations
#
# The Lagrangian (t3) gives the equations of motion of rotor 1 and the two constraints. The units are $a+b=1$ and $\Omega_0$, and
# $y=\sqrt\sigma\,Y$:

# %%
pair = axes_pair()
multipliers = sp.symbols("lambda_1 lambda_2 tau", real=True)
forces = sp.Matrix([pair.constraints]).jacobian(list(AXES.q)).T * sp.Matrix(multipliers)
motion = (euler_lagrange(pair.L, AXES) - sp.Matrix(pair.generalised_forces) - forces).subs({G_1: G, G_2: -G})
units = {a: (1 + 1 / sigma) / 2, b: (1 - 1 / sigma) / 2, G: 1 / sp.sqrt(sigma)}
wide = {q: sp.sqrt(sigma) * q for names in (AXES.q, AXES.v, AXES.a) for q in (names[1], names[4])}
equations = sp.Matrix(
    [e.subs(units).subs(wide, simultaneous=True) for e in (*motion[:3], pair.constraints[0], pair.constraints[2])]
)
equations[1] /= sp.sqrt(sigma)
Formula(equations, "E")

# %% [markdown]
# The variations are substituted to first order in $\xi$ and $\eta$, with $\xi'=A\eta$ and $\eta'=B\xi$. The variation of a
# velocity is $\Omega$ times $(p'+Bq)\,\xi+(q'+Ap)\,\eta$. The variation of an acceleration is $\Omega^2$ times
# $(p''+2Bq'+ABp)\,\xi+(q''+2Ap'+ABq)\,\eta$. So each of the five equations gives two variational equations,
#
# $$E_\xi=\sum_j\Big(\frac{\partial E}{\partial q_j}\,p_j+\Omega\,\frac{\partial E}{\partial\dot q_j}\,(p_j'+Bq_j)
# +\Omega^2\,\frac{\partial E}{\partial\ddot q_j}\,(p_j''+2Bq_j'+ABp_j)\Big)=0,$$
#
# and $E_\eta=0$, in which $p$ and $q$, $A$ and $B$ are exchanged. The derivatives of $E$ are taken on the orbit; $j$ runs
# over both axes and the multipliers. As $p$ and $q$ are odd under $S$, their components for rotor 2 are
# $x_2(\Phi)=x_1(\Phi+\pi)$, $Y_2(\Phi)=-Y_1(\Phi+\pi)$, $z_2(\Phi)=-z_1(\Phi+\pi)$, and
# $\lambda_2(\Phi)=-\lambda_1(\Phi+\pi)$. For the bar $\tau(\Phi+\pi)=-\tau(\Phi)$.
#
# The orbit has the first order $x=r_0\cos\Phi$, $Y_1=-Y_2=r_0\sin\Phi$. With $p=(1,0,0)$ and $q=(0,1,0)$ the coefficients of
# $r_0$ follow. Each symbol means the first-order term of $p$ or of $q$, a dot means $d/d\Phi$, and $y$ means $Y$:


# %%
unknown = (*AXES.q, *AXES.v, *AXES.a, *multipliers)
x1, y1, z1, x2, y2, z2 = AXES.q
swinging = {x1: sp.cos(Phi), y1: sp.sin(Phi), x2: sp.cos(Phi), y2: -sp.sin(Phi)}
for names, slower in ((AXES.v, AXES.q), (AXES.a, AXES.v)):
    swinging |= {s: sp.sympify(swinging.get(q, 0)).diff(Phi) for s, q in zip(names, slower, strict=True)}


def first_order(displaced: dict) -> list[sp.Expr]:
    """The coefficient of r_0 in the five variational equations, for the perturbation `displaced` at r_0 = 0."""
    vary = sp.Symbol("vary")
    substitution = {
        s: int(s in (z1, z2)) + r0 * swinging.get(s, 0) + vary * (displaced.get(s, 0) + r0 * s) for s in unknown
    }
    return [sp.expand(sp.expand(e.xreplace(substitution)).coeff(vary, 1)).coeff(r0, 1) for e in equations]


(x1_v, y1_v, _, *_), (x1_a, y1_a, z1_a, x2_a, y2_a, z2_a) = AXES.v, AXES.a
direct, shared = units[a], units[b]
linear = (
    direct * x1_a + shared * x2_a + y1_v + k * multipliers[2],
    direct * y1_a + shared * y2_a - x1_v / sigma,
    direct * z1_a + shared * z2_a - multipliers[0] + multipliers[2],
    z1,
    -k * (x1 - x2) - z1 - z2,
)
driven = (0, 0, -sp.cos(Phi), sp.cos(Phi), -2 * sp.cos(Phi))
prove(
    first_order({x1: 1, x2: 1}),
    [term + drive for term, drive in zip(linear, driven, strict=True)],
    "the equations for p to first order, each to vanish",
    names=[rf"E_{{\xi,{i}}}^{{(1)}}" for i in range(1, 6)],
)

# %%
driven = (0, 0, -sp.sin(Phi), sigma * sp.sin(Phi), 2 * sigma * sp.sin(Phi))
prove(
    first_order({y1: 1, y2: -1}),
    [term + drive for term, drive in zip(linear, driven, strict=True)],
    "the equations for q to first order, each to vanish",
    names=[rf"E_{{\eta,{i}}}^{{(1)}}" for i in range(1, 6)],
)

# %% [markdown]
# At every order the linear terms of these equations contain the new terms of $p$ and $q$, driven by the lower orders. The
# equations do not determine the means of $x$ and $Y$; by definition these are the means of $p=(1,0,0)$ and $q=(0,1,0)$. The
# new terms cancel in the means of the first two equations. Because of the velocities $p'+Bq$ and $q'+Ap$, the mean of the
# first equation for $p$ contains $B$, and the mean of the second equation for $q$ contains $-A/\sigma$. These two means
# determine $A$ and $B$. (The other two means vanish, because the terms are odd in $\Phi$.) The solution through second order:

# %%
orbit, exponents = paired_series(4), exponent_series(4)
p, q = ([orbit.expression(component) for component in vector] for vector in (exponents.p, exponents.q))
c, s = sp.cos, sp.sin
prove(
    [sum((e.coeff(r0, n) * r0**n for n in range(3)), sp.Integer(0)) for e in p[:3]],
    (
        1 + (sigma - 1) * c(2 * Phi) * r0**2 / 4,
        0,
        -c(Phi) * r0 - sigma * (1 - c(2 * Phi)) * r0**2 / (2 * k),
    ),
    "the shift along x on the orbit",
    names=("p_x", "p_Y", "p_z"),
)

# %%
bend = sigma * (k**2 * (sigma - 1) + 2) / (4 * k**2)
prove(
    [sum((e.coeff(r0, n) * r0**n for n in range(3)), sp.Integer(0)) for e in q[:3]],
    (
        2 * sigma * s(Phi) * r0 / k - bend * s(2 * Phi) * r0**2,
        1 - 2 * c(Phi) * r0 / k + 2 * bend * c(2 * Phi) * r0**2,
        -sigma * s(Phi) * r0 + sigma * s(2 * Phi) * r0**2 / (4 * k),
    ),
    "the twist on the orbit",
    names=("q_x", "q_Y", "q_z"),
)

# %% [markdown]
# ## The two coefficients
#
# The twist drives the shift at second order. The shift drives the twist only at fourth order:

# %%
A, B = (orbit.expression(coefficient) for coefficient in (exponents.A, exponents.B))
fourth = 37 * k**2 * sigma**3 - 72 * k**2 * sigma**2 + 33 * k**2 * sigma + 2 * k**2 + 33 * sigma**2 - 3 * sigma + 6
prove(
    (A, B),
    (-sigma * (sigma - 1) * r0**2 / 2 + sigma * fourth * r0**4 / (48 * k**2), 3 * sigma * r0**4 / (8 * k**2)),
    "the coefficients through fourth order",
    names=("A", "B"),
)

# %% [markdown]
# With these coefficients and with $p$, $q$ through fourth order the variational equations hold: their coefficients of $\xi$
# and of $\eta$ vanish in orders 0 to 4.


# %%
def three(vector: tuple, partner: tuple, coupling: FourierSeries, back_coupling: FourierSeries, sign: int) -> dict:
    """Coordinates, velocities and accelerations of both axes for `vector`, coupled to `partner`; `sign` under S."""
    rate, values = orbit.frequency, {}
    for i in range(3):
        once = vector[i].derivative() + coupling * partner[i]
        twice = (
            vector[i].derivative().derivative()
            + (coupling * partner[i].derivative()).times(2)
            + coupling * back_coupling * vector[i]
        )
        for names, term in ((AXES.q, vector[i]), (AXES.v, rate * once), (AXES.a, rate * rate * twice)):
            later = term.half_period_later()
            values |= {names[i]: term, names[i + 3]: later.times(-sign if i == 0 else sign)}
    return values | {multipliers[0]: vector[3], multipliers[2]: vector[4]}


def put(e: sp.Expr, values: dict) -> FourierSeries:
    """Substitute the series of the coordinates into a polynomial."""
    polynomial, total = sp.Poly(e, *values), FourierSeries({}, 4)
    for powers, coefficient in polynomial.terms():
        term = total.constant(orbit.field.from_sympy(coefficient))
        for series, n in zip(values.values(), powers, strict=True):
            for _ in range(n):
                term = term * series
        total = total + term
    return total


def residuals(variations: dict) -> sp.Matrix:
    """The residuals of the variational equations in orders 0 to 4 of r_0."""
    rows = []
    for e in equations:
        terms = (put(sp.expand(e).diff(symbol), on_orbit) * change for symbol, change in variations.items())
        total = orbit.expression(sum(terms, FourierSeries({}, 4)))
        rows.append([total.coeff(r0, n) for n in range(5)])
    return sp.Matrix(rows)


still = tuple(FourierSeries({}, 4) for _ in exponents.p)
on_orbit = three(orbit.solution.unknowns, still, still[0], still[0], 1)
prove(
    residuals(three(exponents.p, exponents.q, exponents.B, exponents.A, -1)),
    sp.zeros(5, 5),
    "the coefficients of ξ in the five equations",
    names=r"\left(E_\xi^{(0)},\dots,E_\xi^{(4)}\right)",
)

# %%
prove(
    residuals(three(exponents.q, exponents.p, exponents.A, exponents.B, -1)),
    sp.zeros(5, 5),
    "the coefficients of η in the five equations",
    names=r"\left(E_\eta^{(0)},\dots,E_\eta^{(4)}\right)",
)

# %% [markdown]
# The averaged motion (t11) gives the same $A$. The half-angle $\eta$ between the axes has the stiffness $H_{\eta\eta}$, and
# $2G\dot\beta=H_{\eta\eta}\,\eta$. A unit of $q$ changes $\eta$ by $\sqrt\sigma$. The orbit has the amplitude
# $s=\sqrt\sigma\,r_0$ in $\eta$ and the momentum $P=Gs^2/k$. Per radian of phase, that is per time $1/\Omega_0$, this gives

# %%
still = {LEAN: 0, HALF: 0, P: G * SWING**2 / k}
in_half = averaged_hamiltonian().diff(HALF, 2).subs(still)
swung = in_half.subs(SWING, sp.sqrt(sigma) * r0)
per_radian = swung * sp.sqrt(sigma) / (2 * G) * sp.sqrt(a**2 - b**2) / G
prove(
    (per_radian**2).subs(units),
    (A.coeff(r0, 2) * r0**2) ** 2,
    "the square of the leading term of A, by the averaged motion",
    names="A^2",
)

# %% [markdown]
# ## Growth per period
#
# $\lambda^2=AB$. For a bar with $b\neq0$ the leading term is

# %%
prove(
    growth_squared().expressions[0],
    sp.expand(A * B).coeff(r0, 6) * r0**6,
    "the leading term equals the library's law",
    names=r"\lambda^2",
)

# %%
prove(
    growth_squared().expressions[0],
    sp.Rational(3, 16) * sigma**2 * (1 - sigma) * r0**6 / k**2,
    "the explicit law",
    names=r"\lambda^2",
)

# %% [markdown]
# At small amplitude the orbit is elliptic for $\sigma>1$ ($b>0$) and hyperbolic for $\sigma<1$. For a massless bar or a
# dumbbell, $\sigma=1$, the first term of $A$ vanishes, and the orbit is hyperbolic:

# %%
prove(
    sp.expand((A * B).subs(sigma, 1)),
    sp.Rational(9, 32) * r0**8 / k**4,
    "the leading term for σ = 1",
    names=r"\lambda^2",
)

# %%
prove(growth_squared(8, dumbbell=True).expressions[0], sp.Rational(9, 32) * r0**8 / k**4, "the library's law for σ = 1",
      names=r"\lambda^2")  # fmt: skip

# %% [markdown]
# ## The boundary of stability
#
# For $\sigma>1$ the first two terms of $A$ have opposite signs and cancel at some amplitude. Beyond this amplitude the orbit is
# hyperbolic even for $b>0$.

# %%
edge = elliptic_edge().expressions[0]
prove(
    edge**2, 24 * k**2 * (sigma - 1) / fourth, "the amplitude at which the first two terms of A cancel", names="r_0^2"
)

# %% [markdown]
# This law is correct to first order in $\sigma-1$:

# %%
delta = sp.Symbol("delta", positive=True)
prove(
    sp.cancel((edge**2).subs(sigma, 1 + delta)),
    sp.Rational(2, 3) * k**2 * delta,
    "the boundary for small δ = σ − 1",
    small=delta,
    order=1,
    names="r_0^2",
)

# %% [markdown]
# ## Measured on exact orbits

# %%
BARS = {
    "a massless bar, k = 1": (Link(1, 0, 0), (0.1, 0.14)),
    "m = 0.01, K = 0.1": (Link(1, 0.01, 0.1), (0.06, 0.09)),
    "m = 0.4, K = 0.05, k = 1": (Link(1, 0.4, 0.05), (0.06, 0.09)),
}


def measure(link: Link, amplitudes: tuple[float, ...]) -> tuple[str, float, float, float]:
    """(kind, exponent of |mu + 1/mu − 2|, relative error of the law at the largest amplitude, its estimate)."""
    scene = Scene(spins=(10, -10), link=link)
    law = growth_squared(8, dumbbell=True) if scene.sigma == 1 else growth_squared()
    exact = [floquet(scene, amplitude) for amplitude in amplitudes]
    squares = np.array([result.growth**2 - result.turning**2 for result in exact]) / (4 * np.pi**2)
    predicted, bounds = (np.asarray(form(np.array(amplitudes), scene.sigma, scene.k)) for form in (law, law.error))
    errors = np.abs(predicted - squares)
    assert (errors < bounds).all()
    excess = [abs(result.pair_sum - 2) for result in exact]
    return (
        exact[0].kind,
        measured_order(amplitudes, excess),
        float(errors[-1] / squares[-1]),
        float(bounds[-1] / squares[-1]),
    )


measured = {name: measure(link, amplitudes) for name, (link, amplitudes) in BARS.items()}
assert [kind for kind, *_ in measured.values()] == ["hyperbolic", "hyperbolic", "elliptic"]
paper = floquet(Scene(spins=(10, -10), link=Link(1, 0.01, 0.1)), 0.204)
Remark(
    "Stability of the paired precession",
    "At small amplitude the orbit is elliptic for b > 0 and hyperbolic for b ≤ 0. The exact multipliers confirm this. "
    + " ".join(
        f"For {name} the orbit is {kind}, and μ + 1/μ − 2 is proportional to r_0^{slope:.2f}; at r_0 = "
        f"{BARS[name][1][-1]} the law has a relative error of {100 * abs(error):.1f} %, within the bound "
        f"{100 * abs(bound):.1f} %."
        for name, (kind, slope, error, bound) in measured.items()
    )
    + f" In the paper's scene the growth per period at r_0 = 0.204 is {paper.growth:.5f} ± {paper.exponent_error:.0e}.",
)


# %%
def edge_at(sigma_value: float) -> tuple[float, float, float]:
    """r_0 above which the orbit is hyperbolic for K = 0, k = 1: by the law, its error estimate, on exact orbits to 5e-6."""
    law, bound = (float(form(sigma_value, 1.0)) for form in (elliptic_edge(), elliptic_edge().error))
    scene = Scene(spins=(10, -10), link=Link(1, 2 * 1.25 * (sigma_value - 1), 0))

    def excess(r0: float) -> float:
        return (floquet(scene, r0).pair_sum - 2) / r0**6  # nearly a line: A B begins with r_0⁶

    return law, bound, float(brentq(excess, law - 1.5 * bound, law + 1.5 * bound, xtol=5e-6))


edges = {value: edge_at(value) for value in (1.02, 1.1, 1.2)}
assert all(abs(law - exact) < bound for law, bound, exact in edges.values())
ratios = [abs(law - exact) / exact for law, _, exact in edges.values()]
Remark(
    "Boundary between elliptic and hyperbolic",
    "For k = 1 the boundary lies, according to the law, at r_0 = "
    + ", ".join(f"{law:.4f} ± {bound:.4f} for σ = {value}" for value, (law, bound, _) in edges.items())
    + f". On exact orbits it lies at {', '.join(f'{exact:.4f}' for *_, exact in edges.values())}. The law is "
    "asymptotic for small "
    f"σ − 1; its relative error grows from {100 * ratios[0]:.1f} % to {100 * ratios[-1]:.0f} % here.",
)
