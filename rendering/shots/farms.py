"""The same shots for the schedulers of render farms: shell lines, or an Open Job Description template."""

from __future__ import annotations

import json
import os
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ...physics.errors import require
from .shot import Shot

__all__ = ["command_lines", "openjd_template"]

_MOST_VALUES = 1024  # of one parameter, as the specification has it
_NAME = 128  # letters of a job's


def command_lines(shots: Sequence[Shot], *, listed: str, out: str, program: str = "physanimator") -> str:
    """One shell line a shot, for OpenCue's cuecmd, Flamenco or GNU parallel.

    Args:
        shots: to be done.
        listed: path of their list.
        out: the folder of results.
        program: how the program is called on the machines.
    """
    paths = [os.path.abspath(listed), "--output", os.path.join(os.path.abspath(out), "")]
    return "".join(
        f"{program} {shlex.join(['shots', *paths, '--workers', '0', '--quiet', f'--only={shot.name}'])}\n"
        for shot in shots
    )


def openjd_template(shots: Sequence[Shot], *, listed: str, out: str, template: str) -> str:
    """A job template of Open Job Description 2023-09 with one task a shot; JSON, which is YAML as well.

    The list and the folder of results are parameters of the job, so that a farm may map their paths. Those below the
    template's own folder have a default; others have to be said when the job is submitted.

    Args:
        shots: to be done.
        listed: path of their list.
        out: the folder of results.
        template: where the template will be.

    Raises:
        InvalidInputError: a template cannot have the name of a shot.
    """
    groups = [shots[first : first + _MOST_VALUES] for first in range(0, len(shots), _MOST_VALUES)]
    here = os.path.dirname(os.path.abspath(template))
    pictures = os.path.dirname(os.path.abspath(listed))
    job = {
        "specificationVersion": "jobtemplate-2023-09",
        "name": f"PhysAnimator {os.path.basename(listed)}"[:_NAME],
        "parameterDefinitions": [
            _path("Shots", "the list of shots", os.path.abspath(listed), here, "FILE", "IN"),
            _path("Pictures", "what the list reads is in it", pictures, here, "DIRECTORY", "IN"),
            _path("Output", "where the clips go", os.path.abspath(out), here, "DIRECTORY", "OUT"),
            {"name": "Program", "type": "STRING", "default": "physanimator", "description": "the program"},
        ],
        "steps": [_step(f"Animate{number}" if number else "Animate", group) for number, group in enumerate(groups)],
    }
    return json.dumps(job, indent=2, ensure_ascii=False) + "\n"


def _path(name: str, description: str, path: str, here: str, kind: str, flow: str) -> dict[str, Any]:
    words = {"name": name, "type": "PATH", "objectType": kind, "dataFlow": flow, "description": description}
    place = Path(path)
    if place.is_relative_to(here):
        words["default"] = place.relative_to(here).as_posix()
    return words


def _step(name: str, shots: Sequence[Shot]) -> dict[str, Any]:
    words = ["shots", "{{Param.Shots}}", "--output", "{{Param.Output}}", "--workers", "0", "--only={{Task.Param.Shot}}"]
    names = [shot.name for shot in shots]
    for each in names:
        require("name", each, "{{" not in each, "without {{, which job templates replace")
    values = {"name": "Shot", "type": "STRING", "range": names}
    step: dict[str, Any] = {
        "name": name,
        "parameterSpace": {"taskParameterDefinitions": [values]},
        "script": {"actions": {"onRun": {"command": "{{Param.Program}}", "args": words}}},
    }
    if any(shot.on_gpu for shot in shots):
        step["hostRequirements"] = {"amounts": [{"name": "amount.worker.gpu", "min": 1}]}
    return step
