"""Pages of the site that follow from the code: none of them is written by hand."""

from __future__ import annotations

import shutil
from pathlib import Path

from .command_page import command_page
from .cross_references import resolve_reexported
from .library_pages import library_pages
from .node_pages import node_pages
from .own_picture import own_picture
from .public_links import public_links
from .readme_parts import readme_pages
from .scene_page import scene_page

__all__ = ["pages", "public_links", "resolve_reexported", "write_pages"]


def pages(root: Path) -> dict[str, str]:
    """Every page by its place under ``made/``, as MyST Markdown."""
    return {
        "command_line.md": command_page(),
        "scene.md": scene_page(),
        "own_picture.md": own_picture(root),
        **readme_pages(root),
        **{f"nodes/{name}": text for name, text in node_pages(root).items()},
        **{f"library/{name}": text for name, text in library_pages(root).items()},
    }


def write_pages(folder: Path, root: Path) -> None:
    """Write them all; those that are as they were keep their time, so that Sphinx leaves them alone."""
    wanted = pages(root)
    for path in sorted(folder.rglob("*.md")):
        if path.relative_to(folder).as_posix() not in wanted:
            path.unlink()
    for name, text in wanted.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8", newline="\n")
    for picture in (root / "nodes" / "web" / "docs").glob("*.jpg"):
        shutil.copy2(picture, folder / "nodes")
