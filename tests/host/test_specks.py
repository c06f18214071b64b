"""A click on a dot: it is cut out, and one sentence says that it is too small to move."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
import pytest
from editor_page import CANVASES, EditorPage

BAR, DOT = (60, 60), (150, 60)
_NOTES = "[...editor.notes.shown.values()].map((note) => [note.dataset.kind, note.firstChild.textContent])"


def drawn() -> bytes:
    """A bar, and a dot of one pixel beside it; blue, green, red."""
    picture = np.full((120, 200, 3), 235, np.uint8)
    picture[20:100, 50:74], picture[DOT[1], DOT[0]] = (40, 40, 200), (200, 60, 40)
    return bytes(cv2.imencode(".png", picture)[1])


@pytest.mark.parametrize("canvas", sorted(CANVASES))
def test_it_is_said_once_and_what_is_large_enough_moves(page: Any, canvas: str) -> None:
    page.problems.clear()
    editor = EditorPage.animating(page, canvas)
    editor.drop(drawn(), "dot.png")
    editor.wait("editor.document.width === 200")
    page.page.wait_for_timeout(400)
    editor.click(*DOT)
    editor.wait("editor.picking.cuts?.length === 1 && !editor.notes.shown.has('pick')")
    page.page.wait_for_timeout(1500)
    ((kind, said),) = editor.ask(_NOTES)
    assert kind == "info"
    assert said.startswith("The point on the part cut out hardly more than itself")
    page.page.keyboard.down("Shift")
    editor.click(*BAR)
    page.page.keyboard.up("Shift")
    editor.wait("editor.picking.cuts?.length === 2 && editor.live.measured.largest > 0.5")
    ((kind, said),) = editor.ask(_NOTES)
    assert "hardly more than itself" in said
    assert page.problems == []
