"""The paper's Figures 2 to 6 from our own runs, and error over amount of data: small PNG files."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

from bench.paper.closed import GUST_AT, GUST_LONG, MODES, STEP_DEG, Closed
from bench.paper.lab import LabCourse, judge
from bench.paper.models import Models
from bench.tick.timing import hot_us

SHOWN = {
    "analytic": ("nominal analytic", "0.6"),
    "ekf": ("EKF", "tab:orange"),
    "lstm": ("LSTM", "tab:green"),
    "hybrid": ("hybrid", "tab:blue"),
}
COLOURS = ("0.5", "tab:blue", "tab:red")


def save(folder: Path, name: str, fig: Any) -> None:
    fig.tight_layout()
    fig.savefig(folder / name, dpi=72)
    plt.close(fig)


def learning(folder: Path, curves: dict[str, list[list[float]]]) -> None:
    """Fig. 2: validation loss over epochs, each over its own first."""
    fig, ax = plt.subplots(figsize=(7, 3.5))
    for name, colour in (("hybrid", "tab:blue"), ("lstm", "tab:green")):
        runs = [np.array(c) / c[0] for c in curves[name]]
        shortest = min(map(len, runs))
        table = np.stack([r[:shortest] for r in runs])
        x = np.arange(1, shortest + 1)
        ax.plot(
            x,
            table.mean(0),
            color=colour,
            label=f"{'hybrid, roll-outs' if name == 'hybrid' else 'LSTM'} ({len(runs)} seed(s))",
        )
        ax.fill_between(x, table.min(0), table.max(0), color=colour, alpha=0.25)
    ax.set(
        xlabel="epoch",
        ylabel="validation loss / its first",
        yscale="log",
        title="Fig. 2: learning (band: least to greatest of the seeds)",
    )
    ax.legend()
    save(folder, "fig-2-learning.png", fig)


def zigzag(folder: Path, models: Models, c: LabCourse, window: int = 2) -> None:
    """Fig. 3: one unseen window, heading and path."""
    fig, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6))
    true = c.truth[c.at[:, window]]
    t = c.water.t[c.at[:, window]] - c.water.t[c.at[0, window]]
    left.plot(t, np.degrees(true[:, 2] - true[0, 2]), "k", lw=2, label="truth")
    right.plot(true[:, 1] - true[0, 1], true[:, 0] - true[0, 0], "k", lw=2)
    for name, (words, colour) in SHOWN.items():
        run = models.predict[name]([c])[0][:, window]
        left.plot(t[1:], np.degrees(run[:, 2] - true[0, 2]), color=colour, label=words)
        right.plot(run[:, 1] - true[0, 1], run[:, 0] - true[0, 0], color=colour)
    left.set(xlabel="s", ylabel="heading, deg", title=f"Fig. 3: {c.name}, window {window + 1}")
    right.set(xlabel="east, m", ylabel="north, m", title="path", aspect="equal")
    left.legend(fontsize=8)
    save(folder, "fig-3-zigzag.png", fig)


def histogram(folder: Path, models: Models, courses: Sequence[LabCourse]) -> None:
    """Fig. 4: lateral errors at the end of all windows."""
    fig, ax = plt.subplots(figsize=(7, 3.5))
    for name, (words, colour) in SHOWN.items():
        e = judge(models.predict[name](courses), courses).lateral[:, -1]
        bins = np.linspace(-120, 120, 121)
        ax.hist(
            e.clip(-120, 120),
            bins,
            density=True,
            histtype="step",
            color=colour,
            label=f"{words}: sd {e.std():.1f} m",
        )
    ax.set(
        xlabel="lateral error after 120 s, m",
        ylabel="density, 1/m",
        yscale="log",
        title=f"Fig. 4: {len(e)} windows on unseen zigzags",
    )
    ax.legend()
    save(folder, "fig-4-errors.png", fig)


def closed_loop(folder: Path, c: Closed) -> None:
    """Fig. 5: TS-03, every mode: response, rudder, phase portrait, spectrum of the error."""
    fig, ((a, b), (d, e)) = plt.subplots(2, 2, figsize=(10, 6.5))
    x = c.lengths
    for m, mode in enumerate(MODES):
        k = np.flatnonzero((c.mode == m) & (c.scenario == 2))
        for axis, y in ((a, c.heading), (b, c.rudder)):
            axis.plot(x, y[:, k].mean(1), color=COLOURS[m], label=mode)
            axis.fill_between(x, y[:, k].min(1), y[:, k].max(1), color=COLOURS[m], alpha=0.2)
        after = x >= 0
        d.plot(c.error[after][:, k[0]], c.rate[after][:, k[0]], color=COLOURS[m], lw=0.8)
        late = x >= 4.0
        tail = c.error[late][:, k]
        power = (
            np.abs(np.fft.rfft((tail - tail.mean(0)) * np.hanning(len(tail))[:, None], axis=0)) ** 2
        ).mean(1)
        step = float(x[1] - x[0])
        e.loglog(np.fft.rfftfreq(len(tail), step)[1:], power[1:] / len(tail) ** 2, color=COLOURS[m])
    a.axvspan(GUST_AT, GUST_AT + GUST_LONG, color="0.9")
    a.axhline(STEP_DEG, color="k", lw=0.5)
    a.set(
        xlabel="ship lengths sailed since the step",
        ylabel="heading, deg",
        title="Fig. 5a: step of 15 deg, gust (grey); TS-03, band of all seeds",
    )
    b.set(xlabel="ship lengths sailed since the step", ylabel="rudder, deg", title="b: rudder")
    d.set(xlabel="error, deg", ylabel="rate of turn, deg/s", title="c, d: phase portrait of one run")
    e.set(xlabel="per ship length", ylabel="deg^2", title="spectrum of the error after 4 lengths")
    a.legend(fontsize=8)
    save(folder, "fig-5-closed-loop.png", fig)


def horizons(folder: Path) -> dict[str, list[float]]:
    """Fig. 6: time of one prediction over its horizon, in steps of 1 s on floats, one thread; also as numbers
    [ms], one step last."""
    fig, ax = plt.subplots(figsize=(7, 3.5))
    seconds, out = (10, 30, 60, 120, 300), {}
    for (name, once), colour in zip(_predictors().items(), ("0.6", "tab:blue", "tab:green"), strict=True):
        step_us = float(np.median(hot_us(once, 300)))
        out[name] = [ahead_ms(once, n) for n in seconds] + [step_us / 1000]
        ax.loglog(seconds, out[name][:-1], "o-", color=colour, label=name)
    ax.set(
        xlabel="horizon, s",
        ylabel="time of one prediction, ms",
        title="Fig. 6: cost of looking ahead, on this machine",
    )
    ax.legend()
    save(folder, "fig-6-horizon.png", fig)
    return out


def ahead_ms(once: Callable[[], object], steps: int) -> float:
    """Median time of a prediction of so many steps."""

    def whole() -> None:
        for _ in range(steps):
            once()

    return float(np.median(hot_us(whole, 5, warm_up=1))) / 1000


def _predictors() -> dict[str, Callable[[], object]]:
    """One step of 1 s of each."""
    from bench.tick import peers
    from twin.live.learning.learned_force import LearnedForce
    from twin.live.learning.residual import bundled, load
    from twin.live.observer.dynamics import KnownDynamics
    from twin.physics.model import Model
    from twin.physics.ship import load as ship_of

    ship = ship_of(peers.SHIP)
    path = bundled(ship)
    assert path is not None
    learned, known, s = (
        LearnedForce(ship, load(path, ship)),
        KnownDynamics(Model.of(ship)),
        peers.situation(ship),
    )

    def hybrid() -> object:
        forces = known.forces(s)
        return known.far_rates(s, forces, learned.at(s, forces).force, 1.0)

    return {"analytic": peers.analytic(ship), "hybrid": hybrid, "LSTM over its window": peers.lstm(ship)}


CURVES = {
    "hybrid": ("hybrid", "tab:blue"),
    "physics_added_hybrid": ("calibrated + named + network", "tab:purple"),
    "lstm": ("LSTM", "tab:green"),
}


def data(folder: Path, rows: Sequence[dict[str, Any]]) -> None:
    """Error over amount of data."""
    fig, axes = plt.subplots(1, 2, figsize=(9, 3.5))
    for ax, measure, unit in zip(
        axes, ("heading_mae_deg", "lateral_mae_m"), ("heading, deg", "lateral, m"), strict=True
    ):
        for name, (words, colour) in CURVES.items():
            ax.loglog(
                [r["hours"] for r in rows], [r[name][measure] for r in rows], "o-", color=colour, label=words
            )
        ax.set(xlabel="hours that teach", ylabel=f"MAE {unit}")
    axes[0].set_title("Error over amount of data")
    axes[0].legend()
    save(folder, "fig-7-data.png", fig)
