"""What the others cost for one step, measured hot in a process of their own (their memory is not the twin's).

hybrid: the twin's step, correct to adapt. analytic: one Runge-Kutta step of the equations. ekf: filterpy's
    filter on the same equations. lstm: two
layers of 128 in ONNX Runtime, one thread, re-run over its window of 50 each step (the paper's kind) and,
beside it, carrying its state. look_ahead: 120 s in 1200 steps of 0.1 s and in 120 of 1 s, for one ship and
for an ensemble of 64.

    python -m bench.tick.peers [--repeats 1000]      prints JSON
"""

import argparse
import json
from collections.abc import Callable
from typing import Any

import numpy as np

from bench.options import positive
from bench.tick import counted
from bench.tick.ekf import ShipFilter
from bench.tick.ort import session
from bench.tick.random_lstm import HIDDEN, INPUTS, LAYERS, lstm_bytes
from bench.tick.timing import hot_us, quantiles
from twin.live.observer.dynamics import NONE, KnownDynamics
from twin.live.observer.predict import ensemble
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Situation

WINDOW = 50
SETTLE = 4000  # steps of the twin, 80 s, until its filters have settled and it learns
ROUNDS, HOT = 20, 10
STEP_S = 0.1
AHEAD_S, FINE_S, COARSE_S, ENSEMBLE = 120.0, 0.1, 1.0, 64
SHIP = "kvlcc2"


def situation(ship: Any, **changed: Any) -> Situation:
    """Under way at service speed, turning a little, in wind: every term of the model is at work."""
    given = {"u": ship.U_0, "v": 0.1, "r": 0.002, "delta": 0.1, "n": 1.5, "wind_speed": 8.0, "wind_to": 0.7}
    return Situation(**(given | changed))


def analytic(ship: Any) -> Callable[[], object]:
    model, s = Model.of(ship), situation(ship)
    state = (0.0, 0.0, 0.0, s.u, s.v, s.r)
    return lambda: model.step(state, s, STEP_S)


def ekf(ship: Any) -> Callable[[], object]:
    peer = ShipFilter(Model.of(ship), situation(ship), STEP_S)
    measured = np.array([0.0, 0.0, 0.0, ship.U_0, 0.0, 0.0])
    return lambda: peer.tick(measured)


def lstm(ship: Any) -> Callable[[], object]:
    net, window = session(lstm_bytes(False)), np.zeros((WINDOW, 1, INPUTS), np.float32)
    newest = np.ones(INPUTS, np.float32)

    def step() -> object:
        window[:-1] = window[1:]
        window[-1, 0] = newest
        return net.run(["y"], {"x": window})

    return step


def lstm_stateful(ship: Any) -> Callable[[], object]:
    net, feed = session(lstm_bytes(True)), {"x": np.ones((1, 1, INPUTS), np.float32)}
    names = [f"{s}{layer}" for layer in range(LAYERS) for s in "hc"]
    feed |= {name: np.zeros((1, 1, HIDDEN), np.float32) for name in names}

    def step() -> object:
        y, *carried = net.run(["y", *(f"{name}_out" for name in names)], feed)
        feed.update(zip(names, carried, strict=True))
        return y

    return step


PEERS = {"analytic": analytic, "ekf": ekf, "lstm": lstm, "lstm_stateful": lstm_stateful}


def look_ahead(ship: Any, members: int, step_s: float) -> Callable[[], Situation]:
    """120 s open loop by the equations; for an ensemble every number is an array over its members."""
    spread = np.linspace(-1.0, 1.0, members) if members > 1 else 0.0
    speeds = {"u": ship.U_0 + 0.1 * spread, "v": 0.1 + 0.0 * spread, "r": 0.002 + 0.0 * spread}
    s, physics = situation(ship, wind_speed=8.0 + 2.0 * spread, **speeds), KnownDynamics(Model.of(ship))
    return lambda: ensemble(s, physics, lambda s, forces: NONE, AHEAD_S, step_s)


def ahead(ship: Any, members: int) -> dict[str, float]:
    """Milliseconds of the look-ahead in fine and in coarse steps, and how far apart their ends are at
    most."""
    fine, coarse = (look_ahead(ship, members, step_s) for step_s in (FINE_S, COARSE_S))
    a, b = fine(), coarse()
    return {
        f"steps_{AHEAD_S / FINE_S:.0f}_ms": round(min(hot_us(fine, 1, warm_up=0)) * 1e-3, 1),
        f"steps_{AHEAD_S / COARSE_S:.0f}_ms": round(min(hot_us(coarse, 3, warm_up=0)) * 1e-3, 1),
        "apart_m": round(float(np.max(np.hypot(a.x - b.x, a.y - b.y))), 4),
        "apart_deg": round(float(np.degrees(np.max(np.abs(a.psi - b.psi)))), 5),
    }


def measure(repeats: int) -> dict[str, Any]:
    """{"hybrid": {...}, "peers": {name: {"median_us", "p99_us"}}, "look_ahead": {who: {...}}}.

    All in turn, a few steps of each, so that a machine that gets slower or faster does so for all.
    """
    ship, few = load(SHIP), max(repeats // ROUNDS, 1)
    steps = {"hybrid": counted.hybrid(SETTLE + ROUNDS * (few + HOT))} | {
        name: make(ship) for name, make in PEERS.items()
    }
    hot_us(steps["hybrid"], 1, SETTLE - 1)
    times: dict[str, list[float]] = {name: [] for name in steps}
    for _ in range(ROUNDS):
        for name, step in steps.items():
            times[name] += hot_us(step, few, HOT)
    found = {name: _quantiles(us) for name, us in times.items()}
    twin = found.pop("hybrid") | {"mean_us": _mean_us(times["hybrid"])}
    look = {"one ship": ahead(ship, 1), f"{ENSEMBLE} ships": ahead(ship, ENSEMBLE)}
    return {"hybrid": twin, "peers": found, "look_ahead": look}


def _mean_us(times: list[float]) -> float:
    """Of five steps together, in one of which it learns; the median of such means."""
    every = counted.EVERY
    return quantiles(
        [sum(times[i : i + every]) / every for i in range(0, len(times) - every + 1, every)], ("median",)
    )["median"]


def _quantiles(times: list[float]) -> dict[str, float]:
    return {f"{name}_us": us for name, us in quantiles(times, ("median", "p99")).items()}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=positive, default=1000)
    print(json.dumps(measure(parser.parse_args().repeats)))
