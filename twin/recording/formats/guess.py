"""What a column of an unknown table may be, by the words of its name and the unit written in it.

Names are cut into words (`wind_velo_true [m/s]`, `SpeedOverGround(kn)`, `x_ned`); a rule asks for some words
and forbids others. The rule with the most words wins. Nothing is certain here: a person confirms it.
"""

from typing import NamedTuple

from twin.recording.formats.name_words import words_of
from twin.recording.units import UNITS, unit_of

WANTED = frozenset(
    (
        "ref",
        "reference",
        "setpoint",
        "sp",
        "desired",
        "des",
        "target",
        "order",
        "cmd",
        "command",
        "goal",
        "demand",
        "wanted",
        "soll",
    )
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
        "hdop",
        "accuracy",
        "zero",
    )
)
RATE = frozenset(("rate", "velocity", "angvelo", "angular", "speed"))
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


OWN_WORD = 0.3  # what a word of the name itself weighs more than one of its group
ONE_LETTER = 0.5  # what a name of one letter weighs less: it has many meanings
SOG, COG = "speed_over_ground_mps", "course_over_ground_deg"
ENGINE = "engine motor pitch torque power fuel load oil thrust throttle"
NO_MOTION = "water wind power battery motor gyro magnetic acceleration accelerometer volt voltage current"
RULES: tuple[GuessRule, ...] = (
    *_rules(
        "time",
        "time,timestamp,utc,t,clock,date,datetime,epoch,stamp,seconds,secs,basedatetime,original timestamp,"
        "timeus,time us,millis,utctime,gpstime,time since start,elapsed,elapsed time,time boot ms",
        "to next last of rate zone sync period wave",
    ),
    *_rules("latitude_deg", "lat,latitude,gps latitude", "std error"),
    *_rules("longitude_deg", "lon,long,lng,longitude,gps longitude", "std error"),
    *_rules(
        "north_m",
        "north,northing,x ned,x position,position north,xned,pose position x,position n,n position",
        f"velocity speed {NO_MOTION} target",
    ),
    *_rules(
        "east_m",
        "east,easting,y ned,y position,position east,yned,pose position y,position e,e position",
        f"velocity speed {NO_MOTION} target",
    ),
    *_rules("plain_x", "x,xo", f"velocity speed y z w {NO_MOTION} orientation angular linear q quaternion"),
    *_rules("plain_y", "y,yo", f"velocity speed x z w {NO_MOTION} orientation angular linear q quaternion"),
    *_rules(
        "heading_true_north_deg",
        "heading,hdg,hdt,ths,psi,yaw,gyro,heading true,true heading,head,heading gyro,hdg gyro,course steered,pose theta",
        RATE | WIND | {"mag", "magnetic", "x", "y", "z", "ground", "cog", "rad", "over"},
    ),
    *_rules(
        "heading_magnetic_deg",
        "heading magnetic,hdg mag,magnetic heading,hdm,compass,heading mag,compass heading,magnetic",
        RATE | {"variation", "x", "y", "z", "field", "deviation"},
    ),
    *_rules("magnetic_variation_deg", "variation,magnetic variation,declination,magvar,mag var"),
    *_rules(
        COG,
        "cog,course,track,course over ground,trk,ctmg,heading over ground,tmg,gcrs,crs,track made good",
        WIND | {"steered", "error", "xte", "water", "cross"},
    ),
    *_rules(
        SOG,
        "sog,speed over ground,ground speed,gps speed,sogkn,groundspeed,speed,ship speed,vessel speed",
        WIND
        | {"water", "log", "stw", "motor", "engine", "shaft", "propeller", "prop", "rotational", "x", "y"}
        | {
            "n",
            "e",
            "north",
            "east",
            "fan",
            "rotor",
            "thruster",
            "port",
            "starboard",
            "turn",
            "yaw",
            "accuracy",
        },
    ),
    *_rules(
        "surge_velocity_through_water_mps",
        "stw,speed through water,water speed,speed log,log,logspeed,surge water,bsp,boat speed,boatspeed,"
        "log speed,speed water,velocity water surge,vhw,ahead water",
        WIND,
    ),
    *_rules(
        "surge_velocity_mps",
        "surge,u,u velocity,surge velocity,velocity x body,twist linear x,linear velocity x,velocity surge",
        NO_MOTION,
    ),
    *_rules(
        "sway_velocity_mps",
        "sway,v,v velocity,vm velocity,sway velocity,velocity y body,twist linear y,linear velocity y,"
        "velocity sway",
        NO_MOTION,
    ),
    *_rules(
        "velocity_north_mps",
        "velocity north,vn,velocity n,v north,n velocity,vnorth,velocity n m,speed north,north velocity",
        WIND | {"std", "water"},
    ),
    *_rules(
        "velocity_east_mps",
        "velocity east,ve,velocity e,v east,e velocity,veast,velocity e m,speed east,east velocity",
        WIND | {"std", "water"},
    ),
    *_rules(
        "yaw_rate_degps",
        "rot,rate of turn,yaw rate,r angvelo,yawrate,r,turn rate,yawspeed,angular velocity z,gyro z,"
        "twist angular z,rateofturn,yaw velocity,heading rate,turning rate,yaw speed,gyrz,gyr z,omega z",
        "order rudder",
    ),
    *_rules(
        "rudder_angle_deg",
        "rudder,rud,rsa,delta,rudder angle,rudder position,delta rudder,rudder response,rudder feedback,"
        "rudder actual,steering angle,rudder indication",
        "rate demand",
    ),
    *_rules(
        "propeller_rate_rpm",
        "rpm,shaft,propeller,n prop,prop,shaft rpm,propeller rpm,shaft speed,revs,rps,revolutions,n,"
        "propeller speed,prop speed,propeller rate,shaft rate,propeller revolutions,rotational speed,nprop",
        ENGINE,
    ),
    *_rules(
        "engine_rate_rpm",
        "engine rpm,motor rpm,engine speed,motor speed,me rpm,main engine rpm,engine revolutions",
    ),
    *_rules(
        "true_wind_speed_mps",
        "tws,true wind speed,wind speed true,wind velocity true,wind true speed,wind speed,wind speed ground",
        "apparent relative rel direction angle",
    ),
    *_rules(
        "true_wind_direction_deg",
        "twd,true wind direction,wind direction true,wind direction,mwd,wind true direction,true wind from,"
        "wind from",
        "apparent relative rel speed velocity",
    ),
    *_rules(
        "apparent_wind_speed_mps",
        "aws,apparent wind speed,relative wind speed,wind speed apparent,wind velocity relative,"
        "wind speed relative,rws,wind speed rel,rel wind speed",
    ),
    *_rules(
        "apparent_wind_angle_deg",
        "awa,apparent wind angle,relative wind angle,wind angle apparent,wind direction relative,"
        "apparent wind direction,relative wind direction,rwd,wind angle relative,wind direction rel,"
        "wind angle,rel wind direction,rel wind angle,wind direction apparent,relative wind from,rel wind from,"
        "apparent wind from",
        "true",
    ),
    *_rules("water_depth_m", "depth,water depth,dpt,dbt,dbs,sounding", "draught sensor"),
    *_rules("draught_mean_m", "draught,draft,mean draught,mean draft,draught mean", "fore aft fwd"),
    *_rules("roll_deg", "roll,heel,phi,heel angle,roll angle", RATE),
    *_rules("wave_height_significant_m", "hs,wave height,significant wave height,swh"),
    *_rules("wave_period_peak_s", "tp,wave period,peak period,wave period peak"),
    *_rules("wave_direction_deg", "wave direction,mwd wave"),
)


HALVES_OF_WIND = {"speed": "true_wind_speed_mps", "direction": "true_wind_direction_deg"}


class Guess(NamedTuple):
    """A channel ("time" among them), the unit the name states ("" when none), how many words spoke for it."""

    channel: str
    unit: str
    score: float


def guess(name: str, stated: str = "", group: str = "") -> Guess | None:
    """What a column may be; None when no rule fits. `stated`: the unit that stands beside the name, `group`:
    what stands above it."""
    words, unit = words_of(name)
    unit, own = unit or stated, frozenset(words)
    there = own | frozenset(words_of(group)[0])
    there |= _half_of_wind(there, unit)
    if there & (WANTED | DERIVED) or not words:
        return None
    best: Guess | None = None
    for rule in RULES:
        if rule.words <= there and not rule.without & there and can_be(rule.channel, unit):
            score = len(rule.words) - 0.1 * (len(there) - len(rule.words)) + OWN_WORD * len(rule.words & own)
            score -= ONE_LETTER * all(len(word) == 1 for word in rule.words)
            if best is None or score > best.score:
                best = Guess(rule.channel, unit, score)
    return best


def _half_of_wind(words: frozenset[str], unit: str) -> frozenset[str]:
    """Of a wind whose name leaves it open, the word that its unit says: `app_wind_mps` is a speed."""
    if "wind" not in words or words & {"speed", "velocity", "direction", "angle"}:
        return frozenset()
    return frozenset(word for word, channel in HALVES_OF_WIND.items() if unit and can_be(channel, unit))


def can_be(channel: str, unit: str) -> bool:
    """Whether a quantity can be in a unit: an angle is in no knots."""
    if not unit or channel not in KINDS_OF_UNIT:
        return True
    return unit in UNITS[KINDS_OF_UNIT[channel]]


KINDS_OF_UNIT = {rule.channel: unit_of(rule.channel) for rule in RULES if unit_of(rule.channel) in UNITS} | {
    "time": "s",
    "plain_x": "m",
    "plain_y": "m",
}
