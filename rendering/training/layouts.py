"""The data as other trainers read it.

musubi-tuner: dataset.toml with video_directory, control_directory and captions beside the videos
(its docs/dataset_config.md); for Wan with control, by LoRA.
DiffSynth-Studio: metadata.csv with video, control_video, reference_image and prompt (its
examples/wanvideo/model_training/full/Wan2.2-Fun-A14B-Control.sh, and UnifiedDataset, which reads the file).
VideoX-Fun: metadata_control.json with file_path, control_file_path, text and type (its scripts/wan2.1_fun).
ltx-trainer: dataset.json with video, reference_video and caption (its docs/dataset-preparation.md, "V2V IC-LoRA").
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from ...physics.errors import InvalidInputError, require
from ...physics.progress import Progress
from ..files import check_folder_place, replacing, write_text
from ..pictures import read_clip, save_image
from .data_folder import ClipRecord, clip_file, kept_clips, sketch_file

__all__ = ["LAYOUTS", "export_data"]

_RECORD = "physanimator_export.json"
_LARGEST_RECORD = 1 << 30
_LONGEST_CAPTION = 1 << 16
_LONGEST_TARGET = 81  # frames: what Wan is trained on


@dataclass(frozen=True)
class _Clip:
    """A clip and its text."""

    record: ClipRecord
    caption: str

    @property
    def video(self) -> str:
        return f"videos/{self.record.name}.mp4"

    @property
    def control(self) -> str:
        return f"control/{self.record.name}.mp4"

    @property
    def reference(self) -> str:
        return f"reference/{self.record.name}.png"


def export_data(
    data: Path, output: Path, layout: str, *, caption: str = "animation", progress: Progress | None = None
) -> str:
    """Write the kept clips of a data folder in another trainer's layout.

    Videos are hard links where the disk allows, else copies. An earlier export in the folder is brought up to date,
    unless somebody has edited its texts.

    Args:
        data: the data folder.
        output: the folder to write.
        layout: one of ``LAYOUTS``.
        caption: text of clips that have none of their own in ``DATA/captions/NAME.txt``.
        progress: called after each clip; may raise to stop.

    Returns:
        What to tell the other trainer.

    Raises:
        InvalidInputError: the data is unusable, or the folder holds what we did not write or somebody has edited.
    """
    require("layout", layout, layout in LAYOUTS, f"one of {', '.join(LAYOUTS)}")
    clips = [_Clip(record, _caption(data, record.name, caption)) for record in kept_clips(data)]
    earlier, known = _earlier_files(output)
    files, texts = _files_of(clips, layout), _texts_of(clips, layout, output.absolute())
    output.mkdir(exist_ok=True)
    # What this export may write is told first, so that one that was stopped is known as ours.
    digests = {name: [_digest(text.encode())] for name, text in texts.items()}
    either = {name: [*known.get(name, ()), *digests.get(name, ())] for name in {*known, *digests}}
    _write_record(output, layout, {*earlier, *files}, either)
    for folder in sorted({str(Path(name).parent) for name in files}):
        (output / folder).mkdir(exist_ok=True)
    for number, clip in enumerate(clips, start=1):
        _link(clip_file(data, clip.record.name), output / clip.video)
        _link(sketch_file(data, clip.record.name), output / clip.control)
        if clip.reference in files:
            save_image(output / clip.reference, next(islice(read_clip(clip_file(data, clip.record.name)), 1)))
        if progress is not None:
            progress(number, len(clips))
    for name, text in texts.items():
        write_text(output / name, text)
    for gone in earlier - files:
        (output / gone).unlink(missing_ok=True)
    _write_record(output, layout, files, digests)
    return _hint(layout, output, clips)


def _toml(clips: Sequence[_Clip], output: Path) -> str:
    first = clips[0].record
    sizes = {(each.record.width, each.record.height) for each in clips}
    return "\n".join(
        [
            "# Frames that are trained on together are a multiple of 4 and one, as the autoencoder of Wan needs it.",
            "[general]",
            f"resolution = [{first.width}, {first.height}]",
            'caption_extension = ".txt"',
            "batch_size = 1",
            f"enable_bucket = {'true' if len(sizes) > 1 else 'false'}",
            "bucket_no_upscale = true",
            "",
            "[[datasets]]",
            f"video_directory = {_quoted(output / 'videos')}",
            f"control_directory = {_quoted(output / 'control')}",
            f"cache_directory = {_quoted(output / 'cache')}",
            f"target_frames = [{_target(clips, 4)}]",
            'frame_extraction = "head"',
            "num_repeats = 1",
            "",
        ]
    )


def _csv(clips: Sequence[_Clip], _: Path) -> str:
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["video", "control_video", "reference_image", "prompt"])
    rows.writerows([each.video, each.control, each.reference, each.caption] for each in clips)
    return text.getvalue()


def _videox(clips: Sequence[_Clip], _: Path) -> str:
    return _json(
        [
            {"file_path": each.video, "control_file_path": each.control, "text": each.caption, "type": "video"}
            for each in clips
        ]
    )


def _ltx(clips: Sequence[_Clip], _: Path) -> str:
    return _json([{"caption": each.caption, "video": each.video, "reference_video": each.control} for each in clips])


LAYOUTS: dict[str, tuple[str, Callable[[Sequence[_Clip], Path], str]]] = {
    "musubi": ("dataset.toml", _toml),
    "diffsynth": ("metadata.csv", _csv),
    "videox": ("metadata_control.json", _videox),
    "ltx": ("dataset.json", _ltx),
}
"""Name of the file that describes the clips, and what writes it, by layout."""


def _json(listed: object) -> str:
    return json.dumps(listed, indent=2, ensure_ascii=False) + "\n"


def _quoted(path: Path) -> str:
    """A path as TOML's basic string, which JSON's are as well."""
    return json.dumps(path.as_posix(), ensure_ascii=False)


def _target(clips: Sequence[_Clip], step: int) -> int:
    """The largest count, a multiple of ``step`` and one, that all clips have."""
    fewest = min(each.record.frames for each in clips)
    return (min(fewest, _LONGEST_TARGET) - 1) // step * step + 1


def _files_of(clips: Sequence[_Clip], layout: str) -> set[str]:
    files = {LAYOUTS[layout][0]}
    for each in clips:
        files |= {each.video, each.control}
        files |= {each.reference} if layout == "diffsynth" else set()
        files |= {each.video.removesuffix(".mp4") + ".txt"} if layout == "musubi" else set()
    return files


def _texts_of(clips: Sequence[_Clip], layout: str, output: Path) -> dict[str, str]:
    """Those of the files that people like to edit, by name."""
    name, made = LAYOUTS[layout]
    captions = clips if layout == "musubi" else ()
    return {each.video.removesuffix(".mp4") + ".txt": each.caption + "\n" for each in captions} | {
        name: made(clips, output)
    }


def _caption(data: Path, name: str, usual: str) -> str:
    place = data / "captions" / f"{name}.txt"
    if not place.is_file():
        return usual
    with place.open("rb") as opened:
        content = opened.read(_LONGEST_CAPTION + 1)
    try:
        text = " ".join(content.decode("utf-8-sig").split())
    except UnicodeDecodeError:
        text = ""
    if not text or len(content) > _LONGEST_CAPTION:
        raise InvalidInputError(f"{place} must be a text of at most {_LONGEST_CAPTION} bytes. Got: something else")
    return text


def _earlier_files(output: Path) -> tuple[set[str], dict[str, list[str]]]:
    """What an earlier export wrote into the folder: its files, and what its texts may be, as digests.

    Raises:
        InvalidInputError: there is something of somebody else's, or a text has been edited since.
    """
    check_folder_place(output)
    if not output.is_dir() or not any(output.iterdir()):
        return set(), {}
    place = output / _RECORD
    try:
        with place.open("rb") as opened:
            record = json.loads(opened.read(_LARGEST_RECORD))
        ours = {str(each) for each in record["files"]}
        texts = {str(name): [str(each) for each in digests] for name, digests in record["texts"].items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise InvalidInputError(
            f"output must be a new folder, or one that physanimator dataset export wrote. Got: {output}"
        ) from None
    if any(Path(each).is_absolute() or ".." in Path(each).parts for each in {*ours, *texts}):
        raise InvalidInputError(f"{place} must name files of its own folder. Got: others")
    for name, digests in texts.items():
        if (output / name).is_file() and _digest((output / name).read_bytes()) not in digests:
            raise InvalidInputError(
                "output must hold only what physanimator dataset export wrote; move what you have edited away, or"
                f" export to another folder. Got: {output / name}, which has changed since"
            )
    return ours, texts


def _write_record(output: Path, layout: str, files: set[str], texts: Mapping[str, Sequence[str]]) -> None:
    record = {"layout": layout, "files": sorted(files), "texts": dict(sorted(texts.items()))}
    write_text(output / _RECORD, json.dumps(record, indent=1))


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _link(source: Path, place: Path) -> None:
    with replacing(place) as temporary:
        temporary.unlink()
        try:
            os.link(source, temporary)
        except OSError:  # another disk, or one that knows no links
            shutil.copyfile(source, temporary)


def _hint(layout: str, output: Path, clips: Sequence[_Clip]) -> str:
    record = clips[0].record
    count = f"{len(clips)} clips; "
    if layout == "musubi":
        return f"{count}--dataset_config {output / LAYOUTS[layout][0]}"
    if layout == "diffsynth":
        return count + (
            f"--dataset_base_path {output} --dataset_metadata_path {output / LAYOUTS[layout][0]}"
            ' --data_file_keys "video,control_video,reference_image" --extra_inputs "control_video,reference_image"'
            f" --height {record.height} --width {record.width} --num_frames {_target(clips, 4)}"
        )
    if layout == "videox":
        return count + (
            f"--train_data_dir={output} --train_data_meta={output / LAYOUTS[layout][0]}"
            f" --video_sample_stride=1 --video_sample_n_frames={_target(clips, 4)}"
        )
    frames = _target(clips, 8)
    return count + f'{LAYOUTS[layout][0]} --resolution-buckets "{record.width}x{record.height}x{frames}"'
