"""The scene: what moves, and all that acts on it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..physics.errors import InvalidInputError
from ..physics.forces import EnergyStroke, Wind
from ..physics.rig import RigPoint
from ..physics.scene import Scene as PhysicalScene
from ..physics.scene import automatic_scene, held_where_said
from .host import checked_document, refusal
from .host.field_inputs import input_of
from .host.wires import (
    BodiesWire,
    ContactWire,
    MaskedBody,
    MaskedScene,
    RigWire,
    SceneWire,
    StrokesWire,
    Touch,
    WindWire,
)

if TYPE_CHECKING:
    from ..physics.document import LayerMasks

__all__ = ["AutomaticScene", "Scene", "SceneFromJSON", "scene_output", "scene_outputs"]

_SAMPLE = """\
{
  "version": 2,
  "width": 1280,
  "height": 720,
  "strokes": [
    {"kind": "wind", "path": [[0, 300], [1280, 260]], "radius": 250, "interval": 1}
  ]
}
"""


class Scene(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_Scene",
            display_name="Scene (PhysAnimator)",
            category="PhysAnimator/scene",
            description="Gathers the bodies and all that acts on them: wind, gravity, strokes, pins and contact.",
            inputs=[
                BodiesWire.Input("bodies", tooltip="What moves."),
                io.Float.Input(
                    "gravity_x", default=0.0, min=-100.0, max=100.0, step=0.1, tooltip=_gravity("to the right")
                ),
                io.Float.Input(
                    "gravity_y", default=0.0, min=-100.0, max=100.0, step=0.1, tooltip=_gravity("downwards")
                ),
                input_of(PhysicalScene, "frame_rate"),
                StrokesWire.Input("strokes", optional=True, tooltip="Energy strokes that act on every body."),
                RigWire.Input("rig_points", optional=True, tooltip="What is held or led."),
                WindWire.Input("wind", optional=True, tooltip="Blows everywhere beside the strokes."),
                _contact(),
            ],
            outputs=scene_outputs(),
        )

    @classmethod
    def execute(
        cls,
        bodies: tuple[MaskedBody, ...],
        gravity_x: float,
        gravity_y: float,
        frame_rate: float,
        strokes: tuple[EnergyStroke, ...] = (),
        rig_points: tuple[RigPoint, ...] = (),
        wind: Wind | None = None,
        contact: Touch | None = None,
    ) -> io.NodeOutput:
        if not strokes and not rig_points and not gravity_x and not gravity_y and wind is None:
            raise InvalidInputError(
                "Nothing acts on the bodies: connect strokes, wind or rig_points, set gravity, or use Automatic Scene."
            )
        gravity = (gravity_x, gravity_y)
        scene = PhysicalScene(_physical(bodies), strokes, rig_points, gravity, frame_rate, wind=wind)
        return scene_output(_touching(scene, contact), bodies)


class AutomaticScene(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_AutomaticScene",
            display_name="Automatic Scene (PhysAnimator)",
            category="PhysAnimator/scene",
            description="Holds each body where it is attached and lets gentle gusts of wind pass, so that hair and"
            " cloth sway.",
            inputs=[
                BodiesWire.Input("bodies", tooltip="What moves."),
                io.Float.Input(
                    "wind_strength",
                    default=1.0,
                    min=0.0,
                    max=20.0,
                    step=0.1,
                    tooltip="Factor on the usual wind [1]: 0 is calm, 1 gentle, 3 a storm.",
                ),
                io.Float.Input(
                    "wind_angle",
                    default=0.0,
                    min=-360.0,
                    max=360.0,
                    step=5.0,
                    tooltip="Where the wind blows to [degrees]: 0 to the right, 90 up, 180 to the left.",
                ),
                io.Boolean.Input(
                    "sway_by_size",
                    default=True,
                    tooltip="Small bodies sway faster than their material says and large ones slower, as pendulums do."
                    " Off: every body sways as often as its material says.",
                ),
                input_of(PhysicalScene, "frame_rate"),
                StrokesWire.Input("strokes", optional=True, tooltip="Used instead of the gusts when connected."),
                RigWire.Input("rig_points", optional=True, tooltip="Used instead of the pins when connected."),
                WindWire.Input("wind", optional=True, tooltip="Blows instead of the gusts when connected."),
                _contact(),
            ],
            outputs=scene_outputs(),
        )

    @classmethod
    def execute(
        cls,
        bodies: tuple[MaskedBody, ...],
        wind_strength: float,
        wind_angle: float,
        sway_by_size: bool,
        frame_rate: float,
        strokes: tuple[EnergyStroke, ...] = (),
        rig_points: tuple[RigPoint, ...] = (),
        wind: Wind | None = None,
        contact: Touch | None = None,
    ) -> io.NodeOutput:
        scene = automatic_scene(
            _physical(bodies),
            attach=[item.attach for item in bodies],
            frame_rate=frame_rate,
            wind_strength=wind_strength if wind is None else 0.0,
            wind_angle=wind_angle,
            sway_by_size=sway_by_size,
        )
        drawn = {"strokes": strokes, "rig_points": rig_points}
        given = {name: value for name, value in drawn.items() if value}
        return scene_output(_touching(replace(scene, wind=wind, **given), contact), bodies)


class SceneFromJSON(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_SceneFromJSON",
            display_name="Scene from JSON (PhysAnimator)",
            category="PhysAnimator/scene",
            description="Takes strokes, wind, rig points, materials, gravity and frame rate from a scene document.",
            inputs=[
                BodiesWire.Input(
                    "bodies",
                    tooltip="What moves, in the order of the document's bodies, whose materials they take on.",
                ),
                io.String.Input(
                    "scene",
                    default=_SAMPLE,
                    multiline=True,
                    tooltip="A scene document [JSON]: positions and radii in px, times in s, as Scene writes it.",
                ),
            ],
            outputs=scene_outputs(),
        )

    @classmethod
    def validate_inputs(cls, scene: str | None = None) -> bool | str:
        return scene is None or refusal(lambda: checked_document(scene))

    @classmethod
    def execute(cls, bodies: tuple[MaskedBody, ...], scene: str) -> io.NodeOutput:
        from ..physics.document import checked_scene_over

        layers = layer_masks_of(bodies)
        drawn = checked_scene_over(checked_document(scene), _physical(bodies), layers=layers)
        return scene_output(held_where_said(drawn), bodies)


def layer_masks_of(bodies: tuple[MaskedBody, ...]) -> LayerMasks | None:
    """What gives the mask of a still layer by its name, where the bodies are layers."""
    from ..rendering.layers_of_scenes import masks_of_still_layers
    from ..rendering.moving_layers import moving_layers_of

    found = moving_layers_of([item.source for item in bodies])
    return None if found is None else masks_of_still_layers(found.artwork, found.indices)


def _touching(scene: PhysicalScene, touch: Touch | None) -> PhysicalScene:
    return scene if touch is None else replace(scene, contact=touch.contact, colliders=touch.colliders)


def _contact() -> Any:
    return ContactWire.Input(
        "contact", optional=True, tooltip="How bodies touch. Without it they pass through each other."
    )


def _physical(bodies: tuple[MaskedBody, ...]) -> tuple[Any, ...]:
    return tuple(item.body for item in bodies)


def scene_output(scene: PhysicalScene, bodies: tuple[MaskedBody, ...], *, ui: Any = None) -> io.NodeOutput:
    """What the nodes of this file give: the scene with the bodies' masks, and its document."""
    from ..physics.document import dumps

    return io.NodeOutput(MaskedScene.of(scene, bodies), dumps(scene, meshes=False), ui=ui)


def scene_outputs() -> list[io.Output]:
    """Outputs for ``scene_output``."""
    return [
        SceneWire.Output(display_name="scene", tooltip="For Simulate."),
        io.String.Output(
            "scene_json",
            display_name="scene_json",
            tooltip="The scene as a JSON document without its meshes: for Scene from JSON and for the command line.",
        ),
    ]


def _gravity(direction: str) -> str:
    return (
        f"Acceleration of every body {direction} [sides/s^2], a side being the picture's longest; 0.5 is much. What is"
        " held hangs as it is drawn."
    )
