"""Scenes in and out of JSON, and what is said about wrong ones."""

from __future__ import annotations

import copy
import json
import math
import tracemalloc
from dataclasses import MISSING, fields
from functools import partial
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from physanimator.physics import limits
from physanimator.physics.document import dumps, json_text, loads, scene_from_dict, scene_schema, scene_to_dict
from physanimator.physics.document.quick_check import is_right
from physanimator.physics.errors import InvalidInputError, SceneError
from physanimator.physics.fields import described_fields
from physanimator.physics.forces import STROKE_KINDS, EnergyStroke, Wind
from physanimator.physics.material import PRESETS, Material
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import Circle, KeyedPath, MaskRegion, Pinned, Polygon, RigPoint, RigRegion, Wave
from physanimator.physics.scene import Body, Paint, QueryPoint, Scene

ROOT = Path(__file__).resolve().parents[3]


def square_mesh(width: int = 100, height: int = 50, x: float = 0.0) -> TriangleMesh:
    corners = [(x, 0.0), (x + 10, 0.0), (x + 10, 10.0), (x, 10.0)]
    return TriangleMesh(np.array(corners), np.array([[0, 1, 2], [0, 2, 3]]), width, height)


# Random scenes: every field of every type

numbers = st.floats(-1e6, 1e6)
positive = st.floats(0, 1e6, exclude_min=True)
seconds = st.floats(0, 1e5)
points = st.tuples(numbers, numbers)


@st.composite
def meshes(draw: st.DrawFn, width: int, height: int) -> TriangleMesh:
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    count = draw(st.integers(3, 8))
    triangles = [rng.permutation(count)[:3] for _ in range(draw(st.integers(1, 6)))]
    return TriangleMesh(rng.normal(0, 500, (count, 2)), np.array(triangles), width, height)


@st.composite
def bodies(draw: st.DrawFn, width: int, height: int) -> Body:
    mesh = draw(meshes(width, height))
    count = len(mesh.triangles)
    constants = {
        "youngs_modulus": draw(st.floats(1e-3, 1e12)),
        "poisson_ratio": draw(st.floats(0, 0.5, exclude_max=True)),
        "sway_frequency": draw(st.none() | st.floats(0.001, 1000)),
    }
    lame = {"mu": draw(st.floats(0, 1e12, exclude_min=True)), "lambda_": draw(st.floats(0, 1e12))}
    material = Material(
        **(lame if draw(st.booleans()) else constants),
        density=draw(positive),
        damping=draw(st.floats(0, 1e6)),
        stiffness_scale=draw(st.none() | st.lists(positive, min_size=count, max_size=count).map(np.array)),
        name=draw(st.text(max_size=5)),
    )
    return Body(mesh, material, layer=draw(st.integers(-9, 9)), name=draw(st.text(max_size=9)))


@st.composite
def strokes(draw: st.DrawFn) -> EnergyStroke:
    start = draw(seconds)
    return EnergyStroke(
        kind=draw(st.sampled_from(STROKE_KINDS)),
        path=((0, 0), (draw(st.floats(1, 2000)), 7), *draw(st.lists(st.tuples(*[st.floats(0, 2000)] * 2), max_size=4))),
        radius=draw(positive),
        speed=draw(st.just(0.0) | st.floats(100, 1e6)),
        strength=draw(numbers),
        start=start,
        end=draw(st.none() | st.floats(start + 1, 1e6)),
        interval=draw(st.floats(0.5, 1e6)),
    )


@st.composite
def paths(draw: st.DrawFn) -> KeyedPath:
    keys = draw(st.lists(points, min_size=2, max_size=5))
    steps = draw(st.lists(st.floats(0.01, 100), min_size=len(keys), max_size=len(keys)))
    return KeyedPath(tuple(np.cumsum(steps)), tuple(keys))


regions = st.one_of(
    positive.map(Circle),
    st.lists(points, min_size=3, max_size=6).map(lambda corners: Polygon(tuple(corners))),
    st.tuples(st.integers(0, 99), st.integers(1, 9), st.integers(1, 9), st.floats(0, 1)).map(
        lambda v: MaskRegion(np.random.default_rng(v[0]).random((v[1], v[2])) < v[3])
    ),
)
waves = st.builds(Wave, numbers, st.floats(0.01, 1e6), points.filter(lambda direction: math.hypot(*direction) > 1e-9))


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    width, height = draw(st.integers(1, 4000)), draw(st.integers(1, 4000))
    of_scene = draw(st.lists(bodies(width, height), min_size=1, max_size=3))
    rig_point = st.builds(
        RigPoint, points, regions, st.just(Pinned()) | paths() | waves, st.none() | st.integers(0, len(of_scene) - 1)
    )
    of_body = st.none() | st.integers(0, len(of_scene) - 1)
    factors = st.floats(0.001, 1000)
    paint = st.builds(
        Paint, regions.filter(lambda region: not isinstance(region, Circle)), factors, factors, factors, of_body
    )
    return Scene(
        tuple(of_scene),
        tuple(draw(st.lists(strokes(), max_size=3))),
        tuple(draw(st.lists(rig_point, max_size=3))),
        gravity=draw(points),
        frame_rate=draw(st.floats(1, 240)),
        paint=tuple(draw(st.lists(paint, max_size=2))),
        query_points=tuple(draw(st.lists(st.builds(QueryPoint, numbers, numbers, st.booleans()), max_size=3))),
    )


def assert_same(one: Scene, other: Scene) -> None:
    """Every bit of two scenes."""
    assert (one.strokes, one.gravity, one.frame_rate) == (other.strokes, other.gravity, other.frame_rate)
    for mine, yours in zip(one.bodies, other.bodies, strict=True):
        assert (mine.name, mine.layer) == (yours.name, yours.layer)
        assert mine.mesh.content_hash == yours.mesh.content_hash
        for field in fields(Material):
            np.testing.assert_array_equal(getattr(mine.material, field.name), getattr(yours.material, field.name))
    assert one.query_points == other.query_points
    for mine, yours in zip(one.rig_points, other.rig_points, strict=True):
        assert (mine.position, mine.motion, mine.body) == (yours.position, yours.motion, yours.body)
        assert_same_region(mine.region, yours.region)
    for mine, yours in zip(one.paint, other.paint, strict=True):
        for field in ("stiffness", "damping", "density", "body"):
            assert getattr(mine, field) == getattr(yours, field)
        assert_same_region(mine.region, yours.region)


def assert_same_region(one: RigRegion, other: RigRegion) -> None:
    if isinstance(one, MaskRegion):
        np.testing.assert_array_equal(one.mask, other.mask)
    else:
        assert one == other


@settings(deadline=None, max_examples=60)
@given(scene=scenes())
def test_round_trip_is_exact(scene: Scene) -> None:
    assert_same(loads(dumps(scene)), scene)


@settings(deadline=None, max_examples=20)
@given(scene=scenes())
def test_round_trip_with_the_meshes_beside_it(scene: Scene) -> None:
    text = dumps(scene, meshes=False)
    assert "vertices" not in text
    assert_same(loads(text, meshes=[body.mesh for body in scene.bodies]), scene)


@settings(deadline=None, max_examples=20)
@given(scene=scenes())
def test_what_is_written_validates_by_the_published_schema(scene: Scene) -> None:
    published = json.loads((ROOT / "physics" / "document" / "scene.schema.json").read_text(encoding="utf-8"))
    jsonschema.validate(scene_to_dict(scene), published, jsonschema.Draft202012Validator)


# The schema


def test_schema_is_a_schema_and_its_file_in_step() -> None:
    jsonschema.Draft202012Validator.check_schema(scene_schema())
    text = json.dumps(scene_schema(), indent=2) + "\n"
    written = (ROOT / "physics" / "document" / "scene.schema.json").read_text(encoding="utf-8")
    assert written == text, "write it anew: python -m physanimator schema > physics/document/scene.schema.json"


def test_schema_has_the_fields_and_defaults_of_the_dataclasses() -> None:
    definitions = scene_schema()["$defs"]
    classes = {
        "material": Material, "stroke": EnergyStroke, "rig_point": RigPoint, "body": Body, "circle": Circle,
        "polygon": Polygon, "pinned": Pinned, "path": KeyedPath, "wave": Wave, "paint": Paint,
        "query_point": QueryPoint,
    }  # fmt: skip
    for name, kind in classes.items():
        properties = definitions[name]["properties"]
        assert set(properties) - {"type", "preset"} == {each.key for each in described_fields(kind).values()}
        for field in fields(kind):
            if field.name in properties and field.default is not MISSING:
                assert "default" in properties[field.name]
    stroke = definitions["stroke"]["properties"]
    assert {name: stroke[name]["default"] for name in ("radius", "end", "path")} == {
        "radius": EnergyStroke().radius, "end": None, "path": [[0, 0], [1, 0]],
    }  # fmt: skip
    assert definitions["rig_point"]["properties"]["region"]["default"] == {"type": "circle", "radius": 20.0}
    assert definitions["material"]["properties"]["preset"]["enum"] == list(PRESETS)


def test_every_value_is_explained() -> None:
    schema = scene_schema()
    for part in [schema, *schema["$defs"].values()]:
        for name, value in part.get("properties", {}).items():
            assert "$ref" in value or name == "type" or {"title", "description"} <= set(value), name


def test_bounds_of_the_schema_are_those_of_the_dataclasses() -> None:
    """A value at a bound is accepted by the dataclass, and the next one beyond it refused."""
    classes = {"material": Material, "stroke": EnergyStroke, "circle": Circle, "wave": Wave, "paint": Paint}
    classes |= {"wind": Wind, "query_point": QueryPoint}
    beside = {
        "wind": {},
        "repeat": {"end": 0.005},
        "stroke": {"interval": 1e6, "start": 0.0},
        "wave": {},
        "paint": {"region": Polygon(((0, 0), (1, 0), (0, 1)))},
        "query_point": {"x": 0.0, "y": 0.0},
        "circle": {"radius": 1.0},
        "material": {},
        "mu": {"lambda_": 1.0},
        "lambda": {"mu": 1.0},
    }
    names = {"lambda": "lambda_"}
    checked = 0
    for name, kind in classes.items():
        for key, schema in scene_schema()["$defs"][name]["properties"].items():
            for rule, step in (("minimum", -1), ("exclusiveMinimum", 1), ("maximum", 1), ("exclusiveMaximum", -1)):
                if rule not in schema:
                    continue
                bound = float(schema[rule])
                next_to_it = math.nextafter(bound, step * math.inf)
                good, bad = (next_to_it, bound) if rule.startswith("exclusive") else (bound, next_to_it)
                field = names.get(key, key)
                kind(**{**beside[name], **beside.get(key, {}), field: good})
                with pytest.raises(InvalidInputError, match=f"^{key} must be"):
                    kind(**{**beside[name], **beside.get(key, {}), field: bad})
                checked += 1
    assert checked >= 20


def test_example_of_the_schema_is_a_scene() -> None:
    for example in scene_schema()["examples"]:
        scene = scene_from_dict(example, meshes=[square_mesh(1280, 720)])
        assert scene.bodies[0].material.damping == 2
        assert scene.bodies[0].material.sway_frequency == PRESETS["hair"].sway_frequency
        assert scene.rig_points[0].region == Circle(60)


# Reading


BARE = {"version": 1, "width": 100, "height": 50}


def test_everything_else_may_be_left_out() -> None:
    scene = scene_from_dict(BARE, meshes=[square_mesh()])
    assert_same(scene, Scene((Body(square_mesh()),)))
    filled = {**BARE, "strokes": [{}], "rig_points": [{"position": [1, 2]}], "bodies": [{}]}
    expected = Scene((Body(square_mesh()),), (EnergyStroke(),), (RigPoint((1, 2)),))
    assert_same(scene_from_dict(filled, meshes=[square_mesh()]), expected)


def test_preset_with_own_values() -> None:
    material = {"preset": "jelly", "density": 3, "sway_frequency": None}
    scene = scene_from_dict({**BARE, "bodies": [{"material": material}]}, meshes=[square_mesh()])
    expected = Material(40.0, 0.45, 3.0, 0.5, None, name="jelly", wind_response=1.6)
    assert [getattr(scene.bodies[0].material, f.name) for f in fields(Material)] == [
        getattr(expected, f.name) for f in fields(Material)
    ]


def test_meshes_fill_the_bodies_without_one_in_order_and_then_make_more() -> None:
    own = scene_to_dict(Scene((Body(square_mesh(x=5.0)),)))["bodies"][0]["mesh"]
    data = {**BARE, "bodies": [{"name": "a"}, {"name": "b", "mesh": own}, {"name": "c"}]}
    scene = scene_from_dict(data, meshes=[square_mesh(x=10.0 * k) for k in range(4)])
    assert [body.name for body in scene.bodies] == ["a", "b", "c", "", ""]
    assert [body.mesh.vertices[0, 0] for body in scene.bodies] == [0, 5, 10, 20, 30]


def test_too_few_meshes() -> None:
    with pytest.raises(SceneError, match="Meshes given beside the scene: 1") as caught:
        scene_from_dict({**BARE, "bodies": [{}, {}]}, meshes=[square_mesh()])
    assert caught.value.path == "bodies[1].mesh"
    with pytest.raises(SceneError, match="at least one body"):
        scene_from_dict(BARE)


def test_meshes_of_pictures_of_two_sizes() -> None:
    with pytest.raises(SceneError, match="one size"):
        scene_from_dict(BARE, meshes=[square_mesh(), square_mesh(200, 100)])


ACTING = {
    **BARE,
    "gravity": [0.5, 1],
    "strokes": [{"path": [[10, 20], [30, 40]], "radius": 50, "speed": 60, "strength": 7}],
    "rig_points": [
        {"position": [10, 20], "region": {"type": "circle", "radius": 5}, "motion": {"type": "wave", "amplitude": 6}},
        {
            "position": [1, 2],
            "region": {"type": "polygon", "points": [[0, 0], [10, 0], [0, 10]]},
            "motion": {"type": "path", "times": [0, 1], "points": [[1, 2], [3, 4]]},
        },
    ],
}


def test_scene_is_scaled_to_meshes_of_another_size() -> None:
    own = scene_to_dict(Scene((Body(square_mesh()),)))["bodies"][0]["mesh"]
    scene = scene_from_dict({**ACTING, "bodies": [{"mesh": own}]}, meshes=[square_mesh(300, 200)])
    assert (scene.width, scene.height) == (300, 200)
    np.testing.assert_allclose(scene.bodies[0].mesh.vertices[2], (30, 40))
    assert scene.bodies[1].mesh.content_hash == square_mesh(300, 200).content_hash
    (stroke,) = scene.strokes
    np.testing.assert_allclose(stroke.path, [(30, 80), (90, 160)])
    assert (stroke.radius, stroke.speed, stroke.strength, scene.gravity) == (150, 180, 7, (0.5, 1))
    circle, polygon = scene.rig_points
    assert (circle.position, circle.region) == ((30, 80), Circle(15))
    assert circle.motion == Wave(amplitude=18)
    np.testing.assert_allclose(polygon.region.points, [(0, 0), (30, 0), (0, 40)])
    np.testing.assert_allclose(polygon.motion.points, [(3, 8), (9, 16)])
    assert polygon.motion.times == (0, 1)


def test_rescaled_scene_is_the_document_read_at_that_size() -> None:
    scene = scene_from_dict(ACTING, meshes=[square_mesh()]).rescaled(300, 200)
    assert_same(scene, scene_from_dict(ACTING, meshes=[square_mesh().rescaled(300, 200)]))
    assert_same(
        scene_from_dict(ACTING, meshes=[square_mesh()]).rescaled(100, 50),
        scene_from_dict(ACTING, meshes=[square_mesh()]),
    )


def test_wave_across_a_stretched_picture_leads_along_the_stretched_way() -> None:
    wave = Wave(amplitude=10.0, direction=(3.0, 4.0)).rescaled((2.0, 1.0, 2.0))
    np.testing.assert_allclose(np.array(wave.direction) * wave.amplitude, (12, 8))


def test_person_may_name_the_schema_and_save_with_a_byte_order_mark() -> None:
    text = "\ufeff" + json.dumps({"$schema": "scene.schema.json", **BARE})
    for form in (text, text.encode()):
        assert loads(form, meshes=[square_mesh()]).width == 100


def test_text_is_easy_to_edit() -> None:
    text = dumps(scene_from_dict(ACTING, meshes=[square_mesh()]))
    assert '      "path": [[10.0, 20.0], [30.0, 40.0]],\n' in text
    assert max(map(len, text.splitlines())) <= 110
    assert text.endswith("}\n")
    assert "null" not in text


def material_of(entry: dict[str, Any]) -> Material:
    return scene_from_dict({**BARE, "bodies": [{"material": entry}]}, meshes=[square_mesh()]).bodies[0].material


def test_lame_parameters_are_read_as_they_are_and_written_alone() -> None:
    """One pair stands in what is written: whoever edits it edits what counts."""
    read = material_of({"mu": 3, "lambda": 0.1, "density": 2})
    assert (read.lame, read.density) == ((3.0, 0.1), 2.0)
    written = scene_to_dict(Scene((Body(square_mesh(), read),)))["bodies"][0]["material"]
    assert (written["mu"], written["lambda"]) == (3.0, 0.1)
    assert not {"youngs_modulus", "poisson_ratio", "lambda_", "sway_frequency"} & written.keys()
    assert material_of(written).lame == (3.0, 0.1)
    other = scene_to_dict(Scene((Body(square_mesh()),)))["bodies"][0]["material"]
    assert "youngs_modulus" in other
    assert not {"mu", "lambda"} & other.keys()


def test_lame_parameters_take_the_place_of_a_presets_sway() -> None:
    read = material_of({"preset": "hair", "mu": 100, "lambda": 0})
    assert (read.lame, read.sway_frequency) == ((100.0, 0.0), None)
    assert read.root_stiffness == PRESETS["hair"].root_stiffness
    assert material_of({"preset": "hair", "mu": None, "lambda": None}).sway_frequency == PRESETS["hair"].sway_frequency


# Wrong documents


GOOD = {
    **ACTING,
    "bodies": [{"mesh": {"vertices": [[0, 0], [10, 0], [0, 10]], "triangles": [[0, 1, 2]]}}],
}


def edited(keys: list[str | int], value: object) -> dict[str, Any]:
    data = copy.deepcopy(GOOD)
    part: Any = data
    for key in keys[:-1]:
        part = part[key]
    part[keys[-1]] = value
    return data


MASK = {"type": "mask", "width": 2, "height": 2, "runs": [1, 3]}
REGION = ["rig_points", 0, "region"]
MOTION = ["rig_points", 0, "motion"]
BODY = ["bodies", 0]
WRONG = [
    (["version"], 3, "version", "made by a newer PhysAnimator (format 3, known here up to 2)"),
    (["version"], 0, "version", "must be one of 1, 2. Got: 0"),
    (["version"], "1", "version", 'must be one of 1, 2. Got: "1"'),
    (["version"], True, "version", "must be one of 1, 2. Got: true"),
    (["width"], 0, "width", "must be at least 1 px. Got: 0"),
    (["width"], 10.5, "width", "must be a whole number. Got: 10.5"),
    (["height"], 10**9, "height", "must be at most 65536 px"),
    (["height"], None, "height", "must be a whole number. Got: null"),
    (["frame_rate"], 0.5, "frame_rate", "must be at least 1 frames/s. Got: 0.5"),
    (["frame_rate"], math.nan, "frame_rate", "must be a number, and finite. Got: nan"),
    (["gravity"], [0], "gravity", "must be a list of 2 numbers. Got: a list of 1"),
    (["gravity"], [0, True], "gravity[1]", "must be a number. Got: true"),
    (["gravity", 1], -math.inf, "gravity[1]", "must be a number, and finite. Got: -inf"),
    (["bodys"], [], "bodys", "is not known here; did you mean 'bodies'?"),
    (["Strokes"], [], "Strokes", "did you mean 'strokes'?"),
    (["xyz"], [], "xyz", "known are $schema, version, width"),
    (["bodies"], {}, "bodies", "must be a list. Got: an object"),
    (["bodies"], [{}] * 101, "bodies", "must have at most 100 entries. Got: a list of 101"),
    ([*BODY], 7, "bodies[0]", "must be an object in braces. Got: 7"),
    ([*BODY, "layer"], 1.5, "bodies[0].layer", "must be a whole number"),
    ([*BODY, "name"], 3, "bodies[0].name", "must be a text in quotes. Got: 3"),
    ([*BODY, "material"], {"preset": "hiar"}, "bodies[0].material.preset", "one of hair, ribbon, cloth, leaf, jelly."),
    ([*BODY, "material"], {"preset": "hiar"}, "bodies[0].material.preset", "Got: \"hiar\" (did you mean 'hair'?)"),
    ([*BODY, "material"], {"youngs_modulus": 0}, "bodies[0].material.youngs_modulus", "above 0 density side^2/s^2"),
    ([*BODY, "material"], {"poisson_ratio": 0.5}, "bodies[0].material.poisson_ratio", "must be below 0.5. Got: 0.5"),
    ([*BODY, "material"], {"density": -1}, "bodies[0].material.density", "must be above 0"),
    ([*BODY, "material"], {"damping": "5"}, "bodies[0].material.damping", 'must be a number. Got: "5"'),
    ([*BODY, "material"], {"sway_frequency": 0}, "bodies[0].material.sway_frequency", "at least 0.001 Hz"),
    ([*BODY, "material"], {"mu": 0, "lambda": 1}, "bodies[0].material.mu", "above 0 density side^2/s^2. Got: 0"),
    ([*BODY, "material"], {"mu": 1, "lambda": -1}, "bodies[0].material.lambda", "at least 0 density side^2/s^2"),
    ([*BODY, "material"], {"mu": 1}, "bodies[0].material.lambda", "must be given together with mu. Got: mu alone"),
    ([*BODY, "material"], {"lambda": 0}, "bodies[0].material.mu", "must be given together with lambda"),
    ([*BODY, "material"], {"lambda_": 1, "mu": 1}, "bodies[0].material.lambda_", "did you mean 'lambda'?"),
    ([*BODY, "material"], {"mu": 1, "lambda": 1, "youngs_modulus": 9}, "bodies[0].material.youngs_modulus", "left out"),
    ([*BODY, "material"], {"mu": 1, "lambda": 1, "poisson_ratio": 0}, "bodies[0].material.poisson_ratio", "left out"),
    ([*BODY, "material"], {"mu": 1, "lambda": 1, "sway_frequency": 2}, "bodies[0].material.sway_frequency", "2 Hz"),
    ([*BODY, "material"], {"stiffness": 3}, "bodies[0].material.stiffness", "did you mean 'root_stiffness'?"),
    ([*BODY, "material"], {"stiffness_scale": [1, 2]}, "bodies[0].material.stiffness_scale", "each of the 1 triangles"),
    ([*BODY, "material"], {"stiffness_scale": [0]}, "bodies[0].material.stiffness_scale[0]", "must be above 0"),
    ([*BODY, "mesh"], {}, "bodies[0].mesh.vertices", "is missing"),
    ([*BODY, "mesh", "vertices", 1], [0], "bodies[0].mesh.vertices[1]", "must be a list of 2 numbers"),
    ([*BODY, "mesh", "vertices", 1, 0], "a", "bodies[0].mesh.vertices[1][0]", "must be a number"),
    ([*BODY, "mesh", "vertices", 1, 0], math.nan, "bodies[0].mesh.vertices[1][0]", "finite"),
    ([*BODY, "mesh", "vertices", 1, 0], 1e7, "bodies[0].mesh.vertices[1][0]", "at most 1000000"),
    ([*BODY, "mesh", "triangles", 0], [0, 1, 3], "bodies[0].mesh.triangles", "must index the 3 vertices"),
    ([*BODY, "mesh", "triangles", 0], [0, 1, 1], "bodies[0].mesh.triangles", "must have an area"),
    ([*BODY, "mesh", "triangles", 0], [0, 1, -1], "bodies[0].mesh.triangles[0][2]", "must be at least 0"),
    ([*BODY, "mesh", "triangles"], [], "bodies[0].mesh.triangles", "must have at least 1 entry"),
    (["strokes", 0, "kind"], "winf", "strokes[0].kind", "Got: \"winf\" (did you mean 'wind'?)"),
    (["strokes", 0, "radius"], -3, "strokes[0].radius", "must be above 0 px. Got: -3"),
    (["strokes", 0, "raduis"], 3, "strokes[0].raduis", "is not known here; did you mean 'radius'?"),
    (["strokes", 0, "path"], [[1, 1]], "strokes[0].path", "at least 2 different points, to give the wind a direction"),
    (["strokes", 0, "path"], [], "strokes[0].path", "must have at least 1 entry. Got: a list of 0"),
    (["strokes", 0, "path", 1], {"x": 1, "y": 2}, "strokes[0].path[1]", "must be a list. Got: an object"),
    (["strokes", 0, "path", 1, 1], 1e300, "strokes[0].path[1][1]", "must be at most 1000000"),
    (["strokes", 0, "speed"], [], "strokes[0].speed", "must be a number. Got: a list of 0"),
    (["strokes", 0, "strength"], math.inf, "strokes[0].strength", "finite. Got: inf"),
    (["strokes", 0, "start"], -1, "strokes[0].start", "must be at least 0 s. Got: -1"),
    (["strokes", 0, "end"], "x", "strokes[0].end", "must be a number or null"),
    (["strokes", 0], {"start": 5, "end": 4}, "strokes[0].end", "must be after start (5.0 s)"),
    (["strokes", 0, "interval"], 0, "strokes[0].interval", "must be at least 0.01 s"),
    (["strokes", 0, "speed"], 1e-9, "strokes[0].interval", "at most 4096 particles"),
    (["strokes"], [{}] * 1001, "strokes", "must have at most 1000 entries"),
    (["rig_points", 0], {}, "rig_points[0].position", "is missing"),
    (["rig_points", 0, "position"], [1, 2, 3], "rig_points[0].position", "must be a list of 2 numbers"),
    (["rig_points", 0, "body"], 1, "rig_points[0].body", "below the number of bodies (1). Got: 1"),
    (["rig_points", 0, "body"], -1, "rig_points[0].body", "must be at least 0"),
    (REGION, {}, "rig_points[0].region.type", "is missing; one of circle, polygon, mask"),
    (REGION, {"type": "disc"}, "rig_points[0].region.type", "one of circle, polygon, mask. Got: \"disc\""),
    (REGION, {"type": "circle"}, "rig_points[0].region.radius", "is missing"),
    (REGION, {"type": "circle", "raduis": 3}, "rig_points[0].region.raduis", "did you mean 'radius'?"),
    (REGION, {"type": "circle", "radius": 0}, "rig_points[0].region.radius", "must be above 0 px. Got: 0"),
    (REGION, {"type": "polygon", "points": [[0, 0]] * 2}, "rig_points[0].region.points", "at least 3 entries"),
    (REGION, {**MASK, "runs": [1, 2]}, "rig_points[0].region.runs", "add up to width x height (4). Got: 3"),
    (REGION, {**MASK, "runs": [5, -1]}, "rig_points[0].region.runs[1]", "must be at least 0"),
    (REGION, {**MASK, "width": 0}, "rig_points[0].region.width", "must be at least 1 px"),
    (REGION, {**MASK, "width": 50_000, "height": 50_000}, "rig_points[0].region", "at most 268435456 pixels"),
    (["paint"], [{}], "paint[0].region", "is missing"),
    (["paint"], [{"region": {"type": "circle", "radius": 3}}], "paint[0].region.type", "must be one of polygon, mask"),
    (["paint"], [{"region": MASK, "stiffness": 0}], "paint[0].stiffness", "must be at least 0.001. Got: 0"),
    (["paint"], [{"region": MASK, "body": 1}], "paint[0].body", "below the number of bodies (1). Got: 1"),
    (["paint"], [{"region": {**MASK, "width": 50_000, "height": 50_000}}], "paint[0].region", "at most 268435456"),
    (["query_points"], [{"x": 1}], "query_points[0].y", "is missing"),
    (["query_points"], [{"x": 1, "y": math.nan}], "query_points[0].y", "finite"),
    (["query_points"], [{"x": 1, "y": 2, "positive": 1}], "query_points[0].positive", "must be true or false"),
    (["query_points"], [[1, 2]], "query_points[0]", "must be an object"),
    (MOTION, {"type": "waev"}, "rig_points[0].motion.type", "did you mean 'wave'?"),
    (MOTION, {"type": "pinned", "radius": 1}, "rig_points[0].motion.radius", "is not known here; known are type"),
    (MOTION, {"type": "wave", "period": 0}, "rig_points[0].motion.period", "must be at least 0.01 s"),
    (MOTION, {"type": "wave", "direction": [0, 0]}, "rig_points[0].motion.direction", "other than (0, 0)"),
    (MOTION, {"type": "path", "times": [0, 0], "points": [[0, 0]] * 2}, "rig_points[0].motion.times", "increasing"),
    (MOTION, {"type": "path", "times": [0, 1, 2], "points": [[0, 0]] * 2}, "rig_points[0].motion.times", "one per"),
    (MOTION, {"type": "path", "times": [-1, 1], "points": [[0, 0]] * 2}, "rig_points[0].motion.times[0]", "at least 0"),
]  # fmt: skip


@pytest.mark.parametrize(("keys", "value", "path", "words"), WRONG)
def test_wrong_values_name_their_path(keys: list[str | int], value: object, path: str, words: str) -> None:
    scene_from_dict(GOOD)
    with pytest.raises(SceneError) as caught:
        scene_from_dict(edited(keys, value))
    assert caught.value.path == path
    assert str(caught.value).startswith(f"{path}: ")
    assert words in str(caught.value)


def places(part: Any, keys: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Every place in a document."""
    entries = part.items() if isinstance(part, dict) else enumerate(part) if isinstance(part, list) else ()
    return [keys] * bool(keys) + [place for key, entry in entries for place in places(entry, (*keys, key))]


anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=3) | st.sampled_from(["mask", "wave"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(["type", "radius", "x"]), inner),
    max_leaves=4,
)


@settings(deadline=None, max_examples=400)
@given(place=st.sampled_from(places(GOOD)), value=anything)
def test_whatever_stands_anywhere_is_a_scene_or_a_scene_error(place: tuple[str | int, ...], value: object) -> None:
    data = edited(list(place), value)
    try:
        scene = scene_from_dict(data)
    except SceneError:
        return
    assert_same(loads(dumps(scene)), scene)


ODD = [
    -1e7,
    1e7,
    -1,
    0,
    0.5,
    1,
    2.0,
    99,
    10**400,
    math.nan,
    math.inf,
    True,
    None,
    "",
    "wave",
    [],
    [[1, 2]],
    {},
    {"x": 1},
]


@pytest.mark.parametrize("value", ODD, ids=lambda value: f"{value!r:.12}")
def test_the_quick_check_lets_nothing_pass_that_the_schema_does_not(value: object) -> None:
    published = jsonschema.Draft202012Validator(scene_schema())
    for place in places(GOOD):
        data = edited(list(place), value)
        if is_right(data):
            assert published.is_valid(data), place
            json.dumps(data, allow_nan=False)


@pytest.mark.parametrize("data", [GOOD, ACTING, BARE])
def test_the_quick_check_knows_right_documents(data: dict[str, Any]) -> None:
    assert is_right(json.loads(json.dumps(data)))


@pytest.mark.parametrize("key", ["version", "width", "height"])
def test_what_must_be_there(key: str) -> None:
    with pytest.raises(SceneError, match=f"^{key}: is missing"):
        scene_from_dict({name: value for name, value in GOOD.items() if name != key})


def test_first_of_several_wrong_values_is_named() -> None:
    data = {**GOOD, "strokes": [{"radius": 1}] * 10 + [{"radius": -1}, {"speed": -1}], "rig_points": 3}
    with pytest.raises(SceneError, match="rig_points"):
        scene_from_dict(data)
    with pytest.raises(SceneError, match=r"^strokes\[10\]\.radius"):
        scene_from_dict({**data, "rig_points": []})


@pytest.mark.parametrize(
    ("text", "path", "words"),
    [
        ('{"version": 1,\n "width": }', "", "not JSON: line 2, column 11"),
        ("", "", "not JSON: line 1, column 1"),
        ("[1, 2]", "", "must be an object in braces. Got: a list of 2"),
        ("null", "", "must be an object in braces. Got: null"),
        (b"\xff\xfe", "", "must be UTF-8 text"),
        ("[" * 100_000, "", "nested"),
        ('{"version": 1, "width": ' + "9" * 5000 + "}", "", "number"),
        ('{"version": 1, "width": 2, "width": 3}', "width", "stands twice"),
        ('{"version": 1, "strokes": [{}, {"radius": 2, "radius": 2}]}', "strokes[1].radius", "stands twice"),
        ('{"version": 1, "width": 9, "height": 9, "gravity": [0, NaN]}', "gravity[1]", "finite. Got: nan"),
        ('{"version": 1, "width": 9, "height": 9, "gravity": [1e999, 0]}', "gravity[0]", "finite. Got: inf"),
        ('{"version": 1, "width": 9, "height": 9, "gravity": [0, -Infinity]}', "gravity[1]", "finite. Got: -inf"),
        ('{"__class__": "os.system", "version": 1, "width": 9, "height": 9}', "__class__", "is not known here"),
    ],
    ids=str,
)
def test_wrong_texts(text: str | bytes, path: str, words: str) -> None:
    with pytest.raises(SceneError) as caught:
        loads(text)
    assert caught.value.path == path
    assert words in str(caught.value)
    assert len(str(caught.value)) < 400


def test_text_of_any_length_is_refused_before_it_is_read() -> None:
    with pytest.raises(SceneError, match="at most 64 MB"):
        loads(b" " * (limits.MAX_DOCUMENT_BYTES + 1))


HEAD = '{"version": 2, "width": 9, "height": 9, "strokes": ['


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (HEAD + "1," * limits.MAX_DOCUMENT_VALUES + "1]}", "at most 4,200,000 values"),
        (HEAD + "[" * limits.MAX_DOCUMENT_LISTS + "]" * limits.MAX_DOCUMENT_LISTS + "]}", "at most 1,600,000 lists"),
        (HEAD + "{}," * limits.MAX_DOCUMENT_OBJECTS + "{}]}", "at most 100,000 objects"),
        (HEAD + "{" + '"a":1,' * limits.MAX_DOCUMENT_KEYS + '"b":1}]}', "at most 500,000 keys"),
        (HEAD + "9" * limits.MAX_DIGITS + "]}", "at most 1,000 digits a number"),
    ],
    ids=["values", "lists", "objects", "keys", "digits"],
)
@pytest.mark.parametrize("encoded", [False, True])
def test_what_would_fill_the_memory_is_refused_before_it_is_read(text: str, words: str, encoded: bool) -> None:
    given = text.encode() if encoded else text
    tracemalloc.start()
    try:
        with pytest.raises(SceneError, match=words):
            loads(given)
        assert tracemalloc.get_traced_memory()[1] < 200_000
    finally:
        tracemalloc.stop()


def test_what_could_not_be_read_again_is_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_from_dict(GOOD)
    few = partial(json_text.Most, lists=3)
    assert loads(dumps(scene)) is not None
    monkeypatch.setattr(json_text, "_OF_A_SCENE", few())
    with pytest.raises(SceneError, match="at most 3 lists"):
        dumps(scene)


def test_the_place_of_a_repeated_key_is_found_without_a_way_to_every_other() -> None:
    count = 20_000
    text = HEAD + "[[1]]," * count + '{"path": [[{"a": 1, "a": 2}]]}]}'
    with pytest.raises(SceneError, match=rf"^strokes\[{count}\]\.path\[0\]\[0\]\.a: stands twice"):
        loads(text)
    tracemalloc.start()
    try:
        data = [[[1]] for _ in range(count)]
        before = tracemalloc.get_traced_memory()[0]
        json_text._refuse_repeated_keys(data)
        assert tracemalloc.get_traced_memory()[1] - before < 20_000
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("wrong", [math.nan, math.inf, True, "1", None, [1]], ids=str)
@pytest.mark.parametrize("place", [0, 1, 5000, 5999])
def test_a_wrong_value_among_thousands_is_named(wrong: object, place: int) -> None:
    path: list[list[Any]] = [[1, 2.5] for _ in range(6000)]
    path[place][1] = wrong
    data = {**GOOD, "strokes": [{"path": path}]}
    assert not is_right(data)
    with pytest.raises(SceneError, match=rf"^strokes\[0\]\.path\[{place}\]\[1\]: must be a number"):
        scene_from_dict(data)


def test_strokes_together_have_a_limit_of_particles() -> None:
    crowd = {"path": [[0, 0], [400, 0]], "speed": 10, "interval": 0.01}  # 4000 particles
    scene_from_dict({**GOOD, "strokes": [crowd] * 4})
    with pytest.raises(SceneError, match="at most 16384 particles") as caught:
        scene_from_dict({**GOOD, "strokes": [crowd] * 5})
    assert caught.value.path == "strokes"


@pytest.mark.parametrize("first", [True, False])
def test_masks_stand_in_runs(first: bool) -> None:
    mask = np.array([[first, True, True], [False, False, True]])
    scene = Scene((Body(square_mesh()),), rig_points=(RigPoint((0, 0), MaskRegion(mask)),))
    region = scene_to_dict(scene)["rig_points"][0]["region"]
    assert region == {"type": "mask", "width": 3, "height": 2, "runs": [0, 3, 2, 1] if first else [1, 2, 2, 1]}
