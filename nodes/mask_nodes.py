"""From the picture to a mesh: query points give a mask, a mask gives triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from comfy_api.latest import io, ui

from ..physics.errors import MeshingError
from ..rendering.points import parse_points
from .defaults import default_of
from .literals import refusal
from .tensors import batch_of_masks, batch_of_pictures, mask_of, picture_of
from .wires import MaskedMesh, MeshWire

if TYPE_CHECKING:
    import torch

__all__ = ["MaskToMesh", "SegmentByPoints"]

_EMPTY = (
    "mask has no white: nothing would move. Load Image gives such a mask when its file has no transparency; paint one"
    " in the mask editor, or connect Segment by Points."
)


class SegmentByPoints(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_SegmentByPoints",
            display_name="Segment by Points",
            category="PhysAnimator/mesh",
            description="Cuts out the part of the picture on which the points lie. Works without any model file.",
            inputs=[
                io.Image.Input("image", tooltip="The illustration (one picture)."),
                io.String.Input(
                    "points",
                    default="[[640, 360, 1]]",
                    multiline=True,
                    tooltip="Points in pixels as JSON: [[x, y, 1], ...] with 1 on the part and 0 beside it;"
                    ' also [{"x": .., "y": ..}] and {"positive": [...], "negative": [...]} from point editors,'
                    " and a scene document with query_points.",
                ),
            ],
            outputs=[
                io.Mask.Output(display_name="mask", tooltip="White where the part is."),
                io.Image.Output(display_name="preview", tooltip="The part in colour, the rest faded."),
            ],
        )

    @classmethod
    def validate_inputs(cls, points: str | None = None) -> bool | str:
        return points is None or refusal(lambda: parse_points(points, width=1 << 20, height=1 << 20))

    @classmethod
    def execute(cls, image: torch.Tensor, points: str) -> io.NodeOutput:
        from ..rendering.segmentation import segment

        picture = picture_of(image)
        height, width = picture.shape[:2]
        query = parse_points(points, width=width, height=height)
        mask = segment(picture, [(point.x, point.y) for point in query], [point.positive for point in query])
        faded = np.where(mask[..., None], picture, 0.75 + 0.25 * picture)
        preview = batch_of_pictures([faded], 1)
        return io.NodeOutput(batch_of_masks([mask], 1), preview, ui=ui.PreviewImage(preview))


class MaskToMesh(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        from ..physics.meshing import mesh_from_mask

        return io.Schema(
            node_id="PhysAnimator_MaskToMesh",
            display_name="Mask to Mesh",
            category="PhysAnimator/mesh",
            description="Fills a mask with triangles: the shape that the physics bends.",
            inputs=[
                io.Mask.Input("mask", tooltip="White where the part is. A soft edge is kept for rendering."),
                io.Float.Input(
                    "spacing",
                    default=0.0,
                    min=0.0,
                    max=512.0,
                    step=0.5,
                    tooltip="Length of the triangles' edges [px]; 0 chooses one that suits the mask."
                    " Smaller bends more finely and takes longer.",
                ),
                io.Int.Input(
                    "elements_across",
                    default=default_of(mesh_from_mask, "elements_across"),
                    min=1,
                    max=20,
                    tooltip="How many triangles thin strands get across, where the spacing alone would give fewer.",
                ),
                io.Int.Input(
                    "mask_index",
                    default=0,
                    min=0,
                    max=4095,
                    tooltip="Which mask of a batch to take, counted from 0.",
                ),
                io.Image.Input(
                    "image",
                    optional=True,
                    tooltip="The illustration. Connect it to check the mask's size and to see the mesh on the picture.",
                ),
            ],
            outputs=[
                MeshWire.Output(display_name="mesh", tooltip="The triangles, with the mask that they came from."),
                io.Image.Output(display_name="preview", tooltip="The triangles drawn on the picture."),
            ],
        )

    @classmethod
    def execute(
        cls,
        mask: torch.Tensor,
        spacing: float,
        elements_across: int,
        mask_index: int,
        image: torch.Tensor | None = None,
    ) -> io.NodeOutput:
        from ..physics.masks import fitted
        from ..physics.meshing import mesh_from_mask
        from ..rendering.overlay import draw_wireframe

        coverage = mask_of(mask, index=mask_index)
        picture = np.repeat(coverage[..., None], 3, axis=2) if image is None else picture_of(image)
        if not (coverage > 0.5).any():
            raise MeshingError(_EMPTY)
        coverage = fitted(coverage, picture.shape[1], picture.shape[0])
        mesh = mesh_from_mask(coverage, spacing=spacing or None, elements_across=elements_across)
        preview = batch_of_pictures([draw_wireframe(picture, mesh)], 1)
        return io.NodeOutput(MaskedMesh(mesh, coverage), preview, ui=ui.PreviewImage(preview))
