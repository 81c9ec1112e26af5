"""Training: it learns what was planted, says so, is the same twice, goes on where it was, and writes what the
twin can read."""

import hashlib
import json
from dataclasses import replace

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed: pip install 'shiptwin[train]'")
pytest.importorskip("onnx", reason="onnx is not installed: pip install 'shiptwin[train]'")

from export import to_onnx, train  # noqa: E402
from export.batches import shuffled, zeta_of  # noqa: E402
from export.residual_network import ResidualNetwork  # noqa: E402
from export.settings import TrainingSettings  # noqa: E402
from export.teach import device, prepared, teach  # noqa: E402
from export.training_course import TrainingCourse  # noqa: E402
from tests.thorough import thorough  # noqa: E402
from twin.cli import main  # noqa: E402
from twin.errors import ThresholdError  # noqa: E402
from twin.live.learning import residual as live  # noqa: E402
from twin.physics.state import Situation  # noqa: E402
from twin.report.training_page import training_page  # noqa: E402
from twin.study.reference.sailed import Sailed  # noqa: E402
from twin.study.track.track import track  # noqa: E402

FEW = TrainingSettings(epochs=3, rollout_epochs=2, rollout_lengths=0.75)


@pytest.fixture(scope="module")
def learned(ship, sailed, tmp_path_factory):
    path = tmp_path_factory.mktemp("learned") / "residual.onnx"
    made = []
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(
            to_onnx, "trunk", lambda network, trunk=to_onnx.trunk: (made.append(network), trunk(network))[1]
        )
        return path, train.learn(ship, sailed, FEW, [42], path), made[0].state_dict()


def test_it_says_that_a_planted_weakness_was_worth_learning(learned):
    """Test: a rudder 20 % weaker than the ship file says. Expected: held-out free runs better beyond
    chance."""
    assert learned[1]["held_out"]["worth_having"] and "is worth having" in learned[1]["verdict"]
    errors = learned[1]["held_out"]["position_mae_m"]
    assert errors["with_residual"] < 0.7 * errors["physics"]


def test_its_page_shows_the_curves_the_proof_by_horizon_and_the_bound(learned):
    """Expected: a point for each epoch; with the residual the place is better at every horizon; the bound is the
    manifest's."""
    result = learned[1]
    assert [row[0] for row in result["curve"]] == ["acceleration"] * 3 + ["rollout"] * 2
    leads = result["held_out"]["by_horizon"]
    assert [r["horizon_s"] for r in leads] == sorted(r["horizon_s"] for r in leads) and len(leads) >= 2
    assert all(r["position_m"]["with_residual"] < r["position_m"]["physics"] for r in leads)
    table = json.loads(learned[0].with_suffix(".json").read_text())
    assert result["bounds"].items() <= table.items() and "curve" not in table["training"]
    page = training_page(result)
    assert page.count("<polyline") == 4 and result["verdict"][1:] in page


def test_torch_and_onnx_runtime_agree_to_1e_6(learned):
    assert learned[1]["torch_onnx_difference"] <= 1e-6


def test_the_twin_reads_the_two_files(learned, ship):
    """Expected: hash, golden vectors, shapes and ship are as the loop wants them."""
    found = live.load(learned[0], ship)
    assert found.manifest.training["seed"] == 42
    assert len(found.manifest.spectral_norms) == 4


def test_the_twin_says_what_the_training_says(learned, ship, parts):
    """Test: a situation in the middle of the data, through both. Expected: the same f."""
    model = parts[1]
    table = json.loads(learned[0].with_suffix(".json").read_text())
    again = ResidualNetwork(ship, table["training"]["inputs"], parts[0]["train"][0].state[:, :5])
    again.load_state_dict(learned[2])
    s = Situation(psi=0.5, u=6.5, v=0.1, r=0.001, delta=0.1, n=1.6)
    model.forces(s, model.water(s))
    on_board = live.load(learned[0], ship).features(s)
    t = Situation(
        **{n: torch.tensor([getattr(s, n)]) for n in ("psi", "u", "v", "r", "delta", "n", "u_r", "v_r")}
    )
    f = again.f(again.zeta(t))[0].tolist()
    assert on_board.weight == pytest.approx(float(again.weight(again.zeta(t))), abs=1e-6)
    assert on_board.trained == pytest.approx(f, abs=1e-5)


def test_the_same_seed_gives_the_same_weights_and_an_interrupted_training_goes_on(parts, tmp_path):
    """Test: stop after two epochs, start again. Expected: bit for bit what an uninterrupted training
    gives."""
    settings = replace(FEW, loss="acceleration", epochs=4)
    whole = teach(*parts, settings)

    def stop(stage, epoch, *_):
        if epoch == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        teach(*parts, settings, stop, tmp_path / "kept.pt")
    again = teach(*parts, settings, None, tmp_path / "kept.pt")
    assert _digest(again.network) == _digest(whole.network)
    assert [row[1] for row in again.curve] == [0, 1, 2, 3]


@pytest.mark.parametrize(("there", "expected"), [(True, "cuda"), (False, "cpu")])
def test_the_gpu_is_chosen_when_there_is_one(there, expected, monkeypatch):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: there)
    assert device().type == expected


def test_a_training_moves_to_the_chosen_device_and_comes_back(parts, monkeypatch):
    """Test: a device that stands in for a GPU ("meta" has no numbers), and stages that only look. Expected:
    network and data are there while they run, the network is called back, and the samples it is judged with
    never left."""
    seen = []
    monkeypatch.setattr("export.teach.device", lambda: torch.device("meta"))
    monkeypatch.setattr("export.training_course._key", lambda settings, data: "")
    monkeypatch.setattr(
        TrainingCourse, "run", lambda course, stage: seen.append((course.network, course.data["train"]))
    )
    monkeypatch.setattr(
        ResidualNetwork, "cpu", lambda network: seen.append({p.device.type for p in network.parameters()})
    )
    monkeypatch.setattr(ResidualNetwork, "bind", lambda network, zeta: None)
    for place in ("export.teach.zeta_of", "export.training_course.zeta_of"):
        monkeypatch.setattr(place, lambda network, data: data.d)
    taught = teach(*parts, replace(FEW, loss="acceleration"))
    network, data = seen[0]
    assert {data.samples.d.device.type, data.windows.start.device.type} | seen[-1] == {"meta"}
    assert taught.network is network and taught.samples.d.device.type == "cpu"


@pytest.mark.parametrize("stage", ["paper", "acceleration", "rollout"])
def test_a_batch_does_not_mix_two_devices(parts, stage):
    """Test: a batch forward and back on the stand-in for a GPU. Expected: torch finds no tensor on another
    device."""
    away, settings = torch.device("meta"), replace(FEW, mirror=0.1)
    data = prepared(*parts, settings)
    probe = ResidualNetwork(
        parts[1].ship,
        ("surge", "sway", "yaw", "rudder", "propeller"),
        np.ones((3, 5)) * [[0.0], [0.5], [1.0]],
    ).to(away)
    probe.bound = torch.tensor(float("inf"))  # asked for its value, which nothing on "meta" has
    course = object.__new__(TrainingCourse)
    course.network, course.model, course.settings, course.weight = probe, parts[1], settings, torch.ones(8)
    course.data = {part: one.on(away) for part, one in data.items()}
    course.zeta = {part: zeta_of(probe, one.samples) for part, one in course.data.items()}
    course.size = course.jump = torch.ones(3, device=away)
    k = torch.arange(4)
    if stage == "paper":
        with pytest.raises(RuntimeError, match="item"):  # as far as its diagnostics, which are numbers
            course._loss(stage, "train", k)
        return
    value = course._loss(stage, "train", k) + course._penalty(k)
    value.backward()
    assert {p.grad.device.type for p in probe.parameters()} == {"meta"}


def _digest(network):
    return hashlib.sha256(b"".join(x.numpy().tobytes() for x in network.state_dict().values())).hexdigest()


def test_a_residual_that_does_not_help_is_refused(ship, sailed, tmp_path, monkeypatch):
    """Test: a network that was hardly trained. Expected: exit code 3, no file."""
    monkeypatch.setattr(train, "read_all", lambda paths, ship, tell: sailed)
    parser = train.argparse.ArgumentParser()
    train.add_arguments(parser)
    args = parser.parse_args(
        [
            "v.mcap",
            "--ship",
            "kvlcc2",
            "-o",
            str(tmp_path / "r.onnx"),
            "--loss",
            "acceleration",
            "--epochs",
            "0",
        ]
    )
    with pytest.raises(ThresholdError, match="not worth having"):
        train.run(args)
    assert not list(tmp_path.iterdir())


def test_golden_vectors_and_units_are_in_the_manifest(learned, parts):
    table = json.loads(learned[0].with_suffix(".json").read_text())
    assert {entry["unit"] for entry in table["inputs"]} == {"-", "rad"}
    assert len(table["golden"]["inputs"]) >= 2 and len(table["golden"]["outputs"][0]) == 64
    assert table["training"]["voyages"] and table["training"]["held_out"]["windows"] > 0


def test_voyages_recorded_at_other_rates_come_on_one_grid(ship, sailed):
    """Test: one voyage with every second sample. Expected: all tracks get its step."""
    v = sailed[0].voyage
    slow = v.with_rows(v.time_s[::2], {name: x[::2] for name, x in v.columns.items()})
    mixed = [sailed[1], Sailed(slow, track(slow, ship), "slow")]
    assert [t.h for t in train.on_one_grid(mixed, ship)] == pytest.approx([4.0, 4.0])


@thorough
def test_it_learns_from_voyages_that_came_through_twin_import(ship, sailed, tmp_path, capsys):
    """Test: five CSV files -> twin import -> twin train. Expected: exit code 0, and two files that the twin
    takes."""
    paths = []
    for one in sailed[:5]:
        csv, out = tmp_path / f"{one.voyage.name}.csv", tmp_path / f"{one.voyage.name}.mcap"
        columns = {"time_s": one.voyage.time_s} | dict(one.voyage.columns)
        rows = [
            ",".join(columns),
            *(",".join(f"{x:.9g}" for x in row) for row in zip(*columns.values(), strict=True)),
        ]
        csv.write_text("\n".join(rows) + "\n")
        assert main(["import", str(csv), "--ship", "kvlcc2", "-o", str(out)]) == 0
        paths.append(str(out))
    output = tmp_path / "r.onnx"
    assert (
        main(
            [
                "train",
                *paths,
                "--ship",
                "kvlcc2",
                "-o",
                str(output),
                "--loss",
                "acceleration",
                "--epochs",
                "30",
            ]
        )
        == 0
    )
    assert "is worth having" in capsys.readouterr().out
    assert live.load(output, ship).manifest.training["voyages"]


def test_a_voyage_in_heavy_sea_counts_no_more_than_a_calm_one(parts):
    """Test: one of four teaching voyages shaken three times as hard as its neighbours scatter. Expected: its
    weight falls, the mean of all weights stays one, and no weight is more than ten times another."""
    split_parts, model = parts
    first, *others = split_parts["train"]
    rng = np.random.default_rng(2)
    shaken = replace(first, rate=first.rate + 3.0 * first.rate.std(0) * rng.standard_normal(first.rate.shape))

    def weights(legs):
        data = prepared({"train": legs, "validation": split_parts["validation"]}, model, FEW)
        torch.manual_seed(1)
        probe = ResidualNetwork(
            model.ship,
            ("surge", "sway", "yaw", "rudder", "propeller"),
            np.ones((3, 5)) * [[0.0], [0.5], [1.0]],
        )
        return TrainingCourse(probe, model, FEW, data, lambda *_: None, None)._weights("acceleration")

    calm, rough = weights([first, *others]), weights([shaken, *others])
    assert float(rough.mean()) == pytest.approx(1.0, abs=1e-5)
    assert rough[0] < 0.5 * calm[0] and rough.max() / rough.min() < 10.01


def test_little_data_is_taught_in_smaller_batches_and_not_in_fewer_steps(parts):
    """Test: the four voyages, and a quarter of them. Expected: fifty steps an epoch of either."""
    split_parts, model = parts
    for legs in (split_parts["train"], split_parts["train"][:1]):
        data = prepared({"train": legs, "validation": split_parts["validation"]}, model, FEW)
        network = ResidualNetwork(
            model.ship,
            ("surge", "sway", "yaw", "rudder", "propeller"),
            np.ones((3, 5)) * [[0.0], [0.5], [1.0]],
        )
        course = TrainingCourse(network, model, FEW, data, lambda *_: None, None)
        many, batch = course._amount("acceleration")
        assert many == len(data["train"].samples) and batch <= FEW.batch
        assert len(list(shuffled(many, batch, 1))) >= 50
