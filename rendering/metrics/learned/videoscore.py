"""VideoScore (He et al., EMNLP 2024): a vision-language model that grades clips, from a local folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....physics.errors import InvalidInputError, require
from ...files import check_regular
from ...pictures import as_uint8
from .files import VIDEO_SCORE_FOLDER, require_file

__all__ = ["DIMENSIONS", "PROMPT_FILE", "video_score"]

DIMENSIONS = (
    "visual_quality",
    "temporal_consistency",
    "dynamic_degree",
    "text_to_video_alignment",
    "factual_consistency",
)
"""What is graded, from 1 to 4, in the order of the model's answers."""

PROMPT_FILE = "prompt.txt"
"""In the model's folder: the question that it was trained with, with {text_prompt} where the description goes."""

_MOST_FRAMES = 16
"""What VideoScore is used with."""


def video_score(frames: Sequence[NDArray[Any]], description: str, folder: Path) -> dict[str, float]:
    """Grades of a clip by what they are of.

    Args:
        frames: RGB, uint8 or float in 0..1, shape [h, w, 3]; 16 of them, evenly spread, are looked at.
        description: what the clip shows, in words.
        folder: the model's files, and the question in ``prompt.txt``.

    Raises:
        InvalidInputError: the folder, the question, or the package that the model needs is missing.
    """
    from PIL import Image

    require("frames", len(frames), len(frames) > 0, "at least 1")
    require_file(folder, VIDEO_SCORE_FOLDER)
    question = _question(folder).replace("{text_prompt}", description)
    chosen = np.unique(np.linspace(0, len(frames) - 1, _MOST_FRAMES).round().astype(int))
    pictures = [Image.fromarray(as_uint8(frames[k])) for k in chosen]
    question += " <image>" * max(0, len(pictures) - question.count("<image>"))
    model, processor = _loaded(folder)
    inputs = processor(text=question, images=pictures, return_tensors="pt")
    grades = model(**{name: each.to(model.device) for name, each in inputs.items()}).logits[0]
    return {name: round(float(grade), 3) for name, grade in zip(DIMENSIONS, grades, strict=True)}


def _question(folder: Path) -> str:
    check_regular(folder / PROMPT_FILE, PROMPT_FILE)
    try:
        return (folder / PROMPT_FILE).read_text(encoding="utf-8").strip()
    except FileNotFoundError:
        raise InvalidInputError(
            f"{folder / PROMPT_FILE} is missing. Wanted: the question that stands on {VIDEO_SCORE_FOLDER.page}, with"
            " {text_prompt} where the description goes"
        ) from None


def _loaded(folder: Path) -> tuple[Any, Any]:
    try:
        from mantis.models.idefics2 import Idefics2ForSequenceClassification
        from transformers import AutoProcessor
    except ImportError as error:
        raise InvalidInputError(
            "VideoScore needs the packages mantis-vl (https://github.com/TIGER-AI-Lab/Mantis) and transformers."
            f" Got: {error}"
        ) from error
    try:
        processor = AutoProcessor.from_pretrained(folder, local_files_only=True)
        model = Idefics2ForSequenceClassification.from_pretrained(folder, local_files_only=True, torch_dtype="auto")
    except Exception as error:  # damaged files and wrong configurations make the library raise nearly anything
        raise InvalidInputError(
            f"{folder} cannot be loaded as VideoScore: a file in it is missing, damaged, not downloaded to its end, or"
            f" made for another version of transformers. Wanted: all files of {VIDEO_SCORE_FOLDER.page}"
        ) from error
    return model.eval().requires_grad_(False), processor
