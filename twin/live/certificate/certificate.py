"""The stabilizer's certificate: how far the observer's error can go, worked out from the ship's own numbers
before it sails.

`certify` at start (or `kept` of store.py, which looks it up in a file), `Tube.step` once a tick.
Assumptions, proof and what is not promised: docs/stability.md. Plain floats; only the sure bounds of the
slopes need numpy, and only when they are not on file."""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from math import isfinite
from typing import Any

from twin.checksum import sha256_hex
from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.comparison_systems import Matrix, Row
from twin.live.certificate.gains import best_gain, check, gains_that_do, suited_gain, three, usual_gain
from twin.live.certificate.heading_bound import with_heading
from twin.live.certificate.plant import (
    HEADING_NOISE,
    Disturbance,
    Plant,
    as_disturbance,
    lipschitz,
    output_bound,
    plant_of,
    self_regressor,
    usual_disturbance,
    usual_noise,
)
from twin.live.certificate.recursion import Ages, Recursion
from twin.live.certificate.rolled import assess_rolled, radius
from twin.live.certificate.theorem import Promise, assess
from twin.live.learning.movable import movable
from twin.live.observer.estimate import fastest_gain, gain_for
from twin.live.observer.operating import Confined, OperatingSet, of_ship
from twin.live.observer.rollback import FULL_GAIN
from twin.physics.model import Model
from twin.physics.ship import Ship

__all__ = [
    "Certificate",
    "Confined",
    "Disturbance",
    "OperatingSet",
    "Plant",
    "assess",
    "best_gain",
    "certify",
    "gains_that_do",
    "lipschitz",
    "of_ship",
    "output_bound",
    "plant_of",
    "self_regressor",
    "suited_gain",
    "usual_disturbance",
    "usual_gain",
    "usual_noise",
]

VERSION = 9


@dataclass(frozen=True)
class Certificate(Promise):
    """The promise made to one ship, with what it rests on: gain [1/s], period, delay, noise, disturbance and
    operating set."""

    K: Row
    delays: Ages
    noise: Row
    disturbance: Disturbance
    plant: Plant
    heading_noise: float = 0.0  # of the compass [rad]
    # part of the disturbance that is there only while a learned force acts [N, N, N m]
    saturation: Row = (0.0, 0.0, 0.0)
    extra_growth: Matrix | None = None
    # the physics is asked at the observer's heading: the bound of its error is a fourth state
    estimated_heading: bool = False
    # steps into which a period is cut; more than one: samples correct their own time
    inner: int = 1
    # the same ship as far as its live bound is followed, where that is no matter of cells
    reach: Plant | None = None
    ship: str = ""
    fingerprint: str = ""

    @property
    def delay_samples(self) -> int:
        """The greatest age of a measurement on any axis."""
        return max(self.delays)

    @property
    def h(self) -> float:
        """The certified period [s]."""
        return self.plant.h

    @property
    def step_margin(self) -> float:
        """The share of an error that one sample surely takes away; 0 when none does."""
        worst = radius(self.G) if self.inner > 1 else c3.radius(self.G)
        return max(1.0 - worst, 0.0) if self.ok else 0.0

    @property
    def operating(self) -> OperatingSet:
        """The operating set for which it holds."""
        return self.plant.operating

    def in_reach(self) -> "Certificate":
        """What holds, with the same K, as far as the live bound is followed."""
        assert self.reach is not None
        there = replace(self, plant=self.reach, reach=None)
        return replace(there, **_fields(there._again(self.noise, self.disturbance, self.heading_noise)))

    def bound_in(self, H_s: float) -> Row:
        """The ultimate bound in a sea of that height [m/s, m/s, rad/s]."""
        d = self.disturbance
        return self._again(
            d.noise(self.noise, H_s),
            Disturbance(d.at(H_s)),
            d.heading_noise(self.heading_noise, H_s),
        ).bound

    def _again(self, noise: Row, d: Disturbance, heading_noise: float) -> Promise:
        """The promise of the same observer with this noise and disturbance."""
        return _promised(
            self.plant,
            self.K,
            self.delays,
            noise,
            d,
            heading_noise,
            self.extra_growth,
            self.estimated_heading,
            self.inner,
        )

    def to_json(self) -> str:
        """The certificate as its file, with its version and its checksum."""
        table = json.loads(json.dumps(asdict(self)))
        return json.dumps({"version": VERSION, "sha256": digest(table), **table}, indent=1)

    @classmethod
    def from_json(cls, text: str) -> "Certificate":
        """The certificate that to_json wrote; ValueError, KeyError or TypeError when it is none of this
        version, when a number in it was changed since, or when what it promises does not follow from the
        slopes in it."""
        try:
            return cls._read(text)
        except (ArithmeticError, AttributeError, IndexError, RecursionError) as error:
            raise ValueError(f"no certificate: {error}") from None

    @classmethod
    def _read(cls, text: str) -> "Certificate":
        told = json.loads(text)
        if not isinstance(told, dict) or told.pop("version") != VERSION:
            raise ValueError("certificate of another version")
        if told.pop("sha256") != digest(told):
            raise ValueError("certificate changed since it was written")
        table = _tuples(told)
        table["plant"] = Plant.of_table(table["plant"])
        table["reach"] = table["reach"] and Plant.of_table(table["reach"])
        table["disturbance"] = Disturbance(**table["disturbance"])
        table["step"] = Recursion(**table["step"])
        found = cls(**table)
        if not found.follows():
            raise ValueError("certificate promises what does not follow from its slopes")
        return found

    def follows(self) -> bool:
        """Whether all that is promised is what the theorem makes of the plant, K, delay, noise and
        disturbance that stand beside it."""
        again = self._again(self.noise, self.disturbance, self.heading_noise)
        positive = all(isfinite(x) and x > 0.0 for x in (*self.K, self.h))
        bounds = (*self.noise, self.heading_noise, *self.saturation, *self.disturbance.numbers)
        noisy = len(bounds) == 17 and all(isfinite(x) and x >= 0.0 for x in bounds)
        told = all(getattr(self, name) == x for name, x in _fields(again).items())
        return positive and noisy and self.plant.whole and told and self._reaches()

    def _reaches(self) -> bool:
        """Whether the wider set, where there is one, belongs to this one and has all of its numbers."""
        if (far := self.reach) is None:
            return True
        belongs = far.operating.ranges == self.operating.reach and far.inertia == self.plant.inertia
        return belongs and far.bounded and far == far.at_period(self.h)


def certify(
    model: Model,
    K: float | Sequence[float] | None,
    h: float,
    delay_samples: int | Sequence[int] = 1,
    noise: Sequence[float] = (0.15, 0.15, 0.0005),
    disturbance: Sequence[float] | Disturbance | None = None,
    operating_set: OperatingSet | None = None,
    heading_noise: float = 0.0,
    extra_growth: Matrix | None = None,
    adapted: bool = False,
    saturation: Row = (0.0, 0.0, 0.0),
    estimated_heading: bool = False,
    inner: int = 1,
    reach: bool = False,
) -> Certificate:
    """Work out the certificate of an observer with gain K [1/s] and period h [s] (its longest).

    Takes a tenth of a second to a second. K None: the one that suits the ship (`suited_gain`).
    noise: bounds of |y - nu| [m/s, m/s, rad/s]; heading_noise [rad].
    disturbance: see Disturbance (default: `usual_disturbance`).
    delay_samples: the greatest age of a used measurement, in samples, a value held until the sensor's next
    one included; one number, or one for each of u, v, r.
    extra_growth: `self_regressor(...)` when the network is fed with the estimate instead of measurements.
    adapted: the numbers of the effects move on board; everything then holds wherever in their boxes they are.
    saturation: what a learned force can reach [N, N, N m]; it is added to the disturbance, so that any
        weights are covered.
    estimated_heading: the physics is evaluated at the observer's heading, so its error is a fourth state.
    inner: steps into which a period is cut by an observer that corrects at a sample's own time (`RollBack`).
    reach: with what a live bound needs beyond the operating set (an observer with inner steps always has it).
    """
    delays = [delay_samples] * 3 if isinstance(delay_samples, int) else [*delay_samples]
    check(three(1.0 if K is None else K), h, delays, noise)
    m: Ages = (delays[0], delays[1], delays[2])
    d = as_disturbance(disturbance) or usual_disturbance(model)
    d = replace(d, calm=c3.add(d.calm, saturation))
    numbers = movable(model.effects, model.ship) if adapted else ()
    operating = operating_set or of_ship(model)
    plant, noise = plant_of(model, operating, h, numbers, inner > 1), c3.row(noise)
    if inner > 1:
        K = FULL_GAIN / h
    elif K is None:
        K = suited_gain(plant, m, gain_for(model.ship), fastest_gain(h, max(m)))
    K = c3.row(three(K))
    promise = _promised(plant, K, m, noise, d, heading_noise, extra_growth, estimated_heading, inner)
    far = plant_of(model, OperatingSet(operating.reach), h, numbers) if reach and inner == 1 else None
    return Certificate(
        **_fields(promise),
        K=K,
        delays=m,
        noise=noise,
        disturbance=d,
        plant=plant,
        heading_noise=heading_noise,
        saturation=c3.row(saturation),
        extra_growth=extra_growth,
        estimated_heading=estimated_heading,
        inner=inner,
        reach=far if far and far.bounded else None,
        ship=model.ship.name,
    )


def _fields(promise: Promise) -> dict[str, Any]:
    return {name: getattr(promise, name) for name in Promise.__dataclass_fields__}


def _promised(
    plant: Plant,
    K: Row,
    m: Ages,
    noise: Row,
    d: Disturbance,
    heading_noise: float,
    extra: Matrix | None,
    estimated_heading: bool,
    inner: int,
) -> Promise:
    """The theorem that fits the observer."""
    if inner > 1:
        return assess_rolled(plant, K, inner, noise, d, heading_noise, m)
    promised = with_heading if estimated_heading else assess
    return promised(plant, K, m, noise, d, heading_noise, extra)


def on_board(
    ship: Ship, delay_samples: int, adapted: bool, saturation: Row, inner: int = 1
) -> dict[str, Any]:
    """What the loop's own certificate is asked for."""
    return {
        "delay_samples": delay_samples,
        "adapted": adapted,
        "noise": usual_noise(ship),
        "heading_noise": HEADING_NOISE,
        "saturation": saturation,
        "estimated_heading": True,
        "inner": inner,
        "reach": True,
    }


def digest(table: dict[str, Any]) -> str:
    """The SHA-256 that a certificate file tells of its own content."""
    return sha256_hex(json.dumps(table, sort_keys=True).encode())


def _tuples(x: Any) -> Any:
    """JSON lists as the tuples they were."""
    if isinstance(x, list):
        return tuple(map(_tuples, x))
    return {k: _tuples(v) for k, v in x.items()} if isinstance(x, dict) else x
