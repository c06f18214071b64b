"""What clips of video models are asked for besides what the models need: whether they close, and their colours."""

from __future__ import annotations

from typing import Any

from comfy_api.latest import io

__all__ = ["AS_THE_MOTION", "colour_match_input", "colour_match_of", "is_loop", "loop_input"]

AS_THE_MOTION, _YES, _NO = "as the motion", "yes", "no"


def loop_input(what: str) -> io.Combo.Input:
    """Whether a clip closes.

    Args:
        what: comes of it where it does.
    """
    return io.Combo.Input(
        "loop",
        options=[AS_THE_MOTION, _YES, _NO],
        default=AS_THE_MOTION,
        optional=True,
        tooltip=f"In a loop, {what}. as the motion: where Simulate has made one. yes: also without a motion.",
    )


def colour_match_input(what: str) -> io.Float.Input:
    """How far colours are brought back.

    Args:
        what: they are brought back to.
    """
    return io.Float.Input(
        "colour_match",
        default=1.0,
        min=0.0,
        max=1.0,
        step=0.05,
        optional=True,
        tooltip=f"How much of the colour drift of the model is taken out [0 to 1], by the colours of {what}.",
    )


def is_loop(chosen: str | None, motion: Any, count: int) -> bool:
    """Whether frames are to close.

    Args:
        chosen: value of the input; None where a workflow from before has it not.
        motion: known motion, or None.
        count: of frames.
    """
    if chosen in (None, AS_THE_MOTION):
        report = None if motion is None else motion.loop
        return report is not None and count > 1 and count % report.frames == 0
    return chosen == _YES and count > 1


def colour_match_of(choice: dict[str, Any]) -> float:
    """What a choice says of it; a graph that was saved before the input was there says nothing."""
    said = choice.get("colour_match")
    return 1.0 if said is None else float(said)
