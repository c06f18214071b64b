"""What editors ask for: what is accepted, and that anything else is refused with a sentence."""

from __future__ import annotations

import json
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from physanimator.nodes.preview import limits, preview_scene, read_request
from physanimator.nodes.preview.requests import is_key
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import preset
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.scene import Body

KEY = "0123456789abcdef" * 4
SCENE: dict[str, Any] = {"version": 2, "width": 100, "height": 50}
GOOD: dict[str, Any] = {"editor": "one", "key": KEY, "scene": SCENE, "frames": 24}


def body() -> Body:
    corners = np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)])
    return Body(TriangleMesh(corners, np.array([[0, 1, 2], [0, 2, 3]]), 100, 50), preset("hair"), name="lock")


def sent(**changes: Any) -> bytes:
    return json.dumps(GOOD | changes).encode()


def of_scene(**changes: Any) -> bytes:
    return sent(scene=SCENE | changes)


def test_a_good_request_gives_the_scene_over_the_bodies() -> None:
    request = read_request(
        of_scene(width=200, height=100, strokes=[{"path": [[0, 0], [20, 0]]}], bodies=[{"layer": 3}])
    )
    scene, frames = preview_scene(request, [body()])
    assert (request.editor, request.key, frames) == ("one", KEY, 24)
    assert scene.strokes[0].path == ((0, 0), (10, 0)), "a document for another size is scaled"
    assert (scene.bodies[0].layer, scene.bodies[0].name) == (3, "lock")


def test_of_a_loop_one_cycle_is_shown() -> None:
    assert preview_scene(read_request(of_scene(loop=2.0, frame_rate=12.0)), [body()])[1] == 24


def test_meshes_in_a_request_are_passed_over() -> None:
    mesh = {"vertices": [[0, 0], [1, 0], [0, 1]], "triangles": [[0, 1, 2]]}
    scene, _ = preview_scene(read_request(of_scene(bodies=[{"mesh": mesh}])), [body()])
    assert len(scene.bodies[0].mesh.triangles) == 2


def nested(depth: int) -> bytes:
    return b'{"editor": ' + b"[" * depth + b"]" * depth + b"}"


POLYGON = {"type": "polygon", "points": [[0, 0], [1, 0], [0, 1]]}
MASK = {"type": "mask", "width": 60_000, "height": 60_000, "runs": [1]}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (b"", "not JSON"),
        (b"\xff\xfe\x00", "UTF-8"),
        (b"[]", "an object with editor, frames, key, scene"),
        (json.dumps({**GOOD, "path": "/etc/passwd"}).encode(), "an object with editor"),
        (sent(editor=""), "1 to 64 characters"),
        (sent(editor="x" * 65), "1 to 64 characters"),
        (sent(editor=7), "1 to 64 characters"),
        (sent(key="../secret"), "64 hexadecimal digits"),
        (sent(key=KEY.upper()), "64 hexadecimal digits"),
        (sent(scene=[]), "a scene document"),
        (sent(frames=0), "1 to 1200"),
        (sent(frames=1201), "1 to 1200"),
        (sent(frames=True), "a whole number"),
        (sent(frames=1.5), "a whole number"),
        (b"[" + b"1," * 400_001 + b"1]", "at most 400,000 values"),
        (b"[" + b"[]," * 100_001 + b"1]", "at most 100,000 lists"),
        (b"[" + b"{}," * 10_001 + b"1]", "at most 10,000 objects"),
        (b"{" + b",".join(b'"%d":1' % k for k in range(100_001)) + b"}", "at most 100,000 keys"),
        (b'{"editor": "a", "editor": "b"}', "stands twice"),
        (b" " * (limits.MAX_REQUEST_BYTES + 1), "at most 4194304 bytes"),
        (nested(17), "nested at most 16 deep"),
        (nested(100_000), "nested"),
        (of_scene(strokes=[0] * 400_001), "at most 400,000 values"),
        (of_scene(strokes=[{}] * 10_001), "at most 10,000 objects"),
        (of_scene(strokes=[{}] * 401), "at most 400 strokes"),
        (of_scene(rig_points=[{}] * 1001), "at most 1,000 rig_points"),
        (of_scene(strokes=[{"path": [[0, 0]] * 40_001}]), "at most 40,000 points"),
        (of_scene(paint=[{"region": MASK}]), "at most 33,554,432 pixels of painted masks"),
    ],
)
def test_what_is_no_request_is_refused(text: bytes, words: str) -> None:
    with pytest.raises(InvalidInputError, match=words.replace("(", "\\(")):
        read_request(text)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"frame_rate": 0}, "^frame_rate: must be at least 1"),
        ({"loop": 600}, "at most 1,200 frames"),
        ({"strokes": [{"speed": 1e-9, "path": [[0, 0], [1, 0]]}]}, "at most 4096 particles"),
        ({"rig_points": [{"position": [0, 0], "body": 1}]}, "below the number of bodies"),
    ],
)
def test_what_is_more_than_a_preview_shows_is_refused(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidInputError, match=words):
        preview_scene(read_request(of_scene(**changes)), [body()])


def strip(columns: int) -> Body:
    """Two rows of vertices."""
    x = np.arange(columns, dtype=np.float64)
    vertices = np.concatenate([np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + 1])])
    low = np.arange(columns - 1)
    triangles = [
        np.column_stack([low, low + 1, low + columns]),
        np.column_stack([low + 1, low + 1 + columns, low + columns]),
    ]
    return Body(TriangleMesh(vertices, np.concatenate(triangles), columns, 2))


def test_bodies_too_large_for_a_preview_are_refused() -> None:
    request = read_request(sent())
    with pytest.raises(InvalidInputError, match="at most 60,000 triangles; mesh the bodies with a larger spacing"):
        preview_scene(request, [strip(30_002)])
    with pytest.raises(InvalidInputError, match="bytes; show fewer frames"):
        preview_scene(read_request(sent(frames=1200)), [strip(8_000)])
    corners = {"type": "polygon", "points": [[i, i % 2] for i in range(9_000)]}
    many = read_request(of_scene(width=15_000, height=2, rig_points=[{"position": [0, 0], "region": corners}]))
    with pytest.raises(InvalidInputError, match="too many corners"):
        preview_scene(many, [strip(15_000)])


anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=4),
    max_leaves=12,
)
KEYS = ["strokes", "rig_points", "paint", "bodies", "loop", "wind", "contact", "gravity", "width", "query_points"]


@settings(deadline=None, max_examples=300)
@given(
    changes=st.dictionaries(st.sampled_from(sorted(GOOD)), anything),
    scene=st.dictionaries(st.sampled_from(KEYS), anything),
)
def test_whatever_is_sent_is_a_preview_or_a_sentence(changes: dict[str, Any], scene: dict[str, Any]) -> None:
    with suppress(InvalidInputError):
        request = read_request(json.dumps({**GOOD, "scene": SCENE | scene, **changes}).encode())
        assert preview_scene(request, [body()])[1] <= limits.MAX_FRAMES


@settings(deadline=None, max_examples=200)
@given(body=st.binary(max_size=60))
def test_whatever_bytes_are_sent_are_refused(body: bytes) -> None:
    with pytest.raises(InvalidInputError):
        read_request(body)


@pytest.mark.parametrize("key", ["", KEY + "0", KEY[:-1], KEY[:-1] + "\n", f"{KEY}\n", None, 3])
def test_a_key_is_64_hexadecimal_digits(key: object) -> None:
    assert is_key(KEY)
    assert not is_key(key)
