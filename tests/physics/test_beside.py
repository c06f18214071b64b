"""What another thread makes meanwhile: its result, its errors, and that it ends with the block."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import pytest
from physanimator.physics.beside import Beside, made_ahead, side_by_side
from physanimator.physics.interruption import checkpoint, interruptible
from physanimator.physics.threads import THREADS


@pytest.fixture(autouse=True)
def nothing_goes_on(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv(THREADS, "2")
    yield
    assert not [each for each in threading.enumerate() if each.name.startswith("physanimator-beside")]


def endless() -> None:
    while True:
        checkpoint()
        time.sleep(0.005)


def test_the_result_is_made_in_another_thread() -> None:
    with Beside(threading.get_ident) as making:
        assert making.result() != threading.get_ident()
    assert making.ended


def test_of_one_thread_it_is_made_at_once_in_that(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(THREADS, "1")
    this = threading.get_ident()
    with Beside(threading.get_ident) as making:
        assert making.ended
        assert making.result() == this
    assert list(side_by_side(lambda _: threading.get_ident(), range(3))) == [this] * 3
    with pytest.raises(ZeroDivisionError), Beside(lambda: 1 // 0):
        pytest.fail("the block must not begin")


def test_an_error_is_raised_where_the_result_is_wanted() -> None:
    def fail() -> None:
        raise ValueError("made badly")

    with Beside(fail) as making:
        while not making.ended:
            time.sleep(0.005)
        with pytest.raises(ValueError, match="made badly"):
            making.check()
    with pytest.raises(ValueError, match="made badly"):
        making.result()


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_whoever_leaves_by_an_error_gives_it_up(error: type[BaseException]) -> None:
    with pytest.raises(error), Beside(endless):
        raise error


def test_it_can_be_given_up_while_it_is_waited_for() -> None:
    def stop() -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), Beside(endless) as making:
        making.result(meanwhile=stop)


def test_what_the_caller_asks_at_checkpoints_is_asked_there_too() -> None:
    asked = []

    def check() -> None:
        asked.append(threading.get_ident())
        if len(asked) > 2:
            raise InterruptedError

    with interruptible(check), pytest.raises(InterruptedError), Beside(endless) as making:
        making.result()
    assert threading.get_ident() not in asked


def test_results_side_by_side_keep_their_order() -> None:
    def slow_first(number: int) -> int:
        time.sleep(0.05 if number == 0 else 0)
        return number * number

    assert list(side_by_side(slow_first, range(6))) == [0, 1, 4, 9, 16, 25]


def test_the_longest_begins_first_side_by_side() -> None:
    begun = []

    def last(number: int) -> int:
        begun.append(number)
        time.sleep(0.02)
        return number

    assert list(side_by_side(last, range(6), work=[1, 2, 9, 3, 8, 4])) == [0, 1, 2, 3, 4, 5]
    assert set(begun[:2]) == {2, 4}
    assert set(begun[-2:]) == {0, 1}


def test_the_first_error_side_by_side_leaves_out_the_rest() -> None:
    begun = []

    def fail(number: int) -> int:
        begun.append(number)
        time.sleep(0.02)
        raise ValueError(f"number {number}")

    with pytest.raises(ValueError, match="number 0"):
        list(side_by_side(fail, range(200)))
    assert len(begun) < 100


def test_what_is_made_ahead_keeps_its_order_and_is_bounded() -> None:
    begun: list[int] = []

    def make(number: int) -> int:
        begun.append(number)
        time.sleep(0.02 if number % 2 else 0.001)
        return number

    making = made_ahead(make, range(20), most=2)
    assert next(making) == 0
    assert begun == [0]
    for number in range(1, 20):
        assert next(making) == number
        assert len(begun) <= number + 4
    assert sorted(begun) == list(range(20))
    assert list(making) == []


def test_two_are_made_ahead_at_once() -> None:
    both = threading.Barrier(2, timeout=30)
    assert list(made_ahead(lambda number: number and both.wait() * 0 + number, range(5), most=2)) == [0, 1, 2, 3, 4]


def test_an_error_ahead_comes_in_its_turn() -> None:
    making = made_ahead(lambda number: 6 // (3 - number), range(9))
    assert [next(making) for _ in range(3)] == [2, 3, 6]
    with pytest.raises(ZeroDivisionError):
        next(making)


def test_whoever_leaves_what_is_made_ahead_ends_it() -> None:
    asked: list[int] = []

    def arguments() -> Iterator[int]:
        for number in range(1000):
            asked.append(number)
            yield number

    making = made_ahead(lambda number: number, arguments())
    assert [next(making) for _ in range(4)] == [0, 1, 2, 3]
    making.close()
    assert len(asked) < 12


def test_of_one_thread_nothing_is_made_ahead(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(THREADS, "1")
    made: list[int] = []
    making = made_ahead(lambda number: made.append(number) or threading.get_ident(), range(3))
    assert next(making) == threading.get_ident()
    assert made == [0]
