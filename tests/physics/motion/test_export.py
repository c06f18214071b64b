"""Motion as JSON and SVG, read back by parsers of their own."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET
from itertools import pairwise

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.motion import Motion, motion_to_json, motion_to_svg
from physanimator.physics.motion.export import motion_to_dict
from physanimator.physics.motion.trails import trails
from physanimator.physics.scene import Body

WIDTH, HEIGHT, FRAMES = 120, 80, 4
SVG = "{http://www.w3.org/2000/svg}"


def ring(cells: int = 8) -> TriangleMesh:
    """A square with a square hole: two outlines."""
    x, y = np.meshgrid(np.linspace(10, 70, cells + 1), np.linspace(10, 70, cells + 1))
    number = np.arange(x.size).reshape(x.shape)
    hole = np.zeros((cells, cells), dtype=bool)
    hole[3:5, 3:5] = True
    corners = (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1])
    a, b, c, d = (part[~hole] for part in corners)
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    used, triangles = np.unique(triangles, return_inverse=True)
    vertices = np.stack([x.reshape(-1), y.reshape(-1)], axis=1)[used]
    return TriangleMesh(vertices, triangles.reshape(-1, 3), WIDTH, HEIGHT)


@pytest.fixture
def motion() -> Motion:
    mesh = ring()
    triangle = TriangleMesh(np.array([[80.0, 10], [110, 10], [95, 40]]), np.array([[0, 1, 2]]), WIDTH, HEIGHT)
    rest = np.concatenate([mesh.vertices, triangle.vertices])
    sway = np.sin(np.arange(FRAMES)[:, None, None] + rest / 30) * 3
    sway -= sway[:1]
    bodies = Body(mesh, layer=1, name="<hair & bow>"), Body(triangle)
    return Motion(bodies, (rest + sway).astype(np.float32), 12.0)


def test_json_holds_the_whole_motion(motion: Motion) -> None:
    read = json.loads(motion_to_json(motion))
    assert read == motion_to_dict(motion)
    assert {key: read[key] for key in ("format", "version", "width", "height", "frame_rate", "frames")} == {
        "format": "physanimator-motion",
        "version": 1,
        "width": WIDTH,
        "height": HEIGHT,
        "frame_rate": 12.0,
        "frames": FRAMES,
    }
    assert [(body["name"], body["layer"]) for body in read["bodies"]] == [("<hair & bow>", 1), ("", 0)]
    for number, body in enumerate(read["bodies"]):
        mesh = motion.bodies[number].mesh
        assert np.array_equal(body["triangles"], mesh.triangles)
        assert np.abs(np.array(body["rest"]) - mesh.vertices).max() <= 0.0005
        assert np.abs(np.array(body["positions"]) - motion.of_body(number)).max() <= 0.00051


def test_rounding_makes_it_shorter(motion: Motion) -> None:
    assert len(motion_to_json(motion, decimals=0)) < len(motion_to_json(motion, decimals=3))
    positions = np.array(motion_to_dict(motion, decimals=1)["bodies"][0]["positions"])
    assert np.abs(positions - motion.of_body(0)).max() <= 0.05001
    with pytest.raises(InvalidInputError, match="decimals must be 0 to 9"):
        motion_to_dict(motion, decimals=-1)


def lines_of(data: str) -> list[np.ndarray]:
    """Points of each line of path data made of M and l."""
    found = []
    for part in data.split("M")[1:]:
        first, steps = part.split("l")
        numbers = np.array([*first.split(), *steps.split()], dtype=float).reshape(-1, 2)
        found.append(np.cumsum(numbers, axis=0) / 10)
    return found


def segments(lines: list[np.ndarray]) -> set[frozenset[tuple[float, ...]]]:
    pairs = [pair for line in lines for pair in pairwise(line)]
    return {frozenset(tuple(np.round(point, 1).tolist()) for point in pair) for pair in pairs}


def test_svg_shows_every_edge_in_every_frame_from_back_to_front(motion: Motion) -> None:
    root = ET.fromstring(motion_to_svg(motion))
    assert root.get("viewBox") == f"0 0 {WIDTH} {HEIGHT}"
    groups = root.findall(f"{SVG}g")
    titles = [group.findtext(f"{SVG}title") for group in groups]
    assert titles == ["part 2", "<hair & bow>"]
    mesh, positions = motion.bodies[0].mesh, motion.of_body(0)
    edges, outline = groups[1].findall(f"{SVG}path")
    for path, expected in ((edges, mesh.edges), (outline, mesh.boundary_edges)):
        animate = path.find(f"{SVG}animate")
        assert animate is not None
        shapes = animate.attrib["values"].split(";")
        assert len(shapes) == FRAMES
        assert path.get("d") == shapes[0]
        assert animate.get("dur") == f"{FRAMES / 12:.6g}s"
        for frame, shape in enumerate(shapes):
            assert len({re.sub(r"[-\d ]+", "#", each) for each in shapes}) == 1  # only numbers change
            ends = np.round(np.round(positions[frame].astype(np.float32) * 10) / 10, 1)[expected]
            assert segments(lines_of(shape)) == {
                frozenset(tuple(np.round(p.astype(float), 1).tolist()) for p in pair) for pair in ends
            }


def test_outlines_are_closed_so_that_they_can_be_filled(motion: Motion) -> None:
    outline = ET.fromstring(motion_to_svg(motion)).findall(f"{SVG}g")[1].findall(f"{SVG}path")[1]
    lines = lines_of(outline.attrib["d"])
    assert len(lines) == 2
    assert all((line[0] == line[-1]).all() for line in lines)
    assert outline.get("fill-rule") == "evenodd"


def test_a_single_frame_is_a_still_picture_with_its_background(motion: Motion) -> None:
    text = motion_to_svg(motion[:1], background='a "b".png')
    root = ET.fromstring(text)
    assert not list(root.iter(f"{SVG}animate"))
    image = root.find(f"{SVG}image")
    assert image is not None
    assert image.get("href") == 'a "b".png'


@pytest.mark.parametrize("cells", [5, 6, 9])
def test_trails_run_along_each_edge_once_and_save_points(cells: int) -> None:
    edges = ring(cells).edges
    lines = trails(edges)
    run = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
    assert len(run) == len(edges)
    assert np.array_equal(np.unique(np.sort(run, axis=1), axis=0), edges)
    assert sum(map(len, lines)) < 1.35 * len(edges)
