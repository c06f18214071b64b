"""Ablations as figures: the same place of the same frame by each method, where they differ most."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, counted
from ..figures.contact_sheet import contact_sheet
from ..files import RecordedFiles, check_recorded_folder, write_recorded_folder
from ..pictures import as_uint8, save_image
from ..sketch import WarpMode
from .clip_files import kept_clip
from .evaluation_set import PictureOfSet
from .loaded_pictures import loaded
from .methods import ABLATIONS
from .motions import reference_of
from .planning import Plan
from .results import MethodResult, Results, shown_number

__all__ = ["check_figure", "draw_figure"]

Picture = NDArray[np.uint8]

_CELL = 260  # side of a crop in the figure [px]
_SHARE = 0.42  # of the picture's shorter side that a crop shows
_MOST_PICTURES = 8
_NAMED = ("simulated_flow_error", "static_drift")
_BLANK = 244

_EVERYWHERE = ("blur",)
"""Ablations whose rows differ everywhere in every frame."""

_SKETCHES: dict[str, tuple[tuple[str, WarpMode, float], ...]] = {
    "blur": tuple((f"sketch,\nblur {sigma:g} px", "paper", sigma) for sigma in (0.0, 0.8, 1.5, 3.0)),
    "warp-weight": (("sketch,\nby layers", "layered", 0.0), ("sketch,\npaper's weight", "paper", 0.0)),
}
"""Rows that show what leads a video model, and need none: name, how sketches are warped, and their blur [px]."""


def _present(folder: Path) -> list[str]:
    return [each for name in ABLATIONS if os.path.lexists(folder / (each := f"{name}.png"))]


_FILES = RecordedFiles("figures", ".figures_record.json", "only figures that PhysAnimator wrote", _present)


@dataclass(frozen=True)
class _Row:
    """The frames of one row for a picture, as often as they are asked for."""

    name: str
    frames: Iterable[Picture] | None


def check_figure(plan: Plan, name: str) -> None:
    """Refuse a figure that would show nothing, or lie where somebody else's does.

    Raises:
        InvalidInputError: no method of it can be drawn, or see
            :func:`~physanimator.rendering.files.check_recorded_folder`.
    """
    if not plan.cells and name not in _SKETCHES:
        reasons = "; ".join(dict.fromkeys(f"{each.method}: {each.why}" for each in plan.absent))
        raise InvalidInputError(f"--figure {name} must have methods that can be drawn. Got: none. {reasons}")
    if plan.folder.figures.is_dir():
        check_recorded_folder(plan.folder.figures, _FILES)


def draw_figure(plan: Plan, results: Results, name: str) -> Path:
    """Draw an ablation from the clips that are there.

    Args:
        plan: with the ablation's methods.
        results: of the plan; means over the pictures that are shown stand beside the rows.
        name: of ``ABLATIONS``.

    Returns:
        The picture's file.
    """
    rows, columns = _table(plan, results, name)
    count = len({each.method for each in plan.absent if each.method in ABLATIONS[name] and not each.picture})
    note = f"Not drawn, without weights: {counted(count, 'method')}" if count else ""
    sheet = contact_sheet(
        [pictures for _, pictures in rows],
        title=f"Ablation: {name}",
        note=note,
        columns=columns,
        row_names=[each for each, _ in rows],
    )
    _write(plan.folder.figures, f"{name}.png", sheet)
    return plan.folder.figures / f"{name}.png"


def _write(folder: Path, name: str, sheet: Picture) -> None:
    """Put a figure beside those that are there."""
    others = [each for each in _present(folder) if each != name]

    def write(staging: Path) -> Iterable[str]:
        for each in others:
            shutil.copy2(folder / each, staging / each)
        save_image(staging / name, sheet)
        return [*others, name]

    write_recorded_folder(folder, _FILES, write)


def _table(plan: Plan, results: Results, name: str) -> tuple[list[tuple[str, list[Picture]]], list[str]]:
    """Rows with their names, and names of the columns."""
    by_name = {each.name: each for each in results.rows}
    drawn = [each.name for each in plan.methods if each.name in ABLATIONS[name]]
    sketches = [row for row, _, _ in _SKETCHES.get(name, ())]
    cells: list[list[Picture]] = [[] for _ in ("illustration", *drawn, *sketches)]
    columns, pictures = [], []
    for picture in plan.which.pictures[:_MOST_PICTURES]:
        rows = [_Row(each, _clip(plan, picture, each)) for each in drawn]
        rows += [_Row(row, _Sketch(plan, picture, mode, sigma)) for row, mode, sigma in _SKETCHES.get(name, ())]
        shown = [each for each in rows if each.frames is not None]
        if len(shown) < 2:
            continue
        still = loaded(picture, plan.which.size).flat
        frames, (top, left, side), t = _where_they_differ(
            [each.frames for each in shown],
            still,
            pictures=sum(each.name in drawn for each in shown),
            moved=name in _EVERYWHERE,
        )
        crops = {each.name: frame for each, frame in zip(shown, frames, strict=True)}
        columns.append(f"{picture.name}, frame {t}")
        pictures.append(picture.name)
        for strip, frame in zip(cells, [still, *(crops.get(each.name) for each in rows)], strict=True):
            strip.append(_crop(frame, top, left, side))
    if not columns:
        raise InvalidInputError(f"--figure {name} must have two methods of a picture to compare. Got: fewer")
    named = [_named(by_name.get(each), each, pictures) for each in drawn]
    return list(zip(["illustration", *named, *sketches], cells, strict=True)), columns


def _named(row: MethodResult | None, name: str, pictures: Sequence[str]) -> str:
    """A method's name and what was measured of the pictures that the figure shows."""
    lines, few = [name], ""
    for key in _NAMED:
        known = [] if row is None else [row.of_picture(each, key) for each in pictures]
        values = [each for each in known if each is not None]
        if values:
            lines.append(f"{key.replace('_', ' ')} {shown_number(sum(values) / len(values))}")
            few = f"({len(values)} of {len(pictures)} pictures)" if len(values) < len(pictures) else ""
    return "\n".join([*lines, few] if few else lines)


def _clip(plan: Plan, picture: PictureOfSet, method: str) -> Iterable[Picture] | None:
    cell = next((c for c in plan.cells if (c.method.name, c.picture, c.sample) == (method, picture, 0)), None)
    return None if cell is None else kept_clip(plan.folder.clip(method, picture.name, 0), cell.key)


@dataclass(frozen=True)
class _Sketch:
    """The sketches of a picture's first sample, as pictures."""

    plan: Plan
    picture: PictureOfSet
    mode: WarpMode
    sigma: float

    def __iter__(self) -> Iterator[Picture]:
        animation = reference_of(self.plan.which, self.picture, 0)
        networks = replace(animation.networks, sketch_warp=self.mode, sketch_blur=self.sigma)
        for sketch in replace(animation, networks=networks).sketches():
            yield np.repeat(as_uint8(sketch)[..., None], 3, axis=2)


def _where_they_differ(
    clips: Sequence[Iterable[Picture] | None], still: Picture, *, pictures: int, moved: bool
) -> tuple[list[Picture], tuple[int, int, int], int]:
    """The frames of the moment at which rows differ most, the square where they do so, and the frame's number.

    Pictures, which are the first rows, are compared with pictures, and sketches with sketches. Where rows differ
    everywhere, it is where the last one is farthest from what it showed at first.
    """
    height, width = still.shape[:2]
    side = max(16, min(height, width, round(_SHARE * min(height, width))))
    at_first: Picture | None = None
    best: tuple[float, list[Picture], int, int, int] | None = None
    for t, frames in enumerate(zip(*(each for each in clips if each is not None), strict=False)):
        fitted = [_fitted(each, width, height) for each in frames]
        at_first = fitted[-1] if at_first is None else at_first
        alike = fitted[:pictures], fitted[pictures:]
        pairs = [(fitted[-1], at_first)] if moved else [(each, rows[0]) for rows in alike for each in rows[1:]]
        difference = np.max([cv2.absdiff(*each).max(axis=2) for each in pairs], axis=0)
        summed = cv2.boxFilter(difference.astype(np.float32), -1, (side, side), borderType=cv2.BORDER_CONSTANT)
        _, score, _, (x, y) = cv2.minMaxLoc(summed)
        if best is None or score > best[0]:
            best = score, fitted, x, y, t
    assert best is not None
    _, chosen, x, y, t = best
    top, left = (int(np.clip(v - side // 2, 0, whole - side)) for v, whole in ((y, height), (x, width)))
    return chosen, (top, left, side), t


def _fitted(frame: Picture, width: int, height: int) -> Picture:
    if frame.shape[1::-1] == (width, height):
        return frame
    return cv2.resize(frame, (width, height), interpolation=cv2.INTER_AREA)


def _crop(frame: Any, top: int, left: int, side: int) -> Picture:
    if frame is None:
        return np.full((_CELL, _CELL, 3), _BLANK, np.uint8)
    part = frame[top : top + side, left : left + side]
    return cv2.resize(part, (_CELL, _CELL), interpolation=cv2.INTER_AREA if side > _CELL else cv2.INTER_CUBIC)
