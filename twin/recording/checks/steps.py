"""Steps of the heading that no ship makes: two headings in turn, means taken across north, a jump that stays.

Asked of single samples: from one to the next the heading may turn by what the rate of turn says (or by what
the course does), and by its noise.
"""

from dataclasses import dataclass

import numpy as np

from twin.num import as_given, num
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good, wrong
from twin.recording.checks.relations import over_ground
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.resample import continuous

NAME = "heading_steps"
LEAST_DEG = 3.0  # smaller steps are a compass's own
SIGMAS = 8.0
LONGEST_PERIOD = 12  # samples: two headings that alternate come back within this
LEAST_STEPS = 6
ALIKE = 0.25  # spread of the steps between two headings, in the step
NEAR_NORTH_DEG, FAR_DEG = 30.0, 40.0
STAYS = 10  # samples
OWN = 0.5  # share of a step that its witness may make; a boat without way on has any course
JUMP_DEG = 8.0


@dataclass(frozen=True)
class StepSamples:
    """Single headings [deg, unwrapped by the steps expected], and the part of each step that nothing
    explains."""

    t: np.ndarray
    psi: np.ndarray
    odd: np.ndarray  # (N-1,) [deg], on [-180, 180)
    # (N-1,) [deg] by how much the heading stepped: beyond the rate of turn; beside a course, which may be the
    # one that stepped, at all
    own: np.ndarray
    noise: float  # [deg] of a step

    @property
    def big(self) -> np.ndarray:
        """(B,) where the heading makes steps that no compass noise makes."""
        big = np.abs(self.odd) > max(LEAST_DEG, SIGMAS * self.noise)
        return np.flatnonzero(big & (np.abs(self.odd - self.own) < OWN * np.abs(self.odd)))


def samples_of(view: VoyageView) -> StepSamples | None:
    """The headings as they were recorded, with what the rate of turn expects between them."""
    v = view.voyage
    psi = v["heading_true_north_deg"]
    at = np.flatnonzero(np.isfinite(psi))
    if at.size < 30:
        return None
    t, x = v.time_s[at], psi[at]
    steps = np.diff(t)
    usual = float(np.median(steps[steps > 0.0])) if (steps > 0.0).any() else 1.0
    expected = expected_steps(view, t)
    odd = np.mod(np.diff(x) - expected + 180.0, 360.0) - 180.0
    odd = np.where((steps > 3.0 * usual) | ~np.isfinite(odd), 0.0, odd)
    own = turned_off(np.diff(x)) if view.derived("yaw_rate_degps") else odd
    return StepSamples(t, x, odd, own, noise_of(odd))


def expected_steps(view: VoyageView, t: np.ndarray) -> np.ndarray:
    """(S - 1,) how far it turns from one sample to the next [deg]: by the rate of turn, else by the course
    over ground, else not. `t` (S,) [s]."""
    v = view.voyage
    if not view.derived("yaw_rate_degps") and v.has("yaw_rate_degps"):
        r = v["yaw_rate_degps"]
        there = np.isfinite(r)
        rate = np.interp(t, v.time_s[there], r[there])
        return (rate[1:] + rate[:-1]) / 2.0 * np.diff(t)
    way = over_ground(view)
    if way is None or not view.way_on or not np.isfinite(way).any():
        return np.zeros(t.size - 1)
    there = np.isfinite(way)
    cog = np.degrees(np.unwrap(np.angle(way[there])))
    slow = np.convolve(np.pad(cog, 2, mode="edge"), np.ones(5) / 5.0, "valid")
    return np.diff(np.interp(t, view.even.time_s[there], slow))


def noise_of(odd: np.ndarray) -> float:
    """Scatter of a step [deg], also when the heading alternates: over the spacing at which it comes back
    most nearly. `odd` (S - 1,) [deg]. The steps are (S - 1,)."""
    path = np.r_[0.0, np.cumsum(odd)]
    lags = range(1, min(LONGEST_PERIOD, path.size // 3) + 1)
    return min((1.4826 * float(np.median(np.abs(path[k:] - path[:-k]))) for k in lags), default=0.0)


def heading_steps(view: VoyageView) -> Check:
    """Whether the heading makes a step that no ship makes, and of which kind."""
    s = samples_of(view)
    if s is None:
        return cannot_tell(NAME, "there are too few headings.")
    if np.max(np.abs(s.psi)) <= 2.0 * np.pi + 0.01 and view.voyage.duration_s > 60.0 and np.ptp(s.psi) > 0.5:
        return cannot_tell(NAME, "the heading stays within 2 pi: radians? Then its steps say nothing.")
    return (
        across_north(view, s)
        or in_turn(view, s)
        or jump(view, s)
        or good(NAME, "the heading makes no step that a ship cannot.")
    )


def in_turn(view: VoyageView, s: StepSamples) -> Check | None:
    """Two headings that take turns: steps all of one size, to and fro."""
    big = s.big
    if big.size < LEAST_STEPS:
        return None
    size, sign = np.abs(s.odd[big]), np.sign(s.odd[big])
    step = float(np.median(size))
    alike = np.abs(size - step) < max(ALIKE * step, 3.0 * s.noise)
    if alike.mean() < 0.85 or np.mean(sign[1:] != sign[:-1]) < 0.85:
        return None
    upper = upper_rows(s, big)
    text = (
        f"two headings in turn, {step:.1f} deg apart, {100 * upper.mean():.0f} % of the samples on the "
        f"larger, from {as_given(s.t[big[0]])} s on"
    )
    return wrong(
        NAME,
        f"{text}{nearer_course(view, s, upper)}. Two instruments write one column: export one of them (a log "
        "of messages: --source).",
    )


def upper_rows(s: StepSamples, big: np.ndarray) -> np.ndarray:
    """(S,) mask: which samples stand on the larger of the two headings. `big` (B,): the steps between the
    two, by index."""
    state = np.zeros(s.t.size, bool)
    here = bool(s.odd[big[0]] < 0.0)
    begin = 0
    for i in big:
        state[begin : i + 1] = here
        here, begin = bool(s.odd[i] > 0.0), i + 1
    state[begin:] = here
    return state


def nearer_course(view: VoyageView, s: StepSamples, upper: np.ndarray) -> str:
    """What to say of how far each of the two is from the course over ground. `upper` (S,): mask of the
    larger."""
    off = off_course(view, s, upper)
    return f" (off the course over ground: {off[0]:+.1f} and {off[1]:+.1f} deg)" if off else ""


def off_course(view: VoyageView, s: StepSamples, upper: np.ndarray) -> list[float]:
    """How far the larger and the smaller heading are from the course over ground [deg]; empty where there
    is none. `upper` (S,): mask of the larger."""
    way = over_ground(view)
    if way is None or not view.way_on:
        return []
    there = np.isfinite(way)
    course = np.degrees(np.interp(s.t, view.even.time_s[there], np.unwrap(np.angle(way[there]))))
    return [
        float(np.degrees(np.angle(np.mean(np.exp(1j * np.radians(s.psi[rows] - course[rows]))))))
        for rows in (upper, ~upper)
    ]


def references(view: VoyageView, s: StepSamples) -> list[np.ndarray]:
    """The heading [deg] as the course over ground has it, and as the summed rate of turn has it beside a
    slow drift. Each (S,)."""
    out = []
    way = over_ground(view)
    if way is not None and view.way_on and np.isfinite(way).any():
        there = np.isfinite(way)
        out.append(np.interp(s.t, view.even.time_s[there], np.degrees(np.unwrap(np.angle(way[there])))))
    if not view.derived("yaw_rate_degps"):
        path = np.r_[0.0, np.cumsum(expected_steps(view, s.t))]
        for _ in range(3):  # a gyro's bias, found where the heading is right
            off = np.radians(turned_off(s.psi - path))
            middle = np.angle(np.median(np.cos(off)) + 1j * np.median(np.sin(off)))
            off = np.angle(np.exp(1j * (off - middle)))
            usual = np.abs(off) < np.radians(FAR_DEG)
            slope = np.polyfit(s.t[usual], off[usual], 1) if usual.sum() > 20 else np.zeros(2)
            path = path + np.degrees(np.polyval(slope, s.t) + middle)
        out.append(path)
    return out


def turned_off(angle_deg: np.ndarray) -> np.ndarray:
    """(S,) the same angle [deg], on -180 to below 180."""
    return np.mod(angle_deg + 180.0, 360.0) - 180.0


def north_rows(view: VoyageView, s: StepSamples) -> np.ndarray:
    """(K,) index: samples far off a reference, which stood near north."""
    for by in references(view, s):
        off = turned_off(s.psi - by)
        off = turned_off(off - np.median(off))
        far = np.abs(off) > FAR_DEG
        near = np.abs(turned_off(by)) < NEAR_NORTH_DEG
        begins = np.flatnonzero(np.diff(far.astype(int)) == 1)
        leaps = (
            np.abs(turned_off(np.diff(s.psi)))[begins] > FAR_DEG / 2.0
        )  # it goes there in one step, not as a reference that drifts away
        few = np.count_nonzero(far) < 2 or far.mean() > 0.5
        if (
            not few
            and begins.size
            and leaps.mean() > 0.7
            and np.mean(near[far]) >= 0.95
            and np.mean(far[near]) > 0.01
        ):
            return np.flatnonzero(far)
    return np.zeros(0, int)


def across_north(view: VoyageView, s: StepSamples) -> Check | None:
    """Means of 359 and 1 that are 180: only near north the heading is far off."""
    rows = north_rows(view, s)
    if not rows.size:
        return None
    return wrong(
        NAME,
        f"{rows.size} headings are far off the course, all of them while the ship heads within "
        f"{NEAR_NORTH_DEG:.0f} deg of north, the first {s.psi[rows[0]]:.0f} deg at {as_given(s.t[rows[0]])} "
        "s: means were taken across north, where 359 and 1 make 180. Export single samples, or means of "
        "sine and cosine; until then leave those cells empty.",
    )


def jump(view: VoyageView, s: StepSamples) -> Check | None:
    """One step or a few that stay, which neither the rate of turn nor the course made."""
    big = np.array([i for i in s.big if np.abs(s.odd[i]) > JUMP_DEG and at_once(s, i) and stays(s, i)], int)
    if not big.size or big.size > 5:
        return None
    i = int(big[np.argmax(np.abs(s.odd[big]))])
    rate = abs(s.odd[i]) / max(s.t[i + 1] - s.t[i], 1e-9)
    text = (
        f"the heading jumps by {s.odd[i]:+.1f} deg at {as_given(s.t[i + 1])} s ({num(rate, 3)} deg/s) and "
        "stays there"
    )
    independent = not view.derived("yaw_rate_degps") or (over_ground(view) is not None and view.way_on)
    who = "the rate of turn" if not view.derived("yaw_rate_degps") else "the course over ground"
    if not independent:
        return doubtful(NAME, f"{text}. Was another instrument taken, or its offset set?")
    return wrong(
        NAME,
        f"{text}, while {who} knows nothing of "
        f"it{f' ({big.size} such steps)' * (big.size > 1)}: another instrument, or an offset "
        "that was set. "
        f"Cut the voyage there, or correct one part by {abs(s.odd[i]):.1f} deg.",
    )


def at_once(s: StepSamples, i: int) -> bool:
    """Whether the heading steps at once: what turns faster and slower is a turn, however quick, and however
    long the wait for one of its samples."""
    near = slice(max(i - 1, 0), i + 2)
    waits = np.maximum(np.diff(s.t)[near], 1e-9)
    own, odd = np.abs(s.own[near]) / waits, abs(s.odd[i]) / max(s.t[i + 1] - s.t[i], 1e-9)
    return bool(np.sum(own > OWN * odd) == 1)


def stays(s: StepSamples, i: int) -> bool:
    """Whether the heading after a step stays where it went."""
    path = np.r_[0.0, np.cumsum(s.odd)]
    after, before = path[i + 1 : i + 1 + STAYS], path[max(i + 1 - STAYS, 0) : i + 1]
    if after.size < STAYS or before.size < STAYS:
        return False
    return bool(abs(np.median(after) - np.median(before) - s.odd[i]) < 0.3 * abs(s.odd[i]))


def without_steps(view: VoyageView) -> np.ndarray | None:
    """(R,) of R rows: the heading [deg] of the voyage's rows with two headings made one and means across
    north left out; None when neither is there."""
    s = samples_of(view)
    if s is None:
        return None
    psi = view.voyage["heading_true_north_deg"].copy()
    at = np.flatnonzero(np.isfinite(psi))
    rows = north_rows(view, s)
    if rows.size:
        psi[at[rows]] = np.nan
        return psi
    if in_turn(view, s) is not None:
        upper = upper_rows(s, s.big)
        off, step = off_course(view, s, upper), float(np.median(np.abs(s.odd[s.big])))
        if off and abs(off[0]) < abs(off[1]):
            psi[at[~upper]] += step
        else:
            psi[at[upper]] -= step
        return np.mod(continuous(psi, 360.0), 360.0)
    return None
