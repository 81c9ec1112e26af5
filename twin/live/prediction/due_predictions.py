"""Every prediction of a voyage judged as it comes due: for calibration and for the summary of a replay. On
board nothing of this runs."""

from collections import deque
from collections.abc import Sequence

from twin.live.observer.estimate import Estimate
from twin.live.observer.predict import Prediction, usual_error
from twin.live.prediction.circumstances import Circumstances
from twin.live.prediction.judge import Foretold, Judge, VerifiedPrediction
from twin.live.signals.measured import Measured
from twin.physics.ship import Ship


class Watch:
    """`look` after each tick: the predictions that came due in it, by horizon."""

    def __init__(self, ship: Ship, horizons_s: Sequence[float]):
        self.circumstances, self._judge = Circumstances(ship), Judge()
        self._usual = {h: usual_error(ship, h)[:2] for h in horizons_s}
        self._waiting: dict[float, deque[Foretold]] = {h: deque() for h in horizons_s}

    def look(
        self, now_s: float, measured: Measured, e: Estimate, ahead: Sequence[Prediction], good: bool
    ) -> list[tuple[float, VerifiedPrediction]]:
        """Takes what a tick knew."""
        self.circumstances.step(now_s, measured, good)
        self._judge.hear(measured)
        if self.circumstances.settled(now_s):
            for p in ahead:
                self._wait(now_s, measured, e, p)
        return [pair for h, waiting in self._waiting.items() for pair in self._due(h, waiting, now_s)]

    def _wait(self, now_s: float, measured: Measured, e: Estimate, p: Prediction) -> None:
        h = next((h for h in self._usual if abs(h - p.horizon_s) < 0.5), None)
        if h is None:
            return
        known = self.circumstances.known(now_s, e, measured, p, self._usual[h])
        start_s, due_s = now_s - p.age_s, now_s + p.horizon_s
        self._waiting[h].append(Foretold(start_s, now_s, due_s, p.state, known, p.region))

    def _due(
        self, h: float, waiting: deque[Foretold], now_s: float
    ) -> list[tuple[float, VerifiedPrediction]]:
        found = []
        while waiting:
            judged = self._judge.ask(waiting[0], now_s, self.circumstances.moved_s)
            if judged is False:
                break
            waiting.popleft()
            if isinstance(judged, VerifiedPrediction):
                found.append((h, judged))
        return found
