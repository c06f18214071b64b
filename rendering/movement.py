"""How the parts of an illustration move: the scene that is made for them, or the one that is given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ..physics.document import arranged_for, given_scene, materials_of
from ..physics.errors import InvalidInputError
from ..physics.scene import Attachment, Scene, automatic_scene, held_where_said
from .options import DEFAULT_FRAME_RATE, AutomaticWind, Timing
from .parts import OF_STRANDS, Parts
from .physics_options import PhysicsOptions

__all__ = ["Movement"]

_USUAL_WIND, _USUAL_TIMING, _USUAL_PHYSICS = AutomaticWind(), Timing(), PhysicsOptions()


@dataclass(frozen=True, eq=False)
class Movement:
    """What was said of how parts move.

    Attributes:
        preset: name of the material, one for all parts or one for each; None as they suggest.
        sway: how often a part sways in a second, instead of the preset's [Hz].
        attach: side at which parts are held where there is no scene.
        wind: what blows where there is no scene.
        timing: how fast frames are shown.
        strands: whether parts are slit between their strands; None where that suits them.
        pixel_art: whole pixels move, through whose blocks no slit goes.
    """

    preset: str | Sequence[str] | None = None
    sway: float | None = None
    attach: Attachment = "auto"
    wind: AutomaticWind = _USUAL_WIND
    timing: Timing = _USUAL_TIMING
    strands: bool | None = None
    pixel_art: bool = False

    def staged(
        self, parts: Parts, scene: Scene | Mapping[str, Any] | None = None, physics: PhysicsOptions = _USUAL_PHYSICS
    ) -> tuple[Parts, Scene]:
        """The parts, slit where that suits them, and all that acts on them, held where that is said.

        Args:
            parts: of the illustration.
            scene: with a body for each part, or a checked document; None for one that is made for them.
            physics: what is otherwise than materials and the scene say.
        """
        parts, whole = self.automatic(parts) if scene is None else self.given(parts, scene)
        whole = replace(whole, still=parts.still) if parts.still else whole
        whole = physics.applied(whole, sway=self.sway)
        loop = self.timing.loop
        return parts, held_where_said(parts.covered(whole if loop is None else replace(whole, loop=loop)))

    def automatic(self, parts: Parts) -> tuple[Parts, Scene]:
        """The parts, slit where that suits them, and the scene where none is given."""
        suiting = [each or "hair" for each in parts.presets]
        materials = materials_of(self.preset or suiting, self.sway, len(parts.meshes))
        sides = parts.attachments if self.attach == "auto" else (self.attach,) * len(parts.meshes)
        split = _split(self.strands, [each.name in OF_STRANDS for each in materials], self.pixel_art)
        parts = parts.in_strands(split, sides)
        rate = self.timing.frame_rate
        return parts, automatic_scene(
            parts.bodies(materials, split),
            attach=sides,
            frame_rate=DEFAULT_FRAME_RATE if rate is None else rate,
            wind_strength=self.wind.strength,
            wind_angle=self.wind.angle,
            turbulence=self.wind.turbulence,
            sway_by_size=self.sway is None,
        )

    def given(self, parts: Parts, scene: Scene | Mapping[str, Any]) -> tuple[Parts, Scene]:
        """The parts, slit where the scene says so, and the scene with them."""
        absent: tuple[str, ...] = ()
        if not isinstance(scene, Scene):
            scene, absent = arranged_for(scene, parts.names)
        split = _split(self.strands, _split_by(scene, len(parts.meshes)), self.pixel_art)
        parts = parts.in_strands(split, parts.attachments)
        whole = given_scene(
            scene,
            list(parts.meshes),
            names=parts.names,
            layers=parts.layer_mask,
            preset=self.preset,
            sway=self.sway,
            frame_rate=self.timing.frame_rate,
        )
        return parts, replace(whole, absent=absent)


def _split(asked: bool | None, suiting: list[bool], pixel_art: bool) -> list[bool]:
    """Which parts are slit: as asked, or else those that it suits; none in pixel art, through whose blocks slits go."""
    if asked and pixel_art:
        raise InvalidInputError("strands must be left out, or off, with pixel_art. Got: both")
    if pixel_art:
        return [False] * len(suiting)
    return suiting if asked is None else [asked] * len(suiting)


def _split_by(scene: Scene | Mapping[str, Any], count: int) -> list[bool]:
    """Which parts a scene, or a checked document, wants slit between their strands."""
    if isinstance(scene, Scene):
        said = [body.strands for body in scene.bodies]
    else:
        said = [bool(body.get("strands")) for body in scene.get("bodies", [])]
    return [*said, *[False] * count][:count]
