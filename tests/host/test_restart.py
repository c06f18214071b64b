"""The server stops and starts again under an open page: the editors say so, and go on by themselves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from editor_page import CANVASES, EditorPage

HAIR, MORE_HAIR = (700, 300), (640, 250)
GONE = "The server does not answer. Is ComfyUI still running?"
_NOTES = "[...editor.notes.shown.values()].map((note) => note.firstChild.textContent)"


@pytest.fixture(params=sorted(CANVASES))
def canvas(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def restarted(host: Any, page: Any) -> Iterator[Any]:
    """The page; the server runs again afterwards."""
    yield page
    if host.stopped:
        host.start()
        host.wait_until_ready()
    page.reload()
    page.problems.clear()  # the host's own about the server that was gone


def test_the_picker_asks_again_once_the_server_is_back(restarted: Any, host: Any, canvas: str) -> None:
    editor = EditorPage.animating(restarted, canvas)
    editor.click(*HAIR)
    editor.wait("editor.live.measured.drawn > 0")
    host.stop()
    editor.click(*MORE_HAIR)
    editor.wait(f"{_NOTES}.length > 0")
    editor.page.page.wait_for_timeout(1500)
    assert editor.ask(_NOTES) == [GONE]
    host.start()
    host.wait_until_ready()
    editor.wait("editor.picking.cuts?.length === 1 && editor.live.measured.drawn > 0", 120_000)
    assert GONE not in editor.ask(_NOTES)
    assert len(editor.shown()["query_points"]) == 2


def test_the_scene_editor_says_what_to_do_once_the_server_is_back(restarted: Any, host: Any, canvas: str) -> None:
    editor = EditorPage.opened(restarted, canvas)
    editor.run_node()
    editor.wait("editor.live.measured.drawn > 0")
    host.stop()
    editor.press("wind")
    editor.drag((300, 200), (900, 300))
    editor.wait(f"{_NOTES}.includes('{GONE}')")
    host.start()
    host.wait_until_ready()
    editor.wait("/does not hold these bodies any more/.test(editor.notes.root.textContent)", 60_000)
    assert GONE not in editor.ask(_NOTES)
    assert len(editor.shown()["strokes"]) == 1
    editor.run_node()
    editor.wait("editor.live.measured.drawn > 0 && editor.live.playback.moving")
