"""Which room may import which, read from the sources; and that importing costs nothing."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
HOUSES = ("physics", "rendering", "nodes")
HOST = {"comfy", "comfy_api", "comfy_execution", "execution", "folder_paths", "server"}
NEURAL = {"torch", "torchvision", "diffusers", "transformers", "safetensors"}

MAY_IMPORT = {
    # physics: numpy, scipy, OpenCV, Taichi; neither torch nor a host
    "physics": "",
    "physics/forces": "physics",
    "physics/mesh": "physics",
    "physics/runtime": "physics",
    "physics/material": "physics physics/mesh",
    "physics/rig": "physics physics/mesh",
    "physics/scene": "physics physics/forces physics/material physics/mesh physics/rig",
    "physics/solver": "physics physics/forces physics/material physics/rig physics/runtime",
    "physics/assembly": (
        "physics physics/forces physics/material physics/mesh physics/rig physics/scene physics/solver"
    ),
    "physics/document": "physics physics/forces physics/material physics/mesh physics/rig physics/scene",
    "physics/motion": "physics physics/mesh physics/scene",
    "physics/contact": (
        "physics physics/assembly physics/material physics/mesh physics/runtime physics/scene physics/solver"
    ),
    "physics/simulation": (
        "physics physics/assembly physics/contact physics/forces physics/material physics/mesh physics/motion "
        "physics/rig physics/runtime physics/scene physics/solver"
    ),
    # rendering: torch and diffusers as well; no host
    "rendering/files": "physics",
    "rendering/networks": "physics rendering/files",
    "rendering/pictures": "physics physics/mesh rendering/files",
    "rendering/artwork": "physics physics/material rendering/files rendering/pictures",
    "rendering/matting": "physics physics/mesh rendering/pictures",
    "rendering/metrics/learned": "physics rendering/files rendering/networks rendering/pictures",
    "rendering/svd": "physics rendering/networks rendering/pictures",
    "rendering/inpainting": "physics rendering/networks rendering/pictures",
    "rendering/plate": "physics physics/mesh rendering/matting rendering/pictures",
    "rendering/composite": (
        "physics physics/mesh physics/motion rendering/artwork rendering/matting rendering/pictures rendering/plate"
    ),
    "rendering/export": "physics physics/mesh physics/motion rendering/artwork rendering/files rendering/pictures",
    "rendering/overlays": (
        "physics physics/forces physics/mesh physics/motion physics/rig physics/scene rendering/pictures"
    ),
    "rendering/sketch": "physics physics/mesh physics/motion rendering/composite rendering/pictures",
    "rendering/control": (
        "physics physics/mesh physics/motion rendering/composite rendering/overlays rendering/pictures rendering/sketch"
    ),
    "rendering/figures": (
        "physics physics/forces physics/material physics/mesh physics/motion physics/rig physics/scene "
        "physics/simulation rendering/composite rendering/overlays"
    ),
    "rendering/inbetweens": "physics physics/mesh physics/motion rendering/pictures rendering/sketch",
    "rendering/metrics": "physics physics/mesh physics/motion rendering/pictures rendering/sketch",
    "rendering/segmentation": "physics physics/document physics/mesh physics/scene rendering/pictures rendering/sketch",
    "rendering/sketch/drawings": "physics rendering/networks rendering/pictures rendering/sketch",
    "rendering/segmentation/sam": (
        "physics rendering/files rendering/networks rendering/pictures rendering/segmentation"
    ),
    "rendering/tooncrafter": (
        "physics rendering/files rendering/inbetweens rendering/networks rendering/pictures rendering/svd"
    ),
    "rendering/neural": (
        "physics rendering/composite rendering/inpainting rendering/networks rendering/pictures "
        "rendering/segmentation/sam rendering/sketch rendering/sketch/drawings rendering/svd rendering/tooncrafter"
    ),
    "rendering": (
        "physics physics/assembly physics/document physics/material physics/mesh physics/motion physics/rig "
        "physics/scene physics/simulation rendering/artwork rendering/composite rendering/export rendering/files "
        "rendering/inbetweens rendering/matting rendering/neural rendering/overlays rendering/pictures "
        "rendering/segmentation rendering/sketch rendering/svd"
    ),
    "rendering/evaluation/columns": (
        "physics physics/motion rendering/metrics rendering/metrics/learned rendering/neural rendering/pictures "
        "rendering/sketch"
    ),
    "rendering/evaluation/study": "physics rendering/files rendering/pictures",
    "rendering/evaluation": (
        "__init__ physics physics/document physics/forces physics/mesh physics/motion physics/scene rendering "
        "rendering/artwork rendering/evaluation/columns rendering/figures rendering/files rendering/neural "
        "rendering/pictures rendering/segmentation rendering/sketch"
    ),
    "rendering/training": (
        "__init__ physics physics/forces physics/material physics/motion physics/scene rendering "
        "rendering/artwork rendering/files rendering/networks rendering/neural rendering/pictures "
        "rendering/sketch rendering/sketch/drawings rendering/svd rendering/tooncrafter"
    ),
    "rendering/shots": "__init__ physics rendering rendering/composite rendering/files",
    "rendering/command": (
        "__init__ physics physics/assembly physics/document physics/material physics/mesh physics/motion "
        "physics/scene physics/simulation rendering rendering/artwork rendering/composite rendering/export "
        "rendering/evaluation rendering/evaluation/study rendering/figures "
        "rendering/files "
        "rendering/inbetweens rendering/metrics rendering/metrics/learned rendering/neural rendering/pictures "
        "rendering/segmentation rendering/shots rendering/training"
    ),
    # nodes: the host
    "nodes/host": (
        "physics physics/document physics/mesh physics/motion physics/scene rendering rendering/composite "
        "rendering/pictures rendering/sketch"
    ),
    "nodes/preview": (
        "nodes/host physics physics/assembly physics/document physics/forces physics/mesh physics/motion physics/rig "
        "physics/runtime physics/scene physics/simulation rendering rendering/artwork rendering/composite "
        "rendering/pictures rendering/plate rendering/segmentation"
    ),
    "nodes/models": (
        "nodes/host physics rendering/composite rendering/inbetweens rendering/inpainting rendering/networks "
        "rendering/neural rendering/pictures rendering/segmentation/sam rendering/sketch rendering/sketch/drawings "
        "rendering/svd rendering/tooncrafter"
    ),
    "nodes": (
        "nodes/host nodes/models nodes/preview physics physics/document physics/forces physics/material "
        "physics/mesh physics/motion physics/rig physics/scene physics/simulation rendering rendering/artwork "
        "rendering/composite rendering/control rendering/export rendering/inbetweens rendering/matting "
        "rendering/metrics rendering/metrics/learned rendering/neural rendering/overlays rendering/pictures "
        "rendering/segmentation rendering/sketch"
    ),
    # the entry points
    "__init__": "nodes",
    "__main__": "rendering/command",
}
"""For each room, from the ground up, the rooms that it may import. A house's own name stands for the files in it."""

NOT_INSIDE = {"physics": {"PIL", "av"} | HOST | NEURAL, "rendering": HOST, "nodes": set(), "": HOST}
"""Packages that no room of a house may import."""

HEAVY = {"PIL", "av", "dask", "distributed", "jsonschema", "psd_tools", "pythoncdt"} | NEURAL
HEAVY |= {"scipy", "taichi", "threadpoolctl", "tqdm"}

LIGHT = {"numpy", "cv2"}
"""Packages outside the standard library that any module may import at its top."""


@dataclass(frozen=True)
class Import:
    """One imported name.

    Attributes:
        importer: path of the module from the root, without suffix, such as ``physics/mesh/raster``.
        target: first part of an outside package, or the path from the root of a module of ours.
        name: what is imported of it, empty for all of it.
        ours: whether it is a module of this package.
        at_top: whether it is imported as soon as the importer is.
        line: line number.
    """

    importer: str
    target: str
    name: str
    ours: bool
    at_top: bool
    line: int

    def __str__(self) -> str:
        return f"{self.importer}.py:{self.line} imports {self.name or 'all'} of {self.target}"


def room_of(module: str) -> str:
    """The room in which a module is: its folder, or the module itself where it stands at the root."""
    return module.rpartition("/")[0] or module


def sources() -> list[Path]:
    """All but those that draw and build the documentation, which is no part of the package."""
    inside = [path for house in HOUSES for path in (ROOT / house).rglob("*.py")]
    return sorted([*ROOT.glob("*.py"), *(path for path in inside if not path.is_relative_to(ROOT / "nodes" / "docs"))])


@lru_cache
def imports() -> tuple[Import, ...]:
    return tuple(found for path in sources() for found in _imports_of(path))


def _imports_of(path: Path) -> Iterator[Import]:
    importer = path.relative_to(ROOT).with_suffix("").as_posix()
    tree = ast.parse(path.read_text(encoding="utf-8"))
    top = set(_run_at_import(tree.body))
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield Import(importer, alias.name.split(".")[0], "", False, node in top, node.lineno)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            for alias in node.names:
                target = (node.module or "").split(".")[0]
                yield Import(importer, target, alias.name, False, node in top, node.lineno)
        elif isinstance(node, ast.ImportFrom):
            folder = importer.split("/")[: -node.level]
            base = "/".join([*folder, *(node.module.split(".") if node.module else [])])
            for alias in node.names:
                target, name = _module_at(f"{base}/{alias.name}".lstrip("/")), ""
                if target is None:
                    target, name = _module_at(base), alias.name
                assert target is not None, f"{path}:{node.lineno}: there is no {base}"
                yield Import(importer, target, name, True, node in top, node.lineno)


def _module_at(path: str) -> str | None:
    """The module at a path from the root: a file's, or a folder's ``__init__``."""
    if path and (ROOT / path).with_suffix(".py").exists():
        return path
    return f"{path}/__init__".lstrip("/") if (ROOT / path / "__init__.py").exists() else None


def _run_at_import(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Statements that run on import: outside functions and outside ``if TYPE_CHECKING``."""
    for node in body:
        yield node
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            yield from _run_at_import(node.orelse)
        elif not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            for block in ("body", "orelse", "finalbody"):
                yield from _run_at_import(getattr(node, block, []))
            for handler in getattr(node, "handlers", []):
                yield from _run_at_import(handler.body)


def heavy_modules() -> set[str]:
    """Modules whose own subject is a heavy package: they import it at their top, and are imported late themselves."""
    return {
        found.importer
        for found in imports()
        if found.at_top and not found.ours and found.target not in LIGHT | HOST | sys.stdlib_module_names
    }


def circles(arrows: Iterable[tuple[str, str]]) -> list[str]:
    """What is left of a graph when all that leads nowhere but out of it is taken away, again and again."""
    left = {(begin, end) for begin, end in arrows if begin != end}
    while True:
        leading = {begin for begin, _ in left}
        fewer = {(begin, end) for begin, end in left if end in leading}
        if fewer == left:
            return sorted(f"{begin} -> {end}" for begin, end in left)
        left = fewer


@pytest.mark.parametrize("room", MAY_IMPORT)
def test_a_room_imports_only_what_it_may(room: str) -> None:
    allowed = {room, *MAY_IMPORT[room].split()}
    ours = [found for found in imports() if found.ours and room_of(found.importer) == room]
    assert [str(found) for found in ours if room_of(found.target) not in allowed] == []


@pytest.mark.parametrize("room", MAY_IMPORT)
def test_the_table_allows_nothing_that_no_longer_is(room: str) -> None:
    used = {room_of(found.target) for found in imports() if found.ours and room_of(found.importer) == room}
    assert set(MAY_IMPORT[room].split()) - used == set()


def test_every_room_is_in_the_table() -> None:
    rooms = {room_of(path.relative_to(ROOT).with_suffix("").as_posix()) for path in sources()}
    assert rooms - {"install"} == set(MAY_IMPORT)


def test_no_circle_between_rooms() -> None:
    assert circles((room, below) for room in MAY_IMPORT for below in MAY_IMPORT[room].split()) == []


def test_no_circle_between_files() -> None:
    """Imports for type checkers alone and inside functions count as well."""
    assert circles((found.importer, found.target) for found in imports() if found.ours) == []


def test_circles_are_found() -> None:
    assert circles([("a", "b"), ("b", "c"), ("c", "b"), ("c", "d")]) == ["a -> b", "b -> c", "c -> b"]


@pytest.mark.parametrize("house", NOT_INSIDE)
def test_a_house_keeps_packages_out(house: str) -> None:
    inside = [found for found in imports() if (found.importer.split("/")[0] if "/" in found.importer else "") == house]
    assert [str(found) for found in inside if not found.ours and found.target in NOT_INSIDE[house]] == []


def rooms() -> list[str]:
    return [room for room in MAY_IMPORT if "/" in room]


@lru_cache
def names_of(room: str) -> dict[str, str]:
    """The public names of a room, each with the module that defines it."""
    return {found.name: found.target for found in imports() if found.importer == f"{room}/__init__" and found.ours}


@pytest.mark.parametrize("room", rooms())
def test_a_room_says_what_it_is_for_and_lists_its_names(room: str) -> None:
    tree = ast.parse((ROOT / room / "__init__.py").read_text(encoding="utf-8"))
    words = ast.get_docstring(tree) or ""
    assert words
    assert "\n" not in words
    listed = [node for node in tree.body if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__"]
    names = ast.literal_eval(listed[0].value) if listed else []
    assert sorted(names) == sorted(names_of(room))


@pytest.mark.parametrize("room", rooms())
def test_no_name_of_a_room_hides_a_module_of_it(room: str) -> None:
    assert {name for name in names_of(room) if (ROOT / room / f"{name}.py").exists()} == set()


def test_a_name_has_one_path_from_outside_its_room() -> None:
    """What a room hands out is imported from it; what it does not hand out, such as heavy modules, from a file."""
    wrong = [
        str(found)
        for found in imports()
        if found.ours
        and (room := room_of(found.target)) in rooms()
        and room_of(found.importer) != room
        and names_of(room).get(found.name) == found.target
    ]
    assert wrong == []


def test_only_the_entry_point_imports_nodes() -> None:
    others = [found for found in imports() if found.importer.split("/")[0] != "nodes"]
    wrong = [found for found in others if found.target.startswith("nodes/")]
    assert {found.importer for found in wrong} <= {"__init__"}
    assert not any(found.at_top for found in wrong)


def test_imports_inside_the_pack_are_relative() -> None:
    own = {"physanimator", "physics", "rendering", "nodes", "tests"}
    assert [str(found) for found in imports() if not found.ours and found.target in own] == []


def test_modules_of_a_heavy_package_are_imported_late() -> None:
    heavy = heavy_modules()
    wrong = [
        str(found)
        for found in imports()
        if found.ours and found.at_top and found.target in heavy and found.importer not in heavy
    ]
    assert wrong == []


def test_entry_points_are_light() -> None:
    heavy = heavy_modules()
    assert not {"__init__", "__main__", "rendering/pipeline", "rendering/command/commands", "nodes/extension"} & heavy
    first = {found.target for found in imports() if found.importer == "__init__" and found.at_top}
    assert not first - sys.stdlib_module_names


# install.py is what a host's manager runs to install; the worker starts this package's own kernels beside another's.
PROCESSES = {"install.py": {"subprocess"}, "physics/runtime/worker.py": {"subprocess", "sys.path"}}


@pytest.mark.parametrize("path", sources(), ids=lambda path: path.relative_to(ROOT).as_posix())
def test_nothing_that_the_registry_forbids(path: Path) -> None:
    """No code from strings, no installation or processes at run time, no changed import path, no star imports."""
    wrong = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("eval", "exec"):
            wrong.append(node.func.id)
        if isinstance(node, ast.Attribute) and ast.unparse(node) in ("sys.path", "os.system", "os.popen"):
            wrong.append(ast.unparse(node))
        if isinstance(node, ast.Import):
            wrong += [each.name for each in node.names if each.name.split(".")[0] in ("pip", "subprocess", "ensurepip")]
        if isinstance(node, ast.ImportFrom) and not node.level:
            wrong += [str(node.module)] * (str(node.module).split(".")[0] in ("pip", "subprocess", "ensurepip"))
        if isinstance(node, ast.ImportFrom):
            wrong += ["*"] * any(each.name == "*" for each in node.names)
    assert set(wrong) <= PROCESSES.get(path.relative_to(ROOT).as_posix(), set())


def test_importing_loads_nothing_heavy() -> None:
    late = heavy_modules()
    light = [
        "physanimator." + path.relative_to(ROOT).with_suffix("").as_posix().replace("/", ".")
        for path in sources()
        if (module := path.relative_to(ROOT).with_suffix("").as_posix()) not in late
        and not module.startswith("nodes")
        and path.name != "__init__.py"
    ]
    script = (
        "import importlib, runpy, sys\n"
        f"runpy.run_path({str(ROOT / 'tests' / 'conftest.py')!r})\n"
        f"for name in {light!r}: importlib.import_module(name)\n"
        f"print(sorted({HEAVY!r} & set(sys.modules)))\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize(
    "room", ["physics/scene", "physics/simulation", "rendering/composite", "rendering/segmentation"]
)
def test_importing_a_room_loads_only_what_it_may_import(room: str) -> None:
    below, more = {room}, {room}
    while more:
        more = {each for one in more for each in MAY_IMPORT[one].split()} - below
        below |= more
    script = (
        "import importlib, runpy, sys\n"
        f"runpy.run_path({str(ROOT / 'tests' / 'conftest.py')!r})\n"
        f"importlib.import_module('physanimator.{room.replace('/', '.')}')\n"
        "print(*(name for name in sys.modules if name.startswith('physanimator.')))\n"
        f"print(sorted({HEAVY!r} & set(sys.modules)))\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    loaded, heavy = done.stdout.splitlines()
    paths = [name.split(".", 1)[1].replace(".", "/") for name in loaded.split()]
    assert {path for path in paths if path not in HOUSES and not {path, room_of(path)} & below} == set()
    assert heavy == "[]"
