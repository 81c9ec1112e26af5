"""What the compass does by degrees: late, off by an angle, off by a deviation curve, or beside a rate of
another scale.

    psi(t2) - psi(t1) - integral of r = [dev(psi)]_1^2  or  -late [r]_1^2  or  k integral of r        (+ bias)

Each is fitted alone; the one that leaves least is named when the second leaves clearly more. The constant
part shows against the course over ground, where the ship sails on several headings (a stream would change
with them). These are told and imported: `twin diagnose` and `twin instruments` can take them up."""

from dataclasses import dataclass

import numpy as np

from twin.recording.cells import without_deviation
from twin.recording.checks.candidate_mistake import Single
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good
from twin.recording.checks.offset import by_course
from twin.recording.checks.undo import HEADING, undone
from twin.recording.checks.voyage_view import VoyageView, fit, rms

NAME = "compass"
LATE_S = np.arange(-10.0, 10.01, 0.25)
TURNED = np.radians(10.0)  # usual turning within a window
LEAST_DEG = 0.4  # of what is wrong with the heading, rms: less is a compass
EXPLAINS = 0.5  # share of what differs
MARGIN = 5.0  # log likelihood of the second, fewer
MOST_DEVIATION, MOST_SCALE = 0.7, 0.05  # [rad]; of a rate of turn


@dataclass(frozen=True)
class CompassCause:
    """One way in which the heading may differ from the summed rate: words, size [deg rms], what is left,
    parameters."""

    text: str
    fix: str
    size_deg: float
    left: float
    value: tuple[float, ...]


@dataclass(frozen=True)
class CompassWindows:
    """Changes over windows: heading, summed rate [rad], and how many are independent."""

    view: VoyageView
    first: np.ndarray
    last: np.ndarray

    @property
    def independent(self) -> int:
        """How many windows there are that do not overlap."""
        return max(self.first.size // 2, 1)

    def change(self, x: np.ndarray) -> np.ndarray:
        """(W,) by how much x (N,) changes over each window, in the unit of x."""
        return x[self.last] - x[self.first]

    def summed(self, x: np.ndarray) -> np.ndarray:
        """(W,) integral of a rate (N,) over each window, in the unit of x times s."""
        return self.view.summed(x, self.first, self.last)


def windows(view: VoyageView) -> CompassWindows | None:
    """As long as the ship takes to turn ten degrees; None where it hardly turns."""
    r = rms(view.si("yaw_rate_degps"))
    if not r > 1e-5:
        return None
    seconds = float(np.clip(TURNED / r, max(4.0 * view.step_s, 2.0), max(60.0, 8.0 * view.step_s)))
    w = CompassWindows(view, *view.windows(seconds))
    return w if w.first.size >= 12 else None


def compass(view: VoyageView) -> Check:
    """Whether the heading is late, off by an angle or off by a deviation, by rate of turn and course."""
    told = by_rate(view)
    offset = by_course(told[1] if told else view)
    if told is None and offset is None:
        return cannot_tell(
            NAME,
            "there is no rate of turn beside the heading, or too little turning, and no straight stretch "
            "with a course over ground.",
        )
    cause = told[0] if told else None
    if cause is None and (offset is None or not offset.shows):
        return good(NAME, "the heading is neither late nor off, as far as rate of turn and course can tell.")
    if cause is None:
        assert offset is not None
        return doubtful(
            NAME, f"{offset.text} In the map: offset = {offset.lacks:.1f} for heading_true_north_deg."
        )
    text, fix = cause.text, cause.fix
    if "deviation" in cause.text:
        a = -offset.lacks if offset else 0.0
        text = (
            f"the compass has a deviation: A = {a:.1f}, "
            + ", ".join(f"{n} = {x:.1f}" for n, x in zip("BCDE", cause.value, strict=False))
            + " deg"
        )
        fix = f"deviation = [{a:.1f}, {', '.join(f'{x:.1f}' for x in cause.value)}]"
    return doubtful(
        NAME,
        f"{text} (rate of turn and heading differ by {cause.size_deg:.1f} deg rms, "
        f"{100 * (1 - cause.left):.0f} % of it so explained). "
        f"In the map: {fix} for heading_true_north_deg.",
    )


def by_rate(view: VoyageView) -> tuple[CompassCause | None, VoyageView] | None:
    """(what is wrong with the heading beside the rate of turn, the view without it); None where it cannot be
    told."""
    if view.derived("yaw_rate_degps"):
        return None
    w = windows(view)
    if w is None:
        return None
    r, psi = view.si("yaw_rate_degps"), view.psi
    odd = w.change(psi) - w.summed(r)
    ones = np.ones(odd.size)
    base = fit([ones], odd)[2] * float(np.nansum(odd**2))
    good_rows = np.count_nonzero(np.isfinite(odd))
    if good_rows < 12 or base <= 0.0:
        return None
    causes = [
        c
        for c in (late(w, r, psi, base), deviation(w, r, psi, base), scale(w, r, psi, base))
        if c is not None
    ]
    causes.sort(key=lambda c: c.left)
    if not causes:
        return None, view
    best = causes[0]
    second = causes[1].left if len(causes) > 1 else 1.0
    sure = 0.5 * w.independent * np.log(max(second, 1e-9) / max(best.left, 1e-9))
    if best.size_deg < LEAST_DEG or 1.0 - best.left < EXPLAINS or sure < MARGIN or not best.text:
        return None, view
    return best, without(view, best)


def late(w: CompassWindows, r: np.ndarray, psi: np.ndarray, base: float) -> CompassCause | None:
    """The heading a constant time behind the rate (or ahead of it). `r` (N,) [rad/s] and `psi` (N,) [rad]
    on the view's even grid; `base`: sum of squares of what is to be explained [rad2]."""
    t, swung = w.view.even.time_s, w.change(psi)
    whole = np.r_[0.0, np.cumsum(np.nan_to_num((r[1:] + r[:-1]) / 2.0) * np.diff(t))]
    holes = np.isfinite(w.summed(r)) & np.isfinite(swung)
    tried = []
    for by in LATE_S:
        inside = holes & (t[w.first] - by >= t[0]) & (t[w.last] - by <= t[-1])
        if np.count_nonzero(inside) >= 12:
            odd = (swung - w.change(np.interp(t - by, t, whole)))[inside]
            tried.append((left_over(odd, [], base * inside.mean()), float(by)))
    if not tried:
        return None
    left, by = best_between(tried)
    if abs(by) >= LATE_S[-1] - 0.3:
        return None
    words = f"the heading is {by:.1f} s late" if by > 0 else f"the heading is {-by:.1f} s early"
    return CompassCause(words, f"late_s = {by:.1f}", float(np.degrees(rms(r) * abs(by))), left, (by,))


def best_between(tried: list[tuple[float, float]]) -> tuple[float, float]:
    """(least, at) by a parabola through the best and its neighbours."""
    order = sorted(tried, key=lambda p: p[1])
    i = int(np.argmin([p[0] for p in order]))
    if not 0 < i < len(order) - 1:
        return order[i]
    (a, _), (b, x), (c, _) = order[i - 1 : i + 2]
    step, bend = order[i + 1][1] - x, a - 2.0 * b + c
    return b, x + (0.5 * step * (a - c) / bend if bend > 0.0 else 0.0)


def left_over(odd: np.ndarray, columns: list[np.ndarray], base: float) -> float:
    """Share of the base that stays when a bias and these columns are fitted. `odd` and each column (W,)
    [rad], `base` [rad2]."""
    total = float(np.nansum(odd**2))
    return fit([np.ones(odd.size), *columns], odd)[2] * total / max(base, 1e-30)


def curve(x: np.ndarray) -> list[np.ndarray]:
    """Four columns like `x` [rad]: B sin x, C cos x, D sin 2x and E cos 2x, each with its coefficient 1;
    `x` (N,)."""
    return [np.sin(x), np.cos(x), np.sin(2 * x), np.cos(2 * x)]


FORMS = ((0,), (1,), (0, 1), (0, 1, 2, 3))  # which of B, C, D, E: the fewest that tell


def deviation(w: CompassWindows, r: np.ndarray, psi: np.ndarray, base: float) -> CompassCause | None:
    """Coefficients B to E of the compass, as functions of the true heading; as many as the voyage's
    headings can tell apart. `r` (N,) [rad/s] and `psi` (N,) [rad] on the view's even grid."""
    tried = [c for form in FORMS if (c := curve_of(w, r, psi, base, form)) is not None]
    if not tried:
        return None
    n = w.independent
    return min(tried, key=lambda c: n * np.log(max(c.left, 1e-9)) + np.log(n) * np.count_nonzero(c.value))


def curve_of(
    w: CompassWindows, r: np.ndarray, psi: np.ndarray, base: float, form: tuple[int, ...]
) -> CompassCause | None:
    """The coefficients of one form, found again after each undoing. `r` (N,) [rad/s] and `psi` (N,) [rad]
    on the view's even grid; `form`: which columns of `curve` it has."""
    odd, true, full = w.change(psi) - w.summed(r), psi, np.zeros(4)
    for _ in range(5):
        waves = curve(true)
        columns = [w.change(waves[i]) for i in form]
        found, error, _ = fit([np.ones(odd.size), *columns], odd)
        if not np.isfinite(found).all() or np.any(np.abs(found[1:]) > MOST_DEVIATION):
            return None
        full[list(form)] = found[1:]
        true = np.radians(without_deviation(np.degrees(psi), (0.0, *np.degrees(full))))
    if (
        np.any(np.abs(found[1:]) < 4.0 * np.sqrt(2.0) * error[1:])
        if len(form) < 4
        else not np.any(np.abs(found[1:]) > 6.0 * error[1:])
    ):
        return None
    size = rms(sum((a * c for a, c in zip(full, curve(true), strict=True)), np.zeros(true.size)))
    return CompassCause(
        "deviation",
        "",
        float(np.degrees(size)),
        left_over(odd, columns, base),
        tuple(np.degrees(full[: form[-1] + 1]).tolist()),
    )


def scale(w: CompassWindows, r: np.ndarray, psi: np.ndarray, base: float) -> CompassCause | None:
    """The rate of turn by a factor: no matter of the compass, only a rival explanation. `r` (N,) [rad/s]
    and `psi` (N,) [rad] on the view's even grid."""
    summed = w.summed(r)
    odd = w.change(psi) - summed
    k = fit([np.ones(odd.size), summed], odd)[0][1]
    if not np.isfinite(k) or abs(k) > MOST_SCALE:
        return None  # no gyro is so far off; a unit that is has its own check
    return CompassCause("", "", 0.0, left_over(odd, [summed], base), ())


def heading_without(view: VoyageView, cause: CompassCause) -> np.ndarray:
    """(N,) the heading [deg] as it would be, were this undone."""
    t, psi = view.even.time_s, np.degrees(view.psi)
    if "deviation" in cause.text:
        return np.mod(without_deviation(psi, (0.0, *cause.value)), 360.0)
    there = np.isfinite(psi)
    return np.mod(np.interp(t + cause.value[0], t[there], psi[there]), 360.0)


def without(view: VoyageView, cause: CompassCause) -> VoyageView:
    """The view with that heading."""
    psi = heading_without(view, cause)
    return undone(view, lambda c: {HEADING: psi})


def fitted(view: VoyageView) -> list[Single]:
    """What `by_rate` finds, as one of the mistakes that are tried against each other."""
    found = by_rate(view)
    if found is None or found[0] is None:
        return []
    cause = found[0]
    psi = heading_without(view, cause)
    words = cause.text if cause.text != "deviation" else "the compass has a deviation"
    return [
        Single(
            lambda v: words,
            lambda v: lambda c: {HEADING: psi},
            lambda v: f"{cause.fix or 'deviation'} for {HEADING}",
            NAME,
            (HEADING,),
            frozenset(("heading",)),
        )
    ]
