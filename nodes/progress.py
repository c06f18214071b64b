"""The host's progress bar and its interruption as one callback for long loops."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..physics.progress import Progress

__all__ = ["host_progress"]


def host_progress() -> Progress:
    """A callback that moves the bar of the node being run, and raises the host's interruption when asked to stop.

    The node's identity is taken now, because the callback may be called from another thread.
    """
    import comfy.model_management
    import comfy.utils
    from comfy_execution.utils import get_executing_context

    context = get_executing_context()
    bar = comfy.utils.ProgressBar(1, node_id=context.node_id if context else None)

    def report(done: int, total: int) -> None:
        comfy.model_management.throw_exception_if_processing_interrupted()
        bar.update_absolute(done, total)

    return report
