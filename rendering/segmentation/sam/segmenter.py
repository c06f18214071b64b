"""Asking a Segment Anything network: points and a box in, one mask for each object out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from ....physics.errors import require
from .. import Prompt, checked_box, checked_points, require_object
from .families import Family
from .pictures import Square
from .weights import load_network

__all__ = ["SamSegmenter"]

Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class SamSegmenter:
    """A network with its way of seeing pictures.

    Attributes:
        network: one of the mask generation models of transformers.
        family: which one.
        device: where it computes.
    """

    network: nn.Module
    family: Family
    device: torch.device

    @staticmethod
    def load(path: Path, *, device: torch.device | str = "cpu", dtype: torch.dtype = torch.float32) -> SamSegmenter:
        """The network of a folder or file on a device; see ``load_network``."""
        network, family = load_network(path, dtype=dtype)
        return SamSegmenter(network.to(device), family, torch.device(device))

    def segment(self, image: NDArray[np.uint8], prompts: Sequence[Prompt]) -> tuple[list[Mask], list[float]]:
        """One mask for each object: of the network's answers the one that it holds for the best.

        Args:
            image: RGB, shape [h, w, 3].
            prompts: one for each object.

        Returns:
            masks, shape [h, w] each, and the intersection over union that the network expects of each.

        Raises:
            InvalidInputError: a prompt is empty or lies outside the picture.
        """
        shape_ok = image.ndim == 3 and image.shape[2] == 3 and image.size > 0 and image.dtype == np.uint8
        require("image", f"{image.dtype} of shape {image.shape}", shape_ok, "an RGB picture, uint8, shape [h, w, 3]")
        square = self._square(image.shape[1], image.shape[0])
        asked = [self._asked(prompt, square) for prompt in prompts]
        masks, scores = [], []
        with torch.inference_mode():
            seen = self._seen(square.pixels(image, self.family))
            for inputs in asked:
                answer = self.network(**seen, **inputs, multimask_output=True)
                expected = answer.iou_scores[0, 0].float()
                best = int(expected.argmax())
                masks.append(square.logits(answer.pred_masks[0, 0, best : best + 1])[0] > 0)
                scores.append(float(expected[best]))
        return masks, scores

    def _square(self, width: int, height: int) -> Square:
        config: Any = self.network.config
        return Square(width, height, int(config.prompt_encoder_config.image_size), self.family.stretched)

    def _seen(self, pixels: Tensor) -> dict[str, Any]:
        """What the network sees in the picture, once for all objects."""
        network: Any = self.network
        seen = network.get_image_embeddings(pixels.to(self.device, next(network.parameters()).dtype))
        if isinstance(seen, tuple):
            return {"image_embeddings": seen[0], "intermediate_embeddings": seen[1]}
        return {"image_embeddings": seen}

    def _asked(self, prompt: Prompt, square: Square) -> dict[str, Tensor]:
        """One object's prompt as the network takes it. Each object is asked alone: filling up a batch with points that
        count for nothing would change the answers a little."""
        points, positive = checked_points(prompt.points, prompt.labels, square.width, square.height)
        require_object(positive, prompt.box)
        inputs: dict[str, Tensor] = {}
        dtype = next(self.network.parameters()).dtype
        if len(points):
            inputs["input_points"] = square.coordinates(points)[None, None].to(self.device, dtype)
            inputs["input_labels"] = torch.from_numpy(positive.astype(np.int64))[None, None].to(self.device)
        if prompt.box is not None:
            corners = np.reshape(checked_box(prompt.box, square.width, square.height), (2, 2))
            inputs["input_boxes"] = square.coordinates(corners).reshape(1, 1, 4).to(self.device, dtype)
        return inputs
