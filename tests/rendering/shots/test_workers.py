"""Real workers: how many threads each may use, and which of them get shots that ask for a graphics card."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import cv2
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.threads import THREADS, allowed_threads
from physanimator.rendering.command import shots_run
from physanimator.rendering.shots import (
    Animated,
    Job,
    Shot,
    Word,
    check_workers,
    engine,
    fork_server,
    local_cluster,
    missing_workers_told,
    outcomes_of,
)
from shot_lists import draw, environment, until

distributed = pytest.importorskip("distributed")
config = pytest.importorskip("dask.config")


HERE: dict[str, Any] = {}  # what shots of workers in this process tell
LOCK = threading.Lock()


def by_networks(_: Sequence[str]) -> Animated:
    with LOCK:
        HERE["places"]["gpu"].add(distributed.get_worker().name)
        HERE["at work"] += 1
        HERE["most"] = max(HERE["most"], HERE["at work"])
    time.sleep(0.05)
    with LOCK:
        HERE["at work"] -= 1
    return Animated(0)


def plainly(_: Sequence[str]) -> Animated:
    HERE["places"]["plain"].add(distributed.get_worker().name)
    return Animated(0)


def nothing_written(_: str) -> list[str]:
    return []


def job(folder: Path, name: str, run: Any, *, on_gpu: bool) -> Job:
    shot = Shot(name, (), {}, str(folder / f"{name}.shot.json"), on_gpu=on_gpu)
    return Job(shot, name, run, nothing_written, str(folder / "notes"))


@pytest.mark.parametrize("threads", [1, 2])
def test_a_worker_of_ours_keeps_to_its_threads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, threads: int) -> None:
    monkeypatch.syspath_prepend(environment(tmp_path)["PYTHONPATH"])
    monkeypatch.delenv(THREADS, raising=False)
    with local_cluster(1, threads=threads) as client:
        assert list(client.run(allowed_threads).values()) == [threads]
        assert list(client.run(cv2.getNumThreads).values()) == [threads]


@pytest.mark.skipif(not fork_server.FORKS, reason="workers are not forked on this system")
def test_workers_begin_with_what_lets_them_keep_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Before Python starts: the C library does not look later. Dask would have every picture mapped anew."""
    monkeypatch.syspath_prepend(environment(tmp_path)["PYTHONPATH"])
    before = dict(os.environ)
    with local_cluster(1) as client:
        (born,) = client.run(lambda: Path("/proc/self/environ").read_text().split("\0")).values()
    assert "MALLOC_TRIM_THRESHOLD_=268435456" in born
    assert "MALLOC_MMAP_THRESHOLD_=33554432" in born
    assert not [name for name in os.environ if name.startswith("MALLOC") and name not in before]


@pytest.mark.skipif(sys.platform != "linux", reason="the C library of Linux")
def test_a_worker_of_dask_keeps_memory_once_it_has_a_shot(tmp_path: Path) -> None:
    """Pages that are mapped anew for each picture are counted, with what Dask sets for its workers."""
    asked = """
import resource
import numpy as np
from physanimator.physics.kept_memory import keep_memory

def mapped():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(20):
        np.ones((720, 1280), np.float32).sum()
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

before = mapped()
keep_memory()
print(before, mapped())
"""
    variables = {**environment(tmp_path), "MALLOC_TRIM_THRESHOLD_": "65536"}
    run = subprocess.run([sys.executable, "-c", asked], env=variables, capture_output=True, text=True, check=True)
    before, after = map(int, run.stdout.split())
    assert after < before / 4


@pytest.mark.skipif(not fork_server.FORKS, reason="workers are not forked on this system")
def test_workers_are_forked_from_what_has_imported_everything(tmp_path: Path) -> None:
    """It has one thread, without which it could not be forked, and leaves Taichi and Ctrl+C to others."""
    draw(tmp_path)
    asked = """
import os, signal, sys
import physanimator.rendering.command.shot_imports
threads = len(os.listdir("/proc/self/task"))
taichi = "taichi" in sys.modules
known = {each.split(".")[0] for each in sys.modules}
from physanimator.rendering.command.shot_task import animate_shot
ended = animate_shot(["girl.png", "--mask", "hair.png", "--frames", "2", "--output", "a.mp4"])
late = {each.split(".")[0] for each in sys.modules} - known
print(threads, taichi, signal.getsignal(signal.SIGINT) is signal.SIG_IGN, ended.status)
print(sorted(late & {"av", "cv2", "distributed", "numpy", "PIL", "pythoncdt", "scipy"}))
"""
    run = subprocess.run(
        [sys.executable, "-c", asked],
        cwd=tmp_path,
        env={**environment(tmp_path), "OPENBLAS_NUM_THREADS": "1", THREADS: "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.stdout.splitlines() == ["1 False True 0", "[]"], run.stderr


@pytest.fixture
def workers(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """A cluster in this process, which can be given workers: ``add(name, **resources)``, ``remove(name)``."""
    monkeypatch.setattr(engine, "keep_to_threads", lambda _: None)  # this process is not theirs
    with config.set({"distributed.scheduler.work-stealing": False}):
        made = distributed.SpecCluster(
            scheduler={
                "cls": distributed.Scheduler,
                "options": {"port": 0, "dashboard_address": "127.0.0.1:0", "host": "127.0.0.1"},
            }
        )
    count = [0]

    def add(name: str, **resources: int) -> None:
        options = {"nthreads": 2, "name": name, "resources": resources, "host": "127.0.0.1", "dashboard": False}
        made.worker_spec[name] = {"cls": distributed.Worker, "options": options}
        count[0] += 1
        made.sync(made._correct_state)
        client.wait_for_workers(count[0])

    def remove(name: str) -> None:
        del made.worker_spec[name]
        count[0] -= 1
        made.sync(made._correct_state)

    with made, distributed.Client(made, set_as_default=False) as client:
        client.add, client.remove = add, remove
        yield client


def test_a_shot_with_networks_waits_for_a_card_and_has_it_alone(
    tmp_path: Path, workers: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where no worker has a card it is refused; one that has two threads and one card does one such shot at a time."""
    places: dict[str, set[str]] = {"gpu": set(), "plain": set()}
    monkeypatch.setitem(HERE, "places", places)
    monkeypatch.setitem(HERE, "at work", 0)
    monkeypatch.setitem(HERE, "most", 0)
    jobs = [
        job(tmp_path, f"{kind}{n}", {"gpu": by_networks, "plain": plainly}[kind], on_gpu=kind == "gpu")
        for n in range(6)
        for kind in ("gpu", "plain")
    ]
    assert "those with networks wait for one with a graphics card" in shots_run._when(0, jobs)
    workers.add("plain")
    with pytest.raises(InvalidInputError, match=r"need a worker with a graphics card.* Got: gpu0, and 1 workers"):
        check_workers(workers, jobs, ship=False)

    ended = []
    going = threading.Thread(
        target=lambda: ended.extend(outcomes_of(workers, jobs, ship=False, token="t", heard=lambda: None))
    )
    going.start()
    until(lambda: len(list(tmp_path.glob("plain*.shot.json"))) == 6)
    assert places == {"gpu": set(), "plain": {"plain"}}  # those with networks wait, the others do not wait for them
    workers.add("card", GPU=1)
    going.join(30)
    assert sorted((each.name, each.state) for each in ended) == sorted((each.shot.name, "done") for each in jobs)
    assert places["gpu"] == {"card"}
    assert HERE["most"] == 1


def of_picture(words: Sequence[str]) -> Animated:
    with LOCK:
        HERE["of pictures"].setdefault(words[0], set()).add(distributed.get_worker().name)
    time.sleep(0.05)
    return Animated(0)


def test_the_shots_of_a_picture_are_done_by_one_worker(
    tmp_path: Path, workers: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It need not cut out the parts again; when it has gone, another one does them."""
    seen: dict[str, set[str]] = {}
    monkeypatch.setitem(HERE, "of pictures", seen)
    monkeypatch.setattr(engine, "_AHEAD", 1)
    for name in ("one", "two"):
        workers.add(name)
    jobs = []
    for n in range(40):
        word = Word("", f"picture {n % 4}", "input", "image")
        shot = Shot(f"s{n}", (word,), {}, str(tmp_path / f"s{n}.shot.json"))
        jobs.append(Job(shot, shot.name, of_picture, nothing_written, str(tmp_path / "notes")))
    done = outcomes_of(workers, jobs[:32], ship=False, token="t", heard=lambda: None, chosen=True)
    assert [each.state for each in done] == ["done"] * 32
    assert sum(len(each) for each in seen.values()) <= 5  # of 8: who ends first helps with the last picture
    workers.remove("one")
    done = outcomes_of(workers, jobs[32:], ship=False, token="u", heard=lambda: None, chosen=True)
    assert [each.state for each in done] == ["done"] * 8


def test_it_is_told_when_the_last_worker_for_a_shot_leaves_and_when_one_comes(workers: Any) -> None:
    told: list[str] = []

    def until_told(words: str) -> None:
        until(lambda: any(words in each for each in told))

    workers.add("plain")
    workers.add("card", GPU=1)
    with missing_workers_told(workers, lambda on_gpu: 3 if on_gpu else 0, told.append, look=0.05):
        time.sleep(0.3)
        assert told == []
        workers.remove("card")
        until_told("no worker is left: 3 shots with networks wait for one with a graphics card")
        workers.remove("plain")  # which nobody misses
        time.sleep(0.3)
        workers.add("other", GPU=1)
        until_told("a worker has come for 3 shots with networks")
    assert len(told) == 2
