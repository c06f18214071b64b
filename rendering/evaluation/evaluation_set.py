"""What is evaluated: pictures with what moves in them, methods, samples, and files of weights."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import ClassVar

from ...physics.checks import check_number, check_whole
from ...physics.errors import InvalidInputError, require
from ...physics.limits import MAX_BODIES
from .methods import ABLATIONS, METHODS, Method, method_named
from .names import check_different, check_name, suggestion

__all__ = ["EvaluationSet", "PictureOfSet", "Weights"]

MOST_PICTURES = 1000
MOST_METHODS = 200


@dataclass(frozen=True, kw_only=True)
class PictureOfSet:
    """An illustration and what moves in it.

    Attributes:
        name: of its folders.
        image: file of a picture, or of layered artwork.
        masks: files, one for each moving part of a flat picture.
        points: files of query points, one for each further part.
        scene: scene document; without one the parts are held where they are attached, and a gentle wind blows.
        plate: the picture without its parts, where somebody has drawn it.
        in_front: mask of what stands still in front of the parts.
        presets: materials, one for all parts or one for each; the scene's where none is named.
        description: what is seen, as VideoScore is told.
    """

    __pydantic_config__: ClassVar = {"extra": "forbid", "strict": True}

    name: str
    image: str
    masks: tuple[str, ...] = ()
    points: tuple[str, ...] = ()
    scene: str = ""
    plate: str = ""
    in_front: str = ""
    presets: tuple[str, ...] = ()
    description: str = ""

    def __post_init__(self) -> None:
        check_name(self.name)
        count = len(self.masks) + len(self.points)
        require("masks and points", count, count <= MAX_BODIES, f"at most {MAX_BODIES}")
        require(
            "description", f"{len(self.description)} letters", len(self.description) <= 2000, "at most 2000 letters"
        )

    @property
    def files(self) -> tuple[str, ...]:
        """All files that it is made of."""
        named = (self.image, *self.masks, *self.points, self.scene, self.plate, self.in_front)
        return tuple(each for each in named if each)


@dataclass(frozen=True, kw_only=True)
class Weights:
    """Files of weights, by what they are for; empty for those that are not at hand. Nothing is fetched.

    Attributes:
        svd, lvcd, inpainting, tooncrafter, sketch_encoder, image_encoder, text_encoder, lines: as the options of
            ``physanimator animate``.
        inception: of FID, as pytorch-fid has them.
        video_score: folder of VideoScore.
        lpips: of LPIPS.
    """

    __pydantic_config__: ClassVar = {"extra": "forbid", "strict": True}

    svd: str = ""
    lvcd: str = ""
    inpainting: str = ""
    tooncrafter: str = ""
    sketch_encoder: str = ""
    image_encoder: str = ""
    text_encoder: str = ""
    lines: str = ""
    inception: str = ""
    video_score: str = ""
    lpips: str = ""

    def of(self, key: str) -> Path | None:
        """The file that is for something; None where none is named."""
        found = getattr(self, key, "")
        return Path(found) if found else None

    @property
    def named(self) -> dict[str, Path]:
        """All that are named."""
        return {each.name: Path(path) for each in fields(self) if (path := getattr(self, each.name))}


@dataclass(frozen=True, kw_only=True)
class EvaluationSet:
    """What is evaluated. Relative paths in a file are meant from its folder.

    Attributes:
        title: of the report.
        frames: of a clip; a scene that is a loop has its own number.
        rate: frames a second.
        samples: clips of each picture: the first shows the scene as written, others wind and strokes that are stronger
            or weaker and blow elsewhere, and models begin with another noise.
        seed: of all chance.
        size: longest side of flat pictures, to which larger ones are scaled down [px]; 0: as they are.
        device: where networks compute.
        dtype: of networks.
        pictures: what is animated.
        methods: what is compared: in a file names of ``METHODS``, or tables.
        ablations: names of ``ABLATIONS``, whose methods are compared as well.
        weights: files.

    Raises:
        InvalidInputError: a value is out of its range, or names are not different.
    """

    __pydantic_config__: ClassVar = {"extra": "forbid", "strict": True}

    pictures: tuple[PictureOfSet, ...]
    methods: tuple[Method, ...] = ()
    ablations: tuple[str, ...] = ()
    title: str = ""
    frames: int = 48
    rate: float = 24.0
    samples: int = 1
    seed: int = 0
    size: int = 512
    device: str = "auto"
    dtype: str = "auto"
    weights: Weights = Weights()

    def __post_init__(self) -> None:
        check_whole("frames", self.frames, 2, 2000)
        check_number("rate", self.rate, 1, 240, unit=" frames a second")
        check_whole("samples", self.samples, 1, 1000)
        check_whole("seed", self.seed, 0, 2**31 - 1)
        check_whole("size", self.size, 0, 8192, unit=" px")
        require("size", self.size, not 0 < self.size < 32, "0, or 32 to 8192 px")
        require("title", f"{len(self.title)} letters", len(self.title) <= 200, "at most 200 letters")
        _check_count("pictures", len(self.pictures), MOST_PICTURES)
        check_different("pictures", (each.name for each in self.pictures))
        for name in self.ablations:
            near = suggestion(name, ABLATIONS)
            require("ablations", repr(name), name in ABLATIONS, f"among {', '.join(ABLATIONS)}{near}")
        _check_count("methods and ablations", len(self.compared), MOST_METHODS)
        check_different("methods", (each.name for each in self.methods))
        for each in self.methods:
            if (each.draws or each.clips) and each.name in METHODS and each != METHODS[each.name]:
                raise InvalidInputError(f"a method with draws or clips must have a name of its own. Got: {each.name!r}")

    @property
    def compared(self) -> tuple[Method, ...]:
        """All methods, each once, those of ablations last."""
        named = {each.name: each if each.draws or each.clips else method_named(each.name) for each in self.methods}
        for ablation in self.ablations:
            for name in ABLATIONS[ablation]:
                named.setdefault(name, method_named(name))
        return tuple(named.values())


def _check_count(what: str, count: int, most: int) -> None:
    require(what, count, 1 <= count <= most, f"1 to {most}")
