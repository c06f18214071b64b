"""Pictures of a set as they are animated: read, checked, and scaled down to the set's size."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...physics.document import check_document, parse_points, read_json
from ...physics.errors import InvalidInputError
from ..artwork import is_artwork_file, load_artwork
from ..files import read_text_file
from ..parts import picture_of
from ..pictures import load_image, load_mask, over, resized
from ..segmentation import segment
from .evaluation_set import PictureOfSet

if TYPE_CHECKING:
    from ..artwork import Artwork

__all__ = ["LoadedPicture", "loaded"]

Picture = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class LoadedPicture:
    """A picture and what moves in it.

    Attributes:
        image: RGB, uint8, shape [h, w, 3], or layered artwork.
        masks: where parts are, 0..1, shape [h, w] each; none for layered artwork.
        scene: decoded scene document, or None.
        plate: RGB, uint8, of the image's size, or None.
        in_front: 0..1, shape [h, w], or None.
    """

    image: Picture | Artwork
    masks: tuple[NDArray[Any], ...]
    scene: Mapping[str, Any] | None
    plate: Picture | None
    in_front: NDArray[Any] | None

    @property
    def layered(self) -> bool:
        """Whether it is layered artwork."""
        return not isinstance(self.image, np.ndarray)

    @property
    def flat(self) -> Picture:
        """As it is seen, RGB, uint8, shape [h, w, 3]."""
        image = self.image if isinstance(self.image, np.ndarray) else picture_of(self.image)
        shown: Any = over(image)
        return shown if shown.dtype == np.uint8 else np.rint(shown * 255).astype(np.uint8)


@lru_cache(maxsize=2)
def loaded(picture: PictureOfSet, size: int) -> LoadedPicture:
    """A picture of a set, the last ones from memory.

    Args:
        picture: what is read.
        size: longest side that a flat picture is scaled down to [px]; 0: as it is.

    Raises:
        InvalidInputError: a file is missing, damaged, or of another size; the message names it.
    """
    with _about(picture.name):
        scene = None if not picture.scene else _scene(Path(picture.scene))
        if is_artwork_file(picture.image):
            _check_layers_alone(picture)
            return LoadedPicture(load_artwork(picture.image), (), scene, None, None)
        if not picture.masks and not picture.points:
            raise InvalidInputError("a flat picture must have masks or points. Got: neither")
        image = load_image(picture.image)
        height, width = image.shape[:2]
        masks = [load_mask(each, width=width, height=height) for each in picture.masks]
        masks += [_cut(image, each) for each in picture.points]
        plate = _plate(picture.plate, image.shape)
        front = load_mask(picture.in_front, width=width, height=height) if picture.in_front else None
        scale = min(1.0, size / max(width, height)) if size else 1.0
        width, height = (max(1, round(scale * side)) for side in (width, height))

        def sized(pixels: Any) -> Any:
            return pixels if pixels is None or scale == 1 else resized(pixels, width, height)

        return LoadedPicture(sized(image), tuple(map(sized, masks)), scene, sized(plate), sized(front))


@contextmanager
def _about(name: str) -> Iterator[None]:
    try:
        yield
    except InvalidInputError as error:
        raise InvalidInputError(f"picture {name!r}: {error}") from error


def _check_layers_alone(picture: PictureOfSet) -> None:
    for name in ("masks", "points", "plate", "in_front"):
        if getattr(picture, name):
            raise InvalidInputError(f"{name} must be left out for layered artwork. Got: {picture.image}")


def _plate(path: str, shape: tuple[int, ...]) -> Picture | None:
    if not path:
        return None
    plate = load_image(path)
    if plate.shape != shape:
        size, got = (f"{each[1]} x {each[0]} px" for each in (shape, plate.shape))
        raise InvalidInputError(f"plate {path} must have the picture's size, {size}. Got: {got}")
    return plate


def _cut(image: Picture, path: str) -> NDArray[Any]:
    """The mask of the part under query points."""
    height, width = image.shape[:2]
    found = parse_points(read_text_file(path, "points"), width=width, height=height)
    return np.asarray(segment(image, [(p.x, p.y) for p in found], [int(p.positive) for p in found]), dtype=np.float32)


def _scene(path: Path) -> Mapping[str, Any]:
    text = read_text_file(path, "scene")
    try:
        return check_document(read_json(text))
    except InvalidInputError as error:
        raise InvalidInputError(f"scene {path}: {error}") from error
