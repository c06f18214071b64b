"""Scenes as versioned JSON documents, in and out.

Reading checks everything against the published schema (``scene.schema.json``) and never runs anything; whatever is
wrong is a SceneError that names its place.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache, partial
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidInputError, SceneError
from ..forces import EnergyStroke, Wind
from ..limits import MAX_MASK_PIXELS
from ..material import Material, preset
from ..mesh import TriangleMesh, mask_of
from ..points import Scale
from ..rig import Combined, MaskRegion, RigPoint
from ..scene import Body, Collider, Contact, Paint, QueryPoint, Scene
from .checking import check_document, join_path
from .encoding import (
    COLLIDER_TYPES,
    ELASTIC_CONSTANTS,
    MOTION_TYPES,
    REGION_TYPES,
    SCENE_VERSION,
    SHAPE_TYPES,
    scene_to_dict,
)
from .json_text import read_json, write_json
from .migration import migrated
from .schema import scene_schema

__all__ = [
    "SCENE_VERSION",
    "LayerMasks",
    "dumps",
    "loads",
    "mask_pixels",
    "query_points_of",
    "scene_from_checked",
    "scene_from_dict",
    "scene_schema",
    "scene_to_dict",
]

T = TypeVar("T")

LayerMasks = Callable[[str], NDArray[np.bool_]]
"""Gives the mask of the layer of a name, bool, shape [h, w]; InvalidInputError where there is none."""

_NAMED = re.compile(r"([a-z_]+(?:\[\d+\])?(?:\.[a-z_]+)?) (must .*)", re.DOTALL)  # as `require` words it


def dumps(scene: Scene, *, meshes: bool = True) -> str:
    """A scene as JSON text that a person can edit.

    Args:
        scene: the scene.
        meshes: whether to include the bodies' meshes; without, reading it again needs them.

    Raises:
        SceneError: the text would be too long to be read again.
    """
    return write_json(scene_to_dict(scene, meshes=meshes))


def loads(
    text: str | bytes, *, meshes: Sequence[TriangleMesh] | None = None, layers: LayerMasks | None = None
) -> Scene:
    """The scene that a JSON text describes.

    Args:
        text: the document; bytes are UTF-8.
        meshes: as for ``scene_from_dict``.
        layers: as for ``scene_from_dict``.

    Raises:
        SceneError: the text is not JSON (with line and column) or not a scene (with the path of the wrong value).

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.document import dumps, loads
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.scene import Body, Scene
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> loads(dumps(Scene((Body(mesh),)))).width
        60
    """
    return scene_from_dict(read_json(text), meshes=meshes, layers=layers)


def scene_from_dict(
    data: object, *, meshes: Sequence[TriangleMesh] | None = None, layers: LayerMasks | None = None
) -> Scene:
    """The scene that plain JSON data describes.

    Args:
        data: the document.
        meshes: for the bodies that have none in the document, in order; what is left over makes further bodies of
            default material. Where they belong to a picture of another size than the document, the document's
            strokes, rig points and meshes are scaled to theirs.
        layers: gives the mask of the artwork's layer of a name, bool, shape [h, w], for colliders that name one, or
            refuses the name; None where the picture is not in layers.

    Raises:
        SceneError: a value is wrong; ``path`` says which, such as ``strokes[2].radius``.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.document import scene_from_dict, scene_to_dict
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.scene import Body, Scene
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> document = scene_to_dict(Scene((Body(mesh),)))
        >>> len(scene_from_dict(document).bodies)
        1
    """
    return scene_from_checked(check_document(data), meshes=meshes, layers=layers)


def scene_from_checked(
    checked: Mapping[str, Any], *, meshes: Sequence[TriangleMesh] | None = None, layers: LayerMasks | None = None
) -> Scene:
    """The scene of a document that ``check_document`` has let pass; else as ``scene_from_dict``."""
    document = migrated(dict(checked))
    supply = list(meshes or ())
    size = (int(document["width"]), int(document["height"]))
    target = (supply[0].width, supply[0].height) if supply else size
    bodies = _read_bodies(document.get("bodies", []), supply, size, target)
    _require_small_masks(document, target)
    colliders = partial(_read_collider, layers=layers and cache(layers))
    readers: dict[str, Callable[[dict[str, Any], str], Any]] = {**_READERS, "colliders": colliders}
    lists: dict[str, Any] = {name: _each(name, document, read) for name, read in readers.items()}
    fields: dict[str, Any] = {
        "wind": _read_one("wind", document, Wind),
        "contact": _read_one("contact", document, Contact),
    }
    if target != size:
        scale = (target[0] / size[0], target[1] / size[1], max(target) / max(size))
        lists = {
            name: [_rescaled(each, scale, at) for each, at in _placed(name, found)] for name, found in lists.items()
        }
        fields = {name: each and _rescaled(each, scale, name) for name, each in fields.items()}
    options: dict[str, Any] = {name: document[name] for name in _OPTIONS if name in document}
    with _located(""):
        return Scene(tuple(bodies), **lists, **fields, **_floats(options))


def _read_bodies(
    entries: list[dict[str, Any]], supply: list[TriangleMesh], size: tuple[int, int], target: tuple[int, int]
) -> list[Body]:
    spare = iter(supply)
    bodies = []
    for index, entry in enumerate(entries):
        path = join_path("bodies", index)
        mesh = _read_mesh(entry["mesh"], path, size).rescaled(*target) if "mesh" in entry else next(spare, None)
        if mesh is None:
            raise SceneError(f"{path}.mesh", f"is missing. Meshes given beside the scene: {len(supply)}")
        material = _read_material(entry.get("material", {}), f"{path}.material")
        options = {name: value for name, value in entry.items() if name not in ("mesh", "material")}
        with _located(f"{path}.material"):
            bodies.append(Body(mesh, material, **options))
    return bodies + [Body(mesh) for mesh in spare]


def _read_mesh(entry: dict[str, Any], path: str, size: tuple[int, int]) -> TriangleMesh:
    vertices = np.array(entry["vertices"], dtype=np.float64)
    with _located(f"{path}.mesh"):
        return TriangleMesh(vertices, np.array(entry["triangles"], dtype=np.int32), *size)


def _read_material(entry: dict[str, Any], path: str) -> Material:
    values = _floats(entry)
    name = values.pop("preset", None)
    if values.get("mu") is not None or values.get("lambda") is not None:
        for other in ELASTIC_CONSTANTS:
            if other in values:
                raise SceneError(
                    f"{path}.{other}", f"must be left out where mu and lambda are given. Got: {values[other]:g}"
                )
    if "lambda" in values:
        values["lambda_"] = values.pop("lambda")  # no name that Python lets a field have
    with _located(path):
        return preset(name, **values) if name else Material(**values)


def _read_stroke(entry: dict[str, Any], path: str) -> EnergyStroke:
    with _located(path):
        return EnergyStroke(**_floats(entry))


def _read_one(name: str, document: dict[str, Any], kind: type) -> Any:
    with _located(name):
        return None if document.get(name) is None else kind(**_floats(document[name]))


def _read_rig_point(entry: dict[str, Any], path: str) -> RigPoint:
    values = dict(entry)
    if "region" in entry:
        values["region"] = _read_typed(entry["region"], REGION_TYPES, f"{path}.region")
    if "motion" in entry:
        values["motion"] = _read_typed(entry["motion"], MOTION_TYPES, f"{path}.motion")
    with _located(path):
        return RigPoint(**values)


def _read_typed(entry: dict[str, Any], types: dict[str, type], path: str) -> Any:
    values = _floats({name: value for name, value in entry.items() if name != "type"})
    kind = types[entry["type"]]
    if kind is Combined:
        parts = enumerate(entry["motions"])
        values["motions"] = tuple(_read_typed(part, types, join_path(path, "motions", i)) for i, part in parts)
    with _located(path):
        if kind is MaskRegion:
            return MaskRegion(mask_of(values["runs"], width=int(values["width"]), height=int(values["height"])))
        return kind(**values)


def _read_collider(entry: dict[str, Any], path: str, *, layers: LayerMasks | None) -> Collider:
    if entry["region"]["type"] == "layer":
        return _collider_of_layer(entry["region"]["name"], f"{path}.region", layers)
    region = _read_typed(entry["region"], COLLIDER_TYPES, f"{path}.region")
    with _located(path):
        return Collider(region)


def _collider_of_layer(name: str, path: str, layers: LayerMasks | None) -> Collider:
    if layers is None:
        raise SceneError(
            path, f"must be a polygon or a mask where the picture is not in layers. Got: layer {name[:60]}"
        )
    try:
        return Collider.from_mask(layers(name), layer=name)
    except InvalidInputError as error:
        raise SceneError(f"{path}.name", str(error).removeprefix("layer ")) from error


def _read_paint(entry: dict[str, Any], path: str) -> Paint:
    values = _floats({name: value for name, value in entry.items() if name != "region"})
    region = _read_typed(entry["region"], SHAPE_TYPES, f"{path}.region")
    with _located(path):
        return Paint(region, **values)


def query_points_of(document: dict[str, Any]) -> list[QueryPoint]:
    """The query points of a checked document, in pixels of its own size."""
    return _each("query_points", document, _read_query_point)


def _read_query_point(entry: dict[str, Any], _path: str) -> QueryPoint:
    return QueryPoint(**_floats(entry))


_OPTIONS = ("gravity", "frame_rate", "loop", "sag", "still", "order", "time_step", "strokes_as")

_READERS: dict[str, Callable[[dict[str, Any], str], Any]] = {
    "strokes": _read_stroke,
    "rig_points": _read_rig_point,
    "paint": _read_paint,
    "query_points": _read_query_point,
}


def _require_small_masks(document: dict[str, Any], target: tuple[int, int]) -> None:
    """Refuse before unpacking: a few characters can ask for any number of pixels."""
    regions = [entry["region"] for entry in document.get("colliders", []) if entry["region"]["type"] == "layer"]
    total = target[0] * target[1] * len({region["name"] for region in regions})
    if total > MAX_MASK_PIXELS:
        raise SceneError("colliders", f"layers must have at most {MAX_MASK_PIXELS} pixels together. Got: {total}")
    for path, pixels in _masks(document):
        total += pixels
        if total > MAX_MASK_PIXELS:
            raise SceneError(path, f"all masks together must have at most {MAX_MASK_PIXELS} pixels. Got: {total}")


def mask_pixels(document: Mapping[str, Any]) -> int:
    """Pixels of all painted masks of a checked document together, once they are unpacked."""
    return sum(pixels for _, pixels in _masks(document))


def _masks(document: Mapping[str, Any]) -> Iterator[tuple[str, int]]:
    """Path and pixels of each mask of a checked document, whose sizes are whole numbers, as ints or as floats."""
    for name in ("rig_points", "colliders", "paint"):
        for index, entry in enumerate(document.get(name, [])):
            region = entry.get("region", {})
            if region.get("type") == "mask":
                yield join_path(name, index, "region"), int(region["width"]) * int(region["height"])


def _each(name: str, document: dict[str, Any], read: Callable[[dict[str, Any], str], T]) -> list[T]:
    return [read(entry, path) for entry, path in _placed(name, document.get(name, []))]


def _placed(name: str, entries: list[T]) -> list[tuple[T, str]]:
    """Entries of a list with their paths."""
    return [(entry, join_path(name, index)) for index, entry in enumerate(entries)]


def _rescaled(entry: Any, scale: Scale, path: str) -> Any:
    with _located(path):
        return entry.rescaled(scale)


def _floats(entry: dict[str, Any]) -> dict[str, Any]:
    """Whole numbers as floats: a person writes 2 for 2.0."""
    return {name: float(value) if type(value) is int else value for name, value in entry.items()}


@contextmanager
def _located(path: str) -> Iterator[None]:
    """Errors of the dataclasses as errors of the document, at the path of the value that they begin with."""
    try:
        yield
    except SceneError:
        raise
    except InvalidInputError as error:
        named = _NAMED.fullmatch(str(error))
        raise SceneError(join_path(path, named[1]) if named else path, named[2] if named else str(error)) from error
