"""From a mask to a triangle mesh, and from triangles back to pixels (paper, Method, "Mesh")."""

from __future__ import annotations

from .boundary import boundary_edges, half_edges, on_boundary
from .contours import area_of, contours_at_half, resampled
from .cutting import cut_along
from .masks import coverage_of, fitted, largest_area, may_be_inverted, refuse_noise
from .meshing import LEAST_SPACING, SMALLEST_PART, mesh_from_mask
from .outline_distances import signed_distances, within_reach
from .pixel_box import PixelBox, bounding_box
from .raster import AffinePerTriangle, Fragments, affine_per_triangle, barycentric, interpolate, rasterise, triangle_ids
from .run_lengths import mask_of, runs_of
from .triangle_mesh import UNITS_ACROSS, TriangleMesh
from .ways import ways_along, ways_from

__all__ = [
    "LEAST_SPACING",
    "SMALLEST_PART",
    "UNITS_ACROSS",
    "AffinePerTriangle",
    "Fragments",
    "PixelBox",
    "TriangleMesh",
    "affine_per_triangle",
    "area_of",
    "barycentric",
    "boundary_edges",
    "bounding_box",
    "contours_at_half",
    "coverage_of",
    "cut_along",
    "fitted",
    "half_edges",
    "interpolate",
    "largest_area",
    "mask_of",
    "may_be_inverted",
    "mesh_from_mask",
    "on_boundary",
    "rasterise",
    "refuse_noise",
    "resampled",
    "runs_of",
    "signed_distances",
    "triangle_ids",
    "ways_along",
    "ways_from",
    "within_reach",
]
