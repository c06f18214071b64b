"""Measures by networks: the arithmetic is right, files are checked, and nothing is fetched."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
import torch
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.metrics.learned import video_score
from physanimator.rendering.metrics.learned.fid import frechet_distance, frechet_inception_distance
from physanimator.rendering.metrics.learned.inception import FEATURES, InceptionFeatures
from physanimator.rendering.metrics.learned.videoscore import DIMENSIONS
from physanimator.rendering.networks.checkpoints import CheckpointError, build_without_storage


def sample(count: int, shift: float = 0.0, scale: float = 1.0) -> np.ndarray:
    return np.random.default_rng(1).normal(size=(count, 3)) * scale + shift


def pictures(count: int, seed: int) -> list[np.ndarray]:
    return list(np.random.default_rng(seed).random((count, 24, 32, 3), dtype=np.float32))


def weights() -> dict[str, torch.Tensor]:
    generator = torch.Generator().manual_seed(0)
    shapes = {name: each.shape for name, each in build_without_storage(InceptionFeatures).state_dict().items()}
    made = {
        name: torch.ones(shape) if name.endswith(("weight", "var")) else torch.zeros(shape)
        for name, shape in shapes.items()
    }
    for name, tensor in made.items():
        if tensor.ndim == 4:
            made[name] = tensor.normal_(generator=generator) * (2 / tensor[0].numel()) ** 0.5
    return made


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file of random weights, with what the public one holds beside them."""
    beside = {"fc.weight": torch.zeros(1008, FEATURES), "fc.bias": torch.zeros(1008)}
    path = tmp_path_factory.mktemp("inception") / "inception.pth"
    torch.save({**weights(), **beside, "Conv2d_1a_3x3.bn.num_batches_tracked": torch.tensor(0)}, path)
    return path


def test_frechet_distance_of_one_sample_is_zero() -> None:
    assert frechet_distance(sample(50), sample(50)) == pytest.approx(0, abs=1e-9)


def test_frechet_distance_of_a_shift_is_its_square() -> None:
    assert frechet_distance(sample(50), sample(50, shift=2.0)) == pytest.approx(3 * 4)


def test_frechet_distance_of_a_scaling_is_that_of_normal_distributions() -> None:
    first = sample(400)
    centred = first - first.mean(axis=0)
    variance = np.trace(np.cov(first.T))
    assert frechet_distance(centred, 3 * centred) == pytest.approx((3 - 1) ** 2 * variance)


def test_frechet_distance_with_fewer_pictures_than_features() -> None:
    few = np.random.default_rng(1).normal(size=(4, 60))
    assert frechet_distance(few, few) == pytest.approx(0, abs=1e-9)
    assert frechet_distance(few, few + 1) == pytest.approx(60)


def test_the_network_has_the_public_sizes() -> None:
    network = build_without_storage(InceptionFeatures)
    convolutions = sum(p.numel() for p in network.parameters() if p.ndim == 4)
    channels = sum(p.numel() for name, p in network.named_parameters() if name.endswith("bn.bias"))
    # The published Inception v3 without its classifier has 21,802,784 numbers: kernels, and three for each channel.
    assert convolutions + 3 * channels == 21_802_784
    assert network(torch.rand(2, 3, 20, 30, device="meta")).shape == (2, FEATURES)


@pytest.mark.parametrize(("contrast", "least", "most"), [(1.0, -1e-9, 1e-5), (0.2, 1e-3, np.inf)])
def test_fid_of_the_same_pictures_is_zero_and_of_others_is_not(
    file: Path, contrast: float, least: float, most: float
) -> None:
    found = frechet_inception_distance(pictures(2, 1), [contrast * each for each in pictures(2, 1)], file)
    assert least < found < most


def test_a_missing_file_says_what_where_and_whence(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"none\.pth is missing.*pt_inception.*pytorch-fid.*Apache"):
        frechet_inception_distance(pictures(2, 1), pictures(2, 1), tmp_path / "none.pth")


def test_another_file_names_its_faults(tmp_path: Path) -> None:
    torch.save({"encoder.weight": torch.zeros(2)}, tmp_path / "other.pth")
    with pytest.raises(CheckpointError, match=r"470 missing: Conv2d_1a_3x3.*1 not wanted: encoder\.weight"):
        frechet_inception_distance(pictures(2, 1), pictures(2, 1), tmp_path / "other.pth")


def test_one_picture_is_too_few(file: Path) -> None:
    with pytest.raises(InvalidInputError, match="frames must be at least 2 pictures"):
        frechet_inception_distance(pictures(1, 1), pictures(2, 1), file)


class _Processor:
    """Counts what it is given."""

    def __call__(self, *, text: str, images: list[object], return_tensors: str) -> dict[str, torch.Tensor]:
        assert text.count("<image>") == len(images)
        assert "a girl" in text
        return {"pixels": torch.full((1,), float(len(images)))}


class _Model:
    device = torch.device("cpu")

    def __call__(self, pixels: torch.Tensor) -> SimpleNamespace:
        return SimpleNamespace(logits=pixels * torch.arange(1.0, 6.0)[None])

    def eval(self) -> _Model:
        return self

    def requires_grad_(self, wanted: bool) -> _Model:
        return self


@pytest.fixture
def packages(monkeypatch: pytest.MonkeyPatch) -> dict[str, list[dict[str, object]]]:
    """Stand-ins for the packages, which write down how they were asked to load."""
    asked: dict[str, list[dict[str, object]]] = {"model": [], "processor": []}

    def loader(kind: str, made: object) -> type:
        def load(folder: Path, **options: object) -> object:
            asked[kind].append(options)
            return made

        return type(kind, (), {"from_pretrained": staticmethod(load)})

    transformers, idefics = ModuleType("transformers"), ModuleType("mantis.models.idefics2")
    transformers.AutoProcessor = loader("processor", _Processor())  # type: ignore[attr-defined]
    idefics.Idefics2ForSequenceClassification = loader("model", _Model())  # type: ignore[attr-defined]
    for name, module in {"transformers": transformers, "mantis.models.idefics2": idefics}.items():
        monkeypatch.setitem(sys.modules, name, module)
    for name in ("mantis", "mantis.models"):
        monkeypatch.setitem(sys.modules, name, ModuleType(name))
    return asked


def question_in(folder: Path) -> Path:
    (folder / "prompt.txt").write_text("Grade this clip of {text_prompt}.", encoding="utf-8")
    return folder


def test_video_score_looks_at_sixteen_frames_and_names_the_grades(tmp_path: Path, packages: dict) -> None:
    grades = video_score(pictures(40, 1), "a girl", question_in(tmp_path))
    assert list(grades) == list(DIMENSIONS)
    assert grades["visual_quality"] == 16
    assert grades["factual_consistency"] == 80
    assert video_score(pictures(3, 1), "a girl", tmp_path)["visual_quality"] == 3


def test_video_score_fetches_nothing(tmp_path: Path, packages: dict) -> None:
    video_score(pictures(2, 1), "a girl", question_in(tmp_path))
    assert [each["local_files_only"] for asked in packages.values() for each in asked] == [True, True]


def test_video_score_without_its_folder_question_or_packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InvalidInputError, match=r"none is missing.*folder VideoScore.*huggingface.*MIT"):
        video_score(pictures(2, 1), "a girl", tmp_path / "none")
    with pytest.raises(InvalidInputError, match=r"prompt\.txt is missing.*TIGER-Lab"):
        video_score(pictures(2, 1), "a girl", tmp_path)
    monkeypatch.setitem(sys.modules, "mantis", None)
    with pytest.raises(InvalidInputError, match="needs the packages mantis-vl"):
        video_score(pictures(2, 1), "a girl", question_in(tmp_path))
