"""ToonCrafter's parts together, from keyframes to frames, against the numbers of the original."""

from __future__ import annotations

import pytest
import reference_nets as reference
import torch
from physanimator.rendering.tooncrafter import ToonCrafterOptions
from physanimator.rendering.tooncrafter.autoencoder import DualReferenceAutoencoder
from physanimator.rendering.tooncrafter.clip import guided_velocity, sample_clips
from physanimator.rendering.tooncrafter.conditioning import Tokens, contexts, encode_pair
from physanimator.rendering.tooncrafter.decoding import decode_clip
from physanimator.rendering.tooncrafter.models import ToonCrafterModels
from physanimator.rendering.tooncrafter.resampler import ImageResampler
from physanimator.rendering.tooncrafter.sketch_encoder import SketchEncoder
from physanimator.rendering.tooncrafter.unet import InterpolationUNet
from torch import Tensor

NETWORKS = {
    "tooncrafter_unet": InterpolationUNet,
    "tooncrafter_resampler": ImageResampler,
    "tooncrafter_vae": DualReferenceAutoencoder,
    "sketch_encoder": SketchEncoder,
}
PIPELINES = [name for name in reference.cases("tooncrafter_ddim") if "/pipeline" in name]
ROUNDTRIPS = [name for name in reference.cases("tooncrafter_vae") if "/roundtrip" in name]


def models_of(case: str) -> ToonCrafterModels:
    described = reference.fixtures().cases[case]
    networks = [
        NETWORKS[net].from_reference(reference.fixtures().nets[net]["config"], reference.state_dict(case, net))
        for net in NETWORKS
        if net in described["nets"]
    ]
    return ToonCrafterModels(*networks)


@pytest.mark.parametrize("case", PIPELINES)
def test_from_keyframes_to_frames(case: str) -> None:
    settings, given = reference.fixtures().cases[case]["config"], reference.inputs(case)
    models = models_of(case)
    options = ToonCrafterOptions(
        steps=settings["steps"],
        eta=settings["eta"],
        guidance=settings["cfg"],
        guidance_rescale=settings["guidance_rescale"],
        frame_rate=int(given["fs"]),
        control_scale=settings["control_scale"] or 0,
    )
    frames, stored = given["x_T"].shape[2], settings["frames_stored"]

    def noise(number: int) -> Tensor:
        return torch.from_numpy(reference.fixtures().noise(case, number))

    with torch.no_grad():
        keyframes = 2 * torch.stack([given["frame_first"], given["frame_last"]]) - 1
        pair = encode_pair(models.autoencoder, keyframes, given["posterior_noise"][[0, -1]], frames)
        tokens = Tokens(given["clip_tokens"], given["clip_tokens_zero"])
        context = contexts(models.resampler, tokens, given["text"], given["text_empty"])
        velocity = guided_velocity(models, pair.condition, context, given.get("hint"), options)
        samples = sample_clips(velocity, given["x_T"], noise, options)
        latents = samples[0].transpose(0, 1) / settings["scale_factor"]
        drawn = decode_clip(lambda part: models.autoencoder.decode(part, pair.references), latents)
    pictures = drawn.transpose(0, 1)[None]
    got = {"samples": samples, "frames": pictures[:, :, stored], "c_concat": pair.condition[:, :, [0, -1]]}
    reference.assert_within_tolerance(case, got, {"all_frames": pictures, "context": context.conditional})


@pytest.mark.parametrize("case", ROUNDTRIPS)
def test_the_middle_is_decoded_twice(case: str) -> None:
    settings, given = reference.fixtures().cases[case]["config"], reference.inputs(case)
    net = DualReferenceAutoencoder.from_reference(
        reference.fixtures().nets["tooncrafter_vae"]["config"], reference.state_dict(case, "tooncrafter_vae")
    )
    runs: list[Tensor] = []
    with torch.no_grad():
        moments, references = net.encode(2 * given["frames"] - 1)
        mean, log_variance = moments.chunk(2, dim=1)
        drawn = mean + (log_variance.clamp(-30, 20) / 2).exp() * given["posterior_noise"]
        z = settings["scale_factor"] * drawn.transpose(0, 1)[None]

        def decoder(latents: Tensor) -> Tensor:
            runs.append(net.decode(latents, references))
            return runs[-1]

        latents = (z + given["latent_offset"])[0].transpose(0, 1) / settings["scale_factor"]
        composite = decode_clip(decoder, latents)
    whole, shorter, composite = (each.transpose(0, 1)[None] for each in (*runs, composite))
    got = {"z": z, "frames": composite[:, :, settings["frames_stored"]]}
    between = {"decode16": whole, "decode14": shorter, "composite": composite}
    reference.assert_within_tolerance(case, got, between)
