"""Clips from files: whole ones frame by frame, damaged and foreign ones in one sentence."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.pictures import clip_reading, load_image, load_mask, read_clip, save_image, write_animation
from PIL import Image

KINDS = (".gif", ".webp", ".apng", ".mp4", ".webm", ".mov")


def frames(count: int = 4) -> list[np.ndarray]:
    y, x = np.mgrid[0:48, 0:64]
    return [np.stack([x * 3, y * 5, np.full_like(x, 40 * t)], axis=-1).astype(np.uint8) for t in range(count)]


@pytest.mark.parametrize("place", [f"a{kind}" for kind in KINDS] + ["a/"])
def test_frames_come_back_in_order(tmp_path: Path, place: str) -> None:
    write_animation(frames(), f"{tmp_path}/{place}", 24)
    read = list(read_clip(tmp_path / place))
    assert [frame.shape for frame in read] == [(48, 64, 3)] * 4
    assert [round(float(frame[..., 2].mean()) / 40) for frame in read] == [0, 1, 2, 3]


def damaged(content: bytes, seed: int) -> bytes:
    dice, result = random.Random(seed), bytearray(content)
    if seed % 4 == 0:
        return content[: dice.randrange(len(content))]
    for _ in range(dice.choice((1, 3, 20))):
        place = dice.randrange(dice.choice((64, len(result))))
        result[place] = dice.randrange(256)
    return bytes(result)


@pytest.mark.parametrize("kind", KINDS)
def test_damaged_clips_are_read_or_refused_in_a_sentence(tmp_path: Path, kind: str) -> None:
    path = tmp_path / f"a{kind}"
    write_animation(frames(), path, 24)
    whole, said = path.read_bytes(), []
    for seed in range(40):
        path.write_bytes(damaged(whole, seed))
        try:
            assert all(frame.dtype == np.uint8 for frame in read_clip(path))
        except InvalidInputError as error:
            said.append(str(error))
    assert len(said) > 3
    assert all(each.isprintable() and "clip" in each for each in said)


@pytest.mark.parametrize("kind", ["png", "jpg", "webp", "tif", "gif", "bmp", "tga", "ppm", "ico", "jp2", "qoi"])
def test_damaged_pictures_are_read_or_refused_in_a_sentence(tmp_path: Path, kind: str) -> None:
    path = tmp_path / f"a.{kind}"
    Image.fromarray(frames()[1]).save(path)
    whole, said = path.read_bytes(), []
    for seed in range(25):
        path.write_bytes(damaged(whole, seed))
        for load in (load_image, lambda path: load_mask(path, width=64, height=48)):
            try:
                load(path)
            except InvalidInputError as error:
                said.append(str(error))
    assert said
    assert all(each.isprintable() for each in said)


def test_a_small_file_of_a_huge_picture_is_refused_unread(tmp_path: Path) -> None:
    for name, size in (("a.gif", (31000, 10)), ("a.png", (10000, 10000))):
        Image.new("1", size).save(tmp_path / name)
        with pytest.raises(InvalidInputError, match="at most 67 million pixels"):
            list(read_clip(tmp_path / name))


def test_what_is_no_clip(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "text.mp4").write_text("#EXTM3U\nhttp://localhost:9/a.ts\n")
    for place, message in (
        ("empty", "holds pictures"),
        ("none.mp4", "Got: .*none.mp4"),
        ("text.mp4", "cannot be read"),
    ):
        with pytest.raises(InvalidInputError, match=message):
            list(read_clip(tmp_path / place))
    write_animation(frames(), f"{tmp_path}/a/", 24)
    save_image(tmp_path / "a" / "frame_0009.png", frames()[0][:, 1:])
    with pytest.raises(InvalidInputError, match=r"keep the size of its first frame, 64 x 48 px. Got: 63 x 48 px"):
        list(read_clip(tmp_path / "a"))
    write_animation(frames(), tmp_path / "a.gif", 24)
    monkeypatch.setattr(clip_reading, "MAX_CLIP_FRAMES", 3)
    with pytest.raises(InvalidInputError, match="at most 3 frames"):
        list(read_clip(tmp_path / "a.gif"))
