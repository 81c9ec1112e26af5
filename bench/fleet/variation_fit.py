"""By how much numbers of a healthy ship differ between voyages, learned from the fleet's calibrated ships:
`python -m bench.fleet variation FOLDER`.

    gain(s) = sum over healthy voyages of f( ln p(voyage | references, s) - ln p(voyage | references, 0) )

s: standard deviations of kinds of numbers (of effects: `Effect.varies`), climbed
one at a time on a grid; f(x) = c tanh(x / c), c = LARGEST_GAIN, so that no voyage counts for more. The
voyages are those of `run` with nothing hidden, which no calibration saw; the day's wind, stream and sea are
integrated out beside all that is usual. Each family is left out in turn; its voyages are then judged by what
the others taught."""

import argparse
import pickle
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench.fleet.fact_rows import voyage
from bench.fleet.fleet_page import lines
from bench.fleet.kept_ships import of_families
from bench.fleet.plausibility import build
from bench.fleet.voyage_plan import VOYAGES, plan, references, sailed
from twin.physics.effect import Effect
from twin.physics.effects import catalogue, of_ship
from twin.physics.model import Model
from twin.study.estimation.columns import NO_MODEL, Unknown
from twin.study.estimation.innovations import innovate
from twin.study.estimation.linear import linearise
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.reference.between import BetweenVoyages, ship_of
from twin.study.reference.derivatives import first_prior
from twin.study.reference.nuisance import usual_unknowns
from twin.study.reference.sailed import fed
from twin.study.reference.structure import noise_model_of
from twin.study.track.track import track

GRID = (0.0, 0.015, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.4)
LARGEST_GAIN = 20.0
ROUNDS = 3  # of the climb; a fourth changed nothing
FEW = (2, 3, 4)  # reference voyages; five and six are put together

OF_TURNING = ("N_vv", "N_vr", "N_rv", "N_rr")
WEIGHED_KINDS = (
    "yaw moment of turning",
    "sway and yaw",
    "PropellerWalk",
    "HeadingBias",
    "SpeedLogMisalignment",
    "rest of the core",
    "other effect",
)

Shares = Mapping[str, float]


def kind_of(u: Unknown) -> str:
    """Of WEIGHED_KINDS; "" of what no voyage of a ship shares with the next, and of what no model has."""
    if u.owner == "core":
        return (
            WEIGHED_KINDS[0]
            if u.name in OF_TURNING
            else WEIGHED_KINDS[1]
            if u.name[0] in "YN"
            else "rest of the core"
        )
    if u.owner in WEIGHED_KINDS:
        return u.owner
    return "" if u.every_day or u.owner in NO_MODEL else "other effect"


@dataclass(frozen=True)
class OneShip:
    """What the voyages of one ship say of its numbers, in prior widths."""

    family: str
    kinds: tuple[str, ...]  # of each number (P,); "" of what does not differ
    own: np.ndarray  # (P,) variance that its own references ask for
    pull: np.ndarray  # (P,) of the priors' means
    references: tuple[BetweenVoyages, ...]
    healthy: tuple[BetweenVoyages, ...]  # (P + W,): beside the day's weather

    def log_probability(self, shares: Shares) -> np.ndarray:
        """Of each healthy voyage, when numbers differ between voyages by these shares."""
        scatter = np.maximum(self.own, [shares.get(k, 0.0) ** 2 for k in self.kinds])
        mean, covariance = ship_of(self.references, scatter, self.pull)
        known, every = mean.size, self.healthy[0].b.size
        next_mean, next_covariance = np.zeros(every), np.eye(every)
        next_mean[:known] = mean
        next_covariance[:known, :known] = covariance + np.diag(scatter)
        return np.array([v.log_probability(next_mean, next_covariance) for v in self.healthy])


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, nargs="+", help="of `run`")


def run(args: argparse.Namespace) -> int:
    ships = (of_ship_file(path) for path in of_families(args.folder))
    print("\n".join(page([ship for ship in ships if ship.healthy])))
    return 0


def of_ship_file(path: Path) -> OneShip:
    """A ship that `run` kept, with its voyages sailed again."""
    ship, _ = pickle.loads(path.read_bytes())
    family, _, seed = path.stem.rpartition("-")
    random_ship = build(family, int(seed))
    model, known, stored = Model.of(ship), of_ship(ship), ship.notes["structural"]
    unknowns = usual_unknowns(model, known)
    noise_model = noise_model_of(ship, "beside")
    weather = [u for e in known.values() if e.is_weather() for u in _if_it_can(e, model)]
    beside = (*unknowns, *(u for u in weather if u.label not in {k.label for k in unknowns}))

    def said(sailed_case: object, of: Sequence[Unknown]) -> BetweenVoyages:
        t, sd = track(voyage(sailed_case), ship), np.array([u.sd for u in of])
        A, b, ee = innovate([linearise(t, fed(model, t)[0], tuple(of), known)], [noise_model])[0].total()
        temper = stored["temper_beside"]
        return BetweenVoyages(A * np.outer(sd, sd) / temper, b * sd / temper, ee / temper)

    healthy = [c for c in plan(random_ship, VOYAGES) if c.kind == "nothing"]
    return OneShip(
        family,
        tuple(kind_of(u) for u in unknowns),
        np.array([stored["between_voyages"].get(u.label, 0.0) ** 2 for u in unknowns]),
        np.array([(first_prior(u, ship).centre - u.centre) / u.sd for u in unknowns]),
        tuple(said(s, unknowns) for s in references(random_ship)),
        tuple(said(sailed(random_ship, c), beside) for c in healthy),
    )


def _if_it_can(effect: type[Effect], model: Model) -> Iterable[Unknown]:
    return () if effect.lacking(model.ship) else effect_unknowns(effect, model)


def learned(ships: Sequence[OneShip]) -> dict[str, float]:
    """The shares that the healthy voyages of these ships ask for."""
    none = [s.log_probability({}) for s in ships]

    def gain(shares: Shares) -> float:
        each = np.concatenate([s.log_probability(shares) - n for s, n in zip(ships, none, strict=True)])
        return float((LARGEST_GAIN * np.tanh(each / LARGEST_GAIN)).sum())

    return climbed(gain, dict.fromkeys(WEIGHED_KINDS, 0.0))


def climbed(gain: Callable[[Shares], float], shares: dict[str, float]) -> dict[str, float]:
    """The best of the grid for one share after the other."""
    for _ in range(ROUNDS):
        for kind in shares:
            of = {value: gain({**shares, kind: value}) for value in GRID}
            shares = {**shares, kind: max(of, key=lambda value: of[value])}
    return shares


def page(ships: Sequence[OneShip]) -> list[str]:
    families = sorted({s.family for s in ships})
    taught = {f: learned([s for s in ships if s.family != f]) for f in families}
    every = learned(ships)
    left_out = [(s, s.log_probability(taught[s.family]) - s.log_probability({})) for s in ships]
    standing = {name: effect.varies for name, effect in catalogue().items()}
    stands = [(s, s.log_probability(standing) - s.log_probability({})) for s in ships]
    by_family = [
        (f, *(_summary([g for s, g in of if s.family == f]) for of in (left_out, stands))) for f in families
    ]
    by_count = [
        (name, *(_summary([g for s, g in of if _count(s) == name]) for of in (left_out, stands)))
        for name in [*map(str, FEW), "more"]
    ]
    total = [("all", _summary([g for _, g in left_out]), _summary([g for _, g in stands]))]
    heads = ("its family left out", "as it stands")
    return [
        *lines("Gain of a healthy voyage", "", ("family", *heads), [*by_family, *total]),
        *lines("By number of reference voyages", "", ("references", *heads), by_count),
        *lines(
            "Standard deviations",
            "",
            ("kind", "stands", "learned on all", "least and most with a family left out"),
            [
                (k, f"{standing.get(k, 0.0):g}", f"{every[k]:g}", _range([t[k] for t in taught.values()]))
                for k in WEIGHED_KINDS
            ],
        ),
    ]


def _count(ship: OneShip) -> str:
    n = len(ship.references)
    return str(n) if n in FEW else "more"


def _summary(gains: Sequence[np.ndarray]) -> str:
    each = np.concatenate(gains) if gains else np.zeros(0)
    return f"{each.mean():.1f} (median {np.median(each):.1f}, {each.size})" if each.size else "-"


def _range(values: Sequence[float]) -> str:
    return f"{min(values):g} to {max(values):g}"
