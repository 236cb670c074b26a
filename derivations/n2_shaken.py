# %% [markdown]
# # Vibration: spins compared with a tuned mass
#
# **Objective.** The effect of spins on the resonance of a pair on elastic hinges, the optimal brace and damper, and the spin
# above which the pair is better than a tuned mass damper of the same mass.
#
# **Assumptions.** Small motion, massless bars, equal rotors; the optima are for an undamped sway. The closed forms are compared
# with the transfer functions of the library, and these with the exact motion.
#
# **Notation.** $a$ the inertia of an axis about its joint, $h$ its hinge's stiffness less its weight's moment; $u$ the
# common tilt along the bar, $v_1, v_2$ the tilts across it; $\Omega$ the rate of the sway without spins; $\mu$ the mass
# ratio of a tuned mass; $\gamma=G/(a\Omega)$.

# %%
import numpy as np
import sympy as sp

from lagrotor import Brace, Rotor, Structure
from lagrotor.paper import Remark, prove
from lagrotor.structures import (
    mass_worst_case,
    spins_white_noise,
    spins_win_white_noise,
    spins_win_worst_case,
    spins_worst_case,
)

a, h, G, w, F = sp.symbols("a h G omega F", positive=True)
s = sp.Symbol("s")

# %% [markdown]
# ## Resonances with spins
#
# On the degrees of freedom $(u,v_1,v_2)$ a force $F$ along the bar, times the length of the axis, drives $u$:


# %%
def pencil(G_1: sp.Expr, G_2: sp.Expr) -> sp.Matrix:
    """M s² + C s + K."""
    own = a * s**2 + h
    return sp.Matrix([[2 * own, G_1 * s, G_2 * s], [-G_1 * s, own, 0], [-G_2 * s, 0, own]])


amplitudes = {sign: pencil(G, sign * G).LUsolve(sp.Matrix([F, 0, 0])) for sign in (1, -1)}
along = F * (a * s**2 + h) / (2 * ((a * s**2 + h) ** 2 + G**2 * s**2))
prove(
    [amplitudes[sign][0] for sign in (1, -1)],
    (along, along),
    "the sway along the bar is the same under equal and under opposite spins",
    names=("u_{=}", r"u_{\pm}"),
)

# %%
prove(
    [amplitudes[1][1] - amplitudes[1][2], amplitudes[-1][1] + amplitudes[-1][2]],
    (0, 0),
    "equal spins turn it into sway across, opposite ones into yaw",
    names=("v_1-v_2", "v_1+v_2"),
)

# %% [markdown]
# The resonance at $\sqrt{h/a}$ splits into two, $a\omega^2\mp G\omega-h=0$, and at $\sqrt{h/a}$ itself there is no motion along
# the bar:

# %%
split = sp.expand(((a * s**2 + h) ** 2 + G**2 * s**2).subs(s, sp.I * w))
prove(split, (a * w**2 - G * w - h) * (a * w**2 + G * w - h), "the resonances along the bar")

# %% [markdown]
# A force across the bar on both tips, or a ground that shakes across it, drives $v_1+v_2$, on which opposite spins do not
# act:

# %%
shaken = pencil(G, -G).LUsolve(sp.Matrix([0, F, F]))
prove(
    list(shaken),
    (0, F / (a * s**2 + h), F / (a * s**2 + h)),
    "shaken across, opposite spins",
    names=("u", "v_1", "v_2"),
)

# %% [markdown]
# ## The optimal brace and damper
#
# Let a brace and a damper act on the motion that the spins couple to the sway. With $M$ the inertia and $K=M\Omega^2$ the
# stiffness of the sway, $m$, $k_z=m\Omega^2f^2$ and $c=2\zeta m\Omega$ the inertia, stiffness and damping of the other
# motion, $g=\gamma\Omega\sqrt{Mm}$ the coupling, time in $1/\Omega$ and force in $K$, the sway's transfer function is

# %%
gamma, zeta, nu, mu = sp.symbols("gamma zeta nu mu", positive=True)
f2 = sp.Symbol("f2", positive=True)
system = sp.Matrix([[s**2 + 1, gamma * s], [-gamma * s, s**2 + 2 * zeta * s + f2]])
top = s**2 + 2 * zeta * s + f2
transfer = top / ((s**2 + 1) * top + gamma**2 * s**2)
prove(system.LUsolve(sp.Matrix([1, 0]))[0], transfer, "the sway's transfer function", names="X")

# %% [markdown]
# With $\nu=\omega^2$, $q=4\zeta^2$, $A=f^2-\nu$, $P=1-\nu$: $|X|^2=N/D$, $N=A^2+q\nu$, $D=(PA-\nu\gamma^2)^2+q\nu P^2$. It
# does not depend on the damper where $2PA=\nu\gamma^2$, and is $1/P^2$ there. With $f^2=1-\gamma^2/2$ these points are equally
# high, and no damper brings the peak below them (Den Hartog):

# %%
tuning = 1 - gamma**2 / 2
fixed = 2 * (1 - nu) * (tuning - nu) - nu * gamma**2
prove(
    fixed,
    2 * (nu - 1 + gamma / sp.sqrt(2)) * (nu - 1 - gamma / sp.sqrt(2)),
    "the fixed points are 1 ∓ γ/√2, of the height √2/γ",
    names=r"2PA-\nu\gamma^2",
)

# %% [markdown]
# The true peak is higher: with the usual damper, $q=3\gamma^2/2$ (Brock 1946), neither point is a maximum. The least peak $h$
# follows exactly, by the method of Nishihara & Asami (2002) for a tuned mass. Both maxima equal $h$ if $D-N/h^2$ is the
# square of a quadratic in $\nu$, $\nu^2-S\nu+f^2\rho$ with $\rho^2=1-1/h^2$. The coefficients of $\nu^3$ and $\nu$ give $S$
# and the damper,

# %%
rho, F2 = sp.symbols("rho F", positive=True)  # F = f²
q = 2 * F2 * (1 - rho) * (F2 + gamma**2 - rho) / (rho * (rho - F2))
S = 1 + F2 + gamma**2 - q / 2
A, P = F2 - nu, 1 - nu
N, D = A**2 + q * nu, (P * A - nu * gamma**2) ** 2 + q * nu * P**2
left = sp.Poly(D - (1 - rho**2) * N - (nu**2 - S * nu + F2 * rho) ** 2, nu)
prove(
    [left.coeff_monomial(nu**n) for n in (0, 1, 3, 4)],
    (0, 0, 0, 0),
    "all coefficients but one agree",
    names=[rf"[\nu^{n}]" for n in (0, 1, 3, 4)],
)

# %% [markdown]
# and the coefficient of $\nu^2$ gives a curve of tunings with equal peaks:

# %%
curve = ((F2 - rho) ** 2 + F2 * gamma**2) ** 2 * (1 + rho) - 2 * F2 * gamma**4 * rho**2
prove(
    left.coeff_monomial(nu**2) * rho**2 * (rho - F2) ** 2,
    -(1 - rho) * curve,
    "equal peaks",
    names=r"[\nu^2]\,\rho^2(\rho-f^2)^2",
)

# %% [markdown]
# The peak is least where $\rho$ is stationary along the curve, so the derivative by $f^2$ vanishes, too. With $f^2=(1-d)\rho$
# both equations are linear in the other unknowns, and everything is a rational function of $d$:

# %%
d = sp.Symbol("d", positive=True)
over = 8 - 8 * d - d**2 + 2 * d**3
height = 1 - d * (8 - 11 * d + 4 * d**2) / over
least = {gamma: sp.sqrt(2 * d * (2 - d) ** 2 * (4 - 3 * d) / over), F2: (1 - d) * height, rho: height}
prove(
    [e.subs(least, simultaneous=True) for e in (curve, curve.diff(F2), q)],
    (0, 0, 2 * (1 - height) * (3 - 2 * d)),
    "the least of equal peaks, and its damper",
    names=(r"\mathrm{curve}", r"\partial_{f^2}\mathrm{curve}", "q"),
)

# %% [markdown]
# For small spins $\gamma^2\approx4d$, and the peak lies above the fixed points by

# %%
above = sp.series(2 / (least[gamma] ** 2 * (1 / (1 - height**2))), d, 0, 2).removeO()
prove(above, 1 - d / 8, "√2/γ over the peak, squared: the peak is √2/γ (1 + γ²/64 + …)", names=r"2/(\gamma^2h^2)")

# %% [markdown]
# ## White noise
#
# The mean square of $X$ under white noise is $b\,\Pi\,b^T$ with $\Pi$ the covariance of the four states, from Lyapunov's
# equation.


# %%
def mean_square(numerator: sp.Expr, denominator: sp.Expr) -> sp.Expr:
    """∫|n/d|² dω/2π of a monic quartic d in s."""
    d = sp.Poly(denominator, s).all_coeffs()[::-1]
    n = (sp.Poly(numerator, s).all_coeffs()[::-1] + [0, 0])[:4]
    A = sp.Matrix([[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1], [-e for e in d[:4]]])
    Pi = sp.Matrix(4, 4, lambda i, j: sp.Symbol(f"p{min(i, j)}{max(i, j)}"))
    equations = list(A * Pi + Pi * A.T + sp.diag(0, 0, 0, 1))
    solved = sp.solve(equations, sorted(Pi.free_symbols, key=str), dict=True, simplify=False)[0]
    row = sp.Matrix([n])
    return sp.cancel((row * Pi.subs(solved) * row.T)[0])


spins = mean_square(top, sp.expand((s**2 + 1) * top + gamma**2 * s**2))
prove(
    spins,
    ((f2 - 1) ** 2 + f2 * gamma**2 + 4 * zeta**2) / (4 * gamma**2 * zeta),
    "the mean square under white noise",
    names=r"\int|X|^2\frac{d\omega}{2\pi}",
)

# %% [markdown]
# It is least for the same $f^2$ as before, and for

# %%
damping = gamma * sp.sqrt(4 - gamma**2) / 4
best = {f2: tuning, zeta: damping}
prove(
    [spins.diff(f2).subs(best), spins.diff(zeta).subs(best)],
    (0, 0),
    "both slopes vanish at f² = 1 − γ²/2, ζ = γ √(4 − γ²)/4",
    names=(r"\partial_{f^2}", r"\partial_\zeta"),
)

# %%
prove(
    (2 * spins.subs(best)) ** 2, 4 / gamma**2 - 1, "the least mean square, squared", names=r"\left(2\int|X|^2\right)^2"
)

# %% [markdown]
# ## Against a tuned mass
#
# A mass $\mu$ on a spring and a damper attached to the sway, at Warburton's optimum:

# %%
f = sp.Symbol("f", positive=True)
hung = s**2 + 2 * zeta * f * s + f**2
tuned = mean_square(hung, sp.expand((s**2 + 1 + mu * (hung - s**2)) * hung - mu * (hung - s**2) ** 2))
warburton = {f: sp.sqrt(1 + mu / 2) / (1 + mu), zeta: sp.sqrt(mu * (1 + 3 * mu / 4) / (4 * (1 + mu) * (1 + mu / 2)))}
prove(
    (2 * tuned.subs(warburton)) ** 2,
    (4 + 3 * mu) / (mu * (1 + mu)),
    "the tuned mass under white noise",
    names=r"\left(2\int|X|^2\right)^2",
)

# %% [markdown]
# For the largest sway the best mass, with $s=\sqrt{4+3\mu}$, also has two equal peaks, and the difference is again a square:

# %%
r = sp.Symbol("s", positive=True)
mass, form = (r**2 - 4) / 3, 3 * r**2 + 4 * r + 4
own, damper = 24 / ((r - 1) ** 2 * form), 9 * mass * (3 * r + 2) / (4 * (r + 2) * (r**2 - 1))  # f², 4 ζ²
lower = 9 * mass * (r + 2) * (3 * r + 2) / form**2  # 1/h²
one, two = own - nu, 1 - nu - mass * nu
equal = (two * own - (1 - nu) * nu) ** 2 + damper * own * nu * two**2 - lower * (one**2 + damper * own * nu)
across = sp.Poly(nu**2 - 2 * (r**2 + 8 * r + 4) * nu / ((r - 1) * form) + 192 * (r + 1) / ((r - 1) * form) ** 2, nu)
prove(
    sp.Poly(equal, nu).all_coeffs(),
    tuple((across**2).all_coeffs()),
    "Nishihara and Asami's mass: two equal peaks",
    names=[rf"[\nu^{n}]" for n in (4, 3, 2, 1, 0)],
)

# %% [markdown]
# Under white noise spins and mass are equally good at

# %%
prove(
    (4 / gamma**2 - 1) - (4 + 3 * mu) / (mu * (1 + mu)),
    4 / gamma**2 * (1 - gamma**2 * (2 + mu) ** 2 / (4 * mu * (1 + mu))),
    "they are equally good at γ² = 4μ(1 + μ)/(2 + μ)²",
    names=r"\mathrm{mean\ squares}",
)

# %% [markdown]
# ## Compared with a structure
#
# Two thin discs of 1 kg, radius 0.5 m, on axes of 1 m, 50 kg on each tip, swaying along the bar at $\Omega=2\pi$ rad/s: a
# tuned mass of the discs' mass has $\mu=1/50$.


# %%
def pair(ratio: float, found: object, sign: int = -1) -> Structure:
    """The pair whose yaw (sign −1) or cross sway (+1) is braced and damped as `found` says, at γ = ratio."""
    rotor, load, rate = Rotor(1, 1, 1 / 16, 1 / 8), 50.0, 2 * np.pi
    inertia = rotor.J + load
    spring, damper = inertia * rate**2 * found.tuning, 2 * found.damping * inertia * rate
    braces = [Brace(k, (float(k), 1.0, 1.0), float(spring), float(damper)) for k in (0, 1)]
    braces.append(Brace(0, (-1.0, 0.0, 1.0), 2 * inertia * rate**2))
    spin = ratio * inertia * rate / rotor.I3
    return Structure(
        joints=[(0, 0), (1, 0)], bars=[(0, 1)], spins=[spin, sign * spin], rotor=rotor, load=load, braces=braces
    )


def peak(s: Structure) -> float:
    """The largest |X K/F| over all rates."""
    rates = 2 * np.pi * np.linspace(1e-3, 3, 12_001)
    stiffness = s.braces[-1].stiffness
    return float(np.abs(s.response(rates, (1, 0), 0)[:, 0, 0]).max() * stiffness)


ratios = (0.1, 0.2, 0.4)
peaks = {ratio: [peak(pair(ratio, spins_worst_case(ratio), sign)) for sign in (1, -1)] for ratio in ratios}
assert all(abs(one / two - 1) < 1e-12 for one, two in peaks.values())
assert all(abs(one / spins_worst_case(ratio).value - 1) < 2e-5 for ratio, (one, _) in peaks.items())
even = float(spins_win_worst_case(1 / 50))
turning = pair(even, spins_worst_case(even)).spins[0]
Remark(
    "Spins against a tuned mass",
    f"An optimal tuned mass as heavy as the discs (μ = 1/50) reduces the largest amplification to "
    f"{float(mass_worst_case(1 / 50).value):.2f}. Spinning discs reduce it at least as much from γ = {even:.4f} on, which is a "
    f"spin of {turning:.0f} rad/s for a sway of {2 * np.pi:.2f} rad/s. Under white noise they are at least as good from γ = "
    f"{float(spins_win_white_noise(1 / 50)):.4f} on. At γ = {', '.join(map(str, peaks))} the largest amplification of the "
    f"structure is {', '.join(f'{one:.4f}' for one, _ in peaks.values())}; the closed form of the least value gives "
    f"{', '.join(f'{float(spins_worst_case(ratio).value):.4f}' for ratio in peaks)}. Equal and opposite spins give the same "
    "values.",
)

# %% [markdown]
# The transfer function, compared with the exact motion: the pair is shaken along the bar until its start has decayed.

# %%
shaken_pair, push, drive_rate = pair(0.4, spins_worst_case(0.4)), 1e-3, 5.0
amplitude = shaken_pair.response(drive_rate, (push, 0), 0)[0]
times = np.linspace(25, 25 + 2 * np.pi / drive_rate, 33)[:-1]
run = shaken_pair.simulate(
    [0.0, *times], drive=lambda t: np.array([[push * np.sin(drive_rate * t), 0, 0], [0, 0, 0]]), tol=1e-8
).after(times[0])
tilt = (run.tips - run.structure.rotor[0].length * np.array([0, 0, 1]) - [[[0, 0, 0]], [[1, 0, 0]]])[..., :2]
measured = 2j * (tilt * np.exp(-1j * drive_rate * times)[:, None]).mean(1)
off = float(np.abs(measured - amplitude).max() / np.abs(amplitude).max())
assert off < 1e-3
Remark(
    "The transfer function on the exact motion",
    f"The ground is shaken at {drive_rate:g} rad/s. After 25 s the amplitudes of sway and yaw in the exact motion "
    "differ from the "
    f"transfer function by a relative error of {off:.0e}.",
)

# %%
deaf = pair(0.4, spins_white_noise(0.4)).response(2 * np.pi, ground=(0, 1))[0]
assert np.abs(deaf[:, 0]).max() < 1e-12 * np.abs(deaf).max()
Remark(
    "On which motions the spins act",
    "A ground that shakes across the bar moves both tips across it, with or without spins. Opposite spins act on sway along the "
    "bar and on yaw, but not on sway across the bar. Equal spins act on both directions of sway, but not on yaw.",
)
