"""What is doubtful about a calibration, in words an owner can act on."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from twin.num import num, percent
from twin.physics import core
from twin.physics.actuators import NUMBERS
from twin.physics.effects import find, of_role
from twin.physics.model import Model
from twin.physics.ship import DERIVATIVES, Ship
from twin.study.estimation.box import at_an_end
from twin.study.estimation.columns import NO_MODEL, owner_of
from twin.study.reference.derivatives import by_particulars

LARGE = 0.25  # share of the forces at work that is much to leave unexplained
# widths of its prior by which an effect's number may differ between healthy voyages and still be seen
BLIND = 1.0
STRAIGHTENS = {"gamma_v": 1.0, "gamma_r": -1.0}  # the sign that a hull gives them
ON_EVERY_HULL = {"Y_uv": "drift pushes it aside", "N_ur": "its own turning is damped"}  # by its lift
ENOUGH = 5  # reference voyages from which twin diagnose names more (docs/results/judgement.md)
LITTLE = 1.0 / 3.0  # of the resistance that its particulars give, below which it is not believed
NIL = 0.01  # of what its particulars give, below which a derivative is as good as none
WRONG_SIGN_SE = 3.0  # standard errors
AXES = ("surge", "sway", "yaw")


def doubts_of(result: Mapping[str, Any], ship: Ship, after: Ship, voyages: int) -> list[str]:
    """Sentences on what --json holds of a calibration (`result`) of this ship, which is as `after` then; what
    was fitted is held against the ship's particulars, also where it was calibrated before. `voyages`: how
    many it was fitted to."""
    first = by_particulars(ship)
    return doubts(
        [d | {"before": float(first.derivative(d["name"]))} for d in result["derivatives"]],
        result["held_out"],
        result["floor"]["share"],
        result["usual"],
        result["between_voyages"],
        voyages,
        (resistance_of(first), resistance_of(after)),
    )


def doubts(
    derivatives: Sequence[Mapping[str, Any]],
    held_out: Sequence[Mapping[str, Any]],
    share: Sequence[float],
    usual: Sequence[Mapping[str, Any]] = (),
    between: Mapping[str, float] = MappingProxyType({}),
    voyages: int = ENOUGH,
    resistance: tuple[float, float] | None = None,
) -> list[str]:
    """Sentences; none when the calibration is as it should be. `usual`: lasting effects that it shows;
    `between`: by how many widths of their priors numbers differ from voyage to voyage; `voyages`: how many
    it was fitted to; `resistance`: at service speed before and after [N]. What is `before` is what the
    particulars give."""
    return [
        *_stopped(derivatives),
        *_backwards(derivatives),
        *_without_lift(derivatives),
        *_without_resistance(resistance),
        *_no_better(held_out),
        *_coarse(share),
        *_ordered(usual),
        *_blind(between),
        *_few(voyages),
    ]


def _stopped(derivatives: Sequence[Mapping[str, Any]]) -> list[str]:
    box = {f.name: (f.metadata["lo"], f.metadata["hi"]) for f in (*DERIVATIVES, *NUMBERS.values())}
    names = [
        d["name"]
        for d in derivatives
        if d["excited"] and at_an_end(d["value"], *box[d["name"].rpartition(".")[2]])
    ]
    if not names:
        return []
    return [
        f"{', '.join(names)} stopped at the end of what ships have: check mass, draught, rudder and "
        "propeller in the ship file, "
        "and that nothing was wrong on the reference voyages"
    ]


def _backwards(derivatives: Sequence[Mapping[str, Any]]) -> list[str]:
    """Behind every hull drift and turning send the flow against the rudder's angle in a turn; less of it than
    none there is no hull."""
    flow = [d for d in derivatives if d["name"] in STRAIGHTENS]
    wrong = [
        f"{d['name']} {num(d['value'], 2)}"
        for d in flow
        if STRAIGHTENS[d["name"]] * d["value"] < -WRONG_SIGN_SE * d["sd"]
    ]
    if not wrong:
        return []
    return [
        f"{', '.join(wrong)}: the stern's own drift would help its rudder, as on no ship. Is rudder, yaw "
        "rate or sway of the other sign, or late? "
        "twin compare, and the checks of twin import"
    ]


def _without_lift(derivatives: Sequence[Mapping[str, Any]]) -> list[str]:
    """What the lift of any hull does, and of which nothing is left."""
    return [
        f"{d['name']} is as good as none ({num(d['before'], 2)} by the particulars), and of every hull "
        f"{ON_EVERY_HULL[d['name']]}: wind, stream or another derivative stands for it here. Give reference "
        "voyages with turns both ways on other courses, and with the wind recorded"
        for d in derivatives
        if d["name"] in ON_EVERY_HULL and d["excited"] and abs(d["value"]) < NIL * abs(d["before"])
    ]


def resistance_of(ship: Ship) -> float:
    """The calm-water resistance of its hull at service speed [N]."""
    return -float(core.damping(ship.U_0, 0.0, 0.0, Model.of(ship).c)[0])


def _without_resistance(resistance: tuple[float, float] | None) -> list[str]:
    """Most of what holds a hull back is gone: then the turns that were recorded are not what drives it."""
    if resistance is None or resistance[1] > LITTLE * resistance[0]:
        return []
    before, after = resistance
    share, kN = (
        percent(after / before),
        f"{num(after / 1e3, 3)} kN; by the particulars {num(before / 1e3, 3)} kN",
    )
    return [
        f"of the resistance at service speed {share} is left ({kN}): what was recorded of the propeller does "
        "not tell its thrust. Of a controllable pitch record the pitch too (docs/actuators.md)"
    ]


def _no_better(held_out: Sequence[Mapping[str, Any]]) -> list[str]:
    """At the longest horizon that could be judged."""
    judged = [e for e in held_out if e["windows"]]
    if not judged:
        return ["no voyage was left to judge by: give one with --held-out"]
    last = judged[-1]
    rose = [
        f"{num(last[before], 3)} -> {num(last[after], 3)} {unit}"
        for before, after, unit in (("before_m", "position_m", "m"), ("before_deg", "heading_deg", "deg"))
        if last[after] >= last[before]
    ]
    if not rose:
        return []
    return [
        f"the error after {last['horizon_s']:.0f} s did not fall ({', '.join(rose)}): current, wind or a "
        "fault on a reference voyage, or too few "
        "of them? Look at each with twin compare, leave out one that stands apart, and give more"
    ]


def _coarse(share: Sequence[float]) -> list[str]:
    """In which axes the calibration leaves much of the forces at work unexplained."""
    large = [f"{100 * s:.0f} % in {axis}" for s, axis in zip(share, AXES, strict=True) if s > LARGE]
    if not large:
        return []
    return [
        f"{', '.join(large)} of the forces at work stays unexplained, so that twin diagnose sees only what "
        "stands clear of that: give more, or "
        "calmer, reference voyages, and leave out one that stands apart (twin compare)"
    ]


def _ordered(usual: Sequence[Mapping[str, Any]]) -> list[str]:
    """The ship turns later than the rudder that was recorded: then that is its order."""
    if not any(u["name"].startswith(f"{of_role('gear').__name__}.") for u in usual):
        return []
    return [
        "the ship answers otherwise than rudder and steering gear of the model would have it: record the "
        "rudder's feedback if you can, "
        "else a fault of rudder or gear is hard to see"
    ]


def _lasts(label: str) -> bool:
    """Whether it should be alike on these voyages: no part of the core (core.N_r, core.port.gain), and no
    weather."""
    owner = owner_of(label)
    return owner not in ("core", *NO_MODEL) and not find(owner).is_weather()


def _blind(between: Mapping[str, float]) -> list[str]:
    large = {label: widths for label, widths in between.items() if widths >= BLIND and _lasts(label)}
    if not large:
        return []
    told = ", ".join(f"{label} ({widths:.1f} times its usual width)" for label, widths in large.items())
    differ, its = ("differs", "its") if len(large) == 1 else ("differ", "their")
    return [
        f"{told} {differ} so much between these voyages that a fault of {its} kind will hardly be seen: was "
        "something wrong on one of them?"
    ]


def _few(voyages: int) -> list[str]:
    if voyages >= ENOUGH:
        return []
    return [
        f"{voyages} reference voyage{'s' * (voyages > 1)}: of a ship that was calibrated to {ENOUGH} or 6 "
        "twin diagnose names more causes: give more zigzags, circles and changes of speed, on calm days or "
        "with the wind recorded"
    ]
