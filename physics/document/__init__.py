"""Scenes as versioned JSON documents: read, checked against their schema, brought up to date, written."""

from __future__ import annotations

from .body_names import arranged_for, bodies_named, order_of_layers, rig_points_kept, still_layers
from .checking import check_document
from .encoding import encode, encode_material, scene_to_dict
from .given import given_scene, materials_of
from .json_text import Most, read_json, surplus_of
from .overlay import checked_scene_over, scene_over
from .point_text import parse_points, parse_polyline, require_pixels
from .scene_json import LayerMasks, dumps, loads, mask_pixels, scene_from_dict
from .schema import scene_schema

__all__ = [
    "LayerMasks",
    "Most",
    "arranged_for",
    "bodies_named",
    "check_document",
    "checked_scene_over",
    "dumps",
    "encode",
    "encode_material",
    "given_scene",
    "loads",
    "mask_pixels",
    "materials_of",
    "order_of_layers",
    "parse_points",
    "parse_polyline",
    "read_json",
    "require_pixels",
    "rig_points_kept",
    "scene_from_dict",
    "scene_over",
    "scene_schema",
    "scene_to_dict",
    "still_layers",
    "surplus_of",
]
