"""Clips of our own simulator: they move, can be had again, and their flow is exact."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from command_status import status
from physanimator.rendering.pictures import read_clip, save_image
from physanimator.rendering.training import kept_clips
from physanimator.rendering.training.data_folder import clip_file, sketch_file
from physanimator.rendering.training.simulating import flow_file
from small_videos import panned


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[str]]:
    folder = tmp_path_factory.mktemp("simulated")
    picture = np.full((128, 128, 3), 235, np.uint8)
    picture[8:116, 34:94] = panned(1, 1, 0, size=(60, 108))[0]
    mask = np.zeros((128, 128), np.uint8)
    mask[8:116, 34:94] = 255
    save_image(folder / "girl.png", picture)
    save_image(folder / "hair.png", mask)
    arguments = ["dataset", "simulate", str(folder / "girl.png"), "--mask", str(folder / "hair.png"), "--quiet"]
    arguments += ["--output", str(folder / "data"), "--size", "64x64", "--frames", "24", "--seed", "3"]
    assert status(*arguments, "--clips", "1", "--licence", "mine") == 0
    return folder / "data", arguments


def test_a_clip_has_frames_sketches_and_the_flow_that_moves_them(made: tuple[Path, list[str]]) -> None:
    data, _ = made
    (record,) = kept_clips(data)
    frames = [each.astype(np.float32) for each in read_clip(clip_file(data, record.name))]
    assert len(frames) == len(list(read_clip(sketch_file(data, record.name)))) == record.frames == 24
    assert record.licence == "mine"
    flow = np.load(flow_file(data, record.name))["flow"].astype(np.float32)
    assert flow.shape == (24, 64, 64, 2)
    last = int(np.argmax(np.linalg.norm(flow, axis=3).mean(axis=(1, 2))))
    assert np.linalg.norm(flow[last], axis=2).max() > 1
    y, x = np.mgrid[:64, :64].astype(np.float32)
    seen = cv2.remap(frames[last], x + flow[last, ..., 0], y + flow[last, ..., 1], cv2.INTER_LINEAR)
    inside = np.linalg.norm(flow[last], axis=2) > 1
    assert np.abs(seen - frames[0])[inside].mean() < 0.6 * np.abs(frames[last] - frames[0])[inside].mean()


def test_more_clips_are_added_and_those_that_are_there_stay(made: tuple[Path, list[str]]) -> None:
    data, arguments = made
    (first,) = kept_clips(data)
    before = clip_file(data, first.name).stat().st_mtime_ns
    assert status(*arguments, "--clips", "1") == 0
    assert status(*arguments, "--clips", "2") == 0
    both = kept_clips(data)
    assert len(both) == 2
    assert clip_file(data, first.name).stat().st_mtime_ns == before
    one, two = (next(iter(read_clip(sketch_file(data, each.name)))) for each in both)
    assert both[0].score != both[1].score
    assert one.shape == two.shape
