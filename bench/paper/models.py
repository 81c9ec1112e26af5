"""The models that are compared, each made from the same training and validation runs and tuned on those
alone."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch

from bench.paper import adapted as paper_adapted
from bench.paper import filter as paper_filter
from bench.paper import lstm as paper_lstm
from bench.paper import lstm_onnx as paper_lstm_onnx
from bench.paper import paper_voyages, tuned_ekf
from bench.paper.adapted import Acting
from bench.paper.apart import apart
from bench.paper.filter import Push, Tuning
from bench.paper.gap import gap
from bench.paper.lab import LabCourse, course, free
from bench.paper.nominal_ship import nominal
from export.batches import zeta_of
from export.data import TrainingLeg, split
from export.residual_network import ResidualNetwork
from export.settings import TrainingSettings
from export.teach import Taught, teach
from export.worth import share
from twin.physics.effects import catalogue, find
from twin.physics.model import Model
from twin.study.estimation.columns import core_unknowns
from twin.study.estimation.fit import fit
from twin.study.estimation.innovations import NoiseModel
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.reference.nuisance import TEMPER

Predict = Callable[[Sequence[LabCourse]], list[np.ndarray]]  # (T, W, 3) for each course
# what `twin add` would name on TS-02 and TS-03, the current being seen by the log
NAMED = ("Wind", "WaveDrift")
ROWS = {
    "analytic": "nominal analytic, as in the paper (no wind, no current)",
    "analytic_current": "nominal analytic, told the current",
    "ekf": "EKF (filterpy), told the current",
    "lstm": "LSTM",
    "hybrid_smooth": "hybrid, begun in the smooth motion",
    "hybrid": "**hybrid: nominal + network**, begun in its own filter",
    "hybrid_adapted": "the same, learning on (twin/live/learning/adapt.py)",
    "calibrated": "core calibrated on the TS-01 training runs, own filter, no network",
    "physics_added": "calibrated + Wind + WaveDrift, own filter, no network",
    "physics_added_hybrid": "calibrated + Wind + WaveDrift + network, own filter",
}


@dataclass
class Models:
    """Every model as a function of courses, and what is to be told of how it came about."""

    predict: dict[str, Predict] = field(default_factory=dict)
    about: dict[str, Any] = field(default_factory=dict)
    # of every seed: the hybrid, and that on named physics
    seeds: dict[str, dict[int, Predict]] = field(default_factory=dict)
    # validation loss by epoch, of every seed
    curves: dict[str, list[list[float]]] = field(default_factory=dict)
    acting: Acting | None = None  # the first seed's network, for adaptation
    tuning: Tuning = field(default_factory=Tuning)
    network: Any = None  # the first seed's
    plain: Any = None  # the nominal model
    shop: Any = None


@dataclass(frozen=True)
class Workshop:
    """Where models are made: the voyages by parts, the settings, and where what is done is kept."""

    parts: dict[str, list[LabCourse]]
    legs: dict[str, list[TrainingLeg]]
    settings: TrainingSettings
    work: Path
    tell: Callable[[str], None]

    @classmethod
    def of(
        cls, lessons: Sequence[LabCourse], settings: TrainingSettings, work: Path, tell: Callable[[str], None]
    ) -> "Workshop":
        return cls(split(lessons), split([c.water for c in lessons]), settings, work, tell)  # type: ignore[type-var,arg-type]

    @classmethod
    def planned(cls, plan: paper_voyages.PaperPlan, work: Path, tell: Callable[[str], None]) -> "Workshop":
        """Of a plan whose lessons are not yet sailed."""
        lessons = [
            course(one, nominal())
            for one in paper_voyages.sail(paper_voyages.lessons(plan), work / "voyages", tell, plan.tick_s)
        ]
        return cls.of(lessons, settings_for(plan), work, tell)

    def taught(self, model: Model, seed: int, name: str) -> Taught:
        """The trained network; the checkpoint stays, so that a run that was stopped goes on."""
        self.tell(f"training {name}-{seed}")

        def show(stage: str, epoch: int, epochs: int, loss: float, validation: float) -> None:
            if epoch % 10 == 0:
                self.tell(f"  {stage} {epoch}/{epochs}: loss {loss:.4g}, validation {validation:.4g}")

        return teach(
            self.legs, model, replace(self.settings, seed=seed), show, self.work / f"{name}-{seed}.pt"
        )

    def tuned(self, model: Model, push: Push | None) -> Tuning:
        return paper_filter.tuned(self.parts["validation"], model, push)


def settings_for(plan: paper_voyages.PaperPlan) -> TrainingSettings:
    """Of the training."""
    return TrainingSettings(
        epochs=plan.epochs, rollout_epochs=plan.rollout_epochs, rollout_batch=plan.rollout_batch
    )


def build(
    lessons: Sequence[LabCourse],
    settings: TrainingSettings,
    lstm_epochs: int,
    seeds: Sequence[int],
    work: Path,
    tell: Callable[[str], None],
) -> Models:
    """Train, fit and tune everything."""
    out, shop, plain = Models(), Workshop.of(lessons, settings, work, tell), Model(nominal())
    out.shop, out.plain = shop, plain
    out.about["parts"] = {name: len(some) for name, some in shop.parts.items()}
    out.predict["analytic"] = lambda cs: free(plain, None, cs, "earth")
    out.predict["analytic_current"] = lambda cs: free(plain, None, cs)
    _filtered(out, shop, plain)
    _sequence(out, shop, lstm_epochs, seeds[0])
    _hybrids(out, shop, plain, seeds)
    _named(out, shop, plain, seeds)
    return out


def _filtered(out: Models, shop: Workshop, plain: Model) -> None:
    """The EKF of the paper's comparison."""
    shop.tell("tuning the EKF")
    walk, keep = tuned_ekf.tuned(shop.parts["validation"], plain)  # type: ignore[arg-type]
    out.about["ekf"] = {"walk": walk, "disturbance_kept_in_prediction": keep}
    out.predict["ekf"] = lambda cs: tuned_ekf.predict(cs, plain, walk, keep)


def _sequence(out: Models, shop: Workshop, epochs: int, seed: int) -> None:
    shop.tell("training the LSTM")
    lstm = paper_lstm.train(
        shop.legs["train"], shop.legs["validation"], epochs, seed, keep=shop.work / f"lstm-{epochs}-{seed}.pt"
    )
    out.curves["lstm"] = [lstm.curve]
    file = paper_lstm_onnx.to_onnx(lstm)
    (shop.work / "lstm.onnx").write_bytes(file)
    out.about["lstm"] = {
        "epochs": len(lstm.curve),
        "torch_onnx_difference": paper_lstm_onnx.disagreement(lstm, file),
    }
    out.predict["lstm"] = lambda cs: [paper_lstm.predict(lstm, c) for c in cs]


def _hybrids(out: Models, shop: Workshop, plain: Model, seeds: Sequence[int]) -> None:
    """One network for each seed; the filter is tuned once, with the first."""
    taught = {seed: shop.taught(plain, seed, "hybrid") for seed in seeds}
    first = taught[seeds[0]]
    shop.tell("tuning the hybrid's filter")
    out.tuning = shop.tuned(plain, first.network)
    out.seeds["hybrid"] = {seed: _started(plain, one.network, out.tuning) for seed, one in taught.items()}
    out.curves["hybrid"] = [[row[3] for row in t.curve if row[0] == "rollout"] for t in taught.values()]
    out.network = first.network
    out.acting = Acting(first.network, plain, zeta_of(first.network, first.samples))
    out.predict["hybrid"] = out.seeds["hybrid"][seeds[0]]
    out.about["hybrid"] = _about(plain, first) | {
        "filter": asdict(out.tuning),
        "apart": apart(shop.parts["test"], plain, first.network),
    }
    told = {"hybrid": out.predict["hybrid"], "analytic_current": out.predict["analytic_current"]}
    out.about["gap"] = gap(told, shop.parts["validation"], shop.parts["test"])
    out.predict["hybrid_smooth"] = lambda cs: free(plain, first.network, cs)
    out.predict["hybrid_adapted"] = lambda cs: paper_adapted.predict(cs, plain, out.acting, out.tuning)  # type: ignore[arg-type]


def _named(out: Models, shop: Workshop, plain: Model, seeds: Sequence[int]) -> None:
    """What has a name first, then a network on top."""
    shop.tell("calibrating the core, then adding " + ", ".join(NAMED))
    core, added = named(shop.parts["train"], plain)
    out.about["added"] = {
        type(e).__name__: {p.name: float(getattr(e, p.name)) for p in e.params()} for e in added.effects
    }
    for name, model in (("calibrated", core), ("physics_added", added)):
        out.predict[name] = _started(model, None, shop.tuned(model, None))
    taught = {seed: shop.taught(added, seed, "added") for seed in seeds}
    first = taught[seeds[0]]
    tuning, both = shop.tuned(added, first.network), "physics_added_hybrid"
    out.about[both] = _about(added, first) | {"apart": apart(shop.parts["test"], added, first.network)}
    out.seeds[both] = {seed: _started(added, one.network, tuning) for seed, one in taught.items()}
    out.predict[both] = out.seeds[both][seeds[0]]


def named(train: Sequence[LabCourse], plain: Model) -> tuple[Model, Model]:
    """The core calibrated on the calm runs, then with what `twin add` would name on the others; as far as
    there are such runs."""
    calm, windy = ([c for c in train if (c.scenario == "TS-01") is still] for still in (True, False))
    core = _fitted(plain, calm, []) if calm else plain
    return core, _fitted(core, windy, NAMED) if windy else core


def _started(model: Model, network: ResidualNetwork | None, tuning: Tuning) -> Predict:
    return lambda cs: paper_filter.predict(cs, model, network, tuning)


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


def _fitted(model: Model, courses: Sequence[LabCourse], effects: Sequence[str]) -> Model:
    """The study's own fit, of the core or of named effects, on tracks in which no current is left."""
    unknowns = (
        [u for name in effects for u in effect_unknowns(find(name), model)]
        if effects
        else core_unknowns(model)
    )
    return fit([c.floating for c in courses], model, unknowns, catalogue(), NoiseModel(), temper=TEMPER).model
