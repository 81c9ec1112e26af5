"""A plain least-squares fit of Fossen's 3-DOF model to a boat with several actuators: its open-loop error.

    u_dot = a1 v r + a2 u + a3 |u| u + a4 X + a5
    v_dot = b1 u r + b2 v + b3 |v| v + b4 r + b5 + b6 Y
    r_dot = c1 u v + c2 r + c3 |r| r + c4 v + c5 N + c6
X, Y, N: what the actuators give at rest by the builder's curve, summed over where they stand; accelerations
are slopes of the recorded speeds. All are means over a second, which lies whole within a run. No priors, no
bounds, no filter.

    python -m bench.real.fossen_fit FIT.mcap ... --on HELD.mcap ... --first SHIP.toml [--ship CALIBRATED.toml]
`--first`: the ship file that twin init wrote. With a calibrated one, the open-loop error of the twin's model
stands beside it, in the same windows, and that of nothing but the instruments' noise. A window with a hole
in what either needs (the start, the inputs, the end) is left out for both.
"""

import argparse
from collections.abc import Sequence
from typing import Any

import numpy as np

from twin.physics.actuators import attribute_of
from twin.physics.model import Model
from twin.physics.ship import Ship, load
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage
from twin.study.prediction.openloop import predict
from twin.study.prediction.windows import MODEL, SENSORS
from twin.study.reference.sailed import fed
from twin.study.track.track import track

STEP_S, SMOOTH_S = 0.1, 1.0
HORIZONS_S, STRIDE_S = (10.0, 60.0), 10.0
Columns = dict[str, np.ndarray]
KNOWN = "uvrXYN"  # columns that the accelerations are regressed on
FAR_M, FAR_DEG = 1e9, 180.0  # what a model that ran away is off by


def columns(voyage: Voyage, first: Ship) -> Columns:
    """What the fit reads, on an even grid in SI; `t` from the first sample on."""
    v = voyage.on_grid(STEP_S)
    out = {"t": v.time_s - voyage.time_s[0]}
    out |= {
        n: v.si(c)
        for n, c in {
            "x": "north_m",
            "y": "east_m",
            "psi": "heading_true_north_deg",
            "u": "surge_velocity_mps",
            "v": "sway_velocity_mps",
            "r": "yaw_rate_degps",
        }.items()
    }
    return out | dict(zip("XYN", pushes(v, first), strict=True))


def pushes(v: Voyage, first: Ship) -> list[np.ndarray]:
    """Ahead, to starboard [N] and turning [N m], by what was recorded of the actuators, at rest."""
    rest = np.zeros(len(v))
    orders = {attribute_of(c): v.si(c) for a in first.actuators for c in a.columns()}
    forces = [a.force(orders, rest, rest, rest, first) for a in first.actuators]
    return [np.sum([f[i] + rest for f in forces], axis=0) for i in range(3)]


def regressors(u: Any, v: Any, r: Any, X: Any, Y: Any, N: Any) -> list[list[Any]]:
    one = np.ones_like(u)
    return [
        [v * r, u, abs(u) * u, X, one],
        [u * r, v, abs(v) * v, r, one, Y],
        [u * v, r, abs(r) * r, v, N, one],
    ]


def fitted(voyages: Sequence[Columns]) -> list[np.ndarray]:
    """Coefficients of the three equations. Where the mean would reach beyond a run's ends or into a hole,
    nothing is regressed: what is not there is no speed of nought."""
    width = round(SMOOTH_S / STEP_S)
    kernel = np.ones(width) / width
    rows: list[list[np.ndarray]] = [[], [], []]
    slopes: list[list[np.ndarray]] = [[], [], []]
    for c in (c for c in voyages if c["u"].size > width):
        smooth = {n: np.convolve(c[n], kernel, "valid") for n in KNOWN}
        for i, (X, n) in enumerate(zip(regressors(*(smooth[n] for n in KNOWN)), "uvr", strict=True)):
            a, b = np.column_stack(X), np.gradient(smooth[n], STEP_S)
            ok = np.isfinite(a).all(1) & np.isfinite(b)
            rows[i].append(a[ok])
            slopes[i].append(b[ok])
    return [
        np.linalg.lstsq(np.concatenate(a), np.concatenate(b), rcond=None)[0]
        for a, b in zip(rows, slopes, strict=True)
    ]


def begins(c: Columns, horizon_s: float) -> np.ndarray:
    """(W,) when windows begin that end within the run [s after its first sample]."""
    return c["t"][: max(0, c["t"].size - round(horizon_s / STEP_S)) : round(STRIDE_S / STEP_S)]


def errors(c: Columns, theta: Sequence[np.ndarray], horizon_s: float, begin_s: np.ndarray) -> np.ndarray:
    """(2, W) open-loop position [m] and heading [deg] errors of the windows that begin there. NaN: a hole in
    the start, the inputs or the end; FAR_M and FAR_DEG: the fit ran away."""
    steps, out = round(horizon_s / STEP_S), np.full((2, begin_s.size), np.nan)
    for w, k in enumerate(np.searchsorted(c["t"], begin_s - 0.5 * STEP_S)):
        if _whole(c, k, k + steps):
            out[:, w] = _off(c, theta, k, k + steps)
    return out


def _whole(c: Columns, begin: int, end: int) -> bool:
    """Is all there that a prediction from one step to the other needs, and is compared with?"""
    if end >= c["t"].size:
        return False
    speeds, places = [c[n][begin] for n in "uvr"], [c[n][[begin, end]] for n in ("x", "y", "psi")]
    return all(np.isfinite(q).all() for q in (speeds, places, [c[n][begin:end] for n in "XYN"]))


def _off(c: Columns, theta: Sequence[np.ndarray], begin: int, end: int) -> tuple[float, float]:
    """Position [m] and heading [deg] error at step `end` of a prediction from step `begin` on."""
    x, y, psi, u, v, r = (float(c[n][begin]) for n in ("x", "y", "psi", "u", "v", "r"))
    with np.errstate(all="ignore"):  # a fit that runs away is as wrong as can be written down
        for i in range(begin, end):
            X = regressors(*(np.float64(q) for q in (u, v, r, *(c[n][i] for n in "XYN"))))
            du, dv, dr = (float(np.dot(t, q)) for t, q in zip(theta, X, strict=True))
            x += STEP_S * (u * np.cos(psi) - v * np.sin(psi))
            y += STEP_S * (u * np.sin(psi) + v * np.cos(psi))
            psi, u, v, r = psi + STEP_S * r, u + STEP_S * du, v + STEP_S * dv, r + STEP_S * dr
        place = np.hypot(x - c["x"][end], y - c["y"][end])
        turn = np.degrees(abs((psi - c["psi"][end] + np.pi) % (2.0 * np.pi) - np.pi))
    known = np.isfinite([place, turn]).all() and place < FAR_M
    return (float(place), float(turn)) if known else (FAR_M, FAR_DEG)


def of_twin(voyage: Voyage, ship: Ship, horizon_s: float) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """When the twin's windows begin [s], and the same errors of its model and of what the instruments' noise
    alone makes of its predictions."""
    t = track(voyage, ship)
    if t.t[-1] - t.t[0] <= horizon_s:
        return np.zeros(0), {name: np.zeros((2, 0)) for name in ("twin", "noise")}
    windows, out = predict(t, fed(Model.of(ship), t)[0], (horizon_s,), stride_s=STRIDE_S), {}
    k = windows.at(horizon_s)
    for name, run in (("twin", MODEL), ("noise", SENSORS)):
        off = windows.errors(run)
        place, turn = (off[what][k][windows.valid[k]] for what in ("position", "heading"))
        out[name] = np.array([place, np.degrees(turn)])
    return t.t[windows.start[windows.valid[k]]], out


def in_whole_windows(off: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The errors (2, W) of each model in the windows in which none of them has a hole."""
    whole = np.logical_and.reduce([np.isfinite(x).all(0) for x in off.values()])
    return {name: x[:, whole] for name, x in off.items()}


def of_all(place: Sequence[float], draws: int = 2000) -> str:
    """Median and mean over all windows, with the median's 95 % interval (bootstrap over windows)."""
    x = np.asarray(place)
    draw = np.random.default_rng(0).integers(0, x.size, (draws, x.size))
    low, high = np.percentile(np.median(x[draw], axis=1), (2.5, 97.5))
    return f"median {np.median(x):.3g} m ({low:.2g} to {high:.2g}), mean {x.mean():.3g} m ({x.size})"


def run_medians(name: str, place: np.ndarray, turn: np.ndarray) -> str:
    """Medians; a prediction that ran away counts as the farthest."""
    return f"{name} {np.median(place):.3g} m {np.median(turn):.3g} deg ({place.size})"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("voyages", nargs="+")
    parser.add_argument("--on", nargs="+", required=True)
    parser.add_argument("--first", required=True)
    parser.add_argument("--ship")
    args = parser.parse_args()
    first = load(args.first)
    theta = fitted([columns(read_voyage(p), first) for p in args.voyages])
    every: dict[tuple[float, str], list[float]] = {}
    for path in args.on:
        voyage = read_voyage(path)
        c = columns(voyage, first)
        for horizon in HORIZONS_S:
            begin, twin = of_twin(voyage, load(args.ship), horizon) if args.ship else (begins(c, horizon), {})
            off = in_whole_windows({"least squares": errors(c, theta, horizon, begin)} | twin)
            medians = [run_medians(name, *x) for name, x in off.items() if x.size]
            print(f"{path}: {horizon:.0f} s  {'; '.join(medians) or 'too short'}", flush=True)
            for name, (place, _) in off.items():
                every.setdefault((horizon, name), []).extend(place)
    for (horizon, name), place in every.items():
        if place:
            print(f"all: {horizon:.0f} s  {name} {of_all(place)}")


if __name__ == "__main__":
    main()
