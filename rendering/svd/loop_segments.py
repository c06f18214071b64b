"""How a clip that repeats is made of segments: the last one lies between the end of the clip and its beginning.

Frames count from 0, the reference picture, which is not part of the loop; frame 1 comes again after the last. All but
the last frames are made as in any clip. Those are made by a closing segment whose clip begins with frames of the
segment before and ends with the first frames of the loop. Both are held: in every step their denoised latents are put
back, so that they come out as they were; only the frames between them are made from noise.
"""

from __future__ import annotations

from dataclasses import replace
from math import log

from .frame_layout import CLIP_FRAMES, LEAST_OVERLAP, OVERLAP, FrameLayout, KeyFrames
from .plain_segments import plan_plain_segments
from .segments import Segment, plan_segments

__all__ = ["closing_layout", "plan_clip", "plan_loop"]


def plan_clip(frames: int, overlap: int = OVERLAP, *, loops: bool = False, plain: bool = False) -> tuple[Segment, ...]:
    """The segments that make a clip, which may repeat, by LVCD or by plain Stable Video Diffusion.

    See :func:`plan_loop`, :func:`plan_segments` and :func:`plan_plain_segments`.
    """
    if loops:
        return plan_loop(frames, overlap, plain=plain)
    return plan_plain_segments(frames, overlap) if plain else plan_segments(frames, overlap)


def plan_loop(frames: int, overlap: int = OVERLAP, *, plain: bool = False) -> tuple[Segment, ...]:
    """The segments that make a clip whose last frame leads to frame 1.

    Args:
        frames: of the clip, the reference picture included; 2 or more.
        overlap: frames that neighbouring segments share; the closing one shares at most 6 at either end.
        plain: Stable Video Diffusion alone makes them; see :func:`plan_plain_segments`.
    """
    cycle = frames - 1
    if cycle < 2:
        return plan_clip(frames, overlap, plain=plain)
    shared = min(overlap, (CLIP_FRAMES - 1) // 2, cycle - 1)
    new = min(CLIP_FRAMES - 2 * shared, cycle - shared)
    *whole, last = plan_clip(frames - new, overlap, plain=plain)
    segments = (*whole, _led_on(last, frames - new, cycle))
    closing = _closing(segments, cycle, shared=shared, new=new)
    return (*segments, _without_references(closing) if plain else closing)


def _without_references(segment: Segment) -> Segment:
    """A closing segment for a network that reads none: it is conditioned on its own first frame."""
    references, count = segment.layout.references, segment.layout.count
    return Segment(
        FrameLayout(0, (KeyFrames(tuple(range(count - references))),)),
        segment.sketches[references:],
        (),
        segment.blended,
        segment.noise[references:],
        tuple(slot - references for slot in segment.made),
        conditioned_on=segment.blended[0],
        closes=segment.closes,
    )


def closing_layout(shared: int, new: int, *, amplification: float = 10.0) -> FrameLayout:
    """A segment between two others: each new frame attends to one a little nearer to the end that is closer.

    Args:
        shared: frames of the segment before, and as many of the first one, which are references and clip frames.
        new: frames between them.
        amplification: so many times counts a token of the frame that a shared one is.
    """
    references, reach = 1 + 2 * shared, min(LEAST_OVERLAP, shared)
    before = range(references, references + shared)
    between = range(before.stop, before.stop + new)
    after = range(between.stop, between.stop + shared)
    middle = between.start + (new + 1) // 2
    keys = tuple(slot - reach if slot < middle else slot + reach for slot in between)
    runs = (
        KeyFrames(tuple(range(references))),
        KeyFrames(tuple(before), tuple(range(1, 1 + shared)), log(amplification)),
        KeyFrames(keys, (0,) * new),
        KeyFrames(tuple(after), tuple(range(1 + shared, references)), log(amplification)),
    )
    return FrameLayout(references, runs)


def _led_on(segment: Segment, frames: int, cycle: int) -> Segment:
    """A last segment whose surplus frames follow the sketches that come next instead of the last one again."""
    end = segment.made[-1] + 1
    surplus = range(frames, frames + len(segment.sketches) - end)
    return replace(segment, sketches=(*segment.sketches[:end], *(1 + (frame - 1) % cycle for frame in surplus)))


def _closing(segments: tuple[Segment, ...], cycle: int, *, shared: int, new: int) -> Segment:
    first, before = segments[0], segments[-1]
    end, start = before.made[-1] + 1, first.made[0]
    ending, opening = range(end - shared, end), range(start, start + shared)
    led = range(cycle - new - shared + 1, cycle - new + 1)
    held = (*ending, *(before.layout.count + slot for slot in opening))
    noise = [before.noise[slot] for slot in ending], [first.noise[slot] for slot in opening]
    unused = [slot for slot in range(first.layout.references, first.layout.count) if slot not in {*noise[0], *noise[1]}]
    layout = closing_layout(shared, new)
    return Segment(
        layout,
        sketches=(0, *led, *range(1, 1 + shared), *led, *range(cycle - new + 1, cycle + 1), *range(1, 1 + shared)),
        carried=held,
        blended=held,
        noise=(first.noise[0], *noise[0], *noise[1], *noise[0], *unused[:new], *noise[1]),
        made=tuple(range(layout.references + shared, layout.references + shared + new)),
        closes=shared,
    )
