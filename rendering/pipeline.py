"""The whole way from an illustration to its animation, without a host.

picture = load_image("girl.png")
mask = load_mask("hair.png", width=picture.shape[1], height=picture.shape[0])
animate(picture, [mask], preset="hair").save("girl.mp4")
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from ..physics.assembly import work_of_minutes
from ..physics.document import LayerMasks, arranged_for, given_scene, materials_of
from ..physics.errors import InvalidInputError, require
from ..physics.limits import DEFAULT_MINUTES
from ..physics.process_end import working
from ..physics.progress import Progress
from ..physics.scene import Attachment, Body, Collider, Contact, Scene, automatic_scene
from ..physics.simulation import loop_frames, simulate
from .animation import Animation, StageProgress, timed
from .options import DEFAULT_FRAME_RATE, DEFAULT_FRAMES, AutomaticWind, LayerChoice, Timing, Touching, Watch
from .parts import OF_STRANDS, about, coverage, coverages, parts_of_artwork, parts_of_picture
from .physics_options import PhysicsOptions
from .pictures import as_picture, over

if TYPE_CHECKING:
    from .artwork import Artwork

__all__ = ["animate"]

Image = NDArray[Any]
Mask = NDArray[Any]

_USUAL_WIND, _USUAL_TIMING, _AS_THE_SCENE_SAYS, _NOBODY = AutomaticWind(), Timing(), Touching(), Watch()
_BY_THEIR_NAMES = LayerChoice()
_USUAL_PHYSICS = PhysicsOptions()


@working()
def animate(
    image: Image | Artwork,
    masks: Sequence[Mask] | None = None,
    points: Sequence[Any] | None = None,
    *,
    scene: Scene | Mapping[str, Any] | None = None,
    preset: str | Sequence[str] | None = None,
    sway: float | None = None,
    spacing: float | None = None,
    attach: Attachment = "auto",
    wind: AutomaticWind = _USUAL_WIND,
    timing: Timing = _USUAL_TIMING,
    touching: Touching = _AS_THE_SCENE_SAYS,
    plate: Image | None = None,
    in_front: Mask | None = None,
    layers: LayerChoice = _BY_THEIR_NAMES,
    pixel_art: bool = False,
    strands: bool | None = None,
    max_minutes: float = DEFAULT_MINUTES,
    physics: PhysicsOptions = _USUAL_PHYSICS,
    watch: Watch = _NOBODY,
) -> Animation:
    """Set parts of an illustration in motion.

    Args:
        image: the illustration, RGB, or straight RGBA to move on transparency, shape [h, w, 3] or [h, w, 4]: uint8,
            uint16, other whole numbers 0..255, or floating-point numbers 0..1 of any precision, as
            :func:`as_picture` says. Or layered artwork, whose layers move as their names and ``layers`` say.
        masks: where each moving part is, bool, 0..1, 0..255 or 0..65535, each of shape [h, w] or, to be scaled, of the
            picture's proportions; later ones lie in front.
        points: for each further part its query points, in any form that
            :func:`~physanimator.physics.document.parse_points` reads.
        scene: what acts on the parts, as a ``Scene`` with one body for each part or as a decoded scene document;
            without one, the parts are pinned where they are attached and a gentle wind blows.
        preset: name of the material, one for all parts or one for each; replaces the scene's materials.
            Without a scene it is "hair" unless said otherwise.
        sway: how often a part sways to and fro in a second, instead of the preset's [Hz].
        spacing: distance of the mesh's vertices [px]; chosen from each mask when None.
        attach: side at which the parts are held when there is no scene.
        wind: what blows when there is no scene.
        timing: how many frames, how fast, and whether they loop.
        touching: what the parts keep out of.
        plate: the illustration without the moving parts, if it exists, RGB or RGBA in any form that ``image`` may have
            and of its size; painted in when None.
        in_front: where something stands still in front of all parts, such as an arm before hair, in any form that
            ``masks`` may have; the parts go on behind it.
        layers: which layers of an artwork move.
        pixel_art: move whole pixels, or the blocks that an enlarged picture shows for them, and mix no colours.
        strands: whether parts are slit along the lines that are drawn between their strands, so that these swing apart;
            when None, hair and ribbon are where there is no scene, and otherwise what the scene says is. Nothing is in
            pixel art, nor where parts touch.
        max_minutes: minutes that the simulation may take, by the estimate for one core of an ordinary machine; what
            would take longer is refused before it begins.
        physics: what parts are made of and how their motion is computed, where not as presets and the scene say.
        watch: who hears of the work while it is done.

    Raises:
        InvalidInputError: an input is unusable; the message names it.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.options import Timing
        >>> from physanimator.rendering.pipeline import animate
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mask = np.pad(np.ones((40, 40)), 10)
        >>> animation = animate(picture, [mask], preset="hair", timing=Timing(frames=3), spacing=10)
        >>> [frame.shape for frame in animation.frames()]
        [(60, 60, 3), (60, 60, 3), (60, 60, 3)]
    """
    from .artwork import Artwork

    seconds: dict[str, float] = {}
    work_of_minutes(max_minutes)
    if scene is not None and not isinstance(scene, Scene):
        from ..physics.document import check_document

        check_document(scene)
    if not isinstance(image, Artwork):
        image = as_picture(image, alpha=True)
        plate = _checked_plate(plate, image)
        masks = coverages("masks", () if masks is None else masks, image)
        front = None if in_front is None else coverage("in_front", in_front, image)
        _colliders(touching.colliders, image)
        with timed(seconds, "segment"):
            cut = (*masks, *_segmented(over(image), points or ()))
        _check_parts(cut)
        names = _part_names(len(masks), len(cut))
        if watch.on_cut is not None:
            watch.on_cut(cut[len(masks) :])
        with timed(seconds, "mesh"):
            parts = parts_of_picture(
                image, cut, names, spacing=spacing, plate=plate, in_front=front, pixel_art=pixel_art
            )
    else:
        _check_layers_alone(masks=masks, points=points, plate=plate, in_front=in_front, pixel_art=pixel_art or None)
        with timed(seconds, "mesh"):
            said = None if isinstance(scene, Scene) else scene
            parts = parts_of_artwork(image, move=layers.move, still=layers.still, spacing=spacing, document=said)
    if watch.on_note is not None:
        for note in parts.notes:
            watch.on_note(note)
    bars_strands = "pixel_art" if pixel_art else "contact" if touching.contact or _has_contact(scene) else ""
    with timed(seconds, "scene"):
        if scene is None:
            suiting = [each or "hair" for each in parts.presets]
            materials = materials_of(preset or suiting, sway, len(parts.meshes))
            sides = parts.attachments if attach == "auto" else (attach,) * len(parts.meshes)
            split = _split(strands, [each.name in OF_STRANDS for each in materials], bars_strands)
            parts = parts.in_strands(split, sides)
            whole = _automatic(parts.bodies(materials, split), wind, timing, attach=sides, sway_by_size=sway is None)
        else:
            absent: tuple[str, ...] = ()
            if not isinstance(scene, Scene):
                scene, absent = arranged_for(scene, parts.names)
            split = _split(strands, _split_by(scene, len(parts.meshes)), bars_strands)
            parts = parts.in_strands(split, parts.attachments)
            given = list(parts.meshes)
            whole = given_scene(
                scene,
                given,
                names=parts.names,
                layers=parts.layer_mask,
                preset=preset,
                sway=sway,
                frame_rate=timing.frame_rate,
            )
            whole = replace(whole, absent=absent)
        whole = replace(whole, still=parts.still) if parts.still else whole
        whole = physics.applied(whole, sway=sway)
        whole = parts.covered(whole if timing.loop is None else replace(whole, loop=timing.loop))
        timing = _settled(timing, whole)
        whole = _touching(whole, touching.contact, _colliders(touching.colliders, parts.image, parts.layer_mask))
    if watch.on_scene is not None:
        watch.on_scene(whole)
    with timed(seconds, "simulate"):
        hears = _stage("simulate", watch.progress)
        motion = simulate(whole, frames=timing.frames, progress=hears, max_minutes=max_minutes)
    with timed(seconds, "prepare"):
        renderer = parts.renderer(motion)
    return Animation(parts.image, parts.masks, whole, motion, renderer, timing.skip, seconds, parts.own)


def _split(asked: bool | None, suiting: list[bool], barring: str) -> list[bool]:
    """Which parts are slit: as asked, or else those that it suits; none with what bars it.

    The sides of a slit lie on each other, which contact would drive apart, and go through blocks of pixel art.
    """
    if asked and barring:
        raise InvalidInputError(f"strands must be left out, or off, with {barring}. Got: both")
    if barring:
        return [False] * len(suiting)
    return suiting if asked is None else [asked] * len(suiting)


def _has_contact(scene: Scene | Mapping[str, Any] | None) -> bool:
    if scene is None or isinstance(scene, Scene):
        return scene is not None and scene.contact is not None
    return scene.get("contact") is not None


def _split_by(scene: Scene | Mapping[str, Any], count: int) -> list[bool]:
    """Which parts a scene, or a checked document, wants slit between their strands."""
    if isinstance(scene, Scene):
        said = [body.strands for body in scene.bodies]
    else:
        said = [bool(body.get("strands")) for body in scene.get("bodies", [])]
    return [*said, *[False] * count][:count]


def _automatic(
    bodies: Sequence[Body],
    wind: AutomaticWind,
    timing: Timing,
    *,
    attach: Attachment | Sequence[Attachment],
    sway_by_size: bool,
) -> Scene:
    """The scene where none is given."""
    return automatic_scene(
        bodies,
        attach=attach,
        frame_rate=DEFAULT_FRAME_RATE if timing.frame_rate is None else timing.frame_rate,
        wind_strength=wind.strength,
        wind_angle=wind.angle,
        turbulence=wind.turbulence,
        sway_by_size=sway_by_size,
    )


def _settled(timing: Timing, scene: Scene) -> Timing:
    """The timing with its number of frames, which may follow from the scene's loop."""
    if timing.frames is not None:
        return timing
    frames = DEFAULT_FRAMES if scene.loop is None else loop_frames(scene) + timing.skip
    return replace(timing, frames=frames)


def _checked_plate(plate: Image | None, image: Image) -> Image | None:
    """The plate as an array, which suits the picture: the renderer, which needs it, comes after the simulation."""
    if plate is None:
        return None
    plate = as_picture(plate, name="plate", alpha=True)
    if plate.shape[:2] != image.shape[:2]:
        raise InvalidInputError(f"plate must have the picture's size, {image.shape[:2]}. Got: {plate.shape[:2]}")
    return plate


def _segmented(image: Image, points: Sequence[Any]) -> Iterator[Mask]:
    if not points:
        return
    from ..physics.document import parse_points
    from .segmentation import segment

    height, width = image.shape[:2]
    for each, name in zip(points, _part_names(0, len(points)), strict=True):
        with about(name):
            clicked = parse_points(each, width=width, height=height)
            yield segment(image, [(p.x, p.y) for p in clicked], [int(p.positive) for p in clicked])


def _part_names(masks: int, parts: int) -> list[str]:
    """What the parts come from, where there are several."""
    if parts == 1:
        return [""]
    return [f"masks[{number}]" if number < masks else f"points[{number - masks}]" for number in range(parts)]


def _check_layers_alone(**given: Any) -> None:
    """Refuse what says again, or otherwise, what the layers of an artwork say."""
    for name, value in given.items():
        if value is not None and not (isinstance(value, Sequence) and not value):
            raise InvalidInputError(f"{name} must be left out where the picture is in layers. Got: a value")


def _check_parts(parts: Sequence[Mask]) -> None:
    if not parts:
        raise InvalidInputError("an animation needs at least one mask, or points on a part. Got: neither")


def _colliders(given: Sequence[Mask | str], image: Image, layers: LayerMasks | None = None) -> list[Collider]:
    """What parts keep out of: masks, and still layers by their names."""
    found = []
    for number, each in enumerate(given):
        if not isinstance(each, str):
            mask = coverage(f"colliders[{number}]", each, image)
            found.append(Collider.from_mask(mask > 0.5))
            continue
        if layers is None:
            raise InvalidInputError(f"colliders[{number}] must be a mask where the picture is flat. Got: {each[:60]!r}")
        try:
            found.append(Collider.from_mask(layers(each), layer=each))
        except InvalidInputError as error:
            raise InvalidInputError(f"colliders[{number}] {str(error).removeprefix('layer ')}") from error
    return found


def _touching(scene: Scene, contact: Contact | None, colliders: Sequence[Collider]) -> Scene:
    if contact is not None:
        scene = replace(scene, contact=contact)
    if not colliders:
        return scene
    require("contact", scene.contact, scene.contact is not None, "given where there are colliders")
    return replace(scene, colliders=(*scene.colliders, *colliders))


def _stage(name: str, progress: StageProgress | None) -> Progress | None:
    return None if progress is None else lambda done, total: progress(name, done, total)
