"""Predictions of what a fit did not see, before and after a change: of other voyages, or of every part of the
same ones in turn."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from twin.physics.model import Model
from twin.study.diagnosis.horizon import require_positions, where_read
from twin.study.prediction.left_out import horizons
from twin.study.prediction.openloop import Windows
from twin.study.prediction.own_water import settled, shown_best
from twin.study.prediction.path_prior import errors_of
from twin.study.reference.path_error import PathError
from twin.study.reference.sailed import fed
from twin.study.track.track import Track
from twin.study.update.adding import FOLDS, Fitted, ahead, lasting, part_of

HORIZONS_HELD = 2.0  # times that a voyage must hold a horizon to be judged at it
Judging = tuple[np.ndarray, float]  # covariance of the error so far ahead, by which a stream is known


@dataclass(frozen=True)
class HeldParts:
    """Predictions of the held-out tracks: as they are shown, and as they are judged, with the stream that
    each voyage had shown by then."""

    before: list[Windows]
    after: list[Windows]
    judged_before: list[Windows]
    judged_after: list[Windows]
    errors: PathError
    horizons_s: list[float]  # that are judged
    shown_s: list[float]  # and that are shown


def predicted(
    made: Fitted, tracks: Sequence[Track], shown_s: Sequence[float], cross_validated: bool = False
) -> HeldParts:
    """Of every track (`shown_s`: horizons of the table, beside those that are judged); `cross_validated`: the
    tracks are those of the fit. DataError: positions are read too seldom to judge a prediction by.

    Effects of the voyage are judged for what they are where nothing else was named, without any other stream.
    Beside lasting effects they are not judged: the stream that the held-out voyage shows stands in their
    place."""
    base = made.case.model
    models = made.of_parts() if cross_validated else [made.model]
    held_s = horizons(base, tracks, 1.0 / HORIZONS_HELD)
    if not (judged_s := where_read(tracks, held_s)):
        require_positions(tracks, base)
        judged_s = held_s
    table_s = where_read(tracks, shown_s) or judged_s
    asked = sorted({*judged_s, *table_s})
    errors = errors_of(base.ship, tracks, asked)
    before, after = (_each(tracks, some, asked) for some in ([base] * len(models), models))
    if not lasting(made.names):
        return HeldParts(before, after, before, after, errors, judged_s, table_s)
    middle = shown_best(judged_s, base)
    own = [_lasting(base, m, made.names) for m in models]
    known_before, known_after = (
        _each(tracks, some, asked, (errors.at(middle), middle)) for some in ([base] * len(models), own)
    )
    return HeldParts(before, after, known_before, known_after, errors, judged_s, table_s)


def _lasting(base: Model, model: Model, names: Sequence[str]) -> Model:
    """The model with those of the named effects that do not belong to the voyage."""
    return base.but(*(e for e in model.effects if type(e).__name__ in lasting(names)))


def _each(
    tracks: Sequence[Track], models: Sequence[Model], asked: Sequence[float], judging: Judging | None = None
) -> list[Windows]:
    """One set of windows for each track; with several models each part of a track is predicted by its own."""
    by_model = [ahead(tracks, m, asked) for m in models]
    if judging is not None:
        by_model = [
            [settled(w, fed(m, w.track)[0], *judging).windows for w in ws]
            for m, ws in zip(models, by_model, strict=True)
        ]
    return [_joined(list(of_track)) for of_track in zip(*by_model, strict=True)]


def _joined(windows: Sequence[Windows]) -> Windows:
    """The windows of each part by its own model; those that end in another part are not judged."""
    first, *others = windows
    if not others:
        return first
    steps = len(first.track)
    begins, ends = (
        np.array([[part_of(s, steps) for s in row] for row in np.atleast_2d(at)])
        for at in (first.start, first.step)
    )
    promised = np.select([(begins[0] == k)[:, None] for k in range(FOLDS)], [w.promised for w in windows])
    return replace(first, promised=promised, valid=first.valid & (begins == ends))
