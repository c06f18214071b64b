"""``physanimator shots`` in one process: what the list may say, what is done again, and what is told."""

from __future__ import annotations

import errno
import json
import os
import re
import shlex
import subprocess
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from unittest.mock import ANY

import cv2
import numpy as np
import pytest
from command_status import status
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.threads import THREADS, thread_variables
from physanimator.rendering.command import shot_task
from physanimator.rendering.command.shot_list import check_shot, read_list
from physanimator.rendering.pictures import save_image
from physanimator.rendering.shots import Animated, merged, read_shot_record
from PIL import Image
from shot_lists import contents, draw, litter, write_list

Output = pytest.CaptureFixture[str]
SHOTS = ("shots", "list.toml", "--output", "out", "--workers", "0")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    draw(tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def opencv_as_before() -> Iterator[None]:
    """What a command has told OpenCV about threads is forgotten again."""
    before = cv2.getNumThreads()
    yield
    cv2.setNumThreads(before)


def problems(text: str, folder: Path, name: str = "list.toml") -> list[str]:
    """All that is said of a list."""
    (folder / name).write_text(text, encoding="utf-8")
    (folder / "out").mkdir()
    read = read_list(str(folder / name), str(folder / "out"))
    return [str(each) for each in (*read.problems, *(each for shot in read.shots for each in check_shot(shot)))]


def test_shots_are_what_animate_makes_of_the_same_options(folder: Path, capsys: Output) -> None:
    shots = [
        'name = "one"\nwind = 2\nwind-angle = -30\npreset = ["ribbon"]',
        'name = "two"\nwind_angle = 90\noutput = "two.gif"\nstrands = false\nsave-scene = "{out}/{name}.json"',
    ]
    write_list(folder / "list.toml", shots)
    assert status(*SHOTS) == 0, capsys.readouterr().err
    alone = ("animate", "girl.png", "--mask", "hair.png", "--frames", "3", "--quiet")
    assert status(*alone, "-o", "a.mp4", "--wind", "2", "--wind-angle=-30", "--preset", "ribbon") == 0
    assert status(*alone, "-o", "a.gif", "--wind-angle", "90", "--no-strands") == 0
    assert (folder / "out" / "one.mp4").read_bytes() == (folder / "a.mp4").read_bytes()
    assert (folder / "two.gif").read_bytes() == (folder / "a.gif").read_bytes()
    assert json.loads((folder / "out" / "two.json").read_text())["bodies"]
    assert litter(folder / "out") == ["two.json"]


@pytest.mark.parametrize("name", ["a.mp4", "a.webm", "a.mov", "a.gif", "a.webp", "a.apng"])
@pytest.mark.usefixtures("opencv_as_before")
def test_the_bytes_are_the_same_whatever_the_number_of_threads(
    folder: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    made = []
    words = ("animate", "girl.png", "--mask", "hair.png", "--frames", "8", "--quiet", "--output", name)
    for threads in ("2", "1", "3"):
        for variable, said in thread_variables(int(threads)).items():  # which the command sets
            monkeypatch.setenv(variable, said)
        begun, start = [], threading.Thread.start
        monkeypatch.setattr(
            threading.Thread, "start", lambda each, start=start, begun=begun: (begun.append(each.name), start(each))
        )
        assert status(*words) == 0
        assert bool([each for each in begun if each == "physanimator-beside"]) == (threads != "1")
        made.append((folder / name).read_bytes())
    assert made[0] == made[1] == made[2]


def test_a_wrong_number_of_threads_is_told(folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: Output) -> None:
    monkeypatch.setenv(THREADS, "many")
    write_list(folder / "list.toml", ['name = "a"'])
    for words in (SHOTS, ("animate", "girl.png", "--mask", "hair.png", "--output", "a.mp4")):
        assert status(*words) == 2
        assert "PHYSANIMATOR_THREADS must be 1 to 1024. Got: many" in capsys.readouterr().err
    assert not (folder / "out").exists()


def test_what_was_changed_since_is_kept(folder: Path, capsys: Output) -> None:
    write_list(folder / "list.toml", ['name = "a"', 'name = "b"\nsave-scene = "{out}/{name}.json"'])
    assert status(*SHOTS) == 0
    for changed in ("a.mp4", "b.json"):
        kept = (folder / "out" / changed).read_bytes()
        (folder / "out" / changed).write_bytes(kept + b" ")
        capsys.readouterr()
        for arguments in (SHOTS, (*SHOTS, "--dry-run")):
            assert status(*arguments) == 2
            assert f"{changed}, which has changed" in capsys.readouterr().err
        assert (folder / "out" / changed).read_bytes() == kept + b" "
        (folder / "out" / changed).unlink()
    assert status(*SHOTS) == 0


def test_a_second_run_does_only_what_is_missing_or_changed(folder: Path, capsys: Output) -> None:
    write_list(folder / "list.toml", ['name = "a"', 'name = "b"', 'name = "c"', 'name = "d"'])
    assert status(*SHOTS) == 0
    made = {name: (folder / "out" / name).stat().st_mtime_ns for name in contents(folder / "out")}
    assert len(made) == 4
    (folder / "out" / "b.mp4").unlink()
    (folder / "out" / "c.mp4").unlink()
    write_list(folder / "list.toml", ['name = "a"', 'name = "b"', 'name = "c"', 'name = "d"\nwind = 3'])
    capsys.readouterr()
    assert status(*SHOTS, "--dry-run") == 0
    plan = capsys.readouterr().out
    assert re.findall(r"^(\w): to do again: what it (\w+)", plan, re.MULTILINE) == [
        ("b", "wrote"),
        ("c", "wrote"),
        ("d", "reads"),
    ]
    assert status(*SHOTS) == 0
    assert "3 done now, 1 done before" in capsys.readouterr().out
    now = {name: (folder / "out" / name).stat().st_mtime_ns for name in made}
    assert [name for name in made if now[name] != made[name]] == ["b.mp4", "c.mp4", "d.mp4"]
    draw(folder)  # the same pixels, at another time
    assert status(*SHOTS) == 0
    assert "0 done now, 4 done before" in capsys.readouterr().out


@pytest.mark.parametrize("when", ["before", "meanwhile"])
def test_a_picture_that_is_painted_on_during_the_run_is_never_taken_for_done(
    folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch, when: str
) -> None:
    """Of a change before the shot begins the record knows; one while it is made is told, and it is made again."""
    animate, first = shot_task.animate_shot, (folder / "girl.png").read_bytes()

    def painting(words: list[str]) -> Animated:
        if when == "before" and is_of(words, "one"):
            paint()
        ended = animate(words)
        if when == "meanwhile" and is_of(words, "two"):
            paint()
        return ended

    def is_of(words: list[str], name: str) -> bool:
        return any(each.endswith(f"{name}.mp4") for each in words)

    def paint() -> None:
        save_image(folder / "girl.png", 255 - np.asarray(Image.open(folder / "girl.png")))

    write_list(folder / "list.toml", ['name = "one"\nmask = "other.png"', 'name = "two"'])
    (folder / "other.png").write_bytes((folder / "hair.png").read_bytes())
    monkeypatch.setattr(shot_task, "animate_shot", painting)
    assert status(*SHOTS) == 1
    told = capsys.readouterr().err
    changed = "one" if when == "before" else "two"
    assert re.findall(r"^(\w+) +failed  what it reads was changed", told, re.MULTILINE) == [changed]
    monkeypatch.setattr(shot_task, "animate_shot", animate)
    (folder / "girl.png").write_bytes(first)
    assert status(*SHOTS, "--dry-run") == 0
    again = re.findall(r"^(\w+): to do again", capsys.readouterr().out, re.MULTILINE)
    assert again == (["one", "two"] if when == "before" else ["two"])
    assert status(*SHOTS) == 0


@pytest.mark.parametrize("how", [(), ("--dry-run",), ("--write-commands", "lines.txt")])
def test_what_others_have_put_there_is_not_replaced(folder: Path, capsys: Output, how: tuple[str, ...]) -> None:
    write_list(folder / "list.toml", ['name = "a"'])
    (folder / "out").mkdir()
    (folder / "out" / "a.mp4").write_text("mine")
    assert status(*SHOTS, *how) == 2
    assert re.search(r"line 6, shot a: output must be new.* Got: .*a.mp4, which", capsys.readouterr().err)
    assert [path.name for path in (folder / "out").iterdir()] == ["a.mp4"]
    assert (folder / "out" / "a.mp4").read_text() == "mine"


def test_clips_of_another_list_are_not_replaced(folder: Path, capsys: Output) -> None:
    """Two episodes may have shots of the same name; those that are the same are done."""
    frames = 'name = "d"\noutput = "{out}/d/"'
    write_list(folder / "list.toml", ['name = "a"', 'name = "b"', frames])
    assert status(*SHOTS) == 0
    made = contents(folder / "out")
    write_list(folder / "other.toml", ['name = "a"', 'name = "b"\nwind = 3', 'name = "c"', f"{frames}\nwind = 3"])
    words = ("shots", "other.toml", *SHOTS[2:])
    capsys.readouterr()
    assert status(*words) == 2
    told = capsys.readouterr().err
    assert re.search(r"line 9, shot b: output must be new, or a clip of other.toml. Got: .*, which list.toml has", told)
    assert re.search(r"shot d: output must be new, or a clip of other.toml. Got: .*/out/d/, which list.toml has", told)
    assert contents(folder / "out") == made
    assert status(*words, "--only", "a", "c") == 0
    assert "1 done now, 1 done before" in capsys.readouterr().out


def test_a_list_may_get_another_name(folder: Path, capsys: Output) -> None:
    write_list(folder / "list.toml", ['name = "a"', 'name = "b"'])
    assert status(*SHOTS) == 0
    (folder / "list.toml").unlink()
    write_list(folder / "second take.toml", ['name = "a"', 'name = "b"\nwind = 3'])
    capsys.readouterr()
    assert status("shots", "second take.toml", *SHOTS[2:]) == 0
    assert "1 done now, 1 done before" in capsys.readouterr().out


def test_a_clip_whose_run_was_killed_before_its_record_is_made_again(folder: Path, capsys: Output) -> None:
    write_list(folder / "list.toml", ['name = "a"'])
    assert status(*SHOTS) == 0
    (folder / "out" / "a.mp4.shot.json").unlink()
    (folder / "out" / ".shots").mkdir()
    (folder / "out" / ".shots" / "a.0").touch()
    assert status(*SHOTS) == 0
    assert "1 done now" in capsys.readouterr().out


def test_a_moved_folder_is_still_done(folder: Path, capsys: Output) -> None:
    write_list(folder / "list.toml", ['name = "a"\noutput = "{out}/{name}/"', 'name = "b"'])
    assert status(*SHOTS) == 0
    os.rename(folder / "out", folder / "moved")
    assert status("shots", "list.toml", "-o", "moved", "--workers", "0") == 0
    assert "0 done now, 2 done before" in capsys.readouterr().out


def test_the_record_tells_what_was_made_of_what(folder: Path) -> None:
    write_list(folder / "list.toml", ['name = "a"\nwind = 2'])
    assert status(*SHOTS) == 0
    record = read_shot_record(str(folder / "out" / "a.mp4.shot.json"))
    assert record is not None
    assert record.name == "a"
    assert record.settings["wind"] == 2
    assert [each.name for each in record.files] == ["a.mp4"]
    assert record.seconds > 0
    assert record.machine
    place = folder / "out" / "a.mp4.shot.json"
    text = place.read_text(encoding="utf-8")
    for damaged in (
        "[1]",
        text[:-9],
        text.replace('"seconds": ', '"seconds": "x", "s": '),
        text.replace("a.mp4", "\\u0000"),
    ):
        place.write_text(damaged, encoding="utf-8")
        assert read_shot_record(str(place)) is None or damaged.count("u0000")
        assert status(*SHOTS) == 0  # it is done again
        assert read_shot_record(str(place)) == replace(record, files=ANY, seconds=ANY)


def test_a_csv_file_has_a_row_for_each_shot(folder: Path, capsys: Output) -> None:
    rows = (
        "name;image;mask;frames;pixel-art;wind\na;girl.png;hair.png|hair.png;2;yes;\n\nb;girl.png;hair.png;2;no;1.5\n"
    )
    (folder / "list.csv").write_text(rows, encoding="utf-8-sig")
    assert status("shots", "list.csv", "-o", "out", "--workers", "0") == 0, capsys.readouterr().err
    assert sorted(contents(folder / "out")) == ["a.mp4", "b.mp4"]
    settings = read_shot_record(str(folder / "out" / "a.mp4.shot.json")).settings  # type: ignore[union-attr]
    assert settings["pixel_art"] is True
    assert "wind" not in settings


@pytest.mark.parametrize(
    "text",
    [
        "sep=;\nName;Image;--mask;Wind Angle;;\na;girl.png;hair.png;20;;\n",
        "sep=\t\r\nname\timage\tmask\twind-angle\r\na\tgirl.png\thair.png\t20\r\n",
        'SEP=,\n"name","image","mask","wind_angle"\na,girl.png,hair.png,20\n',
    ],
)
def test_csv_files_are_as_spreadsheets_write_them(folder: Path, text: str) -> None:
    (folder / "list.csv").write_text(text, encoding="utf-8", newline="")
    read = read_list(str(folder / "list.csv"), str(folder / "out"))
    assert [str(each) for each in read.problems] == []
    assert [(shot.name, shot.settings["wind_angle"]) for shot in read.shots] == [("a", 20)]


def test_a_wrong_column_is_told_once(folder: Path) -> None:
    rows = "".join(f"a{n},girl.png,hair.png,3,\n" for n in range(5))
    told = problems(f"name,image,mask,wnid,\n{rows}b,girl.png,hair.png,,4\n", folder, "list.csv")
    assert sum("wnid" in each for each in told) == 5  # before those that are the same are merged
    read = read_list(str(folder / "list.csv"), str(folder / "out"))
    assert [str(each) for each in merged(read.problems)] == [
        "line 1: options must be those of animate, and name. Got: wnid; is wind meant?",
        "line 7, shot b: every column must have a name. Got: 4 below none",
    ]


def test_all_errors_are_in_one_list_with_shot_option_and_line(folder: Path) -> None:
    text = (
        '[defaults]\nimage = "girl.png"\nmask = "hair.png"\nframes = 3\n[other]\n'
        '[[shot]]\nname = "a"\nwnid = 3\nframes = "many"\n'
        '[[shot]]\nname = "A"\n'
        '[[shot]]\nname = "b"\ncontact = "yes"\nwind = [1, 2]\n'
        '[[shot]]\nname = "c"\npreset = "hare"\n'
        '[[shot]]\nname = "d"\nwind = 1e9\n'
        '[[shot]]\nname = "e"\nimage = "none.png"\nmask = ["hair.png", "none2.png"]\n'
        '[[shot]]\nname = "f"\nspacing = 1\n'
        '[[shot]]\nname = "g"\nloop = -1\n'
        '[[shot]]\nname = "h"\nattach = "middle"\n'
        '[[shot]]\nname = "nul"\n'
    )
    told = problems(text, folder)
    expected = [
        (5, "", "tables must be"),
        (8, "a", "is wind meant?"),
        (9, "a", "frames must be a whole number"),
        (11, "A", "name must be unlike"),
        (14, "b", "contact must be true or false"),
        (15, "b", "wind must be a text or a number"),
        (18, "c", "--preset must be one of"),
        (21, "d", "--wind must be"),
        (24, "e", "none.png"),
        (25, "e", "none2.png"),
        (28, "f", "--spacing must be at least 2 px"),
        (31, "g", "--loop must be"),
        (34, "h", "attach must be one of"),
        (36, "10", "name must be such that"),
    ]
    assert len(told) == len(expected)
    for line, shot, words in expected:
        head = f"line {line}, shot {shot}: " if shot else f"line {line}: "
        assert any(each.startswith(head) and words in each for each in told), (line, told)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("name = 1\n", "with none"),
        ("[shot]\nname = 'a'\n", "each [[shot]]"),
        ("defaults = 3\n[[shot]]\n", "must be a table"),
        ("[[shot\n", "must be TOML"),
        (f"[[shot]]\nname = 'a'\nframes = {'9' * 5000}\n", "must be TOML"),
    ],
)
def test_what_is_no_list_is_refused(folder: Path, text: str, words: str) -> None:
    with pytest.raises(InvalidInputError, match=re.escape(words)):
        problems(text, folder)


@pytest.mark.parametrize(
    ("one", "two", "words"),
    [
        ('output = "x.mp4"', 'output = "X.mp4"', "must be unlike what shot one writes"),
        ('output = "x.mp4"', 'output = "./sub/../x.mp4"', "must be unlike what shot one writes"),
        ('output = "x.mp4"', 'output = "link/x.mp4"', "must be unlike what shot one writes"),
        ('save-scene = "{out}/two.mp4.shot.json"', "", "must be unlike what shot one writes"),
        ('output = "other.png/"', 'image = "other.png"', "must not be a file that shot two reads"),
        ('scene = "s.json"', 'save-scene = "s.json"', "must not be a file that shot one reads"),
        ('save-scene = "list.toml"', "", "must not be a file that this command reads"),
        ('output = "fr/"', 'save-sketch = "fr/frame_0001.png/"', "must not be named as the frames of shot one"),
    ],
)
def test_no_shot_writes_over_another_or_what_it_reads(folder: Path, one: str, two: str, words: str) -> None:
    (folder / "sub").mkdir()
    (folder / "fr").mkdir()
    (folder / "link").symlink_to(folder, target_is_directory=True)
    head = '[defaults]\nimage = "girl.png"\nmask = "hair.png"\n'
    told = problems(f'{head}[[shot]]\nname = "one"\n{one}\n[[shot]]\nname = "two"\n{two}\n', folder)
    assert any(words in each for each in told), told


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--write-commands", "list.toml"), "--write-commands must not be a file that this command reads"),
        (("--write-commands", "girl.png"), "--write-commands must not be a file that shot a reads"),
        (("--write-commands", "./a.svg"), "--write-commands must be unlike what shot b writes"),
    ],
)
def test_what_is_written_besides_takes_no_files_place(
    folder: Path, capsys: Output, words: tuple[str, str], told: str
) -> None:
    write_list(folder / "list.toml", ['name = "a"', 'name = "b"\nsave-svg = "A.svg"'])
    before = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    assert status(*SHOTS, *words) == 2
    assert told in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()} == before


def test_what_the_defaults_have_wrong_is_told_once(folder: Path, capsys: Output) -> None:
    write_list(
        folder / "list.toml", ['name = "a"', 'name = "b"', 'name = "c"\nfps = 0'], defaults="wind = 1e9\nsawy = 3"
    )
    assert status(*SHOTS) == 2
    told = capsys.readouterr().err
    assert told.count("sawy") == 1
    assert "list.toml: line 5: options must be" in told


def test_nothing_is_begun_where_one_shot_is_wrong(folder: Path, capsys: Output) -> None:
    write_list(folder / "list.toml", ['name = "a"', 'name = "b"\nframes = 0'])
    assert status(*SHOTS) == 2
    assert "line 11, shot b: --frames must be" in capsys.readouterr().err
    assert not (folder / "out").exists()


def test_failures_are_told_and_the_others_go_on(folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch) -> None:
    animate = shot_task.animate_shot

    def failing(words: list[str]) -> Animated:
        if "--wind=2" in words:
            return Animated(1, ("a warning", "the fan is broken"))
        if "--wind=3" in words:
            raise ZeroDivisionError("a fault")
        return animate(words)

    monkeypatch.setattr(shot_task, "animate_shot", failing)
    write_list(folder / "list.toml", ['name = "a"\nwind = 2', 'name = "b"\nwind = 3', 'name = "c"'])
    assert status(*SHOTS, "--report", "r.html") == 1
    told = capsys.readouterr()
    assert re.search(r"^a +failed  the fan is broken$", told.err, re.MULTILINE)
    assert re.search(
        r"^b +failed  ZeroDivisionError: a fault \(an error of PhysAnimator itself", told.err, re.MULTILINE
    )
    assert "3 shots: 1 done now, 0 done before, 2 not done" in told.out
    page = (folder / "r.html").read_text(encoding="utf-8")
    assert page.count("<article") == 3
    assert re.search(r'<video src="out/c\.mp4" poster="data:image/\w+;base64,/9j', page)
    assert "the fan is broken" in page


def test_nothing_more_is_begun_where_the_disk_is_full(
    folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(words: list[str]) -> Animated:
        return Animated(1, ("out/a.mp4: No space left on device",), full=True)

    monkeypatch.setattr(shot_task, "animate_shot", full)
    write_list(folder / "list.toml", ['name = "a"', 'name = "b"', 'name = "c"'])
    assert status(*SHOTS) == 1
    told = capsys.readouterr().err
    assert re.search(r"^a +failed  out/a.mp4: No space left", told, re.MULTILINE)
    assert len(re.findall(r"^[bc] +left +not begun: out/a.mp4: No space left", told, re.MULTILINE)) == 2


@pytest.mark.parametrize("output", ["{out}/{name}.mp4", "{out}/{name}/"])
def test_a_clip_without_room_for_its_record_does_not_stay(
    folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch, output: str
) -> None:
    """It would be taken for somebody else's, and the same command could not make it again."""

    def full(path: str, _: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), path)

    write_list(folder / "list.toml", [f'name = "a"\noutput = "{output}"'])
    with monkeypatch.context() as without_room:
        without_room.setattr("physanimator.rendering.shots.job.write_shot_record", full)
        assert status(*SHOTS) == 1
    assert "No space left on device" in capsys.readouterr().err
    assert not [path for path in (folder / "out").rglob("*") if path.is_file()]
    assert status(*SHOTS) == 0
    assert "1 done now" in capsys.readouterr().out


def test_a_folder_that_cannot_be_written_is_refused_before_the_work(folder: Path, capsys: Output) -> None:
    write_list(folder / "list.toml", ['name = "a"\noutput = "hair.png/x.mp4"'])
    assert status("shots", "list.toml", "-o", "girl.png/out", "--workers", "0") == 2
    assert "--output" in capsys.readouterr().err
    assert status(*SHOTS) == 2
    assert "the folder for" in capsys.readouterr().err


def test_names_and_folders_may_have_braces(folder: Path) -> None:
    out = folder / "{name} of {out}"
    write_list(folder / "list.toml", ['name = "a {out}"', 'name = "{name}"\noutput = "{out}/{name}-{out}.webm"'])
    read = read_list("list.toml", str(out))
    assert [each.text for shot in read.shots for each in shot.paths("output")] == [
        str(out / "a {out}.mp4"),
        f"{out}/{{name}}-{out}.webm",
    ]


def test_checks_tell_how_much_moves(folder: Path) -> None:
    write_list(folder / "list.toml", ['name = "a"', 'name = "b"\nframes = 0'])
    moving: dict[str, int] = {}
    (folder / "out").mkdir()
    shots = read_list("list.toml", "out").shots
    assert [bool(check_shot(shot, moving)) for shot in shots] == [False, True]
    assert moving == {"a": 11 * 35}  # pixels of the strip


def test_some_shots_are_chosen_by_name(folder: Path, capsys: Output) -> None:
    write_list(folder / "list.toml", ['name = "a"', 'name = "b"', 'name = "c"\nframes = 0'])
    assert status(*SHOTS, "--only", "b") == 0
    assert sorted(contents(folder / "out")) == ["b.mp4"]
    assert status(*SHOTS, "--only", "x") == 2
    assert "--only must name shots of the list. Got: x" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--ship",), "--ship needs --scheduler"),
        (("--workers", "2", "--scheduler", "tcp://x:1"), "--workers and --scheduler"),
        (("--workers", "-1"), "--workers must be"),
        (("--report", "x.txt"), "must end in .html"),
    ],
)
def test_options_that_do_not_go_together(folder: Path, capsys: Output, words: tuple[str, ...], told: str) -> None:
    write_list(folder / "list.toml", ['name = "a"'])
    assert status("shots", "list.toml", "-o", "out", *words) == 2
    assert told in capsys.readouterr().err


def test_without_dask_one_sentence_says_what_to_install(
    folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    import importlib.util

    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "distributed" else find(name))
    write_list(folder / "list.toml", ['name = "a"'])
    assert status("shots", "list.toml", "-o", "out") == 2
    assert "pip install 'physanimator[shots]'" in capsys.readouterr().err


def test_each_shell_line_and_each_task_does_one_shot(folder: Path, capsys: Output) -> None:
    write_list(folder / "list.toml", ['name = "a b"', 'name = "c"'])
    words = ("shots", "list.toml", "-o", "out", "--write-commands", "lines.txt", "--write-openjd", "job.yaml")
    assert status(*words) == 0, capsys.readouterr().err
    lines = (folder / "lines.txt").read_text().splitlines()
    assert len(lines) == 2
    program, *rest = shlex.split(lines[0])
    assert program == "physanimator"
    assert status(*rest) == 0
    assert sorted(contents(folder / "out")) == ["a b.mp4"]
    job = json.loads((folder / "job.yaml").read_text())
    assert job["steps"][0]["parameterSpace"]["taskParameterDefinitions"][0]["range"] == ["a b", "c"]


def test_the_job_template_is_valid_and_runs(folder: Path) -> None:
    """As openjd-cli, which runs what farms run, understands it."""
    pytest.importorskip("openjd.cli")
    import sys

    from shot_lists import environment

    write_list(folder / "list.toml", ['name = "a"'])
    assert status("shots", "list.toml", "-o", "out", "--write-openjd", "job.yaml") == 0
    program = folder / "physanimator.sh"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m physanimator "$@"\n')
    program.chmod(0o700)
    openjd = [sys.executable, "-m", "openjd"]
    subprocess.run([*openjd, "check", "job.yaml"], check=True, env=environment(folder))
    if os.name == "nt":
        pytest.skip("the program is a shell script")
    run = [*openjd, "run", "job.yaml", "--step", "Animate", "-p", f"Program={program}"]
    done = subprocess.run(run, env=environment(folder), capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    assert sorted(contents(folder / "out")) == ["a.mp4"]


@pytest.mark.skipif(os.name == "nt", reason="locks are taken in another way there")
def test_two_runs_do_not_fill_one_folder(folder: Path, capsys: Output) -> None:
    pytest.importorskip("distributed")
    import fcntl

    write_list(folder / "list.toml", ['name = "a"'])
    (folder / "out" / ".shots").mkdir(parents=True)
    with (folder / "out" / ".shots" / "lock").open("wb") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        assert status("shots", "list.toml", "-o", "out", "--workers", "1") == 2
    assert "--output must be a folder that no other run fills" in capsys.readouterr().err


def test_a_shot_whose_workers_are_killed_thrice_is_given_up(folder: Path, capsys: Output) -> None:
    """As its notes tell, which a killed worker leaves; what it was writing is removed."""
    from physanimator.rendering.command.shot_task import animate_shot, shot_files
    from physanimator.rendering.shots import FileDigests, Job, identity_of
    from physanimator.rendering.shots.job import MOST_RUNS, perform

    write_list(folder / "list.toml", ['name = "a"'])
    notes = folder / "out" / ".shots"
    notes.mkdir(parents=True)
    shot = read_list("list.toml", "out").shots[0]
    job = Job(shot, identity_of(shot, FileDigests()), animate_shot, shot_files, str(notes))
    for run in range(MOST_RUNS):
        (folder / "out" / f".{run}half.mp4").touch()
        (notes / f"a.{run}").write_text(f"{folder}/out/.{run}half.mp4\0", encoding="utf-8")
    outcome = perform(job)
    assert outcome.state == "lost"
    assert "3 times" in outcome.why
    assert litter(folder / "out") == [".shots"]


def test_what_another_run_is_writing_stays(folder: Path, capsys: Output) -> None:
    """As where a farm gives a task out twice: the second waits until the first has ended."""
    fcntl = pytest.importorskip("fcntl")
    write_list(folder / "list.toml", ['name = "a"'])
    notes = folder / "out" / ".shots"
    notes.mkdir(parents=True)
    half, seen = folder / "out" / ".1half.mp4", []
    half.touch()
    with (notes / "a.0").open("w+b") as note:
        note.write(f"{half}\0".encode())
        note.flush()
        fcntl.flock(note, fcntl.LOCK_EX)

        def end() -> None:
            seen.extend([half.exists(), (folder / "out" / "a.mp4").exists()])
            fcntl.flock(note, fcntl.LOCK_UN)

        threading.Timer(1.0, end).start()
        assert status(*SHOTS) == 0
    assert "1 done now" in capsys.readouterr().out
    assert seen == [True, False]
    assert not half.exists()  # whoever wrote it is gone
