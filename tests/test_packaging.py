"""What pip builds from the tree: everything that the package needs at run time, and nothing else."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from email.message import Message
from email.parser import Parser
from pathlib import Path

import physanimator
import pytest

ROOT = Path(__file__).resolve().parents[1]
DATA = ("physics/document/*.schema.json", "nodes/web/**/*", "rendering/evaluation/**/page/*", "workflows/**/*")
DATA_SUFFIXES = {".css", ".html", ".jpg", ".js", ".json", ".md", ".png", ".psd", ".svg", ".toml", ".webp"}


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the sources, with the kind of litter that a working tree collects."""
    copy = tmp_path_factory.mktemp("packaging") / "any folder-name"
    for room in ("nodes", "physics", "rendering", "tests", "workflows"):
        shutil.copytree(ROOT / room, copy / room, ignore=shutil.ignore_patterns(".*", "node_modules"))
    for path in (path for path in ROOT.iterdir() if path.is_file()):
        shutil.copy(path, copy)
    for litter in (
        "physics/__pycache__/old.pyc",
        "rendering/notes.txt",
        "nodes/web/.DS_Store",
        "frames/frame_0000.png",
    ):
        (copy / litter).parent.mkdir(exist_ok=True)
        (copy / litter).touch()
    return copy


@pytest.fixture(scope="module")
def wheel(tree: Path) -> Path:
    """The wheel that is built, without a network, from the source distribution, as a registry's is."""
    _build("sdist", tree)
    (archive,) = (tree / "dist").glob("*.tar.gz")
    safely = {"filter": "data"} if hasattr(tarfile, "data_filter") else {}  # older patch releases of 3.10 lack it
    shutil.unpack_archive(archive, tree.parent / "unpacked", **safely)
    (source,) = (tree.parent / "unpacked").iterdir()
    _build("wheel", source)
    (built,) = (source / "dist").glob("*.whl")
    return built


def _build(kind: str, folder: Path) -> None:
    script = f"from setuptools import build_meta; build_meta.build_{kind}('dist')"
    done = subprocess.run([sys.executable, "-c", script], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.fixture(scope="module")
def names(wheel: Path) -> set[str]:
    with zipfile.ZipFile(wheel) as archive:
        return {name for name in archive.namelist() if ".dist-info/" not in name}


@pytest.fixture(scope="module")
def metadata(wheel: Path) -> Message:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        return Parser().parsestr(archive.read(name).decode())


def _packages() -> list[Path]:
    inner = [path.parent for room in ("nodes", "physics", "rendering") for path in (ROOT / room).rglob("__init__.py")]
    return [ROOT, ROOT / "workflows", *(each for each in inner if "docs" not in each.relative_to(ROOT).parts)]


def test_wheel_holds_every_module(names: set[str]) -> None:
    expected = {f"physanimator/{p.relative_to(ROOT).as_posix()}" for each in _packages() for p in each.glob("*.py")}
    assert {name for name in names if name.endswith(".py")} == expected


def test_wheel_holds_all_data(names: set[str]) -> None:
    files = [path for pattern in DATA for path in ROOT.glob(pattern) if path.suffix in DATA_SUFFIXES]
    expected = {f"physanimator/{path.relative_to(ROOT).as_posix()}" for path in files}
    expected -= {f"physanimator/workflows/example/{name}" for name in ("README.md", "demo.webp", "illustration.svg")}
    assert {name for name in names if not name.endswith(".py")} == expected
    assert "physanimator/physics/document/scene.schema.json" in names
    assert {name for name in names if name.startswith("physanimator/nodes/web/")}
    assert {f"physanimator/workflows/example/{name}" for name in ("illustration.png", "scene.json")} <= names


def test_wheel_holds_nothing_stray(names: set[str]) -> None:
    stray = re.compile(r"physanimator/(tests|frames|nodes/docs)/|__pycache__|\.pyc$|/\.|notes\.txt|pyproject|\.ci")
    assert [name for name in names if stray.search(name)] == []
    assert all(name.startswith("physanimator/") for name in names)


def test_the_installed_wheel_animates_the_example(wheel: Path, tmp_path: Path) -> None:
    """By pip's own script, in an environment that lends all but this package from the one that tests."""
    environment = tmp_path / "environment"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", environment], check=True)
    scripts = environment / ("Scripts" if os.name == "nt" else "bin")
    site = _asked(scripts / "python", "import sysconfig; print(sysconfig.get_path('purelib'))")
    lent = "\n".join(path for path in sys.path if Path(path).name in {"site-packages", "dist-packages"})
    Path(site, "lent.pth").write_text(lent, encoding="utf-8")
    pip = [sys.executable, "-m", "pip", "--python", scripts / "python", "install", "--no-deps", "--no-index"]
    subprocess.run([*pip, "--quiet", "--disable-pip-version-check", "--ignore-installed", wheel], check=True)
    assert Path(_asked(scripts / "python", "import physanimator; print(physanimator.__file__)")).is_relative_to(site)
    command = [scripts / "physanimator", "demo", "--frames", "3", "--width", "160", "--output", "demo.mp4", "--quiet"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "demo.mp4").stat().st_size > 1000


def _asked(python: Path, code: str) -> str:
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run([python, "-c", code], capture_output=True, text=True, check=True, env=environment)
    return done.stdout.strip()


def test_wheel_runs_where_it_lies(wheel: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
    done = subprocess.run(
        [sys.executable, "-m", "physanimator", "schema"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert '"$schema"' in done.stdout


def test_metadata(metadata: Message) -> None:
    assert metadata["Name"] == "physanimator"
    assert metadata["Version"] == physanimator.__version__
    assert metadata["License-Expression"] == "Apache-2.0"
    assert metadata["Requires-Python"] == "<3.14,>=3.10"


def _requirements(lines: list[str]) -> dict[str, str]:
    found = [re.fullmatch(r"([A-Za-z0-9_-]+)\s*(.*)", line) for line in lines]
    return {match[1].lower(): match[2] for match in found if match}


def test_host_requirements_agree_and_leave_the_hosts_own_alone(metadata: Message) -> None:
    lines = (ROOT / "requirements.txt").read_text(encoding="utf-8").splitlines()
    host = _requirements([line for line in lines if line and not line.startswith("#")])
    package = _requirements([line for line in metadata.get_all("Requires-Dist", []) if ";" not in line])
    assert host.items() <= package.items()
    assert package.keys() - host.keys() == {"torch", "numpy", "pillow", "opencv-python-headless"}
    assert not [name for name in host if "opencv" in name], "it would overwrite another distribution's cv2"
    assert not any("==" in bound or "<" in bound for bound in package.values())


@pytest.mark.parametrize("installed", ["contrib", "broken", "none"])
def test_the_install_script_leaves_a_cv2_that_works_alone(installed: str, tmp_path: Path) -> None:
    """It is run with a pip that only notes what it is asked for, and with each kind of cv2."""
    environment = tmp_path / "environment"
    for name, text in (
        ("pip/__main__.py", f"import sys; print('pip', *sys.argv[1:]); open({str(tmp_path / 'asked')!r}, 'w')"),
        ("pip/__init__.py", ""),
        ("cv2/__init__.py", "import missing_library" if installed == "broken" else "imread = ximgproc = None"),
    ):
        if not (installed == "none" and name.startswith("cv2")):
            (environment / name).parent.mkdir(parents=True, exist_ok=True)
            (environment / name).write_text(text, encoding="utf-8")
    script = (
        f"import sys, runpy; sys.argv = ['install.py']\nimport subprocess as s; run = s.run\n"
        f"def bare(command, **k): return run([command[0], '-S', *command[1:]] if command[0] == sys.executable"
        f" else ['false'], env={{'PYTHONPATH': {str(environment)!r}}}, **k)\n"
        f"s.run = bare\nrunpy.run_path({str(ROOT / 'install.py')!r}, run_name='__main__')"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (tmp_path / "asked").exists() == (installed != "contrib")
    assert done.returncode == (0 if installed == "contrib" else 1), done.stderr  # the noting pip installs nothing
    assert ("left as it is" in done.stdout) == (installed == "contrib")
    assert ("pip install opencv-python-headless>=4.9" in done.stdout) == (installed != "contrib")


def test_console_script(wheel: Path, tmp_path: Path) -> None:
    """The function that pip's script calls is where the wheel says, and runs."""
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
        name = next(each for each in archive.namelist() if each.endswith("entry_points.txt"))
        said = archive.read(name).decode()
    entry = next(line.split(" = ")[1] for line in said.splitlines() if line.startswith("physanimator = "))
    module, function = entry.split(":")
    code = f"import sys; from {module} import {function}; sys.exit({function}())"
    run = subprocess.run(
        [sys.executable, "-c", code, "--version"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout == f"physanimator {physanimator.__version__}\n"


def test_readme_commands_are_found_by_continuous_integration() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    commands = re.findall(r"^<!-- (demo|test) command -->\n```sh\n(.+)\n```$", readme, re.MULTILINE)
    assert [name for name, _ in commands] == ["demo", "test"]
    assert all(command.startswith("python -m venv .venv && .venv/bin/pip install") for _, command in commands)
    assert "<!-- test command -->" in (ROOT / ".ci" / "run").read_text(encoding="utf-8")
