"""How Sphinx builds the site: ``python -m sphinx --fail-on-warning --nitpicky nodes/docs site``.

Pages that follow from the code (nodes, scene documents, command line, library) are written into ``made/`` first.
"""

from __future__ import annotations

import dataclasses
import importlib.util
import inspect
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def _load_package(name: str, folder: Path) -> None:
    """Load a folder as a package of this name, whatever it is called and wherever it lies."""
    if name in sys.modules:
        return
    spec = importlib.util.spec_from_file_location(
        name, folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    assert spec is not None
    assert spec.loader is not None
    sys.modules[name] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)


_load_package("physanimator", ROOT)
_load_package("made_from", HERE / "made_from")

import physanimator  # noqa: E402
from made_from import public_links, resolve_reexported, write_pages  # noqa: E402

project = "PhysAnimator"
author = "The PhysAnimator developers"
copyright = "the PhysAnimator developers; Apache-2.0"
release = version = physanimator.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_enable_extensions = ["deflist", "colon_fence", "attrs_inline"]
myst_heading_anchors = 3
exclude_patterns = ["made_from", "made/own_picture.md"]  # the latter is a part of start.md
nitpicky = True
nitpick_ignore_regex = [("py:.*", r"(?!physanimator\b).*")]  # other projects' types: the build asks no network for them
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 100
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
add_module_names = False
python_use_unqualified_type_names = True
napoleon_google_docstring = True
napoleon_use_ivar = True
napoleon_attr_annotations = False  # they stand in the signature
smartquotes = False  # options begin with two hyphens
napoleon_custom_sections = [("Returns", "params_style")]  # several values, each with its name

html_theme = "furo"
html_title = f"PhysAnimator {release}"
html_logo = html_favicon = "emblem/icon.png"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_theme_options = {"footer_icons": public_links(ROOT)}
html_copy_source = False


def _keep_bars(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Bars in docstrings are absolute values, not reStructuredText's substitutions."""
    lines[:] = [line if line.lstrip().startswith((">>>", "...")) else line.replace("|", r"\|") for line in lines]


class _Words:
    """Stands for a default, as these words."""

    def __init__(self, text: str) -> None:
        self.text = text

    def __repr__(self) -> str:
        return self.text


def _short(default: Any) -> Any:
    """A set of options as its name, where all of it is usual: ``Timing()``."""
    if isinstance(default, type) or not dataclasses.is_dataclass(default):
        return default
    try:
        usual = default == type(default)()
    except TypeError:  # something must be given
        return default
    return _Words(f"{type(default).__name__}()") if usual else default


def _as_written(app: Any, what: str, name: str, thing: Any, options: Any, signature: str, returns: str) -> Any:
    """Types as the source has them, ``NDArray[np.float64]``; of a class only names and defaults, told below it."""
    if what not in {"class", "function", "method"} or not signature:
        return None
    from sphinx.util.inspect import stringify_signature

    told = inspect.signature(thing)
    values = [each.replace(default=_short(each.default)) for each in told.parameters.values()]
    if what == "class":
        values = [each.replace(annotation=inspect.Parameter.empty) for each in values]
        return stringify_signature(told.replace(parameters=values, return_annotation=inspect.Signature.empty)), None
    if what == "method" and values and values[0].name in {"self", "cls"}:
        values = values[1:]
    bare = told.replace(parameters=values, return_annotation=inspect.Signature.empty)
    returned = told.return_annotation
    return stringify_signature(bare), returned if isinstance(returned, str) else None


def setup(app: Any) -> None:
    """Write the pages that follow from the code, and find names where rooms hand them out."""
    write_pages(HERE / "made", ROOT)
    app.connect("autodoc-process-docstring", _keep_bars)
    app.connect("autodoc-process-signature", _as_written)
    app.connect("missing-reference", resolve_reexported)
