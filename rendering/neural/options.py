"""Which networks stand in for what needs none, and the files of their weights."""

from __future__ import annotations

import os
from dataclasses import dataclass

from ...physics.checks import check_number, check_whole, require_kind
from ...physics.errors import InvalidInputError, require
from ..inpainting import InpaintingOptions
from ..sketch import WARP_MODES, WarpMode
from ..svd import SVDOptions
from ..tooncrafter import ToonCrafterOptions

__all__ = ["CHOICES", "DTYPES", "FILES", "NetworkOptions", "StrPath"]

CHOICES = {
    "renderer": ("composite", "svd", "inpainting"),
    "interpolate_with": ("motion", "flow", "blend", "tooncrafter"),
    "extractor": ("gaussians", "informative"),
    "segmenter": ("grabcut", "sam"),
}
"""What can be chosen, first what is usual."""

FILES = {
    "svd": ("renderer", "svd", True),
    "lvcd": ("renderer", "svd", True),
    "inpainting": ("renderer", "inpainting", True),
    "tooncrafter": ("interpolate_with", "tooncrafter", True),
    "sketch_encoder": ("interpolate_with", "tooncrafter", False),
    "image_encoder": ("interpolate_with", "tooncrafter", False),
    "text_encoder": ("interpolate_with", "tooncrafter", False),
    "lines": ("extractor", "informative", True),
    "sam": ("segmenter", "sam", True),
}
"""For each file the choice and its network that it belongs to, and whether that cannot do without it."""

DTYPES = ("auto", "fp32", "fp16", "bf16")

StrPath = str | os.PathLike[str]

_USUAL_SVD, _USUAL_INPAINTING, _USUAL_TOONCRAFTER = SVDOptions(), InpaintingOptions(), ToonCrafterOptions()
_SOFT_EDGES = {"svd": 24.0, "inpainting": 16.0}


@dataclass(frozen=True, kw_only=True)
class NetworkOptions:
    """Networks, each beside what is used without it. Weights are files that the user has; nothing is fetched.

    Attributes:
        renderer: "composite" moves the illustration's own pixels; "svd" has Stable Video Diffusion draw every frame,
            after sketches, the paper's way, or after composite's frames, as ``svd_options`` say; "inpainting" is
            composite with what the parts have uncovered painted by Stable Diffusion, the paper's ablation, for flat
            pictures without a clean plate.
        svd: Stable Video Diffusion, image to video, 14 frames: svd.safetensors, or the folder of its diffusers version.
        lvcd: lvcd.ckpt or lvcd-fp16.safetensors; only where frames follow sketches.
        svd_options: settings of the renderer.
        still_parts: take what no part ever covers from the illustration, as video models repaint all of it.
        inpainting: Stable Diffusion 1 or 2, best one for inpainting, as a diffusers folder.
        inpainting_options: settings of the painting.
        grow: with inpainting, how far holes reach beyond what parts have uncovered [px].
        soft_edge: width of the transition to still parts, or around holes [px]; None for 24 with svd and 16 with
            inpainting.
        interpolate_with: who draws in-betweens: "motion", "flow", "blend", or "tooncrafter", the paper's way.
        tooncrafter: model.ckpt, or its pruned fp16 safetensors.
        sketch_encoder: sketch_encoder.ckpt, with which sketches lead the in-betweens; without it nothing does.
        image_encoder: CLIP-ViT-H-14's picture encoder; needed with the pruned file, which has none.
        text_encoder: Stable Diffusion 2.1's text encoder; needed once with the pruned file, beside which the embedding
            of no words is then kept.
        tooncrafter_options: settings of the in-betweens.
        extractor: "gaussians" finds lines without a network; "informative" is a network that draws them, informative
            drawings or Anime2Sketch.
        lines: sk_model.pth, sk_model2.pth or netG.pth.
        lines_size: longer side of the picture that the line network looks at [px]; 0: as the picture is.
        segmenter: "grabcut" cuts parts out at points by colours and lines; "sam" is a Segment Anything network.
        sam: folder with config.json and .safetensors (SAM, SAM-HQ, SAM 2, EdgeTAM, SAM 3), or SAM's own .pth file.
        device: "auto", or what torch calls it, such as "cpu", "cuda", "cuda:1" or "mps".
        dtype: of weights and computing: "fp32", "fp16", "bf16"; "auto" takes fp16 on a GPU of NVIDIA or AMD and fp32
            elsewhere, and fp32 for Segment Anything everywhere.
        sketch_blur: standard deviation of the blur of sketches that lead video models [px].
        sketch_warp: how those are bent along the motion, one of ``WARP_MODES`` of ``rendering.sketch``.
        close_loop: of a loop, have svd draw the last frames between the end and the beginning, and fill in frames
            between the last keyframe and the first, so that no jump is seen where the loop begins again.
        colour_match: share of the colour drift of svd and tooncrafter that is taken out, 0..1: frames get the colours
            of composite outside holes, in-betweens those of their keyframes.

    Raises:
        InvalidInputError: there is no such choice, a file is missing for it, or one is given that nothing would read.

    Examples:
        >>> from physanimator.rendering.neural import NetworkOptions
        >>> from physanimator.rendering.svd import SVDOptions
        >>> options = NetworkOptions(
        ...     renderer="svd", svd="svd.safetensors", lvcd="lvcd.ckpt", svd_options=SVDOptions(steps=12)
        ... )
        >>> options.draws_all, options.svd_options.seed
        (True, 0)
        >>> options = NetworkOptions(
        ...     renderer="svd", svd="svd.safetensors", svd_options=SVDOptions.following("animation")
        ... )
        >>> options.follows_sketches
        False
    """

    renderer: str = "composite"
    svd: StrPath | None = None
    lvcd: StrPath | None = None
    svd_options: SVDOptions = _USUAL_SVD
    still_parts: bool = True
    inpainting: StrPath | None = None
    inpainting_options: InpaintingOptions = _USUAL_INPAINTING
    grow: float = 4.0
    soft_edge: float | None = None
    interpolate_with: str = "motion"
    tooncrafter: StrPath | None = None
    sketch_encoder: StrPath | None = None
    image_encoder: StrPath | None = None
    text_encoder: StrPath | None = None
    tooncrafter_options: ToonCrafterOptions = _USUAL_TOONCRAFTER
    extractor: str = "gaussians"
    lines: StrPath | None = None
    lines_size: int = 0
    segmenter: str = "grabcut"
    sam: StrPath | None = None
    device: str = "auto"
    dtype: str = "auto"
    sketch_blur: float = 0.8
    sketch_warp: WarpMode = "layered"
    close_loop: bool = True
    colour_match: float = 1.0

    def __post_init__(self) -> None:
        for name, choices in CHOICES.items():
            require(name, repr(getattr(self, name)), getattr(self, name) in choices, f"one of {', '.join(choices)}")
        for name, (choice, network, needed) in FILES.items():
            file = getattr(self, name)
            require_kind(name, file, (str, os.PathLike, type(None)), "the path of a file")
            chosen = getattr(self, choice) == network
            if file is None and chosen and needed and name != "lvcd":
                kind = "folder" if name == "inpainting" else "file"
                raise InvalidInputError(f"{name} must be a {kind} where {choice} is {network}. Got: none")
            if file is not None and not chosen:
                raise InvalidInputError(
                    f"{name} must be left out unless {choice} is {network}. Got: {os.fspath(file)[:80]}"
                )
        self._check_lvcd()
        require("dtype", repr(self.dtype), self.dtype in DTYPES, f"one of {', '.join(DTYPES)}")
        check_number("grow", self.grow, 0, 1000, unit=" px")
        check_number("soft_edge", self.edge_width, 0, 1000 if self.renderer == "inpainting" else 10_000, unit=" px")
        check_number("sketch_blur", self.sketch_blur, 0, 100, unit=" px")
        check_number("colour_match", self.colour_match, 0, 1)
        modes = ", ".join(WARP_MODES)
        require("sketch_warp", repr(self.sketch_warp), self.sketch_warp in WARP_MODES, f"one of {modes}")
        if self.lines_size:
            check_whole("lines_size", self.lines_size, 16, 16384, unit=" px")

    def _check_lvcd(self) -> None:
        where = "where renderer is svd"
        if self.follows_sketches:
            without = f"{where}, unless svd_options have follow=animation"
            require("lvcd", "none", self.lvcd is not None, f"a file {without}")
        elif self.draws_all:
            got = str(self.lvcd)[:80]
            require("lvcd", got, self.lvcd is None, f"left out {where} and svd_options have follow=animation")

    @property
    def draws_all(self) -> bool:
        """Whether a video model draws whole frames."""
        return self.renderer == "svd"

    @property
    def follows_sketches(self) -> bool:
        """Whether it draws them after sketches."""
        return self.draws_all and self.svd_options.follows_sketches

    @property
    def follows_animation(self) -> bool:
        """Whether it draws them after composite's frames."""
        return self.draws_all and self.svd_options.follows_animation

    @property
    def draws_opaque(self) -> bool:
        """Whether a model draws frames, or paints in them: they are opaque then."""
        return self.renderer != "composite"

    @property
    def edge_width(self) -> float:
        """The soft edge, as said or as usual with the renderer [px]."""
        return _SOFT_EDGES.get(self.renderer, 0.0) if self.soft_edge is None else self.soft_edge

    @property
    def uses_networks(self) -> bool:
        """Whether any network is chosen."""
        return any(getattr(self, choice) == network for choice, network, _ in FILES.values())
