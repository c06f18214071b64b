"""The reference of the library: a page for every room that people import from, written by autodoc from docstrings."""

from __future__ import annotations

import importlib
from pathlib import Path

from .markdown import escaped

__all__ = ["ROOMS", "library_pages"]

ROOMS = {
    "Physics": (
        "physics.errors physics.mesh physics.material physics.forces physics.rig physics.scene physics.document "
        "physics.motion physics.assembly physics.simulation"
    ),
    "Pictures from motion": (
        "rendering.pipeline rendering.options rendering.physics_options rendering.animation "
        "rendering.pictures rendering.artwork rendering.matting rendering.plate rendering.composite "
        "rendering.overlays rendering.sketch rendering.control rendering.inbetweens rendering.metrics "
        "rendering.segmentation rendering.svd rendering.neural "
        "rendering.training"
    ),
}
"""Rooms by their house, from the ground up."""


def library_pages(root: Path) -> dict[str, str]:
    """The pages by their names, and an index of them."""
    del root  # what is told of the rooms is imported, and so the tree that is being documented
    parts = [
        "# Library\n",
        "Each step is a room that works alone; import from the room, as the examples do. `physics` needs neither torch"
        " nor a host. Pixels: x to the right, y down, pixel centres at integer + 0.5. Bad input raises"
        " `physanimator.physics.errors.InvalidInputError` with one sentence.\n",
        "```python\nfrom physanimator.rendering.pipeline import animate\n"
        "from physanimator.rendering.pictures.images import load_image, load_mask\n\n"
        'picture = load_image("girl.png", alpha=True)\n'
        'mask = load_mask("hair.png", width=picture.shape[1], height=picture.shape[0])\n'
        'animate(picture, [mask], preset="hair").save("girl.mp4")\n```\n',
    ]
    texts = {}
    for house, rooms in ROOMS.items():
        parts.append(f"## {house}\n")
        for room in rooms.split():
            name = f"physanimator.{room}"
            summary = (importlib.import_module(name).__doc__ or "").strip().splitlines()[0]
            parts.append(f"- [`{name}`]({room}.md): {escaped(summary)}")
            texts[f"{room}.md"] = f"# {room}\n\n```{{eval-rst}}\n.. automodule:: {name}\n```\n"
        parts.append("\n```{toctree}\n:hidden:\n\n" + "\n".join(rooms.split()) + "\n```\n")
    return {"index.md": "\n".join(parts), **texts}
