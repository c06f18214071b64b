"""The whole way from an illustration to its animation, without a host.

picture = load_image("girl.png")
mask = load_mask("hair.png", width=picture.shape[1], height=picture.shape[0])
animate(picture, [mask], preset="hair").save("girl.mp4")
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .physics.automatic import Attachment, automatic_scene
from .physics.collision import Collider, Contact
from .physics.errors import InvalidInputError, require
from .physics.given_scene import given_scene, materials_of
from .physics.loop import loop_frames
from .physics.masks import coverage_of
from .physics.material import Material
from .physics.mesh import TriangleMesh
from .physics.meshing import mesh_from_mask
from .physics.progress import Progress
from .physics.scene import Body, Scene
from .physics.simulation import simulate
from .rendering.animation import Animation, StageProgress, timed
from .rendering.background import over, renderer_of

__all__ = ["DEFAULT_FRAMES", "DEFAULT_FRAME_RATE", "Animation", "StageProgress", "animate"]

Image = NDArray[Any]
Mask = NDArray[Any]

DEFAULT_FRAMES = 72
DEFAULT_FRAME_RATE = 24.0


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
) -> Animation:
    """Set parts of an illustration in motion.

    Args:
        image: the illustration, RGB, or straight RGBA to move on transparency, uint8 or 0..1 float, shape [h, w, 3] or
            [h, w, 4].
        masks: where each moving part is, bool, 0..1 or 0..255, each of shape [h, w]; later ones lie in front.
        points: for each further part its query points, in any form that
            :func:`~physanimator.rendering.points.parse_points` reads.
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
        plate: the illustration without the moving parts, if it exists, RGB or RGBA; painted in when None.
        progress: called as the stages "simulate" and those of the frames advance.
        pixel_art: move whole pixels, or the blocks that an enlarged picture shows for them, and mix no colours.

    Raises:
        InvalidInputError: an input is unusable; the message names it.
    """
    seconds: dict[str, float] = {}
    image = np.asarray(image)
    pictured = image.ndim == 3 and image.shape[2] in (3, 4)
    require("image", f"shape {image.shape}", pictured, "an RGB picture [h, w, 3] or an RGBA picture [h, w, 4]")
    _check_frames(frames, skip)
    if isinstance(scene, Mapping):
        from .physics.scene_checking import check_document

        check_document(scene)
    with timed(seconds, "segment"):
        parts = (*(masks or ()), *_segmented(over(image), points or ()))
    _check_parts(image, parts, plate)
    with timed(seconds, "mesh"):
        meshes = [mesh_from_mask(each, spacing=spacing) for each in parts]
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
    with timed(seconds, "simulate"):
        motion = simulate(whole, frames=frames, progress=_stage("simulate", progress))
    with timed(seconds, "prepare"):
        renderer = renderer_of(image, parts, motion, plate=plate, pixel_art=pixel_art)
    return Animation(image, parts, whole, motion, renderer, skip, seconds)


def _check_frames(frames: int | None, skip: int) -> None:
    if frames is not None:
        require("frames", frames, frames >= 1, "at least 1")
        require("skip", skip, 0 <= skip < frames, f"at least 0 and below the number of frames ({frames})")


def _segmented(image: Image, points: Sequence[Any]) -> Iterator[Mask]:
    if not points:
        return
    from .rendering.points import parse_points
    from .rendering.segmentation import segment

    height, width = image.shape[:2]
    for each in points:
        clicked = parse_points(each, width=width, height=height)
        yield segment(image, [(p.x, p.y) for p in clicked], [int(p.positive) for p in clicked])


def _check_parts(image: Image, parts: Sequence[Mask], plate: Image | None) -> None:
    height, width = image.shape[:2]
    if not parts:
        raise InvalidInputError("an animation needs at least one mask, or points on a part. Got: neither")
    for number, mask in enumerate(parts):
        if np.shape(mask) != (height, width):
            raise InvalidInputError(
                f"masks[{number}] must have the picture's shape, [{height}, {width}]. Got: {list(np.shape(mask))}"
            )
    if plate is not None and np.shape(plate) not in ((height, width, 3), (height, width, 4)):
        raise InvalidInputError(f"plate must have the picture's shape, {image.shape}. Got: {np.shape(plate)}")


def _layered(meshes: Sequence[TriangleMesh], materials: Sequence[Material]) -> list[Body]:
    return [Body(mesh, made, layer) for layer, (mesh, made) in enumerate(zip(meshes, materials, strict=True))]


def _touching(scene: Scene, contact: Contact | None, colliders: Sequence[Mask]) -> Scene:
    if contact is not None:
        scene = replace(scene, contact=contact)
    if not colliders:
        return scene
    require("contact", scene.contact, scene.contact is not None, "given where there are colliders")
    added = tuple(Collider.from_mask(coverage_of(each) > 0.5) for each in colliders)
    return replace(scene, colliders=(*scene.colliders, *added))


def _stage(name: str, progress: StageProgress | None) -> Progress | None:
    return None if progress is None else lambda done, total: progress(name, done, total)
