"""The sampler and the schedules of long clips against the public ones.

With the networks, a step takes nearly a second, and only the first step of each segment is theirs here: it shows what
they are handed, in a first segment and in a later one (noise, conditions, sketches, layout). How a step follows from
another, how segments are blended, and what comes of it in the end is proved with the stand-in, in all steps of three
segments. ``PHYSANIMATOR_FIXTURES``, also with the project's own set, lets the networks predict every step.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from itertools import count
from typing import Any

import pytest
import reference_nets as reference
import torch
from physanimator.rendering.svd import FrameLayout
from physanimator.rendering.svd.controlnet import SketchControlNet
from physanimator.rendering.svd.decoding import decoding_chunks
from physanimator.rendering.svd.noise_schedule import Preconditioning, denoised, euler_step, noise_levels
from physanimator.rendering.svd.sampler import Predictor, SampledStep, sample_clip
from physanimator.rendering.svd.segments import plan_segments
from physanimator.rendering.svd.unet import SpatioTemporalUNet
from torch import Tensor

GROUP = "lvcd_sampler"
EULER = [name for name in reference.cases(GROUP) if "network_output" in reference.fixtures().cases[name]["inputs"]]
LONG = [name for name in reference.cases(GROUP) if "sketches" in reference.fixtures().cases[name]["inputs"]]
SCHEDULE = f"{GROUP}/frame_schedule.json"
ALL_STEPS = "PHYSANIMATOR_FIXTURES" in os.environ


@pytest.mark.parametrize("case", EULER)
def test_noise_levels_and_euler_step(case: str) -> None:
    settings, given = reference.fixtures().cases[case]["config"], reference.inputs(case)
    limits = {name: settings[name] for name in ("sigma_min", "sigma_max", "rho")}
    sigmas = noise_levels(settings["num_steps"], **limits)
    use = Preconditioning.at(sigmas[:-1])
    sigma, following = sigmas[settings["euler_step_index"] :][:2]
    clean = denoised(given["x"], given["network_output"], sigma)
    got = {"sigmas": sigmas, "c_skip": use.skip, "c_out": use.out, "c_in": use.into, "c_noise": use.level}
    got |= {"denoised": clean, "x_next": euler_step(given["x"], clean, sigma, following)}
    assert set(got) == set(reference.fixtures().cases[case]["outputs"])
    reference.assert_within_tolerance(case, got)


def stub(x: Tensor, condition: Tensor, sketches: Tensor, noise_level: Tensor, layout: FrameLayout) -> Tensor:
    """The set's stand-in for the networks."""
    pooled = torch.nn.functional.avg_pool2d(sketches.mean(dim=1, keepdim=True), 8)
    out = 0.5 * x.tanh() + 0.3 * condition / 4 - 0.4 * pooled + 0.1 * noise_level.sin() + 0.2 * x.mean(dim=0)
    return out + 0.15 * x.cos() if layout.runs[-1].own[-1] != layout.count - 1 else out


def networks(case: str, given: dict[str, Tensor]) -> Predictor:
    nets = reference.fixtures().nets
    unet, control = (
        network.from_reference(nets[net]["config"], reference.state_dict(case, net))
        for network, net in ((SpatioTemporalUNet, "lvcd_unet"), (SketchControlNet, "lvcd_control"))
    )

    def predict(x: Tensor, condition: Tensor, sketches: Tensor, noise_level: Tensor, layout: FrameLayout) -> Tensor:
        both = torch.cat([x, condition], dim=1)[None]
        conditions = (noise_level[None], given["context"], given["added_ids"], layout)
        return unet(both, *conditions, control(both, sketches[None], *conditions))[0]

    return predict


def begun(predict: Predictor, results: Sequence[Tensor], sigmas: Tensor) -> Predictor:
    """Predicts the first step of each segment; all later ones go straight to the segment's known result."""
    calls, steps = count(), len(sigmas) - 1

    def first_step(x: Tensor, condition: Tensor, sketches: Tensor, noise_level: Tensor, layout: FrameLayout) -> Tensor:
        segment, step = divmod(next(calls), steps)
        if step == 0:
            return predict(x, condition, sketches, noise_level, layout)
        use = Preconditioning.at(sigmas[step])
        return (results[segment] - use.skip * x / use.into) / use.out

    return first_step


@pytest.mark.parametrize("case", LONG)
def test_long_clips(case: str) -> None:
    described, given = reference.fixtures().cases[case], reference.inputs(case)
    settings, with_networks = described["config"], "lvcd_unet" in described["nets"]
    predict, sigmas = networks(case, given) if with_networks else stub, noise_levels(settings["num_steps"])
    outputs = set(described["outputs"])
    if with_networks and not ALL_STEPS:
        results = [reference.outputs(case)[f"segment{number}_final"] for number in range(settings["segments"])]
        predict = begun(predict, results, sigmas)
        outputs = {"latents"} | {name for name in outputs if name.endswith("_step00")}
        assert len(outputs) > settings["segments"]
    segments = plan_segments(len(given["sketches"]), settings["overlap"])
    assert len(segments) == settings["segments"]
    got: dict[str, Tensor] = {}

    def watch(now: SampledStep) -> None:
        prefix, step = f"segment{now.segment}", f"step{now.step:02d}"
        got[f"{prefix}_x_{step}"], got[f"{prefix}_denoised_{step}"] = now.noisy, now.clean
        if now.step + 1 == settings["num_steps"]:  # the last step ends on the denoised latents
            got[f"{prefix}_final"] = final = now.clean.clone()
            blended, start = list(segments[now.segment].blended), segments[now.segment].layout.references
            if blended:
                final[start : start + len(blended)] = got[f"segment{now.segment - 1}_final"][blended]

    options: dict[str, Any] = {"sigmas": sigmas, "overlap": settings["overlap"], "watch": watch}
    got["latents"] = sample_clip(predict, given["first_latent"], given["sketches"], given["x_T"], **options)
    wanted = {name: each for name, each in got.items() if name in outputs}
    assert set(wanted) == outputs
    reference.assert_within_tolerance(case, wanted)


@pytest.mark.parametrize("entry", reference.text_of(SCHEDULE)["sampling"], ids=lambda entry: entry["sketches"])
def test_segments(entry: dict[str, Any]) -> None:
    """The public schedule ignores surplus sketches; ours makes their frames, and agrees on all that it makes."""
    segments = plan_segments(entry["output_frames"])
    assert len(segments) == len(entry["segments"])
    made = [{"segment": number, "slot": slot} for number, each in enumerate(segments) for slot in each.made]
    assert ["first", *made] == entry["output_source"]
    for ours, theirs in zip(segments, entry["segments"], strict=True):
        assert list(ours.sketches) == theirs["sketch_of_slot"]
        assert list(ours.noise) == theirs["initial_noise_of_slot"]
        assert list(ours.blended) == theirs["blend_from_previous_slot"]
        first = ours.layout.references
        assert list(range(first, first + len(ours.blended))) == theirs["blended_slots"]
        carried = [{"previous_slot": slot} for slot in ours.carried]
        others = ["first"] * (ours.layout.count - 1 - len(carried))
        assert ["first", *carried, *others] == theirs["concat_latent_of_slot"]


@pytest.mark.parametrize("entry", reference.text_of(SCHEDULE)["decoding"], ids=lambda entry: entry["latents"])
def test_decoding_chunks(entry: dict[str, Any]) -> None:
    chunks = list(decoding_chunks(entry["latents"]))
    assert [list(chunk.frames) for chunk in chunks] == entry["chunks"]
    kept = [
        {"chunk": number, "slot": slot}
        for number, chunk in enumerate(chunks)
        for slot in range(chunk.kept, len(chunk.frames))
    ]
    assert kept == entry["output_source"]
