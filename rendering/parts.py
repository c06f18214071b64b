"""What an illustration gives to the simulation and to the renderer: its moving parts, from masks or from layers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ..physics.beside import side_by_side
from ..physics.document import LayerMasks, order_of_layers
from ..physics.errors import InvalidInputError
from ..physics.interruption import checkpoint
from ..physics.linear_algebra import on_one_thread
from ..physics.material import Material, preset
from ..physics.mesh import TriangleMesh, coverage_of, fitted, mesh_from_mask
from ..physics.motion import Motion
from ..physics.progress import Progress
from ..physics.scene import Body, Held, Scene, doubts_about_mask
from .composite import (
    LayeredRenderer,
    PixelArtRenderer,
    behind_still,
    hidden_by,
    mask_of_layer,
    renderer_of,
    resting_on,
)
from .doubtful_inputs import doubts_about_plate, repeated_masks
from .layer_roots import attachment_of_layer, resting_on_held
from .matting import OpenEdge, open_edges, part_mesh
from .single_layers import LayerPictures

if TYPE_CHECKING:
    from .artwork import Artwork, LayerPlan

__all__ = [
    "OF_STRANDS",
    "Parts",
    "about",
    "arranged",
    "coverage",
    "coverages",
    "parts_of_artwork",
    "parts_of_picture",
    "picture_of",
    "with_shown",
]

Image = NDArray[Any]
Mask = NDArray[Any]

OF_STRANDS = ("hair", "ribbon")
"""Materials of what is drawn in strands."""


@dataclass(frozen=True, eq=False)
class Parts:
    """The moving parts of an illustration, from back to front.

    Attributes:
        image: the illustration, RGB or straight RGBA, uint8 or float32, shape [h, w, 3] or [h, w, 4].
        masks: where each part is, hidden places included where they are known, 0 to 1, shape [h, w] each.
        meshes: of the parts.
        names: of the parts; empty for those that have none.
        presets: name of the material that suits each; None where nothing says so.
        covers: where something that stands still is in front of each, bool, shape [h, w]; None for nowhere.
        rests: where something that stands still is behind each, the backdrop apart, as ``covers``.
        attachments: where each is held in an automatic scene.
        renderer: makes what draws a motion of the parts.
        own: each part alone, straight RGBA, shape [h, w, 4] each; empty where only masks are known.
        still: names of layers that stand still by somebody's word.
        layer_mask: gives the mask of the still layer of a name, or refuses it; None where there are no layers.
        notes: a sentence for each layer that stands still against its name, and for what is doubtful about masks and
            plate.
        order: names of layers that somebody put in another order than the file's, from back to front.
        needs_motion: whether the renderer must know the motion when it is made.
        ending: where the mask of each ends within one colour; empty where that is not known.
    """

    image: Image
    masks: tuple[Mask, ...]
    meshes: tuple[TriangleMesh, ...]
    names: tuple[str, ...]
    presets: tuple[str | None, ...]
    covers: tuple[NDArray[np.bool_] | None, ...]
    rests: tuple[NDArray[np.bool_] | None, ...]
    attachments: tuple[Held, ...]
    renderer: Callable[[Motion], LayeredRenderer | PixelArtRenderer]
    own: Sequence[Image] = ()
    still: tuple[str, ...] = ()
    layer_mask: LayerMasks | None = None
    notes: tuple[str, ...] = ()
    order: tuple[str, ...] = ()
    needs_motion: bool = True
    ending: tuple[Sequence[OpenEdge], ...] = ()

    def drawn_at_rest(self, scene: Scene) -> LayeredRenderer | PixelArtRenderer:
        """What draws the bodies of a scene as they are in the drawing; made without their motion."""
        rest = np.concatenate([body.mesh.vertices for body in scene.bodies]).astype(np.float32)
        return self.renderer(Motion(scene.bodies, rest[None], scene.frame_rate))

    def covered(self, scene: Scene) -> Scene:
        """The scene with what is in front of its bodies and behind them, in the order of the parts."""
        if all(each is None for each in (*self.covers, *self.rests)):
            return scene
        bodies = zip(scene.bodies, self.covers, self.rests, strict=True)
        known = tuple(replace(body, cover=cover, rests_on=rest) for body, cover, rest in bodies)
        return replace(scene, bodies=known)

    def bodies(self, materials: Sequence[Material], strands: Sequence[bool] | None = None) -> list[Body]:
        """The parts as bodies of these materials, each in front of the one before.

        Args:
            materials: of the parts.
            strands: which of them :meth:`in_strands` has slit; None for none.
        """
        strands = [False] * len(self.meshes) if strands is None else strands
        parts = zip(self.meshes, materials, self.names, strands, self.covers, self.rests, strict=True)
        return [Body(*(mesh, made, layer, *rest)) for layer, (mesh, made, *rest) in enumerate(parts)]

    def in_strands(self, chosen: Sequence[bool], attachments: Sequence[Held]) -> Parts:
        """The parts with those chosen slit between the strands that are drawn on them.

        Args:
            chosen: whether each is; what is held nowhere is not.
            attachments: where each is held.
        """
        chosen = [each and attach != "none" for each, attach in zip(chosen, attachments, strict=True)]
        if not any(chosen):
            return self
        from .strands import split_into_strands

        meshes = list(self.meshes)
        for number, body in enumerate(self.bodies([preset("hair")] * len(meshes))):
            if chosen[number]:
                shown, alone = (self.own[number], True) if self.own else (self.image, False)
                meshes[number] = split_into_strands(shown, body, attach=attachments[number], alone=alone)
        return replace(self, meshes=tuple(meshes))


@on_one_thread
def parts_of_picture(
    image: Image,
    masks: Sequence[Mask],
    names: Sequence[str],
    *,
    spacing: float | None,
    plate: Image | None,
    in_front: Mask | None,
    pixel_art: bool,
    progress: Progress | None = None,
) -> Parts:
    """Parts that masks show in a flat picture.

    Args:
        image: RGB or straight RGBA.
        masks: of the parts, 0 to 1, shape [h, w] each, from back to front.
        names: what each mask is called in errors.
        spacing: distance of the meshes' vertices [px]; None chooses it.
        plate: what is behind all parts; None makes a clean plate.
        in_front: mask of what stands still in front of all parts, 0 to 1, shape [h, w]; None for nothing. Parts go on
            behind it.
        pixel_art: see :class:`PixelArtRenderer`.
        progress: called before the first part and after each with (parts done, parts); may raise to stop.

    Raises:
        InvalidInputError: a mask gives no mesh.
    """
    cover = None if in_front is None else in_front > 0.5
    if cover is not None:
        masks = [behind_still(mask, cover) for mask in masks]

    def renderer(motion: Motion) -> LayeredRenderer | PixelArtRenderer:
        return renderer_of(image, masks, motion, plate=plate, pixel_art=pixel_art, in_front=in_front)

    seen = None if pixel_art else image  # pixel art moves the very pixels of its mask
    count, meshes, ending = len(masks), list[TriangleMesh](), list[Sequence[OpenEdge]]()
    report = progress or (lambda _done, _total: None)
    report(0, count)

    def made(mask: Mask, name: str, elsewhere: NDArray[np.bool_] | None) -> tuple[TriangleMesh, Sequence[OpenEdge]]:
        mesh = _meshed(mask, spacing, name, seen)
        return mesh, () if seen is None else open_edges(seen, mask, elsewhere=elsewhere)

    shown = [float(mask.sum()) for mask in masks]
    for mesh, edges in side_by_side(made, masks, names, _elsewhere(masks, cover), work=shown):
        meshes.append(mesh)
        ending.append(edges)
        report(len(meshes), count)
    nothing, guessed = (None,) * count, tuple[Held, ...](["auto"] * count)
    found = Parts(
        image, tuple(masks), tuple(meshes), ("",) * count, nothing, (cover,) * count, nothing, guessed, renderer
    )
    doubts = [f"bodies[{number}]: {each}" for number, mask in enumerate(masks) for each in doubts_about_mask(mask)]
    notes = (*doubts, *repeated_masks(masks), *doubts_about_plate(image, plate, masks))
    return replace(found, needs_motion=pixel_art, ending=tuple(ending), notes=notes)


def _elsewhere(masks: Sequence[Mask], cover: NDArray[np.bool_] | None) -> list[NDArray[np.bool_] | None]:
    """For each mask what covers it or is another's, shape [h, w]; None for nothing."""
    shown = [mask > 0.5 for mask in masks]
    found = []
    for number in range(len(masks)):
        planes = [*shown[:number], *shown[number + 1 :], *([] if cover is None else [cover])]
        found.append(np.logical_or.reduce(planes) if planes else None)
    return found


def parts_of_artwork(
    artwork: Artwork,
    *,
    move: Sequence[str] = (),
    still: Sequence[str] = (),
    spacing: float | None = None,
    document: Mapping[str, Any] | None = None,
    elements_across: int | None = None,
    plans: Sequence[LayerPlan] | None = None,
) -> Parts:
    """Parts that are layers of their own.

    Args:
        artwork: the layers.
        move: names of layers that move, whatever the table of names says.
        still: names of layers that stand still.
        spacing: distance of the meshes' vertices [px]; None chooses it.
        document: a checked scene document, which says what moves where the user does not, and which layers lie in
            another order.
        elements_across: triangles across thin strands; None for the usual number.
        plans: what becomes of every layer, in that order, instead of what follows from names and document.

    Raises:
        InvalidInputError: there is no such layer, none moves, or one gives no mesh.
    """
    from .artwork import in_order
    from .layers_of_scenes import SCENE_SAYS, attachments_in, masks_of_still_layers, nothing_moves, planned_layers

    order = order_of_layers(document or {})
    artwork = in_order(artwork, order)
    planned = planned_layers(artwork, move, still, document=document) if plans is None else plans
    plans, meshed, notes = _meshed_layers(artwork, planned, spacing, elements_across)
    artwork = with_shown(artwork, planned)
    if not plans and notes:
        raise InvalidInputError(f"no layer can move: {'; '.join(notes)[:600]}")
    if not plans:
        seen = [name for name, layer in zip(artwork.names, artwork.layers, strict=True) if layer.visible]
        raise InvalidInputError(nothing_moves(seen))
    image = picture_of(artwork)
    indices = [plan.index for plan in plans]
    said = attachments_in(document or {})
    attachments = tuple(said.get(plan.name) or attachment_of_layer(plan) for plan in plans)
    masks, covers, rests = [], [], []
    for index, attach in zip(indices, attachments, strict=True):
        masks.append(mask_of_layer(artwork, index))
        covers.append(hidden_by(artwork, index, moving=indices))
        rests.append(resting_on(artwork, index, moving=indices) if attach == "end" else None)
    return Parts(
        image,
        tuple(masks),
        tuple(meshed),
        tuple(plan.name for plan in plans),
        tuple(plan.preset for plan in plans),
        tuple(covers),
        resting_on_held(rests, masks, meshed, covers, attachments),
        attachments,
        lambda motion: LayeredRenderer.of_artwork(artwork, indices, motion),
        LayerPictures(artwork, indices),
        tuple(plan.name for plan in planned if not plan.moves and (plan.asked or plan.why == SCENE_SAYS)),
        masks_of_still_layers(artwork, indices),
        tuple(notes),
        tuple(order),
    )


def _meshed_layers(
    artwork: Artwork, plans: Sequence[LayerPlan], spacing: float | None, across: int | None
) -> tuple[list[LayerPlan], list[TriangleMesh], list[str]]:
    """The layers that move, their meshes, and a sentence for each that would by its name, but gives no mesh."""
    moving, meshes, notes = [], [], []
    for plan in plans:
        if not plan.moves:
            continue
        try:
            mask = mask_of_layer(artwork, plan.index)
            meshes.append(_meshed(mask, spacing, f"layer {plan.name}", None, across))
            moving.append(plan)
        except InvalidInputError as error:
            if plan.asked:
                raise
            notes.append(f"{error}: it stands still")
    return moving, meshes, notes


def arranged(artwork: Artwork, move: Sequence[str] = (), still: Sequence[str] = ()) -> Artwork:
    """The artwork with the layers visible that are drawn: not the closed eye over the open one, but what is to move.

    Args:
        artwork: the layers.
        move: names of layers that move.
        still: names of layers that stand still.

    Raises:
        InvalidInputError: there is no such layer.
    """
    from .artwork import moving_layers

    return with_shown(artwork, moving_layers(artwork, move, still))


def with_shown(artwork: Artwork, plans: Sequence[LayerPlan]) -> Artwork:
    """The artwork with the layers visible that plans show; the same one where nothing changes."""
    layers = list(zip(artwork.layers, plans, strict=True))
    if all(layer.visible == plan.shown for layer, plan in layers):
        return artwork
    return replace(artwork, layers=tuple(replace(layer, visible=plan.shown) for layer, plan in layers))


def picture_of(artwork: Artwork) -> Image:
    """An artwork as one picture, made once: RGB, or straight RGBA where it has transparency, uint8 or float32."""
    from .artwork import flattened
    from .pictures import as_picture

    if artwork not in _PICTURES:
        flat = flattened(artwork)
        opaque = bool((flat[..., 3] == np.iinfo(flat.dtype).max).all())
        _PICTURES[artwork] = as_picture(np.ascontiguousarray(flat[..., :3]) if opaque else flat, alpha=True)
    return _PICTURES[artwork]


_PICTURES: WeakKeyDictionary[Artwork, Image] = WeakKeyDictionary()


def coverages(name: str, masks: Sequence[Mask], image: Image) -> list[Mask]:
    """Masks as numbers from 0 to 1 of the picture's size."""
    return [coverage(f"{name}[{number}]", mask, image) for number, mask in enumerate(masks)]


def coverage(name: str, mask: Mask, image: Image) -> Mask:
    """A mask as numbers from 0 to 1 of the picture's size."""
    height, width = image.shape[:2]
    return fitted(coverage_of(mask, name=name), width, height, name=name)


def _meshed(
    part: Mask, spacing: float | None, name: str, image: Image | None, across: int | None = None
) -> TriangleMesh:
    checkpoint()
    with about(name):
        if image is None:
            fineness: dict[str, Any] = {} if across is None else {"elements_across": across}
            return mesh_from_mask(part, spacing=spacing, **fineness)
        return part_mesh(image, part, spacing=spacing)


@contextmanager
def about(name: str) -> Iterator[None]:
    """Let an error tell what it is about."""
    try:
        yield
    except InvalidInputError as error:
        if not name:
            raise
        raise type(error)(f"{name}: {error}") from error
