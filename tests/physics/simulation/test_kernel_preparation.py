"""Kernels are compiled in another process, once, and whoever waits for them may stop waiting."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from physanimator.physics.errors import Cancelled, PhysAnimatorError
from physanimator.physics.runtime import KernelCache, taichi_runtime
from physanimator.physics.simulation import compile_aside, kernel_preparation


class OtherProcess:
    """Stands for the process; notes what is asked of it."""

    def __init__(self, answer: Callable[[], None] = lambda: None) -> None:
        self.asked: list[Any] = []
        self.closed = 0
        self._answer = answer

    def call(self, _function: object, contact: bool) -> None:
        self.asked.append(contact)
        self._answer()

    def close(self) -> None:
        self.closed += 1


@pytest.fixture
def aside(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[[OtherProcess], OtherProcess]:
    """Puts another process in place, beside an empty folder for kernels."""
    monkeypatch.setattr(kernel_preparation, "kernel_cache", lambda: KernelCache(str(tmp_path), usable=True))
    monkeypatch.setattr(taichi_runtime, "compiles_here", lambda: True)
    monkeypatch.setattr(taichi_runtime, "read_anew", lambda: None)

    def put(process: OtherProcess) -> OtherProcess:
        monkeypatch.setattr(kernel_preparation, "_compiling", {})
        monkeypatch.setattr(kernel_preparation, "TaichiWorker", lambda: process)
        return process

    return put


def test_each_kind_is_compiled_once_and_not_again_in_a_later_process(
    aside: Callable[[OtherProcess], OtherProcess],
) -> None:
    process = aside(OtherProcess())
    for contact in (False, True, False, True):
        compile_aside(contact=contact)
    assert process.asked == [False, True]
    assert process.closed == 2
    later = aside(OtherProcess())
    compile_aside(contact=True)
    assert later.asked == []


def test_who_waits_may_stop_while_the_compiling_goes_on(aside: Callable[[OtherProcess], OtherProcess]) -> None:
    may_end = threading.Event()
    process = aside(OtherProcess(lambda: may_end.wait(30) and None))

    def gone() -> None:
        raise Cancelled("gone")

    with pytest.raises(Cancelled, match="gone"):
        compile_aside(contact=False, check=gone)
    may_end.set()
    compile_aside(contact=False)
    assert process.asked == [False]


@pytest.mark.parametrize("error", [PhysAnimatorError("no interpreter"), OSError("no process")])
def test_where_no_process_can_be_had_kernels_are_left_to_this_one(
    aside: Callable[[OtherProcess], OtherProcess], error: Exception, tmp_path: Path
) -> None:
    def fail() -> None:
        raise error

    process = aside(OtherProcess(fail))
    compile_aside(contact=False)
    assert process.closed == 1
    assert not list(tmp_path.iterdir()), "what was not compiled must not be noted as if it were"


def test_nothing_is_compiled_aside_where_it_could_not_be_kept(
    aside: Callable[[OtherProcess], OtherProcess], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    process = aside(OtherProcess())
    monkeypatch.setattr(kernel_preparation, "kernel_cache", lambda: KernelCache(str(tmp_path), usable=False))
    compile_aside(contact=False)
    assert process.asked == []
