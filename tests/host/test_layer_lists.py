"""Lists of layers in the nodes: what moves is switched on with a click, also where nothing moves by its name."""

from __future__ import annotations

import json
from typing import Any

import pytest
from editor_page import CANVASES, EditorPage
from layered_files import bust, filled, write_ora

_BUILD = """
async ([file, type]) => {
  app.graph.clear();
  app.nodeOutputs = {};
  // A graph that is opened comes later, too: Vue would take nodes of the same numbers for those before.
  await new Promise((done) => setTimeout(done));
  const add = (type, x, y) => {
    const node = LiteGraph.createNode(type);
    node.pos = [x, y];
    app.graph.add(node);
    return node;
  };
  const load = add('PhysAnimator_LoadLayers', -500, 0);
  const node = add(type, 0, 0);
  const widget = load.widgets.find((one) => one.name === 'file');
  widget.options.values = [...widget.options.values, file];
  widget.value = file;
  const slot = (slots, name) => slots.findIndex((one) => one.name === name);
  load.connect(slot(load.outputs, 'layers'), node, slot(node.inputs, 'layers'));
  if (type === 'PhysAnimator_ArtworkToBodies') {
    const scene = add('PhysAnimator_AutomaticScene', 700, 0);
    const simulate = add('PhysAnimator_Simulate', 700, 500);
    const shown = add('PhysAnimator_PreviewMotion', 1100, 0);
    node.connect(slot(node.outputs, 'bodies'), scene, slot(scene.inputs, 'bodies'));
    node.connect(slot(node.outputs, 'image'), shown, slot(shown.inputs, 'image'));
    scene.connect(0, simulate, slot(simulate.inputs, 'scene'));
    simulate.connect(0, shown, slot(shown.inputs, 'motion'));
  }
  await new Promise((done) => setTimeout(done, 300));
  return node.id;
}
"""
_LIST = "app.graph.getNodeById(id).physanimatorLayers"


@pytest.fixture(scope="module", params=sorted(CANVASES))
def canvas(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(scope="module")
def files(host: Any) -> dict[str, str]:
    """Layers whose names say what moves, and layers whose names do not."""
    write_ora(host.folder / "input" / "lists" / "bust.ora", bust())
    still = [("paper", bust()[0][1]), ("object 1", filled((250, 220, 180), 60, 20, 100, 60))]
    write_ora(host.folder / "input" / "lists" / "still.ora", still)
    return {name: f"lists/{name}.ora" for name in ("bust", "still")}


def built(page: Any, canvas: str, file: str, node: str) -> Any:
    page.problems.clear()
    page.page.set_default_timeout(20_000)
    EditorPage.choose_canvas(page, canvas)
    return page.run(_BUILD, [file, f"PhysAnimator_{node}"])


class NodeList:
    """The list in Artwork to Bodies."""

    def __init__(self, page: Any, node: Any) -> None:
        self.page, self.node = page, node

    def ask(self, expression: str) -> Any:
        return self.page.run(f"([id]) => {{ const list = {_LIST}; return {expression}; }}", [self.node])

    def wait(self, expression: str) -> None:
        script = f"([id]) => {{ const list = {_LIST}; return {expression}; }}"
        self.page.page.wait_for_function(script, arg=[self.node], timeout=90_000, polling=100)

    def click(self, selector: str) -> None:
        self.ask(f"list.root.querySelector('{selector}').click()")

    def choose(self, selector: str, value: str) -> None:
        change = f"(one) => {{ one.value = '{value}'; one.dispatchEvent(new Event('change')); }}"
        self.ask(f"({change})(list.root.querySelector('{selector}'))")

    def value(self) -> dict[str, Any]:
        return json.loads(self.ask("list.value.value"))

    def queued(self) -> dict[str, Any]:
        prompt = json.loads(self.page.run("async () => JSON.stringify((await app.graphToPrompt()).output)"))
        return prompt[str(self.node)]["inputs"]


def test_a_node_lists_its_layers_and_takes_what_the_list_says(page: Any, canvas: str, files: dict[str, str]) -> None:
    shown = NodeList(page, built(page, canvas, files["bust"], "ArtworkToBodies"))
    shown.wait("list.root.offsetHeight > 50")
    assert "once this node has run" in shown.ask("list.note.textContent")
    assert shown.queued()["scene"] == ""
    shown.click('[data-action="run"]')
    shown.wait("list.list.layers.length === 4")
    assert shown.ask("list.list.rows.map((row) => row.layer.name)") == ["前髪", "face", "後ろ髪", "background"]
    assert shown.ask("list.list.rows.map((row) => row.moves.checked)") == [True, False, True, False]
    assert shown.ask("list.list.rows[0].attach.value") == "crown"
    shown.click('[data-moves="face"]')
    shown.choose('[data-preset="face"]', "jelly")
    shown.choose('[data-attach="後ろ髪"]', "top")
    shown.click('[data-place="back 前髪"]')
    assert "next run" in shown.ask("list.note.textContent")
    document = json.loads(shown.queued()["scene"])
    assert document["bodies"] == [
        {"name": "後ろ髪", "attach": "top"},
        {"name": "前髪"},
        {"name": "face", "material": {"preset": "jelly"}, "attach": "auto"},
    ]
    assert document["order"] == ["background", "後ろ髪", "前髪", "face"]
    assert "rig_points" not in document
    shown.click('[data-action="run"]')
    shown.wait("list.list.layers.some((layer) => layer.name === 'face' && layer.moving)")
    assert shown.ask("list.list.rows.map((row) => row.layer.name)") == ["face", "前髪", "後ろ髪", "background"]
    assert shown.ask("list.note.textContent") == ""
    assert page.problems == []


def test_the_list_appears_where_nothing_moves_by_its_name(page: Any, canvas: str, files: dict[str, str]) -> None:
    shown = NodeList(page, built(page, canvas, files["still"], "ArtworkToBodies"))
    shown.click('[data-action="run"]')
    shown.wait("list.list.layers.length === 2")
    assert "No layer moves by its name" in shown.ask("list.note.textContent")
    page.page.keyboard.press("Escape")  # the host's own message
    shown.click('[data-moves="object 1"]')
    shown.click('[data-action="run"]')
    shown.wait("list.list.layers.some((layer) => layer.name === 'object 1' && layer.moving)")


def test_the_editor_s_list_appears_as_well(page: Any, canvas: str, files: dict[str, str]) -> None:
    editor = EditorPage(page, built(page, canvas, files["still"], "SceneEditor"))
    editor.look()
    editor.press("run")
    editor.wait("editor.layerList.layers.length === 2")
    assert editor.selector("[data-layer]").all_text_contents() == ["object 1", "paper"]
    page.page.keyboard.press("Escape")  # the host's own message
    editor.selector('[data-moves="object 1"]').click()
    editor.run_node()
    editor.wait("editor.live.mesh.names.includes('object 1')")
    assert {point["body"] for point in editor.value()["rig_points"]} == {0}


def test_after_undo_the_node_shows_its_own_list(page: Any, canvas: str, files: dict[str, str]) -> None:
    shown = NodeList(page, built(page, canvas, files["bust"], "ArtworkToBodies"))
    shown.wait("list.root.isConnected")
    undone = page.run(
        """async () => {
          const tracker = app.extensionManager.workflow.activeWorkflow.changeTracker;
          const capture = () => (tracker.captureCanvasState ?? tracker.checkState).call(tracker);
          capture();
          app.graph.nodes[0].title = 'Undone';
          capture();
          await tracker.undo();
          return app.graph.nodes[0].title !== 'Undone';
        }"""
    )
    assert undone
    shown.wait("list?.root.isConnected")
    assert page.run("() => document.querySelectorAll('.physanimator-list-only').length") == 1
