# %% [markdown]
# # The linear response to a shock
#
# **Objective.** The motion after a Gaussian pulse, for any two spins and any bar: centre of the precession, permanent
# displacement, drift, amplitude and energy; the paper's $100 \to 100.45$ as a formula.
#
# **Assumptions.** The pair is at rest and upright before the pulse. First order in the pulse.
#
# **Notation.** $q=(x,y_1,y_2)$; $M$, $C$ of t1; $p=(p_x,p_1,p_2)$ the impulse times $R$; $w$ the width of the pulse;
# $N=M^{-1}C$; $n$ with $Cn=0$.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link, Scene, Shock, shock_response, simulate
from lagrotor.models import shock_response_error
from lagrotor.numerics import measured_order
from lagrotor.pair.notation import G_1, G_2, P_1, P_2, P_X, G, Omega, a, att, b, t
from lagrotor.paper import Formula, Remark, prove
from lagrotor.theory import impulse_matrices, shock_displacement, shock_energy

# %% [markdown]
# ## From the equation of motion to powers of one matrix
#
# The linearised equations are $M\ddot q + C\dot q = Q(t)$. One integration gives $M\dot q + Cq = p(t)$, with the impulse
# $p(t)$ up to time $t$. After an impulse $p$ at $s=0$ the equation is $\dot q = M^{-1}p - Nq$. The response is $H(s)p$ with
# $\dot H = e^{-Ns}M^{-1}$.

# %%
linear = impulse_matrices()
M, C, n, squared = linear.mass, linear.gyroscopic, linear.null, linear.frequency_squared
inverse = M.inv()
N = inverse * C
Formula(N, "N")

# %% [markdown]
# $N$ satisfies a cubic equation, because its eigenvalues are zero and $\pm i\Omega_0$ (t1):

# %%
prove(N**3, -squared * N, "N³ = −Ω_0² N", equations=r"N^3 = -\Omega_0^2\,N")

# %% [markdown]
# The exponential is therefore a polynomial of second degree in $N$,
# $$e^{-Ns} = 1 - N\,\frac{\sin\Omega_0 s}{\Omega_0} + N^2\,\frac{1-\cos\Omega_0 s}{\Omega_0^2}.$$
# The right side is 1 at $s=0$, and its derivative with respect to $s$ is $-N$ times itself:

# %%
s, w_0 = sp.symbols("s Omega_0", positive=True)
power = sp.Matrix(3, 3, sp.symbols("N_11 N_12 N_13 N_21 N_22 N_23 N_31 N_32 N_33"))
exponential = sp.eye(3) - power * sp.sin(w_0 * s) / w_0 + power**2 * (1 - sp.cos(w_0 * s)) / w_0**2
residual = exponential.diff(s) + power * exponential
prove(
    residual,
    (power**3 + w_0**2 * power) * (1 - sp.cos(w_0 * s)) / w_0**2,
    "the residual of the differential equation, zero by the cubic equation",
    equations=r"\frac{d}{ds}\,e^{-Ns} + N e^{-Ns} = (N^3 + \Omega_0^2 N)\,\frac{1 - \cos\Omega_0 s}{\Omega_0^2}",
)

# %% [markdown]
# ## The response to a unit impulse
#
# Integration over $s$ and multiplication by $M^{-1}$ give
# $$H(s) = \Big(1+\frac{N^2}{\Omega_0^2}\Big)M^{-1}s + D\,(1-\cos\Omega_0 s) + S\,\frac{\sin\Omega_0 s}{\Omega_0},\qquad
# D=-\frac{NM^{-1}}{\Omega_0^2},\quad S=-\frac{N^2M^{-1}}{\Omega_0^2}.$$
# The first matrix projects onto $n$: the pair drifts along the only direction without gyroscopic force.

# %%
drift, D, S = linear.drift, linear.displacement, linear.swing
prove(D, -N * inverse / squared, "the permanent displacement", equations=r"D = -\frac{N M^{-1}}{\Omega_0^2}")

# %%
prove(S, -N * N * inverse / squared, "the velocity of the oscillation", equations=r"S = -\frac{N^2 M^{-1}}{\Omega_0^2}")

# %%
prove(
    drift,
    (sp.eye(3) + N * N / squared) * inverse,
    "the drift is the initial velocity minus the velocity of the oscillation",
    equations=r"\text{drift} = \Big(1 + \frac{N^2}{\Omega_0^2}\Big)\,M^{-1}",
)

# %%
prove(drift, n * n.T / (n.T * M * n)[0], "the drift is along n", equations=r"\text{drift} = \frac{n\,n^T}{n^T M\,n}")

# %% [markdown]
# The library's matrices solve the equation of motion $M\dot H + CH = 1$. The terms in $1$, $s$, $\cos$ and $\sin$ agree
# separately.

# %%
prove(M * drift + C * D, sp.eye(3), "the constant terms", equations=r"M\cdot\text{drift} + C\,D = 1")

# %%
prove(C * drift, sp.zeros(3, 3), "the terms in s", equations=r"C\cdot\text{drift} = 0")

# %%
prove(M * S, C * D, "the terms in the cosine", equations=r"M\,S = C\,D")

# %%
prove(squared * M * D, -C * S, "the terms in the sine", equations=r"\Omega_0^2\,M\,D = -C\,S")

# %% [markdown]
# For opposite spins and a shock along the bar, the centre of the precession is twisted but not displaced along $x$:

# %%
along_x = {G_1: G, G_2: -G, P_1: 0, P_2: 0}
twisted = [e.subs(along_x) for e in shock_displacement().expressions]
prove(
    twisted,
    (0, P_X / (2 * G), -P_X / (2 * G)),
    "displacement by a shock along x, opposite spins",
    names=("x", "y_1", "y_2"),
)

# %% [markdown]
# ## The width of the pulse
#
# A pulse is a superposition of impulses. The drift and the centre depend on its integral. The oscillation depends on its Fourier
# component at $\Omega_0$, so its amplitude has the factor $A_w = e^{-(\Omega_0 w)^2/4}$.

# %%
w = sp.Symbol("w", positive=True)
pulse = sp.exp(-((t / w) ** 2)) / (w * sp.sqrt(sp.pi))
component = sp.integrate(pulse * sp.exp(-sp.I * Omega * t), (t, -sp.oo, sp.oo))
prove(
    sp.expand(component),
    sp.exp(-((Omega * w) ** 2) / 4),
    "the Fourier component of a Gaussian of unit impulse",
    names=r"\int f(t)\,e^{-i\Omega t}\,dt",
)

# %% [markdown]
# ## Energy
#
# The drift has the energy $p\cdot\text{drift}\,p/2$ and the oscillation $p\cdot S\,p/2$. For a pulse of finite width the
# second has the factor $A_w^2$. For an impulse the sum is the work done on a pair at rest:

# %%
p = sp.Matrix([P_X, P_1, P_2])
drift_energy, swing_energy = shock_energy().expressions
prove(
    drift_energy + swing_energy,
    (p.T * inverse * p)[0] / 2,
    "the energy after an impulse",
    equations=r"E_{\text{drift}} + E_{\text{swing}} = \tfrac12\,p\cdot M^{-1} p",
)

# %% [markdown]
# The paper's shock, along $x$ on equal spins, causes no drift:

# %%
equal_spins = {G_1: G, G_2: G, P_1: 0, P_2: 0}
equal_x = P_X**2 / (4 * (a + b))
prove(
    (drift_energy.subs(equal_spins), swing_energy.subs(equal_spins)),
    (0, equal_x),
    "energy of the drift and of the oscillation",
    names=(r"E_{\text{drift}}", r"E_{\text{swing}}"),
)

# %%
paper = Scene(spins=(10, 10), link=Link(1, 1, 1), shock=Shock((50, 0, 0), 2, 1 / 50))
answer = shock_response(paper)
closed_energy = answer.energy
exact = simulate(paper, [0.0, 3.0], tol=1e-11).energy[1]
Formula(equal_x * att**2, "E")

# %%
Remark(
    "The energy of the shock, 100 to 100.45 J",
    "A shock along x adds the energy p_x²/(4 (a + b)) exp(−(Ω_0 w)²/2) to a pair with equal spins. In the paper's "
    "scene the energy "
    f"then is 100 + {answer.energy:.5f} J; an exact run gives {exact:.5f} J. Without the exponential factor, which "
    "comes from the "
    f"width w of the pulse, it would be 100 + {answer.impulse_energy:.5f} J.",
)

# %% [markdown]
# ## Order of the error
#
# The neglected terms are of second order in the shock and grow with time. For a scene `shock_response_error` estimates them from
# the residual of the linear motion in the exact equations.

# %%
sizes, times = (0.01, 0.02, 0.04), np.linspace(0, 2.5, 101)
errors, estimates = [], []
for size in sizes:
    scene = Scene(spins=(3, -11), link=Link(1.3, 0.4, 0.2), shock=Shock((40 * size, -30 * size, 0), 1, 0.11, 2))
    axes, response = simulate(scene, times, tol=1e-12).axes, shock_response(scene).through(times)
    errors.append(max(float(np.linalg.norm(axes[i, :, :2] - response[:, [0, i + 1]], axis=-1).max()) for i in (0, 1)))
    estimates.append(shock_response_error(scene, 2.5))
slope = measured_order(sizes, errors)
assert abs(slope - 2) < 0.1 and all(error < bound for error, bound in zip(errors, estimates, strict=True))
Remark(
    "Shock response",
    "For any spins and any bar, also during the pulse, the error of the closed form is of second order in the shock (measured "
    f"exponent {slope:.3f}). After 2.5 s the largest errors are "
    + ", ".join(
        f"{error:.2g} R at {50 * size:g} N (estimated {bound:.2g} R)"
        for size, error, bound in zip(sizes, errors, estimates, strict=True)
    )
    + ". If the estimate exceeds 0.1 R, the closed form is refused.",
)

# %%
Remark(
    "Displacement after a shock along x",
    "For opposite spins the displacement is (x, y_1, y_2) = (0, 1, −1) p_x/(2 G). It is a permanent twist as large as the "
    "oscillation, without a displacement along x.",
)
