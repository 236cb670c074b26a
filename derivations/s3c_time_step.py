# %% [markdown]
# # The simulator's time step (3.13)
#
# **Objective.** The order of accuracy of one Euler step in the paper's rigid body program.
#
# **Assumptions.** A rigid body under a force and a torque that vary in time.
#
# **Notation.** $\Delta t$ the step; $\Omega_\times$ the matrix of $\vec\Omega\times$; $I_x, I_y, I_z$ the principal
# inertias, along whose axes the ground's frame lies at the time $t$ of the step.

# %%
import sympy as sp

from lagrotor.algebra import agreement_order
from lagrotor.pair.notation import M
from lagrotor.paper import Formula, Premise, prove, verdict
from lagrotor.paper.grammar import cross, cross_matrix, inverse, vector
from lagrotor.paper.proof import form

dt = sp.Symbol("Delta_t", positive=True)

# %% [markdown]
# ## The exact motion in powers of the step
#
# $\vec L' = \vec\tau$ and $\vec U' = \vec F/M$, with the torque and the force themselves changing:

# %%
L, tau, tau_v, U, F, F_v, X_cm, Omega = map(vector, ("L", "tau", "tau_dot", "U", "F", "F_dot", "X_cm", "Omega"))
I_x, I_y, I_z = principal = sp.symbols("I_x I_y I_z", positive=True)
tensor = sp.diag(*principal)
exact_L = tensor * Omega + tau * dt + tau_v * dt**2 / 2
exact_U = U + F / M * dt + F_v / M * dt**2 / 2
exact_X = X_cm + U * dt + F / M * dt**2 / 2 + F_v / M * dt**3 / 6
prove(
    exact_X.diff(dt),
    exact_U,
    "the centre moves with U",
    equations=r"\frac{d\vec X}{d\Delta_t} = \vec U + \frac{\vec F}{M}\,\Delta_t + \frac{\dot{\vec F}}{2M}\,\Delta_t^2",
)

# %% [markdown]
# The tensor turns with the body, $I' = \Omega_\times I - I\,\Omega_\times$, the rate of $R I_0 R^T$. Differentiating
# $\vec L = I\vec\Omega$ gives Euler's equations for the angular acceleration:

# %%
tensor_rate = cross_matrix(Omega) * tensor - tensor * cross_matrix(Omega)
acceleration = inverse(tensor) * (tau - tensor_rate * Omega)
prove(
    tensor * acceleration + cross(Omega, tensor * Omega),
    tau,
    "Euler's equations",
    equations=r"I\,\dot{\vec\Omega} + \vec\Omega\times I\,\vec\Omega = \vec\tau",
)

# %%
exact_Omega = Omega + acceleration * dt
Formula(exact_Omega, r"\vec\Omega(t + \Delta t)")

# %% [markdown]
# The program computes $\vec\Omega$ with the tensor of the old orientation. For unequal inertias it therefore lags by

# %%
stepped = inverse(tensor) * (tensor * Omega + tau * dt)
lag = agreement_order(stepped[0], exact_Omega[0], dt, 2)
Formula(sp.factor(lag.coefficient) * dt, r"\delta\Omega_x")

# %%
by_old, by_new = (agreement_order((X_cm + V * dt)[0], exact_X[0], dt, 3).order for V in (U, U + F * dt / M))
small_step = Premise("the time step Δt is small", small=dt)
equal_principal = Premise("the principal inertias are equal, I_x = I_y = I_z", {I_y: I_x, I_z: I_x})
verdict(
    "3.13",
    {
        r"\vec L(t+\Delta t)": exact_L,
        r"\vec U(t+\Delta t)": exact_U,
        r"\vec\Omega(t+\Delta t)": exact_Omega,
        r"\vec X_{cm}(t+\Delta t)": exact_X,
    },
    premises=[small_step, equal_principal],
    uses=["3.07", "3.08", "3.12"],
    evidence=[
        "All the paper's bodies have equal inertias. For unequal inertias Omega is computed with the tensor of the old "
        f"orientation, which causes an error of order {lag.order} in the step; the coefficient of its x component is "
        f"{sp.factor(lag.coefficient)}. The program propagates L and R, so the step remains a first-order method.",
        f"X_cm first differs from the exact motion at order {by_old} if the step uses the old U, and at order "
        f"{by_new} if it uses "
        "the new U.",
    ],
    form={
        r"\vec L(t+\Delta t)": form("I*Omega + Delta_t*tau + Delta_t**2/2*tau_dot", I=tensor, tau_dot=tau_v),
        r"\vec U(t+\Delta t)": form("U + Delta_t/M*F + Delta_t**2/(2*M)*F_dot", F_dot=F_v),
        r"\vec\Omega(t+\Delta t)": form(
            "Omega + Delta_t*inverse*(tau - cross(Omega, I*Omega))",
            {"inverse": "I^{-1}"},
            I=tensor,
            inverse=inverse(tensor),
        ),
        r"\vec X_{cm}(t+\Delta t)": form("X_cm + Delta_t*U + Delta_t**2/(2*M)*F + Delta_t**3/(6*M)*F_dot", F_dot=F_v),
    },
)
