"""From motion to frames, by the renderer that is chosen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..physics.errors import require
from .background_inputs import background_chosen, background_inputs
from .drawing import clean_plate_input, drawing_of, in_front_input, told_of_another_picture
from .host import (
    all_told,
    announce_batch,
    batch_of_pictures,
    hint_of_pixel_art,
    host_progress,
    is_wanted,
    mask_batch,
    not_made,
    picture_batch,
    picture_with_alpha,
    refusal,
    sent_inputs,
    told_of_light_lines,
)
from .host.running import is_linked
from .host.wires import MaskedMotion, MotionWire
from .renderers import (
    COMPOSITE,
    check_followed_by,
    check_moves_without_motion,
    frames_by_model,
    missing_model_files,
    renderer_chosen,
    renderer_input,
    sketches_of,
)

if TYPE_CHECKING:
    import torch
    from numpy.typing import NDArray

    from ..rendering.composite import Background, LayeredRenderer, PixelArtRenderer
    from .host import FrameBatch

__all__ = ["Render"]

_FRAMES, _ALPHA, _PLATE = 0, 1, 2  # numbers of the outputs


class Render(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_Render",
            display_name="Render (PhysAnimator)",
            category="PhysAnimator/render",
            description="Paints the frames: each body stretched along with its mesh, over the picture without it; or by"
            " a video model that follows sketches or that animation; or with holes painted by an image model.",
            inputs=[
                io.Image.Input("image", tooltip="The illustration (one picture)."),
                MotionWire.Input(
                    "motion",
                    optional=True,
                    tooltip="From Simulate; it carries the masks along. sketch-guided SVD draws without it, too, if"
                    " keep_still_parts is off.",
                ),
                renderer_input(),
                clean_plate_input(),
                *background_inputs(),
                in_front_input(),
            ],
            outputs=[
                io.Image.Output(display_name="frames", tooltip="One picture a frame: for Create Video."),
                io.Mask.Output(
                    display_name="alpha",
                    tooltip="White where the moving parts are, one mask a frame; of transparent frames the alpha. Made"
                    " only where it is connected.",
                ),
                io.Image.Output("plate", display_name="clean_plate", tooltip="The picture without the moving parts."),
            ],
        )

    @classmethod
    def validate_inputs(
        cls, renderer: dict[str, Any] | None = None, background: dict[str, Any] | None = None, **others: Any
    ) -> bool | str:
        # Before the simulation, not after it. The host hands over what a choice brings only if every input is taken.
        sent = sent_inputs() or {"motion": []}
        checks = [
            lambda: background_chosen(background),
            lambda: check_followed_by(renderer, sketches="renderer.sketches" in sent),
        ]
        if "motion" not in sent:
            checks.append(lambda: _check_without_motion(renderer, plate="clean_plate" in sent))
        return missing_model_files(renderer) or refusal(*checks)

    @classmethod
    def fingerprint_inputs(cls, **inputs: Any) -> list[bool]:
        plate = is_wanted(_PLATE) and "motion" not in (sent_inputs() or {"motion": []})
        return [is_wanted(_FRAMES), is_wanted(_ALPHA), *[True] * plate]

    @classmethod
    def execute(
        cls,
        image: torch.Tensor,
        motion: MaskedMotion | None = None,
        renderer: dict[str, Any] | None = None,
        clean_plate: torch.Tensor | None = None,
        background: dict[str, Any] | None = None,
        image_alpha: torch.Tensor | None = None,
        pixel_art: bool = False,
        in_front: torch.Tensor | None = None,
    ) -> io.NodeOutput:
        from ..rendering.pictures import over

        name, choice = renderer_chosen(renderer)
        behind, by_model = background_chosen(background), name != COMPOSITE
        picture = picture_with_alpha(image, image_alpha)
        plate = None if clean_plate is None else picture_with_alpha(clean_plate, name="clean_plate")
        if by_model:
            transparent = behind.has_alpha or pixel_art
            require("background", behind.kind, not transparent, f"opaque, and pixel_art off, with {name}")
            picture, plate = over(picture, behind.colour), plate if plate is None else over(plate, behind.colour)
        if motion is None:
            _check_without_motion(renderer, plate=plate is not None)
            return _from_sketches(cls, name, picture, plate, behind, choice)
        drawing = drawing_of(motion, picture, plate=plate, pixel_art=pixel_art, in_front=in_front)
        count, (height, width) = len(motion.motion), picture.shape[:2]
        frames = picture_batch(count) if is_wanted(_FRAMES) else None
        alpha = mask_batch(count) if is_wanted(_ALPHA) else None
        channels = (3 + behind.has_alpha) * (frames is not None) + (alpha is not None)
        instead = "" if by_model else "use Save Animation, which holds one frame at a time"
        told = announce_batch(cls, count, width, height, channels=channels, instead=instead)
        if not (by_model or pixel_art or motion.layers):
            told = all_told(told, hint_of_pixel_art(cls, picture))
        told = all_told(told, told_of_another_picture(cls, motion, picture, plate))
        told = all_told(told, told_of_light_lines(cls, choice.get("sketches"), name="sketches"))
        layers = drawing(motion.motion)
        if by_model and frames is not None:
            for frame in frames_by_model(name, picture, layers, behind, choice):
                frames.put(frame)
        _compose(layers, behind, None if by_model else frames, alpha)
        both = (("frames", frames), ("alpha", alpha))
        made = [not_made(name) if batch is None else batch.tensor for name, batch in both]
        behind_all = layers.plate if behind.has_alpha else over(layers.plate, behind.colour)
        return io.NodeOutput(*made, batch_of_pictures([behind_all], 1), ui=told or None)


def _check_without_motion(renderer: dict[str, Any] | None, *, plate: bool) -> None:
    """Raise where something is asked for that only a motion can tell.

    Args:
        renderer: the choice, with what it brings.
        plate: a clean plate is connected.
    """
    check_moves_without_motion(renderer)
    wants = {
        "where alpha is, which shows the moving parts": is_linked(_ALPHA) is True,
        "where the output clean_plate is, or the input clean_plate": is_linked(_PLATE) is True and not plate,
    }
    for reason, wanted in wants.items():
        require("motion", "nothing", not wanted, f"connected {reason}")


def _from_sketches(
    node: Any,
    name: str,
    picture: NDArray[Any],
    plate: NDArray[Any] | None,
    behind: Background,
    choice: dict[str, Any],
) -> io.NodeOutput:
    """What the video model draws of the illustration and its sketches alone."""
    count, made = len(sketches_of(choice)), not_made("frames")
    told: dict[str, list[str]] = {}
    if is_wanted(_FRAMES):
        told = announce_batch(node, count, picture.shape[1], picture.shape[0])
        told = all_told(told, told_of_light_lines(node, choice["sketches"], name="sketches"))
        made = batch_of_pictures(frames_by_model(name, picture, None, behind, choice), count)
    shown = not_made("clean_plate") if plate is None else batch_of_pictures([plate], 1)
    return io.NodeOutput(made, not_made("alpha"), shown, ui=told or None)


def _compose(
    layers: LayeredRenderer | PixelArtRenderer,
    background: Background,
    frames: FrameBatch | None,
    alpha: FrameBatch | None,
) -> None:
    """Draw into the batches that there are."""
    from ..rendering.composite import shown_frame, shown_frame_and_alpha

    report = host_progress()
    for number in range(len(layers) if frames or alpha else 0):
        if alpha is None and frames is not None:
            frames.put(shown_frame(layers, number, background))
        elif alpha is not None:
            frame, covered = shown_frame_and_alpha(layers, number, background)
            alpha.put(covered)
            if frames is not None:
                frames.put(frame)
        report(number + 1, len(layers))
