"""The contact sheet: an HTML page with a picture, the state and the options of every shot."""

from __future__ import annotations

import html
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from urllib.parse import quote

from ..files import replacing
from .job import Outcome
from .shot import Shot

__all__ = ["write_report"]

_STYLE = """
:root { color-scheme: light dark; font: 14px/1.4 system-ui, sans-serif }
body { margin: 2em }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(240px, 1fr)); gap: 1.2em }
article { border: 1px solid #8884; border-top: 4px solid #2a7; padding: .6em; overflow-wrap: anywhere }
article.failed, article.lost, article.left { border-top-color: #c33 }
video, img { width: 100%; background: repeating-conic-gradient(#ccc 0 25%, #fff 0 50%) 0 0 / 16px 16px }
h2 { font-size: 1em; margin: .2em 0 } p { margin: .2em 0 } .why { color: #c33 }
details { font-size: .9em }
"""
_PLAYED = (".mp4", ".webm")
_PICTURES = (".gif", ".webp", ".apng")


def write_report(
    path: str, shots: Iterable[tuple[Shot, Outcome]], *, title: str, picture_of: Callable[[str], str]
) -> None:
    """Write the page; clips are linked from where they are, by paths from the page's folder on.

    Args:
        path: a name in .html.
        shots: every shot with what became of it.
        title: of the page.
        picture_of: gives the address of a small picture of a clip, such as ``data:...``; empty where there is none.

    Raises:
        OSError: it cannot be written.
    """
    known = list(shots)
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(_page(known, os.path.dirname(os.path.abspath(path)), title, picture_of))


def _page(
    shots: Sequence[tuple[Shot, Outcome]], folder: str, title: str, picture_of: Callable[[str], str]
) -> Iterator[str]:
    good = sum(outcome.is_good for _, outcome in shots)
    seconds = sum(outcome.seconds for _, outcome in shots)
    yield (
        f'<!doctype html>\n<html lang="en"><meta charset="utf-8"><title>{html.escape(title)}</title>'
        f"<style>{_STYLE}</style>\n<h1>{html.escape(title)}</h1>\n"
        f"<p>{good} of {len(shots)} shots are there; {seconds:.0f} s of work in all.</p>\n<main>\n"
    )
    for shot, outcome in sorted(shots, key=lambda each: each[1].is_good):
        yield from _article(shot, outcome, folder, picture_of)
    yield "</main></html>\n"


def _article(shot: Shot, outcome: Outcome, folder: str, picture_of: Callable[[str], str]) -> Iterator[str]:
    name = html.escape(shot.name)
    yield f'<article class="{outcome.state}"><h2>{name}</h2>\n'
    clip = next((each.text or "" for each in shot.paths("output") if each.option == "output"), "")
    if outcome.is_good:
        yield _shown(clip, folder, name, picture_of)
        yield f"<p>{outcome.state}, {outcome.seconds:.1f} s on {html.escape(outcome.machine)}</p>\n"
    else:
        yield f'<p class="why">{outcome.state}: {html.escape(outcome.why)}</p>\n'
    yield from (f"<p>{html.escape(line)}</p>\n" for line in outcome.said)
    words = " ".join(shot.command())
    yield f"<details><summary>options</summary>{html.escape(words)}</details></article>\n"


def _shown(clip: str, folder: str, name: str, picture_of: Callable[[str], str]) -> str:
    address, picture = html.escape(_address(clip, folder)), html.escape(picture_of(clip))
    suffix = os.path.splitext(clip)[1].lower()
    if suffix in _PLAYED:
        return f'<video src="{address}" poster="{picture}" preload="none" muted loop controls playsinline></video>\n'
    picture = address if suffix in _PICTURES else picture
    return f'<a href="{address}"><img src="{picture}" alt="{name}" loading="lazy"></a>\n'


def _address(clip: str, folder: str) -> str:
    """Where a clip is from the page's folder on; from the root where it is on another drive."""
    try:
        return quote(Path(os.path.relpath(clip, folder)).as_posix())
    except ValueError:
        return Path(clip).absolute().as_uri()
