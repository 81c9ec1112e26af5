"""The learned residual's trunk: phi(zeta) by ONNX, believed only where it was trained, and only after it proved to be whole.

    phi = trunk((zeta - offset)/scale),  zeta clamped to its envelope;  weight = prod_i (1 - d_i/MARGIN)^2 over inputs outside,

d_i being how far input i is outside its envelope, in widths of the envelope. Loading checks the hash of the bytes, the
operators, shapes, element types and opset, the ship, and that golden inputs still give golden outputs.
"""

import hashlib
import json
from math import isfinite
from pathlib import Path
from typing import NamedTuple

from twin.errors import SettingsError
from twin.live import manifest as manifests
from twin.live.manifest import Manifest
from twin.live.network import Network, NetworkError
from twin.live.onnx_file import FLOAT, OnnxError, look
from twin.physics import ship as ships
from twin.physics.ship import Ship
from twin.physics.state import Situation
from twin.physics.zeta import inputs

OPERATORS = frozenset(
    ("Gemm", "MatMul", "Add", "Sub", "Mul", "Div", "Sigmoid", "Tanh", "Relu", "Clip", "Concat", "Identity", "Softplus", "Swish")
)
MAX_BYTES = 8_000_000
OPSETS = range(13, 26)
MARGIN = 0.25  # how far outside its envelope the residual is shrunk to nothing
GOLDEN = 1e-4  # how closely golden outputs must be met, relative to their size
ABSURD = 1e6  # a feature beyond this is no feature


class ResidualError(SettingsError):
    """A residual that must not be used; the twin goes on with physics only unless the settings forbid it."""


class WrongShip(ResidualError):
    """A residual made for another ship, or for another state of her model: never used, and not passed over in silence."""


class Features(NamedTuple):
    """phi and the whitened components of it, how far they may be believed (0 to 1), and why not fully, in words."""

    phi: list[float]
    components: list[float]
    weight: float
    why: str = ""


class Residual:
    """A checked trunk; `features(s)` never raises."""

    def __init__(self, manifest: Manifest, network: Network, ship: Ship):
        self.manifest, self.network, self.ship = manifest, network, ship
        self._names = tuple(i.name for i in manifest.inputs)
        self._mean, self._rows = manifest.whitening or ((), ())

    def features(self, s: Situation) -> Features:
        """phi of this situation (s.u_r and s.v_r set)."""
        scaled, weight, why = self.scaled(s)
        if weight == 0.0:
            return Features([], [], 0.0, why)
        try:
            phi = self.network.run(scaled)
        except NetworkError as error:
            return Features([], [], 0.0, f"the network failed ({error})")
        if not all(-ABSURD < x < ABSURD for x in phi):
            return Features([], [], 0.0, "the network gives numbers that are not finite or absurd")
        return Features(phi, self.components(phi), weight, why)

    def scaled(self, s: Situation) -> tuple[list[float], float, str]:
        """The network's inputs, the weight of what it will say, and the reason when that is not 1."""
        values, weight, why = [], 1.0, ""
        for entry, zeta in zip(self.manifest.inputs, inputs(self._names, s, self.ship), strict=True):
            if zeta is None or not isfinite(zeta):
                return [], 0.0, f"its input {entry.name} is not measured"
            outside = max(entry.low - zeta, zeta - entry.high, 0.0) / (entry.high - entry.low)
            if outside > 0.0:
                weight *= max(1.0 - outside / MARGIN, 0.0) ** 2
                why = f"{entry.name} = {zeta:.3g} is outside {entry.low:.3g} to {entry.high:.3g}, where it was trained"
                zeta = min(max(zeta, entry.low), entry.high)
            values.append((zeta - entry.offset) / entry.scale)
        return values, weight, why

    def components(self, phi: list[float]) -> list[float]:
        """The few directions in which phi varies most, whitened, clipped at three deviations."""
        centred = [p - m for p, m in zip(phi, self._mean, strict=False)]
        return [min(max(dot(row, centred), -3.0), 3.0) for row in self._rows]


def dot(a: "tuple[float, ...] | list[float]", b: "tuple[float, ...] | list[float]") -> float:
    """The inner product, summed from left to right: the same on every machine (BLAS is not)."""
    return sum(map(float.__mul__, a, b))


def load(path: str | Path, ship: Ship) -> Residual:
    """The residual at `path` (its manifest beside it, `.json` for `.onnx`); ResidualError when it must not be used."""
    path = Path(path)
    try:
        model, text = path.read_bytes(), path.with_suffix(".json").read_bytes()
    except OSError as error:
        raise ResidualError(f"{error.filename}: cannot be read ({error.strerror})") from None
    return check(model, text, ship, str(path))


def check(model: bytes, text: bytes, ship: Ship, where: str = "residual") -> Residual:
    """The residual made of these bytes, once everything about it has been checked."""
    try:
        manifest = manifests.parse(text)
    except manifests.ManifestError as error:
        raise ResidualError(f"{where}: its manifest is not usable: {error}") from None
    _same_ship(manifest, ship, where)
    digest = hashlib.sha256(model).hexdigest()
    if digest != manifest.sha256:
        raise ResidualError(
            f"{where}: its bytes changed (sha256 {digest[:12]}..., the manifest says {manifest.sha256[:12]}...). Copy it again"
        )
    names = _structure(model, manifest, where)
    try:
        network = Network(model, names[0], len(manifest.inputs), names[1], manifest.features)
    except NetworkError as error:
        raise ResidualError(f"{where}: ONNX Runtime refuses it: {error}") from None
    residual = Residual(manifest, network, ship)
    _golden(residual, where)
    return residual


def bundled(ship: Ship) -> Path | None:
    """The residual that comes with a bundled ship of this name, if there is one."""
    for path in sorted((Path(ships.__file__).parent.parent / "ships").glob("*.residual.onnx")):
        try:
            name = json.loads(path.with_suffix(".json").read_bytes())["ship"]["name"]
        except (OSError, ValueError, KeyError, TypeError):
            continue
        if name == ship.name:
            return path
    return None


def ship_hash(ship: Ship) -> str:
    """Identifies the model that a residual was trained on top of: every number of the ship and her effects."""
    table = ships.to_table(ship)
    numbers = {
        section: {name: entry["value"] for name, entry in table[section].items()} for section in ("particulars", "derivatives")
    }
    effects = {name: {k: p["value"] for k, p in entry.items()} for name, entry in table["effects"].items()}
    text = json.dumps([ship.name, numbers, effects], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _same_ship(manifest: Manifest, ship: Ship, where: str) -> None:
    if manifest.ship_name != ship.name:
        raise WrongShip(f"{where}: made for the ship {manifest.ship_name!r}, this one is {ship.name!r}. Give her own residual, or none")
    if manifest.ship_hash and manifest.ship_hash != ship_hash(ship):
        raise WrongShip(
            f"{where}: made for {ship.name!r} with another model (hash {manifest.ship_hash}, now {ship_hash(ship)}). "
            "Train it again with `twin train`, or run without it (residual.file = \"none\")"
        )


def _structure(model: bytes, manifest: Manifest, where: str) -> tuple[str, str]:
    """Operators, opset, shapes and types; returns the names of input and output."""
    if len(model) > MAX_BYTES:
        raise ResidualError(f"{where}: {len(model)} bytes, at most {MAX_BYTES} expected")
    try:
        found = look(model)
    except OnnxError as error:
        raise ResidualError(f"{where}: {error}") from None
    strange = sorted(set(found.operators) - OPERATORS)
    if strange or found.oddities or not found.operators:
        what = ", ".join([*strange, *sorted(set(found.oddities))]) or "nothing to compute"
        raise ResidualError(f"{where}: the network holds {what}; allowed operators: {', '.join(sorted(OPERATORS))}")
    opset = found.opsets.get("", found.opsets.get("ai.onnx", 0))
    if opset != manifest.opset or opset not in OPSETS:
        raise ResidualError(f"{where}: opset {opset}, the manifest says {manifest.opset}, {OPSETS[0]} to {OPSETS[-1]} can be used")
    wanted = [("input", found.inputs, len(manifest.inputs)), ("output", found.outputs, manifest.features)]
    for what, tensors, size in wanted:
        shapes = [(kind, shape) for _, kind, shape in tensors]
        if shapes != [(FLOAT, [1, size])]:
            said = ", ".join(f"element type {kind} shape {shape}" for kind, shape in shapes) or "none"
            raise ResidualError(f"{where}: {what} is {said}; one of element type {FLOAT} (float32) shape [1, {size}] is needed")
    return found.inputs[0][0], found.outputs[0][0]


def _golden(residual: Residual, where: str) -> None:
    for zeta, wanted in residual.manifest.golden:
        try:
            phi = residual.network.run(list(zeta))
        except NetworkError as error:
            raise ResidualError(f"{where}: it does not run: {error}") from None
        size = max(1.0, *(abs(w) for w in wanted))
        worst = max(abs(p - w) if isfinite(p) else float("inf") for p, w in zip(phi, wanted, strict=True))
        if not worst <= GOLDEN * size:
            raise ResidualError(f"{where}: a golden input gives another output than in training (off by {worst:.3g})")
