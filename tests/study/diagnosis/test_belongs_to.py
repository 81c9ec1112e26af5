"""An effect says what it belongs to, and what others install is treated as what it says."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.effect import Force, param
from twin.physics.effects import BUILT_IN, catalogue, find
from twin.physics.model import Model
from twin.physics.state import Force as ForceVector
from twin.study.diagnosis.assemble import of_tracks
from twin.study.reference.nuisance import daily, lasting, of_known_weather
from twin.study.reference.weather_baseline import strengths
from twin.study.track.track import track


class SwellSurge(Force):
    """A swell that somebody else's package knows of pushes it along."""

    belongs_to = "voyage"
    needs = ("H_s", "wave_to")

    push: float = param(0.5, unit="N", lo=-5.0, hi=5.0, of="force", doc="force along the waves")

    def force(self, s, ship):
        return ForceVector(X=self.push * s.H_s * np.cos(s.wave_to - s.psi))


class SternSeal(Force):
    """A seal that drags, of somebody else's package."""

    drag: float = param(0.5, unit="N", lo=0.0, hi=5.0, of="force", doc="force astern")


def test_what_is_weather_and_what_lasts_is_read_from_each_effect():
    weather = {e.__name__ for e in BUILT_IN if e.is_weather()}
    assert weather == {"Wind", "WaveDrift", "Bank", "ShallowWater", "Current", "VaryingCurrent"}
    assert {e.__name__ for e in BUILT_IN if not e.lasts()} == {
        "Current",
        "VaryingCurrent",
        "ExternalForce",
        "TowForce",
    }
    assert {e.__name__ for e in BUILT_IN if e.belongs_to == "instrument"} == {
        e.__name__ for e in BUILT_IN if e.kind == "SensorFault"
    }


def test_a_weather_of_others_is_learned_as_weather_and_a_force_of_others_as_the_ships(tanker, voyages):
    """Test: a swell and a drag that no list of the twin names. Expected: the drag is a lasting effect; the
    swell is none, is felt as hard as it pushed, and one that the ship's file knows is usually a little
    otherwise."""
    known = catalogue() | {"SwellSurge": SwellSurge, "SternSeal": SternSeal}
    owners = {u.owner for u in lasting(Model.of(tanker), known)}
    assert "SternSeal" in owners and "SwellSurge" not in owners
    sailed = track(voyages["nothing"], tanker)
    waves = {"H_s": np.full(len(sailed), 3.0), "wave_to": np.zeros(len(sailed))}
    felt = strengths([replace(sailed, weather={**sailed.weather, **waves})], Model.of(tanker), known)
    assert felt["SwellSurge"] > 0.0 and "SternSeal" not in felt
    has = Model.of(tanker).but(SwellSurge(push=1.0))
    assert "SwellSurge.push" in {u.label for u in of_known_weather(has, known)}


def test_what_every_day_brings_a_little_of_is_declared_number_by_number(tanker):
    labels = [u.label for u in daily(Model.of(tanker), catalogue())]
    assert sorted(labels) == ["Current.east", "Current.north", "ExternalForce.east", "ExternalForce.north"]


def test_an_effect_of_nobody_is_refused_when_it_is_declared():
    with pytest.raises(ValueError, match="belongs_to = 'sea'"):
        type("Nobodys", (Force,), {"belongs_to": "sea"})


def test_what_the_readings_alone_show_is_no_cause_of_a_diagnosis_unless_it_is_in_the_file_or_asked_for(
    make, kvlcc2
):
    """Expected: neither candidate, nor not judged, nor a usual error of a calibration; `twin add` can ask. A
    gyro's scale is weighed, but no error of a calibration either."""
    kinematic = {e.__name__ for e in BUILT_IN if e.suspected_first}
    assert kinematic == {"HeadingLag", "CompassDeviation", "ReceiverSmoothing"}
    assert {e.__name__ for e in BUILT_IN if e.kinematic} == {*kinematic, "GyroScale"}
    sailed = [track(make(seconds=600.0), kvlcc2)]
    case, asked = of_tracks(sailed, kvlcc2), of_tracks(sailed, kvlcc2, asked=[find("HeadingLag")])
    assert kinematic.isdisjoint(case.catalogue) and kinematic.isdisjoint(u.owner for u in case.unknowns)
    assert kinematic & set(asked.candidates) == {"HeadingLag"}
    assert set(asked.candidates) - set(case.candidates) == {"HeadingLag"}
    slow = of_tracks(sailed, kvlcc2.with_effects(find("HeadingLag")(lag=1.0)))
    assert kinematic & set(slow.candidates) == {"HeadingLag"}
    usual = {u.owner for u in lasting(Model.of(kvlcc2), catalogue())}
    assert "GyroScale" in case.candidates and usual.isdisjoint({*kinematic, "GyroScale"})
