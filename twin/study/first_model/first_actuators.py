"""What a first model has of actuators that their builders do not tell: drag, legs, thrust by turns, the wake
of several screws."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from twin.errors import SettingsError
from twin.num import as_given, num
from twin.physics.actuators import KINDS, Actuator
from twin.physics.actuators.helm import ACROSS, actuator_orders
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.state import Situation
from twin.study.first_model import regressions as reg
from twin.study.first_model.halving import matching

# drag of a screw that stands still, over rho D^2 u^2: a plate of half its disc; a jet has no blades in the
# stream, and none runs along a tunnel
OVERRUN_DRAG = 0.2  # of rho D^2 u^2 [-]
# what carries an azimuth's propeller: a fin half a diameter long and a whole one deep, of aspect ratio 2
LEG = 0.5 * 6.13 * 2.0 / (2.0 + 2.25)  # area times slope of the normal force, over D^2 [-]
BLADES = ("propeller", "controllable_pitch", "fixed_thruster", "azimuth", "outboard")
LEAST_PITCH, MOST_PITCH = 0.3, 2.0  # over the diameter, of screws that are built
OF_SCREWS = ("propellers", "pitch-ratio", "shaft-speed-rpm")
Given = Mapping[str, float | None]
Numbers = dict[str, tuple[float, str]]  # name -> value, source


def one_screw(actuators: tuple[Actuator, ...]) -> Numbers:
    """Diameter [m] of the first screw in the hull's wake, and area [m2] of the first rudder behind one: what
    the regressions for wake and slipstream read."""
    behind = _behind(actuators)
    found = {"D_P": [a.D for a in behind], "A_R": [a.A_R for a in behind if a.A_R is not None]}
    return {name: (float(values[0]), "PARTS") for name, values in found.items() if values}


def wake(h: reg.HullForm, actuators: tuple[Actuator, ...]) -> Numbers:
    """The wake fraction of several shafts, where there are several."""
    count = len(_behind(actuators))
    return {"w": reg.propulsion(h, 1.0, count)["w"]} if count > 1 else {}


def begun(ship: Ship, usual_pitch: float, given: Given) -> tuple[Ship, dict[str, dict[str, Any]]]:
    """The ship whose actuators have what builders do not tell, and where each of these numbers is from.

    Where turns are recorded and no K_T0 is told, thrust is that of the Wageningen series with the
    actuator's own pitch, the one `given`, the one that the shaft speed given asks for, or the usual one.
    SettingsError: no pitch that is built keeps the ship at service speed with that shaft speed."""
    began, notes = [], dict[str, dict[str, Any]]()
    pitch = given["pitch-ratio"] or usual_pitch
    if given["shaft-speed-rpm"] and _one_shaft_speed(ship.actuators):
        pitch = _by_shaft_speed(ship, given["shaft-speed-rpm"])
    for a in ship.actuators:
        mine = _of_kind(a) | (_thrust(a, pitch) if _untold(a) else {})
        notes |= {f"{a.name}.{n}": {"value": v, "source": source} for n, (v, source) in mine.items()}
        began.append(a.but(**{n: value for n, (value, _) in mine.items()}))
    return replace(ship, actuators=tuple(began)), notes


def not_used(actuators: tuple[Actuator, ...], given: Given) -> list[str]:
    """In words, what was given of one propeller and says nothing of these actuators."""
    one_pitch = any(_untold(a) and not _own_pitch(a) for a in actuators)
    used = {"pitch-ratio"} if one_pitch else set[str]()
    used |= {"shaft-speed-rpm"} if _one_shaft_speed(actuators) else set()
    idle = [o for o in OF_SCREWS if actuators and given[o] is not None and o not in used]
    return [f"--{o} is not used: each actuator has its own" for o in idle]


def _behind(actuators: tuple[Actuator, ...]) -> list[Actuator]:
    """Those that work in the hull's wake."""
    return [a for a in actuators if KINDS[a.kind].reads]


def _of_kind(a: Actuator) -> Numbers:
    may: Numbers = {"drag": (OVERRUN_DRAG, "CAR18")} if a.kind in BLADES else {}
    may["strut"] = (LEG, "FUJ61")
    return {n: x for n, x in may.items() if n in a.estimated() and not getattr(a, n)}


def _untold(a: Actuator) -> bool:
    """Whether it is a screw whose turns are recorded and whose thrust nobody told."""
    return a.kind in BLADES and "rate" in a.attributes and a.K_T0 == Actuator.K_T0


def _own_pitch(a: Actuator) -> bool:
    return "pitch" in a.attributes or a.pitch_0 != Actuator.pitch_0


def _one_shaft_speed(actuators: tuple[Actuator, ...]) -> bool:
    """Whether one shaft speed, and the pitch that it asks for, may stand for all that drives the ship."""
    driving = [a for a in actuators if a.kind != ACROSS]
    return bool(driving) and all(_untold(a) and not _own_pitch(a) for a in driving)


def _thrust(a: Actuator, pitch: float) -> Numbers:
    own = float(a.pitch_0) if _own_pitch(a) else pitch
    return {name: (float(f"{value:.4g}"), "WAG") for name, value in reg.open_water(own).items()}


def _by_shaft_speed(ship: Ship, rpm: float) -> float:
    """The pitch over diameter with which these turns keep the ship at service speed."""

    def loses(pitch: float) -> float:
        turning = [a.but(**reg.open_water(pitch)) if a.kind != ACROSS else a for a in ship.actuators]
        sailing = replace(ship, actuators=tuple(turning))
        orders = actuator_orders(sailing, 0.0, 1.0)
        orders |= {f"{a.name}.rate": rpm / 60.0 for a in turning if a.kind != ACROSS}
        return -float(Model.of(sailing).nu_dot(Situation(u=ship.U_0, orders=orders)).u)

    if not loses(LEAST_PITCH) > 0.0 > loses(MOST_PITCH):
        raise SettingsError(
            f"--shaft-speed-rpm {as_given(rpm)} cannot drive it at {num(ship.U_0, 3)} m/s: no usual pitch "
            "does. Check shaft speed, service speed and the diameters of the actuators."
        )
    return matching(loses, 0.0, LEAST_PITCH, MOST_PITCH)
