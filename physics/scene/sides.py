"""Where a body can be held: at a side, or where such things are worn."""

from __future__ import annotations

from typing import Literal, get_args

__all__ = ["ATTACHMENTS", "Attachment", "Held"]

Attachment = Literal["auto", "top", "bottom", "left", "right", "head", "crown", "covered", "end"]
ATTACHMENTS: tuple[Attachment, ...] = get_args(Attachment)[:5]
"""Those that people choose from for masks; the others are for layers: see :func:`~.attachment.pins`."""

Held = Literal["none", "auto", "top", "bottom", "left", "right", "head", "crown", "covered", "end"]
"""What a scene document says of a body."""
