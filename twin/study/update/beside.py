"""What stands beside named effects: of the voyages' own water and weather what makes them likelier, weighed
as the search of a diagnosis weighs it (search.py), with where each set leads the ship. So `twin add` has the
number that `twin diagnose` told."""

from twin.recording.progress import Progress, silent
from twin.study.diagnosis.afloat import floats
from twin.study.diagnosis.case import SCENARIOS, Case, visible
from twin.study.diagnosis.hollow import nothing
from twin.study.diagnosis.open_loop_check import open_loop_check
from twin.study.diagnosis.refine import Found, Sets, first_guess, largest, refine
from twin.study.diagnosis.search import CLOSE
from twin.study.diagnosis.steady import simpler, steady
from twin.study.reference.evidence import Hypothesis, Reduced, posterior, weigh_with

TRIED = 2  # kinds of weather beside each set, the likeliest to first order


def beside_the_voyage(case: Case, names: Sets, progress: Progress = silent) -> Found:
    """The named effects with the weather beside which they are likeliest, relinearised at their estimate."""
    search = WeatherSearch(case, names)
    while more := search.likely():
        for chosen in more:
            progress(f"testing whether {search.beside(chosen)} acted beside {' + '.join(names)}")
            search.relinearise(chosen)
    return search.likeliest()


class WeatherSearch:
    """The sets of effects that were relinearised at their estimate: the named ones, and these with weather
    beside them."""

    def __init__(self, case: Case, names: Sets) -> None:
        self.scenarios: dict[str, Reduced] = dict(
            zip(SCENARIOS, case.reduced(case.lines, case.scenarios(list(SCENARIOS))), strict=True)
        )
        usual = self.scenarios["usual"]
        self.case = case.weakened({n: visible(usual, n) for n in case.weather if n not in names})
        none = Hypothesis((), "usual", posterior(usual, ()).log_evidence, case.log_prior((), "usual"))
        self.found: dict[Sets, Found] = {(): Found(none, posterior(usual, ()), case.model)}
        self.names = names
        self.stand: list[Sets] = []  # those that may be the answer
        self.first: list[Sets] = []  # to be judged next, whatever else is likely
        self.relinearise(names)

    def relinearise(self, chosen: Sets) -> None:
        """Judge a set, begun where the likeliest part of it was found to stand, or at its first-order guess
        in the likeliest noise scenario."""
        parts = [self.found[s] for s in self.stand if set(s) < set(chosen)]
        part = largest(parts)
        scenario = part.hypothesis.scenario if part else self._likeliest_scenario(chosen)
        about = part.reduced if part and part.reduced else self.scenarios[scenario]
        z = first_guess(about, chosen)
        self.found[chosen] = found = refine(self.case, chosen, scenario, z, (), part=part)[0]
        swapped = [s for s in simpler(self.case, chosen) if set(self.names) <= set(s)]
        if swapped and steady(self.case, found):
            self.first += [s for s in swapped if s not in self.found]
        elif not any(nothing(self.case, found, n) for n in chosen if n not in self.names):
            self.stand.append(chosen)

    def _likeliest_scenario(self, chosen: Sets) -> str:
        guess = {
            name: posterior(r, chosen).log_evidence + self.case.log_prior(chosen, name)
            for name, r in self.scenarios.items()
        }
        return max(guess, key=lambda name: guess[name])

    def likely(self) -> list[Sets]:
        """What to judge next: a simpler set than one that needs no more; else the likeliest so far with one
        kind of weather more that is near it to first order."""
        if self.first:
            return [self.first.pop()]
        best = max((self.found[s] for s in self.stand), key=lambda f: f.hypothesis.log_weight)
        effects, h = best.hypothesis.effects, best.hypothesis
        more = [n for n in self.case.candidates if self._may_stand_beside(n, effects)]
        if best.reduced is None or not more:
            return []
        likely = {
            wider: evidence + self.case.log_prior(wider, h.scenario)
            for n, evidence in weigh_with(best.reduced, effects, more)
            if (wider := self.case.ordered((*effects, n))) not in self.found
        }
        near = [s for s in sorted(likely, key=lambda s: -likely[s]) if likely[s] > h.log_weight - CLOSE]
        return near[:TRIED]

    def beside(self, chosen: Sets) -> str:
        """What stands beside the named effects in a set, in words."""
        return " + ".join(n for n in chosen if n not in self.names)

    def likeliest(self) -> Found:
        """The likeliest set, by the readings one step ahead and by where it leads the ship, of those that a
        diagnosis would keep; the named effects alone where it would keep none."""
        asked = open_loop_check(self.case, self.found, [f.hypothesis for f in self.found.values()])
        afloat = (self.found[s] for s in self.stand if floats(self.case, self.found[s]))
        kept = [h.effects for h in asked.weigh([f.hypothesis for f in afloat])]
        best = kept[0] if kept else self.names
        return asked.found.get(best, self.found[best])

    def _may_stand_beside(self, name: str, chosen: Sets) -> bool:
        """Whether an effect is water or weather of the voyage (not of its place), new beside these, and
        neither a part of one of them nor the whole of it."""
        case, effect = self.case, self.case.catalogue[name]
        return (
            name in case.weather
            and not effect.of_place
            and name not in chosen
            and name not in case.present
            and not any(name in case.catalogue[n].holds or n in effect.holds for n in chosen)
        )
