"""Line drawing networks as a choice of the node Extract Sketch: their files, inputs and drawing."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ...rendering.sketch.drawings import DRAWING_FILES
from ..host import dtype_of
from .networks import kept_networks
from .option_inputs import precision_input

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["drawing_network_inputs", "missing_drawing_file", "network_sketch"]

_FOLDER = "annotators"
_WORDS = ("sk_model", "netg", "drawing", "sketch", "lineart")
_SUFFIXES = (".pth", ".pt", ".bin", ".ckpt", ".safetensors")
_BYTES_A_PIXEL = 1500
"""What drawing needs beside the weights, for each pixel that is drawn at once, with 32 bits."""


def drawing_network_inputs() -> list[Any]:
    """The inputs that this choice brings."""
    described = "; ".join(f"{file.name}: {file.draws}" for file in DRAWING_FILES)
    return [
        io.Combo.Input(
            "model",
            options=_choices(),
            tooltip=f"{described}. In models/controlnet or models/{_FOLDER}.",
        ),
        io.Int.Input(
            "working_size",
            default=0,
            min=0,
            max=16384,
            tooltip="Longer side of the picture that the network looks at [px]; smaller gives fewer and bolder lines."
            " 0: as the picture is; below 16 it is 16.",
        ),
        precision_input(),
    ]


def missing_drawing_file(choice: dict[str, Any]) -> str:
    """What to tell about the chosen model file if it is not there, with where to get it; else empty."""
    name = choice.get("model")
    if not name or _file(name) is not None:
        return ""
    known = next((file for file in DRAWING_FILES if file.name == name), DRAWING_FILES[0])
    return (
        f"{name} is missing: put {known.name} into models/controlnet or models/{_FOLDER}, from {known.page}"
        f" (licence: {known.licence}). Or set extractor to the one that needs no model."
    )


def network_sketch(picture: NDArray[Any], choice: dict[str, Any], **kept: Any) -> NDArray[Any]:
    """Dark lines on white paper, on the host's device, shape [h, w].

    Args:
        picture: RGB 0..1, shape [h, w, 3].
        choice: values of the inputs.
        kept: which lines to keep.
    """
    from comfy import model_management

    from ...physics.errors import InvalidInputError
    from ...rendering.sketch.drawings.extractor import LEAST_SIDE, STRIP_PIXELS, draw_sketch
    from ...rendering.sketch.drawings.models import load_drawer

    path = _file(choice["model"])
    if path is None:
        raise InvalidInputError(missing_drawing_file(choice))
    device = model_management.get_torch_device()
    dtype = dtype_of(choice["precision"], device)
    # A widget has no gap between 0, which takes the picture as it is, and the least.
    side = max(choice["working_size"], LEAST_SIDE) if choice["working_size"] else 0
    key = path, path.stat().st_mtime, dtype
    networks = kept_networks("line drawings", key, lambda: load_drawer(path, dtype=dtype))
    with networks.at_work(device, [networks.held], working_bytes=STRIP_PIXELS * _BYTES_A_PIXEL):
        return draw_sketch(picture, networks.held, working_size=side, **kept)


def _choices() -> list[str]:
    """The public files and those with similar names; the public ones are always among them."""
    found = [name for name, _ in _files()]
    return list(dict.fromkeys([*(file.name for file in DRAWING_FILES), *found]))


def _file(choice: str) -> Path | None:
    return next((path for name, path in _files() if name == choice), None)


def _files() -> Iterator[tuple[str, Path]]:
    import folder_paths

    for name in folder_paths.get_filename_list("controlnet"):
        path = folder_paths.get_full_path("controlnet", name)
        if path and any(word in name.lower() for word in _WORDS):
            yield name, Path(path)
    own = Path(folder_paths.models_dir) / _FOLDER
    if own.is_dir():
        yield from ((each.name, each) for each in sorted(own.iterdir()) if each.suffix in _SUFFIXES)
