"""The whole way from an illustration to its animation, without a host.

picture = load_image("girl.png")
mask = load_mask("hair.png", width=picture.shape[1], height=picture.shape[0])
animate(picture, [mask], preset="hair").save("girl.mp4")
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from ..physics.assembly import work_of_minutes
from ..physics.document import LayerMasks, arranged_for, check_document, given_scene, materials_of
from ..physics.errors import InvalidInputError, require
from ..physics.limits import DEFAULT_MINUTES
from ..physics.process_end import working
from ..physics.scene import Attachment, Collider, Contact, Scene, automatic_scene, held_where_said
from ..physics.simulation import simulate
from .animation import Animation, timed
from .drawing_checks import check_drawing
from .neural import NetworkOptions
from .neural.checking import check_networks, naming_files
from .options import DEFAULT_FRAME_RATE, AutomaticWind, LayerChoice, Timing, Touching, Watch
from .parts import OF_STRANDS, Parts, about, coverage, coverages, parts_of_artwork, parts_of_picture
from .physics_options import PhysicsOptions
from .pictures import as_picture, over
from .stages import stage_of

if TYPE_CHECKING:
    from .artwork import Artwork

__all__ = ["animate"]

Image = NDArray[Any]
Mask = NDArray[Any]

_USUAL_WIND, _USUAL_TIMING, _AS_THE_SCENE_SAYS, _NOBODY = AutomaticWind(), Timing(), Touching(), Watch()
_BY_THEIR_NAMES, _NO_NETWORKS, _USUAL_PHYSICS = LayerChoice(), NetworkOptions(), PhysicsOptions()


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
    networks: NetworkOptions = _NO_NETWORKS,
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
        networks: which networks cut parts out, draw lines, frames and in-betweens. Their files are opened before any
            work; the animation reads those of its frames when they are asked for.

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
        check_document(scene)
    check_drawing(pixel_art=pixel_art, by_model=networks.draws_all)
    if networks.uses_networks:
        with timed(seconds, "check"):
            check_networks(networks)
    if isinstance(image, Artwork):
        _check_layers_alone(masks=masks, points=points, plate=plate, in_front=in_front, pixel_art=pixel_art or None)
        with timed(seconds, "mesh"):
            said = None if isinstance(scene, Scene) else scene
            parts = parts_of_artwork(image, move=layers.move, still=layers.still, spacing=spacing, document=said)
    else:
        flat = _Flat.of(image, masks, points, plate, in_front, touching)
        with timed(seconds, "segment"):
            cut = flat.cut(networks, watch)
        with timed(seconds, "mesh"):
            parts = flat.parts(cut, spacing=spacing, pixel_art=pixel_art)
    if watch.on_note is not None:
        for note in parts.notes:
            watch.on_note(note)
    with timed(seconds, "scene"):
        how = _Movement(preset, sway, attach, wind, timing, strands, pixel_art)
        parts, whole = how.automatic(parts) if scene is None else how.given(parts, scene)
        whole = replace(whole, still=parts.still) if parts.still else whole
        whole = physics.applied(whole, sway=sway)
        whole = held_where_said(parts.covered(whole if timing.loop is None else replace(whole, loop=timing.loop)))
        timing = timing.settled(whole)
        _check_length(timing, whole, networks)
        whole = _touching(whole, touching.contact, _colliders(touching.colliders, parts.image, parts.layer_mask))
    if watch.on_scene is not None:
        watch.on_scene(whole)
    with timed(seconds, "simulate"):
        hears = stage_of("simulate", watch.progress)
        motion = simulate(whole, frames=timing.frames, progress=hears, max_minutes=max_minutes)
    with timed(seconds, "prepare"):
        renderer = parts.renderer(motion)
    return Animation(parts.image, parts.masks, whole, motion, renderer, timing.skip, seconds, parts.own, networks)


@dataclass(frozen=True, eq=False)
class _Flat:
    """A flat picture and what was said of it, in forms that suit each other."""

    image: Image
    masks: Sequence[Mask]
    points: Sequence[Any]
    plate: Image | None
    front: Mask | None

    @classmethod
    def of(
        cls,
        image: Image,
        masks: Sequence[Mask] | None,
        points: Sequence[Any] | None,
        plate: Image | None,
        in_front: Mask | None,
        touching: Touching,
    ) -> _Flat:
        picture = as_picture(image, alpha=True)
        plate = _checked_plate(plate, picture)
        covered = coverages("masks", () if masks is None else masks, picture)
        front = None if in_front is None else coverage("in_front", in_front, picture)
        _colliders(touching.colliders, picture)
        return cls(picture, covered, points or (), plate, front)

    def cut(self, networks: NetworkOptions, watch: Watch) -> tuple[Mask, ...]:
        """The masks of all parts; somebody may look at those that were cut from points."""
        cut = tuple(_segmented(over(self.image), self.points, networks))
        _check_parts((*self.masks, *cut))
        if watch.on_cut is not None:
            watch.on_cut(cut)
        return (*self.masks, *cut)

    def parts(self, cut: Sequence[Mask], *, spacing: float | None, pixel_art: bool) -> Parts:
        names = _part_names(len(self.masks), len(cut))
        return parts_of_picture(
            self.image, cut, names, spacing=spacing, plate=self.plate, in_front=self.front, pixel_art=pixel_art
        )


@dataclass(frozen=True, eq=False)
class _Movement:
    """What was said of how parts move, and whether it moves as pixel art, which has no slits."""

    preset: str | Sequence[str] | None
    sway: float | None
    attach: Attachment
    wind: AutomaticWind
    timing: Timing
    strands: bool | None
    pixel_art: bool

    def automatic(self, parts: Parts) -> tuple[Parts, Scene]:
        """The parts, slit where that suits them, and the scene where none is given."""
        suiting = [each or "hair" for each in parts.presets]
        materials = materials_of(self.preset or suiting, self.sway, len(parts.meshes))
        sides = parts.attachments if self.attach == "auto" else (self.attach,) * len(parts.meshes)
        split = _split(self.strands, [each.name in OF_STRANDS for each in materials], self.pixel_art)
        parts = parts.in_strands(split, sides)
        rate = self.timing.frame_rate
        return parts, automatic_scene(
            parts.bodies(materials, split),
            attach=sides,
            frame_rate=DEFAULT_FRAME_RATE if rate is None else rate,
            wind_strength=self.wind.strength,
            wind_angle=self.wind.angle,
            turbulence=self.wind.turbulence,
            sway_by_size=self.sway is None,
        )

    def given(self, parts: Parts, scene: Scene | Mapping[str, Any]) -> tuple[Parts, Scene]:
        """The parts, slit where the scene says so, and the scene with them."""
        absent: tuple[str, ...] = ()
        if not isinstance(scene, Scene):
            scene, absent = arranged_for(scene, parts.names)
        split = _split(self.strands, _split_by(scene, len(parts.meshes)), self.pixel_art)
        parts = parts.in_strands(split, parts.attachments)
        whole = given_scene(
            scene,
            list(parts.meshes),
            names=parts.names,
            layers=parts.layer_mask,
            preset=self.preset,
            sway=self.sway,
            frame_rate=self.timing.frame_rate,
        )
        return parts, replace(whole, absent=absent)


def _split(asked: bool | None, suiting: list[bool], pixel_art: bool) -> list[bool]:
    """Which parts are slit: as asked, or else those that it suits; none in pixel art, through whose blocks slits go."""
    if asked and pixel_art:
        raise InvalidInputError("strands must be left out, or off, with pixel_art. Got: both")
    if pixel_art:
        return [False] * len(suiting)
    return suiting if asked is None else [asked] * len(suiting)


def _split_by(scene: Scene | Mapping[str, Any], count: int) -> list[bool]:
    """Which parts a scene, or a checked document, wants slit between their strands."""
    if isinstance(scene, Scene):
        said = [body.strands for body in scene.bodies]
    else:
        said = [bool(body.get("strands")) for body in scene.get("bodies", [])]
    return [*said, *[False] * count][:count]


def _check_length(timing: Timing, scene: Scene, networks: NetworkOptions) -> None:
    """Refuse a clip of nothing but the illustration where a video model draws it."""
    alone = networks.draws_all and scene.loop is None and timing.frames == 1
    require("frames", timing.frames, not alone, "at least 2 where a video model draws them")


def _checked_plate(plate: Image | None, image: Image) -> Image | None:
    """The plate as an array, which suits the picture: the renderer, which needs it, comes after the simulation."""
    if plate is None:
        return None
    plate = as_picture(plate, name="plate", alpha=True)
    if plate.shape[:2] != image.shape[:2]:
        raise InvalidInputError(f"plate must have the picture's size, {image.shape[:2]}. Got: {plate.shape[:2]}")
    return plate


def _segmented(image: Image, points: Sequence[Any], networks: NetworkOptions) -> Iterator[Mask]:
    if not points:
        return
    from ..physics.document import parse_points
    from .neural.cutting import segmenter_of
    from .pictures import as_uint8
    from .segmentation import Prompt, segment

    height, width = image.shape[:2]
    with naming_files(networks):
        network = segmenter_of(networks)
    for each, name in zip(points, _part_names(0, len(points)), strict=True):
        with about(name):
            clicked = parse_points(each, width=width, height=height)
            places, labels = [(p.x, p.y) for p in clicked], [int(p.positive) for p in clicked]
            if network is None:
                yield segment(image, places, labels)
            else:
                yield network.segment(as_uint8(image), [Prompt(places, labels)])[0][0]


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
