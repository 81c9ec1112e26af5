"""The search for what is missing: every cause and every pair, beside the day's weather, in a linear pass;
then the best where they stand.

The linear pass costs milliseconds a hypothesis, and is right for small effects. Then the best hypothesis that
was not yet relinearised at its estimate is, and with it all that have one effect more, until none is left
that could still win. Water and weather of the voyages are a nuisance of every hypothesis: any of them may
stand beside any cause, and takes no cause's place."""

from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from twin.physics.effect import SensorFault
from twin.recording.progress import Progress, silent
from twin.study.diagnosis.case import ODDS_WEAK, SCENARIOS, Case, visible
from twin.study.diagnosis.consider import left_over
from twin.study.diagnosis.criteria import NEARLY
from twin.study.diagnosis.decision import explained
from twin.study.diagnosis.hollow import hollow
from twin.study.diagnosis.open_loop_check import OpenLoopCheck, open_loop_check
from twin.study.diagnosis.refine import Found, Sets, first_guess, largest, refine
from twin.study.diagnosis.steady import simpler, steady
from twin.study.reference.evidence import Hypothesis, Reduced, posterior, weigh_sets

MAX_CAUSES = 3  # causes at once
AT_FIRST = 2  # of which so many in the linear pass; one more only beside what was relinearised
MOST_WEATHER = 3  # of weather at once in the linear pass
WEATHER_SETS = 2  # sets of weather beside which every pair of causes is asked
ROUNDS = 20  # hypotheses relinearised at their estimates, at most
SINGLES = 3  # of which so many single effects first, unless nothing at all explains the voyages
# so many more single effects when nothing plain was found, and sets of one cause more where that leaves too
# much
LAST = 6
CLOSE = 3.0  # log odds behind the best within which a hypothesis is relinearised at its estimate
# of an effect's plausible size that any day brings, from which it is relinearised at its estimate without
# having earned it
MUCH = 0.05
EARNED = 1.5  # log evidence that an effect must add to deserve a second look


class Searched(NamedTuple):
    """What a search found."""

    case: Case  # with the odds of what would not have shown
    weighed: list[Hypothesis]  # all hypotheses, the likeliest first
    found: dict[Sets, Found]  # the few that were relinearised
    seen: dict[str, bool]  # whether each candidate, had it its plausible size, would have shown
    path: OpenLoopCheck  # where those that could be the answer lead the ship


def search(case: Case, progress: Progress = silent) -> Searched:
    """All hypotheses with their weights, judged one step ahead and along the path."""
    progress("weighing every effect and every pair")
    scenarios = dict(zip(SCENARIOS, case.reduced(case.lines, case.scenarios(list(SCENARIOS))), strict=True))
    seen = {name: visible(scenarios["usual"], name) for name in case.candidates if name not in case.unnamed}
    case = case.weakened(seen)
    book = Hypotheses(case, scenarios)
    searched = _searched(book, progress, seen)
    if not _explained(case, searched.weighed, searched.found):
        book.wide, book.last = True, book.one_more()
        searched = _searched(book, progress, seen)
    return searched


def _searched(book: "Hypotheses", progress: Progress, seen: dict[str, bool]) -> Searched:
    """What the book says once nothing is left to be judged."""
    for _ in range(ROUNDS):
        chosen = book.next()
        if chosen is None:
            break
        progress(f"refitting {' + '.join(chosen)} at {'its' if len(chosen) == 1 else 'their'} estimate")
        book.judge(chosen)
    progress("open-loop validation on held-out parts")
    book.asked = asked = open_loop_check(book.case, book.found, book.weighed(), book.asked)
    return Searched(book.case, book.proved(asked), book.found | dict(asked.found), seen, asked)


def _explained(case: Case, weighed: list[Hypothesis], found: dict[Sets, Found]) -> bool:
    best = weighed[0].effects
    if not case.causes(best):
        return found[best].open_loop_error_m <= NEARLY * found[best].expected_error_m
    return explained(left_over(case, weighed, found, best))


def _linear(case: Case, reduced: Reduced, scenario: str) -> list[tuple[Sets, float]]:
    """Log evidence of weather alone and with each cause, and of every pair of causes beside the likeliest
    sets of weather."""
    some = [name for name in case.weather if case.odds[name] > ODDS_WEAK]
    days = [
        day
        for size in range(MOST_WEATHER + 1)
        for day in combinations(some, size)
        if np.isfinite(case.log_prior(day, "usual"))
    ]
    causes = case.causes(case.candidates)
    told = weigh_sets(
        reduced, [case.ordered((*day, *few)) for day in days for few in ((), *combinations(causes, 1))]
    )
    likely: dict[Sets, float] = {}
    for chosen, evidence in told:
        day, weight = case.day(chosen), evidence + case.log_prior(chosen, scenario)
        likely[day] = max(weight, likely.get(day, -np.inf))
    best = sorted(likely, key=lambda day: -likely[day])[:WEATHER_SETS]
    more = [few for size in range(2, AT_FIRST + 1) for few in combinations(causes, size)]
    return [*told, *weigh_sets(reduced, [case.ordered((*day, *few)) for day in best for few in more])]


class Hypotheses:
    """What is known of every hypothesis so far: first about nothing, then about the sizes that were found."""

    def __init__(self, case: Case, scenarios: dict[str, Reduced]) -> None:
        self.case, self.scenarios = case, scenarios
        self.wide = False  # whether one cause more is judged, because the best so far leaves too much
        self.asked: OpenLoopCheck | None = None  # where those that could be the answer lead it
        self.entries: dict[tuple[Sets, str], Hypothesis] = {}
        for scenario, reduced in scenarios.items():
            for chosen, evidence in _linear(case, reduced, scenario):
                self._enter(Hypothesis(chosen, scenario, evidence, case.log_prior(chosen, scenario)))
        nothing = max((h for h in self.entries.values() if not h.effects), key=lambda h: h.log_weight)
        day = max(
            (h for h in self.entries.values() if not case.causes(h.effects)), key=lambda h: h.log_weight
        ).effects
        self.found: dict[Sets, Found] = {
            (): Found(nothing, posterior(scenarios[nothing.scenario], ()), case.model)
        }
        ranked = self.weighed()
        quiet = not case.causes(ranked[0].effects) and SCENARIOS[ranked[0].scenario].plain
        first = 0 if quiet else SINGLES  # none when the plain answer is that nothing is there
        singles = self.promising()
        self.first = [
            day,
            *singles[:first],
            *((*self.of_the_day(), *filter(self.of_another_moment, singles)) if first else ()),
        ]
        self.last = singles[first : first + LAST]

    def _enter(self, h: Hypothesis) -> None:
        if np.isfinite(h.log_weight):
            self.entries[h.effects, h.scenario] = h

    def weighed(self) -> list[Hypothesis]:
        """All that were entered, the likeliest first."""
        return sorted(self.entries.values(), key=lambda h: -h.log_weight)

    def proved(self, asked: OpenLoopCheck) -> list[Hypothesis]:
        """The same with the evidence of the path, and without those that would win unjudged."""
        weighed = asked.weigh(self.weighed())
        best = max(h.log_weight for h in weighed if h.effects in self.found)
        return [h for h in weighed if h.effects in self.found or h.log_weight <= best]

    def promising(self) -> list[Sets]:
        """The single effects that explain something, best first."""
        ranked, case = self.weighed(), self.case
        none = {(h.effects, h.scenario): h.log_evidence for h in ranked if not case.causes(h.effects)}
        ones = [h for h in ranked if len(case.causes(h.effects)) == 1]
        earned = (
            h.effects
            for h in ones
            if h.log_evidence > none.get((case.day(h.effects), h.scenario), -np.inf) + EARNED
        )
        best: dict[Sets, Sets] = {}
        for chosen in earned:
            best.setdefault(case.causes(chosen), chosen)
        return list(best.values())

    def one_more(self) -> list[Sets]:
        """Sets of one cause more than the likeliest, or than its weather alone, that were not judged: the
        likeliest first."""
        best, case = self.weighed()[0].effects, self.case
        beside = [best, case.day(best)][len(case.causes(best)) == MAX_CAUSES :]
        wanted = {
            case.ordered((*some, cause)) for some in beside for cause in case.causes(case.candidates)
        } - set(self.found)
        return list(dict.fromkeys(h.effects for h in self.weighed() if h.effects in wanted))[:LAST]

    def of_the_day(self) -> list[Sets]:
        """What every day brings much of on this ship: to first order what is usual takes the credit, and only
        its own estimate tells."""
        usual = {
            u.owner: self.case.nuisance.daily.get(u.label, 0.0) / u.sd
            for u in self.case.effects
            if u.every_day
        }
        return [(name,) for name, width in usual.items() if width > MUCH]

    def of_another_moment(self, chosen: Sets) -> bool:
        """Whether an instrument shows what was true before: about none, slopes of this moment tell little of
        it."""
        kinds = [self.case.catalogue[name] for name in self.case.causes(chosen)]
        return any(issubclass(kind, SensorFault) and kind.prompt is not SensorFault.prompt for kind in kinds)

    def next(self) -> Sets | None:
        """What to relinearise next; each effect of a set alone before the set, and beside what is unchanged:
        it may do what took two."""
        while self.first:
            if (chosen := self.first.pop(0)) not in self.found:
                return chosen
        ranked = self.weighed()
        for h in ranked:
            if ranked[0].log_weight - h.log_weight > CLOSE:
                break
            if h.effects not in self.found:
                return next((part for part in self.parts(h.effects) if part not in self.found), h.effects)
        for swapped in simpler(self.case, ranked[0].effects):
            if swapped not in self.found:
                return swapped
        while self.last and (self.wide or not SCENARIOS[ranked[0].scenario].plain):
            if (chosen := self.last.pop(0)) not in self.found:
                return chosen
        return None

    def parts(self, effects: Sets) -> list[Sets]:
        """The weather of a set by itself, each cause beside it, and what would be left of three without
        each."""
        case, day, causes = self.case, self.case.day(effects), self.case.causes(effects)
        fewer = (some for size in range(1, len(causes)) for some in combinations(causes, size))
        return [case.ordered((*day, *some)) for some in ((), *fewer)]

    def judge(self, chosen: Sets) -> None:
        """Enter what the voyages say of this set, and of every set with one effect more, about its own
        size."""
        start = largest(self.found[s] for s in self.found if set(s) < set(chosen)) or self.found[()]
        # of three, one in another's place was never weighed
        guess = next((h for h in self.weighed() if h.effects == chosen), None)
        scenario, hoped = (
            (guess.scenario, guess.log_weight) if guess else (start.hypothesis.scenario, -np.inf)
        )
        part = start.hypothesis.effects
        # where a part of the set was found to stand
        about = start.reduced if part and start.reduced else self.scenarios[scenario]
        z = first_guess(about, chosen)
        wider = self.case.candidates if len(self.case.causes(chosen)) < MAX_CAUSES else self.case.weather
        self.found[chosen], judged = refine(self.case, chosen, scenario, z, wider, hoped, start)
        if hollow(self.case, self.found[chosen]):
            self.entries = {key: h for key, h in self.entries.items() if key[0] != chosen}
            judged = [h for h in judged if h.effects != chosen]
        if steady(self.case, self.found[chosen]):
            self.found[chosen] = replace(self.found[chosen], steady=True)
            self.first = [*simpler(self.case, chosen), *self.first]
        for h in judged:
            if self._counts(chosen, h):
                self._enter(h)

    def _counts(self, chosen: Sets, h: Hypothesis) -> bool:
        """Whether what was said about the size of `chosen` is the better word on this hypothesis: on that set
        itself; on what leaves a part of it to what any day brings, if it is likelier so; and on a wider set
        that was not relinearised at its estimate, if this part is nearer."""
        if h.effects == chosen:
            return True
        if set(h.effects) < set(chosen):
            before = self.entries.get((h.effects, h.scenario))
            return before is not None and h.log_weight > before.log_weight
        return h.effects not in self.found and self._nearer(chosen, h)

    def _nearer(self, chosen: Sets, wider: Hypothesis) -> bool:
        """Whether no other part of the wider set was judged so far, or none about which the whole explains
        more: a slow gear is nothing to first order, and shows beside another effect only about its own
        size."""
        parts = [s for s in self.found if s and s != chosen and set(s) < set(wider.effects)]
        before = self.entries.get((wider.effects, wider.scenario))
        return not parts or before is None or wider.log_weight > before.log_weight
