"""The illustration that comes with the pack, so that a workflow opens with nothing to download."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from comfy_api.latest import io, ui

from .host import batch_of_masks, batch_of_pictures

__all__ = ["EXAMPLE_MASKS", "ExampleIllustration"]

FOLDER = Path(__file__).resolve().parents[1] / "workflows" / "example"
EXAMPLE_MASKS = ("hair", "ribbon", "cape", "plant")


class ExampleIllustration(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_ExampleIllustration",
            display_name="Example Illustration",
            category="PhysAnimator/examples",
            description="The illustration that comes with PhysAnimator, with a mask for each part that may move.",
            inputs=[],
            outputs=[
                io.Image.Output(display_name="image", tooltip="The illustration, 1280 x 720 px."),
                *(
                    io.Mask.Output(f"mask_{part}", display_name=part, tooltip=f"White where the {part} is to be seen.")
                    for part in EXAMPLE_MASKS
                ),
            ],
        )

    @classmethod
    def execute(cls) -> io.NodeOutput:
        image = batch_of_pictures([_read("illustration.png", "RGB")], 1)
        masks = [batch_of_masks([_read(f"mask_{part}.png", "L")], 1) for part in EXAMPLE_MASKS]
        return io.NodeOutput(image, *masks, ui=ui.PreviewImage(image))


def _read(name: str, mode: str) -> np.ndarray:
    from PIL import Image

    with Image.open(FOLDER / name) as picture:
        return np.asarray(picture.convert(mode))
