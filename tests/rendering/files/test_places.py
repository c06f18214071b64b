"""Places that cannot be written to are found out beforehand, alike for every kind of result."""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError, printable
from physanimator.rendering.files import check_text_output, made_beside, remove_unfinished, replacing, write_text
from physanimator.rendering.files.path_names import check_windows_name
from physanimator.rendering.pictures import check_image_output, check_output, load_image, save_image, write_animation

FRAME = np.full((8, 8, 3), 120, np.uint8)

Check = Callable[[object], object]
CHECKS: dict[str, tuple[str, Check, Callable[[object], None]]] = {
    "clip": (".webm", check_output, lambda path: write_animation([FRAME], path, 24)),
    "picture": (".png", check_image_output, lambda path: save_image(path, FRAME)),
    "text": (".json", lambda path: check_text_output(path, ".json"), lambda path: write_text(path, "{}")),
}

posix = pytest.mark.skipif(os.name == "nt", reason="of POSIX systems")


def check_in_vain(check: Check, path: object, words: str) -> None:
    with pytest.raises(InvalidInputError, match=words) as caught:
        check(path)
    assert "\n" not in str(caught.value)


@pytest.fixture(params=CHECKS)
def kind(request: pytest.FixtureRequest) -> tuple[str, Check, Callable[[object], None]]:
    return CHECKS[request.param]


Kind = tuple[str, Check, Callable[[object], None]]


@pytest.mark.parametrize("stem", ["a", "a b", "50%d", "girl:v2", "-q", "髪", "e\u0301", "😀", "new\nline", "x" * 60])
@posix
def test_odd_names_are_written(tmp_path: Path, kind: Kind, stem: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    suffix, check, write = kind
    for name in (stem + suffix, f"./{stem}{suffix}"):
        check(name)
        assert list(tmp_path.iterdir()) in ([], [tmp_path / (stem + suffix)])
        write(name)
        assert [entry.name for entry in tmp_path.iterdir()] == [stem + suffix]
        assert (tmp_path / (stem + suffix)).stat().st_size > 0


@pytest.mark.skipif(sys.platform != "linux", reason="names are text there")
def test_a_name_that_is_no_text_is_written(tmp_path: Path, kind: Kind) -> None:
    suffix, check, write = kind
    path = os.fsdecode(os.fsencode(tmp_path) + b"/\xff\xfe" + suffix.encode())
    check(path)
    write(path)
    assert os.listdir(os.fsencode(tmp_path)) == [b"\xff\xfe" + suffix.encode()]


@pytest.mark.parametrize("letter", ["x", "髪", "😀"])
@posix
def test_the_longest_name_is_written_and_a_longer_one_refused(tmp_path: Path, kind: Kind, letter: str) -> None:
    suffix, check, write = kind
    room = os.pathconf(tmp_path, "PC_NAME_MAX") - len(suffix)
    stem = letter * (room // len(letter.encode()))
    stem += "y" * (room - len(stem.encode()))
    check(tmp_path / (stem + suffix))
    write(tmp_path / (stem + suffix))
    write(tmp_path / (stem + suffix))
    assert [entry.name for entry in tmp_path.iterdir()] == [stem + suffix]
    check_in_vain(check, tmp_path / (stem + "y" + suffix), "must be a name that can be written")


def test_the_temporary_name_is_not_longer_than_the_name(tmp_path: Path) -> None:
    for name in ("a.png", "picture.png", "髪髪髪髪.png", "😀" * 60 + ".webm"):
        with made_beside(name, tmp_path) as temporary:
            assert len(os.fsencode(temporary.name)) <= len(os.fsencode(name))
            assert temporary.exists()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("", "must be a name. Got: nothing"),
        ("nul\0{}", "this system can write"),
        ("lone\ud800{}", "this system can write"),
        ("none/a{}", "folder for .* must exist. Got: no folder"),
        ("file/a{}", "which is no folder"),
        ("there{}", "[Gg]ot: a folder|must end in '/'"),
        ("pipe{}", "must be a file. Got: a device or pipe"),
        ("socket{}", "must be a file. Got: a device or pipe"),
        ("null{}", "must be a file. Got: a device or pipe"),
        ("circle{}", "link that leads in a circle"),
        ("read_only{}", "may be replaced. Got: a read-only file"),
        ("dangling/far{}", "folder for .* must exist"),
    ],
)
@posix
def test_impossible_places(tmp_path: Path, kind: Kind, name: str, words: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    suffix, check, write = kind
    Path("file").write_text("mine")
    Path("there" + suffix).mkdir()
    os.mkfifo("pipe" + suffix)
    Path("null" + suffix).symlink_to(os.devnull)
    Path("circle" + suffix).symlink_to("circle" + suffix)
    Path("dangling").symlink_to("nowhere")
    Path("read_only" + suffix).write_text("mine")
    Path("read_only" + suffix).chmod(0o444)
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("socket" + suffix)
    before = sorted(tmp_path.iterdir())
    for call in (check, write):
        check_in_vain(call, name.format(suffix), words)
    assert sorted(tmp_path.iterdir()) == before
    assert Path("read_only" + suffix).read_text() == "mine"
    assert not Path(os.devnull).is_file()


@pytest.mark.parametrize("path", [None, 3, b"a.png"])
def test_what_is_no_path(kind: Kind, path: object) -> None:
    check_in_vain(kind[1], path, "must be a path")


@posix
def test_a_link_stays_a_link(tmp_path: Path, kind: Kind) -> None:
    suffix, check, write = kind
    (tmp_path / "far").mkdir()
    for name in ("old", "new"):
        (tmp_path / (name + suffix)).symlink_to(f"far/real_{name}{suffix}")
    (tmp_path / "far" / f"real_old{suffix}").write_bytes(b"earlier")
    for name in ("old", "new"):
        check(tmp_path / (name + suffix))
        write(tmp_path / (name + suffix))
        assert (tmp_path / (name + suffix)).is_symlink()
        assert (tmp_path / "far" / f"real_{name}{suffix}").read_bytes() not in (b"", b"earlier")
    assert len(list((tmp_path / "far").iterdir())) == 2


@posix
def test_permissions_of_the_replaced_file_stay(tmp_path: Path, kind: Kind) -> None:
    suffix, _, write = kind
    path = tmp_path / ("a" + suffix)
    path.write_bytes(b"earlier")
    path.chmod(0o640)
    write(path)
    assert path.stat().st_mode & 0o777 == 0o640


def test_a_folder_that_is_read_only_is_found_by_trying(
    tmp_path: Path, kind: Kind, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> int:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("physanimator.rendering.files.unfinished.os.open", refuse)
    check_in_vain(kind[1], tmp_path / f"a{kind[0]}", "must be writable. Got: Permission denied")


def test_a_file_that_another_program_holds_is_found_beforehand(
    tmp_path: Path, kind: Kind, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As Windows refuses to open what a player has open."""
    path = tmp_path / f"a{kind[0]}"
    path.touch()

    def refuse(*_: object, **__: object) -> int:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("physanimator.rendering.files.places.os.open", refuse)
    check_in_vain(kind[1], path, "is it open in another program")


def test_an_error_leaves_the_earlier_file_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("earlier")
    with pytest.raises(OSError, match=r"No space.*a\.txt") as caught, replacing(path):
        raise OSError(28, "No space left on device", str(tmp_path / ".1a2b"))
    assert caught.value.filename == str(path)
    assert path.read_text() == "earlier"
    assert list(tmp_path.iterdir()) == [path]


def test_what_a_lost_generator_made_is_removed_at_the_end(tmp_path: Path) -> None:
    held = made_beside("clip.mp4", tmp_path)
    held.__enter__()
    assert len(list(tmp_path.iterdir())) == 1
    remove_unfinished()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "name",
    [
        "con.png",
        "a/NUL",
        "c:\\x\\Com1.mp4",
        "lpt9 .json",
        "COM¹.png",
        "girl:v2.mp4",
        "what?.mp4",
        "a|b",
        "dot.",
        "space ",
        "a\tb",
    ],
)
def test_names_that_windows_gives_another_meaning(name: str) -> None:
    with pytest.raises(InvalidInputError, match="Windows"):
        check_windows_name(name)


@pytest.mark.parametrize(
    "name", ["a.png", "c:\\x\\a b.mp4", "console.png", ".hidden", "..\\x\\", "frames/", "com10.png"]
)
def test_names_that_windows_takes(name: str) -> None:
    check_windows_name(name)


def test_messages_have_no_line_ends_and_no_commands_to_the_terminal() -> None:
    assert printable("a\n\x1b[2J\u202eb") == "a\\n\\x1b[2J\\u202eb"
    assert printable("髪 é\u3000😀\udcff") == "髪 é\u3000😀\\udcff"


@pytest.mark.parametrize("suffix", [".psd", ".ico", ".icns", ".hdf", ".xbm", ".cur", ".mp4", ".svg", ""])
def test_pictures_that_cannot_be_written_are_refused_beforehand(tmp_path: Path, suffix: str) -> None:
    check_in_vain(check_image_output, tmp_path / f"a{suffix}", r"must end in \.png, \.jpg or \.webp")


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".JPEG", ".webp", ".tif", ".bmp", ".gif", ".tga"])
@pytest.mark.parametrize("channels", [1, 3, 4])
def test_what_the_check_accepts_is_written(tmp_path: Path, suffix: str, channels: int) -> None:
    path = tmp_path / f"a{suffix}"
    picture = np.full((40, 310, channels), 99, np.uint8)[..., slice(None) if channels > 1 else 0]
    if channels == 4 and suffix.lower() in (".jpg", ".jpeg", ".bmp"):
        check_in_vain(lambda place: check_image_output(place, alpha=True), path, "with transparency must end in")
        check_in_vain(lambda place: save_image(place, picture), path, "with transparency must end in")
        return
    check_image_output(path, alpha=channels == 4)
    save_image(path, picture)
    assert load_image(path).shape == (40, 310, 3)


def test_pictures_that_are_too_large_for_their_format(tmp_path: Path) -> None:
    for suffix in (".webp", ".jpg", ".gif"):
        check_in_vain(
            lambda path: save_image(path, np.zeros((70_000, 1), np.uint8)), tmp_path / f"a{suffix}", "at most"
        )
    assert list(tmp_path.iterdir()) == []
