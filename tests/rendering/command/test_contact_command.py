"""Contact on the command line and in the pipeline."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.scene import Contact
from physanimator.rendering.command import main
from physanimator.rendering.options import AutomaticWind, Timing, Touching
from physanimator.rendering.pictures import save_image
from physanimator.rendering.pipeline import animate


def picture() -> np.ndarray:
    return np.full((96, 128, 3), 200, dtype=np.uint8)


def rectangle(left: int, top: int, right: int, bottom: int) -> np.ndarray:
    mask = np.zeros((96, 128), dtype=bool)
    mask[top:bottom, left:right] = True
    return mask


def test_a_part_stays_out_of_a_collider() -> None:
    strand, post = rectangle(50, 10, 66, 80), rectangle(72, 5, 90, 90)
    options: dict[str, Any] = {"timing": Timing(frames=36), "wind": AutomaticWind(strength=8.0), "spacing": 5.0}
    free = animate(picture(), [strand], **options)
    assert free.motion.positions[:, :, 0].max() > 78
    held = animate(picture(), [strand], **options, touching=Touching(contact=Contact(), colliders=[post]))
    assert held.motion.positions[:, :, 0].max() < 72.1


def test_colliders_without_contact_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="contact must be given"):
        animate(
            picture(),
            [rectangle(50, 10, 66, 80)],
            timing=Timing(frames=2),
            touching=Touching(colliders=[rectangle(72, 5, 90, 90)]),
        )


def test_the_command_line_takes_colliders(tmp_path: Path) -> None:
    for name, mask in (("strand", rectangle(50, 10, 66, 80)), ("post", rectangle(72, 5, 90, 90))):
        save_image(tmp_path / f"{name}.png", np.repeat(mask[:, :, None], 3, axis=2).astype(np.uint8) * 255)
    save_image(tmp_path / "picture.png", picture())
    arguments = ["animate", str(tmp_path / "picture.png"), "--mask", str(tmp_path / "strand.png"), "--frames", "3"]
    arguments += ["--collider", str(tmp_path / "post.png"), "-o", str(tmp_path / "out.gif"), "--quiet"]
    assert main(arguments) == 0
    assert (tmp_path / "out.gif").stat().st_size > 0
