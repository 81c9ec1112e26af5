"""The words of a column's name, and the unit written in it: `wind_velo_true [m/s]`, `SpeedOverGround(kn)`,
`Ruderlage`. Words of other languages become English ones; sides and numbers stay words of their own.
"""

import re
import unicodedata

BRACKETS = re.compile(r"[\[(<{]\s*([^\])>}]*)\s*[\])>}]")
CAMEL = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
WORD = re.compile(r"[a-z]+|\d+|%")
# as it is written, without blanks and points -> as a map has it
WRITTEN: dict[str, str] = {
    "kn": "kn kt kts knot knots knop knoten",
    "m/s": "m/s mps ms-1 ms^-1 m/sec meter/sec meters/sec m·s-1 meterpersecond meterspersecond",
    "km/h": "km/h kmh kph kmt/h",
    "ft/s": "ft/s fps",
    "cm/s": "cm/s cmps cm/sec",
    "mm/s": "mm/s mmps mm/sec",
    "deg": "deg degree degrees ° º grad degt degm °t °m",
    "rad": "rad radian radians",
    "deg/s": "deg/s degps dps °/s º/s deg/sec degree/s degrees/s degpersec degpers degpersecond °/sec",
    "deg/min": "deg/min degpmin dpm °/min º/min degree/min degrees/min degpermin degm/min",
    "rad/s": "rad/s radps rad/sec radpersec radpers radians/s",
    "rpm": "rpm r/min rev/min u/min o/min omdr/min min-1 min^-1",
    "1/min": "1/min",
    "1/s": "1/s rps rev/s r/s s-1",
    "Hz": "hz",
    "m": "m metre meter metres meters",
    "cm": "cm",
    "mm": "mm millimetre millimeter millimetres millimeters",
    "ft": "ft feet",
    "s": "s sec secs second seconds",
    "ms": "ms msec millis millisecond milliseconds",
    "us": "us usec µs μs micros microseconds",
    "ns": "ns nsec nanos nanoseconds",
    "min": "min minute minutes",
    "h": "h hour hours hr hrs",
    "%": "% pct percent procent prozent",
    "N": "newton newtons",
    "kN": "kilonewton",
}
UNIT_WORDS: dict[str, str] = {word: unit for unit, words in WRITTEN.items() for word in words.split()}
IN_BRACKETS = UNIT_WORDS | {"n": "N", "kn": "kn"}  # [N] is a force; [kN] is told from [kn] by its letters
NO_UNIT_ALONE = frozenset(("rpm", "rps"))  # words that are a quantity too: they stay among the words
# German, the Nordic languages, Dutch, French, Spanish, and short forms of a bridge
ENGLISH: dict[str, str] = {
    "zeit": "time", "uhrzeit": "time", "zeitstempel": "timestamp", "tid": "time", "tidspunkt": "timestamp",
    "tijd": "time", "heure": "time", "hora": "time", "klokkeslett": "time", "klocka": "time",
    "datum": "date", "dato": "date", "fecha": "date",
    "breite": "latitude", "breitengrad": "latitude", "breddegrad": "latitude", "latitud": "latitude",
    "bredde": "latitude", "breedtegraad": "latitude", "bredd": "latitude",
    "lange": "longitude", "langengrad": "longitude", "lengdegrad": "longitude", "longitud": "longitude",
    "lengde": "longitude", "lengtegraad": "longitude", "laengengrad": "longitude", "langd": "longitude",
    "kurs": "heading", "koers": "heading", "cap": "heading", "rumbo": "heading", "steuerkurs": "heading",
    "kug": "cog", "kueg": "cog", "fug": "sog", "fueg": "sog", "fdw": "stw",
    "fart": "speed", "geschwindigkeit": "speed", "hastighet": "speed", "snelheid": "speed",
    "vitesse": "speed", "velocidad": "speed", "fahrt": "speed",
    "grund": "ground", "grunn": "ground", "uber": "over", "ueber": "over", "durchs": "through",
    "wasser": "water", "vann": "water", "vatten": "water", "gjennom": "through", "genom": "through",
    "drehrate": "rate of turn", "wendegeschwindigkeit": "rate of turn", "svinghastighet": "rate of turn",
    "girhastighet": "rate of turn", "girrate": "rate of turn", "drehgeschwindigkeit": "rate of turn",
    "ruder": "rudder", "ruderlage": "rudder", "ruderwinkel": "rudder", "ror": "rudder", "roer": "rudder",
    "rorvinkel": "rudder", "roder": "rudder", "rodervinkel": "rudder", "rorutslag": "rudder",
    "timon": "rudder", "safran": "rudder",
    "drehzahl": "rpm", "turtall": "rpm", "varvtal": "rpm", "omdreininger": "rpm", "toerental": "rpm",
    "wellendrehzahl": "shaft rpm", "propellerdrehzahl": "propeller rpm", "motordrehzahl": "engine rpm",
    "motorturtall": "engine rpm", "aksel": "shaft", "welle": "shaft", "axel": "shaft",
    "wind": "wind", "windgeschwindigkeit": "wind speed", "windrichtung": "wind direction",
    "vindstyrke": "wind speed", "vindhastighet": "wind speed", "vindretning": "wind direction",
    "vindriktning": "wind direction", "vind": "wind", "scheinbar": "apparent", "wahr": "true",
    "scheinbarer": "apparent", "wahrer": "true", "relativ": "relative", "rw": "true", "richtung": "direction",
    "retning": "direction", "wassertiefe": "depth", "tiefe": "depth", "dybde": "depth", "djup": "depth",
    "diepte": "depth", "tiefgang": "draught", "dypgang": "draught", "krangung": "roll", "krengning": "roll",
    "backbord": "port", "babord": "port", "bakboord": "port", "bb": "port", "ps": "port", "left": "port",
    "links": "port", "steuerbord": "starboard", "styrbord": "starboard", "stuurboord": "starboard",
    "stb": "starboard", "stbd": "starboard", "sb": "starboard", "right": "starboard", "rechts": "starboard",
    "centre": "center", "middle": "center", "winkel": "angle", "vinkel": "angle", "hdgt": "hdt",
    "spd": "speed", "dir": "direction", "ang": "angle", "vel": "velocity", "velo": "velocity",
    "app": "apparent", "appar": "apparent", "lin": "linear", "pos": "position", "thr": "thruster",
    "rud": "rudder", "bowthr": "bow thruster", "bowthruster": "bow thruster",
    "sternthr": "stern thruster", "sternthruster": "stern thruster",
    "temps": "time", "anemo": "wind", "anemometer": "wind",
}  # fmt: skip


def plain_letters(text: str) -> str:
    """Without accents: Länge is lange, kurs over grunn stays, ø is o."""
    text = text.replace("ø", "o").replace("Ø", "O").replace("æ", "ae").replace("ß", "ss")
    return "".join(c for c in unicodedata.normalize("NFKD", text) if not unicodedata.combining(c))


def unit_in(text: str) -> str:
    """The unit that a cell or a bracket states, as a map writes it; "" when it states none."""
    bare = text.strip().strip(".").replace(" ", "")
    if bare == "kN":
        return "kN"
    bare = bare.lower()
    return IN_BRACKETS.get(bare) or IN_BRACKETS.get(bare.replace("_", "/")) or ""


def words_of(name: str) -> tuple[list[str], str]:
    """(the words of a name in English, the unit in it)."""
    unit = ""
    for inside in BRACKETS.findall(name):
        unit = unit_in(inside) or unit
    found = WORD.findall(CAMEL.sub(" ", plain_letters(BRACKETS.sub(" ", name))).lower())
    if not unit:
        found, unit = unit_behind(found)
        subject, source, _ = name.partition("/")
        if not unit and source and subject:  # a subject of Keelson before its source
            unit = unit_behind(WORD.findall(subject.lower()))[1]
    elif found and unit == UNIT_WORDS.get(found[-1], "") and found[-1] not in NO_UNIT_ALONE:
        found = found[:-1]
    return [w for word in found for w in ENGLISH.get(word, word).split()], unit


def unit_behind(found: list[str]) -> tuple[list[str], str]:
    """The unit that the last words state (`rot deg min`, `yaw rate rad s`), and the words before it; one
    that is a quantity too (rpm) stays among the words."""
    for k in (3, 2):
        tail = found[-k:]
        if len(found) > k - 1 + (k == 2):
            joined = "/".join(t for t in tail if t != "per")
            unit = UNIT_WORDS.get(joined, "") if "/" in joined else ""
            if unit and len(found) > k:
                return found[:-k], unit
    last = found[-1] if found else ""
    unit = UNIT_WORDS.get(last, "") if len(found) > 1 or last in NO_UNIT_ALONE else ""
    return (found[:-1] if unit and last not in NO_UNIT_ALONE else found), unit
