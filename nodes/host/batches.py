"""Batches that are large: the user is told before the work, and what the machine cannot hold is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...physics.errors import InvalidInputError
from .messages import tell_user

__all__ = ["announce_batch", "free_memory"]

_LARGE = 4e9
_BYTES = 4
_CONTROL_GROUP = Path("/sys/fs/cgroup")


def announce_batch(
    node: Any, frames: int, width: int, height: int, *, channels: int = 3, instead: str = ""
) -> dict[str, list[str]]:
    """Say how large a batch will be where that matters; call it before the work.

    Args:
        node: the node's class, as ``execute`` has it.
        frames: in the batch.
        width: of a frame [px].
        height: of a frame [px].
        channels: of all batches together, 3 for a picture and 1 for a mask.
        instead: what the user can do, if there is something better than fewer or smaller frames.

    Returns:
        For the node's ``ui``, see :func:`~.messages.tell_user`.

    Raises:
        InvalidInputError: the machine has no such memory left.
    """
    size, free = _BYTES * frames * width * height * channels, free_memory()
    if size <= _LARGE and (free is None or size <= free):
        return {}
    batch = f"{frames} frames of {width} x {height} px are {size / 1e9:.1f} GB"
    advice = instead or "make fewer frames, or scale the picture down"
    if free is not None and size > free:
        raise InvalidInputError(f"{batch}, and {max(0.0, free) / 1e9:.1f} GB of memory are free: {advice}.")
    return tell_user(node, [f"{batch} in memory: {advice}."])


def free_memory() -> float | None:
    """Memory that a process can still have, swap included [bytes]; None where the host cannot tell."""
    try:
        import psutil
    except ImportError:  # it comes with the host
        return None
    free = float(psutil.virtual_memory().available + psutil.swap_memory().free)
    limited = _free_in_container(_CONTROL_GROUP)
    return free if limited is None else min(free, limited)


def _free_in_container(group: Path) -> float | None:
    """What a container's limit leaves [bytes]; files that the system keeps in memory can be dropped."""
    try:
        limit, used = ((group / f"memory.{name}").read_text().strip() for name in ("max", "current"))
        kept = dict(line.split() for line in (group / "memory.stat").read_text().splitlines())
        return None if limit == "max" else float(limit) - float(used) + float(kept.get("inactive_file", 0))
    except (OSError, ValueError):
        return None
