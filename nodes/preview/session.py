"""Live previews: one simulation at a time for each editor, of which the latest wins, and the records it sends."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...physics.assembly import Preparations, Prepare, Prepared, SwayPart
from ...physics.errors import Cancelled, PhysAnimatorError
from ...physics.interruption import interruptible
from ...physics.scene import Holds, Scene
from ...physics.simulation import compile_aside, first_frame, periodic, simulate_samples, simulated_aside
from .limits import MAX_EDITORS, MAX_PREVIEW_WORK
from .queue import RecordQueue
from .records import END, ERROR, FRAME, HEADER, FrameEncoder, record

__all__ = ["SUPERSEDED", "PreviewRun", "PreviewRuns", "stream", "warm_up"]

SUPERSEDED = "superseded"
"""Why a run was cancelled when its editor has asked for another."""

_POLL_SECONDS = 0.02


@dataclass(eq=False)
class PreviewRun:
    """One simulation of an editor.

    Attributes:
        editor: whose it is.
        order: later requests have higher numbers.
        prepare: keeps what simulations need before their first step.
        turn: held by whichever run of that editor simulates; the others wait for it.
        wants: what is prepared for it.
        reason: why it was cancelled; empty while it was not.
        successor: the later run for which it was cancelled.
    """

    editor: str
    order: int
    prepare: Prepare
    turn: threading.Lock
    wants: Prepared | None = None
    reason: str = ""
    successor: PreviewRun | None = None
    _cancelled: threading.Event = field(default_factory=threading.Event)

    def cancel(self, reason: str) -> None:
        """Let the simulation stop after the present frame."""
        self.reason = self.reason or reason
        self._cancelled.set()

    def check(self) -> None:
        """
        Raises:
            Cancelled: the run was cancelled; the message is the reason.
        """
        if self._cancelled.is_set():
            raise Cancelled(self.reason)

    def check_preparing(self) -> None:
        """As ``check``, but what the latest run needs as well is prepared to its end: else it would begin anew.

        Raises:
            Cancelled: the run was cancelled, and nobody needs what it prepares.
        """
        latest = self
        while latest.successor is not None:
            latest = latest.successor
        if latest is self or latest._cancelled.is_set() or latest.wants is not self.wants:
            self.check()

    def wait_for_turn(self) -> None:
        """Wait until the editor's earlier runs have stopped; release ``turn`` afterwards.

        Raises:
            Cancelled: the run was cancelled meanwhile.
        """
        self.check()
        while not self.turn.acquire(timeout=_POLL_SECONDS):
            self.check()


class PreviewRuns:
    """The latest run of each editor; safe to use from any thread."""

    def __init__(self, *, most: int = MAX_EDITORS) -> None:
        """
        Args:
            most: editors that may have a run at once.
        """
        self._most = most
        self.prepare = Preparations(most=2 * most)
        self._runs: dict[str, PreviewRun] = {}
        self._lock = threading.Lock()

    def enter(self, editor: str, order: int, wants: Prepared | None = None) -> PreviewRun | None:
        """A new run, for which the editor's earlier one is cancelled; None when too many editors have one.

        Args:
            editor: whose it is.
            order: rises with each request. One that was overtaken by a later request is cancelled from the start.
            wants: what is prepared for it, as ``prepare`` has found or made it.
        """
        with self._lock:
            before = self._runs.get(editor)
            if before is None and len(self._runs) >= self._most:
                return None
            run = PreviewRun(editor, order, self.prepare, before.turn if before else threading.Lock(), wants)
            overtaken = before is not None and before.order > order
            if not overtaken:
                self._runs[editor] = run
                if before is not None:
                    before.successor = run
        stale = run if overtaken else before
        if stale is not None:
            stale.cancel(SUPERSEDED)
        return run

    def leave(self, run: PreviewRun) -> None:
        """Forget a run that has ended, unless another has taken its place."""
        with self._lock:
            if self._runs.get(run.editor) is run:
                del self._runs[run.editor]

    def __len__(self) -> int:
        return len(self._runs)


def stream(
    scene: Scene, frames: int, run: PreviewRun, queue: RecordQueue, *, points: Sequence[int] | None = None
) -> None:
    """Simulate a scene and put its records into a queue, which is closed in the end whatever happens.

    Of a scene that loops every cycle goes out while it settles, so that something moves at once; each frame takes the
    place of the one of the cycle before.

    Args:
        scene: what to simulate.
        frames: how many; of a loop, those of a cycle.
        run: may be cancelled at any time from any thread.
        queue: where the records go.
        points: the number that each rig point has in the editor's document, -1 for none; None where they are the same.
    """
    last = b""
    try:
        run.wait_for_turn()
        try:
            last = _streamed(scene, frames, run, queue, points)
        finally:
            run.turn.release()
    except PhysAnimatorError as error:
        last = record(ERROR, {"error": str(error)})
    except Exception as error:
        last = record(
            ERROR, {"error": f"The preview has failed ({type(error).__name__}); the server's log tells more."}
        )
        raise
    finally:
        queue.close(last)


def _streamed(scene: Scene, frames: int, run: PreviewRun, queue: RecordQueue, points: Sequence[int] | None) -> bytes:
    """Put everything but the last record, which is returned."""
    from ...physics.simulation import simulate

    begun, largest = time.perf_counter(), 0.0
    prepared = run.wants
    acting = scene if scene.loop is None else periodic(scene)
    encoder = FrameEncoder(acting, frames=frames, first_frame=0 if scene.loop is None else first_frame(acting))
    header = encoder.header(frames=frames, points=points)
    header["unheld"] = [] if prepared is None or prepared.holds is None else _unheld(prepared.holds)
    queue.put(record(HEADER, header), run.check)

    def send(number: int, positions: NDArray[np.float32]) -> None:
        nonlocal largest
        payload, displacement = encoder.frame(number, positions)
        largest = max(largest, displacement)
        queue.put(record(FRAME, payload), run.check)
        run.check()

    with interruptible(run.check_preparing):
        compile_aside(contact=scene.contact is not None, check=run.check)
        if prepared is None:
            prepared = run.prepare(scene)
        with simulated_aside(contact=scene.contact is not None):
            simulate(
                scene,
                frames=None if scene.loop else frames,
                on_frame=send,
                progress=_checking(run),
                max_work=MAX_PREVIEW_WORK,
                prepare=lambda _: prepared,  # what is prepared is the same for the scene and for its periodic form
            )
    seconds = time.perf_counter() - begun
    stiffness = _stiffness(prepared.system.sway, len(scene.bodies))
    end = {"frames": frames, "seconds": seconds, "largest_displacement": largest, "stiffness": stiffness}
    return record(END, end)


def _unheld(holds: Holds) -> list[int]:
    """Numbers of the bodies that no rig point holds or leads: forces carry them away."""
    held = zip(holds.leaders, holds.grips, strict=True)
    return [number for number, (leaders, grips) in enumerate(held) if (leaders < 0).all() and not grips.any()]


def _stiffness(sway: Sequence[SwayPart], count: int) -> list[float | None]:
    """Young's modulus that each body has got from its sway frequency, where it has one: that of its longest part."""
    found: list[float | None] = [None] * count
    for part in sorted(sway, key=lambda each: -each.wanted):
        found[part.body] = part.youngs_modulus
    return found


def _checking(run: PreviewRun) -> Callable[[int, int], None]:
    return lambda _done, _total: run.check()


def warm_up(*, contact: bool = False) -> None:
    """Load the kernels and all that a first preview needs, which takes some seconds once in a process.

    What has to be compiled for it is compiled in another process, and kept on disk at once.

    Args:
        contact: the kernels for contact instead.
    """
    from ...physics.runtime import keep_compiled

    compile_aside(contact=contact)
    with simulated_aside(contact=contact):
        simulate_samples(contact=contact)
        if keep_compiled():
            simulate_samples(contact=contact)
