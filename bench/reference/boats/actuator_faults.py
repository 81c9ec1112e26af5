"""What may be hidden in one named drive: `worn.port` 0.18 (it gives less of everything: with its screw the
rudder behind it), `screw.port` 0.18 (the screw alone, and what its race makes of the rudder), `late.port`
0.3 s, `zero.port` 0.05 of full, `turned.aft_port` 6 deg, `lost.port` (it gives nothing, and its feedback says
as it was told), `silent.port` (nothing is recorded of it from half a minute on)."""

from dataclasses import dataclass

from bench.reference.boats.craft import Craft, Drive

FAULT_SIZES = {
    "worn": 0.18,
    "screw": 0.18,
    "late": 0.3,
    "zero": 0.05,
    "turned": 6.0,
    "lost": 1.0,
    "silent": 1.0,
}
SILENT_FROM_S = 30.0


@dataclass
class State:
    """Of one drive: share of its push that is lost, share of its screw's alone, seconds that it is late, what
    its zero is off by (share of full, rad), whether it is not recorded."""

    worn: float = 0.0
    screw: float = 0.0
    late: float = 0.0
    zero: float = 0.0
    turned: float = 0.0
    silent: bool = False


def hidden_in(craft: Craft, effects: tuple[tuple[str, float], ...]) -> dict[str, State]:
    """By drive; ValueError names what there is none of."""
    states = {d.name: State() for d in craft.drives}
    for text, size in effects:
        what, _, name = text.partition(".")
        if what not in FAULT_SIZES or name not in states:
            raise ValueError(
                f"{text!r} is nothing that a {craft.name} can hide: one of {', '.join(FAULT_SIZES)}, a dot, "
                f"and one of {', '.join(states)}."
            )
        _put(states[name], next(d for d in craft.drives if d.name == name), what, size)
    return states


def _put(state: State, drive: Drive, what: str, size: float) -> None:
    if what == "turned":
        if "angle_deg" not in drive.records:
            raise ValueError(f"turned.{drive.name}: it has no angle. Hide another effect.")
        state.turned = size * 0.0174532925
    elif what == "screw" and drive.kind == "jet":
        raise ValueError(f"screw.{drive.name}: a jet has no screw in the stream. Hide worn.{drive.name}.")
    elif what == "lost":
        state.worn = size
    elif what == "silent":
        state.silent = True
    else:
        setattr(state, what, size)
