"""A motion as work to go on with: a Spine skeleton, a glTF scene, or motion vectors for compositing."""

from __future__ import annotations

from .gltf import GltfScene, save_gltf
from .motion_vectors import (
    VECTOR_CHANNELS,
    VectorChannels,
    check_openexr,
    check_vectors_folder,
    exr_channels,
    save_motion_vectors,
)
from .puppet import MovingMesh, Puppet, PuppetPiece
from .spine import SpineSkeleton
from .spine_folder import SPINE_RECORD, check_spine_folder, is_spine_name, save_spine, spine_files_in

__all__ = [
    "SPINE_RECORD",
    "VECTOR_CHANNELS",
    "GltfScene",
    "MovingMesh",
    "Puppet",
    "PuppetPiece",
    "SpineSkeleton",
    "VectorChannels",
    "check_openexr",
    "check_spine_folder",
    "check_vectors_folder",
    "exr_channels",
    "is_spine_name",
    "save_gltf",
    "save_motion_vectors",
    "save_spine",
    "spine_files_in",
]
