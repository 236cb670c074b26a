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
    "Three panels show 10 s. The energy is 100 J, and 100.68 J from t = 2 s on. The force is a pulse of 50 N along y at 2 "
    "s. For the centre of rotor 1, x oscillates slightly about −0.5 m, while y and z go round the ground joint. The dashed "
    "exact curves are slightly ahead at the end."
)

# %%
data, measure, CAPTION, figure = shock_script(SCENE, "y")
