"""Columns by networks, with random weights: known answers, and what is empty or refused without them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from drawn_weights import drawn_weights
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.evaluation.columns import (
    ClipOfPicture,
    ColumnWeights,
    Missing,
    Summary,
    clip_values,
    method_values,
)
from physanimator.rendering.metrics.learned.fid import features_of, frechet_distance, load_inception
from physanimator.rendering.metrics.learned.inception import InceptionFeatures
from physanimator.rendering.metrics.learned.lpips import Lpips
from physanimator.rendering.metrics.learned.videoscore import VideoScore
from physanimator.rendering.networks.checkpoints import build_without_storage


def shapes_of(network: torch.nn.Module) -> dict[str, tuple[int, ...]]:
    return {name: tuple(each.shape) for name, each in network.state_dict().items()}


@pytest.fixture(scope="module")
def inception(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("inception") / "inception.pth"
    torch.save(drawn_weights(shapes_of(build_without_storage(InceptionFeatures))), path)
    return path


@pytest.fixture(scope="module")
def lpips(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("lpips")
    drawn = drawn_weights(shapes_of(build_without_storage(lambda: Lpips("alex"))))
    torch.save({name: each for name, each in drawn.items() if name.startswith("features")}, path / "backbone.pth")
    linear = {f"lin{k}.model.1.weight": drawn[f"lin.{k}.weight"].abs() for k in range(5)}
    torch.save(linear, path / "linear.pth")
    return path


def picture(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).integers(0, 256, (40, 56, 3), dtype=np.uint8)


def still(seed: int, count: int = 3) -> ClipOfPicture:
    return ClipOfPicture([picture(seed)] * count, 24.0, picture(seed))


def darkening(seed: int) -> ClipOfPicture:
    return ClipOfPicture([(picture(seed) * share).astype(np.uint8) for share in (1.0, 0.6)], 24.0, picture(seed))


def fid(clips: list[ClipOfPicture], file: Path) -> Summary:
    found = method_values(clips, weights=ColumnWeights(inception=file, device="cpu"))["fid"]
    assert isinstance(found, Summary)
    return found


def test_without_weights_columns_are_empty_with_the_names_of_the_files() -> None:
    found = clip_values(still(1)) | method_values([still(1)])
    missing = {key: value.name for key, value in found.items() if isinstance(value, Missing)}
    assert missing == {
        "fid": "pt_inception-2015-12-05-6726825d.pth",
        "lpips": "lpips",
        **dict.fromkeys(("vsvq", "vstc", "vsdd", "vsfc"), "VideoScore"),
    }


def test_fid_of_clips_that_stand_still_is_zero(inception: Path) -> None:
    found = fid([still(1, 1), still(2, 3)], inception)
    assert found.mean == pytest.approx(0, abs=1e-6)
    assert found.count == 2


def test_fid_is_that_of_all_frames_to_the_illustrations_of_each(inception: Path) -> None:
    clips, done = [darkening(1), darkening(2), still(2, 1)], []
    found = method_values(
        clips,
        weights=ColumnWeights(inception=inception, device="cpu"),
        progress=lambda count, total: done.append((count, total)),
    )["fid"]
    network = load_inception(inception)
    frames = features_of(network, [frame for clip in clips for frame in clip.frames])
    references = features_of(network, [clip.picture for clip in clips for _ in clip.frames])
    assert isinstance(found, Summary)
    assert found.mean == pytest.approx(frechet_distance(frames, references), rel=1e-4)
    assert found.low is not None
    assert found.low <= found.mean <= found.high
    assert done == [(1, 3), (2, 3), (3, 3)]


def test_fid_of_one_picture_has_no_interval_and_of_one_frame_no_value(inception: Path) -> None:
    found = fid([darkening(1)], inception)
    assert (found.mean is None, found.low, found.high, found.count) == (False, None, None, 1)
    assert method_values([still(1, 1)], weights=ColumnWeights(inception=inception))["fid"] is None


def test_lpips_of_a_clip_that_stands_still_is_zero_and_of_another_is_not(lpips: Path) -> None:
    weights = ColumnWeights(lpips=lpips, device="cpu")
    assert clip_values(still(1), weights=weights)["lpips"] == 0
    found = clip_values(darkening(1), weights=weights)["lpips"]
    assert isinstance(found, float)
    assert found > 1e-3


def test_lpips_of_a_picture_that_is_too_small_is_none(lpips: Path) -> None:
    tiny = picture(1)[:20]
    assert clip_values(ClipOfPicture([tiny], 24.0, tiny), weights=ColumnWeights(lpips=lpips))["lpips"] is None


def test_video_score_fills_four_columns_from_one_look(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("transformers")
    from random_video_score import write_video_score_folder

    folder = write_video_score_folder(tmp_path)
    asked: list[tuple[list[tuple[int, ...]], str]] = []
    grades = VideoScore.grades

    def counted(self: VideoScore, pictures: Any, description: str) -> dict[str, float]:
        asked.append(([each.shape for each in pictures], description))
        return grades(self, pictures, description)

    monkeypatch.setattr(VideoScore, "grades", counted)
    larger = np.zeros((80, 112, 3), np.uint8)
    clip = ClipOfPicture([picture(k) for k in range(30)], 24.0, larger, description="a fox")
    found = clip_values(clip, weights=ColumnWeights(video_score=folder, device="cpu"))
    assert asked == [([(40, 56, 3)] * 10, "a fox")]
    known = grades(VideoScore.load(folder), [picture(k) for k in range(0, 30, 3)], "a fox")
    names = ("visual_quality", "temporal_consistency", "dynamic_degree", "factual_consistency")
    assert [found[key] for key in ("vsvq", "vstc", "vsdd", "vsfc")] == [known[name] for name in names]


def test_weights_are_found_in_a_table_beside_those_of_others(tmp_path: Path) -> None:
    absolute = tmp_path / "elsewhere" / "lpips"
    table = {"inception": "weights/inception.pth", "lpips": str(absolute), "svd": "svd.safetensors", "video_score": ""}
    found = ColumnWeights.of(table, tmp_path, device="cpu")
    assert found == ColumnWeights(tmp_path / "weights/inception.pth", None, absolute, "cpu")
    with pytest.raises(InvalidInputError, match=r"weights\.inception must be the path of a file or folder\. Got: 3"):
        ColumnWeights.of({"inception": 3}, tmp_path)


def test_right_weights_pass_the_check_and_are_told_by_their_hashes(inception: Path, lpips: Path) -> None:
    ColumnWeights().check()
    assert ColumnWeights().hashes() == {}
    weights = ColumnWeights(inception=inception, lpips=lpips)
    weights.check()
    before = weights.hashes()
    assert {key: len(value) for key, value in before.items()} == {"inception": 64, "lpips": 64}
    found = [before["lpips"]]
    for words in ("one", "other"):
        (lpips / "note.txt").write_text(words)
        found.append(weights.hashes()["lpips"])
    (lpips / "note.txt").unlink()
    assert len(set(found)) == 3
    assert weights.hashes() == before


@pytest.mark.parametrize("key", ["inception", "video_score", "lpips"])
def test_weights_that_are_named_and_missing_or_wrong_are_refused_before_any_work(key: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"none is missing\. Wanted: the (file|folder) "):
        ColumnWeights(**{key: tmp_path / "none"}).check()
    wrong = tmp_path / "wrong.pth" if key == "inception" else tmp_path
    torch.save({"weight": torch.zeros(2)}, tmp_path / "wrong.pth")
    with pytest.raises(InvalidInputError, match="Wanted: "):
        ColumnWeights(**{key: wrong}).check()


def test_a_device_that_is_not_there_is_refused_before_any_work(lpips: Path) -> None:
    with pytest.raises(InvalidInputError, match="device must be one that torch finds here"):
        ColumnWeights(lpips=lpips, device="cuda:77").check()
