"""Clips that are never trained on, so that what is measured on them says whether the training helps."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

from .data_folder import ClipRecord

__all__ = ["split"]


def split(clips: Sequence[ClipRecord], share: float) -> tuple[list[ClipRecord], list[ClipRecord]]:
    """Clips to train on, and clips held out.

    A name always falls on the same side, whatever clips come beside it; of two clips or more at least one is on each.

    Args:
        clips: all.
        share: of them that is held out; 0 holds none out.
    """
    if share <= 0 or len(clips) < 2:
        return list(clips), []
    ranked = sorted(clips, key=lambda clip: _place(clip.name))
    out = [clip for clip in ranked if _place(clip.name) < share] or ranked[:1]
    kept = [clip for clip in ranked if clip not in out] or ranked[-1:]
    out = [clip for clip in out if clip not in kept]
    return sorted(kept, key=lambda clip: clip.name), sorted(out, key=lambda clip: clip.name)


def _place(name: str) -> float:
    """A number 0..1 that follows from a name."""
    return int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "big") / 2**64
