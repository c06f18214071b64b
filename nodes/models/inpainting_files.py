"""Where the host keeps the diffusers folders of soft inpainting."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

__all__ = ["inpainting_choices", "inpainting_folder", "missing_inpainting_model"]

_USUAL = "stable-diffusion-inpainting"
_PARTS = ("unet", "text_encoder", "vae")


def inpainting_choices() -> list[str]:
    """Names of folders, those for inpainting first; the usual name is always among them."""
    names = list(dict.fromkeys(each.name for each in _folders()))
    likely = sorted(names, key=lambda name: "inpaint" not in name.lower())
    return likely if _USUAL in likely else [_USUAL, *likely]


def inpainting_folder(choice: str) -> Path | None:
    """Path of a folder, or None where it is missing."""
    return next((each for each in _folders() if each.name == choice), None)


def missing_inpainting_model(choice: str) -> str:
    """What to put where."""
    return (
        f"{choice} is missing: put the folder of a Stable Diffusion 1 or 2 model in diffusers' format, with unet, vae,"
        " text_encoder, tokenizer and scheduler, into models/diffusers, best one for inpainting, such as"
        " https://huggingface.co/stable-diffusion-v1-5/stable-diffusion-inpainting (CreativeML Open RAIL-M)."
        " Or set renderer to composite, which needs no model."
    )


def _folders() -> Iterator[Path]:
    import folder_paths

    for root in map(Path, folder_paths.get_folder_paths("diffusers")):
        if root.is_dir():
            found = (each for each in sorted(root.iterdir()))
            yield from (each for each in found if all((each / part / "config.json").is_file() for part in _PARTS))
