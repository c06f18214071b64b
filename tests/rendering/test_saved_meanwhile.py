"""Animations that are written while they are still simulated."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError, SimulationError
from physanimator.physics.threads import THREADS
from physanimator.rendering import pipeline
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.options import Saving, Timing, Watch
from physanimator.rendering.pictures import load_image
from physanimator.rendering.pipeline import animate

FRAMES = 6


@pytest.fixture(autouse=True)
def two_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(THREADS, "2")


def animated(save: Saving | None = None, **more: Any) -> Any:
    y, x = np.mgrid[0:64, 0:80]
    picture = np.stack([80 + x, 200 - y, 160 + 0 * x], axis=-1).astype(np.uint8)
    strip = (np.abs(x - 40) < 7) & (y > 5) & (y < 55)
    picture[strip] = (200, 60, 40)
    timing = more.pop("timing", Timing(frames=FRAMES))
    return animate(picture, [strip], spacing=8, timing=timing, save=save, **more)


def beside() -> list[threading.Thread]:
    return [each for each in threading.enumerate() if each.name.startswith("physanimator-beside")]


def test_frames_are_those_that_are_saved_afterwards(tmp_path: Path) -> None:
    for timing in (Timing(frames=FRAMES), Timing(frames=FRAMES, skip=2), Timing(frames=12, loop=0.5)):
        saved = animated(Saving(f"{tmp_path}/{timing.skip}{timing.loop}/"), timing=timing)
        written = sorted((tmp_path / f"{timing.skip}{timing.loop}").glob("*.png"))
        frames = list(saved.frames())
        assert len(written) == len(frames) == len(saved) > 1
        assert all((load_image(path) == frame).all() for path, frame in zip(written, frames, strict=True))
        assert (frames[-1] != frames[0]).any()
    animated(Saving(f"{tmp_path}/white/", "white", 40))
    assert load_image(tmp_path / "white" / "frame_0000.png").shape == (32, 40, 3)


def test_a_frame_is_drawn_before_the_next_ones_are_simulated(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn, frame = threading.Event(), LayeredRenderer.frame

    def noted(self: LayeredRenderer, t: int) -> Any:
        drawn.set()
        return frame(self, t)

    def simulated(stage: str, done: int, total: int) -> None:
        if stage == "simulate" and done == 3:
            assert drawn.wait(20)

    monkeypatch.setattr(LayeredRenderer, "frame", noted)
    animated(Saving(tmp_path / "clip.mp4"), watch=Watch(simulated))
    assert (tmp_path / "clip.mp4").stat().st_size > 0


def test_every_step_is_told_in_the_calling_thread(tmp_path: Path) -> None:
    steps: list[tuple[str, int, int]] = []
    threads = set()

    def hear(*step: Any) -> None:
        threads.add(threading.current_thread())
        steps.append(step)

    animation = animated(Saving(tmp_path / "clip.mp4"), watch=Watch(hear))
    told = [(stage, done, FRAMES) for stage in ("simulate", "render") for done in range(1, FRAMES + 1)]
    assert [step for step in steps if step[0] not in ("mesh", "prepare")] == told
    assert threads == {threading.current_thread()}
    assert list(animation.seconds) == ["segment", "mesh", "scene", "simulate", "render"]


@pytest.mark.parametrize("at", [("simulate", 1), ("simulate", FRAMES), ("render", 1), ("render", FRAMES)])
@pytest.mark.parametrize("name", ["clip.mp4", "clip/"])
def test_who_stops_leaves_nothing_behind(tmp_path: Path, at: tuple[str, int], name: str) -> None:
    def stop(stage: str, done: int, _: int) -> None:
        if (stage, done) == at:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animated(Saving(f"{tmp_path}/{name}"), watch=Watch(stop))
    assert not list(tmp_path.iterdir())
    assert not beside()


def test_an_error_of_the_drawing_ends_the_simulation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    failed, simulated = threading.Event(), []

    def fail(self: LayeredRenderer, t: int) -> None:
        if t == 1:
            failed.set()
            raise InvalidInputError("frames must be such and such. Got: others")

    def hear(stage: str, done: int, _: int) -> None:
        simulated.append(done)
        if stage == "simulate" and done == 2:
            assert failed.wait(20)
            for thread in beside():
                thread.join(0.5)

    frame = LayeredRenderer.frame
    monkeypatch.setattr(LayeredRenderer, "frame", lambda self, t: fail(self, t) or frame(self, t))
    with pytest.raises(InvalidInputError, match=r"^frames must be such and such\. Got: others$"):
        animated(Saving(tmp_path / "clip.mp4"), watch=Watch(hear))
    assert simulated[-1] < FRAMES
    assert not list(tmp_path.iterdir())
    assert not beside()


def test_an_error_of_the_simulation_ends_the_drawing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    simulate = pipeline.simulate

    def failing(*arguments: Any, on_frame: Any, **options: Any) -> Any:
        def until_two(number: int, positions: Any) -> None:
            on_frame(number, positions)
            if number == 2:
                raise SimulationError("The motion has got out of hand")

        return simulate(*arguments, on_frame=until_two, **options)

    monkeypatch.setattr(pipeline, "simulate", failing)
    with pytest.raises(SimulationError, match="out of hand"):
        animated(Saving(tmp_path / "clip.mp4"))
    assert not list(tmp_path.iterdir())
    assert not beside()


def test_a_place_where_nothing_can_be_written_is_refused_before_the_work(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="must end in"):
        animated(Saving(tmp_path / "clip.avi"), watch=Watch(lambda *_: pytest.fail("has begun")))
