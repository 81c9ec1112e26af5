"""`twin compare`: model against measurement, open loop from the measured state: how wrong, and where."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from twin.errors import DataError
from twin.num import as_given, num
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.jsonable import plain
from twin.study.estimation.start import BRIDGE_S, waves_on
from twin.study.prediction import locate, score
from twin.study.prediction.comparison_water import KEYS, in_own_water, in_words, stream_at_end, with_own_water
from twin.study.prediction.expected import with_expected_errors
from twin.study.prediction.openloop import HORIZONS_S, Windows, predict
from twin.study.prediction.unexplained import Energy, energy
from twin.study.reference.sailed import Sailed, fed, switched_off
from twin.study.reference.structure import noise_model_of
from twin.study.track.jumps import jumps_on

SCHEMA_VERSION = 1
# times what is expected, from which an error is more than it may be, where no reference voyages told how they
# scatter
UNUSUAL_RATIO = 1.5


@dataclass(frozen=True)
class ComparedVoyages:
    """What compare found (`result` is the JSON of docs/json.md), and what a report draws it from."""

    result: dict[str, Any]
    sailed: tuple[Sailed, ...]
    models: tuple[Model, ...]  # one for each voyage: without the effects that it cannot feed
    windows: tuple[Windows, ...]


def compare(
    sailed: Sequence[Sailed], model: Model, horizons_s: Sequence[float] = HORIZONS_S
) -> ComparedVoyages:
    """Predict every voyage open loop and judge the errors together. DataError: no voyage is long enough
    for a horizon, or a sign, unit or frame of one is proved wrong."""
    from twin.recording.checks import of_voyages

    ship, noise_model = model.ship, noise_model_of(model.ship)
    checks = of_voyages([s.voyage for s in sailed], ship)
    models = [fed(model, s.track)[0] for s in sailed]
    windows = [
        predict(s.track, m, horizons_s, noise_model=noise_model, seed=i)
        for i, (s, m) in enumerate(zip(sailed, models, strict=True))
    ]
    rows = with_expected_errors(score.horizons(windows, horizons_s, noise_model is not None), windows, ship)
    if not rows:
        raise DataError(
            f"{', '.join(s.track.name for s in sailed)}: no stretch of {as_given(min(horizons_s))} s with "
            "controls throughout that begins and ends where position and heading were read together. Give a "
            "longer voyage, or shorter horizons with --horizon, or record both at least every "
            f"{as_given(BRIDGE_S)} s."
        )
    water = in_own_water(windows, models)
    longest = rows[-1]["horizon_s"]
    judged = energy([s.track for s in sailed], models)
    where = locate.regimes(windows, _locating(rows), ship, noise_model is not None)
    result = _result(ship, model, sailed, with_own_water(rows, water), judged)
    result |= {
        "voyages": [
            s.provenance() | {"duration_s": s.voyage.duration_s, "stream": stream_at_end(w)}
            for s, w in zip(sailed, water, strict=True)
        ],
        "data_checks": checks,
        "channels": score.channels(windows, noise_model is not None),
        "where": [{k: v for k, v in w.items() if k != "mask"} for w in where],
        "worst_windows": locate.worst(windows, longest),
        "switched_off": switched_off(model, [s.track for s in sailed]),
        "waves": waves_on([s.track for s in sailed]),
        "jumps": jumps_on([s.track for s in sailed]),
    }
    result |= {"verdict": verdict(result), "water_sentence": water_sentence(result)}
    return ComparedVoyages(plain(result), tuple(sailed), tuple(models), tuple(windows))


def _result(
    ship: Ship, model: Model, sailed: Sequence[Sailed], rows: list[dict[str, Any]], judged: Energy
) -> dict[str, Any]:
    from twin.live.learning.residual import ship_hash

    return {
        "schema_version": SCHEMA_VERSION,
        "ship": ship.name,
        "model": {
            "effects": [type(e).__name__ for e in model.effects],
            "hash": ship_hash(ship),
            "residual": model.residual is not None,
        },
        "horizons": rows,
        "unexplained_force": judged.unexplained(),
        "learned_share": judged.learned_share(),
    }


def _locating(rows: list[dict[str, Any]]) -> float:
    """The horizon at which errors are located: one below the longest, since a shorter window says better when
    it happened."""
    return float(rows[max(len(rows) - 2, 0)]["horizon_s"])


def verdict(result: dict[str, Any]) -> str:
    """The sentence that an engineer reads first: of the longest horizon, or, where that one is no worse than
    it may be, of the one that stands out most."""
    row, clearly = _decisive(result["horizons"])
    expects, times = row["noise_floor"], [score.in_noise(row, k) for k in KEYS]
    of = "of the sensors alone" if expects["of"] == "sensors" else "for this calibrated ship"
    error = f"{num(row[KEYS[0]], 3)} m and {num(row[KEYS[1]], 2)} deg"
    expected = f"expected {of}: {num(expects[KEYS[0]], 2)} m and {num(expects[KEYS[1]], 2)} deg"
    ratio = f"ratio {num(times[0], 3)} and {num(times[1], 3)}"
    which = "" if row is result["horizons"][-1] else " (of all horizons it stands out most)"
    head = f"{as_given(row['horizon_s'])} s open-loop error{which}: {error}; {expected} ({ratio})"
    stay = "95 % of healthy voyages stay" if "limit95" in expects else "a healthy voyage usually stays"
    usual = f"({stay} below {num(clearly, 3)})"
    if max(times) < clearly:
        return f"{head}: no more than expected {usual}."
    where = (
        f"; it is {num(w['error_ratio'], 2)} times larger with {w['condition']} than elsewhere"
        for w in result["where"][:1]
    )
    return f"{head}: more than expected {usual}{''.join(where)}."


def water_sentence(result: dict[str, Any]) -> str:
    """What the water of the day has to do with an error that is more than expected; empty for one that is
    not."""
    row, clearly = _decisive(result["horizons"])
    if max(score.in_noise(row, k) for k in KEYS) < clearly:
        return ""
    return in_words(row, [v["stream"] for v in result["voyages"]], clearly)


def _decisive(rows: list[dict[str, Any]]) -> tuple[dict[str, Any], float]:
    """The horizon of which the verdict is, and times the expected error from which it is more than that."""
    most = [max(score.in_noise(row, k) for k in KEYS) for row in rows]
    clearly = float(rows[-1]["noise_floor"].get("limit95", UNUSUAL_RATIO))
    return rows[-1 if most[-1] >= clearly or max(most) < clearly else most.index(max(most))], clearly
