"""The autoencoder part by part: the same pictures as all at once, in less memory."""

from __future__ import annotations

import pytest
import torch
from live_tensors import LiveTensors
from physanimator.rendering.tooncrafter import AutoencoderConfiguration
from physanimator.rendering.tooncrafter.autoencoder import DualReferenceAutoencoder
from physanimator.rendering.tooncrafter.clip_features import ClipFeatures
from physanimator.rendering.tooncrafter.clip_statistics import ClipStatistics
from physanimator.rendering.tooncrafter.memory import decoding_bytes, encoding_bytes
from physanimator.rendering.tooncrafter.models import ToonCrafterModels
from torch import Tensor, nn
from torch._subclasses.fake_tensor import FakeTensorMode

FRAMES, HEIGHT, WIDTH = 16, 40, 56


@pytest.fixture(scope="module")
def encoded(models: ToonCrafterModels) -> tuple[Tensor, list[Tensor]]:
    """Latents of a clip, and its keyframes' features."""
    random = torch.Generator().manual_seed(5)
    with torch.no_grad():
        _, references = models.autoencoder.encode(torch.randn(2, 3, HEIGHT, WIDTH, generator=random))
    return torch.randn(FRAMES, 4, HEIGHT // 8, WIDTH // 8, generator=random), references


@pytest.mark.parametrize("together", [1, 2, 3, 5, 15])
def test_parts_give_the_pictures_of_the_whole(
    models: ToonCrafterModels, encoded: tuple[Tensor, list[Tensor]], together: int
) -> None:
    latents, references = encoded
    before = latents.clone(), [each.clone() for each in references]
    with torch.no_grad():
        whole = models.autoencoder.decode(latents, references)
        parts = models.autoencoder.decode(latents, references, together=together)
    assert whole.std() > 0.05
    assert (whole[1:] - whole[:-1]).abs().mean() > 0.01
    torch.testing.assert_close(parts, whole, rtol=0, atol=1e-5 * whole.abs().max().item())
    assert torch.equal(latents, before[0])
    assert all(torch.equal(*each) for each in zip(references, before[1], strict=True))


def test_frames_cut_apart_would_differ(models: ToonCrafterModels, encoded: tuple[Tensor, list[Tensor]]) -> None:
    """Why the parts are not simply clips of their own."""
    latents, references = encoded
    with torch.no_grad():
        whole = models.autoencoder.decode(latents, references)
        apart = torch.cat([models.autoencoder.decode(each, references) for each in latents.split(8)])
    assert (apart - whole).abs().max() > 0.01 * whole.abs().max()


def test_pictures_are_encoded_one_by_one_as_together(models: ToonCrafterModels) -> None:
    frames = torch.randn(3, 3, HEIGHT, WIDTH, generator=torch.Generator().manual_seed(6))
    with torch.no_grad():
        moments, references = models.autoencoder.encode(frames)
        one_by_one, their_references = models.autoencoder.encode(frames, together=1)
    torch.testing.assert_close(one_by_one, moments, rtol=1e-4, atol=1e-5)
    for ours, theirs in zip(their_references, references, strict=True):
        torch.testing.assert_close(ours, theirs, rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("mean", [0.0, 300.0])
def test_statistics_of_parts_are_those_of_the_whole(mean: float) -> None:
    """Also where a sum of squares would have lost the variance in its rounding."""
    random = torch.Generator().manual_seed(7)
    norm = nn.GroupNorm(4, 8)
    nn.init.normal_(norm.weight, generator=random)
    nn.init.normal_(norm.bias, generator=random)
    clip = mean + 0.1 * torch.randn(1, 8, 5, 13, 6, generator=random)
    statistics = ClipStatistics(norm)
    for part in clip.split([3, 1, 9], dim=3):
        statistics.add(part)
    with torch.no_grad():
        found, expected = statistics.normalised(clip).double(), norm.double()(clip.double())
    assert (found - expected).abs().max() < (1e-5 if not mean else 2e-3)


def test_layers_see_few_pictures_at_a_time_and_all_once() -> None:
    seen: list[int] = []

    def layer(x: Tensor) -> Tensor:
        seen.extend(x[:, 0, 0, 0].int().tolist())
        calls.append(len(x))
        return x + 100

    calls: list[int] = []
    given = torch.arange(7.0)[:, None, None, None].expand(7, 1, 2, 2)
    features = ClipFeatures(given, budget=3 * 4)
    features.then(layer)
    assert torch.equal(features.settled(), given + 100)
    assert (seen, calls) == (list(range(7)), [1, 3, 3])
    assert torch.equal(features.settled(), given + 100)
    assert len(calls) == 3


def peak(
    config: AutoencoderConfiguration, together: int | None, size: tuple[int, int], *, half: bool = False
) -> tuple[int, int]:
    """Most bytes at once while decoding, keyframes' features included, and while encoding the keyframes."""
    height, width = size
    with FakeTensorMode(), torch.no_grad():
        network = DualReferenceAutoencoder(config)
        with LiveTensors(network) as encoding:
            references = network.encode(torch.empty(2, 3, height, width), together=1)[1]
        for module in network.modules():
            if half and isinstance(module, nn.GroupNorm):  # as it normalises on a GPU
                module.register_forward_pre_hook(lambda _, given: (given[0].float(),))
        with LiveTensors(network) as decoding, torch.autocast("cpu", torch.bfloat16, enabled=half):
            network.decode(torch.empty(FRAMES, 4, height // 8, width // 8), references, together=together)
    return decoding.peak + sum(each.nbytes for each in references), encoding.peak


def test_parts_need_less_memory() -> None:
    config = AutoencoderConfiguration()
    needed = [peak(config, together, (320, 512))[0] / 2**30 for together in (3, 6, 12, None)]
    assert needed[0] < 3.1
    assert needed[3] > 8.5
    assert needed == sorted(needed)


@pytest.mark.parametrize("size", [(320, 512), (512, 768)])
@pytest.mark.parametrize("together", [1, 3, 8, 16])
@pytest.mark.parametrize("dtype", [torch.float32, torch.bfloat16])
def test_memory_asked_for_is_enough_and_not_far_more(dtype: torch.dtype, together: int, size: tuple[int, int]) -> None:
    config = AutoencoderConfiguration()
    decoding, encoding = peak(config, together, size, half=dtype == torch.bfloat16)
    pixels = size[0] * size[1]
    assert decoding <= decoding_bytes(pixels, config.ch, FRAMES, together=together, dtype=dtype) < 1.3 * decoding
    assert encoding <= encoding_bytes(pixels, config.ch) < 1.3 * encoding
