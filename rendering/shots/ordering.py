"""In which order shots are begun: the longest first, so that all workers have something to do until the end."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Hashable, Sequence

from .job import Job
from .shot import Shot
from .waiting_shots import picture_of

__all__ = ["longest_first"]


# What a pixel that moves takes, its mesh and the picture behind it, in pixels of a frame that are drawn and encoded:
# four shots of 1280 x 720 pixels, 25 000 to 84 000 of which move, took 0.8 to 2.7 s.
_MOVING = 2500


def longest_first(jobs: Sequence[Job]) -> list[Job]:
    """Jobs by how long they may take, with those of the same picture in a row; those that are alike in the order that
    they have.
    """
    work = [_work(job.shot) for job in jobs]
    together: Counter[Hashable] = Counter()
    for job, each in zip(jobs, work, strict=True):
        together[picture_of(job)] += each
    place = {picture: number for number, (picture, _) in enumerate(together.most_common())}
    return [
        job for job, _ in sorted(zip(jobs, work, strict=True), key=lambda each: (place[picture_of(each[0])], -each[1]))
    ]


def _work(shot: Shot) -> int:
    return shot.frames * _pixels(shot) + _MOVING * shot.moving


def _pixels(shot: Shot) -> int:
    """Of the shot's picture; of what is no picture as many as it has bytes, as drawings in layers roughly do."""
    from PIL import Image

    path = next((each.text or "" for each in shot.paths("input") if each.option == "image"), "")
    try:
        with Image.open(path) as picture:  # reads no more than its head
            return int(picture.width * picture.height)
    except Exception:  # a folder, or a file of another kind: no reason to leave a shot out
        return os.path.getsize(path) if os.path.exists(path) else 1
