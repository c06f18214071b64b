"""What raters are asked about a pair of clips."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ....physics.errors import InvalidInputError, printable
from .words import WORDS

__all__ = ["QUESTIONS", "Question", "questions_of"]

QUESTIONS = ("vq", "tc", "mp", "overall", "anime")
"""Visual quality, temporal consistency, motion plausibility and overall feeling, as the paper's user study asks, and
"Which video resembles real anime more?", as its ablation of the dynamics enhancement does."""

_LONGEST = 300


@dataclass(frozen=True)
class Question:
    """One question about each pair.

    Attributes:
        key: what it is called in answers and results.
        text: what raters read.
    """

    key: str
    text: str


def questions_of(keys: str | Sequence[str], more: Sequence[str] = (), *, language: str = "en") -> tuple[Question, ...]:
    """Questions by their keys, and more in one's own words.

    Args:
        keys: some of ``QUESTIONS``, in a list or separated by commas.
        more: texts of one's own; they get the keys own1, own2 ...
        language: one of ``WORDS``.

    Raises:
        InvalidInputError: there is none, one is not known or given twice, or a text is empty or too long.

    Examples:
        >>> from physanimator.rendering.evaluation.study import questions_of
        >>> [each.key for each in questions_of("tc,overall", ["Which one moves like cloth?"])]
        ['tc', 'overall', 'own1']
    """
    chosen = [key.strip() for key in (keys.split(",") if isinstance(keys, str) else keys) if key.strip()]
    for key in chosen:
        if key not in QUESTIONS:
            raise InvalidInputError(f"questions must be some of {', '.join(QUESTIONS)}. Got: {printable(key)}")
        if chosen.count(key) > 1:
            raise InvalidInputError(f"questions must be given once each. Got: {key} twice")
    for text in more:
        if not 1 <= len(text.strip()) <= _LONGEST:
            raise InvalidInputError(f"question must be a text of 1 to {_LONGEST} characters. Got: {len(text)}")
    if not chosen and not more:
        raise InvalidInputError("questions must be at least one. Got: none")
    own = [Question(f"own{k}", text.strip()) for k, text in enumerate(more, 1)]
    return (*(Question(key, WORDS[language][key]) for key in chosen), *own)
