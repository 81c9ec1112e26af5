"""An effect was named and added, and grows in the middle of a voyage: what learning its number on board takes
back.

The ship's model is the calibrated core with Wind and WaveDrift and their network (as in `twin-bench paper`),
and one effect more, added at the size it had before the voyage; at CHANGE_S it grows. The filter keeps the
ship file's numbers and hears all laws' stream; free runs of 120 s begin with what each had learned by then.
RUN_S is long enough for the memory of 20 L/U_0 to be filled anew."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import torch

from bench.adaptation.heard import Heard, Hearing, by_scenario
from bench.paper.models import Workshop, named
from bench.paper.nominal_ship import nominal
from bench.paper.paper_voyages import zigzags
from bench.reference import HULLS, Change
from twin.live.learning.adapt import Adaptation
from twin.live.learning.movable import movable, moved
from twin.physics.effects import find
from twin.physics.model import Model

CHANGE_S, RUN_S = 300.0, 1500.0
# the first window ends where the change begins
STARTS_S = (180.0, 300.0, 420.0, 600.0, 780.0, 960.0, 1140.0, 1320.0)
LATE_S = 600.0  # windows begun so long after the change are called late
SIGMAS = 1.96  # of the interval


class RowsAlone(Adaptation):
    """The law on board, but the effects' numbers stand still."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.named.learn = lambda *_: None  # type: ignore[method-assign]


HOW: dict[str, Callable[..., Adaptation] | None] = {"off": None, "rows alone": RowsAlone, "on": Adaptation}


@dataclass(frozen=True)
class Growth:
    """An effect of the ship file with its numbers, the hull before and after the change, and the number that
    grows with its truth."""

    effect: str
    file: dict[str, float]
    before: dict[str, float]  # fields of the reference hull, as factors
    after: dict[str, float]
    grows: str = ""
    truth: float = 0.0


GROWTHS = {
    "rudder wear 0.15, and stays": Growth(
        "RudderWear", {"loss": 0.15}, {"A_R": 0.85}, {"A_R": 0.85}, "loss", 0.15
    ),
    "rudder wear 0.15 to 0.30": Growth(
        "RudderWear", {"loss": 0.15}, {"A_R": 0.85}, {"A_R": 0.70}, "loss", 0.30
    ),
    "fouling 0.2 to 0.4": Growth("HullFouling", {"extra": 0.2}, {"R0": 1.2}, {"R0": 1.4}, "extra", 0.4),
    "mass 0.05 to 0.10": Growth(
        "Loading", {"mass": 0.05, "draught": 0.0, "x_G": 0.0}, {"m": 1.05}, {"m": 1.10}, "mass", 0.10
    ),
    "windage, and half as much again": Growth("", {}, {}, {"A_L": 1.5, "A_F": 1.5}),
    "as it is": Growth("", {}, {}, {}),
}


def with_effect(growth: Growth, model: Model) -> Model:
    """The model that the ship file has before it grows; on board the law learns what the file names."""
    if growth.effect:
        model = Model(model.ship, (*model.effects, find(growth.effect)(**growth.file)))
    return replace(model, ship=replace(model.ship, effects=model.effects))


def growing(growth: Growth, seeds: int) -> list[Any]:
    """Zigzags of its hull before, and of that after from CHANGE_S on."""
    hull = HULLS["kvlcc2"]
    before, after = (
        replace(hull, **{k: f * getattr(hull, k) for k, f in by.items()})
        for by in (growth.before, growth.after)
    )
    change = None if growth.before == growth.after else Change(CHANGE_S, after)
    return zigzags(seeds, 97_000, hull=before, change=change, duration_s=RUN_S)


@dataclass(frozen=True)
class LearnedEffects:
    """By voyage and window: the rows' numbers (V, W, 3, width), the effects' that act and as published with
    sigma (V, W, P), the gate."""

    rows: np.ndarray
    acting: np.ndarray
    value: np.ndarray
    sigma: np.ndarray
    gate: np.ndarray


def learned(made: Callable[..., Adaptation] | None, heard: Heard) -> LearnedEffects:
    """What a law has learned by each window's start."""
    voyages = [
        _of_voyage(made, heard, stream, c.starts)
        for stream, c in zip(heard.streams, heard.courses, strict=True)
    ]
    return LearnedEffects(*(np.array([v[i] for v in voyages]) for i in range(5)))


def _of_voyage(made: Any, heard: Heard, stream: Any, starts: np.ndarray) -> tuple[list[Any], ...]:
    law = (made or Adaptation)(heard.model.ship, heard.acting.network.S, len(heard.acting.rows))
    out: tuple[list[Any], ...] = ([], [], [], [], [])
    first = len(heard.states) - len(stream)
    for k in range(int(starts[-1]) + 1):
        if made is not None and k >= first:
            law.learn(*stream[k - first])
        if k in starts:
            for kept, x in zip(
                out,
                (law.numbers(), law.named.acting(), law.named.values(), law.named.sigma, law.named.gate),
                strict=True,
            ):
                kept.append(x)
    return out


def errors(heard: Heard, known: LearnedEffects) -> tuple[np.ndarray, np.ndarray]:
    """Heading deg and lateral m of the free runs (V, W)."""
    numbers = movable(heard.model.effects, heard.model.ship)
    flat = known.acting.reshape(-1, len(numbers))
    values = [
        torch.tensor(m.start + m.sd * x, dtype=torch.float32) for m, x in zip(numbers, flat.T, strict=True)
    ]
    model = Model(heard.model.ship, moved(heard.model.effects, numbers, values))
    return heard.errors(known.rows.reshape(-1, *known.rows.shape[2:]), model)


def compare(shop: Workshop, seeds: int) -> dict[str, Any]:
    """Every growth, every way of learning."""
    hearing = Hearing.of(shop, named(shop.parts["train"], Model(nominal()))[1], "added")
    out: dict[str, Any] = {
        "seeds": seeds,
        "change_s": CHANGE_S,
        "late_s": LATE_S,
        "starts_s": STARTS_S,
        "growths": {},
    }
    for name, growth in GROWTHS.items():
        shop.tell(f"named: {name}")
        heard = hearing.of_voyages(growing(growth, seeds), STARTS_S, with_effect(growth, hearing.model))
        known = {how: learned(made, heard) for how, made in HOW.items()}
        ways = {how: summary(*errors(heard, x), heard.scenario, seeds) for how, x in known.items()}
        out["growths"][name] = {"how": ways, "number": arrival(growth, heard, known["on"], heard.scenario)}
    return out


def late() -> np.ndarray:
    """(W,) the windows begun LATE_S after the change or later."""
    return np.array(STARTS_S) >= CHANGE_S + LATE_S


def summary(heading: np.ndarray, lateral: np.ndarray, scenario: np.ndarray, seeds: int) -> dict[str, Any]:
    """Of errors (V, W): by window; of the late windows by seed and by scenario."""
    end = late()
    return {
        "heading_deg": heading.mean(0).tolist(),
        "lateral_m": lateral.mean(0).tolist(),
        "late_heading_deg": [float(x[:, end].mean()) for x in np.split(heading, seeds)],
        "late_lateral_m": [float(x[:, end].mean()) for x in np.split(lateral, seeds)],
        "by_scenario_deg": by_scenario(heading[:, end], scenario),
    }


def arrival(
    growth: Growth, heard: Heard, known: LearnedEffects, scenario: np.ndarray
) -> dict[str, Any] | None:
    """The number that grew, as published, beside the truth: by scenario mean over voyages at each window, and
    half its 95 % interval; and in which share of the late windows the interval holds the truth."""
    if not growth.grows:
        return None
    numbers = movable(heard.model.effects, heard.model.ship)
    j = [m.label for m in numbers].index(f"{growth.effect}.{growth.grows}")
    value, half = known.value[..., j], SIGMAS * numbers[j].sd * known.sigma[..., j]
    held = np.abs(value - growth.truth)[:, late()] <= half[:, late()]
    parts = {name: scenario == name for name in sorted(set(scenario.tolist()))}
    return {
        "label": numbers[j].label,
        "file": growth.file[growth.grows],
        "truth": growth.truth,
        "held": float(held.mean()),
        "value": {name: value[some].mean(0).tolist() for name, some in parts.items()},
        "half_95": {name: half[some].mean(0).tolist() for name, some in parts.items()},
        "spread": {
            name: value[some].std(0, ddof=1).tolist() if some.sum() > 1 else [0.0] * len(STARTS_S)
            for name, some in parts.items()
        },
    }
