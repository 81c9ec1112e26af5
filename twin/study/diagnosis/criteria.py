"""The numbers that decide, each with its unit and the question that it answers.

NAMED, SIGNIFICANT and USUAL were fitted with families of ships held out (bench/fleet,
docs/results/judgement.md); NEARLY is what 98 % of their healthy voyages ended within when it was set; the
others are conventions. The table in docs/diagnosis.md is made of these lines (docs/decision_page.py).
"""

# posterior probabilities [1]
NAMED = 0.9  # probability from which a cause is named (fitted)
SURE = 0.8  # from which weather is named, a likely cause is asked about, or nothing said to be missing
CERTAIN = 0.9  # of a second cause, one of a group, or that a force comes and goes: rough forms mend others
LOST = 0.5  # likelier than not: of something without a name, from which none is given; of what is named
# log odds, or log Bayes factor where none were beforehand [natural log]
CLEAR = 3.0  # 20 to 1 (Kass & Raftery 1995): by which a change is asked for, or two effects told apart
# ratios of open-loop errors [1]
NEARLY = 1.75  # times the expected error that 98 % of healthy voyages end within (when it was set)
MOSTLY = 0.5  # share of the error without it that an explanation may leave although more is missing
BETTER = 0.05  # share by which a force must reduce the open-loop error; less is scatter
# others
SIGNIFICANT = 6.0  # standard deviations of an instrument's numbers from none (fitted)
CHANGED = 2.0  # standard deviations of its form by which a number must differ from the ship file's (95 %)
USUAL = 0.25  # share of the reference voyages with as high a score, from which a cause is unchanged (fitted)
POWER = 0.75  # share of the causes that would have shown, before nothing is said to be missing
