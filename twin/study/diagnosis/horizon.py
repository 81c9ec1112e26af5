"""How far ahead the held-out parts of a voyage are predicted: to where a position was read."""

from collections.abc import Sequence

import numpy as np

from twin.errors import DataError
from twin.num import as_given, num
from twin.physics.model import Model
from twin.study.estimation.start import BRIDGE_S, seen
from twin.study.prediction.openloop import coarse_steps, valid_windows
from twin.study.track.track import Track

HORIZON_S, HORIZON_LENGTHS = 120.0, 10.0  # how far ahead held-out parts are predicted: the shorter of the two


def horizon_s(track: Track, model: Model) -> float:
    """How far ahead a held-out part of this track is predicted [s]; where positions are read more slowly than
    they are bridged, a little less: as far as the most of its parts end at one."""
    most = min(
        HORIZON_S, HORIZON_LENGTHS * float(model.ship.scale("time")), 0.25 * track.h * (len(track) - 1)
    )
    wait = _wait(track)
    if wait <= 1:
        return most
    steps = coarse_steps(track, model)
    longest = steps * max(1, int(most / track.h / steps))
    leads = range(longest, max(0, longest - steps * wait), -steps)
    return track.h * max(leads, key=lambda lead: valid_windows(track, lead))


def mean_horizon_s(tracks: Sequence[Track], model: Model) -> float:
    """How far ahead the mean error of these tracks looks [s]: the mean over the parts that are judged of all
    of them, each as far as its own track has it."""
    ahead = [horizon_s(t, model) for t in tracks]
    if len(set(ahead)) == 1:
        return ahead[0]
    count = [valid_windows(t, round(h / t.h)) for t, h in zip(tracks, ahead, strict=True)]
    return float(np.average(ahead, weights=count))


def where_read(tracks: Sequence[Track], horizons_s: Sequence[float]) -> list[float]:
    """The same of any times ahead [s] at which several tracks are judged together: where positions of all of
    them are read more slowly than they are bridged, each as far as the most parts end at one, less those by
    which none does."""
    waits = [_wait(t) for t in tracks]
    if min(waits) <= 1:
        return list(horizons_s)
    step_s, wait_s = min(t.h for t in tracks), max(w * t.h for w, t in zip(waits, tracks, strict=True))
    found = []
    for horizon in horizons_s:
        longest = max(1, round(horizon / step_s))
        leads = range(longest, max(0, longest - int(np.ceil(wait_s / step_s))), -1)
        count = {k: sum(valid_windows(t, round(k * step_s / t.h)) for t in tracks) for k in leads}
        best = max(leads, key=lambda k: count[k])
        if count[best]:
            found.append(horizon if best == longest else best * step_s)
    return sorted(set(found))


def require_positions(tracks: Sequence[Track], model: Model) -> None:
    """DataError where no part of any track ends, so far ahead, where a position was read."""
    if not any(valid_windows(t, round(horizon_s(t, model) / t.h)) for t in tracks):
        raise too_sparse(tracks, model)


def too_sparse(tracks: Sequence[Track], model: Model) -> DataError:
    """What is said of voyages on which nobody can say how far off a prediction ends."""
    names, ahead = ", ".join(t.name for t in tracks), min(horizon_s(t, model) for t in tracks)
    count, sailed_s = sum(_placed(t).size for t in tracks), sum(t.h * len(t) for t in tracks)
    return DataError(
        f"{names}: place and heading are read together {count} times in {num(sailed_s, 3)} s, and never "
        f"{num(ahead)} s apart with the controls known between: how far off a prediction ends cannot be "
        f"judged. Record both at least every {as_given(BRIDGE_S)} s."
    )


def _wait(track: Track) -> int:
    """Grid steps from one place and heading to the next, usually [count]."""
    return int(np.median(np.diff(_placed(track), prepend=0, append=len(track))))


def _placed(track: Track) -> np.ndarray:
    """(P,) the steps at which place and heading were read, short holes bridged."""
    return np.flatnonzero(np.isfinite(seen(track)[:, :3]).all(1))
