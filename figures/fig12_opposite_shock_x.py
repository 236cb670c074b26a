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
    "Three panels show 10 s. The energy is 100 J, and 100.44 J from t = 2 s on. The force is a pulse of 50 N along x at 2 "
    "s. For the centre of rotor 1, x oscillates slightly about −0.5 m, y grows with the same oscillation superposed, and z "
    "decreases slightly. The dashed exact curves coincide with them."
)

# %%
data, measure, CAPTION, figure = shock_script(SCENE, "x")
