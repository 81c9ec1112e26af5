"""One case of the random adversaries, and its certificate."""

from typing import NamedTuple

from bench.stability.adversary_fleet import HEADING_NOISE
from twin.live.certificate import certificate as cert
from twin.live.certificate.certificate import Certificate
from twin.live.learning.movable import movable
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load

NOISE = {
    "kvlcc2": (0.15, 0.15, 0.0005),
    "container": (0.15, 0.15, 0.0006),
    "usv": (0.06, 0.06, 0.008),
}  # three sigma of usual sensors


class AdversaryCase(NamedTuple):
    """One line of the table: which ship, how often, how late, in what sea, how many runs."""

    ship: str
    rate_hz: float
    delays: tuple[int, int, int]  # oldest measurement of u, v, r, in samples
    runs: int
    H_s: float = 0.0
    dropouts: bool = False
    K: float | None = None  # 1/s; None: `usual_gain`
    # effects whose numbers an adversary moves in their boxes, and the wind's, as adaptation might
    moving: tuple[str, ...] = ()


def certified(case: AdversaryCase) -> tuple[Model, Certificate]:
    """The model of a case, with wind and a current, and its certificate."""
    model = Model.of(load(case.ship))
    U = model.ship.U_0
    model = model.but(
        find("Wind").plausible(model.ship),
        find("Current").plausible(model.ship).but(north=0.12 * U, east=-0.08 * U),
        *(find(name).plausible(model.ship) for name in case.moving),
    )
    h = 1.0 / case.rate_hz
    plant = cert.plant_of(
        model, cert.of_ship(model), h, movable(model.effects, model.ship) if case.moving else ()
    )
    # if none holds, the certificate says so
    K = case.K or cert.usual_gain(plant, case.delays) or 1.0 / model.ship.scale("time")
    return model, cert.certify(
        model, K, h, case.delays, NOISE[case.ship], heading_noise=HEADING_NOISE, adapted=bool(case.moving)
    )
