"""ToonCrafter's sketch encoder against the numbers that the public one gives with the same weights."""

from __future__ import annotations

import pytest
import reference_nets as reference
import torch
from physanimator.rendering.networks.checkpoints import build_without_storage, check_names
from physanimator.rendering.tooncrafter import SketchEncoderConfiguration
from physanimator.rendering.tooncrafter.sketch_encoder import SketchEncoder

NET = "sketch_encoder"


@pytest.mark.parametrize("case", reference.cases("sketch_encoder"))
def test_residuals(case: str) -> None:
    described, given = reference.fixtures().cases[case], reference.inputs(case)
    net = SketchEncoder.from_reference(reference.fixtures().nets[NET]["config"], reference.state_dict(case, NET))
    with torch.no_grad(), reference.recorded(case, "", net) as found:
        residuals = net(given["x"], given["hint"], given["t"], given["context"])
    named = found | {f"control_{number:02d}": each for number, each in enumerate(residuals)}
    got = {name: each for name, each in named.items() if name in described["outputs"]}
    between = {name: each for name, each in named.items() if name in described["summaries"]}
    assert set(got) == set(described["outputs"])
    assert len(between) >= 0.9 * len(described["summaries"])
    reference.assert_within_tolerance(case, got, between)


def test_every_public_name_has_its_place() -> None:
    built = build_without_storage(lambda: SketchEncoder(SketchEncoderConfiguration()))
    ours = {name: tuple(tensor.shape) for name, tensor in built.state_dict().items()}
    check_names(ours, reference.full_shapes("sketch_encoder_ckpt"), file="sketch_encoder.ckpt", wanted="all names")
