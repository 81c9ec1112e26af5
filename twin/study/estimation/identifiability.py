"""What a voyage can tell at all: which states can be seen in its measurements, and which forces look alike
along it.

Empirical observability Gramian [Krener & Ide 2009]: start, current and a constant unknown force are nudged by
a tenth of what is not known of them, the model is run on over windows of the voyage, and the readings' answer
is counted in their own scatter. A direction that answers with less than one is not told by the window; below
1e-4 of the strongest it cannot be seen at all, which is what a Lie-rank test would say. Principal angles
[Bjorck & Golub 1973] tell how far an effect's columns, or the features of a learned residual, stand out of
the span of the core's columns: 90 deg is apart, 0 deg is the same thing under another name.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.num import as_given
from twin.physics.effects import of_role, of_ship
from twin.physics.model import Model
from twin.physics.state import Force, Situation
from twin.recording.voyage import Voyage
from twin.study.estimation.columns import columns, core_unknowns, effect_unknowns
from twin.study.estimation.respond import readings, steered
from twin.study.track.track import READINGS, STATE, Track, track

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
ROWS = 1500  # of the voyage used for the angles
Features = Callable[[Situation], np.ndarray]  # (N, F) of a situation of arrays


def report(
    voyage: Voyage, model: Model, residual: Features | None = None, W: np.ndarray | None = None
) -> dict[str, Any]:
    """`observability` by set of sensors, `angles` by effect, `residual` where its features (and last layer)
    are given; see `text`.
    """
    t = track(voyage, model.ship)
    return {
        "voyage": voyage.name,
        "unknowns": list(UNKNOWNS),
        "observability": observability(t, model),
        "angles": angles(t, model),
        "residual": None if residual is None else residual_angles(t, model, residual, W),
    }


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
    """(K, readings, unknowns) answers in sigmas for one prior width each -> the verdict on one window."""
    S = answer.reshape(-1, answer.shape[-1])
    _, size, directions = np.linalg.svd(S, full_matrices=True)
    size = np.append(size, np.zeros(len(directions) - size.size))
    weakest = directions[-1] * np.sign(directions[-1][np.argmax(np.abs(directions[-1]))])
    order = np.argsort(-np.abs(weakest))
    after = np.sqrt(np.diag(np.linalg.inv(S.T @ S + np.eye(S.shape[1]))))
    return {
        "rank": int((size > UNSEEN * size[0]).sum()),
        "informative": int((size > 1.0).sum()),
        "log10_condition": float(2.0 * np.log10(size[0] / max(size[-1], 1e-12 * size[0]))),
        "weakest": {UNKNOWNS[i]: float(round(weakest[i], 3)) for i in order if abs(weakest[i]) > 0.2},
        "still_unknown": {name: float(x) for name, x in zip(UNKNOWNS, after, strict=True)},
    }


def sensitivities(t: Track, model: Model) -> list[np.ndarray]:
    """For each window (K, 8, 11): what the readings answer, in sigmas, to a prior width of each."""
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
    return [answer[:, w] for w in range(len(starts))]


def prior_widths(model: Model) -> np.ndarray:
    """(11,) what is not known of UNKNOWNS before any measurement, in the ship's own scales."""
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
            "told": None if t.told is None else {k: x[rows] for k, x in controls["told"].items()},
            "n": t.n[rows],
            "t": t.t[rows],
        }
        s = Situation(**dict(zip(STATE, state, strict=True)), **inputs)
        rates = model.nu_dot(s)
        s.u_dot, s.v_dot = rates.u, rates.v
        out.append(readings(s, model).reshape(len(starts), len(nudges), -1).swapaxes(1, 2))
        state = model.step(state, Situation(**inputs), t.h)
    return np.stack(out)


def angles(t: Track, model: Model) -> dict[str, dict[str, Any]]:
    """For each force and flow that the voyage can feed: its angles to the span of the core's columns, and
    what of it lies inside.
    """
    thin, known = _thinned(t), of_ship(model.ship)
    scale = _axis_scale(model)
    core = basis(_stacked(columns(thin, model, core_unknowns(model), known)[0], scale))
    spans, out = {}, {}
    for name, kind in known.items():
        if kind.kind not in ("Force", "Flow") or t.missing().intersection(kind.needs):
            continue
        span = _stacked(columns(thin, model, effect_unknowns(kind, model), known)[0], scale)
        if np.any(span):
            spans[name] = span
    for name, span in spans.items():
        own = basis(span)
        rivals = {other: float(principal(own, basis(s))[0]) for other, s in spans.items() if other != name}
        nearest = min(rivals, key=lambda other: rivals[other]) if rivals else None
        out[name] = _told(own, span, core) | {
            "nearest": nearest,
            "nearest_deg": rivals[nearest] if nearest else None,
        }
    return out


def residual_angles(
    t: Track, model: Model, features: Features, W: np.ndarray | None = None
) -> dict[str, dict[str, Any]]:
    """For each axis: the residual's features against the core's columns of that axis (the paper's F_theta
    against F_D); with its last layer W (3, F) also how much of the learned force the core could give itself.
    """
    thin, known = _thinned(t), of_ship(model.ship)
    A = columns(thin, model, core_unknowns(model), known)[0]
    s = thin.situation()
    model.nu_dot(s)
    phi = np.asarray(features(s), float)
    if phi.shape[0] != len(thin):
        raise DataError(
            f"the residual gave {phi.shape} features for {len(thin)} situations: one row each is needed."
        )
    out = {}
    for i, axis in enumerate(("surge", "sway", "yaw")):
        core = basis(A[:, i])
        out[axis] = _told(basis(phi), phi, core)
        if W is not None:
            out[axis]["force_inside_core"] = _inside(phi @ W[i], core)
    return out


def _told(own: np.ndarray, span: np.ndarray, core: np.ndarray) -> dict[str, Any]:
    found = principal(own, core)
    return {
        "smallest_deg": float(found[0]),
        "largest_deg": float(found[-1]),
        "share_inside_core": _inside(span, core),
        "dimensions": int(own.shape[1]),
    }


def _inside(span: np.ndarray, core: np.ndarray) -> float:
    """How much of the columns' squares lies in the span of the core's."""
    return float(np.sum((core.T @ span) ** 2) / max(np.sum(span**2), 1e-300))


def principal(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Principal angles [deg] between two spans, from orthonormal bases; small ones by their sine, which keeps
    its digits.
    """
    if a.shape[1] > b.shape[1]:
        a, b = b, a
    cosines = np.clip(np.linalg.svd(a.T @ b, compute_uv=False), 0.0, 1.0)
    sines = np.clip(np.linalg.svd(a - b @ (b.T @ a), compute_uv=False)[::-1], 0.0, 1.0)
    return np.degrees(np.where(cosines**2 > 0.5, np.arcsin(sines), np.arccos(cosines)))


def basis(span: np.ndarray) -> np.ndarray:
    """(rows, d) orthonormal; columns are put to the same size first, and directions below 1e-6 of the
    strongest dropped.
    """
    size = np.linalg.norm(span, axis=0)
    u, s, _ = np.linalg.svd(span[:, size > 0.0] / size[size > 0.0], full_matrices=False)
    return u[:, s > 1e-6 * s[0]]


def _stacked(A: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """(3 N, P): accelerations of the three axes one under the other, each in its usual size."""
    return (A / scale[None, :, None]).reshape(-1, A.shape[-1])


def _axis_scale(model: Model) -> np.ndarray:
    U, L = float(model.ship.scale("speed")), float(model.ship.scale("length"))
    return np.array([U * U / L, U * U / L, U * U / L**2])


def _thinned(t: Track) -> Track:
    """The track on at most ROWS of its rows with known controls (columns are pointwise, so the gaps do not
    matter).
    """
    rows = np.flatnonzero(t.whole)
    rows = rows[:: max(1, rows.size // ROWS)]
    return replace(
        t, t=t.t[rows], state=t.state[rows], delta=t.delta[rows], n=t.n[rows],
        weather={k: w[rows] for k, w in t.weather.items()}, measured=t.measured[rows], whole=t.whole[rows],
        told=None if t.told is None else {k: x[rows] for k, x in t.told.items()},
    )  # fmt: skip


def text(result: Mapping[str, Any]) -> list[str]:
    """The report as lines for a terminal."""
    lines = [f"What {result['voyage']} can tell (windows of {as_given(LENGTHS)} ship lengths)", ""]
    lines += [f"{'sensors':<36}{'rank':>10}{'informative':>13}{'log10 cond':>12}  weakest direction"]
    for suite, g in result["observability"].items():
        weakest = ", ".join(f"{name} {x:+.2f}" for name, x in list(g["weakest"].items())[:3])
        rank = f"{g['rank']}/{g['of']}"
        lines.append(f"{suite:<36}{rank:>10}{g['informative']:>13}{g['log10_condition']:>12.1f}  {weakest}")
    lines += ["", f"{'effect':<20}{'angle to core':>15}{'inside core':>13}  most alike"]
    for name, a in sorted(result["angles"].items(), key=lambda item: item[1]["smallest_deg"]):
        nearest = f"{a['nearest']} ({a['nearest_deg']:.1f} deg)" if a["nearest"] else "-"
        lines.append(
            f"{name:<20}{a['smallest_deg']:>11.1f} deg{100.0 * a['share_inside_core']:>11.0f} %  {nearest}"
        )
    for axis, a in (result["residual"] or {}).items():
        force = (
            (f", of its force {100.0 * a['force_inside_core']:.0f} % inside")
            if "force_inside_core" in a
            else ""
        )
        lines.append(
            f"residual, {axis:<10}{a['smallest_deg']:>11.1f} deg{100.0 * a['share_inside_core']:>11.0f} %  "
            f"{a['dimensions']} directions{force}"
        )
    return [*lines, "", *verdict(result)]


def verdict(result: Mapping[str, Any]) -> list[str]:
    """In sentences: what cannot be seen, what cannot be told from the core, and whether the paper's F_D and
    F_theta meet.
    """
    measured = result["observability"]["as measured"]
    lines = []
    if measured["rank"] < measured["of"]:
        names = ", ".join(measured["weakest"])
        lines.append(
            f"Not everything can be seen: {names} move together. Turn, or change speed, to tell them apart."
        )
    alike = [name for name, a in result["angles"].items() if a["smallest_deg"] < 5.0]
    if alike:
        lines.append(f"Within 5 deg of what the core can say by itself: {', '.join(alike)}.")
    if result["residual"]:
        least = min(a["smallest_deg"] for a in result["residual"].values())
        apart = "do not meet" if least > 5.0 else "meet; a regularizer does not make them disjoint"
        lines.append(
            f"Here learned features and the core's columns {apart} (smallest angle {least:.2f} deg)."
        )
    return lines or ["Every unknown of the Gramian can be seen, and no effect is hidden in the core."]
