"""Layers that move: bodies of layers, and frames of their motion as layers again."""

from __future__ import annotations

from typing import Any

from comfy_api.latest import io

from ..physics.errors import InvalidInputError, require
from ..physics.material import PRESETS
from ..physics.material import Material as PhysicalMaterial
from .host import all_told, batch_of_pictures, default_of, tell_user
from .host.wires import BodiesWire, LayersWire, MaskedBody, MaskedMotion, MaterialWire, MotionWire
from .layer_nodes import artwork_of

__all__ = ["ArtworkToBodies", "FrameAsLayers"]

_BY_NAME = "by name"


class ArtworkToBodies(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        from ..physics.mesh import mesh_from_mask

        return io.Schema(
            node_id="PhysAnimator_ArtworkToBodies",
            display_name="Artwork to Bodies",
            category="PhysAnimator/layers",
            description="Makes layers bodies that move: those whose names say hair, ribbon, skirt and so on, or those"
            " that you name. All other layers stand still where they are, behind, between and in front.",
            inputs=[
                LayersWire.Input("layers", tooltip="From Load Layers or any other node with layers."),
                io.String.Input(
                    "move",
                    multiline=True,
                    default="",
                    tooltip="Layers that move whatever their names say, one on each line; NAME=PRESET also says of what"
                    f" they are made: {', '.join(PRESETS)}.",
                ),
                io.String.Input(
                    "still",
                    multiline=True,
                    default="",
                    tooltip="Layers that stand still whatever their names say, one on each line.",
                ),
                io.Combo.Input(
                    "preset",
                    options=[_BY_NAME, *PRESETS],
                    default=_BY_NAME,
                    tooltip="What all of them are made of. by name: each of what its name says.",
                ),
                io.Float.Input(
                    "spacing",
                    default=0.0,
                    min=0.0,
                    max=512.0,
                    step=0.5,
                    tooltip="Length of the triangles' edges [px]; 0 chooses one that suits each layer. Smaller bends"
                    " more finely and takes longer.",
                ),
                io.Int.Input(
                    "elements_across",
                    default=default_of(mesh_from_mask, "elements_across"),
                    min=1,
                    max=20,
                    tooltip="How many triangles thin strands get across, where the spacing alone would give fewer.",
                ),
                io.Boolean.Input(
                    "strands",
                    default=True,
                    tooltip="Slit hair and ribbons along the lines that are drawn between their strands, so that these"
                    " swing apart.",
                ),
                BodiesWire.Input(
                    "bodies",
                    optional=True,
                    tooltip="Bodies of other layers of the same artwork, from another such node with other settings.",
                ),
                MaterialWire.Input("material", optional=True, tooltip="Used instead of the presets when connected."),
            ],
            outputs=[
                BodiesWire.Output(display_name="bodies", tooltip="One for each layer that moves: for a scene."),
                io.Image.Output(display_name="image", tooltip="The artwork at rest: for Render and the other nodes."),
                io.String.Output(display_name="report", tooltip="What becomes of each layer and why, a line each."),
            ],
        )

    @classmethod
    def execute(
        cls,
        layers: Any,
        move: str,
        still: str,
        preset: str,
        spacing: float,
        elements_across: int,
        strands: bool,
        bodies: tuple[MaskedBody, ...] = (),
        material: PhysicalMaterial | None = None,
    ) -> io.NodeOutput:
        from ..rendering.moving_layers import bodies_before, bodies_of_layers, told_layers

        artwork, told = artwork_of(cls, layers)
        made = bodies_of_layers(
            artwork,
            move=_names(move),
            still=_names(still),
            material=material or (None if preset == _BY_NAME else preset),
            spacing=spacing or None,
            elements_across=elements_across,
            strands=strands,
            before=bodies_before(artwork, [(item.source, item.body) for item in bodies]),
        )
        chain = tuple(
            MaskedBody(body, mask, attach, source)
            for body, mask, attach, source in zip(
                made.bodies, made.parts.masks, made.parts.attachments, made.sources, strict=True
            )
        )
        report = told_layers(made.plans)
        left_out = [f"{plan.name}: {plan.why}." for plan in made.plans if plan.why.startswith("left out")]
        told = all_told(told, tell_user(cls, [*left_out, *made.parts.notes]))
        return io.NodeOutput(chain, batch_of_pictures([made.parts.image], 1), report, ui={"text": [report], **told})


class FrameAsLayers(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_FrameAsLayers",
            display_name="Frame as Layers",
            category="PhysAnimator/layers",
            description="One frame of a motion of layers as layers again, to paint on: what moves is bent, all else is"
            " as it was.",
            inputs=[
                MotionWire.Input("motion", tooltip="From Simulate, of bodies that are layers."),
                io.Int.Input(
                    "frame",
                    default=0,
                    min=-100_000,
                    max=100_000,
                    tooltip="Number of the frame, from 0; -1 is the last.",
                ),
            ],
            outputs=[
                LayersWire.Output(display_name="layers", tooltip="For Save Layers and the host's own layer nodes.")
            ],
        )

    @classmethod
    def execute(cls, motion: MaskedMotion, frame: int) -> io.NodeOutput:
        from ..rendering.artwork import to_layers_dictionary

        count = len(motion.motion)
        require("frame", frame, -count <= frame < count, f"{-count} to {count - 1}")
        if motion.layers is None:
            raise InvalidInputError("motion must be of layers, from Artwork to Bodies. Got: bodies that masks cut out")
        drawn = motion.layers.renderer(motion.motion).artwork(frame % count)
        return io.NodeOutput(to_layers_dictionary(drawn, most=None))


def _names(text: str) -> list[str]:
    return [line.strip() for line in text.splitlines() if line.strip()]
