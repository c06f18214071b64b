"""What can be said to ``animate``, in groups that belong together."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from ..physics.checks import require_kind
from ..physics.errors import require
from ..physics.scene import Contact, Scene, check_scene_rate
from ..physics.simulation import loop_frames
from .drawing_checks import check_count, check_drawing
from .stages import StageProgress

if TYPE_CHECKING:
    from .artwork import LayerPlan

__all__ = [
    "DEFAULT_FRAMES",
    "DEFAULT_FRAME_RATE",
    "AutomaticWind",
    "LayerChoice",
    "Saving",
    "Timing",
    "Touching",
    "Watch",
]

DEFAULT_FRAMES = 72
"""Three seconds at the default frame rate."""

DEFAULT_FRAME_RATE = 24.0
"""Of film [frames/s]."""


@dataclass(frozen=True)
class Timing:
    """How long the motion is, and how fast it is shown.

    Attributes:
        frames: frames of the motion; frame 0 is the illustration. When None, those of the loop, or 72 without one.
        skip: frames at the start that are simulated but not shown, so that the motion has settled in.
        loop: length of a seamless loop [s]; its frame 0 is not the illustration. None: the scene's own, if it has one.
        frame_rate: frames a second; the scene's own, or 24, when None.

    Raises:
        InvalidInputError: a number is out of range.
    """

    frames: int | None = None
    skip: int = 0
    loop: float | None = None
    frame_rate: float | None = None

    def __post_init__(self) -> None:
        check_count("skip", self.skip, least=0)
        if self.frames is not None:
            check_count("frames", self.frames)
            require(
                "skip", self.skip, self.skip < self.frames, f"at least 0 and below the number of frames ({self.frames})"
            )
        if self.frame_rate is not None:
            check_scene_rate(self.frame_rate)

    def settled(self, scene: Scene) -> Timing:
        """The timing with its number of frames, which may follow from the scene's loop."""
        if self.frames is not None:
            return self
        frames = DEFAULT_FRAMES if scene.loop is None else loop_frames(scene) + self.skip
        return replace(self, frames=frames)


@dataclass(frozen=True)
class AutomaticWind:
    """The wind that blows where there is no scene.

    Attributes:
        strength: factor on the usual wind; 0 is calm, 1 gentle, 3 a storm.
        angle: where it blows to [degrees]; 0 is right, 90 up.
        turbulence: blow a steady wind field with gusts and eddies, which are this share of it (0 to 1), instead of
            passing gusts.
    """

    strength: float = 1.0
    angle: float = 0.0
    turbulence: float | None = None


@dataclass(frozen=True, eq=False)
class Touching:
    """What the parts keep out of.

    Attributes:
        contact: how they keep out of each other, instead of what the scene says; None: as the scene says.
        colliders: masks of what they keep out of besides the scene's colliders, shape [h, w] each, or names of layers
            that stand still; they need contact.
    """

    contact: Contact | None = None
    colliders: Sequence[NDArray[Any] | str] = ()


@dataclass(frozen=True)
class LayerChoice:
    """Which layers of an artwork move; the others do so if their names say it.

    Attributes:
        move: names of layers that move.
        still: names of layers that stand still.
        plans: what becomes of every layer, in the order that the scene says, instead of what follows from their names.
    """

    move: Sequence[str] = ()
    still: Sequence[str] = ()
    plans: Sequence[LayerPlan] | None = None


@dataclass(frozen=True)
class Saving:
    """Where an animation is written as it comes; see :meth:`~physanimator.rendering.animation.Animation.save`.

    Attributes:
        path: a name in .mp4, .webm, .mov, .gif, .webp or .apng, or a folder ending in ``/``.
        background: what is there where nothing moves; None keeps the picture's transparency if the file can hold it.
        width: width of the written frames [px]; that of the illustration when None.
    """

    path: str | os.PathLike[str]
    background: str | None = None
    width: int | None = None

    def check(self, *, by_model: bool = False) -> None:
        """Refuse what cannot be written, before there is anything to write.

        Args:
            by_model: a model draws the frames, or paints in them.

        Raises:
            InvalidInputError: nothing can be written there, the background is unknown, or the width is none.
        """
        from .composite import background_of
        from .pictures import check_output

        has_alpha = False
        if self.background is not None:
            require_kind("background", self.background, str, "a text")
            has_alpha = background_of(self.background).has_alpha
        check_drawing(transparent=has_alpha, by_model=by_model)
        check_output(self.path, alpha=has_alpha)
        if self.width is not None:
            check_count("width", self.width, unit="px")


@dataclass(frozen=True, eq=False)
class Watch:
    """Who hears of the work while it is done.

    Attributes:
        progress: called as the stages "mesh", "simulate" and those of the frames advance, and with "prepare" while the
            illustration is still being taken apart after the simulation.
        on_cut: called with the masks that were cut from points, before anything is made of them.
        on_scene: called with the scene before it is simulated.
        on_note: called with a sentence about what is not as somebody may expect it, such as a layer that cannot move.
    """

    progress: StageProgress | None = None
    on_cut: Callable[[Sequence[NDArray[Any]]], None] | None = None
    on_scene: Callable[[Scene], None] | None = None
    on_note: Callable[[str], None] | None = None
