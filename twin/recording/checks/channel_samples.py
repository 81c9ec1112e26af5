"""Single channels: samples that are missing, implausible, alone, or that stand still while the ship moves."""

from collections.abc import Iterator

import numpy as np

from twin.live.signals.channels import BY_NAME, of_actuators
from twin.num import as_given
from twin.physics.actuators import KINDS
from twin.physics.ship import Ship
from twin.recording.checks.check_result import Check, doubtful, good, wrong
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.out_of_range import out_of_range_in_words, where_most_lie
from twin.recording.samples import spikes as spike_rows
from twin.recording.units import unit_of
from twin.recording.unknown_controls import CONTROLS, of_ship
from twin.recording.voyage import Voyage

JUMPY = frozenset(
    ("rudder_angle_deg", "propeller_rate_rpm", "true_wind_direction_deg", "apparent_wind_angle_deg")
)
# orders jump, and a light wind comes from anywhere: a lonely sample of these is no sign of a bad sensor
ABEAM = 0.25  # of a turn from amidships: beyond it no rudder and no nozzle stands


def missing_samples(view: VoyageView) -> Check:
    """Holes and tails longer than a channel may be old."""
    v = view.voyage
    found = [text for name in v.columns if (text := hole(v, name))]
    absent = ", ".join(name for name in v.absent() if not _follows(v, name)) or "nothing"
    if found:
        return doubtful(
            "missing_samples",
            f"{'; '.join(found)}. Nothing is filled in there; of wind, waves, depth, banks, draught and roll "
            "the study takes what was read last or next, and a line between the two. Absent altogether: "
            f"{absent}.",
        )
    return good(
        "missing_samples",
        f"no channel is without a sample for longer than it may be old. Absent altogether: {absent}.",
    )


def _follows(v: Voyage, name: str) -> bool:
    """Whether an absent channel is found from others: the true wind from the apparent one and its own
    motion."""
    return (
        name.startswith("true_wind_")
        and v.has("apparent_wind_speed_mps")
        and v.has("apparent_wind_angle_deg")
    )


def hole(v: Voyage, name: str) -> str:
    """The longest stretch without a sample of a channel that has some, if longer than it may be old."""
    at = np.flatnonzero(np.isfinite(v[name]))
    if not at.size:
        return ""
    limit = max(BY_NAME[name].stale_s, 5.0 * v.step_s)
    edges = np.r_[v.time_s[0], v.time_s[at], v.time_s[-1]]
    gaps = np.diff(edges)
    i = int(np.argmax(gaps))
    if gaps[i] <= limit:
        return ""
    where = "begins late," if i == 0 else "ends early," if i == gaps.size - 1 else "has a hole,"
    return f"{name} {where} {as_given(gaps[i], 4)} s from {as_given(edges[i])} s"


def plausible_values(view: VoyageView) -> Check:
    """What reading blanked because no ship measures it, and rudders that stand where none can."""
    lost, (never, beyond) = lost_controls(view), beyond_amidships(view)
    if lost or never:
        return wrong("plausible_values", " ".join([*lost, *never]))
    notes = [n for n in view.voyage.meta.get("notes", ()) if "blanked" in n]
    if beyond or any("outside" in n for n in notes):
        said = "; ".join([*notes, *beyond])
        return doubtful(
            "plausible_values",
            f"{said}{'.' * (not said.endswith('?'))} In the map: unit, or [file] missing = [...].",
        )
    return good("plausible_values", "; ".join(notes) or "every sample is one that a ship can have.")


def lost_controls(view: VoyageView) -> list[str]:
    """A sentence for each control that the ship file needs (without one: that was recorded) of which reading
    blanked most samples, for they lie outside what a ship can have."""
    v = view.voyage
    outside, units = v.meta.get("out_of_range", {}), v.meta.get("units", {})
    needed = of_ship(view.ship) if view.ship else (*CONTROLS, *of_actuators(outside))
    return [out_of_range_in_words(n, outside[n], units.get(n)) for n in needed if n in outside]


def beyond_amidships(view: VoyageView) -> tuple[list[str], list[str]]:
    """What stands to either side of amidships, and was recorded beyond ABEAM: a sentence for each of which
    most samples lie there, and one for each of which some do."""
    most, some = list[str](), list[str]()
    for name, what in _to_either_side(view.ship):
        x, ch = view.voyage[name], BY_NAME[name]
        beyond = np.abs(np.mod(x / ch.turn + 0.5, 1.0) - 0.5) > ABEAM
        if not beyond.any():
            continue
        low, high, limit = (as_given(y, 3) for y in (min(x[beyond]), max(x[beyond]), ABEAM * ch.turn))
        text = (
            f"{name}: {np.count_nonzero(beyond)} of {np.count_nonzero(np.isfinite(x))} samples, {low} to "
            f"{high}, more than {limit} {unit_of(name)} from amidships, where no {what} stands"
        )
        if where_most_lie(x, beyond) is None:
            some.append(text)
        else:
            most.append(f"{text}. In the map: the right unit, and an offset that leaves amidships at 0.")
    return most, some


def _to_either_side(ship: Ship | None) -> Iterator[tuple[str, str]]:
    """The channel of each angle that is counted as a rudder's, and what it is the angle of."""
    for a in ship.actuators if ship is not None else ():
        kind = KINDS[a.kind]
        for name, attribute in zip(a.columns(), a.attributes, strict=True):
            if attribute == "angle" and not kind.all_round:
                yield name, kind.turned or kind.noun


def spikes(view: VoyageView) -> Check:
    """One or two samples that leave the line and come back."""
    found = []
    for name in (n for n in view.voyage.columns if n not in JUMPY):
        values = view.voyage.columns[name]
        rows = spike_rows(values, BY_NAME[name].period)
        if rows.size:
            i = int(rows[0])
            found.append(
                f"{name} {rows.size}, first {as_given(values[i], 4)} at {as_given(view.voyage.time_s[i])} s"
            )
    if found:
        return doubtful(
            "spikes", f"isolated samples: {'; '.join(found)}. In the map: despike = true blanks them."
        )
    return good("spikes", "no isolated samples.")


def frozen(view: VoyageView) -> Check:
    """Channels that stand still, to the last digit, while another one says that they cannot."""
    found = [
        text for f in (frozen_heading, frozen_position, frozen_speed, frozen_yaw_rate) if (text := f(view))
    ]
    if found:
        return doubtful("frozen", f"{'; '.join(found)}. A frozen sensor: blank this stretch, or cut it off.")
    return good("frozen", "nothing stands still that should move.")


def frozen_heading(view: VoyageView) -> str:
    """The longest stretch on which the heading stands still while the yaw rate turns the ship; "": none."""
    turned = running(view, view.si("yaw_rate_degps")) if not view.derived("yaw_rate_degps") else None
    return standing(
        view, "heading_true_north_deg", turned, np.radians(5.0), "the yaw rate turns {:.0f} deg", 180 / np.pi
    )


def frozen_yaw_rate(view: VoyageView) -> str:
    """The same of the yaw rate, while the heading turns otherwise."""
    r = view.si("yaw_rate_degps")
    rest = view.psi - running(view, r)
    return standing(
        view, "yaw_rate_degps", rest, np.radians(5.0), "the heading turns {:.0f} deg otherwise", 180 / np.pi
    )


def frozen_position(view: VoyageView) -> str:
    """The same of the position, while the velocities move the ship."""
    if view.derived("north_m", "surge_velocity_mps"):
        return ""
    w = view.velocity * np.exp(1j * view.psi)
    far = max(5.0, 20.0 * view.speed * view.step_s)
    north = standing(view, "north_m", running(view, w.real), far, "the ship sails {:.0f} m north or south")
    return north or standing(
        view, "east_m", running(view, w.imag), far, "the ship sails {:.0f} m east or west"
    )


def frozen_speed(view: VoyageView) -> str:
    """The same of the speed, while the position moves otherwise."""
    if view.derived("north_m", "surge_velocity_mps"):
        return ""
    rest = view.place - running(view, view.velocity * np.exp(1j * view.psi))
    far = max(10.0, 20.0 * view.speed * view.step_s)
    return standing(
        view, "surge_velocity_mps", np.abs(rest - rest[0]), far, "the position moves {:.0f} m otherwise"
    )


def running(view: VoyageView, rate: np.ndarray) -> np.ndarray:
    """(N,) the rate summed from the start, missing samples as zero. In the unit of the rate (N,) times s."""
    return np.cumsum(np.where(np.isfinite(rate), rate, 0.0)) * view.step_s


def standing(
    view: VoyageView, name: str, other: np.ndarray | None, far: float, text: str, unit: float = 1.0
) -> str:
    """The longest stretch of one same value of `name` in which `other` changes by more than `far`. `other`
    (N,) and `far` in one unit, which the text shows times `unit`."""
    x = view.even[name]
    if other is None or x.size < 20 or not np.isfinite(x).any():
        return ""
    with np.errstate(invalid="ignore"):
        moves = np.abs(np.diff(x)) > 1e-9 * np.nanmax(np.abs(x))
    # what is not there does not stand still
    starts = np.flatnonzero(np.r_[True, moves | np.diff(np.isfinite(x))])
    ends = np.r_[starts[1:], x.size] - 1
    long = (ends - starts >= 10) & np.isfinite(x[starts])
    moved = [spread(other[a : b + 1]) if ok else 0.0 for a, b, ok in zip(starts, ends, long, strict=True)]
    i = int(np.argmax(moved))
    if not moved[i] > far:
        return ""
    t = view.even.time_s
    said = text.format(moved[i] * unit)
    return (
        f"{name} stays {as_given(x[starts[i]], 6)} from {as_given(t[starts[i]], 4)} to "
        f"{as_given(t[ends[i]], 4)} s while {said}"
    )


def spread(x: np.ndarray) -> float:
    """Between the largest and the smallest sample that are there. x (N,), in its own unit."""
    x = x[np.isfinite(x)]
    return float(np.ptp(x)) if x.size else 0.0
