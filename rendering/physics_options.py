"""What can be said to ``animate`` of materials and of how they are integrated, as the paper does or otherwise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from ..physics.errors import InvalidInputError
from ..physics.fields import check_field, described_fields
from ..physics.material import Material, check_together, with_values
from ..physics.scene import Scene, StrokesAs

__all__ = ["MATERIAL_VALUES", "PhysicsOptions", "Values"]

Values = float | Sequence[float] | None
"""A number for all parts, or one for each; None for what their materials say."""

MATERIAL_VALUES = (
    "mu",
    "lambda_",
    "youngs_modulus",
    "poisson_ratio",
    "density",
    "damping",
    "stretch_limit",
    "wind_response",
    "root_stiffness",
)
"""Fields of a material that can be given for the parts."""


@dataclass(frozen=True)
class PhysicsOptions:
    """What parts are made of and how their motion is computed, where it is not as presets and the scene say.

    Attributes:
        mu: Lame parameter mu [density side^2/s^2]; see ``Material``, as for all values up to ``root_stiffness``.
        lambda_: Lame parameter lambda [density side^2/s^2]; 0 for none.
        youngs_modulus: instead of the Lame parameters [density side^2/s^2].
        poisson_ratio: beside it.
        density: mass for its size.
        damping: rate at which motion dies away [1/s].
        stretch_limit: how many times as far as drawn a point gets from what is held; 0 for no limit.
        wind_response: factor on what wind and strokes do.
        root_stiffness: how many times as stiff it is where it is held as at its tip.
        time_step: of plain semi-implicit Euler [s], 0.001 in the paper; 0 for steps that follow from the mesh.
        strokes_as: what strengths of strokes and wind are.
        sag: whether parts are drawn without their weight.

    Raises:
        InvalidInputError: a value is none that may be, or they say twice how stiff parts are.
    """

    mu: Values = None
    lambda_: Values = None
    youngs_modulus: Values = None
    poisson_ratio: Values = None
    density: Values = None
    damping: Values = None
    stretch_limit: Values = None
    wind_response: Values = None
    root_stiffness: Values = None
    time_step: float | None = None
    strokes_as: StrokesAs | None = None
    sag: bool | None = None

    def __post_init__(self) -> None:
        given = self._given()
        for name, values in given.items():
            key = described_fields(Material)[name].key
            if not values:
                raise InvalidInputError(f"{key} must be a number for all parts, or one for each. Got: none")
            for value in values:
                check_field(Material, name, None if name == "stretch_limit" and value == 0 else value)
        check_together({name: values[0] for name, values in given.items()})
        for name, value in self._of_scene().items():
            check_field(Scene, name, value)

    def applied(self, scene: Scene, *, sway: float | None = None) -> Scene:
        """The scene with these values in the place of its own.

        Args:
            scene: the parts and what acts on them.
            sway: sway frequency that was asked for as well.

        Raises:
            InvalidInputError: there are neither one nor as many values as parts, or a material cannot have them.
        """
        given, count = self._given(), len(scene.bodies)
        check_together({**({} if sway is None else {"sway_frequency": sway}), **given})
        for name, values in given.items():
            if len(values) not in (1, count):
                key = described_fields(Material)[name].key
                raise InvalidInputError(
                    f"{key} must be one number for all parts, or one for each of the {count}. Got: {len(values)}"
                )
        bodies = []
        for number, body in enumerate(scene.bodies):
            own = {name: values[number if len(values) > 1 else 0] for name, values in given.items()}
            unlimited = own.get("stretch_limit") == 0
            material = with_values(body.material, **{**own, **({"stretch_limit": None} if unlimited else {})})
            material = replace(material, stretch_limit=None) if unlimited else material
            bodies.append(body if not own else replace(body, material=material))
        return replace(scene, bodies=tuple(bodies), **self._of_scene())

    def _given(self) -> dict[str, Sequence[Any]]:
        """The values that are given for parts, in lists."""
        said = {name: getattr(self, name) for name in MATERIAL_VALUES}
        return {
            name: list(value) if isinstance(value, Sequence) and not isinstance(value, str) else [value]
            for name, value in said.items()
            if value is not None
        }

    def _of_scene(self) -> dict[str, Any]:
        """The values that are given for the whole scene."""
        said = {"time_step": self.time_step, "strokes_as": self.strokes_as, "sag": self.sag}
        given = {name: value for name, value in said.items() if value is not None}
        return {**given, "time_step": self.time_step or None} if "time_step" in given else given
