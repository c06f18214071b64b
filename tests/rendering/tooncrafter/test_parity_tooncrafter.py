"""ToonCrafter's networks against the numbers that the public ones give with the same weights."""

from __future__ import annotations

from typing import Any

import pytest
import reference_nets as reference
import torch
from physanimator.rendering.networks.checkpoints import build_without_storage, check_names
from physanimator.rendering.tooncrafter import AutoencoderConfiguration, ResamplerConfiguration, UNetConfiguration
from physanimator.rendering.tooncrafter.autoencoder import DualReferenceAutoencoder
from physanimator.rendering.tooncrafter.resampler import ImageResampler
from physanimator.rendering.tooncrafter.sketch_encoder import SketchEncoder
from physanimator.rendering.tooncrafter.unet import InterpolationUNet
from torch import Tensor

UNET, SKETCH, RESAMPLER, VAE = "tooncrafter_unet", "sketch_encoder", "tooncrafter_resampler", "tooncrafter_vae"


def configuration(net: str) -> dict[str, Any]:
    return reference.fixtures().nets[net]["config"]


def split(case: str, found: dict[str, Tensor]) -> tuple[dict[str, Tensor], dict[str, Tensor]]:
    """What was found by the case's names: stored arrays, and summarised ones."""
    described = reference.fixtures().cases[case]
    outputs = {name: each for name, each in found.items() if name in described["outputs"]}
    summaries = {name: each for name, each in found.items() if name in described.get("summaries", {})}
    return outputs, summaries


def assert_agrees(case: str, found: dict[str, Tensor], *, covered: float = 1.0) -> None:
    described = reference.fixtures().cases[case]
    outputs, summaries = split(case, found)
    assert set(outputs) >= {name for name in described["outputs"] if "." not in name}
    assert len(summaries) >= covered * len(described.get("summaries", {}))
    reference.assert_within_tolerance(case, outputs, summaries)


@pytest.mark.parametrize("case", reference.cases("tooncrafter_resampler"))
def test_resampler(case: str) -> None:
    net = ImageResampler.from_reference(configuration(RESAMPLER), reference.state_dict(case, RESAMPLER))
    with torch.no_grad(), reference.recorded(case, "", net) as found:
        out = net(reference.inputs(case)["tokens"])
    assert_agrees(case, {"out": out, **found})


@pytest.mark.parametrize("case", [name for name in reference.cases("tooncrafter_vae") if "/encode" in name])
def test_autoencoder_encodes(case: str) -> None:
    net = DualReferenceAutoencoder.from_reference(configuration(VAE), reference.state_dict(case, VAE))
    with torch.no_grad(), reference.recorded(case, "", net) as found:
        moments, references = net.encode(reference.inputs(case)["frames"])
    found |= {f"ref{number}": each for number, each in enumerate(references)}
    assert_agrees(case, {"moments": moments, "mean": moments.chunk(2, dim=1)[0], **found})


@pytest.mark.parametrize("case", [name for name in reference.cases("tooncrafter_vae") if "/decode" in name])
def test_autoencoder_decodes(case: str) -> None:
    net = DualReferenceAutoencoder.from_reference(configuration(VAE), reference.state_dict(case, VAE))
    given = reference.inputs(case)
    references = [given[f"ref{number}"] for number in range(sum(name.startswith("ref") for name in given))]
    with torch.no_grad(), reference.recorded(case, "", net) as found:
        frames = net.decode(given["z"], references)
    assert_agrees(case, {"frames": frames, **found})


@pytest.mark.parametrize("case", reference.cases("tooncrafter_unet"))
def test_unet(case: str) -> None:
    described, given = reference.fixtures().cases[case], reference.inputs(case)
    frames, control, found = given["x"].shape[2], None, {}
    with torch.no_grad():
        if SKETCH in described["nets"]:
            encoder = SketchEncoder.from_reference(configuration(SKETCH), reference.state_dict(case, SKETCH))
            latents = given["x"][:, : encoder.config.in_channels].transpose(1, 2).flatten(0, 1)
            control = encoder(latents, given["hint"], given["t"], given["context"])
            control = [each * described["config"]["control_scale"] for each in control]
            found |= {f"control_{number:02d}": each for number, each in enumerate(control)}
        net = InterpolationUNet.from_reference(configuration(UNET), reference.state_dict(case, UNET))
        with reference.recorded(case, "unet", net) as between:
            out = net(given["x"], given["t"], given["context"], given.get("fs"), control)
        embedding = net._conditions(given["t"], given["context"], given.get("fs"), frames).embedding
    assert_agrees(case, {"out": out, "unet.emb": embedding, **found, **between})


@pytest.mark.parametrize(
    ("network", "config"),
    [
        (InterpolationUNet, UNetConfiguration()),
        (ImageResampler, ResamplerConfiguration()),
        (DualReferenceAutoencoder, AutoencoderConfiguration()),
    ],
)
def test_every_public_name_has_its_place(network: Any, config: Any) -> None:
    built = build_without_storage(lambda: network(config))
    ours = {network.prefix + name: tuple(tensor.shape) for name, tensor in built.state_dict().items()}
    public = reference.full_shapes("tooncrafter_model_ckpt")
    part = {name: shape for name, shape in public.items() if name.startswith(network.prefix)}
    check_names(ours, part, file="model.ckpt", wanted="all names")


def test_the_public_file_has_no_other_part() -> None:
    prefixes = (InterpolationUNet.prefix, ImageResampler.prefix, DualReferenceAutoencoder.prefix)
    assert all(name.startswith(prefixes) for name in reference.full_shapes("tooncrafter_model_ckpt"))
