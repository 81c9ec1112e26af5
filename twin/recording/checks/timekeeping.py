"""Is the file whole, and its clock sound: stamps that repeat, that are rounded, that jump."""

import numpy as np

from twin.live.signals.channels import of_actuators
from twin.num import as_given, num
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good, wrong
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.unknown_controls import CONTROLS, gaps
from twin.recording.voyage import Voyage

FEW = 0.01  # share of repeated stamps that a logger's hiccup explains
UNEVEN = 0.35  # scatter of the steps, in usual steps
GAP_STEPS, GAP_S = 5.0, 5.0


def whole_file(view: VoyageView) -> Check:
    """What of the file was damaged: a log that was cut off or repaired, a part whose checksum does not fit, a
    last line that is torn."""
    lost = view.voyage.meta.get("lost", ())
    if lost:
        return doubtful(
            "whole_file", f"{'; '.join(lost)}. Copy the file again if you can; else what is left is judged."
        )
    return good("whole_file", "nothing of the file is damaged.")


def beats(voyage: Voyage) -> np.ndarray:
    """(M,) when the instrument that speaks most often spoke [s]: every row of a table, and of a log with a
    row for each message those of one instrument, for what two instruments say at one moment is no stamp
    twice."""
    made = {*voyage.meta.get("derived", {}), *voyage.meta.get("constant", ())}
    heard = [np.isfinite(values) for name, values in voyage.columns.items() if name not in made]
    often = max(heard, key=np.count_nonzero, default=np.ones(len(voyage), bool))
    return voyage.time_s[often] if np.count_nonzero(often) > 1 else voyage.time_s


def time_stamps(view: VoyageView) -> Check:
    """Repeated (rounded) stamps, and uneven steps."""
    name, t = "time_stamps", beats(view.voyage)
    steps = np.diff(t)
    repeated = steps <= 0.0
    share, usual = float(np.mean(repeated)), float(np.median(steps))
    mean = float(t[-1] - t[0]) / steps.size
    if share > FEW:
        return wrong(
            name,
            f"{100 * share:.0f} % of the time stamps repeat, the first at "
            f"{as_given(t[np.flatnonzero(repeated)[0]])} s; steps of up to {as_given(steps.max())} s beside "
            f"a mean of {as_given(mean, 6)} s: the stamps are believed to be rounded. In the map: [time] "
            f"rebuild = true (even steps of {as_given(mean, 6)} s), or give more digits.",
        )
    if repeated.any():
        i = int(np.flatnonzero(repeated)[0])
        return doubtful(
            name,
            f"{repeated.sum()} time stamps repeat, the first at {as_given(t[i])} s; such samples are "
            "averaged.",
        )
    inside = steps[steps < GAP_STEPS * usual]
    scatter = float(np.std(inside) / usual)
    if scatter > UNEVEN:
        return doubtful(
            name,
            f"the steps are uneven: {num(inside.min(), 3)} to {num(inside.max(), 3)} s, usually "
            f"{num(usual, 3)} s. "
            "Were the stamps taken at arrival? Log the sensor's own time.",
        )
    return good(name, f"a sample every {as_given(usual, 6)} s, scatter {100 * scatter:.1f} % of a step.")


def time_gaps(view: VoyageView) -> Check:
    """Stretches without any row."""
    name, t = "time_gaps", beats(view.voyage)
    steps = np.diff(t)
    usual = float(np.median(steps[steps > 0.0]))
    limit = max(GAP_STEPS * usual, min(GAP_S, 20.0 * usual))
    gaps = np.flatnonzero(steps > limit)
    if not gaps.size:
        return good(name, f"no step is longer than {num(limit, 3)} s.")
    worst = int(gaps[np.argmax(steps[gaps])])
    return doubtful(
        name,
        f"{gaps.size} gap{'s' * (gaps.size > 1)}, {as_given(steps[gaps].sum(), 6)} s in all, the longest "
        f"{as_given(steps[worst], 6)} s after {as_given(t[worst])} s. Nothing is filled in there; "
        "predictions are not run across them.",
    )


def control_gaps(view: VoyageView) -> Check:
    """Gaps of rudder and shaft in which these changed."""
    parts = of_actuators(view.voyage.columns)
    found = {name: gaps(view.voyage, name) for name in (*CONTROLS, *parts)}
    said = [
        f"{name} changed in {len(g)} gap{'s' * (len(g) > 1)} of {as_given(sum(b - a for a, b in g), 4)} s in "
        f"all, the longest {as_given(b - a, 4)} s after {as_given(a)} s"
        for name, g in found.items()
        if g
        for a, b in [max(g, key=lambda pair: pair[1] - pair[0])]
    ]
    if said:
        return doubtful(
            "control_gaps", f"{'; '.join(said)}. When it changed is not known: nothing is judged there."
        )
    return good("control_gaps", "rudder and shaft changed in no gap of theirs.")


STEPS_S = (
    (3600.0, "an hour"),
    (7200.0, "two hours"),
    (86400.0, "a day"),
    (604800.0, "a week"),
    (1024 * 604800.0, "1024 weeks of the GPS"),
)
NEAR_S = 5.0  # of such a step
WENT_ON = 10.0  # usual ways between two rows: a ship that went no farther did not wait so long


def clock_steps(view: VoyageView) -> Check:
    """A gap of an hour, a day or a week over which the ship went no farther than in a step: the clock was
    set."""
    name, t = "clock_steps", view.voyage.time_s
    steps = np.diff(t)
    usual = float(np.median(steps[steps > 0.0])) if (steps > 0.0).any() else 1.0
    for i in np.flatnonzero(steps > 0.9 * STEPS_S[0][0]):
        said = next((text for size, text in STEPS_S if abs(steps[i] - usual - size) <= NEAR_S + usual), None)
        if said and view.derived("north_m"):
            return cannot_tell(
                name,
                f"{said} without a row after {as_given(t[i])} s, and where the ship was is only summed up of "
                "its velocities: record the position.",
            )
        if said and went_on(view.voyage, int(i), usual):
            return wrong(
                name,
                f"the clock steps by {as_given(steps[i] - usual, 6)} s, {said}, at {as_given(t[i])} s, "
                f"while the ship sails on as if nothing had been: it was set. Take {said} off the stamps "
                "after that row, or cut the file there.",
            )
    return good(name, "the clock makes no step of an hour, a day or a week.")


def went_on(voyage: Voyage, i: int, usual: float) -> bool:
    """Whether the ship was way on and yet moved over a gap no more than it does in a few rows."""
    place = voyage["north_m"] + 1j * voyage["east_m"]
    before = place[max(i - 20, 0) : i + 1]
    after = place[i + 1 : i + 21]
    before, after = before[np.isfinite(before)], after[np.isfinite(after)]
    if before.size < 3 or after.size < 3:
        return False
    way = float(np.median(np.abs(np.diff(np.r_[before])))) + float(np.median(np.abs(np.diff(after))))
    return way > 0.0 and abs(after[0] - before[-1]) < WENT_ON * way and way > 0.02 * usual
