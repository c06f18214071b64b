"""Frames from an illustration and one sketch a frame (paper, Method, "Sketch-Guided Rendering")."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from ...physics.errors import require
from ...physics.progress import Progress
from ..networks import Frame
from ..networks.half_precision import decoded_in
from ..networks.memory import autoencoder_bytes, sampling_bytes
from ..networks.placement import Placement
from ..pictures import as_float, as_grey, as_picture
from .conditioning import Conditioning, condition_on
from .decoding import around_the_wrap, decode, decoding_chunks
from .frame_layout import CLIP_FRAMES, FrameLayout
from .loop_segments import plan_clip
from .models import SVDModels
from .noise_schedule import noise_levels
from .options import SVDOptions
from .sampler import LATENT_SCALE, SampledStep, sample_clip

__all__ = ["SVDRenderer"]

FloatImage = NDArray[np.float32]

_PIXELS_PER_LATENT = 8


class SVDRenderer:
    """Draws the frames of a clip that follow given sketches."""

    def __init__(
        self,
        models: SVDModels,
        *,
        options: SVDOptions | None = None,
        placement: Placement | None = None,
    ) -> None:
        """Prepare.

        Args:
            models: the networks.
            options: settings.
            placement: where the networks compute; on the CPU by default.
        """
        self.models = models
        self.options = options or SVDOptions()
        self.placement = placement or Placement(torch.device("cpu"))

    def frames(
        self,
        image: NDArray[Any],
        sketches: Sequence[NDArray[Any]],
        *,
        progress: Progress | None = None,
        watch: Callable[[SampledStep], None] | None = None,
        loops: bool = False,
    ) -> Iterator[FloatImage]:
        """All frames of the clip; frame 0 is the illustration as the autoencoder sees it.

        Args:
            image: the illustration, RGB, uint8 or float in 0..1, shape [h, w, 3].
            sketches: dark lines on white, one for each frame, the illustration's own first, RGB or grey, of its size.
            progress: called after each sampling step and each decoded chunk with the number done and the number in all;
                may raise to stop.
            watch: called in each sampling step; may raise to stop.
            loops: the last frame leads to frame 1, which follows it when the clip is shown again without frame 0.

        Returns:
            An iterator over float32 pictures, 0..1, shape [h, w, 3]. Bad input raises here.
        """
        image = as_picture(image)
        height, width = image.shape[:2]
        require("sketches", f"{len(sketches)}", len(sketches) >= 2, "2 or more: the illustration's and another frame's")
        sizes, expected = (
            {sketch.shape[:2] for sketch in sketches},
            f"of the illustration's size, {width} x {height} px",
        )
        require("sketches", sorted(sizes), sizes == {(height, width)}, expected)
        return self._frames(image, sketches, progress, watch, loops)

    def _frames(
        self,
        image: NDArray[Any],
        sketches: Sequence[NDArray[Any]],
        progress: Progress | None,
        watch: Callable[[SampledStep], None] | None,
        loops: bool,
    ) -> Iterator[FloatImage]:
        options, frame = self.options, Frame.around(image.shape[1], image.shape[0], area=self.options.area)
        steps = options.steps * len(plan_clip(len(sketches), options.overlap, loops=loops))
        decoded = around_the_wrap(len(sketches)) if loops else list(range(len(sketches)))
        total = steps + len(list(decoding_chunks(len(decoded), options.decoded_together)))

        def report(done: int) -> None:
            if progress is not None:
                progress(done, total)

        def each_step(now: SampledStep) -> None:
            if watch is not None:
                watch(now)
            report(now.done)

        generator = torch.Generator().manual_seed(options.seed)
        width, height = (side // _PIXELS_PER_LATENT for side in frame.size)
        noise = torch.randn((1 + options.overlap + CLIP_FRAMES, 4, height, width), generator=generator)
        conditioning = condition_on(
            _as_tensor(frame.inward(as_float(image))),
            self.models,
            options=options,
            placement=self.placement,
            generator=generator,
        )
        hints = torch.cat([_hint(frame.inward(as_grey(sketch))) for sketch in sketches])
        latents = self._sampled(conditioning, hints, noise, each_step, loops)
        more = (len(decoded) - len(sketches)) // 2
        shown = iter([number == 0 or more < number < len(decoded) - more for number in range(len(decoded))])
        for number, pictures in enumerate(self._decoded(latents[decoded]), start=1):
            report(steps + number)
            for picture in pictures:
                if next(shown):
                    yield frame.outward(picture.permute(1, 2, 0).contiguous().numpy())

    def _sampled(
        self,
        conditioning: Conditioning,
        hints: Tensor,
        noise: Tensor,
        watch: Callable[[SampledStep], None],
        loops: bool,
    ) -> Tensor:
        """Latents of all frames, scaled, on the device."""
        device, unet, control, dtype = self.placement.device, self.models.unet, self.models.control, self.models.dtype

        def predict(x: Tensor, condition: Tensor, sketches: Tensor, noise_level: Tensor, layout: FrameLayout) -> Tensor:
            both = torch.cat([x, condition], dim=1)[None].to(dtype)
            conditions = (noise_level[None], conditioning.context, conditioning.ids, layout)
            residuals = control(both, sketches[None].to(device, dtype), *conditions)
            return unet(both, *conditions, residuals)[0].float()

        needed = sampling_bytes(noise[:, 0].numel(), unet.config.model_channels, dtype)
        with self.placement.at_work(unet, control, working_bytes=needed):
            return sample_clip(
                predict,
                conditioning.latent,
                hints,
                noise.to(device),
                sigmas=noise_levels(self.options.steps),
                overlap=self.options.overlap,
                loops=loops,
                watch=watch,
            )

    def _decoded(self, latents: Tensor) -> Iterator[Tensor]:
        """Pictures, 0..1, on the CPU, a chunk [n, 3, H, W] at a time."""
        autoencoder, dtype, device = self.models.autoencoder, self.models.dtype, self.placement.device

        def decoder(chunk: Tensor) -> Tensor:
            return decoded_in(dtype, device, lambda: autoencoder.decode(chunk, num_frames=len(chunk)).sample)

        size = self.options.decoded_together
        pixels = size * latents[0, 0].numel() * _PIXELS_PER_LATENT**2
        needed = autoencoder_bytes(pixels, autoencoder.config.block_out_channels[0])
        with self.placement.at_work(autoencoder, working_bytes=needed):
            for pictures in decode(decoder, latents / LATENT_SCALE, size=size):
                yield (pictures.cpu() + 1) / 2


def _as_tensor(picture: FloatImage) -> Tensor:
    """From shape [h, w, 3] to [1, 3, h, w], channel after channel: norms over groups are less exact otherwise."""
    return torch.from_numpy(picture).permute(2, 0, 1)[None].contiguous()


def _hint(sketch: FloatImage) -> Tensor:
    """Dark lines on white, shape [h, w], as the networks know them: lines 1 on 0, shape [1, 3, h, w]."""
    return torch.from_numpy(1 - sketch).expand(1, 3, -1, -1)
