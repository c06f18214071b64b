"""Moving parts of a flat picture: from its masks, and cut out at points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..physics.errors import InvalidInputError, require
from ..physics.progress import Progress
from .neural import NetworkOptions
from .neural.checking import naming_files
from .options import Watch
from .parts import Parts, about, coverage, coverages, parts_of_picture
from .pictures import as_picture, over

__all__ = ["FlatPicture"]

Image = NDArray[Any]
Mask = NDArray[Any]


@dataclass(frozen=True, eq=False)
class FlatPicture:
    """A flat picture and what was said of it, in forms that suit each other.

    Attributes:
        image: RGB or straight RGBA.
        masks: where moving parts are, 0 to 1, shape [h, w] each.
        points: for each further part its query points.
        plate: the picture without the moving parts; None where it is painted in.
        front: where something stands still in front of all parts, 0 to 1; None for nowhere.
    """

    image: Image
    masks: Sequence[Mask]
    points: Sequence[Any]
    plate: Image | None
    front: Mask | None

    @classmethod
    def of(
        cls,
        image: Image,
        masks: Sequence[Mask] | None,
        points: Sequence[Any] | None,
        plate: Image | None,
        in_front: Mask | None,
    ) -> FlatPicture:
        """What was given, checked; see :func:`~physanimator.rendering.pipeline.animate`.

        Raises:
            InvalidInputError: something is of no such form, or of another size.
        """
        picture = as_picture(image, alpha=True)
        listed = points is None or (isinstance(points, Sequence | np.ndarray) and not isinstance(points, str | bytes))
        require("points", type(points).__name__, listed, "a list with the points of one part in each place")
        plate = _checked_plate(plate, picture)
        covered = coverages("masks", () if masks is None else masks, picture)
        front = None if in_front is None else coverage("in_front", in_front, picture)
        return cls(picture, covered, () if points is None else points, plate, front)

    def cut(self, networks: NetworkOptions, watch: Watch) -> tuple[Mask, ...]:
        """The masks of all parts; somebody may look at those that were cut from points."""
        cut = tuple(_segmented(over(self.image), self.points, networks))
        _check_parts((*self.masks, *cut))
        if watch.on_cut is not None:
            watch.on_cut(cut)
        return (*self.masks, *cut)

    def parts(
        self, cut: Sequence[Mask], *, spacing: float | None, pixel_art: bool, progress: Progress | None = None
    ) -> Parts:
        """The moving parts.

        Args:
            cut: the masks of all of them.
            spacing: distance of the meshes' vertices [px]; None chooses it.
            pixel_art: move whole pixels.
            progress: called before the first part and after each with (parts done, parts); may raise to stop.
        """
        names = _part_names(len(self.masks), len(cut))
        return parts_of_picture(
            self.image,
            cut,
            names,
            spacing=spacing,
            plate=self.plate,
            in_front=self.front,
            pixel_art=pixel_art,
            progress=progress,
        )


def _checked_plate(plate: Image | None, image: Image) -> Image | None:
    """The plate as an array, which suits the picture: the renderer, which needs it, comes after the simulation."""
    if plate is None:
        return None
    plate = as_picture(plate, name="plate", alpha=True)
    if plate.shape[:2] != image.shape[:2]:
        raise InvalidInputError(f"plate must have the picture's size, {image.shape[:2]}. Got: {plate.shape[:2]}")
    return plate


def _segmented(image: Image, points: Sequence[Any], networks: NetworkOptions) -> Iterator[Mask]:
    if not len(points):
        return
    from ..physics.document import parse_points
    from .neural.cutting import segmenter_of
    from .pictures import as_uint8
    from .segmentation import Prompt, segment

    height, width = image.shape[:2]
    with naming_files(networks):
        network = segmenter_of(networks)
    for each, name in zip(points, _part_names(0, len(points)), strict=True):
        with about(name):
            clicked = parse_points(each, width=width, height=height)
            places, labels = [(p.x, p.y) for p in clicked], [int(p.positive) for p in clicked]
            if network is None:
                yield segment(image, places, labels)
            else:
                yield network.segment(as_uint8(image), [Prompt(places, labels)])[0][0]


def _part_names(masks: int, parts: int) -> list[str]:
    """What the parts come from, where there are several."""
    if parts == 1:
        return [""]
    return [f"masks[{number}]" if number < masks else f"points[{number - masks}]" for number in range(parts)]


def _check_parts(parts: Sequence[Mask]) -> None:
    if not parts:
        raise InvalidInputError("an animation needs at least one mask, or points on a part. Got: neither")
