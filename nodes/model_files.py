"""Where the host keeps the files that a backend needs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..rendering.interpolation import ModelFile

__all__ = ["find_model_file"]


def find_model_file(file: ModelFile) -> Path | None:
    """The file's path in the host's model folders, or None where it is missing."""
    import folder_paths

    found = folder_paths.get_full_path(file.folder, file.name)
    return Path(found) if found else None
