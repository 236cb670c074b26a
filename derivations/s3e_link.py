# %% [markdown]
# # The force of a link (3.19, 3.20)
#
# **Objective.** The forces of the spring with a damper that joins two vertices in the paper's program.
#
# **Assumptions.** A spring of rest length zero and stiffness $S$; a damper along it whose force is $D$ times the rate of its
# length.
#
# **Notation.** $\hat e$ the unit vector from vertex 2 to vertex 1, with inclination $\theta$ and azimuth $\phi$ (one reading
# of the paper's $\hat e_{21}$); $s = |\vec X_1 - \vec X_2|$.

# %%
import sympy as sp

from lagrotor.pair import axis
from lagrotor.pair.notation import ROTOR
from lagrotor.paper import Formula, prove, verdict
from lagrotor.paper.grammar import rate, vector
from lagrotor.paper.proof import form

S, D, s = sp.symbols("S D s", positive=True)
theta, phi, _ = ROTOR.q
e_hat = axis(theta, phi)
X_1, X_2, U_1, U_2 = map(vector, ("X_1", "X_2", "U_1", "U_2"))
at_distance = dict(zip(X_1, X_2 + s * e_hat, strict=True))

# %% [markdown]
# ## Energy and loss
#
# The spring holds $\frac S2|\vec X_1 - \vec X_2|^2$. The damper loses $D\dot s^2$, twice Rayleigh's function, with the rate
# of the length

# %%
length_squared = (X_1 - X_2).dot(X_1 - X_2)
s_rate = (U_1 - U_2).dot(e_hat)
prove(
    rate(length_squared, (X_1, X_2), (U_1, U_2)).subs(at_distance),
    2 * s * s_rate,
    "the rate of the squared length",
    equations=r"\frac{d}{dt}\,|\vec X_1 - \vec X_2|^2 = 2 s\,\dot s,\qquad \dot s = (\vec U_1 - \vec U_2)\cdot\hat e",
)

# %%
stored = S / 2 * length_squared
rayleigh = D / 2 * s_rate**2
Formula(rayleigh, r"\mathcal F")

# %% [markdown]
# ## The forces
#
# On either vertex the force is $-\partial/\partial\vec X$ of the energy and $-\partial/\partial\vec U$ of Rayleigh's function.


# %%
def force_on(X: sp.Matrix, U: sp.Matrix) -> sp.Matrix:
    """The force of the link on a vertex at X with the velocity U."""
    return sp.Matrix([-sp.diff(stored, x).subs(at_distance) - sp.diff(rayleigh, u) for x, u in zip(X, U, strict=True)])


on_1, on_2 = force_on(X_1, U_1), force_on(X_2, U_2)
tension = S * s + D * s_rate
prove(
    on_1.dot(e_hat),
    -tension,
    "along ê the force on vertex 1 is the tension, towards vertex 2",
    equations=r"\vec F_1\cdot\hat e = -(S\,s + D\,\dot s)",
)

# %% [markdown]
# The printed equation sets a number equal to a vector. The number is the tension, if $\hat e_{21}$ points from 2 to 1. With the
# direction $\hat e$ restored, the link's energy never grows:

# %%
power = on_1.dot(U_1) + on_2.dot(U_2)
growing = rate(stored, (X_1, X_2), (U_1, U_2)).subs(at_distance)
prove(
    power + growing,
    -D * s_rate**2,
    "the power of the forces plus the rate of the spring's energy: the dissipated power",
    equations=r"\vec F_1\cdot\vec U_1 + \vec F_2\cdot\vec U_2 + \frac{d}{dt}\,\frac{S s^2}{2} = -D\,\dot s^2",
)

# %% [markdown]
# If $\hat e_{21}$ pointed from 1 to 2, and the force along it, the damper would supply the power $P$ to the link:

# %%
other_way = D * (U_1 - U_2).dot(-e_hat) * -e_hat
gained = other_way.dot(U_1) - other_way.dot(U_2)
opening = {**dict.fromkeys((*U_1, *U_2), 0), U_1[2]: 1, theta: 0, phi: 0}  # at 1 m/s
fed = gained.subs(opening)
prove(
    gained,
    D * (U_1 - U_2).dot(e_hat) ** 2,
    "the power that the damper would supply",
    equations=r"P = D\,\big((\vec U_1 - \vec U_2)\cdot\hat e\big)^2",
)

# %%
pull = form("-(S*s + D*dot(U_1 - U_2, hat_e))*hat_e", hat_e=e_hat)
link_force = verdict(
    "3.19",
    on_1,
    correction=pull,
    wrong="A number is equated to a vector: the direction of the link is missing.",
    evidence=[
        "The right side is a number, the left side a vector. The number is the tension of the link, S s + D s', if e_21 points "
        "from 2 to 1; the force on vertex 1 is the tension along -e_21. If e_21 pointed from 1 to 2, the damper would supply a "
        f"power of {fed} W to a link that opens at 1 m/s.",
        "With the corrected force the link's energy changes at the rate -D ((U_1 - U_2).e)^2, so it never increases. "
        "The direction "
        "is undefined at s = 0. The paper's preceding sentence exchanges the names: it calls S the damping and D the spring "
        "constant.",
    ],
    form=pull,
)
link_force

# %% [markdown]
# ## Action and reaction
#
# Energy and loss depend on the differences of places and velocities alone, so that the two forces are opposite.

# %%
verdict(
    "3.20",
    on_2,
    uses=[link_force],
    form=form("(S*s + D*dot(U_1 - U_2, hat_e))*hat_e", hat_e=e_hat),
)
