"""The frames of an animation and its sketches: by the illustration's own pixels, or by the networks that are chosen."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..physics.mesh import coverage_of
from ..physics.motion import FlowSequence, Motion
from .composite import Background, LayeredRenderer, PixelArtRenderer, shown_frame
from .neural import NetworkOptions
from .pictures import as_uint8, over
from .stages import StageProgress, stage_of

__all__ = ["FrameDrawing"]

Image = NDArray[Any]


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
    """

    image: Image
    masks: Sequence[NDArray[Any]]
    own: Sequence[Image]
    motion: Motion
    renderer: LayeredRenderer | PixelArtRenderer
    first: int
    networks: NetworkOptions

    @property
    def shown(self) -> range:
        """The motion's frames that are shown."""
        return range(self.first, len(self.motion))

    def sketches(self) -> Iterator[Image]:
        """The line drawing of each frame, lines dark on white, float32, shape [h, w]."""
        return self._sketches(self.motion, self.shown)

    def frames(self, background: Background, progress: StageProgress | None) -> Iterable[Image]:
        """All frames, each drawn anew."""
        if not self.networks.draws_all:
            return self._composed(self.shown, background, progress)
        return self._sketch_guided(self._guides(), background, progress)

    def with_in_betweens(
        self, at: Sequence[int], background: Background, progress: StageProgress | None
    ) -> Iterator[Image]:
        """All frames, of which those between keyframes are filled in.

        Args:
            at: numbers of the keyframes among the frames that are shown, increasing.
            background: what is there where nothing moves; opaque.
            progress: called with the steps of models.
        """
        led = self.networks.sketch_encoder is not None
        guides = self._guides() if led or self.networks.draws_all else []
        drawn = self._kept(at, guides, background, progress)
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
        wanted = sorted({*at, *range(at[0]), *range(at[-1], len(self.shown))})
        if not self.networks.draws_all:
            painted = self._composed([self.first + t for t in wanted], background, progress)
            return dict(zip(wanted, painted, strict=True)).__getitem__
        frames = enumerate(self._sketch_guided(guides, background, progress))
        return {t: frame for t, frame in frames if t in wanted}.__getitem__

    def _composed(
        self, numbers: Sequence[int], background: Background, progress: StageProgress | None
    ) -> Iterator[Image]:
        """Frames of the illustration's own pixels, with holes painted where that is chosen."""
        if not self.networks.draws_opaque:
            return (shown_frame(self.renderer, t, background) for t in numbers)
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

    def _between(
        self, keyframes: list[Image], at: Sequence[int], guides: list[Image], progress: StageProgress | None
    ) -> Iterator[Image]:
        """Keyframes, and what is between them."""
        from .inbetweens import interpolate
        from .matting import shown_part
        from .neural.drawing import in_between_backend

        backend = in_between_backend(self.networks, stage_of("tooncrafter", progress))
        if not isinstance(backend, str):
            return interpolate(keyframes, at, backend=backend, sketches=guides)
        masks = [coverage_of(mask) for mask in self.masks]
        shown = masks if self.own else [shown_part(self.image, mask) for mask in masks]
        return interpolate(keyframes, [self.first + t for t in at], backend=backend, motion=self.motion, masks=shown)

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

    def _sketch_guided(
        self, guides: list[Image], background: Background, progress: StageProgress | None
    ) -> Iterator[Image]:
        """All frames by the video model, which begins with the illustration: where none of them shows it, one more."""
        from .neural.drawing import load_svd, sketch_guided_frames

        begins_at_rest = self.first == 0 and self.motion.loop is None
        if not begins_at_rest:
            rest = np.concatenate([body.mesh.vertices for body in self.motion.bodies])[None]
            resting = replace(self.motion, positions=rest, loop=None)
            guides = [*map(as_uint8, self._sketches(resting, [0])), *guides]
        models, placement = load_svd(self.networks)
        frames = sketch_guided_frames(
            models,
            over(self.image, background.colour),
            guides,
            options=self.networks.svd_options,
            placement=placement,
            alphas=map(self.renderer.alpha, self.shown) if self.networks.still_parts else None,
            soft_edge=self.networks.edge_width,
            progress=stage_of("svd", progress),
        )
        return itertools.islice(frames, 0 if begins_at_rest else 1, None)
