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
        licence: of the weights, or of the work that they come from.
    """

    name: str
    draws: str
    page: str
    licence: str


_ANNOTATORS = "https://huggingface.co/lllyasviel/Annotators"
_INFORMATIVE = "https://github.com/carolineec/informative-drawings (its licence: MIT)"
_ANIME = "https://github.com/Mukosame/Anime2Sketch (its licence: MIT)"

DRAWING_FILES = (
    DrawingFile("sk_model.pth", "fine lines", _ANNOTATORS, f"after {_INFORMATIVE}"),
    DrawingFile("sk_model2.pth", "coarse lines", _ANNOTATORS, f"after {_INFORMATIVE}"),
    DrawingFile("netG.pth", "lines of anime", _ANNOTATORS, f"after {_ANIME}"),
)
"""The usual one first."""

WANTED = f"{', '.join(file.name for file in DRAWING_FILES[:-1])} or {DRAWING_FILES[-1].name} from {_ANNOTATORS}"
"""For messages."""
