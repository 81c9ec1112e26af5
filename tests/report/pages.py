"""Every kind of page that a verb or a result writes, made of little: what stands on it is made up here, how it is
written is not."""

from dataclasses import replace
from pathlib import Path

import twin
from bench.bundled import FOLDER
from tests.report.boat import straight_with_a_turn
from twin import cli, report
from twin.api.calibration import Calibration
from twin.api.fleet import Fleet
from twin.api.instruments import InstrumentCheck
from twin.api.tube import TubeCalibration
from twin.physics.model import Model
from twin.recording.write import write_voyage
from twin.report.history_page import history_page
from twin.report.training_page import training_page
from twin.studio.project import Project
from twin.studio.project_report import page as project_page

NUMBER = {"name": "east", "value": 0.8, "low95": 0.7, "high95": 0.9, "unit": "m/s", "in_ship_file": 0.2}
CAUSE = {
    "effect": "Current",
    "probability": 0.97,
    "parameters": [NUMBER],
    "typical_force": {"X_N": 4.1e4, "Y_N": 5.12e5, "N_Nm": 3.2e7},
    "error_without": 72.0,
    "error_with": 13.0,
    "cannot_be_told_from": ["VaryingCurrent"],
}
DATED = {"voyage": "monday", "file": "monday.mcap", "start_time_utc": "2026-05-01T08:00:00Z"}
ERRORS = [{"horizon_s": h, "before_m": 4.0 * h, "position_m": 1.0 * h, "after_m": 1.0 * h} for h in (10, 60)]


def diagnosis(name):
    forces = {"X_N": -6e4, "Y_N": 7.24e5, "N_Nm": -1.17e7}
    moment = {"voyage": name, "start_s": 60.0, "end_s": 95.0, **forces}
    curve = [NUMBER | {"name": f"east_{i}", "value": 0.1 * i} for i in range(9)]
    check = {"ok": True, "check": "clock", "text": "fine", "voyage": name}
    return {
        "schema_version": 1,
        "verdict": "missing",
        "sentence": "Missing: Current (97 %).",
        "missing": ["Current"],
        "p_value_sentence": "Against healthy voyages: this one is more unusual than each of this ship's 4 reference voyages.",
        "candidates": [
            CAUSE | {"together_sd": 6.2},
            CAUSE | {"effect": "VaryingCurrent", "parameters": curve},
        ],
        "moments": [moment],
        "data_checks": [check, check | {"ok": False}],
        "next_manoeuvre": {
            "separates": ["Current"],
            "manoeuvre": "reciprocal runs",
            "why": "it changes sign",
        },
        "command": "twin diagnose monday.mcap --ship alma.toml",
    }


def addition():
    step = {
        "date": "2026-05-01",
        "added": ["Current"],
        "errors": [r | {"noise_floor_m": 2.0} for r in ERRORS],
    }
    return {
        "accepted": True,
        "output": "b.toml",
        "parameters": {"Current": {"east": NUMBER}},
        "history": [step],
    }


def fleet():
    number = NUMBER | {"at_box_end": False}
    sizes = [DATED | number | {"named": True, "start_time_utc": f"2026-0{m}-01T08:00:00Z"} for m in (4, 5)]
    said = {"lasting": True, "belongs_to": "ship", "named_on": 2, "of_voyages": 2, "share_of_error": 0.5}
    cause = CAUSE | said | {"number": number, "sizes": sizes, "trend": None, "since": DATED}
    months = {"references": 0, "voyages": 0, "alarm": False, "value": 1.0}
    judged = {
        "failed": None,
        "verdict": "missing",
        "position_mae_m": 12.0,
        "position_expected_m": 4.0,
        "p_value": 0.04,
    }
    voyage = DATED | judged | {"tags": {"crew": "A"}, "causes": [cause | {"named": True}]}
    ship = {
        "rank": 1,
        "ship": "Alma",
        "file": "alma.toml",
        "state": "missing",
        "sentence": "Missing: Current.",
    }
    ship |= {"latest": DATED, "since": DATED, "causes": [cause], "over_months": months, "voyages": [voyage]}
    counts = dict.fromkeys(("weather", "unknown", "undecided", "nothing_missing", "not_asked"), 0) | {
        "missing": 2
    }
    data = {"ships": [ship, ship | {"rank": 2, "ship": "Berta"}], "counts": counts}
    voyages = {"listed": 2, "judged": 2, "references": 0, "failed": 0}
    asked = {"level": 0.1, "ships": 0, "needed": 20.0, "alarms": []}
    return Fleet(data=data | {"voyages": voyages, "over_months": asked})


def added(name, before, after, **more):
    """A step of a ship's history as `twin add` writes it."""
    errors = [
        {"horizon_s": h, "before_m": before * h / 60, "after_m": after * h / 60, "noise_floor_m": 2.0}
        | {"before_deg": 0.5, "after_deg": 0.25}
        for h in (10.0, 60.0)
    ]
    files = {"voyages": [DATED | {"name": "monday"}], "held_out": [{"name": "tuesday", "part": "last third"}]}
    proof = {"log_likelihood_ratio": 19.9, "low95": 15.3, "high95": 24.7, "needed": 3.0}
    step = {"date": "2026-05-01", "added": [name], "errors": errors, "proof": "held-out voyages"}
    return step | files | {"evidence": proof, "forced": False} | more


def with_history(ship):
    """The ship as calibrated in April, and one thing added, taken out again, and another one forced in."""
    calibrated = {"date": "2026-04-01", "voyages": [{"name": "calm", "sha256": ""}]}
    calibrated |= {"held_out": [{"horizon_s": 60.0, "position_m": 1.5, "heading_deg": 0.1, "windows": 9}]}
    steps = [
        added("Current", 21.0, 6.0, of_this_voyage=["Current"]),
        {"date": "2026-05-02", "removed": ["Current"]},
        added("Wind", 20.0, 20.0, date="2026-05-03", forced=True),
    ]
    return replace(ship, notes=dict(ship.notes) | {"structural": calibrated, "history": steps})


def training():
    """The JSON of `twin train`."""
    pair = {"physics": 4.0, "with_residual": 1.0}
    curve = [["acceleration", k, 1.0 / (k + 1), 2.0 / (k + 1)] for k in range(5)]
    limits = {"force_scale": {"X_N": 2e6, "Y_N": 2e6, "N_Nm": 6e8}, "output_bound": 0.5}
    leads = [{"horizon_s": h, "position_m": pair, "heading_deg": pair} for h in (10.0, 60.0, 120.0)]
    held = {"windows": 22, "blocks": 4, "position_ratio_95": [0.2, 0.3], "by_horizon": leads}
    return {
        "ship": "Alma",
        "verdict": "the residual is worth having",
        "held_out": held | {"worth_having": True},
        "learned_share": 0.07,
        "seeds": [42, 123],
        "seed": 123,
        "seconds": 9.7,
        "curve": curve + [["rollout", k, 0.1, 0.2] for k in range(3)],
        "bounds": limits | {"inputs": [{"name": "surge", "low": -0.1, "high": 1.2, "unit": "-"}]},
        "parts": {"train": ["monday 0"], "validation": ["monday 1"], "test": ["monday 2"]},
        "voyages": [{"name": "monday", "start_time_utc": "2026-05-01T08:00:00Z", "sha256": "ab" * 32}],
        "written": True,
        "forced": False,
    }


def replay(folder: Path):
    """What `twin replay` writes of a boat whose ship file promises a tube."""
    folder.mkdir()
    first, other = (straight_with_a_turn(folder / f"v{seed}.csv", seed) for seed in (1, 2))
    boat, log = str(folder / "boat.toml"), str(folder / "log.mcap")
    assert cli.main(["tube", first, other, "--ship", "usv", "-o", boat]) == 0
    write_voyage(twin.read_voyage(first), log)
    assert cli.main(["replay", log, "--ship", boat, "--report", str(folder / "replay.html")]) == 0
    return (folder / "replay.html").read_text()


def project(folder: Path):
    folder.mkdir()
    Project(folder).take_demo()
    return project_page(Project(folder))


def made(folder, track, model, ship):
    """Path of each page, by the name of the class that it belongs to (or of what writes it)."""
    one, other = (track(name) for name in ("monday", "tuesday"))
    tracks, voyages = [one.track, other.track], [one.voyage, other.voyage]
    write = report.write
    compared = twin.compare(ship, voyages).to_dict() | {"files": {"ship": "alma.toml", "voyages": ["m.mcap"]}}
    write(folder / "Comparison.html", "compare", compared, tracks, model, voyages=voyages)
    write(folder / "Diagnosis.html", "diagnose", diagnosis(one.track.name), tracks, model, voyages=voyages)
    write(folder / "Update.html", "add", addition(), tracks, model, before=Model.of(ship), voyages=voyages)
    number = {"name": "Y_v", "before": 1.0, "value": 1.1, "sd": 0.1, "unit": "-", "excited": True}
    held = {
        "held_out": ERRORS,
        "held_out_is": "last third",
        "by_regime": [{"regime": "straight"} | ERRORS[1]],
    }
    calibration = Calibration(ship, data=held | {"derivatives": [number], "refused": "", "doubts": ["Look."]})
    seen = {"words": "compass bias", "effect": "HeadingBias", "fault": "heading_bias", "or_instead": []}
    seen |= {"log_bayes_factor": 9.0, "log_bayes_factor_of_any": 9.0}
    told = {
        "meaning": "offset of the compass",
        "value": 1.0,
        "lo": 0.5,
        "hi": 1.5,
        "unit": "deg",
        "seen": True,
    }
    check = InstrumentCheck(None, data={"voyages": [{"name": "monday"}], "faults": [seen], "numbers": [told]})
    size = {"voyages": 9, "predictions": 90, "place_m": 12.0, "heading_deg": 2.0}
    row = {"horizon_s": 10, "level": 0.9, "regimes": [{"regime": "straight", **size}], **size}
    tube = TubeCalibration(ship, data={"horizons": [row], "doubts": ["Few voyages."], "warnings": ["Few."]})
    monday = twin.read_voyage(FOLDER / "monday.mcap")
    for found in (
        calibration,
        check,
        tube,
        fleet(),
        twin.first_model("MV Alma", 180.0, 30.0, 10.5, block_coefficient=0.8),
        twin.check_voyage(ship, monday),
        twin.check_effect("Wind"),
        twin.simulate(ship, duration_s=300.0),
    ):
        found.write_page(folder / f"{type(found).__name__}.html")
    (folder / "history.html").write_text(history_page(with_history(ship)))
    (folder / "training.html").write_text(training_page(training()))
    (folder / "replay.html").write_text(replay(folder / "boat"))
    (folder / "project.html").write_text(project(folder / "project"))
    return {path.stem: path for path in sorted(folder.glob("*.html"))}
