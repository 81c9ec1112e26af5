"""What a row's answer is worth, held against what was hidden."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Any

from bench.fleet.hidden_causes import CATALOGUE, OF_THE_VOYAGE

Row = Mapping[str, Any]
GAINS = 0.10  # share by which its oracle must bring the ship nearer, for a cause to count as one to be found
SAME = {"Current": {"Current", "VaryingCurrent"}, "VaryingCurrent": {"Current", "VaryingCurrent"}}
# kinds that were outside the catalogue when the fleet was made -> the effects that they are by now
BY_NOW = {"SlowCompass": {"HeadingLag"}, "RateScale": {"GyroScale"}}
FORM_OF = {"memory": "modulus", "heeling": "mmg"}  # families of hulls that add to the form of another
WEATHER_PROBABILITY = 0.5  # probability from which weather is told as today's


@dataclass(frozen=True)
class Share:
    """So many of so many, with its 95 % interval (Wilson 1927)."""

    k: int
    n: int

    def interval(self) -> tuple[float, float]:
        if not self.n:
            return 0.0, 1.0
        z, p, n = 1.96, self.k / self.n, self.n
        middle, half = p + z * z / (2 * n), z * sqrt(p * (1 - p) / n + z * z / (4 * n * n))
        return max(middle - half, 0.0) / (1 + z * z / n), (middle + half) / (1 + z * z / n)

    def __str__(self) -> str:
        if not self.n:
            return "-"
        lo, hi = self.interval()
        return f"{self.k} of {self.n}, {self.k / self.n:.0%} ({lo:.0%} to {hi:.0%})"


def share(marks: Sequence[bool]) -> Share:
    return Share(sum(map(bool, marks)), len(marks))


def causes(names: Sequence[str]) -> set[str]:
    """Those of a list of effects that belong to ship or instruments."""
    return {n for n in names if n not in OF_THE_VOYAGE}


def hidden_causes(row: Row) -> set[str]:
    """The hidden causes of ship and instruments, by the names that the catalogue has for them by now; none on
    a healthy voyage."""
    its = () if row["kind"] == "nothing" else row["hidden"]
    return causes(list(its)).union(*(BY_NOW.get(n, ()) for n in its))


def kind(row: Row) -> str:
    """What is hidden: nothing, a single cause, a pair, a triple; what is in no catalogue (outside), or was in
    none when the fleet was made (by now)."""
    by_now = row["kind"] == "outside" and all(n in BY_NOW for n in row["hidden"])
    return "by now" if by_now else str(row["kind"])


def form(row: Row) -> str:
    """The form of the ship's hull: families of one form are left out of a fit together."""
    return FORM_OF.get(row["family"], row["family"])


def answered_weather(row: Row) -> set[str]:
    """Water and weather that an answer tells, as missing or as today's."""
    today = {w["effect"] for w in row.get("weather", ()) if w["probability"] >= WEATHER_PROBABILITY}
    return today | {n for n in row["missing"] if n in OF_THE_VOYAGE}


def right(row: Row, missing: Sequence[str] | None = None, verdict: str | None = None) -> bool:
    """Whether an answer says what the truth is: every hidden cause of ship and instruments and no other, and
    every hidden weather, and nothing unknown beside; no cause on a healthy ship; of what is in no catalogue,
    no name."""
    missing, verdict = row["missing"] if missing is None else missing, verdict or row["verdict"]
    named, of = causes(missing), kind(row)
    if of == "outside":
        return not named and verdict in ("unknown", "undecided")
    if of == "by now":
        return named == set().union(*(BY_NOW[n] for n in row["hidden"]))
    if of == "nothing":
        return not named and verdict != "unknown"
    seen = answered_weather(row) | set(missing)
    weather = all(SAME.get(n, {n}) & seen for n in row["hidden"] if n in OF_THE_VOYAGE)
    return named == hidden_causes(row) and weather and verdict != "unknown"


def alarm(row: Row) -> bool:
    """Whether an answer accuses ship or instruments: a cause is named, or something unknown."""
    return bool(causes(row["missing"])) or row["verdict"] == "unknown"


def gains(row: Row) -> bool:
    """Whether the truth, known, would bring the ship a tenth nearer to where it went."""
    oracle = row.get("oracle")
    return oracle is not None and bool(oracle["with_m"] <= (1 - GAINS) * oracle["without_m"])


def each_gains(row: Row) -> bool:
    """Whether all that is hidden are causes of ship and instruments, of which each, the others known, would
    bring the ship a tenth nearer."""
    gain_by_each = (row.get("oracle") or {}).get("gain_by_each") or {}
    return len(gain_by_each) == len(row["hidden"]) and all(gain >= GAINS for gain in gain_by_each.values())


def wrong_names(row: Row, missing: Sequence[str] | None = None) -> set[str]:
    """Causes of ship and instruments that are named and not there."""
    return causes(row["missing"] if missing is None else missing) - hidden_causes(row)


def of_weather(row: Row) -> bool:
    """Whether all that is hidden is water and weather."""
    return not causes(list(row["hidden"]))


def astray(row: Row, limit: float = 1.5) -> bool:
    """Whether the model with the day's weather ends clearly farther off than is usual on this ship."""
    return bool(row["facts"]["error_nothing"] > limit)


def truths(row: Row) -> dict[str, float]:
    """Numbers of what is hidden, as the twin's effects have them; a foreign form at service speed."""
    if "truths" in row:  # an answer as it is kept (kept_rows.py)
        return dict(row["truths"])
    f, hidden = row["flaws"], row["hidden"]
    one = {
        "HeadingBias.bias": f.get("heading"),
        "GyroBias.bias": f.get("gyro"),
        "SpeedLogBias.bias": f.get("log_bias"),
        "SpeedLogScale.scale": f.get("log_scale"),
        "SensorDelay.delay": f["late_s"] + row.get("own_late_s", 0.0) if "late_s" in f else None,
        "RudderOffset.offset": f.get("rudder_offset"),
        "PropellerWear.loss": f.get("prop_wear"),
        "RudderWear.loss": f.get("rudder_wear"),
        "Loading.mass": f.get("mass"),
        "HullFouling.extra": 0.4 * hidden["HullFouling"] if "HullFouling" in hidden else None,
    }
    pairs = {
        "AntennaOffset": (("ahead", "starboard"), "antenna"),
        "TowForce": (("ahead", "starboard", "turning"), "tow"),
        "ExternalForce": (("north", "east"), "pull"),
    }
    for name, (keys, flaw) in pairs.items():
        if flaw in f:
            one |= {f"{name}.{k}": v for k, v in zip(keys, f[flaw], strict=True)}
    return {k: float(v) for k, v in one.items() if v is not None and k.split(".")[0] in hidden}


def intervals(row: Row) -> list[tuple[str, bool]]:
    """Of every number of a cause that is rightly named: which, and whether its 95 % interval holds the
    truth."""
    true, out = truths(row), []
    for c in row["candidates"]:
        if c["effect"] in row["missing"] and c["effect"] in row["hidden"]:
            for p in c["parameters"]:
                label = f"{c['effect']}.{p['name']}"
                if label in true:
                    out.append((label, p["low95"] <= true[label] <= p["high95"]))
    return out


def posterior(candidate: Mapping[str, Any]) -> float:
    """The posterior probability of a cause; an answer of before 26 November 2026 told no other."""
    return float(candidate.get("posterior", candidate.get("probability")))


def answered_posteriors(row: Row) -> list[tuple[float, bool]]:
    """The posterior of every cause that an answer tells, and whether the cause is there."""
    return [
        (posterior(c), c["effect"] in hidden_causes(row))
        for c in row["candidates"]
        if c["effect"] in CATALOGUE and c["effect"] not in OF_THE_VOYAGE
    ]
