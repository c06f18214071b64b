"""In-betweens: frames between keyframes, drawn by the known motion, by optical flow or by a video model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..physics.errors import require
from .background_inputs import image_alpha_input
from .given_keyframes import ALL_FRAMES, IMAGES_ARE, GivenPictures, keyframe_numbers
from .host import (
    all_told,
    announce_batch,
    batch_of_pictures,
    chosen,
    host_progress,
    lines_of_frames,
    picture_with_alpha,
    pictures_of,
    refusal,
    told_of_light_lines,
)
from .host.wires import MaskedMotion, MotionWire
from .models import find_model_file
from .models.clip_inputs import AS_THE_MOTION, is_loop, loop_input
from .models.tooncrafter import missing_tooncrafter_files, tooncrafter_backend
from .models.tooncrafter_inputs import tooncrafter_inputs

if TYPE_CHECKING:
    import torch
    from numpy.typing import NDArray

__all__ = ["Interpolate"]

_TOONCRAFTER = "tooncrafter"


class Interpolate(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        from ..rendering.inbetweens import BACKENDS, DEFAULT_GAP

        described = "; ".join(f"{name}: {backend.description}" for name, backend in BACKENDS.items())
        return io.Schema(
            node_id="PhysAnimator_Interpolate",
            display_name="Interpolate (PhysAnimator)",
            category="PhysAnimator/render",
            description="Fills in the frames between keyframes.",
            inputs=[
                io.Image.Input("images", tooltip="All frames, or only the keyframes."),
                io.Combo.Input(
                    "images_are",
                    options=list(IMAGES_ARE),
                    default=ALL_FRAMES,
                    tooltip="all frames: every n-th of them, and the last, is kept as a keyframe and the others are"
                    " drawn anew. keyframes: each is kept.",
                ),
                io.Int.Input(
                    "every",
                    default=DEFAULT_GAP,
                    min=1,
                    max=1000,
                    tooltip="From one keyframe to the next [frames]; the paper takes 15.",
                ),
                io.DynamicCombo.Input(
                    "backend",
                    options=[
                        *(io.DynamicCombo.Option(name, []) for name in BACKENDS),
                        io.DynamicCombo.Option(_TOONCRAFTER, tooncrafter_inputs()),
                    ],
                    tooltip=f"Who draws the in-betweens. {described}; {_TOONCRAFTER}: the paper's video model, for"
                    " which model files are needed.",
                ),
                MotionWire.Input(
                    "motion",
                    optional=True,
                    tooltip="From Simulate: in-betweens then follow the known motion. Without it 'motion' is 'flow'.",
                ),
                io.String.Input(
                    "keyframes_at",
                    default="",
                    optional=True,
                    tooltip="Frame numbers of the keyframes, from 0, with commas between them, instead of every n-th."
                    " Frames before the first and after the last of them stay as they are; of keyframes alone the first"
                    " is shown until its turn. Empty: every n-th.",
                ),
                io.Image.Input(
                    "image",
                    optional=True,
                    tooltip="The illustration. Connect it beside motion: parts then end where the picture shows them to"
                    " end, as in Render, and not where a blurred, grown or hand-painted mask does.",
                ),
                image_alpha_input(),
                loop_input("in-betweens also lead from the last keyframe to the first"),
            ],
            outputs=[io.Image.Output(display_name="frames", tooltip="Keyframes and in-betweens.")],
        )

    @classmethod
    def validate_inputs(
        cls,
        images_are: str | None = None,
        backend: dict[str, Any] | None = None,
        keyframes_at: str | None = None,
        **others: Any,
    ) -> bool | str:
        # The host hands over the inputs that a choice brings only to a function that takes every input.
        missing = " ".join(missing_tooncrafter_files(backend or {}))
        return missing or refusal(lambda: keyframe_numbers(keyframes_at or "", images_are))

    @classmethod
    def execute(
        cls,
        images: torch.Tensor,
        images_are: str,
        every: int,
        backend: dict[str, Any],
        motion: MaskedMotion | None = None,
        keyframes_at: str = "",
        image: torch.Tensor | None = None,
        image_alpha: torch.Tensor | None = None,
        loop: str = AS_THE_MOTION,
    ) -> io.NodeOutput:
        from ..rendering.inbetweens import BACKENDS, interpolate

        name, choice = chosen(backend, "backend", (*BACKENDS, _TOONCRAFTER))
        known = motion.motion if motion else None
        drawn_by_model = name == _TOONCRAFTER
        pictures = pictures_of(images, name="images", alpha=not drawn_by_model)
        given = GivenPictures(pictures, images_are, every, keyframe_numbers(keyframes_at, images_are), known)
        wanted = is_loop(loop, known, given.cycle)
        keyframes, indices = given.keyframes(loops=wanted)
        loops = wanted and len(indices) > 1
        count = given.count(indices, loops=loops)
        told = announce_batch(cls, count, pictures.shape[2], pictures.shape[1], channels=pictures.shape[3])
        sketches = choice.get("sketches")
        told = all_told(told, told_of_light_lines(cls, sketches, name="sketches"))
        before, after = ([], []) if loops else given.kept(indices)
        frames = interpolate(
            list(keyframes),
            indices,
            backend=tooncrafter_backend(choice) if drawn_by_model else name,
            motion=known,
            masks=_shown_masks(motion, image, image_alpha),
            sketches=() if sketches is None else lines_of_frames(sketches),
            find_file=find_model_file,
            progress=None if drawn_by_model else host_progress(),
            before=before,
            after=after,
            loop=given.cycle if loops else None,
        )
        return io.NodeOutput(batch_of_pictures(frames, count), ui=told or None)


def _shown_masks(
    motion: MaskedMotion | None, image: torch.Tensor | None, image_alpha: torch.Tensor | None
) -> list[NDArray[Any]]:
    """The masks of a motion, with their edges where the picture has them if there is one; of layers as they are."""
    from ..rendering.matting import shown_part

    if motion is None or image is None:
        return [] if motion is None else list(motion.masks)
    picture, known = picture_with_alpha(image, image_alpha), motion.motion
    got = f"{picture.shape[1]} x {picture.shape[0]} px"
    size = f"{known.width} x {known.height} px"
    require("image", got, picture.shape[:2] == (known.height, known.width), f"of the motion's size, {size}")
    return list(motion.masks) if motion.layers else [shown_part(picture, mask) for mask in motion.masks]
