"""Texts that people write: in what encodings they are read, and one sentence for what is none."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.files import parsed_toml, read_text_file


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_what_editors_of_every_system_save_is_read(tmp_path: Path, encoding: str) -> None:
    (tmp_path / "list.toml").write_text('name = "風"\n', encoding=encoding)
    text = read_text_file(tmp_path / "list.toml", "SHOTS")
    assert parsed_toml(text, "list.toml", "SHOTS") == {"name": "風"}


def test_what_is_no_text_is_told(tmp_path: Path) -> None:
    (tmp_path / "picture.png").write_bytes(b"\x89PNG\xff")
    (tmp_path / "long.txt").write_text("12345")
    for name, told in (
        ("absent.txt", "--points must be a readable text file. Got: .*: No such file or directory"),
        ("picture.png", "it is not text in UTF-8"),
        ("", "--points must be a readable text file"),
    ):
        with pytest.raises(InvalidInputError, match=told):
            read_text_file(tmp_path / name, "--points")
    assert read_text_file(tmp_path / "long.txt", "--points", most=5) == "12345"
    with pytest.raises(InvalidInputError, match=r"must be at most 0 MB of text\. Got: more"):
        read_text_file(tmp_path / "long.txt", "--points", most=4)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes on this system")
def test_nobody_waits_for_a_pipe(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.toml")
    with pytest.raises(InvalidInputError, match="which is a named pipe"):
        read_text_file(tmp_path / "pipe.toml", "config")


def test_what_is_no_toml_is_told() -> None:
    for text in ("a = ", f"a = {'9' * 5000}", "a = " + "[" * 3000 + "]" * 3000):
        with pytest.raises(InvalidInputError, match=r"config run\.toml must be TOML\. Got: "):
            parsed_toml(text, "run.toml", "config")
