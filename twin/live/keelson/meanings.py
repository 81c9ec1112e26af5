"""What each field of our messages means and in which unit it counts, for `docs/bus.md` and `shiptwin.proto`.

A unit is the suffix of a field's name; a field whose name does not say all stands in MEANINGS. Not loaded on
board."""

from twin.live.signals.channels import BY_NAME

UNITS = {  # suffix of a name, the longest first
    "newton_meter": "N m",
    "degps": "deg/s",
    "knots": "kn",
    "newton": "N",
    "mps": "m/s",
    "rpm": "1/min",
    "deg": "deg",
    "Nm": "N m",
    "hz": "Hz",
    "us": "us",
    "N": "N",
    "m": "m",
    "s": "s",
}

MEANINGS = {
    "Row.time_s": "time of the row since the voyage began, or UTC since 1970",
    "State.current_north_mps": "water's motion towards north that the twin believes in",
    "State.current_east_mps": "water's motion towards east",
    "NamedForce.name": "the effect, as in `twin effects`",
    "X_N": "force ahead",
    "Y_N": "force to starboard",
    "N_Nm": "moment, positive turns the ship to starboard",
    "LearnedForce.bound_N": "the learned force is held below this",
    "LearnedForce.bound_Nm": "the learned moment is held below this",
    "LearnedForce.weight": "0 switched off .. 1 inside the range it was trained in",
    "LearnedForce.share": "of the whole force, 0..1",
    "Parameter.name": "EFFECT.number, as in the ship file",
    "Parameter.value": "as learned on board",
    "Parameter.low": "it is held above this",
    "Parameter.high": "it is held below this",
    "Parameter.sigma": "its standard deviation",
    "Parameter.unit": "of value, low, high and sigma",
    "Parameter.status": "unestimated | estimated | invalid",
    "Prediction.horizon_s": "how far ahead of the tick that says it",
    "Prediction.state": "where the ship will be if helm, engine and weather stay",
    "Prediction.sigma": "68 % of the errors are smaller",
    "Prediction.age_s": "of the estimate it started from",
    "Prediction.status": "of sigma: prior (assumed) | learned (from this voyage's errors)",
    "Prediction.tube": "where the ship will be if helm and engine are held (`twin tube`)",
    "PredictionTube.along_m": "half axis of the ellipse around the place, along the course",
    "PredictionTube.across_m": "half axis across it",
    "PredictionTube.course_deg": "predicted course over ground, from true north",
    "PredictionTube.heading_deg": "half width around the predicted heading",
    "PredictionTube.level": "share of places, and of headings, inside that is promised, 0: none is",
    "PredictionTube.voyages": "reference voyages that the promise rests on",
    "PredictionTube.regime": "still | moving (helm), _unknown | _slight | _moderate | _rough (sea), or all",
    "PredictionTube.status": "calibrated, or why nothing is promised",
    "Certificate.margin": "of the observer's certificate; see docs/stability.md",
    "Certificate.bound": "live bound of the observer's error in speed [m/s]",
    "Certificate.inside": "whether the certificate holds now",
    "yaw_bound_degps": "live bound of the observer's error in the rate of turn",
    "step_margin": "share of an error that one sample surely takes away, 0 when none does",
    "authority_margin": "share of the rudder's authority that is left; below 0 no course is covered by proof",
    "Tick.index": "number of the tick since start",
    "Tick.time_s": "monotonic clock of the twin's computer",
    "Tick.wall_s": "UTC since 1970",
    "Tick.mode": "starting | hybrid | physics only | dead reckoning | invalid",
    "Tick.reasons": "why the mode is not better, and every alarm, in words",
    "Tick.rate_hz": "ticks in a second",
    "Tick.slack_us": "time left when the step was done; absent in a replay",
    "Tick.step_us": "what the tick before took; absent in a replay",
    "Tick.overruns": "periods skipped since start",
    "Tick.rejected": "samples refused since start",
    "Tick.log_dropped": "messages the log had to drop since start",
    "Tick.measured": "newest good sample of each channel, held until it is lost",
    "Tick.age_s": "since the source's stamp, by channel [s]",
    "Tick.quality": "why a channel's newest sample was taken or refused, by channel",
    "Tick.estimate": "what the twin believes",
    "Tick.sigma": "one standard deviation of the estimate",
    "Tick.known": "known forces by effect, the core first",
    "Tick.learned": "the learned force",
    "Tick.parameters": "numbers that are learned on board, in each tenth tick",
    "Tick.predictions": "in the ticks in which a round of predictions is ready",
    "Tick.certificate": "of the observer",
    "Tick.actuators": "channels of the ship's actuators; none of a ship with one propeller and one rudder",
    "ActuatorChannel.name": "ACTUATOR.CHANNEL, as in the ship file: `port.rate_rpm`",
    "ActuatorChannel.value": "newest good sample, held until it is lost, in the channel's unit",
    "ActuatorChannel.age_s": "since the source's stamp",
    "ActuatorChannel.quality": "why its newest sample was taken or refused: a code as in Codes",
    "north_m": "north of the voyage's datum",
    "east_m": "east of the voyage's datum",
}


def unit_of(name: str) -> str:
    """The unit that a name's suffix says, "" where it says none."""
    ending = next((suffix for suffix in UNITS if name.endswith("_" + suffix)), "")
    return UNITS.get(ending, "")


def meaning_of(message: str, field: str) -> str:
    """One field's meaning with its unit in brackets; KeyError where nobody wrote it down."""
    doc = MEANINGS.get(f"{message}.{field}") or MEANINGS.get(field) or BY_NAME[field].doc
    unit = {"Ages": "s", "Codes": ""}.get(message, unit_of(field))
    doc = {"Ages": f"age of: {doc}", "Codes": f"quality of: {doc}"}.get(message, doc)
    return f"{doc} [{unit}]" if unit and "[" not in doc else doc
