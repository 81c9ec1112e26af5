"""A heading that is off by one angle: how far, against the course over ground, beside a stream and leeway."""

from dataclasses import dataclass

import numpy as np

from twin.recording.checks.relations import over_ground
from twin.recording.checks.voyage_view import VoyageView

LEAST_OFFSET_DEG, LEAST_SPREAD_DEG, ALIKE_S = 4.0, 60.0, 30.0
STREAM_MPS, LEEWAY, SIGMAS = 0.5, 0.015, 3.0  # an expected stream; leeway in parts of the speed
DRIFTING, FEWEST_LEGS = 0.05, 4  # leeway where it never sails straight


@dataclass(frozen=True)
class Offset:
    """What the heading lacks against the course over ground [deg], its standard error, spread of the headings
    [deg]."""

    lacks: float
    error: float
    spread: float

    @property
    def shows(self) -> bool:
        """Whether it is large enough, and known well enough, to be told."""
        return abs(self.lacks) > max(LEAST_OFFSET_DEG, SIGMAS * self.error)

    @property
    def text(self) -> str:
        """The finding in words, with its angle, its uncertainty and what else could cause it."""
        several = self.spread > LEAST_SPREAD_DEG
        why = (
            f"on headings {self.spread:.0f} deg apart, so it is no stream"
            if several
            else "on one heading only: a strong stream across would do it too"
        )
        off = f"{-self.lacks:+.1f} deg off the course over ground (95 %: +- {2 * self.error:.1f})"
        cause = "magnetic, mounted askew, or pushed aside by wind or thrusters?"
        return f"the heading is {off} where it sails straight, {why}: {cause}"


def by_course(view: VoyageView) -> Offset | None:
    """The constant part, on straight stretches, where a ship goes where it points but for a stream and its
    leeway.

    aside = tan(lacks) ahead + stream across, means over half a minute; a stream is expected within
        STREAM_MPS.
    """
    way = over_ground(view)
    if way is None or not view.way_on:
        return None
    w, psi = way * np.exp(-1j * view.psi), view.psi
    span = max(round(ALIKE_S / view.step_s), 1)
    starts = np.arange(0, psi.size - span, span)
    turned = np.abs(psi[starts + span] - psi[starts])
    if not np.isfinite(turned).any():
        return None
    straight = turned < max(np.radians(3.0), 0.2 * float(np.nanquantile(turned, 0.95)))
    r, enough = view.si("yaw_rate_degps"), np.count_nonzero(straight) >= FEWEST_LEGS
    rows = [
        mean_of(w[a : a + span], psi[a : a + span], r[a : a + span])
        for a in (starts[straight] if enough else starts)
    ]
    legs = np.array([row for row in rows if row[0] > 0.4 * view.speed])
    if legs.shape[0] < FEWEST_LEGS:
        return None
    shape = np.stack(
        [legs[:, 0], -np.sin(legs[:, 2]), np.cos(legs[:, 2]), *(() if enough else (legs[:, 3],))], axis=1
    )
    x, error = with_expected_stream(shape, legs[:, 1], view.speed, LEEWAY if enough else DRIFTING)
    return Offset(
        float(np.degrees(np.arctan(x))),
        float(np.degrees(error)),
        float(np.degrees(np.ptp(np.unwrap(np.sort(legs[:, 2]))))),
    )


def mean_of(w: np.ndarray, psi: np.ndarray, r: np.ndarray) -> tuple[float, float, float, float]:
    """(ahead, aside, heading, rate of turn) of a stretch, zeros where most of it is missing. Of stretches
    of n rows: w (n,) = ahead + i aside [m/s], psi (n,) [rad], r (n,) [rad/s]."""
    there = np.isfinite(w) & np.isfinite(psi)
    if there.sum() < 0.5 * w.size:
        return 0.0, 0.0, 0.0, 0.0
    z, turning = np.mean(w[there]), r[np.isfinite(r)]
    return (
        float(z.real),
        float(z.imag),
        float(np.angle(np.mean(np.exp(1j * psi[there])))),
        float(turning.mean()) if turning.size else 0.0,
    )


def with_expected_stream(
    shape: np.ndarray, aside: np.ndarray, speed: float, leeway: float
) -> tuple[float, float]:
    """(first coefficient, its standard error); the next two are a stream, expected within STREAM_MPS of
    zero, and what is left is leeway. `shape` (L, 3) or (L, 4): a row a stretch, [m/s] ahead, of a stream
    north and of one east; `aside` (L,) [m/s]."""
    expected = np.zeros((shape.shape[1],) * 2)
    expected[1, 1] = expected[2, 2] = STREAM_MPS**-2.0
    scatter = 0.02 * speed
    for _ in range(5):
        power = shape.T @ shape / scatter**2 + expected
        x = np.linalg.lstsq(power, shape.T @ aside / scatter**2, rcond=None)[0]
        scatter = max(
            float(np.sqrt(np.sum((aside - shape @ x) ** 2) / max(aside.size - 2, 1))), leeway * speed
        )
    return float(x[0]), float(np.sqrt(np.linalg.pinv(power)[0, 0]))
