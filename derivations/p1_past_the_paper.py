# %% [markdown]
# # The paper's results and the extended theory
#
# **Objective.** One row for each subject of the extended theory: the paper's result, the derived result with its order, a
# comparison with the exact model, and the figure.
#
# **Assumptions.** As in the scripts t1 to t15 and n6 to n9, which give every formula and every number.

# %%
import sympy as sp

from lagrotor.pair.notation import P_X, G, Omega, P, a, att, b, k, nu, p_y, r0, sigma
from lagrotor.paper import FigureLink, Table, prove
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.theory import cancelling_impulse, growth_squared, toppling_threshold
from lagrotor.theory.natural_frequency import natural_frequency

t1 = PAPER.scripts.run("derivations", "t1_natural_rate")
t2 = PAPER.scripts.run("derivations", "t2_shock_response")
t3 = PAPER.scripts.run("derivations", "t3_paired_orbit")
t4 = PAPER.scripts.run("derivations", "t4_orbit_family")
t5 = PAPER.scripts.run("derivations", "t5_floquet")
t6 = PAPER.scripts.run("derivations", "t6_shock_drift")
t7 = PAPER.scripts.run("derivations", "t7_duration")
t8 = PAPER.scripts.run("derivations", "t8_toppling")
t9 = PAPER.scripts.run("derivations", "t9_twist")
t10 = PAPER.scripts.run("derivations", "t10_conserved")
t11 = PAPER.scripts.run("derivations", "t11_slow_motion")
t12 = PAPER.scripts.run("derivations", "t12_unequal_spins")
t13 = PAPER.scripts.run("derivations", "t13_integrals")
t14 = PAPER.scripts.run("derivations", "t14_guiding_centre")
t15 = PAPER.scripts.run("derivations", "t15_return_maps")
n6 = PAPER.scripts.run("derivations", "n6_resonances")
n7 = PAPER.scripts.run("derivations", "n7_nonlinear_waves")
n8 = PAPER.scripts.run("derivations", "n8_fast_spins")
n9 = PAPER.scripts.run("derivations", "n9_precessions")
Omega_0, energy, wander, growth, power, reached, shift, turned = (
    sp.Symbol(name) for name in ("Omega_0", "E_gain", r"\dot{X}", "s", "lambda", "rho", r"\omega-\omega_0", "tau")
)


def equal(left: sp.Basic, right: sp.Basic) -> sp.Eq:
    """left = right, unevaluated."""
    return sp.Eq(left, right, evaluate=False)


# %% [markdown]
# ## Formulas

# %%
frequency = equal(Omega_0, natural_frequency().expressions[0])
gained = equal(energy, t2["equal_x"] * att**2)
series = equal(Omega / Omega_0, t3["frequency"])
momentum = equal(P / G, t3["second"] * r0**2)
stability = equal(power**2, growth_squared().expressions[0])
root = sp.sqrt(1 - sigma * att**2 * (att**2 + 2) * P_X**2 / (4 * G**2 * k**2))
impulse = -(att**2 + 2) * P_X**2 / (2 * G * k * (1 + root))
prove(
    cancelling_impulse().expressions[0],
    impulse.subs(sigma, (a + b) / (a - b)),
    "the impulse that cancels the drift",
    names="p_y",
)

# %%
cancelling = equal(p_y, impulse)
walk = equal(wander, sp.factor(t7["alone"]))
edge = equal(nu, toppling_threshold().expressions[0])
twist = equal(growth, t9["unstable"])

# %% [markdown]
# ## Rows

# %%
curve = t4["curves"]["massless, k = 1"]
least = "; ".join(f"{value:.4f} at r_0 = {r}" for r, value in zip(t4["amplitudes"], curve, strict=True))
powers = "; ".join(f"{kind}, exponent {slope:.2f} ({name})" for name, (kind, slope, *_) in t5["measured"].items())
tilts = "; ".join(f"{seen:.4f} 1/s, predicted {said:.4f} 1/s ({name})" for name, (said, seen) in t8["pairs"].items())
twists = "; ".join(
    f"{seen:.4f} 1/s, by Hill's equation {hill:.4f} 1/s ({x} rad)" for x, (_, hill, seen) in t9["pairs"].items()
)
cancelled = ", ".join(f"{force:.2f} N over {turns} oscillations" for turns, force in t6["by_window"].items())
said, given, seen = t5["edges"][1.2]
rows = (
    (
        "normal modes",
        "one fitted constant for any bar and any spins",
        ("one oscillation and four zero roots, for any spins and bar, in the limit of small motion:", frequency),
        f"in the paper's scene of 5.2.1 {t1['value']:.5f} rad/s; the peaks of the spectrum agree (figure)",
        FigureLink("t1"),
    ),
    (
        "response to a shock",
        "energies of 100 and 100.45 J, read from runs",
        ("amplitude, centre, drift and energy in closed form, first order; along x, equal spins:", gained),
        f"the closed form gives 100 + {t2['closed_energy']:.5f} J, the exact run {t2['exact']:.5f} J; the error is "
        "proportional to "
        f"the shock to the power {t2['slope']:.3f}",
        FigureLink("t2"),
    ),
    (
        "paired precession",
        "an ansatz of first order, which gives the bar the wrong length",
        ("a periodic orbit as a series of any order, for any bar:", series, momentum),
        f"exponents of the error: frequency {t3['slopes']['frequency']:.3f} (expected 4), momentum "
        f"{t3['slopes']['momentum']:.3f} (6); at r_0 = {t3['amplitudes'][-1]} the error of the frequency is "
        f"{t3['off']['frequency'][-1]:.1e}, its bound "
        f"{t3['bounds']['frequency'][-1]:.1e}",
        FigureLink("t3"),
    ),
    (
        "the whole family",
        "a frequency ∝ 1/cos θ, increasing for every bar",
        (
            "for ell = R the frequency decreases to a minimum and then increases; the family ends at r_0 = 1 without a fold",
        ),
        f"massless bar, Omega/Omega_0 = {least}",
        FigureLink("t4"),
    ),
    (
        "its stability",
        "none",
        (
            "elliptic for b > 0, hyperbolic for b ≤ 0 at small amplitude; growth lambda per radian, leading term:",
            stability,
        ),
        f"{powers}; the edge between the two at sigma = 1.2, k = 1 is r_0 = {said:.3f} ± {given:.3f} by the law and "
        f"{seen:.3f} on exact orbits",
        FigureLink("t5"),
    ),
    (
        "drift after a shock",
        "a force of −11 N along y, without a reason",
        (
            "a twist carries momentum about the joint line, so the pair rotates, in second order. The impulse that cancels it:",
            cancelling,
        ),
        f"the force is {t6['tried'][1]:.2f} N to second order; on exact runs it is {cancelled}",
        FigureLink("t6"),
    ),
    (
        "time until x leaves",
        "the x direction is stable",
        ("the rotation turns the twist into a mean of x, at an initial rate of third order in the shock:", walk),
        f"exponents in the force: {t7['slopes'][0]:.3f} (lean) and {t7['slopes'][1]:.3f} (mean of x). At 20 N the mean of x over "
        f"an oscillation and both axes stays below 0.1 for {t7['times'][20.0][0]:.2f} s by the initial rate and for "
        f"{t7['followed']:.2f} s on the exact run; x_1 itself for {t7['single'][0]:.2f} s",
        FigureLink("t7"),
    ),
    (
        "toppling",
        "opposite spins topple",
        ("uniform rotation is exact at any angle; it is stable if b nu² > G nu/k, with the threshold", edge),
        f"exact growth rates {tilts}",
        FigureLink("t8"),
    ),
    (
        "equal spins",
        "one rotor, the axes aligned",
        ("exact, but a twist grows if K > m ell²/4, b < 0; first order in the half-angle:", twist),
        f"exact growth rates {twists}",
        FigureLink("t9"),
    ),
    (
        "conserved quantities",
        "A and B",
        ("E, G_1, G_2 and P, and along the paired precession no other; B is conserved, A is not",),
        f"the drift over 3 s is at most {max(t10['drift'].values()):.1e}; A oscillates ∝ r_0 to the power {t10['order']:.2f}",
        FigureLink("t10"),
    ),
    (
        "the slow motion",
        "none",
        (
            "the averaged motion of opposite spins at any lean, in closed form; x turns back only if (σ − 1) k² exceeds",
            t11["threshold"],
        ),
        "time to x = 0.5: "
        + "; ".join(
            f"{exact:.2f} s exact, {said:.2f} s averaged, at {force:g} N"
            for force, said, exact in zip(t11["FORCES"], t11["law"], t11["exact_times"], strict=True)
        )
        + f"; the relative error is proportional to the force to the power {t11['time_order']:.2f}",
        FigureLink("t11"),
    ),
    (
        "unequal spins",
        "none",
        (
            "the relative shift of the rate is c r_0², one formula from equal (ζ = 0) to opposite spins (ζ = 1); a "
            "twist grows by "
            "lambda per radian, leading term:",
            t12["law"],
            equal(power**2, t12["growth"]),
        ),
        "exponents of the errors of the shift and of the drift of the azimuth: "
        + "; ".join(f"{one:.2f} and {two:.2f} ({name})" for name, (one, two) in t12["measured"].items())
        + "; exponents of the error of the growth: "
        + ", ".join(f"{order:.2f} ({name})" for name, order in t12["grown"].items()),
        FigureLink("t12"),
    ),
    (
        "further integrals",
        "none",
        "small oscillations conserve the averaged action to every order; larger ones with a heavy bar are chaotic in simulations",
        f"the distance of neighbouring motions grows as the power {t13['power']:.2f} of time at r_0 = 0.05, and by the factor "
        f"exp({t13['fast'][40] / 40:.2f}) per turn at 0.3; such a run is reliable for {t13['horizon']:.0f} turns",
        FigureLink("t13"),
    ),
    (
        "the guiding centre",
        "none",
        (
            "unequal spins move like a charged particle in three dimensions; for small oscillations the centre stays "
            "on a line of "
            "constant flux, with h half the angle between the axes,",
            t14["flux"],
        ),
        "exponents of the error of its path: "
        + "; ".join(f"{order:.2f} ({name})" for name, order in t14["measured"].items()),
        FigureLink("t14"),
    ),
    (
        "about a periodic orbit",
        "none",
        (
            "the angle of a return is a series in the action, α + τI + …, for any Hamiltonian system (known: Birkhoff "
            "1927, Moser "
            "1973); for Hénon's map, with c = cot α/2,",
            equal(turned, t15["twist"]),
        ),
        "exponents of the error with the twist, and of the error through sixth order: "
        + "; ".join(f"{one:.2f} and {two:.2f} ({name})" for name, (_, one, two) in t15["measured"].items()),
        FigureLink("t15"),
    ),
    (
        "resonances under load",
        "none",
        (
            "linearly stable, but unstable to any push if two slow rates add up to a fast one; with c the coefficient of third "
            "order, the largest push whose motion stays bounded near this resonance is",
            equal(reached, n6["edge"]),
        ),
        f"for a corner of three at {n6['third'] / n6['critical']:.4f} times its critical spins the time is ∝ the push to the "
        f"power −{-n6['slope']:.3f}; the result is new for rotors and bars, the mechanism is Cherry's (1925)",
        FigureLink("n6"),
    ),
    (
        "waves of rows and rings",
        "none",
        (
            "the rate of a wave shifts ∝ the square of its amplitude, N = a²/4, including the forced response:",
            equal(shift, n7["moved"]),
        ),
        "exponents of the remaining error: "
        + ", ".join(f"{order:.2f} ({name})" for name, order in n7["orders"].items())
        + f"; with a wave of amplitude {n7['pumped'][0]:g} two others grow {100 * n7['short'][0]:.1f} % more slowly "
        "than predicted; "
        "the result is new for rotors and bars, the method is Whitham's (1965)",
        FigureLink("n7"),
    ),
    (
        "fast spins",
        "none",
        (
            "only slow precessions remain, in equations of first order; with springs those of Nash et al. (2015). For "
            "one axis with "
            "the stiffness κ and ε = aκ/G²,",
            equal(n8["omega"], n8["in_limit"]),
            "with the relative error ε",
        ),
        f"the error of the slow rates of four gyroscopes is ∝ the spins to the power −{-n8['powers'][0]:.2f}, with the next term "
        f"−{-n8['powers'][1]:.2f}; the gap of hanging gyroscopes on a honeycomb is from {n8['low']:.4f} to "
        f"{n8['high']:.4f} rad/s, "
        f"with inertia from {n8['with_inertia'][0]:.4f} to {n8['with_inertia'][1]:.4f}",
        FigureLink("n8"),
    ),
    (
        "precessions of structures",
        "none",
        (
            "each mode with a simple rate continues at finite tilt τ as a periodic motion (known: Lyapunov 1907). Its "
            "rate, with p "
            "the tilt of the axis over √I and b the forced response:",
            equal(Omega, n9["law"]),
            "and its multipliers, up to the resonance of two modes whose rates nearly add up to it; new for rotors and bars",
        ),
        "exponents of the remaining errors of rate and multipliers: "
        + "; ".join(f"{orders[1]:.2f} and {orders[3]:.2f} ({name})" for name, orders in n9["measured"].items())
        + f"; the fastest precession of a triangle is stable up to a tilt of {n9['law_edge']:.4f}, on exact orbits "
        f"{n9['seen']:.4f}",
        FigureLink("n9"),
    ),
)

tables = [
    Table(
        "The paper's results and the extended theory",
        ("subject", "the paper", "derived result", "compared with the exact model", "figure"),
        rows,
        "Formulas come from the closed forms, numbers from the runs of this report; a and b are the inertias with the bar's "
        "share, k = ell/R, sigma = (a + b)/(a − b).",
    )
]
tables[0]
