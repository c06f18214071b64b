"""How many threads this process may use, and that nothing beside it is begun where that is one."""

from __future__ import annotations

import os

import cv2
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.threads import THREADS, allowed_threads, keep_to_threads, thread_variables, usable_cores


def test_all_cores_unless_the_environment_says_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(THREADS, raising=False)
    assert allowed_threads() == usable_cores()
    for said in ("3", " 3 "):
        monkeypatch.setenv(THREADS, said)
        assert allowed_threads() == 3


@pytest.mark.parametrize("said", ["0", "-1", "two", "1.5", "1025", "²"])
def test_what_is_no_number_of_threads_is_refused(monkeypatch: pytest.MonkeyPatch, said: str) -> None:
    monkeypatch.setenv(THREADS, said)
    with pytest.raises(InvalidInputError, match=r"PHYSANIMATOR_THREADS must be 1 to 1024\. Got: "):
        allowed_threads()


def test_libraries_keep_to_them_unless_they_are_told_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    before = cv2.getNumThreads()
    for name in thread_variables(1):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("MKL_NUM_THREADS", "4")
    monkeypatch.setattr(os, "environ", os.environ.copy())
    try:
        keep_to_threads(1)
        assert cv2.getNumThreads() == 1
        assert os.environ["OMP_NUM_THREADS"] == os.environ[THREADS] == "1"
        assert os.environ["MKL_NUM_THREADS"] == "4"
    finally:
        cv2.setNumThreads(before)
