"""A folder of frames: only what was written there before and not changed since is ever replaced."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.files import recorded_folder
from physanimator.rendering.pictures import check_output, load_image, save_image, write_animation

RECORD = ".physanimator.json"


def clip(count: int, grey: int = 100) -> Iterator[np.ndarray]:
    return (np.full((6, 8, 3), grey + t, np.uint8) for t in range(count))


def names(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir() if entry.name != RECORD)


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


@pytest.fixture
def ours(tmp_path: Path) -> Path:
    write_animation(clip(3), f"{tmp_path}/ours/", 24)
    return tmp_path / "ours"


def test_own_frames_are_replaced_and_other_files_stay(ours: Path) -> None:
    (ours / "notes.txt").write_text("mine")
    (ours / "frame_01.png").write_text("mine, two digits")
    (ours / "sub").mkdir()
    for count in (5, 2):
        write_animation(clip(count, 50), f"{ours}/", 24)
        frames = [f"frame_{t:04d}.png" for t in range(count)]
        assert names(ours) == sorted([*frames, "frame_01.png", "notes.txt", "sub"])
        assert load_image(ours / "frame_0001.png")[0, 0, 0] == 51


def test_an_empty_folder_and_one_of_other_files_are_filled(tmp_path: Path) -> None:
    for name in ("empty", "other"):
        (tmp_path / name).mkdir()
    save_image(tmp_path / "other" / "girl.png", next(clip(1)))
    before = contents(tmp_path / "other")
    for name in ("empty", "other"):
        write_animation(clip(2), f"{tmp_path}/{name}/", 24)
        assert {"frame_0000.png", "frame_0001.png"} <= set(names(tmp_path / name))
    assert before.items() <= contents(tmp_path / "other").items()


def test_a_copied_folder_is_known_again(ours: Path) -> None:
    shutil.copytree(ours, ours.parent / "copied", copy_function=shutil.copyfile)
    write_animation(clip(1), f"{ours.parent}/copied/", 24)
    assert names(ours.parent / "copied") == ["frame_0000.png"]


def retouched(folder: Path) -> None:
    save_image(folder / "frame_0001.png", np.full((6, 8, 3), 7, np.uint8))


def retouched_to_the_same_size(folder: Path) -> None:
    file = folder / "frame_0001.png"
    data = bytearray(file.read_bytes())
    data[-20] ^= 1
    file.write_bytes(data)
    os.utime(file, ns=(1, 1))


def added(folder: Path) -> None:
    save_image(folder / "frame_0007.png", np.full((6, 8, 3), 7, np.uint8))


def added_in_capitals(folder: Path) -> None:
    shutil.copy(folder / "frame_0000.png", folder / "FRAME_0100.PNG")


def without_record(folder: Path) -> None:
    (folder / RECORD).unlink()


def swapped(folder: Path) -> None:
    shutil.copy(folder / "frame_0000.png", folder / "frame_0002.png")


def linked(folder: Path) -> None:
    (folder / "frame_0001.png").rename(folder / "original.png")
    (folder / "frame_0001.png").symlink_to("original.png")


def protected(folder: Path) -> None:
    (folder / "frame_0001.png").chmod(0o444)


def folder_of_that_name(folder: Path) -> None:
    (folder / "frame_0003.png").mkdir()


def with_record(change: Callable[[dict[str, Any]], object]) -> Callable[[Path], None]:
    def apply(folder: Path) -> None:
        record = json.loads((folder / RECORD).read_text())
        changed = change(record)
        (folder / RECORD).write_text(json.dumps(record if changed is None else changed))

    return apply


def record_of_bytes(data: bytes) -> Callable[[Path], None]:
    return lambda folder: (folder / RECORD).write_bytes(data) and None


def record_is_a_pipe(folder: Path) -> None:
    (folder / RECORD).unlink()
    os.mkfifo(folder / RECORD)


def record_is_a_link(folder: Path) -> None:
    (folder / RECORD).rename(folder / "moved.json")
    (folder / RECORD).symlink_to("moved.json")


def first(record: dict[str, Any], **changes: Any) -> None:
    record["frames"][0].update(changes)


FOREIGN: list[Callable[[Path], None]] = [
    retouched,
    retouched_to_the_same_size,
    added,
    added_in_capitals,
    without_record,
    swapped,
    protected,
    folder_of_that_name,
    *([] if os.name == "nt" else [linked, record_is_a_pipe, record_is_a_link]),
    record_of_bytes(b""),
    record_of_bytes(b"\xff\xfe{"),
    record_of_bytes(b"[" * 100_000),
    record_of_bytes(b"[]"),
    record_of_bytes(b'{"format": "physanimator-frames", "version": 1, "frames": 3}'),
    record_of_bytes(b'{"format": "physanimator-frames", "version": 1, "frames": [' + b"9" * 6000 + b"]}"),
    with_record(lambda record: record.update(version=2)),
    with_record(lambda record: record.update(format="other")),
    with_record(lambda record: record["frames"].pop() and None),
    with_record(lambda record: first(record, name=["frame_0000.png"])),
    with_record(lambda record: first(record, size="all")),
    with_record(lambda record: first(record, name="../frame_0000.png")),
]


@pytest.mark.parametrize("change", FOREIGN)
def test_foreign_frames_are_never_touched(ours: Path, change: Callable[[Path], None]) -> None:
    change(ours)
    before = [] if change is record_is_a_pipe else contents(ours)
    listed = sorted(ours.iterdir())
    for call in (lambda: check_output(f"{ours}/"), lambda: write_animation(clip(2), f"{ours}/", 24)):
        with pytest.raises(InvalidInputError, match="choose another folder") as caught:
            call()
        assert "\n" not in str(caught.value)
    assert sorted(ours.iterdir()) == listed
    assert change is record_is_a_pipe or contents(ours) == before


def test_a_record_that_names_files_elsewhere_is_not_obeyed(ours: Path) -> None:
    """Names in it are compared with what is in the folder, never opened or removed."""
    outside = ours.parent / "frame_0000.png"
    save_image(outside, next(clip(1, 9)))
    record = json.loads((ours / RECORD).read_text())
    template = record["frames"][0]
    for name in ("../frame_0000.png", str(outside), "notes.txt", "sub/frame_0000.png"):
        record["frames"].append({**template, "name": name})
    (ours / RECORD).write_text(json.dumps(record))
    (ours / "notes.txt").write_text("mine")
    write_animation(clip(1), f"{ours}/", 24)
    assert load_image(outside)[0, 0, 0] == 9
    assert names(ours) == ["frame_0000.png", "notes.txt"]


def test_frames_that_come_up_during_the_work_are_kept(ours: Path) -> None:
    def frames() -> Iterator[np.ndarray]:
        yield from clip(1)
        added(ours)
        yield from clip(1)

    with pytest.raises(InvalidInputError, match=r"frame_0007\.png"):
        write_animation(frames(), f"{ours}/", 24)
    assert names(ours) == [*(f"frame_000{t}.png" for t in range(3)), "frame_0007.png"]


def test_a_folder_of_a_staging_name_is_not_removed(tmp_path: Path) -> None:
    for name in (".new.partial", "old/.partial"):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "mine.txt").write_text("mine")
    for name in ("new", "old"):
        write_animation(clip(1), f"{tmp_path}/{name}/", 24)
    assert (tmp_path / ".new.partial" / "mine.txt").read_text() == "mine"
    assert (tmp_path / "old" / ".partial" / "mine.txt").read_text() == "mine"


@pytest.mark.parametrize("failing", range(1, 6))
def test_an_error_in_the_middle_of_the_exchange_puts_everything_back(
    ours: Path, monkeypatch: pytest.MonkeyPatch, failing: int
) -> None:
    """As on Windows, where a frame that a viewer shows cannot be moved."""
    before, calls, rename = contents(ours), 0, Path.rename

    def sometimes(self: Path, target: Path) -> Path:
        nonlocal calls
        calls += 1
        if calls == failing:
            raise PermissionError(13, "Permission denied")
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", sometimes)
    with pytest.raises(InvalidInputError, match="open in another program"):
        write_animation(clip(2, 50), f"{ours}/", 24)
    monkeypatch.undo()
    assert contents(ours) == before
    write_animation(clip(2, 50), f"{ours}/", 24)
    assert names(ours) == ["frame_0000.png", "frame_0001.png"]


@pytest.mark.parametrize("stopping", range(1, 6))
def test_after_a_power_cut_old_and_new_are_not_mixed_and_the_folder_is_known(
    ours: Path, monkeypatch: pytest.MonkeyPatch, stopping: int
) -> None:
    class PowerCut(BaseException):
        pass

    calls, rename = 0, Path.rename

    def until(self: Path, target: Path) -> Path:
        nonlocal calls
        calls += 1
        if calls >= stopping:
            raise PowerCut
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", until)
    monkeypatch.setattr(recorded_folder, "_put_back", lambda *_: None)
    with pytest.raises(PowerCut):
        write_animation(clip(2, 50), f"{ours}/", 24)
    monkeypatch.undo()
    left = [load_image(ours / name)[0, 0, 0] for name in names(ours)]
    assert all(value >= 100 for value in left) or all(value < 100 for value in left)
    write_animation(clip(4, 70), f"{ours}/", 24)
    assert names(ours) == [f"frame_000{t}.png" for t in range(4)]


@pytest.mark.skipif(os.name == "nt", reason="links need rights on Windows")
def test_a_link_to_a_folder_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "there").symlink_to("real")
    (tmp_path / "new").symlink_to("made")
    for name, real in (("there", "real"), ("new", "made")):
        for _ in range(2):
            write_animation(clip(2), f"{tmp_path}/{name}/", 24)
        assert (tmp_path / name).is_symlink()
        assert names(tmp_path / real) == ["frame_0000.png", "frame_0001.png"]
