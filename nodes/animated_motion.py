"""The motion of what the node Animate Illustration is given."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from ..physics.errors import InvalidInputError
from ..physics.interruption import interruptible
from ..rendering.picked_parts import AUTO
from .animated_inputs import GivenPicture, chosen_parts, is_empty
from .drawing import drawing_of
from .host import all_told, host_check, named_part, parts_named, server, tell_user
from .host.wires import MaskedMotion, MaskedScene

if TYPE_CHECKING:
    import torch

    from ..physics.progress import Progress
    from ..physics.scene import Scene
    from ..rendering.artwork import Artwork
    from ..rendering.composite import LayeredRenderer, PixelArtRenderer
    from ..rendering.picked_layers import PickedLayers
    from .host.progress import Report

__all__ = ["Moved", "motion_of_parts", "motion_of_scene"]


class Moved(NamedTuple):
    """A motion, what draws it, and what the user was told."""

    motion: MaskedMotion
    renderer: LayeredRenderer | PixelArtRenderer
    told: dict[str, list[str]]


def motion_of_scene(
    node: Any,
    scene: MaskedScene,
    given: GivenPicture,
    points: str,
    pixel_art: bool,
    timing: Mapping[str, Any],
    report: Report,
) -> Moved:
    """The motion of a scene that brings its bodies, and what draws it.

    Args:
        node: the node's class, as ``execute`` has it.
        scene: what moves, and what acts on it.
        given: the illustration.
        points: what is picked, which is not used.
        pixel_art: move whole pixels.
        timing: the inputs loop and frames.
        report: the node's progress.

    Raises:
        InvalidInputError: the picture does not fit the scene.
    """
    from ..physics.simulation import simulate

    picked = not is_empty(points)
    told = tell_user(node, ["The scene that is connected says what moves: what is picked is not used."] * picked)
    acting = scene.scene if not timing["loop"] else replace(scene.scene, loop=timing["loop"])
    if scene.layers is None and given.picture is None:
        raise InvalidInputError(
            "image must be connected, or a flat picture chosen, as the scene has masks. Got: layers"
        )
    with _aside(contact=acting.contact is not None):
        motion = simulate(acting, frames=None if acting.loop else timing["frames"], progress=_half(report))
        moved = MaskedMotion(motion, scene.masks, scene.layers, scene.in_front)
        seen = given.picture if scene.layers is None else scene.layers.picture
        return Moved(moved, drawing_of(moved, seen, pixel_art=pixel_art)(motion), told)


def motion_of_parts(
    node: Any,
    given: GivenPicture,
    points: str,
    masks: torch.Tensor | None,
    document: dict[str, Any] | None,
    pixel_art: bool,
    said: Mapping[str, Any],
    report: Report,
) -> Moved:
    """The motion of what is picked or of layers, and what draws it.

    Args:
        node: the node's class, as ``execute`` has it.
        given: the illustration.
        points: what is picked.
        masks: the host's MASK, one for each further part.
        document: a checked scene document; None for the automatic scene.
        pixel_art: move whole pixels.
        said: the inputs preset, wind, wind_angle, loop, frames and fps.
        report: the node's progress.

    Raises:
        InvalidInputError: nothing moves, or a value is none that may be.
    """
    from ..physics.scene import advice
    from ..rendering.moving_layers import MovingLayers
    from ..rendering.options import AutomaticWind, LayerChoice, Timing, Watch
    from ..rendering.pipeline import animate

    parts, presets, notes = (), None if said["preset"] == AUTO else said["preset"], list[dict[str, list[str]]]()
    told: dict[str, list[str]] = {}
    layered: PickedLayers | None = None
    names: tuple[str, ...] = ()
    if given.picture is not None:
        with interruptible(host_check()):
            chosen = chosen_parts(node, given.picture, points, masks, said["preset"])
        parts, told, names = chosen.masks, chosen.told, chosen.names
        # What a document says of bodies stands above what was picked, but not above what the user has chosen for all.
        told_by_scene = bool((document or {}).get("bodies")) and said["preset"] == AUTO
        presets = None if told_by_scene else list(chosen.presets)
    elif masks is not None:
        raise InvalidInputError("masks must be left out where the picture is in layers. Got: masks")
    else:
        layered = _picked_layers(given.artwork, points, said["preset"], document)
        told = tell_user(node, layered.told)
        if not document:  # each layer says of what it is made; a document's bodies do so themselves
            presets = None
    loop, own_rate = said["loop"] or None, "frame_rate" in (document or {})
    loops = loop is not None or "loop" in (document or {})
    timing = Timing(None if loops else said["frames"], loop=loop, frame_rate=None if own_rate else said["fps"])
    simulated = _half(report)

    def of_stage(stage: str, done: int, total: int) -> None:
        if stage == "simulate":  # the others would put the bar back
            simulated(done, total)

    def tell(note: str) -> None:
        notes.append(tell_user(node, [named_part(note, names)]))

    def on_scene(acting: Scene) -> None:
        for sentence in advice(acting):
            tell(sentence)

    watch = Watch(of_stage, on_note=tell, on_scene=on_scene)
    with _aside(contact="contact" in (document or {})), parts_named(names):
        made = animate(
            given.subject,
            parts or None,
            scene=document,
            preset=presets,
            layers=LayerChoice() if layered is None else LayerChoice(plans=layered.plans),
            wind=AutomaticWind(said["wind"], said["wind_angle"]),
            timing=timing,
            pixel_art=pixel_art,
            watch=watch,
        )
    source = getattr(made.renderer, "source", None)
    layers = None if source is None else MovingLayers(source, tuple(made.renderer.moving_layers))  # type: ignore[union-attr]
    told = all_told(told, *notes)
    return Moved(MaskedMotion(made.motion, tuple(made.masks), layers), made.renderer, told)


def _picked_layers(artwork: Artwork, points: str, usual: str, document: dict[str, Any] | None) -> PickedLayers:
    """What becomes of the layers.

    Raises:
        InvalidInputError: none moves.
    """
    from ..rendering.picked_layers import NOTHING_MOVES, picked_layers

    found = picked_layers(artwork, None if is_empty(points) else points, usual=usual, document=document)
    if not found.moving:
        raise InvalidInputError(" ".join([NOTHING_MOVES, *found.told]))
    return found


@contextmanager
def _aside(*, contact: bool) -> Iterator[None]:
    """Work that can be cancelled, and that leaves a server free to answer meanwhile."""
    from ..physics.simulation import compile_aside, simulated_aside

    serves = server() is not None
    with interruptible(host_check()), simulated_aside(contact=contact and serves):
        if serves:
            compile_aside(contact=contact)
        yield


def _half(report: Report) -> Progress:
    """The first half of the node's bar; the frames are the other."""
    return lambda done, total: report(done, 2 * total)
