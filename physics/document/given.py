"""A scene that somebody gives for bodies whose meshes are at hand, and the changes that are made to it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ..checks import require_kind
from ..errors import InvalidInputError, counted
from ..material import Material, with_values
from ..material import preset as preset_of
from ..mesh import TriangleMesh
from ..scene import Scene
from .body_names import arranged_for

if TYPE_CHECKING:
    from .scene_json import LayerMasks

__all__ = ["given_scene", "materials_of"]


def given_scene(
    scene: Scene | Mapping[str, Any],
    meshes: list[TriangleMesh],
    *,
    names: Sequence[str] = (),
    layers: LayerMasks | None = None,
    preset: str | Sequence[str] | None,
    sway: float | None,
    frame_rate: float | None,
) -> Scene:
    """A scene from outside, with what the caller changes in it.

    Args:
        scene: a scene with one body for each mesh, or a decoded and checked scene document.
        meshes: those of the parts, in order; a document's bodies without a mesh of their own take them.
        names: of the parts, by which a document's bodies are found; empty for those that have none.
        layers: as for ``scene_from_dict``.
        preset: name of the material, one for all bodies or one for each; None keeps the scene's.
        sway: sway frequency of every body [Hz]; None keeps the materials'.
        frame_rate: frames a second; None keeps the scene's.

    Raises:
        InvalidInputError: the scene has another number of bodies, or is wrong.
    """
    if not isinstance(scene, Scene):
        from .scene_json import scene_from_checked

        document, absent = arranged_for(scene, names)
        scene = scene_from_checked(document, meshes=_missing_meshes(document, meshes), layers=layers)
        scene = replace(_with_names(scene, names), absent=absent)
    if len(scene.bodies) != len(meshes):
        raise InvalidInputError(
            f"scene must have {counted(len(meshes), 'body')}, one for each {'moving layer' if any(names) else 'mask'}."
            f" Got: {counted(len(scene.bodies), 'body')}"
        )
    if (scene.width, scene.height) != (meshes[0].width, meshes[0].height):
        scene = scene.rescaled(meshes[0].width, meshes[0].height)
    materials: Sequence[Material] = [body.material for body in scene.bodies]
    if preset is not None:
        materials = materials_of(preset, None, len(meshes))
    if sway is not None:
        materials = [with_values(each, sway_frequency=sway) for each in materials]
    bodies = tuple(replace(body, material=each) for body, each in zip(scene.bodies, materials, strict=True))
    return replace(scene, bodies=bodies, frame_rate=scene.frame_rate if frame_rate is None else frame_rate)


def _with_names(scene: Scene, names: Sequence[str]) -> Scene:
    """The scene whose bodies have the names of the parts, where they have some, and their order."""
    if not any(names) or len(names) != len(scene.bodies):
        return scene
    bodies = enumerate(zip(scene.bodies, names, strict=True))
    named = (replace(body, name=body.name or name, layer=rank) for rank, (body, name) in bodies)
    return replace(scene, bodies=tuple(named))


def _missing_meshes(document: Mapping[str, Any], meshes: list[TriangleMesh]) -> list[TriangleMesh]:
    """The meshes that a checked document does not bring itself."""
    brought = [bool(body.get("mesh")) for body in document.get("bodies", [])]
    return [mesh for number, mesh in enumerate(meshes) if not any(brought[number : number + 1])]


def materials_of(names: str | Sequence[str], sway: float | None, count: int) -> list[Material]:
    """Materials by name.

    Args:
        names: of presets, one for all bodies or one for each.
        sway: sway frequency instead of the presets' [Hz].
        count: number of bodies.

    Raises:
        InvalidInputError: there is no such preset, or the number of names fits neither one nor all bodies.
    """
    require_kind("preset", names, (str, Sequence), "the name of a material, or a list of names")
    chosen = [names] if isinstance(names, str) else list(names)
    if len(chosen) not in (1, count):
        raise InvalidInputError(f"preset must be named once, or once for each of the {count} masks. Got: {len(chosen)}")
    changes = {} if sway is None else {"sway_frequency": sway}
    materials = [preset_of(name, **changes) for name in chosen]
    return materials * count if len(materials) == 1 else materials
