"""What a builder's sheet says of a craft: the tables [[actuators]] and the options of `twin init`, rounded as
a sheet is, and without what is hidden."""

import math
from typing import Any

from bench.reference.boats.craft import CRAFT, Craft, Drive

KIND = {
    "thruster": "fixed_thruster",
    "pod": "azimuth",
    "jet": "waterjet",
    "tunnel": "tunnel_thruster",
    "shaft": "propeller",
}
IMPELLER = 2.0  # diameter of a jet's impeller over that of what leaves its nozzle


def actuators(craft: Craft) -> list[dict[str, Any]]:
    """A table for each drive."""
    return [_table(d, craft.rho) for d in craft.drives]


def _table(d: Drive, rho: float) -> dict[str, Any]:
    area = 0.25 * math.pi * d.D**2
    full = (1.0 if d.kind == "jet" else 0.5 * d.grip) * rho * area * (d.n_max * d.pitch) ** 2
    table: dict[str, Any] = {
        "name": d.name,
        "kind": KIND[d.kind],
        "channels": list(d.records),
        "x_m": d.x,
        "y_m": d.y,
    }
    if "rate_rpm" in d.records:
        D = d.D * (IMPELLER if d.kind == "jet" else 1.0)
        table |= {"diameter_m": D, "K_T0": _rounded(full / (rho * d.n_max**2 * D**4))}
    else:
        table |= {"ahead_n": _rounded(full), "astern_n": _rounded(full * d.astern)}
    if d.rudder:
        table["rudder_area_m2"] = d.rudder
    if d.kind == "tunnel":
        table["half_mps"] = 2.0
    return table


def _rounded(x: float) -> float:
    return float(f"{x:.2g}")


def text(name: str) -> str:
    """The file that `twin init --actuators` reads."""
    lines = [f"# {name}, as its builder has it"]
    for table in actuators(CRAFT[name]):
        lines += ["", "[[actuators]]", *(f"{k} = {_toml(v)}" for k, v in table.items())]
    return "\n".join(lines) + "\n"


def command(name: str, file: str) -> str:
    """The line that makes a first model of it."""
    options = " ".join(f"--{k} {v:.10g}" for k, v in particulars(CRAFT[name]).items())
    return f"twin init {name} {options} --actuators {file} -o {name}.toml"


def particulars(c: Craft) -> dict[str, float]:
    """Options of `twin init`."""
    return {
        "length-pp-m": c.L,
        "beam-m": c.B,
        "draught-m": c.T,
        "mass-kg": c.m,
        "service-speed-mps": c.U0,
        "frontal-area-m2": c.air[0],
        "lateral-area-m2": c.air[1],
    }


def _toml(value: Any) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(f'"{x}"' for x in value) + "]"
    return f'"{value}"' if isinstance(value, str) else f"{value:.10g}"
