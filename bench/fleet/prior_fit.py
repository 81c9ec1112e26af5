"""How wide the prior of each term that a core leaves out should be, learned from the fleet's calibrated
ships: `python -m bench.fleet prior FOLDER`.

    p(x | ship) ~ L(x) N(x; 0, S_0),   L(x) ~ exp(-x'A x/2 + b'x),   A = P^-1 - S_0^-1,  b = P^-1 m
    S = diag(w^2):  w_k^2 <- mean over ships of (m_k^2 + P_kk under S)      (Dempster, Laird & Rubin 1977)

m, P: what calibration left in the ship's file of the terms of twin/study/estimation/form.py. Each family is
left out in turn, and its ships then say how much more probable the learned widths make their reference
voyages than the widths that stand."""

import argparse
import pickle
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench.fleet.fleet_page import lines
from twin.study.estimation.form import TERMS

OF_FORM = "form."
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
    ships = [of_ship(path) for folder in args.folder for path in sorted((folder / "ships").glob("*.pickle"))]
    print("\n".join(page(ships)))
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


def learned(ships: Sequence[Likelihood]) -> np.ndarray:
    """(K,) the most probable widths."""
    width = WIDTHS.copy()
    for _ in range(ROUNDS):
        moments = [(m**2 + np.diag(P)) for m, P in (s.under(width) for s in ships)]
        width = np.sqrt(np.mean(moments, axis=0))
    return width


def page(ships: Sequence[Likelihood]) -> list[str]:
    families = sorted({s.family for s in ships})
    gains = []
    for family in families:
        own, others = [s for s in ships if s.family == family], [s for s in ships if s.family != family]
        width = learned(others)
        gain = [s.evidence(width) - s.evidence(WIDTHS) for s in own]
        gains.append((family, len(own), f"{np.mean(gain):.1f}", f"{min(gain):.1f} to {max(gain):.1f}"))
    width = learned(ships)
    widths = [
        (name, f"{w:.3g}", f"{found:.3g}") for (name, w), found in zip(TERMS.items(), width, strict=True)
    ]
    return [
        *lines("Widths", "", ("term", "stands", "learned"), widths),
        *lines("Left out", "", ("family", "ships", "log probability gained, mean", "from, to"), gains),
    ]
