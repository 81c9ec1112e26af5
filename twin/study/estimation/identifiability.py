"""What a voyage can tell at all: which states can be seen in its measurements, and which forces look alike
along it.

States, streams and constant forces: observability.py. Principal angles
[Bjorck & Golub 1973] tell how far an effect's columns, or the features of a learned residual, stand out of
the span of the core's columns: 90 deg is apart, 0 deg is the same thing under another name.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.num import as_given
from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.physics.state import Situation
from twin.recording.voyage import Voyage
from twin.study.estimation.columns import columns, core_unknowns
from twin.study.estimation.observability import LENGTHS, UNKNOWNS, observability
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.estimation.respond import keep_steered, steered
from twin.study.track.track import Track, track

ROWS = 1500  # of the voyage used for the angles
Features = Callable[[Situation], np.ndarray]  # (N, F) of a situation of arrays


def report(
    voyage: Voyage, model: Model, residual: Features | None = None, W: np.ndarray | None = None
) -> dict[str, Any]:
    """`observability` by set of sensors, `angles` by effect, `residual` where its features (and last
    layer) are given; see `text`. `W` (3, F): the residual's last layer, in units of the force scale."""
    t = track(voyage, model.ship)
    return {
        "voyage": voyage.name,
        "unknowns": list(UNKNOWNS),
        "observability": observability(t, model),
        "angles": angles(t, model),
        "residual": None if residual is None else residual_angles(t, model, residual, W),
    }


def angles(t: Track, model: Model) -> dict[str, dict[str, Any]]:
    """For each force and flow that the voyage can feed: its angles to the span of the core's columns, and
    what of it lies inside.
    """
    thin, known = _thinned(t, model), of_ship(model.ship)
    scale = _axis_scale(model)
    core = basis(_stacked(columns(thin, model, core_unknowns(model), known)[0], scale))
    spans, out = {}, {}
    for name, kind in known.items():
        if kind.kind not in ("Force", "Flow") or t.missing().intersection(kind.needs):
            continue
        if kind.lacking(model.ship):
            continue
        span = _stacked(columns(thin, model, effect_unknowns(kind, model), known)[0], scale)
        if np.any(span):
            spans[name] = span
    for name, span in spans.items():
        own = basis(span)
        rivals = {other: float(principal(own, basis(s))[0]) for other, s in spans.items() if other != name}
        nearest = min(rivals, key=lambda other: rivals[other]) if rivals else None
        out[name] = _information(own, span, core) | {
            "nearest": nearest,
            "nearest_deg": rivals[nearest] if nearest else None,
        }
    return out


def residual_angles(
    t: Track, model: Model, features: Features, W: np.ndarray | None = None
) -> dict[str, dict[str, Any]]:
    """For each axis: the residual's features against the core's columns of that axis [deg] (the paper's
    F_theta against F_D); with its last layer W (3, F) also how much of the learned force the core could
    give itself; of features that are nothing all along, which is a residual that is not believed, no axis.
    DataError: there are not as many features as samples."""
    thin, known = _thinned(t, model), of_ship(model.ship)
    A = columns(thin, model, core_unknowns(model), known)[0]
    s = thin.situation(**steered(thin, model))
    model.nu_dot(s)
    phi = np.asarray(features(s), float)
    if phi.shape[0] != len(thin):
        raise DataError(
            f"the residual gave {phi.shape} features for {len(thin)} situations: one row each is needed."
        )
    if not np.any(phi):
        return {}
    out = {}
    for i, axis in enumerate(("surge", "sway", "yaw")):
        core = basis(A[:, i])
        out[axis] = _information(basis(phi), phi, core)
        if W is not None:
            out[axis]["force_inside_core"] = _inside(phi @ W[i], core)
    return out


def _information(own: np.ndarray, span: np.ndarray, core: np.ndarray) -> dict[str, Any]:
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
    """Principal angles [deg] between two spans, from orthonormal bases; small ones by their sine, which
    keeps its digits. The bases (N, A) and (N, B) give as many angles as the smaller has columns, (K,)."""
    if a.shape[1] > b.shape[1]:
        a, b = b, a
    cosines = np.clip(np.linalg.svd(a.T @ b, compute_uv=False), 0.0, 1.0)
    sines = np.clip(np.linalg.svd(a - b @ (b.T @ a), compute_uv=False)[::-1], 0.0, 1.0)
    return np.degrees(np.where(cosines**2 > 0.5, np.arcsin(sines), np.arccos(cosines)))


def basis(span: np.ndarray) -> np.ndarray:
    """(rows, d) orthonormal; columns are put to the same size first, and directions below 1e-6 of the
    strongest dropped. Of a span (N, C), (N, D) with D at most C, dimensionless."""
    size = np.linalg.norm(span, axis=0)
    u, s, _ = np.linalg.svd(span[:, size > 0.0] / size[size > 0.0], full_matrices=False)
    return u[:, s > 1e-6 * s[0]]


def _stacked(A: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """(3 N, P): accelerations of the three axes one under the other, each in its usual size."""
    return (A / scale[None, :, None]).reshape(-1, A.shape[-1])


def _axis_scale(model: Model) -> np.ndarray:
    U, L = float(model.ship.scale("speed")), float(model.ship.scale("length"))
    return np.array([U * U / L, U * U / L, U * U / L**2])


def _thinned(t: Track, model: Model) -> Track:
    """The track on at most ROWS of its rows with known controls (columns are pointwise, so the gaps do not
    matter), and the model's gears stepped through all of these.
    """
    whole = t.where(t.whole)
    rows = np.arange(0, len(whole), max(1, -(-len(whole) // ROWS)))
    thin = whole.where(rows)
    keep_steered(thin, model, whole, rows)
    return thin


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
    if result["residual"] == {}:
        lines.append(
            f"The residual is not believed anywhere on {result['voyage']}: this voyage says nothing of it."
        )
    elif result["residual"]:
        least = min(a["smallest_deg"] for a in result["residual"].values())
        apart = "do not meet" if least > 5.0 else "meet; a regularizer does not make them disjoint"
        lines.append(
            f"Here learned features and the core's columns {apart} (smallest angle {least:.2f} deg)."
        )
    return lines or ["Every unknown of the Gramian can be seen, and no effect is hidden in the core."]
