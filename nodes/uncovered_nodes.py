"""What the motion uncovers, once for a whole clip: for an image model that paints it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comfy_api.latest import io

from .background_inputs import image_alpha_input
from .drawing import drawing_inputs, drawing_of, in_front_input, told_of_another_picture
from .host import all_told, batch_of_masks, batch_of_pictures, host_progress, picture_with_alpha, tell_user
from .host.wires import MaskedMotion

if TYPE_CHECKING:
    import torch

__all__ = ["UncoveredArea"]

_LAYERS = "The layers say what is behind the moving parts: nothing has to be painted, and the mask is black."
_STILL = "The moving parts uncover nothing in this motion: the mask is black."


class UncoveredArea(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_UncoveredArea",
            display_name="Uncovered Area (for inpainting)",
            category="PhysAnimator/render",
            description="What the moving parts uncover in the whole clip, as one mask, and the picture without them:"
            " an image model of your own paints it once, and the result goes to Render's clean_plate.",
            inputs=[
                *drawing_inputs(),
                io.Int.Input(
                    "grow",
                    default=8,
                    min=0,
                    max=1000,
                    tooltip="How far the mask reaches beyond what is uncovered [px]. More hides seams.",
                ),
                io.Int.Input(
                    "soft_edge",
                    default=0,
                    min=0,
                    max=1000,
                    tooltip="Width of a soft transition around the mask [px]; 0 for a hard edge.",
                ),
                io.Int.Input(
                    "size_step",
                    default=16,
                    min=1,
                    max=256,
                    tooltip="image and mask grow at the right and bottom until their sides are multiples of this [px],"
                    " so that a model's encoder cuts nothing off. 1 leaves them as they are.",
                ),
                image_alpha_input(),
                in_front_input(),
            ],
            outputs=[
                io.Image.Output(
                    "to_paint", display_name="image", tooltip="The picture without the moving parts, for the model."
                ),
                io.Mask.Output(display_name="mask", tooltip="White where the model shall paint."),
                io.Image.Output(
                    "plate",
                    display_name="clean_plate",
                    tooltip="The same picture in the illustration's size: destination of ImageCompositeMasked, so that"
                    " all outside the mask stays to the bit.",
                ),
            ],
        )

    @classmethod
    def execute(
        cls,
        image: torch.Tensor,
        motion: MaskedMotion,
        grow: int,
        soft_edge: int,
        size_step: int,
        image_alpha: torch.Tensor | None = None,
        in_front: torch.Tensor | None = None,
    ) -> io.NodeOutput:
        from ..rendering.neural.uncovered_area import extended, uncovered_area
        from ..rendering.pictures import as_float, over

        picture = picture_with_alpha(image, image_alpha)
        told = told_of_another_picture(cls, motion, picture)
        layers = drawing_of(motion, picture, in_front=in_front)(motion.motion)
        drawn, report = motion.layers is not None, host_progress()
        area = uncovered_area(layers, grow=grow, soft_edge=soft_edge, drawn=drawn, progress=report)
        plate = as_float(over(layers.plate))
        if not area.any():
            told = all_told(told, tell_user(cls, [_LAYERS if drawn else _STILL]))
        shown, mask = extended(plate, size_step), extended(area, size_step, by=0.0)
        whole = batch_of_pictures([plate], 1)
        return io.NodeOutput(batch_of_pictures([shown], 1), batch_of_masks([mask], 1), whole, ui=told or None)
