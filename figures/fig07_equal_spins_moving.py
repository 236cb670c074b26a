# %% [markdown]
# # Figure 7: the moving bodies of a pair of equal spins
#
# The paper's own method: three bodies, spring links, its step. Four pictures of one turn, the wheels carried by the
# rotation and the centre that the run has for each body (section 3.4).

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor.drawing import BAR, INK, RADIUS, ROTORS, Camera
from lagrotor.pair import DAMPING, SCENES, STEP, STIFFNESS
from lagrotor.paper.rotor_pair.runs import paper_run
from lagrotor.pictures import bare, draw_wheel, ground

SCENE = SCENES["same-spin"].scene
T_END, SHOWN = 0.628, (0, 157, 314, 471)  # s; steps of the pictures, a quarter of a turn apart
TITLE = "Equal spins: the moving bodies"
CAPTION = (
    f"Run of the spring-link model with S = {STIFFNESS:g} N/m and D = {DAMPING:g} kg/s (n = 20 and omega_s = 10 rad/s "
    "in 4.01) and "
    f"the paper's step of {STEP:g} s. The spins are 10 and 10 rad/s, the bar has 1 kg and 1 kg m². Between consecutive "
    "pictures (a) to (d) "
    "the rotors make a quarter of a turn: the marked spoke turns, while the axes stay upright. The wheels are not drawn to the "
    "scale of the inertia."
)
ALT = (
    "Four pictures of the pair at t = 0, 0.157, 0.314 and 0.471 s. The axes stand upright and the bar lies level in all; "
    "a green spoke on each wheel moves round by a quarter of a turn from one to the next, the same way on both."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Times (n,) in s, angle of body 1's marked spoke (n,) in rad, and the bodies in the four pictures."""
    t = np.arange(round(T_END / STEP) + 1) * STEP
    run = paper_run(SCENE, t)
    chosen = list(SHOWN)
    spoke = run.rotations[0, :, :, 0]
    return {
        "t": t,
        "angle": np.unwrap(np.arctan2(spoke[:, 1], spoke[:, 0])),
        "shown": t[chosen],
        "centres": run.centres[:, chosen],
        "rotations": run.rotations[:, chosen],
        "tips": run.tips[:, chosen],
        "moved": np.abs(run.tips - run.tips[:, :1]).max(axis=(0, 2)),
    }


def measure() -> dict[str, float]:
    """Rate of the marked spoke (rad/s), and how far the tips have moved at most (m)."""
    d = data()
    return {
        "rate of the wheel (rad/s)": float((d["angle"][-1] - d["angle"][0]) / d["t"][-1]),
        "tips, largest movement (m)": float(d["moved"].max()),
    }


# %%
def figure() -> Figure:
    """Four pictures of one turn."""
    d, camera = data(), Camera()
    R, ell = SCENE.rotor.length, SCENE.link.length
    joints = camera(np.array([[-ell / 2, 0, 0], [ell / 2, 0, 0]]))
    drawn = Figure(figsize=(7.0, 6.4))
    for k, axes in enumerate(drawn.subplots(2, 2).flat):
        wide = camera(d["centres"][:2, k] + RADIUS * R * np.array([[-1, 0, 0], [1, 0, 0]]))
        tips = camera(d["tips"][:, k])
        bare(axes, np.vstack([joints, tips, wide]), 0.07)
        for i, ink in enumerate(ROTORS):
            draw_wheel(axes, camera, d["rotations"][i, k], d["centres"][i, k], (RADIUS * R, R), ink)
        axes.plot(*tips.T, color=BAR, linewidth=5, solid_capstyle="round", zorder=2)
        axes.plot(*tips.T, "o", color=INK, markersize=4, zorder=5)
        ground(axes, joints, 6)
        axes.set_title(f"t = {d['shown'][k]:.3f} s")
    return drawn
