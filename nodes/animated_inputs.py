"""What the node Animate Illustration is given: its picture, the parts that are picked on it, and what refuses them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..physics.errors import InvalidInputError
from ..rendering.picked_parts import picked_parts, presets_of
from .example_nodes import FOLDER
from .host import mask_of, picture_with_alpha, place_of, tell_user
from .host.pictures import picture_place
from .layer_nodes import artwork_of

if TYPE_CHECKING:
    import torch
    from numpy.typing import NDArray

    from ..rendering.artwork import Artwork

__all__ = [
    "EXAMPLE",
    "NOTHING_PICKED",
    "ChosenParts",
    "GivenPicture",
    "check_points",
    "chosen_parts",
    "file_of",
    "given_picture",
    "is_empty",
    "is_layered",
]

EXAMPLE = "PhysAnimator example.png"
NOTHING_PICKED = (
    "Nothing is picked yet: click on what shall move, or connect masks (one for each part), layers or a scene."
)
_LARGEST = 1 << 19


@dataclass(frozen=True, eq=False)
class GivenPicture:
    """The illustration, flat or in layers.

    Attributes:
        picture: RGB or straight RGBA, uint8 or float 0..1, shape [h, w, 3 or 4]; None where it is in layers.
        artwork: its layers; None where it is flat.
        told: what the user was told of it.
    """

    picture: NDArray[Any] | None = None
    artwork: Artwork | None = None
    told: dict[str, list[str]] = field(default_factory=dict)

    @property
    def subject(self) -> Any:
        """Whichever there is."""
        return self.picture if self.artwork is None else self.artwork

    @property
    def seen(self) -> NDArray[Any]:
        """The illustration as one picture."""
        from ..rendering.parts import picture_of

        return self.picture if self.artwork is None else picture_of(self.artwork)


@dataclass(frozen=True, eq=False)
class ChosenParts:
    """The parts of a flat picture that move.

    Attributes:
        masks: where each is, 0..1 or bool, shape [h, w] each.
        presets: what each is made of.
        told: what the user was told of them.
        names: what the user calls each.
    """

    masks: tuple[NDArray[Any], ...]
    presets: tuple[str, ...]
    told: dict[str, list[str]]
    names: tuple[str, ...]


def file_of(name: str) -> Path:
    """Where the picture or the layered file is that was chosen.

    Raises:
        InvalidInputError: it is not in the host's folders.
    """
    if name == EXAMPLE:
        return FOLDER / "illustration.png"
    return place_of(name) if is_layered(name) else picture_place(name)


def is_layered(name: str) -> bool:
    """Whether the name is that of a layered file, or of a folder of layers."""
    from ..rendering.artwork import is_artwork_file

    if name == EXAMPLE:
        return False
    try:
        return is_artwork_file(place_of(name))
    except InvalidInputError:
        return False


def given_picture(
    node: Any, name: str, image: torch.Tensor | None, alpha: torch.Tensor | None, layers: Any
) -> GivenPicture:
    """The illustration: from the inputs where they are connected, else from the file.

    Args:
        node: the node's class, as ``execute`` has it.
        name: of the file.
        image: the host's IMAGE.
        alpha: the host's MASK, white where the illustration is transparent.
        layers: ComfyUI's dictionary of layers.

    Raises:
        InvalidInputError: it cannot be read.
    """
    if layers is not None:
        return _layered(*artwork_of(node, layers))
    if image is not None:
        return GivenPicture(picture_with_alpha(image, alpha))
    if is_layered(name):
        from ..rendering.artwork import load_artwork

        artwork = load_artwork(file_of(name))
        return _layered(artwork, tell_user(node, artwork.warnings))
    from ..rendering.pictures import load_image
    from ..rendering.pictures.picture_files import first_of_several, reading

    picture = load_image(file_of(name), alpha=True)
    with reading(file_of(name), "picture") as opened:
        several = first_of_several(opened, name)
    return GivenPicture(picture, None, tell_user(node, several))


def _layered(artwork: Artwork, told: dict[str, list[str]]) -> GivenPicture:
    """An artwork in layers; a flat picture where it has none that could move alone."""
    from ..rendering.picked_layers import flat_picture

    picture = flat_picture(artwork)
    return GivenPicture(picture, artwork if picture is None else None, told)


def check_points(text: str) -> None:
    """Refuse points that are none, whatever the picture's size.

    Raises:
        InvalidInputError: they are none.
    """
    if not is_empty(text):
        picked_parts(text, width=_LARGEST, height=_LARGEST)


def is_empty(text: str) -> bool:
    """Whether nothing is picked: no text, or a document without points."""
    try:
        data = json.loads(text) if text.strip() else None
    except (ValueError, RecursionError):
        return False
    points = data.get("query_points", []) if isinstance(data, Mapping) and "version" in data else data
    return points is None or points == []


def chosen_parts(node: Any, picture: NDArray[Any], points: str, masks: torch.Tensor | None, usual: str) -> ChosenParts:
    """The parts that move: those of masks, and in front of them those that are picked.

    Args:
        node: the node's class, as ``execute`` has it.
        picture: the illustration.
        points: on the parts.
        masks: the host's MASK, one for each further part.
        usual: preset of the parts of which nothing is said.

    Raises:
        InvalidInputError: there is no part, or the points cut none out.
    """
    from ..rendering.pictures import as_uint8, over
    from ..rendering.segmentation import segment_parts

    given = [] if masks is None else _masks_of(masks)
    cut: Sequence[NDArray[np.bool_]] = ()
    names = [f"mask {number} of masks" for number in range(len(given))]
    own: tuple[str | None, ...] = ()
    told: dict[str, list[str]] = {}
    if not is_empty(points):
        height, width = picture.shape[:2]
        picked = picked_parts(points, width=width, height=height)
        seen = as_uint8(over(picture))
        cut = segment_parts(seen, picked.prompts)
        judged = picked.judged(cut, seen)
        told = tell_user(node, judged)
        picked, cut = picked.that_move(cut)
        own = picked.presets
        if not given and not cut:
            raise InvalidInputError(" ".join(judged))
        names += [f"Part {number + 1}" for number in picked.numbers]
    if not given and not cut:
        raise InvalidInputError(NOTHING_PICKED)
    return ChosenParts((*given, *cut), tuple(presets_of([*[None] * len(given), *own], usual)), told, tuple(names))


def _masks_of(masks: torch.Tensor) -> list[NDArray[np.float32]]:
    count = 1 if masks.ndim == 2 else max(1, len(masks))
    found = [mask_of(masks, index=number, name="masks") for number in range(count)]
    for number, mask in enumerate(found):
        if not (mask > 0.5).any():
            raise InvalidInputError(
                f"masks must each have white where a part is. Got: mask {number} without any; Load Image gives such a"
                " mask when its file has no transparency"
            )
    return found
