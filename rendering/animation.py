"""An animation: an illustration with its motion, whose pictures are drawn as they are asked for."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..physics.errors import InvalidInputError, require
from ..physics.motion import Motion
from ..physics.scene import Scene
from .composite import Background, background_of, usual_background
from .drawing_checks import check_drawing, height_at
from .files import check_text_output, write_text
from .frame_drawing import FrameDrawing
from .inbetweens import keyframe_indices
from .moving_pieces import DEFAULT_TOLERANCE
from .neural import NetworkOptions
from .pictures import check_output, holds_alpha, is_transparent, over, resized, save_image, write_animation
from .stages import StageProgress, stage_of

if TYPE_CHECKING:
    from .artwork import Artwork
    from .composite import LayeredRenderer, PixelArtRenderer
    from .export import VectorChannels

__all__ = ["Animation", "timed"]

Image = NDArray[Any]
Mask = NDArray[Any]
StrPath = str | os.PathLike[str]
T = TypeVar("T")

_NO_NETWORKS = NetworkOptions()


@dataclass(frozen=True, eq=False)
class Animation:
    """An illustration and how its parts move. Frames are drawn when they are asked for.

    Attributes:
        image: the illustration, RGB, shape [h, w, 3], or straight RGBA, shape [h, w, 4].
        masks: where each moving part is, 0..1 or bool, each of shape [h, w].
        scene: bodies, strokes and rig points.
        motion: where every vertex is in every frame.
        renderer: draws the frames.
        first: number of the motion's first frame that is shown; the ones before let the motion settle in.
        own: each part alone, straight RGBA as large as the illustration; empty where it is known from masks alone.
        seconds: how long each stage took [s], by its name, in the order of the work.
        networks: which networks draw frames, in-betweens and lines.
        wait_for: returns when a frame of the motion is known; where the motion is still simulated, nothing but frames
            can be asked for.
    """

    image: Image
    masks: tuple[Mask, ...]
    scene: Scene
    motion: Motion
    renderer: LayeredRenderer | PixelArtRenderer
    first: int = 0
    seconds: dict[str, float] = field(default_factory=dict)
    own: Sequence[Image] = ()
    networks: NetworkOptions = _NO_NETWORKS
    wait_for: Callable[[int], None] | None = None

    def __len__(self) -> int:
        """Number of frames that are shown."""
        return len(self.motion) - self.first

    @property
    def pixel_art(self) -> bool:
        """Whether pixels are moved whole, and no colours are mixed."""
        from .composite import PixelArtRenderer

        return isinstance(self.renderer, PixelArtRenderer)

    @property
    def shown(self) -> range:
        """The motion's frames that are shown."""
        return range(self.first, len(self.motion))

    def background(self, text: str | None = None, *, file_has_alpha: bool = True) -> Background:
        """The background of a name or colour; without one, transparency stays where frames and the file can hold it.

        Args:
            text: see :func:`~physanimator.rendering.composite.background_of`.
            file_has_alpha: what is written can hold transparency.

        Raises:
            InvalidInputError: there is no such background, or the renderer does not draw on it.
        """
        if text is not None:
            chosen = background_of(text)
            check_drawing(transparent=chosen.has_alpha, by_model=self.networks.draws_opaque)
            return chosen
        held = file_has_alpha and not self.networks.draws_opaque
        return usual_background(transparent_picture=is_transparent(self.image), file_has_alpha=held)

    def frames(
        self,
        *,
        transparent: bool = False,
        every: int = 1,
        progress: StageProgress | None = None,
        background: str | None = None,
        keyframes_at: Sequence[int] = (),
    ) -> Iterator[Image]:
        """The pictures of the animation, one after another: RGB, or straight RGBA where they have transparency.

        Args:
            transparent: short for the background "transparent".
            every: draw each so many-th frame anew and fill in the others from the known motion, or as ``networks`` say.
            progress: called after each frame with the stage "render", and with each step of a model with "svd",
                "inpainting" or "tooncrafter".
            background: what is there where nothing moves: "picture", "transparent", "parts" or a colour (see
                :mod:`~physanimator.rendering.composite.background`); None keeps the transparency that the picture has,
                if it is not drawn by a model.
            keyframes_at: numbers of the frames that are drawn, from 0, instead of each so many-th; frames before the
                first and after the last of them are drawn as well, except in a loop, where they are filled in too.

        Raises:
            InvalidInputError: in-betweens, or a model's frames, and transparency are asked for together, the
                background is unknown, or there is no such frame.
        """
        check_drawing(every=every)
        drawing = self._drawing
        closes = drawing.closes
        at = keyframe_indices(len(self), every, at=keyframes_at, loops=closes) if every > 1 or keyframes_at else []
        chosen = self.background("transparent" if transparent and background is None else background)
        if background is None and not transparent and at:
            chosen = Background()
        check_drawing(transparent=chosen.has_alpha, in_betweens=bool(at), pixel_art=self.pixel_art)
        pictures = drawing.with_in_betweens(at, chosen, progress) if at else drawing.frames(chosen, progress)
        return self._measured("render", pictures, progress)

    def layers(self, t: int) -> Artwork:
        """Frame ``t`` as layers, for painting programs; see :meth:`LayeredRenderer.artwork`.

        Args:
            t: number of the frame that is shown, from 0.

        Raises:
            InvalidInputError: there is no such frame, or it is pixel art.
        """
        from .composite import PixelArtRenderer

        require("frame", t, 0 <= t < len(self), f"0 to {len(self) - 1}")
        if isinstance(self.renderer, PixelArtRenderer):
            raise InvalidInputError("frames in layers must be without pixel_art. Got: pixel art")
        return self.renderer.artwork(self.first + t)

    def save_layers(self, folder: StrPath, *, width: int | None = None, progress: StageProgress | None = None) -> None:
        """Write each layer as a sequence of its own, for painters: ``OUT/01 hair/frame_0000.png``.

        A flat picture has its background, its parts, and what stands in front of them as layers. Those that stand still
        have one frame. All frames are RGBA as large as the canvas.

        Args:
            folder: where to; it is made where it is missing.
            width: width of the written frames [px]; that of the illustration when None.
            progress: called after each frame with the stage "render".

        Raises:
            InvalidInputError: the illustration is pixel art, or one of the folders holds frames that PhysAnimator did
                not write.
        """
        from .artwork import layer_on_canvas
        from .layer_sequences import check_layer_sequences, layer_folders

        artwork = self.layers(0)
        moving = self.renderer.moving_layers  # type: ignore[union-attr]
        check_layer_sequences(artwork, folder)
        os.makedirs(folder, exist_ok=True)
        folders = layer_folders(artwork, folder)
        counts = [len(self) if index in moving else 1 for index in range(len(artwork.layers))]
        done = 0
        for index, (place, count) in enumerate(zip(folders, counts, strict=True)):

            def drawn(index: int = index, count: int = count) -> Iterator[Image]:
                nonlocal done
                for t in range(count):
                    bent = self.renderer.artwork(self.first + t, only=index)  # type: ignore[union-attr]
                    yield layer_on_canvas(bent.layers[index], bent)
                    done += 1
                    if progress is not None:
                        progress("render", done, sum(counts))

            self.write(drawn(), f"{place}/", width=width)

    def sketches(self, *, progress: StageProgress | None = None) -> Iterator[Image]:
        """The line drawing of the illustration, warped along the motion: float32 0..1, shape [h, w], lines dark."""
        return self._measured("sketch", self._drawing.sketches(), progress)

    def flows(self, *, progress: StageProgress | None = None) -> Iterator[Image]:
        """The optical flow from the drawing as colours, on one scale for the whole clip."""
        from ..physics.motion import FlowSequence
        from .overlays import flow_to_color

        rest = np.concatenate([body.mesh.vertices for body in self.motion.bodies]).astype(np.float32)
        longest = max(1.0, float(np.linalg.norm(self.motion.positions - rest, axis=2).max()))
        fields = FlowSequence(self.motion)
        found = map(fields.flow, self.shown)
        drawn = (flow_to_color(each.displacement, each.inside, max_px=longest) for each in found)
        return self._measured("flow", drawn, progress)

    def previews(self, *, progress: StageProgress | None = None) -> Iterator[Image]:
        """The animation with meshes, pins and strokes drawn over it."""
        from .overlays import preview

        drawn = (preview(over(self.renderer.frame(t)), self.motion, self.scene, t) for t in self.shown)
        return self._measured("preview", drawn, progress)

    def save(
        self,
        path: StrPath,
        *,
        transparent: bool = False,
        every: int = 1,
        width: int | None = None,
        progress: StageProgress | None = None,
        background: str | None = None,
        keyframes_at: Sequence[int] = (),
    ) -> None:
        """Write the animation to a video, an animated picture or a folder of pictures.

        Args:
            path: a name in .mp4, .webm, .mov, .gif, .webp or .apng, or a folder ending in ``/``.
            transparent: see :meth:`frames`.
            every: see :meth:`frames`.
            width: width of the written frames [px]; that of the illustration when None.
            progress: see :meth:`frames`.
            background: see :meth:`frames`; None keeps the picture's transparency if the file can hold it.
            keyframes_at: see :meth:`frames`.

        Raises:
            InvalidInputError: nothing can be written there, or the background is unknown.
        """
        check_drawing(every=every)
        name = "transparent" if transparent and background is None else background
        if name is None and (every > 1 or keyframes_at or self.networks.draws_opaque or not holds_alpha(path)):
            name = "picture"
        check_output(path, alpha=self.background(name).has_alpha)
        pictures = self.frames(every=every, progress=progress, background=name, keyframes_at=keyframes_at)
        self.write(pictures, path, width=width)

    def write(self, pictures: Iterable[Image], path: StrPath, *, width: int | None = None) -> None:
        """Write any of the clips of this animation, at its frame rate; see :func:`write_animation`.

        Args:
            pictures: what :meth:`frames`, :meth:`sketches`, :meth:`flows` or :meth:`previews` give.
            path: where to.
            width: width of the written frames [px]; that of the illustration when None.
        """
        written = pictures
        if width is not None:
            height, nearest = self.height_at(width), self.pixel_art
            written = (resized(picture, width, height, nearest=nearest) for picture in pictures)
        drawing = sum(self.seconds.values())
        start = time.perf_counter()
        with _ended(pictures):
            write_animation(written, path, self.motion.frame_rate, exact=self.pixel_art)
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
        """Write every vertex of every frame as JSON; see :func:`~physanimator.physics.motion.export.motion_to_dict`.

        Args:
            path: a name in .json.

        Raises:
            InvalidInputError: nothing can be written there.
        """
        from ..physics.motion import motion_to_json

        check_text_output(path, ".json")
        write_text(path, motion_to_json(self.shown_motion))

    def save_scene(self, path: StrPath) -> None:
        """Write the scene as a document without meshes, for ``animate(..., scene=...)`` and the scene editor.

        Args:
            path: a name in .json.

        Raises:
            InvalidInputError: nothing can be written there.
        """
        from ..physics.document import dumps

        check_text_output(path, ".json")
        write_text(path, dumps(self.scene, meshes=False))

    def save_vectors(
        self, folder: StrPath, *, channels: VectorChannels = "nuke", progress: StageProgress | None = None
    ) -> None:
        """Write motion vectors as EXR files, one a frame; see :func:`~.export.save_motion_vectors`.

        Args:
            folder: where to; it is made where it is missing.
            channels: whose names and signs.
            progress: called after each frame with the stage "vectors".

        Raises:
            InvalidInputError: nothing can be written there, or the package OpenEXR is missing.
        """
        from .export import save_motion_vectors

        save_motion_vectors(self.shown_motion, folder, channels=channels, progress=stage_of("vectors", progress))

    def save_spine(
        self, folder: StrPath, *, tolerance: float = DEFAULT_TOLERANCE, progress: StageProgress | None = None
    ) -> list[str]:
        """Write a skeleton for Spine 4.2 and its runtimes: ``NAME.json``, ``NAME.atlas``, its pages, and ``images/``.

        Each layer, or of a flat picture each part, is a slot; moving ones are meshes with deform keys.

        Args:
            folder: where to; it is made where it is missing, and its name is the skeleton's.
            tolerance: how far a vertex may ever be from where the motion has it [px].
            progress: called after each layer with the stage "spine".

        Returns:
            Sentences that say what was written, and what is otherwise than in the frames.

        Raises:
            InvalidInputError: the folder holds a skeleton that PhysAnimator did not write, nothing can be written
                there, the tolerance is out of its range, or the illustration is pixel art.
        """
        from .editable import save_renderer_as_spine

        hears = stage_of("spine", progress)
        return save_renderer_as_spine(self.renderer, folder, first=self.first, tolerance=tolerance, progress=hears)

    def save_gltf(
        self, path: StrPath, *, tolerance: float = DEFAULT_TOLERANCE, progress: StageProgress | None = None
    ) -> list[str]:
        """Write a glTF scene for 3D programs and engines: each layer or part a textured mesh with morph targets.

        Args:
            path: a name in .glb.
            tolerance: how far a vertex may ever be from where the motion has it [px].
            progress: called after each layer with the stage "gltf".

        Returns:
            Sentences that say what was written, and what is otherwise than in the frames.

        Raises:
            InvalidInputError: nothing can be written there, the tolerance is out of its range, or the illustration is
                pixel art.
        """
        from .editable import save_renderer_as_gltf

        hears = stage_of("gltf", progress)
        return save_renderer_as_gltf(self.renderer, path, first=self.first, tolerance=tolerance, progress=hears)

    def save_svg(self, path: StrPath) -> None:
        """Write the moving meshes over the faded illustration as an SVG that plays in a browser.

        Args:
            path: a name in .svg.

        Raises:
            InvalidInputError: nothing can be written there.
        """
        from ..physics.motion import motion_to_svg
        from .pictures import data_address

        check_text_output(path, ".svg")
        write_text(path, motion_to_svg(self.shown_motion, background=data_address(over(self.image))))

    def save_plate(self, path: StrPath) -> None:
        """Write the picture without its moving parts, as it is behind them in the frames.

        Args:
            path: a name in .png.

        Raises:
            InvalidInputError: nothing can be written there.
        """
        check_text_output(path, ".png")
        save_image(path, self.renderer.plate)

    def save_uncovered(
        self, path: StrPath, *, grow: float = 8.0, soft_edge: float = 0.0, progress: StageProgress | None = None
    ) -> None:
        """Write a mask of what the parts uncover in the whole clip, for an image model that paints it once.

        Give what it has painted to ``animate(..., plate=...)``. The mask of layered artwork is black: what is behind
        its parts is drawn already.

        Args:
            path: a name in .png.
            grow: how far the mask reaches beyond what is uncovered [px].
            soft_edge: width of a transition around it [px].
            progress: called after each frame with the stage "uncovered".

        Raises:
            InvalidInputError: nothing can be written there, a width is out of its range, or the illustration is pixel
                art.
        """
        from .composite import PixelArtRenderer
        from .neural.uncovered_area import uncovered_area

        if isinstance(self.renderer, PixelArtRenderer):
            raise InvalidInputError("a mask of what is uncovered must be without pixel_art. Got: pixel art")
        check_text_output(path, ".png")
        numbers, hears = range(self.first, len(self.motion)), stage_of("uncovered", progress)
        widths, drawn = {"grow": grow, "soft_edge": soft_edge}, bool(self.own)
        area = uncovered_area(self.renderer, **widths, drawn=drawn, numbers=numbers, progress=hears)
        save_image(path, area)

    def save_tracks(self, path: StrPath, **options: Any) -> None:
        """Write tracks for motion-controlled video models as JSON; see :func:`~physanimator.physics.motion.tracks`.

        Args:
            path: a name in .json.
            options: those of :func:`~physanimator.physics.motion.tracks`.

        Raises:
            InvalidInputError: nothing can be written there, or an option is out of its range.
        """
        from ..physics.motion import tracks

        check_text_output(path, ".json")
        write_text(path, tracks(self.shown_motion, **options).to_json() + "\n")

    @property
    def _drawing(self) -> FrameDrawing:
        drawn = self.image, self.masks, self.own, self.motion, self.renderer, self.first, self.networks
        return FrameDrawing(*drawn, self.wait_for)

    def _measured(self, stage: str, pictures: Iterable[T], progress: StageProgress | None) -> Iterator[T]:
        iterator = iter(pictures)
        with _ended(iterator):
            for done in range(1, len(self) + 1):
                with timed(self.seconds, stage):
                    picture = next(iterator)
                if progress is not None:
                    progress(stage, done, len(self))
                yield picture


@contextmanager
def _ended(pictures: Iterable[Any]) -> Iterator[None]:
    """End what other threads make of pictures, however a block ends."""
    try:
        yield
    finally:
        if isinstance(pictures, Generator):
            pictures.close()


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
