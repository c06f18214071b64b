"""The site holds all that the code has, is built without a complaint and a network, and its links lead somewhere."""

from __future__ import annotations

import importlib.util
import json
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from made_from import pages, public_links
from made_from.commands import pages_of
from physanimator.physics.document import scene_schema
from physanimator.rendering.command.commands import command_parser

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / "nodes" / "docs"
HELP = ROOT / "nodes" / "web" / "docs"
SCHEMAS = json.loads((ROOT / "tests" / "nodes" / "node_schemas.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def made() -> dict[str, str]:
    return pages(ROOT)


def test_every_node_has_a_page_with_all_its_inputs_and_outputs(made: dict[str, str]) -> None:
    for name, node in SCHEMAS.items():
        text = made[f"nodes/{name}.md"]
        assert f"[{node['display_name']}]({name}.md)" in made["nodes/index.md"]
        for kind in ("required", "optional"):
            for given in node["input"].get(kind, {}):
                assert f"| `{given}` |" in text
        assert all(f"| `{output}` |" in text for output in node["output_name"])


def test_inputs_inside_choices_say_when_they_are_there(made: dict[str, str]) -> None:
    (row,) = (line for line in made["nodes/PhysAnimator_RigPoint.md"].splitlines() if "`region.radius`" in line)
    assert "0.5 to 16384" in row
    assert "With `region = circle`." in row


def test_every_option_of_the_command_line_is_told(made: dict[str, str]) -> None:
    parser = command_parser()
    commands = next(each.choices for each in parser._actions if isinstance(each.choices, dict))
    for name, command in commands.items():
        section = made["command_line.md"].split(f"\n## physanimator {name}\n")[1].split("\n## ")[0]
        for action in command._actions:
            assert action.dest == "help" or all(f"`{option}" in section for option in action.option_strings)


def test_every_field_of_a_scene_has_its_bounds(made: dict[str, str]) -> None:
    schema, text = scene_schema(), made["scene.md"]
    tables = [schema, *(each for each in schema["$defs"].values() if "properties" in each)]
    for field in {field for each in tables for field in each["properties"]}:
        assert f"| `{field}` |" in text
    (row,) = (line for line in text.splitlines() if line.startswith("| `frame_rate` |"))
    assert r"\>= 1, \<= 240" in row
    assert "`24.0`" in row


def test_speed_and_limits_are_the_readmes(made: dict[str, str]) -> None:
    assert "tests/benchmarks/pipeline.py --json" in made["speed.md"]
    assert made["limits.md"].startswith("# Limits\n")
    assert "[Differences from the paper](differences.md)" in made["limits.md"]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    for package in ("sphinx", "myst_parser", "furo"):
        if importlib.util.find_spec(package) is None:
            pytest.skip("the site is built where `.[docs]` is installed")
    out = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "--fail-on-warning", "--keep-going", "--nitpicky", "--quiet"]
    done = subprocess.run([*command, SITE, out], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return out


class _Links(HTMLParser):
    """What a page leads to and shows, and the names of its places."""

    def __init__(self) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.places: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        told = dict(attrs)
        self.targets += [value for key in ("href", "src") if (value := told.get(key))]
        self.places |= {value for key in ("id", "name") if (value := told.get(key))}


def test_links_and_pictures_of_the_built_site_are_there(built: Path) -> None:
    read = {}
    for path in built.rglob("*.html"):
        read[path.resolve()] = links = _Links()
        links.feed(path.read_text(encoding="utf-8"))
    assert len(read) > len(SCHEMAS)
    broken = []
    for path, links in read.items():
        for target in links.targets:
            parts = urlsplit(target)
            if parts.scheme:
                continue
            goal = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            place = unquote(parts.fragment)
            if not goal.exists() or (place and goal in read and place not in read[goal].places):
                broken.append(f"{path.relative_to(built)}: {target}")
    assert broken == []


def test_the_library_is_told_with_its_examples(built: Path) -> None:
    text = (built / "made" / "library" / "physics.mesh.html").read_text(encoding="utf-8")
    assert 'id="physanimator.physics.mesh.mesh_from_mask"' in text
    assert "&gt;&gt;&gt; " in text
    assert "InvalidInputError" in text


def test_the_site_asks_nothing_of_the_network(built: Path) -> None:
    for path in built.rglob("*.html"):
        loaded = re.findall(r'<(?:script|img|link)[^>]+(?:src|href)="(https?:[^"]+)"', path.read_text(encoding="utf-8"))
        assert loaded == [], path


def test_every_page_leads_to_the_repository_once_it_has_an_address(tmp_path: Path) -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    old = re.search(r'^Repository = "([^"]+)"', text, re.MULTILINE)
    assert old is not None
    path = tmp_path / "pyproject.toml"
    path.write_text(text.replace(old[1], "https://repository.invalid/physanimator"), encoding="utf-8")
    assert public_links(tmp_path) == []
    path.write_text(text.replace(old[1], "https://code.example/someone/physanimator"), encoding="utf-8")
    assert [link["url"] for link in public_links(tmp_path)] == [
        "https://code.example/someone/physanimator",
        "https://code.example/someone/physanimator/issues",
    ]


def test_pages_name_nodes_that_there_are() -> None:
    named = {
        name
        for page in pages_of(SITE)
        for name in re.findall(r"made/nodes/(PhysAnimator_\w+)\.md", page.read_text(encoding="utf-8"))
    }
    assert named
    assert named <= set(SCHEMAS)


def test_pages_name_templates_that_there_are() -> None:
    templates = {path.stem for path in (ROOT / "workflows").glob("*.json")}
    for page in pages_of(SITE):
        text = page.read_text(encoding="utf-8")
        assert set(re.findall(r"template \*\*(\w+)\*\*", text)) <= templates
        assert set(re.findall(r"choose \*\*(\w+)\*\*", text)) <= templates


def test_the_steps_for_a_picture_of_ones_own_connect(made: dict[str, str]) -> None:
    """Every node is there, and has the inputs that are named for it."""
    rows = re.findall(r"^\| \[[^\]]+\]\(made/nodes/(\w+)\.md\) \| (.+) \|$", made["own_picture.md"], re.MULTILINE)
    assert len(rows) >= 6
    for name, what in rows:
        inputs = SCHEMAS[name]["input"]
        assert set(re.findall(r"(?<!\*)\*(\w+)\*(?!\*)", what)) <= {*inputs["required"], *inputs.get("optional", {})}


@pytest.mark.parametrize("folder", sorted({path.parent for path in HELP.rglob("*.md")}), ids=lambda path: path.name)
def test_emphasis_in_help_pages_is_read_as_such(folder: Path) -> None:
    """Asterisks beside a bracket and a letter of Chinese, Japanese or Korean stay what they are."""
    reader = pytest.importorskip("markdown_it").MarkdownIt("commonmark").enable("table")
    for path in folder.glob("*.md"):
        inline = [token for token in reader.parse(path.read_text(encoding="utf-8")) if token.type == "inline"]
        texts = [part.content for token in inline for part in token.children if part.type == "text"]
        assert [text for text in texts if "*" in text.replace("L*a*b*", "")] == [], path
