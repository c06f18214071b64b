"""The network that VideoScore is: Idefics2 (Laurencon et al., 2024) with grades in place of words.

The transformers library has Idefics2 without them. In VideoScore's own code (Mantis) the class is called
Idefics2ForSequenceClassification; the names of the tensors are the same.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import torch
import transformers
from safetensors import safe_open
from torch import Tensor, nn
from transformers import AutoProcessor, Idefics2Config
from transformers.models.idefics2.modeling_idefics2 import (
    Idefics2Model,
    Idefics2PreTrainedModel,
    Idefics2VisionEmbeddings,
)

from ...networks.checkpoints import CheckpointError, build_without_storage, check_names
from ...networks.documents import read_document
from ...networks.library_bars import without_bars
from .files import VIDEO_SCORE_FOLDER

__all__ = ["Idefics2Grader", "check_folder", "graded", "load_grader"]

_WANTED = f"all files of {VIDEO_SCORE_FOLDER.page}"
_MOST_BYTES = 1 << 20
_DEEPEST, _LARGEST = 200, 1 << 20
_LARGEST_SIDE = 2048
"""Bounds of what a document may ask for: layers, other sizes, and the side of pictures [px]."""


class Idefics2Grader(Idefics2PreTrainedModel):
    """Reads a question with pictures and gives one number for each thing that it has been trained to grade."""

    def __init__(self, config: Idefics2Config) -> None:
        super().__init__(config)
        self.model = Idefics2Model(config)
        self.model.vision_model.embeddings = _PatchEmbeddings(config.vision_config)
        self.score = nn.Linear(config.text_config.hidden_size, config.num_labels)
        self.post_init()

    def forward(self, **inputs: Tensor) -> Tensor:
        """Grades.

        Args:
            inputs: what the processor makes of one question and its pictures.

        Returns:
            Shape [1, grades]: what the last word's place says.
        """
        seen = self.model(**inputs, use_cache=False).last_hidden_state
        return self.score(seen[:, -1])


class _PatchEmbeddings(Idefics2VisionEmbeddings):
    """Patches at the places that the weights were trained with.

    Later versions of the library round them in other ways, 4.56 for most sizes of pictures.
    """

    def forward(self, pixel_values: Tensor, patch_attention_mask: Tensor) -> Tensor:
        patches = self.patch_embedding(pixel_values).flatten(2).transpose(1, 2)
        numbers = torch.stack([self._numbers(seen.cpu()) for seen in patch_attention_mask])
        return patches + self.position_embedding(numbers.to(patches.device))

    def _numbers(self, seen: Tensor) -> Tensor:
        """Which place of the trained square each patch of a picture has, 0 beside the picture, shape [rows * columns].

        Args:
            seen: which patches belong to the picture, shape [rows, columns].
        """
        side = self.num_patches_per_side
        bounds = torch.arange(1 / side, 1.0, 1 / side)
        row, column = (
            torch.bucketize(torch.arange(0, 1 - 1e-6, 1 / int(along.sum())), bounds, right=True)
            for along in (seen[:, 0], seen[0])
        )
        numbers = torch.zeros(seen.numel(), dtype=torch.long)
        numbers[seen.flatten()] = (row[:, None] * side + column).flatten()
        return numbers


def check_folder(folder: Path, grades: int) -> Idefics2Config:
    """Whether a folder holds the network, from its documents and the heads of its files alone.

    Raises:
        CheckpointError: a file is missing, damaged or of another network.
    """
    document = read_document(folder / "config.json", wanted=_WANTED, most=_MOST_BYTES)
    if document.get("model_type") != "idefics2":
        raise CheckpointError(
            f"{folder / 'config.json'} names the model type {document.get('model_type')!r}. Wanted: {_WANTED}"
        )
    _check_sizes(document, folder)
    try:
        config = Idefics2Config.from_dict(document)
        expected = {
            name: tuple(tensor.shape)
            for name, tensor in build_without_storage(lambda: Idefics2Grader(config)).state_dict().items()
        }
    except Exception as error:  # what a document may say wrongly makes the library raise nearly anything
        raise CheckpointError(f"{folder / 'config.json'} describes no Idefics2. Wanted: {_WANTED}") from error
    if config.num_labels != grades:
        raise CheckpointError(f"{folder} gives {config.num_labels} grades instead of {grades}. Wanted: {_WANTED}")
    shapes = _shapes(folder)
    check_names(expected, {name: shapes[name] for name in shapes if name in expected}, file=str(folder), wanted=_WANTED)
    return config


def load_grader(folder: Path, grades: int) -> tuple[Idefics2Grader, Any]:
    """The network on the CPU, in the precision of its files, and its processor.

    Raises:
        CheckpointError: a file is missing, damaged or of another network.
    """
    config = check_folder(folder, grades)
    only = {"local_files_only": True, "trust_remote_code": False}
    try:
        with without_bars(transformers):
            processor = AutoProcessor.from_pretrained(folder, **only)
            sides = [each for each in dict(processor.image_processor.size).values() if each is not None]
            if not all(0 < each <= _LARGEST_SIDE for each in sides):
                raise ValueError
            network = Idefics2Grader.from_pretrained(
                folder, config=config, use_safetensors=True, dtype="auto", local_files_only=True
            )
    except Exception as error:  # damaged files and wrong configurations make the library raise nearly anything
        raise CheckpointError(
            f"{folder} cannot be loaded as VideoScore: a file in it is missing, damaged, not downloaded to its end, or"
            f" made for another version of transformers. Wanted: {_WANTED}"
        ) from error
    return network.eval().requires_grad_(False), processor


@torch.inference_mode()
def graded(network: Idefics2Grader, processor: Any, question: str, pictures: list[Any]) -> list[float]:
    """The grades of pictures, where the network is.

    Args:
        network: of :func:`load_grader`.
        processor: of :func:`load_grader`.
        question: with ``<image>`` for each picture.
        pictures: Pillow's, RGB.
    """
    inputs = processor(text=question, images=pictures, return_tensors="pt")
    return [float(each) for each in network(**{name: each.to(network.device) for name, each in inputs.items()})[0]]


def _check_sizes(document: dict[str, Any], folder: Path) -> None:
    """Refuse a document that would have so large a network built that the computer stands still."""
    for part in (document, *(each for each in document.values() if isinstance(each, dict))):
        for name, value in part.items():
            most = _DEEPEST if "layers" in name or "depth" in name else _LARGEST
            if isinstance(value, int) and value > most:
                raise CheckpointError(f"{folder / 'config.json'} asks for {name} = {value}. Wanted: {_WANTED}")


def _shapes(folder: Path) -> dict[str, tuple[int, ...]]:
    """The shapes of all tensors of a folder by name."""
    shapes: dict[str, tuple[int, ...]] = {}
    for file in sorted(folder.glob("model*.safetensors")):
        try:
            with safe_open(file, framework="pt") as opened:
                shapes |= {name: tuple(opened.get_slice(name).get_shape()) for name in opened.keys()}  # noqa: SIM118
        except Exception as error:  # damaged files make the reader raise nearly anything
            raise CheckpointError(
                f"{file} cannot be read; it is damaged or was not downloaded to its end. Wanted: {_WANTED}"
            ) from error
    if not shapes:
        raise CheckpointError(f"{folder} holds no model.safetensors nor parts of one. Wanted: {_WANTED}")
    return shapes
