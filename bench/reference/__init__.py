"""The reference sea: a 6-DOF witness that shares no physics with `twin/`, every effect in another form.

recording, = simulate([SeaCase("kvlcc2", "mixed", hidden=(("Wind", 1.0),), seed=3)])
recording.columns["heading_true_north_deg"], recording.truth["u"], recording.hidden["Wind"]
"""

from bench.reference.hulls import HULLS, Hull
from bench.reference.sea import Sea
from bench.reference.sea_voyage import Change, Recording, SeaCase, simulate
from bench.reference.weather import WEATHERS, Weather

__all__ = ["HULLS", "WEATHERS", "Change", "Hull", "Recording", "Sea", "SeaCase", "Weather", "simulate"]
