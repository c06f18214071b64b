"""An animation that is written while it is still simulated: each frame is drawn as soon as it is known."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..physics.beside import Beside
from ..physics.interruption import checkpoint
from ..physics.motion import Motion
from ..physics.scene import Scene
from .composite import LayeredRenderer
from .stages import StageProgress

__all__ = ["ComingFrames", "SavedMeanwhile"]

_POLL_SECONDS = 0.2


class ComingFrames:
    """The frames of a motion as they are simulated: one thread takes them, another waits for them.

    Attributes:
        motion: its positions are zero until they are known.
    """

    def __init__(self, scene: Scene, frames: int) -> None:
        count = sum(len(body.mesh.vertices) for body in scene.bodies)
        self._positions = np.zeros((frames, count, 2), dtype=np.float32)
        self.motion = Motion(scene.bodies, self._positions, scene.frame_rate)
        self._known, self._changed = 0, threading.Condition()

    def take(self, frame: int, positions: NDArray[np.float32]) -> None:
        """Keep the next frame; see :data:`~physanimator.physics.simulation.OnFrame`."""
        self._positions[frame] = positions
        with self._changed:
            self._known = frame + 1
            self._changed.notify_all()

    def wait_for(self, frame: int) -> None:
        """Return when a frame is known; may be stopped at checkpoints."""
        checkpoint()
        with self._changed:
            while self._known <= frame:
                self._changed.wait(_POLL_SECONDS)
                checkpoint()


class _Step(NamedTuple):
    """What is told of the work, and what is set when it has been heard."""

    stage: str
    done: int
    total: int
    heard: threading.Event


class SavedMeanwhile:
    """A renderer that is made, and whose frames are saved, in another thread, while the calling one simulates.

    Whoever leaves the block by an error ends the other thread, as with :class:`~physanimator.physics.beside.Beside`.

    Args:
        make: gives the renderer.
        save: saves all of its frames, and calls its second argument after each.
    """

    def __init__(
        self, make: Callable[[], LayeredRenderer], save: Callable[[LayeredRenderer, StageProgress], None]
    ) -> None:
        self._make, self._save = make, save
        self._renderer: list[LayeredRenderer] = []
        self._steps: queue.Queue[_Step | None] = queue.Queue()
        self._working = Beside(self._work)

    def __enter__(self) -> SavedMeanwhile:
        self._working.__enter__()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        self._working.__exit__(kind, error, _)

    def check(self) -> None:
        """Raise what has ended the other thread early, if anything has."""
        self._working.check()

    def finish(self, progress: StageProgress | None) -> LayeredRenderer:
        """The renderer, when all is saved; raises what has gone wrong there.

        Args:
            progress: called with every step of the saving, in this thread: if it raises, nothing is saved; before, with
                "prepare" while there is no renderer.
        """
        hears = progress or (lambda _stage, _done, _total: None)
        waited = False
        for step in self._told():
            if not self._renderer:
                waited = True
                hears("prepare", 0, 1)
            elif waited:
                waited = False
                hears("prepare", 1, 1)
            if step is not None:
                hears(step.stage, step.done, step.total)
                step.heard.set()
        self._working.result()
        return self._renderer[0]

    def _told(self) -> Iterator[_Step | None]:
        """What is told, in turn, and None now and then meanwhile; until there is nothing more to tell."""
        yield None
        while True:
            try:
                step = self._steps.get(timeout=_POLL_SECONDS)
            except queue.Empty:
                yield None
                continue
            if step is None:
                return
            yield step

    def _work(self) -> None:
        try:
            self._renderer.append(self._make())
            self._save(self._renderer[0], self._tell)
        finally:
            self._steps.put(None)

    def _tell(self, stage: str, done: int, total: int) -> None:
        """Hand a step over. Until the last one has been heard, somebody may not want what is saved."""
        step = _Step(stage, done, total, threading.Event())
        self._steps.put(step)
        while done == total and not step.heard.wait(_POLL_SECONDS):
            checkpoint()
