"""The examples in docstrings run and give what they show, and what people call first has one."""

from __future__ import annotations

import doctest
import importlib
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[1]

SHOWN = {
    "physics.mesh": "mesh_from_mask TriangleMesh coverage_of fitted boundary_edges signed_distances",
    "physics.material": "Material preset painted lame_parameters",
    "physics.forces": "EnergyStroke Wind acceleration particles uniform",
    "physics.rig": "RigPoint displacement vertices_of leaders_of",
    "physics.scene": "Body Scene automatic_scene advice Contact Collider Paint",
    "physics.document": "scene_to_dict scene_from_dict loads scene_over parse_points parse_polyline scene_schema",
    "physics.motion": "Motion FlowSequence FrameFlow layer_order tracks motion_to_json stillness",
    "physics.assembly": "plan",
    "physics.simulation": "simulate",
    "rendering.pictures": (
        "load_image load_mask save_image write_animation as_picture as_float as_uint8 over resized nearest_pixels"
    ),
    "rendering.matting": "regular_mask part_mesh",
    "rendering.plate": "clean_plate",
    "rendering.composite": "LayeredRenderer PixelArtRenderer background_of",
    "rendering.overlays": "draw_wireframe draw_strokes draw_tracks flow_to_color preview",
    "rendering.sketch": "extract_sketch warp_sketch warped_sketches LayeredSketch",
    "rendering.control": "ModelFormat first_and_last suitable_size time_to_move",
    "rendering.inbetweens": "interpolate keyframe_indices",
    "rendering.metrics": "measure_clip chamfer_distance",
    "rendering.segmentation": "segment segment_parts",
    "rendering.svd": "SVDOptions",
    "rendering.neural": "NetworkOptions",
    "rendering.pipeline": "animate",
}
"""Public functions and classes that show a call, by the module that people import them from."""


def examples(module: ModuleType) -> list[doctest.DocTest]:
    finder = doctest.DocTestFinder(exclude_empty=True)
    return [found for found in finder.find(module, globs={}) if found.examples]


def failures(test: doctest.DocTest) -> str:
    told: list[str] = []
    doctest.DocTestRunner(verbose=False).run(test, out=told.append)
    return "".join(told)


def modules() -> list[str]:
    """Those of this tree with an example: the others may import what is heavy."""
    paths = (path for house in ("physics", "rendering") for path in sorted((ROOT / house).rglob("*.py")))
    return [
        path.relative_to(ROOT).with_suffix("").as_posix().replace("/", ".")
        for path in paths
        if ">>> " in path.read_text(encoding="utf-8")
    ]


@pytest.mark.parametrize("name", modules())
def test_examples_give_what_they_show(name: str) -> None:
    found = examples(importlib.import_module(f"physanimator.{name}"))
    assert found
    assert "".join(map(failures, found)) == ""


@pytest.mark.parametrize(("room", "name"), [(room, name) for room, names in SHOWN.items() for name in names.split()])
def test_what_people_call_first_shows_a_call(room: str, name: str) -> None:
    words = getattr(importlib.import_module(f"physanimator.{room}"), name).__doc__
    assert "\n    Examples:\n        >>> " in words
    called = words.split("    Examples:\n")[1]
    assert f"{name}(" in called
    assert f"from physanimator.{room} import " in called


def test_a_wrong_example_is_told() -> None:
    test = doctest.DocTestParser().get_doctest(">>> 1 + 1\n3\n", {}, "wrong", None, 0)
    assert "Expected:\n    3" in failures(test)
