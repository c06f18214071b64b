"""The scene editor in the host's page, used as a person does: by pointer and keyboard."""

from __future__ import annotations

import base64
import json
from typing import Any

__all__ = ["CANVASES", "EditorPage"]

CANVASES = {"litegraph": False, "vue": True}

_CANVAS = """
async (vue) => {
  const settings = app.extensionManager.setting;
  if (settings.get('Comfy.VueNodes.Enabled') === vue) return false;
  await settings.set('Comfy.VueNodes.Enabled', vue);
  return true;
}
"""
_BUILD = """
async () => {
  app.graph.clear();
  app.nodeOutputs = {};
  const add = (type, x, y) => {
    const node = LiteGraph.createNode(type);
    node.pos = [x, y];
    app.graph.add(node);
    return node;
  };
  const link = (from, output, to, input) => from.connect(
    from.outputs.findIndex((slot) => slot.name === output), to, to.inputs.findIndex((slot) => slot.name === input));
  const example = add('PhysAnimator_ExampleIllustration', -1300, 0);
  const mesh = add('PhysAnimator_MaskToMesh', -1300, 300);
  const body = add('PhysAnimator_Body', -900, 0);
  const editor = add('PhysAnimator_SceneEditor', 0, 0);
  link(example, 'hair', mesh, 'mask');
  link(mesh, 'mesh', body, 'mesh');
  link(body, 'bodies', editor, 'bodies');
  link(example, 'image', editor, 'image');
  return editor.id;
}
"""
_VIEW = """
([x, y, scale]) => {
  app.canvas.ds.scale = scale;
  app.canvas.ds.offset = [60 / scale - x, 130 / scale - y];
  app.canvas.setDirty(true, true);
}
"""
_ALONE = """
(type) => {
  app.graph.clear();
  app.nodeOutputs = {};
  const node = LiteGraph.createNode(type);
  app.graph.add(node);
  return node.id;
}
"""
# A file that is dropped where the pointer is, as the browser tells the page.
_DROP = """
([id, text, name]) => {
  const { keys } = app.canvas.graph.getNodeById(id).physanimatorEditor.stage;
  const bytes = Uint8Array.from(atob(text), (one) => one.charCodeAt(0));
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([bytes], name, { type: 'image/png' }));
  for (const kind of ['dragover', 'drop']) {
    keys.dispatchEvent(new DragEvent(kind, { dataTransfer, bubbles: true, cancelable: true }));
  }
}
"""
# In the graph that is open, which may be a subgraph.
_NODE = "app.canvas.graph.getNodeById(id)"
_PLACE = f"""
([id, x, y]) => {{
  const {{ stage }} = ({_NODE}).physanimatorEditor;
  const box = stage.overlay.getBoundingClientRect();
  const ratio = box.width / stage.across;
  const {{ view }} = stage;
  return [box.left + (x * view.scale + view.x) * ratio, box.top + (y * view.scale + view.y) * ratio];
}}
"""
_ASK = f"""
([id, expression]) => {{
  const node = {_NODE};
  return new Function('editor', 'node', `return ${{expression}}`)(node.physanimatorEditor, node);
}}
"""


class EditorPage:
    """One scene editor in a graph.

    Attributes:
        page: the host's page.
        node: id of the editor's node.
    """

    def __init__(self, page: Any, node: Any) -> None:
        self.page, self.node = page, node

    @classmethod
    def opened(cls, page: Any, canvas: str) -> EditorPage:
        """A graph with the example's hair and an editor, in one of the two canvases."""
        cls.choose_canvas(page, canvas)
        editor = cls(page, page.run(_BUILD))
        editor.look()
        return editor

    @classmethod
    def animating(cls, page: Any, canvas: str) -> EditorPage:
        """A graph of nothing but Animate Illustration with the example, in one of the two canvases."""
        cls.choose_canvas(page, canvas)
        editor = cls(page, page.run(_ALONE, "PhysAnimator_AnimateIllustration"))
        editor.look(scale=1)
        editor.wait("editor.backdrop.picture !== null")
        return editor

    @staticmethod
    def choose_canvas(page: Any, canvas: str) -> None:
        if page.run(_CANVAS, CANVASES[canvas]):
            page.reload()

    def look(self, x: float = 0, y: float = 0, scale: float = 1.25) -> None:
        """Bring a part of the graph into view, so that the editor is large enough to be worked with."""
        self.page.run(_VIEW, [x, y, scale])
        self.page.page.wait_for_timeout(700)
        self.wait("editor.stage.across > 0 && editor.stage.down > 0", timeout=10_000)

    def ask(self, expression: str) -> Any:
        """The value of an expression in ``editor`` and ``node``."""
        return self.page.run(_ASK, [self.node, expression])

    def value(self) -> dict[str, Any]:
        """The scene document in the node."""
        return json.loads(self.ask("node.widgets.find((one) => one.name === 'scene').value"))

    def shown(self) -> dict[str, Any]:
        """The scene document as the editor has it."""
        return json.loads(self.ask("JSON.stringify(editor.document)"))

    def queued(self) -> dict[str, Any]:
        """The scene document as it would be queued."""
        prompt = json.loads(self.page.run("async () => JSON.stringify((await app.graphToPrompt()).output)"))
        return json.loads(prompt[str(self.node)]["inputs"]["scene"])

    def pixel(self) -> float:
        """A pixel of the screen, in pixels of the picture."""
        left, right = self.place(0, 0), self.place(100, 0)
        return 100 / (right[0] - left[0])

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Where a pixel of the picture is on the screen."""
        across, down = self.page.run(_PLACE, [self.node, x, y])
        return across, down

    def selector(self, inside: str) -> Any:
        return self.page.page.locator(".physanimator-editor").nth(self._number()).locator(inside)

    def _number(self) -> int:
        return self.ask("[...document.querySelectorAll('.physanimator-editor')].indexOf(editor.root)")

    def press(self, action: str) -> None:
        """A button of the toolbar or the timeline."""
        self.selector(f'[data-action="{action}"]').first.click()

    def drag(self, *points: tuple[float, float], steps: int = 6, button: str = "left") -> None:
        """Press at the first point of the picture, go through the others, release at the last."""
        mouse = self.page.page.mouse
        mouse.move(*self.place(*points[0]))
        mouse.down(button=button)
        for point in points[1:]:
            mouse.move(*self.place(*point), steps=steps)
        mouse.up(button=button)

    def click(self, x: float, y: float) -> None:
        self.page.page.mouse.click(*self.place(x, y))

    def drop(self, content: bytes, name: str) -> None:
        """Drop a picture file on the editor."""
        self.page.run(_DROP, [self.node, base64.b64encode(content).decode(), name])

    def keys(self, *keys: str) -> None:
        for key in keys:
            self.page.page.keyboard.press(key)

    def focus(self) -> None:
        self.ask("editor.stage.focus()")

    def type_into(self, path: str, text: str) -> None:
        """A number into the field of the selected item."""
        self.selector(f'[data-field="{path}"] input').first.fill(text)

    def run_node(self) -> None:
        """Press the editor's own button and wait until the bodies are known."""
        self.press("run")
        self.wait("editor.live.mesh !== null")

    def wait(self, expression: str, timeout: float = 60_000) -> None:
        script = f"([id]) => {{ const node = {_NODE}; const editor = node.physanimatorEditor; return {expression}; }}"
        self.page.page.wait_for_function(script, arg=[self.node], timeout=timeout, polling=100)

    def screenshot(self, path: str) -> None:
        self.selector(".physanimator-frame").screenshot(path=path)
