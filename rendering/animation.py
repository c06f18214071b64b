"""An animation: an illustration with its motion, whose pictures are drawn as they are asked for."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..physics.motion import Motion
from ..physics.scene import Scene
from .drawing_checks import check_drawing, height_at
from .text_files import check_text_output, write_text
from .video import check_output, write_animation

if TYPE_CHECKING:
    from .composite import LayeredRenderer

__all__ = ["Animation", "StageProgress", "timed"]

Image = NDArray[Any]
Mask = NDArray[Any]
StrPath = str | os.PathLike[str]
T = TypeVar("T")

StageProgress = Callable[[str, int, int], None]
"""Called with (stage, done, total) while something takes time; may raise to stop the work."""


@dataclass(frozen=True, eq=False)
class Animation:
    """An illustration and how its parts move. Frames are drawn when they are asked for.

    Attributes:
        image: the illustration, RGB, shape [h, w, 3].
        masks: where each moving part is, 0..1 or bool, each of shape [h, w].
        scene: bodies, strokes and rig points.
        motion: where every vertex is in every frame.
        renderer: draws the frames.
        first: number of the motion's first frame that is shown; the ones before let the motion settle in.
        seconds: how long each stage took [s], by its name, in the order of the work.
    """

    image: Image
    masks: tuple[Mask, ...]
    scene: Scene
    motion: Motion
    renderer: LayeredRenderer
    first: int = 0
    seconds: dict[str, float] = field(default_factory=dict)

    def __len__(self) -> int:
        """Number of frames that are shown."""
        return len(self.motion) - self.first

    @property
    def shown(self) -> range:
        """The motion's frames that are shown."""
        return range(self.first, len(self.motion))

    def frames(
        self, *, transparent: bool = False, every: int = 1, progress: StageProgress | None = None
    ) -> Iterator[Image]:
        """The pictures of the animation, one after another.

        Args:
            transparent: only the moving parts, as RGBA; otherwise the whole picture, as RGB.
            every: draw each so many-th frame anew and fill in the others from the known motion.
            progress: called after each frame with the stage "render".

        Raises:
            InvalidInputError: in-betweens and transparency are asked for together.
        """
        check_drawing(transparent=transparent, every=every)
        pictures: Iterable[Image]
        if every > 1:
            pictures = self._with_in_betweens(every)
        else:
            draw = self.renderer.cutout if transparent else self.renderer.frame
            pictures = (draw(t) for t in self.shown)
        return self._measured("render", pictures, progress)

    def sketches(self, *, progress: StageProgress | None = None) -> Iterator[Image]:
        """The line drawing of the illustration, warped along the motion: float32 0..1, shape [h, w], lines dark."""
        from ..physics.flow import FlowSequence
        from .sketch import extract_sketch
        from .sketch_warping import warped_sketches

        def drawn() -> Iterator[Image]:
            sketch, behind = extract_sketch(self.image), extract_sketch(self.renderer.plate)
            warped = warped_sketches(sketch, FlowSequence(self.motion), self.shown, behind=behind)
            yield from (each.sketch for each in warped)

        return self._measured("sketch", drawn(), progress)

    def flows(self, *, progress: StageProgress | None = None) -> Iterator[Image]:
        """The optical flow from the drawing as colours, on one scale for the whole clip."""
        from ..physics.flow import FlowSequence
        from .flow_colour import flow_to_color

        rest = np.concatenate([body.mesh.vertices for body in self.motion.bodies]).astype(np.float32)
        longest = max(1.0, float(np.linalg.norm(self.motion.positions - rest, axis=2).max()))
        fields = FlowSequence(self.motion)
        found = map(fields.flow, self.shown)
        drawn = (flow_to_color(each.displacement, each.inside, max_px=longest) for each in found)
        return self._measured("flow", drawn, progress)

    def previews(self, *, progress: StageProgress | None = None) -> Iterator[Image]:
        """The animation with meshes, pins and strokes drawn over it."""
        from .overlay import preview

        drawn = (preview(self.renderer.frame(t), self.motion, self.scene, t) for t in self.shown)
        return self._measured("preview", drawn, progress)

    def save(
        self,
        path: StrPath,
        *,
        transparent: bool = False,
        every: int = 1,
        width: int | None = None,
        progress: StageProgress | None = None,
    ) -> None:
        """Write the animation to a video, an animated picture or a folder of pictures.

        Args:
            path: a name in .mp4, .webm, .gif, .webp or .apng, or a folder ending in ``/``.
            transparent: see :meth:`frames`.
            every: see :meth:`frames`.
            width: width of the written frames [px]; that of the illustration when None.
            progress: called after each frame with the stage "render".

        Raises:
            InvalidInputError: nothing can be written there.
        """
        check_output(path, alpha=transparent)
        self.write(self.frames(transparent=transparent, every=every, progress=progress), path, width=width)

    def write(self, pictures: Iterable[Image], path: StrPath, *, width: int | None = None) -> None:
        """Write any of the clips of this animation, at its frame rate; see :func:`write_animation`.

        Args:
            pictures: what :meth:`frames`, :meth:`sketches`, :meth:`flows` or :meth:`previews` give.
            path: where to.
            width: width of the written frames [px]; that of the illustration when None.
        """
        if width is not None:
            height_at(self.image, width)
            pictures = (_resized(picture, width) for picture in pictures)
        drawing = sum(self.seconds.values())
        start = time.perf_counter()
        write_animation(pictures, path, self.motion.frame_rate)
        # Pictures are drawn while they are written; what the drawing took is already counted.
        drawing = sum(self.seconds.values()) - drawing
        self.seconds["write"] = self.seconds.get("write", 0.0) + time.perf_counter() - start - drawing

    @property
    def shown_motion(self) -> Motion:
        """The motion of the frames that are shown."""
        return self.motion[self.first :]

    def height_at(self, width: int) -> int:
        """Height of written frames of a width [px]."""
        return height_at(self.image, width)

    def save_motion(self, path: StrPath) -> None:
        """Write every vertex of every frame as JSON; see :func:`~physanimator.physics.export.motion_to_dict`.

        Args:
            path: a name in .json.

        Raises:
            InvalidInputError: nothing can be written there.
        """
        from ..physics.export import motion_to_json

        check_text_output(path, ".json")
        write_text(path, motion_to_json(self.shown_motion))

    def save_svg(self, path: StrPath) -> None:
        """Write the moving meshes over the faded illustration as an SVG that plays in a browser.

        Args:
            path: a name in .svg.

        Raises:
            InvalidInputError: nothing can be written there.
        """
        from ..physics.export import motion_to_svg
        from .images import data_address

        check_text_output(path, ".svg")
        write_text(path, motion_to_svg(self.shown_motion, background=data_address(self.image)))

    def save_tracks(self, path: StrPath, **options: Any) -> None:
        """Write tracks for motion-controlled video models as JSON; see :func:`~physanimator.physics.tracks.tracks`.

        Args:
            path: a name in .json.
            options: those of :func:`~physanimator.physics.tracks.tracks`.

        Raises:
            InvalidInputError: nothing can be written there, or an option is out of its range.
        """
        from ..physics.tracks import tracks

        check_text_output(path, ".json")
        write_text(path, tracks(self.shown_motion, **options).to_json() + "\n")

    def _with_in_betweens(self, every: int) -> Iterator[Image]:
        from .interpolation import interpolate, keyframe_indices

        indices = [self.first + t for t in keyframe_indices(len(self), every)]
        keyframes = [self.renderer.frame(t) for t in indices]
        yield from interpolate(keyframes, indices, motion=self.motion, masks=self.masks)

    def _measured(self, stage: str, pictures: Iterable[T], progress: StageProgress | None) -> Iterator[T]:
        iterator = iter(pictures)
        for done in range(1, len(self) + 1):
            with timed(self.seconds, stage):
                picture = next(iterator)
            if progress is not None:
                progress(stage, done, len(self))
            yield picture


def _resized(picture: Image, width: int) -> Image:
    import cv2

    height = height_at(picture, width)
    finer = width > picture.shape[1]
    return cv2.resize(picture, (width, height), interpolation=cv2.INTER_CUBIC if finer else cv2.INTER_AREA)


@contextmanager
def timed(seconds: dict[str, float], stage: str) -> Iterator[None]:
    """Add the time that a block takes to what a stage has taken.

    Args:
        seconds: duration of each stage [s]; changed in place.
        stage: its name.
    """
    start = time.perf_counter()
    try:
        yield
    finally:
        seconds[stage] = seconds.get(stage, 0.0) + time.perf_counter() - start
