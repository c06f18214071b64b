"""What draws a motion in the nodes: its layers, or the illustration cut apart by its masks."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from comfy_api.latest import io

from ..physics.errors import InvalidInputError, require
from .host import mask_of, tell_user
from .host.wires import MotionWire

if TYPE_CHECKING:
    from collections.abc import Callable

    import torch
    from numpy.typing import NDArray

    from ..physics.motion import Motion
    from .host.wires import MaskedMotion

__all__ = [
    "clean_plate_input",
    "drawing_inputs",
    "drawing_of",
    "in_front_input",
    "in_front_of",
    "told_of_another_picture",
]

# Mean difference that no rounding of colours makes, 2 levels of 255.
_ANOTHER = 2 / 255


def drawing_inputs(along: str = "the masks") -> list[Any]:
    """The inputs image and motion.

    Args:
        along: what the node takes from the motion besides.
    """
    return [
        io.Image.Input("image", tooltip="The illustration (one picture)."),
        MotionWire.Input("motion", tooltip=f"From Simulate; it carries {along} along."),
    ]


def clean_plate_input() -> Any:
    """The optional input clean_plate."""
    return io.Image.Input(
        "clean_plate",
        optional=True,
        tooltip="The picture without the moving parts. Painted automatically when left out.",
    )


def in_front_input() -> Any:
    """The optional input in_front."""
    return io.Mask.Input(
        "in_front",
        optional=True,
        tooltip="White where something stands still in front of the moving parts, such as an arm before hair: it stays"
        " as drawn, and the parts go on behind it. Connected to Mask to Mesh, it need not be connected here.",
    )


def in_front_of(mask: torch.Tensor | None, width: int, height: int) -> NDArray[np.float32] | None:
    """The mask of the input in_front in the picture's size; None where none is connected, or where it is empty.

    Raises:
        InvalidInputError: it is of another form or size.
    """
    from ..physics.mesh import fitted

    if mask is None:
        return None
    found = fitted(mask_of(mask, name="in_front"), width, height, name="in_front")
    return found if (found > 0.5).any() else None


def drawing_of(
    motion: MaskedMotion,
    picture: NDArray[Any],
    *,
    plate: NDArray[Any] | None = None,
    pixel_art: bool = False,
    in_front: torch.Tensor | None = None,
) -> Callable[[Motion], Any]:
    """Makes the renderer of a motion, or of a part of it.

    Args:
        motion: what is drawn.
        picture: the illustration; with layers only its size counts.
        plate: what is behind all bodies.
        pixel_art: move whole pixels.
        in_front: the input of this name.

    Raises:
        InvalidInputError: something is connected that layers say already, or sizes do not fit.
    """
    from ..rendering.composite import renderer_of

    moved = motion.motion
    front = in_front_of(in_front, moved.width, moved.height)
    if motion.layers is None:
        if plate is not None:
            sizes = [f"{each.shape[1]} x {each.shape[0]} px" for each in (plate, picture)]
            require("clean_plate", sizes[0], sizes[0] == sizes[1], f"of the image's size, {sizes[1]}")
        front = motion.in_front if front is None else front
        return partial(renderer_of, picture, motion.masks, plate=plate, pixel_art=pixel_art, in_front=front)
    given = {"clean_plate": plate is not None, "in_front": front is not None, "pixel_art": pixel_art}
    for name, said in given.items():
        if said:
            raise InvalidInputError(f"{name} must be left out where the moving parts are layers. Got: a value")
    got, size = f"{picture.shape[1]} x {picture.shape[0]} px", f"{moved.width} x {moved.height} px"
    require("image", got, picture.shape[:2] == (moved.height, moved.width), f"of the layers' size, {size}")
    return motion.layers.renderer


def told_of_another_picture(
    node: Any, motion: MaskedMotion, picture: NDArray[Any], plate: NDArray[Any] | None = None
) -> dict[str, list[str]]:
    """Tell that layers are drawn and not the picture, or that the plate is of another picture; as ``tell_user`` does.

    Args:
        node: the node's class, as ``execute`` has it.
        motion: what is drawn.
        picture: from the node's input image, shape [h, w, 3 or 4].
        plate: from its input clean_plate, in the same form and size.
    """
    told = (
        _doubts_about_plate(motion, picture, plate) if motion.layers is None else _doubts_about_layers(motion, picture)
    )
    return tell_user(node, told)


def _doubts_about_plate(motion: MaskedMotion, picture: NDArray[Any], plate: NDArray[Any] | None) -> list[str]:
    from ..rendering.doubtful_inputs import doubts_about_plate

    if any(mask.shape != picture.shape[:2] for mask in motion.masks):  # which is refused when it is drawn
        return []
    told = doubts_about_plate(picture, plate, motion.masks)
    return [each.replace("the plate", "clean_plate", 1) for each in told]


def _doubts_about_layers(motion: MaskedMotion, picture: NDArray[Any]) -> list[str]:
    from ..rendering.pictures import as_float, over

    own = as_float(over(motion.layers.picture))
    apart = float(np.abs(own - as_float(over(picture))).mean()) if own.shape[:2] == picture.shape[:2] else 0.0
    return ["image is another picture than the layers show: what is drawn are the layers."] if apart > _ANOTHER else []
