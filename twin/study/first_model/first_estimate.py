"""`twin init`: a first model of my ship from what its owner knows; every estimated number says where it comes
from."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from twin.errors import SettingsError
from twin.num import as_given, num, percent
from twin.physics.actuators import Actuator
from twin.physics.model import Model
from twin.physics.ship import DERIVATIVES, PARTICULARS, Derivatives, Ship
from twin.study.first_model import first_actuators
from twin.study.first_model import regressions as reg
from twin.study.first_model.halving import matching
from twin.study.first_model.modulus import modulus_form, slipstream
from twin.study.prediction.trial import shaft_speed

# of L: centres of gravity lie within a few per cent of midship, of a slender naval vessel 0.10 astern
FARTHEST_G = 0.15

# option, what it is, unit, smallest and largest that is not a slip of the pen
OPTIONS: tuple[tuple[str, str, float, float], ...] = (
    (
        "length-pp-m",
        "length between perpendiculars; where nobody knows it, 0.96 of the waterline",
        0.2,
        500.0,
    ),
    ("beam-m", "beam at the waterline", 0.05, 90.0),
    ("draught-m", "mean draught", 0.01, 40.0),
    ("mass-kg", "mass (displacement); default: by the block coefficient", 0.05, 1e9),
    ("block-coefficient", "block coefficient C_b", 0.2, 0.99),
    ("service-speed-mps", "service speed", 0.05, 40.0),
    ("shaft-speed-rpm", "propeller rate at service speed in calm water: sets the thrust", 1.0, 10000.0),
    (
        "x-g-m",
        "centre of gravity ahead of midship (half of L_pp; negative: astern of it), by 0.15 L at most; "
        "default 0",
        -60.0,
        60.0,
    ),
    ("yaw-inertia-kgm2", "moment of inertia in yaw about midship; default: a radius of 0.25 L", 1e-4, 1e14),
    ("rho-kg-m3", "density of the water", 900.0, 1100.0),
    ("propellers", "how many propellers turn alike; default 1", 1.0, 4.0),
    ("propeller-diameter-m", "diameter of each propeller", 0.005, 15.0),
    ("pitch-ratio", "propeller pitch over diameter", 0.3, 2.0),
    ("rudder-area-m2", "moveable area of all rudders together", 1e-5, 250.0),
    ("rudder-height-m", "height (span) of each rudder", 0.005, 20.0),
    ("frontal-area-m2", "frontal area above the water, for Wind; default B^2/2", 1e-4, 5000.0),
    ("lateral-area-m2", "lateral area above the water, for Wind; default 0.06 L^2", 1e-4, 20000.0),
)
REQUIRED = ("length-pp-m", "beam-m", "draught-m")
LEAST_FULL = 0.05  # of length x beam x draught, of two slender hulls with much water between them
Given = Mapping[str, float | None]
Numbers = dict[str, tuple[float, str]]  # name -> value, source


def first_model(name: str, given: Given, actuators: tuple[Actuator, ...] = ()) -> tuple[Ship, list[str]]:
    """The ship, and in words what to doubt about it; SettingsError where a number cannot be right. A ship
    with `actuators` may have two hulls, so that it fills little of length x beam x draught."""
    if not name.strip():
        raise SettingsError("NAME is empty. Give the ship a name.")
    _check(given)
    p = _particulars(given, LEAST_FULL if actuators else 0.2)
    p |= {k: x for k, x in first_actuators.one_screw(actuators).items() if p[k][1] != "given"}
    h = reg.HullForm(*(p[k][0] for k in ("L_pp", "B", "T", "C_b", "U_0", "x_G", "rho")))
    of_hull = {**given, **dict.fromkeys(first_actuators.OF_SCREWS)} if actuators else given
    d = _derivatives(reg.nearest(h), p, of_hull) | first_actuators.wake(reg.nearest(h), actuators)
    notes: dict[str, Any] = {
        "particulars": {k: {"value": v, "source": s} for k, (v, s) in p.items()},
        "derivatives": {k: {"value": v, "source": s} for k, (v, s) in d.items()},
    }
    bare = replace(_ship(name.strip(), p, d), actuators=actuators)
    ship, begun = first_actuators.begun(bare, reg.usual_pitch(h), given)
    notes["derivatives"] |= begun
    used = {part for section in ("particulars", "derivatives") for part in _sources(notes[section])}
    notes["sources"] = {key: text for key, text in reg.SOURCES.items() if key in used}
    ship = replace(ship, notes=notes)
    _in_ranges(ship)
    rough = [k for k, (_, s) in p.items() if s in ("ROUGH", "ALEX")]
    guessed = [f"{', '.join(rough)}: guessed by size only; give them if you can"] if rough else []
    idle = first_actuators.not_used(actuators, given)
    return ship, reg.outside(h) + guessed + idle + _two_fullnesses(given, ship)


def _sources(entries: Mapping[str, Mapping[str, Any]]) -> list[str]:
    return [part for entry in entries.values() for part in entry["source"].split("; ")]


def _two_fullnesses(given: Given, ship: Ship) -> list[str]:
    """Mass and block coefficient say the same twice."""
    C_b = given["block-coefficient"]
    if given["mass-kg"] is None or C_b is None or abs(ship.C_b - C_b) < 5e-4:
        return []
    return [
        f"--mass-kg gives C_b = {num(ship.C_b, 4)}, which is used; --block-coefficient {as_given(C_b)} is not"
    ]


def _ship(name: str, particulars: Numbers, derivatives: Numbers) -> Ship:
    ship = Ship(name, **{k: v for k, (v, _) in particulars.items()})  # type: ignore[arg-type]
    return replace(ship, derivatives=Derivatives(**{k: v for k, (v, _) in derivatives.items()}))


def _check(given: Given) -> None:
    for option, doc, lo, hi in OPTIONS:
        value = given[option]
        if value is not None and not lo <= value <= hi:
            raise SettingsError(
                f"--{option} {as_given(value)} lies outside {as_given(lo)} to {as_given(hi)} ({doc}). Check "
                "its unit."
            )
    L, B, T = (float(given[o]) for o in REQUIRED)  # type: ignore[arg-type]
    if B >= L or T >= L:
        raise SettingsError(
            f"a ship {as_given(L)} m long, {as_given(B)} m wide and {as_given(T)} m deep is no ship. Check "
            "the order of the numbers."
        )


def _particulars(given: Given, least: float = 0.2) -> Numbers:
    """Particulars with their sources, given or estimated."""
    L, B, T = (float(given[o]) for o in REQUIRED)  # type: ignore[arg-type]
    rho, box = given["rho-kg-m3"] or 1025.0, L * B * T
    mass, C_b, speed = given["mass-kg"], given["block-coefficient"], given["service-speed-mps"]
    by_mass = None if mass is None else mass / (rho * box)
    if mass is not None and by_mass is not None and not least <= by_mass <= 0.99:
        raise SettingsError(
            f"--mass-kg {as_given(mass)} fills {percent(by_mass)} of length x beam x draught; a ship fills "
            f"{percent(least)} to 99 %. Check the mass (kg) and the draught."
        )
    if by_mass is not None and C_b is not None and abs(by_mass / C_b - 1.0) > 0.05:
        raise SettingsError(
            f"--mass-kg gives C_b = {by_mass:.3f}, but --block-coefficient is {as_given(C_b)}. Leave one of "
            "them out."
        )
    given_fullness = by_mass if by_mass is not None else C_b
    fullness = (
        (given_fullness, "given") if given_fullness is not None else reg.typical_block_coefficient(L, speed)
    )
    C = fullness[0]
    x_G = given["x-g-m"] or 0.0
    if abs(x_G) > FARTHEST_G * L:
        raise SettingsError(
            f"--x-g-m {as_given(x_G)} is more than {as_given(FARTHEST_G)} of the length from midship (half "
            "of L_pp, ahead positive). Check it."
        )
    I_z = given["yaw-inertia-kgm2"]
    m = mass if mass is not None else rho * C * box
    if I_z is not None and not 0.15 <= (I_z / m) ** 0.5 / L <= 0.4:
        raise SettingsError(
            f"--yaw-inertia-kgm2 {as_given(I_z)} is a radius of {(I_z / m) ** 0.5 / L:.2f} L; a ship has 0.2 "
            "to 0.3. Check it."
        )

    def said(option: str, estimate: float, source: str) -> tuple[float, str]:
        value = given[option]
        return (estimate, source) if value is None else (value, "given")

    p = {
        "L_pp": (L, "given"),
        "B": (B, "given"),
        "T": (T, "given"),
        "m": (m, "given" if mass is not None else fullness[1]),
        "C_b": fullness,
        "x_G": said("x-g-m", 0.0, "ZERO"),
        "I_z": said("yaw-inertia-kgm2", m * ((0.25 * L) ** 2 + x_G**2), "GYR"),
        "rho": said("rho-kg-m3", rho, "SEA"),
        "U_0": said("service-speed-mps", reg.service_speed(L, C), "ALEX"),
        "D_P": said("propeller-diameter-m", T * min(0.85, max(0.35, 1.386 - 1.126 * C)), "RULE"),
        "A_R": said("rudder-area-m2", 0.01 * T * L * (1.0 + 25.0 * (B / L) ** 2), "DNV"),
        "A_F": said("frontal-area-m2", 0.5 * B * B, "ROUGH"),
        "A_L": said("lateral-area-m2", 0.06 * L * L, "ROUGH"),
    }
    return {k: (float(f"{v:.6g}"), s) for k, (v, s) in p.items()}


def _derivatives(h: reg.HullForm, p: Numbers, given: Given) -> Numbers:
    """Derivatives with their sources; sets the propeller's diameter in p where only its shaft speed is
    known."""
    out: Numbers = {f.name: (0.0, "ZERO") for f in DERIVATIVES}
    out |= reg.added_masses(h)
    m_x, m_y = -out["X_udot"][0], -out["Y_vdot"][0]
    polynomial = reg.hull_polynomial(h, m_y) | {"R0": reg.resistance(h)}
    source = {"X_vr": "HAS80; LSQ"} | dict.fromkeys(("X_vv", "X_rr"), "YM12; LSQ")
    out |= {
        k: (v, source.get(k, "CGH83; KIJ90; YM12; LSQ"))
        for k, v in modulus_form(polynomial, m_x, m_y).items()
    }
    out["X_uu"] = (-polynomial["R0"], "ITTC57")
    count = _propellers(given)
    blade = p["A_R"][0] / count  # of one rudder: there is one behind each propeller
    height = given["rudder-height-m"] or min(0.7 * h.T, (2.2 * blade) ** 0.5)
    out |= reg.steering(h, height**2 / blade)
    pitch = _pitch_ratio(h, p, given, out)
    one, eta = reg.propulsion(h, pitch), min(1.0, p["D_P"][0] / height)
    epsilon, kappa = slipstream(one["K_T0"][0], one["K_T1"][0], 1.02, 0.6 / 1.02, eta)
    out |= _all_screws(h, pitch, count) | {
        "epsilon": (epsilon, "MAT80; LSQ"),
        "kappa": (kappa / count, "MAT80; LSQ"),
    }
    return {k: (float(f"{v:.5g}") + 0.0, s) for k, (v, s) in out.items()}


def _propellers(given: Given) -> float:
    count = given.get("propellers") or 1.0
    if count != round(count):
        raise SettingsError(
            f"--propellers {as_given(count)} is no whole number. How many propellers turn alike?"
        )
    return count


def _all_screws(h: reg.HullForm, pitch: float, count: float) -> Numbers:
    """One propeller in the place of all: of the same diameter, with the thrust of all of them. What a rudder
    feels is one slipstream, so kappa is divided by their number."""
    out = reg.propulsion(h, pitch, count)
    return out | {name: (count * out[name][0], out[name][1]) for name in ("K_T0", "K_T1")}


def _pitch_ratio(h: reg.HullForm, p: Numbers, given: Given, d: Numbers) -> float:
    """Given, or usual for a hull as full as this, or such that the shaft speed given drives it at service
    speed."""
    usual, count = given["pitch-ratio"] or reg.usual_pitch(h), _propellers(given)
    rpm = given["shaft-speed-rpm"]
    if not rpm:
        return usual

    def turns(diameter: float, pitch: float) -> float:
        return 60.0 * shaft_speed(
            Model(_ship("", p | {"D_P": (diameter, "")}, d | _all_screws(h, pitch, count))), h.U
        )

    D = p["D_P"][0]
    if given["propeller-diameter-m"] is None and not turns(D, 1.4) < rpm < turns(D, 0.5):
        p["D_P"] = (float(f"{matching(lambda x: turns(x, usual), rpm, 0.2 * h.T, 1.2 * h.T):.4g}"), "RPM")
        D = p["D_P"][0]
    pitch = matching(lambda x: turns(D, x), rpm, 0.3, 2.0)
    if abs(turns(D, pitch) / rpm - 1.0) > 0.02:
        raise SettingsError(
            f"--shaft-speed-rpm {as_given(rpm)} cannot drive it at {num(h.U, 3)} m/s with a propeller of "
            f"{num(D, 3)} m: no usual pitch does. Check shaft speed, service speed, propeller diameter and "
            "--propellers."
        )
    return pitch


def _in_ranges(ship: Ship) -> None:
    """Refuse what the ship file would refuse when it is read again."""
    for where, owner, known in (
        ("particulars", ship, PARTICULARS),
        ("derivatives", ship.derivatives, DERIVATIVES),
    ):
        for f in known:
            value = getattr(owner, f.name)
            if not f.metadata["lo"] <= value <= f.metadata["hi"]:
                raise SettingsError(
                    f"the regressions give {where}.{f.name} = {num(value, 3)} {f.metadata['unit']} "
                    f"({f.metadata['doc']}), outside [{as_given(f.metadata['lo'])}, "
                    f"{as_given(f.metadata['hi'])}]: this hull is too unlike a ship. Check length, beam and "
                    "draught."
                )
