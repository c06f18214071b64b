"""The video networks against the numbers that the public ones give with the same weights."""

from __future__ import annotations

from typing import Any

import pytest
import reference_nets as reference
import torch
from physanimator.rendering.networks.checkpoints import build_without_storage, check_names
from physanimator.rendering.svd import FrameLayout, NetworkConfiguration
from physanimator.rendering.svd.controlnet import SketchControlNet
from physanimator.rendering.svd.unet import SpatioTemporalUNet

UNET, CONTROL = "lvcd_unet", "lvcd_control"


def layout_of(settings: dict[str, Any]) -> FrameLayout:
    if settings["mode"] == "train":
        return FrameLayout.single_reference(settings["T"])
    if settings["mode"] == "normal":
        return FrameLayout.first_segment(settings["overlap"])
    return FrameLayout.later_segment(settings["overlap"], amplification=settings["amplify"])


def configuration(net: str) -> dict[str, Any]:
    return reference.fixtures().nets[net]["config"]


@pytest.mark.parametrize("case", reference.cases("lvcd"))
def test_networks_give_the_reference_numbers(case: str) -> None:
    described = reference.fixtures().cases[case]
    given, layout = reference.inputs(case), layout_of(described["config"])
    conditions = (given["c_noise"], given["context"], given["added_ids"], layout)
    got: dict[str, torch.Tensor] = {}
    between: dict[str, torch.Tensor] = {}
    control = None
    with torch.no_grad():
        if CONTROL in described["nets"]:
            net = SketchControlNet.from_reference(configuration(CONTROL), reference.state_dict(case, CONTROL))
            with reference.recorded(case, "control", net) as found:
                control = net(given["x"], given["hint"], *conditions)
            between |= found
            named = {f"control_{number:02d}": each for number, each in enumerate(control)}
            got |= {name: each for name, each in named.items() if name in described["outputs"]}
            between |= {name: each for name, each in named.items() if name in described.get("summaries", {})}
        unet = SpatioTemporalUNet.from_reference(configuration(UNET), reference.state_dict(case, UNET))
        with reference.recorded(case, "unet", unet) as found:
            got["out"] = unet(given["x"], *conditions, control)
    between |= {name: each for name, each in found.items() if name not in got}
    got |= {name: each for name, each in found.items() if name in described["outputs"]}
    assert len(between) >= 0.9 * len(described.get("summaries", {}))
    reference.assert_within_tolerance(case, got, between)


@pytest.mark.parametrize(("network", "net"), [(SpatioTemporalUNet, UNET), (SketchControlNet, CONTROL)])
def test_every_public_name_has_its_place(network: type[SpatioTemporalUNet | SketchControlNet], net: str) -> None:
    built = build_without_storage(lambda: network(NetworkConfiguration()))
    ours = {network.prefix + name: tuple(tensor.shape) for name, tensor in built.state_dict().items()}
    check_names(ours, reference.full_shapes(net), file=f"{net}.json", wanted="all names")


def test_lvcds_file_is_the_control_net_and_attention_of_the_unet() -> None:
    built = build_without_storage(lambda: SpatioTemporalUNet(NetworkConfiguration()))
    attention = {
        SpatioTemporalUNet.prefix + name: tuple(tensor.shape)
        for name, tensor in built.state_dict().items()
        if ".attn1." in name
    }
    expected = {**reference.full_shapes(CONTROL), **attention}
    check_names(expected, reference.full_shapes("lvcd_ckpt"), file="lvcd_ckpt.json", wanted="all names")
