"""A ship of a family: hull, drive, windage and what is usual of its instruments."""

from dataclasses import dataclass

import numpy as np

from bench.fleet import fleet_weather
from bench.fleet.drive import Propulsion
from bench.fleet.hull_families import FleetHull
from bench.fleet.kit import Kit
from bench.fleet.random_particulars import Particulars


@dataclass
class RandomShip:
    """One random ship; `heels`: whether its heel acts on it and is recorded."""

    family: str
    seed: int
    p: Particulars
    hull: FleetHull
    drive: Propulsion
    windage: fleet_weather.Windage
    kit: Kit
    GM: float

    def given(self, rng: np.random.Generator) -> dict[str, float]:
        """What the owner types into `twin init`: particulars to a few per cent."""
        p, near = self.p, lambda v, sd=0.01: float(v * (1 + sd * rng.standard_normal()))
        return {
            "length-pp-m": p.L,
            "beam-m": p.B,
            "draught-m": p.T,
            "block-coefficient": round(near(p.C_b), 3),
            "x-g-m": p.x_G,
            "service-speed-mps": near(p.U0),
            "shaft-speed-rpm": near(60 * self.drive.n0),
            "propellers": float(p.propellers),
            "propeller-diameter-m": p.D_P,
            "pitch-ratio": near(p.pitch, 0.03),
            "rudder-area-m2": near(p.A_R, 0.03),
            "frontal-area-m2": near(p.A_F, 0.1),
            "lateral-area-m2": near(p.A_L, 0.1),
        }
