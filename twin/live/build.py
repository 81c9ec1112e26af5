"""From settings to a loop: the ship, its residual, its certificate, and what had to be left out, in words."""

import sys
from math import ceil
from pathlib import Path

from twin.live import realtime
from twin.live.certificate.authority import authority_margin
from twin.live.certificate.certificate import Certificate, on_board
from twin.live.certificate.rolled_tube import tube_of
from twin.live.certificate.store import kept, mark, on_file
from twin.live.gates.sensors import Sensors
from twin.live.guard import Guard
from twin.live.learning import network
from twin.live.learning import residual as residuals
from twin.live.learning.learned_force import LearnedForce
from twin.live.learning.residual import NoResidual, Residual, ResidualError, WrongShip
from twin.live.loop import Ears, Loop
from twin.live.observer.dynamics import first_current
from twin.live.observer.observer import Observer
from twin.live.observer.predict import Predictor
from twin.live.observer.rollback import RollBack, inner_steps
from twin.live.outbox import Outbox
from twin.live.signals.config import Settings
from twin.live.stabilizer import Stabilizer
from twin.num import as_given
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.ship import load as load_ship

CERTIFY = "from twin.live.build import certify_aside; certify_aside{!r}"
LATENESS = 1.05  # periods within which a tick still counts as one
NO_THEOREM = "none, as its proof covers one propeller with one rudder only"
CERTIFY_S = 20.0  # the longest the service's start waits for a certificate


def loop_of(settings: Settings, ears: Ears, voice: Outbox, patience_s: float | None = CERTIFY_S) -> Loop:
    """The loop these settings describe; SettingsError when they cannot be used. `patience_s`: how long its
    certificate may take, None for as long as it takes.

    What loading a library leaves in memory is given back before the next one is loaded: their sum would be
    the peak.
    """
    breathe = realtime.drop_pages if settings["loop.drop_pages"] else int
    breathe()
    ship = load_ship(settings["ship.file"], arrays=False)
    notes: list[str] = []
    if settings["residual.file"] != "none":
        network.open_library(breathe)
    residual, why_not, logged = residual_of(settings, ship)
    breathe()
    if residual and residual.note:
        notes.append(residual.note)
    learned = LearnedForce(ship, residual, why_not, settings["adaptation.on"])
    if learned.adaptation is not None and (path := learned_file(settings)):
        learned.adaptation.restore(path, mark_of(learned))
        notes += learned.adaptation.notes
    rate, stabilizer = (
        settings["loop.rate_hz"],
        stabilizer_of(settings, ship, patience_s, saturation_of(residual)),
    )
    loop = Loop(
        ship,
        ears,
        voice,
        learned,
        rate,
        settings["observer.gain"] or stabilizer.gain,
        stabilizer=stabilizer,
        observer=observer_of(settings, ship, settings["observer.gain"] or stabilizer.gain),
        predictor=Predictor(
            ship, tuple(settings["prediction.horizons_s"]), settings["prediction.refresh_s"], rate
        ),
        sensors=Sensors(ship, settings.sources, settings["sensors.max_delay_s"]),
        guard=Guard(ship, learned, settings["guard.reckoning_s"], period_s=1.0 / rate),
    )
    if said := loop.stabilizer.why_not:
        notes.append(f"certificate: {said}")
    if said := loop.tube.why_not:
        notes.append(f"prediction tube: {said}")
    loop.notes, loop.logged = notes, [logged] if logged else []
    return loop


def residual_of(settings: Settings, ship: Ship) -> tuple[Residual | None, str, str]:
    """The residual, or None and why there is none: for the bridge, and with file and hashes for the log. One
    made for another ship is passed over only if nobody asked for it. ResidualError: one is required and
    cannot be used, or the one asked for is not for this ship; NoResidual: one is required and none comes with
    the ship."""
    asked = settings["residual.file"]
    if asked == "none":
        return None, "the settings want none", ""
    if ship.actuators:
        why = "a network looks at one rudder and one shaft, and this ship lists [[actuators]]"
        if asked or settings["residual.required"]:
            raise ResidualError(f'residual.file: {why}. Set it to "none"')
        return None, why, ""
    path = Path(asked) if asked else residuals.bundled(ship)
    try:
        if path is None:
            raise NoResidual(f"no residual comes with the ship {ship.name!r}. `twin train` makes one")
        return residuals.load(path, ship), "", ""
    except ResidualError as error:
        if settings["residual.required"] or (asked and isinstance(error, WrongShip)):
            raise
        return None, error.alarm, str(error)


def mark_of(learned: LearnedForce) -> str:
    """What adapted numbers belong to: this ship's model, and this network if there is one."""
    network = learned.residual.manifest.sha256[:16] if learned.residual else "no network"
    return f"{residuals.ship_hash(learned.ship)} {network}"


def learned_file(settings: Settings) -> Path | None:
    """Where adapted numbers are kept; None: nowhere."""
    folder = settings["state.folder"]
    return Path(folder) / "adaptation.json" if folder else None


def saturation_of(residual: Residual | None) -> tuple[float, float, float]:
    """What the learned force can reach on each axis, whatever its weights become [N, N, N m]."""
    if residual is None:
        return 0.0, 0.0, 0.0
    X, Y, N = residual.manifest.force_scale
    bound = residual.manifest.output_bound
    return bound * X, bound * Y, bound * N


def stabilizer_of(
    settings: Settings,
    ship: Ship,
    patience_s: float | None = CERTIFY_S,
    saturation: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Stabilizer:
    """The certificate from its file; when there is none it is worked out by another process (it needs
    numpy, the loop does not). Its period is a little longer than the loop's: a tick may wake late."""
    if ship.actuators:
        return Stabilizer(None, NO_THEOREM)
    h, K = LATENESS / settings["loop.rate_hz"], settings["observer.gain"] or None
    oldest_s = settings["observer.oldest_s"] or min(max(0.0125 * ship.L_pp / ship.U_0, h), 1.2)
    delay = max(ceil(oldest_s / h - 1e-6), 1)
    adapted, said, steps = settings["adaptation.on"], "", steps_of(settings, ship)
    wanted = mark(Model.of(ship), K, h, on_board(ship, delay, adapted, saturation, steps))
    path = certificate_file(settings, wanted)
    certificate = on_file(path, wanted)
    if certificate is None:
        certificate, said = _worked_out(
            patience_s, settings["ship.file"], str(path), K, h, delay, adapted, saturation, steps
        )
    if certificate is None:
        return Stabilizer(None, f"not worked out ({said})")
    why_not = "" if certificate.ok else certificate.reason
    return Stabilizer(tube_of(certificate), why_not, authority_margin(Model.of(ship), certificate))


def steps_of(settings: Settings, ship: Ship) -> int:
    """Into how many steps the observer cuts a period."""
    return int(settings["observer.inner_steps"]) or inner_steps(ship, 1.0 / settings["loop.rate_hz"])


def observer_of(settings: Settings, ship: Ship, gain: float) -> Observer:
    """The observer of this ship at this rate."""
    steps, current = steps_of(settings, ship), first_current(ship)
    if steps == 1:
        return Observer(ship, gain, current)
    return RollBack(ship, LATENESS / settings["loop.rate_hz"] / steps, gain, current)


def _worked_out(patience_s: float | None, *arguments: object) -> tuple[Certificate | None, str]:
    """The certificate from another process, which keeps it on file where it can; or None, and why in one
    line."""
    import subprocess  # here and not above: only the first start needs it

    # -P: no module of the folder that it runs in
    command = [sys.executable, "-P", "-c", CERTIFY.format(arguments)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=patience_s, check=True)
        return Certificate.from_json(done.stdout), ""
    except subprocess.TimeoutExpired:
        waited_s = as_given(CERTIFY_S if patience_s is None else patience_s)
        return None, f"not ready after {waited_s} s. Start again when the machine is less busy"
    except subprocess.CalledProcessError as error:
        return None, (error.stderr.strip().splitlines() or ["no reason given"])[-1]
    except OSError as error:
        return None, str(error)


def certificate_file(settings: Settings, wanted: str) -> Path:
    """As the settings say, else in the state folder, else in ~/.cache/shiptwin, where many ships and settings
    lie: by its mark."""
    if settings["observer.certificate"]:
        return Path(settings["observer.certificate"])
    if settings["state.folder"]:
        return Path(settings["state.folder"]) / "certificate.json"
    return (
        Path.home() / ".cache" / "shiptwin" / f"{Path(settings['ship.file']).stem}-{wanted}.certificate.json"
    )


def certify_aside(
    ship_file: str,
    path: str,
    K: float | None,
    h: float,
    delay: int,
    adapted: bool,
    saturation: tuple[float, float, float],
    inner: int,
) -> None:
    """Work the certificate out, put it on file and say it: what the other process does."""
    ship = load_ship(ship_file, arrays=False)
    print(kept(path, Model.of(ship), K, h, **on_board(ship, delay, adapted, saturation, inner)).to_json())
