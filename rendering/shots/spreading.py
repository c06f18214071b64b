"""The frames of one long shot, drawn by workers that have nothing else to do: its motion travels and is made once."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from ...physics.interruption import checkpoint
from ..composite import Background, shown_frame

if TYPE_CHECKING:
    from distributed import Client, Future

    from ..frame_drawing import DrawsFrames

__all__ = ["FRAMES", "LONG", "drawing_on_idle_workers"]

FRAMES = 16
"""Frames that a worker draws at a time."""

LONG = 12 * FRAMES
"""Frames of a shot that it is worth for: another worker takes seconds until it can draw."""

_AHEAD = 2  # pieces for each thread that are drawn or wait to be written
_FIRST = 10  # priority: what is under way is finished before other shots are begun
_POLL = 0.2  # [s] between two looks at whether somebody still wants the shot


def drawing_on_idle_workers(client: Client, leave: Callable[[], Any], come_back: Callable[[], Any]) -> DrawsFrames:
    """What draws frames for :func:`~physanimator.rendering.frame_drawing.frames_drawn_by` in a task of Dask.

    Args:
        client: of the task's worker.
        leave: lets the worker do another task meanwhile.
        come_back: ends that.
    """

    def draw(renderer: Any, numbers: Sequence[int], background: Background) -> Iterator[NDArray[Any]] | None:
        threads = sum(client.nthreads().values())
        if len(numbers) < LONG or sum(map(len, client.processing().values())) >= threads:
            return None
        return _spread(client, renderer, numbers, background, _AHEAD * threads, leave, come_back)

    return draw


def _spread(
    client: Client,
    renderer: Any,
    numbers: Sequence[int],
    background: Background,
    most: int,
    leave: Callable[[], Any],
    come_back: Callable[[], Any],
) -> Iterator[NDArray[Any]]:
    known = client.scatter(renderer, hash=False)
    pieces = deque(numbers[first : first + FRAMES] for first in range(0, len(numbers), FRAMES))
    under_way: deque[tuple[Sequence[int], Future]] = deque()
    leave()
    try:
        while pieces or under_way:
            while pieces and len(under_way) < most:
                piece = pieces.popleft()
                future = client.submit(_drawn, known, piece, background, pure=False, priority=_FIRST)
                under_way.append((piece, future))
            piece, future = under_way.popleft()
            yield from _received(future) or _drawn(renderer, piece, background)
            del future
    finally:
        client.cancel([future for _, future in under_way], force=True)
        come_back()


def _received(future: Future) -> list[NDArray[Any]] | None:
    """The frames that a worker has drawn; None where it was lost."""
    from distributed import wait

    while not future.done():
        checkpoint()
        try:
            wait([future], timeout=_POLL)
        except TimeoutError:
            continue
    return future.result() if future.status == "finished" else None


def _drawn(renderer: Any, numbers: Sequence[int], background: Background) -> list[NDArray[Any]]:
    return [shown_frame(renderer, t, background) for t in numbers]
