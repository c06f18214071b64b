"""The commands that the pages show, read from the pages themselves."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

__all__ = ["PageCommand", "commands_of", "files_of", "pages_of"]

_BLOCK = re.compile(r"(?:^<!-- picture: (?P<picture>\S+) -->\n)?^```sh\n(?P<lines>.*?)^```$", re.MULTILINE | re.DOTALL)
_DOWNLOAD = re.compile(r"\{download\}`[^`<]*<([^`>]+)>`")


@dataclass(frozen=True)
class PageCommand:
    """One line that readers type.

    Attributes:
        words: the program and its arguments, as a shell splits them.
        picture: file of ``pictures/`` that it makes, or nothing.
    """

    words: tuple[str, ...]
    picture: str | None


def pages_of(site: Path) -> list[Path]:
    """The pages that are written by hand."""
    return sorted(path for path in site.rglob("*.md") if "made" not in path.relative_to(site).parts[:1])


def commands_of(page: Path) -> list[PageCommand]:
    """Every command of a page, in the order in which a reader comes to them."""
    return [
        PageCommand(tuple(shlex.split(line)), block["picture"])
        for block in _BLOCK.finditer(page.read_text(encoding="utf-8"))
        for line in block["lines"].replace("\\\n", " ").splitlines()
        if line.strip()
    ]


def files_of(page: Path) -> list[Path]:
    """What a page offers to save, to follow along."""
    return [(page.parent / found).resolve() for found in _DOWNLOAD.findall(page.read_text(encoding="utf-8"))]
