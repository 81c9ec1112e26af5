"""A tanker's model in an open pond with measured wind, of the open data set FRT-DS-ESSO."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from bench.decisions.question import KnownCase, begun, kept
from twin.physics.ship import Ship, load
from twin.recording.map_file import read_map
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage
from twin.study.calibration.core_fit import calibrate
from twin.study.reference.sailed import Sailed
from twin.study.track.track import track

MAP = Path(__file__).parents[2] / "docs" / "maps" / "esso_osaka.toml"
ESSO = {  # the model of FRT-DS-ESSO, 1/108.33
    "length_pp_m": 3.0,
    "beam_m": 0.489,
    "draught_m": 0.201,
    "block_coefficient": 0.83,
    "x_g_m": 0.094,
    "service_speed_mps": 0.4,
    "shaft_speed_rpm": 840.0,
    "propeller_diameter_m": 0.084,
    "pitch_ratio": 0.715,
    "rudder_area_m2": 0.0102,
}


CALMEST = ("13_04", "13_14", "13_29", "14_08_51", "14_17")
WINDY = ("13_22", "13_42", "13_57", "14_10", "14_29", "14_39", "15_06", "15_21")


def in_the_pond(folder: Path, runs: Path) -> Iterator[KnownCase]:
    """Runs of a tanker's model in an open pond with measured wind, which the model does not know, or does (as
    calibration found it)."""
    paths = {
        run: next(p for p in sorted(runs.glob("*.csv")) if run in p.name and "random" not in p.name)
        for run in (*CALMEST, *WINDY)
    }

    def ship() -> Ship:
        voyages = [pond_voyage(paths[run]) for run in CALMEST]
        start = begun_esso(folder / "ships" / "esso.start.toml")
        sailed = [Sailed(v, track(v, start), v.name) for v in voyages]
        return calibrate(sailed, [(sailed[-1].track, 0)], start).ship

    def without() -> Ship:
        whole = kept(folder / "ships" / "esso", ship)
        return replace(whole, effects=tuple(e for e in whole.effects if type(e).__name__ != "Wind"))

    for run in WINDY:
        for name, which in (("", without), (" knows Wind", lambda: kept(folder / "ships" / "esso", ship))):
            truth = {"hidden": {"Wind": 1.0}, "knows": "Wind" if name else ""}
            yield KnownCase(
                f"esso {run}{name}", truth, lambda run=run, which=which: (which(), [pond_voyage(paths[run])])
            )  # type: ignore[misc]


def pond_voyage(path: Path) -> Voyage:
    """One run, read through its map."""
    return read_voyage(path, read_map(MAP))


def begun_esso(path: Path) -> Ship:
    """The model as its main particulars have it, before any calibration."""
    return load(path) if path.exists() else begun("Esso Osaka", ESSO, path)
