"""Clips of our own simulator: frames, sketches and the exact flow, from artwork and random scenes."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.checks import check_whole
from ...physics.errors import InvalidInputError
from ...physics.progress import Progress
from ..animation import Animation
from ..artwork import Artwork, is_artwork_file, load_artwork
from ..files import replacing
from ..options import DEFAULT_FRAME_RATE, Timing, Watch
from ..pictures import load_image, load_mask, over
from ..pipeline import animate
from .building import BuildOptions, file_names, write_sketches
from .clip_writing import write_clip
from .data_folder import ClipRecord, clip_file, index_file
from .data_journal import DataJournal
from .data_summary import newest_records
from .dynamics import dynamics_score
from .framing import Window, framed, size_of, window_of
from .random_scenes import random_motion, with_strokes
from .sketching import sketcher_of
from .source_videos import identity_of

__all__ = ["SimulationWork", "flow_file", "simulate_clips"]

_TRIES = 4  # scenes for each clip that is wanted: some move too little
_EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example" / "illustration.psd"


@dataclass(frozen=True)
class SimulationWork:
    """What is made.

    Attributes:
        data: the data folder.
        options: size of the clips, their rate (24 where it is 0), and which are kept.
        clips: how many kept clips there shall be of this artwork and seed.
        frames: of a clip.
        seed: of all chance.
        lines: weights of a line drawing network for the sketches.
        device: where it computes.
        licence: for the record.

    Raises:
        InvalidInputError: a number is out of range.
    """

    data: Path
    options: BuildOptions
    clips: int
    frames: int = 48
    seed: int = 0
    lines: Path | None = None
    device: str = "auto"
    licence: str = ""

    def __post_init__(self) -> None:
        check_whole("clips", self.clips, 1, 1_000_000)
        check_whole("frames", self.frames, self.options.bounds.least_frames, 2000)
        check_whole("seed", self.seed, 0, 2**63 - 1)


def flow_file(data: Path, name: str) -> Path:
    """Where the exact flow of a simulated clip is.

    A .npz with ``flow``, float16, shape [f, h, w, 2]: how far each pixel of the illustration has moved in each frame,
    x right and y down, in pixels of the clip.
    """
    return data / "flow" / f"{name}.npz"


def simulate_clips(
    artworks: Sequence[Path], masks: Sequence[str], work: SimulationWork, *, progress: Progress | None = None
) -> int:
    """Make clips until there are as many as are wanted; those that are there already stay.

    Args:
        artworks: layered artwork, or one picture with ``masks``; none: the bundled example.
        masks: of the parts of one flat picture.
        work: what is made.
        progress: called after each frame with frames done and in all; may raise to stop.

    Returns:
        How many were made now.

    Raises:
        InvalidInputError: a file is unusable, or the folder is not ours.
    """
    places = list(artworks) or [_EXAMPLE]
    for place in places:
        _check_artwork(place, masks, len(places))
    name, sketch = sketcher_of(work.lines, work.device)
    journal = DataJournal(work.data)
    journal.open({"size": work.options.size, "sketches": name})
    flow_file(work.data, "").parent.mkdir(exist_ok=True)
    identity = _identity(places, masks, work)
    names = file_names(places[0], identity)
    journal.begin([(identity, names, places[0])])
    earlier = {each.name: each for each in newest_records(work.data)} if index_file(work.data).is_file() else {}
    kept = made = 0
    for number in range(_TRIES * work.clips):
        if kept == work.clips:
            return made
        clip = f"{names}_{number:06d}"
        if clip not in earlier:

            def frames_done(_: str, done: int, total: int, kept: int = kept) -> None:
                if progress is not None:
                    progress(kept * work.frames + min(done, work.frames), work.clips * work.frames)

            record = _made(clip, places[number % len(places)], masks, number, work, name, frames_done)
            if record.kept:
                write_sketches(work.data, record, sketch)
                made += 1
            journal.finish(identity, places[0], [record])
            earlier[clip] = record
        kept += earlier[clip].kept
    if kept < work.clips:
        raise InvalidInputError(
            f"ARTWORK must move in random scenes. Got: {kept} clips of {work.clips} with a dynamics score within the"
            f" bounds, in {_TRIES * work.clips} scenes"
        )
    return made


def _made(
    name: str, place: Path, masks: Sequence[str], number: int, work: SimulationWork, drawn_by: str, progress: Any
) -> ClipRecord:
    """One clip; written where it is kept."""
    animation, box, size = _animation(place, masks, number, work, progress)
    fps = animation.motion.frame_rate
    pictures = [framed(over(frame), box, size) for frame in animation.frames(background="picture", progress=progress)]
    score = dynamics_score(pictures)
    why = work.options.bounds.why_not(len(pictures), score)
    if not why:
        write_clip(pictures, clip_file(work.data, name), fps)
        _write_flow(flow_file(work.data, name), _flows(animation, box, size))
    return ClipRecord(
        name,
        f"{place} (simulated, seed {work.seed}, scene {number})",
        0.0,
        len(pictures) / fps,
        len(pictures),
        fps,
        *size,
        round(score, 6),
        not why,
        why,
        "" if why else drawn_by,
        work.licence,
    )


def _animation(
    place: Path, masks: Sequence[str], number: int, work: SimulationWork, progress: Any
) -> tuple[Animation, Window, tuple[int, int]]:
    picture, parts = _loaded(place, tuple(masks))
    wide, high = (picture.width, picture.height) if isinstance(picture, Artwork) else picture.shape[1::-1]
    size = size_of(work.options.size)
    window = window_of(wide, high, (0.0, 0.0, 1.0, 1.0), size)
    if window is None:
        raise InvalidInputError(f"ARTWORK must be at least half as large as {work.options.size}. Got: {place}")
    chance = np.random.default_rng([work.seed, number])
    motion = random_motion(chance, len(parts))
    rate = work.options.fps or DEFAULT_FRAME_RATE
    how: dict[str, Any] = {"masks": parts} if parts else {}
    timing = Timing(frames=work.frames, frame_rate=rate)
    first: dict[str, Any] = {"preset": list(motion.presets)} if parts else {}
    calm = animate(picture, wind=motion.wind, timing=Timing(frames=1, frame_rate=rate), **how, **first)
    scene = with_strokes(calm.scene, chance, motion.strokes, (wide, high))
    return animate(picture, scene=scene, timing=timing, watch=Watch(progress=progress), **how), window, size


def _flows(animation: Animation, window: Window, size: tuple[int, int]) -> Iterator[NDArray[np.float16]]:
    from ...physics.motion import FlowSequence

    left, top, right, bottom = window
    scale = np.array([size[0] / (right - left), size[1] / (bottom - top)], dtype=np.float32)
    fields = FlowSequence(animation.motion)
    for frame in animation.shown:
        part = fields.flow(frame).displacement[top:bottom, left:right]
        smaller = part.shape[1] > size[0]
        resized = cv2.resize(part, size, interpolation=cv2.INTER_AREA if smaller else cv2.INTER_LINEAR)
        yield (resized * scale).astype(np.float16)


def _write_flow(place: Path, flows: Iterator[NDArray[np.float16]]) -> None:
    with replacing(place) as temporary, temporary.open("wb") as opened:
        np.savez_compressed(opened, flow=np.stack(list(flows)))


@lru_cache(maxsize=1)
def _loaded(place: Path, masks: tuple[str, ...]) -> tuple[Any, list[NDArray[Any]]]:
    if is_artwork_file(place):
        return load_artwork(place), []
    picture = load_image(place)
    height, width = picture.shape[:2]
    return picture, [load_mask(mask, width=width, height=height) for mask in masks]


def _check_artwork(place: Path, masks: Sequence[str], count: int) -> None:
    if not place.exists():
        raise InvalidInputError(f"ARTWORK must be a file or folder. Got: no {place}")
    layered = is_artwork_file(place)
    if layered and masks:
        raise InvalidInputError(f"--mask must be left out for layered artwork. Got: {place}")
    if not layered and (not masks or count > 1):
        raise InvalidInputError(f"ARTWORK must be layered, or one flat picture with --mask. Got: {place}")


def _identity(places: Sequence[Path], masks: Sequence[str], work: SimulationWork) -> str:
    """What tells these clips from others: the artwork, and all that random scenes are made from."""
    digest = hashlib.sha256(f"{work.seed}:{work.frames}:{work.options.fps}".encode())
    for place in [*places, *map(Path, masks)]:
        files = sorted(each for each in place.rglob("*") if each.is_file()) if place.is_dir() else [place]
        for each in files:
            digest.update(identity_of(each).encode())
    return digest.hexdigest()[:12]
