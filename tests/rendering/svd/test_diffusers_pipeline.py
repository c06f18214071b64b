"""Plain Stable Video Diffusion against diffusers' own pipeline: schedule, conditions, guidance, the network's names."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import random_svd
import torch
from physanimator.rendering.svd import CLIP_FRAMES, CrudeAnimation, SVDOptions
from physanimator.rendering.svd.models import load_models
from physanimator.rendering.svd.renderer import SVDRenderer
from physanimator.rendering.svd.sampler import SampledStep

pytest.importorskip("transformers")

SIDE, STEPS, SEED = 64, 4, 5
SIZES = replace(random_svd.TINY, image_encoder=replace(random_svd.TINY.image_encoder, picture=224))
"""The pipeline knows no other size of what the picture encoder sees."""


@pytest.mark.filterwarnings("ignore:__array__ implementation:DeprecationWarning")
def test_held_to_nothing_a_clip_is_the_pipeline_s(tmp_path: Path) -> None:
    import diffusers_svd

    folder = random_svd.write_folder(tmp_path / "svd", random_svd.weights(SIZES), sizes=SIZES)
    picture = np.random.default_rng(0).integers(0, 256, (SIDE, SIDE, 3), dtype=np.uint8)
    options = replace(
        SVDOptions.following("animation"), steps=STEPS, area=SIDE**2, seed=SEED, weak=0.0, strong=0.0,
        picture_noise=0.0, frames_per_second=6, motion_bucket=127, guidance=3.0,
    )  # fmt: skip
    seen: list[SampledStep] = []
    animation = CrudeAnimation(CLIP_FRAMES, lambda _: (picture, np.ones((SIDE, SIDE), np.float32)))
    list(SVDRenderer(load_models(folder), options=options).frames(picture, animation=animation, watch=seen.append))
    noise = torch.randn((CLIP_FRAMES, 4, SIDE // 8, SIDE // 8), generator=torch.Generator().manual_seed(SEED))
    pipeline = diffusers_svd.loaded(folder, torch.float32, torch.device("cpu"))
    # It takes one frame a second more than it tells the network.
    how = {"num_inference_steps": STEPS, "fps": 7, "motion_bucket_id": 127, "noise_aug_strength": 0.0}
    latents = diffusers_svd.draw(
        pipeline, picture, CLIP_FRAMES, latents=noise[None].clone(), max_guidance_scale=3.0, output_type="latent", **how
    )
    assert len(seen) == STEPS
    np.testing.assert_allclose(seen[-1].clean.numpy(), latents, atol=1e-4 * float(np.abs(latents).max()))
