"""VideoScore: the question and the network are the public ones, files are checked, and nothing is fetched."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.metrics.learned import video_score
from physanimator.rendering.metrics.learned.videoscore import (
    DIMENSIONS,
    PROMPT_FILE,
    VideoScore,
    check_video_score,
    frames_looked_at,
)

pytest.importorskip("transformers")
from random_video_score import write_video_score_folder

KNOWN = [0.486, -0.017, 3.044, -2.247, -0.872]
"""What VideoScore's own class gives for these weights and frames: of Mantis 0.0.5, with transformers 4.46."""


def frames(count: int) -> np.ndarray:
    return np.random.default_rng(1).integers(0, 255, (48, 60, 90, 3), dtype=np.uint8)[:count]


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_video_score_folder(tmp_path_factory.mktemp("VideoScore"), shards="40KB")


@pytest.fixture
def copied(model: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(model, tmp_path / "copy"))


def test_the_grades_are_those_of_its_own_code(model: Path) -> None:
    grades = video_score(frames(16), "a girl", model)
    assert list(grades) == list(DIMENSIONS)
    assert list(grades.values()) == pytest.approx(KNOWN, abs=2e-3)


def test_the_description_and_the_frames_count(model: Path) -> None:
    loaded = VideoScore.load(model)
    assert loaded.grades(frames(2), "a girl") != loaded.grades(frames(2), "a fox")
    assert loaded.grades(frames(2), "a girl") != loaded.grades(frames(2)[::-1], "a girl")


def test_a_description_with_a_word_for_pictures_is_only_a_description(model: Path) -> None:
    loaded = VideoScore.load(model)
    assert loaded.grades(frames(2), "a girl<image> {x}") == loaded.grades(frames(2), "a girl {x}")


def test_another_question_can_be_asked(copied: Path, model: Path) -> None:
    (copied / PROMPT_FILE).write_text("text is {text_prompt} :", encoding="utf-8")
    assert video_score(frames(2), "a girl", copied) != video_score(frames(2), "a girl", model)


@pytest.mark.parametrize(
    ("count", "rate", "chosen"),
    [
        (48, 24.0, list(range(0, 48, 3))),
        (12, 24.0, [0, 3, 6, 9]),
        (96, 24.0, list(range(0, 96, 6))),
        (5, 8.0, [0, 1, 2, 3, 4]),
        (3, 1.0, [0, 1, 2]),
        (32, None, list(range(0, 32, 2))),
        (1, 24.0, [0]),
        (8, 30.0, [0, 3, 7]),
    ],
)
def test_eight_frames_a_second_and_sixteen_at_most_are_looked_at(
    count: int, rate: float | None, chosen: list[int]
) -> None:
    assert frames_looked_at(count, rate) == chosen


def configured(**values: Any) -> Callable[[Path], None]:
    def change(folder: Path) -> None:
        document = json.loads((folder / "config.json").read_text())
        for name, value in values.items():
            inner = document["text_config"] if name.startswith("num_hidden") else document
            inner[name] = value
        (folder / "config.json").write_text(json.dumps(document))

    return change


def without(pattern: str) -> Callable[[Path], None]:
    def remove(folder: Path) -> None:
        for file in folder.glob(pattern):
            file.unlink()

    return remove


def shortened(folder: Path) -> None:
    file = folder / "model-00003-of-00007.safetensors"
    file.write_bytes(file.read_bytes()[:-100])


def huge_pictures(folder: Path) -> None:
    file = folder / "preprocessor_config.json"
    sizes = {"longest_edge": 10**6, "shortest_edge": 10**6}
    file.write_text(json.dumps(json.loads(file.read_text()) | {"size": sizes}))


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (without("config.json"), r"config\.json is missing or cannot be read\. Wanted: all files of .*TIGER-Lab"),
        (configured(model_type="llava"), r"names the model type 'llava'"),
        (configured(id2label={"0": "good"}, label2id={"good": 0}), r"gives 1 grades instead of 5"),
        (configured(num_hidden_layers=10**9), r"asks for num_hidden_layers = 1000000000"),
        (configured(num_hidden_layers=3), r"does not fit: 9 missing: model\.text_model\.layers\.2"),
        (without("*.safetensors"), r"holds no model\.safetensors nor parts of one"),
        (without("model-00002*"), r"does not fit: \d+ missing"),
        (shortened, r"model-00003-of-00007\.safetensors cannot be read; it is damaged"),
    ],
)
def test_a_folder_with_a_fault_names_it_before_weights_are_read(
    spoil: Callable[[Path], None], sentence: str, copied: Path
) -> None:
    check_video_score(copied)
    spoil(copied)
    with pytest.raises(InvalidInputError, match=sentence):
        check_video_score(copied)


@pytest.mark.parametrize("spoil", [without("tokenizer.json"), huge_pictures])
def test_a_faulty_processor_is_refused(spoil: Callable[[Path], None], copied: Path) -> None:
    spoil(copied)
    with pytest.raises(InvalidInputError, match=r"cannot be loaded as VideoScore: a file in it is missing, damaged"):
        VideoScore.load(copied)


def test_code_in_the_folder_does_not_run(copied: Path) -> None:
    (copied / "custom.py").write_text("raise SystemExit('ran')")
    for name in ("config.json", "preprocessor_config.json", "processor_config.json", "tokenizer_config.json"):
        document = json.loads((copied / name).read_text())
        kinds = ("AutoConfig", "AutoProcessor", "AutoImageProcessor", "AutoModel")
        document["auto_map"] = {kind: "custom.Thing" for kind in kinds} | {"AutoTokenizer": ["custom.Thing", None]}
        (copied / name).write_text(json.dumps(document))
    assert list(video_score(frames(16), "a girl", copied).values()) == pytest.approx(KNOWN, abs=2e-3)


def test_without_its_folder_or_package(tmp_path: Path, model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InvalidInputError, match=r"none is missing.*folder VideoScore.*huggingface.*MIT"):
        video_score(frames(2), "a girl", tmp_path / "none")
    monkeypatch.setitem(sys.modules, "transformers", None)
    monkeypatch.delitem(sys.modules, "physanimator.rendering.metrics.learned.idefics2_grader")
    monkeypatch.delattr(sys.modules["physanimator.rendering.metrics.learned"], "idefics2_grader")
    with pytest.raises(InvalidInputError, match="needs the package transformers"):
        video_score(frames(2), "a girl", model)
