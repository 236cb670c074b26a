# %% [markdown]
# # Figure 12: opposite spins, a shock along the bar
#
# The pair holds in x, where the shock pushes, and topples slowly in the plane across the bar.

# %%
from lagrotor.pair import SCENES
from lagrotor.pictures import shock_script

SCENE = SCENES["anti-spin-shock-x"].scene
TITLE = "Opposite spins, shock along the bar"
ALT = (
    "Three panels over 10 s. Energy: 100 J, then 100.44 J from t = 2 s. Force: a pulse of 50 N in x at 2 s. Centre of "
    "rotor 1: x swings a little about −0.5 m, y grows with the same swing upon it, z falls a little; the dashed exact "
    "curves lie on them."
)

# %%
data, measure, CAPTION, figure = shock_script(SCENE, "x")
