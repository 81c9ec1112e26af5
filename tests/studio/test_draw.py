"""What the workbench draws, asked of its own modules in a real browser."""

import pytest

from tests.report.test_plot import NAMES
from tests.studio.by_mouse import opened


@pytest.fixture(scope="module")
def page(tab, served):
    return opened(tab, served)


def drawn(page, script):
    """What a script gives that has the drawing modules; `page.said` is what went wrong meanwhile."""
    names = ("dom", "draw", "plot", "compare", "number")
    parts = ", ".join(f"{n}: await import('/app/{n}.js')" for n in names)
    return page.value(f"(async () => {{ const m = {{ {parts} }}; {script} }})()")


def test_a_voyage_without_a_predicted_position_has_words_in_place_of_a_heat_strip(page):
    """Test: no row, and the zoom moved. Expected: a sentence, and nothing thrown when the zoom asks for a drawing."""
    text = drawn(
        page,
        "const view = m.plot.timeView(), heat = { t: new Float32Array([0, 10]), rows: [] };"
        "const made = m.draw.heatStrip('slow', heat, view); document.body.append(made);"
        "for (const f of view.watchers) f();"
        "await new Promise((d) => setTimeout(d, 100)); made.remove(); return made.textContent;",
    )
    assert text.startswith("On slow no prediction") and not page.said


def test_the_difference_to_positions_that_were_read_seldom_is_a_line(page):
    """Test: a position each 20 s on a grid of 1 s, the prediction begun anew once. Expected: red, the line's colour, in
    all pixel columns but those between the last position before that and the first after it; nothing thrown."""
    shares = drawn(
        page,
        "document.documentElement.style.setProperty('--model', '#ff0000');"
        "const packed = (x) => btoa(String.fromCharCode(...new Uint8Array(new Float32Array(x).buffer)));"
        "const t = Array.from({ length: 401 }, (_, i) => i), seldom = t.filter((x) => x % 20 === 0);"
        "const left = packed(t.map((x) => (x % 20 ? NaN : Math.sin(x / 50))));"
        "const channel = { name: 'north_m', noise: 0.1, measured: { t: 1, y: packed(seldom) },"
        " lines: { model: { t: 0, y: packed(t) } }, residuals: { model: { t: 0, y: left } } };"
        "const v = { name: 'slow', grid: 0, restarts: [0, 210], times: [packed(t), packed(seldom)], inputs: [],"
        " channels: [channel], track: { x: packed(t), y: packed(t), lines: {} } };"
        "const other = { name: 'with it', y: new Float32Array(t).map((x) => x + 1), look: 'c-second' };"
        "const with_ = { lines: () => [other] };"
        "const done = [{ job: { asked: { ship: 'a.toml' } }, view: { voyages: [v], longest_s: 120 } }], out = [];"
        "for (const extra of [undefined, { ...with_, name: () => 'model', look: () => 'c-model' }]) {"
        "  const card = m.compare.seriesCard(done, v, m.plot.timeView(), extra); document.body.prepend(card);"
        "  await new Promise((d) => setTimeout(d, 400));"
        "  const c = card.querySelectorAll('canvas')[1], { data, width, height } ="
        "    c.getContext('2d').getImageData(0, 0, c.width, c.height);"
        "  const red = (x) => Array.from({ length: height }, (_, y) => 4 * (y * width + x))"
        "    .some((i) => data[i] > 200 && data[i + 1] < 90 && data[i + 2] < 90 && data[i + 3] > 100);"
        "  const seen = Array.from({ length: width }, (_, x) => x).filter(red);"
        "  out.push(seen.length / (seen.at(-1) - seen[0] + 1)); card.remove();"
        "} return out;",
    )
    assert shares == pytest.approx([0.95, 0.95], abs=0.02) and not page.said


def test_every_channel_is_named_with_its_unit_as_on_the_report(page):
    assert drawn(page, f"return {list(NAMES)}.map(m.dom.named);") == list(NAMES.values())


def test_the_marks_of_an_axis_are_told_from_each_other(page):
    """Test: a line that changes by 5 mm within 50 ms, as a chart, over time and as a picture to save. Expected: no mark
    stands twice on an axis."""
    charted, plotted, saved = drawn(
        page,
        "const x = Array.from({ length: 11 }, (_, i) => 36000 + 0.005 * i), y = x.map((_, i) => 57.69 + 5e-4 * i);"
        "const marks = (svg, side) => [...svg.querySelectorAll(`text[text-anchor=${side}]`)].map((e) => e.textContent);"
        "const both = (svg) => [marks(svg, 'end'), marks(svg, 'middle')];"
        "const wait = () => new Promise((d) => setTimeout(d, 300));"
        "const made = m.draw.chart('c', [{ name: 'a', x, y, look: 'c-model' }]); document.body.prepend(made);"
        "await wait(); const charted = both(made.querySelector('.draw svg')); made.remove();"
        "const told = [], pen = CanvasRenderingContext2D.prototype, real = pen.fillText;"
        "pen.fillText = function (text, ...at) { told.push(text); return real.call(this, text, ...at); };"
        "const line = { name: 'a', t: new Float64Array(x), y: new Float64Array(y), look: 'c-model' };"
        "const figure = m.plot.timePlot('t', [line], { view: m.plot.timeView() }); document.body.prepend(figure);"
        "await wait(); pen.fillText = real;"
        "const append = document.body.append, kept = [];"
        "document.body.append = (e) => { kept.push(both(e)); append.call(document.body, e); };"
        "[...figure.querySelectorAll('button')].find((b) => b.textContent === 'SVG').click(); await wait();"
        "delete document.body.append; figure.remove(); return [charted, [told], kept[0]];",
    )
    for axes in (charted, plotted, saved):
        for marks in axes:
            assert len(marks) > 2 and len(set(marks)) == len(marks), marks
    assert not page.said


def test_the_heat_strip_of_one_window_reaches_to_the_end_of_the_voyage(page):
    """Test: one window that begins at 20 s of 140. Expected: the times below it are those, its colour has a width."""
    times, width = drawn(
        page,
        "const packed = (x) => btoa(String.fromCharCode(...new Uint8Array(new Float32Array(x).buffer)));"
        "const heat = { t: packed([20]), rows: [{ name: 'north_m', y: packed([5]) }] };"
        "const made = m.compare.heatOf({ name: 'one', start_s: 0, end_s: 140, heat }, m.plot.timeView());"
        "document.body.prepend(made); await new Promise((d) => setTimeout(d, 100));"
        "const times = [...made.querySelectorAll('.draw text[text-anchor=middle]')].map((e) => e.textContent);"
        "const width = Number(made.querySelector('.draw rect').getAttribute('width')); made.remove();"
        "return [times, width];",
    )
    assert {"40 s", "80 s", "120 s"} <= set(times) and width > 100 and not page.said
