"""Materials: what a body is made of, and presets under the names that artists use.

Units: the longest side of the illustration is 1 side, density is 1 for every ordinary body, time is seconds.
A look therefore survives a change of resolution.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import InvalidInputError, require
from ..fields import Field, Input, check_fields, described
from ..limits import LARGEST, MAX_TRIANGLES, STIFFEST
from .elasticity import elastic_constants, lame_parameters

__all__ = ["PRESETS", "SCALES", "Material", "preset"]

SCALES = ("stiffness_scale", "damping_scale", "density_scale")
"""Fields of a material that hold one factor for each triangle."""


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


def _scale(quantity: str) -> Field:
    about = f"A factor on the {quantity} of each triangle of the mesh; null means 1 everywhere."
    return Field(f"{quantity.capitalize()} scale", about, entry="factor", most=MAX_TRIANGLES, check=_checked_scale)


@described
@dataclass(frozen=True, eq=False)
class Material:
    """An isotropic fixed corotated solid (paper, Method, "Deformable Body Model").

    Its energy has the Lame parameters mu and lambda. Young's modulus E and Poisson's ratio nu give those of plane
    strain, mu = E / (2 (1 + nu)) and lambda = E nu / ((1 + nu) (1 - 2 nu)). Given themselves, as ``mu`` and
    ``lambda_``, they go into the energy as they are: then ``youngs_modulus`` and ``poisson_ratio`` are those that they
    amount to, whatever was given for them, and there is no sway frequency.

    Damping is the rate alpha of the velocity's decay, v(t) = v(0) exp(-alpha t). From a sway frequency Young's modulus
    follows so that the body's longest connected part sways this often about its pinned points; parts without a pinned
    point keep ``youngs_modulus``, and do not feel the stretch limit. The automatic scene reads from the name how such
    bodies are attached. Scales hold one factor for each triangle, shape [t].

    Examples:
        >>> from physanimator.physics.material import Material
        >>> Material(youngs_modulus=800.0, damping=2.0).poisson_ratio
        0.3
        >>> Material(mu=200.0, lambda_=300.0).youngs_modulus
        520.0
    """

    youngs_modulus: Annotated[
        float,
        Field(
            "Young's modulus",
            "Stiffness: how hard the body is to stretch and bend. Twice the sway needs four times the stiffness. A set"
            " sway_frequency takes its place.",
            "density side^2/s^2",
            above=0,
            maximum=STIFFEST,
        ),
        Input(
            "Stiffness against stretching [density x side^2/s^2], a side being the picture's longest.",
            0.1,
            1_000_000.0,
            step=10.0,
        ),
    ] = 500.0
    poisson_ratio: Annotated[
        float,
        Field(
            "Poisson's ratio",
            "How much a stretched body narrows: 0 not at all, near 0.5 like rubber or jelly.",
            minimum=0,
            below=0.5,
        ),
        Input(
            "How much a pull in one direction narrows the other [1]: 0 not at all, 0.45 like rubber.",
            high=0.49,
            step=0.01,
        ),
    ] = 0.3
    density: Annotated[
        float,
        Field(
            "Density",
            "Mass for its size; 1 is ordinary. A heavier body of the same stiffness sways more slowly.",
            above=0,
        ),
        Input("Mass per area [1]; 1 is ordinary.", 0.01, 100.0, step=0.1),
    ] = 1.0
    damping: Annotated[
        float,
        Field(
            "Damping",
            "How fast motion dies away: 0 never, 1 within some seconds, 5 almost at once.",
            "1/s",
            minimum=0,
        ),
        Input(
            "How fast it comes to rest [1/s]: 0 swings forever, 1.5 is a breeze, 10 moves as in honey.",
            high=50.0,
            step=0.1,
        ),
    ] = 1.5
    sway_frequency: Annotated[
        float | None,
        Field(
            "Sway frequency",
            "How often the body sways about where it is held; hair sways about once a second. Its shorter separate"
            " parts sway faster. The stiffness follows from it. null: use youngs_modulus.",
            "Hz",
            minimum=0.001,
            maximum=1000,
        ),
        Input(
            "How often it swings to and fro about where it is held [Hz]: lower is softer and heavier.",
            0.05,
            20.0,
            step=0.05,
        ),
    ] = None
    stiffness_scale: Annotated[NDArray[np.float64] | None, _scale("stiffness")] = None
    name: Annotated[str, Field("Name", 'What the material is called, such as "hair".')] = ""
    damping_scale: Annotated[NDArray[np.float64] | None, _scale("damping")] = None
    density_scale: Annotated[NDArray[np.float64] | None, _scale("density")] = None
    stretch_limit: Annotated[
        float | None,
        Field(
            "Stretch limit",
            "How many times as far as in the drawing a point gets from where its part is held, at most, as if on a"
            " thread: 1.06 for hair and ribbon, which bend but do not stretch. null: no limit.",
            minimum=1,
        ),
        Input(
            "How many times as far as drawn a point gets from where the part is held, at most [1]: 1.06 hardly"
            " stretches and yet bends; 0 for no limit, and below 1 it is 1.",
            0.0,
            10.0,
            step=0.01,
        ),
    ] = None
    wind_response: Annotated[
        float,
        Field(
            "Wind response",
            "How strongly wind and strokes act on the body: 1 is ordinary, 2 light as paper, 0.5 heavy, 0 not at all.",
            minimum=0,
        ),
        Input(
            "How strongly wind and strokes act on it [1]: 1 is ordinary, 3 light as a ribbon, 0.5 heavy, 0 not at all.",
            high=100.0,
            step=0.1,
        ),
    ] = 1.0
    root_stiffness: Annotated[
        float,
        Field(
            "Root stiffness",
            "How many times as stiff the body is where it is held as at its farthest tip, measured along the shape;"
            " Young's modulus is that of the tip. 1 bends alike everywhere, more keeps hair on its head and lets its"
            " tips swing. A set sway_frequency stays.",
            minimum=1,
            maximum=1000,
        ),
        Input(
            "How many times as stiff it is where it is held as at its tip [1]: 1 bends alike everywhere, 20 keeps the"
            " root still and lets the tip swing.",
            high=1000.0,
            step=1.0,
        ),
    ] = 1.0
    mu: Annotated[
        float | None,
        Field(
            "Lame parameter mu",
            "Resistance to a change of shape, as the paper's mu. Given with lambda, instead of youngs_modulus and"
            " poisson_ratio. null: as those two say.",
            "density side^2/s^2",
            above=0,
            maximum=STIFFEST,
        ),
        Input(
            "Resistance to stretching, bending and shear [density x side^2/s^2], a side being the picture's longest;"
            " the paper's mu.",
            0.01,
            1_000_000.0,
            step=0.1,
        ),
    ] = None
    lambda_: Annotated[
        float | None,
        Field(
            "Lame parameter lambda",
            "Resistance to a change of area, as the paper's lambda; 0 for none. Given with mu.",
            "density side^2/s^2",
            minimum=0,
            maximum=STIFFEST,
        ),
        Input(
            "Resistance to a change of area [density x side^2/s^2], the paper's lambda; 0 lets it narrow or widen"
            " freely.",
            0.0,
            100_000_000.0,
            step=0.1,
        ),
    ] = None

    def __post_init__(self) -> None:
        check_fields(self)
        for name, value, other in (("mu", self.mu, self.lambda_), ("lambda", self.lambda_, self.mu)):
            if value is None and other is not None:
                given = "lambda" if name == "mu" else "mu"
                raise InvalidInputError(f"{name} must be given together with {given}. Got: {given} alone")
        if self.mu is None or self.lambda_ is None:
            return
        if self.sway_frequency is not None:
            raise InvalidInputError(
                f"sway_frequency must be left out where mu and lambda say how stiff the body is."
                f" Got: {self.sway_frequency:g} Hz"
            )
        modulus, ratio = elastic_constants(self.mu, self.lambda_)
        object.__setattr__(self, "youngs_modulus", min(float(modulus), STIFFEST))
        object.__setattr__(self, "poisson_ratio", float(ratio))

    def densities(self, count: int) -> NDArray[np.float64]:
        """Mass per area of each of so many triangles, shape [t]."""
        return self.density * (np.ones(count) if self.density_scale is None else self.density_scale)

    @property
    def lame(self) -> tuple[float, float]:
        """Lame parameters (mu, lambda) [density side^2 / s^2]: those given, or those of plane strain."""
        mu, lam = self.lame_at(np.float64(self.youngs_modulus))
        return float(mu), float(lam)

    def lame_at(self, modulus: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lame parameters of triangles that paint, roots or sway have made stiffer or softer, elementwise.

        Args:
            modulus: their Young's moduli [density side^2 / s^2].
        """
        if self.mu is None or self.lambda_ is None:
            return lame_parameters(modulus, self.poisson_ratio)
        factor = np.asarray(modulus, dtype=np.float64) / self.youngs_modulus  # just 1 where nothing has changed it
        return self.mu * factor, self.lambda_ * factor


PRESETS: dict[str, Material] = {
    "hair": Material(
        youngs_modulus=400.0,
        damping=1.0,
        sway_frequency=0.7,
        stretch_limit=1.06,
        wind_response=0.6,
        root_stiffness=30.0,
        name="hair",
    ),
    "ribbon": Material(
        youngs_modulus=250.0,
        damping=1.4,
        sway_frequency=2.1,
        stretch_limit=1.06,
        wind_response=4.5,
        root_stiffness=10.0,
        name="ribbon",
    ),
    "cloth": Material(
        youngs_modulus=300.0,
        damping=4.0,
        sway_frequency=0.6,
        stretch_limit=1.06,
        wind_response=0.5,
        root_stiffness=10.0,
        name="cloth",
    ),
    "leaf": Material(youngs_modulus=900.0, damping=2.5, sway_frequency=2.8, wind_response=1.5, name="leaf"),
    "jelly": Material(
        youngs_modulus=40.0, poisson_ratio=0.45, damping=0.5, sway_frequency=1.5, wind_response=1.6, name="jelly"
    ),
}


def preset(preset_name: str, /, **changes: Any) -> Material:
    """The preset of a name with fields, its ``name`` among them, replaced by ``changes``.

    Lame parameters among them take the place of its sway frequency.

    Raises:
        InvalidInputError: there is no such preset.

    Examples:
        >>> from physanimator.physics.material import preset
        >>> preset("hair", damping=2.0).damping
        2.0
    """
    if not isinstance(preset_name, str) or preset_name not in PRESETS:
        raise InvalidInputError(f"preset must be one of {', '.join(PRESETS)}. Got: {preset_name!r:.60}")
    if changes.get("mu") is not None or changes.get("lambda_") is not None:
        changes = {"sway_frequency": None, **changes}
    return replace(PRESETS[preset_name], **changes)
