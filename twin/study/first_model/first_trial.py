"""What a first model does in the standard manoeuvres, and what an owner is told of it."""

from collections.abc import Mapping
from math import radians
from typing import Any

from twin.num import as_given, num, percent
from twin.physics.actuators import Actuator
from twin.physics.actuators.helm import ACROSS, actuator_orders
from twin.physics.model import Model
from twin.physics.particulars import ONE_SCREW
from twin.physics.ship import PARTICULARS, Ship
from twin.study.first_model import regressions as reg
from twin.study.first_model.first_estimate import Given
from twin.study.prediction.trial import shaft_speed, straight_line_stability, turning_circle, zigzag

# what is given, and is no particular of the ship file
INSIDE = ("shaft-speed-rpm", "propellers", "pitch-ratio", "rudder-height-m")


IMO = (  # MSC.137(76): figure, what it is called, its unit, its limit
    ("advance_L", "advance of the turning circle", "L", 4.5),
    ("tactical_diameter_L", "tactical diameter", "L", 5.0),
    ("overshoot_20_20_deg", "first overshoot of the 20/20 zigzag", "deg", 25.0),
)
USUAL_DIAMETERS_L = (1.8, 6.5)  # tactical diameters of ships, in ship lengths
FULL_C_B = 0.7  # block coefficient from which ships often do not go straight by themselves


def sea_trial(ship: Ship) -> dict[str, Any]:
    """What this model does in the standard manoeuvres: the check that an owner can make by eye."""
    model = Model.of(ship)
    circle = turning_circle(model, radians(35.0))
    over = zigzag(model, radians(20.0), radians(20.0))
    figures = {
        "shaft_speed_rpm": None if ship.actuators else 60.0 * shaft_speed(model, ship.U_0),
        **({"power": shaft_speed(model, ship.U_0)} if ship.actuators else {}),
        "service_speed_mps": ship.U_0,
        "advance_L": circle.advance,
        "tactical_diameter_L": circle.tactical_diameter,
        "speed_left": circle.speed_left,
        "overshoot_20_20_deg": over[0] if over else None,
        "straight_line_stability": straight_line_stability(model),
    }
    return {k: None if v is None else float(f"{v:.4g}") for k, v in figures.items()}


def _driven(ship: Ship, figures: Mapping[str, Any], bridge: str) -> str:
    """What drives the ship at service speed."""
    at = f"at {num(ship.U_0, 3)} m/s ({ship.U_0 / 0.514444:.1f} kn)"
    if not ship.actuators:
        return f"{figures['shaft_speed_rpm']:.0f} rpm {at}: {bridge}"
    orders = actuator_orders(ship, 0.0, figures["power"])
    driving = [a for a in ship.actuators if a.kind != ACROSS]
    turns = {a.name: f"{60.0 * orders[f'{a.name}.rate']:.0f} rpm" for a in driving if "rate" in a.attributes}
    if not turns:
        return f"{100.0 * figures['power']:.0f} % of the power of {len(driving)} actuators {at}"
    alike = len(set(turns.values())) == 1
    told = next(iter(turns.values())) if alike else ", ".join(f"{n} {rpm}" for n, rpm in turns.items())
    return f"{told} {at}: {bridge}"


def _parts(ship: Ship) -> list[str]:
    """A line for each actuator: what it is, where it stands, its strength and where that is from."""
    lines = ["", "  actuators"] if ship.actuators else []
    for a in ship.actuators:
        lines.append(f"    {a.name:12} {a.kind:18} {_place(a):44} {_strength(ship, a)}".rstrip())
    return lines


def _place(a: Actuator) -> str:
    ahead = f"{as_given(abs(a.x))} m {'ahead of' if a.x > 0.0 else 'astern of'} midship" if a.x else "midship"
    return f"{ahead}, {as_given(abs(a.y))} m to {'starboard' if a.y > 0.0 else 'port'}" if a.y else ahead


def _strength(ship: Ship, a: Actuator) -> str:
    if "rate" in a.attributes:
        source = ship.notes["derivatives"].get(f"{a.name}.K_T0", {}).get("source", "")
        mark = f"  estimated: {reg.SOURCES[source].split(',')[0]}" if source else ""
        return f"{as_given(a.D)} m, K_T0 {num(a.K_T0, 3)}, K_T1 {num(a.K_T1, 3)}{mark}"
    if a.ahead is None or a.astern is None:
        return "its thrust is recorded"
    return f"{as_given(a.ahead)} N ahead, {as_given(a.astern)} N astern at rest"


def _helm(ship: Ship) -> str:
    """How the turning circle is steered."""
    turned = not ship.actuators or any("angle" in a.attributes for a in ship.actuators)
    return " 35 deg" if turned else ", one side stopped and the other at twice its power"


def doubts(figures: Mapping[str, Any], C_b: float) -> list[str]:
    """In words, what is unusual about a trial of so full a ship."""
    out = []
    if figures["straight_line_stability"] <= 0 and C_b < FULL_C_B:
        out.append(
            f"that so fine a hull (C_b {C_b:.2f}) does not go straight by itself is rare, and more likely "
            "an error of these regressions than of "
            "your numbers: calibrate before you trust how it turns"
        )
    low, high = USUAL_DIAMETERS_L
    if not low <= figures["tactical_diameter_L"] <= high:
        out.append(
            f"tactical diameter {figures['tactical_diameter_L']:.1f} L is unusual ({as_given(low)} to "
            f"{as_given(high)} L): check rudder area and speed, and calibrate"
        )
    if figures["speed_left"] < 0.2:
        out.append(
            f"only {percent(figures['speed_left'])} of the speed is left in the turn: check draught and "
            "propeller, and calibrate"
        )
    if figures["overshoot_20_20_deg"] is None or figures["overshoot_20_20_deg"] > 40.0:
        out.append("the 20/20 zigzag does not settle as ships do: check rudder area, and calibrate")
    return out


def summary(ship: Ship, figures: Mapping[str, Any], warnings: list[str], given: Given) -> str:
    """What was given, what was estimated and from where, and the sea trial."""
    notes = ship.notes["particulars"]
    lines = [f"{ship.name}: a first model from its main particulars", ""]
    for f in PARTICULARS:
        source = notes[f.name]["source"]
        idle = bool(ship.actuators) and f.name in ONE_SCREW
        if idle and source != "given":
            continue
        mark = (
            "not used: each actuator has its own"
            if idle
            else ""
            if source == "given"
            else f"estimated: {reg.SOURCES.get(source, source).split(':')[0]}"
        )
        lines.append(
            f"  {f.name:5} {as_given(getattr(ship, f.name), 5):>12} {f.metadata['unit']:6} "
            f"{f.metadata['doc']:38} {mark}".rstrip()
        )
    inside = [o for o in INSIDE if f"--{o} is not used" not in " ".join(warnings)]
    others = [f"--{o} {as_given(value)}" for o in inside if (value := given[o]) is not None]
    lines += ["", f"  also given, and in its numbers: {', '.join(others)}"] if others else []
    lines += _parts(ship)
    bridge = "as given" if given["shaft-speed-rpm"] else "compare it with the bridge's"
    unstable = "does not go straight by itself" + ", as many full ships" * (ship.C_b >= FULL_C_B)
    stable = "goes straight by itself" if figures["straight_line_stability"] > 0 else unstable
    over = figures["overshoot_20_20_deg"]
    lines += [
        "",
        "  sea trial of this model (estimates; how it turns is only roughly right until it is calibrated)",
        f"    {_driven(ship, figures, bridge)}",
        f"    turning circle{_helm(ship)}: advance {figures['advance_L']:.1f} L, tactical diameter "
        f"{figures['tactical_diameter_L']:.1f} L,"
        f" {100 * figures['speed_left']:.0f} % of the speed left",
        f"    zigzag 20/20: first overshoot {'none' if over is None else f'{over:.0f} deg'};  {stable}",
    ]
    return "\n".join(lines + ([""] + [f"  careful: {w}" for w in warnings] if warnings else []))
