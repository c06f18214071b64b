"""The shots of a list, each checked as ``animate`` checks its command, before any of them begins."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ...physics.errors import InvalidInputError, PhysAnimatorError
from ..shots import ENDING, OptionNames, Problem, Shot, ShotRow, Word, colliding_outputs, read_rows, shot_name, words_of
from .files import INPUTS, MODELS, OUTPUTS
from .names import named_by_options, option_of
from .shot_task import shot_parser

__all__ = ["ReadList", "check_shot", "read_list"]

_NO_OPTIONS = ("help", "quiet", "verbose")
_NO_SETTINGS = (*_NO_OPTIONS, "command", "run", "image_after", *INPUTS, *OUTPUTS)


@dataclass(frozen=True)
class ReadList:
    """A list as it was read.

    Attributes:
        shots: all that can be told of.
        problems: what is wrong.
    """

    shots: tuple[Shot, ...]
    problems: tuple[Problem, ...]


def read_list(path: str, out: str, *, also_written: Sequence[tuple[str, str]] = ()) -> ReadList:
    """The shots of a list, with what of it no command could be.

    Args:
        path: of the list.
        out: the folder where results go that say nothing else.
        also_written: options and files that the command writes besides.

    Raises:
        InvalidInputError: the list cannot be read.
    """
    from ..pictures import is_frame_name

    rows, problems = read_rows(path)
    parser = shot_parser()
    actions = {each.dest: each for each in parser._actions if each.dest not in _NO_OPTIONS}
    names = OptionNames(actions, INPUTS, MODELS, OUTPUTS)
    folder, out = os.path.dirname(os.path.abspath(path)), os.path.abspath(out)
    shots: list[Shot] = []
    named: set[str] = set()
    for row in rows:
        try:
            name = shot_name(row)
        except InvalidInputError as error:
            problems.append(Problem(str(error), str(row.number), "name", row.lines.get("name", row.line)))
            continue
        if name.casefold() in named:
            told = f"name must be unlike that of any other shot. Got: {name} again; say name where pictures are alike"
            problems.append(Problem(told, name, "name", row.lines.get("name", row.line)))
            continue
        named.add(name.casefold())
        words, wrong = words_of(row, name, names, folder=folder, out=out)
        options, refused = _parsed(parser, row, name, words, wrong)
        problems += [*wrong, *refused]
        if options is not None and not wrong:
            shots.append(replace(_shot(row, name, words, options), listed=os.path.basename(path)))
    problems += colliding_outputs(
        shots, also_read=[os.path.abspath(path)], also_written=also_written, is_frame=is_frame_name
    )
    return ReadList(tuple(shots), tuple(problems))


def _parsed(
    parser: argparse.ArgumentParser, row: ShotRow, name: str, words: Sequence[Word], wrong: Sequence[Problem]
) -> tuple[argparse.Namespace | None, list[Problem]]:
    """The options of a shot; or each that the parser refuses."""
    try:
        return parser.parse_args([each.spelled() for each in words]), []
    except InvalidInputError as error:
        whole = str(error)
    problems = []
    for option in dict.fromkeys(each.option for each in words):
        needed = [each.spelled() for each in words if each.option in ("image", "output", option)]
        try:
            parser.parse_args(needed if any(each.option == "image" for each in words) else ["IMAGE", *needed])
        except InvalidInputError as error:
            told = str(error).replace(f"--{option.replace('_', '-')} must", f"{option.replace('_', '-')} must")
            problems.append(Problem(told, name, option.replace("_", "-"), row.lines.get(option, row.line)))
    if "image" not in {each.option for each in words} | {each.option for each in wrong}:
        problems.append(Problem("image must be given, the illustration. Got: none", name, "image", row.line))
    return None, problems if problems or wrong else [Problem(whole, name, line=row.line)]


def _shot(row: ShotRow, name: str, words: Sequence[Word], options: argparse.Namespace) -> Shot:
    settings = {key: value for key, value in vars(options).items() if key not in _NO_SETTINGS and value is not None}
    record = options.output.rstrip("/\\" if os.name == "nt" else "/") + ENDING
    return Shot(name, tuple(words), settings, record, row.line, row.lines, _on_gpu(options), _frames(options))


def _frames(options: argparse.Namespace) -> int:
    """How many frames options tell of; a scene's own loop is not looked at."""
    from ..options import DEFAULT_FRAME_RATE, DEFAULT_FRAMES

    if options.frames is not None or options.loop is None:
        return options.frames if options.frames is not None else DEFAULT_FRAMES
    return int(min(options.loop * (options.fps or DEFAULT_FRAME_RATE), 1e9)) if options.loop > 0 else 0


def _on_gpu(options: argparse.Namespace) -> bool:
    """Whether networks draw on a graphics card."""
    from .networks import networks_of

    try:
        return networks_of(options).uses_networks and options.device != "cpu"
    except PhysAnimatorError:  # told by the checks
        return False


def check_shot(shot: Shot, moving: dict[str, int] | None = None) -> list[Problem]:
    """All that ``animate`` would refuse before it simulates, and what can be seen of the rest.

    Args:
        shot: to be checked.
        moving: gets how many pixels move by the shot's name, where its masks tell.
    """
    from ..files import check_replaceable
    from .messages import gathered

    options = shot_parser().parse_args([*shot.command(), "--quiet"])
    with gathered():
        area: list[int] = []
        told = _missing(shot) or _refused(options, area) or _told(lambda _: check_replaceable(shot.record), options)
    if moving is not None and area:
        moving[shot.name] = area[0]
    return [_problem(shot, each) for each in told]


def _problem(shot: Shot, told: str) -> Problem:
    """A refusal of ``animate`` with the line of the option that it begins with."""
    head = told.split(maxsplit=1)[0].rstrip(":")
    option = head.lower().lstrip("-").replace("-", "_")
    return Problem(told, shot.name, line=shot.lines.get(option, shot.line))


def _missing(shot: Shot) -> list[str]:
    return [
        f"{option_of(word.option)} must be a file that is there. Got: {word.text}"
        for word in (*shot.paths("input"), *shot.paths("model"))
        if not os.path.exists(word.text or "") and word.option != "collider"
    ]


def _refused(options: argparse.Namespace, area: list[int]) -> list[str]:
    """What single checks refuse; the pictures are only read where nothing else is wrong, and then ``area`` gets how
    many pixels move.
    """
    from .inputs import check_inputs
    from .networks import check_networks_used, keyframes_of, timing_of
    from .outputs import check_outputs
    from .physics_options import physics_of

    checks: tuple[Callable[[argparse.Namespace], Any], ...] = (
        check_inputs,
        check_outputs,
        check_networks_used,
        keyframes_of,
        timing_of,
        physics_of,
    )
    found = [told for check in checks for told in _told(check, options)]
    return list(dict.fromkeys(found or _told(lambda _: area.append(_read_all(options)), options)))


def _told(check: Callable[[argparse.Namespace], Any], options: argparse.Namespace) -> list[str]:
    from .failures import failure_of

    try:
        with named_by_options(options):
            check(options)
    except Exception as error:
        failure = failure_of(error)
        if failure is None:
            raise
        return [failure.message]
    return []


def _read_all(options: argparse.Namespace) -> int:
    """Read all inputs, and try the values that are otherwise first looked at when the parts have meshes.

    Returns:
        How many pixels move, as masks tell; 0 without any.
    """
    import numpy as np

    from ...physics.assembly import work_of_minutes
    from ...physics.document import check_document
    from .animating import checked_inputs, picture_of_inputs
    from .inputs import read_plate
    from .outputs import background_for

    image, inputs = checked_inputs(options)
    read_plate(options)
    background_for(options, picture_of_inputs(image))
    work_of_minutes(options.max_minutes)
    if inputs["scene"] is not None:
        check_document(inputs["scene"])
    _rehearse(options, inputs)
    return sum(int(np.count_nonzero(mask)) for mask in inputs["masks"])


def _rehearse(options: argparse.Namespace, inputs: Mapping[str, Any]) -> None:
    """Make the automatic scene of a square in the place of every part."""
    import numpy as np

    from ...physics.document import materials_of
    from ...physics.mesh import mesh_from_mask
    from ...physics.scene import Body, automatic_scene

    presets = inputs["preset"] or ["hair"]
    count = len(inputs["masks"]) + len(inputs["points"]) or len(presets)
    materials = materials_of(presets, options.sway, count)
    if inputs["scene"] is not None:
        return
    square = mesh_from_mask(np.pad(np.ones((24, 24)), 4), spacing=min(options.spacing or 8.0, 8.0))
    wind = inputs["wind"]
    scene = automatic_scene(
        [Body(square, material) for material in materials],
        frame_rate=options.fps or 24.0,
        wind_strength=wind.strength,
        wind_angle=wind.angle,
        turbulence=wind.turbulence,
    )
    scene = inputs["physics"].applied(scene, sway=options.sway)
    replace(scene, loop=options.loop)
