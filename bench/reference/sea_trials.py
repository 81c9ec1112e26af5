"""Our KVLCC2 beside other people's: an independent program, tank tests, and the limits that seafarers accept.

The equations are those of Yasukawa & Yoshimura (2015), whose own tables of results we could not get hold
of. `shipmmg` 0.0.11 (MIT, the ShipMMG group) is somebody else's program of the same paper, run once for the
7 m model with our particulars and propeller rate; it keeps a wake law of its own. Tank tests: SIMMAN 2008
free runs of MARIN (ship scale) and HSVA (7 m model). Limits: IMO resolution MSC.137(76), for L/U = 40 s.
"""

import os
from pathlib import Path

import numpy as np

from bench.reference import trial_indices
from bench.reference.sea import hull_of
from bench.reference.sea_voyage import SeaCase, simulate
from bench.reference.trial_legs import RUDDER, ZIGZAG, Leg
from bench.reference.weather import Weather

# rudder: (advance / L, tactical diameter / L); angle: (1st, 2nd overshoot [deg]); minus: rudder first to port
SHIPMMG_TURN = {35: (3.06, 2.99), -35: (2.92, 2.73)}
SHIPMMG_ZIGZAG = {10: (4.6, 13.4), -10: (6.5, 9.3), 20: (11.1, 15.1), -20: (14.8, 12.0)}
MARIN_ZIGZAG = {10: (8.2,), -10: (9.5,), 20: (13.7, 14.9), -20: (15.1, 13.3)}  # read from the measured series
IMO = {
    "advance / L": 4.5,
    "tactical diameter / L": 5.0,
    "10/10 1st": 20.0,
    "10/10 2nd": 40.0,
    "20/20 1st": 25.0,
}


def sail(hull, plans, duration_s):
    """Calm, airless voyages due north with perfect instruments, one for each plan of legs."""
    cases = [
        SeaCase(hull, tuple(plan), Weather(), heading_deg=0.0, duration_s=duration_s, sensors="perfect")
        for plan in plans
    ]
    return simulate(cases)


def measure_turn(recording):
    """Advance and tactical diameter in lengths."""
    true = recording.truth
    return trial_indices.turn(true["north"], true["east"], np.degrees(true["psi"]), hull_of(recording.case).L)


def measure_zigzag(recording, angle, at=None):
    """Overshoots [deg] over the execute heading `at`, and the times [s] of the reversals."""
    true = recording.truth
    time, psi, rudder = (
        recording.columns["time_s"],
        np.degrees(true["psi"]),
        np.degrees(true["rudder_feedback"]),
    )
    over, times = trial_indices.overshoots(time, psi, rudder, angle)
    return [o + abs(angle) - abs(at or angle) for o in over], times


def standard(hull):
    """Advance, tactical diameter and first two overshoots, by rudder angle."""
    turns, zigzags = (35, -35), (10, -10, 20, -20)
    plans = [[Leg(RUDDER, 99, a)] for a in turns] + [[Leg(ZIGZAG, 99, a, abs(a))] for a in zigzags]
    ship = hull_of(SeaCase(hull))
    voyages = sail(hull, plans, 15 * ship.L / ship.U0)
    turned = {a: measure_turn(v) for a, v in zip(turns, voyages, strict=False)}
    return turned, {a: measure_zigzag(v, a)[0][:2] for a, v in zip(zigzags, voyages[2:], strict=True)}


def line(what, ours, theirs, whose):
    return f"  {what:<34}{ours:8.2f}{theirs:10.2f}{100 * (ours / theirs - 1):+9.0f} %   {whose}"


def compare_standard():
    """Lines that set ours beside theirs."""
    out = [f"  {'':<34}{'ours':>8}{'theirs':>10}{'off by':>11}"]
    for hull, turns, zigzags, whose in (
        ("kvlcc2_model", SHIPMMG_TURN, SHIPMMG_ZIGZAG, "shipmmg"),
        ("kvlcc2", {}, MARIN_ZIGZAG, "MARIN, measured"),
    ):
        turned, zigzagged = standard(hull)
        out.append(hull)
        for angle, theirs in turns.items():
            for name, a, b in zip(
                ("advance / L", "tactical diameter / L"), turned[angle], theirs, strict=True
            ):
                out.append(line(f"{name}, rudder {angle:+d} deg", a, b, whose))
        for angle, theirs in zigzags.items():
            for number, a, b in zip(("1st", "2nd"), zigzagged[angle], theirs, strict=False):
                out.append(line(f"{number} overshoot {angle:+d}/{abs(angle)} deg", a, b, whose))
        out += limits(turned, zigzagged)
    return out


def limits(turned, zigzagged):
    """The worst of both sides against the limits of IMO."""
    worst = {
        "advance / L": max(t[0] for t in turned.values()),
        "tactical diameter / L": max(t[1] for t in turned.values()),
        "10/10 1st": max(zigzagged[a][0] for a in (10, -10)),
        "10/10 2nd": max(zigzagged[a][1] for a in (10, -10)),
        "20/20 1st": max(zigzagged[a][0] for a in (20, -20)),
    }
    verdict = {name: "inside" if value <= IMO[name] else "OUTSIDE" for name, value in worst.items()}
    return [f"  {n:<34}{v:8.2f}{IMO[n]:10.2f}   {verdict[n]} the limit of IMO" for n, v in worst.items()]


def read_run(path):
    """Time [s], heading, rudder [deg, starboard positive], rudder angle, execute heading, hull of a file."""
    rows = []
    for text in path.read_text(errors="replace").splitlines():
        try:
            rows.append([float(word) for word in text.split()])
        except ValueError:
            continue
    width = max(map(len, rows))
    data, words = np.array([r for r in rows if len(r) == width]), path.stem.split("_")
    if width == 12:  # HSVA, 20 Hz: psi, rudder in columns 3 and 8; both files count port positive
        return data[:, 0], data[:, 3], -data[:, 8], float(words[4]), float(words[5]), "kvlcc2_model"
    time = 0.1355 * np.arange(len(data))  # MARIN: time stamps are rounded
    return time, data[:, 4], -data[:, 9], abs(float(words[4])), abs(float(words[4])), "kvlcc2"


def compare_runs(folder):
    """Measured zigzags beside ours: first overshoots and mean time between reversals."""
    out = [f"  {'run':<30}{'overshoots measured':<24}{'ours':<24}half period [s] measured, ours"]
    runs = [(path.stem, *read_run(path)) for path in sorted(Path(folder).glob("*/*.dat"))]
    for hull in sorted({run[-1] for run in runs}):
        same = [run for run in runs if run[-1] == hull]
        plans = [
            [Leg(ZIGZAG, 999, first_side(rudder, angle) * angle, at)]
            for _, _, _, rudder, angle, at, _ in same
        ]
        voyages = sail(hull, plans, max(run[1][-1] for run in same))
        out += [run_line(voyage, *run) for voyage, run in zip(voyages, same, strict=True)]
    return out


def first_side(rudder, angle):
    """+1 when the first rudder goes to starboard."""
    return float(np.sign(rudder[np.argmax(np.abs(rudder) > 0.5 * angle)]))


def run_line(voyage, name, time, psi, rudder, angle, at, hull):
    """One measured zigzag beside ours."""
    theirs, their_times = trial_indices.overshoots(time, psi, rudder, angle)
    ours, our_times = measure_zigzag(voyage, angle, at)
    count = min(len(theirs), len(ours), 4)
    cells = [
        " ".join(f"{v:.1f}" for v in values[:count]) for values in ([o + angle - at for o in theirs], ours)
    ]
    periods = [half_period(times[: count + 2]) for times in (their_times, our_times)]
    return f"  {name:<30}{cells[0]:<24}{cells[1]:<24}{periods[0]:.1f} {periods[1]:.1f}"


def half_period(times):
    """Mean time between reversals [s], NaN when there is but one."""
    return float(np.mean(np.diff(times))) if len(times) > 1 else float("nan")


def main():
    print("\n".join(compare_standard()))
    folder = os.environ.get("SHIPTWIN_DATA")
    runs = Path(folder or ".") / "kvlcc2_simman"
    if folder and runs.is_dir():
        print("SIMMAN 2008 free runs, measured")
        print("\n".join(compare_runs(runs)))
    else:
        print(
            "Measured SIMMAN 2008 runs: skipped. Set SHIPTWIN_DATA to the folder that holds kvlcc2_simman/."
        )
    return 0
