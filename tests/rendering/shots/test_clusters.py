"""Shots on clusters of real processes, of which some are killed."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from command_status import status
from shot_lists import begin, contents, draw, litter, until, write_list

pytest.importorskip("distributed")
pytestmark = pytest.mark.skipif(os.name == "nt", reason="os.kill ends no other processes on Windows as SIGKILL does")

LONG = "frames = 500"
DASK = "distributed.cli.dask_"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    draw(tmp_path)
    return tmp_path


@pytest.fixture
def cluster(folder: Path) -> Iterator[tuple[str, subprocess.Popen[str], subprocess.Popen[str]]]:
    """A running cluster of one worker: its address, its scheduler, and the worker."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = str(free.getsockname()[1])
    address = f"tcp://127.0.0.1:{port}"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    scheduler = begin(
        folder, "--host", "127.0.0.1", "--port", port, "--no-dashboard", module=f"{DASK}scheduler", **quiet
    )
    place = folder / "elsewhere"
    place.mkdir()
    words = ("--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(place))
    worker = begin(folder, address, *words, module=f"{DASK}worker", **quiet)
    yield address, scheduler, worker
    for process in (worker, scheduler):
        process.kill()
        process.wait()


def animated_alone(folder: Path, *options: str) -> bytes:
    """A clip as ``animate`` makes it."""
    names = [str(folder / name) for name in ("girl.png", "hair.png", "alone.mp4")]
    assert status("animate", names[0], "--mask", names[1], "-o", names[2], "--quiet", *options) == 0
    return Path(names[2]).read_bytes()


def workers_of(client: subprocess.Popen[str]) -> list[int]:
    """The processes in which a client's workers are."""
    import psutil

    below = psutil.Process(client.pid).children(recursive=True)
    spawned = [each.pid for each in below if "--multiprocessing-fork" in each.cmdline()]
    return spawned or [each.pid for each in below if each.ppid() != client.pid]  # forked


def begun(out: Path, name: str) -> bool:
    """Whether somebody writes frames of a shot already."""
    note = out / ".shots" / name
    return note.is_file() and bool(note.read_bytes())


def test_a_killed_workers_shot_runs_elsewhere_and_everything_is_done_once(folder: Path) -> None:
    """Both workers are killed while one draws a long shot, whose frames idle workers share afterwards."""
    quick = [f'name = "s{n}"\nwind = {1 + n / 10}' for n in range(6)]
    write_list(folder / "list.toml", [f'name = "long"\n{LONG}', *quick])
    client = begin(folder, "shots", "list.toml", "-o", "out", "--workers", "2")
    until(lambda: begun(folder / "out", "long.0"))
    for process in workers_of(client):
        os.kill(process, signal.SIGKILL)
    said, _ = client.communicate(timeout=100)
    assert client.returncode == 0, said
    ended = re.findall(r"^\[\d+/7\] (\w+): done", said, re.MULTILINE)
    assert sorted(ended) == ["long", *(f"s{n}" for n in range(6))]
    assert litter(folder / "out") == []
    assert contents(folder / "out")["long.mp4"] == animated_alone(folder, "--frames", "500")


def test_a_shot_that_a_farm_gives_out_twice_is_done_once(folder: Path) -> None:
    """Also at the same time, and beside a run that has the folder to itself and tidies it up before."""
    write_list(folder / "list.toml", [f'name = "a"\n{LONG}'])
    write_list(folder / "quick.toml", ['name = "b"'])
    words = ("shots", "list.toml", "-o", "out", "--workers", "0")
    first = begin(folder, *words)
    until(lambda: begun(folder / "out", "a.0"))
    second = begin(folder, *words)
    quick = begin(folder, "shots", "quick.toml", "-o", "out", "--workers", "1")
    told = []
    for process in (first, second, quick):
        said, _ = process.communicate(timeout=100)
        assert process.returncode == 0, said
        told.append(re.findall(r"(\w): done in ([\d.]+) s", said))
    assert told[0] == told[1]  # the very seconds
    assert sorted(contents(folder / "out")) == ["a.mp4", "b.mp4"]
    assert litter(folder / "out") == []


def test_files_are_shipped_and_a_killed_client_or_scheduler_leaves_only_whole_shots(
    folder: Path, cluster: tuple[str, subprocess.Popen[str], subprocess.Popen[str]]
) -> None:
    address, scheduler, worker = cluster
    shots = ['name = "a"\nsave-scene = "{out}/a.json"', 'name = "b"\noutput = "{out}/{name}/"', f'name = "c"\n{LONG}']
    write_list(folder / "list.toml", shots)
    words = ("shots", "list.toml", "-o", "out", "--scheduler", address)
    out = folder / "out"

    shipped = begin(folder, *words, "--ship", "--only", "a", "b")
    said, _ = shipped.communicate(timeout=100)
    assert shipped.returncode == 0, said
    assert (out / "a.mp4").read_bytes() == animated_alone(folder, "--frames", "3")
    assert json.loads((out / "a.json").read_text())["bodies"]
    assert sorted(path.name for path in (out / "b").glob("*.png")) == [f"frame_000{n}.png" for n in range(3)]
    assert not list((folder / "elsewhere").rglob("physanimator-shot-*"))

    killed = begin(folder, *words)
    until(lambda: begun(out, "c.0"))
    killed.kill()
    killed.communicate()
    until(lambda: not begun(out, "c.0"))  # the worker has heard that nobody waits for it, and has tidied up
    assert not (out / "c.mp4").exists()
    assert not [each for each in litter(out) if each.endswith("mp4")]

    left = begin(folder, *words)
    until(lambda: begun(out, "c.0"))
    scheduler.kill()
    said, _ = left.communicate(timeout=100)
    assert left.returncode == 1, said
    assert "the scheduler is gone" in said
    assert "3 shots: 0 done now, 2 done before, 1 not done" in said
    assert worker.wait(60) is not None


def _namespaces() -> str:
    """Why two network namespaces cannot be made; nothing where they can."""
    if sys.platform != "linux" or shutil.which("ip") is None:
        return "network namespaces need Linux and its ip command"
    made = subprocess.run(["ip", "netns", "add", "physanimator-try"], capture_output=True, text=True)
    if made.returncode:
        return f"network namespaces cannot be made here: {made.stderr.strip()}"
    subprocess.run(["ip", "netns", "delete", "physanimator-try"], check=True)
    return ""


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True)


def test_two_machines_that_share_a_network_and_nothing_else(folder: Path) -> None:
    """Scheduler and client in one network namespace, the worker in another, with a cable between them."""
    if why := _namespaces():
        pytest.skip(why)
    one, two = f"pa{os.getpid()}a", f"pa{os.getpid()}b"
    processes: list[subprocess.Popen[str]] = []
    try:
        for name in (one, two):
            _ip("netns", "add", name)
        _ip("link", "add", one, "netns", one, "type", "veth", "peer", "name", two, "netns", two)
        for name, address in ((one, "10.99.7.1/24"), (two, "10.99.7.2/24")):
            _ip("-n", name, "address", "add", address, "dev", name)
            for device in ("lo", name):
                _ip("-n", name, "link", "set", device, "up")
        here, there = (["ip", "netns", "exec", name] for name in (one, two))
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        scheduler = ("--host", "10.99.7.1", "--port", "8786", "--no-dashboard")
        processes.append(begin(folder, *scheduler, module=f"{DASK}scheduler", before=here, **quiet))
        worker = ("tcp://10.99.7.1:8786", "--nthreads", "1", "--no-nanny", "--no-dashboard")
        processes.append(begin(folder, *worker, module=f"{DASK}worker", before=there, **quiet))
        write_list(folder / "list.toml", ['name = "a"', 'name = "b"\nwind = 2'])
        words = ("shots", "list.toml", "-o", "out", "--scheduler", "tcp://10.99.7.1:8786", "--ship")
        client = begin(folder, *words, before=here)
        said, _ = client.communicate(timeout=100)
        assert client.returncode == 0, said
        assert sorted(contents(folder / "out")) == ["a.mp4", "b.mp4"]
        assert litter(folder / "out") == []
    finally:
        for process in processes:
            process.kill()
            process.wait()
        for name in (one, two):
            subprocess.run(["ip", "netns", "delete", name], capture_output=True)
