"""The rows that are solved: every reading and every prior about the states as they are, with their slopes."""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.sparse import diags_array

from twin.study.instruments.arrow import Block
from twin.study.instruments.here import Theta, remembering
from twin.study.instruments.problem import OUTLIER, Problem, Rows
from twin.study.instruments.sense import (
    drift,
    has_way_ahead,
    heading,
    log,
    log_aside,
    place,
    rate,
    velocity,
    wind,
)
from twin.study.instruments.unknowns import INDEX, UNKNOWNS

AFFECT = {
    "place": ("gnss_delay", "antenna_ahead", "antenna_starboard", "antenna_above"),
    "velocity": ("gnss_delay", "smoothing", "antenna_ahead", "antenna_starboard"),
    "heading": ("heading_delay", "A", "B", "C", "D", "E"),
    "rate": ("rate_delay", "gyro_bias", "gyro_scale"),
    "log": ("log_delay", "log_scale", "log_bias", "log_angle", "current_north", "current_east"),
    "log aside": ("log_delay", "log_scale", "log_angle", "current_north", "current_east"),
    "wind": ("vane", "wind_scale"),
    "drift": ("current_north", "current_east", "drift_r", "drift_rr", "drift_r_r", "drift_late", "leeway"),
}
# without one of which (or a log of two axes) only how the ship drifts in a turn would tell it (the gyro's
# scale: from a deviation), and that is no instrument's business
WANTS = {
    "antenna_ahead": ("log aside",),
    "antenna_starboard": ("log aside",),
    "gnss_delay": ("own", "log"),
    "gyro_scale": ("own",),
}
DIFFERENCE_WIDTHS = 1e-5  # of a prior width, for slopes
SENSES: dict[str, Callable[[Problem, Theta, Rows | None], np.ndarray]] = {
    "place": place,
    "velocity": velocity,
    "heading": heading,
    "rate": rate,
    "log": log,
    "log aside": log_aside,
    "wind": wind,
}


def blocks(p: Problem, theta: Theta, free: np.ndarray) -> list[Block]:
    """All readings and priors about the states as they are, with their slopes by the numbers of theta (P,),
    each in its own unit, that are `free` (P,)."""
    out = []
    with remembering(p):
        for name, sense in SENSES.items():
            if name in p.by:
                out.append(_block(p, theta, free, name, sense, p.by[name].y.T.ravel()))
        drifts = _block(p, theta, free, "drift", drift, np.zeros(p.grid.size))
        out.append(_whitened(p, drifts, has_way_ahead(p, theta)))
    return out + _priors(p)


def misfit(p: Problem, theta: Theta) -> float:
    """Sum of squares of all readings and priors about the states as they are, each in its own scatter; a
    reading beyond OUTLIER of them counts as one that is so far off."""
    with remembering(p):
        left = {n: p.by[n].y.T.ravel() - sense(p, theta, None) for n, sense in SENSES.items() if n in p.by}
        ahead = has_way_ahead(p, theta)
        left["drift"] = np.where(ahead, _lasting_rest(p, ahead) @ drift(p, theta, None), 0.0)
    read = sum(float(np.minimum((r / p.sd[name]) ** 2, OUTLIER**2).sum()) for name, r in left.items())
    return read + sum(float(((J @ p.x) ** 2).sum()) / p.sd[name] ** 2 for name, J in p.priors.items())


def _lasting_rest(p: Problem, ahead: np.ndarray) -> Any:
    """What drift does beside its formula lasts: what takes of each row `memory` times the one before it, at
    the same scatter; behind a gap in `ahead` (n,) it begins anew."""
    goes_on, k = ahead[1:] & ahead[:-1], 1.0 / np.sqrt(1.0 - p.memory**2)
    main, before = np.r_[1.0, np.where(goes_on, k, 1.0)], np.where(goes_on, -k * p.memory, 0.0)
    return diags_array([main, before], offsets=[0, -1]).tocsr()


def _whitened(p: Problem, b: Block, ahead: np.ndarray) -> Block:
    """The drift's rows, each less what lasts of the one before it. Only where the ship has way `ahead` (n,)
    does its formula hold."""
    p.beside = np.where(ahead, b.r, 0.0)
    L = _lasting_rest(p, ahead)
    return Block(b.name, L @ b.r, (L @ b.J).tocsr(), L @ b.G, ahead.astype(float))


def _block(
    p: Problem,
    theta: Theta,
    free: np.ndarray,
    name: str,
    sense: Callable[[Problem, Theta, Rows | None], np.ndarray],
    y: np.ndarray,
) -> Block:
    rows = Rows()
    here = sense(p, theta, rows)
    r = y - here
    G = np.zeros((y.size, len(UNKNOWNS)))
    for unknown in (n for n in AFFECT[name] if free[INDEX[n]]):
        wanted = set(WANTS.get(unknown, ()))
        if wanted and "log aside" not in p.by and not wanted & {*p.by, *(["own"] if p.own else [])}:
            continue
        step = DIFFERENCE_WIDTHS * float(p.widths[INDEX[unknown]])
        G[:, INDEX[unknown]] = (sense(p, _with(theta, unknown, step), None) - here) / step
    scatter = max(p.sd[name], 1.4826 * float(np.median(np.abs(r))))
    return Block(name, r, rows.matrix(p.size), G, (np.abs(r) < OUTLIER * scatter).astype(float))


def _with(theta: Theta, name: str, step: float) -> Theta:
    out = theta.copy()
    out[INDEX[name]] += step
    return out


def _priors(p: Problem) -> list[Block]:
    """What the states are held to: each prior's rows are nothing."""
    return [
        Block(name, -(J @ p.x), J, np.zeros((J.shape[0], len(UNKNOWNS))), np.ones(J.shape[0]))
        for name, J in p.priors.items()
    ]
