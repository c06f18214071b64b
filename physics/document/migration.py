"""Documents of older versions in the form of the present one."""

from __future__ import annotations

from typing import Any

from .encoding import SCENE_VERSION

__all__ = ["READABLE_VERSIONS", "migrated"]

READABLE_VERSIONS = tuple(range(1, SCENE_VERSION + 1))
"""Versions of documents that can be read."""


def migrated(document: dict[str, Any]) -> dict[str, Any]:
    """A document of any readable version as one of the present version; the argument is left as it is.

    Version 2 adds keys to version 1, with defaults under which a scene moves as it did; only gravity, under which the
    drawing used to sag, now leaves it hanging as drawn unless "sag" is set.

    Args:
        document: a checked document.
    """
    sags = document["version"] == 1 and any(document.get("gravity", ()))
    return {**document, "version": SCENE_VERSION, **({"sag": True} if sags else {})}
