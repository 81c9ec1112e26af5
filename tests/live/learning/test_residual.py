"""A residual proves itself or stays out (M1-M7, M9, M13): every corruption is caught before its first use."""

import contextlib
import hashlib
import itertools
import json
import random

import pytest

from twin.live.learning import manifest as manifests
from twin.live.learning import residual as residuals
from twin.live.learning.learned_force import LearnedForce
from twin.live.learning.manifest import hashed
from twin.live.learning.onnx_file import look
from twin.live.learning.residual import MARGIN, ResidualError, WrongShip, check, load, ship_hash
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load as load_ship
from twin.physics.state import Situation

PATH = residuals.Path(residuals.ships.__file__).parent.parent / "ships" / "kvlcc2.residual.onnx"


@pytest.fixture(scope="module")
def parts():
    return PATH.read_bytes(), PATH.with_suffix(".json").read_bytes()


def edited(parts, **changes):
    """The same model with another manifest, which is whole."""
    return parts[0], json.dumps(hashed(json.loads(parts[1]) | changes)).encode()


def with_model(parts, model):
    """Another model whose hash the manifest knows."""
    return edited((model, parts[1]), sha256=hashlib.sha256(model).hexdigest())


def refusal(parts, ship):
    with pytest.raises(ResidualError) as error:
        check(*parts, ship)
    return str(error.value)


def ahead(ship, u=0.8, r=0.1, delta=0.1):
    s = Situation(u=u * ship.U_0, r=r * ship.U_0 / ship.L_pp, delta=delta, n=1.0)
    return s, list(Model.of(ship).known(s).values())


def test_the_bundled_residual_belongs_to_the_bundled_ship_and_is_whole(kvlcc2):
    residual = load(PATH, kvlcc2)
    assert residuals.bundled(kvlcc2) == PATH
    assert residual.features(ahead(kvlcc2)[0]).weight == 1.0


def test_M1_a_missing_file_is_named(kvlcc2, tmp_path):
    with pytest.raises(ResidualError, match="No such file"):
        load(tmp_path / "none.onnx", kvlcc2)


def test_M2_every_flipped_bit_of_the_model_is_caught(kvlcc2, parts):
    model, text = parts
    dice = random.Random(1)
    for _ in range(300):
        at = dice.randrange(8 * len(model))
        flipped = bytearray(model)
        flipped[at // 8] ^= 1 << at % 8
        with pytest.raises(ResidualError, match="bytes changed"):
            check(bytes(flipped), text, kvlcc2)


def content(manifest):
    """Everything it says, its own hash apart."""
    return (
        manifest.W,
        manifest.inputs,
        manifest.golden,
        manifest.whitening,
        manifest.W_max,
        manifest.output_bound,
        manifest.force_scale,
        manifest.ship_hash,
    )


def test_M2_every_flipped_bit_of_the_manifest_is_caught_or_changes_nothing(kvlcc2, parts):
    """Test: 4000 flips. Expected: refused in one line, or the same content (a space, the name of the hash);
    never a changed number."""
    _, text = parts
    dice, whole = random.Random(2), content(manifests.parse(text))
    accepted = 0
    for _ in range(4000):
        at = dice.randrange(8 * len(text))
        flipped = bytearray(text)
        flipped[at // 8] ^= 1 << at % 8
        try:
            found = manifests.parse(bytes(flipped))
        except manifests.ManifestError as error:
            assert "\n" not in str(error)
            continue
        accepted += 1
        assert content(found) == whole
    assert accepted < 400


def test_M2_a_changed_last_layer_inside_its_bound_is_caught(kvlcc2, parts):
    table = json.loads(parts[1])
    table["W"][1][7] += 1e-3
    assert "not what was written" in refusal((parts[0], json.dumps(table).encode()), kvlcc2)


def test_a_manifest_of_an_earlier_version_is_used_and_said(kvlcc2, parts):
    table = json.loads(parts[1])
    assert check(*parts, kvlcc2).note == ""
    del table["manifest_sha256"]
    assert "no hash of its own" in check(parts[0], json.dumps(table).encode(), kvlcc2).note


def test_M3_a_golden_output_that_is_not_met_is_caught(kvlcc2, parts):
    golden = json.loads(parts[1])["golden"]
    golden["outputs"][1][5] += 0.1
    assert "another output" in refusal(edited(parts, golden=golden), kvlcc2)


@pytest.mark.parametrize(
    "field, value, words",
    (
        ("features", 32, "W: 64 numbers, 32 expected"),
        ("onnx_opset", 11, "opset 17, the manifest says 11"),
        ("output_bound", -1.0, "positive"),
        ("W_max", 1e-6, "norm"),
        ("force_scale", {"X_N": 10**400, "Y_N": 1.0, "N_Nm": 1.0}, "X_N = 1000"),
        ("spectral_norms", [10**400], "spectral_norms: not all are finite numbers"),
        ("sha256", "", "text"),
        ("schema_version", 2, "schema_version"),
        ("force_scale", {"X_N": 1.0, "Y_N": 0.0, "N_Nm": 1.0}, "positive"),
        ("golden", {"inputs": [], "outputs": []}, "golden"),
        ("inputs", [{"name": "sruge", "scale": 1, "offset": 0, "low": 0, "high": 1}], "Did you mean 'surge'"),
    ),
)
def test_M3_M4_a_manifest_that_cannot_be_right_is_named_by_field(kvlcc2, parts, field, value, words):
    assert words in refusal(edited(parts, **{field: value}), kvlcc2)


def hand_made(make_nodes, inputs=((1, 5),), outputs=((1, 64),), kind=1, weights=(), opset=17):
    from onnx import helper

    ins = [helper.make_tensor_value_info(f"in{i}", kind, shape) for i, shape in enumerate(inputs)]
    outs = [helper.make_tensor_value_info(f"out{i}", kind, shape) for i, shape in enumerate(outputs)]
    graph = helper.make_graph(make_nodes(helper), "g", ins, outs, list(weights))
    return helper.make_model(
        graph, opset_imports=[helper.make_opsetid("", opset)], ir_version=8
    ).SerializeToString()


@pytest.mark.parametrize(
    "what, words",
    (
        (
            {"inputs": ((1, 6),)},
            "input is element type 1 shape [1, 6]; one of element type 1 (float32) shape [1, 5]",
        ),
        ({"outputs": ((1, 63),)}, "shape [1, 63]"),
        ({"inputs": ((5,),)}, "shape [5]"),
        ({"kind": 11}, "element type 11"),
        ({"opset": 9}, "opset 9"),
        ({"inputs": ((1, 5), (1, 5))}, "shape [1, 5], element type 1 shape [1, 5]"),
    ),
)
def test_M4_a_model_of_the_wrong_form_is_named_with_what_is_needed(kvlcc2, parts, what, words):
    model = hand_made(lambda h: [h.make_node("Identity", ["in0"], ["out0"])], **what)
    assert words in refusal(with_model(parts, model), kvlcc2)


def test_M4_M9_operators_that_could_ask_for_memory_or_files_are_refused(kvlcc2, parts):
    bomb = hand_made(lambda h: [h.make_node("ConstantOfShape", ["in0"], ["out0"])])
    assert "ConstantOfShape" in refusal(with_model(parts, bomb), kvlcc2)
    own = hand_made(lambda h: [h.make_node("Gemm", ["in0", "in0"], ["out0"], domain="evil")])
    assert "evil::Gemm" in refusal(with_model(parts, own), kvlcc2)


def test_M9_weights_in_another_file_are_refused(kvlcc2, parts):
    from onnx import TensorProto

    outside = TensorProto(name="w", data_type=1, dims=[5, 64], data_location=TensorProto.EXTERNAL)
    outside.external_data.add(key="location", value="../../etc/passwd")
    model = hand_made(lambda h: [h.make_node("MatMul", ["in0", "w"], ["out0"])], weights=[outside])
    assert "weights outside the file" in refusal(with_model(parts, model), kvlcc2)


def test_M5_weights_that_are_no_numbers_are_caught_by_the_golden_check(kvlcc2, parts):
    import numpy as np
    from onnx import numpy_helper

    w = numpy_helper.from_array(np.full((5, 64), np.nan, np.float32), "w")
    model = hand_made(lambda h: [h.make_node("MatMul", ["in0", "w"], ["out0"])], weights=[w])
    assert "another output" in refusal(with_model(parts, model), kvlcc2)


def test_M5_a_network_that_gives_no_number_is_off_at_once_and_says_so(kvlcc2, parts):
    import numpy as np
    from onnx import numpy_helper

    w = numpy_helper.from_array(np.ones((5, 64), np.float32), "w")
    nodes = lambda h: [h.make_node("MatMul", ["in0", "w"], ["h"]), h.make_node("Div", ["h", "h"], ["out0"])]
    golden = {"inputs": [[1.0] * 5, [2.0] * 5], "outputs": [[1.0] * 64] * 2}
    table = json.loads(parts[1])
    inputs = [entry | {"offset": 0.0, "low": -9.0, "high": 9.0} for entry in table["inputs"]]
    model = with_model(parts, hand_made(nodes, weights=[w]))
    residual = check(*edited(model, golden=golden, inputs=inputs), kvlcc2)
    assert residual.features(ahead(kvlcc2)[0]).weight == 1.0
    s = Situation(u=0.0, r=0.0, delta=0.0, n=0.0, u_r=0.0, v_r=0.0)
    assert residual.network.run([0.0] * 5)[0] != residual.network.run([0.0] * 5)[0]  # NaN
    assert "not finite" in residual.features(s).why and residual.features(s).weight == 0.0


@pytest.mark.parametrize(
    "data", (b"", b"\x00", b"\xff" * 64, b"not a model at all", b"\x3a\xff\xff\xff\xff\x0f")
)
def test_M4_bytes_that_are_no_model_are_refused(kvlcc2, parts, data):
    assert "residual" in refusal(with_model(parts, data), kvlcc2)


def test_looking_at_garbage_never_raises_anything_but_its_own_error():
    from twin.live.learning.onnx_file import OnnxError

    dice = random.Random(3)
    for _ in range(3000):
        data = dice.randbytes(dice.randrange(60))
        with contextlib.suppress(OnnxError):
            look(data)


def test_M13_a_residual_of_another_ship_or_model_is_never_used(kvlcc2, parts):
    with pytest.raises(WrongShip, match="made for the ship 'KVLCC2'"):
        check(*parts, load_ship("usv"))
    with pytest.raises(WrongShip, match="another model"):
        check(*parts, kvlcc2.with_derivatives(X_uu=-0.03))
    assert ship_hash(kvlcc2) == ship_hash(load_ship("kvlcc2"))
    # made before the core knew two sides of a rudder's inflow
    assert ship_hash(kvlcc2) == json.loads(parts[1])["ship"]["hash"]
    with pytest.raises(WrongShip, match="another model"):
        check(*parts, kvlcc2.with_derivatives(gamma_a=-0.1))
    drag, harder = find("CrossFlowDrag")(c_d=0.3), find("CrossFlowDrag")(c_d=0.3, c_mid=0.1)
    # before drag had a place along the hull
    assert (
        ship_hash(kvlcc2.with_effects(drag)) == "2869635e5d42bc0d" != ship_hash(kvlcc2.with_effects(harder))
    )


def test_M7_outside_its_envelope_the_learned_force_shrinks_smoothly_to_nothing(kvlcc2):
    learned = LearnedForce(kvlcc2, load(PATH, kvlcc2))
    high = learned.residual.manifest.inputs[2].high  # yaw
    low = learned.residual.manifest.inputs[2].low
    weights = [
        learned.at(*ahead(kvlcc2, r=high + k / 20.0 * MARGIN * (high - low))).weight for k in range(25)
    ]
    assert weights[0] == 1.0 and weights[20:] == [0.0] * 5
    assert all(a >= b for a, b in itertools.pairwise(weights)) and 0.2 < weights[10] < 0.3
    assert "yaw" in learned.at(*ahead(kvlcc2, r=2.0 * high)).why


def test_M7_an_input_that_is_not_measured_is_named(kvlcc2, parts):
    entry = {"name": "roll", "scale": 1.0, "offset": 0.0, "low": -1.0, "high": 1.0}
    table = json.loads(parts[1])
    residual = check(*edited(parts, inputs=[*table["inputs"][:4], entry]), kvlcc2)
    assert residual.features(ahead(kvlcc2)[0]).why == "its input roll is not measured"


def test_M6_an_absurd_last_layer_is_cut_to_the_ball(kvlcc2, parts):
    table = json.loads(parts[1])
    big = [[1e4 * w for w in row] for row in table["W"]]
    learned = LearnedForce(kvlcc2, check(*edited(parts, W=big, W_max=1e9), kvlcc2))
    found = learned.at(*ahead(kvlcc2))
    assert found.clipped and sum(x * x for x in found.shadow) ** 0.5 == pytest.approx(learned.bound)
    assert abs(found.force.Y) <= found.bound_N and abs(found.force.N) <= found.bound_Nm


def test_the_output_agrees_with_the_python_binding(kvlcc2, parts):
    import numpy as np
    import onnxruntime

    residual = load(PATH, kvlcc2)
    zeta = [0.3, -0.2, 0.1, 0.4, 0.0]
    phi = (
        onnxruntime.InferenceSession(parts[0])
        .run(None, {"zeta": np.array([zeta], np.float32)})[0][0]
        .astype(float)
    )
    m = residual.manifest
    wanted = [*(np.array(m.W) @ phi), *(np.array(m.whitening[1]) @ (phi - np.array(m.whitening[0])))]
    assert residual.network.run(zeta) == pytest.approx(wanted, abs=1e-5)
