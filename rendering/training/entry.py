"""What both training programs have in common: their options, and how they end."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import torch

from ...physics.errors import InvalidInputError, PhysAnimatorError
from ..files import ending_signals, remove_unfinished, write_text
from .loop import Task, train
from .settings import PRESETS, TrainingSettings, as_toml, read_settings

__all__ = ["frozen_precision", "run"]


def run(kind: str, make: Callable[[TrainingSettings], Task], arguments: Sequence[str] | None = None) -> int:
    """Train, as the command line asks.

    Args:
        kind: ``lvcd`` or ``tooncrafter``.
        make: from settings to networks and data.
        arguments: what follows the program's name; the process's own when None.

    Returns:
        The exit status: 0; 1 where the disk is full or the loss is no number; 2 for bad input; 130 for Ctrl+C.
    """
    options = _parser(kind).parse_args(arguments)
    with ending_signals():
        try:
            if options.write_config is not None:
                _check_new(options.write_config)
                write_text(options.write_config, as_toml(PRESETS[options.preset][kind]))
                print(f"{options.write_config}: preset {options.preset}")
                return 0
            if options.config is None:
                raise InvalidInputError("--config must name a TOML file; --write-config writes one. Got: none")
            settings = read_settings(Path(options.config), kind, options.preset)
            last = train(make(settings), settings, resume=options.resume, say=_say)
            _say(f"{last}: {settings.steps} steps")
            return 0
        except KeyboardInterrupt as ended:
            return int(getattr(ended, "status", 130))
        except InvalidInputError as error:
            _warn(str(error))
            return 2
        except PhysAnimatorError as error:
            _warn(str(error))
            return 1
        except OSError as error:
            _warn(f"{error.filename or settings.output}: {error.strerror or error}")
            return 1
        finally:
            remove_unfinished()


def frozen_precision(settings: TrainingSettings) -> torch.dtype:
    """In which what is not trained is kept: that of the computation."""
    return {"no": torch.float32, "fp16": torch.float16, "bf16": torch.bfloat16}[settings.precision]


def _parser(kind: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=f"physanimator.rendering.training.{kind}", description=f"Train the sketch ControlNet of {kind}."
    )
    parser.add_argument("--config", metavar="FILE", help="settings of the run (TOML)")
    parser.add_argument(
        "--write-config", metavar="FILE", help="write the settings of a preset, each explained, and end"
    )
    parser.add_argument(
        "--preset",
        choices=tuple(PRESETS),
        default="paper",
        help="values of settings that the file leaves out: the paper's (8 devices), or those for one card of 24 GB"
        " (default: %(default)s)",
    )
    parser.add_argument(
        "--resume", metavar="WHICH", help="go on from 'latest' or from a checkpoint's folder, exactly where it stopped"
    )
    return parser


def _check_new(path: str) -> None:
    """Refuse to replace settings that somebody may have filled in."""
    if os.path.lexists(path):
        raise InvalidInputError(f"--write-config must name a new file. Got: {path}, which is there already")


def _say(line: str) -> None:
    from accelerate import PartialState

    if PartialState().is_main_process:
        print(line, flush=True)


def _warn(line: str) -> None:
    print(f"physanimator: {line}", file=sys.stderr, flush=True)
