"""The same in a real ComfyUI and Chromium: from the pen that is lifted to the picture that moves."""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
from pathlib import Path
from typing import Any

import source_tree

__all__ = ["measured"]

_SPACING = 16  # [px]: some 1,100 triangles

_SPACED = """
(spacing) => {
  const node = app.graph.nodes.find((one) => one.comfyClass === 'PhysAnimator_MaskToMesh');
  node.widgets.find((one) => one.name === 'spacing').value = spacing;
}
"""
_FORGET = "() => performance.clearMarks()"
_MARK = """
(name) => performance.getEntriesByName('physanimator-' + name).at(-1)?.startTime ?? null
"""
_MOVES = "() => performance.getEntriesByName('physanimator-moves').length > 0"
# Slowest and median time from one drawing of the page to the next while a pen goes over the picture.
_WATCH = """
() => {
  const times = window.physanimatorBenchmark = [];
  const count = (now) => {
    times.push(now);
    if (window.physanimatorBenchmark === times) requestAnimationFrame(count);
  };
  requestAnimationFrame(count);
}
"""
_WATCHED = """
() => {
  const times = window.physanimatorBenchmark;
  delete window.physanimatorBenchmark;
  return times.slice(1).map((time, k) => time - times[k]);
}
"""


def measured(rounds: int) -> dict[str, Any]:
    """Wind drawn with the pointer, in both canvases.

    Args:
        rounds: strokes of each canvas; the first one after the node has run is told apart.
    """
    browser, comfy_host, editor_page = map(source_tree.helper, ("host/browser", "host/comfy_host", "host/editor_page"))
    path = os.environ.get("COMFYUI_PATH")
    if not path:
        raise SystemExit("set COMFYUI_PATH to a ComfyUI checkout (and COMFYUI_PYTHON to its Python) for --browser")
    with tempfile.TemporaryDirectory() as folder:
        python = os.environ.get("COMFYUI_PYTHON", sys.executable)
        server = comfy_host.Host(Path(path).resolve(), python, Path(folder))
        try:
            server.wait_until_ready()
            with browser.opened(server.url) as page:
                return {
                    canvas: _drawn(editor_page.EditorPage.opened(page, canvas), rounds)
                    for canvas in editor_page.CANVASES
                }
        finally:
            server.stop()


def _drawn(editor: Any, rounds: int) -> dict[str, Any]:
    editor.page.run(_SPACED, _SPACING)
    editor.run_node()
    editor.wait("editor.live.player.plate !== editor.live.player.picture")
    editor.press("pin")
    editor.click(560, 120)
    editor.press("wind")
    times = [_stroke(editor, y) for y in range(200, 200 + 12 * (rounds + 1), 12)]
    strokes = [{"kind": "wind", "path": [[6 * k, 40 + 3 * k], [300 + 4 * k, 80 + 3 * k]]} for k in range(200)]
    editor.ask(f"editor.commit({{...editor.document, strokes: {strokes}}}, null)")
    editor.page.page.wait_for_timeout(2000)
    editor.page.run(_WATCH)
    editor.drag((200, 600), (1000, 640), (300, 500), steps=20)
    drawing = editor.page.run(_WATCHED)
    return {
        "pen_up_to_first_frame_ms": statistics.median(times[1:]),
        "slowest_first_frame_ms": max(times[1:]),
        "first_stroke_ms": times[0],
        "triangles": editor.ask("editor.live.mesh.triangles.length / 3"),
        "frame_with_200_strokes_ms": {"median": statistics.median(drawing), "slowest": max(drawing)},
    }


def _stroke(editor: Any, y: float) -> float:
    """Draw one stroke; milliseconds from pen-up to the first moving frame on the screen."""
    editor.page.page.wait_for_timeout(700)
    editor.page.run(_FORGET)
    editor.drag((420, y), (660, y - 30), (900, y - 60), steps=10)
    editor.page.page.wait_for_function(_MOVES, polling=20)
    ended, moves = (editor.page.run(_MARK, name) for name in ("pen-up", "moves"))
    return moves - ended
