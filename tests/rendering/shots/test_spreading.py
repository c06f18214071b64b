"""Frames of one shot drawn by several workers: the same pictures in the same order, whatever becomes of workers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from physanimator.rendering.animation import Animation
from physanimator.rendering.frame_drawing import frames_drawn_by
from physanimator.rendering.options import Timing
from physanimator.rendering.pipeline import animate
from physanimator.rendering.shots import spreading

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def animation() -> Animation:
    picture = np.full((40, 40, 3), 230, np.uint8)
    picture[8:32, 12:28] = (200, 60, 40)
    mask = np.zeros((40, 40))
    mask[8:32, 12:28] = 1
    return animate(picture, [mask], timing=Timing(frames=40), spacing=8)


class Worker:
    """A cluster of two threads, of which one is at work, that does everything at once."""

    def __init__(self, lost: int | None = None) -> None:
        self.drawn: list[Any] = []
        self.lost = lost

    def nthreads(self) -> dict[str, int]:
        return {"a": 1, "b": 1}

    def processing(self) -> dict[str, Any]:
        return {"a": ("shot",), "b": ()}

    def scatter(self, value: Any, **_: Any) -> Any:
        return value

    def submit(self, call: Any, *values: Any, **_: Any) -> Any:
        self.drawn.append(values[1])
        status = "error" if len(self.drawn) - 1 == self.lost else "finished"
        return Done(status, call(*values) if status == "finished" else None)

    def cancel(self, futures: Any, **_: Any) -> None:
        assert list(futures) == []


class Done:
    def __init__(self, status: str, value: Any) -> None:
        self.status, self.value = status, value

    def done(self) -> bool:
        return True

    def result(self) -> Any:
        return self.value


@pytest.mark.parametrize("lost", [None, 1])
@pytest.mark.parametrize("background", ["picture", "parts"])
def test_workers_draw_the_same_frames(
    animation: Animation, monkeypatch: pytest.MonkeyPatch, background: str, lost: int | None
) -> None:
    monkeypatch.setattr(spreading, "LONG", 20)
    told: list[str] = []
    client: Any = Worker(lost)
    draw = spreading.drawing_on_idle_workers(client, lambda: told.append("leave"), lambda: told.append("back"))
    alone = list(animation.frames(background=background))
    with frames_drawn_by(draw):
        spread = list(animation.frames(background=background))
    assert [list(each) for each in client.drawn] == [list(range(0, 16)), list(range(16, 32)), list(range(32, 40))]
    assert told == ["leave", "back"]
    assert len(spread) == 40
    assert all(np.array_equal(one, other) for one, other in zip(alone, spread, strict=True))


def test_short_shots_stay_where_they_are(animation: Animation) -> None:
    client: Any = Worker()
    with frames_drawn_by(spreading.drawing_on_idle_workers(client, list, list)):
        assert len(list(animation.frames())) == 40
    assert client.drawn == []


def test_a_renderer_travels(animation: Animation) -> None:
    """Pickled, as Dask does it, it draws the same."""
    import pickle

    from physanimator.rendering.composite import Background, shown_frame

    there = pickle.loads(pickle.dumps(animation.renderer))
    for t in (0, 20, 39):
        here = shown_frame(animation.renderer, t, Background())
        assert np.array_equal(shown_frame(there, t, Background()), here)
