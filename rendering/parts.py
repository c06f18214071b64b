"""What an illustration gives to the simulation and to the renderer: its moving parts, from masks or from layers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ..physics.errors import InvalidInputError
from ..physics.mesh import TriangleMesh, coverage_of, fitted, mesh_from_mask
from ..physics.motion import Motion
from ..physics.scene import Body, Scene
from .composite import LayeredRenderer, PixelArtRenderer, behind_still, hidden_by, mask_of_layer, renderer_of
from .layer_pictures import LayerPictures
from .matting import part_mesh

if TYPE_CHECKING:
    from .artwork import Artwork, LayerPlan

__all__ = ["Parts", "about", "arranged", "coverage", "coverages", "parts_of_artwork", "parts_of_picture", "picture_of"]

Image = NDArray[Any]
Mask = NDArray[Any]


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
        renderer: makes what draws a motion of the parts.
        own: each part alone, straight RGBA, shape [h, w, 4] each; empty where only masks are known.
        notes: a sentence for each layer that stands still against its name.
    """

    image: Image
    masks: tuple[Mask, ...]
    meshes: tuple[TriangleMesh, ...]
    names: tuple[str, ...]
    presets: tuple[str | None, ...]
    covers: tuple[NDArray[np.bool_] | None, ...]
    renderer: Callable[[Motion], LayeredRenderer | PixelArtRenderer]
    own: Sequence[Image] = ()
    notes: tuple[str, ...] = ()

    def covered(self, scene: Scene) -> Scene:
        """The scene with what is in front of its bodies, in the order of the parts."""
        if all(cover is None for cover in self.covers):
            return scene
        bodies = zip(scene.bodies, self.covers, strict=True)
        return replace(scene, bodies=tuple(replace(body, cover=cover) for body, cover in bodies))

    def bodies(self, materials: Sequence[Any]) -> list[Body]:
        """The parts as bodies of these materials, each in front of the one before."""
        parts = zip(self.meshes, materials, self.names, strict=True)
        return [Body(mesh, made, layer, name) for layer, (mesh, made, name) in enumerate(parts)]


def parts_of_picture(
    image: Image,
    masks: Sequence[Mask],
    names: Sequence[str],
    *,
    spacing: float | None,
    plate: Image | None,
    in_front: Mask | None,
    pixel_art: bool,
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

    Raises:
        InvalidInputError: a mask gives no mesh.
    """
    cover = None if in_front is None else in_front > 0.5
    if cover is not None:
        masks = [behind_still(mask, cover) for mask in masks]

    def renderer(motion: Motion) -> LayeredRenderer | PixelArtRenderer:
        return renderer_of(image, masks, motion, plate=plate, pixel_art=pixel_art, in_front=in_front)

    seen = None if pixel_art else image  # pixel art moves the very pixels of its mask
    meshes = tuple(_meshed(mask, spacing, name, seen) for mask, name in zip(masks, names, strict=True))
    count = len(masks)
    return Parts(image, tuple(masks), meshes, ("",) * count, (None,) * count, (cover,) * count, renderer)


def parts_of_artwork(
    artwork: Artwork, *, move: Sequence[str] = (), still: Sequence[str] = (), spacing: float | None = None
) -> Parts:
    """Parts that are layers of their own.

    Args:
        artwork: the layers.
        move: names of layers that move, whatever the table of names says.
        still: names of layers that stand still.
        spacing: distance of the meshes' vertices [px]; None chooses it.

    Raises:
        InvalidInputError: there is no such layer, none moves, or one gives no mesh.
    """
    from .artwork import moving_layers

    plans, meshed, notes = _meshed_layers(artwork, moving_layers(artwork, move, still), spacing)
    artwork = arranged(artwork, move, still)
    if not plans and notes:
        raise InvalidInputError(f"no layer can move: {'; '.join(notes)[:600]}")
    if not plans:
        seen = [name for name, layer in zip(artwork.names, artwork.layers, strict=True) if layer.visible]
        raise InvalidInputError(
            "no layer that is seen has a name that says it moves; name those that do with --move, or the node's input"
            f" move. Got: {', '.join(seen)[:300] or 'none that is seen'}"
        )
    image = picture_of(artwork)
    indices = [plan.index for plan in plans]
    masks, covers = [], []
    for index in indices:
        masks.append(mask_of_layer(artwork, index))
        covers.append(hidden_by(artwork, index, moving=indices))
    return Parts(
        image,
        tuple(masks),
        tuple(meshed),
        tuple(plan.name for plan in plans),
        tuple(plan.preset for plan in plans),
        tuple(covers),
        lambda motion: LayeredRenderer.of_artwork(artwork, indices, motion),
        LayerPictures(artwork, indices),
        tuple(notes),
    )


def _meshed_layers(
    artwork: Artwork, plans: Sequence[LayerPlan], spacing: float | None
) -> tuple[list[LayerPlan], list[TriangleMesh], list[str]]:
    """The layers that move, their meshes, and a sentence for each that would by its name, but gives no mesh."""
    moving, meshes, notes = [], [], []
    for plan in plans:
        if not plan.moves:
            continue
        try:
            meshes.append(_meshed(mask_of_layer(artwork, plan.index), spacing, f"layer {plan.name}", None))
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

    shown = [plan.shown for plan in moving_layers(artwork, move, still)]
    layers = zip(artwork.layers, shown, strict=True)
    if all(layer.visible == seen for layer, seen in layers):
        return artwork
    layers = zip(artwork.layers, shown, strict=True)
    return replace(artwork, layers=tuple(replace(layer, visible=seen) for layer, seen in layers))


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


def _meshed(part: Mask, spacing: float | None, name: str, image: Image | None) -> TriangleMesh:
    with about(name):
        if image is None:
            return mesh_from_mask(part, spacing=spacing)
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
