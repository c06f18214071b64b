"""What is in a data folder, counted: clips that are kept, and why the others are not."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from .data_folder import ClipRecord, read_index

__all__ = ["DataCount", "newest_records"]


def newest_records(data: Path) -> list[ClipRecord]:
    """Every clip of a data folder once, by the last line about it.

    Raises:
        InvalidInputError: see :func:`~physanimator.rendering.training.data_folder.read_index`.
    """
    return list({record.name: record for record in read_index(data)}.values())


@dataclass
class DataCount:
    """Counts of clips.

    Attributes:
        kept: clips that are trained on.
        frames: frames of those.
        seconds: how long those last in the videos [s].
        dropped: the other clips, by why they are left out.
        licences: kept clips by licence.
    """

    kept: int = 0
    frames: int = 0
    seconds: float = 0.0
    dropped: Counter[str] = field(default_factory=Counter)
    licences: Counter[str] = field(default_factory=Counter)

    def add(self, records: Iterable[ClipRecord]) -> None:
        """Count more clips."""
        for each in records:
            if each.kept:
                self.kept += 1
                self.frames += each.frames
                self.seconds += each.end - each.start
                self.licences[each.licence or "not said"] += 1
            else:
                self.dropped[each.why.partition(":")[0]] += 1

    def sentences(self) -> Sequence[str]:
        """One line for what is kept, and one for each reason why clips are not."""
        lines = [f"kept: {self.kept} clips, {self.frames} frames, {self.seconds:.0f} s of video"]
        if len(self.licences) > 1 or "not said" not in self.licences:
            lines += [f"  licence {name}: {count}" for name, count in self.licences.most_common()]
        lines.append(f"dropped: {sum(self.dropped.values())} clips")
        return lines + [f"  {why}: {count}" for why, count in self.dropped.most_common()]
