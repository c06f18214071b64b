"""Frechet inception distance (Heusel et al., NeurIPS 2017) between two sets of pictures."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from ....physics.errors import require
from ...networks.checkpoints import read_checkpoint
from ...pictures import as_float, check_picture
from .files import FID_FILE, require_file
from .inception import InceptionFeatures

__all__ = ["frechet_distance", "frechet_inception_distance"]

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
    require_file(weights, FID_FILE)
    tensors = read_checkpoint(weights, wanted=f"{FID_FILE.name} from {FID_FILE.page}")
    network = InceptionFeatures.from_reference(tensors, file=str(weights))
    return frechet_distance(_features(network, pictures, "frames"), _features(network, references, "references"))


def frechet_distance(first: Features, second: Features) -> float:
    """|m1 - m2|^2 + tr(C1 + C2 - 2 (C1 C2)^(1/2)) of two samples' means and covariances, shape [n, k] each."""
    away = first.mean(axis=0) - second.mean(axis=0)
    roots = [_root_of_covariance(each) for each in (first, second)]
    # The trace of (C1 C2)^(1/2) is the sum of the singular values of A B^T, with C1 = A^T A and C2 = B^T B.
    shared = np.linalg.svd(roots[0] @ roots[1].T, compute_uv=False).sum()
    return float(max(0.0, away @ away + sum((root * root).sum() for root in roots) - 2 * shared))


def _root_of_covariance(sample: Features) -> Features:
    """A with A^T A the sample's covariance, shape [n, k]."""
    return (sample - sample.mean(axis=0)) / np.sqrt(len(sample) - 1)


@torch.inference_mode()
def _features(network: InceptionFeatures, pictures: Iterable[NDArray[Any]], name: str) -> Features:
    found = []
    for picture in pictures:
        check_picture(picture, name=name)
        found.append(network(torch.from_numpy(as_float(picture)).permute(2, 0, 1)[None])[0].double().numpy())
    require(name, len(found), len(found) >= 2, "at least 2 pictures")
    return np.stack(found)
