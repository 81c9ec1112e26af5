"""Where certificates are kept: on file, by a mark of all that they depend on."""

import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from twin import whole
from twin.checksum import sha256_hex
from twin.errors import TwinError
from twin.live.certificate.certificate import VERSION, Certificate, certify
from twin.live.certificate.plant import usual_disturbance
from twin.physics.model import Model


def kept(
    path: str | os.PathLike[str], model: Model, K: float | Sequence[float] | None, h: float, **settings: Any
) -> Certificate:
    """The certificate from its file if it is of this ship, K and settings; else worked out and, where
    possible, written there."""
    wanted = mark(model, K, h, settings)
    if found := on_file(path, wanted):
        return found
    made = replace(certify(model, K, h, **settings), fingerprint=wanted)
    # a folder one may not write to costs half a second at each start, nothing else
    with suppress(OSError, TwinError):
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        whole.write(path, made.to_json())
    return made


def on_file(path: str | os.PathLike[str], wanted: str) -> Certificate | None:
    """The certificate of that mark, if the file holds it."""
    try:
        found = Certificate.from_json(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return found if found.fingerprint == wanted else None


def mark(model: Model, *settings: Any) -> str:
    """What the certificate depends on, as a hash: the ship's numbers, its effects, the settings and the
    theorem's version."""
    ship = [(f.name, getattr(model.ship, f.name)) for f in fields(model.ship) if f.name != "notes"]
    told = repr((VERSION, ship, model.effects, usual_disturbance(model), *settings))
    return sha256_hex(told.encode())[:16]
