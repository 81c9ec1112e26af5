"""What is left when the best explanation holds: as little as on the reference voyages, or more, so that
something else is at work.

Of all hypotheses one is the best, also when none is true: two effects that nobody sailed with explain almost
any third. When it is the truth, what remains is what remained on the reference voyages. When it only looks
like it, the ship stays restless, or does not go where it leads her."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from twin.physics.model import Model
from twin.study.diagnosis.case import WORLDS, Case
from twin.study.diagnosis.led import FORM, roughly
from twin.study.diagnosis.own_force import leads_her, otherwise, without
from twin.study.diagnosis.refine import Found, Sets, standing
from twin.study.diagnosis.verdict import ALIKE, SURE, of_the_sea
from twin.study.estimation.respond import respond, standard
from twin.study.reference.evidence import Hypothesis, posterior
from twin.study.reference.seaway import at_sea

MOSTLY = 1.0 / 3.0  # of the error without it that may be left whatever else is
# times the floor that an answer may end away from where she went, one that names a cause if it leads her some
# of the way
ASTRAY = 2.0
NEARLY = 1.5  # and if it does not
# of the error without it: what she may be left with, and as long as others may do better
SOME, HALF = 0.75, 0.5
TOSSED = 0.1  # share by which she may end farther off where the sea's own force is known, which is chance
BETTER = 0.05  # share by which a force must bring her nearer to where she went
RESTLESS = 4  # times the fast part of the floor
FACTORS = np.array([1, 2, 4, 8, 16, 32])
SURELY = 3.0  # standard deviations of an instrument's fault from none
UNDONE = 0.5  # of what either fault alone does to where she is seen, that two together must do
CHANGED = 2.0  # standard deviations of its form by which a number must differ from what the ship's file has
CLEAR = 3.0  # log evidence by which the voyages must be restless
# log evidence that no force known roughly was seen to mislead to: 21 at most in fifty voyages; true effects
# had 130 and more
BEYOND = 60.0
# share of the path's floor that is due to forces known only roughly, from which they matter
ROUGHLY = 1.0 / 3.0


def answer(
    case: Case, weighed: Sequence[Hypothesis], found: Mapping[Sets, Found], chosen: Sets, strict: bool = False
) -> Sets:
    """The effects of a set that explain the voyages: all of them, if each force is what its name says; those
    without which the others do as well, if one is not (of two forms that are only roughly right, one mends
    the other); or none, unless all of them lead her where she went and the model alone does not. (`strict`:
    as `explains`.)"""
    if not chosen or not explains(case, weighed, found[chosen], found[()], strict):
        return ()
    odd = otherwise(case, found[chosen], found[()])
    rest = tuple(name for name in chosen if name not in odd)
    alone = () if not odd or rest not in found else answer(case, weighed, found, rest, strict)
    return chosen if not odd or (not alone and leads_her(found[chosen], found[()])) else alone


def explaining(case: Case, weighed: Sequence[Hypothesis], found: Mapping[Sets, Found]) -> Sets:
    """The effects that explain the voyages: those of the best hypothesis (`answer`), or, where these leave
    too much, of a part of it that cannot be told from it and leaves no more than it may."""
    best = weighed[0]
    close = (
        h.effects
        for h in weighed
        if best.log_weight - h.log_weight < ALIKE
        and set(h.effects) <= set(best.effects)
        and h.effects in found
    )
    return next((told for part in dict.fromkeys(close) if (told := answer(case, weighed, found, part))), ())


def explains(
    case: Case, weighed: Sequence[Hypothesis], found: Found, nothing: Found, strict: bool = False
) -> bool:
    """Whether no more is left under this hypothesis than a true one would leave (`weighed`: all of them, best
    first). It is explanation enough to lead her most of the way to where she went; a sea that was measured
    may be the reason for more, and a stream that changes for restlessness, which counts only where it leads
    her astray. As long as others may do better (`strict`), more is asked. What is so unlikely that nobody
    asked where it leads her explains nothing."""
    if np.isnan(found.off_m):
        return False
    if found.off_m <= MOSTLY * nothing.off_m or any(at_sea(t, case.model) for t in case.tracks):
        return True
    own = [h for h in weighed if h.effects == found.hypothesis.effects]
    plain = next((h for h in own if WORLDS[h.world].plain), None)
    if (
        plain is None
        or found.off_m
        > (ASTRAY if found.off_m <= (HALF if strict else SOME) * nothing.off_m else NEARLY) * found.floor_m
    ):
        return False
    # a rough world that leads her astray nowhere is none
    if own[0].log_weight - plain.log_weight > CLEAR and not found.off_m <= found.floor_m:
        return False
    return (
        (found.off_m <= found.floor_m and not strict) or WORLDS[plain.world].flow > 1.0 or quiet(case, found)
    )


def missed(nothing: Found) -> bool:
    """Whether the model alone leads her clearly farther from where she went than it did when nothing was
    wrong: nobody may say then that nothing is missing."""
    return nothing.off_m > NEARLY * nothing.floor_m


def helpful(case: Case, found: Mapping[Sets, Found], chosen: Sets) -> list[str]:
    """Those of a set of effects with which she is led better than without, as `twin add` will ask; one that
    only changes what the instruments read need not lead her, but one of its numbers must be clear."""
    return [
        n
        for n in chosen
        if (_clear if case.catalogue[n].kind == "SensorFault" else _leads)(case, found, chosen, n)
    ]


def asked_for(
    case: Case, found: Mapping[Sets, Found], sure: Mapping[str, float], names: Sequence[str], rough: bool
) -> list[str]:
    """Those of some effects that the path, the readings of an instrument, or a probability of its own asks
    for: where the model alone leads her within what is usual, no force is named for a group that it belongs
    to; in `rough` weather (`weathered`), where it does not lead her clearly astray, none but the sea's own
    (`too_small`). A change of what the model has must be asked for by the readings as well: led by the file's
    own numbers she ends astray wherever these were found in another wind (that from ahead turns her otherwise
    than one from abeam); and it must be more than its form may be off (`changed`)."""
    names = [
        n
        for n in names
        if n not in case.present or (_read(found, n, CLEAR) and changed(case, found[(n,)], n))
    ]
    return [
        n for n in names if case.catalogue[n].kind == "SensorFault" or _asked(case, found, sure[n], n, rough)
    ]


def changed(case: Case, found: Found, name: str) -> bool:
    """Whether an effect is other than the ship's file has it by more than nature may write it otherwise in
    another manoeuvre: a gear that was found as a dead time and half a second of easing is the same gear with
    less of the one and more of the other."""
    if name not in case.present:
        return True
    form = {p.name: p.form for p in case.catalogue[name].params()}
    moved = ((u, u.sd * z) for u, z in zip(case.effects, found.posterior.z, strict=True) if u.owner == name)
    return any(abs(by) > CHANGED * form[u.name] * abs(u.centre) for u, by in moved)


def _asked(case: Case, found: Mapping[Sets, Found], sure: float, name: str, rough: bool) -> bool:
    nothing, misled = found[()], _misled(case, found, name, rough)
    led = not missed(nothing) if misled else nothing.off_m <= nothing.floor_m
    return not led or (sure >= SURE and (not misled or of_the_sea(case, name)))


def _misled(case: Case, found: Mapping[Sets, Found], name: str, rough: bool) -> bool:
    """Whether weather may be what the readings take for this effect: any sea; of forces that are known
    roughly, what does not stand far above all that they were ever seen to mislead to."""
    return rough and (any(at_sea(t, case.model) for t in case.tracks) or not _read(found, name, BEYOND))


def _read(found: Mapping[Sets, Found], name: str, by: float) -> bool:
    """Whether the readings, one step ahead, ask for an effect by so much log evidence."""
    return (name,) in found and found[(name,)].hypothesis.log_weight > found[()].hypothesis.log_weight + by


def weathered(case: Case, nothing: Found) -> bool:
    """Whether weather may mislead: a sea, or forces known only roughly that matter to where she went."""
    return any(at_sea(t, case.model) for t in case.tracks) or roughly(case) > ROUGHLY * nothing.floor_m


def too_small(case: Case, found: Mapping[Sets, Found], chosen: Sets, rough: bool) -> bool:
    """Whether a single effect cannot show in where she went, for she is led there with it and without: then
    the readings decide. In `rough` weather they do of the sea's own force alone: of others, they take a
    wave's pull for a ship's."""
    single = case.news(chosen)
    if (
        len(single) != 1
        or case.catalogue[single[0]].kind == "SensorFault"
        or not max(found[chosen].off_m, found[()].off_m) <= found[chosen].floor_m
    ):
        return False
    return of_the_sea(case, single[0]) or not _misled(case, found, single[0], rough)


def undone(case: Case, found: Found) -> bool:
    """Whether two faults of the instruments mostly take back what each does to where she is seen. Two that
    are there do not agree so; a little of another kind, which adds up in her place, is easily written like
    that (a late position and an antenna ahead, at an even speed)."""
    chosen = found.hypothesis.effects
    if len(chosen) < 2 or any(case.catalogue[name].kind != "SensorFault" for name in chosen):
        return False
    both, *each = (
        _shown(case, model)
        for model in (found.model, *(without(found.model, case.model, name) for name in chosen))
    )
    return both < UNDONE * min(each)


def _shown(case: Case, model: Model) -> float:
    """How far a model moves the place that the satellites show, over all that was read of the voyages [m]."""
    moved = 0.0
    for line in case.lines:
        there, before = (
            respond(line.track, m.without_inputs(line.track.missing())[0])[1][:, :2]
            for m in (model, case.model)
        )
        moved += float(np.square(there - before).sum())
    return float(np.sqrt(moved))


def _clear(case: Case, found: Mapping[Sets, Found], chosen: Sets, name: str) -> bool:
    """Whether one number of an effect is surely not that of none. Two that together are may be no fault at
    all: what a late position with as late a compass leaves over is the form of the ship's own sway."""
    own = np.array([i for i, u in enumerate(case.effects) if u.owner == name])
    known = found[chosen].posterior
    return bool((np.abs(known.z[own]) > SURELY * np.sqrt(np.diag(known.covariance)[own])).any())


def _leads(case: Case, found: Mapping[Sets, Found], chosen: Sets, name: str) -> bool:
    """Whether a force brings her nearer to where she went; one that comes and goes hardly can, for what it
    does not explain tosses her on: it leads her no farther off."""
    without, better = (
        found.get(tuple(n for n in chosen if n != name)),
        -TOSSED if of_the_sea(case, name) else BETTER,
    )
    return without is None or not found[chosen].off_m > (1.0 - better) * without.off_m


def quiet(case: Case, found: Found) -> bool:
    """Whether the voyages are, under this hypothesis, as quiet as the reference voyages, but for what its
    form may miss of its force from moment to moment."""
    lines, at = standing(case, found)
    forces = np.concatenate(
        [np.broadcast_to(line.doubted, (len(line.track), 3)) for line in lines]
    ) / standard(case.model)
    usual = np.hypot(case.white, FORM * np.sqrt(np.mean(forces**2)))
    world = found.hypothesis.world if WORLDS[found.hypothesis.world].plain else "coarse"
    floors = [replace(f, white=tuple(k * usual)) for f in case.worlds([world], found.doubt) for k in FACTORS]
    says = np.array(
        [posterior(r, found.hypothesis.effects).log_evidence for r in case.reduced(lines, floors, at)]
    )
    return bool(says[FACTORS >= RESTLESS].max() < says[FACTORS < RESTLESS].max() + CLEAR)
