"""A scene document laid over bodies that are at hand: what the document says of them counts, the rest stays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from ..material import SCALES
from ..scene import Body, Scene
from .body_names import arranged_for
from .checking import check_document
from .scene_json import LayerMasks, scene_from_checked

__all__ = ["checked_scene_over", "scene_over"]


def scene_over(document: object, bodies: Sequence[Body], *, layers: LayerMasks | None = None) -> Scene:
    """The scene that a document describes for given bodies.

    Names, layers and materials that the document's bodies give replace those of the bodies: of one name, where the
    bodies have names, otherwise in order. Factors that are painted on the triangles of a body's material stay where the
    document's has none. Meshes in it are passed over. A document for a picture of another size is scaled to that of the
    bodies.

    Args:
        document: a decoded scene document.
        bodies: what moves, at least one.
        layers: as for ``scene_from_dict``.

    Raises:
        SceneError: a value is wrong; ``path`` says which.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.document import scene_over, scene_to_dict
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.scene import Body, Scene
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> document = scene_to_dict(Scene((Body(mesh),), frame_rate=12.0), meshes=False)
        >>> scene_over(document, [Body(mesh)]).frame_rate
        12.0
    """
    return checked_scene_over(check_document(document), bodies, layers=layers)


def checked_scene_over(
    checked: Mapping[str, Any], bodies: Sequence[Body], *, layers: LayerMasks | None = None
) -> Scene:
    """The same for a document that ``check_document`` has let pass."""
    checked, absent = arranged_for(checked, [body.name for body in bodies])
    entries = [{key: value for key, value in entry.items() if key != "mesh"} for entry in checked.get("bodies", [])]
    scene = scene_from_checked({**checked, "bodies": entries}, meshes=[body.mesh for body in bodies], layers=layers)
    named = [
        replace(body, **{field: _value(field, found, body) for field in entry})
        for body, found, entry in zip(bodies, scene.bodies, entries, strict=False)
    ]
    return replace(scene, bodies=(*named, *bodies[len(named) :]), absent=absent)


def _value(field: str, found: Body, body: Body) -> Any:
    """A field of the body that the document describes, with the factors that are painted on the one at hand."""
    if field != "material":
        return getattr(found, field)
    painted = {name: getattr(found.material, name) for name in SCALES}
    kept = {name: getattr(body.material, name) for name in SCALES if painted[name] is None}
    return replace(found.material, **kept)
