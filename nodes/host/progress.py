"""The host's progress bar and its interruption as one callback for long loops."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    import torch

__all__ = ["host_check", "host_preview", "host_progress", "watched_sampling"]


class Report(Protocol):
    """A progress callback that can also show a picture."""

    def __call__(self, done: int, total: int, preview: Any = None) -> None: ...


def host_progress() -> Report:
    """A callback that moves the bar of the node being run, and raises the host's interruption when asked to stop.

    The node's identity is taken now, because the callback may be called from another thread.
    """
    import comfy.model_management
    import comfy.utils
    from comfy_execution.utils import get_executing_context

    context = get_executing_context()
    bar = comfy.utils.ProgressBar(1, node_id=context.node_id if context else None)

    def report(done: int, total: int, preview: Any = None) -> None:
        comfy.model_management.throw_exception_if_processing_interrupted()
        bar.update_absolute(done, total, preview)

    return report


def host_check() -> Callable[[], None]:
    """What raises the host's interruption when asked to stop, for long preparations without a bar."""
    import comfy.model_management

    check: Callable[[], None] = comfy.model_management.throw_exception_if_processing_interrupted
    return check


def watched_sampling(device: torch.device, middle: Callable[[Any], torch.Tensor]) -> dict[str, Any]:
    """The arguments ``progress`` and ``watch`` of a sampler: the bar moves, and each step shows a part of the latents.

    Args:
        device: of the latents.
        middle: which of a step's clean latents are shown, shape [1, 4, h, w], such as those amid the clip.
    """
    report, preview = host_progress(), host_preview(device)
    latest: list[Any] = []

    def watch(now: Any) -> None:
        latest[:] = [preview(middle(now.clean))]

    return {"watch": watch, "progress": lambda done, total: report(done, total, latest.pop() if latest else None)}


def host_preview(device: torch.device) -> Callable[[torch.Tensor], Any]:
    """What makes a picture for ``host_progress`` of scaled latents [1, 4, h, w]; nothing where previews are off."""
    import comfy.latent_formats
    import latent_preview

    previewer = latent_preview.get_previewer(device, comfy.latent_formats.SD15())
    if previewer is None:
        return lambda _: None
    return lambda latents: previewer.decode_latent_to_preview_image("JPEG", latents)
