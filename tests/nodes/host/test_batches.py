"""Large batches are announced with figures, and refused where there is no memory for them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from physanimator.nodes.host import announce_batch, batches
from physanimator.physics.errors import InvalidInputError


def announced(monkeypatch: pytest.MonkeyPatch, free: float | None, frames: int = 73, **options: Any) -> list[str]:
    monkeypatch.setattr(batches, "free_memory", lambda: free)
    monkeypatch.setattr(batches, "tell_user", lambda _, sentences: {"advice": list(sentences)})
    return announce_batch(None, frames, 4000, 3000, **options).get("advice", [])


def test_figures_before_4_gb(monkeypatch: pytest.MonkeyPatch) -> None:
    (sentence,) = announced(monkeypatch, 64e9, instead="use Save Animation")
    assert sentence == "73 frames of 4000 x 3000 px are 10.5 GB in memory: use Save Animation."
    (sentence,) = announced(monkeypatch, None, channels=4)
    assert "14.0 GB" in sentence
    assert announced(monkeypatch, 64e9, frames=27) == []


def test_what_does_not_fit_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InvalidInputError, match=r"are 10\.5 GB, and 8\.0 GB of memory are free: make fewer frames"):
        announced(monkeypatch, 8e9)
    with pytest.raises(InvalidInputError, match=r"are 1\.4 GB, and 1\.0 GB"):
        announced(monkeypatch, 1e9, frames=10)


def test_a_container_s_limit_counts(tmp_path: Path) -> None:
    assert batches._free_in_container(tmp_path) is None
    (tmp_path / "memory.max").write_text("8000\n")
    (tmp_path / "memory.current").write_text("5000\n")
    (tmp_path / "memory.stat").write_text("anon 4000\ninactive_file 700\n")
    assert batches._free_in_container(tmp_path) == 3700
    (tmp_path / "memory.max").write_text("max\n")
    assert batches._free_in_container(tmp_path) is None
