"""Do rudder and propeller act on this ship as their signs and units say?

    dr/dt = b U^2 delta - a U r - d |r| r + c   with b > 0: a rudder to starboard turns the ship to starboard

Nomoto's first order, its gains as they grow with speed, and Norrbin's cubic damping in its quadratic form.
"""

import numpy as np

from twin.study.checks.answer import Check, cannot_tell, doubtful, good, wrong
from twin.study.checks.view import View, fit, rms

RUDDER_SHARE = 0.3  # the rudder must explain this share of the changes of yaw rate to be asked for its sign
PROOF_SHARE = 0.5  # and this share to prove it
LEAST_RUDDER_DEG = 0.7  # a ship that manoeuvres with less than this has it in radians
SLOWEST_RPM = 20.0  # no propeller drives a ship with fewer turns
ADVANCE = (0.08, 2.0)  # plausible J = U / (n D) of a ship under way


def rudder_sign(view: View) -> Check:
    """The sign of b, over the window length at which the rudder explains most."""
    name = "rudder_sign"
    rudder, r = view.si("rudder_angle_deg"), view.si("yaw_rate_degps")
    r = np.where(view.velocity.real > 0.2 * view.speed, r, np.nan)  # astern the rudder works the other way
    lengths = view.step_s * np.array([2, 5, 10, 20, 40, 80, 160])
    share, b = max((rudder_gain(view, rudder, r, w) for w in lengths if w < view.voyage.duration_s / 10.0), default=(0.0, 0.0))
    if share < RUDDER_SHARE or rms(rudder) == 0.0:
        return cannot_tell(
            name, f"the rudder explains {100 * share:.0f} % of the changes of yaw rate; a zigzag or a turn would show it."
        )
    saw = f"the rudder explains {100 * share:.0f} % of the changes of yaw rate"
    if b > 0.0:
        return good(name, f"{saw}, and turns the ship to its own side.")
    text = f"{saw}, and turns the ship to the other side: it is believed to be positive to port. In the map: sign = -1 for it."
    return wrong(name, text) if share > PROOF_SHARE else doubtful(name, text)


def rudder_gain(view: View, rudder: np.ndarray, r: np.ndarray, seconds: float) -> tuple[float, float]:
    """(share of the changes of r that the rudder explains beside r itself, b)."""
    first, last = view.windows(seconds)
    change, speed = r[last] - r[first], np.abs(view.velocity)
    held = view.summed(rudder * speed**2, first, last)
    damping = [view.summed(speed * r, first, last), view.summed(np.abs(r) * r, first, last), np.ones(first.size)]
    both = np.isfinite(change) & np.isfinite(held) & np.isfinite(damping[0])
    if np.count_nonzero(both) < 10:
        return 0.0, 0.0
    others = [x[both] for x in damping]
    x, error, left = fit([held[both], *others], change[both])
    without = fit(others, change[both])[2]
    if without <= 0.0 or abs(x[0]) < 4.0 * error[0]:
        return 0.0, 0.0
    return float(1.0 - left / without), float(x[0])


def rudder_unit(view: View) -> Check:
    """A ship that turns far with a rudder of less than a degree has it in radians."""
    name = "rudder_unit"
    most = float(np.nanmax(np.abs(view.voyage["rudder_angle_deg"])))
    swung = float(np.degrees(np.nanmax(view.psi) - np.nanmin(view.psi)))
    if most == 0.0:
        return cannot_tell(name, "the rudder is 0 all the time.")
    if most >= LEAST_RUDDER_DEG:
        return good(name, f"the rudder reaches {most:.1f} deg.")
    if swung < 20.0:
        return cannot_tell(name, f"the rudder stays within {most:.2g} deg, and the heading within {swung:.0f} deg.")
    return wrong(
        name,
        f"the rudder stays within {most:.2g} 'deg' while the heading swings {swung:.0f} deg: it is believed to be in "
        'radians. In the map: unit = "rad" for it.',
    )


def propeller_rate(view: View) -> Check:
    """Turns against speed: by the advance ratio J = U / (n D) of a known ship, else by what any propeller does."""
    name = "propeller_rate"
    n, speed = np.abs(view.si("propeller_rate_rpm")), np.abs(view.velocity)
    under_way = (n > 0.5 / 60.0) & (speed > 0.5 * view.speed) & (view.velocity.real > 0.0)
    if np.count_nonzero(under_way) < 10 or view.speed < 0.05:
        return cannot_tell(name, "the ship is hardly ever under way with her propeller turning.")
    rate, way = float(np.median(n[under_way])), float(np.median(speed[under_way]))
    if view.ship is not None:
        return advance(name, way, rate, float(view.ship.D_P))
    if 60.0 * rate < SLOWEST_RPM:
        return wrong(
            name,
            f"the ship makes {way:.2f} m/s with {60 * rate:.3g} turns a minute, {way / rate:.1f} m a turn: no propeller does; "
            'the column is believed to be in 1/s. In the map: unit = "1/s" for it (with --ship this is computed).',
        )
    return good(name, f"{60 * rate:.3g} rpm at {way:.2f} m/s, {way / rate:.2f} m a turn; with --ship this is checked closer.")


def advance(name: str, way: float, rate: float, diameter: float) -> Check:
    low, high = ADVANCE
    j = way / (rate * diameter)
    saw = f"advance ratio J = U/(nD) = {way:.3g}/({rate:.3g} x {diameter:.3g}) = {j:.3g}"
    if low <= j <= high:
        return good(name, f"{saw}, as a ship under way has it.")
    for factor, said, unit in ((60.0, "1/s", "1/s"), (30.0 / np.pi, "rad/s", "rad/s")):
        if 0.25 <= j / factor <= 1.4:
            return wrong(name, f'{saw}; {j / factor:.2g} if the turns are in {said}: that is believed. In the map: unit = "{unit}".')
    if 0.25 <= j * 60.0 <= 1.4:
        return wrong(name, f"{saw}; {j * 60:.2g} if the turns are 60 times too large: rpm were converted twice.")
    return doubtful(name, f"{saw}, expected {low:g} to {high:g}: another ship's file, a wrong unit, or a wrong diameter?")
