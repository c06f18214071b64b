"""Checkpoints of a run: written whole or not at all, the newest kept, and read without running code.

OUTPUT/checkpoints/step_00000500/trained.safetensors    weights under their public names
                                 average.safetensors    their moving average, where one is kept
                                 optimizer.pt           moments, and the scale of fp16's gradients
                                 state.json             what is trained, how far, on which data
"""

from __future__ import annotations

import json
import os
import re
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from safetensors import SafetensorError
from safetensors.torch import load_file, save_file
from torch import Tensor

from ...physics.errors import InvalidInputError

__all__ = ["Checkpoint", "find_checkpoint", "read_checkpoint_folder", "write_checkpoint"]

_NAME = re.compile(r"step_(\d{8,})")
_LARGEST_STATE = 1 << 20


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """All that a run goes on from.

    Attributes:
        state: what is trained (``kind``), ``step``, settings and data, as JSON holds them.
        trained: weights by their public names.
        average: their moving average; empty where none is kept.
        optimizer: of the optimizer (and of fp16's scale).
    """

    state: Mapping[str, Any]
    trained: Mapping[str, Tensor]
    average: Mapping[str, Tensor]
    optimizer: Mapping[str, Any]


def write_checkpoint(output: Path, checkpoint: Checkpoint, *, keep: int = 0) -> Path:
    """Write a checkpoint, and then remove the oldest ones.

    Args:
        output: the run's folder.
        checkpoint: what to write.
        keep: how many to keep; 0 keeps all.

    Returns:
        Its folder.

    Raises:
        OSError: the disk is full or the like; earlier checkpoints are as they were, and nothing half done stays.
    """
    folder = output / "checkpoints"
    folder.mkdir(parents=True, exist_ok=True)
    place = folder / f"step_{checkpoint.state['step']:08d}"
    unfinished = folder / f".{place.name}.unfinished"
    shutil.rmtree(unfinished, ignore_errors=True)
    try:
        unfinished.mkdir()
        _save(unfinished / "trained.safetensors", checkpoint.trained)
        if checkpoint.average:
            _save(unfinished / "average.safetensors", checkpoint.average)
        torch.save(dict(checkpoint.optimizer), unfinished / "optimizer.pt")
        (unfinished / "state.json").write_text(json.dumps(dict(checkpoint.state), indent=2), encoding="utf-8")
        _put(unfinished, place)
    except BaseException as error:
        shutil.rmtree(unfinished, ignore_errors=True)
        if isinstance(error, SafetensorError | RuntimeError):  # how these writers say that the disk is full
            raise OSError(28, f"the checkpoint cannot be written: {error}", str(place)) from error
        raise
    if keep:
        for old in _all(output)[:-keep]:
            shutil.rmtree(old, ignore_errors=True)
    return place


def find_checkpoint(output: Path, asked: str) -> Path | None:
    """The checkpoint to go on from.

    Args:
        output: the run's folder.
        asked: ``latest``, or a checkpoint's folder.

    Returns:
        None where there is none yet and the latest is asked for.

    Raises:
        InvalidInputError: the folder is no checkpoint.
    """
    if asked == "latest":
        found = _all(output)
        return found[-1] if found else None
    place = Path(asked)
    if not (place / "state.json").is_file():
        raise InvalidInputError(f"resume must be 'latest' or a checkpoint's folder. Got: {asked}")
    return place


def read_checkpoint_folder(place: Path) -> Checkpoint:
    """Read a checkpoint; its optimizer's file as data only.

    Raises:
        InvalidInputError: something is missing or damaged.
    """
    try:
        with (place / "state.json").open("rb") as opened:
            state = json.loads(opened.read(_LARGEST_STATE))
        if not isinstance(state, dict) or not isinstance(state.get("step"), int):
            raise ValueError("state.json tells no step")
        average = place / "average.safetensors"
        return Checkpoint(
            state,
            load_file(place / "trained.safetensors"),
            load_file(average) if average.is_file() else {},
            torch.load(place / "optimizer.pt", map_location="cpu", weights_only=True),
        )
    except Exception as error:  # a damaged file makes the readers of zip files and pickles raise nearly anything
        raise InvalidInputError(f"{place} must be a whole checkpoint of a training. Got: {error}") from error


def _all(output: Path) -> list[Path]:
    folder = output / "checkpoints"
    found = [each for each in folder.glob("step_*") if _NAME.fullmatch(each.name) and (each / "state.json").is_file()]
    return sorted(found, key=lambda each: int(each.name.removeprefix("step_")))


def _save(file: Path, tensors: Mapping[str, Tensor]) -> None:
    save_file({name: tensor.detach().cpu().contiguous() for name, tensor in tensors.items()}, file)


def _put(unfinished: Path, place: Path) -> None:
    """Let the finished folder take its place, also where an earlier one of the same step is."""
    earlier = place.with_name(f".{place.name}.earlier")
    shutil.rmtree(earlier, ignore_errors=True)
    if place.exists():
        os.replace(place, earlier)
    os.replace(unfinished, place)
    shutil.rmtree(earlier, ignore_errors=True)
