"""Signals that end a process unwind it, once, and never in the middle of putting files in their places."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from physanimator.rendering.files import (
    ending_signals,
    hear_signals,
    ignore_signals,
    made_beside,
    remove_unfinished,
    replacing,
    uninterrupted,
)
from physanimator.rendering.files.signals import Ended, clearing_up

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


def test_ctrl_c_waits_in_the_library_as_well() -> None:
    done = []
    with pytest.raises(KeyboardInterrupt) as stopped, clearing_up(lambda: None), uninterrupted():
        send(signal.SIGINT)
        done.append("finished")
    assert done == ["finished"]
    assert type(stopped.value) is KeyboardInterrupt  # of nothing else Python makes exit status 130


def test_whoever_handles_signals_in_a_script_goes_on_doing_so(tmp_path: Path) -> None:
    heard = []
    before = signal.signal(signal.SIGTERM, lambda *_: heard.append(1))
    try:
        with replacing(tmp_path / "a.txt") as temporary:
            send(signal.SIGTERM)
            temporary.write_text("whole", encoding="utf-8")
    finally:
        signal.signal(signal.SIGTERM, before)
    assert heard == [1]
    assert [each.name for each in tmp_path.iterdir()] == ["a.txt"]


def test_a_command_hears_signals_while_it_writes(tmp_path: Path) -> None:
    with pytest.raises(Ended), ending_signals(), replacing(tmp_path / "a.txt"):
        send(signal.SIGTERM)
    assert not list(tmp_path.iterdir())


def test_a_fork_removes_nothing_of_the_process_that_it_is_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with made_beside("a.txt", tmp_path) as made:
        with monkeypatch.context() as in_the_fork:
            in_the_fork.setattr(os, "getpid", lambda: -1)
            remove_unfinished()
        assert made.exists()
        remove_unfinished()
        assert not made.exists()


def test_a_folder_goes_while_somebody_writes_into_it(tmp_path: Path) -> None:
    stop = threading.Event()

    def write(folder: Path) -> None:
        number = 0
        while not stop.is_set() and number < 200_000:
            number += 1
            try:
                (folder / f"frame_{number}.png").write_bytes(b"0")
            except OSError:
                return

    with made_beside("frames", tmp_path, is_folder=True) as made:
        writing = [threading.Thread(target=write, args=(made,)) for _ in range(3)]
        for each in writing:
            each.start()
        while len(list(made.iterdir())) < 50:
            pass
        remove_unfinished()
        left = list(tmp_path.iterdir())
        stop.set()
        for each in writing:
            each.join()
    assert left == []
