"""The answer to one search: what was weighed, the facts, and the decision."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from twin.physics.ship import Ship
from twin.recording.progress import Progress, silent
from twin.recording.voyage import Voyage
from twin.study.diagnosis.assemble import of_tracks
from twin.study.diagnosis.by_kinematics import instrument_suspected, kinematics, suspected_instruments
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.consider import Considered, consider
from twin.study.diagnosis.decision import Decision, decide
from twin.study.diagnosis.hollow import nothing
from twin.study.diagnosis.open_loop_check import OpenLoopCheck
from twin.study.diagnosis.refine import Found, Sets
from twin.study.diagnosis.search import search
from twin.study.diagnosis.verdict import Weights, weights
from twin.study.reference.evidence import Hypothesis


@dataclass(frozen=True)
class SearchAnswer:
    """What the voyages of a case say."""

    case: Case
    weighed: Sequence[Hypothesis]  # the likeliest first
    found: Mapping[Sets, Found]
    seen: Mapping[str, bool]  # whether each candidate, had it its plausible size, would have shown
    path: OpenLoopCheck  # where those that could be the answer lead the ship
    weights: Weights
    considered: Considered
    decision: Decision
    # causes that are named only with the others in the model, and the set in which all stand, fitted together
    further: Sets = ()
    joined: Sets = ()

    @property
    def causes(self) -> tuple[str, ...]:
        """Effects of ship and instruments that are named."""
        return self.case.causes(self.decision.missing)

    @property
    def resembling(self) -> tuple[str, ...]:
        """What is known by its form alone and is likely; of a few effects of which one is there, those."""
        of_few = tuple(n for n in self.considered.facts.one_of if n in self.case.unnamed)
        return of_few if self.decision.reason == "one_of" else self.considered.facts.resembles

    @property
    def shown(self) -> Sets:
        """The set of effects in which what is named stands with its numbers: of those that were weighed to
        the end the likeliest that was relinearised with these causes and no other, beside whatever weather;
        else the likeliest that holds them. What is named of water and weather stands in it too, where any
        set has both."""
        if self.joined:
            return self.joined
        weighed = [s for s in dict.fromkeys(h.effects for h in self.weighed) if s in self.found]
        causes = set(self.causes)
        for wanted in (set(self.decision.missing), causes):
            holding = [s for s in weighed if wanted <= set(s)]
            own = [s for s in holding if set(self.case.causes(s)) == causes and self._stands(self.found[s])]
            if holding:
                return max(own, key=self._log_weight, default=holding[0])
        return self.weights.best.effects

    def _log_weight(self, chosen: Sets) -> float:
        """Of a set about its own numbers, with where it leads the ship."""
        return self.path.with_path(self.found[chosen].hypothesis).log_weight

    def _stands(self, found: Found) -> bool:
        """Whether no weather of a set is none, or needs no more than a simpler one."""
        day = self.case.day(found.hypothesis.effects)
        return not found.steady and not any(nothing(self.case, found, name) for name in day)


def answer(
    case: Case,
    voyages: Sequence[Voyage],
    ship: Ship,
    references: Sequence[Voyage] = (),
    progress: Progress = silent,
) -> SearchAnswer:
    """Search, facts and decision; where an instrument is suspected, beside what kinematics say of it."""
    searched, asked = search(case, progress), None
    if instrument_suspected(case, searched.weighed[0].effects):
        progress("checking the instruments against each other, without the ship model")
        asked = kinematics(voyages, ship)
        if asked and (wanted := suspected_instruments(case, asked)):
            case = of_tracks(case.tracks, ship, references, progress, wanted)
            searched = search(case, progress)
    progress("computing the facts")
    case, weighed, found, seen, path = searched
    w = weights(case, weighed, found)
    considered = consider(case, weighed, found, seen, w, asked)
    return SearchAnswer(case, weighed, found, seen, path, w, considered, decide(considered.facts))
