"""A heading that is off by one angle: how far, against the course over ground, beside a stream and leeway."""

from dataclasses import dataclass

import numpy as np

from twin.num import num
from twin.recording.checks.relations import over_ground
from twin.recording.checks.voyage_view import VoyageView, fit

LEAST_OFFSET_DEG, ALIKE_S = 4.0, 30.0
STREAM_MPS, LEEWAY, SIGMAS = 0.5, 0.015, 3.0  # an expected stream; leeway in parts of the speed
DRIFTING, FEWEST_LEGS = 0.05, 4  # leeway where it never sails straight
PUSHED_ALIKE = np.radians(20.0)  # on headings so near each other wind and stream push to the same side
FASTEST_STREAM_MPS = 10.0  # of all straits


@dataclass(frozen=True)
class Offset:
    """What the heading lacks against the course over ground [deg], its standard error, spread of the headings
    [deg], the weakest stream that would look so [m/s], and whether it was seen on straight stretches."""

    lacks: float
    error: float
    spread: float
    stream_mps: float
    straight: bool

    @property
    def shows(self) -> bool:
        """Whether it is large enough, and known well enough, to be told."""
        return abs(self.lacks) > max(LEAST_OFFSET_DEG, SIGMAS * self.error)

    @property
    def text(self) -> str:
        """The finding in words, with its angle, its uncertainty and what else could cause it."""
        off = f"{-self.lacks:+.1f} deg off the course over ground (95 %: +- {2 * self.error:.1f})"
        where = "where it sails straight" if self.straight else "over its turns"
        within = f"on headings within {self.spread:.0f} deg"
        why = (
            f"where a stream of {num(self.stream_mps)} m/s would look the same"
            if self.stream_mps < FASTEST_STREAM_MPS
            else "so it is no stream"
        )
        cause = "magnetic, mounted askew, or pushed aside by wind or thrusters?"
        return f"the heading is {off} {where}, {within}, {why}: {cause}"


def by_course(view: VoyageView) -> Offset | None:
    """The constant part, on straight stretches, where a ship goes where it points but for a stream and its
    leeway; where it hardly sails straight, on all, each with the drift of its turning.

    aside = tan(lacks) ahead + stream across (+ arm rate of turn), means over half a minute; a stream is
        expected within STREAM_MPS.
    """
    way = over_ground(view)
    if way is None or not view.way_on:
        return None
    every, turned = stretches(view, way)
    settled = straight(every, turned, view.speed)
    under_way = (every[:, 0] > 0.4 * view.speed) & np.isfinite(every[:, 3])
    enough = np.count_nonzero(settled & under_way) >= FEWEST_LEGS
    legs = every[settled & under_way if enough else under_way]
    if legs.shape[0] < FEWEST_LEGS:
        return None
    shape = columns(legs)[:, : 3 if enough else 4]
    x, error = with_expected_stream(
        shape, legs[:, 1], shares(legs[:, 2]), view.speed, LEEWAY if enough else DRIFTING
    )
    spread = spread_of(legs[:, 2])
    across = np.cos(spread / 2.0) if spread < np.pi else 0.0  # of the stream that is abeam of them all
    aside = abs(x) * float(np.mean(legs[:, 0]))
    return Offset(
        float(np.degrees(np.arctan(x))),
        float(np.degrees(error)),
        float(np.degrees(spread)),
        float(aside / across) if across > aside / FASTEST_STREAM_MPS else np.inf,
        bool(enough),
    )


def stretches(view: VoyageView, way: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(K, 4) of each half minute the mean way ahead and aside [m/s], the heading [rad] and the rate of turn
    [rad/s], and (K, 2) by how much it turns in each of its halves [rad]. `way` (N,) over ground."""
    half = max(round(ALIKE_S / 2.0 / view.step_s), 1)
    turned = np.diff(view.psi[::half])
    turned = turned[: turned.size // 2 * 2].reshape(-1, 2)
    w, span = way * np.exp(-1j * view.psi), 2 * half
    rows = [mean_of(w[a : a + span], view.psi[a : a + span]) for a in range(0, span * turned.shape[0], span)]
    rate = turned.sum(axis=1) / (span * view.step_s)
    return np.c_[np.array(rows).reshape(-1, 3), rate], turned


def straight(every: np.ndarray, turned: np.ndarray, speed: float) -> np.ndarray:
    """(K,) where the ship hardly turns, nor did in the half minute before, so that its drift in a turn has
    died away: less than a fifth of the voyage's turning, and less than what would push it aside by its
    leeway. How far turning pushes this ship aside is seen in its own turns. `every` (K, 4) and `turned`
    (K, 2) as `stretches` gives them, `speed` [m/s]."""
    if not np.isfinite(turned).any():
        return np.zeros(turned.shape[0], bool)
    arm = np.nan_to_num(abs(fit(list(columns(every).T), every[:, 1])[0][3]))
    rate = np.abs(turned) / (ALIKE_S / 2.0)
    usual = max(np.radians(3.0) / ALIKE_S, 0.2 * float(np.nanquantile(rate, 0.95)))
    quiet = ((rate < usual) & (arm * rate < LEEWAY * speed)).all(axis=1)
    return quiet & np.r_[False, quiet[:-1]]


def columns(rows: np.ndarray) -> np.ndarray:
    """(K, 4) the way aside [m/s] by an offset with the tangent 1, by a stream of 1 m/s north, by one east,
    and by an arm of 1 m. `rows` (K, 4) as `stretches` gives them."""
    return np.stack([rows[:, 0], -np.sin(rows[:, 2]), np.cos(rows[:, 2]), rows[:, 3]], axis=1)


def shares(heading: np.ndarray) -> np.ndarray:
    """(L,) how much each stretch counts: those on one heading have one leeway, and count as one together.
    `heading` (L,) [rad]."""
    alike = np.cos(heading[:, None] - heading) > np.cos(PUSHED_ALIKE)
    return 1.0 / alike.sum(axis=1)


def spread_of(heading: np.ndarray) -> float:
    """The least arc that holds all headings [rad]; `heading` (L,) [rad]. Within half a circle one stream can
    come from one side on all of them."""
    around = np.sort(np.mod(heading, 2.0 * np.pi))
    return float(2.0 * np.pi - np.max(np.diff(np.r_[around, around[0] + 2.0 * np.pi])))


def mean_of(w: np.ndarray, psi: np.ndarray) -> tuple[float, float, float]:
    """(ahead, aside, heading) of a stretch, zeros where most of it is missing. Of stretches of n rows:
    w (n,) = ahead + i aside [m/s], psi (n,) [rad]."""
    there = np.isfinite(w) & np.isfinite(psi)
    if there.sum() < 0.5 * w.size:
        return 0.0, 0.0, 0.0
    z = np.mean(w[there])
    return float(z.real), float(z.imag), float(np.angle(np.mean(np.exp(1j * psi[there]))))


def with_expected_stream(
    shape: np.ndarray, aside: np.ndarray, share: np.ndarray, speed: float, leeway: float
) -> tuple[float, float]:
    """(first coefficient, its standard error); the next two are a stream, expected within STREAM_MPS of
    zero, and what is left is leeway. `shape` (L, 3) or (L, 4): a row a stretch, [m/s] ahead, of a stream
    north and of one east; `aside` (L,) [m/s]; `share` (L,) how much each row counts."""
    expected = np.zeros((shape.shape[1],) * 2)
    expected[1, 1] = expected[2, 2] = STREAM_MPS**-2.0
    scatter, weighted = 0.02 * speed, shape.T * share
    for _ in range(5):
        power = weighted @ shape / scatter**2 + expected
        x = np.linalg.lstsq(power, weighted @ aside / scatter**2, rcond=None)[0]
        left = np.sum(share * (aside - shape @ x) ** 2) / max(share.sum() - 2, 1)
        scatter = max(float(np.sqrt(left)), leeway * speed)
    return float(x[0]), float(np.sqrt(np.linalg.pinv(power)[0, 0]))
