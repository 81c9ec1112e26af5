"""Which states, streams and constant forces can be seen in a voyage's measurements at all.

Empirical observability Gramian [Krener & Ide 2009]: start, current and a constant unknown force are nudged by
a tenth of what is not known of them, the model is run on over windows of the voyage, and the readings' answer
is counted in their own scatter. A direction that answers with less than one is not told by the window; below
1e-4 of the strongest it cannot be seen at all, which is what a Lie-rank test would say.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.physics.effects import of_role
from twin.physics.model import Model
from twin.physics.state import Force, Situation
from twin.study.estimation.respond import readings, steered
from twin.study.track.track import READINGS, STATE, Track

UNKNOWNS = ("x", "y", "psi", "u", "v", "r", "current north", "current east", "force X", "force Y", "force N")
SUITES = {  # which readings are left out
    "as measured": (),
    "without speed log": ("u_r", "v_r"),
    "without position": ("x", "y"),
    "without position and ground speed": ("x", "y", "u", "v"),
}
LENGTHS = 3.0  # a window lasts while the ship sails so many of its lengths
NUDGE = 0.1  # of the prior width
UNSEEN = 1e-4  # a direction whose answer is below this share of the strongest is not seen


def observability(t: Track, model: Model) -> dict[str, Any]:
    """For each set of sensors: rank, condition and weakest direction of the Gramian, and what is still
    unknown after a window.
    """
    answer = sensitivities(t, model)
    there = [i for i, name in enumerate(READINGS) if np.isfinite(t.measured[:, i]).any()]
    out = {}
    for suite, without in SUITES.items():
        keep = [i for i in there if READINGS[i] not in without]
        if suite != "as measured" and len(keep) == len(there):
            continue  # nothing that this voyage has is left out
        judged = [gramian(w[:, keep]) for w in answer]
        middle = sorted(judged, key=lambda g: g["log10_condition"])[len(judged) // 2]
        ranks = [g["rank"] for g in judged]
        out[suite] = middle | {
            "of": len(UNKNOWNS),
            "windows": len(judged),
            "least_rank": min(ranks),
            "greatest_rank": max(ranks),
        }
    return out


def gramian(answer: np.ndarray) -> dict[str, Any]:
    """(K, 8, 11): (K, readings, unknowns) answers in sigmas for one prior width each -> the verdict on one
    window."""
    S = answer.reshape(-1, answer.shape[-1])
    _, size, directions = np.linalg.svd(S, full_matrices=True)
    size = np.append(size, np.zeros(len(directions) - size.size))
    least = max(size[-1] / size[0], 1e-12) if size[0] else 1e-12  # where nothing was read, nothing answers
    weakest = directions[-1] * np.sign(directions[-1][np.argmax(np.abs(directions[-1]))])
    order = np.argsort(-np.abs(weakest))
    after = np.sqrt(np.diag(np.linalg.inv(S.T @ S + np.eye(S.shape[1]))))
    return {
        "rank": int((size > UNSEEN * size[0]).sum()),
        "informative": int((size > 1.0).sum()),
        "log10_condition": float(-2.0 * np.log10(least)),
        "weakest": {UNKNOWNS[i]: float(round(weakest[i], 3)) for i in order if abs(weakest[i]) > 0.2},
        "still_unknown": {name: float(x) for name, x in zip(UNKNOWNS, after, strict=True)},
    }


def sensitivities(t: Track, model: Model) -> list[np.ndarray]:
    """For each window (K, 8, 11): what the readings answer, in sigmas, to a prior width of each; a step at
    which one was not measured answers nothing. DataError: no window has rudder and propeller throughout."""
    steps = max(int(LENGTHS * float(model.ship.scale("time")) / t.h), 8)
    starts = [k for k in range(0, len(t) - steps, steps) if t.whole[k : k + steps].all()]
    if not starts:
        raise DataError(
            f"{t.name}: no window of {steps * t.h:.0f} s has rudder and propeller throughout. Sail longer."
        )
    up, down = (
        _run(t, model, np.array(starts), steps, sign * NUDGE * prior_widths(model)) for sign in (1.0, -1.0)
    )
    answer = (up - down) / (2.0 * NUDGE) / t.sd[:, None]
    answer[np.isnan(t.measured[starts + np.arange(steps)[:, None]])] = 0.0
    return [answer[:, w] for w in range(len(starts))]


def prior_widths(model: Model) -> np.ndarray:
    """(11,) what is not known of UNKNOWNS before any measurement, in the ship's own scales: SI."""
    ship = model.ship
    L, U, time, force = (float(ship.scale(of)) for of in ("length", "speed", "time", "force"))
    return np.array(
        [0.1 * L, 0.1 * L, 0.1, 0.1 * U, 0.1 * U, 0.1 / time, 0.1 * U, 0.1 * U, force, 3.0 * force, force * L]
    )


def _run(t: Track, model: Model, starts: np.ndarray, steps: int, nudges: np.ndarray) -> np.ndarray:
    """(K, windows, 8, unknowns) readings of runs from every window's start, each with one unknown nudged."""
    first = np.repeat(starts, len(nudges))
    by = np.tile(np.diag(nudges), (len(starts), 1)).T  # (unknowns, runs)
    still = of_role("stream").absent(model.ship)
    now = next((e for e in model.effects if type(e) is type(still)), still).values()
    here = still.but(north=now["north"] + by[6], east=now["east"] + by[7])
    push = Force(*by[8:11])
    model = replace(model.but(here), residual=lambda s: push)
    state = tuple(t.state[first, i] + by[i] for i in range(len(STATE)))
    controls, out = steered(t, model), []
    for k in range(steps):
        rows = first + k
        inputs = {name: x[rows] for name, x in t.weather.items()} | {
            "delta": controls["delta"][rows],
            "orders": None if t.orders is None else {k: x[rows] for k, x in controls["orders"].items()},
            "n": t.n[rows],
            "t": t.t[rows],
        }
        s = Situation(**dict(zip(STATE, state, strict=True)), **inputs)
        rates = model.nu_dot(s)
        s.u_dot, s.v_dot, s.r_dot = rates
        out.append(readings(s, model).reshape(len(starts), len(nudges), -1).swapaxes(1, 2))
        state = model.step(state, Situation(**inputs), t.h)
    return np.stack(out)
