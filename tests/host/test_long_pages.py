"""Pages far longer than wide, such as webtoons, and far wider than high: seen in pieces, and walked through."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
import pytest
from editor_page import CANVASES, EditorPage

LONG, SHORT = 6000, 800
# First and last row or column of the picture that is on the stage, and how much of the stage the shorter side fills.
_SEEN = """\
(({ view, across, down, size }) => {
  const tall = size.height > size.width;
  const [begin, room, other, length] = tall ? [view.y, down, across, size.width] : [view.x, across, down, size.height];
  return [-begin / view.scale, (room - begin) / view.scale, length * view.scale / Math.min(room, other)];
})(editor.stage)
"""


def page_of_panels(wide: bool) -> bytes:
    """White, with a dark panel in every 1000 px."""
    drawn = np.full((LONG, SHORT, 3), 255, np.uint8)
    for number in range(LONG // 1000):
        drawn[number * 1000 + 100 : number * 1000 + 900, 60:740] = (40 * number, 90, 200 - 30 * number)
    drawn = drawn.transpose(1, 0, 2) if wide else drawn
    return bytes(cv2.imencode(".png", drawn)[1])


@pytest.fixture(params=[(canvas, wide) for canvas in sorted(CANVASES) for wide in (False, True)])
def editor(request: pytest.FixtureRequest, page: Any) -> EditorPage:
    canvas, wide = request.param
    page.problems.clear()
    shown = EditorPage.animating(page, canvas)
    name = "wide.png" if wide else "tall.png"
    shown.drop(page_of_panels(wide), name)
    shown.wait(f"Math.max(editor.document.width, editor.document.height) === {LONG}")
    page.page.wait_for_timeout(400)
    return shown


def along(editor: EditorPage, far: float, aside: float) -> tuple[float, float]:
    """A pixel so far along the page."""
    return (far, aside) if editor.ask("editor.document.width") == LONG else (aside, far)


def last_point(editor: EditorPage) -> tuple[float, float]:
    point = editor.shown()["query_points"][-1]
    return point["x"], point["y"]


def test_a_long_page_begins_readable_and_is_walked_through(editor: EditorPage) -> None:
    first, last, filled = editor.ask(_SEEN)
    assert first <= 0
    assert 700 < last < 3000
    assert filled > 0.9
    for far in (300, 600):
        editor.click(*along(editor, far, 400))
        assert np.abs(np.subtract(last_point(editor), along(editor, far, 400))).max() <= editor.pixel()
    editor.focus()
    editor.keys("PageDown", "PageDown")
    on = editor.ask(_SEEN)
    assert np.isclose(on[0] - first, 1.6 * (last - first), rtol=0.05)
    editor.keys("PageUp")
    assert editor.ask(_SEEN)[0] < on[0]
    page = editor.page.page
    way = "across" if along(editor, 1, 0)[0] == 1 else "down"
    bar = editor.selector(f'.physanimator-scroll[data-way="{way}"]').bounding_box()
    handle = editor.selector(f'.physanimator-scroll[data-way="{way}"] .physanimator-handle').bounding_box()
    page.mouse.move(handle["x"] + handle["width"] / 2, handle["y"] + handle["height"] / 2)
    page.mouse.down()
    page.mouse.move(bar["x"] + bar["width"] - 2, bar["y"] + bar["height"] - 2, steps=5)
    page.mouse.up()
    end = editor.ask(_SEEN)
    assert end[1] >= LONG
    assert end[1] - LONG < 40 / editor.ask("editor.stage.view.scale")
    editor.click(*along(editor, 5300, 300))
    assert np.abs(np.subtract(last_point(editor), along(editor, 5300, 300))).max() <= editor.pixel()
    assert len(editor.shown()["query_points"]) == 3, "bars draw nothing"
    assert editor.page.problems == []


def test_the_large_view_shows_the_same_piece_and_the_whole_is_a_key_away(editor: EditorPage) -> None:
    editor.focus()
    editor.keys("PageDown", "PageDown", "PageDown")
    first, last, _ = editor.ask(_SEEN)
    editor.press("expand")
    editor.page.page.wait_for_timeout(400)
    large = editor.ask(_SEEN)
    assert large[0] < (first + last) / 2 < large[1]
    assert large[2] > 0.9
    editor.keys("0")
    whole = editor.ask(_SEEN)
    assert whole[0] <= 0
    assert whole[1] >= LONG
    bars = "[...editor.frame.querySelectorAll('.physanimator-scroll')].map((bar) => bar.hidden)"
    editor.wait(f"{bars}.every(Boolean)")
    editor.keys("Escape")
    editor.page.page.wait_for_timeout(400)
    assert editor.ask(_SEEN)[1] >= LONG
    assert editor.page.problems == []
