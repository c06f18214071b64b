"""Materials: what a body is made of, and presets under the names that artists use.

Units: the longest side of the illustration is 1 side, density is 1 for every ordinary body, time is seconds.
A look therefore survives a change of resolution.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import within
from ..errors import InvalidInputError, require
from ..limits import LARGEST, STIFFEST

__all__ = ["PRESETS", "SCALES", "Material", "preset"]

SCALES = ("stiffness_scale", "damping_scale", "density_scale")
"""Fields of a material that hold one factor for each triangle."""


@dataclass(frozen=True, eq=False)
class Material:
    """An isotropic fixed corotated solid (paper, Method, "Deformable Body Model").

    Attributes:
        youngs_modulus: stiffness against stretching [density side^2 / s^2].
        poisson_ratio: how much a pull in one direction narrows the other, 0 to below 0.5.
        density: mass per area [1].
        damping: rate alpha of the velocity's decay, v(t) = v(0) exp(-alpha t) [1/s].
        sway_frequency: when set, Young's modulus is chosen so that the body's longest connected part sways this often
            about its pinned points [Hz], 0.001 to 1000; shorter parts sway faster, as pendulums do, and parts without
            a pinned point keep ``youngs_modulus``.
        stretch_limit: when set, no point gets farther from where its part is held than this factor times the way to
            there through the drawing [1], at least 1: 1.06 looks inextensible and yet bends freely. Parts of which
            nothing is held do not feel it.
        wind_response: factor on the acceleration by wind and strokes [1]: light things fly, heavy ones hardly move.
        stiffness_scale: factor on Young's modulus for each triangle, shape [t]; None means 1 everywhere.
        damping_scale: factor on the damping for each triangle, shape [t]; None means 1 everywhere.
        density_scale: factor on the density for each triangle, shape [t]; None means 1 everywhere.
        name: the preset it came from, or empty; the automatic scene reads from it how such bodies are attached.

    Examples:
        >>> from physanimator.physics.material import Material
        >>> Material(youngs_modulus=800.0, damping=2.0).poisson_ratio
        0.3
    """

    youngs_modulus: float = 500.0
    poisson_ratio: float = 0.3
    density: float = 1.0
    damping: float = 1.5
    sway_frequency: float | None = None
    stiffness_scale: NDArray[np.float64] | None = None
    name: str = ""
    damping_scale: NDArray[np.float64] | None = None
    density_scale: NDArray[np.float64] | None = None
    stretch_limit: float | None = None
    wind_response: float = 1.0

    def __post_init__(self) -> None:
        bounded = within(self.youngs_modulus, 0, STIFFEST, above=True)
        require("youngs_modulus", self.youngs_modulus, bounded, f"above 0 and at most {STIFFEST:g}")
        narrow = within(self.poisson_ratio, 0, 0.5, below=True)
        require("poisson_ratio", self.poisson_ratio, narrow, "at least 0 and below 0.5")
        heavy = within(self.density, 0, LARGEST, above=True)
        require("density", self.density, heavy, f"above 0 and at most {LARGEST}")
        require("damping", self.damping, within(self.damping, 0, LARGEST), f"0 to {LARGEST} per second")
        if self.sway_frequency is not None:
            swaying = within(self.sway_frequency, 0.001, 1_000)
            require("sway_frequency", self.sway_frequency, swaying, "0.001 to 1000 Hz")
        if self.stretch_limit is not None:
            require("stretch_limit", self.stretch_limit, within(self.stretch_limit, 1, LARGEST), f"1 to {LARGEST}")
        require("wind_response", self.wind_response, within(self.wind_response, 0, LARGEST), f"0 to {LARGEST}")
        require("name", self.name, isinstance(self.name, str), "a text")
        for field in SCALES:
            if getattr(self, field) is not None:
                object.__setattr__(self, field, _checked_scale(field, getattr(self, field)))

    def densities(self, count: int) -> NDArray[np.float64]:
        """Mass per area of each of so many triangles, shape [t]."""
        return self.density * (np.ones(count) if self.density_scale is None else self.density_scale)

    @property
    def lame(self) -> tuple[float, float]:
        """Lame parameters (mu, lambda) in plane strain [density side^2 / s^2]."""
        e, nu = self.youngs_modulus, self.poisson_ratio
        return e / (2 * (1 + nu)), e * nu / ((1 + nu) * (1 - 2 * nu))


def _checked_scale(name: str, values: ArrayLike) -> NDArray[np.float64]:
    expected = f"one factor a triangle, above 0 and at most {LARGEST}"
    try:
        scale = np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InvalidInputError(f"{name} must be {expected}. Got: {values!r:.60}") from None
    require(name, f"shape {scale.shape}", scale.ndim == 1, expected)
    wrong = scale[~((scale > 0) & (scale <= LARGEST))]
    require(name, wrong[:1], not len(wrong), expected)
    scale.setflags(write=False)
    return scale


PRESETS: dict[str, Material] = {
    "hair": Material(
        youngs_modulus=400.0, damping=1.0, sway_frequency=0.7, stretch_limit=1.06, wind_response=0.6, name="hair"
    ),
    "ribbon": Material(
        youngs_modulus=250.0, damping=1.4, sway_frequency=2.1, stretch_limit=1.06, wind_response=4.5, name="ribbon"
    ),
    "cloth": Material(
        youngs_modulus=300.0, damping=4.0, sway_frequency=0.6, stretch_limit=1.06, wind_response=0.5, name="cloth"
    ),
    "leaf": Material(youngs_modulus=900.0, damping=2.5, sway_frequency=2.8, wind_response=1.5, name="leaf"),
    "jelly": Material(
        youngs_modulus=40.0, poisson_ratio=0.45, damping=0.5, sway_frequency=1.5, wind_response=1.6, name="jelly"
    ),
}


def preset(preset_name: str, /, **changes: Any) -> Material:
    """The preset of a name with fields, its ``name`` among them, replaced by ``changes``.

    Raises:
        InvalidInputError: there is no such preset.

    Examples:
        >>> from physanimator.physics.material import preset
        >>> preset("hair", damping=2.0).damping
        2.0
    """
    if not isinstance(preset_name, str) or preset_name not in PRESETS:
        raise InvalidInputError(f"preset must be one of {', '.join(PRESETS)}. Got: {preset_name!r:.60}")
    return replace(PRESETS[preset_name], **changes)
