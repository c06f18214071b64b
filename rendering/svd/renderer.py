"""Frames from an illustration and its sketches (paper, Method, "Sketch-Guided Rendering"), or from an animation."""

from __future__ import annotations

import itertools
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
from .crude_animation import CrudeAnimation
from .decoding import around_the_wrap, decode, decoding_chunks
from .dual_clock import DualClock, step_at
from .encoded_animation import PIXELS_PER_LATENT, encode_animation
from .loop_segments import plan_clip
from .models import SVDModels
from .noise_schedule import noise_levels
from .options import SVDOptions
from .prediction import plain_predictor, sketch_predictor
from .sampler import LATENT_SCALE, SampledStep, sample_clip
from .segments import Segment

__all__ = ["SVDRenderer"]

FloatImage = NDArray[np.float32]


class SVDRenderer:
    """Draws the frames of a clip that follow given sketches, a given animation, or both."""

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

        Raises:
            InvalidInputError: the networks do not fit what frames should follow.
        """
        self.models = models
        self.options = options or SVDOptions()
        self.placement = placement or Placement(torch.device("cpu"))
        with_lvcd, follow = models.control is not None, self.options.follow
        what = "with LVCD, which reads sketches" if self.options.follows_sketches else "Stable Video Diffusion's alone"
        got = f"networks {'with' if with_lvcd else 'without'} LVCD"
        require("models", got, with_lvcd == self.options.follows_sketches, f"{what}, to follow {follow}")

    def frames(
        self,
        image: NDArray[Any],
        sketches: Sequence[NDArray[Any]] = (),
        *,
        animation: CrudeAnimation | None = None,
        progress: Progress | None = None,
        watch: Callable[[SampledStep], None] | None = None,
        loops: bool = False,
    ) -> Iterator[FloatImage]:
        """All frames of the clip; frame 0 is the illustration as the autoencoder sees it.

        Args:
            image: the illustration, RGB, uint8 or float in 0..1, shape [h, w, 3].
            sketches: dark lines on white, one for each frame, the illustration's own first, RGB or grey, of its size;
                none where only the animation is followed.
            animation: frames of the illustration's size; None where only sketches are followed.
            progress: called after each encoded frame of the animation, each sampling step and each decoded chunk with
                the number done and the number in all; may raise to stop.
            watch: called in each sampling step; may raise to stop.
            loops: the last frame leads to frame 1, which follows it when the clip is shown again without frame 0.

        Returns:
            An iterator over float32 pictures, 0..1, shape [h, w, 3]. Bad input raises here.
        """
        image = as_picture(image)
        if self.options.follows_sketches:
            _check_sketches(image, sketches)
        else:
            require("sketches", len(sketches), len(sketches) == 0, "left out where frames follow the animation alone")
        count = len(sketches)
        if self.options.follows_animation:
            frames = f"{count}, one for each sketch" if count else "2 or more: the illustration and another"
            got = animation.count if animation is not None else 0
            require("frames of the animation", got, got >= 2 and (not count or got == count), frames)
            count = got
        else:
            require("animation", "one", animation is None, "left out where frames follow sketches alone")
        return self._frames(image, sketches, animation, count, progress, watch, loops)

    def _frames(
        self,
        image: NDArray[Any],
        sketches: Sequence[NDArray[Any]],
        animation: CrudeAnimation | None,
        count: int,
        progress: Progress | None,
        watch: Callable[[SampledStep], None] | None,
        loops: bool,
    ) -> Iterator[FloatImage]:
        options, frame = self.options, Frame.around(image.shape[1], image.shape[0], area=self.options.area)
        animation = animation if self._strong else None
        segments = plan_clip(count, options.overlap, loops=loops, plain=not options.follows_sketches)
        decoded = around_the_wrap(count) if loops else list(range(count))
        encoded = animation.count if animation is not None else 0
        steps = (options.steps - (self._weak if encoded else 0)) * len(segments)
        total = encoded + steps + len(list(decoding_chunks(len(decoded), options.decoded_together)))

        def report(done: int) -> None:
            if progress is not None:
                progress(done, total)

        def each_step(now: SampledStep) -> None:
            if watch is not None:
                watch(now)
            report(encoded + now.done)

        generator = torch.Generator().manual_seed(options.seed)
        width, height = (side // PIXELS_PER_LATENT for side in frame.size)
        noise = torch.randn((segments[0].layout.count, 4, height, width), generator=generator)
        conditioning = condition_on(
            _as_tensor(frame.inward(as_float(image))),
            self.models,
            options=options,
            placement=self.placement,
            generator=generator,
        )
        clock = self._clock(animation, frame, report)
        hints = [_hint(frame.inward(as_grey(sketch))) for sketch in sketches]
        guides = torch.cat(hints) if hints else torch.empty((count, 0))
        latents = self._sampled(conditioning, guides, noise, segments, clock, each_step)
        more = (len(decoded) - count) // 2
        shown = iter([number == 0 or more < number < len(decoded) - more for number in range(len(decoded))])
        for number, pictures in enumerate(self._decoded(latents[decoded]), start=1):
            report(encoded + steps + number)
            for picture in pictures:
                if next(shown):
                    yield frame.outward(picture.permute(1, 2, 0).contiguous().numpy())

    @property
    def _weak(self) -> int:
        return step_at(self.options.weak, self.options.steps)

    @property
    def _strong(self) -> int:
        """Number of the step until which an animation leads; 0: none does."""
        options = self.options
        return step_at(options.strong, options.steps) if options.follows_animation else 0

    def _clock(self, animation: CrudeAnimation | None, frame: Frame, report: Callable[[int], None]) -> DualClock | None:
        if animation is None:
            return None
        done = itertools.count(1)
        latents, moves = encode_animation(
            animation, frame, self.models, placement=self.placement, each=lambda: report(next(done))
        )
        return DualClock(latents, moves, self._weak, self._strong)

    def _sampled(
        self,
        conditioning: Conditioning,
        hints: Tensor,
        noise: Tensor,
        segments: Sequence[Segment],
        clock: DualClock | None,
        watch: Callable[[SampledStep], None],
    ) -> Tensor:
        """Latents of all frames, scaled, on the device."""
        models = self.models
        if models.control is None:
            predict = plain_predictor(models, conditioning, self.options.guidance)
        else:
            predict = sketch_predictor(models, models.control, conditioning)
        networks = [each for each in (models.unet, models.control) if each is not None]
        needed = sampling_bytes(noise[:, 0].numel(), models.unet.config.model_channels, models.dtype)
        with self.placement.at_work(*networks, working_bytes=needed):
            return sample_clip(
                predict,
                conditioning.latent,
                hints,
                noise.to(self.placement.device),
                sigmas=noise_levels(self.options.steps),
                overlap=self.options.overlap,
                watch=watch,
                segments=segments,
                clock=clock,
            )

    def _decoded(self, latents: Tensor) -> Iterator[Tensor]:
        """Pictures, 0..1, on the CPU, a chunk [n, 3, H, W] at a time."""
        autoencoder, dtype, device = self.models.autoencoder, self.models.dtype, self.placement.device

        def decoder(chunk: Tensor) -> Tensor:
            return decoded_in(dtype, device, lambda: autoencoder.decode(chunk, num_frames=len(chunk)).sample)

        size = self.options.decoded_together
        pixels = size * latents[0, 0].numel() * PIXELS_PER_LATENT**2
        needed = autoencoder_bytes(pixels, autoencoder.config.block_out_channels[0])
        with self.placement.at_work(autoencoder, working_bytes=needed):
            for pictures in decode(decoder, latents / LATENT_SCALE, size=size):
                yield (pictures.cpu() + 1) / 2


def _check_sketches(image: NDArray[Any], sketches: Sequence[NDArray[Any]]) -> None:
    height, width = image.shape[:2]
    require("sketches", f"{len(sketches)}", len(sketches) >= 2, "2 or more: the illustration's and another frame's")
    sizes = {sketch.shape[:2] for sketch in sketches}
    expected = f"of the illustration's size, {width} x {height} px"
    require("sketches", sorted(sizes), sizes == {(height, width)}, expected)


def _as_tensor(picture: FloatImage) -> Tensor:
    """From shape [h, w, 3] to [1, 3, h, w], channel after channel: norms over groups are less exact otherwise."""
    return torch.from_numpy(picture).permute(2, 0, 1)[None].contiguous()


def _hint(sketch: FloatImage) -> Tensor:
    """Dark lines on white, shape [h, w], as the networks know them: lines 1 on 0, shape [1, 3, h, w]."""
    return torch.from_numpy(1 - sketch).expand(1, 3, -1, -1)
