"""The models that are compared, each made from the same training and validation runs and tuned on those alone."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import torch

from bench import paper_ekf, paper_lstm
from bench.paper_lab import Course, free
from bench.paper_ship import nominal
from export.data import Leg, split
from export.network import Residual
from export.teach import Settings, Taught, teach
from export.worth import share
from twin.physics.effects import catalogue, find
from twin.physics.model import Model
from twin.study.columns import core_unknowns, effect_unknowns
from twin.study.fit import fit
from twin.study.innovations import Floor
from twin.study.nuisance import TEMPER

Predict = Callable[[Sequence[Course]], list[np.ndarray]]  # (T, W, 3) for each course
NAMED = ("Wind", "WaveDrift")  # what `twin add` would name on TS-02 and TS-03, the current being seen by the log
ROWS = {
    "analytic": "nominal analytic, as in the paper (no wind, no current)",
    "analytic_current": "nominal analytic, told the current",
    "ekf": "EKF (filterpy), told the current",
    "lstm": "LSTM",
    "hybrid": "hybrid: nominal + network",
    "calibrated": "core calibrated on the TS-01 training runs, no network",
    "physics_added": "calibrated + Wind + WaveDrift, no network",
    "physics_added_hybrid": "calibrated + Wind + WaveDrift + network",
}


@dataclass
class Models:
    """Every model as a function of a course, and what is to be told of how it came about."""

    predict: dict[str, Predict] = field(default_factory=dict)
    told: dict[str, object] = field(default_factory=dict)
    seeds: dict[int, Predict] = field(default_factory=dict)  # the hybrid of every seed


def build(
    lessons: Sequence[Course], settings: Settings, lstm_epochs: int, seeds: Sequence[int], work: Path, tell: Callable[[str], None]
) -> Models:
    """Train, fit and tune everything."""
    ship, out = nominal(), Models()
    plain = Model(ship)
    legs = split([c.water for c in lessons])
    parts = split(lessons)  # type: ignore[type-var]
    used = {name: [c.name for c in some] for name, some in parts.items()}
    out.told["parts"] = {name: len(some) for name, some in used.items()}
    out.predict["analytic"] = lambda cs: free(plain, None, cs, "earth")
    out.predict["analytic_current"] = lambda cs: free(plain, None, cs)
    tell("tuning the EKF")
    walk, keep = paper_ekf.tuned(parts["validation"], plain)
    out.told["ekf"] = {"walk": walk, "disturbance_kept_in_prediction": keep}
    out.predict["ekf"] = lambda cs: paper_ekf.predict(cs, plain, walk, keep)
    tell("training the LSTM")
    lstm = paper_lstm.train(legs["train"], legs["validation"], lstm_epochs)
    out.predict["lstm"] = lambda cs: [paper_lstm.predict(lstm, c) for c in cs]
    for seed in seeds:
        taught = _taught(legs, plain, replace(settings, seed=seed), work / f"hybrid-{seed}.pt", tell)
        out.seeds[seed] = _hybrid(plain, taught.network)
        out.told.setdefault("hybrid", _about(plain, taught))
    out.predict["hybrid"] = out.seeds[seeds[0]]
    tell("calibrating the core, then adding " + ", ".join(NAMED))
    calm = [c for c in parts["train"] if c.scenario == "TS-01"]
    core = _fitted(plain, calm, [])
    out.predict["calibrated"] = lambda cs: free(core, None, cs)
    added = _fitted(core, [c for c in parts["train"] if c.scenario != "TS-01"], NAMED)
    out.told["added"] = {type(e).__name__: {p.name: float(getattr(e, p.name)) for p in e.params()} for e in added.effects}
    out.predict["physics_added"] = lambda cs: free(added, None, cs)
    taught = _taught(legs, added, replace(settings, seed=seeds[0]), work / f"added-{seeds[0]}.pt", tell)
    out.predict["physics_added_hybrid"] = _hybrid(added, taught.network)
    out.told["physics_added_hybrid"] = _about(added, taught)
    return out


def _hybrid(model: Model, network: Residual) -> Predict:
    return lambda cs: free(model, network, cs)


def _taught(legs: dict[str, list[Leg]], model: Model, settings: Settings, keep: Path, tell: Callable[[str], None]) -> Taught:
    """The trained network; the checkpoint stays, so that a run that was stopped goes on."""
    tell(f"training {keep.stem}")

    def show(stage: str, epoch: int, epochs: int, loss: float, validation: float) -> None:
        if epoch % 10 == 0:
            tell(f"  {stage} {epoch}/{epochs}: loss {loss:.4g}, validation {validation:.4g}")

    return teach(legs, model, settings, show, keep)


def _about(model: Model, taught: Taught) -> dict[str, object]:
    s = taught.samples.situation(slice(None))  # type: ignore[arg-type]
    with torch.no_grad():
        rms = float((taught.network.f(taught.network.zeta(s)) ** 2).mean().sqrt())
    return {
        "rms_f": rms,
        "share_of_force": share(taught.network, model, s),
        "epochs": len(taught.curve),
        "seconds": round(taught.seconds, 1),
    }


def _fitted(model: Model, courses: Sequence[Course], effects: Sequence[str]) -> Model:
    """The study's own fit, of the core or of named effects, on tracks in which no current is left."""
    unknowns = [u for name in effects for u in effect_unknowns(find(name), model)] if effects else core_unknowns(model)
    return fit([c.floating for c in courses], model, unknowns, catalogue(), Floor(), temper=TEMPER, rounds=4).model
