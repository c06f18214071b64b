"""Which files hold the public line drawing networks, and where to get them."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["DRAWING_FILES", "WANTED", "DrawingFile"]


@dataclass(frozen=True)
class DrawingFile:
    """A public file of weights.

    Attributes:
        name: of the file.
        draws: what its lines look like.
        page: where to get it.
        licence: what is known of it.
    """

    name: str
    draws: str
    page: str
    licence: str


_ANNOTATORS = "https://huggingface.co/lllyasviel/Annotators"
_INFORMATIVE = "see there; informative-drawings itself is under the MIT licence"
_ANIME = "see there; Anime2Sketch itself is under the MIT licence"

DRAWING_FILES = (
    DrawingFile("sk_model.pth", "fine lines", _ANNOTATORS, _INFORMATIVE),
    DrawingFile("sk_model2.pth", "coarse lines", _ANNOTATORS, _INFORMATIVE),
    DrawingFile("netG.pth", "lines of anime", _ANNOTATORS, _ANIME),
)
"""The usual one first."""

WANTED = f"{', '.join(file.name for file in DRAWING_FILES[:-1])} or {DRAWING_FILES[-1].name} from {_ANNOTATORS}"
"""For messages."""
