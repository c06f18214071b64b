"""The results as one HTML page: a table, bars with intervals, and the clips side by side, playing in step."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path
from urllib.parse import quote

from .columns import Column, Summary
from .paper_figures import NOTE, PAPER_TABLES
from .planning import left_out
from .results import ClipResult, MethodResult, Results, Value, shown_number

__all__ = ["as_html"]

_ARROWS = {"lower": " ↓", "higher": " ↑", None: ""}
_ARROWS_SAY = {"lower": "lower is better", "higher": "higher is better", None: "neither is better"}
_ASSETS = Path(__file__).parent / "page"
_WIDTH = 100.0  # of a bar's drawing [%]
_DASH = "&ndash;"
_TOOLS = """<p class="tools"><label>Speed <select id="speed"><option value="1">1 &times;</option>
<option value="0.5">1/2 &times;</option><option value="0.25">1/4 &times;</option></select></label>
<label>Width <input id="width" type="range" min="120" max="960" value="300"></label>
<kbd>space</kbd> plays and halts, <kbd>,</kbd> <kbd>.</kbd> go by a frame</p>"""
_PAPER_HEADS = {"fid": "FID ↓", "vsvq": "VSVQ ↑", "vstc": "VSTC ↑", "vsdd": "VSDD ↑", "vsfc": "VSFC ↑"}


def as_html(results: Results, figures: Sequence[str] = ()) -> str:
    """The page, which shows the clips beside it.

    Args:
        results: what was found.
        figures: names of pictures in ``figures/``.
    """
    columns = [each for each in results.columns if any(row.values[each.key] is not None for row in results.rows)]
    style, script = ((_ASSETS / name).read_text(encoding="utf-8") for name in ("report.css", "report.js"))
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{escape(results.title)}</title><style>{style}</style></head><body>",
        f"<header><h1>{escape(results.title)}</h1><p>{_facts(results)}</p></header>",
        *_notes(results),
        "<section><h2>Means over pictures</h2>",
        "<p>With 95 % intervals from a bootstrap over pictures. The best of a column is bold, among methods with as"
        " many pictures.</p>",
        *_table(results, columns),
        *_paper(),
        "</section><section><h2>Bars</h2><div class='charts'>",
        *(each for column in columns for each in _chart(results, column)),
        "</div></section>",
        *_figures(figures),
        "<section><h2>Clips</h2>",
        *_clips(results),
        "</section>",
        f"<script>{script}</script></body></html>",
    ]
    return "\n".join(parts) + "\n"


def _facts(results: Results) -> str:
    clips = sum(len(each.clips) for each in results.rows)
    return (
        f"{len(results.rows)} methods, {len(results.pictures)} pictures with {results.samples}"
        f" sample{'s' * (results.samples > 1)} each, {clips} clips."
    )


def _notes(results: Results) -> Iterator[str]:
    """What is empty or was left out, and why."""
    if not (results.missing or results.absent):
        return
    yield "<details open><summary>What is left out</summary><ul>"
    titles = {each.key: each.title for each in results.columns}
    for key, name in results.missing.items():
        yield f"<li>Column <b>{escape(titles[key])}</b> is empty: {escape(name)} is not at hand.</li>"
    for who, why in left_out(results.absent):
        yield f"<li><b>{escape(who)}</b>: {escape(why)}.</li>"
    yield "</ul></details>"


def _table(results: Results, columns: Sequence[Column]) -> Iterator[str]:
    yield "<div class='wide'><table><thead><tr><th>Method</th>"
    for each in columns:
        unit = f" <small>[{escape(each.unit)}]</small>" if each.unit else ""
        about = f"{each.meaning} ({_ARROWS_SAY[each.better]})"
        yield f'<th title="{escape(about)}">{escape(each.title)}{_ARROWS[each.better]}{unit}</th>'
    yield "</tr></thead><tbody>"
    best = {each.key: results.best(each) for each in columns}
    for row in results.rows:
        yield f"<tr><th>{escape(row.name)}</th>"
        yield from (_cell(results, row.values[each.key], row.name in best[each.key]) for each in columns)
        yield "</tr>"
    yield "</tbody></table></div>"


def _cell(results: Results, value: Value, best: bool) -> str:
    if isinstance(value, str):
        return f'<td class="none" title="not at hand: {escape(value)}">{_DASH}</td>'
    if value is None or value.mean is None:
        return f'<td class="none">{_DASH}</td>'
    number = shown_number(value.mean)
    number = f"<b>{number}</b>" if best else number
    notes = []
    if value.low is not None and value.high is not None:
        notes.append(f"{shown_number(value.low)} {_DASH} {shown_number(value.high)}")
    notes += [note] if (note := results.few(value)) else []
    return f"<td>{number}{''.join(f'<br><small>{each}</small>' for each in notes)}</td>"


def _paper() -> Iterator[str]:
    yield f"<details><summary>The paper's own figures</summary><p>{escape(NOTE)}</p>"
    for table in PAPER_TABLES:
        keys = [each for each in _PAPER_HEADS if any(each in row for row in table.rows.values())]
        yield f"<table class='paper'><caption>{escape(table.title)}</caption><thead><tr><th>Method</th>"
        yield "".join(f"<th>{_PAPER_HEADS[key]}</th>" for key in keys) + "</tr></thead><tbody>"
        for name, row in table.rows.items():
            yield f"<tr><th>{escape(name)}</th>" + "".join(f"<td>{row[key]:g}</td>" for key in keys) + "</tr>"
        yield "</tbody></table>"
    yield "</details>"


def _chart(results: Results, column: Column) -> Iterator[str]:
    """A bar for each method, with its interval."""
    known = [
        (row, value)
        for row in results.rows
        if isinstance(value := row.values[column.key], Summary) and value.mean is not None
    ]
    if not known:
        return
    ends = [end for _, value in known for end in (value.mean, value.high) if end is not None]
    scale = _WIDTH / max(max(ends), 1e-12)
    unit = f" [{escape(column.unit)}]" if column.unit else ""
    yield f"<figure class='chart'><figcaption>{escape(column.title)}{_ARROWS[column.better]}{unit}</figcaption>"
    for row, value in known:
        yield from _bar(row, value, scale)
    yield "</figure>"


def _bar(row: MethodResult, value: Summary, scale: float) -> Iterator[str]:
    mean = value.mean or 0.0
    yield f"<div class='bar'><span>{escape(row.name)}</span><div class='track'>"
    yield f"<i style='width:{max(0.0, mean * scale):.2f}%'></i>"
    if value.low is not None and value.high is not None:
        low, high = max(0.0, value.low * scale), value.high * scale
        yield f"<u style='left:{low:.2f}%;width:{max(0.2, high - low):.2f}%'></u>"
    yield f"</div><em>{shown_number(mean)}</em></div>"


def _figures(figures: Sequence[str]) -> Iterator[str]:
    if not figures:
        return
    yield "<section><h2>Figures</h2>"
    for name in figures:
        yield f'<img loading="lazy" src="figures/{quote(name)}" alt="{escape(name)}">'
    yield "</section>"


def _clips(results: Results) -> Iterator[str]:
    """For each picture and sample the clips of all methods."""
    yield _TOOLS
    for picture in results.pictures:
        for sample in range(results.samples):
            found = [(row, each) for row in results.rows for each in row.clips if _is(each, picture, sample)]
            if not found:
                continue
            name = escape(picture) + (f", sample {sample}" if results.samples > 1 else "")
            yield f"<section class='group'><h3>{name}</h3><div class='controls'><button type='button'>❚❚</button>"
            yield "<input type='range' min='0' max='1' step='any' value='0' aria-label='time'></div><div class='clips'>"
            for row, clip in found:
                yield f"<figure><video muted playsinline preload='none' data-src='{escape(quote(clip.file))}'></video>"
                yield f"<figcaption>{escape(row.name)}</figcaption></figure>"
            yield "</div></section>"


def _is(clip: ClipResult, picture: str, sample: int) -> bool:
    return clip.picture == picture and clip.sample == sample
