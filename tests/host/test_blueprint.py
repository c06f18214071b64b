"""The subgraph blueprint: hosts list it, and it opens into separate nodes that run."""

from __future__ import annotations

import json
from typing import Any

import pytest
from blueprints import BLUEPRINT, blueprint
from editor_page import CANVASES, EditorPage

HAIR = "[[700, 300, 1]]"

_BUILD = """
async ([workflow, points]) => {
  await app.loadGraphData(JSON.parse(workflow), true, true);
  await new Promise((done) => setTimeout(done, 500));
  const holder = app.graph.nodes.find((node) => node.subgraph);
  const example = LiteGraph.createNode('PhysAnimator_ExampleIllustration');
  app.graph.add(example);
  example.connect(0, holder, holder.inputs.findIndex((slot) => slot.name === 'image'));
  const seen = LiteGraph.createNode('PreviewImage');
  app.graph.add(seen);
  holder.connect(holder.outputs.findIndex((slot) => slot.name === 'frames'), seen, 0);
  const segment = holder.subgraph.nodes.find((node) => node.type === 'PhysAnimator_SegmentByPoints');
  segment.widgets.find((widget) => widget.name === 'points').value = points;
  const frames = holder.widgets.find((widget) => widget.name === 'frames');
  frames.value = 3;
  frames.callback?.(3);
  return [holder.id, String(seen.id), holder.widgets.map((widget) => widget.name)];
}
"""
_UNPACK = "(id) => app.graph.unpackSubgraph(app.graph.getNodeById(id))"
_PROMPT = "async () => JSON.stringify((await app.graphToPrompt()).output)"


def test_the_file_is_what_is_made_of_the_nodes() -> None:
    assert json.loads(BLUEPRINT.read_text(encoding="utf-8")) == blueprint(), "run tests/host/blueprints.py"


def test_the_host_lists_it(host: Any) -> None:
    listed = host.get("/global_subgraphs")
    (identity,) = [key for key, entry in listed.items() if entry["name"] == BLUEPRINT.stem]
    assert listed[identity]["info"]["node_pack"] == "custom_nodes.PhysAnimator"
    assert json.loads(host.get(f"/global_subgraphs/{identity}")["data"]) == blueprint()


@pytest.mark.parametrize("canvas", sorted(CANVASES))
def test_it_runs_and_opens_into_nodes_that_run_alike(host: Any, page: Any, canvas: str) -> None:
    page.problems.clear()
    EditorPage.choose_canvas(page, canvas)
    holder, seen, widgets = page.run(_BUILD, [json.dumps(blueprint()), HAIR])
    assert {"preset", "wind_strength", "wind_angle", "loop", "frames", "frame_rate"} <= set(widgets)
    whole = json.loads(page.run(_PROMPT))
    of_subgraph = host.run(whole)[seen]["images"]
    assert len(of_subgraph) == 3
    page.run(_UNPACK, holder)
    opened = json.loads(page.run(_PROMPT))
    names = {node["class_type"].removeprefix("PhysAnimator_") for node in opened.values()}
    assert {"SegmentByPoints", "MaskToMesh", "Body", "AutomaticScene", "Simulate", "Render"} <= names
    (shown,) = [key for key, node in opened.items() if node["class_type"] == "PreviewImage"]
    of_nodes = host.run(opened)[shown]["images"]
    assert [host.view(saved) for saved in of_nodes] == [host.view(saved) for saved in of_subgraph]
    assert page.problems == []
