"""Masks of several parts at once, by either backend, cleaned."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.interruption import checkpoint
from .grabcut import segment
from .mask_cleanup import clean_mask
from .prompts import Prompt

__all__ = ["Segmenter", "segment_parts"]

Mask = NDArray[np.bool_]


class Segmenter(Protocol):
    """A network that cuts parts out, such as ``sam.SamSegmenter``."""

    def segment(self, image: NDArray[np.uint8], prompts: Sequence[Prompt]) -> tuple[list[Mask], Any]: ...


def segment_parts(
    image: NDArray[np.uint8],
    prompts: Sequence[Prompt],
    *,
    network: Segmenter | None = None,
    smallest_speck: int = 0,
    largest_hole: int = 0,
    smoothing: float = 0.0,
) -> list[Mask]:
    """One mask for each part.

    Args:
        image: RGB, shape [h, w, 3].
        prompts: one for each part.
        network: a Segment Anything network; None cuts by colours and lines, where the points on the other parts count
            as points beside.
        smallest_speck: connected parts of a mask of fewer pixels are left out [px^2].
        largest_hole: gaps of up to so many pixels are filled [px^2].
        smoothing: radius of the bays and spikes of the edge that are evened out [px].

    Returns:
        masks, shape [h, w] each.

    Raises:
        InvalidInputError: a prompt is empty, contradicts itself, or lies outside the picture.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.document import parse_points
        >>> from physanimator.rendering.segmentation import prompts_of, segment_parts
        >>> picture = np.full((300, 300, 3), 230, np.uint8)
        >>> picture[80:220, 90:210] = (200, 60, 40)
        >>> len(segment_parts(picture, prompts_of(parse_points("150,150", width=300, height=300))))
        1
    """
    masks = network.segment(image, prompts)[0] if network else _cut(image, prompts)
    return [
        clean_mask(mask, smallest_speck=smallest_speck, largest_hole=largest_hole, smoothing=smoothing)
        for mask in masks
    ]


def _cut(image: NDArray[np.uint8], prompts: Sequence[Prompt]) -> list[Mask]:
    _check_apart(prompts)
    masks = []
    for number, prompt in enumerate(prompts):
        checkpoint()
        others = [_on(other) for index, other in enumerate(prompts) if index != number]
        beside = np.concatenate([np.zeros((0, 2)), *others])
        points = np.concatenate([np.reshape(prompt.points, (-1, 2)), beside])
        labels = np.concatenate([np.reshape(prompt.labels, -1), np.zeros(len(beside))])
        try:
            masks.append(segment(image, points, labels, box=prompt.box))
        except InvalidInputError as error:
            raise InvalidInputError(f"{prompt.name}: {error}" if prompt.name else str(error)) from error
    return masks


def _check_apart(prompts: Sequence[Prompt]) -> None:
    """Refuse parts that have points at one pixel: it cannot belong to both."""
    seen: dict[tuple[int, int], str] = {}
    for number, prompt in enumerate(prompts, 1):
        name = prompt.name or f"Part {number}"
        for place in {(int(x), int(y)) for x, y in _on(prompt)}:
            if seen.setdefault(place, name) != name:
                raise InvalidInputError(f"{seen[place]} and {name} must not be at the same pixel. Got: both at {place}")


def _on(prompt: Prompt) -> NDArray[np.float64]:
    """The points on a part."""
    return np.reshape(np.asarray(prompt.points, np.float64), (-1, 2))[np.reshape(prompt.labels, -1).astype(bool)]
