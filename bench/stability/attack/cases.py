"""Which ships, rates and delays are attacked, inside the assumptions of the certificate and outside."""

from dataclasses import replace
from functools import cache
from typing import NamedTuple

from bench.stability.adversary_case import AdversaryCase, certified
from twin.live.build import stabilizer_of
from twin.live.certificate.certificate import Certificate
from twin.live.signals.config import Settings
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load

SHIPS = ("kvlcc2", "container", "kvlcc2_model", "usv")
RATES_HZ = (10.0, 20.0, 50.0)
FACTORS = (1.1, 1.25, 1.5, 2.0)  # outside: times the limit
DELAYS = (0.0, 0.5, 1.0)  # of the greatest age that the certificate allows
FULL_RUN, SHORT, GAPS = "full", "short", "gaps"
AHEAD, ASTERN = "yaw late", "yaw prompt"  # every tick full, samples of each row of an age of its own
MIXED = {AHEAD: (0.0, 0.5, 1.0, 0.0), ASTERN: (1.0, 0.5, 0.0, 1.0)}  # of u, v, r, psi, share of the greatest


class Excess(NamedTuple):
    """How many times its limit each thing that the certificate assumes reaches; 1: inside."""

    force: float = 1.0
    noise: float = 1.0
    delay: float = 1.0
    tick: float = 1.0


class Group(NamedTuple):
    """Runs of one kind: the greatest age of a sample as a share of what is allowed, the pattern of ticks and
    samples (full: every tick as long as allowed, every sample comes; short: ticks up to a tenth shorter;
    gaps: samples get lost; MIXED: see there), and what is exceeded."""

    delay: float
    pattern: str = FULL_RUN
    excess: Excess = Excess()

    @property
    def inside(self) -> bool:
        return self.excess == Excess()

    @property
    def ages(self) -> tuple[float, ...]:
        """Of u, v, r, psi, where a sample corrects its own time: shares of the greatest."""
        return MIXED.get(self.pattern) or (self.delay,) * 4


class AttackCase(NamedTuple):
    """One ship at one rate, with the certificate that its loop takes on board; with `late`, that of Theorem 2
    for samples so many ticks late, as the random runs have it (bench/stability/adversaries.py). `reach`: the
    live bound of Theorem 2 in a turn that is beyond the usual set."""

    ship: str
    rate_hz: float
    late: int | None = None
    reach: bool = False

    @property
    def name(self) -> str:
        """What is certified."""
        if self.late is not None:
            return f"late {self.late}"
        return "on board, as far as it reaches" if self.reach else "on board"


INSIDE = tuple(Group(delay, pattern) for delay in DELAYS for pattern in (FULL_RUN, SHORT, GAPS))
EXCESSES = {name: (name,) for name in Excess._fields} | {"all": Excess._fields}  # what is exceeded together
OUTSIDE = tuple(
    Group(1.0, excess=Excess()._replace(**dict.fromkeys(names, factor)))
    for names in EXCESSES.values()
    for factor in FACTORS
)
MIXED_GROUPS = tuple(Group(1.0, pattern) for pattern in MIXED)  # Theorem 2 has them in all of its groups
GROUPS = INSIDE + OUTSIDE
CASES = (
    *(AttackCase(ship, rate) for ship in SHIPS for rate in RATES_HZ),
    *(AttackCase(ship, 10.0, reach=True) for ship in ("kvlcc2", "container")),
    *(AttackCase(ship, 50.0, reach=True) for ship in ("kvlcc2_model", "usv")),
    AttackCase("kvlcc2", 10.0, 1),
    AttackCase("container", 10.0, 1),
    AttackCase("usv", 50.0, 1),
    AttackCase("usv", 50.0, 0),
    AttackCase("usv", 10.0, 0),
)


def groups_of(case: AttackCase) -> tuple[Group, ...]:
    """All groups of a case."""
    return GROUPS + (MIXED_GROUPS if certified_for(case)[1].inner > 1 else ())


@cache
def certified_for(case: AttackCase) -> tuple[Model, Certificate]:
    """The ship in a current, and its certificate."""
    ship = load(case.ship)
    current = find("Current").plausible(ship).but(north=0.12 * ship.U_0, east=-0.08 * ship.U_0)
    model = Model.of(ship).but(current)
    if case.late is not None:
        return model, certified(AdversaryCase(case.ship, case.rate_hz, (case.late,) * 3, 1))[1]
    settings = Settings(
        {
            "ship.file": case.ship,
            "loop.rate_hz": case.rate_hz,
            "residual.file": "none",
            "adaptation.on": False,
        }
    )
    tube = stabilizer_of(settings, ship, None).tube
    assert tube is not None and tube.certificate.ok, case
    c = tube.certificate
    return model, c.in_reach() if case.reach else replace(c, reach=None)
