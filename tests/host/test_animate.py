"""From a picture to a moving one in one node, as a newcomer does it: by dropping a file and clicking."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from blueprints import blueprint
from editor_page import CANVASES, EditorPage
from layered_files import bust, write_ora

ILLUSTRATION = Path(__file__).resolve().parents[2] / "workflows" / "example" / "illustration.png"
HAIR, CAPE = (700, 300), (680, 540)
MOST_CLICKS = 6

_LOAD = """
async (workflow) => {
  await app.loadGraphData(JSON.parse(workflow), true, true);
  await new Promise((done) => setTimeout(done, 500));
}
"""
_ADD = """
([type, x, y]) => {
  const node = LiteGraph.createNode(type);
  node.pos = [x, y];
  app.graph.add(node);
  return node.id;
}
"""


@pytest.fixture(scope="module", params=sorted(CANVASES))
def canvas(request: pytest.FixtureRequest) -> str:
    return request.param


class Hand:
    """What a person does with the mouse, counted.

    Attributes:
        clicks: so far; a double click is two.
    """

    def __init__(self, page: Any) -> None:
        self.page, self.clicks = page, 0

    def click(self, x: float, y: float, *, count: int = 1) -> None:
        self.page.page.mouse.click(x, y, click_count=count, delay=20)
        self.clicks += count


def value_of(editor: EditorPage, name: str) -> Any:
    return editor.ask(f"node.widgets.find((one) => one.name === '{name}').value")


def failure(host: Any, prompt: dict[str, Any]) -> str:
    """The sentence with which a node fails that has begun."""
    entry = host.wait(host.queue(prompt))
    (message,) = [each[1] for each in entry["status"]["messages"] if each[0] == "execution_error"]
    return str(message["exception_message"])


def opened(page: Any, canvas: str) -> EditorPage:
    page.problems.clear()
    EditorPage.choose_canvas(page, canvas)
    page.run("() => { app.graph.clear(); app.nodeOutputs = {}; }")
    editor = EditorPage(page, page.run(_ADD, ["PhysAnimator_AnimateIllustration", 0, 0]))
    editor.look(scale=1.0)
    editor.wait("editor.backdrop.picture !== null")
    return editor


def test_a_newcomer_gets_from_a_dropped_picture_to_a_moving_one(page: Any, canvas: str, record_property: Any) -> None:
    page.problems.clear()
    EditorPage.choose_canvas(page, canvas)
    page.run("() => { app.graph.clear(); app.nodeOutputs = {}; }")
    page.page.wait_for_timeout(500)
    hand = Hand(page)
    hand.click(900, 500, count=2)  # the host's search
    page.page.wait_for_timeout(1000)
    page.page.keyboard.type("animate illustration")
    page.page.wait_for_timeout(1500)
    page.page.keyboard.press("Enter")
    page.page.wait_for_function("() => app.graph.nodes.length === 1", timeout=10_000)
    hand.click(700, 300)  # where newer hosts want the new node to be put down; elsewhere it does nothing
    (number,) = page.run("() => app.graph.nodes.map((node) => node.id)")
    editor = EditorPage(page, number)
    editor.look(*page.run("(id) => [...app.graph.getNodeById(id).pos]", number), scale=1.0)
    editor.drop(ILLUSTRATION.read_bytes(), "mine.png")
    editor.wait("/^mine/.test(node.widgets.find((one) => one.name === 'picture').value)")
    editor.wait("editor.backdrop.picture?.src.includes('mine')")
    assert editor.selector('[data-note="empty"]').inner_text() == "Click on what shall move."
    hand.click(*editor.place(*HAIR))
    editor.wait("editor.picking.cuts?.length === 1")
    editor.wait("editor.live.measured.drawn > 0")
    cut, asked, drawn = editor.ask(
        "[editor.picking.measured.cut, editor.picking.measured.moving, editor.live.measured.drawn]"
    )
    record_property("clicks", hand.clicks)
    record_property("seconds_to_the_cut", round(cut / 1000, 2))
    record_property("seconds_to_the_motion", round((asked + drawn) / 1000, 2))
    print(f"{canvas}: {hand.clicks} clicks, cut after {cut / 1000:.2f} s, moves after {(asked + drawn) / 1000:.2f} s")
    assert hand.clicks <= MOST_CLICKS
    editor.wait("editor.live.measured.largest > 5")
    assert page.problems == []


def test_parts_have_colours_and_materials_of_their_own(page: Any, canvas: str) -> None:
    editor = opened(page, canvas)
    editor.click(*HAIR)
    editor.wait("editor.picking.cuts?.length === 1")
    page.page.keyboard.down("Shift")
    editor.click(*CAPE)
    page.page.keyboard.up("Shift")
    editor.wait("editor.picking.cuts?.length === 2 && editor.live.measured.drawn > 0")
    editor.selector('[data-preset="1"]').select_option("cloth")
    editor.wait("editor.live.run && editor.live.measured.drawn > 0")
    document = json.loads(value_of(editor, "points"))
    assert [point.get("part", 0) for point in document["query_points"]] == [0, 1]
    assert document["bodies"][1]["material"] == {"preset": "cloth"}
    editor.press("new-part")
    assert editor.ask("editor.part") == 2
    editor.selector('[data-part="0"]').click()
    page.page.keyboard.down("Alt")
    editor.click(560, 400)
    page.page.keyboard.up("Alt")
    beside = json.loads(value_of(editor, "points"))["query_points"][-1]
    assert (beside["positive"], beside.get("part", 0)) == (False, 0)
    editor.selector('[data-remove="0"]').click()
    left = json.loads(value_of(editor, "points"))
    assert [point.get("part", 0) for point in left["query_points"]] == [0]
    assert left["bodies"] == [{"material": {"preset": "cloth"}}]
    assert page.problems == []


def test_a_run_shows_its_frames_in_the_editor_and_a_click_goes_back(page: Any, canvas: str) -> None:
    editor = opened(page, canvas)
    editor.click(*HAIR)
    editor.wait("editor.live.measured.drawn > 0")
    editor.ask("node.widgets.find((one) => one.name === 'frames').value = 6")
    page.run("() => app.queuePrompt(0, 1)")
    editor.wait(
        "!editor.picking.result.hidden && editor.picking.result.querySelector('video')?.readyState > 1", 120_000
    )
    page.page.wait_for_timeout(500)
    own = "[...document.querySelectorAll('[data-node-id] :is(.image-preview, .video-preview)')]"
    assert page.run(f"() => {own}.filter((one) => one.checkVisibility()).length") == 0, "shown once is enough"
    transport = editor.selector(".physanimator-bar .physanimator-slider")
    assert not transport.is_visible(), "it plays the preview, which is not seen now"
    assert editor.ask("editor.status.innerText").startswith("The frames of the last run")
    shown = editor.selector(".physanimator-result").bounding_box()
    page.page.mouse.click(shown["x"] + shown["width"] / 2, shown["y"] + shown["height"] / 2)
    assert editor.ask("editor.picking.result.hidden") is True
    assert transport.is_visible()
    assert len(json.loads(value_of(editor, "points"))["query_points"]) == 1
    editor.press("view-result")
    assert editor.ask("editor.picking.result.hidden") is False
    assert page.problems == []


def test_what_is_saved_runs_without_the_page(host: Any, page: Any, canvas: str) -> None:
    editor = opened(page, canvas)
    editor.click(*HAIR)
    editor.wait("editor.picking.cuts?.length === 1")
    prompt = json.loads(page.run("async () => JSON.stringify((await app.graphToPrompt()).output)"))
    prompt[str(editor.node)]["inputs"] |= {"frames": 3}
    (saved,) = host.run(prompt)[str(editor.node)]["images"]
    assert b"ftyp" in host.view(saved)[:16]
    prompt[str(editor.node)]["inputs"]["points"] = ""
    assert "click on what shall move" in host.error_of(prompt)


def test_the_picker_of_masks_cuts_under_the_clicks(host: Any, page: Any, canvas: str) -> None:
    page.problems.clear()
    EditorPage.choose_canvas(page, canvas)
    page.run("() => { app.graph.clear(); app.nodeOutputs = {}; }")
    example = page.run(_ADD, ["PhysAnimator_ExampleIllustration", -1300, 0])
    editor = EditorPage(page, page.run(_ADD, ["PhysAnimator_SegmentByPoints", 0, 0]))
    page.run(
        "([from, to]) => { const [a, b] = [from, to].map((id) => app.graph.getNodeById(id));"
        " a.connect(0, b, b.inputs.findIndex((slot) => slot.name === 'image')); }",
        [example, editor.node],
    )
    editor.look(scale=1.0)
    editor.wait("editor.backdrop.picture !== null")
    editor.click(*HAIR)
    editor.wait("editor.picking.cuts?.length === 1")
    editor.wait("editor.layers.before.cuts?.length === 1")
    editor.ask("node.widgets.find((one) => one.name === 'backend').value = 'segment anything'")
    editor.wait("editor.picking.cuts === null")
    editor.ask("node.widgets.find((one) => one.name === 'backend').value = 'grabcut'")
    editor.wait("editor.picking.cuts?.length === 1")
    page.run("() => app.queuePrompt(0, 1)")  # an output node: it runs with nothing behind it
    page.page.wait_for_function(
        "(id) => (app.nodeOutputs[id] ?? app.nodeOutputs[String(id)])?.images?.length > 0",
        arg=editor.node,
        timeout=60_000,
    )
    assert page.problems == []


def test_a_stroke_on_a_fresh_body_leaves_it_where_it_is_attached(page: Any, canvas: str) -> None:
    page.problems.clear()
    editor = EditorPage.opened(page, canvas)
    editor.press("wind")
    editor.drag((500, 200), (1100, 250))
    assert "rig_points" not in editor.value()
    editor.run_node()
    editor.wait("editor.live.playback.frames.length === editor.live.playback.duration")
    assert editor.value()["rig_points"]
    assert editor.selector('[data-note="unheld"]').count() == 0
    still = editor.ask(
        "(() => { const last = editor.live.playback.frames.at(-1).displacements; let n = 0;"
        " for (let i = 0; i < last.length; i += 2) n += !last[i] && !last[i + 1]; return n / (last.length / 2); })()"
    )
    assert still > 0.05, "what is attached stays"
    editor.ask("editor.commit({ ...editor.document, rig_points: [] }, null)")
    editor.wait("editor.notes.shown.has('unheld')")
    assert "is carried away" in editor.selector('[data-note="unheld"]').inner_text()
    editor.press("unheld")
    editor.wait("!editor.notes.shown.has('unheld')")
    assert editor.value()["rig_points"]
    assert page.problems == []


def test_a_picture_that_nodes_make_can_be_clicked_on_once_a_preview_shows_it(page: Any, canvas: str) -> None:
    page.problems.clear()
    EditorPage.choose_canvas(page, canvas)
    page.run("() => { app.graph.clear(); app.nodeOutputs = {}; }")
    made = page.run(_ADD, ["EmptyImage", -1300, 0])
    seen = page.run(_ADD, ["PreviewImage", -900, 400])
    editor = EditorPage(page, page.run(_ADD, ["PhysAnimator_SegmentByPoints", 0, 0]))
    page.run(
        "(ids) => { const [made, ...others] = ids.map((id) => app.graph.getNodeById(id));"
        " for (const one of others) made.connect(0, one, one.inputs.findIndex((slot) => slot.type === 'IMAGE')); }",
        [made, seen, editor.node],
    )
    editor.look(scale=1.0)
    assert editor.ask("editor.backdrop.picture") is None
    page.run("(id) => app.queuePrompt(0, 1, [String(id)])", seen)
    editor.wait("editor.backdrop.picture?.naturalWidth === 512")
    editor.click(200, 200)
    editor.wait("editor.picking.cuts !== null || editor.notes.shown.has('pick')")
    assert page.problems == []


def test_of_a_layered_file_whose_names_say_nothing_the_clicked_layer_moves(host: Any, page: Any, canvas: str) -> None:
    drawn = [(f"Layer {number}", pixels) for number, (_, pixels) in enumerate(bust())]
    write_ora(host.folder / "input" / "nameless.ora", drawn)
    editor = opened(page, canvas)
    page.run(
        "(id) => { const node = app.graph.getNodeById(id), widget = node.widgets.find((one) => one.name === 'picture');"
        " widget.value = 'nameless.ora'; widget.callback?.(widget.value); node.physanimatorEditor.look(); }",
        editor.node,
    )
    editor.wait("editor.backdrop.picture?.src.includes('nameless') && editor.picking.named === 0")
    told = editor.selector('[data-note="empty"]')
    assert told.inner_text() == "No layer moves by its name: click on what shall move."
    editor.click(80, 24)
    editor.wait("editor.picking.cuts?.length === 1 && editor.live.measured.largest > 0.5")
    assert editor.ask("editor.live.player.layers.filter((one) => one.body !== null).map((one) => one.layer)") == [3]
    page.page.keyboard.down("Shift")
    editor.click(55, 70)
    page.page.keyboard.up("Shift")
    editor.wait("editor.picking.cuts?.length === 2 && editor.live.measured.largest > 0.5")
    editor.selector('[data-preset="1"]').select_option("cloth")
    editor.wait("editor.live.measured.drawn > 0")
    editor.ask("node.widgets.find((one) => one.name === 'frames').value = 6")
    prompt = json.loads(page.run("async () => JSON.stringify((await app.graphToPrompt()).output)"))
    assert host.run(prompt)[str(editor.node)]["images"]
    prompt[str(editor.node)]["inputs"]["points"] = ""
    assert "click on what shall move" in failure(host, prompt)
    assert page.problems == []


@pytest.mark.parametrize("down", [420, 700])
def test_the_play_bar_is_in_sight_however_narrow_the_node(page: Any, canvas: str, down: int) -> None:
    editor = opened(page, canvas)
    editor.click(*HAIR)
    page.page.keyboard.down("Shift")
    editor.click(*CAPE)
    page.page.keyboard.up("Shift")
    editor.wait("editor.picking.cuts?.length === 2 && editor.live.measured.drawn > 0")
    editor.ask(f"(node.setSize([250, {down}]), app.canvas.setDirty(true, true), 0)")
    page.page.wait_for_timeout(600)
    gap = "editor.frame.getBoundingClientRect().bottom - {}.getBoundingClientRect().bottom"
    bar = "editor.timeline.root.querySelector('.physanimator-bar')"
    assert editor.ask(gap.format(bar)) >= 0, "nothing has to be scrolled"
    middle = (
        f"(({{ x, y, width, height }}) => [x + width / 2, y + height / 2])({bar}.firstChild.getBoundingClientRect())"
    )
    there = f"document.elementFromPoint(...{middle})?.closest('button')?.dataset.action"
    assert editor.ask(there) == "play", "nothing lies over it"
    covered = (
        "(({ left, right, top, bottom }) => [[left + 4, top + 4], [right - 4, bottom - 4], [left + 4, bottom - 4]]"
        ".filter(([x, y]) => !document.elementFromPoint(x, y)?.closest('.physanimator-stage')))"
        "(editor.stage.root.getBoundingClientRect())"
    )
    assert editor.ask(covered) == [], "the whole picture can be clicked on"
    editor.press("new-part")
    assert editor.ask("editor.part") == 2
    assert page.problems == []


_OVERLAPS = """(() => {
  const boxes = [...editor.dialog.querySelectorAll('button, .physanimator-part')]
    .filter((one) => one.checkVisibility()).map((one) => [one, one.getBoundingClientRect()]);
  const beside = (a, b) => a.right <= b.left + 1 || b.right <= a.left + 1;
  const apart = (a, b) => beside(a, b) || a.bottom <= b.top + 1 || b.bottom <= a.top + 1;
  return boxes.flatMap(([one, box], i) => boxes.slice(i + 1)
    .filter(([other, more]) => !one.contains(other) && !other.contains(one) && !apart(box, more))
    .map(([other]) => `${one.textContent} / ${other.textContent}`));
})()"""


@pytest.mark.parametrize("across", [390, 820])
def test_nothing_overlaps_in_the_large_view_of_a_small_screen(page: Any, canvas: str, across: int) -> None:
    editor = opened(page, canvas)
    points = [{"x": x, "y": y, "part": part} for part, (x, y) in enumerate((HAIR, CAPE, (850, 480), (560, 400)))]
    document = {"version": 2, "width": 1280, "height": 720, "query_points": points}
    editor.ask(f"(node.widgets.find((one) => one.name === 'points').value = {json.dumps(json.dumps(document))}, 0)")
    editor.wait("editor.document.query_points?.length === 4")
    page.page.set_viewport_size({"width": across, "height": 780})
    try:
        editor.ask("(editor.commands.run('expand'), 0)")
        page.page.wait_for_timeout(600)
        assert editor.selector(".physanimator-part").count() == 4
        assert editor.ask(_OVERLAPS) == []
        editor.ask("(editor.commands.run('expand'), 0)")
    finally:
        page.page.set_viewport_size({"width": 1920, "height": 1080})


def test_a_picker_without_a_picture_says_how_to_get_one(page: Any, canvas: str) -> None:
    page.problems.clear()
    EditorPage.choose_canvas(page, canvas)
    page.run(_LOAD, json.dumps(blueprint()))
    segment = page.run(
        "() => { const { subgraph } = app.graph.nodes.find((node) => node.subgraph); app.canvas.setGraph(subgraph);"
        " return subgraph.nodes.find((node) => node.type === 'PhysAnimator_SegmentByPoints').id; }"
    )
    editor = EditorPage(page, segment)
    editor.look(scale=1.0)
    note = '[data-note="empty"]'
    told = editor.selector(note).inner_text()
    assert told.startswith("Connect a picture, such as that of Load Image, to the node of this subgraph")
    page.run("() => app.canvas.setGraph(app.graph)")
    assert page.problems == []
    holder = page.run("() => app.graph.nodes.find((node) => node.subgraph).id")
    page.run(
        "(id) => app.graph.getNodeById(id).subgraph && app.graph.unpackSubgraph(app.graph.getNodeById(id))", holder
    )
    page.problems.clear()  # some frontends complain of unpacking by themselves
    alone = page.run("() => app.graph.nodes.find((node) => node.type === 'PhysAnimator_SegmentByPoints').id")
    editor = EditorPage(page, alone)
    editor.look(*page.run("(id) => [...app.graph.getNodeById(id).pos]", alone), scale=1.0)
    assert editor.selector(note).inner_text().startswith("Connect a picture, such as that of Load Image, to image:")
    made = page.run(_ADD, ["EmptyImage", -1300, 0])
    page.run(
        "([from, to]) => { const [a, b] = [from, to].map((id) => app.graph.getNodeById(id));"
        " a.connect(0, b, b.inputs.findIndex((slot) => slot.name === 'image')); }",
        [made, alone],
    )
    editor.wait("editor.notes.shown.has('empty')")
    page.page.wait_for_timeout(700)
    assert "connect a Preview Image beside this node" in editor.selector(note).inner_text()
    assert page.problems == []
