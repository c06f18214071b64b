"""From motion to frames: the renderers, and in-betweens."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..physics.errors import require
from .background_inputs import background_chosen, background_inputs, image_alpha_input
from .drawing import drawing_of, in_front_input, told_of_another_picture
from .host import (
    all_told,
    announce_batch,
    batch_of_pictures,
    chosen,
    hint_of_pixel_art,
    host_progress,
    is_wanted,
    lines_of_frames,
    mask_batch,
    not_made,
    picture_batch,
    picture_with_alpha,
    pictures_of,
    refusal,
    sent_inputs,
    told_of_light_lines,
    whole_numbers_of,
)
from .host.running import is_linked
from .host.wires import MaskedMotion, MotionWire
from .models import find_model_file
from .models.clip_inputs import AS_THE_MOTION, is_loop, loop_input
from .models.inpainting import inpainted_frames, refused_inpainting
from .models.inpainting_inputs import inpainting_inputs
from .models.svd import check_followed, missing_svd_files, svd_frames
from .models.svd_inputs import dual_clock_inputs, svd_inputs
from .models.tooncrafter import missing_tooncrafter_files, tooncrafter_backend
from .models.tooncrafter_inputs import tooncrafter_inputs

if TYPE_CHECKING:
    from collections.abc import Iterator

    import torch
    from numpy.typing import NDArray

    from ..physics.motion import Motion
    from ..rendering.composite import Background, LayeredRenderer, PixelArtRenderer
    from .host import FrameBatch

__all__ = ["Interpolate", "Render"]

_COMPOSITE, _SVD, _INPAINTING = "composite", "sketch-guided SVD", "soft inpainting"
_DUAL_CLOCK = "animation-guided SVD"
_RENDERERS = (_COMPOSITE, _SVD, _INPAINTING, _DUAL_CLOCK)
_TOONCRAFTER = "tooncrafter"
_FRAMES, _ALPHA, _PLATE = 0, 1, 2  # numbers of the outputs
_IMAGES_ARE = ("all frames", "keyframes")


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
                io.DynamicCombo.Input(
                    "renderer",
                    options=[
                        io.DynamicCombo.Option(_COMPOSITE, []),
                        io.DynamicCombo.Option(_SVD, svd_inputs()),
                        io.DynamicCombo.Option(_INPAINTING, inpainting_inputs()),
                        io.DynamicCombo.Option(_DUAL_CLOCK, dual_clock_inputs()),
                    ],
                    optional=True,
                    tooltip="composite: the illustration's own pixels, without any model."
                    " sketch-guided SVD: the paper's renderer, for which two model files are needed. soft inpainting:"
                    " composite, with what the parts have uncovered painted by Stable Diffusion. animation-guided SVD:"
                    " composite's frames, repainted by Stable Video Diffusion alone.",
                ),
                io.Image.Input(
                    "clean_plate",
                    optional=True,
                    tooltip="The picture without the moving parts. Painted automatically when left out.",
                ),
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
        checks = [lambda: background_chosen(background)]
        if renderer and renderer.get("renderer") == _DUAL_CLOCK:
            checks.append(lambda: check_followed(renderer, sketches="renderer.sketches" in sent))
        if "motion" not in sent:
            checks.append(lambda: _check_without_motion(renderer, plate="clean_plate" in sent))
        refused = missing_svd_files(renderer or {}) or refused_inpainting(renderer or {})
        return refused or refusal(*checks)

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

        name, choice = chosen(renderer, "renderer", _RENDERERS) if renderer else (_COMPOSITE, {})
        behind, by_model = background_chosen(background), name != _COMPOSITE
        picture = picture_with_alpha(image, image_alpha)
        plate = None if clean_plate is None else picture_with_alpha(clean_plate, name="clean_plate")
        if by_model:
            transparent = behind.has_alpha or pixel_art
            require("background", behind.kind, not transparent, f"opaque, and pixel_art off, with {name}")
            picture, plate = over(picture, behind.colour), plate if plate is None else over(plate, behind.colour)
        if motion is None:
            _check_without_motion(renderer, plate=plate is not None)
            return _from_sketches(cls, picture, plate, renderer or {})
        drawing = drawing_of(motion, picture, plate=plate, pixel_art=pixel_art, in_front=in_front)
        count, (height, width) = len(motion.motion), picture.shape[:2]
        frames = picture_batch(count) if is_wanted(_FRAMES) else None
        alpha = mask_batch(count) if is_wanted(_ALPHA) else None
        channels = (3 + behind.has_alpha) * (frames is not None) + (alpha is not None)
        instead = "" if by_model else "use Save Animation, which holds one frame at a time"
        told = announce_batch(cls, count, width, height, channels=channels, instead=instead)
        if not (by_model or pixel_art or motion.layers):
            told = all_told(told, hint_of_pixel_art(cls, picture))
        told = all_told(told, told_of_another_picture(cls, motion, picture))
        told = all_told(told, told_of_light_lines(cls, choice.get("sketches"), name="sketches"))
        layers = drawing(motion.motion)
        if by_model and frames is not None:
            for frame in _drawn_by_model(name, picture, layers, behind, choice):
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
    choice = renderer or {"renderer": _COMPOSITE}
    name = choice.get("renderer")
    wants = {
        f"for the renderer {name}, which moves the picture's own pixels": name != _SVD,
        "or keep_still_parts switched off, as it tells which parts are still": choice.get("keep_still_parts"),
        "where alpha is, which shows the moving parts": is_linked(_ALPHA) is True,
        "where the output clean_plate is, or the input clean_plate": is_linked(_PLATE) is True and not plate,
    }
    for reason, wanted in wants.items():
        require("motion", "nothing", not wanted, f"connected {reason}")


def _drawn_by_model(
    name: str, picture: NDArray[Any], layers: LayeredRenderer, background: Background, choice: dict[str, Any]
) -> Iterator[NDArray[Any]]:
    """All frames by the model of a choice."""
    if name == _INPAINTING:
        return inpainted_frames(layers, background, choice)
    sketches = _sketches_of(choice)
    if name == _SVD:
        return svd_frames(picture, sketches, layers, choice)
    check_followed(choice, sketches=bool(sketches))
    return svd_frames(picture, sketches, layers, choice, background)


def _sketches_of(choice: dict[str, Any]) -> list[NDArray[Any]]:
    given = choice.get("sketches")
    return [] if given is None else lines_of_frames(given)


def _from_sketches(
    node: Any, picture: NDArray[Any], plate: NDArray[Any] | None, choice: dict[str, Any]
) -> io.NodeOutput:
    """What the video model draws of the illustration and its sketches alone."""
    sketches, made = _sketches_of(choice), not_made("frames")
    told: dict[str, list[str]] = {}
    if is_wanted(_FRAMES):
        told = announce_batch(node, len(sketches), picture.shape[1], picture.shape[0])
        told = all_told(told, told_of_light_lines(node, choice["sketches"], name="sketches"))
        made = batch_of_pictures(svd_frames(picture, sketches, None, choice), len(sketches))
    behind = not_made("clean_plate") if plate is None else batch_of_pictures([plate], 1)
    return io.NodeOutput(made, not_made("alpha"), behind, ui=told or None)


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
                    options=list(_IMAGES_ARE),
                    default=_IMAGES_ARE[0],
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
        return missing or refusal(lambda: _numbers_of(keyframes_at or "", images_are))

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
        at = _numbers_of(keyframes_at, images_are)
        cycle = _cycle(pictures, images_are, every, at, known)
        loops = is_loop(loop, known, cycle)
        keyframes, indices = _keyframes(pictures, images_are, every, at, known, loops=loops)
        loops = loops and len(indices) > 1
        count = indices[-1] + 1 if images_are == _IMAGES_ARE[1] else len(pictures)
        count = cycle if loops else count
        told = announce_batch(cls, count, pictures.shape[2], pictures.shape[1], channels=pictures.shape[3])
        sketches = choice.get("sketches")
        told = all_told(told, told_of_light_lines(cls, sketches, name="sketches"))
        before, after = ([], []) if loops else _kept(pictures, images_are, indices)
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
            loop=cycle if loops else None,
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


def _numbers_of(keyframes_at: str, images_are: str | None) -> tuple[int, ...]:
    """The typed frame numbers; InvalidInputError where no clip can have such keyframes."""
    at = whole_numbers_of(keyframes_at, name="keyframes_at")
    require("keyframes_at", keyframes_at[:60], min(at, default=0) >= 0, "frame numbers from 0")
    if images_are == _IMAGES_ARE[1] and at:
        rising = all(one < next_one for one, next_one in pairwise(at))
        require("keyframes_at", keyframes_at[:60], rising, "increasing frame numbers, one for each keyframe")
    return at


def _cycle(pictures: NDArray[Any], images_are: str, every: int, at: tuple[int, ...], motion: Motion | None) -> int:
    """How many frames the clip has if it is a loop."""
    if images_are != _IMAGES_ARE[1]:
        return len(pictures)
    if motion is not None:
        return len(motion)
    return at[-1] + every if at else every * len(pictures)


def _keyframes(
    pictures: NDArray[Any], images_are: str, every: int, at: tuple[int, ...], motion: Motion | None, *, loops: bool
) -> tuple[NDArray[Any], list[int]]:
    """The keyframes among the pictures and their frame numbers."""
    from ..rendering.inbetweens import keyframe_indices

    if images_are == _IMAGES_ARE[1]:
        last = len(motion) - 1 if motion else every * len(pictures)
        regular = [min(every * number, last) for number in range(len(pictures))]
        return pictures, list(at) or regular
    indices = keyframe_indices(len(pictures), every, at=at, loops=loops)
    return pictures[indices], indices


def _kept(pictures: NDArray[Any], images_are: str, indices: list[int]) -> tuple[list[NDArray[Any]], list[NDArray[Any]]]:
    """What is shown before the first keyframe and after the last."""
    if images_are == _IMAGES_ARE[1]:
        return [pictures[0]] * indices[0], []
    return list(pictures[: indices[0]]), list(pictures[indices[-1] + 1 :])
