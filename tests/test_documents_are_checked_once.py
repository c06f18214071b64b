"""On every way from a scene document to a scene it is checked against the schema once."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from physanimator.nodes.host import checked_document
from physanimator.nodes.preview import preview_scene, read_request
from physanimator.physics.document import checked_scene_over, checking, loads, scene_over
from physanimator.physics.errors import SceneError
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.scene import Body
from physanimator.rendering.command import main
from physanimator.rendering.options import Timing
from physanimator.rendering.pictures import save_image
from physanimator.rendering.pipeline import animate

DOCUMENT: dict[str, Any] = {"version": 2, "width": 64, "height": 48, "strokes": [{"path": [[0, 20], [60, 20]]}]}


@pytest.fixture
def checks(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """What has been checked so far."""
    checked: list[object] = []
    original = checking._check_version
    monkeypatch.setattr(checking, "_check_version", lambda data: checked.append(data) or original(data))
    return checked


def picture() -> np.ndarray:
    return np.full((48, 64, 3), 200, np.uint8)


def part() -> np.ndarray:
    y, x = np.mgrid[0:48, 0:64]
    return (np.abs(x - 30) < 8) & (y > 5) & (y < 40)


def body() -> Body:
    corners = np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)])
    return Body(TriangleMesh(corners, np.array([[0, 1, 2]]), 64, 48))


def test_by_the_library(checks: list[object]) -> None:
    animate(picture(), [part()], scene=DOCUMENT, timing=Timing(frames=2))
    assert len(checks) == 1


def test_by_the_command_line(checks: list[object], tmp_path: Path) -> None:
    save_image(tmp_path / "girl.png", picture())
    save_image(tmp_path / "hair.png", part().astype(np.uint8) * 255)
    (tmp_path / "scene.json").write_text(json.dumps(DOCUMENT))
    names = {"--mask": "hair.png", "--scene": "scene.json", "--output": "out.mp4"}
    options = [word for option, name in names.items() for word in (option, str(tmp_path / name))]
    assert main(["animate", str(tmp_path / "girl.png"), *options, "--frames", "2", "--quiet"]) == 0
    assert len(checks) == 1


def test_over_bodies_and_from_text(checks: list[object]) -> None:
    scene_over(DOCUMENT, [body()])
    assert len(checks) == 1
    loads(json.dumps(DOCUMENT), meshes=[body().mesh])
    assert len(checks) == 2


def test_by_a_node_before_the_prompt_and_as_it_runs(checks: list[object]) -> None:
    text = json.dumps(DOCUMENT | {"width": 65})
    for _ in range(3):
        assert checked_scene_over(checked_document(text), [body()]).strokes
    assert len(checks) == 1
    wrong = json.dumps(DOCUMENT | {"width": 0})
    for _ in range(2):  # what is refused is not remembered as right
        with pytest.raises(SceneError, match="width"):
            checked_document(wrong)


def test_at_every_stroke_of_a_preview(checks: list[object]) -> None:
    request = {"editor": "one", "key": "0123456789abcdef" * 4, "scene": DOCUMENT, "frames": 24}
    preview_scene(read_request(json.dumps(request).encode()), [body()])
    assert len(checks) == 1
