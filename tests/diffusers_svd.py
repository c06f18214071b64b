"""Stable Video Diffusion by diffusers' own pipeline, with weights of random_svd and the public scheduler's settings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import torch
from diffusers import (
    AutoencoderKLTemporalDecoder,
    EulerDiscreteScheduler,
    StableVideoDiffusionPipeline,
    UNetSpatioTemporalConditionModel,
)
from numpy.typing import NDArray
from PIL import Image
from transformers import CLIPImageProcessor, CLIPVisionModelWithProjection

__all__ = ["draw", "loaded"]

# What the public folder's documents say and those of random_svd do not, as the renderer does not read it.
_AUTOENCODER = {"down_block_types": ("DownEncoderBlock2D",) * 4, "layers_per_block": 2, "latent_channels": 4}
_SCHEDULER = {
    "beta_start": 0.00085,
    "beta_end": 0.012,
    "beta_schedule": "scaled_linear",
    "num_train_timesteps": 1000,
    "prediction_type": "v_prediction",
    "sigma_max": 700.0,
    "sigma_min": 0.002,
    "steps_offset": 1,
    "timestep_spacing": "leading",
    "timestep_type": "continuous",
    "use_karras_sigmas": True,
}


def loaded(
    folder: Path, dtype: torch.dtype, device: torch.device, *, in_turns: bool = False
) -> StableVideoDiffusionPipeline:
    """The pipeline.

    Args:
        folder: with unet, vae and image_encoder.
        dtype: of all weights, as its users load it.
        device: where its networks are.
        in_turns: they come there only for their work, as ours do; otherwise all are there all the time, as usual.
    """
    given = {"torch_dtype": dtype}
    unet = UNetSpatioTemporalConditionModel.from_pretrained(folder / "unet", **given)
    autoencoder = AutoencoderKLTemporalDecoder.from_pretrained(folder / "vae", **_AUTOENCODER, **given)
    encoder = CLIPVisionModelWithProjection.from_pretrained(folder / "image_encoder", hidden_act="gelu", **given)
    scheduler = EulerDiscreteScheduler(**_SCHEDULER)
    pipeline = StableVideoDiffusionPipeline(autoencoder, encoder, unet, scheduler, CLIPImageProcessor())
    pipeline.set_progress_bar_config(disable=True)
    if in_turns:
        pipeline.enable_model_cpu_offload(device=device)
    else:
        pipeline.to(device)
    return pipeline


def draw(pipeline: StableVideoDiffusionPipeline, image: NDArray[np.uint8], frames: int, **how: Any) -> NDArray[Any]:
    """A clip, 0..1, shape [f, h, w, 3], or what the argument output_type asks for.

    Args:
        pipeline: draws it.
        image: RGB, of the working size.
        frames: of the clip.
        how: more arguments of the pipeline.
    """
    height, width = image.shape[:2]
    size = {"width": width, "height": height}
    found = pipeline(Image.fromarray(image), num_frames=frames, **{"output_type": "np", **size, **how}).frames[0]
    return np.asarray(found)
