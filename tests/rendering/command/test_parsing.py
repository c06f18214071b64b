"""Options that take several values, before and after the picture: nothing is taken for something else in silence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from physanimator.rendering.command import main
from physanimator.rendering.command.commands import command_parser
from physanimator.rendering.pictures import save_image

Output = pytest.CaptureFixture[str]


def parsed(line: str) -> tuple[str, list[str], list[str] | None, list[str]]:
    """Picture, masks, presets and colliders of a command."""
    options = command_parser().parse_args(line.split())
    return options.image, options.mask, options.preset, options.collider


@pytest.mark.parametrize("command", ["animate", "measure"])
@pytest.mark.parametrize(
    ("line", "masks", "presets", "colliders"),
    [
        ("girl.png --mask a.png b.png", "a.png b.png", None, ""),
        ("girl.png --mask a.png b.png --preset hair cloth", "a.png b.png", "hair cloth", ""),
        ("girl.png --mask a.png --mask b.png --collider c.png d.png", "a.png b.png", None, "c.png d.png"),
        ("--mask a.png b.png girl.png", "a.png b.png", None, ""),
        ("--mask a.png girl.png --frames 3", "a.png", None, ""),
        ("--frames 3 --mask a.png girl.png", "a.png", None, ""),
        ("--mask a.png --frames 3 girl.png", "a.png", None, ""),
        ("--mask=a.png girl.png", "a.png", None, ""),
        ("--mask a.png --loop 2 girl.png --mask b.png", "a.png b.png", None, ""),
        ("--mask a.png -- girl.png", "a.png", None, ""),
        ("--mask a.png --preset hair girl.png", "a.png", "hair", ""),
        ("--preset hair girl.png --mask a.png", "a.png", "hair", ""),
        ("--preset hair cloth --mask a.png b.png girl.png", "a.png b.png", "hair cloth", ""),
        ("--mask a.png b.png girl.png --preset hair cloth", "a.png b.png", "hair cloth", ""),
        ("--collider c.png girl.png --mask a.png", "a.png", None, "c.png"),
        ("--mask a.png --collider c.png d.png girl.png", "a.png", None, "c.png d.png"),
        ("--mask a.png --wind -1 girl.png", "a.png", None, ""),
    ],
)
def test_the_picture_may_stand_anywhere(
    command: str, line: str, masks: str, presets: str | None, colliders: str
) -> None:
    end = " --output o.mp4" if command == "animate" else ""
    both = [f"{command} {line}{end}", f"{command}{end} {line}"]
    for given in both[" -- " in line :]:
        assert parsed(given) == ("girl.png", masks.split(), presets and presets.split(), colliders.split())


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("--mask a.png", "IMAGE must be given"),
        ("--mask a.png --mask b.png", "IMAGE must be given"),
        ("--mask a.png --preset hair cloth", "IMAGE must be given"),
        ("--mask", "--mask must have a value. Got: none"),
        (
            "--mask a.png b.png --collider c.png d.png",
            "IMAGE must stand before the options where it could be b.png or d.png",
        ),
        ("--mask a.png b.png --mask c.png d.png", "could be b.png or d.png"),
        ("--mask a.png girl.png --frames many", "--frames must be a whole number. Got: 'many'"),
        ("--mask a.png girl.png --fps fast", "--fps must be a number. Got: 'fast'"),
        ("--mask a.png girl.png --attach middle", "--attach must be one of 'auto', 'top'"),
        ("girl.png other.png --mask a.png", "must be among those of --help. Got: other.png"),
        ("--mask a.png girl.png --colour red", "must be among those of --help. Got: --colour"),
    ],
)
def test_what_is_ambiguous_or_missing_is_refused(capsys: Output, line: str, words: str) -> None:
    with pytest.raises(SystemExit) as ended:
        parsed(f"animate --output o.mp4 {line}")
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert words in said
    assert said.startswith("physanimator: ")
    assert said.count("\n") == 1


def test_the_output_is_still_required(capsys: Output) -> None:
    with pytest.raises(SystemExit):
        parsed("animate --mask a.png girl.png")
    assert "--output/-o must be given" in capsys.readouterr().err


def test_a_mask_is_not_taken_for_the_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Output) -> None:
    monkeypatch.chdir(tmp_path)
    y, x = np.mgrid[0:48, 0:64]
    strip = (np.abs(x - 30) < 6) & (y > 4) & (y < 40)
    save_image("girl.png", np.stack([80 + x, 200 - y, 160 + 0 * x], axis=-1).astype(np.uint8))
    for name in ("hair.png", "skirt.png"):
        save_image(name, strip.astype(np.uint8) * 255)
    assert main(["animate", "--mask", "hair.png", "skirt.png", "--frames", "2", "--output", "o.mp4"]) == 2
    assert "skirt.png, the last value of --mask, which looks like a mask" in capsys.readouterr().err
    assert not Path("o.mp4").exists()
    assert main(["animate", "--mask", "hair.png", "girl.png", "--frames", "2", "--output", "o.mp4"]) == 0
    assert "girl.png, the last value of --mask, is taken as the picture" in capsys.readouterr().err
