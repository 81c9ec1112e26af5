"""`twin.first_model`: a first model of a ship from what its owner knows, before any voyage."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from twin.api.result import Result
from twin.api.simulation import simulate
from twin.errors import UsageError, did_you_mean
from twin.num import as_given, num, readable
from twin.physics.actuators import Actuator
from twin.physics.ship import Ship, to_table
from twin.study.first_model.first_estimate import OPTIONS, Given
from twin.study.first_model.first_estimate import first_model as estimated
from twin.study.first_model.first_trial import IMO, doubts, sea_trial, summary

if TYPE_CHECKING:
    from twin.report.curves import Curves

SCHEMA_VERSION = 1
FIGURES = {  # figure of the sea trial -> what it is called, its unit
    "shaft_speed_rpm": ("shaft speed at service speed", "rpm"),
    "power": ("power at service speed, share of full", ""),
    "service_speed_mps": ("service speed", "m/s"),
    **{key: (words, unit) for key, words, unit, _ in IMO},
    "speed_left": ("share of the speed that is left in the turn", ""),
    "straight_line_stability": ("straight-line stability (above zero: goes straight by itself)", ""),
}


@dataclass(frozen=True, repr=False)
class FirstModel(Result):
    """`ship`: with every number's source, given or estimated. Its rows are the particulars and derivatives:
    value, unit, source."""

    ship: Ship
    given: Given = field(repr=False)

    @property
    def trial(self) -> dict[str, Any]:
        """What the model does in the standard manoeuvres: turning circle at 35 deg and 20/20 zigzag, lengths
        in ship lengths L, angles in deg, speed in m/s, shaft in rpm."""
        return dict(self.data["trial"])

    @property
    def warnings(self) -> list[str]:
        """What is unusual about the model or the numbers, in words an owner can act on."""
        return list(self.data["warnings"])

    def text(self) -> list[str]:
        """The lines of `twin init`."""
        return summary(self.ship, self.trial, self.warnings, self.given).splitlines()

    def _rows(self) -> Any:
        notes, table = self.ship.notes, to_table(self.ship)
        return [
            {
                "section": section,
                "name": name,
                "value": entry["value"],
                "unit": table[section].get(name, {}).get("unit", "-"),  # an actuator's own share has none
                **entry,
            }
            for section in ("particulars", "derivatives")
            for name, entry in notes[section].items()
        ]

    def page(self) -> str:
        """What it does in the standard manoeuvres, beside the IMO's limits, and every number with its
        source."""
        from twin.report.result_page import PageTable, result_page

        columns = {
            "section": "section",
            "name": "number",
            "value": "value",
            "unit": "unit",
            "source": "source",
        }
        sources = [{"short": k, "long": v} for k, v in self.ship.notes.get("sources", {}).items()]
        return result_page(
            f"{self.ship.name}: a first model",
            f"{self.ship.name}: a first model from its main particulars.",
            self.warnings,
            (
                PageTable(
                    "Sea trial of this model",
                    {"is": "figure", "value": "value", "limit": "IMO"},
                    self._figures(),
                ),
                *self._manoeuvres(),
                PageTable("Numbers", columns, [readable(r) for r in self._rows()], given=("value",)),
                PageTable("Sources", {"short": "short", "long": "source"}, sources),
            ),
        )

    def _figures(self) -> list[dict[str, Any]]:
        """The sea trial in words, with units, and the limits of MSC.137(76)."""
        limits = {key: f"at most {as_given(limit)} {unit}" for key, _, unit, limit in IMO}
        return [
            {"is": FIGURES.get(key, (key, ""))[0], "value": _of(value, key), "limit": limits.get(key)}
            for key, value in self.trial.items()
        ]

    def _manoeuvres(self) -> list["Curves"]:
        """Turning circle in ship lengths, and the heading in the zigzag."""
        from twin.report.curves import Curve, Curves

        length_s = float(self.ship.L_pp / self.ship.U_0)
        circle = simulate(self.ship, manoeuvre="circle_35", duration_s=14.0 * length_s).data["columns"]
        turned = simulate(self.ship, manoeuvre="zigzag_20", duration_s=25.0 * length_s).data["columns"]
        L, every = float(self.ship.L_pp), slice(None, None, 4)
        way = [(e / L, n / L) for e, n in zip(circle["east_m"], circle["north_m"], strict=True)][every]
        headings = [(h + 180.0) % 360.0 - 180.0 for h in turned["heading_true_north_deg"]]
        swing = list(zip(turned["time_s"], headings, strict=True))[every]
        return [
            Curves(
                "Turning circle, rudder 35 deg to starboard",
                "to starboard [ship lengths]",
                "ahead [ship lengths]",
                [Curve("track", "--model", way)],
                even=True,
            ),
            Curves("Zigzag 20/20", "time [s]", "heading [deg]", [Curve("heading", "--model", swing)]),
        ]

    def __repr__(self) -> str:
        return (
            f"<FirstModel of {self.ship.name!r}: {as_given(self.ship.L_pp)} m, {len(self.warnings)} warnings>"
        )


def first_model(
    name: str,
    length_pp_m: float,
    beam_m: float,
    draught_m: float,
    *,
    actuators: Sequence[Actuator] = (),
    **known: float,
) -> FirstModel:
    """A ship from its main particulars [m]; what is not given is estimated by published regressions.

    `known`: what else an owner knows, by the names of `twin init --help` with `_` for `-`, such as
    `block_coefficient=0.8`, `service_speed_mps=7.5`, `shaft_speed_rpm=90`. `actuators`: what drives and
    steers the ship where that is not a propeller with a rudder. UsageError for a name that is not known;
    SettingsError where a number cannot be right. A second.
    """
    names = [option.replace("-", "_") for option, *_ in OPTIONS]
    for key in known:
        if key not in names:
            raise UsageError(f"no particular is called {key!r}.{did_you_mean(key, names)}")
    numbers = {"length_pp_m": length_pp_m, "beam_m": beam_m, "draught_m": draught_m, **known}
    given: Given = {option: numbers.get(option.replace("-", "_")) for option, *_ in OPTIONS}
    ship, warnings = estimated(name, given, tuple(actuators))
    trial = sea_trial(ship)
    said = {
        "schema_version": SCHEMA_VERSION,
        "ship": ship.name,
        "trial": trial,
        "warnings": warnings + doubts(trial, ship.C_b),
    }
    return FirstModel(ship, given, data=said)


def _of(value: float | None, key: str) -> str:
    return "none" if value is None else f"{num(value, 3)} {FIGURES.get(key, ('', ''))[1]}".strip()
