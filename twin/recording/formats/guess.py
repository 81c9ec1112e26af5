"""What a column of an unknown table may be, by the words of its name and the unit written in it.

Names are cut into words (`wind_velo_true [m/s]`, `SpeedOverGround(kn)`, `x_ned`); a rule asks for some words
and forbids others. The rule with the most words wins. Nothing is certain here: a person confirms it.
"""

import re
from typing import NamedTuple

BRACKETS = re.compile(r"[\[(<{]\s*([^\])>}]*)\s*[\])>}]")
CAMEL = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
WORD = re.compile(r"[a-z]+|\d+")
UNIT_WORDS: dict[str, str] = {
    "kn": "kn",
    "kt": "kn",
    "kts": "kn",
    "knot": "kn",
    "knots": "kn",
    "m/s": "m/s",
    "mps": "m/s",
    "ms-1": "m/s",
    "km/h": "km/h",
    "kmh": "km/h",
    "kph": "km/h",
    "deg": "deg",
    "degree": "deg",
    "degrees": "deg",
    "°": "deg",
    "rad": "rad",
    "radian": "rad",
    "radians": "rad",
    "deg/s": "deg/s",
    "degps": "deg/s",
    "dps": "deg/s",
    "°/s": "deg/s",
    "deg/min": "deg/min",
    "°/min": "deg/min",
    "rad/s": "rad/s",
    "radps": "rad/s",
    "rpm": "rpm",
    "1/min": "1/min",
    "rps": "1/s",
    "1/s": "1/s",
    "hz": "Hz",
    "m": "m",
    "metre": "m",
    "meter": "m",
    "ft": "ft",
    "feet": "ft",
    "s": "s",
    "sec": "s",
    "secs": "s",
    "seconds": "s",
    "msec": "ms",
    "millis": "ms",
    "us": "us",
    "ns": "ns",
}
WANTED = frozenset(
    ("ref", "reference", "setpoint", "sp", "desired", "des", "target", "order", "cmd", "command", "goal")
)
DERIVED = frozenset(
    (
        "dot",
        "acc",
        "accel",
        "acceleration",
        "cov",
        "covariance",
        "std",
        "var",
        "variance",
        "bias",
        "error",
        "err",
        "quality",
    )
)
RATE = frozenset(("rate", "velo", "vel", "velocity", "angvelo", "angular", "speed"))
WIND = frozenset(("wind", "tws", "twd", "aws", "awa"))


class GuessRule(NamedTuple):
    """A name with all of `words` and none of `without` may be `channel`."""

    channel: str
    words: frozenset[str]
    without: frozenset[str] = frozenset()


def _rules(channel: str, names: str, without: frozenset[str] | str = "") -> list[GuessRule]:
    """Rules of one channel: alternatives by comma, words by blank."""
    no = frozenset(without.split()) if isinstance(without, str) else without
    return [GuessRule(channel, frozenset(n.split()), no) for n in names.split(",")]


SOG, COG = "speed_over_ground_mps", "course_over_ground_deg"
RULES: tuple[GuessRule, ...] = (
    *_rules(
        "time",
        "time,timestamp,utc,t,clock,date,datetime,epoch,stamp,seconds,secs,basedatetime,original timestamp",
    ),
    *_rules("latitude_deg", "lat,latitude"),
    *_rules("longitude_deg", "lon,long,lng,longitude"),
    *_rules(
        "north_m",
        "north,northing,x ned,x position,pos x,position north,xned,pose position x",
        "vel velocity velo speed wind",
    ),
    *_rules(
        "east_m",
        "east,easting,y ned,y position,pos y,position east,yned,pose position y",
        "vel velocity velo speed wind",
    ),
    *_rules(
        "heading_true_north_deg",
        "heading,hdg,hdt,psi,yaw,gyro,heading true,true heading,head",
        RATE | WIND | {"mag", "magnetic"},
    ),
    *_rules(
        "heading_magnetic_deg", "heading magnetic,hdg mag,magnetic heading,hdm,compass,heading mag", RATE
    ),
    *_rules(COG, "cog,course,track,course over ground,trk,ctmg", WIND),
    *_rules(
        SOG,
        "sog,speed over ground,ground speed,gps speed,sogkn,groundspeed,speed",
        WIND | {"water", "log", "stw", "motor", "engine", "shaft"},
    ),
    *_rules(
        "surge_velocity_through_water_mps",
        "stw,speed through water,water speed,speed log,log,logspeed,surge water",
        WIND,
    ),
    *_rules("surge_velocity_mps", "surge,u,u velo,surge velocity,vel x body", "water wind power"),
    *_rules(
        "sway_velocity_mps",
        "sway,v,v velo,vm velo,sway velocity,vel y body",
        "water wind power battery motor",
    ),
    *_rules("velocity_north_mps", "vel north,velocity north,vn,vel n,v north", WIND),
    *_rules("velocity_east_mps", "vel east,velocity east,ve,vel e,v east", WIND),
    *_rules(
        "yaw_rate_degps",
        "rot,rate of turn,yaw rate,r angvelo,yawrate,r,turn rate,yawspeed,angular "
        "velocity z,gyro z,twist angular z",
    ),
    *_rules("rudder_angle_deg", "rudder,rud,rsa,delta,rudder angle,rudder position,delta rudder", "rate"),
    *_rules(
        "propeller_rate_rpm",
        "rpm,shaft,propeller,n prop,prop,shaft rpm,propeller rpm,shaft speed,revs,rps",
        "engine motor pitch torque power",
    ),
    *_rules("engine_rate_rpm", "engine rpm,motor rpm,engine speed,motor speed,me rpm"),
    *_rules(
        "true_wind_speed_mps",
        "tws,true wind speed,wind speed true,wind velo true,wind true speed,wind speed",
        "apparent relative rel dir direction angle",
    ),
    *_rules(
        "true_wind_direction_deg",
        "twd,true wind direction,wind dir true,wind direction true,wind direction,wind dir,mwd",
        "apparent relative rel speed velo",
    ),
    *_rules(
        "apparent_wind_speed_mps",
        "aws,apparent wind speed,relative wind speed,wind speed apparent,wind "
        "velo relative,wind speed relative,rws,wind speed rel",
    ),
    *_rules(
        "apparent_wind_angle_deg",
        "awa,apparent wind angle,relative wind angle,wind angle apparent,wind "
        "dir relative,apparent wind direction,"
        "relative wind direction,rwd,wind angle relative,wind dir rel,wind angle",
    ),
    *_rules("water_depth_m", "depth,water depth,dpt,dbt,dbs"),
    *_rules("draught_mean_m", "draught,draft,mean draught,mean draft,draught mean"),
    *_rules("roll_deg", "roll,heel,phi", RATE),
    *_rules("wave_height_significant_m", "hs,wave height,significant wave height,swh"),
    *_rules("wave_period_peak_s", "tp,wave period,peak period,wave period peak"),
    *_rules("wave_direction_deg", "wave direction,wave dir,mwd wave"),
)


class Guess(NamedTuple):
    """A channel ("time" among them), the unit the name states ("" when none), how many words spoke for it."""

    channel: str
    unit: str
    score: float


def words_of(name: str) -> tuple[list[str], str]:
    """(the words of a name, the unit in it)."""
    unit = ""
    for inside in BRACKETS.findall(name):
        unit = UNIT_WORDS.get(inside.strip().lower(), unit)
    bare = BRACKETS.sub(" ", name)
    found = WORD.findall(CAMEL.sub(" ", bare).lower())
    if not unit and len(found) > 1:
        unit = UNIT_WORDS.get(found[-1], "") or UNIT_WORDS.get("/".join(found[-2:]), "")
        found = found[:-1] if unit and found[-1] not in ("rpm", "rps") else found
    elif not unit and found:
        unit = UNIT_WORDS.get(found[0], "") if found[0] in ("rpm", "rps") else ""
    return found, unit


def guess(name: str) -> Guess | None:
    """What a column may be; None when no rule fits."""
    words, unit = words_of(name)
    there = frozenset(words)
    if there & (WANTED | DERIVED) or not words:
        return None
    best: Guess | None = None
    for rule in RULES:
        if rule.words <= there and not rule.without & there:
            score = len(rule.words) - 0.1 * (len(there) - len(rule.words))
            if best is None or score > best.score:
                best = Guess(rule.channel, unit, score)
    return best
