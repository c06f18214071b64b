"""Layered pictures: a drawn figure apart from what is behind it, so that what its moving part hides is known."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import source_tree  # noqa: F401  (loads this source tree as the package physanimator)
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.pictures import load_image, load_mask
from PIL import Image

__all__ = ["LayeredSample", "load_sample", "sample_folders"]

FILES = ("composite.png", "sprite.png", "background.png")


@dataclass(frozen=True, eq=False)
class LayeredSample:
    """One layered picture.

    Attributes:
        name: of its folder.
        picture: the flat drawing, uint8, shape [h, w, 3].
        sprite: the figure alone, straight RGB and alpha in 0 to 1, float32, shape [h, w, 4].
        background: what is behind it, float32 in 0 to 1, shape [h, w, 3].
        mask: the part that moves, 0 to 1, float32, shape [h, w].
    """

    name: str
    picture: np.ndarray
    sprite: np.ndarray
    background: np.ndarray
    mask: np.ndarray


def sample_folders(folder: Path) -> list[Path]:
    """The layered samples in a folder, or the folder itself if it is one.

    Raises:
        InvalidInputError: there are none.
    """
    if not folder.is_dir():
        raise InvalidInputError(f"FOLDER must be a folder of layered samples. Got: {folder}")
    if (folder / FILES[0]).is_file():
        return [folder]
    found = [each for each in sorted(folder.iterdir()) if (each / FILES[0]).is_file()]
    if not found:
        raise InvalidInputError(f"FOLDER must hold folders with {', '.join(FILES)} and a mask. Got: none in {folder}")
    return found


def load_sample(folder: Path, *, mask_name: str = "mask.png") -> LayeredSample:
    """Read one layered picture.

    Args:
        folder: holds the composite, the sprite, the background and the mask.
        mask_name: file name of the mask; if there is none of this name, the only other ``*mask*.png`` is taken,
            ``mask_sprite.png`` (the whole figure) only if there is no other.

    Raises:
        InvalidInputError: a file is missing, has another size, or the sprite has no transparency.
    """
    missing = [name for name in FILES if not (folder / name).is_file()]
    if missing:
        raise InvalidInputError(
            f"sample {folder} must hold {', '.join(FILES)} and a mask. Missing: {', '.join(missing)}"
        )
    picture, background = (load_image(folder / name) for name in (FILES[0], FILES[2]))
    height, width = picture.shape[:2]
    mask = load_mask(_mask_file(folder, mask_name), width=width, height=height)
    with Image.open(folder / FILES[1]) as opened:
        if opened.mode not in ("RGBA", "LA", "PA") and "transparency" not in opened.info:
            raise InvalidInputError(f"{folder / FILES[1]} must be transparent where the figure is not. Got: no alpha")
        sprite = np.asarray(opened.convert("RGBA"))
    for name, layer in (("sprite.png", sprite), ("background.png", background)):
        if layer.shape[:2] != (height, width):
            got = f"{layer.shape[1]} x {layer.shape[0]} px"
            raise InvalidInputError(
                f"{folder / name} must have the composite's size, {width} x {height} px. Got: {got}"
            )
    as_float = [layer.astype(np.float32) / np.float32(255) for layer in (sprite, background)]
    return LayeredSample(folder.name, picture, as_float[0], as_float[1], mask)


def _mask_file(folder: Path, name: str) -> Path:
    if (folder / name).is_file():
        return folder / name
    others = sorted(folder.glob("*mask*.png"))
    parts = [each for each in others if each.name != "mask_sprite.png"] or others
    if len(parts) != 1:
        got = ", ".join(each.name for each in parts) or "none"
        raise InvalidInputError(f"sample {folder} must hold {name}, or one mask of another name. Got: {got}")
    return parts[0]
