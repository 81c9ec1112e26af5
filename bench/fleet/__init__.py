"""A fleet of families: random ships that share no form of their forces with one another nor with the twin,
on which the decision of `twin diagnose` is measured and fitted with each family held out in turn."""
