"""The whole way in one node: from a picture and what is picked on it to its frames."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..physics.errors import InvalidInputError
from ..physics.limits import MAX_LOOP
from ..physics.material import PRESETS
from ..physics.scene import Scene
from ..rendering.options import DEFAULT_FRAMES
from ..rendering.picked_parts import AUTO
from .animated_frames import draw
from .animated_inputs import EXAMPLE, NOTHING_PICKED, check_points, file_of, given_picture, is_empty, is_layered
from .animated_motion import motion_of_parts, motion_of_scene
from .background_inputs import background_chosen, background_inputs
from .host import (
    all_told,
    batch_of_masks,
    checked_document,
    contents_of,
    hint_of_pixel_art,
    host_progress,
    is_wanted,
    layered_files,
    not_made,
    refusal,
    send_to_page,
    sent_inputs,
    shown_with,
)
from .host.choices import OPEN
from .host.field_inputs import input_of
from .host.pictures import picture_files
from .host.previews import saved_picture
from .host.wires import LayersWire, MaskedScene, MotionWire, SceneOrTextWire
from .preview.server import start_warm_up

if TYPE_CHECKING:
    import torch

__all__ = ["AnimateIllustration"]

PICTURE_EVENT = "physanimator.picture"
"""Name of the message by which a picture that other nodes have made appears in the node: see nodes/web/js/host."""

_FRAMES = 0  # number of the output


class AnimateIllustration(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_AnimateIllustration",
            display_name="Animate Illustration",
            category="PhysAnimator",
            description="One picture, moving: choose or drop a picture, click on what shall move. Hair, clothes, plants"
            " and the like are cut out, held where they are attached, and swing in the wind.",
            is_output_node=True,
            inputs=[
                io.Combo.Input(
                    "picture",
                    options=[*picture_files(), *layered_files(), EXAMPLE],
                    default=EXAMPLE,
                    extra_dict={OPEN: True},
                    tooltip="A picture of the input folder, or a .psd, .psb or .ora file there, whose layers move as"
                    " their names say. Drop a file on the node, or choose one with the button. Not used where image or"
                    " layers are connected.",
                ),
                io.String.Input(
                    "points",
                    default="",
                    multiline=True,
                    tooltip="What is picked: click on the picture; of a picture in layers, the layer under the click"
                    " moves. As text, points in every form that Segment by Points takes, such as [[x, y, 1, part], ...]"
                    " in pixels; the bodies of a scene document with query_points say of what each part is made.",
                ),
                io.Combo.Input(
                    "preset",
                    options=[AUTO, *PRESETS],
                    default=AUTO,
                    tooltip="What the parts are made of that say nothing themselves. auto: hair, or what a layer's name"
                    " says.",
                ),
                io.Float.Input(
                    "wind",
                    default=1.0,
                    min=0.0,
                    max=20.0,
                    step=0.1,
                    tooltip="Factor on the usual wind [1]: 0 is calm, 1 gentle, 3 a storm. A scene brings its own.",
                ),
                io.Float.Input(
                    "wind_angle",
                    default=0.0,
                    min=-360.0,
                    max=360.0,
                    step=5.0,
                    tooltip="Where the wind blows to [degrees]: 0 to the right, 90 up, 180 to the left.",
                ),
                io.Float.Input(
                    "loop",
                    default=0.0,
                    min=0.0,
                    max=MAX_LOOP,
                    step=0.5,
                    tooltip="Length of a seamless loop [s], whose last frame leads back to the first; it takes several"
                    " times as long. 0 is off, unless the scene has a loop.",
                ),
                io.Int.Input(
                    "frames",
                    default=DEFAULT_FRAMES,
                    min=1,
                    max=100_000,
                    tooltip="Number of frames; the first is the illustration. 72 frames at 24 a second last 3 s. With a"
                    " loop, its own length is used instead.",
                ),
                input_of(Scene, "frame_rate", name="fps"),
                io.Image.Input("image", optional=True, tooltip="The illustration, instead of the file chosen above."),
                io.Mask.Input(
                    "masks",
                    optional=True,
                    tooltip="White where a part is that shall move, one mask for each part, beside those that are"
                    " picked.",
                ),
                LayersWire.Input(
                    "layers",
                    optional=True,
                    tooltip="The illustration in layers: those move whose names say so, and those that are picked.",
                ),
                SceneOrTextWire.Input(
                    "scene",
                    optional=True,
                    tooltip="What acts, instead of the wind here: a scene of other nodes, which also says what moves;"
                    " or a scene document for the parts that are picked, such as scene_json.",
                ),
                *background_inputs(),
            ],
            outputs=[
                io.Image.Output(display_name="frames", tooltip="One picture a frame: for Create Video."),
                io.Mask.Output(display_name="masks", tooltip="White where each part is on the illustration."),
                MotionWire.Output(display_name="motion", tooltip="How the parts move: for Render, Tracks and others."),
                io.Float.Output(display_name="frame_rate", tooltip="Frames a second: for Create Video [1/s]."),
            ],
        )

    @classmethod
    def validate_inputs(
        cls,
        points: str | None = None,
        picture: str | None = None,
        background: dict[str, Any] | None = None,
        **others: Any,
    ) -> bool | str:
        # The host hands over what a choice brings only to a function that takes every input.
        sent = sent_inputs() or {}
        linked = {name for name, value in sent.items() if isinstance(value, list)}
        checks = [lambda: background_chosen(background), lambda: check_points(points or "")]
        if picture is not None and not linked & {"image", "layers"}:
            checks.append(lambda: file_of(picture))
            if not linked & {"points", "masks", "scene"} and not is_layered(picture):
                checks.append(lambda: _check_picked(points or ""))
        return refusal(*checks)

    @classmethod
    def fingerprint_inputs(cls, picture: str | None = None, **others: Any) -> list[Any]:
        try:
            contents = contents_of(file_of(picture or ""))
        except (InvalidInputError, OSError):
            contents = ""  # said when it is read
        return [contents, is_wanted(_FRAMES)]

    @classmethod
    def execute(
        cls,
        picture: str,
        points: str,
        preset: str,
        wind: float,
        wind_angle: float,
        loop: float,
        frames: int,
        fps: float,
        image: torch.Tensor | None = None,
        masks: torch.Tensor | None = None,
        layers: dict[str, Any] | None = None,
        scene: MaskedScene | str | None = None,
        background: dict[str, Any] | None = None,
        image_alpha: torch.Tensor | None = None,
        pixel_art: bool = False,
    ) -> io.NodeOutput:
        behind, report = background_chosen(background), host_progress()
        report(0, 2)  # the bar appears at once: cutting and meshing have no steps of their own
        given = given_picture(cls, picture, image, image_alpha, layers)
        shown: dict[str, Any] = {}
        if image is not None or layers is not None:
            shown = {"physanimator_picture": [saved_picture(given.seen)]}
            # At once: where nothing is picked yet, it has to be seen to be clicked on.
            send_to_page(PICTURE_EVENT, shown["physanimator_picture"][0])
        timing = {"loop": loop, "frames": frames, "fps": fps}
        if isinstance(scene, MaskedScene):
            moved = motion_of_scene(cls, scene, given, points, pixel_art, timing, report)
        else:
            document = checked_document(scene) if isinstance(scene, str) and scene.strip() else None
            said = {"preset": preset, "wind": wind, "wind_angle": wind_angle, **timing}
            moved = motion_of_parts(cls, given, points, masks, document, pixel_art, said, report)
        told = all_told(given.told, moved.told)
        if moved.motion.layers is None and not pixel_art:
            told = all_told(told, hint_of_pixel_art(cls, given.picture))
        motion, wanted = moved.motion.motion, is_wanted(_FRAMES)
        drawn = draw(cls, moved.renderer, motion, behind, report, wanted=wanted, exact=pixel_art)
        start_warm_up()
        return io.NodeOutput(
            not_made("frames") if drawn.batch is None else drawn.batch.tensor,
            batch_of_masks(moved.motion.masks, len(moved.motion.masks)),
            moved.motion,
            motion.frame_rate,
            ui=shown_with(drawn.shown, {**shown, **all_told(told, drawn.told)}),
        )


def _check_picked(points: str) -> None:
    if is_empty(points):
        raise InvalidInputError(NOTHING_PICKED)
