"""Parts that somebody has picked by points: what is asked of the cut, and what each part is made of."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import compress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..physics.document import parse_points
from ..physics.material import PRESETS
from ..physics.mesh import SMALLEST_PART, largest_area
from .segmentation import Prompt, judge_cuts, prompts_of

__all__ = ["AUTO", "PickedParts", "picked_parts", "presets_in", "presets_of"]

AUTO = "auto"
"""Stands for the preset that suits a part: what a layer's name says, or hair."""

Box = tuple[float, float, float, float]


@dataclass(frozen=True, eq=False)
class PickedParts:
    """Parts by what is asked of their cut.

    Attributes:
        prompts: one for each part, in the order of their numbers.
        numbers: of the parts.
        presets: name of the material of each; None where nothing is said of it.
    """

    prompts: tuple[Prompt, ...]
    numbers: tuple[int, ...]
    presets: tuple[str | None, ...]

    def judged(self, masks: Sequence[NDArray[np.bool_]], image: NDArray[Any] | None = None) -> list[str]:
        """What is suspicious about the masks that were cut: sentences, with the part's name if there are more.

        Args:
            masks: one for each part, shape [h, w] each.
            image: what they were cut from, RGB, shape [h, w, 3].
        """
        return judge_cuts(masks, self.prompts, image=image)

    def that_move(self, masks: Sequence[NDArray[np.bool_]]) -> tuple[PickedParts, list[NDArray[np.bool_]]]:
        """The parts and masks without those that are too small to become bodies, of which ``judged`` says so.

        Args:
            masks: one for each part, shape [h, w] each.
        """
        large = [largest_area(mask) >= SMALLEST_PART for mask in masks]
        prompts, numbers = compress(self.prompts, large), compress(self.numbers, large)
        presets = compress(self.presets, large)
        return PickedParts(tuple(prompts), tuple(numbers), tuple(presets)), list(compress(masks, large))


def picked_parts(points: str | Mapping[str, Any], *, width: int, height: int, boxes: Sequence[Box] = ()) -> PickedParts:
    """The parts that points are on.

    Args:
        points: in any form that :func:`~physanimator.physics.document.parse_points` takes. A scene document's
            ``bodies`` say what the parts are made of, the first of part 0 and so on: ``{"material": {"preset": ...}}``.
        width: of the picture [px].
        height: of the picture [px].
        boxes: around part 0, part 1 and so on [px]; may replace points.

    Raises:
        InvalidInputError: there is neither a point nor a box, or a point or a preset is none.

    Examples:
        >>> from physanimator.rendering.picked_parts import picked_parts
        >>> document = {
        ...     "version": 2,
        ...     "width": 40,
        ...     "height": 40,
        ...     "query_points": [{"x": 9, "y": 9}, {"x": 30, "y": 9, "part": 1}],
        ...     "bodies": [{}, {"material": {"preset": "cloth"}}],
        ... }
        >>> picked_parts(document, width=40, height=40).presets
        (None, 'cloth')
    """
    given = points.strip() if isinstance(points, str) else points
    found = parse_points(points, width=width, height=height) if given else []
    prompts = prompts_of(found, boxes)
    numbers = tuple(sorted({point.part for point in found} | set(range(len(boxes)))))
    said = presets_in(points)
    return PickedParts(tuple(prompts), numbers, tuple(said.get(number) for number in numbers))


def presets_of(own: Sequence[str | None], usual: str) -> list[str]:
    """What parts are made of.

    Args:
        own: name of the material of each part; None where nothing is said of it.
        usual: of the others; ``AUTO`` for hair.
    """
    return [name or ("hair" if usual == AUTO else usual) for name in own]


def presets_in(points: str | Mapping[str, Any]) -> dict[int, str]:
    """What a document says that its parts are made of: names of presets by the parts' numbers."""
    if isinstance(points, str):
        try:
            points = json.loads(points)
        except (ValueError, RecursionError):
            return {}
    bodies = points.get("bodies") if isinstance(points, Mapping) else None
    found = {}
    for number, body in enumerate(bodies if isinstance(bodies, list) else []):
        material = body.get("material") if isinstance(body, Mapping) else None
        name = material.get("preset") if isinstance(material, Mapping) else None
        if name in PRESETS:  # what else it may be is said by who reads the document
            found[number] = name
    return found
