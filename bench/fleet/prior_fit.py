"""How wide the prior of each term that a core leaves out should be, learned from the fleet's calibrated
ships: `python -m bench.fleet prior FOLDER`.

    p(x | ship) ~ L(x) N(x; 0, S_0),   L(x) ~ exp(-x'A x/2 + b'x),   A = P^-1 - S_0^-1,  b = P^-1 m
    S = diag(w^2):  w_k^2 <- (sum over n ships of (m_k^2 + P_kk under S) + c w_0k^2) / (n + c)

m, P: what calibration left in the ship's file of the terms of twin/study/estimation/form.py; S_0, w_0: the
widths that stand, which count as c ships. Each family is left out in turn, and its ships then say how much
more probable the learned widths make their reference voyages than the widths that stand.

Source: Dempster, Laird & Rubin (1977) Maximum likelihood from incomplete data via the EM algorithm."""

import argparse
import pickle
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench.fleet.fleet_page import lines
from bench.fleet.kept_ships import of_families
from twin.study.estimation.form import TERMS

OF_FORM = "form."
STANDING = (0.0, 0.1, 0.3, 1.0, 2.0, 4.0)  # ships that the widths that stand may count as
SHOWN_STANDING = (0.0, 0.3, 1.0)
ROUNDS = 200  # of the iteration; it has settled to three digits after a hundred
SEEN_SHARE = 1e-2  # information, of the prior's, from which a direction counts as seen
WIDTHS = np.array(list(TERMS.values()))


@dataclass(frozen=True)
class Likelihood:
    """What one ship's reference voyages say of the terms: exp(-x'A x/2 + b'x)."""

    family: str
    A: np.ndarray  # (K, K)
    b: np.ndarray  # (K,)

    def under(self, width: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean (K,) and covariance (K, K) of the terms under a prior of these widths (K,)."""
        P = np.linalg.inv(self.A + np.diag(width**-2))
        return P @ self.b, P

    def evidence(self, width: np.ndarray) -> float:
        """Log probability of the voyages under it, but for a constant of the ship."""
        m, P = self.under(width)
        return float(0.5 * (np.linalg.slogdet(P)[1] - 2.0 * np.log(width).sum() + self.b @ m))


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, nargs="+", help="of `run`")


def run(args: argparse.Namespace) -> int:
    print("\n".join(page([of_ship(path) for path in of_families(args.folder)])))
    return 0


def of_ship(path: Path) -> Likelihood:
    ship, _ = pickle.loads(path.read_bytes())
    kept: Mapping[str, Sequence[float]] = ship.notes["structural"]
    place = {label: i for i, label in enumerate(kept["labels"])}
    at = [place[OF_FORM + name] for name in TERMS]
    P = np.array(kept["covariance"])[np.ix_(at, at)] / np.outer(WIDTHS, WIDTHS)
    told, V = np.linalg.eigh(np.linalg.inv(P) - np.eye(len(at)))  # of widths that stand
    told, V = told[told > SEEN_SHARE], V[:, told > SEEN_SHARE]
    mean = np.array(kept["offset"])[at] / WIDTHS
    A, b = (V * told) @ V.T, V @ ((told + 1.0) * (V.T @ mean))
    return Likelihood(path.stem.rpartition("-")[0], A / np.outer(WIDTHS, WIDTHS), b / WIDTHS)


def learned(ships: Sequence[Likelihood], standing: float) -> np.ndarray:
    """(K,) the most probable widths, where those that stand count as so many ships."""
    width = WIDTHS.copy()
    for _ in range(ROUNDS):
        moments = [(m**2 + np.diag(P)) for m, P in (s.under(width) for s in ships)]
        width = np.sqrt((np.sum(moments, axis=0) + standing * WIDTHS**2) / (len(ships) + standing))
    return width


def gains(ships: Sequence[Likelihood], standing: float) -> list[tuple[str, float]]:
    """(family, log probability gained) of each ship, its family left out of what is learned."""
    out = []
    for family in sorted({s.family for s in ships}):
        width = learned([s for s in ships if s.family != family], standing)
        out += [(family, s.evidence(width) - s.evidence(WIDTHS)) for s in ships if s.family == family]
    return out


def page(ships: Sequence[Likelihood]) -> list[str]:
    each = {c: gains(ships, c) for c in STANDING}
    families = sorted({s.family for s in ships})
    body = [
        (f"{c:g}", *(f"{np.mean([g for of, g in found if of == f]):.1f}" for f in families), *_all(found))
        for c, found in each.items()
    ]
    width = [learned(ships, c) for c in SHOWN_STANDING]
    widths = [
        (name, f"{w:.3g}", *(f"{of[k]:.2g}" for of in width)) for k, (name, w) in enumerate(TERMS.items())
    ]
    heads = [f"learned, {c:g}" for c in SHOWN_STANDING]
    return [
        *lines("Families left out", "", ("standing widths count as", *families, "all ships", "least"), body),
        *lines("Widths", "", ("term", "stands", *heads), widths),
    ]


def _all(found: Sequence[tuple[str, float]]) -> tuple[str, str]:
    return f"{np.mean([g for _, g in found]):.1f}", f"{min(g for _, g in found):.1f}"
