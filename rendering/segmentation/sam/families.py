"""The members of the Segment Anything family: how each sees a picture, and where its weights are to be had.

Kirillov et al., "Segment anything" (2023); Ke et al., "Segment anything in high quality" (2023); Ravi et al., "SAM 2:
Segment anything in images and videos" (2024); Zhou et al., "EdgeTAM" (2025); Carion et al., "SAM 3" (2025).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

__all__ = ["FAMILIES", "Family", "where_to_get"]

Triple = tuple[float, float, float]

_IMAGENET_MEAN, _IMAGENET_STD = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)


@dataclass(frozen=True)
class Family:
    """One architecture.

    Attributes:
        title: its name.
        stretched: whether pictures are stretched to the network's square; else they keep their proportions and are
            filled up at the right or the bottom.
        mean: of the network's colours, RGB in 0 to 1.
        std: of the network's colours, RGB in 0 to 1.
        file: what to get: a file, or a folder with config.json and model.safetensors.
        page: where to get it.
        licence: of the weights.
    """

    title: str
    stretched: bool
    file: str
    page: str
    licence: str = "Apache-2.0"
    mean: Triple = _IMAGENET_MEAN
    std: Triple = _IMAGENET_STD


_SAM2 = Family(
    "SAM 2", True, "sam2.1-hiera-base-plus/", "https://huggingface.co/facebook/sam2.1-hiera-base-plus/tree/main"
)
_SAM3 = Family(
    "SAM 3",
    True,
    "sam3/",
    "https://huggingface.co/facebook/sam3/tree/main",
    "SAM License",
    (0.5, 0.5, 0.5),
    (0.5, 0.5, 0.5),
)

FAMILIES: Mapping[str, Family] = {
    "sam": Family(
        "SAM", False, "sam_vit_b_01ec64.pth", "https://github.com/facebookresearch/segment-anything#model-checkpoints"
    ),
    "sam_hq": Family(
        "SAM-HQ", False, "sam-hq-vit-base/", "https://huggingface.co/syscv-community/sam-hq-vit-base/tree/main"
    ),
    "sam2": _SAM2,
    "sam2_video": _SAM2,
    "edgetam": Family("EdgeTAM", True, "EdgeTAM-hf/", "https://huggingface.co/yonigozlan/EdgeTAM-hf/tree/main"),
    "sam3_tracker": _SAM3,
    "sam3_video": _SAM3,
}
"""The architectures by the ``model_type`` in their config.json."""


def where_to_get(folder: str) -> str:
    """What to put where, one sentence for each family.

    Args:
        folder: where the files belong, such as ``models/sams``.
    """
    once = {family.title: family for family in FAMILIES.values()}.values()
    return " ".join(
        f"{each.title}: put {_contents(each.file)} into {folder}, from {each.page} ({each.licence})." for each in once
    )


def _contents(file: str) -> str:
    return f"the folder {file} with config.json and model.safetensors" if file.endswith("/") else file
