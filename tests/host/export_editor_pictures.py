"""Writes the pictures of the scene editor's help page from the editor itself, in a real ComfyUI.

    COMFYUI_PATH=/path/to/ComfyUI /path/to/its/python tests/host/export_editor_pictures.py [folder]

Without a folder they go beside the help page; a folder also gets one picture of every tool in use.
"""

from __future__ import annotations

import io
import json
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from browser import opened
from comfy_host import ROOT, Host
from editor_page import EditorPage
from graphs import DRAWN
from PIL import Image

WIDTH = 1000

# The graph of the editor's page has the hair alone.
HAIR = DRAWN | {"strokes": DRAWN["strokes"][:1], "rig_points": [DRAWN["rig_points"][0] | {"body": 0}]}

# What a person does with each tool, in pixels of the example.
TOOLS: dict[str, Callable[[EditorPage], None]] = {
    "wind": lambda editor: editor.drag((430, 330), (640, 250), (830, 340), (1000, 270)),
    "repel": lambda editor: editor.drag((950, 470), (800, 350)),
    "attract": lambda editor: editor.click(930, 250),
    "pin": lambda editor: editor.click(560, 130),
    "path": lambda editor: editor.drag((820, 300), (900, 220), (980, 300), steps=12),
    "wave": lambda editor: editor.drag((700, 260), (700, 330)),
    "region-circle": lambda editor: editor.drag((545, 200), (600, 260)),
    "region-polygon": lambda editor: editor.drag(*[(x, y) for x, y in DRAWN["rig_points"][0]["region"]["points"]]),
    "region-brush": lambda editor: editor.drag((520, 140), (590, 220), (600, 340)),
    "stiffness": lambda editor: editor.drag((640, 250), (760, 240), (800, 330)),
}


def save(png: bytes, path: Path) -> None:
    """A picture small enough for a help page."""
    image = Image.open(io.BytesIO(png)).convert("RGB")
    height = round(WIDTH * image.height / image.width)
    image.resize((WIDTH, height), Image.Resampling.LANCZOS).save(path, quality=82, optimize=True)
    print(path)


def tell(editor: EditorPage, document: object) -> None:
    """Put a document into the node, as a workflow brings it."""
    text = json.dumps(json.dumps(document))
    editor.ask(f"node.widgets.find((one) => one.name === 'scene').value = {text}")
    editor.wait(f"editor.text === {text}")


def every_tool(editor: EditorPage, folder: Path) -> None:
    for name, use in TOOLS.items():
        tell(editor, {"version": 2, "width": 1280, "height": 720})
        editor.press(name)
        use(editor)
        editor.page.page.wait_for_timeout(800)
        save(editor.selector(".physanimator-frame").screenshot(), folder / f"tool_{name}.jpg")


def overview(editor: EditorPage, folder: Path) -> None:
    tell(editor, HAIR)
    editor.press("expand")
    editor.press("select")
    editor.click(560, 290)
    editor.wait("editor.live.measured.frames >= 72 && editor.live.player.plate !== editor.live.player.picture")
    editor.ask("editor.commands.seek(26)")
    editor.page.page.wait_for_timeout(500)
    save(editor.selector(".physanimator-frame").screenshot(), folder / "scene_editor.jpg")
    editor.ask("editor.select({ list: 'rig_points', index: 0 })")
    editor.press("mesh")
    editor.page.page.wait_for_timeout(500)
    save(editor.selector(".physanimator-frame").screenshot(), folder / "scene_editor_pin.jpg")
    editor.keys("Escape", "Escape")


def main() -> None:
    if "COMFYUI_PATH" not in os.environ:
        sys.exit("set COMFYUI_PATH to a ComfyUI checkout")
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "nodes" / "web" / "docs"
    with tempfile.TemporaryDirectory() as place:
        python = os.environ.get("COMFYUI_PYTHON", sys.executable)
        host = Host(Path(os.environ["COMFYUI_PATH"]).resolve(), python, Path(place))
        try:
            host.wait_until_ready()
            with opened(host.url) as page:
                editor = EditorPage.opened(page, "litegraph")
                editor.run_node()
                overview(editor, folder)
                if len(sys.argv) > 1:
                    every_tool(editor, folder)
        finally:
            host.stop()


if __name__ == "__main__":
    main()
