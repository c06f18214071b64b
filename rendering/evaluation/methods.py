"""Methods that can be compared: what draws the frames, and what is changed in it for an ablation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from types import MappingProxyType
from typing import Any, ClassVar

from ...physics.checks import check_number, check_whole
from ...physics.errors import InvalidInputError, require
from ..neural import CHOICES
from ..neural.options import FILES
from ..sketch import WARP_MODES, WarpMode
from .mask_errors import MASK_ERRORS
from .names import check_name, suggestion

__all__ = ["ABLATIONS", "DUAL_CLOCK", "METHODS", "PAPER_INTERVAL", "Method", "method_named"]

PAPER_INTERVAL = 15
"""Frames from keyframe to keyframe in the paper's in-betweening, n."""

WARP = "warp-inpaint"
"""Draws each frame by warping the picture and filling what is left by itself, without knowing of other frames."""

DUAL_CLOCK = "dual-clock"
"""Draws by Stable Video Diffusion that follows the animation of composite."""

_RENDERERS = {"svd": "sketch-guided"}
"""Renderers that a method calls otherwise than the command line does."""

DRAWS: Mapping[str, str] = MappingProxyType(
    {
        WARP: "composite",
        **{_RENDERERS.get(each, each): each for each in CHOICES["renderer"]},
        DUAL_CLOCK: "svd",
    }
)
"""What can draw frames, with its renderer. A renderer that the package gains is a method of that name at once."""

_SWEEP = (0.0, 0.8, 1.5, 3.0)


@dataclass(frozen=True, kw_only=True)
class Method:
    """What is compared.

    Attributes:
        name: of its row and its folder.
        draws: one of ``DRAWS``.
        clips: folder with somebody else's clips instead: a video or a folder of frames for each picture and sample.
        follows: those clips show our motion, as those of trajectory-guided models do: what is measured along it is.
        rate: of those clips [frames/s]; 0 for what their files say, and for folders of frames the set's.
        interpolate: frames from keyframe to keyframe, between which frames are filled in; 1: none are.
        interpolate_with: who fills them in.
        sketch_blur: standard deviation of the sketches' blur [px].
        sketch_warp: how sketches are warped.
        weight: which pixel shows where several meet after warping the picture: "layered", that of the body in front, or
            "paper", that which moved further.
        mask_error: how the masks are spoiled; empty for not at all.
        mask_error_px: by how much [px of a picture of 512 px].
        contact: False: bodies pass through each other, whatever the scene says.
        settings: of the renderer, such as ``{steps = 12}``.
        interpolate_settings: of the model that fills frames in.

    Raises:
        InvalidInputError: values do not go together.
    """

    __pydantic_config__: ClassVar = {"extra": "forbid", "strict": True}

    name: str
    draws: str = ""
    clips: str = ""
    follows: bool = False
    rate: float = 0.0
    interpolate: int = 1
    interpolate_with: str = "tooncrafter"
    sketch_blur: float = 0.8
    sketch_warp: WarpMode = "layered"
    weight: str = "layered"
    mask_error: str = ""
    mask_error_px: float = 6.0
    contact: bool = True
    settings: dict[str, float | int | bool | str] = field(default_factory=dict, hash=False)
    interpolate_settings: dict[str, float | int | bool | str] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        check_name(self.name)
        if self.draws or self.clips:
            self._check_values()
            self._check_together()

    def _check_values(self) -> None:
        for name, value, choices in (
            ("interpolate_with", self.interpolate_with, CHOICES["interpolate_with"]),
            ("sketch_warp", self.sketch_warp, WARP_MODES),
            ("weight", self.weight, ("layered", "paper")),
            ("mask_error", self.mask_error, ("", *MASK_ERRORS)),
            ("draws", self.draws, ("", *DRAWS)),
        ):
            known = [each for each in choices if each]
            require(name, repr(value), value in choices, f"one of {', '.join(known)}{suggestion(value, known)}")
        check_whole("interpolate", self.interpolate, 1, 1000, unit=" frames")
        check_number("rate", self.rate, 0, 240, unit=" frames a second")
        check_number("sketch_blur", self.sketch_blur, 0, 100, unit=" px")
        check_number("mask_error_px", self.mask_error_px, 0, 200, unit=" px")

    def _check_together(self) -> None:
        if bool(self.draws) == bool(self.clips):
            raise InvalidInputError("a method must have either draws or clips. Got: both")
        usual = {each.name: each.default for each in fields(self)}
        used = _USED_BY_CLIPS if self.clips else _USED_BY.get(self.draws, _USED_BY_RENDERERS)
        for name, default in usual.items():
            value = getattr(self, name)
            if name not in used | _ALWAYS and value != default and value != {}:
                raise InvalidInputError(f"{name} must be left out with {self.draws or 'clips'}. Got: {value!r}")

    @property
    def renderer(self) -> str:
        """The renderer of :class:`~physanimator.rendering.neural.NetworkOptions`."""
        return DRAWS[self.draws]

    @property
    def weights(self) -> tuple[str, ...]:
        """Keys of the files that it cannot do without."""
        if self.clips:
            return ()
        chosen = {"renderer": self.renderer}
        if self.interpolate > 1:
            chosen["interpolate_with"] = self.interpolate_with
        return tuple(
            name
            for name, (which, network, needed) in FILES.items()
            if needed and chosen.get(which) == network and (name != "lvcd" or self.follow != "animation")
        )

    @property
    def follow(self) -> str:
        """What frames of Stable Video Diffusion follow: see :class:`~physanimator.rendering.svd.SVDOptions`."""
        return str(self.settings.get("follow", "animation" if self.draws == DUAL_CLOCK else "sketches"))

    def as_record(self) -> dict[str, Any]:
        """All that its clips depend on: their name is no part of it."""
        return {each.name: getattr(self, each.name) for each in fields(self) if each.name not in ("name", "clips")}


_ALWAYS = {"name", "draws", "clips"}
_USED_BY_CLIPS = {"follows", "rate"}
_USED_BY_RENDERERS = {
    "interpolate",
    "interpolate_with",
    "sketch_blur",
    "sketch_warp",
    "mask_error",
    "mask_error_px",
} | {
    "contact",
    "settings",
    "interpolate_settings",
}
_USED_BY = {
    DUAL_CLOCK: _USED_BY_RENDERERS - {"sketch_blur", "sketch_warp"},
    WARP: {"weight", "mask_error", "mask_error_px", "contact"},
    "composite": _USED_BY_RENDERERS - {"sketch_blur", "sketch_warp", "settings"},
    "inpainting": _USED_BY_RENDERERS - {"sketch_blur", "sketch_warp"},
}


def _built_in() -> dict[str, Method]:
    spoiled = [
        Method(name=f"{draws}-{error}", draws=draws, mask_error=error)
        for draws in ("composite", WARP, "sketch-guided")
        for error in MASK_ERRORS
    ]
    blurred = [
        Method(name=f"sketch-guided-blur-{sigma:g}", draws="sketch-guided", sketch_blur=sigma) for sigma in _SWEEP
    ]
    other = [Method(name=each, draws=each) for each in DRAWS]
    filled = [
        Method(name=f"{draws}-interpolated", draws=draws, interpolate=PAPER_INTERVAL)
        for draws in ("composite", "sketch-guided")
    ]
    found = [
        *other,
        *filled,
        Method(name="sketch-guided-dual-clock", draws="sketch-guided", settings={"follow": "both"}),
        Method(name="composite-no-contact", draws="composite", contact=False),
        Method(name=f"{WARP}-paper-weight", draws=WARP, weight="paper"),
        Method(name="sketch-guided-paper-weight", draws="sketch-guided", sketch_warp="paper"),
        *blurred,
        *spoiled,
    ]
    return {each.name: each for each in found}


METHODS: Mapping[str, Method] = MappingProxyType(_built_in())
"""Methods that a set may name."""

ABLATIONS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "inpainting": ("composite", WARP, "inpainting", "sketch-guided"),
        "blur": tuple(f"sketch-guided-blur-{sigma:g}" for sigma in _SWEEP),
        "masks": (
            "composite",
            *(f"composite-{each}" for each in MASK_ERRORS),
            WARP,
            *(f"{WARP}-{each}" for each in MASK_ERRORS),
            "sketch-guided",
            *(f"sketch-guided-{each}" for each in MASK_ERRORS),
        ),
        "dual-clock": ("composite", "sketch-guided", DUAL_CLOCK, "sketch-guided-dual-clock"),
        "contact": ("composite", "composite-no-contact"),
        "warp-weight": ("composite", WARP, f"{WARP}-paper-weight", "sketch-guided", "sketch-guided-paper-weight"),
        "interpolation": (
            "composite",
            "composite-interpolated",
            "sketch-guided",
            "sketch-guided-interpolated",
        ),
    }
)
"""Ablations by name, each with the methods that it compares."""


def method_named(name: str) -> Method:
    """A method of ``METHODS``.

    Raises:
        InvalidInputError: there is none of that name.
    """
    if name not in METHODS:
        raise InvalidInputError(
            f"a method without draws and clips must be one of {', '.join(METHODS)}{suggestion(name, METHODS)}."
            f" Got: {name!r}"
        )
    return METHODS[name]
