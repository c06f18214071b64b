"""The networks and keyframes that a command is told to use: read from its options, and checked before any work."""

from __future__ import annotations

import argparse
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, TypeVar

from .names import named_as, option_of

if TYPE_CHECKING:
    from ...physics.scene import Scene
    from ..neural import NetworkOptions
    from ..options import Timing

__all__ = ["check_keyframes", "check_networks_used", "keyframes_of", "networks_of", "timing_of"]

Settings = TypeVar("Settings")

_YES_OR_NO = {"true": True, "yes": True, "false": False, "no": False}


def networks_of(options: argparse.Namespace) -> NetworkOptions:
    """The networks that a command is told to use.

    Raises:
        InvalidInputError: options do not go together, or a value is unusable; the message names the option.
    """
    from ..neural import NetworkOptions

    given = {each.name: getattr(options, each.name, None) for each in fields(NetworkOptions)}
    told = {name: value for name, value in given.items() if value is not None}
    for name in ("svd_options", "inpainting_options", "tooncrafter_options"):
        if name in told:
            with named_as(option_of(name)):
                told[name] = _settings(getattr(NetworkOptions(), name), told[name])
    return NetworkOptions(**told)


def _settings(usual: Settings, text: str) -> Settings:
    """Settings with some of their values said as ``NAME=VALUE,...``, of which texts may have commas."""
    from ...physics.errors import InvalidInputError

    known = {each.name: getattr(usual, each.name) for each in fields(usual)}  # type: ignore[arg-type]
    texts: dict[str, str] = {}
    last = ""
    for part in text.split(","):
        name, equals, value = (each.strip() for each in part.partition("="))
        if not equals and isinstance(known.get(last), str):
            texts[last] += f",{part}"
            continue
        if not equals or name not in known:
            raise InvalidInputError(f"settings must be NAME=VALUE with {', '.join(known)}. Got: {part[:60]!r}")
        if name in texts:
            raise InvalidInputError(f"settings must each be given once. Got: {name} twice")
        texts[name], last = value, name
    if "follow" in texts:
        usual = usual.following(texts["follow"])  # type: ignore[attr-defined]
    return replace(usual, **{name: _value(name, known[name], said) for name, said in texts.items()})  # type: ignore[type-var]


def _value(name: str, usual: Any, text: str) -> Any:
    """The value of a setting, of the kind that the usual one is."""
    from ...physics.errors import InvalidInputError

    text = text.strip()
    if isinstance(usual, bool):
        if text.lower() not in _YES_OR_NO:
            raise InvalidInputError(f"{name} must be yes or no. Got: {text[:60]!r}")
        return _YES_OR_NO[text.lower()]
    if usual is None and text.lower() == "none":
        return None
    try:
        return _area(text) if name == "area" else type(usual)(text)
    except (ValueError, OverflowError):
        kind = "a number" if isinstance(usual, float) else "a whole number"
        raise InvalidInputError(f"{name} must be {kind}. Got: {text[:60]!r}") from None


def _area(text: str) -> int:
    """An area in px^2, which may be written as a product."""
    area = 1
    for side in text.lower().split("x"):
        area *= int(side)
    return area


def check_networks_used(options: argparse.Namespace) -> None:
    """Refuse networks that would have nothing to do, and files of networks that are not chosen, before any work.

    Raises:
        InvalidInputError: the message names the options.
    """
    from ...physics.errors import InvalidInputError

    networks = networks_of(options)
    if networks.segmenter == "sam" and not options.points:
        raise InvalidInputError("--segmenter sam needs --points, at which it cuts. Got: without")
    if hasattr(options, "interpolate"):
        filled = options.interpolate > 1 or bool(options.keyframes_at)
        if options.interpolate_with is not None and not filled:
            raise InvalidInputError(
                "--interpolate-with needs --interpolate N or --keyframes-at; the paper draws every 15th. Got: neither"
            )
        drawn = options.save_sketch or networks.follows_sketches or networks.sketch_encoder is not None
        if networks.extractor != "gaussians" and not drawn:
            raise InvalidInputError(
                "--extractor informative needs --save-sketch, --renderer svd or --sketch-encoder, for which it draws."
                " Got: none of them"
            )
    for name, choice, kind in (
        ("svd_options", "renderer", "svd"),
        ("still_parts", "renderer", "svd"),
        ("inpainting_options", "renderer", "inpainting"),
        ("tooncrafter_options", "interpolate_with", "tooncrafter"),
        ("lines_size", "extractor", "informative"),
    ):
        if getattr(options, name, None) is not None and getattr(options, choice) != kind:
            raise InvalidInputError(f"{option_of(name)} needs {option_of(choice)} {kind}. Got: without")
    if options.colour_match is not None and not (networks.draws_all or networks.interpolate_with == "tooncrafter"):
        raise InvalidInputError("--colour-match needs --renderer svd or --interpolate-with tooncrafter. Got: without")
    masked = getattr(options, "save_uncovered", None) is not None
    if options.grow is not None and not (masked or networks.renderer == "inpainting"):
        raise InvalidInputError("--grow needs --renderer inpainting or --save-uncovered. Got: without")
    if options.soft_edge is not None and not (masked or networks.draws_opaque):
        raise InvalidInputError("--soft-edge needs --renderer svd or inpainting, or --save-uncovered. Got: without")
    for name in ("device", "dtype"):
        if getattr(options, name) is not None and not networks.uses_networks:
            raise InvalidInputError(f"{option_of(name)} needs a network, such as --renderer svd. Got: none")


def keyframes_of(options: argparse.Namespace) -> tuple[int, ...]:
    """The numbers of ``--keyframes-at``; none without the option.

    Raises:
        InvalidInputError: they are none, or ``--interpolate`` is given as well.
    """
    from ...physics.errors import InvalidInputError

    text = getattr(options, "keyframes_at", None)
    if text is None:
        return ()
    if options.interpolate != 1:
        raise InvalidInputError("--keyframes-at and --interpolate say the same in two ways. Got: both")
    parts = [part.strip() for part in text.split(",")]
    if not all(part.isascii() and part.isdigit() and len(part) < 10 for part in parts):
        raise InvalidInputError(
            f"--keyframes-at must be frame numbers from 0 with commas between them, such as 0,12,15. Got: {text[:60]!r}"
        )
    return tuple(int(part) for part in parts)


def check_keyframes(options: argparse.Namespace, scene: Scene) -> None:
    """Refuse numbers that no frame has, before the simulation.

    Raises:
        InvalidInputError: see above.
    """
    from ..inbetweens import keyframe_indices

    if numbers := keyframes_of(options):
        timing = timing_of(options).settled(scene)
        with named_as("--keyframes-at", "keyframes"):
            keyframe_indices(int(timing.frames or 0) - timing.skip, at=numbers)


def timing_of(options: argparse.Namespace) -> Timing:
    """What was said of the frames' number and rate."""
    from ..options import Timing

    return Timing(frames=options.frames, loop=options.loop, skip=options.skip, frame_rate=options.fps)
