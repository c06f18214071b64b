"""What goes through the clipboard and what is dropped: nodes with their scenes, items, pictures to draw on."""

from __future__ import annotations

import json
from typing import Any

import pytest
from editor_page import CANVASES, EditorPage

_EDITORS = """
() => app.graph.nodes.filter((one) => one.comfyClass === 'PhysAnimator_SceneEditor').map((one) => one.id)
"""
_PICTURE = """
  const canvas = Object.assign(document.createElement('canvas'), { width: 320, height: 200 });
  canvas.getContext('2d').fillRect(0, 0, 160, 200);
  const blob = await new Promise((done) => canvas.toBlob(done, 'image/png'));
"""
_COPY_PICTURE = f"""async () => {{ {_PICTURE}
  await navigator.clipboard.write([new ClipboardItem({{ 'image/png': blob }})]);
}}"""
_DRAGGED = f"""async () => {{ {_PICTURE}
  const data = new DataTransfer();
  data.items.add(new File([blob], 'drawn.png', {{ type: 'image/png' }}));
  return data;
}}"""


@pytest.fixture(scope="module", params=sorted(CANVASES))
def canvas(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def editor(page: Any, canvas: str) -> EditorPage:
    page.problems.clear()
    page.page.set_default_timeout(10_000)
    page.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    return EditorPage.opened(page, canvas)


def test_a_node_is_copied_with_its_scene_by_the_host_s_keys(editor: EditorPage) -> None:
    editor.press("wind")
    editor.drag((300, 200), (900, 300))
    document = editor.value()
    page = editor.page.page
    # On the canvas beside the nodes, where the keys are the host's.
    page.mouse.click(1500, 950)
    editor.page.run("([id]) => app.canvas.selectNode(app.graph.getNodeById(id))", [editor.node])
    page.keyboard.press("Control+c")
    page.mouse.move(1400, 950)
    page.keyboard.press("Control+v")
    page.wait_for_timeout(1000)
    (new,) = set(editor.page.run(_EDITORS)) - {editor.node}
    copy = EditorPage(editor.page, new)
    assert copy.shown() == copy.value() == document
    editor.press("undo")
    assert not editor.value().get("strokes")
    assert copy.value() == document
    assert editor.page.problems == []


def test_items_are_copied_within_an_editor_and_the_node_stays_alone(editor: EditorPage) -> None:
    editor.page.run("([id]) => app.canvas.selectNode(app.graph.getNodeById(id))", [editor.node])
    editor.press("wind")
    editor.drag((300, 200), (900, 300))
    editor.keys("Control+c", "Control+v")
    first, second = editor.value()["strokes"]
    assert [round(b - a) for a, b in zip(first["path"][0], second["path"][0], strict=True)] == [26, 26]
    assert {**second, "path": 0} == {**first, "path": 0}
    editor.keys("Control+x")
    assert editor.value()["strokes"] == [first]
    assert editor.page.run(_EDITORS) == [editor.node]
    assert editor.page.problems == []


def test_a_picture_from_the_clipboard_is_drawn_on(editor: EditorPage) -> None:
    nodes = editor.page.run("() => app.graph.nodes.length")
    editor.page.run(_COPY_PICTURE)
    editor.focus()
    editor.keys("Control+v")
    editor.wait("editor.document.width === 320 && editor.document.height === 200")
    assert editor.ask("editor.backdrop.picture.naturalWidth") == 320
    assert editor.page.run("() => app.graph.nodes.length") == nodes
    assert editor.page.problems == []


def test_a_picture_is_dropped_on_the_editor_and_not_on_the_graph(editor: EditorPage) -> None:
    nodes = editor.page.run("() => app.graph.nodes.length")
    data = editor.page.page.evaluate_handle(_DRAGGED)
    picture = editor.selector("input.physanimator-keys")
    for name in ("dragenter", "dragover", "drop"):
        picture.dispatch_event(name, {"dataTransfer": data})
    editor.wait("editor.document.width === 320")
    editor.press("wind")
    editor.drag((20, 20), (300, 100))
    assert editor.value()["strokes"][0]["path"][-1] == pytest.approx([300, 100], abs=editor.pixel())
    assert editor.page.run("() => app.graph.nodes.length") == nodes
    assert "only drawn on" in editor.selector('[data-note="said"]').inner_text()
    assert json.loads(editor.ask("JSON.stringify(editor.document)"))["width"] == 320
    assert editor.page.problems == []
