"""What errors call the values of a command: by the options that they were given with, not by the library's names."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from ...physics.errors import InvalidInputError, SceneError

__all__ = ["named_as", "named_by_options", "option_of", "parts_in_options"]

_OPTIONS = {
    "every": "--interpolate",
    "frame_rate": "--fps",
    "damping": "--damping",
    "density": "--density",
    "image": "IMAGE",
    "in_front": "--in-front",
    "lambda": "--lambda",
    "max_minutes": "--max-minutes",
    "mu": "--mu",
    "poisson_ratio": "--poisson-ratio",
    "root_stiffness": "--root-stiffness",
    "stretch_limit": "--stretch-limit",
    "strokes_as": "--strokes-as",
    "sway_frequency": "--sway",
    "time_step": "--time-step",
    "wind_angle": "--wind-angle",
    "wind_response": "--wind-response",
    "wind_strength": "--wind",
    "youngs_modulus": "--youngs-modulus",
} | {name: f"--{name}" for name in ("attach", "background", "frames", "loop", "plate", "preset", "skip", "spacing")}
_OPTIONS |= {"turbulence": "--turbulence", "width": "--width"}
_FILES = ("svd", "lvcd", "inpainting", "tooncrafter", "sketch_encoder", "image_encoder", "text_encoder", "lines", "sam")
_CHOICES = ("renderer", "interpolate_with", "extractor", "segmenter")
_OPTIONS |= {
    name: f"--{name.replace('_', '-')}"
    for name in (
        *_FILES,
        *_CHOICES,
        "device",
        "dtype",
        "grow",
        "soft_edge",
        "colour_match",
        "lines_size",
        "keyframes_at",
    )
}
_OPTIONS["keyframes"] = "--keyframes-at"
_LISTS = {"masks": ("mask", "--mask"), "colliders": ("collider", "--collider"), "points": ("points", "--points")}

_ITEM = re.compile(r"(masks|colliders|points)\[(\d+)\](?=:| must)")
_POINT = re.compile(r"points(\[\d+\])? must ")  # one of the points of a file, not one of the files
_BODY = re.compile(r"bodies\[(\d+)\]")
_FILE = re.compile(rf"({'|'.join(_FILES)}|inpainting_options)(?=: )")
_HEAD = re.compile(r"(?P<before>|.*?: )(?P<name>[a-z_]+)(?= must )", re.DOTALL)
_REMEDIES = (
    ("max_minutes", re.compile(r"\bset max_minutes\b"), "set --max-minutes"),
    ("spacing", re.compile(r"\ba (larger|smaller) spacing\b"), r"a \1 --spacing"),
    *((name, re.compile(rf"\b(where|unless) {name} is\b"), rf"\1 {_OPTIONS[name]} is") for name in _CHOICES),
    ("svd_options", re.compile(r"\bsvd_options have\b"), "--svd-options have"),
    ("sway", re.compile(r"\ba lower sway_frequency\b"), "a lower --sway"),
)


def option_of(name: str) -> str:
    """An option as a person writes it, from what the parser calls it."""
    return name.upper() if name in ("image", "file") else "--" + name.replace("_", "-")


@contextmanager
def named_as(option: str, *names: str) -> Iterator[None]:
    """Let an error about one option's value name that option.

    Args:
        option: as a person writes it.
        names: what the library calls the value; the first word of its sentences.
    """
    try:
        yield
    except InvalidInputError as error:
        text = str(error)
        if text.startswith("--"):  # it tells already
            raise
        name = next((each for each in names if text.startswith(f"{each} ")), None)
        said = f"{option}: {text}" if name is None else option + text[len(name) :]
        raise InvalidInputError(said) from error


@contextmanager
def named_by_options(options: argparse.Namespace) -> Iterator[None]:
    """Let errors about the parameters of the library name the command's options."""
    try:
        yield
    except SceneError as error:
        scene = getattr(options, "scene", None)
        if scene is None:
            raise
        raise InvalidInputError(f"--scene {scene}: {error}") from error
    except InvalidInputError as error:
        raise InvalidInputError(_in_options(str(error), options)) from error


def _in_options(text: str, options: argparse.Namespace) -> str:
    if found := _FILE.match(text):
        text = option_of(found[1]) + text[found.end() :]
    elif _POINT.match(text) and len(clicked := _given(options, "points")) == 1:
        text = f"--points {clicked[0]}: {text}"
    elif found := _ITEM.match(text):
        attribute, option = _LISTS[found[1]]
        given = _given(options, attribute)
        if int(found[2]) < len(given):
            text = f"{option} {given[int(found[2])]}{text[found.end() :]}"
    elif text.startswith("mask must ") and len(parts := _parts(options)) == 1:
        text = f"{parts[0]}: {text}"
    elif text.startswith("masks must "):
        text = ("--mask" if _given(options, "mask") else "--points") + text[len("masks") :]
    if (found := _HEAD.match(text)) and hasattr(options, _attribute(option := _OPTIONS.get(found["name"], ""))):
        text = found["before"] + option + text[found.end() :]
    for attribute, pattern, replacement in _REMEDIES:
        # What a scene file says is lowered there, unless the option is in its place.
        if hasattr(options, attribute) and not (attribute == "sway" and options.scene and options.sway is None):
            text = pattern.sub(replacement, text)
    return text


def parts_in_options(text: str, options: argparse.Namespace) -> str:
    """A sentence about a body, with the option that its part was given by in the body's place."""
    parts, found = _parts(options), _BODY.match(text)
    if found is None or int(found[1]) >= len(parts):
        return text
    return parts[int(found[1])] + text[found.end() :]


def _parts(options: argparse.Namespace) -> list[str]:
    """The options that moving parts are given by."""
    return [f"--{name} {path}" for name in ("mask", "points") for path in _given(options, name)]


def _given(options: argparse.Namespace, name: str) -> Sequence[str]:
    """The paths of an option that may be repeated; none where the command does not have it."""
    return getattr(options, name, None) or ()


def _attribute(option: str) -> str:
    return option.lower().lstrip("-").replace("-", "_") or "-"
