"""The page of a result that needs no track: a sentence, what to heed, bars and tables, in one file without a
script."""

from collections.abc import Collection, Mapping, Sequence
from html import escape
from importlib import resources
from typing import Any, NamedTuple

from twin.num import as_given, num
from twin.report.curves import Curves, Drawings
from twin.report.curves import drawn as curves_drawn
from twin.report.curves import legend as curves_legend

WIDE, HIGH = 640, 22  # of the drawing, and of one bar with what stands beside it [px]
NAMED, ENDS = 210, 470  # where the bars begin, and where the longest ends
COLOURS = ("var(--before)", "var(--model)", "var(--noise)")


class Bars(NamedTuple):
    """One drawing: a group of bars for each row, a bar for each of `of` (key -> what it is called) that it
    has."""

    caption: str
    unit: str
    label: str  # the key that names a row
    of: Mapping[str, str]
    rows: Sequence[Mapping[str, Any]]


class PageTable(NamedTuple):
    """Rows of one kind; `columns`: key -> heading, with its unit; `given`: the keys of what was declared."""

    caption: str
    columns: Mapping[str, str]
    rows: Sequence[Mapping[str, Any]]
    given: Collection[str] = ()


Part = Bars | PageTable | Curves | Drawings


def result_page(title: str, sentence: str, heed: Sequence[str] = (), parts: Sequence["Part"] = ()) -> str:
    """One self-contained HTML page. `heed`: what the owner should know of it, a line each."""
    style = _with_dark((resources.files(__package__) / "page.css").read_text(encoding="utf-8"))
    notes = "".join(f'<p class="note">{escape(text)}</p>' for text in heed)
    body = [f'<section><div class="head"><h2>To heed</h2></div>{notes}</section>'] if heed else []
    body += [_section(part) for part in parts if _has(part)]
    said = f'<div class="eyebrow">{escape(title)}</div><h1>{escape(sentence)}</h1>'
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>{style}</style>\n</head>\n<body>\n"
        f"<main><header><div>{said}</div></header>{''.join(body)}</main>\n</body>\n</html>\n"
    )


def _with_dark(style: str) -> str:
    """The style, dark on a screen that its owner keeps dark: there is no script here that could choose."""
    dark = style.partition(':root[data-theme="dark"]')[2].partition("}")[0]
    return f"{style}@media screen and (prefers-color-scheme: dark) {{ :root {dark}}} }}"


def _section(part: Part) -> str:
    key = curves_legend(part) if isinstance(part, Curves) else ""
    return f'<section><div class="head"><h2>{escape(part.caption)}</h2>{key}</div>{_drawn(part)}</section>'


def _has(part: Part) -> bool:
    if isinstance(part, Drawings):
        return bool(part.each)
    return bool(part.lines if isinstance(part, Curves) else part.rows)


def _drawn(part: Part) -> str:
    if isinstance(part, Drawings):
        each = "".join(f"<div><h3>{escape(one.caption)}</h3>{curves_drawn(one)}</div>" for one in part.each)
        return f'<div class="small">{each}</div>'
    if isinstance(part, Curves):
        return _scrolled(part.caption, curves_drawn(part))
    return _bars(part) if isinstance(part, Bars) else _table(part)


def _table(table: PageTable) -> str:
    names = table.columns
    numeric = {k for k in names if any(_is_number(row.get(k)) for row in table.rows)}
    side = {k: " class=n" * (k in numeric) for k in names}
    heads = "".join(f"<th{side[k]}>{escape(v)}</th>" for k, v in names.items())
    cells = [
        "".join(f"<td{side[k]}>{_cell(row.get(k), k in table.given)}</td>" for k in names)
        for row in table.rows
    ]
    rows = "".join(f"<tr>{row}</tr>" for row in cells)
    return _scrolled(f"Table: {', '.join(names.values())}", f"<table><tr>{heads}</tr>{rows}</table>")


def _scrolled(name: str, inner: str) -> str:
    """What may be wider than a phone, and is scrolled there by finger or arrow keys."""
    return f'<div class="scroll" tabindex="0" role="group" aria-label="{escape(name)}">{inner}</div>'


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _cell(value: Any, given: bool = False) -> str:
    """A count or what was `given` with all its digits, else three."""
    if value is None or value == "":
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, float):
        return escape(str(value))
    return as_given(value) if given else num(value, 3)


def _bars(bars: Bars) -> str:
    """Bars from the left, their numbers at their ends; a row without any number is left out."""
    told = [row for row in bars.rows if any(_is_number(row.get(k)) for k in bars.of)]
    most = max((abs(row[k]) for row in told for k in bars.of if _is_number(row.get(k))), default=0.0) or 1.0
    out, y = [], 0
    for row in told:
        out.append(f'<text x="0" y="{y + 15}" fill="var(--soft)">{_cell(row[bars.label])}</text>')
        for colour, (key, name) in zip(COLOURS, bars.of.items(), strict=False):
            if not _is_number(row.get(key)):
                continue
            long = max(1.0, (ENDS - NAMED) * abs(row[key]) / most)
            out.append(f'<rect x="{NAMED}" y="{y + 4}" width="{long:.1f}" height="14" fill="{colour}"/>')
            said, at = f"{num(row[key], 3)} {bars.unit} {name}".strip(), f"{NAMED + long + 8:.1f}"
            out.append(f'<text x="{at}" y="{y + 15}" fill="var(--ink)">{escape(said)}</text>')
            y += HIGH
        y += HIGH // 3
    said = escape(f"{bars.caption} {bars.unit}: a bar for each row".replace("  ", " "))
    begin = f'<svg class="bars" viewBox="0 0 {WIDE} {y}" font-size="13" role="img" aria-label="{said}">'
    return _scrolled(bars.caption, f"{begin}{''.join(out)}</svg>")
