"""Sets as TOML: what is read, and one sentence for whatever is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.evaluation.methods import ABLATIONS, METHODS
from physanimator.rendering.evaluation.set_document import read_set

GOOD = """
frames = 24
methods = ["composite", {name = "theirs", clips = "clips"}]
[[pictures]]
name = "one"
image = "one.png"
masks = ["mask.png"]
"""


def written(folder: Path, text: str) -> Path:
    file = folder / "set.toml"
    file.write_text(text, encoding="utf-8")
    return file


def test_paths_are_meant_from_the_file(tmp_path: Path) -> None:
    found = read_set(written(tmp_path, GOOD))
    assert found.pictures[0].image == str(tmp_path / "one.png")
    assert found.pictures[0].masks == (str(tmp_path / "mask.png"),)
    assert found.methods[1].clips == str(tmp_path / "clips")
    assert [each.name for each in found.compared] == ["composite", "theirs"]
    assert found.compared[0] == METHODS["composite"]


def test_ablations_add_their_methods_once(tmp_path: Path) -> None:
    found = read_set(written(tmp_path, GOOD.replace("frames = 24", 'ablations = ["masks"]')))
    names = [each.name for each in found.compared]
    assert set(ABLATIONS["masks"]) < set(names)
    assert len(names) == len(set(names))


@pytest.mark.parametrize(
    ("before", "after", "says"),
    [
        ("frames = 24", "frmes = 24", "did you mean frames?). Got: frmes"),
        ("frames = 24", "frames = 1", "frames must be a whole number from 2 to 2000. Got: 1"),
        ("frames = 24", 'frames = "24"', "frames must be a whole number. Got: 24"),
        ("frames = 24", "frames = 24.5", "frames must be a whole number. Got: 24.5"),
        ("frames = 24", "frames = 99999999999999999999999999999", "frames must be a whole number"),
        ("frames = 24", "frames = " + "9" * 5000, "must be TOML"),
        ("frames = 24", "rate = nan", "rate must be a number from 1 to 240"),
        ("frames = 24", "rate = inf", "rate must be a number"),
        ("frames = 24", "rate = true", "rate must be a number. Got: True"),
        ("frames = 24", "samples = 0", "samples must be a whole number from 1"),
        ("frames = 24", "frames = 2024-01-01", "Got: a date"),
        ("frames = 24", "a = " + "[" * 3000 + "]" * 3000, "must be TOML"),
        ("frames = 24", 'ablations = ["mask"]', "did you mean masks?"),
        ("frames = 24", "frames = 24\nframes = 24", "must be TOML"),
        ('"composite"', '"composit"', "did you mean composite?). Got: 'composit'"),
        ('"composite"', "3", "methods[0] must be a table. Got: 3"),
        ('image = "one.png"', "", "pictures[0].image must be given. Got: nothing"),
        ('image = "one.png"', "image = 3", "pictures[0].image must be text in quotes. Got: 3"),
        ('masks = ["mask.png"]', 'masks = "mask.png"', "pictures[0].masks must be a list"),
        ('masks = ["mask.png"]', 'mask = ["mask.png"]', "did you mean masks?). Got: mask"),
        ('name = "one"', 'name = "../one"', "name must be 1 to 60 letters that can name a folder"),
        ('name = "one"', 'name = ".."', "name must be 1 to 60 letters"),
        ('name = "one"', 'name = "con"', "name must be 1 to 60 letters"),
        ('name = "one"', 'name = ""', "name must be 1 to 60 letters"),
        ('clips = "clips"', 'clips = "clips", draws = "composite"', "either draws or clips. Got: both"),
        ('clips = "clips"', 'draws = "composite", sketch_blur = 3', "sketch_blur must be left out with composite"),
        ('clips = "clips"', 'draws = "composite", mask_error = "grwn"', "did you mean grown?"),
        ('clips = "clips"', 'draws = "composit"', "did you mean composite?"),
        ('name = "theirs"', 'name = "composite"', "must have names of their own"),
        ('name = "theirs"', 'name = "COMPOSITE"', "must have names of their own"),
        ('name = "theirs"', 'name = "warp-inpaint"', "must have a name of its own"),
    ],
)
def test_what_is_wrong_is_said_in_one_sentence(tmp_path: Path, before: str, after: str, says: str) -> None:
    with pytest.raises(InvalidInputError) as refused:
        read_set(written(tmp_path, GOOD.replace(before, after, 1)))
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)


def test_names_of_pictures_differ_on_every_system(tmp_path: Path) -> None:
    twice = GOOD + '[[pictures]]\nname = "ONE"\nimage = "one.png"\nmasks = ["mask.png"]\n'
    with pytest.raises(InvalidInputError, match="pictures must have names of their own"):
        read_set(written(tmp_path, twice))


def test_a_file_that_is_none(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"SET must be a readable text file\. Got: .*absent.toml: No such file"):
        read_set(tmp_path / "absent.toml")
    (tmp_path / "binary.toml").write_bytes(b"\xff\x00\x00")
    with pytest.raises(InvalidInputError, match="it is not text in UTF-8"):
        read_set(tmp_path / "binary.toml")
