"""Do the propeller's turns fit the ship's speed?    J = U / (n D)"""

import numpy as np

from twin.num import as_given, num
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good, wrong
from twin.recording.checks.voyage_view import VoyageView

SLOWEST_RPM = 20.0  # no propeller drives a ship with fewer turns
ADVANCE = (0.08, 2.0)  # plausible J = U / (n D) of a ship under way

ADVANCE_MISTAKES = (
    (1.0 / 60.0, 'the turns are in 1/s (in the map: unit = "1/s")', "a larger"),
    (np.pi / 30.0, 'the turns are in rad/s (in the map: unit = "rad/s")', "a larger"),
    (60.0, "the turns are 60 times too large (converted twice)", "a smaller"),
)


def propeller_rate(view: VoyageView) -> Check:
    """Turns against speed: by the advance ratio of a known ship, else by what any propeller does."""
    name = "propeller_rate"
    if not np.isfinite(view.si("propeller_rate_rpm")).any():
        return cannot_tell(name, view.not_recorded("shaft"))
    driven = under_way(view)
    if driven is None:
        return cannot_tell(name, "the ship is hardly ever under way with its propeller turning.")
    way, rate = driven
    if view.ship is not None:
        return advance(name, way, rate, float(view.ship.D_P))
    if 60.0 * rate < SLOWEST_RPM:
        return wrong(
            name,
            f"the ship makes {way:.2f} m/s with {num(60 * rate, 3)} turns a minute, {way / rate:.1f} m a "
            "turn: "
            "no propeller does; "
            'the column is believed to be in 1/s. In the map: unit = "1/s" for it (with --ship this is '
            "computed).",
        )
    return good(
        name,
        f"{num(60 * rate, 3)} rpm at {way:.2f} m/s, {way / rate:.2f} m a turn; with --ship this is checked "
        "closer.",
    )


def under_way(view: VoyageView) -> tuple[float, float] | None:
    """Usual speed [m/s] and turns [1/s] with the shaft driving; None where it hardly ever does."""
    n, speed = np.abs(view.si("propeller_rate_rpm")), np.abs(view.velocity)
    driven = thrust_on(view, n) & (speed > 0.5 * view.speed) & (view.velocity.real > 0.0)
    if np.count_nonzero(driven) < 10 or view.speed < 0.05 or not view.way_on:
        return None
    return float(np.median(speed[driven])), float(np.median(n[driven]))


def thrust_on(view: VoyageView, n: np.ndarray) -> np.ndarray:
    """(N,) mask. where the shaft turns and the ship keeps its speed: one that runs out with its shaft
    stopped says nothing of its unit."""
    usual = float(np.nanquantile(n, 0.9))
    signed = view.si("propeller_rate_rpm")
    signed = signed[np.isfinite(signed)]
    scatter = float(np.median(np.abs(np.diff(signed)))) if signed.size > 2 else 0.0
    turns = (n > max(0.5 / 60.0, 0.3 * usual)) & (usual > 4.0 * scatter)
    span = max(round(30.0 / view.step_s), 1)
    speed = np.abs(view.velocity)
    ahead = np.r_[speed[span:], np.full(min(span, speed.size), np.nan)][: speed.size]
    with np.errstate(invalid="ignore"):
        kept = ~(ahead < 0.9 * speed)
    return turns & kept


def advance(name: str, way: float, rate: float, diameter: float) -> Check:
    """What an advance ratio says of the units: `way` [m/s], `rate` [1/s], `diameter` [m]."""
    low, high = ADVANCE
    j = way / (rate * diameter)
    saw = f"advance ratio J = U/(nD) = {num(way, 3)}/({num(rate, 3)} x {num(diameter, 3)}) = {num(j, 3)}"
    if low <= j <= high:
        return good(name, f"{saw}, as a ship under way has it.")
    mistake = believed(j)
    if mistake is not None:
        factor, said, other = mistake
        return wrong(
            name,
            f"{saw}; {num(j * factor, 2)} if {said}: that is believed, unless the file is of {other} ship.",
        )
    return doubtful(
        name,
        f"{saw}, expected {as_given(low)} to {as_given(high)}: another ship's file, a wrong unit, or a "
        "wrong diameter?",
    )


def believed(j: float) -> tuple[float, str, str] | None:
    """The mistake of unit that explains an advance ratio: its factor on it, its words, the other ship."""
    return next((m for m in ADVANCE_MISTAKES if 0.25 <= j * m[0] <= 1.4), None)


def with_believed_turns(view: VoyageView) -> VoyageView:
    """The view with the turns that its ship's advance ratio makes believe; the same where none are."""
    driven = under_way(view)
    if view.ship is None or driven is None:
        return view
    mistake = believed(driven[0] / (driven[1] * float(view.ship.D_P)))
    if mistake is None:
        return view
    columns = dict(view.voyage.columns)
    columns["propeller_rate_rpm"] = columns["propeller_rate_rpm"] / mistake[0]
    return VoyageView(view.voyage.with_rows(view.voyage.time_s, columns), view.ship)
