"""A fleet of families: random ships that share no form of their forces with one another nor with the twin,
on which the decision of `twin diagnose` is measured and fitted with each family held out in turn."""

import os

# before numpy loads: on small matrices threads wait for each other, and here a process has a core
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
