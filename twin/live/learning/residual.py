"""The learned residual's trunk: phi(zeta) by ONNX, believed only where it was trained, and only after it
proved to be whole.

    phi = trunk((zeta - offset)/scale),
        zeta clamped to its envelope;  weight = prod_i (1 - d_i/MARGIN)^2 over inputs outside,

d_i being how far input i is outside its envelope, in widths of the envelope. Loading checks the hash of the
bytes, the operators, shapes, element types and opset, the ship, and that golden inputs still give golden
outputs.
"""

import json
from math import inf, isfinite, sqrt
from pathlib import Path
from typing import NamedTuple

from twin import whole
from twin.checksum import sha256_hex
from twin.errors import SettingsError
from twin.live.learning import manifest as manifests
from twin.live.learning.manifest import Manifest
from twin.live.learning.network import Network, NetworkError
from twin.live.learning.onnx_file import FLOAT, OnnxError, look, with_rows
from twin.num import as_given, num
from twin.physics import ship as ships
from twin.physics.maths import dot, total
from twin.physics.ship import Ship
from twin.physics.state import Situation
from twin.physics.zeta import ZETA

OPERATORS = frozenset(
    (
        "Gemm",
        "MatMul",
        "Add",
        "Sub",
        "Mul",
        "Div",
        "Sigmoid",
        "Tanh",
        "Relu",
        "Clip",
        "Concat",
        "Identity",
        "Softplus",
        "Swish",
    )
)
MAX_BYTES = 8_000_000
OPSETS = range(13, 26)
# derivatives that came after the first residuals: a ship without them is the model it was (of an effect's
# numbers it says so itself)
LATER = ("gamma_a", "X_uuu")
MARGIN = 0.25  # how far outside its envelope the residual is shrunk to nothing
GOLDEN = 1e-4  # how closely golden outputs must be met, relative to their size
ABSURD = 1e6  # a feature beyond this is no feature


class ResidualError(SettingsError):
    """A residual that must not be used; the twin goes on with physics only unless the settings forbid it.
    `alarm`: the same for the bridge, in a few words and without a path."""

    alarm = "the network's file cannot be used"


class WrongShip(ResidualError):
    """A residual made for another ship, or for another state of its model: never used, and not passed over
    in silence."""

    alarm = "the network was not trained for this model of the ship"


class NoResidual(ResidualError):
    """None was asked for, and none comes with the ship."""

    alarm = "no network has been trained for this ship"


class Features(NamedTuple):
    """W phi in units of the force scale, the whitened components of phi, how far to believe them (0 to 1),
    and why not fully."""

    trained: list[float]
    components: list[float]
    weight: float
    why: str = ""


class Residual:
    """A checked trunk with its last layer; `features(s)` never raises."""

    def __init__(self, manifest: Manifest, network: Network, ship: Ship):
        # the network gives W phi and the components
        self.manifest, self.network, self.ship = manifest, network, ship
        self._inputs = [
            (i.name, ZETA[i.name].of, ZETA[i.name].needs, i.low, i.high, i.offset, i.scale)
            for i in manifest.inputs
        ]

    def features(self, s: Situation) -> Features:
        """What the network says of this situation (s.u_r and s.v_r set)."""
        scaled, weight, why = self.scaled(s)
        if weight == 0.0:
            return Features([], [], 0.0, why)
        try:
            out = self.network.run(scaled)
        except NetworkError as error:
            return Features([], [], 0.0, f"the network failed ({error})")
        # the sum is NaN if one is
        if not (abs(total(out)) < ABSURD and max(out) < ABSURD and min(out) > -ABSURD):
            return Features([], [], 0.0, "the network gives numbers that are not finite or absurd")
        return Features(out[:3], [-3.0 if x < -3.0 else 3.0 if x > 3.0 else x for x in out[3:]], weight, why)

    def scaled(self, s: Situation) -> tuple[list[float], float, str]:
        """The network's inputs, the weight of what it will say, and the reason when that is not 1."""
        values, weight, why, ship = [], 1.0, "", self.ship
        for name, of, needs, low, high, offset, scale in self._inputs:
            zeta = None if needs and any(getattr(s, need) is None for need in needs) else of(s, ship)
            if zeta is None or not low <= zeta <= high:
                if zeta is None or not isfinite(zeta):
                    return [], 0.0, f"its input {name} is not measured"
                weight *= max(1.0 - max(low - zeta, zeta - high) / (high - low) / MARGIN, 0.0) ** 2
                why = (
                    f"{name} = {as_given(zeta, 4)} is outside {as_given(low, 4)} to {as_given(high, 4)}, "
                    "where it was trained"
                )
                zeta = min(max(zeta, low), high)
            values.append((zeta - offset) / scale)
        return values, weight, why

    @property
    def note(self) -> str:
        """What is to be said of it at the start, "" for nothing."""
        old = (
            "residual: its manifest has no hash of its own (made by an earlier version): a rotten number "
            "in it is not noticed"
        )
        return "" if self.manifest.hashed else f"{old}. `twin train` writes one"


def load(path: str | Path, ship: Ship) -> Residual:
    """The residual at `path` (its manifest beside it, `.json` for `.onnx`); ResidualError when it must not
    be used."""
    path = Path(path)
    try:
        model, text = whole.read(path, MAX_BYTES), whole.read(path.with_suffix(".json"), manifests.MAX_BYTES)
    except (OSError, ValueError) as error:  # ValueError: a name that no other ending can be given
        where, why = getattr(error, "filename", None) or path, getattr(error, "strerror", None) or error
        raise ResidualError(f"{str(where)[:300]}: cannot be read ({why})") from None
    return check(model, text, ship, str(path))


def check(model: bytes, text: bytes, ship: Ship, where: str = "residual") -> Residual:
    """The residual made of these bytes, once everything about it has been checked. ResidualError: it is
    not usable, or another ship's."""
    try:
        manifest = manifests.parse(text)
    except manifests.ManifestError as error:
        raise ResidualError(f"{where}: its manifest is not usable: {error}") from None
    _same_ship(manifest, ship, where)
    norm = sqrt(total(w * w for row in manifest.W for w in row))
    if norm > manifest.W_max:
        raise ResidualError(
            f"{where}: its last layer has the norm {num(norm, 3)}, the manifest allows "
            f"{num(manifest.W_max, 3)}"
        )
    digest = sha256_hex(model)
    if digest != manifest.sha256:
        raise ResidualError(
            f"{where}: its bytes changed (sha256 {digest[:12]}..., the manifest says "
            f"{manifest.sha256[:12]}...). Copy it again"
        )
    names = _structure(model, manifest, where)
    try:
        _golden(Network(model, names[0], len(manifest.inputs), names[1], manifest.features), manifest, where)
        return Residual(manifest, _with_last_layer(model, manifest, *names), ship)
    except NetworkError as error:
        raise ResidualError(f"{where}: ONNX Runtime refuses it: {error}") from None


def _with_last_layer(model: bytes, manifest: Manifest, source: str, phi: str) -> Network:
    """The trunk, with the products W phi and components (phi - mean) worked out by ONNX Runtime as well."""
    mean, components = manifest.whitening or ((), ())
    rows = (*manifest.W, *components)
    offsets = (0.0, 0.0, 0.0, *(-dot(row, mean) for row in components))
    whole = with_rows(model, phi, rows, offsets, "shiptwin_rows")
    return Network(whole, source, len(manifest.inputs), "shiptwin_rows", len(rows))


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
    """Identifies the model that a residual was trained on top of: every number of the ship and its
    effects."""
    table = ships.to_table(ship)
    numbers = {
        section: {name: entry["value"] for name, entry in table[section].items()}
        for section in ("particulars", "derivatives")
    }
    if ship.actuators:
        numbers["actuators"] = {a.name: repr(a) for a in ship.actuators}
    effects = {name: {k: p["value"] for k, p in entry.items()} for name, entry in table["effects"].items()}
    later = {"derivatives": LATER} | {type(e).__name__: type(e).added_later for e in ship.effects}
    for owner, entry in (numbers | effects).items():
        for name in later.get(owner, ()):
            if entry[name] == 0.0:
                del entry[name]
    text = json.dumps([ship.name, numbers, effects], sort_keys=True)
    return sha256_hex(text.encode())[:16]


def _same_ship(manifest: Manifest, ship: Ship, where: str) -> None:
    if manifest.ship_name != ship.name:
        raise WrongShip(
            f"{where}: made for the ship {manifest.ship_name!r}, this one is {ship.name!r}. Give "
            "its own residual, or none"
        )
    if manifest.ship_hash and manifest.ship_hash != ship_hash(ship):
        raise WrongShip(
            f"{where}: made for {ship.name!r} with another model (hash {manifest.ship_hash}, now "
            f"{ship_hash(ship)}). "
            'Train it again with `twin train`, or run without it (residual.file = "none")'
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
        raise ResidualError(
            f"{where}: the network holds {what}; allowed operators: {', '.join(sorted(OPERATORS))}"
        )
    opset = found.opsets.get("", found.opsets.get("ai.onnx", 0))
    if opset != manifest.opset or opset not in OPSETS:
        raise ResidualError(
            f"{where}: opset {opset}, the manifest says {manifest.opset}, {OPSETS[0]} to "
            f"{OPSETS[-1]} can be used"
        )
    wanted = [("input", found.inputs, len(manifest.inputs)), ("output", found.outputs, manifest.features)]
    for what, tensors, size in wanted:
        shapes = [(kind, shape) for _, kind, shape in tensors]
        if shapes != [(FLOAT, [1, size])]:
            said = ", ".join(f"element type {kind} shape {shape}" for kind, shape in shapes) or "none"
            raise ResidualError(
                f"{where}: {what} is {said}; one of element type {FLOAT} (float32) shape [1, "
                f"{size}] is needed"
            )
    return found.inputs[0][0], found.outputs[0][0]


def _golden(trunk: Network, manifest: Manifest, where: str) -> None:
    """Golden inputs must give golden outputs; the trunk is closed afterwards."""
    for zeta, wanted in manifest.golden:
        phi = trunk.run(list(zeta))
        size = max(1.0, *(abs(w) for w in wanted))
        worst = max(abs(p - w) if isfinite(p) else inf for p, w in zip(phi, wanted, strict=True))
        if not worst <= GOLDEN * size:
            raise ResidualError(
                f"{where}: a golden input gives another output than in training (off by {num(worst, 3)})"
            )
    trunk.close()
