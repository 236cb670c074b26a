# %% [markdown]
# # Figure 13: opposite spins, a shock across the bar
#
# Pushed across the bar, the pair topples at once in that plane, while x swings about its place.

# %%
from lagrotor.pair import SCENES
from lagrotor.pictures import shock_script

SCENE = SCENES["anti-spin-shock-y"].scene
TITLE = "Opposite spins, shock across the bar"
ALT = (
    "Three panels over 10 s. Energy: 100 J, then 100.68 J from t = 2 s. Force: a pulse of 50 N in y at 2 s. Centre of "
    "rotor 1: x swings a little about −0.5 m while y and z go round the ground joint; the dashed exact "
    "curves run a little ahead in the end."
)

# %%
data, measure, CAPTION, figure = shock_script(SCENE, "y")
