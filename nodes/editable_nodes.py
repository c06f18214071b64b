"""A motion saved as work that other programs go on with."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..rendering.moving_pieces import DEFAULT_TOLERANCE, check_tolerance
from .background_inputs import image_alpha_input
from .drawing import clean_plate_input, drawing_inputs, drawing_of, in_front_input, told_of_another_picture
from .host import SPINE, all_told, check_prefix, free_place, host_progress, picture_with_alpha, refusal, tell_user
from .host.wires import MaskedMotion
from .saving_inputs import place_inputs

if TYPE_CHECKING:
    import torch

__all__ = ["SaveSpineOrGltf"]

_GLTF = "glb"


class SaveSpineOrGltf(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_SaveSpineOrGltf",
            display_name="Save for Spine or glTF",
            category="PhysAnimator/render",
            description="Saves the motion as meshes that move, to be edited further or played in a game: a Spine"
            " skeleton, or a glTF scene for Blender and 3D engines. Each layer or part is a piece of its own.",
            is_output_node=True,
            inputs=[
                *drawing_inputs("the masks and the frame rate"),
                *place_inputs(
                    "animation/PhysAnimator",
                    (SPINE, _GLTF),
                    "spine: a folder with a skeleton for Spine 4.2, its atlas for engines and images for the editor."
                    " glb: a binary glTF scene, moved by morph targets.",
                ),
                io.Float.Input(
                    "tolerance",
                    default=DEFAULT_TOLERANCE,
                    min=0.01,
                    max=10.0,
                    step=0.05,
                    tooltip="How far a vertex may be from the motion [px]: with more there are fewer keys and targets,"
                    " and smaller files.",
                ),
                clean_plate_input(),
                image_alpha_input(),
                in_front_input(),
            ],
            outputs=[io.String.Output(display_name="path", tooltip="The folder of the skeleton, or the file.")],
        )

    @classmethod
    def validate_inputs(cls, filename_prefix: str | None = None, tolerance: float | None = None) -> bool | str:
        checks: list[Callable[[], Any]] = []
        if filename_prefix is not None:
            checks.append(lambda: check_prefix(filename_prefix))
        if tolerance is not None:
            checks.append(lambda: check_tolerance(tolerance))
        return refusal(*checks)

    @classmethod
    def execute(
        cls,
        image: torch.Tensor,
        motion: MaskedMotion,
        filename_prefix: str,
        file_type: str,
        tolerance: float,
        clean_plate: torch.Tensor | None = None,
        image_alpha: torch.Tensor | None = None,
        in_front: torch.Tensor | None = None,
    ) -> io.NodeOutput:
        from ..rendering.editable import save_renderer_as_gltf, save_renderer_as_spine
        from ..rendering.pictures import as_uint8

        picture = as_uint8(picture_with_alpha(image, image_alpha))
        plate = None if clean_plate is None else as_uint8(picture_with_alpha(clean_plate, name="clean_plate"))
        drawing = drawing_of(motion, picture, plate=plate, in_front=in_front)
        place = free_place(filename_prefix, file_type, picture.shape[1], picture.shape[0])
        save = save_renderer_as_spine if file_type == SPINE else save_renderer_as_gltf
        written, *warnings = save(drawing(motion.motion), place.path, tolerance=tolerance, progress=host_progress())
        told = all_told(tell_user(cls, warnings), told_of_another_picture(cls, motion, picture, plate))
        return io.NodeOutput(place.path, ui={"text": [f"{place.name}: {written}"], **told})
