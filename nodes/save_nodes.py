"""An animation straight to disk, frame by frame, without a batch of frames in memory."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from comfy_api.latest import io, ui

from ..physics.errors import require
from ..rendering.pictures import FORMATS, check_output
from .background_inputs import background_chosen, background_inputs
from .drawing import clean_plate_input, drawing_inputs, drawing_of, in_front_input, told_of_another_picture
from .host import (
    FILE_TYPES,
    FRAMES,
    Place,
    all_told,
    check_prefix,
    free_place,
    hint_of_pixel_art,
    host_progress,
    picture_with_alpha,
    refusal,
    shown_with,
)
from .host.wires import MaskedMotion
from .saving_inputs import place_inputs

if TYPE_CHECKING:
    import torch
    from numpy.typing import NDArray

    from ..rendering.composite import Background, LayeredRenderer, PixelArtRenderer

__all__ = ["SaveAnimation"]

_LONGEST_SIDE = 16384


class SaveAnimation(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_SaveAnimation",
            display_name="Save Animation (PhysAnimator)",
            category="PhysAnimator/render",
            description="Paints the frames as Render does and writes each to disk at once: long clips of large pictures"
            " need no memory for a batch.",
            is_output_node=True,
            inputs=[
                *drawing_inputs("the masks and the frame rate"),
                *place_inputs(
                    "animation/PhysAnimator",
                    FILE_TYPES,
                    f"mp4: H.264, plays everywhere. webm: VP9. gif, webp, apng: animated pictures. mov: ProRes 4444 for"
                    f" editing and compositing programs. {FRAMES}: a folder of numbered pictures. All but mp4 can be"
                    " transparent.",
                ),
                io.Int.Input(
                    "width",
                    default=0,
                    min=0,
                    max=_LONGEST_SIDE,
                    tooltip="Width of the frames [px], the height follows; 0 is the illustration's own size.",
                ),
                clean_plate_input(),
                *background_inputs(),
                in_front_input(),
            ],
            outputs=[io.String.Output(display_name="path", tooltip="The file, or the folder of frames.")],
        )

    @classmethod
    def validate_inputs(
        cls,
        filename_prefix: str | None = None,
        file_type: str | None = None,
        background: dict[str, Any] | None = None,
        **others: Any,
    ) -> bool | str:
        # The host hands over what a choice brings only to a function that takes every input.
        checks: list[Callable[[], Any]] = []
        if filename_prefix is not None:
            checks.append(lambda: check_prefix(filename_prefix))
        if file_type is not None:
            checks.append(lambda: _check_format(file_type, background_chosen(background)))
        return refusal(*checks)

    @classmethod
    def execute(
        cls,
        image: torch.Tensor,
        motion: MaskedMotion,
        filename_prefix: str,
        file_type: str,
        width: int,
        clean_plate: torch.Tensor | None = None,
        background: dict[str, Any] | None = None,
        image_alpha: torch.Tensor | None = None,
        pixel_art: bool = False,
        in_front: torch.Tensor | None = None,
    ) -> io.NodeOutput:
        from ..rendering.pictures import as_uint8, write_animation

        behind = background_chosen(background)
        _check_format(file_type, behind)
        # In the depth in which they are written.
        picture = as_uint8(picture_with_alpha(image, image_alpha))
        plate = None if clean_plate is None else as_uint8(picture_with_alpha(clean_plate, name="clean_plate"))
        drawing = drawing_of(motion, picture, plate=plate, pixel_art=pixel_art, in_front=in_front)
        size = _size(picture, width)
        place = free_place(filename_prefix, file_type, *size)
        check_output(place.path, alpha=behind.has_alpha)
        told = {} if pixel_art or motion.layers else hint_of_pixel_art(cls, picture)
        told = all_told(told, told_of_another_picture(cls, motion, picture, plate))
        renderer = drawing(motion.motion)
        frames = _frames(renderer, behind, size, nearest=pixel_art)
        write_animation(frames, place.path, motion.motion.frame_rate, exact=pixel_art)
        return io.NodeOutput(place.path, ui=shown_with(_preview(place, file_type, len(renderer)), told))


def _frames(
    renderer: LayeredRenderer | PixelArtRenderer, background: Background, size: tuple[int, int], *, nearest: bool
) -> Iterator[NDArray[Any]]:
    """The frames one after another, with the host's progress and interruption."""
    from ..rendering.composite import shown_frame
    from ..rendering.pictures import resized

    report = host_progress()
    for number in range(len(renderer)):
        frame = shown_frame(renderer, number, background)
        own = (frame.shape[1], frame.shape[0]) == size
        yield frame if own else resized(frame, *size, nearest=nearest)
        report(number + 1, len(renderer))


def _size(picture: NDArray[Any], width: int) -> tuple[int, int]:
    """Width and height of what is written [px]."""
    height, own = picture.shape[:2]
    size = (own, height) if not width else (width, max(1, round(height * width / own)))
    require("width", f"{size[0]} x {size[1]} px", max(size) <= _LONGEST_SIDE, f"at most {_LONGEST_SIDE} px on a side")
    return size


def _holds_alpha(file_type: str) -> bool:
    return file_type == FRAMES or FORMATS[f".{file_type}"].alpha_pixels is not None


def _check_format(file_type: str, background: Background) -> None:
    """Refuse what the format cannot hold; InvalidInputError."""
    import folder_paths

    if file_type not in FILE_TYPES:
        return  # said elsewhere
    able = ", ".join(each for each in FILE_TYPES if _holds_alpha(each))
    require(
        "file_type", file_type, not background.has_alpha or _holds_alpha(file_type), f"one of {able} for transparency"
    )
    ending = "/" if file_type == FRAMES else f".{file_type}"
    # Also whether it can be encoded here, and whether anything can be written. The host makes the folder when it saves.
    output = folder_paths.get_output_directory()
    os.makedirs(output, exist_ok=True)
    check_output(os.path.join(output, f"physanimator{ending}"), alpha=background.has_alpha)


def _preview(place: Place, file_type: str, count: int) -> Any:
    """What the node shows: the file itself, as the host's own save nodes do."""
    if file_type != FRAMES:
        return ui.SavedImages([ui.SavedResult(place.name, place.subfolder, io.FolderType.output)], is_animated=True)
    folder = os.path.join(place.subfolder, place.name)
    names = sorted(name for name in os.listdir(place.path) if name.endswith(".png"))[:count]
    return ui.SavedImages([ui.SavedResult(name, folder, io.FolderType.output) for name in names])
