"""A voyage is read about the core that was fitted by steps, whichever core the ship file predicts with."""

from dataclasses import replace

import numpy as np
import pytest

from tests.thorough import thorough
from twin.commands.story import MONDAY
from twin.errors import SettingsError
from twin.physics.model import Model
from twin.recording.read import read_voyage
from twin.study.calibration import usual as baseline
from twin.study.calibration.usual import usual
from twin.study.diagnosis import assemble
from twin.study.diagnosis.assemble import of_tracks
from twin.study.estimation.columns import core_unknowns
from twin.study.reference import sailed
from twin.study.reference.derivatives import one_step_core, with_one_step_core
from twin.study.reference.structure import noise_model_of
from twin.study.track.track import track

ALONG_THE_PATH = {"Y_v": 1.3, "N_r": 0.8, "X_uu": 1.1, "kappa": 0.9}  # times what was fitted by steps


@pytest.fixture(scope="module")
def files(tanker):
    """A ship file whose core was fitted by steps, and one with another core, fitted along the path."""
    other = tanker.with_derivatives(**{n: k * float(tanker.derivative(n)) for n, k in ALONG_THE_PATH.items()})
    return tanker, _keeping(other, one_step_core(other, tanker))


@pytest.fixture(scope="module")
def tracks(tanker):
    return [track(read_voyage(MONDAY), tanker)]


@pytest.fixture(scope="module")
def cases(files, tracks):
    return [of_tracks(tracks, ship) for ship in files]


def test_only_what_differs_is_kept(files):
    by_steps, by_paths = files
    assert set(by_paths.notes["structural"]["one_step_core"]) == set(ALONG_THE_PATH)
    assert one_step_core(by_steps, by_steps) == {}
    there = with_one_step_core(by_paths)
    for n in by_paths.notes["derivatives"]:
        assert float(there.derivative(n)) == pytest.approx(float(by_steps.derivative(n)), rel=1e-12)


def test_both_files_read_a_voyage_alike(cases):
    """Else the better of two ways of fitting that predict as well decides which effect is named."""
    one, other = cases
    for a, b in zip(one.lines, other.lines, strict=True):
        for name in ("F", "defect", "A", "R"):
            assert np.allclose(getattr(a, name), getattr(b, name), rtol=1e-5, atol=1e-9), name
    nothing = [c.reduced(c.lines, [c.noise_model])[0] for c in cases]
    assert nothing[0].base == pytest.approx(nothing[1].base, abs=1e-3)
    assert np.allclose(nothing[0].b, nothing[1].b, rtol=1e-3, atol=1e-3)


def test_what_the_ship_file_predicts_with_stays_its_own_core(files, cases):
    for ship, case in zip(files, cases, strict=True):
        assert float(case.model.ship.derivative("Y_v")) == float(ship.derivative("Y_v"))
        found = case.at([], np.zeros(len(case.effects)), case.tracks[0])
        assert float(found.ship.derivative("Y_v")) == float(ship.derivative("Y_v"))


def test_a_number_that_its_owner_changes_by_hand_changes_in_both(files):
    _, by_paths = files
    edited = by_paths.with_derivatives(N_r=1.5 * float(by_paths.derivative("N_r")))
    moved = float(edited.derivative("N_r")) - float(by_paths.derivative("N_r"))
    before, after = (float(with_one_step_core(s).derivative("N_r")) for s in (by_paths, edited))
    assert after - before == pytest.approx(moved)


@thorough
def test_what_is_usual_on_the_ship_is_that_about_the_core_by_steps(files, tracks):
    """Offsets, covariance, noise and scores of the references are those about the core that they are read
    with; the errors of the path are those of the core that predicts."""
    by_steps, _ = files
    halves = [tracks[0].part(0, len(tracks[0]) // 2), tracks[0].part(len(tracks[0]) // 2, len(tracks[0]))]
    noise_model = noise_model_of(by_steps)
    one, other = (usual(ship, by_steps, halves, noise_model) for ship in files)
    assert set(other.pop("one_step_core")) == set(ALONG_THE_PATH) and not one.pop("one_step_core", {})
    assert one.pop("path_error") != other.pop("path_error")
    assert one == other


def test_without_one_of_its_voyages_the_core_that_predicts_is_moved_by_what_holds_about_itself(
    files, tracks, monkeypatch
):
    """Found on a boat whose added masses the two ways fit otherwise: moved by what holds about the core by
    steps, the core of the path ran away within two seconds."""
    seen = []
    monkeypatch.setattr(baseline, "path_errors", lambda ship, tracks, lines, *_: seen.extend(lines) or {})
    by_steps, by_paths = files
    usual(by_paths, by_steps, tracks, noise_model_of(by_steps))
    assert [float(x.model.ship.derivative("Y_v")) for x in seen] == [float(by_paths.derivative("Y_v"))]


def test_waves_are_looked_for_about_the_core_by_steps(files, monkeypatch):
    """Of the voyages that are judged as of the references."""
    by_steps, by_paths = files
    about = []
    for module in (assemble, sailed):
        monkeypatch.setattr(module, "swung", lambda t, model: about.append(model) or t)
    monkeypatch.setattr(assemble, "of_tracks", lambda tracks, *_: tracks)
    monday = read_voyage(MONDAY)
    assemble.assemble([monday], by_paths)
    sailed.sailed(monday, by_paths)
    assert [float(m.ship.derivative("Y_v")) for m in about] == 2 * [
        pytest.approx(float(by_steps.derivative("Y_v")), rel=1e-12)
    ]


@pytest.mark.parametrize("kept", [{"N_r": "x"}, 3, {"N_r": float("nan")}])
def test_a_damaged_file_is_said_in_one_line(tanker, kept):
    with pytest.raises(SettingsError, match=r"\[structural\] one_step_core .* damaged .*Calibrate it again"):
        with_one_step_core(_keeping(tanker, kept))


def test_a_number_that_its_owner_has_moved_to_the_end_of_its_box_stays_inside(tanker):
    (own,) = (u for u in core_unknowns(Model.of(tanker)) if u.name == "N_r")
    there = with_one_step_core(_keeping(tanker.with_derivatives(N_r=own.hi), {"N_r": 1.0}))
    assert float(there.derivative("N_r")) == own.hi


def _keeping(ship, kept):
    structural = ship.notes["structural"] | {"one_step_core": kept}
    return replace(ship, notes={**ship.notes, "structural": structural})
