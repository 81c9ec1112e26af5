"""What is drawn of a channel, in a real browser: what was sampled seldom is a line all the same, what was lost is a
gap, and the marks of an axis are told from each other."""

import numpy as np
import pytest

from tests.report.test_series import placed_every
from twin import report
from twin.physics.model import Model
from twin.study.prediction.open_loop_comparison import compare

# of the drawings in a panel of this name: which part of the pixel columns right of the axis shows its line
DRAWN = """((name) => {{
  const root = document.documentElement.style, panel = [...document.querySelectorAll("#plots .panel")]
    .find((p) => p.querySelector("b")?.textContent === name);
  root.setProperty("--measured", "#ff0000"); root.setProperty("--residual", "#ff0000");
  root.setProperty("--model", "#0000"); drawAll();
  return [...panel.querySelectorAll("canvas")].map((c) => {{
    const {{ data, width, height }} = c.getContext("2d").getImageData(LEFT, 0, c.width - LEFT, c.height);
    const red = (x) => Array.from({{ length: height }}, (_, y) => 4 * (y * width + x))
      .some((i) => data[i] > data[i + 1] + 60 && data[i] > data[i + 2] + 60 && data[i + 3] > 60);
    return Array.from({{ length: width }}, (_, x) => red(x)).filter(Boolean).length / width;
  }});
}})({name!r})"""


@pytest.fixture(scope="module")
def voyage():
    """Half an hour, positions each 20 s, waves each 10 min, the draught said once, and the speed lost for 5 min."""
    from tests.study.conftest import voyage

    made = placed_every(voyage(seconds=1500.0), 16)
    t, columns = made.time_s, dict(made.columns)
    seldom = np.arange(t.size) % 480 == 0
    columns["wave_height_significant_m"] = np.where(seldom, 1.0 + 1e-3 * t, np.nan)
    columns["draught_mean_m"] = np.where(np.arange(t.size) == 700, 20.8, np.nan)
    columns["surge_velocity_mps"] = np.where((t > 600.0) & (t < 900.0), np.nan, columns["surge_velocity_mps"])
    return made.with_rows(t, columns)


@pytest.fixture(scope="module")
def page(tab, voyage, tmp_path_factory):
    from tests.study.conftest import ship
    from twin.study.reference.sailed import Sailed
    from twin.study.track.track import track

    path, model = tmp_path_factory.mktemp("page") / "page.html", Model.of(ship())
    sailed = Sailed(voyage, track(voyage, ship()), voyage.name)
    result = compare([sailed], model).result | {"files": {"ship": "alma.toml", "voyages": ["m.mcap"]}}
    report.write(path, "compare", result, [sailed.track], model, voyages=[voyage])
    tab.size(1200, 900)
    tab.leave()
    tab.open(f"{path.as_uri()}#theme=light")
    tab.wait("document.documentElement?.dataset.readyMs")
    return tab


def test_positions_each_20_s_are_a_line_and_so_is_what_is_left_over(page):
    measured, left_over = page.value(DRAWN.format(name="north"))
    assert measured > 0.95 and left_over > 0.8  # which begins anew every 120 s


def test_waves_each_10_min_are_a_line_and_a_draught_said_once_is_a_dot(page):
    """Expected: a line from the first wave to the last, at 1200 s of 1500; a dot that is seen."""
    (waves,) = page.value(DRAWN.format(name="wave height significant"))
    (draught,) = page.value(DRAWN.format(name="draught mean"))
    assert waves == pytest.approx(0.8, abs=0.02)
    assert 1e-3 < draught < 0.01


def test_what_was_lost_for_minutes_is_a_gap(page):
    (lost, _), (whole, _) = (page.value(DRAWN.format(name=n)) for n in ("surge velocity", "heading"))
    assert whole > 0.95 and lost == pytest.approx(0.8, abs=0.03)


def test_the_value_beside_the_cursor_is_there_wherever_the_line_is(page):
    """Test: the cursor 5 min after a wave was said. Expected: that wave, and of the surge lost then none."""
    said = page.value(
        "(() => { point(900 - 100); return [...document.querySelectorAll('#plots .panel')].map((p) =>"
        " [p.querySelector('b')?.textContent, p.querySelector('.value')?.textContent]); })()"
    )
    values = {name: text.split("\n")[0].split()[1] for name, text in said if name}
    assert values["wave height significant"] == "1.602" and values["surge velocity"] == "–"
    assert values["heading"] != "–"


# what is written on a canvas beside its lines while it is drawn
WRITTEN = """((draw) => {{
  const told = [], pen = CanvasRenderingContext2D.prototype, real = pen.fillText;
  pen.fillText = function (text, ...at) {{ told.push(text); return real.call(this, text, ...at); }};
  draw(); pen.fillText = real; return told;
}})({draw})"""


def test_the_marks_of_an_axis_are_told_from_each_other(page):
    """Test: a panel whose line changes by 5 mm. Expected: no mark of its axis stands twice."""
    told = page.value(
        "(() => { const t = new Float64Array([0, 900]), y = new Float64Array([57.690, 57.695]), before = view.panels.length;"
        " plot(200, [{ data: { t, y }, colour: 'model' }], { label: 'x' }); const panel = view.panels.pop();"
        " document.body.append(panel.box);"
        f" const told = {WRITTEN.format(draw='() => panel.draw()')};"
        " panel.box.remove(); return told; })()"
    )
    assert len(told) > 4 and len(set(told)) == len(told) and "57.691" in told


NAMES = {
    "port.pwm_us": ["port pwm", "us"],
    "port.rate_rev_s": ["port rate", "1/s"],
    "port.thrust_n": ["port thrust", "N"],
    "port.angle_rad": ["port angle", "rad"],
    "port.pitch_ratio": ["port pitch ratio", ""],
    "wave_period_peak_s": ["wave period peak", "s"],
    "yaw_rate_degps": ["yaw rate", "deg/s"],
}


def test_every_channel_is_named_with_its_unit(page):
    assert page.value(f"{list(NAMES)}.map(named)") == list(NAMES.values())


def test_the_heat_strip_of_one_window_is_coloured_to_the_end_of_the_voyage(page):
    """Test: one window that begins at 25 s of 100. Expected: its colour in the last three quarters of the strip."""
    share = page.value(
        "(() => { const heat = { t: [25], rows: [{ name: 'north_m', y: [16] }] }, kept = [view.from, view.to];"
        " const before = view.watchers.length, c = heatStrip({ name: 'one', start_s: 0, end_s: 100, heat });"
        " document.querySelector('section').append(c); [view.from, view.to] = [0, 100];"
        " view.watchers[before](); view.watchers.length = before; [view.from, view.to] = kept;"
        " const { data, width } = c.getContext('2d').getImageData(210, 10, c.width - 210, 1);"
        " const at = Array.from({ length: width }, (_, x) => 4 * x).filter((i) => data[i] > data[i + 1] + 60);"
        " c.remove(); return at.length / width; })()"
    )
    assert share == pytest.approx(0.75, abs=0.02)
