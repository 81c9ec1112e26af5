"""Whether a force is what its name says: how large a share of it the voyages would rather have something
else.

A wrong name may lead a ship most of the way, for its size is what suits the voyages best. But it pulls in
moments when nothing does, and a squall that is taken for a load, or a play of the gear for a slow gear, is
explained by it here and there only. Then the voyages are more probable if most of what the effect does is
left open at every moment. Nature writes a true effect otherwise than a catalogue does, by a fifth of it as a
rule (DOUBTS, refine.py): to leave more open makes true voyages less probable. Now and then its form is
farther off; then it still leads her where she went, as the model alone does not, and voyages on which it were
not at work at all would be less probable."""

from dataclasses import replace

import numpy as np

from twin.physics.model import Model
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.led import plain
from twin.study.diagnosis.refine import DOUBTS, Found, standing
from twin.study.estimation.respond import respond
from twin.study.reference.evidence import posterior

PUSH = ("Force", "Lag")  # kinds that are judged by what they do to her
MOST_OF_IT = (0.4, 0.8, 1.6)  # shares that no true effect leaves open; the last is more than all of it
CLEAR = 3.0  # log evidence by which the voyages must ask for one of them


def otherwise(case: Case, found: Found, nothing: Found) -> list[str]:
    """The effects of a hypothesis whose force the voyages would clearly rather have otherwise, whatever the
    others explain (`nothing`: the hypothesis without any)."""
    kinds = ((name, case.catalogue[name]) for name in found.hypothesis.effects)
    asked = [name for name, kind in kinds if kind.kind in PUSH and not kind.irregular]
    if not asked:
        return []
    lines, at = standing(case, found)
    shares = np.array([*DOUBTS, *(MOST_OF_IT[-1:] if leads_her(found, nothing) else MOST_OF_IT)])
    world = plain(found.hypothesis).world
    out = []
    for name in asked:
        bare = without(found.model, case.model, name)
        own = [
            np.abs(
                respond(x.track, x.model)[0] - respond(x.track, bare.without_inputs(x.track.missing())[0])[0]
            )
            for x in lines
        ]
        doubted = [
            replace(x, doubted=force, slack=np.hypot(x.slack, found.doubt * x.doubted))
            for x, force in zip(lines, own, strict=True)
        ]
        reduced = case.reduced(doubted, [case.worlds([world], share)[0] for share in shares], at)
        says = np.array([posterior(r, found.hypothesis.effects).log_evidence for r in reduced])
        if says[len(DOUBTS) :].max() > says[: len(DOUBTS)].max() + CLEAR:
            out.append(name)
    return out


def leads_her(found: Found, nothing: Found) -> bool:
    """Whether a hypothesis leads her within what is usual of where she went, as the model alone does not (to
    each its own floor would make the water restless for who needs it so)."""
    return found.off_m <= found.floor_m < nothing.off_m


def without(model: Model, before: Model, name: str) -> Model:
    """The model with one effect taken out, or put back to what it was `before`."""
    was = (e for e in before.effects if type(e).__name__ == name)
    return Model(model.ship, (*(e for e in model.effects if type(e).__name__ != name), *was))
