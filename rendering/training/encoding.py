"""Latents and embeddings of clips, computed once by the frozen networks and kept beside the clips."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from safetensors import SafetensorError, safe_open
from safetensors.torch import save_file
from torch import Tensor

from ...physics.progress import Progress
from ..files import replacing
from ..networks.image_encoder import ImageEncoder, encoder_picture
from ..pictures import read_clip
from .data_folder import clip_file, encoded_file, hash_of, kept_clips

__all__ = ["encode_for_svd", "encode_for_tooncrafter", "shared_file"]

_TOGETHER = 8
FIRST_FRAMES = 4
"""Frames of a clip, evenly spread, that a clip of ToonCrafter may begin with; each takes 257 tokens of the picture."""


def shared_file(data: Path) -> Path:
    """What all clips share for ToonCrafter: the empty prompt, and the tokens of a grey picture."""
    return data / "encoded" / "tooncrafter.safetensors"


def encode_for_svd(
    data: Path, svd: Path, *, device: torch.device | None = None, progress: Progress | None = None
) -> int:
    """Encode all kept clips for the video model's training; those that are encoded already stay.

    Writes ``latents``, the autoencoder's own, float16, shape [f, 4, h, w], and ``embeddings`` of every frame, [f, c].

    Args:
        data: the data folder.
        svd: Stable Video Diffusion's file or folder.
        device: where to compute; the CPU by default.
        progress: called after each clip; may raise to stop.

    Returns:
        How many clips were encoded now.

    Raises:
        InvalidInputError: the data or the file is unusable.
    """
    from ..networks.checkpoints import network_of
    from ..svd.autoencoder import build_autoencoder
    from ..svd.svd_weights import WANTED_SVD, read_svd

    weights = read_svd(svd)
    where = device or torch.device("cpu")
    full, file = torch.float32, str(svd)
    autoencoder = network_of(
        lambda: build_autoencoder(weights.sizes.autoencoder),
        weights.autoencoder,
        dtype=full,
        file=file,
        wanted=WANTED_SVD,
    )
    encoder = network_of(
        lambda: ImageEncoder(weights.sizes.image_encoder),
        weights.image_encoder,
        dtype=full,
        file=file,
        wanted=WANTED_SVD,
    )
    autoencoder, encoder = autoencoder.to(where), encoder.to(where)

    def encoded(pictures: Tensor, _: Sequence[int]) -> dict[str, Tensor]:
        latents = autoencoder.encode(pictures).latent_dist.mode()
        return {"latents": latents, "embeddings": encoder(encoder_picture(pictures, encoder.config.picture))}

    return _encode_all(data, "svd", _identity(svd), encoded, where, progress)


def encode_for_tooncrafter(
    data: Path,
    model: Path,
    *,
    image_encoder: Path | None = None,
    text_encoder: Path | None = None,
    device: torch.device | None = None,
    progress: Progress | None = None,
) -> int:
    """Encode all kept clips for the interpolation's training; those that are encoded already stay.

    Writes scaled ``latents``, float16, shape [f, 4, h, w], and ``tokens`` of the frames ``firsts``, [k, n, c]; for all
    clips together the empty prompt and a grey picture's tokens.

    Args:
        data: the data folder.
        model: ToonCrafter's file.
        image_encoder, text_encoder: where the model's file holds none.
        device: where to compute; the CPU by default.
        progress: called after each clip; may raise to stop.

    Returns:
        How many clips were encoded now.

    Raises:
        InvalidInputError: the data or a file is unusable.
    """
    from ..tooncrafter.conditioning import LATENT_SCALE, empty_prompt_of, look_at
    from ..tooncrafter.models import load_models

    models = load_models(model, image_encoder=image_encoder, text_encoder=text_encoder)
    where = device or torch.device("cpu")
    models.autoencoder.to(where)
    if models.image_encoder is not None:
        models.image_encoder.to(where)

    def encoded(pictures: Tensor, firsts: Sequence[int]) -> dict[str, Tensor]:
        moments, _ = models.autoencoder.encode(pictures, together=1)
        found = {"latents": LATENT_SCALE * moments.chunk(2, dim=1)[0]}
        if firsts:
            found["tokens"] = look_at(models, [pictures[first] for first in firsts]).picture
        return found

    with torch.no_grad():
        grey = torch.zeros((3, 64, 64), device=where)
        shared = {"nothing": look_at(models, [grey]).nothing, "prompt": empty_prompt_of(models)}
    _keep(shared_file(data), shared, {"model": _identity(model)})
    return _encode_all(data, "tooncrafter", _identity(model), encoded, where, progress)


@torch.no_grad()
def _encode_all(
    data: Path,
    kind: str,
    model: str,
    encoded: Callable[[Tensor, Sequence[int]], dict[str, Tensor]],
    device: torch.device,
    progress: Progress | None,
) -> int:
    clips, made = kept_clips(data), 0
    for number, clip in enumerate(clips, start=1):
        told = {"clip": hash_of(clip_file(data, clip.name)), "model": model}
        place = encoded_file(data, kind, clip.name)
        if not _is_there(place, told):
            firsts = _first_frames(clip.frames) if kind == "tooncrafter" else ()
            tensors = _of_clip(data, clip.name, encoded, firsts, device)
            _keep(place, tensors, told)
            made += 1
        if progress is not None:
            progress(number, len(clips))
    return made


def _of_clip(
    data: Path,
    name: str,
    encoded: Callable[[Tensor, Sequence[int]], dict[str, Tensor]],
    firsts: Sequence[int],
    device: torch.device,
) -> dict[str, Tensor]:
    parts: list[dict[str, Tensor]] = []
    start = 0
    for pictures in _chunks(read_clip(clip_file(data, name))):
        batch = torch.from_numpy(np.stack(pictures)).permute(0, 3, 1, 2).contiguous().to(device).float() / 127.5 - 1
        here = [first - start for first in firsts if start <= first < start + len(batch)]
        parts.append({each: tensor.half().cpu() for each, tensor in encoded(batch, here).items()})
        start += len(batch)
    names = sorted({name for part in parts for name in part})
    tensors = {name: torch.cat([part[name] for part in parts if name in part]) for name in names}
    return tensors | ({"firsts": torch.tensor(firsts)} if firsts else {})


def _chunks(frames: Iterator[NDArray[np.uint8]]) -> Iterator[list[NDArray[np.uint8]]]:
    waiting: list[NDArray[np.uint8]] = []
    for frame in frames:
        waiting.append(frame)
        if len(waiting) == _TOGETHER:
            yield waiting
            waiting = []
    if waiting:
        yield waiting


def _first_frames(frames: int, window: int = 16) -> tuple[int, ...]:
    """Evenly spread from the first frame to the last that a whole window follows."""
    last = max(frames - window, 0)
    return tuple(sorted({round(last * each / max(FIRST_FRAMES - 1, 1)) for each in range(FIRST_FRAMES)}))


def _keep(place: Path, tensors: dict[str, Tensor], told: dict[str, str]) -> None:
    place.parent.mkdir(parents=True, exist_ok=True)
    with replacing(place) as temporary:
        save_file({name: tensor.contiguous() for name, tensor in tensors.items()}, temporary, metadata=told)


def _is_there(place: Path, told: dict[str, str]) -> bool:
    try:
        with safe_open(place, framework="pt") as opened:
            return (opened.metadata() or {}) == told
    except (SafetensorError, OSError):
        return False


def _identity(model: Path) -> str:
    """What tells one model from another: the SHA-256 of its file, or of each file of its folder."""
    if not model.is_dir():
        return hash_of(model) if model.is_file() else ""
    files = sorted(each for each in model.rglob("*") if each.is_file())
    return ";".join(f"{each.relative_to(model).as_posix()}:{hash_of(each)}" for each in files)
