"""Scene documents as texts of nodes, checked once although the host looks at a text twice."""

from __future__ import annotations

import hashlib
import json
from collections import deque
from typing import Any

__all__ = ["canonical_text", "checked_document"]

_passed: deque[bytes] = deque(maxlen=256)
"""Digests of texts that hold a right document."""


def checked_document(text: str) -> dict[str, Any]:
    """The scene document in a text.

    The host has a node's text checked before a prompt runs, and hands it over again when the node runs.

    Raises:
        SceneError: it holds none.
    """
    from ...physics.document import check_document, read_json

    document: Any = read_json(text)
    digest = hashlib.sha256(text.encode("utf-8", "surrogatepass")).digest()
    if digest not in _passed:
        check_document(document)
        _passed.append(digest)
    return document


def canonical_text(text: str) -> str:
    """A scene document in one spelling: without spaces, keys in order, 1.0 as 1; as it is where it cannot be read.

    The host knows by a node's text whether it has to run again.
    """
    from ...physics.document import read_json
    from ...physics.errors import PhysAnimatorError

    try:
        document: Any = read_json(text)
        return json.dumps(_plain(document), sort_keys=True, separators=(",", ":"))
    except (PhysAnimatorError, RecursionError):
        return text


def _plain(value: Any) -> Any:
    """Whole numbers as such, which JSON may write in several ways."""
    if isinstance(value, dict):
        return {key: _plain(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_plain(each) for each in value]
    whole = isinstance(value, float) and value.is_integer() and abs(value) < 2**53
    return int(value) if whole else value
