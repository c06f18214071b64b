"""Points clicked on the picture in Segment by Points, and where editors take their picture from."""

from __future__ import annotations

import io
import json
import urllib.request
import uuid
from typing import Any

import pytest
from editor_page import CANVASES, EditorPage
from PIL import Image

_BUILD = """
async ([file, type]) => {
  app.graph.clear();
  app.nodeOutputs = {};
  const load = LiteGraph.createNode('LoadImage');
  load.pos = [-1300, 0];
  app.graph.add(load);
  const image = load.widgets.find((widget) => widget.name === 'image');
  image.options.values = [file];
  image.value = file;
  const node = LiteGraph.createNode(type);
  node.pos = [0, 0];
  app.graph.add(node);
  load.connect(0, node, node.inputs.findIndex((slot) => slot.name === 'image'));
  return node.id;
}
"""
_CHOOSE = """
(file) => {
  const image = app.graph.nodes.find((node) => node.type === 'LoadImage').widgets.find((one) => one.name === 'image');
  image.options.values = [file];
  image.value = file;
}
"""


def uploaded(host: Any, width: int, height: int) -> str:
    """A picture in the host's input folder, left half red and right half blue; its name."""
    picture = Image.new("RGB", (width, height), "blue")
    picture.paste((255, 0, 0), (0, 0, width // 2, height))
    data = io.BytesIO()
    picture.save(data, "PNG")
    name, border = f"{uuid.uuid4().hex}.png", uuid.uuid4().hex
    head = f'--{border}\r\nContent-Disposition: form-data; name="image"; filename="{name}"\r\n'
    body = f"{head}Content-Type: image/png\r\n\r\n".encode() + data.getvalue() + f"\r\n--{border}--\r\n".encode()
    kind = {"Content-Type": f"multipart/form-data; boundary={border}"}
    with urllib.request.urlopen(urllib.request.Request(f"{host.url}/upload/image", body, kind), timeout=60) as answer:
        return json.load(answer)["name"]


@pytest.fixture(scope="module", params=sorted(CANVASES))
def canvas(request: pytest.FixtureRequest) -> str:
    return request.param


def opened(page: Any, canvas: str, file: str, node_type: str) -> EditorPage:
    page.problems.clear()
    page.page.set_default_timeout(10_000)
    EditorPage.choose_canvas(page, canvas)
    editor = EditorPage(page, page.run(_BUILD, [file, f"PhysAnimator_{node_type}"]))
    editor.look()
    editor.wait("editor.backdrop.picture !== null")
    return editor


def test_points_are_clicked_on_the_picture_before_anything_has_run(host: Any, page: Any, canvas: str) -> None:
    editor = opened(page, canvas, uploaded(host, 600, 400), "SegmentByPoints")
    assert editor.ask("[editor.document.width, editor.document.height]") == [600, 400]
    editor.press("query-positive")
    editor.click(120, 200)
    editor.press("query-negative")
    editor.click(450, 100)
    document = json.loads(editor.ask("node.widgets.find((one) => one.name === 'points').value"))
    assert (document["width"], document["height"]) == (600, 400)
    on, beside = document["query_points"]
    assert (on["x"], on["y"]) == pytest.approx((120, 200), abs=editor.pixel())
    assert (beside["x"], beside["y"]) == pytest.approx((450, 100), abs=editor.pixel())
    assert (on["positive"], beside["positive"]) == (True, False)
    prompt = json.loads(page.run("async () => JSON.stringify((await app.graphToPrompt()).output)"))
    prompt["mask"] = {"class_type": "MaskToImage", "inputs": {"mask": [str(editor.node), 0]}}
    prompt["save"] = {"class_type": "PreviewImage", "inputs": {"images": ["mask", 0]}}
    mask = Image.open(io.BytesIO(host.view(host.run(prompt)["save"]["images"][0]))).convert("L")
    assert mask.getpixel((120, 200)) > 200
    assert mask.getpixel((450, 100)) < 50
    assert page.problems == []


def test_an_empty_picker_asks_for_a_click_and_a_strange_cut_is_told_in_the_node(
    host: Any, page: Any, canvas: str
) -> None:
    editor = opened(page, canvas, uploaded(host, 600, 400), "SegmentByPoints")
    assert editor.ask("node.widgets.find((one) => one.name === 'points').value") == ""
    assert editor.selector('[data-note="empty"]').inner_text() == "Click on what shall move."
    editor.press("query-positive")
    editor.click(120, 200)
    assert editor.selector('[data-note="empty"]').count() == 0
    editor.ask("editor.advise(['The cut is 90 % of the picture.'])")
    assert "90 %" in editor.selector('[data-note="advice"]').inner_text()
    editor.click(150, 220)
    assert editor.selector('[data-note="advice"]').count() == 0
    assert page.problems == []


def test_points_from_a_list_stay_what_they_are_until_they_are_changed(host: Any, page: Any, canvas: str) -> None:
    editor = opened(page, canvas, uploaded(host, 600, 400), "SegmentByPoints")
    text = "[[50, 60, 1], [70, 80, 0]]"
    editor.ask(f"node.widgets.find((one) => one.name === 'points').value = {json.dumps(text)}")
    editor.wait(f"editor.text === {json.dumps(text)}")
    assert editor.ask("node.widgets.find((one) => one.name === 'points').value") == text
    before = editor.place(50, 60)
    editor.press("select")
    editor.wait("editor.status.innerText.startsWith('Select')")
    assert editor.place(50, 60) == pytest.approx(before, abs=0.5), "the picture stays where it is"
    editor.drag((50, 60), (150, 160))
    document = json.loads(editor.ask("node.widgets.find((one) => one.name === 'points').value"))
    moved, kept = document["query_points"]
    assert (moved["x"], moved["y"]) == pytest.approx((150, 160), abs=2 * editor.pixel())
    assert (kept["x"], kept["y"], kept["positive"]) == (70, 80, False)


def test_another_size_of_picture_scales_the_scene_once_and_says_so(host: Any, page: Any, canvas: str) -> None:
    editor = opened(page, canvas, uploaded(host, 600, 400), "SceneEditor")
    editor.press("wind")
    editor.drag((100, 100), (500, 300))
    before = editor.value()["strokes"][0]
    page.run(_CHOOSE, uploaded(host, 1200, 800))
    editor.wait("editor.document.width === 1200")
    after = editor.value()["strokes"][0]
    assert after["path"] == [[2 * x, 2 * y] for x, y in before["path"]]
    assert (after["radius"], after["speed"]) == (2 * before["radius"], 2 * before["speed"])
    assert "1200 \u00d7 800 px" in editor.selector('[data-note="said"]').inner_text()
    page.page.wait_for_timeout(1500)
    assert editor.value()["strokes"][0] == after
    editor.focus()
    editor.keys("Control+z")
    assert editor.value()["strokes"][0] == before
    assert page.problems == []


def test_a_pen_s_pressure_sets_the_strength_along_the_stroke(host: Any, page: Any, canvas: str) -> None:
    editor = opened(page, canvas, uploaded(host, 600, 400), "SceneEditor")
    editor.press("wind")
    places = [editor.place(x, y) for x, y in ((100, 100), (300, 110), (300, 300))]
    page.run(
        """([id, places]) => {
        const { keys } = app.graph.getNodeById(id).physanimatorEditor.stage;
        const send = (name, [x, y], pressure) => keys.dispatchEvent(new PointerEvent(name, {
            pointerId: 77, pointerType: 'pen', clientX: x, clientY: y, pressure, buttons: 1, bubbles: true }));
        send('pointerdown', places[0], 0.25);
        send('pointermove', places[1], 0.5);
        send('pointermove', places[2], 1);
        send('pointerup', places[2], 0);
    }""",
        [editor.node, places],
    )
    keys = editor.value()["strokes"][0]["strength_keys"]
    assert [factor for _, factor in keys] == [0.5, 1, 2]
    assert [keys[0][0], keys[-1][0]] == [0, 1]


def test_two_fingers_zoom_and_pan_without_drawing(host: Any, page: Any, canvas: str) -> None:
    editor = opened(page, canvas, uploaded(host, 600, 400), "SceneEditor")
    editor.press("wind")
    before = editor.pixel()
    left, right = editor.place(200, 200), editor.place(400, 200)
    page.run(
        """([id, left, right]) => {
        const { keys } = app.graph.getNodeById(id).physanimatorEditor.stage;
        const send = (name, pointerId, [x, y]) => keys.dispatchEvent(new PointerEvent(name, {
            pointerId, pointerType: 'touch', clientX: x, clientY: y, buttons: 1, bubbles: true }));
        send('pointerdown', 1, left);
        send('pointerdown', 2, right);
        send('pointermove', 1, [left[0] - 60, left[1]]);
        send('pointermove', 2, [right[0] + 60, right[1]]);
        send('pointerup', 1, left);
        send('pointerup', 2, right);
    }""",
        [editor.node, left, right],
    )
    assert editor.pixel() < before * 0.8
    assert not editor.value().get("strokes")
    assert page.problems == []
