"""Frechet inception distance (Heusel et al., NeurIPS 2017) between two sets of pictures."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from ....physics.errors import require
from ...networks.checkpoints import read_checkpoint
from ...pictures import as_float, as_picture
from .files import FID_FILE, require_file
from .inception import FEATURES, InceptionFeatures

__all__ = ["features_of", "frechet_distance", "frechet_inception_distance", "load_inception"]

Features = NDArray[np.float64]


def frechet_inception_distance(
    pictures: Iterable[NDArray[Any]], references: Iterable[NDArray[Any]], weights: Path
) -> float:
    """How far apart two sets of pictures are, as Inception v3 sees them; 0 for the same set.

    Few pictures give a large and uncertain distance: compare only numbers of sets of the same size.

    Args:
        pictures: at least 2, RGB, uint8 or float32 in 0..1, shape [h, w, 3].
        references: at least 2.
        weights: file of Inception's weights.

    Raises:
        InvalidInputError: the file is missing or another one, or there are too few pictures.
    """
    network = load_inception(weights)
    samples = {name: features_of(network, each) for name, each in (("frames", pictures), ("references", references))}
    for name, sample in samples.items():
        require(name, len(sample), len(sample) >= 2, "at least 2 pictures")
    return frechet_distance(samples["frames"], samples["references"])


def load_inception(weights: Path) -> InceptionFeatures:
    """The network of a file of weights, on the CPU.

    Raises:
        InvalidInputError: the file is missing, damaged or another one.
    """
    require_file(weights, FID_FILE)
    tensors = read_checkpoint(weights, wanted=f"{FID_FILE.name} from {FID_FILE.page}")
    return InceptionFeatures.from_reference(tensors, file=str(weights))


@torch.inference_mode()
def features_of(network: InceptionFeatures, pictures: Iterable[NDArray[Any]]) -> Features:
    """What the network sees in pictures, one after the other, where it is.

    Args:
        network: of :func:`load_inception`.
        pictures: RGB, uint8 or float32 in 0..1, shape [h, w, 3], of any size.

    Returns:
        Shape [n, 2048].
    """
    device = next(network.parameters()).device
    found = []
    for picture in pictures:
        pixels = torch.from_numpy(as_float(as_picture(picture, name="frames"))).to(device)
        found.append(network(pixels.permute(2, 0, 1)[None])[0].double().cpu().numpy())
    return np.stack(found) if found else np.zeros((0, FEATURES))


def frechet_distance(first: Features, second: Features, *, counts: Sequence[int] | None = None) -> float:
    """|m1 - m2|^2 + tr(C1 + C2 - 2 (C1 C2)^(1/2)) of two samples' means and covariances.

    It is the number that pytorch-fid computes by the square root of a matrix, which is inexact where there are fewer
    pictures than features; here it is exact.

    Args:
        first, second: features of pictures, shape [n, k] and [m, k].
        counts: how often each of the second sample counts, m whole numbers; once without.
    """
    (mean, root), (other_mean, other_root) = _moments(first), _moments(second, counts)
    away = mean - other_mean
    traces = float(sum((each * each).sum() for each in (root, other_root)))
    if min(len(root), len(other_root)) > root.shape[1]:
        root, other_root = (np.asarray(np.linalg.qr(each, mode="r")) for each in (root, other_root))
    # The trace of (C1 C2)^(1/2) is the sum of the singular values of A B^T, with C1 = A^T A and C2 = B^T B.
    shared = np.linalg.svd(root @ other_root.T, compute_uv=False).sum()
    return float(max(0.0, away @ away + traces - 2 * shared))


def _moments(sample: Features, counts: Sequence[int] | None = None) -> tuple[Features, Features]:
    """A sample's mean, and A with A^T A its covariance, shape [n, k]."""
    often = np.ones(len(sample)) if counts is None else np.asarray(counts, dtype=np.float64)
    mean = often @ sample / often.sum()
    return mean, (sample - mean) * np.sqrt(often / (often.sum() - 1))[:, None]
