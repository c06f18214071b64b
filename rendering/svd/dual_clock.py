"""Dual-clock denoising: a crude animation leads what moves for longer than what does not.

Time-to-Move (Singer et al., 2025, arXiv 2511.08633), here with the Euler steps of Stable Video Diffusion. Let z be the
latents of the crude animation, e one draw of noise, s_0 > ... > s_N = 0 the noise levels, m = 1 in latent cells where
something moves and 0 elsewhere, and 0 <= weak <= strong <= N two of the steps. Sampling starts at step ``weak``, from

    x_weak = z + s_weak e,

and each step i goes on from what the network makes of x_i, y_(i+1) = Euler(x_i, s_i, s_(i+1)), with

    x_(i+1) = m (z + s_(i+1) e) + (1 - m) y_(i+1)    for i < strong,
    x_(i+1) = y_(i+1)                                from there on.

So what stands still and what was uncovered is repainted from noise level s_weak down, and what moves only from s_strong
down: it keeps the animation's path, and gets shading and folds that the animation lacks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor

__all__ = ["DualClock", "step_at"]


def step_at(part: float, steps: int) -> int:
    """The step that lies nearest to a part of all steps, the later of two.

    Args:
        part: 0 to 1.
        steps: number of all steps.
    """
    return int(part * steps + 0.5)


@dataclass(frozen=True, eq=False)
class DualClock:
    """A crude animation, and how long it leads.

    Attributes:
        latents: of each frame of the animation, scaled as the sampler's are, shape [f, 4, h, w].
        moves: where something moves in each of them, bool, shape [f, 1, h, w].
        weak: number of the step at which sampling starts.
        strong: number of the step from which nothing is put back.
    """

    latents: Tensor
    moves: Tensor
    weak: int
    strong: int

    def start(self, frames: Sequence[int], noise: Tensor, sigma: Tensor) -> Tensor:
        """What sampling starts from.

        Args:
            frames: number of the frame that each slot shows.
            noise: of each slot, shape [t, 4, h, w].
            sigma: noise level of step ``weak``.
        """
        return self.latents[list(frames)] + sigma * noise

    def put_back(self, x: Tensor, frames: Sequence[int], noise: Tensor, step: int, sigma: Tensor) -> Tensor:
        """What the next step goes on from.

        Args:
            x: latents after a step, shape [t, 4, h, w].
            frames: see :meth:`start`.
            noise: see :meth:`start`; the same.
            step: number of that step.
            sigma: noise level that it has reached.
        """
        if step >= self.strong:
            return x
        return torch.where(self.moves[list(frames)], self.latents[list(frames)] + sigma * noise, x)
