"""GIF: one palette for the whole clip, and a dither that does not crawl over parts that stand still."""

from __future__ import annotations

import tempfile
import zlib
from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import av
    from av.filter import Graph
    from av.filter.context import FilterContext

__all__ = ["paletted", "shown_indices"]

# Browsers stretch a delay of one hundredth of a second to ten.
_SHORTEST_DELAY = 2


def shown_indices(count: int, frame_rate: Fraction) -> Iterator[int]:
    """Numbers of the frames that a GIF can show: its delays are whole hundredths of a second, at least two.

    Args:
        count: number of frames.
        frame_rate: frames a second.
    """
    free_from = 0
    for index in range(count):
        hundredth = round(index * 100 / frame_rate)
        if hundredth >= free_from:
            free_from = hundredth + _SHORTEST_DELAY
            yield index


def paletted(
    frames: Iterable[av.VideoFrame],
    frame_rate: Fraction,
    *,
    dithered: bool = True,
    folder: Path | None = None,
) -> Iterator[av.VideoFrame]:
    """Frames in 256 colours that are chosen for all of them together.

    All frames are needed before the first comes out; they wait compressed in a temporary file, not in memory.

    Args:
        frames: of one size, in FFmpeg's format rgb24 or rgba, with their times.
        frame_rate: frames a second.
        dithered: mix colours that are missing from others; without, each pixel gets the nearest one.
        folder: where the temporary file is made, such as that of the result; the system's own when None.

    Yields:
        The frames that a GIF can show, in FFmpeg's format pal8.
    """
    with tempfile.TemporaryFile(dir=folder) as spool:
        lengths: list[int] = []
        palette, like = _palette(_recorded(frames, spool, lengths))
        spool.seek(0)
        yield from _painted(_replayed(spool, lengths, like, frame_rate), palette, like, dithered=dithered)


def _recorded(frames: Iterable[av.VideoFrame], spool: IO[bytes], lengths: list[int]) -> Iterator[av.VideoFrame]:
    """The same frames, each also appended to ``spool``; ``lengths`` collects how many bytes each takes."""
    for frame in frames:
        lengths.append(spool.write(zlib.compress(frame.to_ndarray().tobytes(), 1)))
        yield frame


def _replayed(
    spool: IO[bytes], lengths: list[int], like: av.VideoFrame, frame_rate: Fraction
) -> Iterator[av.VideoFrame]:
    import av

    shape = like.to_ndarray().shape
    shown = set(shown_indices(len(lengths), frame_rate))
    for index, length in enumerate(lengths):
        data = spool.read(length)
        if index in shown:
            pixels: NDArray[Any] = np.frombuffer(zlib.decompress(data), np.uint8).reshape(shape)
            frame = av.VideoFrame.from_ndarray(pixels, format=like.format.name)
            frame.pts, frame.time_base = index, 1 / frame_rate
            yield frame


def _palette(frames: Iterator[av.VideoFrame]) -> tuple[av.VideoFrame, av.VideoFrame]:
    """The palette as a frame of 16x16 px, and the first of ``frames``."""
    from av.filter import Graph

    first = next(frames)
    graph = Graph()
    source, sink = _buffer(graph, first), graph.add("buffersink")
    finder = graph.add("palettegen", f"reserve_transparent={int(first.format.name == 'rgba')}")
    source.link_to(finder)
    finder.link_to(sink)
    graph.configure()
    source.push(first)
    for frame in frames:
        source.push(frame)
    source.push(None)
    return next(_pulled(sink)), first


def _painted(
    frames: Iterable[av.VideoFrame], palette: av.VideoFrame, like: av.VideoFrame, *, dithered: bool
) -> Iterator[av.VideoFrame]:
    from av.filter import Graph

    graph = Graph()
    source, colours, sink = _buffer(graph, like), _buffer(graph, palette), graph.add("buffersink")
    painter = graph.add("paletteuse", f"dither={'bayer:bayer_scale=4' if dithered else 'none'}:diff_mode=rectangle")
    source.link_to(painter, 0, 0)
    colours.link_to(painter, 0, 1)
    painter.link_to(sink)
    graph.configure()
    colours.push(palette)
    colours.push(None)
    for frame in frames:
        source.push(frame)
        yield from _pulled(sink)
    source.push(None)
    yield from _pulled(sink)


def _buffer(graph: Graph, like: av.VideoFrame) -> FilterContext:
    return graph.add_buffer(
        width=like.width, height=like.height, format=like.format, time_base=like.time_base or Fraction(1, 100)
    )


def _pulled(sink: FilterContext) -> Iterator[av.VideoFrame]:
    """The frames that are ready at the end of a filter graph."""
    import av

    while True:
        try:
            frame = sink.pull()
        except (av.error.BlockingIOError, av.error.EOFError):
            return
        yield cast("av.VideoFrame", frame)
