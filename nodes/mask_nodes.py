"""From the picture to a mesh: query points give a mask, a mask gives triangles."""

from __future__ import annotations

from contextlib import nullcontext
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from comfy_api.latest import io, ui

from ..physics.document import parse_points
from ..physics.errors import InvalidInputError, MeshingError
from .background_inputs import image_alpha_input
from .drawing import in_front_input, in_front_of
from .host import (
    all_told,
    batch_of_masks,
    batch_of_pictures,
    boxes_of,
    chosen,
    mask_of,
    picture_of,
    picture_with_alpha,
    refusal,
    sent_inputs,
    shown_with,
    tell_user,
)
from .host.field_inputs import ADVANCED
from .host.wires import MaskedMesh, MeshWire
from .mesh_inputs import mesh_inputs, spacing_advice, spacing_of
from .models import segmenter_advice
from .models.sam_backend import missing_sam_files, sam_inputs, sam_network

if TYPE_CHECKING:
    import torch
    from numpy.typing import NDArray

    from ..physics.scene import QueryPoint

__all__ = ["MaskToMesh", "SegmentByPoints"]

_EMPTY = (
    "mask has no white: nothing would move. Load Image gives such a mask when its file has no transparency; paint one"
    " in the mask editor, or connect Segment by Points."
)

_NO_POINTS = (
    "points is empty: click on what shall move (+ puts a point on it, - beside it), or give points such as"
    " [[x, y, 1], ...], or a box."
)

_TINT, _TINT_SHARE = (0.25, 0.84, 0.48), 0.45
"""How a mask is shown over its picture: RGB, and how much of it."""

_GRABCUT, _SAM = "grabcut", "segment anything"


class SegmentByPoints(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_SegmentByPoints",
            display_name="Segment by Points",
            category="PhysAnimator/mesh",
            description="Cuts out the part of the picture on which the points lie, or several parts, each into a mask"
            " of its own. Works without any model file.",
            is_output_node=True,
            inputs=[
                io.Image.Input("image", tooltip="The illustration (one picture)."),
                io.String.Input(
                    "points",
                    default="",
                    multiline=True,
                    tooltip="Click on the picture, or give points in pixels as JSON: [[x, y, 1], ...] with 1 on the"
                    " part, 0 beside it; and for several parts [[x, y, 1, part], ...] with the part's number, from 0;"
                    " also objects with x and y, and lists named positive and negative, from point editors,"
                    " and a scene document with query_points.",
                ),
                io.DynamicCombo.Input(
                    "backend",
                    options=[io.DynamicCombo.Option(_GRABCUT, []), io.DynamicCombo.Option(_SAM, sam_inputs())],
                    optional=True,
                    tooltip="grabcut: by colours and lines, without any model. segment anything: by a network of the"
                    " SAM family, for which a model file is needed.",
                ),
                io.String.Input(
                    "box",
                    default="",
                    optional=True,
                    tooltip="Box around the part [px]: [x0, y0, x1, y1]; for several parts a list of boxes, part 0"
                    " first. May replace the points. Empty: no box.",
                ),
                io.Int.Input(
                    "smallest_speck",
                    default=0,
                    min=0,
                    max=1_000_000,
                    optional=True,
                    tooltip="Pieces of a mask with fewer pixels are left out [px]; the largest one always stays.",
                ),
                io.Int.Input(
                    "largest_hole",
                    default=0,
                    min=0,
                    max=1_000_000,
                    optional=True,
                    tooltip="Gaps in a mask of up to so many pixels are filled [px].",
                ),
                io.Float.Input(
                    "smoothing",
                    default=0.0,
                    min=0.0,
                    max=100.0,
                    step=0.5,
                    optional=True,
                    tooltip="Radius of the bays and spikes of the edge that are evened out [px]; thin tips suffer.",
                ),
            ],
            outputs=[
                io.Mask.Output(display_name="mask", tooltip="White where the part is; one mask for each part."),
                io.Image.Output(display_name="preview", tooltip="The part in colour, the rest faded."),
            ],
        )

    @classmethod
    def validate_inputs(
        cls, points: str | None = None, box: str | None = None, backend: dict[str, Any] | None = None, **others: Any
    ) -> bool | str:
        # The host hands over the inputs that a choice brings only to a function that takes every input.
        unread = points is None or isinstance((sent_inputs() or {}).get("box"), list)
        checks = [lambda: boxes_of(box or "", name="box")]
        if points is not None:
            checks.append(lambda: _points_of(points, 1 << 19, 1 << 19, needed=not (unread or (box or "").strip())))
        return missing_sam_files(backend or {}) or refusal(*checks)

    @classmethod
    def execute(
        cls,
        image: torch.Tensor,
        points: str,
        backend: dict[str, Any] | None = None,
        box: str = "",
        smallest_speck: int = 0,
        largest_hole: int = 0,
        smoothing: float = 0.0,
    ) -> io.NodeOutput:
        from ..rendering.pictures import as_uint8
        from ..rendering.segmentation import judge_cuts, prompts_of, segment_parts

        picture = picture_of(image)
        height, width = picture.shape[:2]
        boxes = boxes_of(box, name="box")
        prompts = prompts_of(_points_of(points, width, height, needed=not boxes), boxes)
        name, choice = chosen(backend or {"backend": _GRABCUT}, "backend", (_GRABCUT, _SAM))
        cleaning = {"smallest_speck": smallest_speck, "largest_hole": largest_hole, "smoothing": smoothing}
        seen, others = as_uint8(picture), segmenter_advice() if name == _GRABCUT else ""
        with sam_network(choice) if name == _SAM else nullcontext() as network:
            masks = segment_parts(seen, prompts, network=network, **cleaning)
        told = tell_user(cls, judge_cuts(masks, prompts, instead=others, image=seen))
        faded = np.where(np.logical_or.reduce(masks)[..., None], picture, 0.75 + 0.25 * picture)
        preview = batch_of_pictures([faded], 1)
        return io.NodeOutput(batch_of_masks(masks, len(masks)), preview, ui=shown_with(ui.PreviewImage(preview), told))


def _points_of(text: str, width: int, height: int, *, needed: bool) -> list[QueryPoint]:
    """The points in the text; none where it is empty, unless they are needed."""
    found = parse_points(text, width=width, height=height) if text.strip() else []
    if needed and not found:
        raise InvalidInputError(_NO_POINTS)
    if needed:
        from ..rendering.segmentation import require_object

        require_object(np.array([point.positive for point in found]), None)
    return found


class MaskToMesh(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_MaskToMesh",
            display_name="Mask to Mesh (PhysAnimator)",
            category="PhysAnimator/mesh",
            description="Fills a mask with triangles: the shape that the physics bends.",
            is_output_node=True,
            inputs=[
                io.Mask.Input("mask", tooltip="White where the part is. A soft edge is kept for rendering."),
                *mesh_inputs("the mask"),
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
                    tooltip="The illustration. Connect it: the mesh then ends where the picture shows the part to end,"
                    " which is where Render cuts it out, and not where a blurred, grown or hand-painted mask does.",
                ),
                image_alpha_input(),
                io.Boolean.Input(
                    "pixel_art",
                    default=False,
                    optional=True,
                    tooltip="As in Render, which then moves the very pixels of the mask: so does the mesh.",
                ),
                in_front_input(),
                io.Boolean.Input(
                    "uniform",
                    default=False,
                    optional=True,
                    tooltip="Outlines get their points at the same distance everywhere, the spacing, as in the paper;"
                    " elements_across does not count. Thin parts then bend more stiffly.",
                    **ADVANCED,
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
        image_alpha: torch.Tensor | None = None,
        pixel_art: bool = False,
        in_front: torch.Tensor | None = None,
        uniform: bool = False,
    ) -> io.NodeOutput:
        from ..physics.mesh import fitted, mesh_from_mask
        from ..physics.scene import mask_advice
        from ..rendering.composite import behind_still
        from ..rendering.edge_advice import edges_in_words
        from ..rendering.matting import open_edges, part_mesh
        from ..rendering.overlays import draw_wireframe
        from ..rendering.pictures import over

        coverage = mask_of(mask, index=mask_index)
        given = image is not None
        picture = picture_with_alpha(image, image_alpha) if given else np.repeat(coverage[..., None], 3, axis=2)
        if not (coverage > 0.5).any():
            raise MeshingError(_EMPTY)
        coverage = fitted(coverage, picture.shape[1], picture.shape[0])
        told = tell_user(cls, [*mask_advice(coverage), *spacing_advice(spacing)])
        front = in_front_of(in_front, picture.shape[1], picture.shape[0])
        if front is not None:
            coverage = behind_still(coverage, front > 0.5)
        meshed = partial(part_mesh, picture) if given and not pixel_art else mesh_from_mask
        mesh = meshed(coverage, spacing=spacing_of(spacing), elements_across=elements_across, uniform=uniform)
        if given and not pixel_art:
            ending = open_edges(picture, coverage, elsewhere=None if front is None else front > 0.5)
            told = all_told(told, tell_user(cls, edges_in_words(ending, of="the mask")))
        preview = batch_of_pictures([draw_wireframe(over(picture), mesh)], 1)
        seen = preview if not given else batch_of_pictures([draw_wireframe(_tinted(over(picture), coverage), mesh)], 1)
        return io.NodeOutput(MaskedMesh(mesh, coverage, front), preview, ui=shown_with(ui.PreviewImage(seen), told))


def _tinted(picture: NDArray[np.float32], mask: NDArray[np.float32]) -> NDArray[np.float32]:
    """The picture with the mask laid over it in colour, shape [h, w, 3]."""
    share = _TINT_SHARE * mask[..., None]
    return (picture * (1 - share) + np.float32(_TINT) * share).astype(np.float32)
