"""A clip as the columns see it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from ....physics.errors import InvalidInputError, require
from ....physics.motion import Motion
from ...metrics.flow_warp_error import RestMaps
from ...metrics.static_drift import away_from, still_region
from ...pictures import as_picture, as_uint8

__all__ = ["ClipOfPicture", "Frames"]

Picture = NDArray[np.uint8]
Mask = NDArray[np.bool_]


class Frames(Protocol):
    """Frames that can be counted, and read in turn any number of times: a list, or a class that decodes a file."""

    def __len__(self) -> int: ...

    def __iter__(self) -> Iterator[NDArray[Any]]: ...


@dataclass(frozen=True, eq=False)
class ClipOfPicture:
    """A clip that some method made of a still illustration, and what is known of it.

    Attributes:
        frames: RGB, shape [h, w, 3] each; read one at a time, never held together.
        rate: frames a second.
        picture: the illustration, RGB, uint8, shape [h, w, 3].
        moving: where parts come in any frame, shape [h, w]. Give all clips of a picture the same, so that what should
            be still is the same for all of them. None: what the motion covers; without a motion, not known.
        motion: the simulation that the clip follows, whose frames are the clip's; None for clips of other systems.
        sketches: the drawings that drove the clip, one a frame, paper 1, lines 0, shape [h, w]; None without.
        loops: whether the last frame is meant to lead to the first.
        description: what the clip shows, in words, for networks that ask for it.
    """

    frames: Frames
    rate: float
    picture: Picture
    moving: Mask | None = None
    motion: Motion | None = None
    sketches: Iterable[NDArray[Any]] | None = None
    loops: bool = False
    description: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "picture", as_uint8(as_picture(self.picture, name="picture")))
        size = self.picture.shape[:2]
        require("rate", self.rate, 0 < self.rate < np.inf, "above 0 frames a second")
        require("frames", len(self.frames), len(self.frames) > 0, "at least 1")
        if self.moving is not None:
            object.__setattr__(self, "moving", np.asarray(self.moving, dtype=bool))
            require("moving", f"shape {self.moving.shape}", self.moving.shape == size, f"of the picture's shape {size}")
        if self.motion is not None:
            shown = (self.motion.height, self.motion.width)
            require("motion", f"shape {shown}", shown == size, f"of the picture's shape {size}")
            enough = len(self.motion) >= len(self.frames)
            require("motion", f"{len(self.motion)} frames", enough, f"of at least the clip's {len(self.frames)} frames")

    def sized_frames(self) -> Iterator[Picture]:
        """The frames in turn, uint8, resized to the picture where a system works in another size [px].

        A frame of other proportions is stretched: what a system has cut off or squeezed counts as a fault of it.
        """
        height, width = self.picture.shape[:2]
        count = 0
        for each in self.frames:
            count += 1
            frame = as_uint8(as_picture(each, name="frames"))
            if frame.shape[:2] != (height, width):
                smaller = frame.shape[0] * frame.shape[1] > height * width
                frame = cv2.resize(frame, (width, height), interpolation=cv2.INTER_AREA if smaller else cv2.INTER_CUBIC)
            yield frame
        if count != len(self.frames):
            raise InvalidInputError(f"frames must be the {len(self.frames)} that they say. Got: {count}")

    @cached_property
    def maps(self) -> RestMaps | None:
        """What each frame shows of the drawing, of the motion."""
        return None if self.motion is None else RestMaps(self.motion[: len(self.frames)])

    @cached_property
    def still(self) -> Mask | None:
        """Where nothing should change, shape [h, w]; None where that is not known."""
        if self.moving is not None:
            return away_from(self.moving)
        return None if self.maps is None else still_region(self.maps)
