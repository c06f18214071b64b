"""The motion of each sample of a picture: one for all methods, so that only what draws it differs."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.forces import EnergyStroke
from ...physics.mesh import PixelBox, TriangleMesh, barycentric, triangle_ids
from ...physics.motion import Motion
from ...physics.scene import Scene
from ..animation import Animation
from ..options import Timing
from ..pipeline import animate
from ..stages import StageProgress
from .evaluation_set import EvaluationSet, PictureOfSet
from .loaded_pictures import LoadedPicture, loaded
from .mask_errors import spoiled
from .methods import Method

__all__ = ["Impossible", "animation_of", "check_motion", "reference_of", "sample_scene"]

# Samples beyond the first: strength within a factor, direction within an angle [degrees], of what the scene says.
_STRONGER, _TURNED = 1.5, 20.0


class Impossible(InvalidInputError):
    """Spoiled masks leave nothing that could be animated; the message says why."""


def check_motion(which: EvaluationSet, picture: PictureOfSet) -> None:
    """Refuse a picture whose parts or scene cannot be animated, before any work.

    Raises:
        InvalidInputError: the message names the picture.
    """
    _at_rest(picture, which.size, which.rate, "", 0.0, 0)


def reference_of(
    which: EvaluationSet,
    picture: PictureOfSet,
    sample: int,
    *,
    contact: bool = True,
    progress: StageProgress | None = None,
) -> Animation:
    """How a sample moves, by the masks as they are; the last ones from memory.

    Args:
        which: the set.
        picture: one of it.
        sample: its number.
        contact: whether bodies touch, where the scene says so.
        progress: called while it is simulated.

    Raises:
        InvalidInputError: picture or scene are unusable.
    """
    key = (picture, which.size, which.frames, which.rate, which.seed, sample, contact)
    if key not in _simulated:
        while len(_simulated) > 1:
            _simulated.pop(next(iter(_simulated)))
        _simulated[key] = _reference(which, picture, sample, contact, progress)
    return _simulated[key]


_simulated: dict[Any, Animation] = {}


def _reference(
    which: EvaluationSet, picture: PictureOfSet, sample: int, contact: bool, progress: StageProgress | None
) -> Animation:
    from ..options import Watch

    shown = loaded(picture, which.size)
    resting = _at_rest(picture, which.size, which.rate, "", 0.0, 0)
    scene = sample_scene(resting.scene, which.seed, picture.name, sample)
    scene = scene if contact else replace(scene, contact=None)
    timing = Timing(frames=None if scene.loop else which.frames, frame_rate=which.rate)
    try:
        return _animated(shown, shown.masks, scene=scene, timing=timing, watch=Watch(progress=progress))
    except InvalidInputError as error:
        raise InvalidInputError(f"picture {picture.name!r}, sample {sample}: {error}") from error


@lru_cache(maxsize=2)
def _at_rest(picture: PictureOfSet, size: int, rate: float, mask_error: str, amount: float, seed: int) -> Animation:
    """The picture taken apart and its scene, by masks as they are or with an error."""
    shown = loaded(picture, size)
    masks = shown.masks
    if mask_error:
        masks = tuple(spoiled(each, mask_error, amount, seed=seed + n) for n, each in enumerate(masks))
    preset = list(picture.presets) or None
    one = preset[0] if preset and len(preset) == 1 else preset
    timing = Timing(frames=1, frame_rate=rate)
    document = None if shown.scene is None else {**shown.scene, "loop": None}
    try:
        found = _animated(shown, masks, scene=document, preset=one, timing=timing)
    except InvalidInputError as error:
        if mask_error:
            raise Impossible(f"its masks, {mask_error} by {amount:g} px, cannot be animated: {error}") from error
        raise InvalidInputError(f"picture {picture.name!r}: {error}") from error
    loop = None if shown.scene is None else shown.scene.get("loop")
    return replace(found, scene=replace(found.scene, loop=loop))


def _animated(shown: LoadedPicture, masks: Any, **how: Any) -> Animation:
    flat: dict[str, Any] = (
        {} if shown.layered else {"masks": list(masks), "plate": shown.plate, "in_front": shown.in_front}
    )
    return animate(shown.image, **flat, **how)


def sample_scene(scene: Scene, seed: int, name: str, sample: int) -> Scene:
    """The scene of a sample: as it is of the first; of others wind and strokes are stronger or weaker, and turned.

    Args:
        scene: of the picture.
        seed: of the set.
        name: of the picture.
        sample: number of the sample.
    """
    if sample == 0:
        return scene
    chance = np.random.default_rng([seed, sample, *name.encode()])
    factor = float(_STRONGER ** chance.uniform(-1, 1))
    angle = float(chance.uniform(-_TURNED, _TURNED))
    wind = scene.wind
    if wind is not None:
        turned = replace(wind, strength=wind.strength * factor, angle=wind.angle + angle)
        wind = replace(turned, seed=int(chance.integers(2**31)))
    strokes = tuple(_changed(each, factor, np.radians(-angle)) for each in scene.strokes)
    return replace(scene, wind=wind, strokes=strokes)


def _changed(stroke: EnergyStroke, factor: float, angle: float) -> EnergyStroke:
    """A stroke that is stronger, and turned about its middle [radians, clockwise]."""
    path = np.asarray(stroke.path, dtype=np.float64)
    middle = path.mean(axis=0)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    points = tuple((float(x), float(y)) for x, y in (path - middle) @ turn + middle)
    return replace(stroke, path=points, strength=stroke.strength * factor)


def animation_of(
    which: EvaluationSet,
    picture: PictureOfSet,
    sample: int,
    method: Method,
    *,
    progress: StageProgress | None = None,
) -> Animation:
    """What a method draws: the sample's motion, carried by the parts that its masks cut out.

    A spoiled mask changes what is cut out, not how it moves: each vertex of its mesh goes where the true mesh has it,
    and beyond that along with the nearest vertex, as one flow field would warp them.

    Raises:
        InvalidInputError: picture or scene are unusable, also with its masks spoiled.
    """
    truth = reference_of(which, picture, sample, contact=method.contact, progress=progress)
    if not method.mask_error:
        return truth
    error = method.mask_error, method.mask_error_px, which.seed
    resting = _at_rest(picture, which.size, which.rate, *error)
    positions = np.concatenate(
        [
            _carried(body.mesh, other.mesh, truth.motion.of_body(number))
            for number, (body, other) in enumerate(zip(resting.motion.bodies, truth.motion.bodies, strict=True))
        ],
        axis=1,
    )
    motion = Motion(resting.motion.bodies, positions, truth.motion.frame_rate, truth.motion.loop)
    return replace(resting, motion=motion, renderer=resting.renderer.showing(motion))  # type: ignore[union-attr]


def _carried(mesh: TriangleMesh, true: TriangleMesh, positions: NDArray[np.float32]) -> NDArray[np.float32]:
    """Where the vertices of a mesh are in each frame, from those of the true one, shape [f, v, 2]."""
    from scipy.spatial import cKDTree

    box = PixelBox(0, 0, true.width, true.height)
    ids = triangle_ids(true.vertices, true.triangles, box)
    column = np.clip(mesh.vertices[:, 0].astype(int), 0, true.width - 1)
    row = np.clip(mesh.vertices[:, 1].astype(int), 0, true.height - 1)
    triangle = ids[row, column]
    nearest = cKDTree(true.vertices).query(mesh.vertices)[1]
    corners = np.repeat(nearest[:, None], 3, axis=1)
    weights = np.full((len(corners), 3), 1 / 3)
    inside = triangle >= 0
    corners[inside] = true.triangles[triangle[inside]]
    weights[inside] = barycentric(mesh.vertices[inside], true.vertices[corners[inside]])
    moved = positions - true.vertices.astype(np.float32)
    return (mesh.vertices + np.einsum("vk,fvkd->fvd", weights, moved[:, corners])).astype(np.float32)
