"""The scene editor: strokes and rig points drawn on the picture, with the real physics under the pen.

Its value is a scene document, so the node runs from that alone; what it returns beside its outputs is for the canvas.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from comfy_api.latest import io

from ..physics.errors import InvalidInputError, require
from .background_inputs import image_alpha_input
from .edited_layers import EditedLayers, edited_layers
from .host import all_told, checked_document, picture_with_alpha, refusal, tell_user
from .host.previews import saved_picture
from .host.wires import BodiesWire, LayersWire, MaskedBody
from .layer_nodes import artwork_of
from .preview import STORE, PreviewBodies, holds_of_bodies
from .preview.server import start_warm_up
from .scene_nodes import scene_output, scene_outputs
from .told_materials import told_materials

if TYPE_CHECKING:
    import torch

__all__ = ["SceneEditor"]

_EMPTY = '{"version": 2, "width": 1280, "height": 720}'


class SceneEditor(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_SceneEditor",
            display_name="Scene Editor (PhysAnimator)",
            category="PhysAnimator/scene",
            description="Draw wind, pushes, pins and paths on the picture and see it move.",
            is_output_node=True,
            inputs=[
                io.String.Input(
                    "scene",
                    default=_EMPTY,
                    multiline=True,
                    socketless=True,
                    tooltip="What is drawn, as a scene document [JSON]: positions and radii in px, times in s.",
                ),
                BodiesWire.Input(
                    "bodies", optional=True, tooltip="What moves; may be left out where layers are connected."
                ),
                io.Image.Input("image", optional=True, tooltip="The illustration, to draw on."),
                io.Image.Input(
                    "plate",
                    optional=True,
                    tooltip="The illustration without its moving parts, which the preview shows behind them. One is"
                    " made when none is connected.",
                ),
                image_alpha_input(),
                LayersWire.Input(
                    "layers",
                    optional=True,
                    tooltip="An illustration in layers instead of bodies: those whose names say so move, and in the"
                    " editor's list you choose others.",
                ),
            ],
            outputs=scene_outputs(),
        )

    @classmethod
    def validate_inputs(cls, scene: str | None = None) -> bool | str:
        return scene is None or refusal(lambda: checked_document(scene))

    @classmethod
    def execute(
        cls,
        scene: str,
        bodies: tuple[MaskedBody, ...] = (),
        image: torch.Tensor | None = None,
        plate: torch.Tensor | None = None,
        image_alpha: torch.Tensor | None = None,
        layers: dict[str, Any] | None = None,
    ) -> io.NodeOutput:
        from ..physics.document import checked_scene_over
        from ..physics.scene import absent_bodies, held_where_said

        if not bodies and layers is None:
            raise InvalidInputError("bodies or layers must be connected, to know what moves. Got: neither")
        document = checked_document(scene)
        artwork, told = (None, {}) if layers is None else artwork_of(cls, layers)
        found = edited_layers(document, bodies, artwork)
        bodies = bodies if found is None else found.bodies
        held = held_unless_said(bodies, document) if found is None else found.held_unless_said(document)
        acting = [item.body for item in held]
        unheld = checked_scene_over(document, acting, layers=found and found.masks)
        drawn = held_where_said(unheld)
        told = all_told(told, tell_user(cls, absent_bodies(drawn)))
        shown = None if image is None else _shown(image, drawn.width, drawn.height, "image", image_alpha)
        behind = None if plate is None else _shown(plate, drawn.width, drawn.height, "plate")
        info = {
            "key": STORE.put(_kept(bodies, shown, found)),
            "width": drawn.width,
            "height": drawn.height,
            "image": shown if shown is None else saved_picture(shown),
            "plate": behind if behind is None else saved_picture(behind),
            "layers": None if found is None else found.told(),
            "materials": told_materials([item.body for item in bodies]),
            "holds": holds_of_bodies(drawn, len(drawn.rig_points) - len(unheld.rig_points)),
        }
        # Where several bodies are drawn on, contact may be switched on at any moment.
        start_warm_up(contact=len(bodies) > 1 or drawn.contact is not None)
        return scene_output(drawn, bodies, ui={"physanimator_editor": [info], **told})


def held_unless_said(bodies: tuple[MaskedBody, ...], document: dict[str, Any]) -> list[MaskedBody]:
    """Bodies that masks cut out, held where they are attached as long as the document has no word on that.

    Args:
        bodies: from other nodes.
        document: a checked scene document. Its rig points, even none, are its word; so is where it holds a body.
    """
    if "rig_points" in document:
        return list(bodies)
    entries = document.get("bodies", [])

    def held(number: int, item: MaskedBody) -> MaskedBody:
        said = number < len(entries) and "attach" in entries[number]
        return item if said else replace(item, body=replace(item.body, attach=item.attach))

    return [held(number, item) for number, item in enumerate(bodies)]


def _shown(image: torch.Tensor, width: int, height: int, name: str, alpha: torch.Tensor | None = None) -> np.ndarray:
    """A picture of the bodies' size as bytes, uint8, shape [h, w, 3], or [h, w, 4] where it has transparency."""
    picture = picture_with_alpha(image, alpha, name=name)
    got = f"{picture.shape[1]} x {picture.shape[0]} px"
    require(name, got, picture.shape[:2] == (height, width), f"of the bodies' size, {width} x {height} px")
    from ..rendering.pictures import as_uint8

    return as_uint8(picture)


def _kept(bodies: tuple[MaskedBody, ...], picture: np.ndarray | None, found: EditedLayers | None) -> PreviewBodies:
    physical = tuple(item.body for item in bodies)
    held: dict[str, Any] = {"attachments": found.attachments if found else tuple(item.attach for item in bodies)}
    if found is not None:
        layered = {"layers": found.pictures, "layer_masks": found.masks, "layer_bytes": found.memory}
        return PreviewBodies(physical, **layered, **held)
    if picture is None:
        return PreviewBodies(physical, **held)
    from ..rendering.pictures import as_uint8

    hole = np.max([item.mask for item in bodies], axis=0)
    return PreviewBodies(physical, picture, as_uint8(hole), **held)
