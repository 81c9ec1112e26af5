"""A cause of a diagnosis in the units of the bridge: its numbers, its direction, what it changes."""

from collections.abc import Iterable, Mapping, Sequence
from math import degrees
from typing import Any

import numpy as np

from twin.num import READABLE
from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.report.series import packed, stitched
from twin.study.diagnosis.set_and_rate import stream_in_words
from twin.study.prediction.unexplained import AXES
from twin.study.reference.sailed import fed
from twin.study.track.track import READINGS, STATE, Track

KNOT = 1852.0 / 3600.0
BRIDGE = READABLE | {  # unit of a number -> unit of the bridge, what it is multiplied by
    "m/s": ("kn", 1.0 / KNOT),
    "N": ("kN", 1e-3),
    "N m": ("MN m", 1e-6),
}
SHARES = ("extra", "loss", "scale", "share", "slip")  # numbers without unit that are parts of a whole
WAYS = {  # axis -> in words, where the force is positive, and where it is negative
    "surge": ("with the motion", "against the motion"),
    "sway": ("to starboard", "to port"),
    "yaw": ("turning to starboard", "turning to port"),
}
ONE_WAY = 0.5  # mean over root mean square from which a force is said to act one way
MAX_CAUSES_TRIED = 6  # causes that are predicted with


def number(p: Mapping[str, Any]) -> dict[str, Any]:
    """One number of an effect, with its interval, as the bridge speaks of it."""
    unit, k = BRIDGE.get(p["unit"], (p["unit"], 1.0))
    if p["unit"] == "-":
        unit, k = ("%", 100.0) if p["name"] in SHARES else ("", 1.0)
    sizes = {key: None if p.get(key) is None else k * p[key] for key in ("value", "low95", "high95")}
    return {"name": p["name"], "unit": unit, **sizes}


def with_cause(model: Model, candidate: Mapping[str, Any], key: str = "value") -> Model | None:
    """The model with a candidate at its estimate (`key`: value, low95 or high95); None when it cannot be."""
    effect = of_ship(model.ship).get(candidate["effect"])
    values = {p["name"]: p.get(key) for p in candidate.get("parameters", [])}
    if effect is None or any(v is None for v in values.values()) or not values:
        return None
    present = next((e for e in model.effects if type(e) is effect), None) or effect.absent(model.ship)
    known = {p.name for p in effect.params()}
    return model.but(present.but(**{k: v for k, v in values.items() if k in known}))


def ways(tracks: Sequence[Track], model: Model, name: str) -> list[str]:
    """Which way the force of an effect acts, in words, axis by axis; empty when it makes none."""
    sums, squares = np.zeros(3), np.zeros(3)
    known_energy = np.zeros(3)
    for track in tracks:
        known_model = fed(model, track)[0]
        s = track.situation(**dict(zip(STATE, track.state.T, strict=True)))
        forces = known_model.known(s)
        if name not in forces:
            return []
        f = [np.broadcast_to(np.asarray(x, float), track.t.shape)[track.whole] for x in forces[name]]
        sums += [x.sum() for x in f]
        squares += [np.square(x).sum() for x in f]
        every = [
            np.broadcast_to(np.asarray(x, float), track.t.shape)[track.whole]
            for g in forces.values()
            for x in g
        ]
        known_energy += [sum(np.square(x).sum() for x in every[i::3]) for i in range(3)]
    count = sum(int(t.whole.sum()) for t in tracks) or 1
    out = []
    for axis, total, square, energy in zip(AXES, sums, squares, known_energy, strict=True):
        rms = (square / count) ** 0.5
        if square < 1e-4 * energy or rms == 0.0:
            continue
        ahead, astern = WAYS[axis]
        mean = total / count
        side = ahead if mean > 0.0 else astern
        out.append(side if abs(mean) > ONE_WAY * rms else f"{ahead} and {astern} by turns")
    return out


def cause_view(
    tracks: Sequence[Track], model: Model, candidate: Mapping[str, Any], horizon_s: float
) -> dict[str, Any]:
    """A cause for the page: numbers (of a stream also in words), ways, the lines predicted with it, and what
    it changes."""
    told: dict[str, Any] = {
        "effect": candidate["effect"],
        "numbers": [number(p) for p in candidate.get("parameters", [])],
        "stream": stream_in_words(candidate.get("stream", [])),
    }
    better = with_cause(model, candidate)
    if better is None:
        return told
    told["ways"] = ways(tracks, better, candidate["effect"])
    plain = [stitched(t, fed(model, t)[0], horizon_s)[0] for t in tracks]
    lines = [stitched(t, fed(better, t)[0], horizon_s)[0] for t in tracks]
    told["lines"] = [
        {name: packed(line[:, i] * _k(name)) for i, name in enumerate(READINGS)} for line in lines
    ]
    changes = {"value": changed(plain, lines)}
    if len(candidate["parameters"]) == 1:
        for key in ("low95", "high95"):
            other = with_cause(model, candidate, key)
            if other is not None:
                changes[key] = changed(plain, [stitched(t, fed(other, t)[0], horizon_s)[0] for t in tracks])
    told["changes"] = [
        {"what": what, "unit": unit} | {key: c[what] for key, c in changes.items()}
        for what, unit in (("speed", "kn"), ("heading", "deg"), ("place", "m"))
    ]
    return told


def changed(plain: Iterable[np.ndarray], lines: Iterable[np.ndarray]) -> dict[str, float | None]:
    """What a cause changes in the predictions, on average over them: speed ahead [kn], and how far heading
    [deg] and place [m] are moved."""
    d = np.concatenate([b - a for a, b in zip(plain, lines, strict=True)])
    at = {name: d[:, i] for i, name in enumerate(READINGS)}

    def mean(x: np.ndarray) -> float | None:
        return float(np.nanmean(x)) if np.isfinite(x).any() else None

    return {
        "speed": mean(at["u"] / KNOT),
        "heading": mean(np.abs(np.degrees(at["psi"]))),
        "place": mean(np.hypot(at["x"], at["y"])),
    }


def _k(name: str) -> float:
    return degrees(1.0) if name in ("psi", "r") else 1.0
