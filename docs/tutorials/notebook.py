# %% [markdown]
# # A tanker that sails badly on Monday
#
# The whole story on voyages that come with the package: read, compare, diagnose, add, compare, plot. Open
# this file as a notebook (VS Code, Jupytext, Spyder), or run it: `python docs/tutorials/notebook.py`. It
# needs `pip install 'shiptwin[notebook]'`.

# %%
from pathlib import Path

import twin

HERE = Path(twin.__file__).parent / "voyages"  # bundled: a calibrated tanker and two voyages

# %% [markdown]
# ## Read
# A ship file holds particulars, derivatives and what calibration learned of healthy voyages. A voyage holds
# samples by channel, each in the unit of the channel's name. `twin.read_voyage` also reads CSV, with a map of
# its columns where they have other names.

# %%
ship = twin.Ship.load(HERE / "tanker.toml")
monday = twin.read_voyage(HERE / "monday.mcap")
tuesday = twin.read_voyage(HERE / "tuesday.mcap")
table = monday.to_dataframe()
table[["heading_true_north_deg", "rudder_angle_deg", "surge_velocity_mps"]].describe()

# %% [markdown]
# ## Compare
# The model is started from the measured state, again and again, and run on the recorded rudder and propeller.
# Errors stand beside what is expected of this calibrated ship.

# %%
before = twin.compare(ship, tuesday)
before.errors

# %%
before.plot()

# %% [markdown]
# ## Diagnose
# Which effect of the catalogue is missing? All are judged jointly: the answer has a verdict, probabilities,
# and for each candidate its size, 95 % interval and force.

# %%
found = twin.diagnose(ship, monday)
print(found.sentence)
print(found.verdict, found.effects, found.probabilities)

# %%
found.to_dataframe()[["effect", "probability", "error_without", "error_with"]]

# %% [markdown]
# In a notebook cell `found` alone shows the whole page, with tracks and plots.

# %%
found.plot()

# %% [markdown]
# ## Add, and prove it on a voyage that was not used
# Only the numbers of the added effect are fitted, on Monday. Tuesday judges.

# %%
better = twin.add(ship, found.effects, monday, held_out=tuesday)
better.to_dataframe()

# %%
print(f"{better.error_before_m:.1f} m -> {better.error_after_m:.1f} m, accepted: {better.accepted}")

# %% [markdown]
# ## Compare again

# %%
after = twin.compare(better.ship, tuesday)
after.plot(beside=before)

# %% [markdown]
# ## Simulate
# What does the better model do in still water?

# %%
run = twin.simulate(better.ship, manoeuvre="zigzag_20", duration_s=900.0)
run.plot()

# %% [markdown]
# ## Keep it
# `better.ship.save("tanker-better.toml")` writes the ship file, with the history of what was added and why.
