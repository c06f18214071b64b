"""Which frames are trained on, and what is done to their sketches."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import random_networks
import torch
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.training import ClipRecord, TrainingSettings, kept_clips
from physanimator.rendering.training.data_folder import clip_file, index_file
from physanimator.rendering.training.drawing_lots import numbers_of_process
from physanimator.rendering.training.encoding import encode_for_svd, encode_for_tooncrafter
from physanimator.rendering.training.frame_choice import reference_and_window, strided_window
from physanimator.rendering.training.held_out import split
from physanimator.rendering.training.hints import blurred
from physanimator.rendering.training.lvcd_samples import LVCDSamples
from physanimator.rendering.training.tooncrafter_samples import ToonCrafterSamples
from training_data import write_data

BASE = ClipRecord("clip", "film.mp4", 0.0, 1.0, 24, 24.0, 64, 64, 0.3, True)


def test_a_reference_comes_from_the_earliest_quarter_before_its_run() -> None:
    chance, starts = np.random.default_rng(0), set()
    for _ in range(400):
        reference, *run = reference_and_window(40, 14, chance)
        assert run == list(range(run[0], run[0] + 14))
        assert run[-1] < 40
        assert 0 <= reference < max(run[0] // 4, 1)
        starts.add(run[0])
    assert {1, 26} <= starts


def test_the_shortest_clip_has_one_run() -> None:
    assert reference_and_window(15, 14, np.random.default_rng(0)) == tuple(range(15))
    with pytest.raises(InvalidInputError, match="at least 15 frames"):
        reference_and_window(14, 14, np.random.default_rng(0))


def test_strides_reach_from_one_to_six_where_the_clip_is_long_enough() -> None:
    chance, strides = np.random.default_rng(0), set()
    for _ in range(300):
        frames, stride = strided_window(120, 16, chance)
        assert {b - a for a, b in itertools.pairwise(frames)} == {stride}
        assert frames[-1] < 120
        strides.add(stride)
    assert strides == {1, 2, 3, 4, 5, 6}


def test_windows_begin_where_the_picture_was_looked_at() -> None:
    chance = np.random.default_rng(0)
    assert {strided_window(24, 16, chance, firsts=(0, 8))[0][0] for _ in range(50)} == {0, 8}
    with pytest.raises(InvalidInputError, match="first frame must be at most frame 8"):
        strided_window(24, 16, chance, firsts=(9,))


def test_blur_spreads_a_line_and_leaves_it_where_it_is_zero() -> None:
    line = np.zeros((1, 21, 21), np.float32)
    line[0, :, 10] = 1
    assert np.array_equal(blurred(line, 0), line)
    soft = blurred(line, 2.0)
    assert soft[0, 10, 10] == pytest.approx(1 / (2 * np.sqrt(2 * np.pi)), rel=0.05)
    assert soft.sum() == pytest.approx(line.sum(), rel=1e-3)


def test_processes_share_out_all_samples_and_none_twice() -> None:
    of_two = [list(numbers_of_process(3, 6, batch=2, process=each, processes=2)) for each in (0, 1)]
    taken = sorted(number for process in of_two for batch in process for number in batch)
    assert taken == list(range(12, 24))
    assert list(numbers_of_process(3, 6, batch=4)) == [sorted(a + b) for a, b in zip(*of_two, strict=True)]


def test_clips_stay_on_their_side_when_others_come() -> None:
    def clip(number: int) -> ClipRecord:
        return replace(BASE, name=f"clip {number}")

    few, many = [clip(n) for n in range(20)], [clip(n) for n in range(200)]
    _, out_of_few = split(few, 0.2)
    trained_on, out_of_many = split(many, 0.2)
    assert out_of_few
    assert set(out_of_few) <= set(out_of_many)
    assert not set(trained_on) & set(out_of_many)
    assert len(out_of_many) == pytest.approx(40, abs=15)
    assert [len(each) for each in split(few[:2], 0.01)] == [1, 1]
    assert [len(each) for each in split(few[:1], 0.5)] == [1, 0]


@pytest.fixture(scope="module")
def encoded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("data")
    files = random_networks.write(folder / "networks", "folder")
    data = write_data(folder / "data", clips=2)
    assert encode_for_svd(data, files["svd"]) == 2
    assert encode_for_tooncrafter(data, files["tooncrafter"]) == 2
    assert encode_for_svd(data, files["svd"]) == 0
    return data


def test_blur_touches_the_hints_alone(encoded: Path) -> None:
    clips = kept_clips(encoded)
    sharp = TrainingSettings(least_blur=0, most_blur=0)
    soft = replace(sharp, most_blur=4.0, least_blur=4.0)
    for samples in (LVCDSamples, ToonCrafterSamples):
        name, one = samples(encoded, clips, sharp)[5]
        other_name, other = samples(encoded, clips, soft)[5]
        assert name == other_name
        assert {key for key in one if not torch.equal(one[key], other[key])} == {"hints"}
        assert float(one["hints"].max()) > 0.9
        assert float(other["hints"].max()) < 0.8


def test_blur_is_drawn_anew_for_every_sample(encoded: Path) -> None:
    samples = LVCDSamples(encoded, kept_clips(encoded)[:1], TrainingSettings(least_blur=0, most_blur=6, frames=24))
    darkest = [round(float(samples[number][1]["hints"].max()), 3) for number in range(6)]
    assert len(set(darkest)) == 6


def test_the_same_number_is_the_same_sample_and_another_seed_is_not(encoded: Path) -> None:
    clips = kept_clips(encoded)
    for samples in (LVCDSamples, ToonCrafterSamples):
        one, same = (samples(encoded, clips, TrainingSettings())[7][1] for _ in range(2))
        assert all(torch.equal(one[key], same[key]) for key in one)
        other = samples(encoded, clips, TrainingSettings(seed=1))[7][1]
        assert not torch.equal(one["noise"], other["noise"])


def test_a_share_of_the_samples_is_told_of_a_grey_picture(encoded: Path) -> None:
    clips = kept_clips(encoded)
    kept, dropped = (ToonCrafterSamples(encoded, clips, TrainingSettings(dropped_pictures=share)) for share in (0, 1))
    grey = dropped.shared()["nothing"][0].float()
    assert torch.equal(dropped[0][1]["tokens"], grey)
    assert not torch.equal(kept[0][1]["tokens"], grey)


def test_latents_of_other_frames_are_refused(tmp_path: Path) -> None:
    files = random_networks.write(tmp_path / "networks", "folder")
    data = write_data(tmp_path / "data", clips=2)
    encode_for_svd(data, files["svd"])
    clips = kept_clips(data)
    clip_file(data, "disc_00").write_bytes(clip_file(data, "disc_01").read_bytes())
    with pytest.raises(InvalidInputError, match="clip disc_00 must be encoded again"):
        LVCDSamples(data, clips[:1], TrainingSettings())[0]
    with pytest.raises(InvalidInputError, match="must be encoded first"):
        ToonCrafterSamples(data, clips, TrainingSettings())[0]


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("not JSON", "must be a JSON object on one line"),
        ("[]", "must be a JSON object. Got: list"),
        ('{"name": "a"}', "must tell source"),
        (BASE.as_line().replace('"frames": 24', '"frames": 1e999'), "frames must be"),
        (BASE.as_line().replace('"frames": 24', '"frames": -1'), "frames must be"),
        (BASE.as_line().replace('"score": 0.3', '"score": NaN'), "score must be"),
        ("../../etc/passwd", "must have a name that is a file's"),
        (".hidden", "must have a name that is a file's"),
    ],
)
def test_an_index_that_is_none_of_ours_is_refused(tmp_path: Path, line: str, sentence: str) -> None:
    text = line if line[0] in "n[{" else replace(BASE, name=line).as_line()
    index_file(tmp_path).write_text(text + "\n")
    with pytest.raises(InvalidInputError, match=sentence):
        kept_clips(tmp_path)


def test_of_several_lines_about_a_clip_the_last_counts(tmp_path: Path) -> None:
    dropped = replace(BASE, kept=False, why="too still")
    index_file(tmp_path).write_text(f"{BASE.as_line()}\n{dropped.as_line()}\n")
    with pytest.raises(InvalidInputError, match="must have clips that are kept"):
        kept_clips(tmp_path)
