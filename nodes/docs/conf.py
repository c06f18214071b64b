"""How Sphinx builds the site: ``python -m sphinx --fail-on-warning --nitpicky nodes/docs site``.

Pages that follow from the code (nodes, scene documents, command line, library) are written into ``made/`` first.
"""

from __future__ import annotations

import importlib.util
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
from made_from import resolve_reexported, write_pages  # noqa: E402

project = "PhysAnimator"
author = "The PhysAnimator developers"
copyright = "the PhysAnimator developers; Apache-2.0"
release = version = physanimator.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_enable_extensions = ["deflist", "colon_fence", "attrs_inline"]
myst_heading_anchors = 3
exclude_patterns = ["README.md", "made_from", "emblem", "files/README.md"]
nitpicky = True
nitpick_ignore_regex = [("py:.*", r"(?!physanimator\b).*")]  # other projects' types: the build asks no network for them
autodoc_typehints = "description"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "show-inheritance": False}
add_module_names = False
python_use_unqualified_type_names = True
napoleon_google_docstring = True
napoleon_use_ivar = True
napoleon_custom_sections = [("Returns", "params_style")]  # several values, each with its name

html_theme = "furo"
html_title = f"PhysAnimator {release}"
html_logo = html_favicon = "emblem/icon.png"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False


def _keep_bars(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Bars in docstrings are absolute values, not reStructuredText's substitutions."""
    lines[:] = [line if line.lstrip().startswith((">>>", "...")) else line.replace("|", r"\|") for line in lines]


def setup(app: Any) -> None:
    """Write the pages that follow from the code, and find names where rooms hand them out."""
    write_pages(HERE / "made", ROOT)
    app.connect("autodoc-process-docstring", _keep_bars)
    app.connect("missing-reference", resolve_reexported)
