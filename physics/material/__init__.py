"""Materials: fixed corotated elasticity with its Lame parameters, presets, natural modes, and painted factors."""

from __future__ import annotations

from .changing import check_together, with_values
from .elasticity import (
    RestShape,
    deformation_gradients,
    elastic_constants,
    energy,
    forces,
    gradient_products,
    lame_parameters,
    lumped_masses,
    rest_shape,
    rotations,
    semi_implicit_euler,
    stiffness_matrix,
    stress,
)
from .material import PRESETS, SCALES, Material, preset
from .modes import highest_eigenvalue, lowest_eigenvalue, lowest_modes
from .painting import mask_means, painted, painted_by_means

__all__ = [
    "PRESETS",
    "SCALES",
    "Material",
    "RestShape",
    "check_together",
    "deformation_gradients",
    "elastic_constants",
    "energy",
    "forces",
    "gradient_products",
    "highest_eigenvalue",
    "lame_parameters",
    "lowest_eigenvalue",
    "lowest_modes",
    "lumped_masses",
    "mask_means",
    "painted",
    "painted_by_means",
    "preset",
    "rest_shape",
    "rotations",
    "semi_implicit_euler",
    "stiffness_matrix",
    "stress",
    "with_values",
]
