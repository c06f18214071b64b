"""The Frechet inception distance: the arithmetic is right, the network is the public one, and files are checked."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.linalg
import torch
from drawn_weights import drawn_weights
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.metrics.learned.fid import features_of, frechet_distance, frechet_inception_distance
from physanimator.rendering.metrics.learned.inception import FEATURES, InceptionFeatures
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


def published_distance(first: np.ndarray, second: np.ndarray) -> float:
    """As pytorch-fid computes it."""
    away = first.mean(axis=0) - second.mean(axis=0)
    covariances = [np.cov(each, rowvar=False) for each in (first, second)]
    root = scipy.linalg.sqrtm(covariances[0] @ covariances[1])
    return float(away @ away + sum(map(np.trace, covariances)) - 2 * np.trace(np.real(root)))


@pytest.mark.parametrize(("first", "second", "features"), [(60, 90, 20), (300, 40, 20), (12, 9, 30)])
def test_the_distance_is_that_of_the_published_formula(first: int, second: int, features: int) -> None:
    random = np.random.default_rng(2)
    samples = random.normal(size=(first, features)) * random.random(features), random.normal(size=(second, features))
    assert frechet_distance(*samples) == pytest.approx(published_distance(*samples), rel=1e-5)


def test_the_distance_of_known_normal_distributions() -> None:
    """Variances 4 and 9 along one axis, 1 and 1 along the other, means 3 apart: 9 + (3 - 2)^2 + 0."""
    corners = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]]) * 0.75**0.5
    assert frechet_distance(corners * (2, 1), corners * (3, 1) + (0, 3)) == pytest.approx(9 + 1)


def test_counted_pictures_are_as_copies() -> None:
    first, second = sample(30), sample(3, shift=1.0)
    copied = np.repeat(second, [4, 1, 2], axis=0)
    counted = frechet_distance(first, second, counts=[4, 1, 2])
    assert counted == pytest.approx(published_distance(first, copied), rel=1e-5)


def test_the_network_is_that_of_pytorch_fid() -> None:
    """pytorch-fid 0.3.0 gives these numbers for these weights and pictures."""
    shapes = {name: tuple(each.shape) for name, each in build_without_storage(InceptionFeatures).state_dict().items()}
    network = InceptionFeatures.from_reference(drawn_weights(shapes))
    drawn = np.random.default_rng(3).integers(0, 256, (5, 70, 90, 3), dtype=np.uint8)
    found = features_of(network, drawn)
    known = [0.001614613807760179, 0.04945014417171478, 0.0003518930170685053, 0.0, 0.0008865203708410263]
    assert found[0, :5] == pytest.approx(known, rel=1e-3, abs=1e-6)
    assert (found.mean(), found.std()) == (pytest.approx(0.25539381, rel=1e-5), pytest.approx(0.35227379, rel=1e-5))
    assert frechet_distance(found[:3, :256], found[3:, :256]) == pytest.approx(0.0114963, rel=1e-3)
