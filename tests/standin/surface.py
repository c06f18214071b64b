"""What the stand-in offers under the host's names, as JSON: run with either of them, the two are compared.

    python tests/standin/surface.py tests/standin/host
    python tests/standin/surface.py COMFYUI [argument ...] < NAMES

COMFYUI is a checkout, the arguments are those of its main.py, and NAMES are those that the first command has printed.
"""

from __future__ import annotations

import importlib
import inspect
import json
import sys
from pathlib import Path
from typing import Any

STAND_IN = Path(__file__).with_name("host")
_EMPTY = inspect.Parameter.empty


def modules() -> list[str]:
    """Names of the stand-in's modules that the host has too."""
    paths = (path.relative_to(STAND_IN).with_suffix("") for path in STAND_IN.rglob("*.py"))
    found = (".".join(path.parts).removesuffix(".__init__") for path in paths)
    # How the host divides its interface of nodes into files is its own affair.
    return sorted(name for name in found if not name.startswith("comfy_api.latest."))


def names() -> dict[str, list[str]]:
    """The functions, classes and methods of each module, as dotted paths."""
    found = {}
    for module in modules():
        offered = vars(importlib.import_module(module))
        public = [name for name, value in offered.items() if _is_own(name, value, module)]
        found[module] = [path for name in public for path in (name, *_methods(name, offered[name]))]
    interface = importlib.import_module("comfy_api.latest")
    for part in ("io", "ui"):
        offered = vars(getattr(interface, part))
        for name in offered["__all__"]:
            paths = (name, *_methods(name, offered[name]), *(f"{name}.{each}" for each in _parts(offered[name])))
            found["comfy_api.latest"] += [f"{part}.{path}" for path in paths]
    return found


def told(wanted: dict[str, list[str]]) -> dict[str, Any]:
    """Signatures of these paths: parameters with their kinds and defaults; None for what is no function or class."""
    return {
        f"{module}:{path}": _signature(importlib.import_module(module), path)
        for module, paths in wanted.items()
        for path in paths
    }


def _is_own(name: str, value: Any, module: str) -> bool:
    return not name.startswith("_") and getattr(value, "__module__", "").startswith(module) and name != "use"


def _methods(name: str, value: Any) -> list[str]:
    if not isinstance(value, type):
        return []
    return [f"{name}.{each}" for each, kept in vars(value).items() if not each.startswith("_") and _is_call(kept)]


def _is_call(value: Any) -> bool:
    return inspect.isfunction(getattr(value, "__func__", value))


def _parts(value: Any) -> list[str]:
    """Input, Output and Option of a type of wire."""
    return [each for each in ("Input", "Output", "Option") if isinstance(getattr(value, each, None), type)]


def _signature(owner: Any, path: str) -> Any:
    for name in path.split("."):
        if not hasattr(owner, name):
            return "missing"
        owner = getattr(owner, name)
    try:
        parameters = inspect.signature(owner).parameters.values()
    except (TypeError, ValueError):
        return None
    return {
        each.name: [each.kind.name, "required" if each.default is _EMPTY else str(each.default)] for each in parameters
    }


def main() -> None:
    folder, *arguments = sys.argv[1:]
    sys.path.insert(0, folder)
    sys.argv[1:] = arguments
    if Path(folder).resolve() == STAND_IN:
        wanted = names()
    else:
        wanted = json.load(sys.stdin)
        import comfy.options
        import utils.install_util  # noqa: F401 - the host's nodes hide this package, as its main.py knows

        comfy.options.enable_args_parsing()
    print(json.dumps({"names": wanted, "told": told(wanted)}))


if __name__ == "__main__":
    main()
