"""The frames of an animation and its sketches: by the illustration's own pixels, or by the networks that are chosen."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..physics.beside import made_ahead
from ..physics.mesh import coverage_of
from ..physics.motion import FlowSequence, Motion
from .composite import Background, LayeredRenderer, PixelArtRenderer, shown_frame, shown_frame_and_alpha
from .neural import NetworkOptions
from .pictures import as_float, as_uint8, over
from .stages import StageProgress, stage_of
from .svd import CrudeAnimation

if TYPE_CHECKING:
    from .neural.colour_drift import Reference

__all__ = ["DrawsFrames", "FrameDrawing", "drawn_elsewhere", "frames_drawn_by"]

Image = NDArray[Any]

DrawsFrames = Callable[["LayeredRenderer | PixelArtRenderer", Sequence[int], Background], Iterator[Image] | None]
"""Called with a renderer, numbers of its motion's frames and a background; gives those frames in turn, or None where it
would rather not."""

_AT_ONCE = 4  # frames that are drawn at once: the encoders take no more of them
_PIXELS_AT_ONCE = 40_000_000  # of these frames together: some 80 bytes each

_drawn_by: ContextVar[DrawsFrames | None] = ContextVar("drawn_by", default=None)


@contextmanager
def frames_drawn_by(draw: DrawsFrames) -> Iterator[None]:
    """Let somebody else draw the frames that come from the illustration's own pixels, on this thread.

    Args:
        draw: must give the very pixels that :func:`~physanimator.rendering.composite.shown_frame` does.
    """
    token = _drawn_by.set(draw)
    try:
        yield
    finally:
        _drawn_by.reset(token)


def drawn_elsewhere() -> bool:
    """Whether somebody else draws on this thread; see :func:`frames_drawn_by`."""
    return _drawn_by.get() is not None


@dataclass(frozen=True, eq=False)
class FrameDrawing:
    """Draws the shown frames of a motion.

    Attributes:
        image: the illustration, RGB or straight RGBA.
        masks: where each moving part is, shape [h, w] each.
        own: each part alone, straight RGBA; empty where only masks are known.
        motion: where every vertex is in every frame.
        renderer: draws frames from the illustration's own pixels.
        first: number of the motion's first frame that is shown.
        networks: who draws what.
        wait_for: returns when a frame of the motion is known, where that is still simulated.
    """

    image: Image
    masks: Sequence[NDArray[Any]]
    own: Sequence[Image]
    motion: Motion
    renderer: LayeredRenderer | PixelArtRenderer
    first: int
    networks: NetworkOptions
    wait_for: Callable[[int], None] | None = None

    @property
    def shown(self) -> range:
        """The motion's frames that are shown."""
        return range(self.first, len(self.motion))

    @property
    def closes(self) -> bool:
        """Whether the last shown frame leads to the first, as what draws frames is to know."""
        loop, count = self.motion.loop, len(self.shown)
        return self.networks.close_loop and loop is not None and count > 1 and count % loop.frames == 0

    def sketches(self) -> Iterator[Image]:
        """The line drawing of each frame, lines dark on white, float32, shape [h, w]."""
        return self._sketches(self.motion, self.shown)

    def frames(self, background: Background, progress: StageProgress | None) -> Iterable[Image]:
        """All frames, each drawn anew."""
        if not self.networks.draws_all:
            return self._composed(self.shown, background, progress)
        guides = self._guides() if self.networks.follows_sketches else []
        return self._by_video_model(guides, background, progress)

    def with_in_betweens(
        self, at: Sequence[int], background: Background, progress: StageProgress | None
    ) -> Iterator[Image]:
        """All frames, of which those between keyframes are filled in.

        Args:
            at: numbers of the keyframes among the frames that are shown, increasing. Of a clip that closes, all other
                frames are in-betweens.
            background: what is there where nothing moves; opaque.
            progress: called with the steps of models.
        """
        led = self.networks.sketch_encoder is not None
        guides = self._guides() if led or self.networks.follows_sketches else []
        drawn = self._kept(at, guides, background, progress)
        if self.closes and len(at) > 1:
            yield from self._between([drawn(t) for t in at], at, guides if led else [], progress, loop=len(self.shown))
            return
        count = len(self.shown)
        yield from map(drawn, range(at[0]))
        yield from self._between([drawn(t) for t in at], at, guides if led else [], progress)
        yield from map(drawn, range(at[-1] + 1, count))

    def _kept(
        self, at: Sequence[int], guides: list[Image], background: Background, progress: StageProgress | None
    ) -> Callable[[int], Image]:
        """What gives each frame that is no in-between; a model draws all of them at once."""
        if not self.networks.draws_opaque:
            return lambda t: shown_frame(self.renderer, self.first + t, background)
        around = () if self.closes and len(at) > 1 else (*range(at[0]), *range(at[-1], len(self.shown)))
        wanted = sorted({*at, *around})
        if not self.networks.draws_all:
            painted = self._composed([self.first + t for t in wanted], background, progress)
            return dict(zip(wanted, painted, strict=True)).__getitem__
        frames = enumerate(self._by_video_model(guides, background, progress))
        return {t: frame for t, frame in frames if t in wanted}.__getitem__

    def _composed(
        self, numbers: Sequence[int], background: Background, progress: StageProgress | None
    ) -> Iterator[Image]:
        """Frames of the illustration's own pixels, with holes painted where that is chosen."""
        if not self.networks.draws_opaque:
            draw = _drawn_by.get()
            elsewhere = None if draw is None else draw(self.renderer, numbers, background)
            here = partial(shown_frame, self.renderer, background=background)
            most = max(1, min(_AT_ONCE, _PIXELS_AT_ONCE // (self.motion.width * self.motion.height)))
            return elsewhere or made_ahead(here, self._known(numbers), most=most)
        from .neural.soft_inpainting import changes_of_holes, load_inpainting, painted_frames

        layers: Any = self.renderer
        models, placement = load_inpainting(self.networks)
        return painted_frames(
            models,
            layers,
            background,
            changes_of_holes(layers, grow=self.networks.grow, soft_edge=self.networks.edge_width),
            options=self.networks.inpainting_options,
            placement=placement,
            numbers=numbers,
            progress=stage_of("inpainting", progress),
        )

    def _known(self, numbers: Sequence[int]) -> Iterator[int]:
        """Numbers of frames, each when it is known."""
        for t in numbers:
            if self.wait_for is not None:
                self.wait_for(t)
            yield t

    def _between(
        self,
        keyframes: list[Image],
        at: Sequence[int],
        guides: list[Image],
        progress: StageProgress | None,
        loop: int | None = None,
    ) -> Iterator[Image]:
        """Keyframes, and what is between them; of a loop all frames."""
        from .inbetweens import interpolate
        from .matting import shown_part
        from .neural.drawing import in_between_backend

        backend = in_between_backend(self.networks, stage_of("tooncrafter", progress))
        if not isinstance(backend, str):
            return interpolate(keyframes, at, backend=backend, sketches=guides, loop=loop)
        masks = [coverage_of(mask) for mask in self.masks]
        shown = masks if self.own else [shown_part(self.image, mask) for mask in masks]
        motion = self.motion[self.first :]
        return interpolate(keyframes, at, backend=backend, motion=motion, masks=shown, loop=loop)

    def _guides(self) -> list[Image]:
        """The sketches, as video models follow them."""
        return [as_uint8(each) for each in self.sketches()]

    def _sketches(self, motion: Motion, frames: Iterable[int]) -> Iterator[Image]:
        from .neural.line_drawing import line_extractor
        from .sketch import warped_sketches

        extract = line_extractor(self.networks)
        sketch, behind = extract(over(self.image)), extract(over(self.renderer.plate))
        own = [extract(over(part)) for part in self.own] or None
        mode, blur = self.networks.sketch_warp, self.networks.sketch_blur
        layers: dict[str, Any] = {"behind": behind, "own": own} if mode == "layered" else {}
        for each in warped_sketches(sketch, FlowSequence(motion), frames, mode=mode, blur_sigma=blur, **layers):
            yield each.sketch

    def _by_video_model(
        self, guides: list[Image], background: Background, progress: StageProgress | None
    ) -> Iterator[Image]:
        """All frames by the video model, which begins with the illustration: where none of them shows it, one more.

        Args:
            guides: the sketches of all frames; not used where only the animation is followed.
            background: what is there where nothing moves; opaque.
            progress: called with its steps.
        """
        from .neural.colour_drift import own_colours
        from .neural.drawing import load_svd, sketch_guided_frames

        networks, picture = self.networks, over(self.image, background.colour)
        begins_at_rest = self.first == 0 and self.motion.loop is None
        sketches = guides if networks.follows_sketches else []
        if sketches and not begins_at_rest:
            sketches = [*map(as_uint8, self._sketches(self._resting, [0])), *sketches]
        models, placement = load_svd(networks)
        composed = self._colours(background, [] if begins_at_rest else [own_colours(as_float(picture))])
        frames = sketch_guided_frames(
            models,
            picture,
            sketches,
            options=networks.svd_options,
            placement=placement,
            animation=self._followed(picture, begins_at_rest, background) if networks.follows_animation else None,
            alphas=map(self.renderer.alpha, self.shown) if networks.still_parts else None,
            soft_edge=networks.edge_width,
            progress=stage_of("svd", progress),
            loops=self.closes,
            colour_match=self.networks.colour_match,
            references=composed,
        )
        return itertools.islice(frames, 0 if begins_at_rest else 1, None)

    @property
    def _resting(self) -> Motion:
        """One frame of the illustration as it is."""
        rest = np.concatenate([body.mesh.vertices for body in self.motion.bodies])[None]
        return replace(self.motion, positions=rest, loop=None)

    def _followed(self, picture: Image, begins_at_rest: bool, background: Background) -> CrudeAnimation:
        """Composite's frames, and where parts move in them; before them the illustration, where none shows it."""
        layers: Any = self.renderer
        before = 0 if begins_at_rest else 1

        def at(number: int) -> tuple[Image, Image]:
            if number < before:
                return picture, layers.alpha_at_rest
            return shown_frame_and_alpha(layers, self.shown[number - before], background)

        return CrudeAnimation(before + len(self.shown), at)

    def _colours(self, background: Background, before: Sequence[Reference]) -> Iterator[Reference]:
        """What colours frames should have: those of the illustration's own pixels, where no hole is."""
        yield from before
        renderer: Any = self.renderer
        for t in self.shown:
            frame, alpha = shown_frame_and_alpha(renderer, t, background)
            yield as_float(frame), 1 - renderer.uncovered_by(alpha)
