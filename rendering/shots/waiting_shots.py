"""Shots that wait to be begun: a worker goes on with the picture that it knows and whose parts it has cut out."""

from __future__ import annotations

from collections import deque
from collections.abc import Hashable, Iterable

from .job import Job

__all__ = ["WaitingShots", "picture_of"]


def picture_of(job: Job) -> Hashable:
    """By what shots are known whose parts are cut out of the same picture along the same masks."""
    return tuple(each.text for each in job.shot.paths("input") if each.option in ("image", "mask"))


class WaitingShots:
    """Jobs in the order that they have; but a worker gets those of one picture in a row."""

    def __init__(self, jobs: Iterable[Job]) -> None:
        self._by_picture: dict[Hashable, deque[Job]] = {}
        for job in jobs:
            self._by_picture.setdefault(picture_of(job), deque()).append(job)
        self._known: dict[str, Hashable] = {}

    def __len__(self) -> int:
        return sum(map(len, self._by_picture.values()))

    def next_for(self, worker: str) -> Job:
        """Take the job that a worker does best: of its picture, else of the first one that is no other worker's, else
        of that of which most is left.
        """
        picture = self._known.get(worker)
        if picture not in self._by_picture:
            others = set(self._known.values())
            free = [each for each in self._by_picture if each not in others]
            picture = free[0] if free else max(self._by_picture, key=lambda each: len(self._by_picture[each]))
            self._known[worker] = picture
        waiting = self._by_picture[picture]
        job = waiting.popleft()
        if not waiting:
            del self._by_picture[picture]
        return job
