"""How a command ends: by signals, with nobody who listens, and with names that the terminal cannot show."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.command import main
from physanimator.rendering.pictures import save_image, write_animation

ROOT = Path(__file__).resolve().parents[3]
ANIMATE = ["animate", "girl.png", "--mask", "hair.png", "--frames", "3"]

Output = pytest.CaptureFixture[str]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with a picture and a mask."""
    monkeypatch.chdir(tmp_path)
    y, x = np.mgrid[0:48, 0:64]
    strip = (np.abs(x - 30) < 6) & (y > 4) & (y < 40)
    save_image("girl.png", np.stack([80 + x, 200 - y, 160 + 0 * x], axis=-1).astype(np.uint8))
    save_image("hair.png", strip.astype(np.uint8) * 255)
    return tmp_path


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def run(*arguments: str, **options: object) -> subprocess.Popen[bytes]:
    script = (
        f"import runpy, sys; runpy.run_path({str(ROOT / 'tests' / 'conftest.py')!r})\n"
        "from physanimator.rendering.command import program\nsys.exit(program())"
    )
    return subprocess.Popen([sys.executable, "-c", script, *arguments], **options)  # type: ignore[call-overload]


@pytest.mark.skipif(os.name == "nt", reason="os.kill ends the process on Windows")
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_a_signal_while_writing_leaves_everything_as_it_was(
    folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    number = getattr(signal, name)

    def signalling(_: object) -> Callable[[str, int, int], None]:
        def advance(stage: str, done: int, total: int) -> None:
            if stage == "render" and done == 2:
                os.kill(os.getpid(), number)

        return advance

    monkeypatch.setattr("physanimator.rendering.command.messages.progress_bars", signalling)
    write_animation([np.zeros((8, 8, 3), np.uint8)] * 5, "old/", 24)
    Path("old.webp").write_bytes(b"earlier")
    before = contents(folder)
    for output in ("new.mp4", "old.webp", "new/", "old/"):
        assert main([*ANIMATE, "--output", output]) == 128 + number
        assert contents(folder) == before
        assert not (folder / "new").exists()
    said = capsys.readouterr().err
    assert "Traceback" not in said
    assert said.splitlines()[-1] == (
        "physanimator: interrupted" if name == "SIGINT" else f"physanimator: ended by {name}"
    )


@pytest.mark.skipif(os.name == "nt", reason="there are no such pipes")
def test_nobody_reads_the_schema_to_its_end() -> None:
    done = run("schema", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert done.stdout is not None
    assert done.stderr is not None
    done.stdout.close()
    said = done.stderr.read()
    done.stderr.close()
    assert done.wait() == 141
    assert said == b""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full device")
def test_what_cannot_be_printed_is_told() -> None:
    with open("/dev/full", "wb") as full:
        done = run("schema", stdout=full, stderr=subprocess.PIPE)
        said = done.communicate()[1].decode()
    assert done.returncode == 1
    assert said.splitlines() == ["physanimator: No space left on device"]


def test_the_process_waits_for_everybody_and_takes_nothing_apart() -> None:
    script = (
        f"import runpy; runpy.run_path({str(ROOT / 'tests' / 'conftest.py')!r})\n"
        "import sys, threading, time\n"
        "class Module:\n    def __del__(self):\n        print('taken apart')\n"
        "kept = Module()\n"
        "def late():\n    time.sleep(0.5)\n    print('thread')\n"
        "threading.Thread(target=late).start()\n"
        "from physanimator.rendering.command import program\n"
        "sys.argv = ['physanimator', *sys.argv[1:]]\n"
        "status = program()\n"
        "import atexit\natexit.register(lambda: print('last words', end=''))\n"
        "sys.exit(status)"
    )
    done = subprocess.run([sys.executable, "-c", script, "schema"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.endswith("}\nthread\nlast words")
    missing = [sys.executable, "-c", script, "animate", "none.png", "-o", "a.mp4"]
    done = subprocess.run(missing, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout.endswith("thread\nlast words")


class _Narrow(io.TextIOWrapper):
    """A stream of Windows's western code page, as where output goes into a file there."""

    def __init__(self) -> None:
        super().__init__(io.BytesIO(), encoding="cp1252", errors="strict")

    @property
    def text(self) -> str:
        self.flush()
        return self.buffer.getvalue().decode("cp1252")  # type: ignore[attr-defined]


def test_a_gif_needs_no_folder_but_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its frames wait beside it, where there is to be room for it anyway."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "none"))
    write_animation([np.full((16, 16, 3), 30 * t, np.uint8) for t in range(3)], tmp_path / "a.gif", 24)
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.gif"]


def test_names_outside_the_code_page(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out, err = _Narrow(), _Narrow()
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "stderr", err)
    assert main([*ANIMATE, "--output", "髪.mp4"]) == 0
    assert (folder / "髪.mp4").stat().st_size > 0
    assert out.text.startswith("\\u9aea.mp4: 3 frames")
    assert main(["animate", "髪.png", "--mask", "hair.png", "--output", "o.mp4"]) == 2
    assert "\\u9aea.png" in err.text
    with pytest.raises(SystemExit):
        main(["髪"])
    with pytest.raises(SystemExit):
        main(["animate", "--help"])
    assert out.errors == "strict"
    assert err.errors == "strict"


def test_a_name_cannot_command_the_terminal(folder: Path, capsys: Output) -> None:
    assert main(["animate", "girl.png", "--mask", "hair.png", "--output", "a\n\x1b[2J.avi"]) == 2
    said = capsys.readouterr().err
    assert "a\\n\\x1b[2J.avi" in said
    assert len(said.splitlines()) == 1
    for arguments in (["schema", "a\n\x1b[2J"], [*ANIMATE, "--output", "o.mp4", "--a\n\x1b[2J"]):
        with pytest.raises(SystemExit):
            main(arguments)
        assert "\x1b" not in capsys.readouterr().err


class _Broken(io.StringIO):
    """A stream whose reader is gone."""

    def write(self, text: str) -> int:
        if text:
            raise BrokenPipeError(32, "Broken pipe")
        return 0


@pytest.mark.parametrize("stream", [_Broken, type(None)])
def test_nobody_listens_and_the_work_is_done(
    folder: Path, monkeypatch: pytest.MonkeyPatch, stream: Callable[[], object]
) -> None:
    monkeypatch.setattr(sys, "stdout", stream())
    monkeypatch.setattr(sys, "stderr", stream())
    assert main([*ANIMATE, "--verbose", "--output", "o.mp4"]) == 0
    assert (folder / "o.mp4").stat().st_size > 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (
            "--save-tracks t.json --width 16 --output a.mp4 --interpolate 2 --background transparent",
            "must end in .webm",
        ),
        ("--output a.webm --interpolate 2", "one by one"),
        ("--output a.mp4 --interpolate 0", "--interpolate must be at least 1"),
        ("--output a.mp4 --fps 0.0001", "--fps must be 1 to 240"),
        ("--output a.mp4 --fps nan", "--fps must be 1 to 240"),
        ("--output a.mp4 --fps inf", "--fps must be 1 to 240"),
        ("--output a.mp4 --save-svg none/a.svg", "folder for none/a.svg must exist"),
        ("--output a.mp4 --save-tracks girl.png/t.json", "girl.png, which is no folder"),
        ("--output a.mp4 --preview shots/", "frame_0000.png, which PhysAnimator did not write"),
        ("--output shots/", "frame_0000.png, which PhysAnimator did not write"),
        ("--output=", "must be a name. Got: nothing"),
        (f"--output {'x' * 252}.mp4", "must be a name that can be written"),
        (f"--output a.mp4 --save-motion {'x' * 252}.json", "must be a name that can be written"),
    ],
)
def test_what_cannot_be_written_is_refused_before_any_picture_is_read(
    folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch, arguments: str, words: str
) -> None:
    def never(*_: object, **__: object) -> None:
        pytest.fail("the picture was loaded")

    (folder / "shots").mkdir()
    save_image("shots/frame_0000.png", np.zeros((8, 8, 3), np.uint8))
    monkeypatch.setattr("physanimator.rendering.pictures.load_image", never)
    before = contents(folder)
    assert main(["animate", "girl.png", "--mask", "hair.png", *arguments.split()]) == 2
    assert words in capsys.readouterr().err
    assert contents(folder) == before


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("--output a.webp --width 20000", "--width must be 16 to 8192"),
        ("--output a.webp --width 3510", "at most 16383 px on a side"),
        ("--output a.gif --save-flow b.webp --width 3510", "at most 16383 px on a side"),
        ("--output a.mp4 --width 8192", "at most"),
    ],
)
def test_too_large_frames_are_refused_before_the_simulation(
    folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch, arguments: str, words: str
) -> None:
    monkeypatch.setattr("physanimator.rendering.pipeline.animate", lambda *_, **__: pytest.fail("simulated"))
    save_image("page.png", np.full((300, 64, 3), 200, np.uint8))
    save_image("strand.png", np.full((300, 64), 255, np.uint8))
    assert main(["animate", "page.png", "--mask", "strand.png", *arguments.split()]) == 2
    assert words in capsys.readouterr().err


@pytest.mark.parametrize("suffix", [".mp4", ".webm", ".mov", ".gif", ".webp", ".apng"])
@pytest.mark.parametrize("rate", [0.01, 240])
def test_the_slowest_and_the_fastest_rate_are_written(tmp_path: Path, suffix: str, rate: float) -> None:
    write_animation([np.full((16, 16, 3), 30 * t, np.uint8) for t in range(3)], tmp_path / f"a{suffix}", rate)
    assert (tmp_path / f"a{suffix}").stat().st_size > 50


@pytest.mark.parametrize("rate", [1e-4, 0, -1, 241, float("nan"), float("inf"), True, "24", None, 1j])
def test_rates_that_no_format_holds(tmp_path: Path, rate: object) -> None:
    with pytest.raises(InvalidInputError, match="frame_rate must be a number from"):
        write_animation([np.zeros((8, 8, 3), np.uint8)], tmp_path / "a.mp4", rate)  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("name", "limit"), [("a.webp", 16383), ("a.mp4", 16384), ("a.gif", 65535)])
def test_frames_larger_than_the_format_holds(tmp_path: Path, name: str, limit: int) -> None:
    with pytest.raises(InvalidInputError, match=f"at most {limit} px on a side. Got: 2 x {limit + 1} px"):
        write_animation([np.zeros((limit + 1, 2, 3), np.uint8)], tmp_path / name, 24)
    write_animation([np.zeros((limit, 2, 3), np.uint8)], tmp_path / name, 24)
