"""A motion as work to go on with: a Spine skeleton, or a glTF scene."""

from __future__ import annotations

from .gltf import GltfScene, save_gltf
from .puppet import MovingMesh, Puppet, PuppetPiece
from .spine import SpineSkeleton
from .spine_folder import SPINE_RECORD, check_spine_folder, is_spine_name, save_spine, spine_files_in

__all__ = [
    "SPINE_RECORD",
    "GltfScene",
    "MovingMesh",
    "Puppet",
    "PuppetPiece",
    "SpineSkeleton",
    "check_spine_folder",
    "is_spine_name",
    "save_gltf",
    "save_spine",
    "spine_files_in",
]
