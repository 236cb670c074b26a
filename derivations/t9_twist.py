# %% [markdown]
# # Equal spins: the parallel pair and its twist instability
#
# **Objective.** The exact equivalence of the parallel pair to one rotor; the conditions under which the axes stay parallel;
# the growth rate of a twist, and the error of its closed form.
#
# **Assumptions.** Equal spins, any bar; an infinitesimal twist.
#
# **Notation.** $\Delta$ the twist; $r$ the common axis, $x=r\cdot e_x=\tanh U$, $\alpha$ its angle about the joint line;
# $\rho$ the sine of the cone's half-angle $\theta$; $a$, $b$ the inertias with the bar's share, $\beta=b/(a-b)$; $G=G_1=G_2$;
# $\Phi$ the phase of the precession.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link, Scene, Shock, shock_response, simulate
from lagrotor.mechanics import euler_lagrange
from lagrotor.pair.notation import G_1, G_2, TWISTED, G, Phi, a, b, rho
from lagrotor.paper import Formula, Remark, prove
from lagrotor.theory import (
    lyapunov_criterion,
    parallel_scene,
    twist_bounded,
    twist_growth,
    twist_growth_error,
    twist_multiplier_growth,
    twisted_lagrangian,
)

(U, Delta, alpha), (U_v, Delta_v, alpha_v), (U_a, Delta_a, alpha_a) = TWISTED.q, TWISTED.v, TWISTED.a

# %% [markdown]
# ## Exact equivalence to one rotor
#
# The pair has three Euler–Lagrange expressions (t8), here called along (of $U$), across (of $\Delta$) and about (of
# $\alpha$). In a parallel motion $\Delta=0$ for all time. The residual of the equation of the twist is then

# %%
straight = {Delta: 0, Delta_v: 0, Delta_a: 0}
in_U, in_twist, in_alpha = (e.subs(straight) for e in euler_lagrange(twisted_lagrangian(), TWISTED))
prove(
    in_twist,
    (G_2 - G_1) * U_v / (2 * sp.cosh(U) ** 2),
    "the residual of the twist equation for parallel motion",
    names=r"\text{across}",
)

# %% [markdown]
# It vanishes on every parallel motion if and only if $G_1=G_2$. The other two expressions are then twice those of one rotor of
# inertia $a+b$ and momentum $G$. The Lagrangian of this rotor in Mercator coordinates is

# %%
one_rotor = (a + b) / 2 * (U_v**2 + alpha_v**2) / sp.cosh(U) ** 2 + G * sp.tanh(U) * alpha_v
Formula(one_rotor, r"\mathcal L^{\text{rotor}}")

# %%
rotor = euler_lagrange(one_rotor, TWISTED)
equal = {G_1: G, G_2: G}
prove(
    (in_U.subs(equal), in_alpha.subs(equal)),
    (2 * rotor[0], 2 * rotor[2]),
    "the equations of the pair are twice those of one rotor",
    equations=(r"\text{along} = 2\,\mathcal E_U^{\text{rotor}}", r"\text{about} = 2\,\mathcal E_\alpha^{\text{rotor}}"),
)

# %% [markdown]
# ## The equation of a small twist
#
# To first order in $\Delta$ the equation is $\frac{d}{dt}(\text{inertia}\,\dot\Delta)+\text{stiffness}\,\Delta=0$. It contains no
# gyroscopic term and is independent of the length of the bar:

# %%
x = sp.tanh(U)
x_a = U_a / sp.cosh(U) ** 2 - 2 * sp.tanh(U) * U_v**2 / sp.cosh(U) ** 2
speed = (U_v**2 + alpha_v**2) / sp.cosh(U) ** 2
twisting = euler_lagrange(twisted_lagrangian().subs(equal), TWISTED)[1]
inertia, stiffness = (twisting.diff(symbol).subs(straight) for symbol in (Delta_a, Delta))
prove(inertia, (a - b) / 2 * (1 - x**2), "the inertia of the twist, x = tanh U", names=r"\text{inertia}")

# %%
prove(
    stiffness,
    b * (speed + x * x_a),
    "the stiffness of the twist, b (|r′|² + x x″)",
    equations=r"\text{stiffness} = b\,\big(|\dot r|^2 + x\,\ddot x\big)",
)

# %% [markdown]
# ## Hill's equation
#
# On the cone, $x=\rho\cos\Phi$ and $|r'|^2=\rho^2$ in units of the precession rate $G/((a+b)\cos\theta)$ (derived with 5.24).
# With $\beta=b/(a-b)$ the twist obeys Hill's equation
# $$\big((1-\rho^2\cos^2\Phi)\,\Delta'\big)' + 2\beta\rho^2\sin^2\Phi\;\Delta = 0,$$
# with coefficients of period $\pi$.

# %%
on_cone = rho * sp.cos(Phi)
prove(
    rho**2 + on_cone * on_cone.diff(Phi, 2),
    rho**2 * sp.sin(Phi) ** 2,
    "|r′|² + x x″ on the cone",
)

# %% [markdown]
# ## Growth on narrow cones
#
# Let $\Delta=e^{\mu\Phi}u$ with $\mu=\mu_1\rho+\mu_3\rho^3+\dots$ and $u=1+\rho^2(p\cos2\Phi+\dots)+\dots$ of period $\pi$.
# Let $H$ be the left side of Hill's equation divided by $e^{\mu\Phi}$. The means of $H$ over a period must vanish order by
# order and determine the exponent. The second harmonic at second order determines $p$.

# %%
beta, mu_1, mu_3, p = sp.symbols("beta mu_1 mu_3 p", real=True)
mu, u = mu_1 * rho + mu_3 * rho**3, 1 + p * rho**2 * sp.cos(2 * Phi)
slope = u.diff(Phi) + mu * u
flux = (1 - on_cone**2) * slope
hill = sp.expand(flux.diff(Phi) + mu * flux + 2 * beta * rho**2 * sp.sin(Phi) ** 2 * u)


def mean(order: int, weight: sp.Expr = sp.S.One) -> sp.Expr:
    """The mean over a period of one order of Hill's equation times `weight`: the terms without Φ."""
    return sp.expand((hill.coeff(rho, order) * weight).rewrite(sp.exp)).as_independent(Phi)[0]


prove(mean(2), mu_1**2 + beta, "the mean at second order: μ_1² = −β", names=r"\langle H\rangle_2")

# %%
prove(
    mean(2, 2 * sp.cos(2 * Phi)),
    -4 * p - beta,
    "the second harmonic at second order: p = −β/4",
    names=r"\langle 2H\cos 2\Phi\rangle_2",
)

# %%
prove(
    mean(4),
    2 * mu_1 * mu_3 - mu_1**2 / 2 - beta * p / 2,
    "the mean at fourth order",
    names=r"\langle H\rangle_4",
)

# %% [markdown]
# Hence $\mu_3=\mu_1\,(1/4+\beta/16)$. With $1/\cos\theta=1+\rho^2/2+\dots$ the growth rate per unit of time for $\beta<0$ is
# $$\frac{|G|}{a+b}\sqrt{-\beta}\;\rho\,\Big(1+\big(\tfrac34+\tfrac\beta{16}\big)\rho^2+\dots\Big).$$

# %%
third = sp.solve(mean(4).subs(p, -beta / 4).subs(beta, -(mu_1**2)), mu_3, simplify=False)[0]
prove(third, mu_1 * (sp.Rational(1, 4) - mu_1**2 / 16), "the exponent's third order, with β = −μ_1²", names=r"\mu_3")

# %%
growing = sp.series((mu_1 * rho + third * rho**3) / sp.sqrt(1 - rho**2), rho, 0, 4).removeO()
prove(
    growing,
    mu_1 * rho * (1 + (sp.Rational(3, 4) - mu_1**2 / 16) * rho**2),
    "the growth rate in units of G/(a + b)",
    names=r"(\mu_1\rho + \mu_3\rho^3)/\cos\theta",
    small=rho,
    order=3,
)

# %% [markdown]
# The first term is the library's closed form, and the second is its error. The factor $1/(1-\rho^2)$ for all further terms is
# empirical. It is checked on Hill's equation:

# %%
grown = twist_growth().expressions[0]
unstable = grown.replace(sp.Max, lambda *arguments: next(argument for argument in arguments if argument != 0))
prove(
    (unstable * (a + b)) ** 2,
    G**2 * rho**2 * (-b / (a - b)),
    "the square of the closed form, for b < 0",
    names=r"\text{growth}^2",
)

# %%
relative = rho**2 * (sp.Rational(3, 4) + sp.Abs(b / (a - b)) / 16) / (1 - rho**2)
assert twist_growth_error().expressions[0] / grown == relative
Formula(relative, r"\frac{\text{error}}{\text{growth}}")

# %% [markdown]
# ## Cones on which the axes stay parallel
#
# For $b>0$ the stiffness is positive. Solutions of $(P y')'+Qy=0$ of period $T$ are bounded by Lyapunov's criterion if
# $\int d\Phi/P\int Q\,d\Phi\le4$ (Magnus & Winkler, Hill's Equation, ch. V). The integrals are
# $\int_0^\pi d\Phi/(1-\rho^2\cos^2\Phi)=\pi/\sqrt{1-\rho^2}$ and $\int_0^\pi2\beta\rho^2\sin^2\Phi\,d\Phi=\pi\beta\rho^2$. A
# small twist is therefore bounded on cones with

# %%
lyapunov_criterion()

# %% [markdown]
# On wider cones the twist can grow by resonance, as Hill's equation shows:

# %%
heavy, cones = Scene(spins=(10, 10), link=Link(1, 1, 0)), np.radians(np.arange(5, 90, 5))
resonant = {float(np.degrees(c)): g for c in cones if (g := twist_multiplier_growth(heavy, c))}
widest = max(np.degrees(c) for c in cones if twist_bounded(heavy, c))
assert widest < min(resonant)
Remark(
    "Wide cones",
    "The bar has a point mass of 1 kg at its middle (K = 0, b > 0), and the half-angle of the cone is increased in steps of 5°. "
    f"According to Lyapunov's criterion a small twist is bounded up to {widest:.0f}°. The first cone on which it grows has "
    f"{min(resonant):.0f}°; the growth rate is {resonant[min(resonant)]:.2f} 1/s.",
)

# %% [markdown]
# ## Predicted and measured growth rates
#
# The runs start with a twist rate of $10^{-7}$ rad/s. The twist is sampled at multiples of half a period of the precession.


# %%
def measured(link: Link, angle: float) -> tuple[float, float, float]:
    """Growth rates (1/s): to first order in the angle, by Hill's equation, and of the exact motion."""
    scene = Scene(spins=(10, 10), link=link)
    first = float(twist_growth()(np.sin(angle), 10.0, *scene.inertias))
    hill = twist_multiplier_growth(scene, angle)
    half_turn = np.pi * sum(scene.inertias) * np.cos(angle) / 10
    times = half_turn * np.array([np.ceil(6 / hill / half_turn), np.ceil(11 / hill / half_turn)])
    axes = simulate(parallel_scene(scene, angle, 1e-7), [0.0, *times], "minimal", 1e-10).after(times[0]).axes
    apart = np.linalg.norm(axes[0] - axes[1], axis=-1)
    return first, hill, float(np.log(apart[1] / apart[0]) / (times[1] - times[0]))


pairs = {angle: measured(Link(1, 1, 1), angle) for angle in (0.1, 0.4)}
tested = Scene(spins=(10, 10), link=Link(1, 1, 1)).inertias
errors = {angle: float(twist_growth_error()(np.sin(angle), 10.0, *tested)) for angle in pairs}
assert all(abs(hill / exact - 1) < 0.005 for _, hill, exact in pairs.values())
assert all(abs(first - hill) < errors[angle] for angle, (first, hill, _) in pairs.items())
assert twist_multiplier_growth(Scene(spins=(10, 10), link=Link(1, 1, 0.2)), 0.4) == 0
paper = Scene(spins=(10, 10), link=Link(1, 1, 1), shock=Shock((50, 0, 0), 2, 1 / 50))
size = float(np.max(shock_response(paper).amplitude))
rate = float(twist_growth()(size, 10.0, *paper.inertias))
Remark(
    "Equal spins",
    "Motion with parallel axes is an exact solution if and only if G_1 = G_2. The pair is then equivalent to one rotor with "
    "inertia a + b and momentum G per axis.",
)

# %%
Remark(
    "The twist instability",
    "On narrow cones a small twist is bounded for b > 0, that is K < m ℓ²/4. For b < 0 it grows at the rate "
    "ρ |G| √(−b/(a − b))/(a + b), with ρ the sine of the half-angle; the next term is of third order. For m = 1 kg "
    "and K = 1 kg m² "
    "the rates are compared. "
    + " ".join(
        f"At a half-angle of {angle} rad the law gives {f:.4f} 1/s with an error of at most {errors[angle]:.4f} 1/s, Hill's "
        f"equation gives {h:.4f} 1/s, and the exact run {s:.4f} 1/s."
        for angle, (f, h, s) in pairs.items()
    )
    + f" In the paper's scene of figure 10 (amplitude {size:.4f}) a twist grows at {rate:.3f} 1/s, so its axes are not "
    "'necessarily aligned at all times'.",
)
