"""In-betweens: keyframes stay, known motion is followed, backends say what they lack."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.inbetweens import BACKENDS, Clip, ModelFile, interpolate, interpolation, keyframe_indices

WIDTH, HEIGHT, FRAMES = 160, 120, 11
CORNERS = np.array([[40, 40], [84, 40], [84, 84], [40, 84]], dtype=np.float64)


def grid(corners: NDArray[np.float64] = CORNERS, cells: int = 4) -> TriangleMesh:
    x0, y0 = corners.min(axis=0)
    x1, y1 = corners.max(axis=0)
    xs, ys = np.meshgrid(np.linspace(x0, x1, cells + 1), np.linspace(y0, y1, cells + 1))
    cell = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).reshape(-1)
    right, below, across = cell + 1, cell + cells + 1, cell + cells + 2
    triangles = np.concatenate([np.stack([cell, right, below], 1), np.stack([right, across, below], 1)])
    return TriangleMesh(np.stack([xs, ys], axis=-1).reshape(-1, 2), triangles, WIDTH, HEIGHT)


def rigid(mesh: TriangleMesh, t: float) -> NDArray[np.float64]:
    """Turned by 50 degrees about its middle and moved by 40 px over the whole clip."""
    angle, middle = np.deg2rad(50 * t), mesh.vertices.mean(axis=0)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return (mesh.vertices - middle) @ turn + middle + (40 * t, 10 * t)


def smooth_noise(seed: int, sigma: float) -> NDArray[np.float32]:
    noise = np.random.default_rng(seed).random((HEIGHT * 2, WIDTH * 2, 3)).astype(np.float32)
    noise = cv2.GaussianBlur(noise, (0, 0), sigma)
    return (noise - noise.min()) / np.ptp(noise)


def truth(motion: Motion, frame: int) -> NDArray[np.uint8]:
    """The clip's frame, drawn without the renderers: texture through one affine map, edges by supersampling."""
    scale = 4
    mesh, texture = motion.bodies[0].mesh, smooth_noise(2, 4)[:HEIGHT, :WIDTH]
    now = motion.positions[frame]
    affine, _ = cv2.estimateAffine2D(mesh.vertices - 0.5, now - 0.5)
    body = cv2.warpAffine(texture, affine, (WIDTH, HEIGHT), flags=cv2.INTER_CUBIC)
    outline = now[[0, 4, 24, 20]]
    shape = np.zeros((HEIGHT * scale, WIDTH * scale), np.uint8)
    cv2.fillPoly(shape, [np.rint(outline * scale - 0.5).astype(np.int32)], 255)
    alpha = cv2.resize(shape, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)[..., None] / 255
    picture = alpha * body + (1 - alpha) * smooth_noise(3, 3)[:HEIGHT, :WIDTH]
    return np.rint(np.clip(picture, 0, 1) * 255).astype(np.uint8)


@pytest.fixture(scope="module")
def motion() -> Motion:
    mesh = grid()
    return Motion((Body(mesh),), np.stack([rigid(mesh, f / (FRAMES - 1)) for f in range(FRAMES)]), 24.0)


@pytest.fixture(scope="module")
def frames(motion: Motion) -> list[NDArray[np.uint8]]:
    return [truth(motion, frame) for frame in range(FRAMES)]


def psnr(a: NDArray[Any], b: NDArray[Any]) -> float:
    error = np.mean((a.astype(np.float64) - b.astype(np.float64)) ** 2)
    return float(10 * np.log10(255**2 / max(error, 1e-12)))


def test_keyframes_may_be_listed() -> None:
    assert keyframe_indices(31, at=[12, 5, 12]) == [5, 12]
    for wrong in (31, -1, 1.5):
        with pytest.raises(InvalidInputError, match="frame numbers from 0 to 30"):
            keyframe_indices(31, at=[wrong])  # type: ignore[list-item]


def test_keyframes_are_every_nth_and_the_last() -> None:
    assert keyframe_indices(31, 15) == [0, 15, 30]
    assert keyframe_indices(40, 15) == [0, 15, 30, 39]
    assert keyframe_indices(1, 15) == [0]
    assert keyframe_indices(5, 1) == [0, 1, 2, 3, 4]
    assert keyframe_indices(46) == [0, 15, 30, 45]


@pytest.mark.parametrize("backend", ["motion", "flow", "blend"])
@pytest.mark.parametrize("kind", [np.uint8, np.float32])
def test_keyframes_come_out_unchanged(
    backend: str, kind: type, motion: Motion, frames: list[NDArray[np.uint8]]
) -> None:
    indices = [2, 5, 10]
    scale = 1 if kind is np.uint8 else np.float32(1 / 255)
    keyframes = [frames[k].astype(kind) * kind(scale) for k in indices]
    seen: list[tuple[int, int]] = []
    result = list(
        interpolate(keyframes, indices, backend=backend, motion=motion, progress=lambda *done: seen.append(done))
    )
    assert len(result) == 9
    for keyframe, index in zip(keyframes, indices, strict=True):
        np.testing.assert_array_equal(result[index - 2], keyframe)
    assert {(frame.shape, frame.dtype) for frame in result} == {(keyframes[0].shape, keyframes[0].dtype)}
    assert seen == [(k, 9) for k in range(1, 10)]


@pytest.mark.parametrize("with_mask", [False, True])
def test_known_motion_beats_a_cross_dissolve_by_far(
    with_mask: bool, motion: Motion, frames: list[NDArray[np.uint8]]
) -> None:
    indices = [0, 10]
    keyframes = [frames[k] for k in indices]
    mask = np.zeros((HEIGHT, WIDTH), np.float32)
    mask[40:84, 40:84] = 1
    masks = [mask] if with_mask else []
    ours = list(interpolate(keyframes, indices, motion=motion, masks=masks))
    dissolved = list(interpolate(keyframes, indices, backend="blend"))
    for frame in range(1, 10):
        assert psnr(ours[frame], frames[frame]) > 32
        assert psnr(ours[frame], frames[frame]) > psnr(dissolved[frame], frames[frame]) + 8


def test_background_that_neither_keyframe_shows_comes_from_another(
    motion: Motion, frames: list[NDArray[np.uint8]]
) -> None:
    mesh = motion.bodies[0].mesh
    place = [0, 0, 40, 0, 0, 40]  # away and back between two keyframes
    there_and_back = Motion((Body(mesh),), np.stack([mesh.vertices + np.array([dx, 0]) for dx in place]), 24.0)
    truths = [truth(there_and_back, frame) for frame in range(6)]
    result = list(interpolate([truths[0], truths[4], truths[5]], [0, 4, 5], motion=there_and_back))
    assert psnr(result[2], truths[2]) > 32


def test_a_body_in_front_hides_another_in_one_keyframe() -> None:
    back, front = grid(), grid(CORNERS + np.array([44, 0]))
    bodies = (Body(back, layer=0), Body(front, layer=1))
    steps = [0, -22, -44]  # the front body comes to lie over the one behind
    positions = np.stack([np.concatenate([back.vertices, front.vertices + np.array([dx, 0])]) for dx in steps])
    motion = Motion(bodies, positions, 24.0)
    colours = {"ground": (0, 0, 255), "back": (255, 0, 0), "front": (0, 255, 0)}

    def drawn(dx: int) -> NDArray[np.uint8]:
        picture = np.full((HEIGHT, WIDTH, 3), colours["ground"], np.uint8)
        picture[40:84, 40:84] = colours["back"]
        picture[40:84, 84 + dx : 128 + dx] = colours["front"]
        return picture

    middle = list(interpolate([drawn(0), drawn(-44)], [0, 2], motion=motion))[1]
    away = np.ones((HEIGHT, WIDTH), bool)
    for x in (40, 62, 84, 106, 128):
        away[:, x - 3 : x + 3] = False
    away[[*range(37, 43), *range(81, 87)]] = False
    np.testing.assert_array_equal(middle[away], drawn(-22)[away])


def test_a_body_that_changes_its_colour_fades_with_time() -> None:
    mesh = grid()
    motion = Motion((Body(mesh),), np.stack([mesh.vertices + np.array([4 * f, 0]) for f in range(5)]), 24.0)
    keyframes = []
    for dx, colour in ((0, (200, 0, 0)), (16, (0, 0, 200))):
        picture = np.full((HEIGHT, WIDTH, 3), 90, np.uint8)
        picture[40:84, 40 + dx : 84 + dx] = colour
        keyframes.append(picture)
    result = list(interpolate(keyframes, [0, 4], motion=motion))
    assert [tuple(result[f][60, 62 + 4 * f]) for f in range(5)] == [
        (200, 0, 0),
        (150, 0, 50),
        (100, 0, 100),
        (50, 0, 150),
        (0, 0, 200),
    ]


def test_keyframes_of_another_size_than_the_drawing(motion: Motion, frames: list[NDArray[np.uint8]]) -> None:
    half = [cv2.resize(frame, (WIDTH // 2, HEIGHT // 2), interpolation=cv2.INTER_AREA) for frame in frames]
    result = list(interpolate([half[0], half[10]], [0, 10], motion=motion))
    assert psnr(result[5], half[5]) > 28


def test_flow_follows_a_shift_that_nobody_told_it() -> None:
    wide = np.rint(smooth_noise(5, 2) * 255).astype(np.uint8)
    first, middle, last = (wide[20 : 20 + HEIGHT, x : x + WIDTH] for x in (20, 24, 28))
    followed = list(interpolate([first, last], [0, 2], backend="flow"))[1]
    dissolved = list(interpolate([first, last], [0, 2], backend="blend"))[1]
    assert psnr(followed[10:-10, 10:-10], middle[10:-10, 10:-10]) > 32
    assert psnr(followed, middle) > psnr(dissolved, middle) + 6


def test_flow_follows_a_thing_over_a_still_background() -> None:
    ground, thing = (np.rint(smooth_noise(seed, 4) * 255).astype(np.uint8) for seed in (6, 7))

    def drawn(dx: int) -> NDArray[np.uint8]:
        picture = ground[:HEIGHT, :WIDTH].copy()
        picture[40:80, 50 + dx : 90 + dx] = thing[40:80, 50:90]
        return picture

    followed = list(interpolate([drawn(0), drawn(8)], [0, 2], backend="flow"))[1]
    dissolved = list(interpolate([drawn(0), drawn(8)], [0, 2], backend="blend"))[1]
    assert psnr(followed, drawn(4)) > psnr(dissolved, drawn(4)) + 6
    still = np.ones((HEIGHT, WIDTH), bool)
    still[20:100, 30:120] = False
    assert np.abs(followed.astype(int) - drawn(4))[still].max() <= 2


def test_flow_leaves_what_stands_still_as_it_is() -> None:
    """Lone marks beside a part that is drawn anew: what flow is found there must not take them along."""
    random = np.random.default_rng(3)
    marks = np.full((240, 400, 3), 120, np.uint8)
    marks[random.integers(0, 240, 40), random.integers(200, 400, 40)] = 255
    keyframes = [marks.copy(), marks.copy()]
    for keyframe in keyframes:
        keyframe[:, :180] = cv2.resize(random.integers(0, 256, (30, 24, 3), np.uint8), (180, 240))
    for frame in list(interpolate(keyframes, [0, 4], backend="flow"))[1:4]:
        np.testing.assert_array_equal(frame[:, 200:], marks[:, 200:])


def test_flow_that_finds_nothing_alike_fades() -> None:
    """Two pictures without anything in common: what flow is found between them is worth no more than half."""
    first, last = (np.rint(smooth_noise(seed, 3) * 255).astype(np.uint8)[:HEIGHT, :WIDTH] for seed in (8, 9))
    followed, dissolved = (list(interpolate([first, last], [0, 2], backend=each))[1] for each in ("flow", "blend"))
    blended = ((first.astype(int) + last) / 2 - dissolved).std()
    assert blended < 1
    assert (followed.astype(int) - dissolved).std() < 0.6 * (first.astype(int) - dissolved).std()


@pytest.mark.parametrize(("gap", "follows"), [(2, True), (4, True), (5, False), (16, False)])
def test_flow_fades_keyframes_that_are_far_apart(gap: int, follows: bool) -> None:
    wide = np.rint(smooth_noise(5, 2) * 255).astype(np.uint8)
    keyframes = [wide[20 : 20 + HEIGHT, x : x + WIDTH] for x in (20, 28)]
    followed, dissolved = (list(interpolate(keyframes, [0, gap], backend=each)) for each in ("flow", "blend"))
    assert (np.abs(np.stack(followed).astype(int) - dissolved).max() > 20) == follows


def test_flow_is_nearer_than_fading_where_a_swing_is_short() -> None:
    """A leaf that swings on an arc: along the flow while frames are few, and never worse when they are many."""
    ground, leaf = (np.rint(smooth_noise(seed, 4) * 255).astype(np.uint8)[:HEIGHT, :WIDTH] for seed in (10, 11))

    def drawn(frame: int) -> NDArray[np.uint8]:
        angle = 40 * np.sin(frame * 2 * np.pi / 24)
        shape = np.zeros((HEIGHT, WIDTH), np.uint8)
        cv2.ellipse(shape, (WIDTH // 2, HEIGHT // 2), (12, 40), 0, 0, 360, 255, -1)
        turn = cv2.getRotationMatrix2D((WIDTH / 2, 10.0), angle, 1.0)
        turned, mask = (cv2.warpAffine(each, turn, (WIDTH, HEIGHT)) for each in (leaf, shape))
        return np.where(mask[..., None] > 127, turned, ground)

    for gap in range(2, 17):
        truth = [drawn(frame) for frame in range(gap + 1)]
        found = {}
        for backend in ("flow", "blend"):
            frames = list(interpolate([truth[0], truth[gap]], [0, gap], backend=backend))
            found[backend] = np.mean([psnr(a, b) for a, b in zip(frames[1:-1], truth[1:-1], strict=True)])
        assert found["flow"] > found["blend"] + (0.5 if gap == 2 else -0.01), gap


def test_without_a_motion_the_default_is_flow(frames: list[NDArray[np.uint8]]) -> None:
    keyframes, indices = [frames[0], frames[2]], [0, 2]
    default = list(interpolate(keyframes, indices))
    np.testing.assert_array_equal(default[1], list(interpolate(keyframes, indices, backend="flow"))[1])


def test_one_keyframe_is_one_frame(frames: list[NDArray[np.uint8]]) -> None:
    np.testing.assert_array_equal(list(interpolate([frames[0]], [0])), [frames[0]])


class NeedsFiles:
    name = "weighty"
    description = "A backend with two files"
    requires = (ModelFile("a.safetensors", "checkpoints", "example.org"), ModelFile("b.safetensors", "controlnet"))

    def in_betweens(self, clip: Clip, number: int) -> Iterator[NDArray[Any]]:
        assert clip.files["a.safetensors"] == Path("/models/a.safetensors")
        for _ in clip.times(number):
            yield clip.keyframes[number]


def test_a_backend_names_the_files_it_lacks_and_works_with_them(
    monkeypatch: pytest.MonkeyPatch, frames: list[NDArray[np.uint8]]
) -> None:
    monkeypatch.setitem(interpolation.BACKENDS, "weighty", NeedsFiles())
    keyframes, indices = [frames[0], frames[3]], [0, 3]
    missing = r"'weighty' needs files that are missing: models/checkpoints/a.safetensors \(from example.org\)"
    with pytest.raises(InvalidInputError, match=missing + ", models/controlnet/b.safetensors"):
        interpolate(keyframes, indices, backend="weighty")
    with pytest.raises(InvalidInputError, match=r"missing: models/controlnet/b.safetensors"):
        interpolate(keyframes, indices, backend="weighty", find_file=lambda f: Path("/x") if "a" in f.name[0] else None)
    found = interpolate(keyframes, indices, backend="weighty", find_file=lambda f: Path("/models") / f.name)
    assert len(list(found)) == 4


def test_every_backend_describes_itself() -> None:
    assert list(BACKENDS) == ["motion", "flow", "blend"]
    for name, backend in BACKENDS.items():
        assert backend.name == name
        assert backend.description
        assert backend.requires == ()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"backend": "magic"}, "backend must be one of motion, flow, blend. Got: 'magic'"),
        ({"indices": [0]}, r"indices must be one per keyframe \(2\). Got: 1"),
        ({"indices": [5, 5]}, "indices must be increasing"),
        ({"indices": [-3, 5]}, "indices must be increasing frame numbers from 0"),
        ({"indices": [0, 4.5]}, "indices must be increasing frame numbers from 0"),
        ({"indices": [0, 11]}, "indices must be within the motion's frames 0 to 10"),
        ({"keyframes": []}, "keyframes must be at least one"),
        ({"masks": [0, 0]}, r"masks must be none or one per body \(1\)"),
        ({"keyframes": [np.zeros((4, 4, 3)), np.zeros((4, 5, 3))]}, "keyframes must be of one size and type"),
    ],
)
def test_bad_input_raises_at_once(
    changes: dict[str, Any], message: str, motion: Motion, frames: list[NDArray[np.uint8]]
) -> None:
    arguments: dict[str, Any] = {"keyframes": frames[:2], "indices": [0, 1], "motion": motion, **changes}
    with pytest.raises(InvalidInputError, match=message):
        interpolate(arguments.pop("keyframes"), arguments.pop("indices"), **arguments)


@pytest.mark.parametrize(("count", "every"), [(0, 15), (10, 0)])
def test_bad_keyframe_plans(count: int, every: int) -> None:
    with pytest.raises(InvalidInputError, match="must be at least 1 frame"):
        keyframe_indices(count, every)


@pytest.mark.parametrize("backend", ["motion", "blend", "flow"])
@pytest.mark.parametrize("dtype", [np.uint8, np.float32])
def test_in_betweens_of_transparent_keyframes_mix_no_hidden_colours(motion: Motion, backend: str, dtype: type) -> None:
    indices = [0, 3, 6]
    keyframes = []
    for frame in indices:
        image = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
        image[..., :3] = (255, 0, 255)  # hidden
        corners = np.rint(motion.positions[frame][[0, 4, 24, 20]] - 0.5).astype(np.int32)
        cv2.fillPoly(image, [corners], (40, 200, 60, 255))
        keyframes.append(image if dtype == np.uint8 else image.astype(np.float32) / 255)
    drawn = list(interpolate(keyframes, indices, backend=backend, motion=motion))
    assert all((drawn[index] == keyframe).all() for index, keyframe in zip(indices, keyframes, strict=True))
    for frame in (1, 2, 4, 5):
        shown = drawn[frame].astype(np.float64) * (1 if dtype == np.uint8 else 255)
        seen = shown[..., 3] > 20
        assert drawn[frame].dtype == dtype
        assert seen.sum() > 1500
        assert np.abs(shown[seen][:, :3] - (40, 200, 60)).max() <= 8


def test_a_clip_may_begin_with_a_later_keyframe() -> None:
    dark, light = np.zeros((8, 8, 3), np.uint8), np.full((8, 8, 3), 200, np.uint8)
    frames = list(interpolate([dark, light], [3, 7], backend="blend"))
    assert levels(frames) == [0, 50, 100, 150, 200]


def levels(frames: Iterable[NDArray[Any]]) -> list[int]:
    return [int(frame[0, 0, 0]) for frame in frames]


@pytest.mark.parametrize("channels", [3, 4])
@pytest.mark.parametrize("backend", list(BACKENDS))
def test_frames_around_the_keyframes_stay_as_given(motion: Motion, backend: str, channels: int) -> None:
    random = np.random.default_rng(8)
    given = list(random.integers(0, 256, (FRAMES, HEIGHT, WIDTH, channels), dtype=np.uint8))
    seen: list[tuple[int, int]] = []
    drawn = list(
        interpolate(
            [given[3], given[6]],
            [3, 6],
            backend=backend,
            motion=motion,
            before=given[:3],
            after=given[7:],
            progress=lambda *now: seen.append(now),
        )
    )
    assert seen == [(done, FRAMES) for done in range(1, FRAMES + 1)]
    for number in (0, 1, 2, 3, 6, 7, 8, 9, 10):
        np.testing.assert_array_equal(drawn[number], given[number])
    for number in (4, 5):
        assert (drawn[number] != given[number]).any()


def test_frames_around_the_keyframes_must_be_like_them() -> None:
    dark = np.zeros((8, 8, 3), np.uint8)
    assert levels(interpolate([dark, dark + 200], [3, 5], before=[dark + 9], after=[dark + 7])) == [9, 0, 100, 200, 7]
    with pytest.raises(InvalidInputError, match="before must be of the keyframes' size and type"):
        interpolate([dark], [1], before=[np.zeros((8, 9, 3), np.uint8)])
    with pytest.raises(InvalidInputError, match="after must be of the keyframes' size and type"):
        interpolate([dark], [1], after=[np.zeros((8, 8, 3), np.float32)])
