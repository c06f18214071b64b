"""Informative drawings against the numbers that the public network gives with the same weights."""

from __future__ import annotations

import pytest
import reference_nets as reference
import torch
from physanimator.rendering.networks.checkpoints import build_without_storage, check_names
from physanimator.rendering.sketch.drawings import InformativeDrawingsConfiguration
from physanimator.rendering.sketch.drawings.informative_drawings import InformativeDrawings
from physanimator.rendering.sketch.drawings.strips import draw_in_strips

CASES = [
    (case, net) for case in reference.cases("informative_drawings") for net in reference.fixtures().cases[case]["nets"]
]


def network(case: str, net: str) -> InformativeDrawings:
    return InformativeDrawings.from_reference(reference.fixtures().nets[net]["config"], reference.state_dict(case, net))


@pytest.mark.parametrize(("case", "net"), CASES)
def test_drawing(case: str, net: str) -> None:
    described, drawer = reference.fixtures().cases[case], network(case, net)
    before: list[torch.Tensor] = []
    drawer.model4[1].register_forward_hook(lambda _, given, out: before.append(out.clone()))
    with torch.no_grad(), reference.recorded(case, "", drawer) as found:
        drawing = drawer(reference.inputs(case)["image"])
    got = {"out": drawing, "pre_sigmoid": before[0]}
    assert set(described["outputs"]) <= set(got)
    assert set(found) == set(described["summaries"])
    reference.assert_within_tolerance(case, {name: got[name] for name in described["outputs"]}, found)


@pytest.mark.parametrize(("case", "net"), CASES)
@pytest.mark.parametrize("rows", [12, 40])
def test_drawing_in_strips(case: str, net: str, rows: int) -> None:
    with torch.no_grad():
        drawing = draw_in_strips(network(case, net), reference.inputs(case)["image"], rows=rows)
    reference.assert_within_tolerance(case, {"out": drawing})


def test_every_public_name_has_its_place() -> None:
    built = build_without_storage(lambda: InformativeDrawings(InformativeDrawingsConfiguration()))
    ours = {name: tuple(tensor.shape) for name, tensor in built.state_dict().items()}
    check_names(ours, reference.full_shapes("informative_drawings_sk_model"), file="sk_model.pth", wanted="all names")
