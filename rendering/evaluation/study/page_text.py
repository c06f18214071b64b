"""The raters' page as one text: markup, style, script and data."""

from __future__ import annotations

import html
import json
from pathlib import Path
from typing import Any

__all__ = ["page_text"]

_PARTS = Path(__file__).resolve().parent / "page"


def page_text(document: dict[str, Any], language: str, title: str) -> str:
    """Fill the page.

    Args:
        document: what its script reads.
        language: of its words.
        title: above it.
    """
    data = json.dumps(document, ensure_ascii=False, separators=(",", ":"))
    filled = {
        "LANGUAGE": html.escape(language),
        "TITLE": html.escape(title),
        "STYLE": (_PARTS / "study.css").read_text(encoding="utf-8"),
        "SCRIPT": (_PARTS / "study.js").read_text(encoding="utf-8"),
        "DATA": data.replace("<", "\\u003c"),  # or a text could end the script
    }
    first, *rest = (_PARTS / "study.html").read_text(encoding="utf-8").split("{{")
    parts = [first]
    for each in rest:
        name, _, after = each.partition("}}")
        parts += [filled[name], after]
    return "".join(parts)
