"""Frames whose holes are painted by a diffusion model (paper, Experiments, ablation of the rendering)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor
from torch.nn import functional

from ...physics.errors import require
from ...physics.progress import Progress
from ..networks import Frame
from ..networks.half_precision import decoded_in
from ..networks.memory import autoencoder_bytes, sampling_bytes
from ..networks.placement import Placement
from ..pictures import as_float, as_picture
from .models import InpaintingModels
from .options import InpaintingOptions
from .sampler import sample_softly

__all__ = ["SoftInpainter"]

FloatImage = NDArray[np.float32]

_HOLE, _GREY = 0.5, 0.5
"""What may change by this much is hidden behind grey from a UNet that is told of holes, as in plain inpainting."""


class SoftInpainter:
    """Paints in frames, each pixel as much as its change map says.

    Pixels that may not change stay exactly as they are. Those that may change by half or more are the model's own, and
    between the two both are mixed, where the model has hardly left the frame.
    """

    def __init__(
        self,
        models: InpaintingModels,
        *,
        options: InpaintingOptions | None = None,
        placement: Placement | None = None,
    ) -> None:
        """Prepare.

        Args:
            models: the networks.
            options: settings.
            placement: where the networks compute; on the CPU by default. Prompts are always embedded on the CPU.
        """
        self.models = models
        self.options = options or InpaintingOptions()
        self.placement = placement or Placement(torch.device("cpu"))

    def frames(
        self,
        frames: Iterable[tuple[NDArray[Any], NDArray[np.float32]]],
        count: int,
        *,
        progress: Progress | None = None,
    ) -> Iterator[FloatImage]:
        """All frames, one after the other.

        Args:
            frames: each frame, RGB, uint8 or float in 0..1, shape [h, w, 3], of any size, with how much each of its
                pixels may change, 0..1, shape [h, w]. A frame in which nothing may change costs nothing.
            count: of the frames.
            progress: called after each sampling step with the number done and the number in all; may raise to stop.

        Returns:
            An iterator over float32 pictures, 0..1, shape [h, w, 3].

        Raises:
            InvalidInputError: there are too many steps; or, in its turn, a change map does not fit its frame.
        """
        self.models.check_steps(self.options.steps)
        return self._frames(frames, count, progress)

    def _frames(
        self,
        frames: Iterable[tuple[NDArray[Any], NDArray[np.float32]]],
        count: int,
        progress: Progress | None,
    ) -> Iterator[FloatImage]:
        options, context, done = self.options, None, 0

        def report(step: int) -> None:
            if progress is not None:
                progress(done + step, count * options.steps_done)

        generator = torch.Generator().manual_seed(options.seed)
        for frame, change in frames:
            picture = as_float(as_picture(frame))
            _check(picture, change)
            if (change > 0).any():
                if options.shared_noise:
                    generator.manual_seed(options.seed)
                context = self._context() if context is None else context
                place = _working_frame(picture, options.area, self.models.pixels_per_latent)
                picture = self._painted(picture, change, place, context, generator, report)
            done += options.steps_done
            report(0)
            yield picture

    def _context(self) -> Tensor:
        """The prompts, shape [1 or 2, tokens, channels]: the negative one first, where guidance needs it."""
        prompt = self.models.embedded(self.options.prompt)
        if self.options.guidance == 1:
            return prompt
        return torch.cat([self.models.embedded(self.options.negative_prompt), prompt])

    def _painted(
        self,
        picture: FloatImage,
        change: FloatImage,
        place: Frame,
        context: Tensor,
        generator: torch.Generator,
        report: Callable[[int], None],
    ) -> FloatImage:
        inside = torch.from_numpy(place.inward(picture)).permute(2, 0, 1)[None].contiguous()
        may_change = torch.from_numpy(place.inward(change))[None, None]
        with self._at_work(inside):
            drawn = self._drawn(inside, may_change, context, generator, report)
        return _mixed(picture, place.outward(drawn[0].permute(1, 2, 0).contiguous().numpy()), change)

    def _at_work(self, picture: Tensor) -> Any:
        """UNet and autoencoder on the device, with room for their work on a picture, shape [1, 3, h, w]."""
        unet, autoencoder = self.models.unet, self.models.autoencoder
        pixels = picture[0, 0].numel()
        latents = 2 * pixels // self.models.pixels_per_latent**2
        needed = max(
            sampling_bytes(latents, unet.config.block_out_channels[0], self.models.dtype),
            autoencoder_bytes(pixels, autoencoder.config.block_out_channels[0]),
        )
        return self.placement.at_work(unet, autoencoder, working_bytes=needed)

    def _drawn(
        self,
        picture: Tensor,
        change: Tensor,
        context: Tensor,
        generator: torch.Generator,
        report: Callable[[int], None],
    ) -> Tensor:
        """What the networks make of a picture, 0..1, shape [1, 3, h, w]."""
        options, device = self.options, self.placement.device
        original = self._encoded(picture)
        noise = torch.randn(original.shape, generator=generator).to(device)
        change = change.to(device)
        # A place may change as much as the pixel in it that may change most.
        places = functional.max_pool2d(change, self.models.pixels_per_latent)
        seen: tuple[Tensor, ...] = ()
        if self.models.sees_holes:
            shown = self._encoded(torch.where(change.to(picture) < _HOLE, picture, picture.new_tensor(_GREY)))
            seen = ((places >= _HOLE).to(original), shown)
        steps = 0

        def watch() -> None:
            nonlocal steps
            steps += 1
            if steps < options.steps_done:  # the last is done when the frame is
                report(steps)

        latents = sample_softly(
            self._predictor(context.to(device, self.models.dtype), seen),
            self.models.scheduler(),
            original,
            noise,
            places,
            steps=options.steps,
            strength=options.strength,
            watch=watch,
        )
        return self._decoded(latents)

    def _predictor(self, context: Tensor, seen: tuple[Tensor, ...]) -> Callable[[Tensor, Tensor], Tensor]:
        unet, guidance, dtype = self.models.unet, self.options.guidance, self.models.dtype

        def predict(x: Tensor, time: Tensor) -> Tensor:
            given = torch.cat([x, *seen], dim=1).expand(len(context), -1, -1, -1).to(dtype)
            out = unet(given, time, encoder_hidden_states=context, return_dict=False)[0].float()
            return out if len(out) == 1 else out[:1] + guidance * (out[1:] - out[:1])

        return predict

    @torch.no_grad()
    def _encoded(self, picture: Tensor) -> Tensor:
        """Scaled latents on the device of a picture, 0..1, shape [1, 3, h, w]."""
        autoencoder = self.models.autoencoder
        given = (2 * picture - 1).to(self.placement.device)
        latents: Tensor = autoencoder.encode(given).latent_dist.mode()
        return latents * autoencoder.config.scaling_factor

    @torch.no_grad()
    def _decoded(self, latents: Tensor) -> Tensor:
        """A picture, 0..1, on the CPU."""
        autoencoder, dtype, device = self.models.autoencoder, self.models.dtype, self.placement.device
        scaled = latents / autoencoder.config.scaling_factor
        picture = decoded_in(dtype, device, lambda: autoencoder.decode(scaled, return_dict=False)[0])
        return (picture.float().cpu() / 2 + 0.5).clamp(0, 1)


def _check(picture: FloatImage, change: FloatImage) -> None:
    got, expected = change.shape, picture.shape[:2]
    require("change map", f"the shape {got}", got == expected, f"of its frame's shape, {expected}")
    held = bool(np.isfinite(change).all()) and change.min() >= 0 and change.max() <= 1
    require("change map", f"{change.min():.3g} to {change.max():.3g}", held, "0 to 1 everywhere")


def _working_frame(picture: FloatImage, area: int | None, multiple: int) -> Frame:
    """The size in which the networks see a picture: of an area, or its own with the sides rounded up."""
    height, width = picture.shape[:2]
    if area is not None:
        return Frame.around(width, height, area=area)
    sides = (-(-width // multiple) * multiple, -(-height // multiple) * multiple)
    return Frame(width, height, (width, height), sides)


def _mixed(picture: FloatImage, drawn: FloatImage, change: FloatImage) -> FloatImage:
    share = np.clip(2 * change, 0, 1)[..., None]
    share = share * share * (3 - 2 * share)
    return np.asarray(np.where(share > 0, picture + share * (drawn - picture), picture), dtype=np.float32)
