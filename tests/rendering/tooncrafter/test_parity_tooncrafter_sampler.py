"""ToonCrafter's sampler, step by step, against the numbers of the original."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import reference_nets as reference
import torch
from physanimator.rendering.tooncrafter.guidance import guided
from physanimator.rendering.tooncrafter.noise_schedule import latent_scales, sampling_steps, signal_levels
from physanimator.rendering.tooncrafter.sampler import SampledStep, sample_ddim
from torch import Tensor

GROUP = "tooncrafter_ddim"
STUBS = [name for name in reference.cases(GROUP) if reference.fixtures().cases[name]["nets"] == ["stub"]]


def stub(given: dict[str, Tensor], settings: dict[str, Any]) -> Callable[[Tensor, int], Tensor]:
    """A velocity that stands in for the networks, with guidance."""

    def one(x: Tensor, timestep: int, condition: Tensor) -> Tensor:
        moved = torch.roll(x, 1, dims=2)
        return 0.5 * torch.tanh(x) - 0.2 * moved + 0.1 * float(np.sin(timestep / 100)) + 0.3 * condition

    def both(x: Tensor, timestep: int) -> Tensor:
        conditional, without = one(x, timestep, given["cond"]), one(x, timestep, given["uncond"])
        return guided(conditional, without, scale=settings["cfg"], rescale=settings["guidance_rescale"])

    return both


@pytest.mark.parametrize("case", [name for name in reference.cases(GROUP) if name.endswith("schedule")])
def test_schedule(case: str) -> None:
    alphas = signal_levels()
    betas = 1 - alphas / np.concatenate([[1], alphas[:-1]])
    found = {"betas": betas, "alphas_cumprod": alphas, "scale_arr": latent_scales()}
    reference.assert_within_tolerance(case, {name: torch.from_numpy(each) for name, each in found.items()})


@pytest.mark.parametrize("case", STUBS)
def test_trajectory(case: str) -> None:
    described, given = reference.fixtures().cases[case], reference.inputs(case)
    settings = described["config"]
    steps = sampling_steps(settings["steps"], eta=settings["eta"])
    got: dict[str, Tensor] = {}

    def watch(now: SampledStep) -> None:
        got[f"x_before_step{now.number:03d}"] = now.noisy
        got[f"pred_x0_step{now.number:03d}"] = now.clean

    def noise(number: int) -> Tensor:
        return torch.from_numpy(reference.fixtures().noise(case, number))

    got["samples"] = sample_ddim(stub(given, settings), given["x_T"], steps, noise, watch=watch)
    for name, field in {
        "timesteps_ascending": "timestep",
        "alphas": "alpha",
        "alphas_prev": "next_alpha",
        "sigmas": "sigma",
        "scale": "scale",
        "scale_prev": "next_scale",
    }.items():
        got[name] = torch.tensor([float(getattr(step, field)) for step in reversed(steps)])
    reference.assert_within_tolerance(case, {name: each for name, each in got.items() if name in described["outputs"]})
    assert set(described["outputs"]) <= set(got)
