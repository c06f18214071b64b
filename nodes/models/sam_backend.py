"""Segment Anything as a choice of the node Segment by Points: its inputs, and the network that they make."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ...physics.errors import InvalidInputError
from ..host import PRECISIONS, dtype_of
from .networks import kept_networks
from .sam_files import missing_sam_model, sam_choices, sam_file

if TYPE_CHECKING:
    from ...rendering.segmentation.sam.segmenter import SamSegmenter

__all__ = ["missing_sam_files", "sam_inputs", "sam_network"]


def sam_inputs() -> list[Any]:
    """The inputs that this choice brings."""
    return [
        io.Combo.Input(
            "sam_model",
            options=sam_choices(),
            tooltip="In models/sams: a folder with config.json and model.safetensors (SAM, SAM-HQ, SAM 2, EdgeTAM,"
            " SAM 3), or one of SAM's own .pth files.",
        ),
        io.Combo.Input(
            "precision",
            options=list(PRECISIONS),
            default="fp32",
            tooltip="fp32 is exact; fp16 and bf16 take half the memory; auto is what suits the graphics card.",
        ),
    ]


def missing_sam_files(choice: dict[str, Any]) -> str:
    """Where to get the chosen model, or nothing where it is there or none is chosen."""
    name = choice.get("sam_model")
    return missing_sam_model(name) if name and sam_file(name) is None else ""


@contextmanager
def sam_network(choice: dict[str, Any]) -> Iterator[SamSegmenter]:
    """The chosen network on the host's device, for as long as it is used.

    Raises:
        InvalidInputError: its files are missing or hold something else.
    """
    from comfy import model_management

    from ...rendering.segmentation.sam.segmenter import SamSegmenter
    from ...rendering.segmentation.sam.weights import load_network

    path = sam_file(choice["sam_model"])
    if path is None:
        raise InvalidInputError(missing_sam_model(choice["sam_model"]))
    device = model_management.get_torch_device()
    dtype = dtype_of(choice["precision"], device)
    networks = kept_networks("segment anything", (path, _changed(path), dtype), lambda: load_network(path, dtype=dtype))
    network, family = networks.held
    size = sum(each.numel() * each.element_size() for each in network.parameters())
    with networks.at_work(device, [network], working_bytes=2 * size):
        yield SamSegmenter(network, family, device)


def _changed(path: Path) -> float:
    """When the newest of a model's files was written."""
    return (
        max((each.stat().st_mtime for each in path.iterdir()), default=0.0) if path.is_dir() else path.stat().st_mtime
    )
