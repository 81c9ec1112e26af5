"""A residual's manifest: what its network is, for which ship, on which inputs it may be believed, and how
to prove it is whole.

The format is described in docs/residual.md; `export` writes it, `residual.py` believes nothing that it has
not checked. Its own hash is of its content and not of its bytes, so that it may be written out in another
way:

    manifest_sha256 = SHA-256 of the table without that entry, as JSON with sorted keys and no spaces
"""

import json
import sys
from dataclasses import dataclass
from typing import Any

from twin.checksum import sha256_hex
from twin.errors import SettingsError, did_you_mean
from twin.num import as_given
from twin.physics.state import Force
from twin.physics.zeta import ZETA

SCHEMA_VERSION = 1
MAX_BYTES = 2_000_000
MAX_FEATURES = 256
OWN_HASH = "manifest_sha256"


class ManifestError(SettingsError):
    """A manifest that cannot be used."""


@dataclass(frozen=True)
class Input:
    """One input: the network sees (zeta - offset)/scale; outside [low, high] (zeta's own unit) it was not
    trained."""

    name: str
    scale: float
    offset: float
    low: float
    high: float


@dataclass(frozen=True)
class Manifest:
    """The checked content of the file; `whitening` holds (mean of phi, rows of components) or None."""

    sha256: str
    opset: int
    inputs: tuple[Input, ...]
    features: int
    W: tuple[tuple[float, ...], ...]
    W_max: float
    force_scale: Force
    output_bound: float
    ship_name: str
    ship_hash: str
    golden: tuple[tuple[tuple[float, ...], tuple[float, ...]], ...]
    whitening: tuple[tuple[float, ...], tuple[tuple[float, ...], ...]] | None
    spectral_norms: tuple[float, ...]
    training: dict[str, Any]
    hashed: bool  # its own hash was there and fits; the first manifests had none


def own_hash(table: dict[str, Any]) -> str:
    """What `manifest_sha256` must be for this table."""
    bare = {name: value for name, value in table.items() if name != OWN_HASH}
    return sha256_hex(json.dumps(bare, sort_keys=True, separators=(",", ":")).encode())


def hashed(table: dict[str, Any]) -> dict[str, Any]:
    """The table with its own hash in it, ready to be written."""
    return table | {OWN_HASH: own_hash(table)}


def _whole(table: dict[str, Any]) -> bool:
    """Whether its own hash fits; False where there is none."""
    said = table.get(OWN_HASH)
    if said is None:
        return False
    try:
        fits = said == own_hash(table)
    except RecursionError:
        fits = False
    if not fits:
        raise ManifestError(f"its content is not what was written ({OWN_HASH} does not fit). Copy it again")
    return True


def parse(data: bytes) -> Manifest:
    """The manifest of these bytes; ManifestError says which field is wrong and how."""
    if len(data) > MAX_BYTES:
        raise ManifestError(f"{len(data)} bytes, at most {MAX_BYTES} expected")
    try:
        table = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise ManifestError(f"not JSON ({error})") from None
    if not isinstance(table, dict) or table.get("schema_version") != SCHEMA_VERSION:
        raise ManifestError(f"schema_version is not {SCHEMA_VERSION}")
    whole = _whole(table)
    features = _count(table, "features", MAX_FEATURES)
    inputs = tuple(_input(entry) for entry in _list(table, "inputs"))
    training = table.get("training")
    scale, ship = _table(table, "force_scale"), _table(table, "ship")
    return Manifest(
        sha256=_word(table, "sha256"),
        opset=_count(table, "onnx_opset", 64),
        inputs=inputs,
        features=features,
        W=_matrix(table.get("W"), 3, features, "W"),
        W_max=_positive(table, "W_max"),
        force_scale=Force(_positive(scale, "X_N"), _positive(scale, "Y_N"), _positive(scale, "N_Nm")),
        output_bound=_positive(table, "output_bound"),
        ship_name=_word(ship, "name"),
        ship_hash=str(ship.get("hash") or ""),
        golden=_golden(_table(table, "golden"), len(inputs), features),
        whitening=_whitening(table.get("whitening"), features),
        spectral_norms=_vector(table.get("spectral_norms", []), None, "spectral_norms"),
        training=training if isinstance(training, dict) else {},
        hashed=whole,
    )


def _input(entry: Any) -> Input:
    if not isinstance(entry, dict) or entry.get("name") not in ZETA:
        name = entry.get("name") if isinstance(entry, dict) else entry
        raise ManifestError(f"input {name!r} is not known.{did_you_mean(str(name), ZETA)}")
    made = Input(entry["name"], *(_number(entry, key) for key in ("scale", "offset", "low", "high")))
    if made.scale <= 0.0 or made.low >= made.high:
        raise ManifestError(f"input {made.name}: scale must be positive and low below high")
    return made


def _golden(table: dict[str, Any], inputs: int, features: int) -> tuple[Any, ...]:
    asked, answers = table.get("inputs"), table.get("outputs")
    if not isinstance(asked, list) or not isinstance(answers, list):
        raise ManifestError("golden: lists of inputs and outputs are needed")
    if len(asked) != len(answers) or len(asked) < 2:
        raise ManifestError(
            f"golden: {len(asked)} inputs and {len(answers)} outputs; two or more pairs are needed"
        )
    return tuple(
        (_vector(z, inputs, "golden.inputs"), _vector(phi, features, "golden.outputs"))
        for z, phi in zip(asked, answers, strict=True)
    )


def _whitening(table: Any, features: int) -> tuple[tuple[float, ...], tuple[tuple[float, ...], ...]] | None:
    if not isinstance(table, dict):
        return None
    rows = table.get("components")
    count = len(rows) if isinstance(rows, list) else 0
    if not 1 <= count <= 16:
        raise ManifestError(f"whitening.components has {count} rows, 1 to 16 expected")
    mean = _vector(table.get("mean"), features, "whitening.mean")
    return mean, _matrix(rows, count, features, "whitening.components")


def _matrix(value: Any, rows: int, columns: int, name: str) -> tuple[tuple[float, ...], ...]:
    if not isinstance(value, list) or len(value) != rows:
        raise ManifestError(f"{name}: {rows} rows expected")
    return tuple(_vector(row, columns, name) for row in value)


def _vector(value: Any, size: int | None, name: str) -> tuple[float, ...]:
    if not isinstance(value, list) or (size is not None and len(value) != size):
        found = len(value) if isinstance(value, list) else "no"
        raise ManifestError(f"{name}: {found} numbers, {size} expected")
    if not all(map(_finite, value)):
        raise ManifestError(f"{name}: not all are finite numbers")
    return tuple(float(x) for x in value)


def _number(table: dict[str, Any], key: str) -> float:
    value: Any = table.get(key)
    if not _finite(value):
        raise ManifestError(f"{key} = {value!r:.60}: a finite number is needed")
    return float(value)


def _finite(value: Any) -> bool:
    """Whether it is a number that a float can hold."""
    return type(value) in (int, float) and abs(value) <= sys.float_info.max


def _positive(table: dict[str, Any], key: str) -> float:
    value = _number(table, key)
    if value <= 0.0:
        raise ManifestError(f"{key} = {as_given(value)}: must be positive")
    return value


def _count(table: dict[str, Any], key: str, most: int) -> int:
    value = table.get(key)
    if type(value) is not int or not 1 <= value <= most:
        raise ManifestError(f"{key} = {value!r}: a whole number from 1 to {most} is needed")
    return value


def _word(table: dict[str, Any], key: str) -> str:
    value = table.get(key)
    if not isinstance(value, str) or not value:
        raise ManifestError(f"{key} = {value!r}: a text is needed")
    return value


def _list(table: dict[str, Any], key: str) -> list[Any]:
    value = table.get(key)
    if not isinstance(value, list) or not value:
        raise ManifestError(f"{key}: a list is needed")
    return value


def _table(table: dict[str, Any], key: str) -> dict[str, Any]:
    value = table.get(key)
    if not isinstance(value, dict):
        raise ManifestError(f"{key}: a table is needed")
    return value
