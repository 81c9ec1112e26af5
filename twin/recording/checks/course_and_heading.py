"""Without an independent position: a ship goes nearly where it points."""

import numpy as np

from twin.num import num
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, wrong
from twin.recording.checks.voyage_view import VoyageView, rms

FASTEST_MPS = 40.0
LARGE_DRIFT_DEG = 8.0


def course_against_heading(name: str, view: VoyageView) -> Check:
    """The drift angle, as the columns stand and as if the velocities were earth-fixed."""
    w = view.velocity[np.abs(view.velocity) > 0.3 * view.speed]
    psi = view.psi[np.abs(view.velocity) > 0.3 * view.speed]
    keep = np.isfinite(w) & np.isfinite(psi)
    w, psi = w[keep], psi[keep]
    if w.size < 10 or view.speed < 0.02:
        return cannot_tell(name, "the ship hardly moves, and position and velocities are not independent.")
    by_heading = w * np.exp(-1j * psi)
    drift, earth = rms(np.angle(w)), rms(np.angle(by_heading))
    saw = f"drift angle {np.degrees(drift):.0f} deg rms"
    if view.speed > FASTEST_MPS:
        return wrong(
            name,
            f"the ship makes {num(view.speed, 3)} m/s: is the time in minutes or hours, the position in "
            "feet?",
        )
    if drift > np.radians(LARGE_DRIFT_DEG) and earth < 0.5 * drift and not view.derived("surge_velocity_mps"):
        text = f"{saw}, but {np.degrees(earth):.0f} deg if surge and sway are earth-fixed (dx/dt and dy/dt)"
        fix = 'In the map: frame = "earth" for both.'
        if swing(by_heading) < 0.5 * swing(w):
            return wrong(name, f"{text}: that is believed. {fix}")
        return doubtful(name, f"{text}; so it is with leeway on this course, and a turn would tell. {fix}")
    mean = float(np.degrees(np.angle(np.mean(w / np.abs(w)))))
    if abs(mean) > 45.0:
        return doubtful(
            name,
            f"the ship moves {mean:.0f} deg off its heading on average: are heading, north and east right?",
        )
    return cannot_tell(name, f"position and velocities are not independent ({saw}).")


def swing(w: np.ndarray) -> float:
    """How much the direction of a velocity (N,) swings about its mean [rad, root mean square]."""
    return rms(np.angle(w * np.conj(np.mean(w / np.abs(w)))))
