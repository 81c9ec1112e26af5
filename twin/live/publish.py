"""What the twin says: the wide record of one tick, and the few subjects that others listen to.

Nothing that is not a finite number is ever put into a message: such a field stays absent, and is counted.
"""

from math import degrees, isfinite
from typing import Any

from twin.live.keelson import messages
from twin.live.keelson.topics import OUTPUTS, Output
from twin.live.learning.learned_force import Learned
from twin.live.observer.estimate import Estimate
from twin.live.observer.predict import Prediction, Region
from twin.live.seen import Seen, Standing
from twin.live.signals.chart import Chart
from twin.live.signals.measured import Measured
from twin.physics.core import Tau
from twin.physics.maths import total

IDENTITY = next(output for output in OUTPUTS if output.subject == "configuration_json")


class Publisher:
    """Builds messages; `withheld` counts the numbers that were not finite, `identity` says who speaks (JSON,
    see `provenance.identity`)."""

    def __init__(self) -> None:
        self.withheld, self.identity = 0, ""
        self.actuators: tuple[str, ...] = ()  # channels of the ship's own
        self._next: dict[Output, float] = {}

    def tick(self, seen: Seen, standing: Standing) -> Any:
        """The wide record."""
        finite, instant, measured, estimate = self._finite, seen.instant, seen.measured, seen.estimate
        ready, pace, ages = estimate.ready, standing.pace, measured.age_by_channel()
        return messages.Tick(
            index=instant.number,
            time_s=instant.time_s,
            wall_s=instant.wall_s,
            mode=seen.verdict.mode,
            reasons=standing.reasons,
            rate_hz=pace.rate_hz,
            slack_us=pace.slack_us,
            step_us=pace.step_us,
            overruns=pace.overruns,
            rejected=standing.rejected,
            log_dropped=standing.log_dropped,
            measured=finite({**self._without_actuators(measured.border), "time_s": instant.wall_s}),
            age_s=finite(self._without_actuators(ages)),
            quality=self._without_actuators(standing.quality),
            estimate=finite(state_of(estimate)) if ready else None,
            sigma=finite(border_sigma(estimate.sigma)) if ready else None,
            known=[
                {"name": name, **finite(named(force))}
                for name, force in zip(seen.physics.names, seen.forces, strict=True)
            ],
            learned=finite(learned_of(seen.learned, standing.share)),
            parameters=[
                {"name": p.name, "unit": p.unit, "status": p.status, **finite(p.numbers())}
                for p in standing.parameters
            ],
            predictions=[self._prediction(p) for p in seen.ahead],
            certificate=finite(seen.certified._asdict()),
            actuators=[
                {"name": name, "quality": standing.quality[name], **finite(_channel(name, measured, ages))}
                for name in self.actuators
            ],
        )

    def _without_actuators(self, by_channel: dict[str, Any]) -> dict[str, Any]:
        """A message has a field for each channel that every ship has; those of actuators are a list."""
        return {k: x for k, x in by_channel.items() if "." not in k} if self.actuators else by_channel

    def _prediction(self, p: Prediction) -> dict[str, Any]:
        said = {
            "horizon_s": p.horizon_s,
            "state": self._finite(border_state(*p.state)),
            "sigma": self._finite(border_sigma(p.sigma)),
            "age_s": p.age_s,
            "status": p.status,
        }
        if r := p.region:
            words = {"voyages": r.voyages, "regime": r.regime, "status": r.status}
            said["tube"] = self._finite(border_region(r)) | words
        return said

    def due(self, tick: Any, chart: Chart | None) -> list[tuple[Output, bytes]]:
        """The subjects whose time has come, encoded; `chart`: where its place is on earth."""
        ns = int(tick.wall_s * 1e9)
        said = []
        for output in OUTPUTS:
            if tick.time_s < self._next.get(output, 0.0):
                continue
            data = self._identity(ns) if output is IDENTITY else _encode(output, tick, chart, ns)
            if data is not None:
                said.append((output, data))
                self._next[output] = tick.time_s + output.every_s - 1e-6
        return said

    def _identity(self, ns: int) -> bytes | None:
        return messages.encode_string(self.identity, ns) if self.identity else None

    def _finite(self, values: dict[str, Any]) -> dict[str, Any]:
        """The values without those that are not finite numbers."""
        whole = total(values.values())
        if whole - whole == 0.0:  # NaN or infinity anywhere makes this NaN
            return values
        kept = {name: x for name, x in values.items() if isfinite(x)}
        self.withheld += len(values) - len(kept)
        return kept


def _channel(name: str, measured: Measured, ages: dict[str, float]) -> dict[str, float]:
    return {"value": measured.border[name], "age_s": ages[name]} if name in measured.border else {}


def state_of(e: Estimate) -> dict[str, float]:
    """The estimate by channel names, in border units."""
    return border_state(e.x, e.y, e.psi, e.u, e.v, e.r) | {
        "current_north_mps": e.current_north,
        "current_east_mps": e.current_east,
    }


def learned_of(learned: Learned, share: float) -> dict[str, float]:
    """The learned force, its bounds, and how far it is used."""
    bounds = {"bound_N": learned.bound_N, "bound_Nm": learned.bound_Nm}
    return named(learned.force) | bounds | {"weight": learned.weight, "share": share}


def border_state(x: float, y: float, psi: float, u: float, v: float, r: float) -> dict[str, float]:
    """The six numbers of eta and nu by their names and units outside; the heading in [0, 360)."""
    return {
        "north_m": x,
        "east_m": y,
        "heading_true_north_deg": degrees(psi) % 360.0,
        "surge_velocity_mps": u,
        "sway_velocity_mps": v,
        "yaw_rate_degps": degrees(r),
    }


def border_sigma(sigma: tuple[float, ...]) -> dict[str, float]:
    """Standard deviations of the state by channel names, in border units."""
    x, y, psi, u, v, r = sigma
    return {
        "north_m": x,
        "east_m": y,
        "heading_true_north_deg": degrees(psi),
        "surge_velocity_mps": u,
        "sway_velocity_mps": v,
        "yaw_rate_degps": degrees(r),
    }


def border_region(r: Region) -> dict[str, float]:
    """A predicted region in border units."""
    return {
        "along_m": r.along_m,
        "across_m": r.across_m,
        "course_deg": degrees(r.course) % 360.0,
        "heading_deg": degrees(r.heading),
        "level": r.level,
    }


def named(force: Tau) -> dict[str, float]:
    """A force by component [N, N, N m]."""
    return {"X_N": force[0], "Y_N": force[1], "N_Nm": force[2]}


def _encode(output: Output, tick: Any, chart: Chart | None, ns: int) -> bytes | None:
    """One subject from the wide record; None when there is nothing to say."""
    e = tick.estimate
    if output.subject == "twin_tick":
        return bytes(tick.SerializeToString())
    if output.subject == "twin_status":
        return messages.encode_string("; ".join([tick.mode, *tick.reasons]), ns)
    if output.subject == "location_fix":
        return (
            messages.encode_fix(*chart.position(e.north_m, e.east_m), ns)
            if chart and e.HasField("north_m")
            else None
        )
    if output.subject in ("force_newton", "moment_newton_meter"):
        return _vector(output, tick, ns)
    return messages.encode_float(getattr(e, output.subject), ns) if e.HasField(output.subject) else None


def _vector(output: Output, tick: Any, ns: int) -> bytes:
    forces = [tick.learned] if output.source.endswith("learned") else tick.known
    if output.subject == "force_newton":
        return messages.encode_vector(total(f.X_N for f in forces), total(f.Y_N for f in forces), 0.0, ns)
    return messages.encode_vector(0.0, 0.0, total(f.N_Nm for f in forces), ns)
