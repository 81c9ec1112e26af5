"""Is this voyage of this ship, and long enough to say something about it?"""

import numpy as np

from twin.num import as_given, num
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good
from twin.recording.checks.voyage_view import VoyageView

G = 9.81  # [m/s2]
# U / sqrt(g L): what a displacement hull stays below, and what is too fast for it; for a hull whose own
# service speed is faster, as many times that
DISPLACEMENT_FROUDE, FASTEST_FROUDE = 0.5, 0.7
TIGHTEST_TURN = 2.0  # r L / U; the tightest turning circles of ships reach 1
WAVE_S = 3.0  # yawing in waves is shorter than this on a boat
SHORT_S = 480.0
SHORT_LENGTHS = 10.0  # ship lengths sailed
STEADY_RUDDER_DEG = 1.0


def ship_size(view: VoyageView) -> Check:
    """Speed and turning against the length of the ship, and its draught."""
    name = "ship_size"
    if view.ship is None:
        return cannot_tell(name, "give --ship to compare speed, turning and draught with its size.")
    length, speed = float(view.ship.L_pp), view.speed
    wave = np.sqrt(G * length)
    froude, own = speed / wave, float(view.ship.U_0) / wave
    turning = tightest(view, length)
    draught = float(np.nanmedian(view.voyage["draught_mean_m"])) if view.voyage.has("draught_mean_m") else 0.0
    saw = f"Froude number {froude:.3f}, tightest turn r L/U = {turning:.2f} with L = {as_given(length, 4)} m"
    other = (
        f"Another ship's file, or a model's ([scale] froude = ...)? {view.ship.name} is "
        f"{as_given(length, 4)} m long."
    )
    if froude > FASTEST_FROUDE * max(1.0, own / DISPLACEMENT_FROUDE):
        return doubtful(name, f"{saw}: {num(speed, 3)} m/s is too fast for it. {other}")
    if turning > TIGHTEST_TURN and not view.ship.actuators:  # thrusters turn a vessel on the spot
        return doubtful(name, f"{saw}: no ship turns within {1 / turning:.2f} lengths. {other}")
    if draught and not 0.4 < draught / float(view.ship.T) < 2.0:
        return doubtful(
            name,
            f"draught {num(draught, 3)} m, but {view.ship.name} has {num(float(view.ship.T), 3)} m. {other}",
        )
    return good(name, f"{saw}: possible for {view.ship.name}.")


def tightest(view: VoyageView, length: float) -> float:
    """The 99 % quantile of |r| L / U under way, means over a quarter of L / U (WAVE_S [s] at least)."""
    if not view.speed > 0.02:
        return 0.0
    first, last = view.windows(max(0.25 * length / view.speed, WAVE_S))
    turned = np.abs(view.summed(view.si("yaw_rate_degps"), first, last))
    sailed = view.summed(np.abs(view.velocity), first, last)
    ratio = turned * length / np.maximum(sailed, 0.25 * np.nanmedian(sailed))
    return float(np.nanquantile(ratio, 0.99)) if np.isfinite(ratio).any() else 0.0


def duration(view: VoyageView) -> Check:
    """Long enough, and with enough going on, to judge a model by."""
    name, seconds = "duration", view.voyage.duration_s
    sailed = float(np.nansum(np.abs(view.velocity)) * view.step_s)
    steered = view.voyage["rudder_angle_deg"]
    still = np.isfinite(steered).any() and float(np.nanstd(steered)) < STEADY_RUDDER_DEG
    calm = " The rudder hardly moves: nothing about turning can be learned from it." * bool(still)
    if view.ship is not None:
        lengths = sailed / float(view.ship.L_pp)
        saw = f"{as_given(seconds, 4)} s, {lengths:.0f} ship lengths"
        short = lengths < SHORT_LENGTHS
    else:
        saw, short = f"{as_given(seconds, 4)} s, {as_given(sailed, 4)} m", seconds < SHORT_S
    if short:
        return doubtful(
            name,
            f"{saw}: too short to judge a cause by. Use it beside other voyages; 20 minutes with manoeuvres "
            f"are good.{calm}",
        )
    return good(name, f"{saw}.{calm}")
