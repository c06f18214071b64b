"""The look of the editor and its manners in the host's page: sizes, names, gestures, and true words."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest
from editor_page import CANVASES, EditorPage


@pytest.fixture(scope="module", params=sorted(CANVASES))
def canvas(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def editor(page: Any, canvas: str) -> Iterator[EditorPage]:
    page.problems.clear()
    page.page.set_default_timeout(10_000)
    opened = EditorPage.opened(page, canvas)
    yield opened
    if opened.ask("editor.dialog.open"):
        opened.ask("editor.dialog.close()")


def draw(editor: EditorPage, count: int = 1) -> None:
    editor.press("wind")
    for number in range(count):
        editor.drag((300, 100 + 40 * number), (900, 120 + 40 * number))


# Every visible text, with its size on a screen at 100 %.
_SIZES = """(() => [...editor.root.querySelectorAll('*')]
  .filter((one) => one.tagName !== 'STYLE' && one.checkVisibility())
  .filter((one) => [...one.childNodes].some((node) => node.nodeType === 3 && node.data.trim()))
  .map((one) => [one.textContent.slice(0, 20), parseFloat(getComputedStyle(one).fontSize)]))()"""


def test_no_word_is_small_and_the_large_view_has_a_title(editor: EditorPage) -> None:
    draw(editor)
    assert min(size for _, size in editor.ask(_SIZES)) >= 12
    assert not editor.selector(".physanimator-title").is_visible()
    editor.press("expand")
    title = editor.selector(".physanimator-title")
    assert title.is_visible()
    assert title.inner_text() == "Scene Editor"
    sizes = dict(editor.ask(_SIZES))
    assert sizes["Scene Editor"] == 18
    assert min(sizes.values()) >= 12


def test_icons_have_words_where_there_is_room(editor: EditorPage) -> None:
    labels = "[...editor.toolbar.root.querySelectorAll('.physanimator-label')]"
    shown = f"{labels}.filter((one) => one.checkVisibility()).map((one) => one.textContent)"
    high = "editor.toolbar.root.offsetHeight"
    before = editor.ask(high)
    editor.ask("(editor.root.style.width = '2400px', 0)")
    editor.wait("editor.toolbar.root.dataset.labels === 'all'")
    assert editor.ask(high) <= before
    assert {"Wind", "Pin", "Undo"} <= set(editor.ask(shown))
    editor.ask("(editor.root.style.width = '', 0)")
    editor.wait("editor.toolbar.root.dataset.labels !== 'all'")
    editor.press("expand")
    assert {"Select", "Wind", "Stiffness", "Undo", "Back to the node"} <= set(editor.ask(shown))


def test_numbers_have_sliders(editor: EditorPage) -> None:
    draw(editor)
    row = editor.selector('[data-field="strength"]')
    slider, box = row.locator("input[type=range]"), row.locator("input[type=range]").bounding_box()
    assert slider.is_visible()
    mouse = editor.page.page.mouse
    mouse.move(box["x"] + 0.6 * box["width"], box["y"] + box["height"] / 2)
    mouse.down()
    for share in (0.7, 0.8, 0.9):
        mouse.move(box["x"] + share * box["width"], box["y"] + box["height"] / 2, steps=3)
    mouse.up()
    strength = editor.value()["strokes"][0]["strength"]
    assert strength == pytest.approx(8, abs=0.7)
    assert float(row.locator("input[type=number]").input_value()) == strength
    editor.keys("ArrowLeft")
    assert editor.value()["strokes"][0]["strength"] == pytest.approx(strength, abs=0.2), "the arrows move the slider"
    assert editor.value()["strokes"][0]["path"][0] == pytest.approx([300, 100], abs=editor.pixel()), (
        "and not the stroke"
    )
    editor.type_into("strength", "-3")
    assert editor.value()["strokes"][0]["strength"] == -3
    editor.press("undo")
    editor.press("undo")
    assert [stroke["strength"] for stroke in editor.value().get("strokes", [])] in ([], [2])


def test_lanes_have_names_and_scroll(editor: EditorPage) -> None:
    draw(editor, 8)
    names = editor.selector(".physanimator-lane-name")
    assert names.all_inner_texts() == [f"Wind stroke {number}" for number in range(1, 9)]
    lanes = "editor.timeline.lanes.parentElement"
    assert editor.ask(f"{lanes}.scrollHeight > {lanes}.clientHeight + 40")
    box_of = "(one) => one.getBoundingClientRect()"
    inside = (
        "((row, box) => row.top >= box.top - 1 && row.bottom <= box.bottom + 1)"
        f"(...[editor.timeline.lanes.querySelector('[data-selected=true]'), {lanes}].map({box_of}))"
    )
    assert editor.ask(inside), "the lane of what was drawn last is in view"
    editor.ask("editor.select({ list: 'strokes', index: 0 })")
    assert editor.ask(inside)
    # Of the names nothing is left where the times are.
    name = editor.selector(".physanimator-lane-name").first.bounding_box()
    lane = editor.selector(".physanimator-lane").first.bounding_box()
    assert name["x"] + name["width"] <= lane["x"] + 1


def test_the_status_is_beside_the_picture(editor: EditorPage) -> None:
    for _ in range(2):
        stage = editor.selector(".physanimator-stage").bounding_box()
        status = editor.selector(".physanimator-status").bounding_box()
        assert status["y"] >= stage["y"] + stage["height"] - 1
        assert "720 px" in editor.selector(".physanimator-status").inner_text()
        editor.press("expand")
        editor.page.page.wait_for_timeout(300)
    assert editor.ask("editor.dialog.open") is False


def test_the_button_says_what_plays(editor: EditorPage) -> None:
    play = editor.selector('[data-action="play"]')
    assert play.is_disabled()
    assert "Play" in play.get_attribute("title")
    draw(editor)
    editor.run_node()
    editor.wait("editor.live.playback.plays")
    editor.wait("!editor.timeline.play.disabled")
    assert "Pause" in play.get_attribute("title")
    editor.press("play")
    editor.wait("editor.timeline.play.title.startsWith('Play')")
    standing = editor.ask("editor.live.playback.position")
    editor.page.page.wait_for_timeout(200)
    assert editor.ask("editor.live.playback.position") == standing
    editor.press("loop")
    editor.wait("editor.live.playback.frames.length === editor.live.playback.duration")
    editor.press("play")
    editor.ask("(editor.live.playback.position = editor.live.playback.duration - 3, 0)")
    editor.wait("!editor.live.playback.playing")
    # At its end a motion that is no loop stands.
    editor.wait("editor.timeline.play.title.startsWith('Play')")


_GRAPH = "() => [app.canvas.ds.scale, ...app.canvas.ds.offset]"


def test_the_wheel_is_the_graph_s_until_somebody_works_in_the_editor(editor: EditorPage) -> None:
    page = editor.page.page
    editor.ask("(document.activeElement?.blur(), 0)")
    page.mouse.move(*editor.place(600, 300))
    graph, view = editor.page.run(_GRAPH), editor.ask("editor.stage.view.scale")
    page.mouse.wheel(0, 120)
    page.wait_for_timeout(400)
    assert editor.page.run(_GRAPH) != graph
    assert editor.ask("editor.stage.view.scale") == pytest.approx(view, rel=0.02)
    editor.look()
    editor.click(600, 300)
    graph, view = editor.page.run(_GRAPH), editor.ask("editor.stage.view.scale")
    page.mouse.wheel(0, -120)
    page.wait_for_timeout(400)
    assert editor.page.run(_GRAPH) == graph
    assert editor.ask("editor.stage.view.scale") > view


def test_two_fingers_zoom_the_editor_only(editor: EditorPage) -> None:
    session = editor.page.page.context.new_cdp_session(editor.page.page)

    def touch(kind: str, *points: tuple[float, float]) -> None:
        given = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": given})

    def pinch(x: float, y: float) -> None:
        touch("touchStart", (x - 20, y))
        touch("touchStart", (x - 20, y), (x + 20, y))
        for step in range(1, 7):
            touch("touchMove", (x - 20 - 6 * step, y), (x + 20 + 6 * step, y))
        touch("touchEnd")
        editor.page.page.wait_for_timeout(300)

    graph, view = editor.page.run(_GRAPH), editor.ask("editor.stage.view.scale")
    pinch(*editor.place(640, 360))
    assert editor.ask("editor.stage.view.scale") > 1.5 * view
    assert editor.page.run(_GRAPH) == pytest.approx(graph)
    panel = editor.selector(".physanimator-inspector").bounding_box()
    pinch(panel["x"] + 60, panel["y"] + 60)
    assert editor.page.run(_GRAPH) == pytest.approx(graph), "nor does it over the numbers"
    assert editor.value().get("strokes", []) == []


_OUTSIDE = """(() => {
  const frame = editor.frame.getBoundingClientRect();
  return [...editor.frame.querySelectorAll('button, input, select, label, span, h3')]
    .filter((one) => one.checkVisibility() && !one.closest('.physanimator-lanes'))
    .map((one) => [one, one.getBoundingClientRect()])
    .filter(([, box]) => box.width && (box.left < frame.left - 1 || box.right > frame.right + 1))
    .map(([one]) => one.outerHTML.slice(0, 80));
})()"""
_BOXES = """(() => {
  const frame = editor.frame.getBoundingClientRect();
  const holder = editor.root.closest('[data-node-id]')?.getBoundingClientRect();
  const { ds } = app.canvas;
  const page = app.canvas.canvas.getBoundingClientRect();
  const left = holder?.left ?? page.left + (node.pos[0] + ds.offset[0]) * ds.scale;
  const right = holder?.right ?? left + node.size[0] * ds.scale;
  const bottom = holder?.bottom ?? page.top + (node.pos[1] + node.size[1] + ds.offset[1]) * ds.scale;
  return [frame.left - left, right - frame.right, bottom - frame.bottom];
})()"""


_PANEL = """async (open) => {
  const { setting } = app.extensionManager;
  if (setting.get('Comfy.RightSidePanel.IsOpen') !== undefined) await setting.set('Comfy.RightSidePanel.IsOpen', open);
}"""


@pytest.mark.parametrize("across", [250, 330, 420, 560, 810])
@pytest.mark.parametrize("down", [420, 700])
def test_nothing_is_hidden_and_nothing_overhangs(editor: EditorPage, across: int, down: int) -> None:
    draw(editor, 2)
    if across == 250:  # the longest unit
        editor.press("wave")
        editor.drag((300, 300), (300, 380))
    editor.ask(f"(node.setSize([{across}, {down}]), app.canvas.setDirty(true, true), 0)")
    editor.page.page.wait_for_timeout(600)
    assert editor.ask(_OUTSIDE) == []
    assert min(editor.ask(_BOXES)) >= -1, "left, right and below"
    frame = "editor.frame"
    assert editor.ask(f"{frame}.scrollWidth <= {frame}.clientWidth")
    scrolls = f"{frame}.scrollHeight <= {frame}.clientHeight + 1 || getComputedStyle({frame}).overflowY === 'auto'"
    assert editor.ask(scrolls), "what does not fit is reached by scrolling"
    panel = "editor.inspector.root"
    assert editor.ask(f"{panel}.scrollWidth <= {panel}.clientWidth")


@pytest.mark.parametrize("across", [250, 420, 810])
def test_another_tool_leaves_the_picture_where_it_is(editor: EditorPage, across: int) -> None:
    editor.ask(f"(node.setSize([{across}, 700]), app.canvas.setDirty(true, true), 0)")
    editor.page.page.wait_for_timeout(600)
    tools = editor.ask("[...editor.tools.keys()]")
    high = []
    for tool in tools:
        editor.ask(f"editor.commands.choose('{tool}')")
        editor.page.page.wait_for_timeout(120)
        high.append(editor.ask("editor.stage.root.clientHeight"))
    assert len(tools) > 5
    assert len(set(high)) == 1


def test_the_host_s_side_panel_leaves_the_editor_as_wide_as_its_node(editor: EditorPage) -> None:
    page = editor.page
    page.run(_PANEL, True)
    try:
        page.run("([id]) => app.canvas.selectNode(app.graph.getNodeById(id))", [editor.node])
        page.page.wait_for_timeout(1200)
        editor.ask("(node.widgets.find((one) => one.name === 'physanimator_editor').width = 240, 0)")
        page.page.wait_for_timeout(600)
        assert max(editor.ask(_BOXES)[:2]) < 40, "beside the editor, left and right"
        assert "physanimator_editor" not in page.run("() => document.body.innerText")
    finally:
        page.run(_PANEL, False)


def test_the_same_scene_in_another_spelling_is_not_simulated_again(editor: EditorPage) -> None:
    draw(editor)
    editor.run_node()
    editor.wait("editor.live.measured.frames > 20")
    asked: list[str] = []
    editor.page.page.on("request", lambda one: asked.append(one.url))
    respelled = json.dumps(dict(reversed(editor.value().items())), indent=2)
    place = "node.widgets.find((one) => one.name === 'scene')"
    editor.ask(f"({place}.value = {json.dumps(respelled)}, 0)")
    editor.page.page.wait_for_timeout(1500)
    assert [url for url in asked if url.endswith("/physanimator/preview")] == []
    assert editor.ask("editor.text") == respelled
    editor.press("undo")
    assert editor.value().get("strokes", []) == [], "the steps to undo are still there"


_LISTEN = """(() => {
  const said = (window.saidByPhysAnimator = []);
  const look = () => {
    const text = editor.notes.root.querySelector('[data-note=run]')?.firstChild?.data ?? '';
    if (said.at(-1) !== text) said.push(text);
  };
  new MutationObserver(look).observe(editor.notes.root, { childList: true, subtree: true });
})()"""


def test_what_is_said_while_the_node_runs(editor: EditorPage) -> None:
    draw(editor)
    editor.ask(_LISTEN)
    editor.run_node()
    editor.wait("editor.live.measured.frames > 3")
    editor.wait("!editor.notes.shown.has('run')")
    said = [text for text in editor.page.run("() => window.saidByPhysAnimator") if text]
    assert said[0].startswith("This node is running")
    assert any(text.startswith("Preparing") for text in said)
    assert not any(text.startswith("Nothing moves yet") for text in said)


def test_a_server_that_is_gone_is_said_so(editor: EditorPage) -> None:
    draw(editor)
    editor.run_node()
    editor.wait("editor.live.measured.frames > 3")
    page = editor.page.page
    page.route("**/physanimator/preview", lambda route: route.abort())
    editor.drag((300, 500), (900, 520))
    editor.wait("editor.notes.shown.has('motion')")
    said = editor.selector('[data-note="motion"]').inner_text()
    page.unroute("**/physanimator/preview")
    assert said == "The server does not answer. Is ComfyUI still running?"
    editor.page.problems.clear()


def test_a_run_that_fails_is_offered_again(editor: EditorPage) -> None:
    editor.page.run(
        "([id]) => app.graph.getNodeById(id).disconnectInput(0)",
        [editor.node],
    )
    editor.press("run")
    editor.wait("!editor.backdrop.waiting", timeout=20_000)
    assert "Run this node" in editor.selector('[data-note="run"]').inner_text()
    editor.page.run("() => { document.querySelectorAll('[role=dialog] button').forEach((one) => one.click()); }")
    editor.keys("Escape")


def test_no_deprecated_link_is_asked_for(editor: EditorPage) -> None:
    said: list[str] = []
    editor.page.page.on("console", lambda message: said.append(message.text))
    editor.page.run("async () => app.loadGraphData(JSON.parse(JSON.stringify(app.graph.serialize())))")
    editor.page.page.wait_for_timeout(1500)
    assert [text for text in said if "input.link" in text] == []
