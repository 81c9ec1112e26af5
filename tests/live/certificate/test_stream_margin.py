"""A followed current that is wrong: what it does stays within the disturbance."""

import re
from pathlib import Path

import numpy as np
import pytest

from twin.live.certificate.certificate import certify
from twin.live.certificate.stream import stream_margin
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Situation

SAMPLES = 400
ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("hull", ["kvlcc2", "container", "usv"])
def test_a_current_that_is_wrong_by_the_margin_does_no_more_than_the_disturbance(hull):
    """Test: nu_dot at random places of the set, corners among them, with the current as it is and with one that
    is off by the margin in a random direction, outside the set at its edge. Expected: they differ by no more
    than what the calm disturbance may do."""
    model = Model.of(load(hull))
    c = certify(model, None, 0.1)
    may = np.array(c.plant.inertia) @ np.array(c.disturbance.calm)
    ranges, rng = c.operating.ranges, np.random.default_rng(7)
    most = np.zeros(3)
    for _ in range(SAMPLES):
        inside = rng.beta(0.3, 0.3, 5)  # most of them near an edge
        named = zip(("u", "v", "r", "delta", "n"), inside, strict=True)
        at = {name: ranges[name][0] + x * (ranges[name][1] - ranges[name][0]) for name, x in named}
        angle = rng.uniform(-np.pi, np.pi)
        off = stream_margin(c) * np.array([np.cos(angle), np.sin(angle)])
        right = np.array(model.nu_dot(Situation(**at)))
        wrong = np.array(model.nu_dot(Situation(**at | {"u": at["u"] - off[0], "v": at["v"] - off[1]})))
        turned = np.array([at["r"] * off[1], -at["r"] * off[0], 0.0])
        most = np.maximum(most, np.abs(wrong + turned - right))
    assert (most <= may).all()
    assert (most / may).max() > 0.2  # the margin is no number that is always small


def test_the_page_says_the_margins_of_the_bundled_ships():
    page = (ROOT / "docs/stability.md").read_text()
    said = re.search(
        r"covers c up to\s+`stream_margin`: ([\d.]+) m/s for the tanker, ([\d.]+) for the container ship, "
        r"([\d.]+) for the boat, ([\d.]+) for the model",
        page,
    )
    hulls = ("kvlcc2", "container", "usv", "kvlcc2_model")
    margins = [stream_margin(certify(Model.of(load(hull)), None, 0.1)) for hull in hulls]
    assert [float(x) for x in said.groups()] == [round(x, 2) for x in margins]
