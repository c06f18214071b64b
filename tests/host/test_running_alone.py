"""Our own Run buttons: each runs its node, whatever else is in the graph, or says why it cannot."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from editor_page import CANVASES, EditorPage
from layered_files import bust, write_ora

_LAYERS = """
([file]) => {
  app.graph.clear();
  app.nodeOutputs = {};
  const add = (type, x) => {
    const node = LiteGraph.createNode(type);
    node.pos = [x, 0];
    app.graph.add(node);
    return node;
  };
  const [load, bodies] = [add('PhysAnimator_LoadLayers', -500), add('PhysAnimator_ArtworkToBodies', 0)];
  const widget = load.widgets.find((one) => one.name === 'file');
  widget.options.values = [...widget.options.values, file];
  widget.value = file;
  load.connect(0, bodies, bodies.inputs.findIndex((one) => one.name === 'layers'));
  return bodies.id;
}
"""
_COUNTED = """
() => {
  window.queued = 0;
  if (window.counting) return;
  window.counting = true;
  const { api } = app;
  const post = api.queuePrompt;
  api.queuePrompt = (...given) => {
    window.queued += 1;
    return post.apply(api, given);
  };
}
"""
_TOLD = (
    "() => [...document.querySelectorAll('.p-toast-message, [data-toast-kind], .p-dialog')].map((one) => one.innerText)"
)


@pytest.fixture(params=sorted(CANVASES))
def canvas(request: pytest.FixtureRequest) -> str:
    return request.param


def test_a_list_of_layers_appears_in_a_graph_without_an_output(host: Any, page: Any, canvas: str) -> None:
    folder = Path(host.folder) / "input"
    folder.mkdir(exist_ok=True)
    write_ora(folder / "alone.ora", bust())
    page.problems.clear()
    EditorPage.choose_canvas(page, canvas)
    node = page.run(_LAYERS, ["alone.ora"])
    page.page.wait_for_timeout(800)
    listed = "([id]) => app.graph.getNodeById(id).physanimatorLayers.list.layers.length"
    page.run("([id]) => app.graph.getNodeById(id).physanimatorLayers.run.click()", [node])
    page.page.wait_for_function(f"(given) => ({listed})(given) === 4", arg=[node], timeout=60_000)
    assert not any("no outputs" in each for each in page.run(_TOLD))
    assert page.problems == []


@pytest.mark.parametrize("mode", [2, 4], ids=["muted", "bypassed"])
def test_a_node_that_is_left_out_says_so_and_runs_nothing(page: Any, canvas: str, mode: int) -> None:
    editor = EditorPage.opened(page, canvas)
    before = sum(map(_says_so, page.run(_TOLD)))
    editor.ask(f"(node.mode = {mode})")
    page.run(_COUNTED)
    editor.press("run")
    page.page.wait_for_timeout(800)
    told = page.run(_TOLD)
    assert sum(map(_says_so, told)) == before + 1
    assert not any("no outputs" in each for each in told), "that is the host's word for it"
    assert page.run("() => window.queued") == 0
    assert "Run this node" in editor.ask("editor.root.innerText"), "it can be tried again"
    editor.ask("(node.mode = 0)")
    editor.run_node()
    assert page.run("() => window.queued") == 1
    assert page.problems == []


def _says_so(told: str) -> bool:
    return "muted or bypassed" in told
