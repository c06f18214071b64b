"""Pages that stand in the repository already: the README's speed and limits, what differs from the paper, changes."""

from __future__ import annotations

import re
from pathlib import Path

__all__ = ["readme_pages"]

_PAGES = {"workflows/differences_from_the_paper.md": "differences.md", "CHANGELOG.md": "changes.md"}
"""Files of the repository that are pages of the site, from ``made/``."""


def readme_pages(root: Path) -> dict[str, str]:
    """Pages by their places: ``speed.md``, ``limits.md``, ``differences.md`` and ``changes.md``."""
    readme = (root / "README.md").read_text(encoding="utf-8")
    return {
        "speed.md": _page(_section(readme, "Speed")),
        "limits.md": _page(_section(readme, "Limits")),
        **{place: _page((root / path).read_text(encoding="utf-8")) for path, place in _PAGES.items()},
    }


def _section(text: str, title: str) -> str:
    """A section of the second level, as a page."""
    found = re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    assert found is not None, f"README.md has no section {title}"
    return f"# {title}\n{re.sub(r'^###', '##', found[1], flags=re.MULTILINE)}"


def _page(text: str) -> str:
    """Links to files that are no pages here become the files' names; anchors within the README, words."""

    def link(match: re.Match[str]) -> str:
        words, target = match[1], match[2]
        if re.match(r"https?://", target):
            return match[0]
        path = target.partition("#")[0]
        if path in _PAGES:
            return f"[{words}]({_PAGES[path]})"
        return f"{words} (`{path}` in the repository)" if path else words

    return re.sub(r"(?<!!)\[([^\]]+)\]\(([^)\s]+)\)", link, text)
