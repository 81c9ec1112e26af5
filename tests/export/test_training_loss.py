"""The losses of the training: what they are nothing of, and what they count."""

import pytest

torch = pytest.importorskip("torch", reason="torch is not installed: pip install 'shiptwin[train]'")

from export import training_loss  # noqa: E402
from export.batches import input_names, samples  # noqa: E402
from export.settings import TrainingSettings  # noqa: E402
from export.teach import teach  # noqa: E402
from tests.thorough import thorough  # noqa: E402
from twin.live.learning.learned_force import scale_of  # noqa: E402
from twin.physics.model import Model  # noqa: E402
from twin.physics.state import Force  # noqa: E402


@thorough
def test_the_papers_R_is_nothing_whatever_the_network_says(parts):
    """Expected: R by automatic differentiation is zero (it holds by construction), while f is not:
    lambda_phys pulls at nothing."""
    taught = teach(*parts, TrainingSettings(loss="paper", epochs=1, rollout_lengths=0.75))
    assert taught.diagnostics["R"] < 0.02 * taught.diagnostics["f"]


def test_physics_alone_explains_a_ship_that_is_as_her_file_says(parts):
    """Expected: M nu_dot less the forces is zero for accelerations that the model itself gave."""
    split_parts, model = parts
    data = samples(split_parts["test"], model, input_names(split_parts["test"]))
    s = data.situation(slice(0, 50))
    rates = torch.stack(list(model.nu_dot(s)), -1)
    scale = torch.tensor(scale_of(model.ship))
    assert training_loss.left_over(model, s, rates, scale).abs().max() < 1e-3


def test_what_the_core_says_itself_is_penalised_whole(parts):
    """Test: f made of the core's own columns, and f across them. Expected: all of it, and next to nothing."""
    g = torch.Generator().manual_seed(3)
    columns = torch.randn(200, 3, 4, generator=g)
    inside = columns.sum(-1)
    assert float(training_loss.orthogonal(inside, columns)) == pytest.approx(
        float((inside**2).sum() / 200), rel=1e-4
    )
    across = torch.randn(200, 3, generator=g)
    assert float(training_loss.orthogonal(across, columns)) < 0.1 * float((across**2).sum() / 200)


def test_a_learned_force_is_that_of_the_middle_of_its_step(ship):
    """Test: a moment that follows the rudder, which swings; steps of 4, 2 and 0.125 s. Expected: half the
    step, a quarter of the error (a force held from each step's beginning gives a half)."""
    model, seconds = Model.of(ship), 60.0

    def heading(h):
        t = torch.arange(0.0, seconds + h / 2, h, dtype=torch.float64)
        inputs = {
            "delta": 0.3 * torch.sin(t / 8.0)[:, None],
            "n": torch.full((len(t), 1), 1.6, dtype=torch.float64),
        }
        start = torch.tensor([[0.0, 0.0, 0.0, 7.0, 0.0, 0.0]], dtype=torch.float64)
        run = training_loss.free_run(
            lambda s: Force(0.0 * s.u, 0.0 * s.u, 3e9 * s.delta),
            model,
            start,
            inputs,
            torch.tensor([h], dtype=torch.float64),
        )
        return float(run[-1, 0, 2])

    fine = heading(0.125)
    coarse, half = abs(heading(4.0) - fine), abs(heading(2.0) - fine)
    assert coarse / half > 3.0
