"""Every command that the pages show runs, on the files that they offer: smaller, and for a few frames."""

from __future__ import annotations

import dataclasses
import re
import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest
from made_from.commands import PageCommand, commands_of, files_of, pages_of
from physanimator.rendering.artwork import load_artwork, save_psd
from physanimator.rendering.command import main
from physanimator.rendering.command.commands import command_parser
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / "nodes" / "docs"
SMALLER = 4
PAGES = [page for page in pages_of(SITE) if commands_of(page)]
WRITES = re.compile(r"--(output|preview|save-\S+)")


def _save_smaller(path: Path, folder: Path) -> None:
    """A file that a page offers, a quarter as large; coordinates go along."""
    goal = folder / path.name
    if path.suffix == ".png":
        with Image.open(path) as picture:
            picture.resize((picture.width // SMALLER, picture.height // SMALLER), Image.Resampling.BOX).save(goal)
    elif path.suffix == ".psd":
        _save_smaller_artwork(path, goal)
    elif path.suffix == ".txt":
        clicks = [line.split(",") for line in path.read_text(encoding="utf-8").split()]
        goal.write_text(
            "".join(f"{int(x) // SMALLER},{int(y) // SMALLER},{on}\n" for x, y, on in clicks), encoding="utf-8"
        )
    else:
        shutil.copy(path, goal)


def _save_smaller_artwork(path: Path, goal: Path) -> None:
    artwork = load_artwork(path)
    layers = []
    for layer in artwork.layers:
        height, width = layer.pixels.shape[:2]
        size = max(1, width // SMALLER), max(1, height // SMALLER)
        pixels = Image.fromarray(layer.pixels).resize(size, Image.Resampling.BOX)
        left, top = layer.left // SMALLER, layer.top // SMALLER
        layers.append(dataclasses.replace(layer, pixels=np.asarray(pixels), left=left, top=top))
    small = dataclasses.replace(
        artwork, width=artwork.width // SMALLER, height=artwork.height // SMALLER, layers=tuple(layers)
    )
    save_psd(small, goal)


def _for_a_few_frames(command: PageCommand) -> list[str]:
    """The arguments, with a clip as short and as small as will show that they work."""
    arguments = list(command.words[1:])
    if arguments[0] == "shots":
        return [*arguments, "--workers", "0", "--quiet"]
    if arguments[0] not in {"animate", "demo"}:
        return arguments
    if "--loop" in arguments:
        arguments[arguments.index("--loop") + 1] = "1"
    elif "--frames" in arguments:
        arguments[arguments.index("--frames") + 1] = "2"
    else:
        arguments += ["--frames", "2"]
    if "--pixel-art" not in arguments:
        arguments += ["--width", "120"]
    return [*arguments, "--quiet"]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(SITE).as_posix())
def test_the_commands_of_a_page_run_one_after_the_other(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for path in files_of(page):
        _save_smaller(path, tmp_path)
    monkeypatch.chdir(tmp_path)
    for command in commands_of(page):
        assert command.words[0] == "physanimator"
        if command.words[1] == "figure":  # of one size: test_command_line.py draws each of them
            command_parser().parse_args(command.words[1:])
            continue
        assert main(_for_a_few_frames(command)) == 0, capsys.readouterr().err
        for option, value in zip(command.words, command.words[1:], strict=False):
            assert not WRITES.fullmatch(option) or (tmp_path / value).exists(), f"{shlex.join(command.words)}: {value}"


def test_pictures_are_made_by_the_commands_beside_them() -> None:
    made = [command.picture for page in PAGES for command in commands_of(page) if command.picture]
    assert len(made) == len(set(made))
    there = {path.name for path in (SITE / "pictures").glob("*.webp")}
    # Pictures of the evaluation's clips, which take many minutes.
    figures = {name for name in there if name.startswith("ablation_")}
    assert there - figures == set(made)
    for page in pages_of(SITE):
        for command in commands_of(page):
            assert command.picture is None or command.picture in command.words
        shown = re.findall(r"!\[[^\]]*\]\((?:\.\./)?pictures/([^)]+)\)", page.read_text(encoding="utf-8"))
        assert set(shown) <= set(made) | figures


def test_the_pictures_move_and_are_small() -> None:
    total = 0
    for page in PAGES:
        for command in commands_of(page):
            if command.picture:
                path = SITE / "pictures" / command.picture
                total += path.stat().st_size
                with Image.open(path) as picture:
                    assert command.words[1] == "figure" or getattr(picture, "n_frames", 1) == 24
    assert total < 2_500_000


def _readme_commands() -> list[str]:
    text = (ROOT / "README.md").read_text(encoding="utf-8").replace("\\\n", " ")
    return re.findall(
        r"^(?:.* )?(?:\S*/)?(physanimator (?:animate|demo|layers|figure|measure)\b[^`\n]*)", text, re.MULTILINE
    )


@pytest.mark.parametrize("line", _readme_commands())
def test_the_readmes_commands_are_understood(line: str) -> None:
    words = shlex.split(line)
    if len(words) > 3:
        assert command_parser().parse_args(words[1:]).command == words[1]


def test_the_readme_shows_commands() -> None:
    assert len(_readme_commands()) >= 6
