"""What an editor shows while somebody picks parts: the cut under the clicks, and the scene that moves what is cut.

The masks are those that the nodes make: the same pixels, points and functions, without a network.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...physics.checks import is_whole, within
from ...physics.document import scene_to_dict
from ...physics.errors import require
from ...physics.mesh import runs_of
from ...rendering.picked_parts import AUTO
from ..host import boxes_of, named_part
from ..host.pictures import as_load_image, picture_place, require_small
from .layers import artwork_to_pick, cuts_of_layers, layered_place, moving_of_layers
from .limits import MAX_EDITOR_NAME, MAX_FRAMES, MAX_PICKED_PIXELS, MAX_PICKED_POINTS, MAX_PICKED_SIZE
from .requests import read_bounded
from .store import PreviewBodies, PreviewStore

if TYPE_CHECKING:
    from ...rendering.artwork import Artwork
    from ...rendering.movement import Movement
    from ...rendering.picked_parts import PickedParts

__all__ = ["PickRequest", "Picker", "read_pick"]

Mask = NDArray[np.bool_]
T = TypeVar("T")

_FIELDS = {"editor", "picture", "alpha", "points", "cleaning", "move"}
_CLEANING = {"box", "smallest_speck", "largest_hole", "smoothing"}
_MOVE = {"preset", "wind", "wind_angle", "loop", "frames", "fps"}


@dataclass(frozen=True)
class PickRequest:
    """A request whose form is right.

    Attributes:
        editor: which editor asks; a later request of it takes the place of an earlier one.
        picture: name of the file in the host's folders; None for the example.
        alpha: keep the transparency that the file has.
        points: a document with query points.
        cleaning: box, smallest_speck, largest_hole and smoothing, as the node Segment by Points has them.
        move: preset, wind, wind_angle, loop, frames and fps, as Animate Illustration has them; None for the cut alone.
    """

    editor: str
    picture: str | None
    alpha: bool
    points: dict[str, Any]
    cleaning: dict[str, Any]
    move: dict[str, Any] | None


def read_pick(body: bytes) -> PickRequest:
    """The request in the body of a POST.

    Raises:
        InvalidInputError: it is no such request, or larger than the limits.
    """
    data = read_bounded(body)
    named = isinstance(data, dict) and set(data) == _FIELDS
    require("the request", "another form", named, f"an object with {', '.join(sorted(_FIELDS))}")
    editor, picture, points = data["editor"], data["picture"], data["points"]
    is_name = isinstance(editor, str) and 0 < len(editor) <= MAX_EDITOR_NAME
    require("editor", repr(editor)[:60], is_name, f"a text of 1 to {MAX_EDITOR_NAME} characters")
    require("picture", repr(picture)[:60], picture is None or isinstance(picture, str), "the name of a file, or null")
    require("alpha", repr(data["alpha"])[:60], isinstance(data["alpha"], bool), "true or false")
    require("points", "another form", isinstance(points, dict), "a document, an object in braces")
    listed = points.get("query_points", [])
    few = isinstance(listed, list) and len(listed) <= MAX_PICKED_POINTS
    require("query_points", "others", few, f"a list of at most {MAX_PICKED_POINTS}")
    cleaning, move = _cleaning_of(data["cleaning"]), data["move"]
    return PickRequest(editor, picture, data["alpha"], points, cleaning, None if move is None else _move_of(move))


def _cleaning_of(data: Any) -> dict[str, Any]:
    named = isinstance(data, dict) and set(data) <= _CLEANING
    require("cleaning", "another form", named, f"an object with {', '.join(sorted(_CLEANING))}")
    for name, most in (("smallest_speck", 1_000_000), ("largest_hole", 1_000_000)):
        require(name, repr(data.get(name))[:60], is_whole(data.get(name, 0), 0, most), f"a whole number up to {most}")
    smoothing, box = data.get("smoothing", 0), data.get("box", "")
    require("smoothing", repr(smoothing)[:60], within(smoothing, 0, 100), "a number from 0 to 100")
    require("box", repr(box)[:60], isinstance(box, str), "a text")
    return data


def _move_of(data: Any) -> dict[str, Any]:
    named = isinstance(data, dict) and set(data) == _MOVE
    require("move", "another form", named, f"an object with {', '.join(sorted(_MOVE))}")
    require("frames", repr(data["frames"])[:60], is_whole(data["frames"], 1, 100_000), "a whole number from 1")
    for name in ("wind", "wind_angle", "loop", "fps"):
        require(name, repr(data[name])[:60], within(data[name], -1e6, 1e6), "a number")
    require("preset", repr(data["preset"])[:60], isinstance(data["preset"], str), "the name of a preset")
    return data


class Picker:
    """Cuts parts out and sets them in a scene; what was made last is kept. Safe to use from any thread."""

    def __init__(self, store: PreviewStore, example: Path) -> None:
        """
        Args:
            store: where bodies go that are to be simulated.
            example: the illustration that stands for no file.
        """
        self._store, self._example = store, example
        self._pictures, self._cuts, self._parts, self._artworks = _Kept(2), _Kept(4), _Kept(2), _Kept(1)

    def answer(self, wanted: PickRequest) -> dict[str, Any]:
        """What the page gets: the size of the picture, a mask for each part, and what moves them where that is asked.

        Nothing moves where all that is cut is too small for it, which the advice says.

        Raises:
            InvalidInputError: the picture, a point or a value is none that may be.
        """
        from ...rendering.picked_parts import picked_parts
        from ...rendering.pictures import as_uint8, over

        layered = None if wanted.picture is None else layered_place(wanted.picture)
        if layered is not None:
            of_file = _stamp(layered)
            picture = self._artworks.get(of_file, lambda: artwork_to_pick(layered))
            if not isinstance(picture, np.ndarray):
                return self._answer_of_layers(picture, of_file, wanted)
        else:
            place = self._example if wanted.picture is None else picture_place(wanted.picture)
            of_file = (*_stamp(place), wanted.alpha)
            picture = self._pictures.get(of_file, lambda: _read(place, wanted.alpha))
        height, width = picture.shape[:2]
        if layered is not None and not wanted.points.get("query_points"):
            return {"width": width, "height": height, "cuts": [], "advice": []}  # that nothing is layered is an answer
        picked = picked_parts(
            wanted.points, width=width, height=height, boxes=boxes_of(wanted.cleaning.get("box", ""), name="box")
        )
        size = len(picked.prompts) * width * height
        require("parts", len(picked.prompts), size <= MAX_PICKED_SIZE, "fewer, or of a smaller picture")
        cleaning = {name: value for name, value in wanted.cleaning.items() if name != "box"}
        asked = repr([(each.points, each.labels, each.box, each.name) for each in picked.prompts]), repr(cleaning)

        def cut() -> tuple[list[Mask], list[str]]:
            from ...rendering.segmentation import segment_parts

            seen = as_uint8(over(picture))
            masks = segment_parts(seen, picked.prompts, **cleaning)
            return masks, picked.judged(masks, seen)

        masks, judged = self._cuts.get((of_file, asked), cut)
        made: dict[str, Any] = {"width": width, "height": height, "cuts": _told(masks, picked.numbers)}
        made["advice"] = judged
        picked, large = picked.that_move(masks)
        if wanted.move is not None and large:
            moving, told = self._moving(picture, large, (of_file, asked), picked, wanted.move)
            made |= moving
            made["advice"] = [*made["advice"], *told]
        return made

    def _answer_of_layers(self, artwork: Artwork, of_file: Hashable, wanted: PickRequest) -> dict[str, Any]:
        """The same for a picture in layers, of which those are cut out that move by their names or were picked."""
        from ...rendering.parts import parts_of_artwork
        from ...rendering.picked_layers import picked_layers

        move = wanted.move or {"preset": AUTO}
        points = wanted.points if wanted.points.get("query_points") else None
        picked = picked_layers(artwork, points, usual=move["preset"])
        shown = tuple((plan.name, plan.moves, plan.shown) for plan in picked.plans)
        made: dict[str, Any] = {"width": artwork.width, "height": artwork.height}
        made["cuts"] = self._cuts.get((of_file, shown, repr(picked.parts)), lambda: cuts_of_layers(artwork, picked))
        made["advice"] = list(picked.told)
        if wanted.move is not None and picked.moving:
            parts = self._parts.get((of_file, shown), lambda: parts_of_artwork(artwork, plans=picked.plans))
            made["advice"] += parts.notes
            made |= moving_of_layers(artwork, parts, picked, _movement(None, move), int(move["frames"]), self._store)
        return made

    def _moving(
        self,
        picture: NDArray[np.uint8],
        masks: Sequence[Mask],
        key: Hashable,
        picked: PickedParts,
        move: dict[str, Any],
    ) -> tuple[dict[str, Any], list[str]]:
        """The bodies' key and the scene that the node Animate Illustration makes for them; and what is to be said."""
        from ...rendering.edge_advice import edge_advice
        from ...rendering.parts import parts_of_picture
        from ...rendering.picked_parts import presets_of

        covered = [mask.astype(np.float32) for mask in masks]
        names = [f"Part {number + 1}" for number in picked.numbers]
        common: dict[str, Any] = {"spacing": None, "plate": None, "in_front": None, "pixel_art": False}
        parts = self._parts.get(key, lambda: parts_of_picture(picture, covered, names, **common))
        _, scene = _movement(presets_of(picked.presets, move["preset"]), move).staged(parts)
        hole = np.logical_or.reduce(masks).astype(np.uint8) * np.uint8(255)
        stored = self._store.put(PreviewBodies(scene.bodies, picture, hole))
        document = scene_to_dict(scene, meshes=False)
        told = [named_part(each, names) for each in edge_advice(parts.ending, scene)]
        return {"key": stored, "scene": document, "frames": min(int(move["frames"]), MAX_FRAMES)}, told


def _movement(presets: Sequence[str] | None, move: dict[str, Any]) -> Movement:
    """How parts move, as the node Animate Illustration has it."""
    from ...rendering.movement import Movement
    from ...rendering.options import AutomaticWind, Timing

    timing = Timing(loop=move["loop"] or None, frame_rate=move["fps"])
    return Movement(presets, wind=AutomaticWind(move["wind"], move["wind_angle"]), timing=timing)


def _stamp(place: Path) -> tuple[Any, ...]:
    """What is another for another file, or for another content of the same."""
    files = sorted(place.iterdir()) if place.is_dir() else [place]
    return str(place), *((file.name, file.stat().st_mtime_ns, file.stat().st_size) for file in files)


class _Kept:
    """The last results by what they were made from."""

    def __init__(self, most: int) -> None:
        self._most, self._lock = most, threading.Lock()
        self._made: OrderedDict[Hashable, Any] = OrderedDict()

    def get(self, key: Hashable, make: Callable[[], T]) -> T:
        with self._lock:
            if key in self._made:
                self._made.move_to_end(key)
                return self._made[key]  # type: ignore[no-any-return]
        made = make()
        with self._lock:
            self._made[key] = made
            while len(self._made) > self._most:
                self._made.popitem(last=False)
        return made


def _read(place: Path, alpha: bool) -> NDArray[np.uint8]:
    require_small(place, MAX_PICKED_PIXELS)
    if not alpha:
        return as_load_image(place)
    from ...rendering.pictures import load_image

    return load_image(place, alpha=True)


def _told(masks: Sequence[Mask], numbers: Sequence[int]) -> list[dict[str, Any]]:
    """Masks in the form of a scene document's painted regions."""
    return [
        {"part": number, "type": "mask", "width": mask.shape[1], "height": mask.shape[0], "runs": runs_of(mask)}
        for number, mask in zip(numbers, masks, strict=True)
    ]
