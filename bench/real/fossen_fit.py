"""A plain least-squares fit of Fossen's 3-DOF model to a boat with several actuators: its open-loop error.

    u_dot = a1 v r + a2 u + a3 |u| u + a4 X + a5
    v_dot = b1 u r + b2 v + b3 |v| v + b4 r + b5 + b6 Y
    r_dot = c1 u v + c2 r + c3 |r| r + c4 v + c5 N + c6
X, Y, N: what the actuators give at rest by the builder's curve, summed over where they stand; accelerations
are slopes of the recorded speeds. No priors, no bounds, no filter.

    python -m bench.real.fossen_fit FIT.mcap ... --on HELD.mcap ... --first SHIP.toml [--ship CALIBRATED.toml]
`--first`: the ship file that twin init wrote. With a calibrated one, the open-loop error of the twin's model
stands beside it, in windows begun as often, and that of nothing but the instruments' noise.
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


def columns(voyage: Voyage, first: Ship) -> Columns:
    """What the fit reads, on an even grid in SI."""
    v = voyage.on_grid(STEP_S)
    out = {
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
    """Coefficients of the three equations."""
    kernel = np.ones(round(SMOOTH_S / STEP_S)) / round(SMOOTH_S / STEP_S)
    rows: list[list[np.ndarray]] = [[], [], []]
    slopes: list[list[np.ndarray]] = [[], [], []]
    for c in voyages:
        smooth = {n: np.convolve(c[n], kernel, "same") for n in KNOWN}
        for i, (X, n) in enumerate(zip(regressors(*(smooth[n] for n in KNOWN)), "uvr", strict=True)):
            a, b = np.column_stack(X), np.gradient(smooth[n], STEP_S)
            ok = np.isfinite(a).all(1) & np.isfinite(b)
            rows[i].append(a[ok])
            slopes[i].append(b[ok])
    return [
        np.linalg.lstsq(np.concatenate(a), np.concatenate(b), rcond=None)[0]
        for a, b in zip(rows, slopes, strict=True)
    ]


def errors(c: Columns, theta: list[np.ndarray], horizon_s: float) -> tuple[list[float], list[float]]:
    """Open-loop position [m] and heading [deg] errors of windows that begin every STRIDE_S."""
    steps, stride = round(horizon_s / STEP_S), round(STRIDE_S / STEP_S)
    place, turn = list[float](), list[float]()
    for k in range(0, c["x"].size - steps, stride):
        x, y, psi, u, v, r = (float(c[n][k]) for n in ("x", "y", "psi", "u", "v", "r"))
        for i in range(k, k + steps):
            X = regressors(*(np.float64(q) for q in (u, v, r, *(c[n][i] for n in "XYN"))))
            du, dv, dr = (float(np.dot(t, q)) for t, q in zip(theta, X, strict=True))
            x += STEP_S * (u * np.cos(psi) - v * np.sin(psi))
            y += STEP_S * (u * np.sin(psi) + v * np.cos(psi))
            psi, u, v, r = psi + STEP_S * r, u + STEP_S * du, v + STEP_S * dv, r + STEP_S * dr
        end = k + steps
        off = (psi - c["psi"][end] + np.pi) % (2.0 * np.pi) - np.pi
        if np.isfinite(c["x"][end]):  # a fit that ran away counts: the table has medians
            place.append(float(np.hypot(x - c["x"][end], y - c["y"][end])))
            turn.append(abs(float(np.degrees(off))))
    return place, turn


def of_twin(voyage: Voyage, ship: Ship, horizon_s: float) -> dict[str, tuple[list[float], list[float]]]:
    """The same errors of the twin's model, and what the instruments' noise alone makes of its predictions."""
    t = track(voyage, ship)
    if t.t[-1] - t.t[0] <= horizon_s:
        return {}
    windows, out = predict(t, fed(Model.of(ship), t)[0], (horizon_s,), stride_s=STRIDE_S), {}
    k = windows.at(horizon_s)
    for name, run in (("twin", MODEL), ("noise", SENSORS)):
        off = windows.errors(run)
        place, turn = (off[what][k][windows.valid[k]] for what in ("position", "heading"))
        out[name] = place.tolist(), np.degrees(turn).tolist()
    return out


def of_all(place: Sequence[float], draws: int = 2000) -> str:
    """Median and mean over all windows, with the median's 95 % interval (bootstrap over windows)."""
    x = np.nan_to_num(place, nan=1e9)
    draw = np.random.default_rng(0).integers(0, x.size, (draws, x.size))
    low, high = np.percentile(np.median(x[draw], axis=1), (2.5, 97.5))
    return f"median {np.median(x):.3g} m ({low:.2g} to {high:.2g}), mean {x.mean():.3g} m ({x.size})"


def run_medians(name: str, place: Sequence[float], turn: Sequence[float]) -> str:
    """Medians; a run that went beyond numbers counts as the farthest."""
    metres, degrees = (float(np.median(np.nan_to_num(x, nan=1e9))) for x in (place, turn))
    return f"{name} {metres:.3g} m {degrees:.3g} deg ({len(place)})"


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
            with np.errstate(all="ignore"):  # a fit that runs away is as wrong as can be written down
                off = {"least squares": errors(c, theta, horizon)}
            if args.ship:
                off |= of_twin(voyage, load(args.ship), horizon)
            medians = [run_medians(name, *x) for name, x in off.items() if x[0]]
            print(f"{path}: {horizon:.0f} s  {'; '.join(medians) or 'too short'}", flush=True)
            for name, (place, _) in off.items():
                every.setdefault((horizon, name), []).extend(place)
    for (horizon, name), place in every.items():
        print(f"all: {horizon:.0f} s  {name} {of_all(place)}")


if __name__ == "__main__":
    main()
