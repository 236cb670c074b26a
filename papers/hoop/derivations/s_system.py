# %% [markdown]
# # The system that paper.toml states
#
# Written by `lagrotor derive`; change paper.toml, not this.

# %%
from lagrotor.paper import stated, verdict

system = stated(__file__)

# %% [markdown]
# ## (1): L

# %%
verdict("1", system["1"])

# %% [markdown]
# ## (2): momentum theta

# %%
verdict("2", system["2"])

# %% [markdown]
# ## (3): acceleration theta

# %%
verdict("3", system["3"])

# %% [markdown]
# ## (4): energy

# %%
verdict("4", system["4"])

# %% [markdown]
# ## (5): frequency at theta = 0

# %%
verdict("5", system["5"])

# %% [markdown]
# ## (6): frequency^2 at theta = acos(g/(R*Omega**2))

# %%
verdict("6", system["6"])

# %% [markdown]
# ## (7): acceleration theta

# %%
verdict("7", system["7"])
