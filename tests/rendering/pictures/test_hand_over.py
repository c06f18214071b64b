"""Frames are drawn and written by two threads, which end together."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from physanimator.physics.interruption import checkpoint, interruptible
from physanimator.physics.threads import THREADS
from physanimator.rendering.pictures import video, write_animation
from physanimator.rendering.pictures.hand_over import consumed_beside

FRAME = np.full((32, 32, 3), 120, np.uint8)


@pytest.fixture(autouse=True)
def two_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(THREADS, "2")


def writing_threads() -> list[threading.Thread]:
    return [each for each in threading.enumerate() if each.name == "physanimator-beside"]


def test_all_items_arrive_in_order_in_another_thread() -> None:
    found, threads = [], set()

    def consume(items: Iterator[int]) -> None:
        for item in items:
            threads.add(threading.get_ident())
            found.append(item)

    consumed_beside(range(50), consume)
    assert found == list(range(50))
    assert threading.get_ident() not in threads


def test_items_are_made_while_earlier_ones_are_consumed_but_not_far_ahead() -> None:
    made, most = [], []

    def items() -> Iterator[int]:
        for number in range(20):
            made.append(number)
            yield number

    def consume(arriving: Iterator[int]) -> None:
        for number in arriving:
            time.sleep(0.01)
            most.append(made[-1] - number)

    consumed_beside(items(), consume, ahead=2)
    assert 1 <= max(most) <= 4  # two wait, one is consumed, one is about to be handed over


def test_of_one_thread_each_is_consumed_before_the_next_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(THREADS, "1")
    made: list[int] = []

    def items() -> Iterator[int]:
        for number in range(20):
            made.append(number)
            yield number

    def consume(arriving: Iterator[int]) -> None:
        for number in arriving:
            assert made[-1] == number
            assert not writing_threads()

    consumed_beside(items(), consume)
    assert made == list(range(20))

    def refuse() -> None:
        raise InterruptedError

    with pytest.raises(InterruptedError), interruptible(refuse):
        write_animation([FRAME] * 3, tmp_path / "clip.mp4", 24.0)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("threads", ["1", "2"])
@pytest.mark.parametrize("error", [ValueError("drawn badly"), KeyboardInterrupt()])
def test_an_error_while_drawing_stops_the_writing_and_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, threads: str
) -> None:
    monkeypatch.setenv(THREADS, threads)

    def frames() -> Iterator[np.ndarray]:
        yield from [FRAME] * 5
        raise error

    with pytest.raises(type(error)):
        write_animation(frames(), tmp_path / "clip.mp4", 24.0)
    assert not list(tmp_path.iterdir())
    assert not writing_threads()


@pytest.mark.parametrize("error", [OSError(28, "no space left"), MemoryError(), ValueError("encoded badly")])
def test_an_error_while_writing_stops_the_drawing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException
) -> None:
    drawn = []

    def frames() -> Iterator[np.ndarray]:
        for number in range(1000):
            drawn.append(number)
            yield FRAME

    def fail(items: Iterator[np.ndarray], *_: object, **__: object) -> None:
        next(items)
        raise error

    monkeypatch.setattr(video, "encode", fail)
    with pytest.raises(type(error)):
        write_animation(frames(), tmp_path / "clip.mp4", 24.0)
    assert len(drawn) < 10
    assert not list(tmp_path.iterdir())
    assert not writing_threads()


def test_what_goes_on_after_the_last_item_stops_at_a_checkpoint(monkeypatch: pytest.MonkeyPatch) -> None:
    went_on = threading.Event()

    def consume(items: Iterator[int]) -> None:
        list(items)
        went_on.set()
        while True:
            checkpoint()
            time.sleep(0.01)

    class Interrupted(threading.Thread):
        """A thread that a signal reaches while it is waited for."""

        def join(self, timeout: float | None = None) -> None:
            if went_on.wait(5) and not hasattr(self, "told"):
                self.told = True
                raise KeyboardInterrupt
            super().join(timeout)

    monkeypatch.setattr(threading, "Thread", Interrupted)
    with pytest.raises(KeyboardInterrupt):
        consumed_beside([1], consume)
    assert not writing_threads()
