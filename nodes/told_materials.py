"""What bodies are made of, as the scene editor's page takes it: what its document says counts instead."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..physics.document import encode_material
from ..physics.material import PRESETS, SCALES, Material
from ..physics.motion import layer_order
from ..physics.scene import Body

__all__ = ["told_materials"]


def told_materials(bodies: Sequence[Body]) -> dict[str, Any]:
    """The presets, the material without any, and of each body its name and its material, without what is painted.

    Args:
        bodies: as other nodes give them, before a document speaks of them.
    """
    return {
        "presets": {name: _plain(material) for name, material in PRESETS.items()},
        "plain": _plain(Material()),
        "bodies": [{"name": body.name, "material": _short(body.material)} for body in bodies],
        "order": layer_order(bodies),
    }


def _short(material: Material) -> dict[str, Any]:
    """A preset by its name alone where nothing of it was changed."""
    plain = _plain(material)
    preset = PRESETS.get(material.name)
    return {"preset": material.name} if preset is not None and plain == _plain(preset) else plain


def _plain(material: Material) -> dict[str, Any]:
    return {name: value for name, value in encode_material(material).items() if name not in SCALES}
