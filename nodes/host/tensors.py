"""The host's IMAGE and MASK tensors to our arrays and back: the only place where the two meet."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, require
from ...rendering.pictures import over

if TYPE_CHECKING:
    import torch

__all__ = [
    "FrameBatch",
    "batch_of_masks",
    "batch_of_pictures",
    "mask_batch",
    "mask_of",
    "picture_batch",
    "picture_of",
    "picture_with_alpha",
    "pictures_for",
    "pictures_of",
]

FloatImage = NDArray[np.float32]


def pictures_of(images: torch.Tensor, *, name: str = "image", alpha: bool = False) -> FloatImage:
    """A batch of pictures as an array.

    Args:
        images: the host's IMAGE, 0..1, shape [f, h, w, c] with 3 or 4 channels.
        name: what the node calls the input.
        alpha: keep a fourth channel; without, pictures that have one are laid over white.

    Returns:
        RGB, float32, 0..1, shape [f, h, w, 3], or straight RGBA, [f, h, w, 4]; shares memory with ``images`` where it
        can, so only read it.

    Raises:
        InvalidInputError: the shape is another, or a value is not finite.
    """
    if images.ndim != 4 or images.shape[-1] not in (3, 4) or 0 in images.shape:
        raise InvalidInputError(
            f"{name} must be a batch of RGB pictures of shape [f, h, w, 3]. Got: {tuple(images.shape)}"
        )
    pictures = images.detach().cpu().float().numpy()
    return pictures if alpha or pictures.shape[-1] == 3 else np.stack([over(np.clip(each, 0, 1)) for each in pictures])


def picture_of(images: torch.Tensor, *, name: str = "image") -> FloatImage:
    """A single picture as an array, float32, 0..1, shape [h, w, 3].

    Args:
        images: the host's IMAGE with a batch of one.
        name: what the node calls the input.

    Raises:
        InvalidInputError: the batch holds more than one picture, or the shape is another.
    """
    pictures = pictures_of(images, name=name)
    if len(pictures) != 1:
        raise InvalidInputError(
            f"{name} must be one picture; choose one with the node ImageFromBatch. Got: a batch of {len(pictures)}"
        )
    picture = np.ascontiguousarray(pictures[0])
    if not np.isfinite(picture).all():
        raise InvalidInputError(f"{name} must hold finite colours. Got: NaN or infinity")
    return np.clip(picture, 0.0, 1.0)


def picture_with_alpha(images: torch.Tensor, alpha: torch.Tensor | None = None, *, name: str = "image") -> FloatImage:
    """A single picture that keeps its transparency: float32, 0..1, RGB, shape [h, w, 3], or straight RGBA, [h, w, 4].

    Args:
        images: the host's IMAGE with a batch of one, of 3 or 4 channels.
        alpha: the host's MASK of the same size, white where the picture is transparent, as Load Image gives it; counts
            instead of a fourth channel.
        name: what the node calls the input.

    Returns:
        RGBA only where something is transparent; black where alpha is 0.

    Raises:
        InvalidInputError: the batch holds more than one picture, or shapes or sizes do not fit.
    """
    picture = picture_of(images, name=name)
    if alpha is not None:
        opacity = 1 - mask_of(alpha, name=f"{name}_alpha")
        # Load Image gives a small empty mask with a picture that has no alpha.
        if opacity.shape != picture.shape[:2] and opacity.min() == 1:
            return picture
        got = f"{opacity.shape[1]} x {opacity.shape[0]} px"
        size = f"{picture.shape[1]} x {picture.shape[0]} px"
        require(f"{name}_alpha", got, opacity.shape == picture.shape[:2], f"of the picture's size, {size}")
    elif images.shape[-1] == 4:
        opacity = np.clip(images[0, ..., 3].detach().cpu().float().numpy(), 0.0, 1.0)
    else:
        return picture
    if opacity.min() == 1:
        return picture
    colours = np.clip(images[0, ..., :3].detach().cpu().float().numpy(), 0.0, 1.0)
    return np.dstack([np.where(opacity[..., None] > 0, colours, np.float32(0)), opacity])


def pictures_for(images: torch.Tensor, width: int, height: int, *, frames: int, name: str = "image") -> FloatImage:
    """One picture, or one for each frame, of a motion's size: float32, shape [1 or f, h, w, 3].

    Args:
        images: the host's IMAGE.
        width: of the motion's illustration [px].
        height: of the motion's illustration [px].
        frames: of the motion.
        name: what the node calls the input.

    Raises:
        InvalidInputError: the size or the number of pictures is another.
    """
    pictures = pictures_of(images, name=name)
    got = f"{pictures.shape[2]} x {pictures.shape[1]} px"
    require(name, got, pictures.shape[1:3] == (height, width), f"of the motion's size, {width} x {height} px")
    require(name, f"{len(pictures)}", len(pictures) in (1, frames), f"one picture, or one for each of {frames} frames")
    return pictures


def mask_of(masks: torch.Tensor, *, index: int = 0, name: str = "mask") -> FloatImage:
    """One mask of a batch as an array, float32, 0..1, shape [h, w].

    Args:
        masks: the host's MASK, shape [f, h, w] or [h, w].
        index: which one of the batch.
        name: what the node calls the input; the index is called ``{name}_index``.

    Raises:
        InvalidInputError: there is no such mask in the batch, or the shape is another.
    """
    batch = masks[None] if masks.ndim == 2 else masks
    if batch.ndim == 3 and len(batch) == 0:
        why = "the node that made it, such as SAM3 Detect, has found nothing"
        raise InvalidInputError(f"{name} must hold at least one mask: {why}. Got: an empty batch")
    if batch.ndim != 3 or 0 in batch.shape:
        raise InvalidInputError(f"{name} must be a mask of shape [f, h, w]. Got: {tuple(masks.shape)}")
    if not 0 <= index < len(batch):
        raise InvalidInputError(f"{name}_index must be below the number of masks ({len(batch)}). Got: {index}")
    mask = batch[index].detach().cpu().float().numpy()
    if not np.isfinite(mask).all():
        raise InvalidInputError(f"{name} must hold finite values. Got: NaN or infinity")
    return np.clip(mask, 0.0, 1.0)


class FrameBatch:
    """A batch that is filled one frame at a time, so that a long clip is never held twice.

    Attributes:
        count: how many frames it will hold.
    """

    def __init__(self, count: int, *, channels: int | None) -> None:
        """
        Args:
            count: how many frames there will be.
            channels: 3 for the host's IMAGE, where grey frames are repeated; None for its MASK.
        """
        self.count = count
        self._channels = channels
        self._batch: torch.Tensor | None = None
        self._done = 0

    def put(self, frame: NDArray[Any]) -> None:
        """Add a frame: uint8, bool, or float in 0..1, shape [h, w, 3], [h, w, 4] or [h, w]."""
        import torch

        grey = self._channels is not None and frame.ndim == 2
        if self._batch is None:
            shape = (*frame.shape, self._channels) if grey else frame.shape
            self._batch = torch.empty((self.count, *shape), dtype=torch.float32)
        target = self._batch[self._done].numpy()
        np.copyto(target, frame[..., None] if grey else frame)
        if frame.dtype == np.uint8:
            target /= np.float32(255)
        self._done += 1

    @property
    def tensor(self) -> torch.Tensor:
        """The full batch, float32, shape [f, h, w, 3 or 4] or [f, h, w].

        Raises:
            InvalidInputError: frames are missing.
        """
        if self._batch is None or self._done != self.count:
            raise InvalidInputError(f"{self.count} frames were announced. Got: {self._done}")
        return self._batch


def picture_batch(count: int) -> FrameBatch:
    """An empty batch for the host's IMAGE."""
    return FrameBatch(count, channels=3)


def mask_batch(count: int) -> FrameBatch:
    """An empty batch for the host's MASK."""
    return FrameBatch(count, channels=None)


def batch_of_pictures(frames: Iterable[NDArray[Any]], count: int) -> torch.Tensor:
    """The host's IMAGE, shape [f, h, w, 3 or 4], from RGB, RGBA or grey frames that are made one at a time."""
    return _filled(picture_batch(count), frames)


def batch_of_masks(frames: Iterable[NDArray[Any]], count: int) -> torch.Tensor:
    """The host's MASK, shape [f, h, w], from frames that are made one at a time."""
    return _filled(mask_batch(count), frames)


def _filled(batch: FrameBatch, frames: Iterable[NDArray[Any]]) -> torch.Tensor:
    for frame in frames:
        batch.put(frame)
    return batch.tensor
