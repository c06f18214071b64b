"""Signals that end a process unwind it, once, and never in the middle of putting files in their places."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from physanimator.rendering.files import ending_signals, hear_signals, ignore_signals, replacing, uninterrupted
from physanimator.rendering.files.signals import Ended

# Where a signal is heard is the very thing: the blocks are as long as that takes.
# ruff: noqa: PT012, SIM105

pytestmark = pytest.mark.skipif(os.name == "nt", reason="os.kill ends the process on Windows")

SIGNALS = [signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else [])]


def send(number: int) -> None:
    os.kill(os.getpid(), number)


@pytest.fixture(autouse=True)
def handlers() -> Iterator[None]:
    before = [signal.getsignal(number) for number in SIGNALS]
    yield
    assert [signal.getsignal(number) for number in SIGNALS] == before


@pytest.mark.parametrize("number", SIGNALS)
def test_a_signal_unwinds(number: int) -> None:
    unwound = False
    with pytest.raises(Ended) as ended, ending_signals():
        try:
            send(number)
            pytest.fail("went on")
        finally:
            unwound = True
    assert unwound
    assert ended.value.status == 128 + number
    assert isinstance(ended.value, KeyboardInterrupt)


def test_an_ignored_signal_stays_ignored() -> None:
    before = signal.signal(signal.SIGTERM, signal.SIG_IGN)
    try:
        with ending_signals():
            send(signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, before)


def test_a_handler_of_somebody_else_stays() -> None:
    heard = []
    before = signal.signal(signal.SIGTERM, lambda *_: heard.append(1))
    try:
        with ending_signals():
            send(signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, before)
    assert heard == [1]


def test_a_block_is_finished_first() -> None:
    done = []
    with pytest.raises(Ended) as ended, ending_signals(), uninterrupted():
        with uninterrupted():
            send(signal.SIGTERM)
            done.append("inner")
        done.append("outer")
    assert done == ["inner", "outer"]
    assert ended.value.number == signal.SIGTERM


def test_a_signal_that_is_sent_twice_does_not_disturb_the_cleaning_up() -> None:
    with pytest.raises(Ended), ending_signals():
        try:
            send(signal.SIGTERM)
        finally:
            send(signal.SIGTERM)
            send(signal.SIGINT)
            cleaned = True
    assert cleaned


def test_a_swallowed_signal_is_heard_at_the_next_step() -> None:
    with pytest.raises(Ended), ending_signals():
        hear_signals()
        try:
            send(signal.SIGTERM)
        except Ended:
            pass
        hear_signals()
    hear_signals()


def test_nothing_arrives_while_the_process_ends() -> None:
    with ending_signals():
        ignore_signals()
        send(signal.SIGTERM)


def test_other_threads_are_left_alone() -> None:
    seen = []

    def work() -> None:
        before = signal.getsignal(signal.SIGTERM)
        with ending_signals(), uninterrupted():
            seen.append(signal.getsignal(signal.SIGTERM) is before)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [True]


def test_a_file_is_replaced_whole_although_a_signal_comes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """At every step of the exchange: either the earlier file is there or the new one, and nothing else."""
    path, steps = tmp_path / "a.txt", 0
    for name in ("chmod", "replace", "unlink", "open", "close"):
        real = getattr(os, name)

        def and_signal(*arguments: object, real: object = real, **options: object) -> object:
            nonlocal steps
            steps += 1
            send(signal.SIGTERM)
            return real(*arguments, **options)  # type: ignore[operator]

        path.write_text("earlier")
        with monkeypatch.context() as patched, pytest.raises(Ended), ending_signals():
            patched.setattr(os, name, and_signal)
            with replacing(path) as temporary, open(temporary, "w", encoding="ascii") as stream:
                stream.write("new")
        assert path.read_text() in ("earlier", "new")
        assert list(tmp_path.iterdir()) == [path]
    assert steps >= 5
