"""Colours of a PSD file as sRGB: drawing tablets and printing houses embed other profiles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from .artwork import ArtLayer

if TYPE_CHECKING:
    from psd_tools import PSDImage

__all__ = ["in_srgb_colours"]


def in_srgb_colours(layers: Sequence[ArtLayer], document: PSDImage, remarks: list[str]) -> list[ArtLayer]:
    """Layers of a document in sRGB.

    Args:
        layers: of the document.
        document: whose profile counts.
        remarks: gets a sentence where a profile cannot be applied.
    """
    from psd_tools.constants import ColorMode, Resource

    profile = document.image_resources.get_data(Resource.ICC_PROFILE)
    if not isinstance(profile, bytes) or document.color_mode != ColorMode.RGB or _is_srgb(profile):
        return list(layers)
    if document.depth != 8:
        remarks.append("the file's colour profile is not applied; convert it to sRGB in the painting program")
        return list(layers)
    return [_converted(layer, profile) for layer in layers]


def _is_srgb(profile: bytes) -> bool:
    import io

    from PIL import ImageCms

    try:
        return "srgb" in ImageCms.getProfileDescription(ImageCms.ImageCmsProfile(io.BytesIO(profile))).lower()
    except (ImageCms.PyCMSError, OSError, ValueError, TypeError):
        return True  # a profile that cannot be read says nothing


def _converted(layer: ArtLayer, profile: bytes) -> ArtLayer:
    from PIL import Image

    from ..pictures.picture_modes import in_srgb

    if not layer.pixels.size:
        return layer
    picture = Image.fromarray(layer.pixels)
    picture.info["icc_profile"] = profile
    return replace(layer, pixels=np.array(in_srgb(picture)))
