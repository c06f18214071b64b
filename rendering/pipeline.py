"""The whole way from an illustration to its animation, without a host.

picture = load_image("girl.png")
mask = load_mask("hair.png", width=picture.shape[1], height=picture.shape[0])
animate(picture, [mask], preset="hair").save("girl.mp4")
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from numpy.typing import NDArray

from ..physics.assembly import work_of_minutes
from ..physics.document import given_scene, materials_of
from ..physics.errors import InvalidInputError, require
from ..physics.limits import DEFAULT_MINUTES
from ..physics.material import Material
from ..physics.mesh import TriangleMesh, coverage_of, fitted, mesh_from_mask
from ..physics.process_end import working
from ..physics.progress import Progress
from ..physics.scene import Attachment, Body, Collider, Contact, Scene, automatic_scene, check_scene_rate
from ..physics.simulation import loop_frames, simulate
from .animation import Animation, StageProgress, timed
from .composite import renderer_of
from .drawing_checks import check_count
from .matting import part_mesh
from .pictures import as_picture, over

__all__ = ["DEFAULT_FRAMES", "DEFAULT_FRAME_RATE", "Animation", "StageProgress", "animate"]

Image = NDArray[Any]
Mask = NDArray[Any]

DEFAULT_FRAMES = 72
DEFAULT_FRAME_RATE = 24.0


@working()
def animate(
    image: Image,
    masks: Sequence[Mask] | None = None,
    points: Sequence[Any] | None = None,
    *,
    scene: Scene | Mapping[str, Any] | None = None,
    preset: str | Sequence[str] | None = None,
    frames: int | None = None,
    skip: int = 0,
    loop: float | None = None,
    frame_rate: float | None = None,
    spacing: float | None = None,
    sway: float | None = None,
    attach: Attachment = "auto",
    wind_strength: float = 1.0,
    wind_angle: float = 0.0,
    turbulence: float | None = None,
    contact: Contact | None = None,
    colliders: Sequence[Mask] = (),
    plate: Image | None = None,
    progress: StageProgress | None = None,
    pixel_art: bool = False,
    max_minutes: float = DEFAULT_MINUTES,
    on_cut: Callable[[Sequence[Mask]], None] | None = None,
    on_scene: Callable[[Scene], None] | None = None,
) -> Animation:
    """Set parts of an illustration in motion.

    Args:
        image: the illustration, RGB, or straight RGBA to move on transparency, shape [h, w, 3] or [h, w, 4]: uint8,
            uint16, other whole numbers 0..255, or floating-point numbers 0..1 of any precision, as
            :func:`as_picture` says.
        masks: where each moving part is, bool, 0..1, 0..255 or 0..65535, each of shape [h, w] or, to be scaled, of the
            picture's proportions; later ones lie in front.
        points: for each further part its query points, in any form that
            :func:`~physanimator.physics.document.parse_points` reads.
        scene: what acts on the parts, as a ``Scene`` with one body for each part or as a decoded scene document;
            without one, the parts are pinned where they are attached and a gentle wind blows.
        preset: name of the material, one for all parts or one for each; replaces the scene's materials.
            Without a scene it is "hair" unless said otherwise.
        frames: frames of the motion; frame 0 is the illustration. When None, those of the loop, or 72 without one.
        skip: frames at the start that are simulated but not shown, so that the motion has settled in.
        loop: length of a seamless loop [s]; its frame 0 is not the illustration. None: the scene's own, if it has one.
        frame_rate: frames a second; the scene's own, or 24, when None.
        spacing: distance of the mesh's vertices [px]; chosen from each mask when None.
        sway: how often a part sways to and fro in a second, instead of the preset's [Hz].
        attach: side at which the parts are held when there is no scene.
        wind_strength: factor on the wind when there is no scene.
        wind_angle: where that wind blows to [degrees]; 0 is right, 90 up.
        turbulence: blow a steady wind field with gusts and eddies, which are this share of it (0 to 1), instead of
            passing gusts, when there is no scene.
        contact: how the parts keep out of each other, instead of what the scene says.
        colliders: masks of what the parts keep out of besides the scene's colliders; they need contact.
        plate: the illustration without the moving parts, if it exists, RGB or RGBA in any form that ``image`` may have
            and of its size; painted in when None.
        progress: called as the stages "simulate" and those of the frames advance.
        pixel_art: move whole pixels, or the blocks that an enlarged picture shows for them, and mix no colours.
        max_minutes: minutes that the simulation may take, by the estimate for one core of an ordinary machine; what
            would take longer is refused before it begins.
        on_cut: called with the masks that were cut from points, before anything is made of them.
        on_scene: called with the scene before it is simulated.

    Raises:
        InvalidInputError: an input is unusable; the message names it.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.pipeline import animate
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mask = np.pad(np.ones((40, 40)), 10)
        >>> animation = animate(picture, [mask], preset="hair", frames=3, spacing=10)
        >>> [frame.shape for frame in animation.frames()]
        [(60, 60, 3), (60, 60, 3), (60, 60, 3)]
    """
    seconds: dict[str, float] = {}
    image = as_picture(image, alpha=True)
    plate = _checked_plate(plate, image)
    masks, colliders = (
        _coverages("masks", () if masks is None else masks, image),
        _coverages("colliders", colliders, image),
    )
    _check_frames(frames, skip)
    if frame_rate is not None:
        check_scene_rate(frame_rate)
    work_of_minutes(max_minutes)
    if scene is not None and not isinstance(scene, Scene):
        from ..physics.document import check_document

        check_document(scene)
    with timed(seconds, "segment"):
        parts = (*masks, *_segmented(over(image), points or ()))
    _check_parts(parts)
    names = _part_names(len(masks), len(parts))
    if on_cut is not None:
        on_cut(parts[len(masks) :])
    with timed(seconds, "mesh"):
        seen = None if pixel_art else image  # pixel art moves the very pixels of its mask
        meshes = [_meshed(part, spacing, name, seen) for part, name in zip(parts, names, strict=True)]
    with timed(seconds, "scene"):
        if scene is None:
            whole = automatic_scene(
                _layered(meshes, materials_of(preset or "hair", sway, len(meshes))),
                attach=attach,
                frame_rate=DEFAULT_FRAME_RATE if frame_rate is None else frame_rate,
                wind_strength=wind_strength,
                wind_angle=wind_angle,
                turbulence=turbulence,
                sway_by_size=sway is None,
            )
        else:
            whole = given_scene(scene, meshes, preset=preset, sway=sway, frame_rate=frame_rate)
        whole = whole if loop is None else replace(whole, loop=loop)
        if frames is None:
            frames = DEFAULT_FRAMES if whole.loop is None else loop_frames(whole) + skip
            _check_frames(frames, skip)
        whole = _touching(whole, contact, colliders)
    if on_scene is not None:
        on_scene(whole)
    with timed(seconds, "simulate"):
        motion = simulate(whole, frames=frames, progress=_stage("simulate", progress), max_minutes=max_minutes)
    with timed(seconds, "prepare"):
        renderer = renderer_of(image, parts, motion, plate=plate, pixel_art=pixel_art)
    return Animation(image, parts, whole, motion, renderer, skip, seconds)


def _checked_plate(plate: Image | None, image: Image) -> Image | None:
    """The plate as an array, which suits the picture: the renderer, which needs it, comes after the simulation."""
    if plate is None:
        return None
    plate = as_picture(plate, name="plate", alpha=True)
    if plate.shape[:2] != image.shape[:2]:
        raise InvalidInputError(f"plate must have the picture's size, {image.shape[:2]}. Got: {plate.shape[:2]}")
    return plate


def _check_frames(frames: int | None, skip: int) -> None:
    check_count("skip", skip, least=0)
    if frames is not None:
        check_count("frames", frames)
        require("skip", skip, 0 <= skip < frames, f"at least 0 and below the number of frames ({frames})")


def _coverages(name: str, masks: Sequence[Mask], image: Image) -> list[Mask]:
    """Masks as numbers from 0 to 1 of the picture's size."""
    height, width = image.shape[:2]
    named = [(f"{name}[{number}]", mask) for number, mask in enumerate(masks)]
    return [fitted(coverage_of(mask, name=each), width, height, name=each) for each, mask in named]


def _segmented(image: Image, points: Sequence[Any]) -> Iterator[Mask]:
    if not points:
        return
    from ..physics.document import parse_points
    from .segmentation import segment

    height, width = image.shape[:2]
    for each, name in zip(points, _part_names(0, len(points)), strict=True):
        with _about(name):
            clicked = parse_points(each, width=width, height=height)
            yield segment(image, [(p.x, p.y) for p in clicked], [int(p.positive) for p in clicked])


def _meshed(part: Mask, spacing: float | None, name: str, image: Image | None) -> TriangleMesh:
    with _about(name):
        if image is None:
            return mesh_from_mask(part, spacing=spacing)
        return part_mesh(image, part, spacing=spacing)


def _part_names(masks: int, parts: int) -> list[str]:
    """What the parts come from, where there are several."""
    if parts == 1:
        return [""]
    return [f"masks[{number}]" if number < masks else f"points[{number - masks}]" for number in range(parts)]


@contextmanager
def _about(name: str) -> Iterator[None]:
    """Let an error tell what it is about."""
    try:
        yield
    except InvalidInputError as error:
        if not name:
            raise
        raise type(error)(f"{name}: {error}") from error


def _check_parts(parts: Sequence[Mask]) -> None:
    if not parts:
        raise InvalidInputError("an animation needs at least one mask, or points on a part. Got: neither")


def _layered(meshes: Sequence[TriangleMesh], materials: Sequence[Material]) -> list[Body]:
    return [Body(mesh, made, layer) for layer, (mesh, made) in enumerate(zip(meshes, materials, strict=True))]


def _touching(scene: Scene, contact: Contact | None, colliders: Sequence[Mask]) -> Scene:
    if contact is not None:
        scene = replace(scene, contact=contact)
    if not colliders:
        return scene
    require("contact", scene.contact, scene.contact is not None, "given where there are colliders")
    added = tuple(Collider.from_mask(each > 0.5) for each in colliders)
    return replace(scene, colliders=(*scene.colliders, *added))


def _stage(name: str, progress: StageProgress | None) -> Progress | None:
    return None if progress is None else lambda done, total: progress(name, done, total)
