"""The peers compute what they claim to, and the yardsticks are what they say."""

import math

import numpy as np
import pytest

from bench.tick import cortex, counted, instructions, nbody, peers, random_lstm
from bench.tick.ekf import ShipFilter
from bench.tick.memory import memory
from bench.tick.ort import session
from bench.tick.timing import hot_us, quantiles
from tests.thorough import thorough
from twin.live.loop import Loop
from twin.physics.model import Model
from twin.physics.ship import load


@pytest.fixture(scope="module")
def ship():
    return load(peers.SHIP)


def test_an_lstm_that_carries_its_state_says_what_one_that_is_re_run_says():
    """Test: 50 inputs at once and one by one. Expected: the same output, so both are the same network."""
    x = np.random.default_rng(3).standard_normal((50, 1, random_lstm.INPUTS)).astype(np.float32)
    whole = session(random_lstm.lstm_bytes(False)).run(["y"], {"x": x})[0]
    one = session(random_lstm.lstm_bytes(True))
    names = [f"{s}{layer}" for layer in range(random_lstm.LAYERS) for s in "hc"]
    carried = {name: np.zeros((1, 1, random_lstm.HIDDEN), np.float32) for name in names}
    for row in x:
        y, *state = one.run(["y", *(f"{n}_out" for n in names)], {"x": row[None]} | carried)
        carried = dict(zip(names, state, strict=True))
    assert np.allclose(y, whole, atol=1e-5)


def test_the_lstm_has_two_layers_of_128():
    """Expected: 4 gates x 128 x (inputs + 128) weights and 8 x 128 biases a layer, and the last layer."""
    import onnx
    from onnx import numpy_helper

    tensors = onnx.load_from_string(random_lstm.lstm_bytes(False)).graph.initializer
    numbers = sum(numpy_helper.to_array(t).size for t in tensors if not t.name.startswith("axis"))
    n = random_lstm.HIDDEN
    layers = 4 * n * (random_lstm.INPUTS + n) + 8 * n + 4 * n * (n + n) + 8 * n
    assert numbers == layers + random_lstm.OUTPUTS * n + random_lstm.OUTPUTS


def test_the_filter_finds_a_disturbance_that_no_known_force_explains(ship):
    """Test: a ship pushed aside by 1 cm/s2 beyond its model. Expected: the filter says so within 20 %."""
    s = peers.situation(ship)
    model = Model.of(ship)
    peer, push = ShipFilter(model, peers.situation(ship), 0.1), 0.01
    truth = (0.0, 0.0, 0.0, s.u, s.v, s.r)
    for _ in range(1500):
        ahead = model.step(truth, s, 0.1)
        truth = (*ahead[:4], ahead[4] + push * 0.1, ahead[5])
        peer.tick(np.array(truth))
    assert peer.x[7] == pytest.approx(push, rel=0.2)


def test_an_ensemble_of_equal_ships_goes_where_one_goes(ship):
    one = peers.look_ahead(ship, 1, 1.0)()
    many = peers.look_ahead(ship, 3, 1.0)()  # the one in the middle is not varied
    assert [float(x[1]) for x in (many.x, many.y, many.psi)] == pytest.approx([one.x, one.y, one.psi])


def test_steps_of_a_second_end_within_two_centimetres_of_steps_of_a_tenth(ship):
    """Expected: that is what lets a look-ahead of 64 ships fit into a second."""
    fine, coarse = (peers.look_ahead(ship, 1, h)() for h in (0.1, 1.0))
    assert abs(fine.x - coarse.x) + abs(fine.y - coarse.y) < 0.02


def test_every_peer_runs(ship):
    for make in peers.PEERS.values():
        assert quantiles(hot_us(make(ship), 5, warm_up=1))["median"] > 0


def test_quantiles_are_values_that_were_measured():
    found = quantiles(range(1000))
    assert found == {"median": 500, "p99": 990, "p999": 999, "max": 999}
    assert quantiles([7.0])["p999"] == 7.0


def test_memory_is_split_in_anonymous_and_file_backed_parts():
    now = memory()
    assert now.peak_mb >= now.now_mb
    assert now.anon_mb + now.file_mb == pytest.approx(now.now_mb, rel=0.02)


def test_on_a_cortex_a72_nothing_is_scaled():
    found = cortex.estimate(300.0, 900.0, "CPU implementer : 0x41\nCPU part\t: 0xd08\n")
    assert found["factor"] == 1.0 and found["step_ms_p999"] == 0.9


def test_elsewhere_the_estimate_lies_between_its_ends():
    found = cortex.estimate(1000.0, 2000.0, "model name : another\n")
    assert found["factor_low"] == 2.6 and found["factor_high"] == 6.8
    low, high = found["step_ms_median_range"]
    assert low < found["step_ms_median"] < high


def test_the_yardstick_conserves_momentum():
    """Expected: what the bodies pull on each other sums to nothing, so the program is the N-body problem."""
    bodies = [([0.0, 0.0, 0.0], [0.0, 0.0, 0.0], 3.0), ([1.0, 0.5, 0.2], [0.1, 0.0, 0.3], 0.5)]
    before = [sum(v[i] * m for _, v, m in bodies) for i in range(3)]
    nbody._advance(bodies, [tuple(bodies)], 100)
    assert [sum(v[i] * m for _, v, m in bodies) for i in range(3)] == pytest.approx(before)


@thorough
@pytest.mark.skipif(not instructions.available(), reason="valgrind is not installed")
def test_instruction_counts_repeat(tmp_path):
    """Expected: two runs differ by less than a thousandth (where a home folder lies moves a few hundred)."""
    running = [instructions.start(instructions.VALGRIND, "analytic", 3, str(tmp_path)) for _ in range(2)]
    first, second = map(instructions.total, running)
    assert first == pytest.approx(second, rel=1e-3)


def test_what_is_counted_runs_as_a_whole():
    """Expected: after a second the tick that is counted runs on measurements, and the network answers."""
    step = counted.tick()
    ticks = [step() for _ in range(30)]
    assert ticks[-1].mode in ("hybrid", "physics only")
    assert len(counted.network()()) > 0


def test_the_twins_step_beside_the_peers_does_all_the_work():
    """Test: 120 s of it. Expected: the estimate follows the measurements, the network acts, and it
    learns."""
    step = counted.hybrid(6000)
    e = [step() for _ in range(6000)][-1]
    loop = next(c.cell_contents for c in step.__closure__ if isinstance(c.cell_contents, Loop))
    assert e.ready and e.u == pytest.approx(7.0, abs=0.1)
    assert e.r == pytest.approx(0.006 * math.cos(0.06 * 119.98), abs=2e-3)
    assert any(loop.learned.evidence.trained)
    assert loop.learned.adaptation.updates > 100, loop.learned.adaptation.frozen
