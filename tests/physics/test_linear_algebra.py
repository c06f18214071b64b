"""That linear algebra keeps to one thread where it is asked to, and is left as it was."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator

import pytest
import scipy.sparse.linalg  # noqa: F401  (loads SciPy's own library)
from physanimator.physics.linear_algebra import THREADS_OF_ALGEBRA, begin_on_one_thread, on_one_thread
from physanimator.physics.runtime import TaichiWorker
from threadpoolctl import ThreadpoolController


@pytest.fixture
def libraries(monkeypatch: pytest.MonkeyPatch) -> Iterator[ThreadpoolController]:
    """OpenBLAS with two threads."""
    found = ThreadpoolController().select(internal_api="openblas")
    if not found.lib_controllers:
        pytest.skip("NumPy and SciPy have another library here")
    monkeypatch.delenv(THREADS_OF_ALGEBRA, raising=False)
    with found.limit(limits=2):
        yield found


def threads(libraries: ThreadpoolController) -> set[int]:
    return {each["num_threads"] for each in libraries.info()}


def test_one_thread_inside_and_as_before_outside(libraries: ThreadpoolController) -> None:
    @on_one_thread
    def inside() -> set[int]:
        return threads(libraries)

    assert inside() == {1}
    assert threads(libraries) == {2}
    with pytest.raises(ValueError, match="wrong"), on_one_thread:
        raise ValueError("wrong")
    assert threads(libraries) == {2}


def test_blocks_of_two_threads_may_overlap(libraries: ThreadpoolController) -> None:
    entered, leave = threading.Event(), threading.Event()

    def other() -> None:
        with on_one_thread, on_one_thread:
            entered.set()
            leave.wait(30)

    thread = threading.Thread(target=other)
    with on_one_thread:
        thread.start()
        assert entered.wait(30)
        assert threads(libraries) == {1}
    leave.set()
    thread.join(30)
    assert threads(libraries) == {2}
    with on_one_thread:
        assert threads(libraries) == {1}


def test_a_process_that_has_loaded_numpy_is_left_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(THREADS_OF_ALGEBRA, raising=False)
    begin_on_one_thread()
    assert THREADS_OF_ALGEBRA not in os.environ


@pytest.mark.parametrize(("told", "used"), [(None, "1"), ("3", "3")])
def test_the_process_for_kernels_begins_on_one_thread(
    monkeypatch: pytest.MonkeyPatch, told: str | None, used: str
) -> None:
    monkeypatch.delenv(THREADS_OF_ALGEBRA, raising=False)
    if told is not None:
        monkeypatch.setenv(THREADS_OF_ALGEBRA, told)
    worker = TaichiWorker()
    try:
        assert worker.call(os.getenv, THREADS_OF_ALGEBRA) == used
    finally:
        worker.close()
