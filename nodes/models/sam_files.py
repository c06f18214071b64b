"""Where the host keeps the weights of Segment Anything."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

__all__ = ["has_sam_model", "missing_sam_model", "sam_choices", "sam_file"]

_KIND = "sams"
_USUAL = ("sam2.1-hiera-base-plus/", "sam_vit_b_01ec64.pth")
_FILES = (".pth", ".safetensors")


def sam_choices() -> list[str]:
    """Folders, written with a stroke at their end, and files; the usual names are always among them."""
    return list(dict.fromkeys([*(name for name, _ in _found()), *_USUAL]))


def has_sam_model() -> bool:
    """Whether there is any file or folder to choose from."""
    return next(_found(), None) is not None


def sam_file(choice: str) -> Path | None:
    """Path of a folder or file, or None where it is missing."""
    return next((path for name, path in _found() if name == choice), None)


def missing_sam_model(choice: str) -> str:
    """One sentence for each family: what to put where, and from which page."""
    from ...rendering.segmentation.sam import where_to_get

    return f"{choice} is missing. {where_to_get('models/' + _KIND)}"


def _found() -> Iterator[tuple[str, Path]]:
    for root in _roots():
        if root.is_dir():
            for each in sorted(root.iterdir()):
                if (each / "config.json").is_file():
                    yield each.name + "/", each
                elif each.suffix in _FILES and each.is_file():
                    yield each.name, each


def _roots() -> list[Path]:
    """Other packs, and extra_model_paths.yaml, may add folders under the same name."""
    import folder_paths

    known = folder_paths.get_folder_paths(_KIND) if _KIND in folder_paths.folder_names_and_paths else []
    return list(dict.fromkeys([Path(folder_paths.models_dir) / _KIND, *map(Path, known)]))
