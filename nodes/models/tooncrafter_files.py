"""Where the host keeps ToonCrafter's files."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

__all__ = ["TOONCRAFTER_FILES", "model_choices", "model_file", "sketch_model_choices", "sketch_model_file"]

TOONCRAFTER_FILES = {
    "tooncrafter_model": "put model.ckpt into models/checkpoints, from https://huggingface.co/Doubiiu/ToonCrafter"
    ", or its pruned fp16 safetensors, from https://huggingface.co/Kijai/DynamiCrafter_pruned.",
    "sketch_model": "put sketch_encoder.ckpt into models/controlnet, from https://huggingface.co/Doubiiu/ToonCrafter"
    ", or leave the sketches away.",
}
"""Where to get the files, by the input that names them."""

_MODEL, _SKETCH_MODEL = "model.ckpt", "sketch_encoder.ckpt"
_MODEL_KINDS, _SKETCH_KINDS = ("checkpoints", "diffusion_models"), ("controlnet", "checkpoints")


def model_choices() -> list[str]:
    """Checkpoints, likely ones first; the usual name is always among them."""
    return _sorted(_names(_MODEL_KINDS), ("tooncrafter", "toon_crafter", _MODEL), _MODEL)


def model_file(choice: str) -> Path | None:
    """Path of the model, or None where it is missing."""
    return _found(_MODEL_KINDS, choice)


def sketch_model_choices() -> list[str]:
    """Control models, likely ones first; the usual name is always among them."""
    return _sorted(_names(_SKETCH_KINDS), ("sketch_encoder",), _SKETCH_MODEL)


def sketch_model_file(choice: str) -> Path | None:
    """Path of the sketch encoder, or None where it is missing."""
    return _found(_SKETCH_KINDS, choice)


def _names(kinds: Iterable[str]) -> list[str]:
    import folder_paths

    return list(dict.fromkeys(name for kind in kinds for name in folder_paths.get_filename_list(kind)))


def _sorted(names: list[str], words: tuple[str, ...], usual: str) -> list[str]:
    likely = sorted(names, key=lambda name: not any(word in name.lower() for word in words))
    return likely if usual in likely else [usual, *likely]


def _found(kinds: Iterable[str], choice: str) -> Path | None:
    import folder_paths

    paths = (folder_paths.get_full_path(kind, choice) for kind in kinds)
    return next((Path(path) for path in paths if path), None)
