"""What an editor asks for, read without trust: a scene over bodies that the server keeps, and how many frames of it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...physics.checks import is_whole
from ...physics.document import LayerMasks, Most, read_json, surplus_of
from ...physics.errors import InvalidInputError, counted, require
from ...physics.limits import MAX_SIDE
from ...physics.scene import Body, Scene
from ...physics.simulation import loop_frames
from .limits import (
    MAX_ANSWER_BYTES,
    MAX_EDITOR_NAME,
    MAX_FRAMES,
    MAX_KEYS,
    MAX_LISTS,
    MAX_NESTING,
    MAX_OBJECTS,
    MAX_PREVIEW_CROSSINGS,
    MAX_PREVIEW_CROWDING,
    MAX_PREVIEW_MASK_PIXELS,
    MAX_PREVIEW_OUTLINE_POINTS,
    MAX_PREVIEW_PAINT_WORK,
    MAX_PREVIEW_POINTS,
    MAX_PREVIEW_REGION_WORK,
    MAX_PREVIEW_RIG_POINTS,
    MAX_PREVIEW_STROKES,
    MAX_PREVIEW_TRIANGLES,
    MAX_REQUEST_BYTES,
    MAX_VALUES,
)

__all__ = ["PreviewRequest", "document_points", "is_key", "preview_scene", "read_bounded", "read_request"]

_MOST = Most(values=MAX_VALUES, lists=MAX_LISTS, objects=MAX_OBJECTS, keys=MAX_KEYS)
_COARSER = "paint on a coarser mask"
_FIELDS = {"editor", "key", "scene", "frames"}
_KEY = re.compile(r"[0-9a-f]{64}")
_POINT_LISTS = ("path", "points", "times", "strength_keys", "speed_keys", "angles", "factors")


@dataclass(frozen=True)
class PreviewRequest:
    """A request whose form is right; its scene has not been checked yet.

    Attributes:
        editor: which editor asks; a later request of it takes the place of an earlier one.
        key: of the bodies.
        document: the decoded scene document.
        frames: how many frames to show, the drawing included; of a loop, those of one cycle are shown.
    """

    editor: str
    key: str
    document: dict[str, Any]
    frames: int


def is_key(text: object) -> bool:
    """Whether something has the form of a key: 64 hexadecimal digits."""
    return isinstance(text, str) and _KEY.fullmatch(text) is not None


def read_request(body: bytes) -> PreviewRequest:
    """The request in the body of a POST.

    Raises:
        InvalidInputError: it is no such request, or larger than the limits.
    """
    data = read_bounded(body)
    named = isinstance(data, dict) and set(data) == _FIELDS
    require("the request", _shown(data), named, f"an object with {', '.join(sorted(_FIELDS))}")
    editor, key, document, frames = (data[name] for name in ("editor", "key", "scene", "frames"))
    is_name = isinstance(editor, str) and 0 < len(editor) <= MAX_EDITOR_NAME
    require("editor", _shown(editor), is_name, f"a text of 1 to {MAX_EDITOR_NAME} characters")
    require("key", _shown(key), is_key(key), "64 hexadecimal digits")
    require("scene", _shown(document), isinstance(document, dict), "a scene document, an object in braces")
    whole = type(frames) is int and 1 <= frames <= MAX_FRAMES
    require("frames", _shown(frames), whole, f"a whole number from 1 to {MAX_FRAMES}")
    _require_few(document, "strokes", MAX_PREVIEW_STROKES)
    _require_few(document, "rig_points", MAX_PREVIEW_RIG_POINTS)
    points, pixels = _count_points(document)
    _require_preview("points", points, MAX_PREVIEW_POINTS, "draw with fewer of them")
    _require_preview("pixels of painted masks", pixels, MAX_PREVIEW_MASK_PIXELS, _COARSER)
    return PreviewRequest(editor, key, document, frames)


def read_bounded(body: bytes) -> Any:
    """The JSON in the body of a POST.

    Raises:
        InvalidInputError: it is none, or larger, deeper or of more parts than the limits.
    """
    require(
        "the request", counted(len(body), "byte"), len(body) <= MAX_REQUEST_BYTES, f"at most {MAX_REQUEST_BYTES} bytes"
    )
    if surplus := surplus_of(body, _MOST):
        raise InvalidInputError(f"the request must hold at most {surplus}. Got: more")
    data = read_json(body)
    _require_small(data)
    return data


def preview_scene(
    request: PreviewRequest, bodies: Sequence[Body], layers: LayerMasks | None = None
) -> tuple[Scene, int]:
    """The scene to simulate for a request, and how many frames of it.

    Args:
        request: what an editor asks for.
        bodies: over which its scene is.
        layers: gives the mask of a still layer by its name; None where there are no layers.

    Raises:
        SceneError: a value of the scene is wrong.
        InvalidInputError: it is more than a preview shows.
    """
    from ...physics.document import check_document, checked_scene_over, mask_pixels
    from ...physics.scene import held_where_said, region_work

    triangles = sum(len(body.mesh.triangles) for body in bodies)
    _require_preview("triangles", triangles, MAX_PREVIEW_TRIANGLES, "mesh the bodies with a larger spacing")
    document = check_document(request.document)
    _require_preview("pixels of painted masks", mask_pixels(document), MAX_PREVIEW_MASK_PIXELS, _COARSER)
    scene = held_where_said(checked_scene_over(document, bodies, layers=layers))
    frames = request.frames if scene.loop is None else loop_frames(scene)
    _require_preview("frames", frames, MAX_FRAMES, "shorten the loop")
    vertices = sum(len(body.mesh.vertices) for body in bodies)
    _require_preview("bytes", 4 * vertices * frames, MAX_ANSWER_BYTES, "show fewer frames, or mesh more coarsely")
    comparisons = region_work(scene.rig_points, bodies)
    if comparisons > MAX_PREVIEW_REGION_WORK:
        raise InvalidInputError(
            f"The polygons of all rig points have too many corners for a live preview of {vertices:,} vertices; draw"
            f" them with fewer, or mesh more coarsely. Got: {comparisons:,} corners times vertices, at most"
            f" {MAX_PREVIEW_REGION_WORK:,.0f} are allowed"
        )
    if len(scene.paint) * triangles > MAX_PREVIEW_PAINT_WORK:
        raise InvalidInputError(
            f"There are too many entries of paint for a live preview of {triangles:,} triangles; draw fewer, or mesh"
            f" more coarsely. Got: {len(scene.paint)}"
        )
    _require_short_outlines(scene)
    return scene, frames


def document_points(request: PreviewRequest, scene: Scene) -> list[int]:
    """For each rig point of a scene its number in the document that it was made of; -1 for those found on the way.

    Rig points of bodies that are not there are left out of a scene, and pins of bodies that say where they are held
    come before the others.
    """
    from ...physics.document import rig_points_kept

    kept = rig_points_kept(request.document, [body.name for body in scene.bodies])
    return [-1] * (len(scene.rig_points) - len(kept)) + kept


def _require_short_outlines(scene: Scene) -> None:
    """Refuse colliders whose outlines are so long or so ragged that to prepare them would take seconds."""
    if scene.contact is None or not scene.colliders:
        return
    from ...physics.scene import count_outlines, spacing_of

    points, crossings, crowding = count_outlines(scene, spacing_of(scene.bodies))
    remedy = "draw the colliders with fewer corners, or mesh more coarsely"
    _require_preview("points of colliders' outlines", points, MAX_PREVIEW_OUTLINE_POINTS, remedy)
    _require_preview("pixels along the edges of colliders' masks", crossings, MAX_PREVIEW_CROSSINGS, "paint no specks")
    name = "pairs of points of colliders' outlines that lie close upon each other"
    _require_preview(name, crowding, MAX_PREVIEW_CROWDING, remedy)


def _require_preview(name: str, count: int, most: int, remedy: str) -> None:
    if count > most:
        raise InvalidInputError(f"A live preview shows at most {most:,} {name}; {remedy}. Got: {count:,}")


def _require_few(document: dict[str, Any], name: str, most: int) -> None:
    entries = document.get(name)
    count = len(entries) if isinstance(entries, list) else 0
    _require_preview(name, count, most, "queue the graph to see them all")


def _require_small(data: object) -> None:
    """Refuse what is nested too deep or has too many parts, before anything walks through it with more effort."""
    level, depth, values, objects = [data], 0, 1, 0
    while level := [entry for entry in level if isinstance(entry, dict | list)]:
        depth += 1
        require("the request", "more", depth <= MAX_NESTING, f"nested at most {MAX_NESTING} deep")
        values += sum(map(len, level))
        objects += sum(isinstance(entry, dict) for entry in level)
        require("the request", "more", values <= MAX_VALUES, f"of at most {MAX_VALUES:,} values")
        require("the request", "more", objects <= MAX_OBJECTS, f"of at most {MAX_OBJECTS:,} objects")
        level = [each for entry in level for each in (entry.values() if isinstance(entry, dict) else entry)]


def _count_points(data: object) -> tuple[int, int]:
    """Entries of all lists of points, times and keys; and pixels of all masks, which stand there as run lengths."""
    count, pixels, pending = 0, 0, [data]
    while pending:
        entry = pending.pop()
        if isinstance(entry, dict):
            count += sum(len(entry[name]) for name in _POINT_LISTS if isinstance(entry.get(name), list))
            if "runs" in entry and all(is_whole(entry.get(side), 0, MAX_SIDE) for side in ("width", "height")):
                pixels += int(entry["width"]) * int(entry["height"])
            pending += [each for each in entry.values() if isinstance(each, dict | list)]
        elif isinstance(entry, list):
            pending += [each for each in entry if isinstance(each, dict)]
    return count, pixels


def _shown(value: object) -> str:
    if isinstance(value, dict | list):
        return f"{'an object' if isinstance(value, dict) else 'a list'} of {len(value)}"
    return repr(value)[:60]
