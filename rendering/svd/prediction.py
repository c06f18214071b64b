"""What the networks predict: LVCD's after sketches, or Stable Video Diffusion's alone."""

from __future__ import annotations

import torch
from torch import Tensor

from .conditioning import Conditioning
from .controlnet import SketchControlNet
from .frame_layout import FrameLayout
from .models import SVDModels
from .sampler import Predictor

__all__ = ["plain_predictor", "sketch_predictor"]


def sketch_predictor(models: SVDModels, control: SketchControlNet, conditioning: Conditioning) -> Predictor:
    """The networks with the sketch ControlNet.

    Args:
        models: whose UNet predicts.
        control: reads the sketches.
        conditioning: what they are told of the illustration.
    """

    def predict(x: Tensor, condition: Tensor, sketches: Tensor, noise_level: Tensor, layout: FrameLayout) -> Tensor:
        both = torch.cat([x, condition], dim=1)[None].to(models.dtype)
        conditions = (noise_level[None], conditioning.context, conditioning.ids, layout)
        residuals = control(both, sketches[None].to(both.device, both.dtype), *conditions)
        return models.unet(both, *conditions, residuals)[0].float()

    return predict


def plain_predictor(models: SVDModels, conditioning: Conditioning, guidance: float) -> Predictor:
    """Stable Video Diffusion alone, with classifier-free guidance that rises from frame to frame.

    With scale w of a frame, u the prediction for an empty picture, and c that for the illustration, it is
    u + w (c - u); w goes from 1 in the first frame to ``guidance`` in the last (Blattmann et al., 2023, Stable Video
    Diffusion).

    Args:
        models: whose UNet predicts.
        conditioning: what it is told of the illustration.
        guidance: of the last frame; 1: none at all.
    """

    def predicted(x: Tensor, condition: Tensor, context: Tensor, noise_level: Tensor, layout: FrameLayout) -> Tensor:
        both = torch.cat([x, condition], dim=1)[None].to(models.dtype)
        return models.unet(both, noise_level[None], context, conditioning.ids, layout)[0].float()

    def predict(x: Tensor, condition: Tensor, sketches: Tensor, noise_level: Tensor, layout: FrameLayout) -> Tensor:
        told = predicted(x, condition, conditioning.context, noise_level, layout)
        if guidance == 1:
            return told
        nothing = torch.zeros_like(condition), torch.zeros_like(conditioning.context)
        untold = predicted(x, *nothing, noise_level, layout)
        scales = torch.linspace(1, guidance, len(x), device=x.device)[:, None, None, None]
        return untold + scales * (told - untold)

    return predict
