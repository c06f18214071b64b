"""In which order shots are begun: the longest first, so that all workers have something to do until the end."""

from __future__ import annotations

import os
from collections.abc import Sequence

from .job import Job
from .shot import Shot

__all__ = ["longest_first"]


def longest_first(jobs: Sequence[Job]) -> list[Job]:
    """Jobs by how many pixels are to be drawn; those of the same size in the order that they have."""
    return sorted(jobs, key=lambda job: -job.shot.frames * _pixels(job.shot))


def _pixels(shot: Shot) -> int:
    """Of the shot's picture; of what is no picture as many as it has bytes, as drawings in layers roughly do."""
    from PIL import Image

    path = next((each.text or "" for each in shot.paths("input") if each.option == "image"), "")
    try:
        with Image.open(path) as picture:  # reads no more than its head
            return int(picture.width * picture.height)
    except Exception:  # a folder, or a file of another kind: no reason to leave a shot out
        return os.path.getsize(path) if os.path.exists(path) else 1
