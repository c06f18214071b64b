"""Layers of an artwork as bodies: by their names, by what somebody says, and by what a scene document says."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..physics.document import bodies_named, checked_scene_over, order_of_layers
from ..physics.errors import InvalidInputError, require
from ..physics.material import Material, preset
from ..physics.scene import Body, Held
from .layers_of_scenes import attachments_in, planned_layers
from .moving_layers import MIXED, LayerSource, moving_layers_of
from .parts import OF_STRANDS, Parts, parts_of_artwork, with_shown

if TYPE_CHECKING:
    from .artwork import Artwork, LayerPlan

__all__ = ["LayerBodies", "bodies_before", "bodies_of_layers", "plans_of_layers"]

_KEPT = ("mesh", "material", "strands")
"""Of bodies that layers are already."""


@dataclass(frozen=True, eq=False)
class LayerBodies:
    """Layers as bodies.

    Attributes:
        parts: the layers.
        bodies: of the parts, from back to front.
        sources: the layer that each body is.
        attachments: where each is held.
        plans: what becomes of every layer of the artwork, moving or not.
    """

    parts: Parts
    bodies: tuple[Body, ...]
    sources: tuple[LayerSource, ...]
    attachments: tuple[Held, ...]
    plans: tuple[LayerPlan, ...]


def bodies_of_layers(
    artwork: Artwork,
    *,
    move: Sequence[str] = (),
    still: Sequence[str] = (),
    material: Material | str | None = None,
    spacing: float | None = None,
    elements_across: int | None = None,
    strands: bool = True,
    before: Mapping[int, tuple[Body, Held]] | None = None,
    document: Mapping[str, Any] | None = None,
    plans: Sequence[LayerPlan] | None = None,
) -> LayerBodies:
    """The layers that move as bodies.

    Args:
        artwork: the layers.
        move: names of layers that move, whatever the table of names says; ``NAME=PRESET`` also says how.
        still: names of layers that stand still.
        material: of all that move, or the name of its preset, instead of what suits each; ``NAME=PRESET`` and the
            document stand above.
        spacing: distance of the meshes' vertices [px]; None chooses it.
        elements_across: triangles across thin strands; None for the usual number.
        strands: slit hair and ribbons along the lines that are drawn between their strands, so that these swing apart.
        before: bodies that layers of this artwork are already, and where they are held, by the layers' index.
        document: a checked scene document, which says of layers by name whether they move, what they are made of, where
            they are held, whether they are slit, and in which order they lie.
        plans: what becomes of every layer, in the order that the document says; None to follow from all that.

    Raises:
        InvalidInputError: there is no such layer, none moves, or one gives no mesh.
    """
    from .artwork import in_order

    document = document or {}
    known = {artwork.names[index]: each for index, each in (before or {}).items()}
    for plan in _asked(artwork, move):
        require("move", plan.name, plan.name not in known, "of layers that are no bodies yet")
    chosen = {plan.name for plan in _asked(artwork, [each for each in move if _has_preset(each, artwork)])}
    if plans is None:
        plans = plans_of_layers(artwork, move=move, still=still, before=before, document=document)
    artwork = in_order(artwork, order_of_layers(document))
    parts = parts_of_artwork(
        artwork, spacing=spacing, elements_across=elements_across, document=document, plans=tuple(plans)
    )
    _require_meshes(parts, document)
    moving = [plan for plan in plans if plan.moves and plan.name in parts.names]
    said = attachments_in(document)
    attachments = [
        known[plan.name][1] if plan.name in known and plan.name not in said else held
        for plan, held in zip(moving, parts.attachments, strict=True)
    ]
    materials = [_material(plan, None if plan.name in chosen else material) for plan in moving]
    worded = _over(document, parts.bodies(materials), without=known)
    slit_ones = _strands_in(document) if strands else {}
    split = [
        strands and body.name not in known and slit_ones.get(body.name, body.material.name in OF_STRANDS)
        for body in worded
    ]
    whole, parts = parts.meshes, parts.in_strands(split, attachments)
    slit = [mesh is not uncut for mesh, uncut in zip(parts.meshes, whole, strict=True)]
    bodies = [
        replace(body, **{name: getattr(known[body.name][0], name) for name in _KEPT}) if body.name in known else body
        for body in parts.bodies([body.material for body in worded], slit)
    ]
    shown = with_shown(artwork, plans)
    sources = tuple(LayerSource(shown, plan.index) for plan in moving)
    return LayerBodies(parts, tuple(bodies), sources, tuple(attachments), tuple(plans))


def plans_of_layers(
    artwork: Artwork,
    *,
    move: Sequence[str] = (),
    still: Sequence[str] = (),
    before: Mapping[int, tuple[Body, Held]] | None = None,
    document: Mapping[str, Any] | None = None,
) -> list[LayerPlan]:
    """What becomes of every layer, in the order that the document says; arguments as of :func:`bodies_of_layers`."""
    from .artwork import in_order

    known = {artwork.names[index] for index in before or {}}
    ordered = in_order(artwork, order_of_layers(document or {}))
    return [_as_before(plan, known) for plan in planned_layers(ordered, move, still, document=document)]


def bodies_before(
    artwork: Artwork, before: Sequence[tuple[LayerSource | None, Body, Held]]
) -> dict[int, tuple[Body, Held]]:
    """Bodies that layers of an artwork are already, and where they are held, by the layers' index.

    Args:
        artwork: the layers, in any order.
        before: bodies, the layers that they are, and where they are held.

    Raises:
        InvalidInputError: a body is cut out by a mask, or a layer of another artwork.
    """
    from .artwork import in_order

    layers = moving_layers_of([source for source, *_ in before])
    require("bodies", "bodies of masks", layers is not None or not before, MIXED)
    if layers is None:
        return {}
    if not _alike(in_order(layers.artwork, artwork.names), artwork):
        raise InvalidInputError("bodies must be of layers of the same artwork. Got: those of another")
    names = layers.artwork.names
    return {artwork.names.index(names[source.index]): (body, held) for source, body, held in before if source}


def _alike(one: Artwork, other: Artwork) -> bool:
    """Whether two artworks hold the same layers in the same places; which are shown does not count."""
    if (one.width, one.height, one.names) != (other.width, other.height, other.names):
        return False
    pairs = zip(one.layers, other.layers, strict=True)
    return all(a.box == b.box and np.array_equal(a.pixels, b.pixels) for a, b in pairs)


def _asked(artwork: Artwork, move: Sequence[str]) -> list[LayerPlan]:
    """The layers that somebody named."""
    from .artwork import moving_layers

    return [plan for plan in moving_layers(artwork, move) if plan.moves and plan.asked]


def _has_preset(entry: str, artwork: Artwork) -> bool:
    return "=" in entry and entry not in artwork.names


def _material(plan: LayerPlan, chosen: Material | str | None) -> Material:
    return chosen if isinstance(chosen, Material) else preset(chosen or plan.preset or "hair")


def _require_meshes(parts: Parts, document: Mapping[str, Any]) -> None:
    """Refuse a layer that gives no mesh where the document says that it moves."""
    wanted = [name for name in bodies_named(document) if name not in parts.names]
    for note in parts.notes:
        require("layer", note, not any(f"layer {name}:" in note for name in wanted), "one that gives a mesh")


def _over(document: Mapping[str, Any], bodies: list[Body], *, without: Collection[str]) -> Sequence[Body]:
    """Bodies of the materials that a scene document says."""
    names = {body.name for body in bodies} - set(without)
    entries = [
        {key: entry[key] for key in ("name", "material") if key in entry}
        for entry in document.get("bodies", [])
        if entry.get("name") in names
    ]
    if not entries:
        return bodies
    size = {"width": bodies[0].mesh.width, "height": bodies[0].mesh.height}
    return checked_scene_over({"version": 2, **size, "bodies": entries}, bodies).bodies


def _strands_in(document: Mapping[str, Any]) -> dict[str, bool]:
    """Of which bodies a scene document says whether they are slit, by name."""
    entries = document.get("bodies", [])
    return {entry["name"]: entry["strands"] for entry in entries if "strands" in entry and "name" in entry}


def _as_before(plan: LayerPlan, known: Collection[str]) -> LayerPlan:
    """The plan of a layer that is a body already."""
    if plan.name not in known or plan.moves:
        return plan
    if plan.asked:
        raise InvalidInputError(f"layer {plan.name} must either move or stand still. Got: both")
    return replace(plan, moves=True, preset="hair", shown=True, why="it is a body already", asked=True)
