"""Settings of a training run, as one TOML file: what each means stands beside it, in the file and here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from ...physics.checks import check_number, check_whole
from ...physics.errors import InvalidInputError, require
from ..files import parsed_toml, read_text_file

__all__ = ["KINDS", "PRESETS", "TrainingSettings", "as_toml", "read_settings"]

KINDS = ("lvcd", "tooncrafter")
"""What can be trained: the video model's ControlNet, and the interpolation's."""

_LARGEST_FILE = 1 << 20
_PATHS = ("data", "output", "svd", "tooncrafter", "encoder", "start", "image_encoder", "text_encoder")
_PRECISIONS = ("no", "fp16", "bf16")


def _told(default: Any, comment: str) -> Any:
    return field(default=default, metadata={"comment": comment})


@dataclass(frozen=True)
class TrainingSettings:
    """All settings; relative paths are meant from the file's folder.

    Raises:
        InvalidInputError: a value is out of its range; the message names it.
    """

    data: str = _told("", "folder that `physanimator dataset` made")
    output: str = _told("", "folder for checkpoints, samples and logs")
    svd: str = _told("", "lvcd: Stable Video Diffusion, its file or its diffusers folder")
    tooncrafter: str = _told("", "tooncrafter: ToonCrafter's file")
    start: str = _told("", "weights to go on from: LVCD's, ToonCrafter's sketch encoder's, or exported ones")
    encoder: str = _told("", "tooncrafter without start: Stable Diffusion 2.1's file, whose encoder is copied")
    image_encoder: str = _told("", "tooncrafter: the picture encoder, where ToonCrafter's file holds none (samples)")
    text_encoder: str = _told("", "tooncrafter: the text encoder, where ToonCrafter's file holds none (samples)")
    frames: int = _told(0, "frames that are trained on together; 0: 15 of lvcd (a reference and 14), 16 of tooncrafter")
    steps: int = _told(10_000, "steps of the optimizer")
    batch: int = _told(1, "clips at once on each device")
    accumulate: int = _told(32, "batches whose gradients are added up for one step")
    learning_rate: float = _told(1e-5, "of AdamW, after the warm-up")
    warmup: int = _told(0, "steps over which the learning rate rises to its value")
    weight_decay: float = _told(0.01, "of AdamW")
    clip: float = _told(1.0, "largest norm of the gradient; 0: any")
    eight_bit: bool = _told(False, "AdamW with moments of 8 bits (bitsandbytes, on CUDA)")
    ema: float = _told(0.9999, "decay of the moving average of the weights; 0: none is kept")
    precision: str = _told("bf16", "no, fp16 or bf16: of the computation; what is trained stays float32")
    gradient_checkpointing: bool = _told(True, "compute intermediate results twice instead of keeping them")
    least_blur: float = _told(0.0, "weakest blur of the sketches, standard deviation in pixels")
    most_blur: float = _told(3.0, "strongest blur of the sketches; drawn anew for every sample")
    dropped_pictures: float = _told(0.05, "tooncrafter: share of samples that are told of a grey picture, for guidance")
    held_out: float = _told(0.02, "share of the clips that are never trained on; at least one where there are two")
    seed: int = _told(0, "of all chance")
    workers: int = _told(2, "processes that read data")
    checkpoint_every: int = _told(500, "steps between checkpoints")
    keep: int = _told(3, "newest checkpoints that are kept; 0: all")
    sample_every: int = _told(500, "steps between sample clips and measurements on held-out clips; 0: none")
    samples: int = _told(4, "held-out samples that are measured")
    sample_steps: int = _told(25, "sampling steps of a sample clip; 0: measure only")
    licence: str = _told("", "under which the trained weights may be used; goes into exported files")

    def __post_init__(self) -> None:
        for name in (*_PATHS, "precision", "licence"):
            value = getattr(self, name)
            require(name, f"{value!r:.60}", isinstance(value, str), "text")
        for name in ("eight_bit", "gradient_checkpointing"):
            require(name, getattr(self, name), isinstance(getattr(self, name), bool), "true or false")
        require("precision", self.precision, self.precision in _PRECISIONS, f"one of {', '.join(_PRECISIONS)}")
        for name, low, high in (
            ("frames", 0, 1000),
            ("steps", 1, 10**9),
            ("batch", 1, 4096),
            ("accumulate", 1, 65536),
            ("warmup", 0, 10**9),
            ("seed", 0, 2**63 - 1),
            ("workers", 0, 256),
            ("checkpoint_every", 1, 10**9),
            ("keep", 0, 10**6),
            ("sample_every", 0, 10**9),
            ("samples", 1, 10**4),
            ("sample_steps", 0, 1000),
        ):
            check_whole(name, getattr(self, name), low, high)
        require("frames", self.frames, self.frames != 1, "0, or at least 2: a single frame tells nothing of motion")
        check_number("learning_rate", self.learning_rate, 0, 10)
        check_number("weight_decay", self.weight_decay, 0, 10)
        check_number("clip", self.clip, 0)
        check_number("ema", self.ema, 0, 0.999999)
        check_number("least_blur", self.least_blur, 0, 100, unit=" px")
        check_number("most_blur", self.most_blur, self.least_blur, 100, unit=" px")
        check_number("dropped_pictures", self.dropped_pictures, 0, 1)
        check_number("held_out", self.held_out, 0, 0.9)


PRESETS: Mapping[str, Mapping[str, TrainingSettings]] = {
    # 8 devices with 4 clips each and one batch a step make the paper's batch of 32.
    "paper": {
        "lvcd": TrainingSettings(batch=4, accumulate=1, steps=10_000),
        "tooncrafter": TrainingSettings(batch=4, accumulate=1, steps=50_000, clip=0.5),
    },
    "24gb": {
        "lvcd": TrainingSettings(accumulate=32, steps=10_000, eight_bit=True, ema=0.0, frames=15),
        "tooncrafter": TrainingSettings(accumulate=32, steps=50_000, clip=0.5, eight_bit=True, ema=0.0),
    },
}
"""Settings by preset and by what is trained: the paper's (8 devices, 32 clips a step), and those for one card."""


def as_toml(settings: TrainingSettings) -> str:
    """A file with all settings, each with what it means."""
    lines = ["# Settings of a training run. Relative paths are meant from this file's folder."]
    for each in fields(settings):
        lines += ["", f"# {each.metadata['comment']}", f"{each.name} = {_value(getattr(settings, each.name))}"]
    return "\n".join(lines) + "\n"


def read_settings(path: Path, kind: str, preset: str = "paper") -> TrainingSettings:
    """The settings of a file, with a preset's for those that it leaves out.

    Args:
        path: the TOML file.
        kind: one of ``KINDS``.
        preset: a name of ``PRESETS``.

    Returns:
        With absolute paths.

    Raises:
        InvalidInputError: the file is missing, no TOML, or a setting is unknown or unusable.
    """
    require("preset", preset, preset in PRESETS, f"one of {', '.join(PRESETS)}")
    told = parsed_toml(read_text_file(path, "config", most=_LARGEST_FILE), path, "config")
    known = {each.name for each in fields(TrainingSettings)}
    if unknown := sorted(set(told) - known):
        raise InvalidInputError(
            f"config {path} must have no other settings than --write-config lists. Got: {unknown[0]}"
        )
    try:
        settings = replace(PRESETS[preset][kind], **told)
    except InvalidInputError as error:
        raise InvalidInputError(f"config {path}: {error}") from None
    _check_given(settings, kind, path)
    folder = path.absolute().parent
    placed: dict[str, Any] = {name: str(folder / getattr(settings, name)) for name in _PATHS if getattr(settings, name)}
    return replace(settings, **placed)


def _check_given(settings: TrainingSettings, kind: str, path: Path) -> None:
    model = "svd" if kind == "lvcd" else "tooncrafter"
    for name in ("data", "output", model):
        if not getattr(settings, name):
            raise InvalidInputError(f"config {path} must name {name}. Got: nothing")
    if kind == "tooncrafter" and not (settings.start or settings.encoder):
        raise InvalidInputError(f"config {path} must name start or encoder. Got: neither")


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        quoted = value.replace("\\", "\\\\").replace('"', '\\"')
        return f'"{quoted}"'
    return repr(value)
