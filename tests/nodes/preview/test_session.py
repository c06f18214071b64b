"""Live previews: frames as ``simulate`` makes them, latest wins, and nothing stays behind."""

from __future__ import annotations

import itertools
import json
import struct
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from physanimator.nodes.preview import FRAME, HEADER, PreviewBodies, PreviewStore, split_records
from physanimator.nodes.preview import session as preview_session
from physanimator.nodes.preview.queue import RecordQueue
from physanimator.nodes.preview.records import END, ERROR, record
from physanimator.nodes.preview.session import PreviewRun, PreviewRuns, stream, warm_up
from physanimator.physics import runtime
from physanimator.physics.assembly import Preparations, preparation, system
from physanimator.physics.errors import Cancelled
from physanimator.physics.forces import EnergyStroke
from physanimator.physics.material import Material, modes
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import Circle, MaskRegion, Polygon, RigPoint, Wave
from physanimator.physics.runtime import taichi_runtime
from physanimator.physics.scene import Body, Contact, Holds, Paint, Scene
from physanimator.physics.simulation import sample_simulations, simulate

PATIENCE = 60.0
ORDER = itertools.count()


def scene(**changes: Any) -> Scene:
    x, y = np.meshgrid(np.arange(5.0) * 10 + 20, np.arange(3.0) * 10 + 20)
    cell = np.array([[0, 1, 5], [1, 6, 5]])
    triangles = np.concatenate([cell + 5 * row + column for row in range(2) for column in range(4)])
    mesh = TriangleMesh(np.column_stack([x.ravel(), y.ravel()]), triangles, 100, 80)
    body = Body(mesh, Material(youngs_modulus=10.0, damping=4.0))
    stroke = EnergyStroke("wind", ((0.0, 30.0), (100.0, 50.0)), 60.0, speed=200.0, strength=4.0)
    drawn = {"bodies": (body,), "strokes": (stroke,), "rig_points": (RigPoint((20.0, 30.0), Circle(15.0)),)}
    return Scene(**(drawn | changes))


def run_of(runs: PreviewRuns, editor: str = "one") -> PreviewRun:
    run = runs.enter(editor, next(ORDER))
    assert run is not None
    return run


def until(holds: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.002)


def streamed(of: Scene, frames: int, run: PreviewRun | None = None) -> list[tuple[int, bytes]]:
    queue = RecordQueue(lambda: None, max_bytes=2**30)
    stream(of, frames, run or run_of(PreviewRuns()), queue)
    data, closed = queue.take()
    assert closed
    return split_records(data)


def displacements(records: list[tuple[int, bytes]]) -> tuple[list[int], np.ndarray]:
    header = json.loads(records[0][1])
    payloads = [payload for kind, payload in records if kind == FRAME]
    moved = [np.frombuffer(p, "<i2", 2 * header["vertices"], 4).reshape(-1, 2) * header["unit"] for p in payloads]
    return [struct.unpack_from("<I", payload)[0] for payload in payloads], np.array(moved)


def test_what_is_streamed_is_what_is_simulated() -> None:
    records = streamed(scene(), 20)
    assert [kind for kind, _ in records] == [HEADER, *[FRAME] * 20, END]
    numbers, moved = displacements(records)
    motion = simulate(scene(), frames=20)
    assert numbers == list(range(20))
    np.testing.assert_allclose(moved, motion.positions - motion.positions[0], atol=0.51 * 100 / 16384)
    end = json.loads(records[-1][1])
    assert end["frames"] == 20
    assert end["largest_displacement"] == pytest.approx(np.abs(motion.positions - motion.positions[0]).max(), abs=1e-4)
    assert end["largest_displacement"] > 1


def test_a_loop_moves_at_once_and_ends_as_it_is_simulated() -> None:
    looping = scene(loop=1.0, frame_rate=12.0)
    records = streamed(looping, 12)
    numbers, moved = displacements(records)
    cycles = len(numbers) // 12
    assert cycles >= 3
    assert numbers == list(range(12)) * cycles
    assert (moved[0] == 0).all(), "it starts from the drawing"
    rest = looping.bodies[0].mesh.vertices
    np.testing.assert_allclose(moved[-12:], simulate(looping).positions - rest, atol=0.51 * 100 / 16384)
    assert json.loads(records[0][1])["loop"] is True


def test_too_much_work_is_refused_in_the_stream(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("physanimator.nodes.preview.session.MAX_PREVIEW_WORK", 100.0)
    kind, payload = streamed(scene(), 200)[-1]
    assert kind == ERROR
    assert "To lower it" in json.loads(payload)["error"]


def test_a_failure_is_told_and_raised(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: Any, **__: Any) -> None:
        raise ZeroDivisionError("secret")

    monkeypatch.setattr("physanimator.physics.simulation.simulate", fail)
    queue, run = RecordQueue(lambda: None), run_of(PreviewRuns())
    with pytest.raises(ZeroDivisionError):
        stream(scene(), 5, run, queue)
    data, closed = queue.take()
    assert closed
    assert b"ZeroDivisionError" in data
    assert b"secret" not in data
    assert not run.turn.locked()


def test_the_latest_request_of_an_editor_wins() -> None:
    runs, first_queue = PreviewRuns(), RecordQueue(lambda: None, max_bytes=4_000)
    first = run_of(runs)
    thread = threading.Thread(target=stream, args=(scene(), 1_000, first, first_queue))
    thread.start()
    until(first.turn.locked)
    second = run_of(runs)
    records = streamed(scene(), 3, second)  # waits until the first has let go
    thread.join(PATIENCE)
    assert not thread.is_alive()
    assert [kind for kind, _ in records] == [HEADER, FRAME, FRAME, FRAME, END]
    data, closed = first_queue.take()
    kind, payload = split_records(data)[-1]
    assert (closed, kind, json.loads(payload)) == (True, ERROR, {"error": "superseded"})
    runs.leave(first)
    assert len(runs) == 1, "one that was superseded does not take its successor along"
    runs.leave(second)
    assert len(runs) == 0


def test_a_run_that_was_superseded_before_its_turn_never_simulates(monkeypatch: pytest.MonkeyPatch) -> None:
    runs = PreviewRuns()
    first, second, _ = run_of(runs), run_of(runs), run_of(runs)
    monkeypatch.setattr("physanimator.physics.simulation.simulate", lambda *_, **__: pytest.fail("it has simulated"))
    assert [kind for run in (first, second) for kind, _ in streamed(scene(), 3, run)] == [ERROR, ERROR]


def test_editors_do_not_disturb_each_other_and_have_a_limit() -> None:
    runs = PreviewRuns(most=2)
    one, two = run_of(runs, "one"), run_of(runs, "two")
    assert runs.enter("three", next(ORDER)) is None
    one.check()
    two.check()
    assert runs.enter("two", next(ORDER)) is not None, "an editor may replace its own"
    runs.leave(one)
    assert runs.enter("three", next(ORDER)) is not None


def test_a_full_queue_holds_the_simulation_back() -> None:
    woken = threading.Event()
    queue, run = RecordQueue(woken.set, max_bytes=100), run_of(PreviewRuns())
    done: list[int] = []

    def put() -> None:
        for number in range(10):
            queue.put(record(FRAME, bytes(40)), run.check)
            done.append(number)

    thread = threading.Thread(target=put)
    thread.start()
    until(lambda: len(done) == 2)
    assert woken.is_set()
    time.sleep(0.1)
    assert len(done) == 2
    taken = 0
    while taken < 10:
        taken += len(split_records(queue.take()[0]))
    thread.join(PATIENCE)
    assert done == list(range(10))


def test_cancelling_frees_who_waits_for_room() -> None:
    queue, run = RecordQueue(lambda: None, max_bytes=10), run_of(PreviewRuns())
    queue.put(bytes(100), run.check)
    threading.Timer(0.05, run.cancel, ["gone"]).start()
    with pytest.raises(Cancelled, match="gone"):
        queue.put(bytes(100), run.check)


def pinned(radius: float) -> Scene:
    sways = replace(scene().bodies[0], material=Material(sway_frequency=1.0))
    return scene(gravity=(0.0, 0.1), bodies=(sways,), rig_points=(RigPoint((20.0, 30.0), Circle(radius)),))


@pytest.mark.parametrize("radius", [15.0, 25.0])
def test_preparing_is_given_up_unless_the_next_run_needs_the_same(
    radius: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    runs, asked, superseded = PreviewRuns(), 0, pinned(15.0)
    monkeypatch.setattr(modes, "_DENSE", 0)
    first = runs.enter("one", next(ORDER), runs.prepare(superseded))
    assert first is not None

    def check() -> None:
        nonlocal asked
        asked += 1
        if asked == 3:
            runs.enter("one", next(ORDER), runs.prepare(pinned(radius)))
        PreviewRun.check_preparing(first)

    monkeypatch.setattr(first, "check_preparing", check)
    records = streamed(superseded, 3, first)
    assert json.loads(records[-1][1]) == {"error": "superseded"}
    assert (asked > 3) == (radius == 15.0)
    assert ("system" in vars(first.wants)) == (radius == 15.0)


def test_preparing_is_shared_where_only_strokes_and_motions_differ() -> None:
    preparations, base = Preparations(most=3), scene(gravity=(0.0, 0.3))
    prepared = preparations(base)
    stroke = replace(base.strokes[0], strength=9.0)
    led = replace(base.rig_points[0], motion=Wave(5.0, 1.0))
    assert preparations(replace(base, strokes=(stroke,), rig_points=(led,), frame_rate=12.0)) is prepared
    stiffer = replace(base.bodies[0], material=Material(youngs_modulus=11.0, damping=4.0))
    region = Polygon(((30.0, 20.0), (60.0, 20.0), (60.0, 40.0)))
    others = {
        "gravity": (0.0, 0.31),
        "sag": True,
        "rig_points": (replace(led, region=Circle(25.0)),),
        "bodies": (stiffer,),
        "paint": (Paint(region, stiffness=3.0),),
    }
    changed = [replace(base, **{name: value}) for name, value in others.items()]  # type: ignore[arg-type]
    changed.append(replace(base, paint=(Paint(region, stiffness=2.0),)))
    changed.append(replace(base, rig_points=(replace(led, falloff=8.0),)))
    preparations = Preparations(most=9)
    assert len({id(preparations(each)) for each in [base, *changed]}) == 8


def test_a_shared_preparation_moves_as_one_of_its_own() -> None:
    preparations, base = Preparations(most=1), scene(gravity=(0.0, 0.2))
    preparations(base)
    led = replace(base.rig_points[0], motion=Wave(5.0, 1.0))
    changed = replace(base, rig_points=(led,), strokes=())
    assert preparations(changed).scene is base
    shared = simulate(changed, frames=10, prepare=preparations).positions
    np.testing.assert_array_equal(shared, simulate(changed, frames=10).positions)
    assert np.abs(shared[-1] - shared[0]).max() > 1


def test_of_preparations_the_last_are_kept() -> None:
    preparations = Preparations(most=1)
    first = preparations(scene())
    preparations(scene(gravity=(0.0, 1.0)))
    assert preparations(scene()) is not first


def kept(seed: int, *, pixels: int = 0) -> PreviewBodies:
    corners = np.random.default_rng(seed).uniform(0, 100, (3, 2))
    picture = np.zeros((pixels, 1, 3), np.uint8) if pixels else None
    return PreviewBodies((Body(TriangleMesh(corners, np.array([[0, 1, 2]]), 100, 100)),), picture)


def test_kernels_for_bodies_that_touch_are_loaded_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    warmed: list[Scene] = []
    monkeypatch.setattr(sample_simulations, "simulate", lambda scene, **_: warmed.append(scene))
    monkeypatch.setattr(runtime, "keep_compiled", lambda: False)
    warm_up()
    assert warmed[-1].contact is None
    warm_up(contact=True)
    assert warmed[-1].contact is not None
    assert len(warmed[-1].bodies) > 1


@pytest.mark.parametrize("contact", [False, True])
def test_large_kernels_run_where_they_stop_nobody_in_this_process(
    contact: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[bool] = []
    launched = taichi_runtime._TaichiThread.launched

    def noted(thread: Any, aside: bool, *rest: Any) -> Any:
        asked.append(aside)
        return launched(thread, False, *rest)

    monkeypatch.setattr(taichi_runtime._TaichiThread, "launched", noted)
    monkeypatch.setattr(preview_session, "compile_aside", lambda **_: None)
    runs, acting = PreviewRuns(), scene(contact=Contact() if contact else None)
    run = runs.enter("one", next(ORDER))
    assert run is not None
    assert streamed(acting, 3, run)[-1][0] == END
    assert set(asked) == {contact}
    asked.clear()
    simulate(acting, frames=3)
    assert set(asked) == {False}, "elsewhere nobody waits for an answer"


def test_what_was_compiled_is_kept_before_it_is_needed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []
    monkeypatch.setattr(sample_simulations, "simulate", lambda *_, **__: done.append("simulated"))
    monkeypatch.setattr(runtime, "keep_compiled", lambda: done.append("kept") or True)
    warm_up()
    assert done == ["simulated", "kept", "simulated"]


def test_the_store_keeps_what_was_used_last_within_its_bytes() -> None:
    store = PreviewStore(max_bytes=10_000)
    keys = [store.put(kept(seed, pixels=1_000)) for seed in range(3)]
    assert store.get(keys[0]) is not None
    keys.append(store.put(kept(3, pixels=1_000)))
    assert store.get(keys[1]) is None, "the one that was not used for longest"
    assert all(store.get(keys[k]) is not None for k in (0, 2, 3))
    assert store.size <= 10_000
    assert store.get(store.put(kept(4, pixels=100_000))) is not None
    assert len(store) == 1


def test_keys_follow_the_content() -> None:
    assert kept(1).key == kept(1).key
    assert kept(1).key != kept(2).key
    assert kept(1).key != kept(1, pixels=1).key
    changed = PreviewBodies((Body(kept(1).bodies[0].mesh, Material(damping=7.0)),))
    assert changed.key != kept(1).key
    assert changed.picture_key == kept(1).picture_key


def test_rig_points_are_compared_with_the_bodies_once(monkeypatch: pytest.MonkeyPatch) -> None:
    compared: list[Scene] = []
    original = preparation.holds_of

    def counted(of: Scene) -> Holds:
        compared.append(of)
        return original(of)

    for module in (preparation, system):
        monkeypatch.setattr(module, "holds_of", counted)
    runs, looping = PreviewRuns(), scene(loop=0.5)
    run = runs.enter("one", next(ORDER), runs.prepare(looping))
    assert run is not None
    assert streamed(looping, 12, run)[-1][0] == END
    assert len(compared) == 1


def test_masks_that_are_not_read_any_more_are_not_kept() -> None:
    mask = MaskRegion(np.ones((2000, 2000), bool))
    preparations, base = Preparations(most=8, max_bytes=9_000_000), scene()
    held = replace(base, rig_points=(replace(base.rig_points[0], region=mask),))
    prepared = preparations(held)
    assert prepared.size < 1_000_000
    np.testing.assert_array_equal(prepared.system.leaders, 0)
    for factor in (2.0, 3.0, 4.0, 5.0):
        preparations(replace(base, paint=(Paint(mask, stiffness=factor),)))
    assert 8_000_000 < preparations.size < 9_000_000, "two masks of paint"
