"""Skeletons and scenes of layers, flat pictures and sprites: opened again, compared with the motion, and drawn."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import trimesh
from drawn_meshes import draw_mesh
from opened_exports import (
    gltf_by_its_format,
    morphed,
    pages_of,
    read_by_node,
    spine_by_its_format,
    spine_by_its_runtime,
)
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask
from physanimator.physics.motion import LoopReport, Motion
from physanimator.physics.scene import Body
from physanimator.rendering.artwork import ArtLayer, Artwork
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.editable import save_renderer_as_gltf, save_renderer_as_spine
from physanimator.rendering.moving_pieces import puppet_of
from physanimator.rendering.pictures import premultiplied
from PIL import Image

WIDTH, HEIGHT, FRAMES, RATE = 128, 96, 41, 24.0
KINDS = ("layers", "flat", "sprite")


def rgba(colour: tuple[int, int, int, int] = (0, 0, 0, 0)) -> np.ndarray:
    return np.full((HEIGHT, WIDTH, 4), colour, np.uint8)


def hair() -> np.ndarray:
    """Two locks of one layer with soft edges, and a speck beside them that their mesh does not reach."""
    fine = np.zeros((4 * HEIGHT, 4 * WIDTH, 4), np.uint8)
    for x in (44, 70):
        cv2.fillPoly(fine, [np.int32([[x, 12], [x + 24, 12], [x + 20, 84], [x + 6, 84]]) * 4], (150, 70, 40, 255))
        cv2.line(fine, (4 * x + 48, 80), (4 * x + 48, 300), (60, 20, 10, 255), 12)
    cv2.rectangle(fine, (176, 48), (376, 96), (150, 70, 40, 255), -1)
    cv2.circle(fine, (460, 200), 16, (150, 70, 40, 255), -1)
    small = cv2.resize(fine.astype(np.float32), (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)
    small[..., :3] *= 255 / np.maximum(small[..., 3:], 1)
    return np.rint(np.clip(small, 0, 255)).astype(np.uint8)


def wall() -> np.ndarray:
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    return np.dstack([200 - y // 2, 210 - x // 4, 230 + 0 * x, 255 + 0 * x]).astype(np.uint8)


def swaying(mesh: TriangleMesh, *, loop: bool = False) -> Motion:
    """A motion with two swings of other speeds, larger further down, that does not begin at rest."""
    rest, t = mesh.vertices, np.arange(FRAMES)[:, None] * 2 * np.pi / FRAMES
    low = np.clip((rest[:, 1] - 20) / 64, 0, 1) ** 1.5
    across = 14 * low * np.sin(t - 2 * low + 0.4) + 3 * low * np.sin(3 * t - rest[:, 0] / 9)
    moves = np.stack([across, 4 * low * np.cos(2 * t)], axis=2)
    report = LoopReport(FRAMES / RATE, FRAMES, 2, 0.0, 0.0) if loop else None
    return Motion((Body(mesh),), (rest + moves).astype(np.float32), RATE, report)


def renderer_of(kind: str, *, loop: bool = False) -> LayeredRenderer:
    lock = hair()
    alone = lock.copy()
    alone[:, 105:] = 0
    motion = swaying(mesh_from_mask(alone[..., 3] / 255, spacing=8), loop=loop)
    if kind == "layers":
        band = rgba()
        band[36:46, 20:110] = (250, 210, 180, 255)
        shade = rgba((120, 120, 160, 0))
        shade[60:80, 30:100, 3] = 140
        layers = (
            ArtLayer("wall", wall()),
            ArtLayer("hair: front/1", lock[4:], top=4, opacity=0.8),
            ArtLayer("band", band),
            ArtLayer("hidden", rgba((255, 0, 0, 255)), visible=False),
            ArtLayer("Band", shade, blend="multiply"),
        )
        return LayeredRenderer.of_artwork(Artwork(WIDTH, HEIGHT, layers), [1], motion)
    share = alone[..., 3:] / 255
    drawn = np.rint(share * alone[..., :3] + (1 - share) * wall()[..., :3])
    picture = np.dstack([drawn, wall()[..., 3]]).astype(np.uint8)
    if kind == "sprite":
        picture[..., 3] = np.where(np.mgrid[0:HEIGHT, 0:WIDTH][1] > 58, alone[..., 3], 255)
    return LayeredRenderer(picture if kind == "sprite" else picture[..., :3].copy(), [alone[..., 3]], motion)


def canvas() -> np.ndarray:
    return np.zeros((HEIGHT, WIDTH, 4), np.float32)


def apart(drawn: np.ndarray, frame: np.ndarray) -> np.ndarray:
    """How far a drawn canvas is from a frame, in levels, shape [h, w]."""
    if frame.shape[2] == 3:
        frame = np.dstack([frame, np.full(frame.shape[:2], 255, np.uint8)])
    return np.abs(drawn - premultiplied(frame)).max(axis=2) * 255


def close(drawn: np.ndarray, frame: np.ndarray) -> None:
    """Bilinear reading is softer than the renderer's, and edges of triangles are not smoothed: nothing else differs."""
    levels = apart(drawn, frame)
    assert levels.mean() < 1.2
    assert np.percentile(levels, 99) < 30
    assert (cv2.erode((levels > 16).astype(np.uint8), np.ones((3, 3))) == 0).all()


Reader = Callable[[Path, list[float]], dict[str, Any]]


@pytest.mark.parametrize("reader", [spine_by_its_format, spine_by_its_runtime])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("tolerance", [0.25, 2.0])
def test_a_skeleton_moves_as_the_motion_does(kind: str, tolerance: float, reader: Reader, tmp_path: Path) -> None:
    renderer = renderer_of(kind)
    save_renderer_as_spine(renderer, tmp_path / "girl", tolerance=tolerance)
    read = reader(tmp_path / "girl", [t / RATE for t in range(FRAMES)])
    assert (read["fps"], read["width"], read["height"], read["x"]) == (RATE, WIDTH, HEIGHT, -WIDTH / 2)
    assert read["duration"] == pytest.approx((FRAMES - 1) / RATE, abs=1e-4)
    (moving,) = (piece for piece in puppet_of(renderer).pieces if piece.mesh is not None)
    pages = pages_of(tmp_path / "girl")
    worst = 0.0
    for t, slots in enumerate(read["frames"]):
        shown = {each["slot"]: each for each in slots}
        vertices = np.array(shown[moving.name]["vertices"]).reshape(-1, 2)
        inside = np.stack([vertices[:, 0] + WIDTH / 2, HEIGHT - vertices[:, 1]], axis=1)
        # Every vertex of the simulated mesh is found again, whatever the order.
        wanted = renderer.motion.of_body(0)[t]
        distance = np.linalg.norm(inside[:, None] - wanted, axis=2).min(axis=0)
        worst = max(worst, float(distance.max()))
        if tolerance < 1 and t in (0, 21):
            drawn = canvas()
            for each in slots:
                points = np.array(each["vertices"]).reshape(-1, 2)
                points = np.stack([points[:, 0] + WIDTH / 2, HEIGHT - points[:, 1]], axis=1).round(3)
                if each["blend"] == 0:
                    places = np.array(each["uvs"]).reshape(-1, 2)
                    draw_mesh(drawn, points, np.reshape(each["triangles"], (-1, 3)), places, pages[each["page"]])
            if kind == "layers":  # the multiplied layer lies over all
                tint = puppet_of(renderer).pieces[-1]
                left, top, across, down = (int(v) for v in tint.box)
                part = drawn[top : top + down, left : left + across]
                share = tint.pixels[..., 3:] / 255
                part[..., :3] *= 1 - share + share * tint.pixels[..., :3] / 255
            close(drawn, renderer.frame(t))
    assert worst <= tolerance + 0.01
    assert tolerance < 1 or worst > 0.3


def test_slots_are_layers_in_their_order(tmp_path: Path) -> None:
    renderer = renderer_of("layers")
    save_renderer_as_spine(renderer, tmp_path / "girl")
    read = spine_by_its_format(tmp_path / "girl", [0.0])
    slots = read["frames"][0]
    assert [each["slot"] for each in slots] == ["wall", "hair: front/1", "band", "Band"]
    assert [each["blend"] for each in slots] == [0, 0, 0, 2]
    assert sorted(file.name for file in (tmp_path / "girl" / "images").iterdir()) == [
        "Band (2).png", "band.png", "hair_ front_1.png", "wall.png"
    ]  # fmt: skip
    mesh = slots[1]
    hull = np.array(mesh["vertices"]).reshape(-1, 2)[: mesh["hull"]]
    assert mesh["hull"] == len(np.unique(hull, axis=0))
    around = np.zeros((HEIGHT, WIDTH), np.uint8)
    cv2.fillPoly(around, [np.rint(np.stack([hull[:, 0] + WIDTH / 2, HEIGHT - hull[:, 1]], axis=1)).astype(np.int32)], 1)
    assert around[30, 50]
    assert around[60, 80]


def test_a_loop_ends_where_it_begins(tmp_path: Path) -> None:
    renderer = renderer_of("flat", loop=True)
    save_renderer_as_spine(renderer, tmp_path / "girl")
    read = spine_by_its_format(tmp_path / "girl", [0.0, FRAMES / RATE])
    assert read["duration"] == pytest.approx(FRAMES / RATE, abs=1e-4)
    first, last = (np.array(frame[1]["vertices"]) for frame in read["frames"])
    assert np.abs(first - last).max() <= 0.02
    save_renderer_as_gltf(renderer, tmp_path / "girl.glb")
    _, meshes = gltf_by_its_format(tmp_path / "girl.glb")
    assert meshes[1]["times"][-1] == pytest.approx(FRAMES / RATE)
    assert np.abs(morphed(meshes[1], 0) - morphed(meshes[1], FRAMES)).max() <= 1e-3
    # A part of a loop is none.
    save_renderer_as_gltf(renderer, tmp_path / "part.glb", first=3)
    _, meshes = gltf_by_its_format(tmp_path / "part.glb")
    assert meshes[1]["times"][-1] == pytest.approx((FRAMES - 4) / RATE)


@pytest.mark.parametrize("other", [False, True])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("tolerance", [0.25, 2.0])
def test_a_scene_moves_as_the_motion_does(kind: str, tolerance: float, other: bool, tmp_path: Path) -> None:
    renderer = renderer_of(kind)
    told = save_renderer_as_gltf(renderer, tmp_path / "girl.glb", tolerance=tolerance)
    document, meshes = gltf_by_its_format(tmp_path / "girl.glb")
    puppet = puppet_of(renderer, blends=("normal",))
    read = read_by_node("@gltf-transform/core", str(tmp_path / "girl.glb")) if other else meshes
    assert [mesh["name"] for mesh in read] == [piece.name for piece in puppet.pieces]
    (number,) = (k for k, piece in enumerate(puppet.pieces) if piece.mesh is not None)
    targets = len(read[number]["targets"])
    assert 0 < targets <= 5  # that many shapes make this motion
    assert f"{targets} morph targets" in told[0]
    assert np.abs(read[number]["weights"]).max() <= 1 + 1e-6
    assert np.allclose(read[number]["times"], np.arange(FRAMES) / RATE)
    moved = puppet.pieces[number].mesh
    assert moved is not None
    worst = 0.0
    for t in range(FRAMES):
        vertices = morphed(read[number], t)
        inside = np.stack([vertices[:, 0] + WIDTH / 2, HEIGHT - vertices[:, 1]], axis=1)
        worst = max(worst, float(np.linalg.norm(inside - moved.positions[t], axis=1).max()))
        near = np.linalg.norm(inside[:, None] - renderer.motion.of_body(0)[t], axis=2).min(axis=0)
        assert near.max() <= tolerance + 0.01
        if not other and tolerance < 1 and t in (0, 21):
            drawn = canvas()
            for k, mesh in enumerate(meshes):
                points = morphed(mesh, t if k == number else 0)
                points = np.stack([points[:, 0] + WIDTH / 2, HEIGHT - points[:, 1]], axis=1).round(3)
                draw_mesh(drawn, points, mesh["triangles"], mesh["places"], puppet.pieces[k].pixels)
            (close_but_for_tint(drawn, renderer, t) if kind == "layers" else close(drawn, renderer.frame(t)))
    assert worst <= tolerance + 1e-3
    assert document["meshes"][number]["extras"]["error_px"] == pytest.approx(worst, abs=2e-3)
    depths = [document["nodes"][k]["translation"][2] for k in range(len(meshes))]
    assert depths == sorted(set(depths))


def close_but_for_tint(drawn: np.ndarray, renderer: LayeredRenderer, t: int) -> None:
    """glTF has no multiply: the layer has the colours that it gives at rest, right where nothing moves below it."""
    levels = apart(drawn, renderer.frame(t))
    assert levels[:58].mean() < 1.2
    still = np.abs(renderer.frame(t).astype(int) - renderer.plate).max(axis=2) == 0
    still &= hair()[..., 3] == 0
    assert levels[still].mean() < 1.2


@pytest.mark.parametrize("kind", KINDS)
def test_a_scene_opens_in_another_library(kind: str, tmp_path: Path) -> None:
    renderer = renderer_of(kind)
    save_renderer_as_gltf(renderer, tmp_path / "girl.glb")
    scene = trimesh.load_scene(tmp_path / "girl.glb")
    puppet = puppet_of(renderer, blends=("normal",))
    for number, piece in enumerate(puppet.pieces):
        matrix, name = scene.graph[piece.name]
        geometry = scene.geometry[name]
        corners = trimesh.transform_points(geometry.vertices, matrix) * HEIGHT
        rest = (
            piece.mesh.rest
            if piece.mesh
            else np.add(np.array([[0, 1], [1, 1], [1, 0], [0, 0]]) * piece.box[2:], piece.box[:2])
        )
        assert (
            np.abs(corners - np.column_stack([puppet.upright(rest), np.full(len(rest), number * HEIGHT / 1000)])).max()
            < 1e-3
        )
        material = geometry.visual.material
        assert material.alphaMode == ("OPAQUE" if piece.opaque else "BLEND")
        assert (np.asarray(material.baseColorTexture.convert("RGBA")) == piece.pixels).all()


@pytest.mark.parametrize("kind", KINDS)
def test_a_scene_is_valid(kind: str, tmp_path: Path) -> None:
    save_renderer_as_gltf(renderer_of(kind), tmp_path / "girl.glb")
    report = read_by_node("gltf-validator", str(tmp_path / "girl.glb"))
    assert (report["issues"]["numErrors"], report["issues"]["numWarnings"]) == (0, 0)
    assert report["info"]["hasMorphTargets"]


@pytest.mark.parametrize("kind", KINDS)
def test_colours_go_on_under_alpha_0(kind: str) -> None:
    """Bilinear reading of straight alpha mixes them in: black would be a dark rim."""
    for piece in puppet_of(renderer_of(kind)).pieces:
        if not piece.opaque:
            beside = (piece.pixels[..., 3] == 0) & (cv2.dilate(piece.pixels[..., 3], np.ones((3, 3))) > 0)
            assert (piece.pixels[beside][:, :3].max(axis=1) > 30).all()


def test_a_glow_wider_than_the_mesh_is_drawn_once() -> None:
    """What squares beyond the mesh carry and what the mesh itself does add up to no seam and no double rim."""
    glowing = hair()
    glowing[:, 105:] = 0
    mesh = mesh_from_mask(glowing[..., 3] / 255, spacing=8)
    distance = cv2.distanceTransform((glowing[..., 3] == 0).astype(np.uint8), cv2.DIST_L2, 5)
    around = (glowing[..., 3] < 255) & (distance < 30)
    glowing[around] = (250, 220, 120, 100)
    art = Artwork(WIDTH, HEIGHT, (ArtLayer("wall", wall()), ArtLayer("hair", glowing)))
    still = Motion((Body(mesh),), mesh.vertices[None].astype(np.float32), RATE)
    renderer = LayeredRenderer.of_artwork(art, [1], still)
    drawn = canvas()
    for piece in puppet_of(renderer).pieces:
        if piece.mesh is None:
            drawn[:] = premultiplied(piece.pixels)
        else:
            draw_mesh(drawn, piece.mesh.rest, piece.mesh.triangles, piece.mesh.places, piece.pixels)
    levels = apart(drawn, renderer.frame(0))
    assert (levels > 8).mean() < 0.01
    assert levels.mean() < 0.5


def test_what_a_format_lacks_is_said(tmp_path: Path) -> None:
    renderer = renderer_of("layers")
    assert len(save_renderer_as_spine(renderer, tmp_path / "girl")) == 1
    _, sentence = save_renderer_as_gltf(renderer, tmp_path / "girl.glb")
    assert sentence == "layer Band has the colours that it gives at rest, because glTF has no mode multiply"


def test_images_for_the_editor_are_what_the_atlas_holds(tmp_path: Path) -> None:
    save_renderer_as_spine(renderer_of("sprite"), tmp_path / "girl")
    (page,) = pages_of(tmp_path / "girl").values()
    atlas = (tmp_path / "girl" / "girl.atlas").read_text("utf-8").splitlines()
    for name, bounds in zip(atlas[3::2], atlas[4::2], strict=False):
        left, top, width, height = map(int, bounds.removeprefix("bounds:").split(","))
        image = np.asarray(Image.open(tmp_path / "girl" / "images" / f"{name}.png").convert("RGBA"))
        assert (page[top : top + height, left : left + width] == image).all()
    assert len(atlas) == 7
