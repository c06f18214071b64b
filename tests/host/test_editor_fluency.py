"""Many strokes: what stands still is not drawn again while something moves, and nothing twice in a frame."""

from __future__ import annotations

import json
from typing import Any

import pytest
from editor_page import CANVASES, EditorPage

STROKES = 200
_FRAMES = """([id, most]) => new Promise((done) => {
  const { scheduler, layers, live } = app.graph.getNodeById(id).physanimatorEditor;
  const state = () => ({ frames: scheduler.drawn, items: layers.drawn, at: live.playback.position });
  const before = state();
  let passed = 0;
  const count = () => {
    const now = state();
    passed += 1;
    if (now.frames - before.frames < most && passed < 600) return requestAnimationFrame(count);
    done({ frames: now.frames - before.frames, items: now.items - before.items, moved: now.at !== before.at });
  };
  requestAnimationFrame(count);
})"""

_BURST = """([id]) => new Promise((done) => {
  const editor = app.graph.getNodeById(id).physanimatorEditor;
  const { scheduler, layers } = editor;
  const [drawn, requested, items] = [scheduler.drawn, scheduler.requested, layers.drawn];
  let passed = 0;
  const count = () => {
    passed += 1;
    if (passed < 30) requestAnimationFrame(count);
    else done({
      drawn: scheduler.drawn - drawn, requested: scheduler.requested - requested, items: layers.drawn - items, passed,
    });
  };
  for (let k = 0; k < 500; k++) editor.redraw();
  requestAnimationFrame(count);
})"""


@pytest.fixture(scope="module", params=sorted(CANVASES))
def canvas(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def editor(page: Any, canvas: str) -> EditorPage:
    """An editor with many strokes in it."""
    page.problems.clear()
    page.page.set_default_timeout(10_000)
    editor = EditorPage.opened(page, canvas)
    strokes = [
        {"kind": "wind", "path": [[20 + 6 * k, 50 + (k * 37) % 500], [220 + 5 * k, 90 + (k * 53) % 500]], "radius": 60}
        for k in range(STROKES)
    ]
    text = json.dumps(json.dumps(editor.value() | {"strokes": strokes}))
    editor.ask(f"node.widgets.find((one) => one.name === 'scene').value = {text}")
    editor.wait(f"editor.document.strokes?.length === {STROKES} && !editor.scheduler.waiting")
    return editor


def passed(editor: EditorPage, frames: int) -> dict[str, Any]:
    """What was drawn until so many frames had been."""
    return editor.page.run(_FRAMES, [editor.node, frames])


def drawn(editor: EditorPage) -> dict[str, int]:
    return editor.ask("({ frames: editor.scheduler.drawn, items: editor.layers.drawn })")


def test_many_requests_are_one_drawing_a_frame(editor: EditorPage) -> None:
    counted = editor.page.run(_BURST, [editor.node])
    assert counted["requested"] >= 500
    assert 1 <= counted["drawn"] <= counted["passed"] + 1
    assert counted["items"] == 0


def test_playing_draws_no_item_again(editor: EditorPage) -> None:
    editor.run_node()
    editor.wait("editor.live.shows && editor.live.measured.frames > 40")
    editor.wait("editor.live.player.plate !== editor.live.player.picture")
    passed(editor, 5)
    counted = passed(editor, 30)
    assert counted["frames"] >= 30
    assert counted["moved"] is True
    assert counted["items"] == 0


def test_dragging_draws_the_dragged_item_alone(editor: EditorPage) -> None:
    editor.press("select")
    start = editor.value()["strokes"][100]["path"][1]
    before = drawn(editor)
    editor.drag(tuple(start), (900, 600), (300, 500), steps=30)
    editor.wait("!editor.scheduler.waiting")
    after = drawn(editor)
    frames = after["frames"] - before["frames"]
    assert frames > 10
    # All of them when one is chosen, when it is grasped and when it is let go.
    assert after["items"] - before["items"] <= 3 * STROKES + frames
    assert editor.page.problems == []


def test_drawing_a_stroke_draws_the_others_once(editor: EditorPage) -> None:
    editor.press("wind")
    before = drawn(editor)
    editor.drag((200, 600), (1000, 640), steps=30)
    editor.wait(f"editor.document.strokes.length === {STROKES + 1} && !editor.scheduler.waiting")
    after = drawn(editor)
    assert after["frames"] - before["frames"] > 5
    assert after["items"] - before["items"] <= 2 * (STROKES + 1)
    path = editor.value()["strokes"][-1]["path"]
    assert path[0] == pytest.approx((200, 600), abs=editor.pixel())
    assert editor.page.problems == []
