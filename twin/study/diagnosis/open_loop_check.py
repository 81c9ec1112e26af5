"""Whether a hypothesis would also have brought the model where the ship went: a second test beside the
readings one step ahead.

One step ahead, a hypothesis is judged by what is fast; a little misfit of the core, repeated at every step,
may then decide between two causes that explain the voyages nearly alike. Run free from measured states over
parts it was not fitted to, a wrong cause goes astray where the true one does not. What noise and structure
would do to a true model anyway says nothing."""

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from twin.physics.model import Model
from twin.study.diagnosis.case import MOST_SEGMENTS, SCENARIOS, Case
from twin.study.diagnosis.horizon import horizon_s, too_sparse
from twin.study.diagnosis.refine import Found, Sets, standing
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.estimation.rough import COMES_AND_GOES, added, elsewhere
from twin.study.prediction.openloop import coarse, predict_each
from twin.study.prediction.windows import MODEL, STRUCTURE, Windows
from twin.study.reference.evidence import Hypothesis, given, posterior, reduce
from twin.study.reference.path_error import of_ship as path_error_of
from twin.study.reference.structure import once_off

# log odds against a second effect that the path does not ask for: of two forms that are only roughly right,
# one mends the other
COMPLEXITY = 10.0
# windows that count: what the core misses is the same in all of them, and more of the same tells no more
MAX_WINDOWS = 40.0
FORM_MISSES = 0.1  # share of what an effect does to the path that its form may miss
ANY_DAY = 2.0  # standard deviations of what any day brings, that nobody need name
DEGRADED = 0.05  # share by which two effects lead it farther off than one of them, so that the other is none
REACH = 60.0  # log odds behind the best up to which a hypothesis is asked


@dataclass(frozen=True)
class OpenLoopCheck:
    """How far from the measured path each hypothesis ended, and what noise and structure alone would have
    made of it."""

    found: Mapping[Sets, Found]  # with `open_loop_error_m`; "nothing" is among them
    expected_m: Mapping[str, float]  # [m], by noise scenario
    levered: Mapping[Sets, float]  # [m] and what each may leave whose side force attacks elsewhere along it
    windows: float  # that do not overlap, and no more than MAX_WINDOWS
    irregular: frozenset[str]  # effects that come and go
    weather: frozenset[str]  # effects that are no cause, and bear no penalty

    def log_probability(self, h: Hypothesis) -> float:
        """Of the path under a hypothesis; one that was not asked leads no worse than the best part of it that
        was."""
        own, levered = (
            self.found.get(h.effects),
            max(m for s, m in self.levered.items() if set(s) <= set(h.effects)),
        )
        expected_m = _expected_error(
            h, self.expected_m, self.found[()].open_loop_error_m, self.irregular, levered
        )
        error = (
            own.open_loop_error_m
            if own
            else min(f.open_loop_error_m for s, f in self.found.items() if set(s) <= set(h.effects))
        )
        return self._path(error, expected_m)

    def weigh(self, weighed: Sequence[Hypothesis]) -> list[Hypothesis]:
        """The same hypotheses with this evidence too, best first, but for those that spoil what a part of
        them does."""
        kept = (h for h in weighed if not self._degrades(h.effects))
        return sorted((self.with_path(h) for h in kept), key=lambda h: -h.log_weight)

    def with_path(self, h: Hypothesis) -> Hypothesis:
        """The same hypothesis with this evidence too. As far as one effect leads the ship there alone, a
        second is not needed."""
        more = max(0, len(self._causes(h.effects)) - 1)
        extra = self.log_probability(h) - self._complexity * more
        return replace(h, log_evidence=h.log_evidence + extra)

    @cached_property
    def _complexity(self) -> float:
        single = (
            self._path(f.open_loop_error_m, f.expected_error_m)
            for s, f in self.found.items()
            if len(self._causes(s)) == 1
        )
        return max(0.0, COMPLEXITY + max(single, default=-COMPLEXITY))

    def _causes(self, effects: Sets) -> Sets:
        return tuple(name for name in effects if name not in self.weather)

    def _degrades(self, effects: Sets) -> bool:
        """Whether a set leads it farther off than is usual, and than a part of it does: of two that are
        there neither does that, but one that mends the steps of another's form."""
        own, parts = (
            self.found.get(effects),
            (f.open_loop_error_m for s, f in self.found.items() if self._causes(s) and set(s) < set(effects)),
        )
        return (
            own is not None
            and own.open_loop_error_m > own.expected_error_m
            and min(parts, default=np.inf) < (1.0 - DEGRADED) * own.open_loop_error_m
        )

    def _path(self, error: float, expected_m: float) -> float:
        """Log probability of ending so far off where the expected error is all that a true hypothesis would
        leave: two directions, a normal error of unknown size."""
        return -2.0 * self.windows * float(np.log(max(error, expected_m) / expected_m))


def open_loop_check(
    case: Case,
    found: Mapping[Sets, Found],
    weighed: Sequence[Hypothesis],
    before: OpenLoopCheck | None = None,
) -> OpenLoopCheck:
    """Run nothing and every hypothesis that could still be the answer over the held-out parts (`weighed`:
    what is known of all of them by now; one is likelier than where it was found if it leaves to any day what
    another had found). What was asked `before` is not run again."""
    known = {s: f.open_loop_error_m for s, f in before.found.items()} if before else {}
    likely = {s: max((h.log_weight for h in weighed if h.effects == s), default=-np.inf) for s in found}
    best = max(likely.values())
    off = {
        s: known[s] if s in known else held_out_error(case, f)
        for s, f in found.items()
        if not case.causes(s) or likely[s] > best - REACH
    }
    expected_m = before.expected_m if before else expected_errors(case)
    # the expected errors have the others
    irregular = frozenset(
        name for name in case.candidates if case.catalogue[name].irregular and name not in case.present
    )
    levered = {
        s: before.levered[s]
        if s in known and before
        else _levered(case, [found[s].on(i) for i in range(len(case.tracks))], set(s) - case.present)
        for s in off
    }
    ends = {
        s: _expected_error(in_plain_scenario(found[s].hypothesis), expected_m, off[()], irregular, levered[s])
        for s in off
    }
    asked = {s: replace(found[s], open_loop_error_m=m, expected_error_m=ends[s]) for s, m in off.items()}
    windows = min(MAX_WINDOWS, sum((len(t) - 1) * t.h / horizon_s(t, case.model) for t in case.tracks))
    return OpenLoopCheck(asked, expected_m, levered, windows, irregular, frozenset(case.weather))


def expected_errors(case: Case) -> dict[str, float]:
    """[m] by noise scenario: what noise and structure alone would make of the path."""
    levels = _levels(case)
    steps = dict(zip(SCENARIOS, _usual(case, case.scenarios(list(SCENARIOS)), bool(levels)), strict=True))
    # what is run free is a core alone, and as good as it was when nothing was wrong
    level = float(np.exp(np.mean(np.log(levels)))) if levels else _as_once_measured(case, steps["coarse"])
    known = roughly(case)
    return {name: float(np.hypot(level * max(m, steps["coarse"]), known)) for name, m in steps.items()}


def _levels(case: Case) -> list[float]:
    """How much farther off than noise and structure alone have it the ship ended on its reference voyages
    [1], so far ahead as each voyage is predicted; none in a file whose calibration did not compare them."""
    path = path_error_of(case.model.ship)
    levels = [path.level_at(horizon_s(t, case.model)) for t in case.tracks] if path else []
    return [level for level in levels if level is not None]


def _as_once_measured(case: Case, coarse_m: float) -> float:
    """The same where the two were not compared: no nearer than calibration measured."""
    return max(1.0, measured_error_m(case) / coarse_m)


def in_plain_scenario(h: Hypothesis) -> Hypothesis:
    """The same in a noise scenario that is no rougher than on the reference voyages."""
    return (
        h
        if SCENARIOS[h.scenario].plain
        else replace(
            h,
            scenario=next(
                n for n, w in SCENARIOS.items() if w.plain and w.flow == SCENARIOS[h.scenario].flow
            ),
        )
    )


def _expected_error(
    h: Hypothesis,
    expected_m: Mapping[str, float],
    nothing_m: float,
    irregular: frozenset[str],
    levered_m: float,
) -> float:
    """How far off a true hypothesis may be [m]: nature writes an effect otherwise, so a part of what it does
    is left; more of one that comes and goes, or whose side force may attack elsewhere."""
    left = COMES_AND_GOES if irregular.intersection(h.effects) else FORM_MISSES if h.effects else 0.0
    return float(np.hypot.reduce([expected_m[h.scenario], left * nothing_m, levered_m]))


def held_out_error(case: Case, found: Found) -> float:
    """Mean position error [m] with the effects of a hypothesis, each half of the segments predicted with the
    parameters that the other half asks for, about where the hypothesis stands; the water and air of any day
    are there too, as far as they usually go. What changes with the clock is taken as the whole voyage has it:
    no other hour tells of it; and so are the numbers of a voyage alone that has one segment. DataError: no
    part ends where a position was read."""
    chosen = found.hypothesis.effects
    lines, at = standing(case, found)
    every_day = {u.label for u in case.effects if u.every_day}
    day = {label: width for label, width in case.nuisance.daily.items() if label in every_day}
    mine = [i for i, u in enumerate(case.effects) if u.owner in chosen or u.label in day]
    most = np.array(
        [np.inf if u.owner in chosen else ANY_DAY * day.get(u.label, 0.0) / u.sd for u in case.effects]
    )
    normal = innovate(lines, case.scenarios([found.hypothesis.scenario], found.doubt), MOST_SEGMENTS)[0]
    segments = Counter(case.tracks[i].name for i, *_ in normal.where)
    lasts = np.array(
        [
            "t" not in case.catalogue[u.owner].needs and segments.get(u.voyage or "", 2) > 1
            for u in case.effects
        ]
    )
    half = np.arange(len(normal.where)) % 2
    total, count = 0.0, 0
    for side in (0, 1):
        z = found.posterior.z.copy()
        if half.any():
            part = reduce(
                normal.only(half != side), case.nuisance, case.unknowns, case.effects, case.temper, at
            )
            z[lasts] = posterior(given(part, z, ~lasts), chosen).z
        z = np.clip(z, -most, most)
        for i, track in enumerate(case.tracks):
            begins, steps = np.zeros(len(track), bool), np.searchsorted(track.steps(), lines[i].track.steps())
            for _, a, b in (w for w, s in zip(normal.where, half, strict=True) if s == side and w[0] == i):
                begins[steps[a] : steps[b - 1] + 1] = True
            here = case.at(mine, z, track).without_inputs(track.missing())[0]
            errors = _errors(coarse(track, here, horizon_s(track, case.model), leads=1, begins=begins), MODEL)
            total, count = total + float(np.nansum(errors)), count + int(np.isfinite(errors).sum())
    if not count:
        raise too_sparse(case.tracks, case.model)
    return total / count


def _usual(case: Case, noise_models: Sequence[NoiseModel], simulated_alone: bool) -> list[float]:
    """(F,) mean position error [m] of a model that is as good as each of these noise models says, and, unless
    they are `simulated_alone`, no better than on the reference voyages."""
    errors: list[list[np.ndarray]] = [[] for _ in noise_models]
    for track in case.tracks:
        model, horizons = case.model.without_inputs(track.missing())[0], [horizon_s(track, case.model)]
        for mine, windows in zip(
            errors,
            predict_each(track, model, noise_models, horizons, leads=1, simulated_alone=simulated_alone),
            strict=True,
        ):
            mine.append(_errors(windows, STRUCTURE))
    return [max(float(np.nanmean(np.concatenate(mine))), 1e-9) for mine in errors]


def roughly(case: Case) -> float:
    """How far off [m] the forms of effects may leave it that are in the model since it was calibrated: a
    share of where it would be without, and where it would be if their side force attacked elsewhere."""
    left = [share * mean_error_m(case, without) for without, share in added(case.model)]
    return float(np.hypot.reduce([_levered(case, [case.model]), *left]))


def _levered(case: Case, models: Sequence[Model], names: Collection[str] | None = None) -> float:
    """How far off [m] the side forces of a model's effects may leave it that attack elsewhere along it than
    their forms have it. `models`: one, or one of each voyage."""
    left = 0.0
    for of_voyages in zip(*(elsewhere(m, names) for m in models), strict=True):
        there = 0.5 * sum(mean_error_m(case, *moved) ** 2 for moved in zip(*of_voyages, strict=True))
        left += max(0.0, there - mean_error_m(case, *models) ** 2)
    return float(np.sqrt(left))


def mean_error_m(case: Case, *models: Model) -> float:
    """Mean position error [m] over all of the voyages of one model, or of one of each voyage."""
    errors = (
        _errors(coarse(t, m.without_inputs(t.missing())[0], horizon_s(t, case.model), leads=1), MODEL)
        for t, m in zip(case.tracks, models if models[1:] else models * len(case.tracks), strict=True)
    )
    return float(np.nanmean(np.concatenate(list(errors))))


def measured_error_m(case: Case) -> float:
    """Mean position error [m] of the calibrated ship on voyages that it was not fitted to; nothing where no
    calibration measured it."""
    return float(
        once_off(
            case.model.ship, "position_m", np.array([horizon_s(t, case.model) for t in case.tracks])
        ).mean()
    )


def _errors(windows: Windows, run: int) -> np.ndarray:
    """(W,) position errors at the end of each window, NaN where there is none."""
    return np.where(windows.valid[-1], windows.errors(run)["position"][-1], np.nan)
