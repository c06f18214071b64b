"""Pixel art: whole pixels move, and no colour is new."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.composite import PixelArtRenderer, pixel_art_hint
from physanimator.rendering.composite.pixel_blocks import block_size, looks_like_pixel_art
from physanimator.rendering.pictures import write_animation
from PIL import Image

SKY, GRASS, HAIR, LIGHT = (91, 150, 220), (70, 160, 70), (90, 50, 20), (120, 70, 30)


def scene(*, block: int = 1, alpha: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Art of 48 x 40 px with a strand of two colours, and the strand's mask."""
    image = np.zeros((40, 48, 4), np.uint8)
    image[:26], image[26:] = (*SKY, 255), (*GRASS, 255)
    mask = np.zeros((40, 48), np.uint8)
    mask[6:31, 20:25] = 255
    mask[31:33, 22:25] = 255
    image[mask > 0] = (*HAIR, 255)
    image[8:30:3, 21] = (*LIGHT, 255)
    if alpha:
        image[image[..., 2] == SKY[2]] = 0
    image = image if alpha else image[..., :3]
    return tuple(np.ascontiguousarray(each.repeat(block, 0).repeat(block, 1)) for each in (image, mask))  # type: ignore[return-value]


def swaying(mesh: TriangleMesh, *, unit: float = 1.0) -> Motion:
    """Bent sideways the further down, by fractions of a pixel; then turned and stretched."""
    rest = mesh.vertices
    depth = (rest[:, 1] - rest[:, 1].min()) / np.ptp(rest[:, 1])
    moved = [rest + np.stack([unit * reach * depth**2, 0 * depth], axis=1) for reach in (0.4, 3.3, 7.7, -6.2)]
    turned = (rest - rest.mean(axis=0)) @ np.array([[0.8, -0.6], [0.6, 0.9]]) + rest.mean(axis=0)
    return Motion((Body(mesh),), np.stack([rest, *moved, turned]).astype(np.float32), 24.0)


def colours(*images: np.ndarray) -> set[tuple[int, ...]]:
    return {tuple(colour) for image in images for colour in np.unique(image.reshape(-1, image.shape[2]), axis=0)}


@pytest.mark.parametrize("block", [1, 2, 5, 8])
@pytest.mark.parametrize("alpha", [False, True])
def test_every_frame_is_made_of_the_picture_s_pixels(block: int, alpha: bool) -> None:
    image, mask = scene(block=block, alpha=alpha)
    renderer = PixelArtRenderer(image, [mask], swaying(mesh_from_mask(mask), unit=block))
    frames = [renderer.frame(t) for t in range(len(renderer))]
    assert renderer.block == block
    assert (frames[0] == image).all()
    assert colours(*frames, renderer.plate) <= colours(image)
    assert all(block_size(frame) % block == 0 for frame in frames)
    assert (frames[2] != image).any(axis=2).sum() > 20 * block**2
    for frame, t in zip(frames, range(len(renderer)), strict=True):
        drawn, covered = renderer.frame_and_alpha(t)
        assert (drawn == frame).all()
        assert set(np.unique(covered)) <= {0, 1}
        cut = renderer.cutout(t)
        assert (cut[..., 3] == 255 * covered).all()
        assert (cut[covered > 0][:, :3] == frame[covered > 0][:, :3]).all()
        assert (frame[covered == 0] == renderer.plate[covered == 0]).all()


def test_the_same_art_moves_alike_at_every_size() -> None:
    drawn = []
    for block in (2, 4):
        image, mask = scene(block=block)
        mesh = mesh_from_mask(scene(block=2)[1])
        scaled = TriangleMesh(mesh.vertices * block / 2, mesh.triangles, image.shape[1], image.shape[0])
        renderer = PixelArtRenderer(image, [mask], swaying(scaled, unit=block))
        drawn.append([renderer.frame(t)[::block, ::block] for t in range(len(renderer))])
    for small, large in zip(*drawn, strict=True):
        assert (small != large).any(axis=2).mean() < 0.01


def test_a_strand_stays_whole_and_as_wide() -> None:
    image, mask = scene()
    renderer = PixelArtRenderer(image, [mask], swaying(mesh_from_mask(mask)))
    for t in range(1, 5):
        widths = renderer.alpha(t).sum(axis=1)
        assert (widths[6:31] >= 4).all()
        assert (widths[6:31] <= 6).all()
        starts = renderer.alpha(t)[6:31].argmax(axis=1)
        assert np.abs(np.diff(starts)).max() <= 1  # a staircase without jumps


def test_uncovered_places_show_the_nearest_pixels() -> None:
    image, mask = scene()
    plate = PixelArtRenderer(image, [mask], swaying(mesh_from_mask(mask))).plate
    assert (plate[:26][mask[:26] > 0] == SKY).all()
    assert (plate[27:][mask[27:] > 0] == GRASS).all()


def test_a_part_behind_another_goes_on_beneath_it() -> None:
    image, mask = scene()
    front = np.zeros_like(mask)
    front[15:20, 19:26] = 255
    image[front > 0] = (255, 0, 0)
    meshes = [mesh_from_mask(np.maximum(mask, 0)), mesh_from_mask(front)]
    rest = np.concatenate([mesh.vertices for mesh in meshes])
    step = np.concatenate([np.zeros_like(meshes[0].vertices), np.full_like(meshes[1].vertices, (0, 14.0))])
    bodies = tuple(Body(mesh, layer=number) for number, mesh in enumerate(meshes))
    renderer = PixelArtRenderer(
        image, [mask, front], Motion(bodies, np.stack([rest, rest + step]).astype(np.float32), 24.0)
    )
    assert (renderer.frame(0) == image).all()
    bared = renderer.frame(1)[15:20, 20:25].reshape(-1, 3)
    assert {*map(tuple, bared)} <= {HAIR, LIGHT}


def test_blocks_and_pixel_art_are_told() -> None:
    assert [block_size(scene(block=block)[0]) for block in (1, 2, 3, 8)] == [1, 2, 3, 8]
    assert looks_like_pixel_art(scene(block=8)[0])
    smooth = np.random.default_rng(0).integers(0, 256, (64, 64, 3), dtype=np.uint8)
    assert not looks_like_pixel_art(smooth)
    assert not looks_like_pixel_art(np.kron(np.eye(600, dtype=np.uint8)[..., None], np.ones((1, 1, 3), np.uint8)))
    assert pixel_art_hint(scene()[0], option="--pixel-art")[0].endswith("--pixel-art keeps its pixels hard")


@pytest.mark.parametrize("suffix", [".gif", ".webp", ".apng"])
@pytest.mark.parametrize("alpha", [False, True])
def test_animated_pictures_hold_the_exact_colours(tmp_path: Path, suffix: str, alpha: bool) -> None:
    image, mask = scene(alpha=alpha)
    image[..., 0] += np.arange(48, dtype=np.uint8) % 7 * (image[..., -1] > 0)  # colours close to each other
    renderer = PixelArtRenderer(image, [mask], swaying(mesh_from_mask(mask)))
    frames = [renderer.frame(t) for t in (0, 2, 3, 4, 5)]  # a WebP holds equal ones once
    write_animation(frames, tmp_path / f"art{suffix}", 10, exact=True)
    with Image.open(tmp_path / f"art{suffix}") as clip:
        for number, frame in enumerate(frames):
            clip.seek(number)
            shown = np.array(clip.convert("RGBA"))
            assert (shown[..., :3] == frame[..., :3])[shown[..., 3] > 0].all()
            assert (shown[..., 3] == (frame[..., 3] if alpha else 255)).all()


def test_unusable_input_is_refused() -> None:
    image, mask = scene()
    motion = swaying(mesh_from_mask(mask))
    with pytest.raises(InvalidInputError, match=r"^masks must be one for each"):
        PixelArtRenderer(image, [mask, mask], motion)
    with pytest.raises(InvalidInputError, match=r"^plate must have the image's shape"):
        PixelArtRenderer(image, [mask], motion, plate=image[:-1])
    with pytest.raises(InvalidInputError, match=r"^masks must leave some"):
        PixelArtRenderer(image, [np.ones_like(mask)], swaying(mesh_from_mask(np.ones_like(mask))))
    with pytest.raises(InvalidInputError, match=r"^frame must be 0 to 5. Got: 6"):
        PixelArtRenderer(image, [mask], motion).frame(6)
