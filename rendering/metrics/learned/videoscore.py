"""VideoScore (He et al., EMNLP 2024): a vision-language model that grades clips, from a local folder.

Question, order of the grades and choice of frames are those of its code, github.com/TIGER-AI-Lab/VideoScore (MIT).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....physics.errors import InvalidInputError, require
from ...files import check_regular
from ...pictures import as_picture, as_uint8
from .files import VIDEO_SCORE_FOLDER, require_file

__all__ = ["DIMENSIONS", "PROMPT_FILE", "VideoScore", "check_video_score", "frames_looked_at", "video_score"]

DIMENSIONS = (
    "visual_quality",
    "temporal_consistency",
    "dynamic_degree",
    "text_to_video_alignment",
    "factual_consistency",
)
"""What is graded, from 1 to 4, in the order of the model's answers."""

PROMPT_FILE = "prompt.txt"
"""In the model's folder, if another question is to be asked: {text_prompt} stands where the description goes."""

_MOST_FRAMES = 16
_RATE = 8.0
"""What VideoScore was trained with: frames, and frames a second."""

_IMAGE = "<image>"

_QUESTION = "\n".join(
    (
        "",
        "Suppose you are an expert in judging and evaluating the quality of AI-generated videos,",
        "please watch the following frames of a given video and see the text prompt for generating the video,",
        "then give scores from 5 different dimensions:",
        "(1) visual quality: the quality of the video in terms of clearness, resolution, brightness, and color",
        "(2) temporal consistency, both the consistency of objects or humans and the smoothness of motion or movements",
        "(3) dynamic degree, the degree of dynamic changes",
        "(4) text-to-video alignment, the alignment between the text prompt and the video content",
        "(5) factual consistency, the consistency of the video content with the common-sense and factual knowledge",
        "",
        "for each dimension, output a float number from 1.0 to 4.0,",
        "the higher the number is, the better the video performs in that sub-score, ",
        "the lowest 1.0 means Bad, the highest 4.0 means Perfect/Real (the video is like a real video)",
        "Here is an output example:",
        "visual quality: 3.2",
        "temporal consistency: 2.7",
        "dynamic degree: 4.0",
        "text-to-video alignment: 2.3",
        "factual consistency: 1.8",
        "",
        'For this video, the text prompt is "{text_prompt}",',
        "all the frames of video are as follows:",
        "",
    )
)


def frames_looked_at(count: int, rate: float | None = None) -> list[int]:
    """Numbers of the frames of a clip that are looked at: 8 a second, 16 at most, evenly spread.

    Args:
        count: frames of the clip.
        rate: frames a second; without, or where it is lower than 8, every frame counts.

    Examples:
        >>> from physanimator.rendering.metrics.learned.videoscore import frames_looked_at
        >>> frames_looked_at(12, 24.0), len(frames_looked_at(96, 24.0))
        ([0, 3, 6, 9], 16)
    """
    step = 1.0 if rate is None else max(1.0, rate / _RATE)
    chosen = np.arange(0, count, step).astype(int)
    if len(chosen) > _MOST_FRAMES:
        chosen = chosen[np.arange(0, len(chosen), len(chosen) / _MOST_FRAMES).astype(int)]
    return [int(each) for each in chosen]


@dataclass(frozen=True)
class VideoScore:
    """The model, loaded.

    Attributes:
        network: where it computes.
        processor: of questions and pictures.
        question: with {text_prompt} where the description goes.
    """

    network: Any
    processor: Any
    question: str

    @classmethod
    def load(cls, folder: Path, device: Any = "cpu") -> VideoScore:
        """From a folder.

        Raises:
            InvalidInputError: the folder, a file of it or the package transformers is missing or cannot be used.
        """
        require_file(folder, VIDEO_SCORE_FOLDER)
        question = _question(folder)
        network, processor = _grader().load_grader(folder, len(DIMENSIONS))
        return cls(network.to(device), processor, question)

    def grades(self, pictures: Sequence[NDArray[Any]], description: str) -> dict[str, float]:
        """Grades of frames by what they are of.

        Args:
            pictures: of :func:`frames_looked_at`, RGB, uint8 or float in 0..1, shape [h, w, 3].
            description: what the clip shows, in words.
        """
        from PIL import Image

        images = [Image.fromarray(as_uint8(as_picture(each, name="frames"))) for each in pictures]
        question = self.question.replace("{text_prompt}", description.replace(_IMAGE, ""))
        question += f"{_IMAGE} " * max(0, len(images) - question.count(_IMAGE))
        found = _grader().graded(self.network, self.processor, question, images)
        return {name: round(grade, 3) for name, grade in zip(DIMENSIONS, found, strict=True)}


def video_score(frames: Sequence[NDArray[Any]], description: str, folder: Path) -> dict[str, float]:
    """Grades of a clip by what they are of.

    Args:
        frames: RGB, uint8 or float in 0..1, shape [h, w, 3]; 16 of them, evenly spread, are looked at.
        description: what the clip shows, in words.
        folder: the model's files.

    Raises:
        InvalidInputError: the folder, a file of it or the package that the model needs is missing.
    """
    require("frames", len(frames), len(frames) > 0, "at least 1")
    model = VideoScore.load(folder)
    return model.grades([frames[k] for k in frames_looked_at(len(frames))], description)


def check_video_score(folder: Path) -> None:
    """Raise unless a folder holds the model; its weights are not read.

    Raises:
        InvalidInputError: a file is missing, damaged or of another model, or the package transformers is missing.
    """
    require_file(folder, VIDEO_SCORE_FOLDER)
    _question(folder)
    _grader().check_folder(folder, len(DIMENSIONS))


def _question(folder: Path) -> str:
    file = folder / PROMPT_FILE
    if not file.exists():
        return _QUESTION
    check_regular(file, PROMPT_FILE)
    try:
        return file.read_text(encoding="utf-8").strip() + " "
    except (OSError, ValueError) as error:
        raise InvalidInputError(f"{file} must be text in UTF-8. Got: {error}") from error


def _grader() -> Any:
    try:
        from . import idefics2_grader
    except ImportError as error:
        raise InvalidInputError(
            f"VideoScore needs the package transformers: pip install 'transformers>=4.56'. Got: {error}"
        ) from error
    return idefics2_grader
