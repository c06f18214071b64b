"""Layers that move: bodies of layers, and frames of their motion as layers again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..physics.errors import InvalidInputError, require
from ..physics.material import PRESETS
from ..physics.material import Material as PhysicalMaterial
from ..rendering.moving_layers import moving_layers_of
from .host import all_told, batch_of_pictures, checked_document, refusal, tell_user
from .host.wires import BodiesWire, LayersWire, MaskedBody, MaskedMotion, MaterialWire, MotionWire
from .layer_lists import listed_layers, masked_bodies, tell_layers, told_list
from .layer_nodes import artwork_of
from .mesh_inputs import mesh_inputs, spacing_advice, spacing_of

if TYPE_CHECKING:
    from ..rendering.artwork import Artwork, LayerPlan

__all__ = ["ArtworkToBodies", "FrameAsLayers"]

_BY_NAME = "by name"


class ArtworkToBodies(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_ArtworkToBodies",
            display_name="Artwork to Bodies",
            category="PhysAnimator/layers",
            description="Makes layers bodies that move: those whose names say hair, ribbon, skirt and so on, or those"
            " that you name. All other layers stand still where they are, behind, between and in front.",
            is_output_node=True,
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
                *mesh_inputs("each layer"),
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
                io.String.Input(
                    "scene",
                    default="",
                    multiline=True,
                    optional=True,
                    tooltip="What the list of layers in this node says, as a scene document [JSON]: of each layer by"
                    " its name whether it moves, of what, where it is held, and in which order. Other nodes write it as"
                    " scene_json.",
                ),
            ],
            outputs=[
                BodiesWire.Output(display_name="bodies", tooltip="One for each layer that moves: for a scene."),
                io.Image.Output(display_name="image", tooltip="The artwork at rest: for Render and the other nodes."),
                io.String.Output(display_name="report", tooltip="What becomes of each layer and why, a line each."),
            ],
        )

    @classmethod
    def validate_inputs(cls, scene: str | None = None) -> bool | str:
        return not scene or refusal(lambda: checked_document(scene))

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
        scene: str = "",
    ) -> io.NodeOutput:
        from ..rendering.layer_bodies import bodies_before, bodies_of_layers, plans_of_layers
        from ..rendering.layers_of_scenes import planned_layers
        from ..rendering.moving_layers import told_layers

        artwork, told = artwork_of(cls, layers)
        artwork = _ordered_as(bodies, artwork)
        document = checked_document(scene) if scene.strip() else {}
        before = bodies_before(artwork, [(item.source, item.body, item.attach) for item in bodies])
        chosen = {"move": _names(move), "still": _names(still)}
        one = material or (None if preset == _BY_NAME else preset)
        usual = {plan.name: _made_of(plan, one) for plan in planned_layers(artwork, **chosen) if plan.moves}
        held = {item.body.name: item.attach for item in bodies}
        plans = plans_of_layers(artwork, **chosen, before=before, document=document)
        if not any(plan.moves for plan in plans):
            tell_layers(artwork, listed_layers(plans, usual, held))
        made = bodies_of_layers(
            artwork,
            **chosen,
            material=one,
            spacing=spacing_of(spacing),
            elements_across=elements_across,
            strands=strands,
            before=before,
            document=document,
        )
        chain = masked_bodies(made)
        report = told_layers(made.plans)
        left_out = [f"{plan.name}: {plan.why}." for plan in made.plans if plan.why.startswith("left out")]
        told = all_told(told, tell_user(cls, [*left_out, *made.parts.notes, *spacing_advice(spacing)]))
        listed = told_list(artwork, listed_layers(made.plans, usual, held, [item.source.index for item in chain]))
        shown = {"text": [report], "physanimator_layers": [listed], **told}
        return io.NodeOutput(chain, batch_of_pictures([made.parts.image], 1), report, ui=shown)


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


def _made_of(plan: LayerPlan, one: PhysicalMaterial | str | None) -> str:
    return one.name if isinstance(one, PhysicalMaterial) else one or plan.preset or "hair"


def _ordered_as(bodies: tuple[MaskedBody, ...], artwork: Artwork) -> Artwork:
    """The artwork with its layers in the order in which an earlier node has put them."""
    from ..rendering.artwork import in_order

    earlier = moving_layers_of([item.source for item in bodies])
    return artwork if earlier is None else in_order(artwork, earlier.artwork.names)
