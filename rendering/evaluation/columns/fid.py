"""FID as the paper compares methods: all frames of a method against all illustrations."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .clip import ClipOfPicture
from .column import Column
from .statistics import Summary, summary_of_whole
from .weights import ColumnWeights

__all__ = ["FID"]

_FEWEST = 2
"""One frame has no covariance."""

Features = NDArray[Any]


def _frechet_inception_distance(clips: Iterable[ClipOfPicture], weights: ColumnWeights) -> Summary | None:
    """Of the frames of all clips to the illustrations, each counted once for each frame that was made of it."""
    from ...metrics.learned.fid import features_of, frechet_distance

    assert weights.inception is not None  # else the column is missing
    network = _loaded(weights.inception, weights.device)
    pictures: dict[str, Features] = {}
    frames: dict[str, list[Features]] = {}
    for clip in clips:
        name = _name_of(clip.picture)
        if name not in pictures:
            pictures[name] = features_of(network, [clip.picture])
        frames.setdefault(name, []).append(features_of(network, clip.frames).astype(np.float32))
    made = [np.concatenate(frames[name]) for name in pictures]
    references = list(pictures.values())

    def distance(chosen: Sequence[int]) -> float | None:
        counts = [len(made[k]) for k in chosen]
        if sum(counts) < _FEWEST:
            return None
        of_frames, of_pictures = (np.concatenate([each[k] for k in chosen]) for each in (made, references))
        return frechet_distance(of_frames.astype(np.float64), of_pictures, counts=counts)

    found = summary_of_whole(range(len(made)), distance)
    return None if found.mean is None else found


def _name_of(picture: NDArray[np.uint8]) -> str:
    """The same for the same picture, whoever has read it."""
    return hashlib.sha256(f"{picture.shape}".encode() + picture.tobytes()).hexdigest()


@lru_cache(maxsize=1)
def _loaded(file: Path, device: str) -> Any:
    from ...metrics.learned.fid import load_inception
    from ...neural.devices import device_of

    return load_inception(file).to(device_of(device))


FID = Column(
    "fid",
    "FID",
    "Frechet inception distance of all frames of a method to the illustrations.",
    better="lower",
    compare=_frechet_inception_distance,
    weights=("inception",),
)
"""The paper measures "the similarity between the generated frames and the reference images", 20 of them. The number is
that of pytorch-fid on a folder of all frames and a folder with the illustration of each frame, so clips that stand
still have 0. So few illustrations make it large and biased: only numbers over the same pictures and as many frames
compare, and none with other papers'. It favours clips that hardly move, as the paper says of Cinemo."""
