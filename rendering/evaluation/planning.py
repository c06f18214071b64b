"""What an evaluation has to do: everything is checked, and what is there already is told from what is missing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ... import __version__
from ...physics.errors import InvalidInputError
from ..neural.checking import check_networks
from .clip_files import check_clip_place, kept_clip
from .columns import COLUMNS, ColumnWeights
from .drawing import network_options, unusable_for
from .evaluation_set import EvaluationSet, PictureOfSet
from .foreign_clips import check_foreign_clips
from .identity import clip_recipe, digest_of_recipe
from .loaded_pictures import loaded
from .methods import WARP, Method
from .motions import check_motion
from .names import suggestion
from .report_folder import ReportFolder

__all__ = ["IMPOSSIBLE", "Absent", "Cell", "Plan", "column_weights", "left_out", "planned", "restricted"]

IMPOSSIBLE = "impossible"
"""In a clip's measures: why there is no clip."""

_WANTED = {
    "svd": "svd.safetensors (Stable Video Diffusion, image to video, 14 frames)",
    "lvcd": "lvcd.ckpt or lvcd-fp16.safetensors",
    "inpainting": "a folder of Stable Diffusion for inpainting in diffusers' format",
    "tooncrafter": "model.ckpt of ToonCrafter, or its pruned fp16 safetensors",
}


@dataclass(frozen=True)
class Absent:
    """Why a method, or a method's clip of a picture, is left out.

    Attributes:
        method: its name.
        picture: name of the picture; empty for all.
        why: in words.
    """

    method: str
    picture: str
    why: str


def left_out(absent: Sequence[Absent]) -> list[tuple[str, str]]:
    """Who is left out and why, those with one reason together."""
    found: dict[str, dict[str, list[str]]] = {}
    for each in absent:
        found.setdefault(each.why, {}).setdefault(each.method, []).extend([each.picture] * bool(each.picture))
    told = []
    for why, methods in found.items():
        alike: dict[str, list[str]] = {}
        for method, pictures in methods.items():
            alike.setdefault(", ".join(pictures), []).append(method)
        told += [(f"{', '.join(names)}{f' for {where}' if where else ''}", why) for where, names in alike.items()]
    return told


@dataclass(frozen=True)
class Cell:
    """One clip of the evaluation.

    Attributes:
        method, picture, sample: whose.
        key: hash of what it is made from.
        kept: whether the clip is there.
        measured: whether its measures are there, too.
    """

    method: Method
    picture: PictureOfSet
    sample: int
    key: str
    kept: bool
    measured: bool

    @property
    def name(self) -> str:
        """For people."""
        return f"{self.method.name} / {self.picture.name} / sample {self.sample}"


@dataclass(frozen=True)
class Plan:
    """What is evaluated.

    Attributes:
        which: the set.
        folder: of the report.
        cells: all clips, those of one picture and sample one after another.
        absent: what is left out.
        weights_key: hash of the columns and their weights.
    """

    which: EvaluationSet
    folder: ReportFolder
    cells: tuple[Cell, ...]
    absent: tuple[Absent, ...]
    weights_key: str

    @property
    def there(self) -> Plan:
        """What of it is drawn and measured."""
        return replace(self, cells=tuple(each for each in self.cells if each.kept and each.measured))

    @property
    def todo(self) -> tuple[Cell, ...]:
        """What has to be drawn or measured."""
        return tuple(each for each in self.cells if not (each.kept and each.measured))

    @property
    def methods(self) -> tuple[Method, ...]:
        """Those that have clips, in the set's order."""
        used = {each.method.name for each in self.cells}
        return tuple(each for each in self.which.compared if each.name in used)

    def cells_of(self, method: Method) -> tuple[Cell, ...]:
        """The clips of a method."""
        return tuple(each for each in self.cells if each.method == method)

    def method_key(self, method: Method) -> str:
        """Hash of all clips of a method and of the columns."""
        return digest_of_recipe([self.weights_key, *(each.key for each in self.cells_of(method))])


def restricted(which: EvaluationSet, methods: Sequence[str], pictures: Sequence[str]) -> EvaluationSet:
    """The set with some of its methods and pictures only.

    Args:
        which: the set.
        methods: names; none for all.
        pictures: names; none for all.

    Raises:
        InvalidInputError: it has none of such a name.
    """
    for option, wanted, known in (
        ("--method", methods, [each.name for each in which.compared]),
        ("--picture", pictures, [each.name for each in which.pictures]),
    ):
        for name in wanted:
            if name not in known:
                raise InvalidInputError(
                    f"{option} must be one of {', '.join(known)}{suggestion(name, known)}. Got: {name!r}"
                )
    chosen = tuple(each for each in which.compared if not methods or each.name in methods)
    shown = tuple(each for each in which.pictures if not pictures or each.name in pictures)
    return replace(which, methods=chosen, ablations=(), pictures=shown)


def planned(which: EvaluationSet, output: Path, *, opened: bool = False) -> Plan:
    """Check all that can be known before any work, and look at what is there.

    Args:
        which: the set.
        output: folder of the report.
        opened: whether files of weights were opened before.

    Raises:
        InvalidInputError: a file is missing or unusable, or the folder holds what is not ours.
    """
    folder = ReportFolder(output)
    folder.check()
    for picture in which.pictures:
        _check_place(picture)
    absent, usable = _usable(which, opened)
    weights = column_weights(which)
    if not opened:
        weights.check()
    columns = digest_of_recipe([__version__, [each.key for each in COLUMNS], weights.hashes(), which.device])
    cells: list[Cell] = []
    for picture in which.pictures:
        found = _cells(which, folder, picture, usable, columns)
        absent += [each for each in found if isinstance(each, Absent)]
        of_picture = [each for each in found if isinstance(each, Cell)]
        if not opened and any(not (each.kept or each.method.clips) for each in of_picture):
            check_motion(which, picture)
        cells += of_picture
    return Plan(which, folder, tuple(cells), tuple(absent), columns)


def column_weights(which: EvaluationSet) -> ColumnWeights:
    """Where the weights of columns are."""
    return ColumnWeights.of(
        {key: str(place) for key, place in which.weights.named.items()}, Path(), device=which.device
    )


def _check_place(picture: PictureOfSet) -> None:
    for each in picture.files:
        if not Path(each).exists():
            raise InvalidInputError(f"picture {picture.name!r} must name files that are there. Got: no {each}")


def _usable(which: EvaluationSet, opened: bool) -> tuple[list[Absent], list[Method]]:
    """Methods that lack weights, and those that do not, whose files are opened once."""
    absent, usable, seen = [], [], set()
    for method in which.compared:
        if missing := [key for key in method.weights if which.weights.of(key) is None]:
            wanted = " and ".join(f"weights.{key}: {_WANTED.get(key, key)}" for key in missing)
            absent.append(Absent(method.name, "", f"not at hand: {wanted}"))
            continue
        if method.clips:
            check_foreign_clips(which, method)
        elif method.draws != WARP and not opened:
            networks = network_options(which, method, 0)
            told = repr(replace(networks, sketch_blur=0.8, sketch_warp="layered"))
            if networks.uses_networks and told not in seen:
                check_networks(networks)
                seen.add(told)
        usable.append(method)
    return absent, usable


def _cells(
    which: EvaluationSet, folder: ReportFolder, picture: PictureOfSet, methods: Sequence[Method], columns: str
) -> list[Cell | Absent]:
    """The clips of a picture, those of one sample together, and what has none."""
    shown = loaded(picture, which.size)
    why_not = {each.name: unusable_for(each, picture, shown) for each in methods}
    found: list[Cell | Absent] = [Absent(name, picture.name, why) for name, why in why_not.items() if why]
    for sample in range(which.samples):
        for method in methods:
            if not why_not[method.name]:
                found.append(_cell(which, folder, picture, sample, method, columns))
    return found


def _cell(
    which: EvaluationSet, folder: ReportFolder, picture: PictureOfSet, sample: int, method: Method, columns: str
) -> Cell | Absent:
    key = digest_of_recipe(clip_recipe(which, picture, sample, method))
    place = folder.clip(method.name, picture.name, sample)
    check_clip_place(place)
    kept = kept_clip(place, key) is not None
    file = folder.measures(method.name, picture.name, sample)
    folder.check_measures(file)
    values = folder.read_measures(file, f"{key} {columns}")
    if values is not None and IMPOSSIBLE in values:
        return Absent(method.name, picture.name, str(values[IMPOSSIBLE]))
    return Cell(method, picture, sample, key, kept, values is not None)
