"""The whole way from an illustration to its animation, without a host.

In short::

    picture = load_image("girl.png")
    mask = load_mask("hair.png", width=picture.shape[1], height=picture.shape[0])
    animate(picture, [mask], preset="hair").save("girl.mp4")
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from ..physics.assembly import work_of_minutes
from ..physics.beside import Beside
from ..physics.checks import require_kind
from ..physics.document import LayerMasks, check_document
from ..physics.errors import InvalidInputError, require
from ..physics.limits import DEFAULT_MINUTES
from ..physics.linear_algebra import on_one_thread
from ..physics.process_end import working
from ..physics.scene import Attachment, Collider, Contact, Scene
from ..physics.simulation import begin_aside, simulate, simulated_beside
from ..physics.threads import allowed_threads
from .animation import Animation, timed
from .drawing_checks import check_drawing
from .edge_advice import edge_advice
from .files import removed_at_signals
from .flat_pictures import FlatPicture
from .movement import Movement
from .neural import NetworkOptions
from .neural.checking import check_networks
from .options import AutomaticWind, LayerChoice, Saving, Timing, Touching, Watch
from .parts import Parts, coverage, parts_of_artwork
from .physics_options import PhysicsOptions
from .stages import StageProgress, stage_of

if TYPE_CHECKING:
    from ..physics.motion import Motion
    from .artwork import Artwork
    from .composite import LayeredRenderer, PixelArtRenderer

__all__ = ["animate"]

Image = NDArray[Any]
Mask = NDArray[Any]

_USUAL_WIND, _USUAL_TIMING, _AS_THE_SCENE_SAYS, _NOBODY = AutomaticWind(), Timing(), Touching(), Watch()
_KINDS: dict[str, type] = {
    "wind": AutomaticWind,
    "timing": Timing,
    "touching": Touching,
    "layers": LayerChoice,
    "physics": PhysicsOptions,
    "watch": Watch,
    "networks": NetworkOptions,
    "save": Saving,
}
_SUCH = {"wind": "strength=2", "timing": "frames=48", "save": '"a.mp4"', "layers": 'move=("hair",)'}
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
    save: Saving | None = None,
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
        save: where to write the animation before it is returned; frames are drawn and written while later ones are
            still simulated, if they neither loop nor need a network, and this process may use several threads.

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
    groups = {"wind": wind, "timing": timing, "touching": touching, "layers": layers, "physics": physics}
    _check_kinds(**groups, watch=watch, networks=networks, save=save)
    if save is not None:
        save.check(by_model=networks.draws_opaque)
    work_of_minutes(max_minutes)
    if not (pixel_art or isinstance(image, Artwork)):
        begin_aside()  # it takes as long as to cut the parts out
    if scene is not None and not isinstance(scene, Scene):
        check_document(scene)
    check_drawing(pixel_art=pixel_art, by_model=networks.draws_opaque)
    if networks.renderer == "inpainting":
        _check_unknown_behind(image, plate)
    if networks.uses_networks:
        with timed(seconds, "check"):
            check_networks(networks)
    if isinstance(image, Artwork):
        _check_layers_alone(masks=masks, points=points, plate=plate, in_front=in_front, pixel_art=pixel_art or None)
        if watch.progress is not None:
            watch.progress("mesh", 0, 1)
        with timed(seconds, "mesh"):
            said = None if isinstance(scene, Scene) else scene
            chosen: dict[str, Any] = {"move": layers.move, "still": layers.still, "plans": layers.plans}
            parts = parts_of_artwork(image, spacing=spacing, document=said, **chosen)
            if watch.progress is not None:
                watch.progress("mesh", 1, 1)
    else:
        named = bool(layers.move or layers.still or layers.plans)
        require("layers", "names of layers", not named, "left out where the picture is flat")
        flat = FlatPicture.of(image, masks, points, plate, in_front)
        _colliders(touching.colliders, flat.image)
        with timed(seconds, "segment"):
            cut = flat.cut(networks, watch)
        with timed(seconds, "mesh"):
            parts = flat.parts(cut, spacing=spacing, pixel_art=pixel_art, progress=stage_of("mesh", watch.progress))
    if watch.on_note is not None:
        for note in parts.notes:
            watch.on_note(note)
    with timed(seconds, "scene"):
        how = Movement(preset, sway, attach, wind, timing, strands, pixel_art)
        parts, whole = how.staged(parts, scene, physics)
        timing = timing.settled(whole)
        _check_length(timing, whole, networks)
        whole = _touching(whole, touching.contact, _colliders(touching.colliders, parts.image, parts.layer_mask))
    if watch.on_note is not None:
        for note in edge_advice(parts.ending, whole):
            watch.on_note(note)
    if watch.on_scene is not None:
        watch.on_scene(whole)
    animated = partial(Animation, parts.image, parts.masks, whole, own=parts.own, networks=networks, first=timing.skip)
    comes_frame_by_frame = whole.loop is None and not (parts.needs_motion or networks.draws_opaque)
    if save is not None and comes_frame_by_frame and allowed_threads() > 1:
        saved = _simulated_and_saved(parts, whole, timing, max_minutes, watch, seconds, save, animated)
        return animated(motion=saved.motion, renderer=saved, seconds=seconds)
    motion, renderer = _simulated(parts, whole, timing, max_minutes, watch, seconds)
    animation = animated(motion=motion, renderer=renderer, seconds=seconds)
    if save is not None:
        animation.save(save.path, background=save.background, width=save.width, progress=watch.progress)
    return animation


def _check_kinds(**given: object) -> None:
    """Refuse groups of options that are none, such as a bare path to save to."""
    for name, value in given.items():
        kind = _KINDS[name]
        if value is not None or name != "save":
            require_kind(name, value, kind, f"given as {kind.__name__}({_SUCH.get(name, '...')})")


@on_one_thread
def _simulated(
    parts: Parts, scene: Scene, timing: Timing, max_minutes: float, watch: Watch, seconds: dict[str, float]
) -> tuple[Motion, LayeredRenderer | PixelArtRenderer]:
    """The motion, and what draws it; the illustration is taken apart meanwhile where that can be done without it."""
    hears = stage_of("simulate", watch.progress)
    if parts.needs_motion:
        with timed(seconds, "simulate"):
            motion = simulate(scene, frames=timing.frames, progress=hears, max_minutes=max_minutes)
        with timed(seconds, "prepare"):
            return motion, parts.renderer(motion)

    def advance(done: int, total: int) -> None:
        drawing.check()
        if hears is not None:
            hears(done, total)

    drawing = Beside(lambda: parts.drawn_at_rest(scene))

    def wait() -> None:
        if watch.progress is not None:
            watch.progress("prepare", 0, 1)

    with simulated_beside(), drawing:
        with timed(seconds, "simulate"):
            motion = simulate(scene, frames=timing.frames, progress=advance, max_minutes=max_minutes)
        with timed(seconds, "prepare"):
            waited, renderer = not drawing.ended, drawing.result(meanwhile=wait)
            if waited and watch.progress is not None:
                watch.progress("prepare", 1, 1)
            return motion, renderer.showing(motion)  # type: ignore[union-attr]


@on_one_thread
def _simulated_and_saved(
    parts: Parts,
    scene: Scene,
    timing: Timing,
    max_minutes: float,
    watch: Watch,
    seconds: dict[str, float],
    save: Saving,
    animated: Callable[..., Animation],
) -> LayeredRenderer:
    """What draws the motion; all frames are saved, most of them while others are still simulated."""
    from .saved_meanwhile import ComingFrames, SavedMeanwhile

    assert timing.frames is not None
    coming, hears = ComingFrames(scene, timing.frames), stage_of("simulate", watch.progress)

    def write(renderer: LayeredRenderer, progress: StageProgress) -> None:
        drawn = animated(motion=coming.motion, renderer=renderer.showing(coming.motion), wait_for=coming.wait_for)
        drawn.save(save.path, background=save.background, width=save.width, progress=progress)

    def advance(done: int, total: int) -> None:
        saving.check()
        if hears is not None:
            hears(done, total)

    saving = SavedMeanwhile(lambda: parts.drawn_at_rest(scene), write)  # type: ignore[arg-type, return-value]
    with removed_at_signals(), simulated_beside(), saving:
        with timed(seconds, "simulate"):
            motion = simulate(
                scene, frames=timing.frames, progress=advance, max_minutes=max_minutes, on_frame=coming.take
            )
        with timed(seconds, "render"):
            return saving.finish(watch.progress).showing(motion)


def _check_length(timing: Timing, scene: Scene, networks: NetworkOptions) -> None:
    """Refuse a clip of nothing but the illustration where a video model draws it."""
    alone = networks.draws_all and scene.loop is None and timing.frames == 1
    require("frames", timing.frames, not alone, "at least 2 where a video model draws them")


def _check_unknown_behind(image: Image | Artwork, plate: Image | None) -> None:
    """Refuse to paint what parts uncover where somebody has drawn it."""
    from .artwork import Artwork

    where = "where renderer is inpainting, which paints what is behind the parts"
    require("plate", "a picture", plate is None, f"left out {where}")
    require("image", "layers", not isinstance(image, Artwork), f"flat {where}")


def _check_layers_alone(**given: Any) -> None:
    """Refuse what says again, or otherwise, what the layers of an artwork say."""
    for name, value in given.items():
        if value is not None and not (isinstance(value, Sequence) and not value):
            raise InvalidInputError(f"{name} must be left out where the picture is in layers. Got: a value")


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
