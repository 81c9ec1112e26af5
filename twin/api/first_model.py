"""`twin.first_model`: a first model of a ship from what its owner knows, before any voyage."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from twin.api.result import Result
from twin.errors import UsageError, did_you_mean
from twin.num import as_given
from twin.physics.actuators import Actuator
from twin.physics.ship import Ship
from twin.study.first_model.first_estimate import OPTIONS, Given
from twin.study.first_model.first_estimate import first_model as estimated
from twin.study.first_model.first_trial import doubts, sea_trial, summary

SCHEMA_VERSION = 1


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
        notes = self.ship.notes
        return [
            {"section": section, "name": name, **entry}
            for section in ("particulars", "derivatives")
            for name, entry in notes[section].items()
        ]

    def page(self) -> str:
        """What it does in the standard manoeuvres, and every number with its source."""
        from twin.report.result_page import PageTable, result_page

        trial = [{"figure": k, "value": v} for k, v in self.trial.items()]
        columns = {"section": "section", "name": "number", "value": "value", "source": "source"}
        return result_page(
            f"{self.ship.name}: a first model",
            f"{self.ship.name}: a first model from its main particulars.",
            self.warnings,
            (
                PageTable("Sea trial of this model", {"figure": "figure", "value": "value"}, trial),
                PageTable("Numbers", columns, self._rows()),
            ),
        )

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
