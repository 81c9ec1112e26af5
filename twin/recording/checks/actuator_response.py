"""Do the ship's actuators push and turn it as the ship file has them?

    du = a (motion of the hull) + c_u sum of b_i X_i,  b_i, c_u >= 0;  dv and dr likewise with Y_i and N_i

over windows, i each actuator ahead and each astern: how strong they are (b), and how easily the vessel with
the water around it is moved along each axis (c), nobody needs to know here, only which way they push and
turn it. Each has one strength in surge, sway and yaw, for it is one force: what noise makes of one axis,
the others contradict. Asked once for the record as it is and once for every way in which it may be wired
otherwise (wirings.py); the one under which thrust explains most of what surge, sway and yaw do is believed.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from twin.live.signals.channels import of_actuators
from twin.physics.actuators import Actuator
from twin.physics.actuators.actuator_channels import DRIVES
from twin.physics.ship import Ship
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good, wrong
from twin.recording.checks.voyage_view import RunningSum, VoyageView
from twin.recording.checks.wirings import RIGHT, OrderArrays, Wiring, stop, wirings
from twin.recording.unknown_controls import CONTROLS, of_ship

AXES = ("surge", "sway", "yaw")
LENGTHS = (3, 6, 12, 24, 48)  # of windows, in steps of STEP_S at least
STEP_S = 0.2
LEAST_WINDOWS = 12  # windows that do not overlap
LEAST_SHARE = 0.1  # share of an axis' motion that thrust must explain, or add to, to tell anything of it
LEAD = 10.0  # log likelihood ratio that proves another wiring than the recorded one
# models of hulls are off by less: of an axis' motion, what the other wiring must explain more, or the most
# that it may leave of what is not explained as recorded; to be believed, and to be told
PROOF, HINT = (0.15, 0.6), (0.1, 0.75)
RIVAL = 5.0  # and to the next that is not the same, or needs fewer mistakes
AS_ONE = 'column = ["PORT", "STARBOARD"], factors = [0.5, 0.5].'
ROUNDS = 8  # of strengths and of how easily the vessel moves along each axis, in turn
ALIKE = 0.02  # share of the force by which two wirings that mean the same may differ

Windows = tuple[np.ndarray, np.ndarray]  # first and last rows


@dataclass(frozen=True)
class TriedWiring:
    """One wiring: by how much log likelihood thrust explains each axis, and which share of it."""

    wiring: Wiring
    columns: np.ndarray  # (3, N, C) over mass and inertia
    gain: np.ndarray  # (3,)
    share: np.ndarray  # (3,)

    @property
    def total(self) -> float:
        """Gain in log likelihood, of all three axes together."""
        return float(self.gain.sum())


def actuators(view: VoyageView) -> Check:
    """Which wiring of its actuators explains its motion."""
    name = "actuators"
    ship = view.ship
    others = ship is not None and driven_otherwise(view, ship)
    if others:
        return doubtful(name, others)
    if ship is None or not ship.actuators:
        return cannot_tell(name, "no ship file with actuators was given (--ship).")
    if not all(view.voyage.has(*a.columns()) for a in ship.actuators):
        return cannot_tell(name, "nothing was recorded of what drives and steers the vessel.")
    tried = best_window(view, ship)
    if not tried:
        return cannot_tell(name, "it hardly moves under thrust that changes.")
    as_is = next(t for t in tried if t.wiring.text == RIGHT)
    best = max(tried, key=lambda t: t.total - RIVAL * max(t.wiring.mistakes - 1, 0))
    if best is as_is or best.total - as_is.total < RIVAL or not _better(best, as_is, HINT):
        return good(name, f"thrust explains {_shares(as_is)}, as the ship file has its actuators.")
    return _answer(name, best, as_is, tried)


def driven_otherwise(view: VoyageView, ship: Ship) -> str:
    """That the voyage was recorded of other controls than the ship file has; "" where it has them all, or
    none of any kind."""
    wanted, v = of_ship(ship), view.voyage
    missing = [c for c in wanted if not v.has(c)]
    there = [c for c in (*CONTROLS, *of_actuators(v.columns)) if v.has(c)]
    if not missing or not there or not (ship.actuators or of_actuators(there)):
        return ""
    mean = "" if ship.actuators else " Two rudders or shafts that go together are one channel: " + AS_ONE
    return (
        f"not recorded: {', '.join(missing)}; without that the voyage cannot be used with the file of "
        f"{ship.name}. Recorded: {', '.join(there)}. Give each channel that is missing a line in the map "
        "(--suggest-map proposes them), or leave out of the ship file what is not recorded."
        f"{mean}"
    )


def _answer(name: str, best: TriedWiring, as_is: TriedWiring, tried: list[TriedWiring]) -> Check:
    rivals = [t for t in tried if t.wiring.mistakes <= best.wiring.mistakes and not _alike(t, best)]
    rival = max(rivals, key=lambda t: t.total)
    second = f"; the next best, {rival.wiring.text}, {_shares(rival)}" * (rival is not as_is)
    saw = f"if {best.wiring.text}, thrust explains {_shares(best)}; as recorded {_shares(as_is)}{second}"
    sides = " (or exchange their x_m and y_m in the ship file)" * ("exchange" in best.wiring.fix)
    fix = f"In the map: {best.wiring.fix}{sides}"
    ahead = best.total - max(as_is.total, rival.total) >= LEAD
    contradicted = _better(as_is, best, HINT)  # by another axis, which the same force moves
    if ahead and _better(best, as_is, PROOF) and not contradicted:
        return wrong(name, f"{saw}: {best.wiring.text}, that is believed. {fix}.")
    return doubtful(name, f"{saw}. Not proved: more turning under thrust would tell. {fix}.")


def _better(a: TriedWiring, b: TriedWiring, by: tuple[float, float]) -> bool:
    """Whether one explains so much more of an axis than the other."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return bool(np.any((a.share - b.share >= by[0]) | ((1.0 - a.share) / (1.0 - b.share) <= by[1])))


def _shares(t: TriedWiring) -> str:
    told = [f"{100 * s:.0f} % of {axis}" for s, axis in zip(t.share, AXES, strict=True) if np.isfinite(s)]
    return ", ".join(told)


def _alike(a: TriedWiring, b: TriedWiring) -> bool:
    """Whether two wirings give the same force, up to a little."""
    x, y = a.columns.sum(2), b.columns.sum(2)
    size = np.nanmax(np.abs(x), axis=1)
    moved = size > 1e-9 * np.nanmax(size)
    return bool(np.nanmax(np.abs(x - y)[moved] / size[moved, None]) < ALIKE)


def best_window(view: VoyageView, ship: Ship) -> list[TriedWiring]:
    """All wirings, over windows of the length at which one of them explains most; none where nothing
    tells."""
    motion = np.array([view.velocity.real, view.velocity.imag, view.si("yaw_rate_degps")])
    step = max(view.step_s, STEP_S)
    lengths = [k * step for k in LENGTHS if k * step * LEAST_WINDOWS < view.voyage.duration_s]
    windows, hull = [view.windows(seconds) for seconds in lengths], _hull(view, motion)
    each = [
        _tried(view, motion, hull, w, _columns(view, ship, motion, w), windows)
        for w in wirings(ship.actuators)
    ]
    clear = [ts for ts in map(list, zip(*each, strict=True)) if max(t.total for t in ts) > LEAD]
    return max(clear, key=lambda ts: max(t.total for t in ts), default=[])


def _hull(view: VoyageView, motion: np.ndarray) -> list[list[RunningSum]]:
    """For surge, sway and yaw what the hull's own motion may do to it."""
    u, v, r = motion
    hull = ((v * r, u, abs(u) * u), (u * r, v, abs(v) * v, r), (u * v, r, abs(r) * r, abs(u) * r, v))
    return [[RunningSum.of(x, view.step_s) for x in of_axis] for of_axis in hull]


def _columns(view: VoyageView, ship: Ship, motion: np.ndarray, wiring: Wiring) -> np.ndarray:
    """(3, N, C) of every actuator ahead and astern, over mass and inertia."""
    names = [
        (f"{a.name}.{n}", c) for a in ship.actuators for n, c in zip(a.attributes, a.columns(), strict=True)
    ]
    told = wiring.undo({n: view.si(c) for n, c in names})
    u, v, r = motion
    mass = np.array([ship.m, ship.m, ship.I_z], float)[:, None]
    out = []
    for a in ship.actuators:
        force = np.array([np.broadcast_to(f, motion[0].shape) for f in a.force(told, u, v, r, ship)]) / mass
        ahead = _ahead(a, told)
        out += [np.where(side, force, 0.0 * force) for side in (ahead, ~ahead)]
    return np.stack(out, axis=2)


def _ahead(a: Actuator, told: OrderArrays) -> np.ndarray:
    """(N,) whether it is told to push ahead."""
    drive = next(n for n in a.attributes if n in DRIVES)
    return np.asarray(told[f"{a.name}.{drive}"] > stop(a, drive))


def _tried(
    view: VoyageView,
    motion: np.ndarray,
    hull: list[list[RunningSum]],
    wiring: Wiring,
    columns: np.ndarray,
    windows: list[Windows],
) -> list[TriedWiring]:
    """How well it explains the motion over windows of each of these lengths."""
    pushes = [[RunningSum.of(x, view.step_s) for x in of_axis.T] for of_axis in columns]
    out = []
    for first, last in windows:
        axes: dict[int, np.ndarray] = {}
        for i in range(3):
            change = motion[i][last] - motion[i][first]
            push = np.stack([x.over(first, last) for x in pushes[i]], axis=1)
            others = np.stack([*(x.over(first, last) for x in hull[i]), np.ones(first.size)], axis=1)
            ok = np.isfinite(change) & np.isfinite(push).all(1) & np.isfinite(others).all(1)
            if np.count_nonzero(ok) / 2 < LEAST_WINDOWS or not np.ptp(push[ok], axis=0).any():
                continue
            both = _beside(others[ok], np.column_stack([change, push])[ok])
            if (size := float(np.linalg.norm(both[:, 0]))) > 0.0:
                axes[i] = both / size
        out.append(TriedWiring(wiring, columns, *_explained(axes)))
    return out


def _explained(axes: dict[int, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """(3,) log likelihood that thrust gains, and (3,) the share that it explains, of the motion beside thrust
    in each axis that tells anything, (W, 1 + C) of one size."""
    gain, share = np.zeros(3), np.full(3, np.nan)
    pushes = _pushes(list(axes.values())) if axes else []
    for (i, both), push in zip(axes.items(), pushes, strict=True):
        left = float(np.sum((both[:, 0] - push) ** 2))
        share[i] = max(0.0, 1.0 - left)
        gain[i] = -0.25 * len(both) * np.log(max(left, 1e-12)) if abs(1.0 - left) > LEAST_SHARE else 0.0
    return gain, share


def _pushes(axes: Sequence[np.ndarray]) -> list[np.ndarray]:
    """(W,) of each axis what thrust explains of its change: an actuator has one strength in all axes,
    and how easily the vessel moves along an axis is one for all actuators. Least squares of the one and of
    the other in turn."""
    from scipy.optimize import nnls  # heavy, and only ships with actuators are asked

    ease = np.ones(len(axes))
    change = np.concatenate([both[:, 0] for both in axes])
    for _ in range(ROUNDS):
        strengths = nnls(
            np.concatenate([k * both[:, 1:] for k, both in zip(ease, axes, strict=True)]), change
        )[0]
        pushes = [both[:, 1:] @ strengths for both in axes]
        ease = np.array(
            [
                max(0.0, float(p @ both[:, 0])) / max(float(p @ p), 1e-300)
                for p, both in zip(pushes, axes, strict=True)
            ]
        )
    return [k * p for k, p in zip(ease, pushes, strict=True)]


def _beside(others: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """What the hull's own motion does not explain of each column, by least squares."""
    return columns - others @ np.linalg.lstsq(others, columns, rcond=None)[0]
