"""Where the weights are that some columns need; only files of this machine are ever read."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ....physics.errors import InvalidInputError, require
from ...metrics.learned import (
    FID_FILE,
    LPIPS_FOLDER,
    VIDEO_SCORE_FOLDER,
    MetricFile,
    check_video_score,
    require_file,
)

__all__ = ["NO_WEIGHTS", "WANTED", "ColumnWeights"]

WANTED: Mapping[str, MetricFile] = {
    "inception": FID_FILE,
    "video_score": VIDEO_SCORE_FOLDER,
    "lpips": LPIPS_FOLDER,
}
"""By key, what the columns need."""


@dataclass(frozen=True)
class ColumnWeights:
    """Where weights are, and where their networks compute.

    Attributes:
        inception: file of Inception's weights, for FID.
        video_score: folder of VideoScore.
        lpips: folder with the backbone and the linear layers of LPIPS.
        device: auto, cpu, cuda, cuda:1, mps.
    """

    inception: Path | None = None
    video_score: Path | None = None
    lpips: Path | None = None
    device: str = "auto"

    @classmethod
    def of(cls, table: Mapping[str, Any], folder: Path, *, device: str = "auto") -> ColumnWeights:
        """From a table of names, as a set's ``[weights]`` is; other names in it belong to others.

        Args:
            table: places by key.
            folder: where relative places begin.
            device: where networks compute.

        Raises:
            InvalidInputError: a place is no text.
        """
        places = {key: table[key] for key in WANTED if table.get(key) not in (None, "")}
        for key, place in places.items():
            require(f"weights.{key}", place, isinstance(place, str | Path), "the path of a file or folder")
        return cls(**{key: folder / Path(place).expanduser() for key, place in places.items()}, device=device)

    def place(self, key: str) -> Path | None:
        """Where the weights of a key are; None where nobody has said."""
        return {"inception": self.inception, "video_score": self.video_score, "lpips": self.lpips}[key]

    def check(self) -> None:
        """Open all that is named, before any work.

        Raises:
            InvalidInputError: something named is missing, damaged or other than what the column needs; the message
                says what is wanted and where to get it.
        """
        if any(self.place(key) is not None for key in WANTED):
            from ...neural.devices import device_of

            device_of(self.device)
        for key, place in self._named():
            require_file(place, WANTED[key])
        if self.inception is not None:
            from ...metrics.learned.fid import load_inception

            load_inception(self.inception)
        if self.lpips is not None:
            from ...metrics.learned.lpips import load_lpips

            load_lpips(self.lpips)
        if self.video_score is not None:
            check_video_score(self.video_score)

    def hashes(self) -> dict[str, str]:
        """SHA-256 of all that is named, by key; of a folder, of its files' names and contents in their order."""
        return {key: _digest(place) for key, place in self._named()}

    def _named(self) -> Iterator[tuple[str, Path]]:
        for key in WANTED:
            place = self.place(key)
            if place is not None:
                yield key, place


NO_WEIGHTS = ColumnWeights()
"""Only columns that need none have values."""


def _digest(place: Path) -> str:
    digest = hashlib.sha256()
    files = [place] if place.is_file() else sorted(each for each in place.iterdir() if each.is_file())
    try:
        for file in files:
            if file != place:
                digest.update(file.name.encode() + b"\0")
            with file.open("rb") as opened:
                while block := opened.read(1 << 20):
                    digest.update(block)
    except OSError as error:
        raise InvalidInputError(f"{place} cannot be read: {error.strerror}") from error
    return digest.hexdigest()
