"""Is this a voyage of the ship in the file? Asked by what its shaft and its rudder do to it.

    s = U / u      u: the speed at which the file's ship would accelerate as this one does, its shaft turning
                   as recorded, on a path as curved (v/u and r/u as measured); median over straight windows
    dr = k N_R/I_z dt + (damping of r)      N_R/I_z: what the file's rudder would do at this angle and speed,
                   its shaft turning as that ship's would at this speed

A ship of another size or kind has another propeller and another length: s follows the propeller's diameter
and pitch, k the inverse square of the length. One cause, a fouled hull, a worn rudder, changes one of the two
and by less; a mistaken unit of shaft or rudder changes one alone. Both out, and together far out, are told:

    a = |log s| / log 1.5      b = log k / log 2 where k > 1, log(0.6/k) / log 2.4 where k < 0.6, else 0
"""

from math import log

import numpy as np

from twin.num import num
from twin.physics.model import Model
from twin.physics.state import WEATHER, Rates, Situation
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good
from twin.recording.checks.rudder import PROOF_SHARE, best_gain
from twin.recording.checks.voyage_view import VoyageView

# 1 at the ends of what 38 ships of the fleet show on 380 voyages, healthy and with what the catalogue and
# more hide, with calibrated models and first ones: s 0.65 to 1.4, k (biased low by lags) 0.2 to 2
SPEED_END, TURNING_ENDS, USUAL_TURNING = 1.5, (0.25, 2.0), (0.6, 1.0)
OUT_OF_SPEED, OUT_OF_TURNING, OUT_TOGETHER = 0.5, 0.5, 2.25  # of a, of b, of both together
# of the measured speed, where the file's is looked for; the least is taken at which it accelerates no more
TRIED = np.geomspace(0.01, 100.0, 321)
LEAST_TURNING = 1e-4  # of k: a ship that turns the other way is as far out
FEWEST_WINDOWS = 5  # under way with the shaft turning; fewer say nothing
WINDOW_STEPS = 10  # of the grid, that a window lasts
STRAIGHTEST = 0.3  # share of the windows that turn least


def other_ship(view: VoyageView) -> Check:
    """Speed at its shaft and turning at its rudder against the ship in the file."""
    name, found = "other_ship", ratios(view)
    if isinstance(found, str):
        return cannot_tell(name, found)
    speed, turning = found
    ship = view.ship.name if view.ship else ""
    saw = (
        f"at this shaft rate it makes {num(speed, 2)} times the speed of {ship}, and turns {num(turning, 2)} "
        "times as strongly at this rudder"
    )
    if not out_together(speed, turning):
        return good(name, f"{saw}.")
    return doubtful(
        name,
        f"{saw}: no single cause does both. Give the ship file of this ship; or see the units of speed and "
        "shaft.",
    )


def ratios(view: VoyageView) -> tuple[float, float] | str:
    """(s, k); or why they cannot be told."""
    ship = view.ship
    if ship is None:
        return "give --ship to compare how it goes and turns with what its ship would do."
    if ship.actuators:
        return "the ship has actuators in the place of one propeller and one rudder."
    if not view.voyage.has("propeller_rate_rpm", "rudder_angle_deg") or not view.way_on:
        return "rudder and shaft of a ship that makes way would tell."
    model = Model.of(ship).without_inputs(set(WEATHER))[0]
    speed = speed_ratio(view, model)
    if speed is None:
        return "it hardly goes straight with its shaft turning."
    share, turning = best_gain(view, rudder_push(view, model, speed))
    if share < PROOF_SHARE:
        return f"at this shaft rate it makes {num(speed, 2)} times the speed; its turning says too little."
    return speed, turning


def as_its_own(view: VoyageView) -> bool:
    """Whether s and k are both seen, and as a ship in its own file shows them."""
    found = ratios(view)
    if isinstance(found, str):
        return False
    return abs(log(found[0])) <= log(SPEED_END) and TURNING_ENDS[0] <= found[1] <= TURNING_ENDS[1]


def out_together(speed: float, turning: float) -> bool:
    """Whether s and k are both outside what a ship in its own file shows, and together far outside."""
    a = abs(log(speed)) / log(SPEED_END)
    (least, most), (low, high) = TURNING_ENDS, USUAL_TURNING
    k = max(turning, LEAST_TURNING)
    b = max(log(k / high) / log(most / high), log(low / k) / log(low / least))
    return a > OUT_OF_SPEED and b > OUT_OF_TURNING and a + b > OUT_TOGETHER


def rates(
    model: Model, u: np.ndarray, v: np.ndarray, r: np.ndarray, delta: np.ndarray, n: np.ndarray
) -> Rates:
    """What the file's ship would do in still water: [m/s2, m/s2, rad/s2]. All (N,), SI."""
    with np.errstate(all="ignore"):
        return model.nu_dot(Situation(u=u, v=v, r=r, delta=delta, n=n))


def rudder_push(view: VoyageView, model: Model, speed: float) -> np.ndarray:
    """(N,) N_R/I_z of the file's ship [rad/s2], its shaft turning as it would at the measured speed."""
    u, v, r = view.velocity.real, view.velocity.imag, view.si("yaw_rate_degps")
    delta, n = view.si("rudder_angle_deg"), view.si("propeller_rate_rpm") * speed
    return np.asarray(rates(model, u, v, r, delta, n).r - rates(model, u, v, r, 0.0 * delta, n).r)


def speed_ratio(view: VoyageView, model: Model) -> float | None:
    """s; None where too few windows are straight with the shaft turning ahead."""
    by_log = "surge_velocity_through_water_mps"
    u = view.si(by_log) if view.voyage.has(by_log) else view.velocity.real
    r, n = view.si("yaw_rate_degps"), view.si("propeller_rate_rpm")
    first, last = view.windows(WINDOW_STEPS * view.step_s)
    seconds = (last - first) * view.step_s
    told = [view.summed(x, first, last) / seconds for x in (u, view.velocity.imag, r, n)]
    told += [view.summed(view.si("rudder_angle_deg"), first, last) / seconds, (u[last] - u[first]) / seconds]
    ahead = np.isfinite(told).all(axis=0) & (told[0] > 0.5 * view.speed)
    ahead &= told[3] > 0.5 * np.nanquantile(np.abs(n), 0.9)
    if np.count_nonzero(ahead) < FEWEST_WINDOWS:
        return None
    ahead &= np.abs(told[2]) <= np.quantile(np.abs(told[2][ahead]), STRAIGHTEST)
    u, v, r, n, delta, u_dot = (x[ahead] for x in told)
    by = TRIED[:, None]  # (T, 1), of the measured speed and, on the same path, of drift and turning
    slow = rates(model, by * u, by * v, by * r, delta, n).u > u_dot  # (T, W)
    return float(np.median(1.0 / TRIED[np.argmin(np.vstack([slow[:-1], 0 * slow[:1]]), axis=0)]))
