"""Which files the learned measures need, and what to say where they are missing."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ....physics.errors import InvalidInputError

__all__ = ["FID_FILE", "LPIPS_FOLDER", "VIDEO_SCORE_FOLDER", "MetricFile", "require_file"]


@dataclass(frozen=True)
class MetricFile:
    """A public file or folder of weights.

    Attributes:
        name: usual name.
        page: where to get it.
        licence: of it.
        is_folder: whether it is a folder.
    """

    name: str
    page: str
    licence: str
    is_folder: bool = False

    def missing(self, place: object) -> str:
        """The sentence for a place where it is not."""
        kind = "folder" if self.is_folder else "file"
        return f"{place} is missing. Wanted: the {kind} {self.name} from {self.page} (licence: {self.licence})"


FID_FILE = MetricFile(
    "pt_inception-2015-12-05-6726825d.pth",
    "https://github.com/mseitzer/pytorch-fid/releases/tag/fid_weights",
    "Apache-2.0",
)

LPIPS_FOLDER = MetricFile(
    "lpips",
    "https://github.com/richzhang/PerceptualSimilarity (lpips/weights/v0.1/alex.pth or vgg.pth) with"
    " https://download.pytorch.org/models/alexnet-owt-7be5be79.pth or vgg16-397923af.pth beside it",
    "BSD-2-Clause, backbones BSD-3-Clause",
    is_folder=True,
)

VIDEO_SCORE_FOLDER = MetricFile("VideoScore", "https://huggingface.co/TIGER-Lab/VideoScore", "MIT", is_folder=True)


def require_file(path: Path, wanted: MetricFile) -> None:
    """Raise unless it is there.

    Raises:
        InvalidInputError: it is not; the message says what is wanted and where to get it.
    """
    if not (path.is_dir() if wanted.is_folder else path.is_file()):
        raise InvalidInputError(wanted.missing(path))
