"""Colours of a PSD file as sRGB: drawing tablets and printing houses embed other profiles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from .artwork import ArtLayer

if TYPE_CHECKING:
    from psd_tools import PSDImage

__all__ = ["in_srgb_colours"]


def in_srgb_colours(layers: Sequence[ArtLayer], document: PSDImage, remarks: list[str]) -> list[ArtLayer]:
    """Layers of a document in sRGB.

    Args:
        layers: of the document.
        document: whose profile counts.
        remarks: gets a sentence where a profile cannot be applied, or not exactly.
    """
    from psd_tools.constants import Resource

    from ..pictures.colour_profiles import as_srgb

    profile = document.image_resources.get_data(Resource.ICC_PROFILE)
    if not isinstance(profile, bytes) or not profile:
        return list(layers)
    converted = []
    for layer in layers:
        pixels, remark = as_srgb(layer.pixels, profile)
        converted.append(replace(layer, pixels=pixels))
        if remark and remark not in remarks:
            remarks.append(remark)
    return converted
