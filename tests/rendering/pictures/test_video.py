"""Files that are read back: sizes, times, colours, transparency, and what an interrupted run leaves."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.pictures import FORMATS, check_output, encoding, read_clip, write_animation
from physanimator.rendering.pictures.frame_conversion import converted
from physanimator.rendering.pictures.frame_rates import exact_frame_rate
from physanimator.rendering.pictures.gif import shown_indices
from PIL import Image

WIDTH, HEIGHT = 96, 64
COLOUR = (200, 40, 90)


def clip(count: int = 12, *, width: int = WIDTH, height: int = HEIGHT, alpha: bool = False) -> Iterator[np.ndarray]:
    """A coloured disc that moves 2 px a frame over white; with alpha the disc alone."""
    y, x = np.mgrid[0:height, 0:width]
    for t in range(count):
        frame = np.full((height, width, 4), (255, 255, 255, 0), np.uint8)
        frame[(x - 24 - 2 * t) ** 2 + (y - 32) ** 2 < 16**2] = (*COLOUR, 255)
        yield frame if alpha else frame[..., :3].copy()


@dataclass
class Decoded:
    frames: list[av.VideoFrame]
    size: tuple[int, int]
    codec: str
    pixels: str | None
    colorspace: int
    rate: Fraction | None
    metadata: dict[str, str]


def decoded(path: Path, codec: str | None = None) -> Decoded:
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        if codec is None:
            frames = list(container.decode(stream))
        else:
            context = av.codec.CodecContext.create(codec, "r")
            frames = [frame for packet in container.demux(stream) for frame in context.decode(packet)]
        found = stream.codec_context
        return Decoded(
            frames,
            (found.width, found.height),
            found.name,
            found.pix_fmt,
            int(found.colorspace),
            stream.average_rate,
            {name.lower(): value for name, value in stream.metadata.items()},
        )


def colour_at(frame: av.VideoFrame, x: int, y: int) -> np.ndarray:
    """RGB of one pixel, from the numbers in the file by the formulas of BT.709, limited range."""
    planes = frame.to_ndarray(format="yuv420p").astype(float)
    height, width = frame.height, frame.width
    chroma = planes[height:].reshape(2, height // 2, width // 2)[:, y // 2, x // 2] - 128
    grey, (blue, red) = (planes[y, x] - 16) * 255 / 219, chroma * 255 / 224
    return np.array([grey + 1.5748 * red, grey - 0.1873 * blue - 0.4681 * red, grey + 1.8556 * blue])


def seconds(path: Path) -> list[float]:
    """How long each picture of a file that Pillow reads is shown [s]."""
    with Image.open(path) as picture:
        shown = []
        for index in range(picture.n_frames):
            picture.seek(index)
            picture.load()
            shown.append(picture.info["duration"] / 1000)
        return shown


def pixels_of(path: Path, index: int) -> np.ndarray:
    with Image.open(path) as picture:
        picture.seek(index)
        return np.array(picture.convert("RGBA"))


def test_mp4_plays_in_browsers_and_keeps_colours(tmp_path: Path) -> None:
    path = tmp_path / "clip.mp4"
    write_animation(clip(), path, 24)
    result = decoded(path)
    assert len(result.frames) == 12
    assert result.size == (WIDTH, HEIGHT)
    assert result.codec == "h264"
    assert result.pixels == "yuv420p"
    assert result.colorspace == 1
    assert result.rate == 24
    data = path.read_bytes()
    assert data.index(b"moov") < data.index(b"mdat")
    frame = result.frames[5]
    assert np.abs(colour_at(frame, 34, 32) - COLOUR).max() <= 4
    assert np.abs(colour_at(frame, 4, 4) - 255).max() <= 2


def test_of_large_pictures_fewer_are_held_before_the_first_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(0)

    def held(name: str) -> int:
        folder, before_any = tmp_path / name, []
        folder.mkdir()

        def frames() -> Iterator[np.ndarray]:
            for number in range(60):
                if sum(file.stat().st_size for file in folder.iterdir()) < 1_000:
                    before_any.append(number)
                yield rng.integers(0, 256, (256, 256, 3), dtype=np.uint8)

        write_animation(frames(), folder / "clip.mp4", 24)
        return len(before_any)

    usual = held("usual")
    monkeypatch.setattr(encoding, "_LOOKAHEAD_PIXELS", 4 * 256 * 256)
    assert held("large") <= usual - 10


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="this system cannot keep a process to one processor")
@pytest.mark.parametrize("suffix", FORMATS)
def test_bytes_do_not_depend_on_the_number_of_processors(tmp_path: Path, suffix: str) -> None:
    generator = np.random.default_rng(2)
    still = generator.integers(0, 255, (256, 320, 3), dtype=np.uint8)
    frames = [np.roll(still, 3 * step, axis=1) for step in range(12)]
    every = os.sched_getaffinity(0)
    paths = [tmp_path / f"{name}{suffix}" for name in ("all", "one")]
    write_animation(frames, paths[0], 24.0)
    os.sched_setaffinity(0, {min(every)})
    try:
        write_animation(frames, paths[1], 24.0)
    finally:
        os.sched_setaffinity(0, every)
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_x264_does_without_instructions_that_differ_by_chance(tmp_path: Path) -> None:
    """See ``encoding._alike_everywhere``; of a run in a thousand no test could wait for the difference."""
    level = av.logging.get_level()
    av.logging.set_level(av.logging.VERBOSE)
    try:
        with av.logging.Capture(local=False) as said:
            write_animation([np.zeros((48, 64, 3), np.uint8)], tmp_path / "clip.mp4", 24.0)
    finally:
        av.logging.set_level(level)
    words = [text for _, source, text in said if source == "libx264"]
    assert any("cpu capabilities" in text for text in words)
    assert not any("AVX512" in text or "rror" in text for text in words)
    assert b"threads=1 lookahead_threads=1 " in (tmp_path / "clip.mp4").read_bytes()


@pytest.mark.parametrize(("width", "height"), [(97, 64), (96, 63), (97, 63)])
def test_mp4_of_odd_size_grows_by_its_last_row_or_column(tmp_path: Path, width: int, height: int) -> None:
    path = tmp_path / "odd.mp4"
    frames = [np.full((height, width, 3), 30, np.uint8)] * 3
    write_animation(frames, path, 24)
    result = decoded(path)
    assert result.size == (width + width % 2, height + height % 2)
    assert np.abs(colour_at(result.frames[0], result.size[0] - 1, result.size[1] - 1) - 30).max() <= 3


def test_webm_keeps_alpha_and_odd_size(tmp_path: Path) -> None:
    path = tmp_path / "clip.webm"
    write_animation(clip(width=97, height=63, alpha=True), path, 24)
    result = decoded(path, "libvpx-vp9")
    frames = result.frames
    assert len(frames) == 12
    assert result.metadata["alpha_mode"] == "1"
    assert frames[0].format.name == "yuva420p"
    assert (frames[0].width, frames[0].height) == (97, 63)
    alpha = frames[5].to_ndarray(format="rgba")[..., 3]
    expected = list(clip(width=97, height=63, alpha=True))[5][..., 3]
    assert np.abs(alpha.astype(int) - expected).mean() < 3
    assert alpha[32, 30] > 250
    assert alpha[2, 2] < 5


def soft(width: int, height: int) -> np.ndarray:
    """Colours that change across, and alpha that changes from one corner to the other."""
    y, x = np.mgrid[0:height, 0:width]
    planes = [x * 255 // width, y * 255 // height, np.full_like(x, 90), (x + y) * 255 // (width + height)]
    return np.stack(planes, axis=2).astype(np.uint8)


@pytest.mark.parametrize(("width", "height"), [(96, 64), (97, 63)])
def test_mov_is_prores_4444_with_straight_alpha(tmp_path: Path, width: int, height: int) -> None:
    drawn = soft(width, height)
    write_animation([drawn] * 3, tmp_path / "clip.mov", 24)
    with av.open(str(tmp_path / "clip.mov")) as container:
        stream = container.streams.video[0]
        frames = list(container.decode(stream))
        found = stream.codec_context
        assert (found.name, found.profile, str(found.pix_fmt)[:8]) == ("prores", "4444", "yuva444p")
        tags = (found.colorspace, found.color_primaries, found.color_trc, found.color_range)
        assert [int(each) for each in tags] == [1, 1, 1, 1]
        assert stream.average_rate == 24
    assert len(frames) == 3
    assert (frames[0].width, frames[0].height) == (width, height)
    read = converted(frames[1], format="rgba64le", src_colorspace="ITU709").to_ndarray() / 257
    apart = np.abs(read - drawn)
    assert apart[..., 3].max() <= 0.5
    # Premultiplied, a colour of alpha 64 would be a quarter of what was drawn.
    assert apart[drawn[..., 3] > 0][:, :3].max() <= 2


def test_mov_of_opaque_frames_keeps_all_of_its_colours(tmp_path: Path) -> None:
    drawn = soft(96, 64)[..., :3].copy()
    write_animation([drawn] * 2, tmp_path / "clip.mov", 23.976)
    result = decoded(tmp_path / "clip.mov")
    assert str(result.pixels).startswith("yuv444p")
    assert result.rate == Fraction(24000, 1001)
    assert np.abs(result.frames[0].to_ndarray(format="rgb24").astype(int) - drawn).max() <= 2


def test_webm_of_opaque_frames_has_no_alpha(tmp_path: Path) -> None:
    write_animation(clip(), tmp_path / "clip.webm", 24)
    result = decoded(tmp_path / "clip.webm", "libvpx-vp9")
    assert result.frames[0].format.name == "yuv420p"
    assert "alpha_mode" not in result.metadata


@pytest.mark.parametrize("suffix", [".gif", ".webp", ".apng"])
@pytest.mark.parametrize("alpha", [False, True])
def test_picture_formats_keep_colours_alpha_time_and_loop(tmp_path: Path, suffix: str, alpha: bool) -> None:
    path = tmp_path / f"clip{suffix}"
    write_animation(clip(alpha=alpha), path, 24)
    with Image.open(path) as picture:
        assert picture.size == (WIDTH, HEIGHT)
        assert picture.n_frames == 12
        assert picture.info["loop"] == 0
    assert sum(seconds(path)) == pytest.approx(12 / 24, abs=0.011)
    result = pixels_of(path, 7)
    expected = list(clip(alpha=True))[7]
    inside = expected[..., 3] == 255
    assert np.abs(result[inside][:, :3].astype(int) - COLOUR).mean() < 4
    assert (result[..., 3] == (expected[..., 3] if alpha else 255)).all()


def test_gif_leaves_still_parts_still(tmp_path: Path) -> None:
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    scenery = np.stack([x * 255 // WIDTH, y * 255 // HEIGHT, (x + y) % 255], axis=-1).astype(np.uint8)
    assert len(np.unique(scenery.reshape(-1, 3), axis=0)) > 1000
    frames = [scenery.copy() for _ in range(6)]
    for t, frame in enumerate(frames):
        frame[10:20, 10 + 5 * t : 20 + 5 * t] = COLOUR
    path = tmp_path / "clip.gif"
    write_animation(frames, path, 25)
    first = pixels_of(path, 0)
    for t in range(1, 6):
        assert (pixels_of(path, t)[24:] == first[24:]).all()


def test_gif_does_not_drift_and_skips_what_browsers_would_slow_down() -> None:
    assert list(shown_indices(5, Fraction(25))) == [0, 1, 2, 3, 4]
    shown = list(shown_indices(60, Fraction(60)))
    times = [round(index * 100 / 60) for index in shown]
    assert min(np.diff(times)) >= 2
    assert len(shown) > 30


def test_folder_holds_exact_numbered_pictures(tmp_path: Path) -> None:
    write_animation(clip(3, alpha=True), f"{tmp_path}/frames/", 24)
    names = sorted(entry.name for entry in (tmp_path / "frames").glob("*.png"))
    assert names == ["frame_0000.png", "frame_0001.png", "frame_0002.png"]
    assert (pixels_of(tmp_path / "frames" / "frame_0002.png", 0) == list(clip(3, alpha=True))[2]).all()
    assert [entry.name for entry in tmp_path.iterdir()] == ["frames"]


def test_folder_replaces_an_earlier_clip_and_nothing_else(tmp_path: Path) -> None:
    folder = tmp_path / "frames"
    write_animation(clip(5), f"{folder}/", 24)
    (folder / "notes.txt").write_text("mine")
    write_animation(clip(2), f"{folder}/", 24)
    assert sorted(entry.name for entry in folder.glob("[!.]*")) == ["frame_0000.png", "frame_0001.png", "notes.txt"]


@pytest.mark.parametrize("name", ["clip.mp4", "clip.webm", "clip.gif", "clip.webp", "clip.apng", "clip.mov"])
@pytest.mark.parametrize("stop", [KeyboardInterrupt, RuntimeError])
def test_interrupted_run_leaves_the_earlier_file_alone(tmp_path: Path, name: str, stop: type[BaseException]) -> None:
    def broken() -> Iterator[np.ndarray]:
        yield from clip(4)
        raise stop

    path = tmp_path / name
    path.write_bytes(b"earlier")
    with pytest.raises(stop):
        write_animation(broken(), path, 24)
    assert path.read_bytes() == b"earlier"
    assert [entry.name for entry in tmp_path.iterdir()] == [name]


def test_interrupted_run_leaves_no_folder_and_no_mixture(tmp_path: Path) -> None:
    def broken() -> Iterator[np.ndarray]:
        yield from clip(2)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_animation(broken(), f"{tmp_path}/new/", 24)
    assert list(tmp_path.iterdir()) == []
    write_animation(clip(3), f"{tmp_path}/old/", 24)
    with pytest.raises(KeyboardInterrupt):
        write_animation(broken(), f"{tmp_path}/old/", 24)
    assert sorted(entry.name for entry in (tmp_path / "old").iterdir()) == [
        ".physanimator.json",
        *(f"frame_000{t}.png" for t in range(3)),
    ]


def test_frames_are_encoded_as_they_come(tmp_path: Path) -> None:
    """A clip of unknown length must not pile up in memory: few frames are alive at any time."""
    alive, most = 0, 0

    class Frame(np.ndarray):
        def __del__(self) -> None:
            nonlocal alive
            alive -= 1

    def counted() -> Iterator[np.ndarray]:
        nonlocal alive, most
        for t in range(60):
            frame = np.full((HEIGHT, WIDTH, 3), t, np.uint8).view(Frame)
            alive += 1
            most = max(most, alive)
            yield frame

    write_animation(counted(), tmp_path / "clip.mp4", 24)
    assert most < 10


def test_grey_and_float_frames(tmp_path: Path) -> None:
    write_animation([np.full((8, 8), 0.5, np.float32)], f"{tmp_path}/out/", 24)
    assert (pixels_of(tmp_path / "out" / "frame_0000.png", 0) == (128, 128, 128, 255)).all()


@pytest.mark.parametrize(
    ("given", "exact"),
    [
        (24, Fraction(24)),
        (23.976, Fraction(24000, 1001)),
        (23.98, Fraction(24000, 1001)),
        (29.97, Fraction(30000, 1001)),
        (59.94, Fraction(60000, 1001)),
        (12.5, Fraction(25, 2)),
        (Fraction(24000, 1001), Fraction(24000, 1001)),
    ],
)
def test_exact_frame_rate(given: float | Fraction, exact: Fraction) -> None:
    assert exact_frame_rate(given) == exact


def test_fractional_rate_reaches_the_file(tmp_path: Path) -> None:
    write_animation(clip(), tmp_path / "clip.mp4", 23.976)
    assert decoded(tmp_path / "clip.mp4").rate == Fraction(24000, 1001)


@pytest.mark.parametrize(
    ("name", "alpha", "words"),
    [
        ("clip.avi", False, r"must end in \.mp4, \.webm, \.gif"),
        ("clip", False, r"must end in \.mp4"),
        ("clip.png", False, r"'/' for a folder"),
        ("clip.mp4", True, r"with transparency must end in \.webm"),
        ("missing/clip.mp4", False, "folder for .* must exist"),
        ("missing/frames/", False, "folder for .* must exist"),
        ("there", False, r"must end in '/'"),
        ("file/", False, "must be a folder"),
    ],
)
def test_bad_output_is_refused_before_any_frame(tmp_path: Path, name: str, alpha: bool, words: str) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "file").touch()
    with pytest.raises(InvalidInputError, match=words):
        check_output(f"{tmp_path}/{name}", alpha=alpha)


@pytest.mark.parametrize("name", [*(f"clip{suffix}" for suffix in FORMATS), "CLIP.MP4", "frames/"])
def test_good_output_is_accepted_and_not_created(tmp_path: Path, name: str) -> None:
    check_output(f"{tmp_path}/{name}")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("frames", "words"),
    [
        ([], "at least one frame"),
        ([np.zeros((8, 8, 3), np.uint8), np.zeros((8, 9, 3), np.uint8)], "frame 1 must have the shape of the first"),
        ([np.zeros((8, 8, 2), np.uint8)], r"frame 0 must have shape"),
    ],
)
def test_bad_frames(tmp_path: Path, frames: list[np.ndarray], words: str) -> None:
    with pytest.raises(InvalidInputError, match=words):
        write_animation(frames, tmp_path / "clip.mp4", 24)
    assert list(tmp_path.iterdir()) == []


def test_bad_frame_rate(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="frame_rate"):
        write_animation(clip(), tmp_path / "clip.mp4", 0)


@pytest.mark.skipif(os.name == "nt", reason="Windows reads it as a stream of the file girl")
def test_a_name_with_a_colon_is_read_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_animation(clip(3), "girl:v2.mp4", 24)
    assert len(list(read_clip("girl:v2.mp4"))) == 3


@pytest.mark.parametrize("suffix", [".webp", ".apng", ".gif"])
@pytest.mark.parametrize("step", [0, 4], ids=["still", "moving"])
def test_an_opaque_rectangle_on_transparency_stays_one(tmp_path: Path, suffix: str, step: int) -> None:
    sprite = np.zeros((48, 80, 4), np.uint8)
    sprite[12:36, 20:44] = (200, 40, 40, 255)
    path = tmp_path / f"clip{suffix}"
    write_animation([np.roll(sprite, number * step, axis=1) for number in range(3)], path, 12.0)
    with Image.open(path) as picture:
        for number in range(getattr(picture, "n_frames", 1)):
            picture.seek(number)
            alpha = np.asarray(picture.convert("RGBA"))[..., 3]
            assert (alpha == np.roll(sprite, number * step, axis=1)[..., 3]).all()


@pytest.mark.parametrize("suffix", FORMATS)
@pytest.mark.parametrize("width", [96, 97, 98])
def test_the_same_frames_are_the_same_bytes(tmp_path: Path, suffix: str, width: int) -> None:
    """Of widths that are no multiple of eight, threads of FFmpeg's scaler wrote over each other's rows."""
    drawn = soft(width, 63) if FORMATS[suffix].alpha_pixels else soft(width, 63)[..., :3]
    paths = [tmp_path / f"{number}{suffix}" for number in range(8)]
    for path in paths:
        write_animation([drawn] * 3, path, 24)
    assert len({path.read_bytes() for path in paths}) == 1
