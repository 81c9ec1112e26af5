"""From settings to a loop: the ship, her residual, her certificate, and what had to be left out, in words."""

import sys
from pathlib import Path

from twin.errors import SettingsError
from twin.live import network, realtime
from twin.live import residual as residuals
from twin.live.certificate import Certificate, Tube, kept, on_board
from twin.live.config import Settings
from twin.live.estimate import gain_for
from twin.live.guard import Guard
from twin.live.learned import LearnedForce
from twin.live.loop import Ears, Loop
from twin.live.outbox import Outbox
from twin.live.predict import Predictor
from twin.live.residual import Residual, ResidualError, WrongShip
from twin.live.sensors import Sensors
from twin.live.stabilizer import Stabilizer
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.ship import load as load_ship

CERTIFY = "from twin.live.build import certify_aside; certify_aside({!r}, {!r}, {!r}, {!r}, {!r}, {!r})"
CERTIFY_S = 20.0  # the longest the start waits for a certificate


def loop_of(settings: Settings, ears: Ears, voice: Outbox, ship: Ship | None = None, certify: bool = True) -> Loop:
    """The loop these settings describe; SettingsError when they cannot be used. `certify` False: no
    certificate is worked out.

    What loading a library leaves in memory is given back before the next one is loaded: their sum would be
    the peak.
    """
    breathe = realtime.drop_pages if settings["loop.drop_pages"] else int
    breathe()
    ship = ship or load_ship(settings["ship.file"])
    notes: list[str] = []
    if settings["residual.file"] != "none":
        network.open_library(breathe)
    residual, why_not = residual_of(settings, ship)
    breathe()
    learned = LearnedForce(ship, residual, why_not, settings["adaptation.on"])
    if learned.adaptation is not None and (path := learned_file(settings)):
        learned.adaptation.restore(path, mark_of(learned))
        notes += learned.adaptation.notes
    rate = settings["loop.rate_hz"]
    loop = Loop(
        ship, ears, voice, learned, rate, settings["observer.gain"],
        stabilizer=stabilizer_of(settings, ship) if certify else None,
        predictor=Predictor(ship, tuple(settings["prediction.horizons_s"]), settings["prediction.refresh_s"], rate),
        sensors=Sensors(ship, settings.sources, settings["sensors.max_delay_s"]),
        guard=Guard(ship, learned, settings["guard.reckoning_s"]),
    )  # fmt: skip
    if certify and (said := loop.stabilizer.why_not):
        notes.append(f"certificate: {said}")
    loop.notes = notes
    return loop


def residual_of(settings: Settings, ship: Ship) -> tuple[Residual | None, str]:
    """The residual, or None and why there is none. One made for another ship is passed over only if nobody
    asked for it."""
    asked = settings["residual.file"]
    if asked == "none":
        return None, "the settings want none"
    path = Path(asked) if asked else residuals.bundled(ship)
    try:
        if path is None:
            raise ResidualError(f"no residual comes with the ship {ship.name!r}. `twin train` makes one")
        return residuals.load(path, ship), ""
    except ResidualError as error:
        if settings["residual.required"] or (asked and isinstance(error, WrongShip)):
            raise
        return None, str(error)


def mark_of(learned: LearnedForce) -> str:
    """What adapted numbers belong to: this ship's model, and this network if there is one."""
    network = learned.residual.manifest.sha256[:16] if learned.residual else "no network"
    return f"{residuals.ship_hash(learned.ship)} {network}"


def learned_file(settings: Settings) -> Path | None:
    folder = settings["state.folder"]
    return Path(folder) / "adaptation.json" if folder else None


def stabilizer_of(settings: Settings, ship: Ship) -> Stabilizer:
    """The certificate from its file; when there is none it is worked out by another process (it needs
    numpy, the loop does not)."""
    h, K = 1.0 / settings["loop.rate_hz"], settings["observer.gain"] or gain_for(ship)
    oldest_s = settings["observer.oldest_s"] or min(max(0.0125 * ship.L_pp / ship.U_0, 2.0 * h), 1.2)
    delay = max(round(oldest_s / h), 1)
    path, adapted = certificate_file(settings), settings["adaptation.on"]
    try:
        certificate = _on_file(path, ship, K, h, delay, adapted)
        said = "" if certificate else _worked_out(settings["ship.file"], str(path), K, h, delay, adapted)
        certificate = certificate or _on_file(path, ship, K, h, delay, adapted)
    except (OSError, SettingsError) as error:
        certificate, said = None, str(error)
    if certificate is None:
        return Stabilizer(None, f"not worked out ({said})")
    return Stabilizer(Tube(certificate), "" if certificate.ok else certificate.reason)


def _worked_out(*arguments: object) -> str:
    """Lets another process put the certificate on file; returns what it said when it could not."""
    import subprocess  # here and not above: only the first start needs it

    command = [sys.executable, "-c", CERTIFY.format(*arguments)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=CERTIFY_S, check=False)
    except subprocess.TimeoutExpired as error:
        return str(error)
    return (done.stderr.strip().splitlines() or ["no reason given"])[-1]


def certificate_file(settings: Settings) -> Path:
    """As the settings say, else in the state folder, else in ~/.cache/shiptwin, under the ship file's name."""
    if settings["observer.certificate"]:
        return Path(settings["observer.certificate"])
    if settings["state.folder"]:
        return Path(settings["state.folder"]) / "certificate.json"
    return Path.home() / ".cache" / "shiptwin" / f"{Path(settings['ship.file']).stem}.certificate.json"


def certify_aside(ship_file: str, path: str, K: float, h: float, delay: int, adapted: bool) -> None:
    """Work the certificate out and put it on file: what the other process does."""
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    ship = load_ship(ship_file)
    kept(path, Model.of(ship), (K, K, K), h, **on_board(ship, delay, adapted))


def _on_file(path: Path, ship: Ship, K: float, h: float, delay: int, adapted: bool) -> Certificate | None:
    """The certificate on file if it is of this ship and these numbers."""
    from twin.live.certificate import _mark

    try:
        found = Certificate.from_json(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, KeyError, TypeError):
        return None
    wanted = _mark(Model.of(ship), (K, K, K), h, on_board(ship, delay, adapted))
    return found if found.fingerprint == wanted else None
