"""Writes the workflows in both formats and their thumbnails from a real ComfyUI, and the nodes' schemas for the tests.

    COMFYUI_PATH=/path/to/ComfyUI /path/to/its/python tests/host/export_workflows.py [workflow ...]

Without names, all of them; those with nodes that the host lacks stay as they are. The graphs are described in graphs.py
and the files beside it that end like it. The frontend itself builds and serialises them: the files are what it would
save; the API files are what it would post.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import uuid
from dataclasses import asdict
from pathlib import Path
from typing import Any

import thumbnails
from browser import Page, opened
from comfy_host import ROOT, Host
from frame_interpolation_graph import NAME, with_frame_interpolation
from graphs import WORKFLOWS, Group
from layer_graphs import LAYER_WORKFLOWS
from more_video_model_graphs import MORE_VIDEO_MODEL_WORKFLOWS
from paper_graphs import PAPER_WORKFLOWS
from showcase_graphs import SHOWCASE_WORKFLOWS
from stamps import stamped
from video_model_graphs import VIDEO_MODEL_WORKFLOWS

SCHEMAS = ROOT / "tests" / "nodes" / "node_schemas.json"
_VIDEO = VIDEO_MODEL_WORKFLOWS | MORE_VIDEO_MODEL_WORKFLOWS
_WORKFLOWS = WORKFLOWS | PAPER_WORKFLOWS | SHOWCASE_WORKFLOWS | LAYER_WORKFLOWS | _VIDEO
_NOTES = {"MarkdownNote", "Note"}
"""Nodes of the page alone."""
_GAP = 40
# The Vue canvas of newer frontends draws nodes taller than this one.
_ROW_GAP = 75
_TITLE = 70


_BUILD = """
async ({groups, gap, rowGap, title}) => {
  app.graph.clear();
  const made = {};
  let x = 0;
  for (const group of groups) {
    const left = x;
    let bottom = 0;
    x += gap / 2;
    for (const column of group.columns) {
      let y = title;
      for (const spec of column.nodes) {
        const node = LiteGraph.createNode(spec.type);
        if (!node) throw new Error(`no node type ${spec.type}`);
        app.graph.add(node);
        if (spec.title) node.title = spec.title;
        for (const [name, value] of Object.entries(spec.values)) {
          const widget = name ? node.widgets.find((w) => w.name === name) : node.widgets[0];
          if (!widget) throw new Error(`${spec.type} has no widget ${name}`);
          widget.value = value;
          widget.callback?.(value);
          // A dynamic combo brings its inputs a moment later.
          await new Promise((done) => setTimeout(done, 20));
        }
        const needed = node.computeSize();
        node.setSize([column.width, Math.max(spec.height, needed[1])]);
        node.pos = [x, y];
        y += node.size[1] + rowGap + LiteGraph.NODE_TITLE_HEIGHT;
        made[spec.key] = node;
      }
      bottom = Math.max(bottom, y);
      x += column.width + gap;
    }
    const frame = new LiteGraph.LGraphGroup(group.title);
    frame.pos = [left, -title / 4];
    frame.size = [x - gap / 2 - left, bottom - rowGap / 2 + title / 4];
    frame.color = group.color;
    app.graph.add(frame);
    x += gap;
  }
  for (const spec of groups.flatMap((group) => group.columns.flatMap((column) => column.nodes))) {
    for (const [input, source] of Object.entries(spec.inputs)) {
      const [key, output] = source.split('.');
      const from = made[key].outputs.findIndex((slot) => slot.name === output);
      const to = made[spec.key].inputs.findIndex((slot) => slot.name === input);
      if (from < 0 || to < 0 || !made[key].connect(from, made[spec.key], to)) {
        throw new Error(`cannot connect ${source} to ${spec.key}.${input}`);
      }
    }
  }
  await new Promise((done) => setTimeout(done, 300));
  // As text, because a value handed over as an object would turn what is undefined into null.
  return JSON.stringify({ui: app.graph.serialize(), api: (await app.graphToPrompt()).output});
}
"""


def export(page: Page, name: str, groups: tuple[Group, ...]) -> tuple[dict[str, Any], dict[str, Any]]:
    """The graph as the frontend saves it and as it posts it."""
    described = {"groups": [asdict(group) for group in groups], "gap": _GAP, "rowGap": _ROW_GAP, "title": _TITLE}
    graphs = json.loads(page.run(_BUILD, described))
    ui, api = graphs["ui"], graphs["api"]
    ui["id"] = str(uuid.uuid5(uuid.NAMESPACE_URL, f"physanimator/{name}"))
    ui["extra"] = {"ds": _view(ui)}
    return stamped(ui), api


def _view(ui: dict[str, Any]) -> dict[str, Any]:
    """Scale and offset that show the graph on an ordinary screen, readably."""
    left, top, right, bottom = (
        pick(value)
        for pick, value in (
            (min, [group["bounding"][0] for group in ui["groups"]]),
            (min, [group["bounding"][1] for group in ui["groups"]]),
            (max, [group["bounding"][0] + group["bounding"][2] for group in ui["groups"]]),
            (max, [group["bounding"][1] + group["bounding"][3] for group in ui["groups"]]),
        )
    )
    # Below this scale the canvas draws no text: then rather show the beginning.
    scale = round(max(0.6, min(1700 / (right - left), 900 / (bottom - top))), 3)
    return {"scale": scale, "offset": [round(120 / scale - left, 1), round(130 / scale - top, 1)]}


def schemas(host: Host) -> dict[str, Any]:
    """What the host tells about the nodes of this pack, without the words by which they are found."""
    info = host.get("/object_info")
    ours = {name: info[name] for name in sorted(info) if name.startswith("PhysAnimator_")}
    return {name: {key: told for key, told in node.items() if key != "search_aliases"} for name, node in ours.items()}


def _types(groups: tuple[Group, ...]) -> set[str]:
    return {node.type for group in groups for column in group.columns for node in column.nodes}


def _write(path: Path, data: Any) -> None:
    path.parent.mkdir(exist_ok=True)
    path.write_text(json.dumps(data, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    print(path.relative_to(ROOT))


def _write_for_newer_hosts() -> None:
    """What is made of the quickstart."""
    folders = ROOT / "workflows", ROOT / "workflows" / "api"
    quickstart = [json.loads((folder / "quickstart.json").read_text(encoding="utf-8")) for folder in folders]
    for folder, graph in zip(folders, with_frame_interpolation(*quickstart), strict=True):
        _write(folder / f"{NAME}.json", graph)
    thumbnails.write(NAME)


def main() -> None:
    if "COMFYUI_PATH" not in os.environ:
        sys.exit("set COMFYUI_PATH to a ComfyUI checkout")
    with tempfile.TemporaryDirectory() as folder:
        python = os.environ.get("COMFYUI_PYTHON", sys.executable)
        host = Host(Path(os.environ["COMFYUI_PATH"]).resolve(), python, Path(folder))
        try:
            host.wait_until_ready()
            _write(SCHEMAS, schemas(host))
            with opened(host.url) as page:
                known = set(host.get("/object_info")) | _NOTES
                for name in sys.argv[1:] or _WORKFLOWS:
                    if missing := _types(_WORKFLOWS[name]()) - known:
                        print(f"{name} stays as it is: this host has no {', '.join(sorted(missing))}")
                        continue
                    ui, api = export(page, name, _WORKFLOWS[name]())
                    _write(ROOT / "workflows" / f"{name}.json", ui)
                    _write(ROOT / "workflows" / "api" / f"{name}.json", api)
                    thumbnails.write(name)
            _write_for_newer_hosts()
        finally:
            host.stop()


if __name__ == "__main__":
    main()
