"""Where the host keeps the files that a backend needs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...rendering.inbetweens import ModelFile

__all__ = ["SVD_FILES", "find_model_file", "lvcd_choices", "lvcd_file", "svd_choices", "svd_file"]

SVD_FILES = {
    "svd_model": "put svd.safetensors into models/checkpoints, from"
    " https://huggingface.co/stabilityai/stable-video-diffusion-img2vid (Stability AI Community License).",
    "lvcd_model": "put lvcd.ckpt into models/controlnet, from"
    " https://huggingface.co/luckyhzt/lvcd_pretrained_models, or lvcd-fp16.safetensors, from"
    " https://huggingface.co/Kijai/LVCD-pruned (read their licences there).",
}
"""Where to get the model files that the sketch-guided renderer needs, by the input that names them."""

_SVD, _LVCD = "svd.safetensors", "lvcd.ckpt"
_FOLDER = "diffusers/"
_LVCD_KINDS = ("controlnet", "checkpoints")


def find_model_file(file: ModelFile) -> Path | None:
    """The file's path in the host's model folders, or None where it is missing."""
    import folder_paths

    found = folder_paths.get_full_path(file.folder, file.name)
    return Path(found) if found else None


def svd_choices() -> list[str]:
    """Checkpoints and diffusers folders, likely ones first; the usual name is always among them."""
    import folder_paths

    names = [*folder_paths.get_filename_list("checkpoints"), *(_FOLDER + each.name for each in _diffusers_folders())]
    likely = sorted(names, key=lambda name: not any(word in name.lower() for word in ("svd", "stable-video")))
    return likely if _SVD in likely else [_SVD, *likely]


def svd_file(choice: str) -> Path | None:
    """Path of a checkpoint or diffusers folder, or None where it is missing."""
    import folder_paths

    if choice.startswith(_FOLDER):
        return next((each for each in _diffusers_folders() if _FOLDER + each.name == choice), None)
    found = folder_paths.get_full_path("checkpoints", choice)
    return Path(found) if found else None


def lvcd_choices() -> list[str]:
    """Files with LVCD in their names; the usual name is always among them."""
    names = list(dict.fromkeys(name for name, _ in _lvcd_files()))
    return names if _LVCD in names else [*names, _LVCD]


def lvcd_file(choice: str) -> Path | None:
    """Path of an LVCD file, or None where it is missing."""
    return next((path for name, path in _lvcd_files() if name == choice), None)


def _diffusers_folders() -> Iterator[Path]:
    import folder_paths

    for root in map(Path, folder_paths.get_folder_paths("diffusers")):
        if root.is_dir():
            yield from (each for each in sorted(root.iterdir()) if (each / "unet" / "config.json").is_file())


def _lvcd_files() -> Iterator[tuple[str, Path]]:
    import folder_paths

    for kind in _LVCD_KINDS:
        for name in folder_paths.get_filename_list(kind):
            path = folder_paths.get_full_path(kind, name)
            if path and "lvcd" in name.lower():
                yield name, Path(path)
    own = Path(folder_paths.models_dir) / "lvcd"
    if own.is_dir():
        yield from ((each.name, each) for each in sorted(own.iterdir()) if each.suffix in (".ckpt", ".safetensors"))
