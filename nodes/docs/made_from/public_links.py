"""Where the project is on the network, as pyproject.toml says once it has an address (``.ci/release.py address``)."""

from __future__ import annotations

import re
from pathlib import Path

__all__ = ["public_links"]

_SHOWN = {"Repository": "Source", "Issues": "Questions and faults"}
"""Addresses of pyproject.toml that every page shows, and how they are called there."""


def public_links(root: Path) -> list[dict[str, str]]:
    """Links for the foot of each page, in the form of the theme's icons; none before there is an address."""
    text = (root / "pyproject.toml").read_text(encoding="utf-8")
    found = {key: re.search(rf'^{key} = "([^"]*)"', text, re.MULTILINE) for key in _SHOWN}
    links = {_SHOWN[key]: match[1] for key, match in found.items() if match}
    return [
        {"name": name, "url": url, "html": name, "class": "public-link"}
        for name, url in links.items()
        if ".invalid/" not in url
    ]
