"""Wherever HOME points, a simulation ends well, and kernels are kept in a folder that is the user's alone."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from physanimator.physics.runtime import KernelCache, kernel_cache
from physanimator.physics.runtime import cache_folder as module

PREAMBLE = f"import sys; sys.path.insert(0, {str(Path(__file__).resolve().parents[2])!r}); import conftest\n"
posix = pytest.mark.skipif(sys.platform == "win32", reason="the rules of owners and modes are POSIX's")


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty home, and a folder for temporary files beside it."""
    folder = tmp_path / "home"
    folder.mkdir()
    (tmp_path / "tmp").mkdir()
    for name in ("TI_OFFLINE_CACHE_FILE_PATH", "TI_OFFLINE_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(folder))
    monkeypatch.setattr(module.sys, "platform", "linux")
    monkeypatch.setattr(module.tempfile, "gettempdir", lambda: str(tmp_path / "tmp"))
    return folder


def test_the_user_s_choice_comes_first_then_the_cache_of_the_system(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert kernel_cache() == KernelCache(str(home / ".cache" / "physanimator" / "taichi"), True)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg é"))
    assert kernel_cache() == KernelCache(str(tmp_path / "xdg é" / "physanimator" / "taichi"), True)
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")
    assert kernel_cache().folder.startswith(str(home))
    monkeypatch.setattr(module.sys, "platform", "darwin")
    assert kernel_cache().folder == str(home / "Library" / "Caches" / "physanimator" / "taichi")
    monkeypatch.setenv("TI_OFFLINE_CACHE_FILE_PATH", str(tmp_path / "mine"))
    assert kernel_cache() == KernelCache(str(tmp_path / "mine"), True)
    monkeypatch.setenv("TI_OFFLINE_CACHE", "0")
    assert kernel_cache() == KernelCache(str(tmp_path / "mine"), False)


@posix
@pytest.mark.parametrize("kind", ["a file", "relative", "a cache that is a file", "undecodable", "others write there"])
def test_an_unusable_home_gives_a_private_temporary_folder(
    kind: str, home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if kind == "a file":
        monkeypatch.setenv("HOME", str(tmp_path / "file"))
        (tmp_path / "file").touch()
    elif kind == "relative":
        monkeypatch.setenv("HOME", "home")
    elif kind == "a cache that is a file":
        (home / ".cache").touch()
    elif kind == "undecodable":
        monkeypatch.setenv("HOME", str(tmp_path / "\udce9"))
    else:
        (home / ".cache" / "physanimator" / "taichi").mkdir(parents=True)
        (home / ".cache" / "physanimator" / "taichi").chmod(0o777)
    found = kernel_cache()
    assert found.usable
    assert Path(found.folder).parent == tmp_path / "tmp"
    assert Path(found.folder).stat().st_mode & 0o077 == 0


@posix
def test_a_temporary_folder_that_somebody_else_has_prepared_is_not_used(home: Path, tmp_path: Path) -> None:
    home.rmdir()
    home.touch()
    trap = tmp_path / "tmp" / f"physanimator-{os.geteuid()}"
    (tmp_path / "elsewhere").mkdir()
    trap.symlink_to(tmp_path / "elsewhere")
    assert kernel_cache() == KernelCache(os.path.abspath(os.sep), False)
    trap.unlink()
    trap.mkdir(mode=0o700)
    trap.chmod(0o770)
    assert not kernel_cache().usable


def test_a_lock_that_a_killed_process_has_left_is_taken_away_and_no_other(home: Path) -> None:
    lock = Path(kernel_cache().folder) / "ticache.lock"
    lock.touch()
    kernel_cache()
    assert lock.exists()
    long_ago = time.time() - 3600
    os.utime(lock, (long_ago, long_ago))
    kernel_cache()
    assert not lock.exists()


@posix
@pytest.mark.parametrize(
    "kind", ["a file", "unset", "nothing can be written", "gone at the end", "damaged", "other variables"]
)
def test_a_simulation_ends_well(kind: str, tmp_path: Path) -> None:
    """Each of these ended the process with a signal, or computed with other numbers."""
    home = tmp_path / "home"
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("TI_", "XDG_"))}
    environment |= {"HOME": str(home), "TMPDIR": str(tmp_path)}
    before = after = ""
    if kind == "a file":
        home.touch()
    elif kind == "unset":
        environment |= {"XDG_CACHE_HOME": ""}
        del environment["HOME"]
    elif kind == "nothing can be written":
        before = "from physanimator.physics.runtime import cache_folder\n"
        before += "cache_folder._takes_files = lambda folder: False\n"
    elif kind == "gone at the end":
        after = f"import shutil; shutil.rmtree({str(home)!r}); open({str(home)!r}, 'w').close()\n"
    elif kind == "damaged":
        folder = home / ".cache" / "physanimator" / "taichi"
        folder.mkdir(parents=True)
        for name in ("ticache.tcb", "ticache.lock", "T00.tic"):
            (folder / name).write_bytes(bytes(range(256)))
            os.utime(folder / name, (0, 0))
    else:
        environment |= {"TI_ARCH": "vulkan", "TI_DEFAULT_FP": "64", "TI_OFFLINE_CACHE_FILE_PATH": "/dev/null/x"}
    code = (
        PREAMBLE
        + before
        + (
            "from physanimator.physics.runtime.taichi_runtime import compiled, run\n"
            "def told(ti): return ti.cfg.arch == ti.x64 or ti.cfg.arch == ti.arm64, ti.cfg.default_fp == ti.f32\n"
            "print(run(compiled, told), flush=True)\n"
        )
        + after
    )
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "(True, True)\n", "")
