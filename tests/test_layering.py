"""Who may import whom, read from the sources; and that importing costs nothing."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
ROOMS = ("physics", "rendering", "nodes")
HOST = {"comfy", "comfy_api", "comfy_execution", "execution", "folder_paths", "server"}
NEURAL = {"torch", "torchvision", "diffusers", "transformers", "safetensors"}

FORBIDDEN = {
    "physics": {"rendering", "nodes", "pipeline", "__main__", "PIL", "av"} | HOST | NEURAL,
    "rendering": {"nodes", "pipeline", "__main__"} | HOST,
    "nodes": {"pipeline", "__main__"},
    "pipeline": {"nodes", "__main__"} | HOST,
    "__main__": {"nodes"} | HOST,
    "__init__": {"physics", "rendering", "pipeline", "__main__"} | HOST,
}
"""For each room, or module at the root, what it must not import."""

HEAVY = {"PIL", "av", "jsonschema", "pythoncdt", "scipy", "taichi", "tqdm"} | NEURAL

LIGHT = {"numpy", "cv2"}
"""Packages outside the standard library that any module may import at its top."""


@dataclass(frozen=True)
class Import:
    """One imported name.

    Attributes:
        importer: path of the module from the root, without suffix, such as ``physics/mesh``.
        target: first part of an outside package, or the path from the root of a module of ours.
        ours: whether it is a module of this package.
        at_top: whether it is imported as soon as the importer is.
        line: line number.
    """

    importer: str
    target: str
    ours: bool
    at_top: bool
    line: int

    @property
    def room(self) -> str:
        return self.importer.split("/")[0]

    def __str__(self) -> str:
        return f"{self.importer}.py:{self.line} imports {self.target}"


def sources() -> list[Path]:
    inside = [path for room in ROOMS for path in (ROOT / room).rglob("*.py")]
    return sorted([*ROOT.glob("*.py"), *inside])


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
                yield Import(importer, alias.name.split(".")[0], False, node in top, node.lineno)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield Import(importer, (node.module or "").split(".")[0], False, node in top, node.lineno)
        elif isinstance(node, ast.ImportFrom):
            folder = importer.split("/")[: -node.level]
            base = [*folder, *(node.module.split(".") if node.module else [])]
            for alias in node.names:
                named = [*base, alias.name]
                is_module = ROOT.joinpath(*named).with_suffix(".py").exists() or ROOT.joinpath(*named).is_dir()
                target = "/".join(named if is_module else base)
                yield Import(importer, target or "__init__", True, node in top, node.lineno)


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


@pytest.mark.parametrize("room", FORBIDDEN)
def test_rooms_import_only_what_they_may(room: str) -> None:
    wrong = [
        str(found)
        for found in imports()
        if found.room == room and (found.target.split("/")[0] if found.ours else found.target) in FORBIDDEN[room]
    ]
    assert wrong == []


def test_only_the_entry_point_imports_nodes() -> None:
    wrong = [found for found in imports() if found.ours and found.target.startswith("nodes") and found.room != "nodes"]
    assert {found.importer for found in wrong} <= {"__init__"}
    assert not any(found.at_top for found in wrong)


def test_imports_inside_the_pack_are_relative() -> None:
    own = {"physanimator", "physics", "rendering", "nodes", "pipeline", "tests"}
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
    assert not {"__init__", "__main__", "pipeline", "nodes/extension"} & heavy
    first = {found.target for found in imports() if found.importer in ("__init__", "__main__") and found.at_top}
    assert not first - sys.stdlib_module_names - {"__init__"}


# install.py is what a host's manager runs to install; the worker starts this package's own kernels beside another's.
PROCESSES = {"install.py": {"subprocess"}, "physics/taichi_worker.py": {"subprocess", "sys.path"}}


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
