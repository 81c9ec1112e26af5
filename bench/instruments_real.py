"""Real voyages for `twin-bench instruments`: two circles of a yacht by NMEA 2000, and a model of Esso Osaka
on a pond. Nothing is planted."""

from pathlib import Path

import numpy as np

from twin.live.signals.channels import BY_NAME
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage
from twin.study.instruments.instrument_estimate import Instruments, estimate
from twin.study.instruments.instrument_lines import terminal_lines

YACHT = ("furuno-130842-figure8-fast.raw", "furuno-130842-wide-turn.raw")
SOURCES = {"": "52", "yaw_rate_degps": "27"}  # the faster of two rate sensors
ESSO = ("turn_14-Oct-2020_14_08_51.csv", "turn_14-Oct-2020_14_29_49.csv", "zigzag_31-Jul-2020_13_04_24.csv")
ESSO_LENGTH_M = 3.0
CHANNELS = {  # column -> channel
    "x_position_mid [m]": "north_m",
    "y_position_mid [m]": "east_m",
    "u_velo [m/s]": "surge_velocity_mps",
    "vm_velo [m/s]": "sway_velocity_mps",
    "psi_hat [rad]": "heading_true_north_deg",
    "r_angvelo [rad/s]": "yaw_rate_degps",
}


def findings(data: Path) -> dict[str, Instruments]:
    """What is found of each voyage that is there."""
    out = {}
    for name in YACHT:
        path = data / "logs" / "nmea2000" / name
        if path.is_file():
            out[name] = estimate([read_voyage(path, sources=SOURCES, controls=False)])
    for name in ESSO:
        path = data / "esso_osaka" / name
        if path.is_file():
            out[name] = estimate([esso(path)], ESSO_LENGTH_M)
    return out


def esso(path: Path) -> Voyage:
    """One run; velocities come in the model's own axes."""
    with open(path, encoding="utf-8") as file:
        names = file.readline().strip().split(",")
    rows = np.genfromtxt(path, delimiter=",", skip_header=1)
    columns = {channel: rows[:, names.index(c)] / BY_NAME[channel].to_si for c, channel in CHANNELS.items()}
    return Voyage(path.stem, rows[:, names.index("t [s]")], columns, {"velocity_frame": "body"})


def page(found: dict[str, Instruments]) -> list[str]:
    """Markdown: what the verb says of each."""
    lines = [
        "",
        "## Real voyages",
        "",
        "Nothing is planted and no truth is known but that two circles of one yacht must agree.",
        "",
    ]
    for name, instruments in found.items():
        lines += [f"### {name}", "", "```text", *terminal_lines(instruments), "```", ""]
    if all(name in found for name in YACHT):
        lines += _log([found[name] for name in YACHT])
    return lines


def log_lacks(found: Instruments) -> float:
    """How much the log shows too little at the voyage's usual speed [m/s]: by its scale, its bias or both,
    whichever were seen."""
    at = {"log_scale": found.readings[0].speed, "log_bias": 1.0}
    return -sum(k * e.value for name, k in at.items() if name in found.faults and (e := found.of(name)))


def _log(circles: list[Instruments]) -> list[str]:
    """What the yacht's log lacks at the speed of each circle."""
    lines = ["| circle | speed over ground m/s | log lacks m/s | shown over true |", "|---|---|---|---|"]
    for i in circles:
        speed, lacks = i.readings[0].speed, log_lacks(i)
        lines.append(f"| {i.readings[0].name} | {speed:.2f} | {lacks:.3f} | {1.0 - lacks / speed:.3f} |")
    return lines
