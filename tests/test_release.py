"""What a release needs: one version, a changelog by the rules, addresses that agree, pictures, a lean archive."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import physanimator
import pytest
from PIL import Image

pytest.importorskip("tomllib", reason="the release is made with Python 3.11 or later")
import tomllib

ROOT = Path(__file__).resolve().parents[1]
ADDRESS = "https://code.example/someone/physanimator"
DATED = "# Changelog\n\n## [0.1.0] - 2025-03-02\n\n### Added\n\n- All of it.\n"
ENVIRONMENTS = {
    "GPU :: NVIDIA CUDA",
    "GPU :: AMD ROCm",
    "GPU :: Intel Arc",
    "NPU :: Huawei Ascend",
    "GPU :: Apple Metal",
}


def _release() -> ModuleType:
    spec = importlib.util.spec_from_file_location("release", ROOT / ".ci" / "release.py")
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules["release"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


release = _release()


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A tree as it would be published: with an address and a date."""
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    (tmp_path / "CHANGELOG.md").write_text(DATED.replace("0.1.0", physanimator.__version__), encoding="utf-8")
    assert release.set_address(tmp_path, ADDRESS) == []
    return tmp_path


def _project() -> dict:
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_the_version_stands_in_one_place() -> None:
    assert physanimator.__version__ == _project()["project"]["version"]
    lines = [
        f"{path.relative_to(ROOT)}: {line}"
        for path in (*ROOT.glob("*.py"), *(ROOT / ".ci").glob("*.py"), *(ROOT / "nodes").rglob("*.py"))
        for line in path.read_text(encoding="utf-8").splitlines()
        if f'"{physanimator.__version__}"' in line
    ]
    assert lines == []


def test_the_changelog_keeps_its_rules() -> None:
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert release.changelog_problems(text) == []
    assert release.sections(text)[0].version == physanimator.__version__
    assert release.notes(ROOT).startswith("### Added\n\n- ")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (DATED.replace(" - 2025-03-02", ""), "a heading of CHANGELOG.md must be"),
        (DATED.replace("2025-03-02", "2025-02-30"), "in the calendar. Got: 2025-02-30"),
        (DATED.replace("### Added", "### New"), "a kind of change must be one of Added"),
        (DATED.replace("- All of it.", ""), "at least one entry"),
        (DATED + "\n### Added\n\n- More.\n", "stand once"),
        (DATED + "\n" + DATED.split("\n\n", 1)[1].replace("0.1.0", "0.2.0"), "must go down. Got: 0.1.0 above 0.2.0"),
        (DATED + "\n## [0.0.9] - unreleased\n\n### Fixed\n\n- A bug.\n", "only the newest version may be unreleased"),
    ],
)
def test_what_breaks_the_changelogs_rules_is_told(text: str, said: str) -> None:
    (told,) = release.changelog_problems(text)
    assert said in told


def test_a_tree_that_is_ready_is_let_through(tree: Path) -> None:
    assert release.problems(tree, tag=f"v{physanimator.__version__}") == []


def test_what_is_not_ready_is_refused(tree: Path) -> None:
    (told,) = release.problems(tree, tag="v9.9.9")
    assert told.endswith("Got: v9.9.9")
    path = tree / "CHANGELOG.md"
    path.write_text(path.read_text(encoding="utf-8").replace("2025-03-02", "unreleased"), encoding="utf-8")
    (told,) = release.problems(tree)
    assert "must have a date" in told
    path.write_text(DATED.replace("0.1.0", "0.0.1"), encoding="utf-8")
    (told,) = release.problems(tree)
    assert told.endswith("Got: 0.0.1")


def test_nothing_is_published_without_an_address(tree: Path) -> None:
    assert release.set_address(tree, "https://repository.invalid/physanimator") == []
    (told,) = release.problems(tree)
    assert "no public address yet" in told


@pytest.mark.parametrize("url", ["http://code.example/a/b", "code.example/a/b", 'https://code.example/"', "https://"])
def test_what_is_no_address_is_refused(tree: Path, url: str) -> None:
    before = (tree / "pyproject.toml").read_text(encoding="utf-8")
    assert release.set_address(tree, url)
    assert (tree / "pyproject.toml").read_text(encoding="utf-8") == before


def test_addresses_follow_from_the_repositorys() -> None:
    project = _project()
    told = {**project["project"]["urls"], **project["tool"]["comfy"]}
    for name, ending in release.ADDRESSES.items():
        assert told[name] == told["Repository"] + ending


def test_the_address_stands_nowhere_else() -> None:
    address = _project()["project"]["urls"]["Repository"]
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], capture_output=True, check=False)
    if listed.returncode:
        pytest.skip("which files are the project's is known to git, and this is no checkout")
    texts = [
        name for name in listed.stdout.decode().split("\0") if name.endswith((".md", ".py", ".toml", ".yml", ".js"))
    ]
    holding = {name for name in texts if address in (ROOT / name).read_text(encoding="utf-8")}
    assert holding - {"tests/test_release.py", "tests/docs/test_site.py"} == {"pyproject.toml"}


def test_an_address_of_another_place_is_told(tree: Path) -> None:
    path = tree / "pyproject.toml"
    changed = re.sub(r'^Icon = ".*"', 'Icon = "https://code.example/icon.png"', path.read_text("utf-8"), flags=re.M)
    path.write_text(changed, encoding="utf-8")
    (told,) = release.problems(tree)
    assert told.startswith("Icon in pyproject.toml must be https://code.example/someone/")


@pytest.mark.parametrize(("name", "proportions"), [("Icon", 1), ("Banner", 21 / 9)])
def test_the_registrys_pictures_are_as_it_asks(name: str, proportions: float) -> None:
    path = ROOT / release.ADDRESSES[name].removeprefix("/raw/HEAD/")
    with Image.open(path) as picture:
        assert picture.format in {"PNG", "JPEG"}
        assert picture.width / picture.height == pytest.approx(proportions, rel=1e-3)
        assert name != "Icon" or picture.width <= 400
    assert path.stat().st_size < 200_000


def test_the_metadata_is_what_the_registry_reads() -> None:
    project, comfy = _project()["project"], _project()["tool"]["comfy"]
    assert re.fullmatch(r"[A-Za-z]([A-Za-z0-9]|[-_.](?![-_.])){0,99}", project["name"])
    assert re.fullmatch(r">=\d+\.\d+\.\d+", comfy["requires-comfyui"])
    assert comfy["PublisherId"]
    assert comfy["DisplayName"]
    systems = [each for each in project["classifiers"] if each.startswith("Operating System :: ")]
    assert systems == ["Operating System :: OS Independent"]
    environments = {each.partition(" :: ")[2] for each in project["classifiers"] if each.startswith("Environment ::")}
    assert environments <= ENVIRONMENTS, "one other than these makes the registry drop all of them"


def test_nothing_runs_text_as_code() -> None:
    """The registry's tool looks through all of the tree, and refuses what does."""
    called = re.compile(r"(?<![\w.\"'`])(exec|eval)\(")
    kept = [path for path in ROOT.rglob("*.py") if not {"node_modules", ".venv", "build"} & set(path.parts)]
    assert len(kept) > 500
    assert [path.name for path in kept if called.search(path.read_text(encoding="utf-8"))] == []


@pytest.fixture(scope="module")
def archive() -> set[str]:
    if not (ROOT / ".git").exists() or shutil.which("git") is None:
        pytest.skip("the registry's packer asks git, and this is no checkout")
    return set(release.archive(ROOT))


def test_the_archive_holds_what_runs_and_nothing_else(archive: set[str]) -> None:
    modules = {
        path.relative_to(ROOT).as_posix()
        for room in ("nodes", "physics", "rendering", "workflows")
        for path in (ROOT / room).rglob("*.py")
        if "docs" not in path.parts and path.parent.name != "drawing" and path.name != "render.py"
    }
    assert modules <= archive
    needed = "README.md LICENSE CHANGELOG.md pyproject.toml requirements.txt install.py __init__.py __main__.py"
    assert set(needed.split()) <= archive
    rooms = {name.split("/")[0] for name in archive if "/" in name}
    assert rooms - {"locales", "subgraphs"} == {"nodes", "physics", "rendering", "workflows"}
    assert not [name for name in archive if name.startswith(("nodes/docs/", "."))]


def test_the_archive_is_small(archive: set[str]) -> None:
    size = sum((ROOT / name).stat().st_size for name in archive)
    assert size < 16_000_000, f"{size:,} bytes: does .comfyignore name what is not needed?"


def test_the_archive_loads_and_finds_its_files(archive: set[str], tmp_path: Path) -> None:
    folder = tmp_path / "physanimator"
    for name in archive:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    command = [sys.executable, "-m", "physanimator", "demo", "--frames", "2", "--width", "160", "--output", "demo.gif"]
    done = subprocess.run(
        [*command, "--quiet"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "demo.gif").stat().st_size > 1000


WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))


def _jobs(path: Path) -> dict:
    yaml = pytest.importorskip("yaml")
    return yaml.safe_load(path.read_text(encoding="utf-8"))["jobs"]


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_actions_are_pinned_and_no_secret_is_in_the_text(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    used = [step["uses"] for job in _jobs(path).values() for step in job.get("steps", []) if "uses" in step]
    assert used
    for each in used:
        assert re.fullmatch(r"actions/[a-z-]+@v\d+|[\w-]+/[\w-]+@([0-9a-f]{40}|v?\d+\.\d+\.\d+)", each), each
    assert set(re.findall(r"secrets\.(\w+)", text)) <= {"REGISTRY_ACCESS_TOKEN"}
    assert all(job["runs-on"] for job in _jobs(path).values() if "uses" not in job)
    assert "-latest" not in text


def test_nothing_is_published_before_the_checks_and_tests() -> None:
    jobs = _jobs(ROOT / ".github" / "workflows" / "publish.yml")
    assert "release.py check --tag" in str(jobs["check"])
    assert jobs["tests"]["uses"] == "./.github/workflows/tests.yml"
    assert all(jobs[name]["needs"] == ["check", "tests"] for name in jobs.keys() - {"check", "tests"})


def test_every_system_and_the_newest_host_are_tested() -> None:
    jobs = _jobs(ROOT / ".github" / "workflows" / "tests.yml")
    systems = {each.split("-")[0] for each in jobs["tests"]["strategy"]["matrix"]["system"]}
    assert systems == {"ubuntu", "windows", "macos"}
    oldest = _project()["tool"]["comfy"]["requires-comfyui"].removeprefix(">=")
    assert jobs["host"]["strategy"]["matrix"]["host"] == [f"v{oldest}", "newest"]
    pinned = {found for job in jobs.values() for found in re.findall(r"torch==[\d.]+", str(job))}
    assert pinned == set(re.findall(r"torch==[\d.]+", (ROOT / ".ci" / "run").read_text(encoding="utf-8")))
